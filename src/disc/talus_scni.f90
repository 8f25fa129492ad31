! SPDX-License-Identifier: MIT
!> First level: stabilised conforming nodal integration (src/THEORY.md (4.2)-(4.5); Chen, Wu, Yoon &
!> You 2001). The gradient at node L is the closed integral of Psi N over the boundary of its cell,
!> divided by the cell's area. Each inner segment is seen with the same values from both sides, and
!> on the outer boundary the trace is the straight line between the two nodes of the edge, so that
!>
!>   sum_I G_LI X_I = 1               (a linear field has its gradient exactly),
!>   sum_L A_L G_LI = 0, I inside     (the integration constraint: patch tests pass exactly),
!>   u on the boundary is the nodal value (essential conditions hold exactly at boundary nodes).
module talus_scni
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_set, status_failed, status_deck
  use talus_text, only: text_of
  use talus_nodes, only: mesh_t
  use talus_dual_cells, only: dual_t
  use talus_cell_list, only: cell_list_t, cell_list_build, cell_list_supports
  use talus_rk_shape, only: rk_shape
  implicit none
  private
  public :: scni_t, scni_build, scni_transpose

  !> Gather lists of the first level and of its adjoint.
  !>
  !>   cell L :  sum of b(:,k) u(:,node(k)),  k = cell_offset(L) .. cell_offset(L+1)-1
  !>   node I :  sum of P(cell(k)) bt(:,k),   k = node_offset(I) .. node_offset(I+1)-1
  type :: scni_t
    integer, allocatable :: cell_offset(:) !! first entry of each cell, (n+1)
    integer, allocatable :: node(:)        !! nodes that reach the cell, ascending
    real(dp), allocatable :: b(:,:)        !! closed integral of Psi N [m], area times gradient
    integer, allocatable :: node_offset(:) !! first entry of each node, (n+1)
    integer, allocatable :: cell(:)        !! cells that the node reaches, ascending
    real(dp), allocatable :: bt(:,:)       !! the same values, in the order of the nodes [m]
  end type scni_t

