! SPDX-License-Identifier: MIT
!> A line that shows how far a run has come, on a terminal only.
module talus_progress
  use, intrinsic :: iso_c_binding, only: c_int
  use, intrinsic :: iso_fortran_env, only: error_unit
  use talus_kinds, only: dp
  use talus_text, only: text_of
  use talus_timer, only: timer_now
  implicit none
  private
  public :: progress_t, progress_start, progress_show, progress_line, progress_end, progress_say

  !> Seconds between two updates.
  real(dp), parameter :: update_every = 0.25_dp
  !> Letters of the line.
  integer, parameter :: width = 100
  integer(c_int), parameter :: standard_error = 2_c_int

  type :: progress_t
    logical :: terminal = .false.
    real(dp) :: stage_began = 0.0_dp !! wall clock [s]
    real(dp) :: shown = -1.0_dp      !! wall clock of the last update [s]
    character(:), allocatable :: stage
  end type progress_t

  interface
    function isatty(descriptor) bind(c, name='isatty') result(answer)
      import :: c_int
      integer(c_int), value :: descriptor
      integer(c_int) :: answer
    end function isatty
  end interface

contains

  !> Begin a stage.
  subroutine progress_start(progress, stage)
    type(progress_t), intent(inout) :: progress
    character(*), intent(in) :: stage !! its name

    progress%terminal = isatty(standard_error) /= 0
    progress%stage_began = timer_now()
    progress%shown = -1.0_dp
    progress%stage = stage
  end subroutine progress_start

  !> Rewrite the line, if the last time is long enough ago.
  subroutine progress_show(progress, fraction, time, water_error, energy_error)
    type(progress_t), intent(inout) :: progress
    real(dp), intent(in) :: fraction     !! of the stage, 0..1
    real(dp), intent(in) :: time         !! simulated [s]
    real(dp), intent(in) :: water_error  !! relative
    real(dp), intent(in) :: energy_error !! relative
    real(dp) :: now, left

    if (.not. progress%terminal) return
    now = timer_now()
    if (now - progress%shown < update_every) return
    progress%shown = now
    left = (now - progress%stage_began)*(1.0_dp - fraction)/max(fraction, 1.0e-6_dp)
    write (error_unit, '(3a)', advance='no') achar(13), &
      progress_line(progress%stage, fraction, time, left, water_error, energy_error), achar(13)
    flush (error_unit)
  end subroutine progress_show

  !> The line, of a constant width: a long name of a stage is cut, so that the errors show.
  pure function progress_line(stage, fraction, time, left, water_error, energy_error) result(line)
    character(*), intent(in) :: stage
    real(dp), intent(in) :: fraction     !! of the stage, 0..1
    real(dp), intent(in) :: time         !! simulated [s]
    real(dp), intent(in) :: left         !! wall clock to the end of the stage [s]
    real(dp), intent(in) :: water_error  !! relative
    real(dp), intent(in) :: energy_error !! relative
    character(width) :: line
    character(width) :: numbers
    integer :: room

    write (numbers, '(1x,f5.1,a,3x,2a,3x,a,a,3x,a,es8.1,a,es8.1)') 100.0_dp*fraction, ' %', &
      't = ', duration_text(time), 'ETA ', duration_text(left), 'water ', water_error, &
      '  energy ', energy_error
    room = width - len_trim(numbers)
    line = stage//numbers
    if (len(stage) > room) line = stage(:room-2)//'..'//numbers
  end function progress_line

  !> Clear the line.
  subroutine progress_end(progress)
    type(progress_t), intent(inout) :: progress

    if (progress%terminal) write (error_unit, '(3a)', advance='no') achar(13), repeat(' ', width), &
      achar(13)
  end subroutine progress_end

  !> One line that stays, on a terminal only.
  subroutine progress_say(progress, text)
    type(progress_t), intent(inout) :: progress
    character(*), intent(in) :: text

    if (.not. progress%terminal) return
    call progress_end(progress)
    write (error_unit, '(a)') text
  end subroutine progress_say

  !> Seconds in the unit a person would use.
  pure function duration_text(seconds) result(text)
    real(dp), intent(in) :: seconds
    character(:), allocatable :: text

    if (seconds < 120.0_dp) then
      text = text_of(seconds, 3)//' s'
    else if (seconds < 7200.0_dp) then
      text = text_of(seconds/60.0_dp, 3)//' min'
    else
      text = text_of(seconds/3600.0_dp, 4)//' h'
    end if
  end function duration_text
end module talus_progress
