! SPDX-License-Identifier: MIT
!> Named parts of the boundary as node lists with reference normals.
module talus_boundary_sets
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_set, status_deck
  use talus_nodes, only: mesh_t, tag_left, tag_right, tag_bottom, tag_top, tag_face
  use talus_dual_cells, only: dual_t
  implicit none
  private
  public :: boundary_set_t, boundary_set_build

  !> Names that boundary_set_build knows.
  character(*), parameter, public :: boundary_names = 'left|right|bottom|top|face|surface|all|box'

  !> The halves of node(i) are half(half_offset(i):half_offset(i+1)-1); all sums are over them.
  type :: boundary_set_t
    integer, allocatable :: node(:)        !! nodes, ascending, (m)
    real(dp), allocatable :: normal(:,:)   !! outward normal times length, reference [m], (2,m)
    real(dp), allocatable :: length(:)     !! boundary length of the node [m], (m)
    integer, allocatable :: half_offset(:) !! first half of each node, (m+1)
    integer, allocatable :: half(:)        !! boundary halves of the nodal cells, see dual_t
  end type boundary_set_t

contains

  !> Collect a part of the boundary by its name: `top` is all level ground, also left of the toe;
  !> `surface` is top and face, all that rain sees; `all` is the whole boundary; `box` is every
  !> node in a rectangle, interior nodes included, with the boundary edges that lie in it.
  !> Fails when the part is empty.
  pure subroutine boundary_set_build(set, mesh, dual, where, box, status)
    type(boundary_set_t), intent(out) :: set
    type(mesh_t), intent(in) :: mesh
    type(dual_t), intent(in) :: dual
    character(*), intent(in) :: where !! one of boundary_names
    real(dp), intent(in) :: box(4)    !! from_x, to_x, from_y, to_y [m]; used by `box` only
    type(status_t), intent(inout) :: status
    logical, allocatable :: chosen(:), inside(:)

    allocate (inside(size(mesh%x, 2)))
    inside = .false.
    select case (where)
    case ('left')
      chosen = mesh%boundary_tag == tag_left
    case ('right')
      chosen = mesh%boundary_tag == tag_right
    case ('bottom')
      chosen = mesh%boundary_tag == tag_bottom
    case ('top')
      chosen = mesh%boundary_tag == tag_top
    case ('face')
      chosen = mesh%boundary_tag == tag_face
    case ('surface')
      chosen = mesh%boundary_tag == tag_top .or. mesh%boundary_tag == tag_face
    case ('all')
      allocate (chosen(size(mesh%boundary_tag)))
      chosen = .true.
    case ('box')
      inside = nodes_inside(mesh, box)
      chosen = inside(mesh%boundary_edge(1, :)) .and. inside(mesh%boundary_edge(2, :))
    case default
      call status_set(status, status_deck, 'boundary: where = "'//trim(where)// &
        '" is not one of '//boundary_names)
      return
    end select
    call collect(set, dual, chosen, inside)
    if (size(set%node) == 0) call status_set(status, status_deck, 'boundary: where = "'// &
      trim(where)//'": this model has no nodes there')
  end subroutine boundary_set_build

  !> Nodes in a rectangle, with room for round-off.
  pure function nodes_inside(mesh, box) result(inside)
    type(mesh_t), intent(in) :: mesh
    real(dp), intent(in) :: box(4)
    logical :: inside(size(mesh%x, 2))
    real(dp) :: margin

    margin = 1.0e-9_dp*maxval(maxval(mesh%x, dim=2) - minval(mesh%x, dim=2))
    inside = mesh%x(1, :) >= box(1) - margin .and. mesh%x(1, :) <= box(2) + margin .and. &
             mesh%x(2, :) >= box(3) - margin .and. mesh%x(2, :) <= box(4) + margin
  end function nodes_inside

  !> Nodes of the chosen edges and the other nodes asked for, with the halves of the chosen edges.
  pure subroutine collect(set, dual, chosen, inside)
    type(boundary_set_t), intent(inout) :: set
    type(dual_t), intent(in) :: dual
    logical, intent(in) :: chosen(:) !! by boundary edge
    logical, intent(in) :: inside(:) !! by node
    logical, allocatable :: member(:)
    integer :: i, k, m, n_half

    allocate (member, source=inside)
    member(pack(dual%half_node(1, :), chosen(dual%half_edge))) = .true.
    m = count(member)
    set%node = pack([(i, i=1, size(member))], member)
    allocate (set%normal(2, m), set%length(m), set%half_offset(m+1))
    allocate (set%half(count(chosen(dual%half_edge))))
    n_half = 0
    set%half_offset(1) = 1
    do i = 1, m
      set%normal(:, i) = 0.0_dp
      set%length(i) = 0.0_dp
      do k = dual%half_offset(set%node(i)), dual%half_offset(set%node(i)+1) - 1
        if (.not. chosen(dual%half_edge(k))) cycle
        n_half = n_half + 1
        set%half(n_half) = k
        set%normal(:, i) = set%normal(:, i) + dual%half_normal(:, k)
        set%length(i) = set%length(i) + norm2(dual%half_normal(:, k))
      end do
      set%half_offset(i+1) = n_half + 1
    end do
  end subroutine collect
end module talus_boundary_sets
