! SPDX-License-Identifier: MIT
!> Boundary conditions of one stage: what holds, drives and loads the nodes, and where water comes
!> and goes.
module talus_conditions
  use talus_kinds, only: dp
  use talus_disc, only: disc_t
  use talus_boundary_sets, only: boundary_set_t
  use talus_rain, only: rain_t
  use talus_homogeneous_motion, only: motion_map, motion_velocity_about
  implicit none
  private
  public :: conditions_t, inlets_t, conditions_allocate, conditions_hold, conditions_load
  public :: conditions_deform, conditions_follow, conditions_floor, floor_t
  public :: conditions_support, conditions_reaction
  public :: inlet_paint_t, inlets_start, inlets_paint, inlets_finish, inlets_catch, inlets_rules

  integer, parameter, public :: inlet_none = 0, inlet_head = 1, inlet_flux = 2, inlet_rain = 3, &
    inlet_seepage = 4

  !> Where water crosses the boundary. The halves of inlet i are half(offset(i):offset(i+1)-1). A
  !> node where rains or fluxes of several boundaries meet has an inlet of each; the last one rules
  !> it, and every rain there has its limit.
  type :: inlets_t
    integer, allocatable :: node(:)      !! boundary node of each inlet, ascending, (m)
    integer, allocatable :: kind(:)      !! one of inlet_*, (m)
    real(dp), allocatable :: value(:)    !! head [m], inward flux [m/s] or pressure [Pa], (m)
    integer, allocatable :: rain(:)      !! number of its rain, 0 for none, (m)
    integer, allocatable :: offset(:)    !! (m+1)
    integer, allocatable :: half(:)      !! boundary halves, see dual_t
    type(rain_t), allocatable :: rains(:)
  end type inlets_t

  !> Ground that nodes may land on; a node may be named more than once.
  type :: floor_t
    integer, allocatable :: node(:)   !! (m)
    real(dp), allocatable :: level(:) !! elevation y [m], (m)
  end type floor_t

  !> Nodes that a named boundary holds or drives, for its reaction.
  type :: support_t
    character(:), allocatable :: name
    logical, allocatable :: held(:,:)    !! in this direction, (2,n)
  end type support_t

  type :: conditions_t
    logical, allocatable :: held(:,:)    !! displacement is prescribed, (2,n)
    real(dp), allocatable :: given(:,:)  !! prescribed velocity [m/s], (2,n)
    logical :: driven = .false.          !! some prescribed velocity is not zero
    real(dp), allocatable :: traction(:,:) !! dead load on the boundary [N/m], (2,n)
    ! Homogeneous motions; allocated where the stage has one.
    integer, allocatable :: motion(:)      !! number of a node's motion, 0 for none, (n)
    real(dp), allocatable :: gradient(:,:) !! velocity gradient xx, xy, yx, yy [1/s], (4,motions)
    real(dp), allocatable :: centre(:,:)   !! fixed point [m], (2,motions)
    type(floor_t), allocatable :: floor    !! allocated where the stage has one
    type(support_t), allocatable :: support(:) !! of the named boundaries that act in the stage
    type(inlets_t) :: inlets
  end type conditions_t

  !> A water condition on a set.
  type :: layer_t
    integer :: set      !! its number
    integer :: kind     !! one of inlet_*
    integer :: rain     !! number of its rain, 0 for none
    real(dp) :: value   !! head [m], inward flux [m/s] or greatest pressure [Pa]
  end type layer_t

  !> Inlets while boundaries are laid over each other.
  type :: inlet_paint_t
    type(layer_t), allocatable :: layer(:) !! in the order that they were laid in
    integer, allocatable :: last(:)        !! layer laid last over each node, 0 for none, (n)
  end type inlet_paint_t

