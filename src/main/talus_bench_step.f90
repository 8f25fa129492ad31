! SPDX-License-Identifier: MIT
!> The same soil step as talus_soil_step, with the clock read after each phase, and blocks of steps
!> that are timed as a whole. The models that are timed have no second level for damage alone.
module talus_bench_step
  use talus_kinds, only: dp, i8
  use talus_disc, only: disc_t
  use talus_ground, only: ground_t
  use talus_state, only: state_t
  use talus_session, only: session_t
  use talus_soil_step, only: work_t, motion_t, soil_step
  use talus_strain, only: strain_first, strain_gradient, per_area
  use talus_smooth, only: smooth_gradient, smooth_stress, smooth_gradient_tied, smooth_stress_tied
  use talus_tie_step, only: tie_measure, tie_means
  use talus_stress_update, only: stress_update
  use talus_residual, only: residual_gather, residual_gather_levels
  use talus_force, only: force_unbalanced, motion_position, motion_velocity
  use talus_seepage, only: seepage_advance
  use talus_audit, only: energies_t, audit_energies
  use talus_timer, only: timer_now
  use talus_bench_bytes, only: phases, phase_strain, phase_second, phase_stress, phase_stabilise, &
    phase_adjoint, phase_force
  implicit none
  private
  public :: step_timed, block_seconds, block_phases, seepage_seconds

contains

  !> One soil step; adds the time of each phase.
  subroutine step_timed(disc, ground, motion, state, work, seconds, failed)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(motion_t), intent(in) :: motion
    type(state_t), intent(inout) :: state
    type(work_t), intent(inout) :: work
    real(dp), intent(inout) :: seconds(phases) !! [s]
    integer, intent(out) :: failed
    real(dp) :: began

    failed = 0
    began = timer_now()
    !$omp parallel default(none) shared(disc, ground, motion, state, work, failed, seconds, began)
    call motion_position(motion%step, state%v, state%u)
    if (disc%two_levels) then
      call strain_first(disc%scni, state%u, work%y)
      call mark(seconds(phase_strain), began)
      if (disc%tied) then
        call tie_measure(disc%tie, disc%dual%area, work%y, work%stretch, work%weighed, &
          stiffness=state%stiffness, intact=state%intact, between=state%between, &
          between_old=state%between_old)
        call smooth_gradient_tied(disc%two_level, work%y, work%weighed, work%h, work%mean)
        call tie_means(disc%tie, work%mean, work%weighed)
      else
        call smooth_gradient(disc%two_level, work%y, work%h)
      end if
      if (disc%stabilised) call per_area(disc%dual%area, work%y)
      call mark(seconds(phase_second), began)
    else
      call strain_gradient(disc%scni, disc%dual%area, state%u, work%h)
      call mark(seconds(phase_strain), began)
    end if
    call stress_update(disc, ground, motion%coupled, work%h, work%drive, state, work%q, failed)
    call mark(seconds(phase_stress), began)
    if (disc%two_levels) then
      if (disc%stabilised) call residual_gather_levels(disc%stabilise, disc%dual%area, state%u, &
        work%y, state%stiffness, state%stiffness_old, state%between, state%between_old, work%h, &
        work%q, work%stabilising, state%stabilising, state%stabilising_lost)
      call mark(seconds(phase_stabilise), began)
      if (disc%tied) then
        call smooth_stress_tied(disc%two_level, disc%tie, disc%dual%area, work%q, work%weighed, &
          work%mean, work%stretch, work%h, work%y, state%intact, state%tied, state%stabilising_lost)
      else
        call smooth_stress(disc%two_level, work%q, disc%stabilised, work%h, work%y)
      end if
      call mark(seconds(phase_adjoint), began)
      call force_unbalanced(disc%scni, work%y, state%load, work%stabilising, work%force)
    else
      if (disc%stabilised) then
        call residual_gather(disc%stabilise, disc%dual%area, state%u, work%h, state%stiffness, &
          state%stiffness_old, work%q, work%stabilising, state%stabilising, &
          state%stabilising_lost)
        call mark(seconds(phase_stabilise), began)
      else
        call per_area(disc%dual%area, work%q)
        call mark(seconds(phase_adjoint), began)
      end if
      call force_unbalanced(disc%scni, work%q, state%load, work%stabilising, work%force)
    end if
    call motion_velocity(motion%step, motion%local, motion%viscous, motion%mobility, work%force, &
                         state%v, state%acceleration, state%damped)
    call mark(seconds(phase_force), began)
    !$omp end parallel
    state%steps = state%steps + 1_i8
  end subroutine step_timed

  !> Add the time since `began`, and begin again. All threads have passed the barrier of a loop.
  subroutine mark(seconds, began)
    real(dp), intent(inout) :: seconds, began !! [s]
    real(dp) :: now

    !$omp master
    now = timer_now()
    seconds = seconds + (now - began)
    began = now
    !$omp end master
  end subroutine mark

  !> Start again from the state saved in the session, with one step that is not timed: the copy
  !> leaves the fields in the cache of one processor.
  subroutine start_again(session)
    type(session_t), intent(inout) :: session
    integer :: failed

    session%state = session%last_good
    call soil_step(session%disc, session%ground, session%motion, session%state, session%work, &
      failed)
  end subroutine start_again

  !> Time of one step [s], from `steps` steps that start at the state saved in the session.
  real(dp) function block_seconds(session, steps, audit) result(each)
    type(session_t), intent(inout) :: session
    integer, intent(in) :: steps
    logical, intent(in) :: audit !! all energies after every step
    type(energies_t) :: energies
    real(dp) :: began
    integer :: i, failed

    call start_again(session)
    began = timer_now()
    do i = 1, steps
      call soil_step(session%disc, session%ground, session%motion, session%state, session%work, &
        failed)
      if (audit) energies = audit_energies(session%disc, session%ground, session%motion, &
        session%state)
    end do
    each = (timer_now() - began)/real(steps, dp)
    ! Keep the account in use, so that it is not left out.
    if (audit) session%energies_start = energies
  end function block_seconds

  !> Time of each phase in one step [s].
  function block_phases(session, steps) result(seconds)
    type(session_t), intent(inout) :: session
    integer, intent(in) :: steps
    real(dp) :: seconds(phases)
    integer :: i, failed

    call start_again(session)
    seconds = 0.0_dp
    do i = 1, steps
      call step_timed(session%disc, session%ground, session%motion, session%state, session%work, &
                      seconds, failed)
    end do
    seconds = seconds/real(steps, dp)
  end function block_phases

  !> Time of one sub-step of the water [s]: explicit, just below the step that is stable.
  real(dp) function seepage_seconds(session, water_step) result(each)
    type(session_t), intent(inout) :: session
    real(dp), intent(in) :: water_step !! stable step [s]
    real(dp) :: began
    integer(i8) :: before

    session%state = session%last_good
    before = session%state%seepage_steps
    began = timer_now()
    call seepage_advance(session%seepage, session%disc, session%ground, session%conditions%inlets, &
                         0.0_dp, 0.9_dp*water_step, session%state)
    each = (timer_now() - began)/real(max(1_i8, session%state%seepage_steps - before), dp)
  end function seepage_seconds
end module talus_bench_step
