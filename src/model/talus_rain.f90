! SPDX-License-Identifier: MIT
!> Rain on the ground: constant, or a hydrograph read from a CSV file time_s,mm_per_h.
!!
!! The intensity of a row holds from its time until the next row's; the last one holds for ever;
!! there is no rain before the first. Intensity is volume per horizontal area and time [m/s].
module talus_rain
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
  use talus_kinds, only: dp
  use talus_const, only: mm_per_hour
  use talus_status, only: status_t, status_set, status_deck, status_failed
  use talus_text, only: text_of
  use talus_table_csv, only: table_csv_read
  implicit none
  private
  public :: rain_t, rain_constant, rain_hydrograph, rain_read, rain_rate, rain_total
  public :: rain_next_change

  real(dp), parameter :: intensity_greatest = 1.0e4_dp ! mm/h; ten times the record

  type :: rain_t
    real(dp), allocatable :: time(:)      !! start of each step [s], increasing
    real(dp), allocatable :: intensity(:) !! in the step [m/s]
  end type rain_t

contains

  !> The same rain at all times, also before time zero.
  pure function rain_constant(mm_each_hour) result(rain)
    real(dp), intent(in) :: mm_each_hour !! intensity [mm/h]
    type(rain_t) :: rain

    allocate (rain%time(1), rain%intensity(1))
    rain%time(1) = -huge(1.0_dp)
    rain%intensity(1) = mm_each_hour*mm_per_hour
  end function rain_constant

  !> Rain in steps.
  subroutine rain_hydrograph(time, mm_each_hour, rain, status)
    real(dp), intent(in) :: time(:)         !! start of each step [s], increasing
    real(dp), intent(in) :: mm_each_hour(:) !! intensity [mm/h], >= 0
    type(rain_t), intent(out) :: rain
    type(status_t), intent(inout) :: status
    integer :: i

    call check_steps(time, mm_each_hour, 'hydrograph, row ', [(i, i=1, size(time))], status)
    if (status_failed(status)) return
    rain%time = time
    rain%intensity = mm_each_hour*mm_per_hour
  end subroutine rain_hydrograph

  !> Rain from a CSV file with the header time_s,mm_per_h.
  subroutine rain_read(path, rain, status)
    character(*), intent(in) :: path
    type(rain_t), intent(out) :: rain
    type(status_t), intent(inout) :: status
    real(dp), allocatable :: values(:, :)
    integer, allocatable :: lines(:)

    call table_csv_read(path, 'time_s,mm_per_h', values, lines, status)
    if (status_failed(status)) return
    call check_steps(values(1, :), values(2, :), trim(path)//':', lines, status)
    if (status_failed(status)) return
    rain%time = values(1, :)
    rain%intensity = values(2, :)*mm_per_hour
  end subroutine rain_read

  !> Times increase, intensities are rain; `place` and `lines` name the first wrong row.
  subroutine check_steps(time, mm_each_hour, place, lines, status)
    real(dp), intent(in) :: time(:), mm_each_hour(:)
    character(*), intent(in) :: place
    integer, intent(in) :: lines(:) !! line of each row
    type(status_t), intent(inout) :: status
    integer :: i

    if (size(time) < 1) call status_set(status, status_deck, place//' no rows')
    do i = 1, size(time)
      if (.not. ieee_is_finite(time(i)) .or. .not. ieee_is_finite(mm_each_hour(i))) then
        call status_set(status, status_deck, place//text_of(lines(i))//': not a finite number')
      else if (mm_each_hour(i) < 0.0_dp .or. mm_each_hour(i) > intensity_greatest) then
        call status_set(status, status_deck, place//text_of(lines(i))//': mm_per_h = '// &
          text_of(mm_each_hour(i))//' is not allowed; allowed: 0 to '//text_of(intensity_greatest))
      end if
      if (status_failed(status)) return
    end do
    do i = 2, size(time)
      if (time(i) <= time(i-1)) call status_set(status, status_deck, place// &
        text_of(lines(i))//': time_s = '//text_of(time(i))//' is not allowed; allowed: > '// &
        text_of(time(i-1))//' (times increase)')
    end do
  end subroutine check_steps

  !> Intensity at a time [m/s], >= 0.
  pure real(dp) function rain_rate(rain, time) result(rate)
    type(rain_t), intent(in) :: rain
    real(dp), intent(in) :: time !! [s]
    integer :: i

    i = step_of(rain, time)
    rate = 0.0_dp
    if (i > 0) rate = rain%intensity(i)
  end function rain_rate

  !> Depth of rain that falls from t0 to t1 [m]: the exact integral of the intensity.
  pure real(dp) function rain_total(rain, t0, t1) result(depth)
    type(rain_t), intent(in) :: rain
    real(dp), intent(in) :: t0, t1 !! [s], t0 <= t1
    real(dp) :: start, finish
    integer :: i, last

    depth = 0.0_dp
    last = step_of(rain, t1)
    do i = max(1, step_of(rain, t0)), last
      start = max(t0, rain%time(i))
      finish = t1
      if (i < last) finish = rain%time(i+1)
      depth = depth + rain%intensity(i)*(finish - start)
    end do
  end function rain_total

  !> First time after `time` at which the intensity may change [s]; huge() if it never does.
  pure real(dp) function rain_next_change(rain, time) result(change)
    type(rain_t), intent(in) :: rain
    real(dp), intent(in) :: time !! [s]
    integer :: i

    i = step_of(rain, time) + 1
    change = huge(change)
    if (i <= size(rain%time)) change = rain%time(i)
  end function rain_next_change

  !> Row in force at a time, 0 before the first: bisection.
  pure integer function step_of(rain, time) result(low)
    type(rain_t), intent(in) :: rain
    real(dp), intent(in) :: time !! [s]
    integer :: high, middle

    low = 0
    high = size(rain%time) + 1
    do while (high - low > 1)
      middle = (low + high)/2
      if (rain%time(middle) <= time) then
        low = middle
      else
        high = middle
      end if
    end do
  end function step_of
end module talus_rain
