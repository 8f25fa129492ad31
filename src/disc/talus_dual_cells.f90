! SPDX-License-Identifier: MIT
!> Median-dual nodal cells (src/THEORY.md section 4.1). In each element, segments from the edge
!> midpoints to the mean of its nodes separate the cells of the edges' end nodes; on the boundary,
!> each half of an edge belongs to the cell of its nearer end. Cells tile the domain exactly.
!>
!>              d-------------c      cell of a in this element: a, m_ab, centre, m_da
!>              |      |      |      segment m_ab-centre: shared by the cells of a and b
!>              |---centre----|      half edge a-m_ab: on the boundary of the cell of a
!>              |      |      |
!>              a----m_ab-----b
module talus_dual_cells
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_set, status_failed, status_numeric
  use talus_text, only: text_of
  use talus_nodes, only: mesh_t, mesh_edges, mesh_next_corner
  implicit none
  private
  public :: dual_t, dual_build, dual_spacing

  type :: dual_t
    real(dp), allocatable :: area(:)             !! cell area [m2], (n)

    integer, allocatable :: segment_cell(:,:)    !! first and second cell, (2,ns)
    real(dp), allocatable :: segment_normal(:,:) !! normal times length, first to second [m], (2,ns)
    real(dp), allocatable :: segment_mid(:,:)    !! midpoint [m], (2,ns)
    integer, allocatable :: cell_offset(:)       !! first entry of each cell in cell_segment, (n+1)
    integer, allocatable :: cell_segment(:)      !! segments of a cell; negative: cell is second

    integer, allocatable :: half_offset(:)       !! first boundary half of each cell, (n+1)
    integer, allocatable :: half_node(:,:)       !! cell's own node, other end of the edge, (2,nh)
    integer, allocatable :: half_edge(:)         !! column of mesh%boundary_edge, (nh)
    real(dp), allocatable :: half_normal(:,:)    !! outward normal times length/2 [m], (2,nh)
    real(dp), allocatable :: half_mid(:,:)       !! midpoint of the half [m], (2,nh)

    integer, allocatable :: edge_node(:,:)       !! nodes of element edges, smaller first, (2,ne)
    real(dp), allocatable :: edge_normal(:,:)    !! sum of its segments' normals [m], (2,ne)
    integer, allocatable :: node_offset(:)       !! first neighbour of each node, (n+1)
    integer, allocatable :: node_neighbour(:)    !! node at the other end of the edge
    integer, allocatable :: node_edge(:)         !! the edge
    real(dp), allocatable :: node_sign(:)        !! +1 when the node is the edge's first, else -1
  end type dual_t

