! SPDX-License-Identifier: MIT
!> Reads a table of numbers from a CSV file and says exactly what is wrong with a bad one: all that
!! is wrong, each with its line.
!!
!! First line: the column names, in any case, quoted or not. Then one row a line, numbers separated
!! by commas. Blank lines and lines that start with # are skipped.
module talus_table_csv
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_set, status_deck
  use talus_text, only: text_of, text_lower, text_to_real
  use talus_read_file, only: file_read
  implicit none
  private
  public :: table_csv_t, table_csv_read, table_csv_fault, table_csv_faults, table_csv_status

  !> Largest file [bytes].
  integer, parameter :: bytes_max = 100000000
  !> Faults kept of one table; the others are counted.
  integer, parameter :: faults_kept = 20

  type :: fault_t
    character(:), allocatable :: text
  end type fault_t

  type :: table_csv_t
    character(:), allocatable :: place      !! what goes before a line's number: 'file.csv:'
    real(dp), allocatable :: values(:, :)   !! (columns, rows), of rows without fault
    integer, allocatable :: lines(:)        !! (rows) line number of each row
    integer :: faults = 0                   !! number of faults
    type(fault_t), allocatable :: fault(:)  !! the first ones, and how many more there are
  end type table_csv_t

contains

  !> Read all rows. The table holds those that are right, and a fault for each that is not; every
  !> fault names the file, the line, the value and what is allowed.
  subroutine table_csv_read(path, header, table)
    character(*), intent(in) :: path       !! file name
    character(*), intent(in) :: header     !! required names, comma-separated
    type(table_csv_t), intent(out) :: table
    character(:), allocatable :: text, problem, content
    integer :: first, last, line, columns, rows, i
    logical :: header_seen

    table%place = trim(path)//':'
    columns = 1 + count([(header(i:i) == ',', i=1, len(header))])
    allocate (table%values(columns, 64), table%lines(64))
    rows = 0
    call file_read(path, 'the deck''s folder', 'a CSV file with the columns '//header, bytes_max, &
      text, problem)
    if (len(problem) > 0) call table_csv_fault(table, 0, problem)
    header_seen = .false.
    line = 0
    first = 1
    do while (first <= len(text) .and. len(problem) == 0)
      last = first + index(text(first:), new_line('a')) - 2
      if (last < first - 1) last = len(text)
      line = line + 1
      content = clean(text(first:last))
      first = last + 2
      if (len(content) == 0 .or. index(content, '#') == 1) cycle
      if (header_seen) then
        call read_row(line, content, header, rows, table)
      else if (unquoted(content) /= text_lower(header)) then
        call table_csv_fault(table, line, 'header '''//content// &
          ''' is not allowed; allowed: '//header)
        exit
      end if
      header_seen = .true.
    end do
    if (rows == 0 .and. table%faults == 0) call table_csv_fault(table, 0, &
      'no rows; allowed: the header '//header//' and at least one row of numbers')
    table%values = table%values(:, :rows)
    table%lines = table%lines(:rows)
  end subroutine table_csv_read

  !> A line without tabs and without blanks at its ends.
  pure function clean(text) result(content)
    character(*), intent(in) :: text
    character(:), allocatable :: content
    integer :: i

    content = text
    do i = 1, len(content)
      if (content(i:i) == achar(9)) content(i:i) = ' '
    end do
    content = trim(adjustl(content))
  end function clean

  !> A header in small letters, without blanks and the quotes that spreadsheets write.
  pure function unquoted(text) result(names)
    character(*), intent(in) :: text
    character(:), allocatable :: names
    integer :: i

    names = ''
    do i = 1, len(text)
      if (text(i:i) /= ' ' .and. text(i:i) /= '"') names = names//text_lower(text(i:i))
    end do
  end function unquoted

  !> Add the numbers of one row to the table, or its first fault.
  subroutine read_row(line, text, header, rows, table)
    integer, intent(in) :: line
    character(*), intent(in) :: text, header
    integer, intent(inout) :: rows
    type(table_csv_t), intent(inout) :: table
    real(dp) :: row(size(table%values, 1))
    character(:), allocatable :: field
    integer :: column, first, last
    logical :: is_right

    first = 1
    do column = 1, size(row)
      last = first + index(text(first:)//',', ',') - 2
      field = clean(text(first:last))
      call text_to_real(field, row(column), is_right)
      if (.not. is_right) then
        call table_csv_fault(table, line, 'value '''//field//''' in column '// &
          text_of(column)//' is not a finite number; allowed: '//text_of(size(row))// &
          ' numbers: '//header)
        return
      end if
      first = min(last + 2, len(text) + 1)
    end do
    if (last < len(text)) then
      call table_csv_fault(table, line, ''''//text//''' has more than '// &
        text_of(size(row))//' columns; allowed: '//header)
      return
    end if
    rows = rows + 1
    if (rows > size(table%lines)) call grow(table)
    table%values(:, rows) = row
    table%lines(rows) = line
  end subroutine read_row

  !> Twice the room for rows.
  subroutine grow(table)
    type(table_csv_t), intent(inout) :: table
    real(dp), allocatable :: values(:, :)

    associate (rows => size(table%lines))
      allocate (values(size(table%values, 1), 2*rows))
      values(:, :rows) = table%values
    end associate
    call move_alloc(values, table%values)
    table%lines = [table%lines, table%lines]
  end subroutine grow

  !> Add a fault of one line.
  pure subroutine table_csv_fault(table, line, problem)
    type(table_csv_t), intent(inout) :: table
    integer, intent(in) :: line            !! 0 for the file as a whole
    character(*), intent(in) :: problem    !! what is wrong; allowed: what is right
    character(:), allocatable :: text
    integer :: i

    if (.not. allocated(table%fault)) allocate (table%fault(faults_kept + 1))
    table%faults = table%faults + 1
    text = table%place
    if (line > 0) text = text//text_of(line)//':'
    text = text//' '//problem
    if (table%faults > faults_kept) &
      text = table%place//' and '//text_of(table%faults - faults_kept)//' more errors'
    ! An expression as the index here is compiled wrong by GCC 12.
    i = table_csv_faults(table)
    table%fault(i)%text = text
  end subroutine table_csv_fault

  !> Number of texts in table%fault.
  pure integer function table_csv_faults(table) result(n)
    type(table_csv_t), intent(in) :: table

    n = min(table%faults, faults_kept + 1)
  end function table_csv_faults

  !> Fail with all faults, one a line; nothing happens when there are none.
  pure subroutine table_csv_status(table, status)
    type(table_csv_t), intent(in) :: table
    type(status_t), intent(inout) :: status
    character(:), allocatable :: text
    integer :: i

    if (table%faults == 0) return
    text = ''
    do i = 1, table_csv_faults(table)
      text = text//new_line('a')//table%fault(i)%text
    end do
    call status_set(status, status_deck, text(2:))
  end subroutine table_csv_status
end module talus_table_csv
