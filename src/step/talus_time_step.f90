! SPDX-License-Identifier: MIT
!> Largest stable step of the soil: 2/omega of the highest eigenfrequency of M^-1 K, found by
!> conjugate gradients without a matrix (src/THEORY.md (5.2)). K is the elastic tangent in the
!> present shape with stabilisation and, where the pore water moves with the soil, its stiffness.
module talus_time_step
  use talus_kinds, only: dp
  use talus_disc, only: disc_t
  use talus_ground, only: ground_t
  use talus_state, only: state_t
  use talus_sum, only: sum_products
  use talus_elastic, only: elastic_piola_tangent
  use talus_soil_law, only: stress_bishop, bishop_factor
  use talus_inertia, only: inertia_apply
  use talus_rayleigh, only: search_t, search_begin, search_turn, direction_start, &
    direction_residual
  use talus_soil_step, only: work_t, motion_t, gradients, unbalanced
  implicit none
  private
  public :: time_step_stable, stiffness_apply, water_bulk_modulus

  !> Part of the start vector that is new when the last fastest mode is known.
  real(dp), parameter :: start_share = 0.3_dp

contains

  !> Largest stable step [s], without safety. 0 when no node can move.
  real(dp) function time_step_stable(disc, ground, state, motion, work) result(step)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(state_t), intent(in) :: state
    type(motion_t), intent(inout) :: motion
    type(work_t), intent(inout) :: work
    real(dp), allocatable :: bulk(:), nothing(:,:)
    type(search_t) :: search
    real(dp) :: square

    allocate (bulk(disc%n), nothing(2, disc%n), search%now%d(2, disc%n), search%now%m(2, disc%n))
    nothing = 0.0_dp
    call water_bulk_modulus(disc, ground, state, motion%coupled, bulk)
    step = 0.0_dp
    associate (now => search%now, ahead => search%ahead)
      call direction_start(motion%mobility, now%m)
      square = sum_products(2*disc%n, now%m, now%m)
      if (square <= 0.0_dp) return
      ! The fastest mode moves little from one look to the next; some of all others finds a new one.
      if (allocated(motion%mode)) now%m = motion%mode + (start_share/sqrt(square))*now%m
      call displace(disc, motion, now%m, now%d)
      call stiffness_apply(disc, ground, state, bulk, nothing, now%d, work)
      now%k = work%force
      call search_begin(search)
      do while (.not. search%done)
        ! The residual K d - omega^2 M d, and where it points: M^-1 K d - omega^2 d.
        call direction_residual(now, search%quotient, ahead%m)
        call displace(disc, motion, ahead%m, ahead%d)
        call stiffness_apply(disc, ground, state, bulk, nothing, ahead%d, work)
        ahead%k = work%force
        call search_turn(search)
      end do
      step = 2.0_dp/sqrt(search%quotient)
      motion%mode = now%m/sqrt(sum_products(2*disc%n, now%m, now%m))
    end associate
  end function time_step_stable

  !> Displacement M^-1 times a force.
  subroutine displace(disc, motion, force, d)
    type(disc_t), intent(in) :: disc
    type(motion_t), intent(in) :: motion
    real(dp), contiguous, intent(in) :: force(:,:)  !! [N/m], (2,n)
    real(dp), contiguous, intent(inout) :: d(:,:)   !! (2,n)
    integer :: i

    if (motion%consistent) then
      call inertia_apply(disc%dual, motion%pair_mass, motion%mobility, force, d)
      return
    end if
    !$omp parallel do default(none) shared(motion, force, d) private(i) schedule(static)
    do i = 1, size(d, 2)
      d(:, i) = force(:, i)*motion%mobility(:, i)
    end do
    !$omp end parallel do
  end subroutine displace

  !> Stiffness of the pore water against a change of volume at constant water [Pa].
  subroutine water_bulk_modulus(disc, ground, state, coupled, bulk)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(state_t), intent(in) :: state
    logical, intent(in) :: coupled
    real(dp), intent(out) :: bulk(:) !! (n)
    real(dp) :: effective
    integer :: i, soil

    bulk = 0.0_dp
    if (.not. (coupled .and. ground%wet)) return
    do i = 1, disc%n
      soil = disc%soil(i)
      if (ground%law(soil)%stress /= stress_bishop) cycle
      associate (curve => ground%curve(soil))
        effective = (state%saturation(i) - curve%residual)/(curve%maximum - curve%residual)
      end associate
      ! w(p, J) stays: dw/dJ dJ + dw/dp dp = 0, with dw/dJ = S + S_s <p + s_a>.
      bulk(i) = bishop_factor(-state%pressure(i), effective)*(state%saturation(i) &
        + ground%storage(soil)*max(state%pressure(i) + ground%curve(soil)%entry, 0.0_dp)) &
        *state%jacobian(i)/state%capacity(i)
    end do
  end subroutine water_bulk_modulus

  !> work%force = K d.
  subroutine stiffness_apply(disc, ground, state, bulk, nothing, d, work)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(state_t), intent(in) :: state
    real(dp), contiguous, intent(in) :: bulk(:)      !! stiffness of the pore water [Pa], (n)
    real(dp), contiguous, intent(in) :: nothing(:,:) !! zeros, (2,n)
    real(dp), contiguous, intent(in) :: d(:,:)       !! displacement [m], (2,n)
    type(work_t), intent(inout) :: work
    real(dp), allocatable :: energy(:), loss(:), one(:), none(:)
    integer :: i

    allocate (energy(disc%n), loss(disc%n), one(disc%n))
    energy = 0.0_dp
    loss = 0.0_dp
    one = 1.0_dp
    none = 0.0_dp*one
    !$omp parallel default(none) shared(disc, ground, state, bulk, nothing, d, work, energy, loss) &
    !$omp shared(one, none) private(i)
    call gradients(disc, d, work, f=state%f)
    !$omp do schedule(static)
    do i = 1, disc%n
      call elastic_piola_tangent(ground%law(disc%soil(i))%elastic, bulk(i), state%f(:, i), &
                                 work%h(:, i), work%q(:, i))
      work%q(:, i) = disc%dual%area(i)*work%q(:, i)
    end do
    !$omp end do
    call unbalanced(disc, d, one, one, nothing, work, energy, loss, none, none)
    !$omp do schedule(static)
    do i = 1, disc%n
      work%force(:, i) = -work%force(:, i)
    end do
    !$omp end do
    !$omp end parallel
  end subroutine stiffness_apply
end module talus_time_step
