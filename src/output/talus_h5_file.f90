! SPDX-License-Identifier: MIT
!> HDF5 files: open, close, and groups that appear whole or not at all.
!>
!> A program may be killed between any two writes of the library, which writes what has changed in
!> the order of addresses and the end of the file last. So that every such state can be read,
!> nothing that has a name is changed by more than one write at a time: groups that get new names
!> keep them in their header, which has room for all of them from the start (h5_group_roomy), and
!> what is new is on disk, within the end of the file there, before its name is written.
module talus_h5_file
  use, intrinsic :: iso_c_binding, only: c_char, c_int, c_null_char
  use hdf5, only: hid_t, size_t, h5open_f, h5eset_auto_f, h5fcreate_f, h5fopen_f, h5fclose_f, &
    h5fflush_f, h5gcreate_anon_f, h5gclose_f, h5olink_f, h5tcopy_f, h5tset_size_f, &
    h5tset_cset_f, h5tset_strpad_f, h5pcreate_f, h5pclose_f, h5pset_create_inter_group_f, &
    h5pset_link_creation_order_f, h5pset_link_phase_change_f, h5pset_est_link_info_f, &
    h5gcreate_f, h5lexists_f, h5ldelete_f, h5gn_members_f, h5gget_obj_info_idx_f, &
    h5f_acc_trunc_f, h5f_acc_rdonly_f, h5f_acc_rdwr_f, h5f_scope_global_f, &
    h5p_crt_order_tracked_f, h5p_file_create_f, h5p_group_create_f, h5p_link_create_f, &
    h5t_native_double, h5t_fortran_s1, h5t_cset_utf8_f, h5t_str_nullpad_f
  use talus_status, only: status_t, status_set, status_failed, status_io
  implicit none
  private
  public :: h5_create, h5_open, h5_close, h5_exists, h5_names, h5_delete, h5_group_begin
  public :: h5_group_end, h5_group_roomy
  public :: h5_fail, h5_letters, h5_text_type

  !> Longest name of an object that h5_names tells.
  integer, parameter, public :: h5_name_letters = 64

  !> Letters of a name for which h5_group_roomy has room.
  integer, parameter :: h5_usual_letters = 12

  !> Names for which the root group has room.
  integer, parameter :: root_names = 16

  !> Most names that a group may have room for: its header, a message of HDF5, has at most 64 kB.
  integer, parameter :: most_names = 1500

  !> An open HDF5 file.
  type, public :: h5_file_t
    character(:), allocatable :: path !! file name
    integer(hid_t) :: id = -1         !! of the file, -1 when closed
    integer(hid_t) :: here = -1       !! group in which names without a leading / are found
  end type h5_file_t

  interface
    !> POSIX setenv.
    integer(c_int) function c_setenv(name, value, overwrite) bind(c, name='setenv')
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: name(*), value(*)
      integer(c_int), value :: overwrite
    end function c_setenv
  end interface

