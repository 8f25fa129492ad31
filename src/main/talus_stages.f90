! SPDX-License-Identifier: MIT
!> The stages of a deck (src/THEORY.md section 5). What each kind does: talus_geostatic,
!> talus_storm, talus_dynamic, talus_strength_reduction.
module talus_stages
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_failed
  use talus_text, only: text_of
  use talus_deck_types, only: stage_t
  use talus_state, only: water_balance_t
  use talus_session, only: session_t
  use talus_setup_conditions, only: setup_conditions
  use talus_soil_step, only: soil_leave_rest
  use talus_relax, only: motion_prepare
  use talus_floor, only: floor_hold
  use talus_seepage, only: seepage_shape
  use talus_audit, only: audit_energies, audit_stored_water
  use talus_stage_parts, only: take_load, takes_turns, report_broken
  use talus_geostatic, only: run_geostatic, reset
  use talus_storm, only: run_storm
  use talus_dynamic, only: run_dynamic
  use talus_strength_reduction, only: strength_reduction
  use talus_record, only: record_restart
  use talus_progress, only: progress_start, progress_end
  use talus_timer, only: timer_start, timer_stop
  implicit none
  private
  public :: stage_run

  !> A change of load between stages that is more than round-off and drizzle, over the load.
  real(dp), parameter :: load_share = 1.0e-4_dp
  !> Steps of a dynamic stage below which its end matters.
  real(dp), parameter :: few_steps = 100.0_dp

contains

  !> Run one stage of the deck.
  subroutine stage_run(session, number, status)
    type(session_t), intent(inout) :: session
    integer, intent(in) :: number !! of the stage
    type(status_t), intent(inout) :: status
    integer :: failed

    session%stage = number
    associate (stage => session%deck%stage(number))
      if (stage%only_after_failure .and. .not. session%lost) return
      call progress_start(session%progress, stage%name)
      call stage_begin(session, stage, status)
      if (status_failed(status)) return
      call timer_start(session%timer, stage%kind)
      select case (stage%kind)
      case ('geostatic')
        call run_geostatic(session, stage, status)
      case ('storm')
        call run_storm(session, stage, status)
      case ('strength_reduction')
        call strength_reduction(session, stage, failed, status)
        if (failed > 0) call report_broken(session, failed, status)
      case default
        call run_dynamic(session, stage, status)
      end select
      call timer_stop(session%timer, stage%kind)
      if (.not. status_failed(status) .and. stage%reset_displacement) call reset(session)
      if (session%deck%output%restart /= 'none') call record_restart(session, status)
      call progress_end(session%progress)
    end associate
  end subroutine stage_run

  !> Conditions, loads, motion and the starting values of the audit.
  subroutine stage_begin(session, stage, status)
    type(session_t), intent(inout) :: session
    type(stage_t), intent(in) :: stage
    type(status_t), intent(inout) :: status
    real(dp), allocatable :: before(:,:)

    call setup_conditions(session%deck, session%disc, stage%name, session%conditions, status)
    if (status_failed(status)) return
    session%stage_start = session%state%time
    session%joint = .false.
    session%new_load = .false.
    associate (state => session%state, disc => session%disc)
      if (session%ground%wet) then
        state%water = water_balance_t()
        state%water%stored_start = audit_stored_water(disc, state)
      end if
      if (stage%solve /= 'seepage') then
        session%motion%local = stage%damping
        session%motion%viscous = 0.0_dp
        session%motion%consistent = stage%mass == 'consistent'
        session%joint = takes_turns(session, stage)
        session%motion%coupled = session%ground%wet .and. stage%solve == 'both' .and. &
          .not. session%joint
        before = state%load
        call take_load(session)
        session%new_load = any(abs(before) > 0.0_dp) .and. &
          maxval(abs(state%load - before)) > load_share*maxval(abs(state%load))
        if (allocated(session%conditions%floor) .and. stage%kind /= 'dynamic') &
          call floor_hold(disc%mesh%x + state%u, session%conditions)
        call motion_prepare(disc, session%ground, session%conditions, state, stage%mass_scaling, &
                            stage%step_safety, session%motion, session%work)
        if (stage%kind == 'dynamic') session%motion%step = fitting_step(session%motion%step, &
                                                                       stage%duration)
        call start_motion(session, stage)
        session%energies_start = audit_energies(disc, session%ground, session%motion, state)
        if (len(session%declared) > 0) session%declared = session%declared//'; '
        session%declared = session%declared//stage%name//': mass scaling '// &
          trim(merge('on ', 'off', stage%mass_scaling))//', '//stage%mass// &
          ' mass, local damping '// &
          text_of(stage%damping)
      else if (allocated(session%motion%mobility)) then
        ! The soil rests, and keeps its energies.
        session%energies_start = audit_energies(disc, session%ground, session%motion, state)
      end if
      if (stage%solve /= 'soil') then
        session%seepage%explicit_only = stage%water_step == 'explicit'
        session%seepage%safety = stage%water_safety
        call seepage_shape(session%seepage, disc, session%ground, session%conditions%inlets, state)
      end if
    end associate
    session%last_good = session%state
  end subroutine stage_begin

  !> A step that ends a dynamic stage of few steps on time; one of many may overrun by its last.
  pure real(dp) function fitting_step(step, duration) result(fitting)
    real(dp), intent(in) :: step, duration !! [s]

    fitting = step
    if (step > duration/few_steps) fitting = duration/real(ceiling(duration/step), dp)
  end function fitting_step

  !> Velocities at the start of a stage: real motion goes on from one dynamic stage to the next, all
  !> else starts at rest, the trials of a strength reduction too, which ends as it began; prescribed
  !> velocities hold at once.
  subroutine start_motion(session, stage)
    type(session_t), intent(inout) :: session
    type(stage_t), intent(in) :: stage
    real(dp) :: before
    integer :: failed

    if (stage%kind == 'strength_reduction') return
    associate (state => session%state, conditions => session%conditions)
      before = state%ahead
      state%ahead = 0.0_dp
      if (stage%kind == 'dynamic') state%ahead = 0.5_dp*session%motion%step
      if (before > 0.0_dp .and. stage%kind == 'dynamic') then
        ! The velocity is half a step ahead, of the new step from now on.
        state%v = state%v + (state%ahead - before)*state%acceleration
      else
        state%v = 0.0_dp
        state%acceleration = 0.0_dp
        ! A failure here shows again in the first step, which reports it.
        if (stage%kind == 'dynamic') call soil_leave_rest(session%disc, session%ground, &
          session%motion, state, session%work, failed)
      end if
      if (abs(stage%spin) > 0.0_dp) state%v = state%v + spinning( &
        session%disc%mesh%x + state%u, state%mass, stage%spin)
      if (stage%kind == 'dynamic') state%v = merge(conditions%given, state%v, conditions%held)
    end associate
  end subroutine start_motion

  !> Velocities of a body that turns about its centre of mass [m/s], (2,n).
  pure function spinning(place, mass, spin) result(v)
    real(dp), intent(in) :: place(:,:) !! [m], (2,n)
    real(dp), intent(in) :: mass(:)    !! [kg/m], (n)
    real(dp), intent(in) :: spin       !! anticlockwise positive [rad/s]
    real(dp) :: v(2, size(mass))

    v(1, :) = -spin*(place(2, :) - sum(mass*place(2, :))/sum(mass))
    v(2, :) = spin*(place(1, :) - sum(mass*place(1, :))/sum(mass))
  end function spinning
end module talus_stages
