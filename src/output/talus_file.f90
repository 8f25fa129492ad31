! SPDX-License-Identifier: MIT
!> Text files that are always whole: a new version is written beside the old one and renamed
!> over it in one step, so that a run killed at any moment leaves the old or the new version.
module talus_file
  use, intrinsic :: iso_c_binding, only: c_associated, c_char, c_int, c_loc, c_null_char, c_ptr
  use talus_status, only: status_t, status_set, status_failed, status_io
  implicit none
  private
  public :: file_exists, file_same, file_replace, file_base_name, file_delete

  !> Letters that POSIX allows a path (PATH_MAX), and the end.
  integer, parameter :: path_letters = 4097

  interface
    !> POSIX rename: replaces `new` in one step.
    integer(c_int) function c_rename(old, new) bind(c, name='rename')
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: old(*), new(*)
    end function c_rename

    !> POSIX realpath: the path without links and dots, or a null pointer.
    type(c_ptr) function c_realpath(path, resolved) bind(c, name='realpath')
      import :: c_char, c_ptr
      character(kind=c_char), intent(in) :: path(*)
      type(c_ptr), value :: resolved
    end function c_realpath
  end interface

contains

  !> True when a file of this name can be seen.
  logical function file_exists(path)
    character(*), intent(in) :: path !! file name

    inquire (file=path, exist=file_exists)
  end function file_exists

  !> True when two names mean the same file, which exists.
  logical function file_same(one, other)
    character(*), intent(in) :: one, other !! file names
    character(kind=c_char), target :: path(path_letters, 2)
    type(c_ptr) :: found(2)

    path = c_null_char
    found(1) = c_realpath(one//c_null_char, c_loc(path(:, 1)))
    found(2) = c_realpath(other//c_null_char, c_loc(path(:, 2)))
    file_same = c_associated(found(1)) .and. c_associated(found(2)) &
      .and. all(path(:, 1) == path(:, 2))
  end function file_same

  !> Name without its folders: 'out/slope.h5' is 'slope.h5'.
  pure function file_base_name(path) result(name)
    character(*), intent(in) :: path !! file name
    character(:), allocatable :: name

    name = trim(path(index(path, '/', back=.true.)+1:))
  end function file_base_name

  !> Delete a file; nothing happens when there is none.
  subroutine file_delete(path)
    character(*), intent(in) :: path !! file name
    integer :: unit, failed

    if (.not. file_exists(path)) return
    open (newunit=unit, file=path, status='old', iostat=failed)
    if (failed == 0) close (unit, status='delete', iostat=failed)
  end subroutine file_delete

  !> Give the file `path` this text, all of it or none.
  subroutine file_replace(path, text, status)
    character(*), intent(in) :: path !! file name
    character(*), intent(in) :: text !! whole content, lines ended by new_line
    type(status_t), intent(inout) :: status
    character(:), allocatable :: part
    character(256) :: reason
    integer :: unit, failed

    if (status_failed(status)) return
    part = path//'.part'
    reason = ''
    open (newunit=unit, file=part, status='replace', action='write', access='stream', &
      form='unformatted', iostat=failed, iomsg=reason)
    if (failed == 0) then
      write (unit, iostat=failed, iomsg=reason) text
      if (failed == 0) then
        close (unit, iostat=failed, iomsg=reason)
      else
        close (unit, status='delete')
      end if
    end if
    if (failed == 0) then
      if (c_rename(part//c_null_char, path//c_null_char) /= 0) then
        failed = 1
        reason = 'could not rename '//part
        call file_delete(part)
      end if
    end if
    if (failed /= 0) call status_set(status, status_io, &
      'output file '''//path//''': could not be written: '//trim(reason))
  end subroutine file_replace
end module talus_file
