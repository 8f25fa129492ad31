! SPDX-License-Identifier: MIT
!> Stage `storm`: the clock of the water, with the soil in equilibrium at each step (src/THEORY.md
!> section 5.6).
module talus_storm
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_failed
  use talus_text, only: text_of
  use talus_deck_types, only: stage_t, deck_given
  use talus_session, only: session_t
  use talus_relax, only: relax_t, relax, motion_prepare, relax_balanced, relax_broken
  use talus_coupling, only: coupling_t, coupling_start, coupling_give, coupling_take, &
    coupling_left, coupling_done, coupling_turns
  use talus_soil_law, only: soil_inverted, plasticity_none
  use talus_stage_parts, only: take_load, move_water, take_back, is_due, put_off, &
    snapshot_interval, report_broken, feel_supports
  use talus_record, only: record_line, record_snapshot
  use talus_progress, only: progress_say
  use talus_timer, only: timer_start, timer_stop
  implicit none
  private
  public :: run_storm

contains

  !> Steps of the storm clock: the water moves, then the soil finds its equilibrium. When it finds
  !> none, the step is taken back and halved, until the time of failure is known.
  subroutine run_storm(session, stage, status)
    type(session_t), intent(inout) :: session
    type(stage_t), intent(in) :: stage
    type(status_t), intent(inout) :: status
    real(dp) :: done, step, next_snapshot, next_line, line_interval, next_window
    logical :: stands, ended

    done = 0.0_dp
    next_window = 0.0_dp
    session%lost = .false.
    step = stage%storm_step
    next_snapshot = snapshot_interval(session, stage)
    line_interval = 0.0_dp
    if (deck_given(session%deck%output%history_interval)) &
      line_interval = session%deck%output%history_interval
    next_line = line_interval
    call record_line(session, 0.0_dp, status)
    call record_snapshot(session, status)
    if (stage%solve /= 'seepage') session%u_window = session%state%u
    if (session%joint .and. session%new_load .and. &
      any(session%ground%law%plasticity /= plasticity_none)) then
      call take_new_load(session, stage, stands, status)
      if (status_failed(status)) return
      if (.not. stands) then
        call lose_balance(session, stage, 0.0_dp)
        call record_line(session, 0.0_dp, status)
        call record_snapshot(session, status)
        return
      end if
    end if
    do while (done < stage%duration*(1.0_dp - 1.0e-12_dp))
      step = min(step, stage%duration - done)
      if (stage%solve /= 'seepage' .and. is_due(done, next_window)) then
        session%u_window = session%state%u
        next_window = done + stage%storm_step
      end if
      session%last_good = session%state
      call storm_step(session, stage, step, stands, status)
      if (status_failed(status)) return
      if (.not. stands) then
        if (step > stage%storm_step_minimum) then
          call take_back(session)
          step = max(0.5_dp*step, stage%storm_step_minimum)
          cycle
        end if
        call lose_balance(session, stage, step)
      end if
      done = done + step
      ended = session%lost .or. is_due(done, stage%duration)
      if (ended .or. is_due(done, next_line)) then
        call record_line(session, done/stage%duration, status)
        call put_off(next_line, done, line_interval)
      end if
      if (ended .or. is_due(done, next_snapshot)) then
        call record_snapshot(session, status)
        call put_off(next_snapshot, done, snapshot_interval(session, stage))
      end if
      if (session%lost .or. status_failed(status)) return
    end do
  end subroutine run_storm

  !> Where water carries load, a load that begins with the stage acts at once, on soil whose water has
  !> had no time to move: the pore pressure follows the pores. Taken by the soil alone it would leave
  !> plastic strain or failure that never were; elastic soil comes back, and goes without. `stands`
  !> tells whether the soil finds its equilibrium so.
  subroutine take_new_load(session, stage, stands, status)
    type(session_t), intent(inout) :: session
    type(stage_t), intent(in) :: stage
    logical, intent(out) :: stands
    type(status_t), intent(inout) :: status

    session%motion%coupled = .true.
    call prepare()
    call find_balance(session, stage, 0.0_dp, stands, status)
    session%motion%coupled = .false.
    ! A shape that broke tells nothing of the step; it is taken back.
    if (stands) call prepare()

  contains

    subroutine prepare()
      call motion_prepare(session%disc, session%ground, session%conditions, session%state, &
        stage%mass_scaling, stage%step_safety, session%motion, session%work)
    end subroutine prepare
  end subroutine take_new_load

  !> Equilibrium is lost in a step, and the soil stays as it was before. The water of the failing step
  !> stays: the slide starts out of balance.
  subroutine lose_balance(session, stage, step)
    type(session_t), intent(inout) :: session
    type(stage_t), intent(in) :: stage
    real(dp), intent(in) :: step !! [s]

    session%lost = .true.
    if (.not. session%failed) session%trigger_time = session%last_good%time
    session%failed = .true.
    call take_back(session)
    if (stage%solve /= 'soil' .and. step > 0.0_dp) call move_water(session, stage, step)
    session%state%time = session%last_good%time + step
    call feel_supports(session)
    call progress_say(session%progress, 'equilibrium lost after '// &
      text_of(session%last_good%time/3600.0_dp)//' h')
  end subroutine lose_balance

  !> One step of the storm clock. `stands` tells whether the soil is in equilibrium after it.
  subroutine storm_step(session, stage, step, stands, status)
    type(session_t), intent(inout) :: session
    type(stage_t), intent(in) :: stage
    real(dp), intent(in) :: step !! [s]
    logical, intent(out) :: stands
    type(status_t), intent(inout) :: status
    type(coupling_t) :: coupling
    real(dp) :: left, before
    integer :: turn

    stands = .true.
    if (.not. session%joint) then
      if (stage%solve /= 'soil') call move_water(session, stage, step)
      session%state%time = session%state%time + step
      if (stage%solve /= 'seepage') call find_balance(session, stage, step, stands, status)
      return
    end if
    call coupling_start(coupling, session%state)
    left = huge(left)
    do turn = 1, coupling_turns
      call coupling_give(coupling, session%disc, session%ground, session%state)
      call move_water(session, stage, step)
      call coupling_take(coupling, session%state)
      session%state%time = session%state%time + step
      call find_balance(session, stage, merge(step, 0.0_dp, turn == 1), stands, status)
      if (.not. stands .or. status_failed(status)) return
      before = left
      left = coupling_left(coupling, session%disc, session%ground, session%state)
      if (coupling_done(before, left)) exit
      if (turn < coupling_turns) session%state%time = session%state%time - step
    end do
    session%coupling_error = max(session%coupling_error, left)
  end subroutine storm_step

  !> Relax under the load of the moment. `stands` tells whether the soil found its equilibrium.
  subroutine find_balance(session, stage, travel, stands, status)
    type(session_t), intent(inout) :: session
    type(stage_t), intent(in) :: stage
    real(dp), intent(in) :: travel !! time that driven nodes move on [s]
    logical, intent(out) :: stands
    type(status_t), intent(inout) :: status
    type(relax_t) :: outcome
    real(dp) :: moved_max, stable

    call take_load(session)
    call timer_start(session%timer, 'soil')
    moved_max = huge(1.0_dp)
    if (deck_given(stage%failure_displacement)) moved_max = stage%failure_displacement
    stable = session%motion%step
    call relax(session%disc, session%ground, session%conditions, session%motion, stage%tolerance, &
               stage%steps_max, moved_max, travel, session%state, session%work, outcome, &
               session%u_window)
    call timer_stop(session%timer, 'soil')
    ! Soil that turns inside out while it looks for equilibrium has found none.
    stands = outcome%outcome == relax_balanced .and. outcome%moved <= moved_max
    if (.not. stands) session%motion%step = stable
    if (outcome%outcome == relax_broken .and. &
        (outcome%failed - 1)/session%disc%n /= soil_inverted) &
      call report_broken(session, outcome%failed, status)
  end subroutine find_balance
end module talus_storm
