! SPDX-License-Identifier: MIT
!> Rectangular domain with a regular or graded grid of quadrilaterals.
module talus_mesh_box
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_set, status_deck
  use talus_nodes, only: mesh_t, mesh_find_boundary, mesh_tag_sides
  implicit none
  private
  public :: mesh_box, graded_points

contains

  !> Grid of round(width/spacing) by round(height/spacing_y) quadrilaterals, at least one each way.
  !> Grading changes the spacing by a constant factor from one interval to the next; `spacing` is
  !> then the mean. Nodes are numbered along the shorter direction first.
  pure subroutine mesh_box(mesh, width, height, spacing, spacing_y, grading_x, grading_y, origin, &
                           status)
    type(mesh_t), intent(out) :: mesh
    real(dp), intent(in) :: width, height !! sides of the rectangle [m], > 0
    real(dp), intent(in) :: spacing       !! node spacing along x [m], > 0
    real(dp), intent(in) :: spacing_y     !! node spacing along y [m]; 0 means `spacing`
    real(dp), intent(in) :: grading_x     !! last over first interval along x [-], > 0
    real(dp), intent(in) :: grading_y     !! last over first interval along y [-], > 0
    real(dp), intent(in) :: origin(2)     !! lower left corner [m]
    type(status_t), intent(inout) :: status
    real(dp), allocatable :: px(:), py(:)
    real(dp) :: step_y
    integer :: i, j, e, nx, ny, right, up

    step_y = merge(spacing_y, spacing, spacing_y > 0.0_dp)
    if (min(width, height, spacing, grading_x, grading_y) <= 0.0_dp) then
      call status_set(status, status_deck, &
        'box: width, height, spacing, grading_x and grading_y must be positive')
      return
    end if
    px = graded_points(width, spacing, grading_x)
    py = graded_points(height, step_y, grading_y)
    nx = size(px)
    ny = size(py)
    right = merge(1, ny, nx < ny)
    up = merge(nx, 1, nx < ny)
    allocate (mesh%x(2, nx*ny), mesh%element_offset((nx-1)*(ny-1)+1))
    allocate (mesh%element_nodes(4*(nx-1)*(ny-1)))
    do j = 0, ny - 1
      do i = 0, nx - 1
        mesh%x(:, 1+i*right+j*up) = origin + [px(i+1), py(j+1)]
      end do
    end do
    e = 0
    do j = 0, ny - 2
      do i = 0, nx - 2
        mesh%element_nodes(4*e+1:4*e+4) = 1 + i*right + j*up + [0, right, right + up, up]
        e = e + 1
      end do
    end do
    mesh%element_offset = [(4*e + 1, e=0, (nx-1)*(ny-1))]
    call mesh_find_boundary(mesh, status)
    call mesh_tag_sides(mesh)
  end subroutine mesh_box

  !> Points from 0 to `length` in round(length/spacing) intervals growing geometrically.
  pure function graded_points(length, spacing, grading) result(points)
    real(dp), intent(in) :: length        !! [m]
    real(dp), intent(in) :: spacing       !! mean interval [m]
    real(dp), intent(in) :: grading       !! last over first interval [-]
    real(dp), allocatable :: points(:)
    real(dp) :: factor, interval
    integer :: i, n

    n = max(1, nint(length/spacing))
    allocate (points(0:n))
    factor = 1.0_dp
    if (n > 1) factor = grading**(1.0_dp/real(n - 1, dp))
    if (abs(factor - 1.0_dp) < 1.0e-12_dp) then
      points = [(length*real(i, dp)/real(n, dp), i=0, n)]
      return
    end if
    points(0) = 0.0_dp
    interval = 1.0_dp
    do i = 1, n
      points(i) = points(i-1) + interval
      interval = interval*factor
    end do
    points = points*(length/points(n))
    points(n) = length
  end function graded_points
end module talus_mesh_box
