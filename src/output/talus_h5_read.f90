! SPDX-License-Identifier: MIT
!> Read datasets back from an HDF5 file.
module talus_h5_read
  use, intrinsic :: iso_c_binding, only: c_char, c_loc, c_null_char, c_ptr
  use hdf5, only: hid_t, hsize_t, h5dopen_f, h5dclose_f, h5dread_f, h5dget_space_f, h5dget_type_f, &
    h5sclose_f, h5sget_simple_extent_dims_f, h5sget_simple_extent_ndims_f, h5tget_size_f, &
    h5tclose_f, h5t_native_double, h5t_native_integer, size_t
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_failed
  use talus_h5_file, only: h5_file_t, h5_fail
  implicit none
  private
  public :: h5_read, h5_dataset_open

  !> Read a whole dataset: text; reals (n), (m,n); integers (n). Empty after a failure.
  interface h5_read
    module procedure read_text, read_real_1, read_real_2, read_integer_1
  end interface h5_read

contains

  !> Open a dataset of the given rank.
  subroutine h5_dataset_open(file, name, dataset, dims, status)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: name               !! path of the dataset
    integer(hid_t), intent(out) :: dataset
    integer(hsize_t), intent(out) :: dims(:)       !! Fortran order; 0 after a failure
    type(status_t), intent(inout) :: status
    integer(hsize_t) :: max_dims(size(dims))
    integer(hid_t) :: space
    integer :: rank, ierr, ignored

    dims = 0
    dataset = -1
    if (status_failed(status)) return
    call h5dopen_f(file%here, name, dataset, ierr)
    if (ierr /= 0) then
      call h5_fail(file, name, 'not found', status)
      return
    end if
    call h5dget_space_f(dataset, space, ierr)
    call h5sget_simple_extent_ndims_f(space, rank, ierr)
    if (rank /= size(dims)) then
      call h5_fail(file, name, 'has another number of dimensions', status)
    else if (rank > 0) then
      call h5sget_simple_extent_dims_f(space, dims, max_dims, ierr)
    end if
    call h5sclose_f(space, ignored)
  end subroutine h5_dataset_open

  !> Read into memory and close.
  subroutine dataset_read(file, name, dataset, data_type, address, status)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: name            !! path of the dataset
    integer(hid_t), intent(in) :: dataset, data_type
    type(c_ptr), intent(in) :: address          !! where the data go
    type(status_t), intent(inout) :: status
    type(c_ptr) :: target_address
    integer :: ierr, ignored

    if (dataset < 0) return
    target_address = address
    ierr = 0
    if (.not. status_failed(status)) call h5dread_f(dataset, data_type, target_address, ierr)
    if (ierr /= 0) call h5_fail(file, name, 'could not be read', status)
    call h5dclose_f(dataset, ignored)
  end subroutine dataset_read

  subroutine read_real_1(file, name, data, status)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: name !! path of the dataset
    real(dp), allocatable, target, intent(out) :: data(:)
    type(status_t), intent(inout) :: status
    integer(hsize_t) :: dims(1)
    integer(hid_t) :: dataset

    call h5_dataset_open(file, name, dataset, dims, status)
    allocate (data(dims(1)))
    call dataset_read(file, name, dataset, h5t_native_double, c_loc(data), status)
  end subroutine read_real_1

  subroutine read_real_2(file, name, data, status)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: name !! path of the dataset
    real(dp), allocatable, target, intent(out) :: data(:,:)
    type(status_t), intent(inout) :: status
    integer(hsize_t) :: dims(2)
    integer(hid_t) :: dataset

    call h5_dataset_open(file, name, dataset, dims, status)
    allocate (data(dims(1), dims(2)))
    call dataset_read(file, name, dataset, h5t_native_double, c_loc(data), status)
  end subroutine read_real_2

  subroutine read_integer_1(file, name, data, status)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: name !! path of the dataset
    integer, allocatable, target, intent(out) :: data(:)
    type(status_t), intent(inout) :: status
    integer(hsize_t) :: dims(1)
    integer(hid_t) :: dataset

    call h5_dataset_open(file, name, dataset, dims, status)
    allocate (data(dims(1)))
    call dataset_read(file, name, dataset, h5t_native_integer, c_loc(data), status)
  end subroutine read_integer_1

  subroutine read_text(file, name, text, status)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: name !! path of the dataset
    character(:), allocatable, intent(out) :: text
    type(status_t), intent(inout) :: status
    character(kind=c_char), allocatable, target :: letters(:)
    integer(hsize_t) :: none(0)
    integer(hid_t) :: dataset, letter_type
    integer(size_t) :: length
    integer :: i, ierr

    text = ''
    call h5_dataset_open(file, name, dataset, none, status)
    if (dataset < 0) return
    call h5dget_type_f(dataset, letter_type, ierr)
    call h5tget_size_f(letter_type, length, ierr)
    allocate (letters(length))
    letters = c_null_char
    call dataset_read(file, name, dataset, letter_type, c_loc(letters), status)
    call h5tclose_f(letter_type, ierr)
    do i = 1, size(letters)
      if (letters(i) == c_null_char) exit
      text = text//letters(i)
    end do
  end subroutine read_text
end module talus_h5_read
