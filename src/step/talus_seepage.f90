! SPDX-License-Identifier: MIT
!> Seepage in storage form (src/THEORY.md (4.16), (5.4)):
!>
!>   q = flux through every face         explicit: of the pressures now; implicit: of those to come
!>   w = w - step (sum q)/A              the same for both, so water is conserved to round-off
!>   rain, ponds, seepage faces, heads   inlets_apply
!>   pressure <- stored water            seepage_invert
!>
!> Each sub-step is explicit or implicit, whichever advances further for its cost. An explicit step
!> is taken back when the water it moved makes it unstable; an implicit one when it moves too much
!> water, or when its equations have no solution within a few iterations.
module talus_seepage
  use talus_kinds, only: dp, i8
  use talus_disc, only: disc_t
  use talus_ground, only: ground_t
  use talus_state, only: state_t, water_balance_t
  use talus_conditions, only: inlets_t, inlet_flux, inlet_rain
  use talus_rain, only: rain_total, rain_next_change
  use talus_cell_water, only: cells_invert
  use talus_points, only: soil_points, points_alike
  use talus_darcy, only: seepage_t, seepage_shape, seepage_hold, face_fluxes, cell_outflow, &
    seepage_step_limit, seepage_velocity
  use talus_seepage_newton, only: newton_t, newton_prepare, newton_solve, newton_cost
  use talus_inlet_step, only: inlets_apply, inlets_heads
  use talus_sum, only: sum_add
  implicit none
  private
  public :: seepage_t, seepage_shape, seepage_advance, seepage_invert, face_fluxes, seepage_velocity
  public :: seepage_step_limit, seepage_supply

  !> The most that an explicit step may have of the limit after it.
  real(dp), parameter :: excess = 1.5_dp
  !> Most growth from one explicit step to the next, and what a rejected one is divided by.
  real(dp), parameter :: growth = 2.0_dp, cut = 8.0_dp
  integer, parameter :: most_cuts = 12
  !> Water content that an implicit step should change in a cell, and any step at most twice [-].
  real(dp), parameter :: content_change = 0.01_dp