contains

  !> Start the HDF5 library once, silent, and without file locks: a viewer that has the file open
  !> must not make the run fail. A lock setting made by the user is kept.
  subroutine library_start(ierr)
    integer, intent(out) :: ierr !! 0 when all went well

    ierr = 0
    if (h5t_native_double > 0) return
    ierr = c_setenv('HDF5_USE_FILE_LOCKING'//c_null_char, 'FALSE'//c_null_char, 0_c_int)
    call h5open_f(ierr)
    if (ierr == 0) call h5eset_auto_f(0, ierr)
  end subroutine library_start

  !> Create a file, or empty the one that is there.
  subroutine h5_create(file, path, status)
    type(h5_file_t), intent(out) :: file
    character(*), intent(in) :: path !! file name
    type(status_t), intent(inout) :: status
    integer(hid_t) :: creation
    integer :: ierr, ignored

    file%path = path
    if (status_failed(status)) return
    call library_start(ierr)
    if (ierr == 0) call h5pcreate_f(h5p_file_create_f, creation, ierr)
    if (ierr == 0) then
      call make_room(creation, root_names, ierr)
      call h5fcreate_f(path, h5f_acc_trunc_f, file%id, ierr, creation)
      call h5pclose_f(creation, ignored)
    end if
    if (ierr /= 0) then
      file%id = -1
      call status_set(status, status_io, 'output file '''//path// &
        ''': could not be created (does its folder exist, and may you write there?)')
      return
    end if
    file%here = file%id
  end subroutine h5_create

  !> Open an existing file.
  subroutine h5_open(file, path, status, read_only)
    type(h5_file_t), intent(out) :: file
    character(*), intent(in) :: path !! file name
    type(status_t), intent(inout) :: status
    logical, intent(in), optional :: read_only !! default .false.
    integer :: ierr, mode

    file%path = path
    if (status_failed(status)) return
    mode = h5f_acc_rdwr_f
    call library_start(ierr)
    if (ierr == 0) then
      mode = h5f_acc_rdwr_f
      if (present(read_only)) then
        if (read_only) mode = h5f_acc_rdonly_f
      end if
      call h5fopen_f(path, mode, file%id, ierr)
    end if
    if (ierr /= 0) then
      file%id = -1
      call status_set(status, status_io, 'HDF5 file '''//path// &
        ''': could not be opened (is it there, is it HDF5, is it open elsewhere?)')
      return
    end if
    file%here = file%id
  end subroutine h5_open

  !> Close a file, also after a failure; nothing happens when it is not open.
  subroutine h5_close(file, status)
    type(h5_file_t), intent(inout) :: file
    type(status_t), intent(inout) :: status
    integer :: ierr

    if (file%id < 0) return
    if (file%here /= file%id) call h5gclose_f(file%here, ierr)
    call h5fclose_f(file%id, ierr)
    if (ierr /= 0) call h5_fail(file, '/', 'could not be closed (disk full?)', status)
    file%id = -1
    file%here = -1
  end subroutine h5_close

  !> Record what went wrong with an object of the file.
  subroutine h5_fail(file, name, reason, status)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: name, reason
    type(status_t), intent(inout) :: status

    call status_set(status, status_io, &
      'HDF5 file '''//file%path//''', object '''//name//''': '//reason)
  end subroutine h5_fail

  !> True when the file has an object of this name; its parent groups must exist.
  logical function h5_exists(file, name)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: name !! path of the object
    integer :: ierr

    call h5lexists_f(file%here, name, h5_exists, ierr)
    if (ierr /= 0) h5_exists = .false.
  end function h5_exists

  !> Names of the objects of a group, in the order of letters; none when there is no such group.
  subroutine h5_names(file, group, names)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: group !! path
    character(h5_name_letters), allocatable, intent(out) :: names(:)
    integer :: i, n, kind_of, ierr

    n = 0
    if (h5_exists(file, group)) call h5gn_members_f(file%id, group, n, ierr)
    allocate (names(max(0, n)))
    do i = 1, size(names)
      call h5gget_obj_info_idx_f(file%id, group, i - 1, names(i), kind_of, ierr)
    end do
  end subroutine h5_names

  !> Let a group keep its names in its header, with room for as many from the start.
  subroutine make_room(creation, names, ierr)
    integer(hid_t), intent(in) :: creation !! properties with which a group or a file is created
    integer, intent(in) :: names
    integer, intent(out) :: ierr !! 0 when all went well

    ! The order of creation, which nobody asks for, makes HDF5 choose the groups that can do this.
    call h5pset_link_creation_order_f(creation, h5p_crt_order_tracked_f, ierr)
    if (ierr == 0) call h5pset_link_phase_change_f(creation, most_names, 0, ierr)
    if (ierr == 0) call h5pset_est_link_info_f(creation, min(names, most_names), &
                                               h5_usual_letters, ierr)
  end subroutine make_room

  !> Create an empty group that can take `names` names, each by one write. More names can be given,
  !> then by several writes.
  subroutine h5_group_roomy(file, name, names, status)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: name !! path of the group; its parent must exist
    integer, intent(in) :: names     !! of h5_usual_letters at most
    type(status_t), intent(inout) :: status
    integer(hid_t) :: creation, group
    integer :: ierr, ignored

    if (status_failed(status)) return
    call h5pcreate_f(h5p_group_create_f, creation, ierr)
    if (ierr == 0) then
      call make_room(creation, names, ierr)
      if (ierr == 0) call h5gcreate_f(file%id, name, group, ierr, gcpl_id=creation)
      if (ierr == 0) call h5gclose_f(group, ierr)
      call h5pclose_f(creation, ignored)
    end if
    if (ierr /= 0) call h5_fail(file, name, 'could not be created (name in use, disk full?)', &
      status)
  end subroutine h5_group_roomy

  !> Take an object out of the file; nothing happens when there is none.
  subroutine h5_delete(file, name, status)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: name !! path of the object; its parent groups need not exist
    type(status_t), intent(inout) :: status
    integer :: ierr

    if (status_failed(status)) return
    if (.not. h5_exists(file, name)) return
    call h5ldelete_f(file%id, name, ierr)
    if (ierr /= 0) call h5_fail(file, name, 'could not be deleted', status)
  end subroutine h5_delete

  !> Start a group that nobody can see before h5_group_end: names without a leading / go into it.
  subroutine h5_group_begin(file, status)
    type(h5_file_t), intent(inout) :: file
    type(status_t), intent(inout) :: status
    integer :: ierr

    if (status_failed(status)) return
    call h5gcreate_anon_f(file%id, file%here, ierr)
    if (ierr /= 0) then
      file%here = file%id
      call h5_fail(file, '(new group)', 'could not be created', status)
    end if
  end subroutine h5_group_begin

  !> Give the group its name. Its content is flushed first, so that the name never shows half of it.
  !> A group that had the name gives way to it in the same write.
  subroutine h5_group_end(file, name, status, replace)
    type(h5_file_t), intent(inout) :: file
    character(*), intent(in) :: name !! path of the group, e.g. '/snapshots/000000'
    type(status_t), intent(inout) :: status
    logical, intent(in), optional :: replace !! the name may be in use; default .false.
    integer(hid_t) :: parents
    integer :: ierr, ignored

    if (status_failed(status)) return
    call h5fflush_f(file%id, h5f_scope_global_f, ierr)
    if (present(replace)) then
      if (replace) call h5_delete(file, name, status)
    end if
    if (ierr == 0) call h5pcreate_f(h5p_link_create_f, parents, ierr)
    if (ierr == 0) then
      call h5pset_create_inter_group_f(parents, 1, ierr)
      call h5olink_f(file%here, file%id, name, ierr, lcpl_id=parents)
      call h5pclose_f(parents, ignored)
    end if
    if (ierr /= 0) call h5_fail(file, name, 'could not be written (name in use, disk full?)', &
      status)
    call h5gclose_f(file%here, ignored)
    file%here = file%id
  end subroutine h5_group_end

  !> The bytes of a text: cut to fit, NUL behind its end.
  pure subroutine h5_letters(text, letters)
    character(*), intent(in) :: text
    character(kind=c_char), intent(out) :: letters(:)
    integer :: i

    letters = c_null_char
    do i = 1, min(len(text), size(letters))
      letters(i) = text(i:i)
    end do
  end subroutine h5_letters

  !> HDF5 type of a text of `length` bytes of UTF-8, padded with NUL.
  subroutine h5_text_type(length, id)
    integer, intent(in) :: length
    integer(hid_t), intent(out) :: id
    integer :: ierr

    call h5tcopy_f(h5t_fortran_s1, id, ierr)
    call h5tset_size_f(id, int(max(1, length), size_t), ierr)
    call h5tset_cset_f(id, h5t_cset_utf8_f, ierr)
    call h5tset_strpad_f(id, h5t_str_nullpad_f, ierr)
  end subroutine h5_text_type
end module talus_h5_file