contains

  !> No supports and no loads.
  subroutine conditions_allocate(conditions, n)
    type(conditions_t), intent(out) :: conditions
    integer, intent(in) :: n !! nodes

    allocate (conditions%held(2, n), source=.false.)
    allocate (conditions%given(2, n), conditions%traction(2, n), source=0.0_dp)
    allocate (conditions%support(0))
  end subroutine conditions_allocate

  !> Remember what a named boundary holds, so that its reaction can be asked for. Boundaries of the
  !> same name count as one.
  pure subroutine conditions_support(conditions, set, name, along)
    type(conditions_t), intent(inout) :: conditions
    type(boundary_set_t), intent(in) :: set
    character(*), intent(in) :: name
    logical, intent(in) :: along(2) !! directions held or driven
    type(support_t) :: support
    integer :: i, j

    do i = 1, size(conditions%support)
      if (conditions%support(i)%name == name) exit
    end do
    if (i > size(conditions%support)) then
      support%name = name
      allocate (support%held(2, size(conditions%held, 2)), source=.false.)
      conditions%support = [conditions%support, support]
    end if
    do j = 1, 2
      if (along(j)) conditions%support(i)%held(j, set%node) = .true.
    end do
  end subroutine conditions_support

  !> Force that a named boundary exerts on the soil by holding or driving it [N/m]; none where it
  !> does not act.
  pure function conditions_reaction(conditions, name, force) result(reaction)
    type(conditions_t), intent(in) :: conditions
    character(*), intent(in) :: name
    real(dp), intent(in) :: force(:,:) !! out-of-balance force of the nodes [N/m], (2,n)
    real(dp) :: reaction(2)
    integer :: i

    reaction = 0.0_dp
    if (.not. allocated(conditions%support)) return
    do i = 1, size(conditions%support)
      if (conditions%support(i)%name == name) &
        reaction = -sum(force, dim=2, mask=conditions%support(i)%held)
    end do
  end function conditions_reaction

  !> Hold or drive one direction of the nodes of a set.
  pure subroutine conditions_hold(conditions, set, direction, velocity)
    type(conditions_t), intent(inout) :: conditions
    type(boundary_set_t), intent(in) :: set
    integer, intent(in) :: direction !! 1 for x, 2 for y
    real(dp), intent(in) :: velocity !! [m/s], 0 to hold

    conditions%held(direction, set%node) = .true.
    conditions%given(direction, set%node) = velocity
    if (allocated(conditions%motion)) conditions%motion(set%node) = 0
    if (abs(velocity) > 0.0_dp) conditions%driven = .true.
  end subroutine conditions_hold

  !> Let the nodes of a set follow a homogeneous motion, in place of what was prescribed for them.
  subroutine conditions_deform(conditions, set, gradient, centre)
    type(conditions_t), intent(inout) :: conditions
    type(boundary_set_t), intent(in) :: set
    real(dp), intent(in) :: gradient(4) !! of velocity, xx, xy, yx, yy [1/s]
    real(dp), intent(in) :: centre(2)   !! fixed point [m]
    integer :: i, motions

    call conditions_hold(conditions, set, 1, 0.0_dp)
    call conditions_hold(conditions, set, 2, 0.0_dp)
    if (.not. allocated(conditions%motion)) then
      allocate (conditions%motion(size(conditions%held, 2)), source=0)
      allocate (conditions%gradient(4, 0), conditions%centre(2, 0))
    end if
    motions = size(conditions%gradient, 2) + 1
    conditions%gradient = reshape([(conditions%gradient(:, i), i=1, motions - 1), gradient], &
                                  [4, motions])
    conditions%centre = reshape([(conditions%centre(:, i), i=1, motions - 1), centre], &
                                [2, motions])
    conditions%motion(set%node) = motions
    conditions%driven = .true.
  end subroutine conditions_deform

  !> Velocities of one step that take nodes to where their homogeneous motion takes them in a time:
  !> the step itself, or a share of a storm step.
  pure subroutine conditions_follow(conditions, x, u, time, step, v)
    type(conditions_t), intent(in) :: conditions
    real(dp), intent(in) :: x(:,:)    !! reference places [m], (2,n)
    real(dp), intent(in) :: u(:,:)    !! displacement before the step [m], (2,n)
    real(dp), intent(in) :: time      !! [s]
    real(dp), intent(in) :: step      !! [s]
    real(dp), intent(inout) :: v(:,:) !! [m/s], (2,n)
    real(dp) :: map(4, size(conditions%gradient, 2))
    integer :: i, k

    do k = 1, size(map, 2)
      map(:, k) = motion_map(conditions%gradient(:, k), time)
    end do
    do i = 1, size(conditions%motion)
      k = conditions%motion(i)
      if (k > 0) v(:, i) = motion_velocity_about(map(:, k), &
        x(:, i) - conditions%centre(:, k) + u(:, i), step)
    end do
  end subroutine conditions_follow

  !> Let the nodes of a set land on a floor: those that begin above it.
  pure subroutine conditions_floor(conditions, set, x, level)
    type(conditions_t), intent(inout) :: conditions
    type(boundary_set_t), intent(in) :: set
    real(dp), intent(in) :: x(:,:) !! reference places [m], (2,n)
    real(dp), intent(in) :: level  !! elevation y [m]
    integer, allocatable :: node(:)
    integer :: i

    if (.not. allocated(conditions%floor)) then
      allocate (conditions%floor)
      allocate (conditions%floor%node(0), conditions%floor%level(0))
    end if
    node = pack(set%node, x(2, set%node) > level)
    conditions%floor%node = [conditions%floor%node, node]
    conditions%floor%level = [conditions%floor%level, (level, i=1, size(node))]
  end subroutine conditions_floor

  !> Add tractions to the nodes of a set.
  pure subroutine conditions_load(conditions, set, traction, pressure)
    type(conditions_t), intent(inout) :: conditions
    type(boundary_set_t), intent(in) :: set
    real(dp), intent(in) :: traction(2) !! force per boundary length [Pa]
    real(dp), intent(in) :: pressure    !! normal, inward positive [Pa]
    integer :: i

    do i = 1, size(set%node)
      conditions%traction(:, set%node(i)) = conditions%traction(:, set%node(i)) &
        + traction*set%length(i) - pressure*set%normal(:, i)
    end do
  end subroutine conditions_load

  !> Start with an impermeable boundary.
  pure subroutine inlets_start(paint, n)
    type(inlet_paint_t), intent(out) :: paint
    integer, intent(in) :: n !! nodes

    allocate (paint%layer(0))
    allocate (paint%last(n), source=0)
  end subroutine inlets_start

  !> Lay a water condition over the nodes and edges of a set; it replaces what was there. Inside the
  !> body only a head makes sense: water enters and leaves through the boundary.
  pure subroutine inlets_paint(paint, set, number, kind, value, rain)
    type(inlet_paint_t), intent(inout) :: paint
    type(boundary_set_t), intent(in) :: set
    integer, intent(in) :: number  !! of the set, for inlets_finish
    integer, intent(in) :: kind    !! one of inlet_*
    real(dp), intent(in) :: value  !! head [m], inward flux [m/s] or greatest pressure [Pa]
    integer, intent(in) :: rain    !! number of its rain, 0 for none
    integer :: i

    paint%layer = [paint%layer, layer_t(number, kind, rain, value)]
    do i = 1, size(set%node)
      if (any(kind == [inlet_flux, inlet_rain, inlet_seepage]) .and. &
          set%half_offset(i+1) == set%half_offset(i)) cycle
      paint%last(set%node(i)) = size(paint%layer)
    end do
  end subroutine inlets_paint

  !> Inlets of all painted nodes. Every half brings the water of the layer that was laid over it
  !> last, so that rain is whole where two boundaries meet.
  pure subroutine inlets_finish(inlets, paint, sets, rains)
    type(inlets_t), intent(out) :: inlets
    type(inlet_paint_t), intent(in) :: paint
    type(boundary_set_t), intent(in) :: sets(:)
    type(rain_t), intent(in) :: rains(:)
    integer, allocatable :: place(:,:) !! of a node in the set of a layer, 0 for none
    integer, allocatable :: holder(:)  !! layer laid last over each half
    integer, allocatable :: layer(:), ruler(:) !! of each inlet: its own, and that of its node
    integer, allocatable :: layers(:)
    integer :: i, k, m

    allocate (place(size(paint%last), size(paint%layer)), source=0)
    allocate (holder(maxval([(maxval(sets(paint%layer(k)%set)%half), k=1, size(paint%layer))])))
    do k = 1, size(paint%layer)
      associate (set => sets(paint%layer(k)%set))
        place(set%node, k) = [(i, i=1, size(set%node))]
        holder(set%half) = k
      end associate
    end do
    m = count(place > 0)
    allocate (inlets%node(m), layer(m), ruler(m), inlets%offset(m+1), inlets%half(0))
    inlets%offset(1) = 1
    m = 0
    do i = 1, size(paint%last)
      layers = node_layers(i)
      do k = 1, size(layers)
        m = m + 1
        inlets%node(m) = i
        layer(m) = layers(k)
        ruler(m) = layers(size(layers))
        inlets%half = [inlets%half, halves(i, layers(k))]
        inlets%offset(m+1) = size(inlets%half) + 1
      end do
    end do
    inlets%node = inlets%node(:m)
    inlets%offset = inlets%offset(:m+1)
    inlets%kind = paint%layer(layer(:m))%kind
    inlets%rain = paint%layer(layer(:m))%rain
    inlets%value = merge(paint%layer(ruler(:m))%value, paint%layer(layer(:m))%value, &
                         inlets%kind == inlet_rain)
    inlets%rains = rains

  contains

    !> Halves of a node that a layer holds.
    pure function halves(i, k)
      integer, intent(in) :: i, k
      integer, allocatable :: halves(:)

      allocate (halves(0))
      if (place(i, k) == 0) return
      associate (set => sets(paint%layer(k)%set), j => place(i, k))
        halves = set%half(set%half_offset(j):set%half_offset(j+1) - 1)
      end associate
      halves = pack(halves, holder(halves) == k)
    end function halves

    !> Layers that make inlets of a node, the one that rules it last. That is the one laid last; but
    !> an impermeable one leaves it to the water of the other halves, and a flux to their rain,
    !> which has a limit. A head takes what it needs, whatever rains on it.
    pure function node_layers(i) result(layers)
      integer, intent(in) :: i
      integer, allocatable :: layers(:)
      integer :: k, rules

      allocate (layers(0))
      rules = paint%last(i)
      if (rules == 0) return
      do k = 1, paint%last(i)
        associate (kind => paint%layer(k)%kind)
          if (all(kind /= [inlet_flux, inlet_rain]) .or. size(halves(i, k)) == 0) cycle
          layers = [layers, k]
          if (paint%layer(rules)%kind == inlet_none .or. &
              (paint%layer(rules)%kind == inlet_flux .and. kind == inlet_rain)) rules = k
        end associate
      end do
      select case (paint%layer(rules)%kind)
      case (inlet_none)
        layers = layers(:0)
      case (inlet_head)
        layers = [rules]
      case default
        layers = [pack(layers, layers /= rules), rules]
      end select
    end function node_layers
  end subroutine inlets_finish

  !> Whether an inlet rules its node, as the last one there.
  pure logical function inlets_rules(inlets, k) result(rules)
    type(inlets_t), intent(in) :: inlets
    integer, intent(in) :: k !! the inlet

    rules = all(inlets%node(k+1:min(k+1, size(inlets%node))) /= inlets%node(k))
  end function inlets_rules

  !> Boundary length of each inlet in the present shape [m]: horizontal and facing up where it
  !> rains, so that rain stays rain per horizontal metre; full length for a flux.
  pure subroutine inlets_catch(inlets, disc, u, catch)
    type(inlets_t), intent(in) :: inlets
    type(disc_t), intent(in) :: disc
    real(dp), intent(in) :: u(:,:)     !! displacement [m], (2,n)
    real(dp), intent(out) :: catch(:)  !! (m)
    real(dp) :: side(2), edge(2)
    integer :: i, k, own, other

    do i = 1, size(inlets%node)
      catch(i) = 0.0_dp
      do k = inlets%offset(i), inlets%offset(i+1) - 1
        associate (half => inlets%half(k))
          own = disc%dual%half_node(1, half)
          other = disc%dual%half_node(2, half)
          side = disc%mesh%x(:, other) - disc%mesh%x(:, own)
          edge = side + u(:, other) - u(:, own)
          if (inlets%kind(i) == inlet_flux) then
            catch(i) = catch(i) + 0.5_dp*norm2(edge)
          else
            ! The edge turns with the soil; its outward side is known in the reference.
            side = [side(2), -side(1)]
            catch(i) = catch(i) + max(0.0_dp, -0.5_dp*edge(1) &
              *sign(1.0_dp, dot_product(side, disc%dual%half_normal(:, half))))
          end if
        end associate
      end do
    end do
  end subroutine inlets_catch
end module talus_conditions
