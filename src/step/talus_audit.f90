! SPDX-License-Identifier: MIT
!> Where energy and water are, and how well they balance (src/THEORY.md (5.5)-(5.7)).
!>
!> Kinetic energy is 1/2 v(n-1/2).M v(n+1/2), the one that central differences conserve. All others
!> come from the stress and the history of the points, not from nodal forces, so the balance checks
!> the discretisation, its adjoint, the laws and the time step together.
module talus_audit
  use talus_kinds, only: dp
  use talus_disc, only: disc_t
  use talus_ground, only: ground_t
  use talus_state, only: state_t
  use talus_soil_law, only: soil_stored_energy, stress_bishop, history_damage, &
    history_plastic_work, history_damage_work
  use talus_soil_step, only: motion_t
  use talus_inertia, only: inertia_momentum
  use talus_sum, only: sum_blocks, sum_products
  implicit none
  private
  public :: energies_t, audit_energies, audit_energy_error, audit_stored_water, audit_water_error
  public :: audit_load, audit_driven

  !> Energies per metre of slope [J/m].
  type :: energies_t
    real(dp) :: kinetic = 0.0_dp
    real(dp) :: strain = 0.0_dp        !! stored elastically
    real(dp) :: plastic = 0.0_dp       !! dissipated by plastic flow
    real(dp) :: damage = 0.0_dp        !! dissipated by damage
    real(dp) :: water = 0.0_dp         !! exchanged with the pore water or by swelling
    real(dp) :: stabilisation = 0.0_dp !! stored there, and lost as the soil softened
    real(dp) :: damping = 0.0_dp       !! taken by local damping and by impact on a floor
    real(dp) :: external = 0.0_dp      !! work of weight, tractions and driven nodes
    real(dp) :: motion = 0.0_dp        !! 1/2 m v(n+1/2)^2: only to scale errors at the very start
  end type energies_t

