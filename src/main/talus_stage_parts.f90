! SPDX-License-Identifier: MIT
!> What several kinds of stage do: take the load, move the water, find balance, go back, report a
!> node that broke, and keep the times of lines and snapshots.
module talus_stage_parts
  use talus_kinds, only: dp, i8
  use talus_status, only: status_t, status_set, status_numeric
  use talus_text, only: text_of
  use talus_deck_types, only: stage_t, deck_given
  use talus_state, only: state_t
  use talus_session, only: session_t
  use talus_soil_step, only: soil_force
  use talus_coupling, only: coupling_needed
  use talus_initial, only: weight_masses, weight_load
  use talus_seepage, only: seepage_shape, seepage_advance
  use talus_audit, only: audit_load
  use talus_soil_law, only: soil_inverted
  use talus_record, only: record_last_good
  use talus_timer, only: timer_start, timer_stop
  implicit none
  private
  public :: take_load, takes_turns, move_water, take_back, feel_supports, is_due, put_off, &
    snapshot_interval, report_broken, node_text

contains

  !> Weight of soil and water now, and tractions.
  subroutine take_load(session)
    type(session_t), intent(inout) :: session

    call weight_masses(session%disc, session%ground, session%state)
    call audit_load(session%disc%n, weight_load(session%ground, session%state%mass, &
                                                session%conditions%traction), session%state)
  end subroutine take_load

  !> Whether water and soil agree by turns in each step of a stage's clock: in a storm, where pore
  !> water carries load.
  pure logical function takes_turns(session, stage)
    type(session_t), intent(in) :: session
    type(stage_t), intent(in) :: stage

    takes_turns = stage%kind == 'storm' .and. stage%solve == 'both' .and. &
      coupling_needed(session%ground)
  end function takes_turns

  !> Move the water for a time, with the soil at rest in its present shape.
  subroutine move_water(session, stage, step)
    type(session_t), intent(inout) :: session
    type(stage_t), intent(in) :: stage
    real(dp), intent(in) :: step !! [s]

    call timer_start(session%timer, 'seepage')
    if (stage%solve == 'both') call seepage_shape(session%seepage, session%disc, session%ground, &
      session%conditions%inlets, session%state)
    call seepage_advance(session%seepage, session%disc, session%ground, session%conditions%inlets, &
      session%state%time - session%stage_start, step, session%state)
    call timer_stop(session%timer, 'seepage')
  end subroutine move_water

  !> Return to the last good state; the steps in vain are counted all the same.
  subroutine take_back(session)
    type(session_t), intent(inout) :: session
    integer(i8) :: steps, seepage_steps

    steps = session%state%steps
    seepage_steps = session%state%seepage_steps
    session%state = session%last_good
    session%state%steps = steps
    session%state%seepage_steps = seepage_steps
  end subroutine take_back

  !> The forces of the state as it is, for the reactions of the next line, where those at hand are of
  !> a trial that was taken back, or none. The state is not touched.
  subroutine feel_supports(session)
    type(session_t), intent(inout) :: session
    type(state_t) :: state
    integer :: failed

    if (.not. session%soil_moves) return
    state = session%state
    call soil_force(session%disc, session%ground, session%motion%coupled, state, session%work, &
      failed)
  end subroutine feel_supports

  !> True when a time is reached, but for round-off.
  pure logical function is_due(time, due)
    real(dp), intent(in) :: time, due !! [s]

    is_due = time >= due*(1.0_dp - 1.0e-9_dp)
  end function is_due

  !> Put off a regular event to its first time after `time`.
  pure subroutine put_off(due, time, interval)
    real(dp), intent(inout) :: due          !! [s]
    real(dp), intent(in) :: time, interval  !! [s]

    if (.not. is_due(time, due)) return
    due = due + interval
    if (interval > 0.0_dp .and. is_due(time, due)) &
      due = due + interval*aint((time - due)/interval + 1.0_dp)
  end subroutine put_off

  !> Time between two snapshots of a stage [s].
  pure real(dp) function snapshot_interval(session, stage) result(interval)
    type(session_t), intent(in) :: session
    type(stage_t), intent(in) :: stage

    interval = huge(1.0_dp)
    if (deck_given(session%deck%output%snapshot_interval)) then
      interval = session%deck%output%snapshot_interval
    else if (stage%snapshots > 0) then
      interval = stage%duration/real(stage%snapshots, dp)
    end if
  end function snapshot_interval

  !> Report the node that broke and save the last good state.
  subroutine report_broken(session, failed, status)
    type(session_t), intent(inout) :: session
    integer, intent(in) :: failed !! code*n + node
    type(status_t), intent(inout) :: status
    integer :: node, code
    character(:), allocatable :: what, saved

    code = (failed - 1)/session%disc%n
    node = failed - code*session%disc%n
    call record_last_good(session, saved)
    what = 'the stress is not a finite number'
    if (code == soil_inverted) what = 'the soil is turned inside out (det F <= 0)'
    call status_set(status, status_numeric, 'stage '//session%deck%stage(session%stage)%name// &
      ', time '//text_of(session%state%time)//' s, step '//text_of(session%state%steps)// &
      ', '//node_text(session, node)//': '//what//'; '//saved)
  end subroutine report_broken

  !> A node by its number and where it was at the start.
  function node_text(session, node) result(text)
    type(session_t), intent(in) :: session
    integer, intent(in) :: node
    character(:), allocatable :: text

    text = 'node '//text_of(node)//' at ('//text_of(session%disc%mesh%x(1, node))//', '// &
      text_of(session%disc%mesh%x(2, node))//') m'
  end function node_text
end module talus_stage_parts
