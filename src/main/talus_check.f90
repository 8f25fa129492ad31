! SPDX-License-Identifier: MIT
!> `talus check`: the resolved deck, what will be active and what it costs, without stepping.
module talus_check
  use, intrinsic :: iso_fortran_env, only: output_unit
  use talus_kinds, only: dp, i8
  use talus_status, only: status_t, status_failed
  use talus_text, only: text_of
  use talus_deck_types, only: deck_t
  use talus_boundary_sets, only: boundary_set_t, boundary_set_build
  use talus_session, only: session_t
  use talus_run, only: run_prepare
  use talus_setup_conditions, only: setup_conditions
  use talus_relax, only: motion_prepare
  use talus_stage_parts, only: takes_turns
  use talus_soil_step, only: soil_step
  use talus_seepage, only: seepage_shape, seepage_advance, face_fluxes, seepage_step_limit
  use talus_initial, only: weight_load
  use talus_audit, only: audit_load
  use talus_timer, only: timer_now, timer_seconds
  use talus_cost, only: cost_t, cost_of, snapshots_of, snapshot_bytes, restart_bytes
  use talus_seepage_stable, only: seepage_step_stable
  use talus_spectrum, only: spectrum_frequencies, spectrum_rates, spectrum_most_nodes
  implicit none
  private
  public :: check_deck

  !> Steps that are timed on a copy, to estimate the run time.
  integer, parameter :: trial_steps = 10
  !> Sub-steps of the water after which the trial is cut short.
  integer(i8), parameter :: trial_seepage_steps = 200_i8
  !> And the seconds after which it ends with the present step of the storm's clock.
  real(dp), parameter :: trial_seconds = 3.0_dp
  !> What looks at the step, audits and output add to the steps.
  real(dp), parameter :: overhead = 1.5_dp
  !> Soil steps of the search for the time of a failure, for each halving of the storm's step.
  real(dp), parameter :: search_steps = 1500.0_dp
  !> Turns in which water and soil agree on a step of the storm, by experience; loads on saturated
  !> soil take far more.
  real(dp), parameter :: typical_turns = 4.0_dp
  !> Output above which a warning tells how to write less.
  real(dp), parameter :: many_snapshots = 1.0e3_dp, many_bytes = 1.0e10_dp

  !> Sum of all stages.
  type :: estimate_t
    real(dp) :: total = 0.0_dp     !! time of those that run in any case [s]
    real(dp) :: slide = 0.0_dp     !! time that a failure adds [s]
    real(dp) :: snapshots = 0.0_dp
    real(dp) :: bytes = 0.0_dp     !! written
  end type estimate_t