contains

  !> Build the cells of a mesh whose boundary is known. Fails on a cell part without area.
  pure subroutine dual_build(dual, mesh, status)
    type(dual_t), intent(out) :: dual
    type(mesh_t), intent(in) :: mesh
    type(status_t), intent(inout) :: status
    integer, allocatable :: edge_corner(:,:), corner_edge(:)

    call mesh_edges(mesh, dual%edge_node, edge_corner, corner_edge, status)
    if (status_failed(status)) return
    call build_segments(dual, mesh, corner_edge)
    call build_areas(dual, mesh, status)
    call build_halves(dual, mesh)
    call gather_lists(size(mesh%x, 2), dual%segment_cell, dual%cell_offset, dual%cell_segment)
    call build_neighbours(dual, size(mesh%x, 2))
  end subroutine dual_build

  !> One segment for each element edge, in the order of the element corners.
  pure subroutine build_segments(dual, mesh, corner_edge)
    type(dual_t), intent(inout) :: dual
    type(mesh_t), intent(in) :: mesh
    integer, intent(in) :: corner_edge(:)
    real(dp) :: centre(2), middle(2), along(2)
    integer :: e, k, a, b, edge

    allocate (dual%segment_cell(2, size(corner_edge)), dual%segment_normal(2, size(corner_edge)))
    allocate (dual%segment_mid(2, size(corner_edge)))
    allocate (dual%edge_normal(2, size(dual%edge_node, 2)))
    dual%edge_normal = 0.0_dp
    do e = 1, size(mesh%element_offset) - 1
      centre = element_centre(mesh, e)
      do k = mesh%element_offset(e), mesh%element_offset(e+1) - 1
        a = mesh%element_nodes(k)
        b = mesh%element_nodes(mesh_next_corner(mesh, e, k))
        edge = corner_edge(k)
        middle = 0.5_dp*(mesh%x(:, a) + mesh%x(:, b))
        along = centre - middle
        dual%segment_cell(:, k) = [a, b]
        dual%segment_normal(:, k) = [along(2), -along(1)]
        dual%segment_mid(:, k) = 0.5_dp*(centre + middle)
        dual%edge_normal(:, edge) = dual%edge_normal(:, edge) &
          + merge(1.0_dp, -1.0_dp, a == dual%edge_node(1, edge))*dual%segment_normal(:, k)
      end do
    end do
  end subroutine build_segments

  !> Cell areas as sums of corner quadrilaterals, by their diagonals' cross product.
  pure subroutine build_areas(dual, mesh, status)
    type(dual_t), intent(inout) :: dual
    type(mesh_t), intent(in) :: mesh
    type(status_t), intent(inout) :: status
    real(dp) :: diagonal(2), across(2), part
    integer :: e, k, node, next, previous

    allocate (dual%area(size(mesh%x, 2)))
    dual%area = 0.0_dp
    do e = 1, size(mesh%element_offset) - 1
      previous = mesh%element_nodes(mesh%element_offset(e+1)-1)
      do k = mesh%element_offset(e), mesh%element_offset(e+1) - 1
        node = mesh%element_nodes(k)
        next = mesh%element_nodes(mesh_next_corner(mesh, e, k))
        diagonal = element_centre(mesh, e) - mesh%x(:, node)
        across = 0.5_dp*(mesh%x(:, previous) - mesh%x(:, next))
        part = 0.5_dp*(diagonal(1)*across(2) - diagonal(2)*across(1))
        if (.not. part > 0.0_dp) call status_set(status, status_numeric, 'the cell of node '// &
          text_of(node)//' has no area in element '//text_of(e)//': elements must be convex')
        dual%area(node) = dual%area(node) + part
        previous = node
      end do
    end do
  end subroutine build_areas

  !> The two halves of every boundary edge, sorted by cell.
  pure subroutine build_halves(dual, mesh)
    type(dual_t), intent(inout) :: dual
    type(mesh_t), intent(in) :: mesh
    real(dp) :: along(2)
    integer, allocatable :: entry(:)
    integer :: i, j, n_half, own, other

    n_half = 2*size(mesh%boundary_edge, 2)
    allocate (dual%half_node(2, n_half), dual%half_edge(n_half), dual%half_normal(2, n_half))
    allocate (dual%half_mid(2, n_half))
    call gather_lists(size(mesh%x, 2), mesh%boundary_edge, dual%half_offset, entry)
    do i = 1, n_half
      j = abs(entry(i))
      own = mesh%boundary_edge(merge(1, 2, entry(i) > 0), j)
      other = mesh%boundary_edge(merge(2, 1, entry(i) > 0), j)
      along = mesh%x(:, mesh%boundary_edge(2, j)) - mesh%x(:, mesh%boundary_edge(1, j))
      dual%half_node(:, i) = [own, other]
      dual%half_edge(i) = j
      dual%half_normal(:, i) = 0.5_dp*[along(2), -along(1)]
      dual%half_mid(:, i) = 0.75_dp*mesh%x(:, own) + 0.25_dp*mesh%x(:, other)
    end do
  end subroutine build_halves

  !> Edges around each node, in the order of their other ends.
  pure subroutine build_neighbours(dual, n)
    type(dual_t), intent(inout) :: dual
    integer, intent(in) :: n
    integer, allocatable :: entry(:)
    integer :: i, k, p, edge, way

    call gather_lists(n, dual%edge_node, dual%node_offset, entry)
    allocate (dual%node_neighbour(size(entry)), dual%node_edge(size(entry)))
    allocate (dual%node_sign(size(entry)))
    do i = 1, n
      do k = dual%node_offset(i), dual%node_offset(i+1) - 1
        way = merge(2, 1, entry(k) > 0)
        edge = abs(entry(k))
        do p = k - 1, dual%node_offset(i), -1
          if (dual%node_neighbour(p) < dual%edge_node(way, edge)) exit
          dual%node_neighbour(p+1) = dual%node_neighbour(p)
          dual%node_edge(p+1) = dual%node_edge(p)
          dual%node_sign(p+1) = dual%node_sign(p)
        end do
        dual%node_neighbour(p+1) = dual%edge_node(way, edge)
        dual%node_edge(p+1) = edge
        dual%node_sign(p+1) = merge(1.0_dp, -1.0_dp, entry(k) > 0)
      end do
    end do
  end subroutine build_neighbours

  !> For each node, the pairs it belongs to: +pair as the first, -pair as the second of it.
  pure subroutine gather_lists(n, pairs, offset, list)
    integer, intent(in) :: n                       !! number of nodes
    integer, intent(in) :: pairs(:,:)              !! nodes, (2,np)
    integer, allocatable, intent(out) :: offset(:) !! first entry of each node, (n+1)
    integer, allocatable, intent(out) :: list(:)   !! signed pair numbers, ascending in size
    integer, allocatable :: filled(:)
    integer :: i, k, node

    allocate (offset(n+1), filled(n), list(2*size(pairs, 2)))
    filled = 0
    do i = 1, size(pairs, 2)
      filled(pairs(:, i)) = filled(pairs(:, i)) + 1
    end do
    offset(1) = 1
    do i = 1, n
      offset(i+1) = offset(i) + filled(i)
    end do
    filled = 0
    do i = 1, size(pairs, 2)
      do k = 1, 2
        node = pairs(k, i)
        list(offset(node)+filled(node)) = merge(i, -i, k == 1)
        filled(node) = filled(node) + 1
      end do
    end do
  end subroutine gather_lists

  !> Mean of an element's nodes [m].
  pure function element_centre(mesh, e) result(centre)
    type(mesh_t), intent(in) :: mesh
    integer, intent(in) :: e
    real(dp) :: centre(2)
    integer :: k

    centre = 0.0_dp
    do k = mesh%element_offset(e), mesh%element_offset(e+1) - 1
      centre = centre + mesh%x(:, mesh%element_nodes(k))
    end do
    centre = centre/real(mesh%element_offset(e+1) - mesh%element_offset(e), dp)
  end function element_centre

  !> Local node spacing [m], (n): root mean square length of the element edges at each node. It is
  !> the grid spacing on a square grid, at its boundary and corners too, where cells are smaller.
  pure function dual_spacing(dual, mesh) result(spacing)
    type(dual_t), intent(in) :: dual
    type(mesh_t), intent(in) :: mesh
    real(dp) :: spacing(size(mesh%x, 2))
    integer :: i, k, n

    do i = 1, size(spacing)
      spacing(i) = 0.0_dp
      n = dual%node_offset(i+1) - dual%node_offset(i)
      do k = dual%node_offset(i), dual%node_offset(i+1) - 1
        spacing(i) = spacing(i) + sum((mesh%x(:, dual%node_neighbour(k)) - mesh%x(:, i))**2)
      end do
      spacing(i) = sqrt(spacing(i)/real(n, dp))
    end do
  end function dual_spacing
end module talus_dual_cells