contains

  !> Build the list of the cells. Fails where too few nodes reach a segment.
  subroutine scni_build(scni, mesh, dual, support, status)
    type(scni_t), intent(out) :: scni
    type(mesh_t), intent(in) :: mesh
    type(dual_t), intent(in) :: dual
    real(dp), intent(in) :: support(:) !! support radius of each node [m], (n)
    type(status_t), intent(inout) :: status
    integer, allocatable :: reach_offset(:), reach(:)
    real(dp), allocatable :: psi(:)
    type(cell_list_t) :: list

    call cell_list_build(list, mesh%x, support)
    call cell_list_supports(list, dual%segment_mid, reach_offset, reach, status)
    if (status_failed(status)) return
    call segment_shapes(dual%segment_mid, mesh%x, support, reach_offset, reach, psi, status)
    if (status_failed(status)) return
    call gather_cells(scni, dual, reach_offset, reach, psi)
  end subroutine scni_build

  !> Shape functions at the midpoints of all inner segments.
  subroutine segment_shapes(mid, x, support, reach_offset, reach, psi, status)
    real(dp), intent(in) :: mid(:,:), x(:,:), support(:)
    integer, intent(in) :: reach_offset(:), reach(:)
    real(dp), allocatable, intent(out) :: psi(:)
    type(status_t), intent(inout) :: status
    integer :: s, first, last, bad
    logical :: regular

    allocate (psi(size(reach)))
    bad = 0
    !$omp parallel do default(none) shared(mid, x, support, reach_offset, reach, psi) &
    !$omp private(s, first, last, regular) reduction(max:bad) schedule(static)
    do s = 1, size(mid, 2)
      first = reach_offset(s)
      last = reach_offset(s+1) - 1
      call rk_shape(mid(:, s), x(:, reach(first:last)), support(reach(first:last)), &
                    psi(first:last), regular)
      if (.not. regular) bad = max(bad, s)
    end do
    !$omp end parallel do
    if (bad > 0) call status_set(status, status_deck, '&nodes support: too few nodes reach ('// &
      text_of(mid(1, bad))//', '//text_of(mid(2, bad))//') m; raise support or even out the nodes')
  end subroutine segment_shapes

  !> Sum the segments of each cell, in two passes: count, then fill.
  subroutine gather_cells(scni, dual, reach_offset, reach, psi)
    type(scni_t), intent(inout) :: scni
    type(dual_t), intent(in) :: dual
    integer, intent(in) :: reach_offset(:), reach(:)
    real(dp), intent(in) :: psi(:)
    integer, allocatable :: seen(:)
    integer :: l, n

    n = size(dual%area)
    allocate (scni%cell_offset(n+1))
    scni%cell_offset(1) = 1
    !$omp parallel default(none) shared(scni, dual, reach_offset, reach, n) private(l, seen)
    allocate (seen(n))
    seen = 0
    !$omp do schedule(static)
    do l = 1, n
      call count_cell(l, dual, reach_offset, reach, seen, scni%cell_offset(l+1))
    end do
    !$omp end do
    !$omp end parallel
    do l = 1, n
      scni%cell_offset(l+1) = scni%cell_offset(l) + scni%cell_offset(l+1)
    end do
    allocate (scni%node(scni%cell_offset(n+1)-1), scni%b(2, scni%cell_offset(n+1)-1))
    !$omp parallel default(none) shared(scni, dual, reach_offset, reach, psi, n) private(l, seen)
    allocate (seen(n))
    !$omp do schedule(static)
    do l = 1, n
      associate (first => scni%cell_offset(l), last => scni%cell_offset(l+1) - 1)
        call fill_cell(l, dual, reach_offset, reach, psi, seen, scni%node(first:last), &
                       scni%b(:, first:last))
      end associate
    end do
    !$omp end do
    !$omp end parallel
  end subroutine gather_cells

  !> Number of nodes that reach cell l. `seen` holds the last cell in which a node was met.
  pure subroutine count_cell(l, dual, reach_offset, reach, seen, found)
    integer, intent(in) :: l
    type(dual_t), intent(in) :: dual
    integer, intent(in) :: reach_offset(:), reach(:)
    integer, intent(inout) :: seen(:)
    integer, intent(out) :: found
    integer :: k, j, s

    found = 0
    do k = dual%cell_offset(l), dual%cell_offset(l+1) - 1
      s = abs(dual%cell_segment(k))
      do j = reach_offset(s), reach_offset(s+1) - 1
        if (seen(reach(j)) == l) cycle
        seen(reach(j)) = l
        found = found + 1
      end do
    end do
    do k = dual%half_offset(l), dual%half_offset(l+1) - 1
      do j = 1, 2
        if (seen(dual%half_node(j, k)) == l) cycle
        seen(dual%half_node(j, k)) = l
        found = found + 1
      end do
    end do
  end subroutine count_cell

  !> Nodes that reach cell l, ascending, and their closed integrals.
  pure subroutine fill_cell(l, dual, reach_offset, reach, psi, place, node, b)
    integer, intent(in) :: l
    type(dual_t), intent(in) :: dual
    integer, intent(in) :: reach_offset(:), reach(:)
    real(dp), intent(in) :: psi(:)
    integer, intent(inout) :: place(:) !! work: place of a node in `node`
    integer, intent(out) :: node(:)
    real(dp), intent(out) :: b(:,:)
    integer :: k, j, s, found
    real(dp) :: way

    call list_cell(l, dual, reach_offset, reach, node, found)
    do j = 1, found
      place(node(j)) = j
    end do
    b = 0.0_dp
    do k = dual%cell_offset(l), dual%cell_offset(l+1) - 1
      s = abs(dual%cell_segment(k))
      way = real(sign(1, dual%cell_segment(k)), dp)
      do j = reach_offset(s), reach_offset(s+1) - 1
        associate (p => place(reach(j)))
          b(:, p) = b(:, p) + way*psi(j)*dual%segment_normal(:, s)
        end associate
      end do
    end do
    do k = dual%half_offset(l), dual%half_offset(l+1) - 1
      associate (own => place(dual%half_node(1, k)), other => place(dual%half_node(2, k)))
        b(:, own) = b(:, own) + 0.75_dp*dual%half_normal(:, k)
        b(:, other) = b(:, other) + 0.25_dp*dual%half_normal(:, k)
      end associate
    end do
  end subroutine fill_cell

  !> The distinct nodes that reach cell l, ascending (insertion into a short sorted list).
  pure subroutine list_cell(l, dual, reach_offset, reach, node, found)
    integer, intent(in) :: l
    type(dual_t), intent(in) :: dual
    integer, intent(in) :: reach_offset(:), reach(:)
    integer, intent(inout) :: node(:)
    integer, intent(out) :: found
    integer :: k, j, s

    found = 0
    do k = dual%cell_offset(l), dual%cell_offset(l+1) - 1
      s = abs(dual%cell_segment(k))
      do j = reach_offset(s), reach_offset(s+1) - 1
        call insert(node, found, reach(j))
      end do
    end do
    do k = dual%half_offset(l), dual%half_offset(l+1) - 1
      call insert(node, found, dual%half_node(1, k))
      call insert(node, found, dual%half_node(2, k))
    end do
  end subroutine list_cell

  pure subroutine insert(list, found, item)
    integer, intent(inout) :: list(:)
    integer, intent(inout) :: found
    integer, intent(in) :: item
    integer :: p

    do p = found, 1, -1
      if (list(p) == item) return
      if (list(p) < item) exit
    end do
    list(p+2:found+1) = list(p+1:found)
    list(p+1) = item
    found = found + 1
  end subroutine insert

  !> The list of the adjoint, which forces need: for each node the cells it reaches.
  pure subroutine scni_transpose(scni)
    type(scni_t), intent(inout) :: scni
    integer, allocatable :: filled(:)
    integer :: l, k, n

    n = size(scni%cell_offset) - 1
    allocate (scni%node_offset(n+1), filled(n))
    allocate (scni%cell(size(scni%node)), scni%bt(2, size(scni%node)))
    filled = 0
    do k = 1, size(scni%node)
      filled(scni%node(k)) = filled(scni%node(k)) + 1
    end do
    scni%node_offset(1) = 1
    do l = 1, n
      scni%node_offset(l+1) = scni%node_offset(l) + filled(l)
    end do
    filled = 0
    do l = 1, n
      do k = scni%cell_offset(l), scni%cell_offset(l+1) - 1
        associate (p => scni%node_offset(scni%node(k)) + filled(scni%node(k)))
          scni%cell(p) = l
          scni%bt(:, p) = scni%b(:, k)
        end associate
        filled(scni%node(k)) = filled(scni%node(k)) + 1
      end do
    end do
  end subroutine scni_transpose
end module talus_scni
