! SPDX-License-Identifier: MIT
!> A whole text file as one string, with the reasons why it may not be one.
module talus_read_file
  use talus_kinds, only: i8
  use talus_text, only: text_of
  implicit none
  private
  public :: file_read, file_problem, text_without_mark

  character(*), parameter :: byte_order_mark = char(239)//char(187)//char(191)

contains

  !> Contents of a file with lines ended by newlines; `problem` is '' when it could be read.
  subroutine file_read(path, folder, what, bytes_max, text, problem)
    character(*), intent(in) :: path
    character(*), intent(in) :: folder   !! that a relative path starts from, for the message
    character(*), intent(in) :: what     !! the file should hold: 'a namelist'
    integer, intent(in) :: bytes_max     !! a larger file is surely something else
    character(:), allocatable, intent(out) :: text, problem
    integer :: unit, iostat
    integer(i8) :: bytes

    text = ''
    problem = file_problem(path, folder)
    if (len(problem) > 0) return
    inquire (file=path, size=bytes)
    if (bytes > int(bytes_max, i8)) then
      problem = 'the file has '//text_of(bytes)//' bytes; allowed: '//what//' of at most '// &
                text_of(bytes_max)
      return
    end if
    text = repeat(' ', bytes)
    open (newunit=unit, file=path, access='stream', form='unformatted', action='read', &
          status='old', iostat=iostat)
    if (iostat == 0) read (unit, iostat=iostat) text
    if (iostat /= 0) problem = 'the file cannot be read; allowed: a readable text file'
    close (unit, iostat=iostat)
    if (len(problem) > 0) return
    call normalise(text)
    if (is_binary(text)) then
      problem = 'the file is not text; allowed: '//what//' in plain text'
    else if (verify(text, ' '//achar(9)//achar(10)) == 0) then
      problem = 'the file is empty; allowed: '//what
    end if
  end subroutine file_read

  !> Why a file cannot be opened for reading, '' when it can.
  function file_problem(path, folder) result(problem)
    character(*), intent(in) :: path
    character(*), intent(in) :: folder !! that a relative path starts from
    character(:), allocatable :: problem
    logical :: exists
    integer :: unit, iostat
    integer(i8) :: bytes

    problem = ''
    inquire (file=path//'/.', exist=exists)
    if (exists) then
      problem = 'this is a folder; allowed: a file'
      return
    end if
    inquire (file=path, exist=exists)
    if (.not. exists) then
      problem = 'no such file; allowed: a path relative to '//folder//', or absolute'
      return
    end if
    open (newunit=unit, file=path, access='stream', form='unformatted', action='read', &
          status='old', iostat=iostat)
    if (iostat /= 0) then
      problem = 'the file cannot be opened; allowed: a readable file'
      return
    end if
    inquire (unit=unit, size=bytes)
    close (unit)
    if (bytes <= 0_i8) problem = 'the file is empty; allowed: a file with content'
  end function file_problem

  !> A text without the byte-order mark that some editors put before it.
  pure function text_without_mark(text) result(rest)
    character(*), intent(in) :: text
    character(:), allocatable :: rest

    rest = text
    if (index(text, byte_order_mark) == 1) rest = text(len(byte_order_mark)+1:)
  end function text_without_mark

  !> Drop a byte-order mark and turn the line ends of other systems into newlines.
  subroutine normalise(text)
    character(:), allocatable, intent(inout) :: text
    character :: letter, before
    integer :: i, n

    text = text_without_mark(text)
    n = 0
    before = ' '
    do i = 1, len(text)
      letter = text(i:i)
      if (.not. (letter == achar(10) .and. before == achar(13))) then
        n = n + 1
        text(n:n) = merge(achar(10), letter, letter == achar(13))
      end if
      before = letter
    end do
    text = text(:n)
  end subroutine normalise

  !> True when control characters appear that no text has.
  pure logical function is_binary(text)
    character(*), intent(in) :: text
    integer :: i, code

    is_binary = .false.
    do i = 1, len(text)
      code = iachar(text(i:i))
      if (code >= 0 .and. code < 32 .and. code /= 9 .and. code /= 10 .and. code /= 12) then
        is_binary = .true.
        return
      end if
    end do
  end function is_binary
end module talus_read_file
