! SPDX-License-Identifier: MIT
!> Where the results of a run go.
module talus_place
  use talus_status, only: status_t, status_set, status_deck, status_io
  use talus_deck_types, only: deck_t
  use talus_file, only: file_exists, file_same
  implicit none
  private
  public :: place_results, place_folder

  !> What a run writes.
  character(*), parameter :: endings(4) = [character(12) :: '.h5', '.xdmf', '_history.csv', &
    '_summary.txt']

contains

  !> Path of the result files without ending. Refuses results that exist unless they may be
  !> replaced.
  subroutine place_results(deck, folder, overwrite, base, status)
    type(deck_t), intent(in) :: deck
    character(*), intent(in) :: folder !! asked for on the command line, '' for the deck's
    logical, intent(in) :: overwrite
    character(:), allocatable, intent(out) :: base
    type(status_t), intent(inout) :: status
    character(:), allocatable :: place, present
    integer :: i

    place = deck%output%directory
    if (len(folder) > 0) place = folder
    base = place//'/'//deck%run%name
    if (len(deck%initial%from_result) > 0) then
      if (file_same(base//'.h5', deck%initial%from_result)) call status_set(status, status_deck, &
        '&initial from_result: the results of this run would replace '//base//'.h5, from which '// &
        'it starts; nothing was written (choose another &run name or --output DIR)')
    end if
    if (overwrite) return
    present = ''
    do i = 1, size(endings)
      if (endings(i) == '.xdmf' .and. .not. deck%output%xdmf) cycle
      if (file_exists(base//trim(endings(i)))) present = present//', '//base//trim(endings(i))
    end do
    if (len(present) > 0) call status_set(status, status_deck, 'results exist: '//present(3:)// &
      '; nothing was written (allow with --overwrite, or choose --output DIR)')
  end subroutine place_results

  !> Make the folder of the result files.
  subroutine place_folder(base, status)
    character(*), intent(in) :: base !! path of the result files without ending
    type(status_t), intent(inout) :: status
    integer :: failed

    associate (folder => base(:max(1, index(base, '/', back=.true.) - 1)))
      call execute_command_line("mkdir -p -- '"//quoted(folder)//"'", exitstat=failed)
      if (failed /= 0) call status_set(status, status_io, 'cannot make the folder '//folder)
    end associate
  end subroutine place_folder

  !> Text safe between single quotes of the shell.
  pure function quoted(text) result(safe)
    character(*), intent(in) :: text
    character(:), allocatable :: safe
    integer :: i

    safe = ''
    do i = 1, len(text)
      if (text(i:i) == "'") then
        safe = safe//"'\''"
      else
        safe = safe//text(i:i)
      end if
    end do
  end function quoted
end module talus_place
