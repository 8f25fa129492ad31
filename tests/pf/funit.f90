! SPDX-License-Identifier: MIT
!> The part of pFUnit's module `funit` that the suites of TALUS use, for machines without pFUnit.
!> tests/pf/translate.py writes the programs that call it. Names and argument order are pFUnit's.
module funit
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite, ieee_is_nan
  use funit_compare, only: dp, compare, text_of, tolerances
  use funit_report, only: SourceLocation, anyExceptions, report_failure, funit_begin, funit_test, &
    funit_disabled, funit_end
  implicit none
  private
  public :: SourceLocation, anyExceptions, funit_begin, funit_test, funit_disabled, funit_end
  public :: TestCase, ParameterizedTestCase, AbstractTestParameter
  public :: assertEqual, assertRelativelyEqual, assertTrue, assertFalse, assertLessThan
  public :: assertLessThanOrEqual, assertGreaterThan, assertGreaterThanOrEqual
  public :: assertIsFinite, assertIsNaN, assertFail

  !> What a test runs in: setUp before it, tearDown after it.
  type, abstract :: TestCase
  contains
    procedure :: setUp
    procedure :: tearDown
  end type TestCase

  !> One of the values a parameterised test is run with.
  type, abstract :: AbstractTestParameter
  contains
    procedure(to_string), deferred :: toString
  end type AbstractTestParameter

  type, abstract, extends(TestCase) :: ParameterizedTestCase
    class(AbstractTestParameter), allocatable :: testParameter
  end type ParameterizedTestCase

  abstract interface
    function to_string(this) result(string)
      import :: AbstractTestParameter
      class(AbstractTestParameter), intent(in) :: this
      character(:), allocatable :: string
    end function to_string
  end interface

  interface assertEqual
    module procedure equal_string
    module procedure equal_integer, equal_integer_01, equal_integer_1
    module procedure equal_integer_02, equal_integer_2
    module procedure equal_real, equal_real_01, equal_real_1, equal_real_02, equal_real_2
  end interface assertEqual

  interface assertRelativelyEqual
    module procedure relative_real, relative_real_1
  end interface assertRelativelyEqual

  interface assertLessThan
    module procedure less_integer, less_real
  end interface assertLessThan

  interface assertLessThanOrEqual
    module procedure not_above_integer, not_above_real
  end interface assertLessThanOrEqual

  interface assertGreaterThan
    module procedure greater_integer, greater_real
  end interface assertGreaterThan

  interface assertGreaterThanOrEqual
    module procedure not_below_integer, not_below_real
  end interface assertGreaterThanOrEqual

  interface assertIsNaN
    module procedure is_nan_real
  end interface assertIsNaN

  interface assertIsFinite
    module procedure is_finite_real
  end interface assertIsFinite

