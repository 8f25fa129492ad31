! SPDX-License-Identifier: MIT
!> Stage `dynamic`: real time with true masses (src/THEORY.md section 5.7).
module talus_dynamic
  use talus_kinds, only: dp, i8
  use talus_status, only: status_t, status_failed, status_set, status_numeric
  use talus_text, only: text_of
  use talus_deck_types, only: stage_t, deck_given
  use talus_session, only: session_t
  use talus_conditions, only: conditions_follow
  use talus_floor, only: floor_land
  use talus_soil_step, only: soil_step, soil_force
  use talus_relax, only: motion_shorten
  use talus_seepage, only: face_fluxes, seepage_step_limit
  use talus_audit, only: audit_driven
  use talus_stage_parts, only: take_load, move_water, is_due, put_off, snapshot_interval, &
    report_broken
  use talus_record, only: record_line, record_snapshot, record_last_good
  use talus_timer, only: timer_start, timer_stop
  implicit none
  private
  public :: run_dynamic, step_collapsed

  !> History lines of a dynamic stage when the deck does not say.
  integer, parameter :: dynamic_lines = 200
  !> Part of a dynamic stage before which rest is not believed: a slide starts slowly.
  real(dp), parameter :: rest_share = 0.05_dp
  !> Real-time steps between two looks at how far the soil has moved; the stable step is found again
  !> when that is more than this part of the node spacing, and with moving pore water now and then.
  integer(i8), parameter :: look_every = 20_i8, refresh_every = 240_i8
  real(dp), parameter :: refresh_travel = 0.02_dp
  !> A step shorter than this part of the stage's first has collapsed. Soil that is squeezed to a
  !> fiftieth, and water that stiffens it a thousandfold, shorten it by 1e4 together.
  real(dp), parameter :: collapse_share = 1.0e-6_dp

