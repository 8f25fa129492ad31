! SPDX-License-Identifier: MIT
!> The summary of a run: `key = value`, one a line, SI units. The file is replaced as a whole at
!> each writing, so a killed run leaves the last one.
module talus_summary
  use talus_kinds, only: dp, i8
  use talus_status, only: status_t
  use talus_text, only: text_of
  use talus_file, only: file_replace
  implicit none
  private
  public :: summary_create, summary_set, summary_write

  !> Significant digits of reals.
  integer, parameter :: digits = 12

  character(*), parameter :: nl = new_line('a')

  !> A summary being written.
  type, public :: summary_t
    private
    character(:), allocatable :: path  !! of the file
    character(:), allocatable :: lines !! 'key = value' each with its end of line
  end type summary_t

  !> Give a key its value; a key set before keeps its line and takes the new value.
  interface summary_set
    module procedure set_text, set_real, set_integer, set_long, set_logical
  end interface summary_set

contains

  !> Start an empty summary; nothing is written yet.
  subroutine summary_create(summary, path)
    type(summary_t), intent(out) :: summary
    character(*), intent(in) :: path !! of the file

    summary%path = path
    summary%lines = ''
  end subroutine summary_create

  pure subroutine set_text(summary, key, value)
    type(summary_t), intent(inout) :: summary
    character(*), intent(in) :: key, value

    summary%lines = lines_with(summary%lines, key, key//' = '//value//nl)
  end subroutine set_text

  !> The lines with one replaced, or added when its key is new.
  pure function lines_with(old, key, line) result(lines)
    character(*), intent(in) :: old, key
    character(*), intent(in) :: line !! 'key = value' with its end of line
    character(:), allocatable :: lines
    integer :: first, last

    first = index(nl//old, nl//key//' = ')
    if (first == 0) then
      lines = old//line
    else
      last = first + index(old(first:), nl) - 1
      lines = old(:first-1)//line//old(last+1:)
    end if
  end function lines_with

  pure subroutine set_real(summary, key, value)
    type(summary_t), intent(inout) :: summary
    character(*), intent(in) :: key
    real(dp), intent(in) :: value

    call set_text(summary, key, text_of(value, digits))
  end subroutine set_real

  pure subroutine set_integer(summary, key, value)
    type(summary_t), intent(inout) :: summary
    character(*), intent(in) :: key
    integer, intent(in) :: value

    call set_text(summary, key, text_of(value))
  end subroutine set_integer

  pure subroutine set_long(summary, key, value)
    type(summary_t), intent(inout) :: summary
    character(*), intent(in) :: key
    integer(i8), intent(in) :: value

    call set_text(summary, key, text_of(value))
  end subroutine set_long

  pure subroutine set_logical(summary, key, value)
    type(summary_t), intent(inout) :: summary
    character(*), intent(in) :: key
    logical, intent(in) :: value

    call set_text(summary, key, text_of(value))
  end subroutine set_logical

  !> Write the file.
  subroutine summary_write(summary, status)
    type(summary_t), intent(in) :: summary
    type(status_t), intent(inout) :: status

    call file_replace(summary%path, summary%lines, status)
  end subroutine summary_write
end module talus_summary