contains

  !> Pressures and flow properties of the stored water.
  subroutine seepage_invert(disc, ground, state)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(state_t), intent(inout) :: state
    integer :: start, first, last, n

    !$omp parallel do default(none) shared(disc, ground, state) private(start, first, last, n) &
    !$omp schedule(static)
    do start = 1, disc%n, soil_points
      last = min(disc%n, start + soil_points - 1)
      first = start
      do while (first <= last)
        n = points_alike(disc%soil(first:last))
        call cells_invert(ground, disc%soil(first), first, n, state)
        first = first + n
      end do
    end do
    !$omp end parallel do
  end subroutine seepage_invert

  !> Advance the water from the state's time by `duration`, with the soil at rest. The state's time
  !> is left to the caller.
  subroutine seepage_advance(seepage, disc, ground, inlets, start, duration, state, most, reached)
    type(seepage_t), intent(inout) :: seepage
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(inlets_t), intent(in) :: inlets
    real(dp), intent(in) :: start    !! time for the rain [s]
    real(dp), intent(in) :: duration !! [s]
    type(state_t), intent(inout) :: state
    integer, intent(in), optional :: most      !! sub-steps after which to give up, for trials
    real(dp), intent(out), optional :: reached !! of the duration [s]
    type(newton_t) :: newton
    real(dp) :: done, step, limit, allowed, cost
    integer(i8) :: last_step
    logical :: finished

    cost = newton_cost(disc)
    call inlets_heads(inlets, seepage%height, disc, ground, state)
    call seepage_hold(seepage, inlets, state%pressure)
    call face_fluxes(seepage, disc, ground, state)
    limit = seepage_step_limit(seepage, disc, ground, state)
    last_step = huge(last_step)
    if (present(most)) last_step = state%seepage_steps + int(most, i8)
    done = 0.0_dp
    finished = .not. duration > 0.0_dp
    do while (.not. finished)
      allowed = allowed_step(inlets, start + done, duration - done)
      step = min(seepage%safety*limit, allowed)
      if (seepage%last > 0.0_dp) step = min(step, growth*seepage%last)
      if (.not. seepage%explicit_only .and. min(seepage%stride, allowed) > cost*step) then
        call newton_prepare(newton, disc)
        call implicit_step(newton, seepage, disc, ground, inlets, start + done, allowed, state, &
          step)
      else
        ! Two even last steps instead of a full one and a sliver.
        if (step < allowed .and. 2.0_dp*step > allowed) step = 0.5_dp*allowed
        call explicit_step(seepage, disc, ground, inlets, start + done, state, step)
      end if
      state%seepage_steps = state%seepage_steps + 1_i8
      limit = seepage_step_limit(seepage, disc, ground, state)
      finished = done + step >= duration*(1.0_dp - 1.0e-14_dp) .or. &
        state%seepage_steps >= last_step
      done = done + step
    end do
    if (present(reached)) reached = done
  end subroutine seepage_advance

  !> Time to the end or to the next change of a rain [s].
  pure real(dp) function allowed_step(inlets, time, remaining) result(allowed)
    type(inlets_t), intent(in) :: inlets
    real(dp), intent(in) :: time, remaining !! [s]
    real(dp) :: change
    integer :: i

    allowed = remaining
    do i = 1, size(inlets%rains)
      change = rain_next_change(inlets%rains(i), time) - time
      if (change > 1.0e-9_dp*max(1.0_dp, abs(time))) allowed = min(allowed, change)
    end do
  end function allowed_step

  !> One explicit step with the fluxes at hand, shortened until it is stable after the fact.
  subroutine explicit_step(seepage, disc, ground, inlets, time, state, step)
    type(seepage_t), intent(inout) :: seepage
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(inlets_t), intent(in) :: inlets
    real(dp), intent(in) :: time
    type(state_t), intent(inout) :: state
    real(dp), intent(inout) :: step !! in: longest; out: taken [s]
    type(water_balance_t) :: water
    real(dp) :: moved
    integer :: cuts

    seepage%content_before = state%content
    seepage%q_before = seepage%q
    water = state%water
    do cuts = 0, most_cuts
      call take_step(seepage, disc, ground, inlets, time, step, state)
      call face_fluxes(seepage, disc, ground, state)
      moved = maxval(abs(state%content - seepage%content_before))
      ! Steps that are asked to be too long are not taken back: to see what they do is the point.
      if (seepage%explicit_only .and. seepage%safety > 1.0_dp) exit
      if (step <= excess*seepage_step_limit(seepage, disc, ground, state) .and. &
          moved <= 2.0_dp*content_change) exit
      if (cuts == most_cuts) exit
      step = step/cut
      state%content = seepage%content_before
      state%water = water
      seepage%q = seepage%q_before
    end do
    seepage%stride = step*content_change/max(moved, 1.0e-12_dp)
    seepage%last = step
  end subroutine explicit_step

  !> One implicit step, shortened until it converges and moves little enough water.
  subroutine implicit_step(newton, seepage, disc, ground, inlets, time, allowed, state, step)
    type(newton_t), intent(inout) :: newton
    type(seepage_t), intent(inout) :: seepage
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(inlets_t), intent(in) :: inlets
    real(dp), intent(in) :: time, allowed !! [s]
    type(state_t), intent(inout) :: state
    real(dp), intent(inout) :: step !! in: an explicit one, the shortest tried; out: taken [s]
    type(water_balance_t) :: water
    real(dp), allocatable :: content(:), pressure(:)
    real(dp) :: moved, shortest
    logical :: converged
    logical, allocatable :: held(:)
    integer :: iterations

    content = state%content
    pressure = state%pressure
    held = seepage%held
    water = state%water
    shortest = step
    step = min(seepage%stride, allowed)
    if (step < allowed .and. 2.0_dp*step > allowed) step = 0.5_dp*allowed
    do
      call two_stages(newton, seepage, disc, ground, inlets, time, step, state, converged, &
        iterations)
      moved = maxval(abs(state%content - content))
      if (converged .and. (moved <= 2.0_dp*content_change .or. step <= shortest)) exit
      if (converged) then
        step = step*max(0.25_dp, 0.8_dp*content_change/moved)
      else
        step = 0.25_dp*step
      end if
      state%content = content
      state%pressure = pressure
      seepage%held = held
      state%water = water
      if (step > shortest) cycle
      ! No luck: the explicit step that was at hand.
      step = shortest
      call seepage_invert(disc, ground, state)
      call face_fluxes(seepage, disc, ground, state)
      call explicit_step(seepage, disc, ground, inlets, time, state, step)
      return
    end do
    seepage%stride = step*min(2.0_dp, 0.9_dp*content_change/max(moved, 1.0e-12_dp))
    if (iterations > 10) seepage%stride = min(seepage%stride, step)
    seepage%last = 0.0_dp
    call face_fluxes(seepage, disc, ground, state)
  end subroutine implicit_step

  !> An implicit step of second order (Alexander 1977, two stages, L-stable): a backward step of
  !> theta, its change of water stretched to 1 - theta, and a second backward step of theta. Both
  !> stages exchange fluxes, so their sum conserves water too.
  subroutine two_stages(newton, seepage, disc, ground, inlets, time, step, state, converged, &
    iterations)
    type(newton_t), intent(inout) :: newton
    type(seepage_t), intent(inout) :: seepage
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(inlets_t), intent(in) :: inlets
    real(dp), intent(in) :: time, step !! [s]
    type(state_t), intent(inout) :: state
    logical, intent(out) :: converged
    integer, intent(out) :: iterations !! of the harder stage
    real(dp), parameter :: theta = 1.0_dp - sqrt(0.5_dp), stretch = (1.0_dp - theta)/theta
    type(water_balance_t) :: water
    real(dp), allocatable :: content(:)
    integer :: stage, needed

    content = state%content
    water = state%water
    iterations = 0
    do stage = 1, 2
      call newton_solve(newton, seepage, disc, ground, inlets, 1.0_dp/(theta*step), &
        seepage_supply(seepage, inlets, time, theta*step), state, converged, &
        needed)
      iterations = max(iterations, needed)
      if (.not. converged) return
      call take_step(seepage, disc, ground, inlets, time, theta*step, state)
      if (stage == 2) exit
      state%content = content + stretch*(state%content - content)
      call water_stretch(state%water, water, stretch)
    end do
  end subroutine two_stages

  !> Count what happened since `before` a number of times.
  pure subroutine water_stretch(water, before, times)
    type(water_balance_t), intent(inout) :: water
    type(water_balance_t), intent(in) :: before
    real(dp), intent(in) :: times

    call stretch(water%inflow, water%inflow_lost, before%inflow, before%inflow_lost)
    call stretch(water%outflow, water%outflow_lost, before%outflow, before%outflow_lost)
    call stretch(water%runoff, water%runoff_lost, before%runoff, before%runoff_lost)

  contains

    pure subroutine stretch(total, lost, total_before, lost_before)
      real(dp), intent(inout) :: total, lost
      real(dp), intent(in) :: total_before, lost_before
      real(dp) :: part

      part = times*((total - total_before) - (lost - lost_before))
      total = total_before
      lost = lost_before
      call sum_add(total, lost, part)
    end subroutine stretch
  end subroutine water_stretch

  !> Move the water of the fluxes at hand, and what crosses the boundary.
  subroutine take_step(seepage, disc, ground, inlets, time, step, state)
    type(seepage_t), intent(inout) :: seepage
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(inlets_t), intent(in) :: inlets
    real(dp), intent(in) :: time, step !! [s]
    type(state_t), intent(inout) :: state
    integer :: i

    !$omp parallel do default(none) shared(seepage, disc, state, step) private(i) schedule(static)
    do i = 1, disc%n
      state%content(i) = state%content(i) &
        - step/disc%dual%area(i)*cell_outflow(disc%dual, seepage%q, i)
    end do
    !$omp end parallel do
    call inlets_apply(inlets, seepage%catch, seepage%height, disc, ground, time, step, state)
    call seepage_invert(disc, ground, state)
    call seepage_hold(seepage, inlets, state%pressure)
  end subroutine take_step

  !> Water offered at each inlet over a step [m2/s], (m).
  pure function seepage_supply(seepage, inlets, time, step) result(supply)
    type(seepage_t), intent(in) :: seepage
    type(inlets_t), intent(in) :: inlets
    real(dp), intent(in) :: time, step !! [s]
    real(dp) :: supply(size(inlets%node))
    integer :: k

    supply = 0.0_dp
    do k = 1, size(inlets%node)
      if (inlets%kind(k) == inlet_flux) supply(k) = inlets%value(k)*seepage%catch(k)
      if (inlets%kind(k) == inlet_rain) supply(k) = seepage%catch(k)/step &
        *rain_total(inlets%rains(inlets%rain(k)), time, time + step)
    end do
  end function seepage_supply
end module talus_seepage
