! SPDX-License-Identifier: MIT
!> The part of the summary that tells what strength reduction found.
module talus_report_factor
  use talus_kinds, only: dp
  use talus_text, only: text_of, text_as_word
  use talus_deck_types, only: stage_t
  use talus_session, only: session_t, reduction_t
  use talus_relax, only: relax_t, relax_moving, relax_exhausted
  use talus_summary, only: summary_t, summary_set
  implicit none
  private
  public :: report_factors

contains

  !> Factor, bracket and criterion of each stage; of more than one with the name of the stage.
  subroutine report_factors(session)
    type(session_t), intent(inout) :: session
    character(:), allocatable :: ending
    integer :: i

    if (.not. allocated(session%reduction)) return
    do i = 1, size(session%reduction)
      associate (stage => session%deck%stage(session%reduction(i)%stage))
        ending = ''
        if (size(session%reduction) > 1) ending = '_'//text_as_word(stage%name)
        call report_factor(session%summary, session%reduction(i), stage, ending)
      end associate
    end do
  end subroutine report_factors

  !> One stage: the factor is the middle of its bracket.
  subroutine report_factor(summary, found, stage, ending)
    type(summary_t), intent(inout) :: summary
    type(reduction_t), intent(in) :: found
    type(stage_t), intent(in) :: stage
    character(*), intent(in) :: ending !! of the keys

    if (min(found%lower, found%upper) > 0.0_dp) then
      call summary_set(summary, 'factor_of_safety'//ending, 0.5_dp*(found%lower + found%upper))
    else
      call summary_set(summary, 'factor_of_safety'//ending, 'none')
    end if
    call bound('factor_lower', found%lower, found%stood)
    call bound('factor_upper', found%upper, found%fell)
    if (found%upper > 0.0_dp) &
      call summary_set(summary, 'factor_upper_failed_by'//ending, cause(found%fell))
    call summary_set(summary, 'factor_criterion'//ending, criterion(stage, found%moved_max))
    call summary_set(summary, 'factor_failure_displacement'//ending, found%moved_max)
    call summary_set(summary, 'factor_trials'//ending, found%trials)

  contains

    !> An end of the bracket with the steps, balance and displacement of its relaxation.
    subroutine bound(name, factor, outcome)
      character(*), intent(in) :: name
      real(dp), intent(in) :: factor
      type(relax_t), intent(in) :: outcome

      if (factor > 0.0_dp) then
        call summary_set(summary, name//ending, factor)
        call summary_set(summary, name//'_steps'//ending, outcome%steps)
        call summary_set(summary, name//'_unbalanced'//ending, outcome%ratio)
        call summary_set(summary, name//'_displacement'//ending, outcome%moved)
      else
        call summary_set(summary, name//ending, 'none')
      end if
    end subroutine bound
  end subroutine report_factor

  !> What counts as lost equilibrium, with its thresholds.
  function criterion(stage, moved_max) result(text)
    type(stage_t), intent(in) :: stage
    real(dp), intent(in) :: moved_max !! displacement that counts as failure [m]
    character(:), allocatable :: text

    text = 'out-of-balance force above '//text_of(stage%tolerance)//' of the load after '// &
      text_of(stage%steps_max)//' steps (tolerance, steps_max), or displacement beyond '// &
      text_of(moved_max, 4)//' m (failure_displacement)'
  end function criterion

  !> By which part of the criterion a trial failed.
  function cause(outcome) result(text)
    type(relax_t), intent(in) :: outcome
    character(:), allocatable :: text

    select case (outcome%outcome)
    case (relax_exhausted)
      text = 'steps_max'
    case (relax_moving)
      text = 'failure_displacement'
    case default
      text = 'soil turned inside out'
    end select
  end function cause
end module talus_report_factor
