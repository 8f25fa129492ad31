! SPDX-License-Identifier: MIT
!> Bytes that a run holds, counted from what is allocated, and those that it will write.
module talus_cost
  use talus_kinds, only: sp, dp, i8
  use talus_deck_types, only: stage_t
  use talus_session, only: session_t
  use talus_state, only: state_t
  use talus_stage_parts, only: snapshot_interval
  implicit none
  private
  public :: cost_t, cost_of, snapshots_of, snapshot_bytes, restart_bytes

  !> What HDF5 and XDMF take to describe a snapshot, as measured.
  integer(i8), parameter :: description_bytes = 20000_i8

  !> Bytes of the parts of a run.
  type :: cost_t
    integer(i8) :: cells = 0_i8     !! nodes, grid and nodal cells
    integer(i8) :: first = 0_i8     !! first level and its adjoint
    integer(i8) :: second = 0_i8    !! second level
    integer(i8) :: stabilise = 0_i8 !! pairs of the stabilisation
    integer(i8) :: state = 0_i8     !! fields, and their copy to fall back on
    integer(i8) :: step = 0_i8      !! fields within a step, and of the motion
    integer(i8) :: seepage = 0_i8   !! fluxes
    integer(i8) :: matrix = 0_i8    !! band matrix of an implicit step of the water, if one is taken
    integer(i8) :: total = 0_i8
  end type cost_t

  !> Bytes of an array, 0 when it is not allocated.
  interface bytes
    module procedure bytes_single_1, bytes_real_1, bytes_real_2, bytes_integer_1, bytes_integer_2
  end interface bytes

