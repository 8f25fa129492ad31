! SPDX-License-Identifier: MIT
!> Rain on the ground: constant, or a hydrograph read from a CSV file time_s,mm_per_h.
!!
!! The intensity of a row holds from its time until the next row's; the last one holds for ever;
!! there is no rain before the first. Intensity is volume per horizontal area and time [m/s].
module talus_rain
  use talus_kinds, only: dp
  use talus_const, only: mm_per_hour
  use talus_status, only: status_t
  use talus_table_csv, only: table_csv_t, table_csv_status
  use talus_deck_csv, only: hydrograph_read
  implicit none
  private
  public :: rain_t, rain_constant, rain_read, rain_total, rain_next_change

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

  !> Rain from a CSV file with the header time_s,mm_per_h.
  subroutine rain_read(path, rain, status)
    character(*), intent(in) :: path
    type(rain_t), intent(out) :: rain
    type(status_t), intent(inout) :: status
    type(table_csv_t) :: table

    call hydrograph_read(path, table)
    call table_csv_status(table, status)
    if (table%faults > 0) return
    rain%time = table%values(1, :)
    rain%intensity = table%values(2, :)*mm_per_hour
  end subroutine rain_read

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
