! SPDX-License-Identifier: MIT
!> Nodes, the grid that comes with them, and its boundary (src/THEORY.md section 4.1).
!> The grid serves to build the nodal cells and to draw pictures; no mesh takes part in stepping.
module talus_nodes
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_set, status_deck
  use talus_text, only: text_of
  implicit none
  private
  public :: mesh_t, mesh_edges, mesh_find_boundary, mesh_tag_sides, mesh_bandwidth
  public :: mesh_corner_jacobian, mesh_next_corner, mesh_trim_elements

  !> Where a boundary edge lies.
  integer, parameter, public :: tag_none = 0, tag_left = 1, tag_right = 2, tag_bottom = 3, &
    tag_top = 4, tag_face = 5

  !> Element e has the nodes element_nodes(element_offset(e):element_offset(e+1)-1).
  type :: mesh_t
    real(dp), allocatable :: x(:,:)            !! reference coordinates [m], (2,n)
    integer, allocatable :: element_offset(:)  !! first corner of each element, (ne+1)
    integer, allocatable :: element_nodes(:)   !! nodes, counter-clockwise, 3 or 4 an element
    integer, allocatable :: boundary_edge(:,:) !! nodes; the domain is on the left, (2,nb)
    integer, allocatable :: boundary_tag(:)    !! one of tag_*, (nb)
    integer, allocatable :: soil(:)            !! soil number of each node, (n); file meshes only
  end type mesh_t

