! SPDX-License-Identifier: MIT
!> Files that a deck names: they must open, and tables must hold what they should.
module talus_deck_check_file
  use talus_read_file, only: file_problem
  use talus_table_csv, only: table_csv_t, table_csv_faults
  use talus_deck_messages, only: messages_t
  use talus_deck_store, only: store_t
  use talus_deck_csv, only: hydrograph_read, retention_read
  use talus_deck_report, only: complain => report_error
  implicit none
  private
  public :: check_file, check_hydrograph, check_retention

contains

  !> A file must open and hold something.
  subroutine check_file(store, section, name, path, messages, is_there)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    character(*), intent(in) :: name, path     !! key; path that opens from the working folder
    type(messages_t), intent(inout) :: messages
    logical, intent(out), optional :: is_there !! it can be read
    character(:), allocatable :: problem
    integer :: split

    if (present(is_there)) is_there = .false.
    if (len(path) == 0) return
    problem = file_problem(path, 'the deck''s folder')
    if (present(is_there)) is_there = len(problem) == 0
    if (len(problem) == 0) return
    split = index(problem, '; allowed: ')
    call complain(store, section, name, problem(:split-1), messages, problem(split+11:))
  end subroutine check_file

  !> Every row of a hydrograph.
  subroutine check_hydrograph(store, section, path, messages, table)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    character(*), intent(in) :: path           !! that opens from the working folder
    type(messages_t), intent(inout) :: messages
    type(table_csv_t), intent(out) :: table    !! no values when it cannot be read
    logical :: is_there

    allocate (table%values(2, 0))
    call check_file(store, section, 'hydrograph', path, messages, is_there)
    if (.not. is_there) return
    call hydrograph_read(path, table)
    call report_faults(store, section, 'hydrograph', table, messages)
  end subroutine check_hydrograph

  !> Every point of a retention table.
  subroutine check_retention(store, section, path, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    character(*), intent(in) :: path           !! that opens from the working folder
    type(messages_t), intent(inout) :: messages
    type(table_csv_t) :: table
    logical :: is_there

    call check_file(store, section, 'file', path, messages, is_there)
    if (.not. is_there) return
    call retention_read(path, table)
    call report_faults(store, section, 'file', table, messages)
  end subroutine check_retention

  !> Each fault of a table as an error of the key that names its file.
  subroutine report_faults(store, section, name, table, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    character(*), intent(in) :: name
    type(table_csv_t), intent(in) :: table
    type(messages_t), intent(inout) :: messages
    integer :: i

    do i = 1, table_csv_faults(table)
      call complain(store, section, name, table%fault(i)%text, messages, '')
    end do
  end subroutine report_faults
end module talus_deck_check_file
