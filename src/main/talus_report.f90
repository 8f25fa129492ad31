! SPDX-License-Identifier: MIT
!> The summary of a run, one `key = value` a line, in SI units.
module talus_report
  use, intrinsic :: iso_fortran_env, only: compiler_version
  use omp_lib, only: omp_get_max_threads
  use talus_kinds, only: dp, i8
  use talus_memory, only: memory_held
  use talus_status, only: status_t, status_failed
  use talus_text, only: text_of, text_as_word
  use talus_deck_types, only: deck_given
  use talus_session, only: session_t
  use talus_soil_law, only: plasticity_none
  use talus_strength, only: strength_cone
  use talus_drucker_prager, only: cone_t
  use talus_summary, only: summary_create, summary_set, summary_write
  use talus_report_factor, only: report_factors
  use talus_timer, only: timer_seconds, timer_names
  use talus_version, only: version, git_hash
  implicit none
  private
  public :: report_summary

contains

  !> Write the summary. `outcome` is that of the run.
  subroutine report_summary(session, outcome, warning, status)
    type(session_t), intent(inout) :: session
    type(status_t), intent(in) :: outcome
    character(:), allocatable, intent(out) :: warning !! about what the run found, '' for none
    type(status_t), intent(inout) :: status

    warning = warning_of(session)
    associate (summary => session%summary)
      call summary_create(summary, session%base//'_summary.txt')
      call summary_set(summary, 'title', session%deck%run%title)
      call summary_set(summary, 'version', version)
      call summary_set(summary, 'git_hash', git_hash)
      call summary_set(summary, 'compiler', compiler_version())
      call summary_set(summary, 'exit_code', outcome%code)
      if (status_failed(outcome)) call summary_set(summary, 'failure', outcome%message)
      if (len(warning) > 0) call summary_set(summary, 'warning', warning)
      if (len(session%restart_name) > 0) then
        call summary_set(summary, 'started_from', session%deck%initial%from_result)
        call summary_set(summary, 'started_from_snapshot', session%restart_name)
      end if
      call report_model(session)
      call report_cost(session)
      call report_answers(session)
      call report_factors(session)
      call summary_write(summary, status)
    end associate
  end subroutine report_summary

  !> What makes the results doubtful although the run ended well, '' for nothing. Soil may fall as
  !> far as its floor, and a body that spins may turn over.
  function warning_of(session) result(warning)
    type(session_t), intent(in) :: session
    character(:), allocatable :: warning
    real(dp) :: size, lowest(2)

    warning = ''
    associate (deck => session%deck, x => session%disc%mesh%x)
      if (any(abs(deck%stage%spin) > 0.0_dp)) return
      lowest = minval(x, dim=2)
      lowest(2) = min(lowest(2), minval(deck%boundary%floor, deck_given(deck%boundary%floor)))
      size = norm2(maxval(x, dim=2) - lowest)
    end associate
    if (session%greatest_displacement > size) warning = 'the soil moved '// &
      text_of(session%greatest_displacement, 4)//' m, further than the model is wide and high ('// &
      text_of(size, 4)//' m): it fell freely or flew apart'
  end function warning_of

  !> Size, smoothing and laws.
  subroutine report_model(session)
    type(session_t), intent(inout) :: session
    type(cone_t) :: cone
    character(:), allocatable :: soil
    integer :: i

    associate (summary => session%summary, deck => session%deck, disc => session%disc)
      call summary_set(summary, 'nodes', disc%n)
      call summary_set(summary, 'mean_neighbours', real(size(disc%scni%node), dp)/real(disc%n, dp))
      call summary_set(summary, 'smoothing_levels', merge(2, 1, disc%two_levels))
      if (disc%two_levels) then
        call summary_set(summary, 'smoothing_length', deck%smoothing%length)
        call summary_set(summary, 'smoothing_weights', deck%smoothing%weights)
        call summary_set(summary, 'smoothing_acts_on', deck%smoothing%acts_on)
        if (.not. disc%damage_only) call summary_set(summary, 'elastic_strain', &
          trim(merge('local   ', 'smoothed', disc%tied)))
        call summary_set(summary, 'mean_second_neighbours', &
                         real(size(disc%two_level%cell), dp)/real(disc%n, dp))
      end if
      call summary_set(summary, 'stabilisation', &
                       merge(deck%smoothing%stabilisation, 0.0_dp, disc%stabilised))
      if (disc%two_levels .and. disc%stabilised .and. .not. disc%damage_only) &
        call summary_set(summary, 'level_stiffness', deck%smoothing%level_stiffness)
      if (.not. session%soil_moves) return
      do i = 1, size(deck%soil)
        if (session%ground%law(i)%plasticity == plasticity_none) cycle
        soil = text_as_word(trim(session%ground%name(i)))
        call strength_cone(session%ground%law(i)%strength, 0.0_dp, 0.0_dp, 1.0_dp, cone)
        call summary_set(summary, 'cone_fit_'//soil, deck%soil(i)%fit)
        call summary_set(summary, 'cone_alpha_'//soil, cone%alpha)
        call summary_set(summary, 'cone_k_'//soil, cone%k)
      end do
      call summary_set(summary, 'scaling_and_damping', session%declared)
    end associate
  end subroutine report_model

  !> Steps, seconds and bytes.
  subroutine report_cost(session)
    type(session_t), intent(inout) :: session
    character(:), allocatable :: names(:)
    real(dp) :: wall, soil
    integer(i8) :: steps
    integer :: i

    associate (summary => session%summary, state => session%state)
      call summary_set(summary, 'threads', omp_get_max_threads())
      steps = state%steps - session%steps_before
      call summary_set(summary, 'steps', steps)
      call summary_set(summary, 'seepage_steps', &
                       state%seepage_steps - session%seepage_steps_before)
      wall = timer_seconds(session%timer, 'set_up') + timer_seconds(session%timer, 'stages')
      call summary_set(summary, 'wall_seconds', wall)
      names = timer_names(session%timer)
      do i = 1, size(names)
        call summary_set(summary, 'wall_seconds_'//trim(names(i)), &
                         timer_seconds(session%timer, trim(names(i))))
      end do
      soil = timer_seconds(session%timer, 'soil') + timer_seconds(session%timer, 'geostatic') &
        + timer_seconds(session%timer, 'strength_reduction')
      if (soil > 0.0_dp) call summary_set(summary, 'node_steps_per_second', &
        real(session%disc%n, dp)*real(steps, dp)/soil)
      call summary_set(summary, 'peak_memory_bytes', memory_held('VmHWM:'))
    end associate
  end subroutine report_cost

  !> What the run found.
  subroutine report_answers(session)
    type(session_t), intent(inout) :: session

    associate (summary => session%summary)
      call summary_set(summary, 'simulated_seconds', session%state%time)
      call summary_set(summary, 'maximum_displacement', session%greatest_displacement)
      call summary_set(summary, 'water_error', session%worst_water_error)
      call summary_set(summary, 'energy_error', session%worst_energy_error)
      if (session%coupling_error >= 0.0_dp) call summary_set(summary, 'coupling_error', &
                                                             session%coupling_error)
      call summary_set(summary, 'failed', session%failed)
      if (session%failed) then
        call summary_set(summary, 'trigger_time', session%trigger_time)
      else
        call summary_set(summary, 'trigger_time', 'none')
      end if
    end associate
  end subroutine report_answers
end module talus_report
