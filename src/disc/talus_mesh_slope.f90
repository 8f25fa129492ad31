! SPDX-License-Identifier: MIT
!> Slope between level ground at a toe (left) and a crest (right), on a level base.
!>
!>                         crest corner ________ crest
!>                                    /         |
!>             ________ toe _________/          |
!>            |                                 |
!>            |_________________________________|
!>
!> The grid is a piecewise uniform lattice with lines through toe and crest corner. Slopes of one
!> row or less per column are cut column by column: a column ends at a node exactly on the face,
!> and lattice nodes nearer to it than `clearance` spacings are left out. Steeper ones are cut row
!> by row in the same way. Neighbouring lines then differ by at most one node, so that
!> quadrilaterals and one triangle join them.
module talus_mesh_slope
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_set, status_deck
  use talus_nodes, only: mesh_t, mesh_find_boundary, mesh_tag_sides, mesh_trim_elements, &
    tag_face
  implicit none
  private
  public :: mesh_slope

  !> Tenths of a spacing between a face node and the next lattice node, at least.
  integer, parameter :: clearance = 7

  !> The lattice, with coordinates relative to the lower left corner.
  type :: lattice_t
    real(dp) :: toe(2), crest(2), right !! toe, crest corner, right side [m]
    integer :: n1, n2, n3               !! columns left of the toe, under the face, under the crest
    integer :: nb, ns                   !! rows in the base and in the slope
  end type lattice_t

