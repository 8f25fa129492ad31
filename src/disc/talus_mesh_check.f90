! SPDX-License-Identifier: MIT
!> Is a mesh from elsewhere fit to build nodal cells on? Boundaries that touch betray hanging
!> nodes, nodes in the same place and overlapping elements, whatever their cause.
module talus_mesh_check
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_set, status_deck, status_failed
  use talus_text, only: text_of
  use talus_nodes, only: mesh_t
  use talus_cell_list, only: cell_list_t, cell_list_build, cell_list_supports
  implicit none
  private
  public :: mesh_check_boundary

  !> Distance over edge length below which boundary edges touch.
  real(dp), parameter :: touching = 1.0e-6_dp

contains

  !> Fails when a node has more than two boundary edges, or boundary edges touch or cross.
  subroutine mesh_check_boundary(mesh, status)
    type(mesh_t), intent(in) :: mesh !! with its boundary known
    type(status_t), intent(inout) :: status
    type(cell_list_t) :: list
    real(dp), allocatable :: middle(:,:), reach(:)
    integer, allocatable :: offset(:), near(:)
    real(dp) :: along(2)
    integer :: i, k, n

    n = size(mesh%boundary_edge, 2)
    allocate (middle(2, n), reach(n))
    do i = 1, n
      along = mesh%x(:, mesh%boundary_edge(2, i)) - mesh%x(:, mesh%boundary_edge(1, i))
      middle(:, i) = mesh%x(:, mesh%boundary_edge(1, i)) + 0.5_dp*along
      reach(i) = norm2(along)
    end do
    reach = (0.5_dp + touching)*(reach + maxval(reach))
    call cell_list_build(list, middle, reach)
    call cell_list_supports(list, middle, offset, near, status)
    if (status_failed(status)) return
    do i = 1, n
      do k = offset(i), offset(i+1) - 1
        if (near(k) <= i) cycle
        if (.not. edges_touch(mesh, mesh%boundary_edge(:, i), mesh%boundary_edge(:, near(k)))) cycle
        call status_set(status, status_deck, 'the boundary edges of nodes '// &
          pair_text(mesh%boundary_edge(:, i))//' and '// &
          pair_text(mesh%boundary_edge(:, near(k)))// &
          ' touch: a hanging node, two nodes at one place, or overlapping elements. '// &
          'Neighbouring elements must share whole edges and their nodes')
      end do
    end do
    call check_corners(mesh, status)
  end subroutine mesh_check_boundary

  pure function pair_text(pair) result(text)
    integer, intent(in) :: pair(2)
    character(:), allocatable :: text

    text = text_of(pair(1))//'-'//text_of(pair(2))
  end function pair_text

  !> Every boundary node must have just one boundary edge coming in and one going out.
  subroutine check_corners(mesh, status)
    type(mesh_t), intent(in) :: mesh
    type(status_t), intent(inout) :: status
    integer, allocatable :: uses(:)
    integer :: i

    allocate (uses(size(mesh%x, 2)))
    uses = 0
    do i = 1, size(mesh%boundary_edge, 2)
      uses(mesh%boundary_edge(:, i)) = uses(mesh%boundary_edge(:, i)) + 1
    end do
    do i = 1, size(uses)
      if (uses(i) > 2) call status_set(status, status_deck, 'node '//text_of(i)//' has '// &
        text_of(uses(i))//' boundary edges: parts of the domain may not meet in a single node')
    end do
  end subroutine check_corners

  !> True when two boundary edges touch other than end to end, or leave a node in one direction.
  pure logical function edges_touch(mesh, a, b) result(touch)
    type(mesh_t), intent(in) :: mesh
    integer, intent(in) :: a(2), b(2) !! nodes of the edges
    real(dp) :: p(2), q(2), room
    integer :: i, j

    associate (xa => mesh%x(:, a), xb => mesh%x(:, b))
      do i = 1, 2
        do j = 1, 2
          if (a(i) /= b(j)) cycle
          p = xa(:, 3-i) - xa(:, i)
          q = xb(:, 3-j) - xb(:, j)
          touch = dot_product(p, q) > 0.0_dp .and. &
            abs(p(1)*q(2) - p(2)*q(1)) < touching*norm2(p)*norm2(q)
          return
        end do
      end do
      room = touching*min(norm2(xa(:, 2) - xa(:, 1)), norm2(xb(:, 2) - xb(:, 1)))
      touch = distance(xa(:, 1), xb) < room .or. distance(xa(:, 2), xb) < room .or. &
        distance(xb(:, 1), xa) < room .or. distance(xb(:, 2), xa) < room .or. &
        (side(xa(:, 1), xb)*side(xa(:, 2), xb) < 0.0_dp .and. &
         side(xb(:, 1), xa)*side(xb(:, 2), xa) < 0.0_dp)
    end associate
  end function edges_touch

  !> Distance of a point from an edge.
  pure real(dp) function distance(point, edge)
    real(dp), intent(in) :: point(2), edge(2,2)
    real(dp) :: along(2), part

    along = edge(:, 2) - edge(:, 1)
    part = dot_product(point - edge(:, 1), along)/sum(along**2)
    distance = norm2(point - edge(:, 1) - min(1.0_dp, max(0.0_dp, part))*along)
  end function distance

  !> Sign of the side of an edge on which a point lies: +1 on its left, -1 on its right.
  pure real(dp) function side(point, edge)
    real(dp), intent(in) :: point(2), edge(2,2)

    side = sign(1.0_dp, (edge(1, 2) - edge(1, 1))*(point(2) - edge(2, 1)) &
                        - (edge(2, 2) - edge(2, 1))*(point(1) - edge(1, 1)))
  end function side
end module talus_mesh_check