contains

  subroutine setUp(this)
    class(TestCase), intent(inout) :: this

    associate (unused => this)
    end associate
  end subroutine setUp

  subroutine tearDown(this)
    class(TestCase), intent(inout) :: this

    associate (unused => this)
    end associate
  end subroutine tearDown

  !> Blanks around the text do not count, as in pFUnit.
  subroutine equal_string(expected, found, message, location)
    character(*), intent(in) :: expected, found
    character(*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    if (trim(adjustl(expected)) == trim(adjustl(found))) return
    call report_failure('expected "'//expected//'" but found: "'//found//'"', message, location)
  end subroutine equal_string

  subroutine equal_integer(expected, actual, message, location)
    integer, intent(in) :: expected, actual
    character(*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    call compare(real([expected], dp), real([actual], dp), &
      .true., .true., tolerances(1), message, location)
  end subroutine equal_integer

  subroutine equal_integer_01(expected, actual, message, location)
    integer, intent(in) :: expected, actual(:)
    character(*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    call compare(real(spread(expected, 1, size(actual)), dp), real(actual, dp), &
      .true., .true., tolerances(size(actual)), message, location)
  end subroutine equal_integer_01

  subroutine equal_integer_1(expected, actual, message, location)
    integer, intent(in) :: expected(:), actual(:)
    character(*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    call compare(real(expected, dp), real(actual, dp), &
      size(expected) == size(actual), .true., tolerances(size(actual)), message, location)
  end subroutine equal_integer_1

  subroutine equal_integer_02(expected, actual, message, location)
    integer, intent(in) :: expected, actual(:,:)
    character(*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    call compare(real(spread(expected, 1, size(actual)), dp), &
      real(reshape(actual, [size(actual)]), dp), &
      .true., .true., tolerances(size(actual)), message, location)
  end subroutine equal_integer_02

  subroutine equal_integer_2(expected, actual, message, location)
    integer, intent(in) :: expected(:,:), actual(:,:)
    character(*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    call compare(real(reshape(expected, [size(expected)]), dp), &
      real(reshape(actual, [size(actual)]), dp), &
      all(shape(expected) == shape(actual)), .true., tolerances(size(actual)), message, location)
  end subroutine equal_integer_2

  subroutine equal_real(expected, actual, tolerance, message, location)
    real(dp), intent(in) :: expected, actual
    real(dp), intent(in), optional :: tolerance
    character(*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    call compare([expected], [actual], &
      .true., .false., tolerances(1, tolerance), message, location)
  end subroutine equal_real

  subroutine equal_real_01(expected, actual, tolerance, message, location)
    real(dp), intent(in) :: expected, actual(:)
    real(dp), intent(in), optional :: tolerance
    character(*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    call compare(spread(expected, 1, size(actual)), actual, &
      .true., .false., tolerances(size(actual), tolerance), message, location)
  end subroutine equal_real_01

  subroutine equal_real_1(expected, actual, tolerance, message, location)
    real(dp), intent(in) :: expected(:), actual(:)
    real(dp), intent(in), optional :: tolerance
    character(*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    call compare(expected, actual, &
      size(expected) == size(actual), .false., &
      tolerances(size(actual), tolerance), message, location)
  end subroutine equal_real_1

  subroutine equal_real_02(expected, actual, tolerance, message, location)
    real(dp), intent(in) :: expected, actual(:,:)
    real(dp), intent(in), optional :: tolerance
    character(*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    call compare(spread(expected, 1, size(actual)), reshape(actual, [size(actual)]), &
      .true., .false., tolerances(size(actual), tolerance), message, location)
  end subroutine equal_real_02

  subroutine equal_real_2(expected, actual, tolerance, message, location)
    real(dp), intent(in) :: expected(:,:), actual(:,:)
    real(dp), intent(in), optional :: tolerance
    character(*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    call compare(reshape(expected, [size(expected)]), reshape(actual, [size(actual)]), &
      all(shape(expected) == shape(actual)), .false., &
      tolerances(size(actual), tolerance), message, location)
  end subroutine equal_real_2

  subroutine relative_real(expected, actual, tolerance, message, location)
    real(dp), intent(in) :: expected, actual, tolerance
    character(*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    if (abs(expected) <= 0.0_dp) then
      call report_failure('a relative error needs a non-zero expectation', message, location)
      return
    end if
    call compare([expected], [actual], .true., .false., &
      tolerance*abs([expected]), message, location)
  end subroutine relative_real

  subroutine relative_real_1(expected, actual, tolerance, message, location)
    real(dp), intent(in) :: expected(:), actual(:), tolerance
    character(*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    if (any(abs(expected) <= 0.0_dp)) then
      call report_failure('a relative error needs a non-zero expectation', message, location)
      return
    end if
    call compare(expected, actual, size(expected) == size(actual), .false., &
      tolerance*abs(expected), message, location)
  end subroutine relative_real_1

  subroutine less_integer(a, b, message, location)
    integer, intent(in) :: a, b
    character(*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    if (a < b) return
    call report_failure('expected '//text_of(real(a, dp), .true.)//' to be less than '// &
      text_of(real(b, dp), .true.), message, location)
  end subroutine less_integer

  subroutine less_real(a, b, message, location)
    real(dp), intent(in) :: a, b
    character(*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    if (.not. (ieee_is_nan(a) .or. ieee_is_nan(b))) then
      if (a < b) return
    end if
    call report_failure('expected '//text_of(a, .false.)//' to be less than '// &
      text_of(b, .false.), message, location)
  end subroutine less_real

  subroutine not_above_integer(a, b, message, location)
    integer, intent(in) :: a, b
    character(*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    if (a <= b) return
    call report_failure('expected '//text_of(real(a, dp), .true.)//' to be at most '// &
      text_of(real(b, dp), .true.), message, location)
  end subroutine not_above_integer

  subroutine not_above_real(a, b, message, location)
    real(dp), intent(in) :: a, b
    character(*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    if (.not. (ieee_is_nan(a) .or. ieee_is_nan(b))) then
      if (a <= b) return
    end if
    call report_failure('expected '//text_of(a, .false.)//' to be at most '// &
      text_of(b, .false.), message, location)
  end subroutine not_above_real

  subroutine greater_integer(a, b, message, location)
    integer, intent(in) :: a, b
    character(*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    if (a > b) return
    call report_failure('expected '//text_of(real(a, dp), .true.)//' to be greater than '// &
      text_of(real(b, dp), .true.), message, location)
  end subroutine greater_integer

  subroutine greater_real(a, b, message, location)
    real(dp), intent(in) :: a, b
    character(*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    if (.not. (ieee_is_nan(a) .or. ieee_is_nan(b))) then
      if (a > b) return
    end if
    call report_failure('expected '//text_of(a, .false.)//' to be greater than '// &
      text_of(b, .false.), message, location)
  end subroutine greater_real

  subroutine not_below_integer(a, b, message, location)
    integer, intent(in) :: a, b
    character(*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    if (a >= b) return
    call report_failure('expected '//text_of(real(a, dp), .true.)//' to be at least '// &
      text_of(real(b, dp), .true.), message, location)
  end subroutine not_below_integer

  subroutine not_below_real(a, b, message, location)
    real(dp), intent(in) :: a, b
    character(*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    if (.not. (ieee_is_nan(a) .or. ieee_is_nan(b))) then
      if (a >= b) return
    end if
    call report_failure('expected '//text_of(a, .false.)//' to be at least '// &
      text_of(b, .false.), message, location)
  end subroutine not_below_real

  subroutine assertTrue(condition, message, location)
    logical, intent(in) :: condition
    character(*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    if (.not. condition) call report_failure('expected true but found false', message, location)
  end subroutine assertTrue

  subroutine assertFalse(condition, message, location)
    logical, intent(in) :: condition
    character(*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    if (condition) call report_failure('expected false but found true', message, location)
  end subroutine assertFalse

  subroutine is_nan_real(x, message, location)
    real(dp), intent(in) :: x
    character(*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    if (.not. ieee_is_nan(x)) call report_failure('expected NaN but found: '//text_of(x, .false.), &
      message, location)
  end subroutine is_nan_real

  subroutine is_finite_real(x, message, location)
    real(dp), intent(in) :: x
    character(*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    if (.not. ieee_is_finite(x)) call report_failure('expected a finite number but found: '// &
      text_of(x, .false.), message, location)
  end subroutine is_finite_real

  subroutine assertFail(message, location)
    character(*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    call report_failure('reached assertFail', message, location)
  end subroutine assertFail
end module funit
