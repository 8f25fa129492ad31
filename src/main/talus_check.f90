! SPDX-License-Identifier: MIT
!> `talus check`: the resolved deck, what will be active and what it costs, without stepping.
module talus_check
  use, intrinsic :: iso_fortran_env, only: output_unit
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_failed
  use talus_text, only: text_of
  use talus_deck_types, only: deck_t
  use talus_session, only: session_t
  use talus_run, only: run_prepare
  use talus_setup_conditions, only: setup_conditions
  use talus_relax, only: motion_prepare
  use talus_soil_step, only: soil_step
  use talus_seepage, only: seepage_shape, face_fluxes, seepage_step_limit
  use talus_initial, only: weight_load
  use talus_audit, only: audit_load
  use talus_timer, only: timer_now
  use talus_report, only: peak_memory_bytes
  use talus_spectrum, only: spectrum_frequencies, spectrum_most_nodes
  implicit none
  private
  public :: check_deck

  !> Steps that are timed on a copy, to estimate the run time.
  integer, parameter :: trial_steps = 10

contains

  !> Print the report.
  subroutine check_deck(deck, spectrum, status)
    type(deck_t), intent(in) :: deck
    logical, intent(in) :: spectrum !! also all eigenvalues, of a small model
    type(status_t), intent(inout) :: status
    type(session_t) :: session
    integer :: i

    call run_prepare(deck, session, status)
    if (status_failed(status)) return
    write (output_unit, '(a)') deck%resolved
    call print_model(session)
    do i = 1, size(deck%stage)
      call print_stage(session, i, spectrum, status)
      if (status_failed(status)) return
    end do
    write (output_unit, '(2a)') 'memory now                ', &
      text_of(real(peak_memory_bytes(), dp)/1.0e6_dp, 4)//' MB'
  end subroutine check_deck

  !> Size and active parts.
  subroutine print_model(session)
    type(session_t), intent(in) :: session

    associate (disc => session%disc, state => session%state)
      write (output_unit, '(a)') 'What will be active'
      write (output_unit, '(2a)') 'nodes                     ', text_of(disc%n)
      write (output_unit, '(2a)') 'area                      ', text_of(sum(disc%dual%area))//' m2'
      write (output_unit, '(2a)') 'first-level neighbours    ', &
        text_of(real(size(disc%scni%node), dp)/real(disc%n, dp), 4)//' a node'
      if (disc%two_levels) write (output_unit, '(2a)') 'second-level neighbours   ', &
        text_of(real(size(disc%two_level%cell), dp)/real(disc%n, dp), 4)//' a node'
      call part('second level of smoothing', disc%two_levels)
      call part('stabilisation', disc%stabilised)
      call part('plasticity', any(session%ground%law%plasticity /= 0))
      call part('damage', any(session%ground%law%damage%driver /= 0))
      call part('water', session%ground%wet)
      call part('Bishop stress', any(session%ground%law%stress == 2))
      write (output_unit, '(2a)') 'bytes of state a node     ', text_of(state_bytes(session))
    end associate
  end subroutine print_model

  subroutine part(name, active)
    character(*), intent(in) :: name
    logical, intent(in) :: active
    character(26) :: label

    label = name
    write (output_unit, '(2a)') label, trim(merge('on ', 'off', active))
  end subroutine part

  !> Bytes a node takes in the state and the operators: 8 a real, 4 an index.
  integer function state_bytes(session) result(bytes)
    type(session_t), intent(in) :: session
    integer :: reals, first

    associate (state => session%state, disc => session%disc)
      first = size(disc%scni%node)/disc%n
      reals = 12 + 4 + 4 + 2 + 12 + 4 + 4*first
      if (allocated(state%strain)) reals = reals + 4
      if (allocated(state%history)) reals = reals + size(state%history, 1)
      if (allocated(state%content)) reals = reals + 8
      if (disc%stabilised) reals = reals + 4
      bytes = 8*reals + 4*2*first
      if (disc%two_levels) bytes = bytes + 12*(size(disc%two_level%cell)/disc%n)
      if (disc%stabilised) bytes = bytes + 28*(size(disc%stabilise%node)/disc%n)
    end associate
  end function state_bytes

  !> Steps and estimated time of one stage, from a few trial steps on a copy of the state.
  subroutine print_stage(session, number, spectrum, status)
    type(session_t), intent(inout) :: session
    integer, intent(in) :: number
    logical, intent(in) :: spectrum
    type(status_t), intent(inout) :: status
    real(dp) :: began, each, steps, estimate
    integer :: i, failed

    associate (stage => session%deck%stage(number))
      write (output_unit, '(/,5a)') 'stage ', stage%name, ' (', stage%kind, ', '//stage%solve//')'
      call setup_conditions(session%deck, session%disc, stage%name, session%conditions, status)
      if (status_failed(status)) return
      estimate = 0.0_dp
      if (stage%solve /= 'seepage') then
        session%motion%coupled = session%ground%wet .and. stage%solve == 'both'
        session%motion%local = stage%damping
        call motion_prepare(session%disc, session%ground, session%conditions, session%state, &
                            stage%mass_scaling, 1.0_dp, session%motion, session%work)
        write (output_unit, '(2a)') '  stable soil step        ', text_of(session%motion%step, 4)// &
          trim(merge(' s of relaxation (scaled masses)', ' s                              ', &
                     stage%mass_scaling))
        if (spectrum) call print_spectrum(session)
        session%motion%step = stage%step_safety*session%motion%step
        call audit_load(session%disc%n, weight_load(session%ground, session%state%mass, &
                                                    session%conditions%traction), session%state)
        session%last_good = session%state
        began = timer_now()
        do i = 1, trial_steps
          call soil_step(session%disc, session%ground, session%motion, session%state, session%work, &
                         failed)
        end do
        each = (timer_now() - began)/real(trial_steps, dp)
        session%state = session%last_good
        steps = typical_steps(session, number)
        write (output_unit, '(2a)') '  soil steps, about       ', text_of(steps, 3)
        estimate = steps*each
      end if
      if (stage%solve /= 'soil') call print_seepage(session, number, estimate)
      write (output_unit, '(2a)') '  estimated run time      ', text_of(estimate, 3)//' s'
    end associate
  end subroutine print_stage

  !> Soil steps of a stage: exact for real time, by experience for a relaxation.
  real(dp) function typical_steps(session, number) result(steps)
    type(session_t), intent(in) :: session
    integer, intent(in) :: number
    real(dp) :: across

    across = sqrt(real(session%disc%n, dp))
    associate (stage => session%deck%stage(number))
      select case (stage%kind)
      case ('geostatic')
        steps = 40.0_dp*across
      case ('storm')
        steps = 10.0_dp*across*stage%duration/stage%storm_step
      case default
        steps = stage%duration/session%motion%step
      end select
    end associate
  end function typical_steps

  !> Sub-steps of the water and their time, from the state at the start.
  subroutine print_seepage(session, number, estimate)
    type(session_t), intent(inout) :: session
    integer, intent(in) :: number
    real(dp), intent(inout) :: estimate !! of the stage so far [s]
    real(dp) :: began, limit, each
    integer :: i

    associate (seepage => session%seepage, disc => session%disc, ground => session%ground, &
               state => session%state, stage => session%deck%stage(number))
      call seepage_shape(seepage, disc, ground, session%conditions%inlets, state)
      began = timer_now()
      do i = 1, trial_steps
        call face_fluxes(seepage, disc, ground, state)
        limit = seepage_step_limit(seepage, disc, ground, state)
      end do
      ! Fluxes and limit are about half of a sub-step.
      each = 2.0_dp*(timer_now() - began)/real(trial_steps, dp)
      write (output_unit, '(2a)') '  stable seepage step     ', text_of(limit, 4)//' s at the start'
      write (output_unit, '(2a)') '  seepage steps, at least ', &
        text_of(max(1.0_dp, stage%duration/limit), 3)
      estimate = estimate + each*stage%duration/limit
    end associate
  end subroutine print_seepage

  !> All eigenfrequencies, to compare with the estimate of the step.
  subroutine print_spectrum(session)
    type(session_t), intent(inout) :: session
    real(dp), allocatable :: square(:)
    integer :: i

    if (session%disc%n > spectrum_most_nodes) then
      write (output_unit, '(2a)') '  spectrum                only up to nodes: ', &
        text_of(spectrum_most_nodes)
      return
    end if
    call spectrum_frequencies(session%disc, session%ground, session%state, session%motion, &
                              session%work, square)
    write (output_unit, '(2a)') '  2/omega_max by LAPACK   ', &
      text_of(2.0_dp/sqrt(square(size(square))), 6)//' s'
    write (output_unit, '(a)') '  omega^2 [1/s2], ascending'
    do i = 1, size(square)
      write (output_unit, '(4x,i6,es16.8)') i, square(i)
    end do
  end subroutine print_spectrum
end module talus_check
