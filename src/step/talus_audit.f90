! SPDX-License-Identifier: MIT
!> Where energy and water are, and how well they balance (src/THEORY.md (5.5)-(5.7)).
!>
!> Kinetic energy is 1/2 v(n-1/2).M v(n+1/2), the one that central differences conserve. All others
!> come from the stress and the history of the points, not from nodal forces, so the balance checks
!> the discretisation, its adjoint, the laws and the time step together.
module talus_audit
  use talus_kinds, only: dp
  use talus_points, only: soil_points, points_take, points_alike
  use talus_disc, only: disc_t
  use talus_ground, only: ground_t
  use talus_state, only: state_t
  use talus_soil_law, only: soil_stored_energies, history_damage, history_plastic_work, &
    history_damage_work
  use talus_soil_step, only: motion_t
  use talus_inertia, only: inertia_momentum
  use talus_sum, only: sum_products, sum_apart
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

  !> Nodes whose energies are summed by themselves, and the sums.
  integer, parameter :: block_length = 1024
  integer, parameter :: sum_strain = 1, sum_plastic = 2, sum_damage = 3, sum_water = 4, &
    sum_stabilisation = 5, sum_damping = 6, sum_load = 7, sum_kinetic = 8, sum_ahead = 9, sums = 9

contains

  !> All energies of a state.
  function audit_energies(disc, ground, motion, state) result(energies)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(motion_t), intent(in) :: motion
    type(state_t), intent(in) :: state
    type(energies_t) :: energies
    real(dp), allocatable :: part(:,:)
    real(dp) :: total(sums)
    integer :: b, first

    allocate (part(sums, (disc%n + block_length - 1)/block_length))
    !$omp parallel do default(none) shared(disc, ground, motion, state, part) private(b, first) &
    !$omp schedule(static)
    do b = 1, size(part, 2)
      first = (b - 1)*block_length + 1
      call block_sums(disc, ground, motion, state, first, min(block_length, disc%n - first + 1), &
                      part(:, b))
    end do
    !$omp end parallel do
    ! Block after block: the same bits with any number of threads.
    total = sum(part, dim=2)
    energies%strain = total(sum_strain)
    energies%plastic = total(sum_plastic)
    energies%damage = total(sum_damage)
    energies%water = total(sum_water)
    energies%stabilisation = total(sum_stabilisation)
    energies%damping = total(sum_damping)
    energies%external = state%external + total(sum_load)
    energies%kinetic = 0.5_dp*total(sum_kinetic)
    energies%motion = 0.5_dp*total(sum_ahead)
    if (motion%consistent) call consistent_energy(disc, motion, state, energies%kinetic, &
                                                  energies%motion)
  end function audit_energies

  !> The energies of a block of nodes, all in one pass over their fields.
  pure subroutine block_sums(disc, ground, motion, state, first, n, part)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(motion_t), intent(in) :: motion
    type(state_t), intent(in) :: state
    integer, intent(in) :: first, n     !! nodes first to first + n - 1
    real(dp), intent(out) :: part(sums) !! see sum_*
    real(dp) :: energy(block_length)
    integer :: i, last

    last = first + n - 1
    call stored_energies(disc, ground, state, first, n, energy)
    ! What the rate law stores is not the change of J e at finite strain: see volume_work.
    do i = first, last
      energy(i-first+1) = disc%dual%area(i)*(energy(i-first+1)*(state%f(1, i)*state%f(4, i) &
        - state%f(2, i)*state%f(3, i)) - state%volume_work(i))
    end do
    part = 0.0_dp
    part(sum_strain) = sum_apart(n, energy)
    call moving_sums(2*n, motion%step, state%load(:, first:last), state%u(:, first:last), &
      state%u_load(:, first:last), motion%mobility(:, first:last), state%v(:, first:last), &
      state%acceleration(:, first:last), part(sum_load), part(sum_ahead), part(sum_kinetic))
    part(sum_damping) = sum_apart(n, state%damped(first:last))
    associate (area => disc%dual%area(first:last))
      if (allocated(state%history)) part(sum_plastic) = &
        sum_apart(n, state%history(history_plastic_work, first:last)*area)
      if (damages(state)) part(sum_damage) = &
        sum_apart(n, state%history(history_damage_work, first:last)*area)
      if (allocated(state%water_work)) part(sum_water) = &
        sum_apart(n, state%water_work(first:last)*area)
    end associate
    if (allocated(state%stabilising)) part(sum_stabilisation) = &
      sum_apart(n, state%stabilising(first:last) + state%stabilising_lost(first:last))
    if (allocated(state%tied)) part(sum_stabilisation) = part(sum_stabilisation) + sum_apart(n, &
      0.5_dp*disc%dual%area(first:last)*sum(state%tied(1:3, first:last)*state%tied(4:6, first:last), &
      dim=1))
  end subroutine block_sums

  !> Work of the load since it was set, v.M v and that less step v.M a, over n components.
  pure subroutine moving_sums(n, step, load, u, u_load, mobility, v, acceleration, work, ahead, &
    kinetic)
    integer, intent(in) :: n
    real(dp), intent(in) :: step !! [s]
    real(dp), dimension(n), intent(in) :: load, u, u_load, mobility, v, acceleration
    real(dp), intent(out) :: work, ahead, kinetic !! [J/m]
    real(dp), dimension(2*block_length) :: each, momentum
    integer :: i

    do i = 1, n
      each(i) = load(i)*(u(i) - u_load(i))
      ! Next to nothing where motion is held.
      momentum(i) = v(i)/merge(mobility(i), huge(1.0_dp), mobility(i) > 0.0_dp)
    end do
    work = sum_apart(n, each)
    each(:n) = momentum(:n)*v
    ahead = sum_apart(n, each)
    each(:n) = momentum(:n)*acceleration
    kinetic = ahead - step*sum_apart(n, each)
  end subroutine moving_sums

  !> Elastic energy stored at the nodes of a block, per current volume [J/m3].
  pure subroutine stored_energies(disc, ground, state, first, n, energy)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(state_t), intent(in) :: state
    integer, intent(in) :: first, n
    real(dp), intent(out) :: energy(n)
    real(dp) :: stress(soil_points,4), damage(soil_points)
    integer :: start, run

    start = first
    do while (start < first + n)
      run = points_alike(disc%soil(start:min(start + soil_points, first + n) - 1))
      call points_take(run, state%stress(:, start:start+run-1), stress)
      if (damages(state)) damage(:run) = state%history(history_damage, start:start+run-1)
      call soil_stored_energies(ground%law(disc%soil(start)), run, stress, damage, &
                                energy(start-first+1:))
      start = start + run
    end do
  end subroutine stored_energies

  !> The history holds damage.
  pure logical function damages(state)
    type(state_t), intent(in) :: state

    damages = .false.
    if (allocated(state%history)) damages = size(state%history, 1) >= history_damage_work
  end function damages

  !> 1/2 v(n-1/2).M v(n+1/2) over the nodes that can move, and 1/2 v(n+1/2).M v(n+1/2), with the
  !> consistent mass.
  subroutine consistent_energy(disc, motion, state, energy, ahead)
    type(disc_t), intent(in) :: disc
    type(motion_t), intent(in) :: motion
    type(state_t), intent(in) :: state
    real(dp), intent(out) :: energy, ahead !! [J/m]
    real(dp), allocatable :: momentum(:,:)

    call inertia_momentum(disc%dual, motion%pair_mass, motion%mobility, state%v, momentum)
    ahead = 0.5_dp*sum_products(2*disc%n, momentum, state%v)
    energy = 0.5_dp*sum_products(2*disc%n, momentum, state%v - motion%step*state%acceleration)
  end subroutine consistent_energy

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