contains

  !> All energies of a state.
  function audit_energies(disc, ground, motion, state) result(energies)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(motion_t), intent(in) :: motion
    type(state_t), intent(in) :: state
    type(energies_t) :: energies
    real(dp), allocatable :: density(:)
    real(dp) :: damage
    logical :: damages
    integer :: i

    allocate (density(disc%n))
    damages = .false.
    if (allocated(state%history)) damages = size(state%history, 1) >= history_damage_work
    !$omp parallel do default(none) shared(disc, ground, state, density, damages) &
    !$omp private(i, damage) schedule(static)
    do i = 1, disc%n
      damage = 0.0_dp
      if (damages) damage = state%history(history_damage, i)
      associate (law => ground%law(disc%soil(i)), stress => state%stress(:, i))
        ! What the rate law stores is not the change of J e at finite strain: see volume_work.
        density(i) = soil_stored_energy(law, stress, damage) &
          *(state%f(1, i)*state%f(4, i) - state%f(2, i)*state%f(3, i)) - state%volume_work(i)
      end associate
    end do
    !$omp end parallel do
    energies%strain = sum_products(disc%n, density, disc%dual%area)
    call kinetic_energy(disc, motion, state, energies%kinetic, energies%motion)
    if (allocated(state%history)) then
      density = state%history(history_plastic_work, :)
      energies%plastic = sum_products(disc%n, density, disc%dual%area)
    end if
    if (damages) then
      density = state%history(history_damage_work, :)
      energies%damage = sum_products(disc%n, density, disc%dual%area)
    end if
    if (allocated(state%water_work)) &
      energies%water = sum_products(disc%n, state%water_work, disc%dual%area)
    if (allocated(state%stabilising)) energies%stabilisation = &
      sum_blocks(disc%n, state%stabilising) + sum_blocks(disc%n, state%stabilising_lost)
    energies%damping = sum_blocks(disc%n, state%damped)
    energies%external = state%external + load_work(disc%n, state)
  end function audit_energies

  !> 1/2 v(n-1/2).M v(n+1/2) over the nodes that can move, and 1/2 v(n+1/2).M v(n+1/2).
  subroutine kinetic_energy(disc, motion, state, energy, ahead)
    type(disc_t), intent(in) :: disc
    type(motion_t), intent(in) :: motion
    type(state_t), intent(in) :: state
    real(dp), intent(out) :: energy, ahead !! [J/m]
    real(dp), allocatable :: momentum(:,:)

    if (motion%consistent) then
      call inertia_momentum(disc%dual, motion%pair_mass, motion%mobility, state%v, momentum)
    else
      allocate (momentum(2, disc%n))
      momentum = 0.0_dp
      where (motion%mobility > 0.0_dp) momentum = state%v/motion%mobility
    end if
    ahead = 0.5_dp*sum_products(2*disc%n, momentum, state%v)
    energy = 0.5_dp*sum_products(2*disc%n, momentum, state%v - motion%step*state%acceleration)
  end subroutine kinetic_energy

  !> Work of the present load since it was set.
  real(dp) function load_work(n, state)
    integer, intent(in) :: n
    type(state_t), intent(in) :: state

    load_work = sum_products(2*n, state%load, state%u) - sum_products(2*n, state%load, state%u_load)
  end function load_work

  !> Change the load, keeping account of the work of the old one.
  subroutine audit_load(n, load, state)
    integer, intent(in) :: n
    real(dp), intent(in) :: load(:,:) !! [N/m], (2,n)
    type(state_t), intent(inout) :: state

    state%external = state%external + load_work(n, state)
    state%load = load
    state%u_load = state%u
  end subroutine audit_load

  !> Add the work of the forces that drive nodes over half a step: call it before and after each
  !> soil step, so that their work follows the trapezoidal rule as all other works do.
  subroutine audit_driven(motion, force, state)
    type(motion_t), intent(in) :: motion
    real(dp), intent(in) :: force(:,:) !! out-of-balance force [N/m], (2,n)
    type(state_t), intent(inout) :: state
    integer :: i, j

    do i = 1, size(force, 2)
      do j = 1, 2
        if (.not. motion%mobility(j, i) > 0.0_dp .and. abs(state%v(j, i)) > 0.0_dp) &
          state%external = state%external - 0.5_dp*motion%step*force(j, i)*state%v(j, i)
      end do
    end do
  end subroutine audit_driven

  !> Relative error of the energy balance since `start`: what is missing over the largest energy
  !> that changed hands, or over a millionth of the largest held where next to nothing moves.
  pure real(dp) function audit_energy_error(start, now) result(error)
    type(energies_t), intent(in) :: start, now
    real(dp), parameter :: held_share = 1.0e-6_dp
    real(dp) :: change(7), work, scale

    change = [now%kinetic - start%kinetic, now%strain - start%strain, now%plastic - start%plastic, &
              now%damage - start%damage, now%water - start%water, &
              now%stabilisation - start%stabilisation, now%damping - start%damping]
    work = now%external - start%external
    scale = max(abs(work), maxval(abs(change)), held_share*max(now%strain, abs(now%external)), &
                now%motion)
    error = 0.0_dp
    if (scale > 0.0_dp) error = (sum(change) - work)/scale
  end function audit_energy_error

  !> Water in the soil [m3/m].
  real(dp) function audit_stored_water(disc, state) result(stored)
    type(disc_t), intent(in) :: disc
    type(state_t), intent(in) :: state

    stored = sum_products(disc%n, state%content, disc%dual%area)
  end function audit_stored_water

  !> Relative error of the water balance of a stage: in - out - change of storage, over the water
  !> that moved or, when less, the water stored.
  real(dp) function audit_water_error(disc, state) result(error)
    type(disc_t), intent(in) :: disc
    type(state_t), intent(in) :: state
    real(dp) :: missing, scale

    associate (balance => state%water)
      missing = balance%inflow - balance%outflow &
        - (audit_stored_water(disc, state) - balance%stored_start)
      scale = max(balance%stored_start, balance%inflow + balance%outflow)
    end associate
    error = 0.0_dp
    if (scale > 0.0_dp) error = missing/scale
  end function audit_water_error
end module talus_audit