contains

  !> The corner that follows corner k of element e, going counter-clockwise.
  pure integer function mesh_next_corner(mesh, e, k) result(next)
    type(mesh_t), intent(in) :: mesh
    integer, intent(in) :: e !! element
    integer, intent(in) :: k !! position in element_nodes

    next = k + 1
    if (next == mesh%element_offset(e+1)) next = mesh%element_offset(e)
  end function mesh_next_corner

  !> Unique element edges. Fails when an edge is used twice in the same direction: elements then
  !> overlap, or more than two of them meet at the edge.
  pure subroutine mesh_edges(mesh, edge_node, edge_corner, corner_edge, status, bad_element)
    type(mesh_t), intent(in) :: mesh
    integer, allocatable, intent(out) :: edge_node(:,:)   !! smaller node first, (2,ne)
    integer, allocatable, intent(out) :: edge_corner(:,:) !! corner going first to second node, and
                                                          !! the one going back; 0 on the boundary
    integer, allocatable, intent(out) :: corner_edge(:)   !! edge that starts at each corner
    type(status_t), intent(inout) :: status
    integer, intent(out), optional :: bad_element         !! first one to fail, or 0
    integer, allocatable :: start(:), filled(:), bucket(:), node(:,:), corner(:,:)
    integer :: e, k, p, a, b, low, high, edge, n_edge, way, bad

    call bucket_starts(mesh, start)
    allocate (filled(size(start)-1), bucket(size(mesh%element_nodes)))
    allocate (node(2, size(bucket)), corner(2, size(bucket)), corner_edge(size(bucket)))
    filled = 0
    n_edge = 0
    bad = 0
    do e = 1, size(mesh%element_offset) - 1
      do k = mesh%element_offset(e), mesh%element_offset(e+1) - 1
        a = mesh%element_nodes(k)
        b = mesh%element_nodes(mesh_next_corner(mesh, e, k))
        low = min(a, b)
        high = max(a, b)
        edge = 0
        do p = start(low), start(low) + filled(low) - 1
          if (node(2, bucket(p)) == high) edge = bucket(p)
        end do
        if (edge == 0) then
          n_edge = n_edge + 1
          edge = n_edge
          bucket(start(low)+filled(low)) = edge
          filled(low) = filled(low) + 1
          node(:, edge) = [low, high]
          corner(:, edge) = 0
        end if
        way = merge(1, 2, a == low)
        if (corner(way, edge) /= 0) then
          if (bad == 0) bad = e
          call status_set(status, status_deck, 'edge between nodes '//text_of(a)//' and '// &
            text_of(b)//': elements overlap there, or more than two of them share it')
        end if
        corner(way, edge) = k
        corner_edge(k) = edge
      end do
    end do
    edge_node = node(:, :n_edge)
    edge_corner = corner(:, :n_edge)
    if (present(bad_element)) bad_element = bad
  end subroutine mesh_edges

  !> Room for the edges that start at each node as their smaller node.
  pure subroutine bucket_starts(mesh, start)
    type(mesh_t), intent(in) :: mesh
    integer, allocatable, intent(out) :: start(:)
    integer :: e, k, low

    allocate (start(size(mesh%x, 2)+1))
    start = 0
    do e = 1, size(mesh%element_offset) - 1
      do k = mesh%element_offset(e), mesh%element_offset(e+1) - 1
        low = min(mesh%element_nodes(k), mesh%element_nodes(mesh_next_corner(mesh, e, k)))
        start(low+1) = start(low+1) + 1
      end do
    end do
    start(1) = 1
    do k = 2, size(start)
      start(k) = start(k) + start(k-1)
    end do
  end subroutine bucket_starts

  !> Fill boundary_edge with the edges that only one element uses; every tag becomes tag_none.
  pure subroutine mesh_find_boundary(mesh, status)
    type(mesh_t), intent(inout) :: mesh
    type(status_t), intent(inout) :: status
    integer, allocatable :: edge_node(:,:), edge_corner(:,:), corner_edge(:), found(:,:)
    integer :: i, n_found

    call mesh_edges(mesh, edge_node, edge_corner, corner_edge, status)
    allocate (found(2, size(edge_node, 2)))
    n_found = 0
    do i = 1, size(edge_node, 2)
      if (all(edge_corner(:, i) /= 0)) cycle
      n_found = n_found + 1
      found(:, n_found) = edge_node(:, i)
      if (edge_corner(1, i) == 0) found(:, n_found) = edge_node([2, 1], i)
    end do
    mesh%boundary_edge = found(:, :n_found)
    if (allocated(mesh%boundary_tag)) deallocate (mesh%boundary_tag)
    allocate (mesh%boundary_tag(n_found))
    mesh%boundary_tag = tag_none
  end subroutine mesh_find_boundary

  !> Tag boundary edges by place: the vertical sides of the bounding box are left and right, its
  !> lower side is bottom; of the others, level edges facing up are top, and those facing
  !> sideways or obliquely up are face. Edges facing down elsewhere keep tag_none.
  pure subroutine mesh_tag_sides(mesh)
    type(mesh_t), intent(inout) :: mesh
    real(dp) :: low(2), high(2), tolerance, along(2), middle(2), level
    integer :: i

    low = minval(mesh%x, dim=2)
    high = maxval(mesh%x, dim=2)
    tolerance = 1.0e-9_dp*maxval(high - low)
    do i = 1, size(mesh%boundary_tag)
      along = mesh%x(:, mesh%boundary_edge(2, i)) - mesh%x(:, mesh%boundary_edge(1, i))
      middle = 0.5_dp*(mesh%x(:, mesh%boundary_edge(2, i)) + mesh%x(:, mesh%boundary_edge(1, i)))
      level = 1.0e-6_dp*norm2(along)
      mesh%boundary_tag(i) = tag_none
      if (middle(1) < low(1) + tolerance) then
        mesh%boundary_tag(i) = tag_left
      else if (middle(1) > high(1) - tolerance) then
        mesh%boundary_tag(i) = tag_right
      else if (middle(2) < low(2) + tolerance) then
        mesh%boundary_tag(i) = tag_bottom
      else if (along(1) < 0.0_dp .and. abs(along(2)) <= level) then
        mesh%boundary_tag(i) = tag_top
      else if (along(1) <= level) then
        mesh%boundary_tag(i) = tag_face
      end if
    end do
  end subroutine mesh_tag_sides

  !> Smallest corner Jacobian of an element [m2]: twice the area of the triangle that a corner
  !> spans with its two neighbours. Positive in every valid element.
  pure real(dp) function mesh_corner_jacobian(mesh, e) result(smallest)
    type(mesh_t), intent(in) :: mesh
    integer, intent(in) :: e !! element
    real(dp) :: a(2), b(2)
    integer :: k, first, n

    first = mesh%element_offset(e)
    n = mesh%element_offset(e+1) - first
    smallest = huge(1.0_dp)
    do k = 0, n - 1
      associate (c => mesh%x(:, mesh%element_nodes(first+k)))
        a = mesh%x(:, mesh%element_nodes(first+modulo(k+1, n))) - c
        b = mesh%x(:, mesh%element_nodes(first+modulo(k-1, n))) - c
      end associate
      smallest = min(smallest, a(1)*b(2) - a(2)*b(1))
    end do
  end function mesh_corner_jacobian

  !> Largest difference of the numbers of two nodes of one element.
  pure integer function mesh_bandwidth(mesh) result(width)
    type(mesh_t), intent(in) :: mesh
    integer :: e

    width = 0
    do e = 1, size(mesh%element_offset) - 1
      associate (nodes => mesh%element_nodes(mesh%element_offset(e):mesh%element_offset(e+1)-1))
        width = max(width, maxval(nodes) - minval(nodes))
      end associate
    end do
  end function mesh_bandwidth

  !> Cut over-long element arrays to the elements in use.
  pure subroutine mesh_trim_elements(mesh, n_element)
    type(mesh_t), intent(inout) :: mesh
    integer, intent(in) :: n_element !! elements in use
    integer :: n_corner

    n_corner = mesh%element_offset(n_element+1) - 1
    mesh%element_nodes = mesh%element_nodes(:n_corner)
    mesh%element_offset = mesh%element_offset(:n_element+1)
  end subroutine mesh_trim_elements
end module talus_nodes
