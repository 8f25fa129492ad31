! SPDX-License-Identifier: MIT
!> Comparison of numbers for the asserts of module funit.
module funit_compare
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite, ieee_is_nan
  use, intrinsic :: iso_fortran_env, only: dp => real64
  use funit_report, only: SourceLocation, report_failure
  implicit none
  private
  public :: dp, compare, text_of, tolerances

contains

  !> Number as text: all digits of a real.
  function text_of(value, whole) result(text)
    real(dp), intent(in) :: value
    logical, intent(in) :: whole !! an integer
    character(:), allocatable :: text
    character(32) :: buffer

    if (whole) then
      write (buffer, '(i0)') nint(value)
    else
      write (buffer, '(es24.16e3)') value
    end if
    text = trim(adjustl(buffer))
  end function text_of

  !> True when two numbers agree within an absolute tolerance; a NaN agrees with nothing.
  pure logical function agree(expected, actual, tolerance)
    real(dp), intent(in) :: expected, actual, tolerance

    if (ieee_is_finite(expected) .and. ieee_is_finite(actual)) then
      agree = abs(actual - expected) <= tolerance
    else if (ieee_is_nan(expected) .or. ieee_is_nan(actual)) then
      agree = .false.
    else ! infinite: only the same infinity agrees
      agree = .not. (expected < actual .or. expected > actual)
    end if
  end function agree

  !> Report the first element that differs, and the number of those that do.
  subroutine compare(expected, actual, conform, whole, tolerance, message, location)
    real(dp), intent(in) :: expected(:), actual(:), tolerance(:)
    logical, intent(in) :: conform !! the shapes agree
    logical, intent(in) :: whole   !! integers
    character(*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location
    logical :: same(size(actual))
    integer :: i
    character(80) :: place

    if (.not. conform) then
      call report_failure('the shapes differ', message, location)
      return
    end if
    same = [(agree(expected(i), actual(i), tolerance(i)), i=1, size(actual))]
    if (all(same)) return
    i = findloc(same, .false., 1)
    place = ''
    if (size(actual) > 1) write (place, '(a,3(i0,a))') '; element ', i, ' of ', size(actual), &
      ', ', count(.not. same), ' differ'
    call report_failure('expected '//text_of(expected(i), whole)//' but found: '// &
      text_of(actual(i), whole)//trim(place)//'; tolerance: '//text_of(tolerance(i), whole), &
      message, location)
  end subroutine compare

  !> An absolute tolerance for each element, zero by default.
  pure function tolerances(n, tolerance) result(each)
    integer, intent(in) :: n
    real(dp), intent(in), optional :: tolerance
    real(dp) :: each(n)

    each = 0.0_dp
    if (present(tolerance)) each = tolerance
  end function tolerances
end module funit_compare
