! SPDX-License-Identifier: MIT
!> One-dimensional HDF5 datasets that grow. The room that a series is given is one chunk: as long as
!> it stays within that, growing adds nothing to the file and changes it by two writes, of which the
!> first, of values behind the end, is not seen before the second, of the length.
module talus_h5_append
  use, intrinsic :: iso_c_binding, only: c_char, c_int8_t, c_loc, c_ptr
  use hdf5, only: hid_t, hsize_t, size_t, h5screate_simple_f, h5sclose_f, h5sselect_hyperslab_f, &
    h5dcreate_f, h5dread_f, h5dwrite_f, h5dclose_f, &
    h5dget_space_f, h5dget_type_f, h5dset_extent_f, h5tclose_f, h5tget_size_f, &
    h5pcreate_f, h5pclose_f, h5pset_create_inter_group_f, h5pset_chunk_f, &
    h5s_select_set_f, h5s_unlimited_f, h5t_native_double, h5t_native_integer, &
    h5p_link_create_f, h5p_dataset_create_f
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_failed
  use talus_h5_file, only: h5_file_t, h5_fail, h5_letters, h5_text_type
  use talus_h5_read, only: h5_dataset_open
  implicit none
  private
  public :: h5_start_series, h5_append, h5_append_series

  !> Letters of one text in a series of texts.
  integer, parameter, public :: h5_series_letters = 64

  !> Append values to a series.
  interface h5_append
    module procedure append_real, append_integer, append_texts
  end interface h5_append

contains

  !> Create an empty series.
  subroutine h5_start_series(file, name, kind_of, room, status)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: name    !! path of the dataset
    character(*), intent(in) :: kind_of !! real, integer or text
    integer, intent(in) :: room         !! number of values that it can take safely
    type(status_t), intent(inout) :: status
    integer(hid_t) :: data_type, space, parents, chunked, dataset
    integer :: ierr, ignored

    if (status_failed(status)) return
    select case (kind_of)
    case ('text')
      call h5_text_type(h5_series_letters, data_type)
    case ('integer')
      data_type = h5t_native_integer
    case default
      data_type = h5t_native_double
    end select
    call h5screate_simple_f(1, [0_hsize_t], space, ierr, [h5s_unlimited_f])
    call h5pcreate_f(h5p_link_create_f, parents, ierr)
    call h5pset_create_inter_group_f(parents, 1, ierr)
    call h5pcreate_f(h5p_dataset_create_f, chunked, ierr)
    call h5pset_chunk_f(chunked, 1, [int(room, hsize_t)], ierr)
    call h5dcreate_f(file%here, name, data_type, space, dataset, ierr, chunked, parents)
    if (ierr /= 0) then
      call h5_fail(file, name, 'could not be created (does it exist already?)', status)
    else
      call h5dclose_f(dataset, ignored)
    end if
    call h5pclose_f(chunked, ignored)
    call h5pclose_f(parents, ignored)
    call h5sclose_f(space, ignored)
    if (kind_of == 'text') call h5tclose_f(data_type, ignored)
  end subroutine h5_start_series

  subroutine append_real(file, name, values, status)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: name !! path of the dataset
    real(dp), intent(in), target, contiguous :: values(:)
    type(status_t), intent(inout) :: status

    if (size(values) == 0) return
    call append_data(file, name, h5t_native_double, size(values, kind=hsize_t), c_loc(values), &
      status)
  end subroutine append_real

  subroutine append_integer(file, name, values, status)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: name !! path of the dataset
    integer, intent(in), target, contiguous :: values(:)
    type(status_t), intent(inout) :: status

    if (size(values) == 0) return
    call append_data(file, name, h5t_native_integer, size(values, kind=hsize_t), c_loc(values), &
      status)
  end subroutine append_integer

  subroutine append_texts(file, name, values, status)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: name !! path of the dataset
    character(*), intent(in) :: values(:) !! cut at h5_series_letters
    type(status_t), intent(inout) :: status
    character(kind=c_char), target :: letters(h5_series_letters, max(1, size(values)))
    integer(hid_t) :: letter_type
    integer :: i, ignored

    if (size(values) == 0 .or. status_failed(status)) return
    do i = 1, size(values)
      call h5_letters(trim(values(i)), letters(:, i))
    end do
    call h5_text_type(h5_series_letters, letter_type)
    call append_data(file, name, letter_type, size(values, kind=hsize_t), c_loc(letters), status)
    call h5tclose_f(letter_type, ignored)
  end subroutine append_texts

  !> Append all values of another series of the same kind.
  subroutine h5_append_series(file, name, source, status)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: name   !! path of the dataset
    character(*), intent(in) :: source !! path of the other dataset
    type(status_t), intent(inout) :: status
    integer(c_int8_t), allocatable, target :: values(:)
    type(c_ptr) :: address
    integer(hid_t) :: dataset, data_type
    integer(hsize_t) :: length(1)
    integer(size_t) :: bytes
    integer :: ierr, ignored

    call h5_dataset_open(file, source, dataset, length, status)
    if (status_failed(status)) return
    call h5dget_type_f(dataset, data_type, ierr)
    call h5tget_size_f(data_type, bytes, ierr)
    allocate (values(bytes*length(1)))
    address = c_loc(values)
    call h5dread_f(dataset, data_type, address, ierr)
    if (ierr /= 0) call h5_fail(file, source, 'could not be read', status)
    call append_data(file, name, data_type, length(1), address, status)
    call h5tclose_f(data_type, ignored)
    call h5dclose_f(dataset, ignored)
  end subroutine h5_append_series

  !> Lengthen a series and write its new end.
  subroutine append_data(file, name, data_type, n, address, status)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: name         !! path of the dataset
    integer(hid_t), intent(in) :: data_type  !! HDF5 type in memory
    integer(hsize_t), intent(in) :: n        !! number of new values
    type(c_ptr), intent(in) :: address       !! of the new values
    type(status_t), intent(inout) :: status
    integer(hid_t) :: dataset, space, piece
    integer(hsize_t) :: length(1)
    integer :: ierr, ignored

    call h5_dataset_open(file, name, dataset, length, status)
    if (status_failed(status)) return
    call h5dset_extent_f(dataset, length + n, ierr)
    if (ierr == 0) then
      call h5dget_space_f(dataset, space, ierr)
      call h5sselect_hyperslab_f(space, h5s_select_set_f, length, [n], ierr)
      call h5screate_simple_f(1, [n], piece, ierr)
      call h5dwrite_f(dataset, data_type, address, ierr, piece, space)
      call h5sclose_f(piece, ignored)
      call h5sclose_f(space, ignored)
    end if
    if (ierr /= 0) call h5_fail(file, name, 'could not be appended to (disk full?)', status)
    call h5dclose_f(dataset, ignored)
  end subroutine append_data
end module talus_h5_append
