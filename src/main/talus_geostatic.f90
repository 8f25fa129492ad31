! SPDX-License-Identifier: MIT
!> Stage `geostatic`: gravity to equilibrium (src/THEORY.md section 5.3).
module talus_geostatic
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_set, status_failed, status_numeric
  use talus_text, only: text_of
  use talus_deck_types, only: stage_t
  use talus_ground, only: ground_t
  use talus_state, only: state_t
  use talus_soil_law, only: history_eqps, history_plastic_work, history_damage_work, history_size
  use talus_session, only: session_t
  use talus_setup_ground, only: ground_intact
  use talus_initial, only: initial_water
  use talus_relax, only: relax_t, relax, relax_balanced, relax_broken
  use talus_stage_parts, only: report_broken, node_text
  use talus_record, only: record_line, record_snapshot, record_last_good
  implicit none
  private
  public :: run_geostatic, reset

  !> Relaxation steps between two history lines.
  integer, parameter :: relax_chunk = 500

contains

  !> Gravity to equilibrium with the pore pressure as given, in soil that neither softens nor
  !> breaks.
  subroutine run_geostatic(session, stage, status)
    type(session_t), intent(inout) :: session
    type(stage_t), intent(in) :: stage
    type(status_t), intent(inout) :: status
    real(dp), allocatable :: pressure(:)

    ! Elastic first: switching gravity on in a plastic soil would leave the marks of its jolt.
    call settle(session, ground_intact(session%ground, .false.), stage, status)
    call settle(session, ground_intact(session%ground, .true.), stage, status)
    if (status_failed(status)) return
    ! The pore pressure was given for the settled soil.
    if (session%ground%wet) then
      pressure = session%state%pressure
      call initial_water(session%disc, session%ground, pressure, session%state)
    end if
    if (stage%reset_displacement) call reset(session)
    call record_snapshot(session, status)
  end subroutine run_geostatic

  !> Relax to equilibrium in a simplified ground.
  subroutine settle(session, ground, stage, status)
    type(session_t), intent(inout) :: session
    type(ground_t), intent(in) :: ground
    type(stage_t), intent(in) :: stage
    type(status_t), intent(inout) :: status
    type(relax_t) :: outcome
    integer :: done

    done = 0
    do while (.not. status_failed(status))
      call relax(session%disc, ground, session%conditions, session%motion, stage%tolerance, &
                 min(relax_chunk, stage%steps_max - done), huge(1.0_dp), 0.0_dp, &
                 session%state, session%work, outcome)
      done = done + outcome%steps
      if (outcome%outcome == relax_broken) call report_broken(session, outcome%failed, status)
      ! Relaxation brings the force down by a constant factor a step.
      call record_line(session, min(1.0_dp, log(max(outcome%ratio, stage%tolerance)) &
                                            /log(stage%tolerance)), status)
      if (outcome%outcome == relax_balanced) return
      if (done < stage%steps_max .or. status_failed(status)) cycle
      call report_unbalanced(session, stage, outcome%ratio, status)
    end do
  end subroutine settle

  !> Report where the soil found no equilibrium, and save its state.
  subroutine report_unbalanced(session, stage, ratio, status)
    type(session_t), intent(inout) :: session
    type(stage_t), intent(in) :: stage
    real(dp), intent(in) :: ratio !! out-of-balance force over the load
    type(status_t), intent(inout) :: status
    real(dp), allocatable :: force(:), moved(:)
    character(:), allocatable :: saved

    session%last_good = session%state
    call record_last_good(session, saved)
    force = sum(merge(session%work%force, 0.0_dp, session%motion%mobility > 0.0_dp)**2, dim=1)
    moved = norm2(session%state%u - session%state%u_zero, dim=1)
    call status_set(status, status_numeric, 'stage '//stage%name//', time '// &
      text_of(session%state%time)//' s: no equilibrium within steps_max = '// &
      text_of(stage%steps_max)//' steps: out-of-balance force '//text_of(ratio)// &
      ' of the load, allowed '//text_of(stage%tolerance)//', largest at '// &
      node_text(session, maxloc(force, dim=1))//'; largest displacement '// &
      text_of(maxval(moved))//' m at '//node_text(session, maxloc(moved, dim=1))// &
      '; the slope does not stand, or steps_max is too small; '//saved)
  end subroutine report_unbalanced

  !> Plastic strain has softened the stabilisation: keep it there, where forces would jump otherwise.
  pure subroutine keep_settled(state)
    type(state_t), intent(inout) :: state

    if (.not. allocated(state%stiffness)) return
    associate (eqps => state%history(history_eqps, :))
      if (.not. any(eqps > 0.0_dp)) return
      if (.not. allocated(state%settled)) state%settled = 0.0_dp*eqps
      state%settled = state%settled + eqps
    end associate
  end subroutine keep_settled

  !> Count displacement, strain and plastic strain from here. Damage stays: without it the stress
  !> would jump.
  subroutine reset(session)
    type(session_t), intent(inout) :: session

    ! A run of the water alone has nothing to count.
    if (.not. allocated(session%state%u_zero)) return
    session%greatest_displacement = 0.0_dp
    associate (state => session%state)
      state%u_zero = state%u
      state%v = 0.0_dp
      state%ahead = 0.0_dp
      if (allocated(state%strain)) state%strain = 0.0_dp
      if (allocated(state%history)) then
        call keep_settled(state)
        state%history(history_eqps, :) = 0.0_dp
        state%history(history_plastic_work, :) = 0.0_dp
        if (size(state%history, 1) == history_size) &
          state%history(history_damage_work, :) = 0.0_dp
      end if
    end associate
  end subroutine reset
end module talus_geostatic
