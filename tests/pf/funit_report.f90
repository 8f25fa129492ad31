! SPDX-License-Identifier: MIT
!> Counts tests and failures and prints them the way pFUnit does.
module funit_report
  use, intrinsic :: iso_fortran_env, only: output_unit
  implicit none
  private
  public :: SourceLocation, anyExceptions, report_failure
  public :: funit_begin, funit_test, funit_disabled, funit_end

  !> A line of a .pf file.
  type :: SourceLocation
    character(:), allocatable :: file
    integer :: line = 0
  end type SourceLocation

  character(*), parameter :: new = new_line('a')
  !> State of the one suite this program runs.
  character(:), allocatable, save :: suite, test, failures
  integer, save :: tests = 0, disabled = 0, failed = 0
  logical, save :: test_failed = .false.

contains

  !> True when the test that runs has failed already.
  logical function anyExceptions()
    anyExceptions = test_failed
  end function anyExceptions

  !> Record that an assert of the test that runs does not hold.
  subroutine report_failure(what, message, location)
    character(*), intent(in) :: what !! the values, as text
    character(*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location
    character(12) :: line

    if (.not. test_failed) then
      failed = failed + 1
      write (output_unit, '(a)', advance='no') 'F'
    end if
    test_failed = .true.
    failures = failures//new//'Failure'//new//' in: '//new//suite//'.'//test//new
    if (present(location)) then
      write (line, '(i0)') location%line
      failures = failures//'  Location: '//new//'['//location%file//':'//trim(line)//']'//new
    end if
    if (present(message)) failures = failures//message//new
    failures = failures//what//new
  end subroutine report_failure

  subroutine funit_begin(name)
    character(*), intent(in) :: name !! of the suite

    suite = name
    failures = ''
  end subroutine funit_begin

  !> A test starts; its name is for the report.
  subroutine funit_test(name)
    character(*), intent(in) :: name

    test = name
    test_failed = .false.
    tests = tests + 1
    write (output_unit, '(a)', advance='no') '.'
    flush (output_unit)
  end subroutine funit_test

  !> A test marked @Disable is counted, not run.
  subroutine funit_disabled(name)
    character(*), intent(in) :: name

    disabled = disabled + 1
    write (output_unit, '(a)') ' disabled: '//name
  end subroutine funit_disabled

  !> Print the outcome; end the program with exit code 2 when a test failed.
  subroutine funit_end()
    write (output_unit, '(a)') failures
    if (failed > 0) then
      write (output_unit, '(a)') ' FAILURES!!!'
      write (output_unit, '(3(a,i0))') 'Tests run: ', tests, ', Failures: ', failed, &
        ', Errors: 0, Disabled: ', disabled
      stop 2
    end if
    write (output_unit, '(a)') ' OK'
    write (output_unit, '(a,i0,2a)', advance='no') ' (', tests, ' test', &
      trim(merge(' ', 's', tests == 1))
    if (disabled > 0) write (output_unit, '(a,i0,a)', advance='no') ', ', disabled, ' disabled'
    write (output_unit, '(a)') ')'
  end subroutine funit_end
end module funit_report