contains

  !> Real time with true masses, until the duration or until the soil rests.
  subroutine run_dynamic(session, stage, status)
    type(session_t), intent(inout) :: session
    type(stage_t), intent(in) :: stage
    type(status_t), intent(inout) :: status
    real(dp) :: travelled, step_first
    real(dp) :: done, since_water, water_interval, next_line, next_snapshot, line_interval
    integer :: failed
    logical :: over, due

    done = 0.0_dp
    step_first = session%motion%step
    since_water = 0.0_dp
    travelled = 0.0_dp
    line_interval = line_pace(session, stage)
    next_line = line_interval
    next_snapshot = snapshot_interval(session, stage)
    water_interval = water_pace(session, stage)
    call record_line(session, 0.0_dp, status)
    call record_snapshot(session, status)
    session%last_good = session%state
    ! The forces that driven nodes feel at the start, for the account of their work.
    failed = 0
    if (session%conditions%driven) call soil_force(session%disc, session%ground, &
      session%motion%coupled, session%state, session%work, failed)
    over = .false.
    do while (.not. (over .or. status_failed(status)))
      call timer_start(session%timer, 'soil')
      call look_at_step(session, travelled)
      if (step_collapsed(session%motion%step, step_first, stage%duration)) then
        call report_collapse(session, step_first, status)
        return
      end if
      call advance(session, failed)
      call timer_stop(session%timer, 'soil')
      if (failed > 0) then
        call report_broken(session, failed, status)
        return
      end if
      done = done + session%motion%step
      since_water = since_water + session%motion%step
      session%state%time = session%state%time + session%motion%step
      over = is_due(done, stage%duration)
      due = over .or. done >= min(next_line, next_snapshot)
      if (due .and. .not. over) over = done > rest_share*stage%duration .and. &
        sqrt(maxval(sum(session%state%v**2, dim=1))) < stage%rest_velocity
      ! The water of the whole stage moves, also of the last part of an interval.
      if (stage%solve == 'both' .and. (over .or. since_water >= water_interval)) then
        session%state%time = session%state%time - since_water
        call move_water(session, stage, since_water)
        session%state%time = session%state%time + since_water
        call take_load(session)
        since_water = 0.0_dp
        water_interval = water_pace(session, stage)
      end if
      if (.not. due) cycle
      call put_off(next_line, done, line_interval)
      call record_line(session, done/stage%duration, status)
      session%last_good = session%state
      if (done >= next_snapshot .and. .not. over) then
        call record_snapshot(session, status)
        call put_off(next_snapshot, done, snapshot_interval(session, stage))
      end if
    end do
    call record_snapshot(session, status)
  end subroutine run_dynamic

  !> One step of the soil, with driven nodes, the account of their work, and the floor.
  subroutine advance(session, failed)
    type(session_t), intent(inout) :: session
    integer, intent(out) :: failed !! see soil_step

    associate (disc => session%disc, conditions => session%conditions, motion => session%motion, &
               state => session%state, work => session%work)
      if (allocated(conditions%motion)) call conditions_follow(conditions, disc%mesh%x, state%u, &
        motion%step, motion%step, state%v)
      if (conditions%driven) call audit_driven(motion, work%force, state)
      call soil_step(disc, session%ground, motion, state, work, failed)
      if (failed > 0) return
      if (conditions%driven) call audit_driven(motion, work%force, state)
      if (allocated(conditions%floor)) call floor_land(conditions%floor, disc%mesh%x, motion, state)
    end associate
  end subroutine advance

  !> Time between two history lines [s].
  pure real(dp) function line_pace(session, stage) result(interval)
    type(session_t), intent(in) :: session
    type(stage_t), intent(in) :: stage

    interval = stage%duration/real(dynamic_lines, dp)
    if (deck_given(session%deck%output%history_interval)) &
      interval = session%deck%output%history_interval
  end function line_pace

  !> True when a step is too short for time to reach the end of the stage, or is not a number.
  pure logical function step_collapsed(step, first, duration)
    real(dp), intent(in) :: step     !! [s]
    real(dp), intent(in) :: first    !! step at the start of the stage [s]
    real(dp), intent(in) :: duration !! of the stage [s]

    step_collapsed = .not. (step >= collapse_share*first .and. duration + step > duration)
  end function step_collapsed

  !> Report a stable step that has collapsed, and save the last good state.
  subroutine report_collapse(session, step_first, status)
    type(session_t), intent(inout) :: session
    real(dp), intent(in) :: step_first !! step at the start of the stage [s]
    type(status_t), intent(inout) :: status
    character(:), allocatable :: saved

    call timer_stop(session%timer, 'soil')
    call record_last_good(session, saved)
    call status_set(status, status_numeric, 'stage '//session%deck%stage(session%stage)%name// &
      ', time '//text_of(session%state%time)//' s, step '//text_of(session%state%steps)// &
      ': the stable step of the soil has fallen from '//text_of(step_first)//' to '// &
      text_of(session%motion%step)//' s, too short for time to go on; '//saved)
  end subroutine report_collapse

  !> Find the stable step again where the soil has moved enough to change it.
  subroutine look_at_step(session, travelled)
    type(session_t), intent(inout) :: session
    real(dp), intent(inout) :: travelled !! bound of the motion since the last time [m]
    real(dp) :: spacing

    associate (disc => session%disc, state => session%state, motion => session%motion)
      if (modulo(state%steps, look_every) /= 0_i8) return
      travelled = travelled + real(look_every, dp)*motion%step*sqrt(maxval(sum(state%v**2, dim=1)))
      spacing = sqrt(sum(disc%dual%area)/real(disc%n, dp))
      if (travelled < refresh_travel*spacing .and. .not. (motion%stiffens .and. &
          modulo(state%steps, refresh_every) == 0_i8)) return
      call motion_shorten(disc, session%ground, state, motion, session%work)
      travelled = 0.0_dp
    end associate
  end subroutine look_at_step

  !> Time between two moves of the water in real time [s]: its stable step, or a hundredth of the
  !> stage, but one soil step at least.
  real(dp) function water_pace(session, stage) result(interval)
    type(session_t), intent(inout) :: session
    type(stage_t), intent(in) :: stage

    interval = huge(1.0_dp)
    if (stage%solve /= 'both') return
    call face_fluxes(session%seepage, session%disc, session%ground, session%state)
    interval = seepage_step_limit(session%seepage, session%disc, session%ground, session%state)
    interval = max(session%motion%step, min(interval, 0.01_dp*stage%duration))
  end function water_pace
end module talus_dynamic
