! SPDX-License-Identifier: MIT
!> Paths of decks and of the files they name.
module talus_deck_path
  implicit none
  private
  public :: path_folder, path_stem, path_from_deck

contains

  !> Folder of a file with its final '/', '' for the working folder.
  pure function path_folder(path) result(folder)
    character(*), intent(in) :: path
    character(:), allocatable :: folder

    folder = path(:index(path, '/', back=.true.))
  end function path_folder

  !> File name without folder and last extension; for case.nml the name of its folder.
  pure function path_stem(path) result(stem)
    character(*), intent(in) :: path
    character(:), allocatable :: stem
    character(:), allocatable :: folder
    integer :: dot

    folder = path_folder(path)
    stem = path(len(folder)+1:)
    dot = index(stem, '.', back=.true.)
    if (dot > 1) stem = stem(:dot-1)
    if (stem /= 'case' .or. len(folder) < 2) return
    folder = folder(:len(folder)-1)
    folder = folder(index(folder, '/', back=.true.)+1:)
    if (folder /= '.' .and. folder /= '..') stem = folder
  end function path_stem

  !> A path written in a deck, relative to the deck's folder, as one that opens from here.
  pure function path_from_deck(folder, path) result(full)
    character(*), intent(in) :: folder !! of the deck, from path_folder
    character(*), intent(in) :: path   !! as in the deck
    character(:), allocatable :: full

    full = path
    if (len(path) == 0) return
    if (path(1:1) /= '/') full = folder//path
  end function path_from_deck
end module talus_deck_path
