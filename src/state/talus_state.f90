! SPDX-License-Identifier: MIT
!> What changes with time. Fields that a run does not need stay unallocated. Copying a state by
!> assignment saves it; assigning it back restores it.
module talus_state
  use talus_kinds, only: dp, i8
  use talus_disc, only: disc_t
  use talus_ground, only: ground_t
  use talus_soil_law, only: soil_needs_strain, history_size, history_size_plastic, &
    stress_bishop
  use talus_suction_strain, only: suction_strain_none
  implicit none
  private
  public :: state_t, water_balance_t, state_allocate

  !> Water since the start of a stage [m3 per m of slope], and the low bits of long sums.
  type :: water_balance_t
    real(dp) :: stored_start = 0.0_dp !! in the soil when the stage began
    real(dp) :: inflow = 0.0_dp       !! rain that entered, heads and fluxes inward
    real(dp) :: outflow = 0.0_dp      !! seepage faces, heads and fluxes outward
    real(dp) :: runoff = 0.0_dp       !! rain that did not enter
    real(dp) :: inflow_lost = 0.0_dp, outflow_lost = 0.0_dp, runoff_lost = 0.0_dp
  end type water_balance_t

  type :: state_t
    real(dp) :: time = 0.0_dp                   !! since the start of the run [s]
    integer(i8) :: steps = 0_i8                 !! soil steps
    integer(i8) :: seepage_steps = 0_i8
    real(dp), allocatable :: u(:,:)             !! displacement from the reference [m], (2,n)
    real(dp), allocatable :: f(:,:)             !! deformation gradient 11, 12, 21, 22, (4,n)
    ! Soil; allocated when the run keeps it.
    real(dp), allocatable :: u_zero(:,:)        !! displacement that counts as none [m], (2,n)
    real(dp), allocatable :: v(:,:)             !! velocity, half a step ahead [m/s], (2,n)
    real(dp) :: ahead = 0.0_dp                  !! that half step in real time [s]; 0 in relaxation
    real(dp), allocatable :: acceleration(:,:)  !! [m/s2], (2,n)
    real(dp), allocatable :: f_drive(:,:)       !! smoothed, when it drives damage alone, (4,n)
    real(dp), allocatable :: stress(:,:)        !! undamaged, without pore pressure [Pa], (4,n)
    real(dp), allocatable :: strain(:,:)        !! total, where damage needs it, (4,n)
    real(dp), allocatable :: history(:,:)       !! see talus_soil_law, (5,n) or (2,n)
    real(dp), allocatable :: opening(:)         !! volumetric strain soil is open by, where it closes
                                                !! again, (n)
    real(dp), allocatable :: stiffness(:)       !! stiffness left over the elastic one, (n)
    real(dp), allocatable :: stiffness_old(:)   !! one step ago, (n)
    real(dp), allocatable :: settled(:)         !! plastic strain that counts as none, of (4.11)
                                                !! still; once some was reset, (n)
    real(dp), allocatable :: stabilising(:)     !! energy in the stabilisation [J/m], (n)
    real(dp), allocatable :: stabilising_lost(:) !! lost there as the soil softened [J/m], (n)
    real(dp), allocatable :: intact(:)          !! how intact soil is for the tie of the levels, (n)
    real(dp), allocatable :: between(:)         !! stiffness left between the levels, (n)
    real(dp), allocatable :: between_old(:)     !! one step ago, (n)
    real(dp), allocatable :: tied(:,:)          !! slopes of its energy [Pa] and stretch, (6,n)
    real(dp), allocatable :: volume_work(:)     !! sum of stored energy dJ [J/m3], (n)
    real(dp), allocatable :: damped(:)          !! taken by local damping and impacts [J/m], (n)
    real(dp), allocatable :: mass(:)            !! true, with water [kg/m], (n)
    real(dp), allocatable :: load(:,:)          !! weight and tractions [N/m], (2,n)
    real(dp), allocatable :: u_load(:,:)        !! displacement when the load was set [m], (2,n)
    real(dp) :: external = 0.0_dp               !! work of earlier loads and driven nodes [J/m]
    ! Water; allocated when the ground is wet.
    real(dp), allocatable :: jacobian(:)        !! J of the last soil step, (n)
    real(dp), allocatable :: content(:)         !! water per reference area w [m3/m2], (n)
    real(dp), allocatable :: pressure(:)        !! p_w [Pa], compression +, (n)
    real(dp), allocatable :: saturation(:)      !! S_r, (n)
    real(dp), allocatable :: ratio(:)           !! k_r, (n)
    real(dp), allocatable :: potential(:)       !! Phi [Pa], (n)
    real(dp), allocatable :: capacity(:)        !! dw/dp [1/Pa], (n)
    real(dp), allocatable :: suction(:)         !! that the stress has seen [Pa], (n):
                                                !! s of net stress, chi s of Bishop's
    real(dp), allocatable :: give(:)            !! water that wider pores take up [1/Pa], (n)
    real(dp), allocatable :: anchor(:)          !! pressure of the shape as it is [Pa], (n)
    real(dp), allocatable :: water_work(:)      !! on pore pressure or swelling [J/m3], (n)
    type(water_balance_t) :: water
  end type state_t

