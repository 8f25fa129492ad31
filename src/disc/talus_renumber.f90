! SPDX-License-Identifier: MIT
!> Nodes in reverse Cuthill-McKee order: neighbours close in memory and a narrow band.
module talus_renumber
  use talus_nodes, only: mesh_t, mesh_bandwidth
  implicit none
  private
  public :: mesh_renumber, mesh_graph, cuthill_mckee

contains

  !> Renumber nodes by reverse Cuthill-McKee unless their present order has the narrower band, and
  !> elements and boundary edges by their first node.
  pure subroutine mesh_renumber(mesh, old_number)
    type(mesh_t), intent(inout) :: mesh
    integer, allocatable, intent(out) :: old_number(:) !! earlier number of each node, (n)
    integer, allocatable :: offset(:), neighbour(:), new_number(:)
    integer :: i, n

    n = size(mesh%x, 2)
    call mesh_graph(mesh, offset, neighbour)
    call cuthill_mckee(offset, neighbour, old_number)
    old_number = old_number(n:1:-1)
    allocate (new_number(n))
    new_number(old_number) = [(i, i=1, n)]
    if (graph_bandwidth(offset, neighbour, new_number) >= mesh_bandwidth(mesh)) then
      old_number = [(i, i=1, n)]
      new_number = old_number
    end if
    mesh%x = mesh%x(:, old_number)
    if (allocated(mesh%soil)) mesh%soil = mesh%soil(old_number)
    mesh%element_nodes = new_number(mesh%element_nodes)
    call sort_elements(mesh)
    if (.not. allocated(mesh%boundary_edge)) return
    do i = 1, size(mesh%boundary_edge, 2)
      mesh%boundary_edge(:, i) = new_number(mesh%boundary_edge(:, i))
    end do
    call sort_boundary(mesh)
  end subroutine mesh_renumber

  !> Largest difference of the numbers of two neighbours.
  pure integer function graph_bandwidth(offset, neighbour, number) result(width)
    integer, intent(in) :: offset(:), neighbour(:) !! graph by rows
    integer, intent(in) :: number(:)               !! number of each node
    integer :: i, k

    width = 0
    do i = 1, size(number)
      do k = offset(i), offset(i+1) - 1
        width = max(width, abs(number(neighbour(k)) - number(i)))
      end do
    end do
  end function graph_bandwidth

  !> Graph of the nodes that share an element.
  pure subroutine mesh_graph(mesh, offset, neighbour)
    type(mesh_t), intent(in) :: mesh
    integer, allocatable, intent(out) :: offset(:)    !! first neighbour of each node, (n+1)
    integer, allocatable, intent(out) :: neighbour(:) !! without the node itself
    integer, allocatable :: start(:), element(:), filled(:), seen(:)
    integer :: e, i, k, m, node, n

    n = size(mesh%x, 2)
    allocate (start(n+1), filled(n), seen(n), offset(n+1), element(size(mesh%element_nodes)))
    filled = 0
    do k = 1, size(mesh%element_nodes)
      filled(mesh%element_nodes(k)) = filled(mesh%element_nodes(k)) + 1
    end do
    start(1) = 1
    do i = 1, n
      start(i+1) = start(i) + filled(i)
    end do
    filled = 0
    do e = 1, size(mesh%element_offset) - 1
      do k = mesh%element_offset(e), mesh%element_offset(e+1) - 1
        node = mesh%element_nodes(k)
        element(start(node)+filled(node)) = e
        filled(node) = filled(node) + 1
      end do
    end do
    allocate (neighbour(3*size(element)))
    seen = 0
    offset(1) = 1
    do i = 1, n
      offset(i+1) = offset(i)
      seen(i) = i
      do m = start(i), start(i+1) - 1
        e = element(m)
        do k = mesh%element_offset(e), mesh%element_offset(e+1) - 1
          node = mesh%element_nodes(k)
          if (seen(node) == i) cycle
          seen(node) = i
          neighbour(offset(i+1)) = node
          offset(i+1) = offset(i+1) + 1
        end do
      end do
    end do
    neighbour = neighbour(:offset(n+1)-1)
  end subroutine mesh_graph

  !> Cuthill-McKee order (Cuthill & McKee 1969) from a pseudo-peripheral node of each part of the
  !> graph (George & Liu 1979).
  pure subroutine cuthill_mckee(offset, neighbour, order)
    integer, intent(in) :: offset(:), neighbour(:) !! graph by rows
    integer, allocatable, intent(out) :: order(:)  !! nodes in their new order, (n)
    integer, allocatable :: stamp(:)
    integer :: i, n, first, last, trial, round, depth, deepest, root

    n = size(offset) - 1
    allocate (order(n), stamp(n))
    stamp = 0
    round = 0
    last = 0
    do i = 1, n
      if (stamp(i) /= 0) cycle
      first = last + 1
      root = i
      deepest = -1
      do trial = 1, 8
        round = round + 1
        order(first) = root
        call visit_levels(offset, neighbour, round, first, order, stamp, last, depth)
        if (depth <= deepest .or. trial == 8) exit
        deepest = depth
        root = order(last)
      end do
    end do
  end subroutine cuthill_mckee

  !> Visit a part of the graph level by level, in each row the nodes of lowest degree first.
  pure subroutine visit_levels(offset, neighbour, round, first, order, stamp, last, depth)
    integer, intent(in) :: offset(:), neighbour(:)
    integer, intent(in) :: round       !! stamp of visited nodes
    integer, intent(in) :: first       !! place of the root in `order`
    integer, intent(inout) :: order(:) !! visited nodes from `first` to `last`
    integer, intent(inout) :: stamp(:)
    integer, intent(out) :: last
    integer, intent(out) :: depth      !! levels after the root's
    integer :: head, k, p, row, node, level_end

    stamp(order(first)) = round
    last = first
    depth = 0
    level_end = first
    head = first
    do while (head <= last)
      row = last
      do k = offset(order(head)), offset(order(head)+1) - 1
        node = neighbour(k)
        if (stamp(node) == round) cycle
        stamp(node) = round
        do p = last, row + 1, -1
          if (degree(order(p)) <= degree(node)) exit
          order(p+1) = order(p)
        end do
        order(p+1) = node
        last = last + 1
      end do
      if (head == level_end .and. last > level_end) then
        depth = depth + 1
        level_end = last
      end if
      head = head + 1
    end do

  contains

    pure integer function degree(node)
      integer, intent(in) :: node

      degree = offset(node+1) - offset(node)
    end function degree
  end subroutine visit_levels

  !> Order elements by their smallest node.
  pure subroutine sort_elements(mesh)
    type(mesh_t), intent(inout) :: mesh
    integer, allocatable :: key(:), order(:), offset(:), nodes(:)
    integer :: e, i, n, first

    n = size(mesh%element_offset) - 1
    allocate (key(n), order(n), offset(n+1), nodes(size(mesh%element_nodes)))
    do e = 1, n
      key(e) = minval(mesh%element_nodes(mesh%element_offset(e):mesh%element_offset(e+1)-1))
    end do
    order = order_by_key(key, size(mesh%x, 2))
    offset(1) = 1
    do i = 1, n
      e = order(i)
      first = mesh%element_offset(e)
      offset(i+1) = offset(i) + mesh%element_offset(e+1) - first
      nodes(offset(i):offset(i+1)-1) = mesh%element_nodes(first:mesh%element_offset(e+1)-1)
    end do
    mesh%element_offset = offset
    mesh%element_nodes = nodes
  end subroutine sort_elements

  !> Order boundary edges by their first node.
  pure subroutine sort_boundary(mesh)
    type(mesh_t), intent(inout) :: mesh
    integer :: order(size(mesh%boundary_tag))

    order = order_by_key(mesh%boundary_edge(1, :), size(mesh%x, 2))
    mesh%boundary_edge = mesh%boundary_edge(:, order)
    mesh%boundary_tag = mesh%boundary_tag(order)
  end subroutine sort_boundary

  !> Stable counting sort of keys between 1 and `highest`.
  pure function order_by_key(key, highest) result(order)
    integer, intent(in) :: key(:), highest
    integer :: order(size(key))
    integer, allocatable :: place(:)
    integer :: i

    allocate (place(highest+1))
    place = 0
    do i = 1, size(key)
      place(key(i)+1) = place(key(i)+1) + 1
    end do
    do i = 2, highest + 1
      place(i) = place(i) + place(i-1)
    end do
    do i = 1, size(key)
      place(key(i)) = place(key(i)) + 1
      order(place(key(i))) = i
    end do
  end function order_by_key
end module talus_renumber