contains

  !> Count the bytes of a session that is ready to run.
  pure function cost_of(session) result(cost)
    type(session_t), intent(in) :: session
    type(cost_t) :: cost
    integer(i8) :: band

    associate (disc => session%disc, work => session%work)
      associate (mesh => disc%mesh, dual => disc%dual, scni => disc%scni)
        cost%cells = bytes(mesh%x) + bytes(mesh%element_offset) + bytes(mesh%element_nodes) &
          + bytes(mesh%boundary_edge) + bytes(mesh%boundary_tag) + bytes(disc%soil) &
          + bytes(dual%area) + bytes(dual%segment_cell) + bytes(dual%segment_normal) &
          + bytes(dual%segment_mid) + bytes(dual%cell_offset) + bytes(dual%cell_segment) &
          + bytes(dual%half_offset) + bytes(dual%half_node) + bytes(dual%half_edge) &
          + bytes(dual%half_normal) + bytes(dual%half_mid) + bytes(dual%edge_node) &
          + bytes(dual%edge_normal) + bytes(dual%node_offset) + bytes(dual%node_neighbour) &
          + bytes(dual%node_edge) + bytes(dual%node_sign)
        cost%first = bytes(scni%cell_offset) + bytes(scni%node) + bytes(scni%b) &
          + bytes(scni%node_offset) + bytes(scni%cell) + bytes(scni%bt)
        band = int(maxval(abs(dual%edge_node(2, :) - dual%edge_node(1, :))), i8)
      end associate
      cost%second = bytes(disc%two_level%offset) + bytes(disc%two_level%cell) &
        + bytes(disc%two_level%s) + bytes(disc%two_level%rest) + bytes(disc%two_level%plain) &
        + bytes(disc%two_level%adjoint)
      cost%stabilise = bytes(disc%stabilise%offset) + bytes(disc%stabilise%node) &
        + bytes(disc%stabilise%reach) + bytes(disc%stabilise%stiffness) &
        + bytes(disc%stabilise%level) + bytes(disc%tie%volume) + bytes(disc%tie%shear)
      ! Strength reduction also keeps the state of its mechanism.
      cost%state = merge(3_i8, 2_i8, allocated(session%reduction))*state_bytes(session%state)
      cost%step = bytes(work%y) + bytes(work%h) + bytes(work%drive) + bytes(work%q) &
        + bytes(work%stretch) + bytes(work%weighed) + bytes(work%mean) &
        + bytes(work%stabilising) + bytes(work%force) + bytes(work%pull) &
        + bytes(session%motion%pair_mass)
      ! What every stage of the soil allocates as it begins: mobility, fastest mode and its place.
      if (session%soil_moves) cost%step = cost%step + 48_i8*int(disc%n, i8)
      if (session%ground%wet) then
        ! Eleven numbers a face and six a node besides the matrix.
        cost%seepage = 8_i8*(11_i8*int(size(disc%dual%edge_node, 2), i8) + 6_i8*int(disc%n, i8))
        cost%matrix = 8_i8*(3_i8*band + 1_i8)*int(disc%n, i8)
      end if
    end associate
    cost%total = cost%cells + cost%first + cost%second + cost%stabilise + cost%state + cost%step &
      + cost%seepage + cost%matrix
  end function cost_of

  !> Snapshots that a stage writes. It looks whether one is due after each of its `looks` steps.
  pure real(dp) function snapshots_of(session, stage, looks) result(snapshots)
    type(session_t), intent(in) :: session
    type(stage_t), intent(in) :: stage
    real(dp), intent(in) :: looks

    snapshots = 1.0_dp
    if (stage%kind == 'geostatic' .or. stage%kind == 'strength_reduction') return
    ! At the start, then one for each interval; the last of them is that of the end.
    snapshots = 1.0_dp + max(1.0_dp, min(looks, stage%duration/snapshot_interval(session, stage)))
  end function snapshots_of

  !> Bytes of the fields of one snapshot.
  pure integer(i8) function snapshot_bytes(session) result(total)
    type(session_t), intent(in) :: session
    integer :: numbers

    numbers = 0
    ! Displacement, velocity, stress, strain; that which acts; plastic strain; opening; damage.
    if (session%soil_moves) then
      numbers = numbers + 12
      if (session%disc%two_levels .and. .not. session%disc%damage_only) numbers = numbers + 4
      if (allocated(session%state%history)) numbers = numbers + 1
      if (allocated(session%state%opening)) numbers = numbers + 1
      if (any(session%ground%law%damage%driver /= 0)) numbers = numbers + 1
    end if
    ! Pressure, saturation, suction, porosity and velocity.
    if (session%ground%wet) numbers = numbers + 6
    total = 8_i8*int(numbers, i8)*int(session%disc%n, i8) + description_bytes
  end function snapshot_bytes

  !> Bytes of all of the state, as `&output restart` saves it.
  pure integer(i8) function restart_bytes(session) result(total)
    type(session_t), intent(in) :: session

    ! The fastest mode goes with the soil.
    total = state_bytes(session%state)
    if (session%soil_moves) total = total + 16_i8*int(session%disc%n, i8)
  end function restart_bytes

  !> Bytes of a state.
  pure integer(i8) function state_bytes(state) result(total)
    type(state_t), intent(in) :: state

    total = bytes(state%volume_work) &
      + bytes(state%u) + bytes(state%u_zero) + bytes(state%v) + bytes(state%acceleration) &
      + bytes(state%f) + bytes(state%f_drive) + bytes(state%stress) + bytes(state%strain) &
      + bytes(state%history) + bytes(state%opening) + bytes(state%stiffness) &
      + bytes(state%stiffness_old) &
      + bytes(state%settled) + bytes(state%stabilising) + bytes(state%stabilising_lost) &
      + bytes(state%intact) + bytes(state%between) &
      + bytes(state%between_old) + bytes(state%tied) + bytes(state%damped) &
      + bytes(state%mass) + bytes(state%load) + bytes(state%u_load) + bytes(state%jacobian) &
      + bytes(state%content) + bytes(state%pressure) + bytes(state%saturation) &
      + bytes(state%ratio) + bytes(state%potential) + bytes(state%capacity) &
      + bytes(state%suction) + bytes(state%give) + bytes(state%anchor) + bytes(state%water_work)
  end function state_bytes

  pure integer(i8) function bytes_single_1(values) result(total)
    real(sp), allocatable, intent(in) :: values(:)

    total = 0_i8
    if (allocated(values)) total = 4_i8*size(values, kind=i8)
  end function bytes_single_1

  pure integer(i8) function bytes_real_1(values) result(total)
    real(dp), allocatable, intent(in) :: values(:)

    total = 0_i8
    if (allocated(values)) total = 8_i8*size(values, kind=i8)
  end function bytes_real_1

  pure integer(i8) function bytes_real_2(values) result(total)
    real(dp), allocatable, intent(in) :: values(:,:)

    total = 0_i8
    if (allocated(values)) total = 8_i8*size(values, kind=i8)
  end function bytes_real_2

  pure integer(i8) function bytes_integer_1(values) result(total)
    integer, allocatable, intent(in) :: values(:)

    total = 0_i8
    if (allocated(values)) total = 4_i8*size(values, kind=i8)
  end function bytes_integer_1

  pure integer(i8) function bytes_integer_2(values) result(total)
    integer, allocatable, intent(in) :: values(:,:)

    total = 0_i8
    if (allocated(values)) total = 4_i8*size(values, kind=i8)
  end function bytes_integer_2
end module talus_cost