contains

  !> Slope grid of round(length/spacing) intervals along each straight part.
  pure subroutine mesh_slope(mesh, slope_height, slope_ratio, base_depth, toe_distance, &
                             crest_width, spacing, spacing_y, origin, status)
    type(mesh_t), intent(out) :: mesh
    real(dp), intent(in) :: slope_height !! crest above toe [m], > 0
    real(dp), intent(in) :: slope_ratio  !! horizontal over vertical [-], >= 0; 0 is a vertical cut
    real(dp), intent(in) :: base_depth   !! soil below the toe [m], >= 0
    real(dp), intent(in) :: toe_distance !! level ground left of the toe [m], >= 0
    real(dp), intent(in) :: crest_width  !! level ground right of the crest corner [m], > 0
    real(dp), intent(in) :: spacing      !! node spacing along x [m], > 0
    real(dp), intent(in) :: spacing_y    !! node spacing along y [m]; 0 means `spacing`
    real(dp), intent(in) :: origin(2)    !! lower left corner [m]
    type(status_t), intent(inout) :: status
    type(lattice_t) :: lattice
    real(dp) :: step_y

    if (min(slope_height, crest_width, spacing) <= 0.0_dp .or. &
        min(slope_ratio, base_depth, toe_distance) < 0.0_dp) then
      call status_set(status, status_deck, 'slope: slope_height, crest_width and spacing must '// &
        'be positive, slope_ratio, base_depth and toe_distance not negative')
      return
    else if (toe_distance > 0.0_dp .and. .not. base_depth > 0.0_dp) then
      call status_set(status, status_deck, &
        'slope: level ground at the toe (toe_distance > 0) needs base_depth > 0')
      return
    end if
    step_y = merge(spacing_y, spacing, spacing_y > 0.0_dp)
    lattice%toe = [toe_distance, base_depth]
    lattice%crest = lattice%toe + slope_height*[slope_ratio, 1.0_dp]
    lattice%right = lattice%crest(1) + crest_width
    lattice%n1 = intervals(toe_distance, spacing)
    lattice%n2 = nint(slope_ratio*slope_height/spacing)
    lattice%n3 = intervals(crest_width, spacing)
    if (lattice%n2 == 0) lattice%n3 = intervals(lattice%right - toe_distance, spacing)
    lattice%nb = intervals(base_depth, step_y)
    lattice%ns = intervals(slope_height, step_y)
    if (lattice%n2 >= lattice%ns) then
      call cut_by_columns(mesh, lattice)
    else
      call cut_by_rows(mesh, lattice)
    end if
    call mesh_find_boundary(mesh, status)
    call tag_boundary(mesh, lattice)
    mesh%x(1, :) = mesh%x(1, :) + origin(1)
    mesh%x(2, :) = mesh%x(2, :) + origin(2)
  end subroutine mesh_slope

  !> Number of intervals in a length: none only when the length is zero.
  pure integer function intervals(length, spacing)
    real(dp), intent(in) :: length, spacing

    intervals = nint(length/spacing)
    if (length > 0.0_dp) intervals = max(1, intervals)
  end function intervals

  !> Columns from the bottom up to the ground, left to right.
  pure subroutine cut_by_columns(mesh, g)
    type(mesh_t), intent(inout) :: mesh
    type(lattice_t), intent(in) :: g
    integer :: i, k, n, n_column, n_element, start, previous, n_previous
    real(dp) :: x, top, part

    n_column = g%n1 + g%n2 + g%n3
    call allocate_for(mesh, (n_column + 1)*(g%nb + g%ns + 1))
    start = 1
    n_element = 0
    previous = 0
    n_previous = 0
    do i = 0, n_column
      part = real(min(max(i - g%n1, 0), g%n2), dp)/real(g%n2, dp)
      top = g%toe(2) + part*(g%crest(2) - g%toe(2))
      x = lattice_x(g, i)
      n = column_count(g, min(max(i - g%n1, 0), g%n2))
      do k = 1, n - 1
        mesh%x(:, start+k-1) = [x, lattice_y(g, k - 1)]
      end do
      mesh%x(:, start+n-1) = [x, top]
      if (i > 0) call join_lines(mesh, n_element, previous, n_previous, start, n, .false.)
      previous = start
      n_previous = n
      start = start + n
    end do
    mesh%x = mesh%x(:, :start-1)
    call mesh_trim_elements(mesh, n_element)
  end subroutine cut_by_columns

  !> Nodes of the column i columns right of the toe: the lattice rows clear of the face node, at
  !> least the bottom one, and the face node itself.
  pure integer function column_count(g, i) result(n)
    type(lattice_t), intent(in) :: g
    integer, intent(in) :: i
    integer :: tenths

    tenths = g%n2*(10*g%nb - clearance) + 10*g%ns*i
    n = (tenths - modulo(tenths, 10*g%n2))/(10*g%n2) + 2
    if (g%nb > 0 .or. i > 0) n = max(n, 2)
  end function column_count

  !> Rows from the right side to the face, bottom to top.
  pure subroutine cut_by_rows(mesh, g)
    type(mesh_t), intent(inout) :: mesh
    type(lattice_t), intent(in) :: g
    integer :: j, k, n, n_element, start, previous, n_previous
    real(dp) :: y, face

    call allocate_for(mesh, (g%n1 + g%n2 + g%n3 + 1)*(g%nb + g%ns + 1))
    start = 1
    n_element = 0
    previous = 0
    n_previous = 0
    do j = 0, g%nb + g%ns
      y = lattice_y(g, j)
      n = g%n1 + g%n2 + g%n3 + 1
      face = 0.0_dp
      if (j > g%nb) then
        face = g%toe(1) + real(j - g%nb, dp)/real(g%ns, dp)*(g%crest(1) - g%toe(1))
        n = g%n2 + g%n3 + 2 - first_clear_column(g, j - g%nb)
      end if
      do k = 1, n - 1
        mesh%x(:, start+k-1) = [lattice_x(g, g%n1 + g%n2 + g%n3 + 1 - k), y]
        if (g%n2 == 0 .and. j > g%nb) mesh%x(1, start+k-1) = &
          g%right - real(k - 1, dp)/real(n - 1, dp)*(g%right - face)
      end do
      mesh%x(:, start+n-1) = [face, y]
      if (j == g%nb + 1) n_previous = n_previous - g%n1
      if (j > 0) call join_lines(mesh, n_element, start, n, previous, n_previous, .true.)
      previous = start
      n_previous = n
      start = start + n
    end do
    mesh%x = mesh%x(:, :start-1)
    call mesh_trim_elements(mesh, n_element)
  end subroutine cut_by_rows

  !> First lattice column, counted from the toe, that is clear of the face in slope row j.
  pure integer function first_clear_column(g, j) result(column)
    type(lattice_t), intent(in) :: g
    integer, intent(in) :: j
    integer :: tenths

    tenths = 10*g%n2*j + clearance*g%ns
    column = (tenths + modulo(-tenths, 10*g%ns))/(10*g%ns)
  end function first_clear_column

  !> Elements between a line and the next, whose first nodes pair up; the second may be one longer.
  pure subroutine join_lines(mesh, n_element, a, n_a, b, n_b, flip)
    type(mesh_t), intent(inout) :: mesh
    integer, intent(inout) :: n_element
    integer, intent(in) :: a, n_a !! first node and number of nodes of the shorter line
    integer, intent(in) :: b, n_b !! the same of the other line
    logical, intent(in) :: flip   !! counter-clockwise means the other way round
    integer :: k

    do k = 0, n_a - 2
      call add_element(mesh, n_element, [a + k, b + k, b + k + 1, a + k + 1], flip)
    end do
    if (n_b > n_a) call add_element(mesh, n_element, [a + n_a - 1, b + n_a - 1, b + n_a], flip)
  end subroutine join_lines

  !> Append an element, in reverse order of its nodes when `flip` is set.
  pure subroutine add_element(mesh, n_element, nodes, flip)
    type(mesh_t), intent(inout) :: mesh
    integer, intent(inout) :: n_element
    integer, intent(in) :: nodes(:)
    logical, intent(in) :: flip
    integer :: first, n

    n = size(nodes)
    n_element = n_element + 1
    first = mesh%element_offset(n_element)
    mesh%element_nodes(first:first+n-1) = nodes
    if (flip) mesh%element_nodes(first:first+n-1) = nodes(n:1:-1)
    mesh%element_offset(n_element+1) = first + n
  end subroutine add_element

  !> Room for a full lattice of n nodes; there are no more elements than nodes.
  pure subroutine allocate_for(mesh, n)
    type(mesh_t), intent(inout) :: mesh
    integer, intent(in) :: n

    allocate (mesh%x(2, n), mesh%element_offset(n+1), mesh%element_nodes(4*n))
    mesh%element_offset(1) = 1
  end subroutine allocate_for

  !> Abscissa of lattice column i = 0, 1, ...; without columns under the face the part right of
  !> the toe is uniform.
  pure real(dp) function lattice_x(g, i) result(x)
    type(lattice_t), intent(in) :: g
    integer, intent(in) :: i
    real(dp) :: corner

    corner = g%crest(1)
    if (g%n2 == 0) corner = g%toe(1)
    if (i > g%n1 + g%n2) then
      x = corner + (g%right - corner)*(real(i - g%n1 - g%n2, dp)/real(g%n3, dp))
    else if (i > g%n1) then
      x = g%toe(1) + (corner - g%toe(1))*(real(i - g%n1, dp)/real(g%n2, dp))
    else
      x = g%toe(1)*(real(i, dp)/real(max(g%n1, 1), dp))
      if (i == g%n1) x = g%toe(1)
    end if
  end function lattice_x

  !> Elevation of lattice row j = 0, 1, ...
  pure real(dp) function lattice_y(g, j) result(y)
    type(lattice_t), intent(in) :: g
    integer, intent(in) :: j

    if (j > g%nb) then
      y = g%toe(2) + (g%crest(2) - g%toe(2))*(real(j - g%nb, dp)/real(g%ns, dp))
    else
      y = g%toe(2)*(real(j, dp)/real(max(g%nb, 1), dp))
      if (j == g%nb) y = g%toe(2)
    end if
  end function lattice_y

  !> The face is the edges on the line from toe to crest corner; level ground on either side is top.
  pure subroutine tag_boundary(mesh, g)
    type(mesh_t), intent(inout) :: mesh
    type(lattice_t), intent(in) :: g
    real(dp) :: middle(2), along(2), from_toe(2)
    integer :: i

    call mesh_tag_sides(mesh)
    along = g%crest - g%toe
    do i = 1, size(mesh%boundary_tag)
      middle = 0.5_dp*(mesh%x(:, mesh%boundary_edge(1, i)) + mesh%x(:, mesh%boundary_edge(2, i)))
      from_toe = middle - g%toe
      if (abs(along(1)*from_toe(2) - along(2)*from_toe(1)) > 1.0e-9_dp*sum(along**2)) cycle
      if (from_toe(2) > 0.0_dp .and. middle(2) < g%crest(2)) mesh%boundary_tag(i) = tag_face
    end do
  end subroutine tag_boundary
end module talus_mesh_slope