contains

  !> Print the report.
  subroutine check_deck(deck, spectrum, status)
    type(deck_t), intent(in) :: deck
    logical, intent(in) :: spectrum !! also all eigenvalues, of a small model
    type(status_t), intent(inout) :: status
    type(session_t) :: session
    type(estimate_t) :: estimate
    integer :: i

    call run_prepare(deck, session, status)
    if (status_failed(status)) return
    write (output_unit, '(a)') deck%resolved
    call print_model(session)
    call print_boundaries(session)
    estimate%total = timer_seconds(session%timer, 'set_up')
    do i = 1, size(deck%stage)
      call print_stage(session, i, spectrum, estimate, status)
      if (status_failed(status)) return
    end do
    write (output_unit, '(/,2a)') 'estimated run time        ', text_of(estimate%total, 3)// &
      ' s on this machine, within a factor of about 3'
    if (estimate%slide > 0.0_dp) write (output_unit, '(2a)') '  if a storm fails        ', &
      text_of(estimate%slide, 3)//' s more, with the search for the time of failure'
    write (output_unit, '(2a)') 'output                    ', &
      text_of(ceiling(estimate%snapshots, i8))// &
      ' snapshots at most, '//text_of(estimate%bytes*1.0e-6_dp, 3)//' MB on disk'
    if (estimate%snapshots > many_snapshots .or. estimate%bytes > many_bytes) &
      write (output_unit, '(a)') &
      '  warning: that much takes long to write; raise &output snapshot_interval or lower '// &
      '&stage snapshots'
  end subroutine check_deck

  !> Size and active parts.
  subroutine print_model(session)
    type(session_t), intent(in) :: session

    associate (disc => session%disc, state => session%state)
      write (output_unit, '(a)') 'What will be active'
      write (output_unit, '(2a)') 'nodes                     ', text_of(disc%n)
      write (output_unit, '(2a)') 'area                      ', text_of(sum(disc%dual%area))//' m2'
      call neighbours('first-level neighbours', disc%scni%cell_offset)
      if (disc%two_levels) call neighbours('second-level neighbours', disc%two_level%offset)
      call part('soil', session%soil_moves)
      call part('second level of smoothing', disc%two_levels)
      call part('stabilisation', disc%stabilised)
      call part('plasticity', session%soil_moves .and. any(session%ground%law%plasticity /= 0))
      call part('damage', session%soil_moves .and. any(session%ground%law%damage%driver /= 0))
      call part('water', session%ground%wet)
      call part('Bishop stress', session%soil_moves .and. any(session%ground%law%stress == 2))
    end associate
    call print_bytes(session)
  end subroutine print_model

  !> What each boundary has found of the model.
  subroutine print_boundaries(session)
    type(session_t), intent(in) :: session
    type(boundary_set_t) :: set
    type(status_t) :: status
    integer :: i

    do i = 1, size(session%deck%boundary)
      associate (boundary => session%deck%boundary(i))
        call boundary_set_build(set, session%disc%mesh, session%disc%dual, boundary%where, &
          [boundary%from_x, boundary%to_x, boundary%from_y, boundary%to_y], status)
        write (output_unit, '(9a)') 'boundary ', text_of(i), ', ', boundary%where, ': ', &
          text_of(size(set%node)), ' nodes, ', text_of(sum(set%length), 4), ' m of edges'
      end associate
    end do
  end subroutine print_boundaries

  !> Neighbours of a list: least, mean and most.
  subroutine neighbours(name, offset)
    character(*), intent(in) :: name
    integer, intent(in) :: offset(:) !! first entry of each node, (n+1)
    character(26) :: label
    integer :: n

    n = size(offset) - 1
    label = name
    write (output_unit, '(7a)') label, text_of(real(offset(n+1) - 1, dp)/real(n, dp), 3), &
      ' a node, from ', text_of(minval(offset(2:) - offset(:n))), ' to ', &
      text_of(maxval(offset(2:) - offset(:n)))
  end subroutine neighbours

  !> Memory of the run by its parts.
  subroutine print_bytes(session)
    type(session_t), intent(in) :: session
    type(cost_t) :: cost

    cost = cost_of(session)
    write (output_unit, '(5a)') 'memory                    ', megabytes(cost%total), ', ', &
      text_of(int(cost%total/int(session%disc%n, i8))), &
      ' bytes a node; the program itself takes about 20 MB more'
    call line('nodes and cells', cost%cells)
    call line('first level', cost%first)
    call line('second level', cost%second)
    call line('stabilisation', cost%stabilise)
    call line('state and its copy', cost%state)
    call line('within a step', cost%step)
    call line('seepage', cost%seepage)
    call line('implicit seepage', cost%matrix)

  contains

    subroutine line(name, bytes)
      character(*), intent(in) :: name
      integer(i8), intent(in) :: bytes
      character(24) :: label

      if (bytes == 0_i8) return
      label = name
      write (output_unit, '(3a)') '  ', label, megabytes(bytes)
    end subroutine line

    pure function megabytes(bytes) result(text)
      integer(i8), intent(in) :: bytes
      character(:), allocatable :: text

      text = text_of(real(bytes, dp)/1.0e6_dp, 3)//' MB'
    end function megabytes
  end subroutine print_bytes

  subroutine part(name, active)
    character(*), intent(in) :: name
    logical, intent(in) :: active
    character(26) :: label

    label = name
    write (output_unit, '(2a)') label, trim(merge('on ', 'off', active))
  end subroutine part

  !> Steps, estimated time and output of one stage, from a few trial steps on a copy of the state.
  subroutine print_stage(session, number, spectrum, all_stages, status)
    type(session_t), intent(inout) :: session
    integer, intent(in) :: number
    logical, intent(in) :: spectrum
    type(estimate_t), intent(inout) :: all_stages !! those so far
    type(status_t), intent(inout) :: status
    real(dp) :: estimate, looks

    associate (stage => session%deck%stage(number))
      write (output_unit, '(/,5a)') 'stage ', stage%name, ' (', stage%kind, ', '//stage%solve//')'
      call setup_conditions(session%deck, session%disc, stage%name, session%conditions, status)
      if (status_failed(status)) return
      estimate = 0.0_dp
      if (stage%solve /= 'seepage') &
        call print_soil(session, number, spectrum, estimate, all_stages%slide)
      if (stage%solve /= 'soil') call print_seepage(session, number, spectrum, estimate)
      write (output_unit, '(2a)') '  estimated run time      ', text_of(estimate, 3)//' s'// &
        trim(merge(', if it is reached', '                  ', stage%only_after_failure))
      if (stage%only_after_failure) then
        all_stages%slide = all_stages%slide + estimate
      else
        all_stages%total = all_stages%total + estimate
      end if
      looks = 1.0_dp
      if (stage%kind == 'storm') looks = stage%duration/stage%storm_step
      if (stage%kind == 'dynamic') looks = stage%duration/session%motion%step
      call add_output(session, snapshots_of(session, stage, looks), all_stages)
    end associate
  end subroutine print_stage

  !> Add what a stage writes.
  subroutine add_output(session, snapshots, all_stages)
    type(session_t), intent(in) :: session
    real(dp), intent(in) :: snapshots
    type(estimate_t), intent(inout) :: all_stages

    all_stages%snapshots = all_stages%snapshots + snapshots
    all_stages%bytes = all_stages%bytes + snapshots*real(snapshot_bytes(session), dp)
    if (session%deck%output%restart == 'all') all_stages%bytes = all_stages%bytes &
      + snapshots*real(restart_bytes(session), dp)
    if (session%deck%output%restart == 'stages') all_stages%bytes = all_stages%bytes &
      + real(restart_bytes(session), dp)
  end subroutine add_output

  !> Steps of the soil and their time, and those of the search when a storm fails.
  subroutine print_soil(session, number, spectrum, estimate, slide)
    type(session_t), intent(inout) :: session
    integer, intent(in) :: number
    logical, intent(in) :: spectrum
    real(dp), intent(inout) :: estimate !! of the stage so far [s]
    real(dp), intent(inout) :: slide    !! what a failure adds [s]
    real(dp) :: each, steps

    associate (stage => session%deck%stage(number))
      session%motion%coupled = session%ground%wet .and. stage%solve == 'both' .and. &
        .not. takes_turns(session, stage)
      session%motion%local = stage%damping
      session%motion%consistent = stage%mass == 'consistent'
      call motion_prepare(session%disc, session%ground, session%conditions, session%state, &
                          stage%mass_scaling, 1.0_dp, session%motion, session%work)
      write (output_unit, '(2a)') '  stable soil step        ', &
        text_of(session%motion%step, 4)// &
        trim(merge(' s of relaxation (scaled masses)', ' s                              ', &
                   stage%mass_scaling))
      if (spectrum) call print_spectrum(session)
      session%motion%step = stage%step_safety*session%motion%step
      each = time_of_a_step(session)
      steps = turns(session, number)*typical_steps(session, number)
      write (output_unit, '(2a)') '  soil steps, about       ', text_of(steps, 3)
      estimate = overhead*steps*each
      if (stage%kind /= 'storm' .or. all(session%ground%law%plasticity == 0)) return
      steps = search_steps*(1.0_dp + log(stage%storm_step/stage%storm_step_minimum)/log(2.0_dp))
      write (output_unit, '(2a)') '  if it fails, about      ', text_of(steps, 3)// &
        ' more, to find the time of failure'
      slide = slide + overhead*steps*each
    end associate
  end subroutine print_soil

  !> How often a step of the storm's clock is solved, about.
  pure real(dp) function turns(session, number)
    type(session_t), intent(in) :: session
    integer, intent(in) :: number

    turns = merge(typical_turns, 1.0_dp, takes_turns(session, session%deck%stage(number)))
  end function turns

  !> Time of a soil step [s], from a few under load that are taken back.
  real(dp) function time_of_a_step(session) result(each)
    type(session_t), intent(inout) :: session
    real(dp) :: began
    integer :: i, failed

    call audit_load(session%disc%n, weight_load(session%ground, session%state%mass, &
                                                session%conditions%traction), session%state)
    session%last_good = session%state
    began = timer_now()
    do i = 0, trial_steps
      ! The first step warms up.
      if (i == 1) began = timer_now()
      call soil_step(session%disc, session%ground, session%motion, session%state, session%work, &
                     failed)
    end do
    each = (timer_now() - began)/real(trial_steps, dp)
    session%state = session%last_good
  end function time_of_a_step

  !> Soil steps of a stage: exact for real time, by experience for a relaxation.
  real(dp) function typical_steps(session, number) result(steps)
    type(session_t), intent(in) :: session
    integer, intent(in) :: number
    real(dp) :: across

    across = sqrt(real(session%disc%n, dp))
    associate (stage => session%deck%stage(number))
      select case (stage%kind)
      case ('geostatic')
        steps = 25.0_dp + 7.0_dp*across
      case ('storm')
        steps = (45.0_dp + across)*stage%duration/stage%storm_step
      case ('strength_reduction')
        ! Next to the factor of safety a trial takes long.
        steps = 100.0_dp*across*(3.0_dp &
          + log(max(1.0_dp, 0.25_dp*stage%factor_first/stage%factor_tolerance))/log(2.0_dp))
      case default
        steps = stage%duration/session%motion%step
      end select
    end associate
  end function typical_steps

  !> Sub-steps of the water and their time, from a trial with the soil as it is at the start: as
  !> far into the stage as some sub-steps and seconds reach.
  subroutine print_seepage(session, number, spectrum, estimate)
    type(session_t), intent(inout) :: session
    integer, intent(in) :: number
    logical, intent(in) :: spectrum
    real(dp), intent(inout) :: estimate !! of the stage so far [s]
    real(dp) :: began, spent, trial, reached, done, scale
    integer(i8) :: taken

    associate (seepage => session%seepage, disc => session%disc, ground => session%ground, &
               state => session%state, stage => session%deck%stage(number))
      trial = 0.01_dp*stage%duration
      if (stage%kind == 'storm') trial = stage%storm_step
      seepage%explicit_only = stage%water_step == 'explicit'
      seepage%safety = stage%water_safety
      call seepage_shape(seepage, disc, ground, session%conditions%inlets, state)
      call face_fluxes(seepage, disc, ground, state)
      write (output_unit, '(2a)') '  explicit seepage step   ', &
        text_of(seepage_step_limit(seepage, disc, ground, state), 6)//' s at the start, monotone'
      write (output_unit, '(2a)') '  stable seepage step     ', &
        text_of(seepage_step_stable(seepage, disc, ground, state), 6)//' s at the start'
      if (spectrum) call print_rates(session)
      session%last_good = state
      done = 0.0_dp
      taken = 0_i8
      began = timer_now()
      spent = 0.0_dp
      do while (done < 0.999_dp*stage%duration .and. taken < trial_seepage_steps .and. &
                spent < trial_seconds)
        call seepage_advance(seepage, disc, ground, session%conditions%inlets, done, &
          min(trial, stage%duration - done), state, int(trial_seepage_steps - taken), reached)
        done = done + reached
        taken = state%seepage_steps - session%last_good%seepage_steps
        spent = timer_now() - began
      end do
      scale = turns(session, number)*stage%duration/done
      estimate = estimate + spent*scale
      write (output_unit, '(2a)') '  seepage steps, about    ', &
        text_of(real(taken, dp)*scale, 3)//', by the first '// &
        text_of(100.0_dp*done/stage%duration, 2)//' % of the stage'
      state = session%last_good
    end associate
  end subroutine print_seepage

  !> All eigenfrequencies, to compare with the estimate of the step.
  subroutine print_spectrum(session)
    type(session_t), intent(inout) :: session
    real(dp), allocatable :: square(:)
    integer :: i

    if (too_large(session%disc%n)) return
    call spectrum_frequencies(session%disc, session%ground, session%state, session%motion, &
                              session%work, square)
    write (output_unit, '(2a)') '  2/omega_max by LAPACK   ', &
      text_of(2.0_dp/sqrt(square(size(square))), 6)//' s'
    write (output_unit, '(a)') '  omega^2 [1/s2], ascending'
    do i = 1, size(square)
      write (output_unit, '(4x,i6,es16.8)') i, square(i)
    end do
  end subroutine print_spectrum

  !> The step at which the fastest change of pressure neither grows nor decays, from all of them.
  subroutine print_rates(session)
    type(session_t), intent(in) :: session
    complex(dp), allocatable :: rate(:)

    if (too_large(session%disc%n)) return
    call spectrum_rates(session%seepage, session%disc, session%ground, session%state, rate)
    write (output_unit, '(2a)') '  2/lambda_max by LAPACK  ', &
      text_of(2.0_dp/maxval(real(rate, dp)), 6)//' s'
  end subroutine print_rates

  !> Say that a model is too large for all eigenvalues.
  logical function too_large(nodes)
    integer, intent(in) :: nodes

    too_large = nodes > spectrum_most_nodes
    if (too_large) write (output_unit, '(2a)') '  spectrum                only up to nodes: ', &
      text_of(spectrum_most_nodes)
  end function too_large
end module talus_check
