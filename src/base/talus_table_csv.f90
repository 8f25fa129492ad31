! SPDX-License-Identifier: MIT
!> Reads a table of numbers from a CSV file and says exactly what is wrong with a bad one.
!!
!! First line: the column names. Then one row a line, numbers separated by commas. Blank lines
!! and lines that start with # are skipped.
module talus_table_csv
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
  use, intrinsic :: ieee_exceptions, only: ieee_overflow, ieee_get_halting_mode, &
    ieee_set_halting_mode, ieee_set_flag
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_set, status_deck, status_io, status_failed
  use talus_text, only: text_of
  implicit none
  private
  public :: table_csv_read

  integer, parameter :: line_length = 1000

contains

  !> Read all rows; every message names the file, the line, the value and what is allowed.
  subroutine table_csv_read(path, header, values, lines, status)
    character(*), intent(in) :: path                   !! file name
    character(*), intent(in) :: header                 !! required names, comma-separated
    real(dp), allocatable, intent(out) :: values(:, :) !! (columns, rows)
    integer, allocatable, intent(out) :: lines(:)      !! (rows) line number of each row
    type(status_t), intent(inout) :: status
    character(line_length) :: text
    real(dp), allocatable :: grown(:, :)
    integer :: unit, iostat, line, rows, columns, i
    logical :: header_seen

    columns = 1 + count([(header(i:i) == ',', i=1, len(header))])
    allocate (values(columns, 64), lines(64))
    open (newunit=unit, file=path, status='old', action='read', iostat=iostat)
    if (iostat /= 0) then
      call status_set(status, status_io, trim(path)//': cannot be opened for reading; '// &
        'expected a CSV file with the columns '//header)
      return
    end if
    rows = 0
    line = 0
    header_seen = .false.
    do
      read (unit, '(a)', iostat=iostat) text
      if (iostat /= 0) exit
      line = line + 1
      do i = 1, len_trim(text)
        if (text(i:i) == achar(9) .or. text(i:i) == achar(13)) text(i:i) = ' '
      end do
      text = adjustl(text)
      if (len_trim(text) == 0 .or. text(1:1) == '#') cycle
      if (.not. header_seen) then
        call check_header(path, line, text, header, status)
        header_seen = .true.
      else
        rows = rows + 1
        if (rows > size(lines)) then
          allocate (grown(columns, 2*size(lines)))
          grown(:, :rows-1) = values
          call move_alloc(grown, values)
          lines = [lines, lines]
        end if
        lines(rows) = line
        call read_row(path, line, text, header, values(:, rows), status)
      end if
      if (status_failed(status)) exit
    end do
    close (unit)
    if (rows == 0) call status_set(status, status_deck, trim(path)//': no rows; expected '// &
      'the header '//header//' and at least one row of numbers')
    values = values(:, :rows)
    lines = lines(:rows)
  end subroutine table_csv_read

  subroutine check_header(path, line, text, header, status)
    character(*), intent(in) :: path, text, header
    integer, intent(in) :: line
    type(status_t), intent(inout) :: status
    character(line_length) :: squeezed
    integer :: i, n

    squeezed = ''
    n = 0
    do i = 1, len_trim(text)
      if (text(i:i) == ' ') cycle
      n = n + 1
      squeezed(n:n) = text(i:i)
    end do
    if (squeezed(:n) == header) return
    call status_set(status, status_deck, trim(path)//':'//text_of(line)//': header '''// &
      trim(text)//''' is not allowed; expected '//header)
  end subroutine check_header

  !> Numbers of one row.
  subroutine read_row(path, line, text, header, row, status)
    character(*), intent(in) :: path, text, header
    integer, intent(in) :: line
    real(dp), intent(out) :: row(:)
    type(status_t), intent(inout) :: status
    character(line_length) :: field
    integer :: column, first, last, iostat

    row = 0.0_dp
    first = 1
    last = 0
    do column = 1, size(row)
      last = index(text(first:), ',')
      if (last == 0 .or. first > len_trim(text)) last = len_trim(text(first:)) + 1
      last = first + last - 2
      field = adjustl(text(first:last))
      iostat = 1
      if (verify(trim(field), '0123456789+-.eEdD') == 0) &
        call read_number(field, row(column), iostat)
      if (iostat /= 0) then
        call status_set(status, status_deck, trim(path)//':'//text_of(line)//': value '''// &
          trim(field)//''' in column '//text_of(column)//' is not a finite number; expected '// &
          text_of(size(row))//' numbers: '//header)
        return
      end if
      first = min(last + 2, len(text))
    end do
    if (last < len_trim(text)) call status_set(status, status_deck, trim(path)//':'// &
      text_of(line)//': '''//trim(text)//''' has more than '//text_of(size(row))// &
      ' columns; expected '//header)
  end subroutine read_row

  !> A finite number, or iostat /= 0. A number too large must not halt a debugging build.
  subroutine read_number(field, value, iostat)
    character(*), intent(in) :: field
    real(dp), intent(out) :: value
    integer, intent(out) :: iostat
    logical :: halting

    value = 0.0_dp
    iostat = 1
    if (len_trim(field) == 0) return
    call ieee_get_halting_mode(ieee_overflow, halting)
    call ieee_set_halting_mode(ieee_overflow, .false.)
    read (field, *, iostat=iostat) value
    call ieee_set_flag(ieee_overflow, .false.)
    call ieee_set_halting_mode(ieee_overflow, halting)
    if (iostat == 0 .and. .not. ieee_is_finite(value)) iostat = 1
  end subroutine read_number
end module talus_table_csv