contains

  !> Allocate what the run needs, at rest and without stress.
  subroutine state_allocate(state, disc, ground, soil)
    type(state_t), intent(out) :: state
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    logical, intent(in) :: soil !! with what only soil that moves needs

    ! The shape that the water flows through.
    allocate (state%u(2, disc%n), state%f(4, disc%n), source=0.0_dp)
    state%f(1, :) = 1.0_dp
    state%f(4, :) = 1.0_dp
    if (soil) call allocate_soil(state, disc, ground)
    if (ground%wet) call allocate_water(state, disc%n, ground, soil)
  end subroutine state_allocate

  subroutine allocate_soil(state, disc, ground)
    type(state_t), intent(inout) :: state
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    integer :: n, i
    logical :: inelastic, strained

    n = disc%n
    inelastic = .false.
    strained = .false.
    do i = 1, size(ground%law)
      inelastic = inelastic .or. ground%law(i)%plasticity /= 0 .or. ground%law(i)%damage%driver /= 0
      strained = strained .or. soil_needs_strain(ground%law(i))
    end do
    allocate (state%u_zero(2, n), state%v(2, n), state%acceleration(2, n), state%stress(4, n), &
              state%mass(n), state%load(2, n), state%u_load(2, n), state%damped(n), &
              state%volume_work(n), source=0.0_dp)
    if (strained) allocate (state%strain(4, n), source=0.0_dp)
    if (strained .and. disc%damage_only) state%f_drive = state%f
    if (inelastic) allocate (state%history(merge(history_size, history_size_plastic, &
      any(ground%law%damage%driver /= 0)), n), source=0.0_dp)
    if (any(ground%law%closes)) allocate (state%opening(n), source=0.0_dp)
    if (disc%stabilised) then
      allocate (state%stabilising(n), state%stabilising_lost(n), source=0.0_dp)
      allocate (state%stiffness(n), state%stiffness_old(n), source=1.0_dp)
    end if
    if (disc%tied) then
      allocate (state%intact(n), source=1.0_dp)
      allocate (state%between(n), state%between_old(n), state%tied(6, n), source=0.0_dp)
    end if
  end subroutine allocate_soil

  subroutine allocate_water(state, n, ground, soil)
    type(state_t), intent(inout) :: state
    integer, intent(in) :: n
    type(ground_t), intent(in) :: ground
    logical, intent(in) :: soil !! that the water acts on
    logical :: bishop

    allocate (state%content(n), state%pressure(n), state%saturation(n), state%ratio(n), &
              state%potential(n), state%capacity(n), state%suction(n), source=0.0_dp)
    allocate (state%jacobian(n), source=1.0_dp)
    if (.not. soil) return
    bishop = any(ground%law%stress == stress_bishop)
    if (bishop) allocate (state%give(n), state%anchor(n), source=0.0_dp)
    if (bishop .or. any(ground%law%swelling%kind /= suction_strain_none)) &
      allocate (state%water_work(n), source=0.0_dp)
  end subroutine allocate_water
end module talus_state
