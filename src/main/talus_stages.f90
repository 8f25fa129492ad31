! SPDX-License-Identifier: MIT
!> The kinds of stage (src/THEORY.md sections 5.3, 5.6 and 5.7; for 5.9 see
!> talus_strength_reduction): each is the ordered list of what happens; the work is in step/.
module talus_stages
  use talus_kinds, only: dp, i8
  use talus_status, only: status_t, status_set, status_failed, status_numeric
  use talus_text, only: text_of
  use talus_deck_types, only: stage_t, deck_given
  use talus_ground, only: ground_t
  use talus_state, only: water_balance_t
  use talus_session, only: session_t
  use talus_setup_ground, only: ground_intact
  use talus_setup_conditions, only: setup_conditions
  use talus_conditions, only: conditions_follow
  use talus_floor, only: floor_land
  use talus_initial, only: initial_water, weight_masses, weight_load
  use talus_soil_step, only: soil_step, soil_force, soil_leave_rest
  use talus_relax, only: relax_t, relax, motion_prepare, motion_shorten, largest_motion, &
    relax_balanced, relax_broken
  use talus_seepage, only: seepage_shape, seepage_advance, face_fluxes, seepage_step_limit
  use talus_coupling, only: coupling_t, coupling_needed, coupling_start, coupling_give, &
    coupling_take, coupling_left, coupling_done, coupling_turns
  use talus_audit, only: audit_energies, audit_load, audit_driven, audit_stored_water, energies_t
  use talus_soil_law, only: soil_inverted
  use talus_strength_reduction, only: strength_reduction
  use talus_record, only: record_line, record_snapshot, record_restart, record_last_good
  use talus_progress, only: progress_start, progress_end, progress_say
  use talus_timer, only: timer_start, timer_stop
  implicit none
  private
  public :: stage_run

  !> Relaxation steps between two history lines of a geostatic stage.
  integer, parameter :: relax_chunk = 500
  !> History lines of a dynamic stage when the deck does not say.
  integer, parameter :: dynamic_lines = 200
  !> Part of a dynamic stage before which rest is not believed: a slide starts slowly.
  real(dp), parameter :: rest_share = 0.05_dp
  !> Real-time steps between two looks at how far the soil has moved; the stable step is found again
  !> when that is more than this part of the node spacing, and with moving pore water now and then.
  integer(i8), parameter :: look_every = 20_i8, refresh_every = 240_i8
  real(dp), parameter :: refresh_travel = 0.02_dp

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
        if (failed > 0) call fail(session, failed, status)
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

    call setup_conditions(session%deck, session%disc, stage%name, session%conditions, status)
    if (status_failed(status)) return
    session%stage_start = session%state%time
    associate (state => session%state, disc => session%disc)
      if (session%ground%wet) then
        state%water = water_balance_t()
        state%water%stored_start = audit_stored_water(disc, state)
      end if
      if (stage%solve /= 'seepage') then
        session%motion%local = stage%damping
        session%motion%viscous = 0.0_dp
        session%motion%consistent = stage%mass == 'consistent'
        session%joint = stage%kind == 'storm' .and. stage%solve == 'both' .and. &
          coupling_needed(session%ground)
        session%motion%coupled = session%ground%wet .and. stage%solve == 'both' .and. &
          .not. session%joint
        call take_load(session)
        call motion_prepare(disc, session%ground, session%conditions, state, stage%mass_scaling, &
                            stage%step_safety, session%motion, session%work)
        call start_motion(session, stage)
        session%energies_start = audit_energies(disc, session%ground, session%motion, state)
        session%declared = session%declared//stage%name//': mass scaling '// &
          trim(merge('on ', 'off', stage%mass_scaling))//', '//stage%mass// &
          ' mass, local damping '// &
          text_of(stage%damping)//'; '
      end if
      if (stage%solve /= 'soil') then
        session%seepage%explicit_only = stage%water_step == 'explicit'
        session%seepage%safety = stage%water_safety
        call seepage_shape(session%seepage, disc, session%ground, session%conditions%inlets, state)
      end if
    end associate
    session%last_good = session%state
  end subroutine stage_begin

  !> Velocities at the start of a stage: real motion goes on from one dynamic stage to the next, all
  !> else starts at rest; prescribed velocities hold at once.
  subroutine start_motion(session, stage)
    type(session_t), intent(inout) :: session
    type(stage_t), intent(in) :: stage
    real(dp) :: before
    integer :: failed

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

  !> Weight of soil and water now, and tractions.
  subroutine take_load(session)
    type(session_t), intent(inout) :: session

    call weight_masses(session%disc, session%ground, session%state)
    call audit_load(session%disc%n, weight_load(session%ground, session%state%mass, &
                                                session%conditions%traction), session%state)
  end subroutine take_load

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
      if (outcome%outcome == relax_broken) call fail(session, outcome%failed, status)
      ! Relaxation brings the force down by a constant factor a step.
      call record_line(session, min(1.0_dp, log(max(outcome%ratio, stage%tolerance)) &
                                            /log(stage%tolerance)), status)
      if (outcome%outcome == relax_balanced) return
      if (done < stage%steps_max .or. status_failed(status)) cycle
      session%last_good = session%state
      call record_last_good(session)
      call status_set(status, status_numeric, 'stage '//stage%name//': no equilibrium within '// &
        'steps_max = '//text_of(stage%steps_max)//' steps: out-of-balance force '// &
        text_of(outcome%ratio)//' of the load, allowed '//text_of(stage%tolerance)// &
        ', largest displacement '//text_of(largest_motion(session%disc%n, session%state%u, &
        session%state%u_zero))//' m; the slope does not stand, or steps_max is too small')
    end do
  end subroutine settle

  !> Count displacement, strain and the history of the soil from here.
  subroutine reset(session)
    type(session_t), intent(inout) :: session

    session%greatest_displacement = 0.0_dp
    associate (state => session%state)
      state%u_zero = state%u
      state%v = 0.0_dp
      state%ahead = 0.0_dp
      if (allocated(state%strain)) state%strain = 0.0_dp
      if (allocated(state%history)) state%history = 0.0_dp
    end associate
  end subroutine reset

  !> Steps of the storm clock: the water moves, then the soil finds its equilibrium. When it finds
  !> none, the step is taken back and halved, until the time of failure is known.
  subroutine run_storm(session, stage, status)
    type(session_t), intent(inout) :: session
    type(stage_t), intent(in) :: stage
    type(status_t), intent(inout) :: status
    real(dp) :: done, step, next_snapshot, next_line, line_interval
    logical :: stands, ended

    done = 0.0_dp
    session%lost = .false.
    step = stage%storm_step
    next_snapshot = snapshot_interval(session, stage)
    line_interval = 0.0_dp
    if (deck_given(session%deck%output%history_interval)) &
      line_interval = session%deck%output%history_interval
    next_line = line_interval
    call record_line(session, 0.0_dp, status)
    call record_snapshot(session, status)
    do while (done < stage%duration*(1.0_dp - 1.0e-12_dp))
      step = min(step, stage%duration - done)
      session%last_good = session%state
      call storm_step(session, stage, step, stands, status)
      if (status_failed(status)) return
      if (.not. stands) then
        if (step > stage%storm_step_minimum) then
          call take_back(session)
          step = max(0.5_dp*step, stage%storm_step_minimum)
          cycle
        end if
        session%lost = .true.
        if (.not. session%failed) session%trigger_time = session%last_good%time
        session%failed = .true.
        ! The water of the failing step stays: the slide starts out of balance.
        call take_back(session)
        if (stage%solve /= 'soil') call move_water(session, stage, step)
        session%state%time = session%last_good%time + step
        call progress_say(session%progress, 'equilibrium lost after '// &
          text_of(session%last_good%time/3600.0_dp)//' h')
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
               stage%steps_max, moved_max, travel, session%state, session%work, outcome)
    call timer_stop(session%timer, 'soil')
    ! Soil that turns inside out while it looks for equilibrium has found none.
    stands = outcome%outcome == relax_balanced
    if (.not. stands) session%motion%step = stable
    if (outcome%outcome == relax_broken .and. &
        (outcome%failed - 1)/session%disc%n /= soil_inverted) &
      call fail(session, outcome%failed, status)
  end subroutine find_balance

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

  !> Real time with true masses, until the duration or until the soil rests.
  subroutine run_dynamic(session, stage, status)
    type(session_t), intent(inout) :: session
    type(stage_t), intent(in) :: stage
    type(status_t), intent(inout) :: status
    real(dp) :: travelled
    real(dp) :: done, since_water, water_interval, next_line, next_snapshot, line_interval, speed
    integer :: failed

    done = 0.0_dp
    since_water = 0.0_dp
    travelled = 0.0_dp
    line_interval = stage%duration/real(dynamic_lines, dp)
    if (deck_given(session%deck%output%history_interval)) &
      line_interval = session%deck%output%history_interval
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
    do while (done < stage%duration .and. .not. status_failed(status))
      call timer_start(session%timer, 'soil')
      call look_at_step(session, travelled)
      if (allocated(session%conditions%motion)) call conditions_follow(session%conditions, &
        session%disc%mesh%x, session%state%u, session%motion%step, session%motion%step, &
        session%state%v)
      if (session%conditions%driven) call audit_driven(session%motion, session%work%force, &
                                                       session%state)
      call soil_step(session%disc, session%ground, session%motion, session%state, session%work, &
                     failed)
      call timer_stop(session%timer, 'soil')
      if (failed > 0) then
        call fail(session, failed, status)
        return
      end if
      if (session%conditions%driven) call audit_driven(session%motion, session%work%force, &
                                                       session%state)
      if (allocated(session%conditions%floor)) call floor_land(session%conditions%floor, &
        session%disc%mesh%x, session%motion, session%state)
      done = done + session%motion%step
      since_water = since_water + session%motion%step
      session%state%time = session%state%time + session%motion%step
      if (stage%solve == 'both' .and. since_water >= water_interval) then
        session%state%time = session%state%time - since_water
        call move_water(session, stage, since_water)
        session%state%time = session%state%time + since_water
        call take_load(session)
        since_water = 0.0_dp
        water_interval = water_pace(session, stage)
      end if
      if (done < min(next_line, next_snapshot, stage%duration)) cycle
      call put_off(next_line, done, line_interval)
      call record_line(session, done/stage%duration, status)
      session%last_good = session%state
      speed = sqrt(maxval(sum(session%state%v**2, dim=1)))
      if (done >= next_snapshot .and. done < stage%duration) then
        call record_snapshot(session, status)
        call put_off(next_snapshot, done, snapshot_interval(session, stage))
      end if
      if (speed < stage%rest_velocity .and. done > rest_share*stage%duration) exit
    end do
    call record_snapshot(session, status)
  end subroutine run_dynamic

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
  subroutine fail(session, failed, status)
    type(session_t), intent(inout) :: session
    integer, intent(in) :: failed !! code*n + node
    type(status_t), intent(inout) :: status
    integer :: node, code
    character(:), allocatable :: what

    code = (failed - 1)/session%disc%n
    node = failed - code*session%disc%n
    what = 'the stress is not a finite number'
    if (code == soil_inverted) what = 'the soil is turned inside out (det F <= 0)'
    call status_set(status, status_numeric, 'stage '//session%deck%stage(session%stage)%name// &
      ', time '//text_of(session%state%time)//' s, step '//text_of(session%state%steps)// &
      ', node '//text_of(node)//' at ('//text_of(session%disc%mesh%x(1, node))//', '// &
      text_of(session%disc%mesh%x(2, node))//') m: '//what//'; last good state at '// &
      text_of(session%last_good%time)//' s saved as snapshot last_good')
    call record_last_good(session)
  end subroutine fail
end module talus_stages
