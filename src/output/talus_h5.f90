! SPDX-License-Identifier: MIT
!> Datasets and attributes of an HDF5 file. Every failure becomes a status that names the file and
!> the object. A Fortran array (ncomp, n) is seen as (n, ncomp) from C and Python.
module talus_h5
  use, intrinsic :: iso_c_binding, only: c_char, c_loc, c_null_ptr, c_ptr
  use hdf5, only: hid_t, hsize_t, h5oopen_f, h5oclose_f, h5screate_f, h5screate_simple_f, &
    h5sclose_f, h5dcreate_f, h5dwrite_f, h5dclose_f, h5acreate_f, h5awrite_f, h5aclose_f, &
    h5aexists_f, h5adelete_f, h5tclose_f, h5pcreate_f, h5pclose_f, h5pset_create_inter_group_f, &
    h5s_scalar_f, h5t_native_double, h5t_native_integer, h5p_link_create_f
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_failed
  use talus_h5_file, only: h5_file_t, h5_create, h5_open, h5_close, h5_exists, h5_names, &
    h5_delete, h5_name_letters, h5_group_begin, h5_group_end, h5_group_roomy, h5_fail, &
    h5_letters, h5_text_type
  implicit none
  private
  public :: h5_file_t, h5_create, h5_open, h5_close, h5_exists, h5_names, h5_name_letters
  public :: h5_delete, h5_group_begin, h5_group_end, h5_group_roomy
  public :: h5_write, h5_attribute

  !> Write a dataset: text; reals (n), (m,n); integers (n), (m,n); a list of names.
  interface h5_write
    module procedure write_text, write_texts, write_real_1, write_real_2, write_integer_1, &
      write_integer_2
  end interface h5_write

  !> Write an attribute of an object ('.' is the current group); an old one is replaced.
  interface h5_attribute
    module procedure attribute_text, attribute_real, attribute_integer
  end interface h5_attribute

contains

  !> Write one text.
  subroutine write_text(file, name, text, status)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: name !! path of the dataset
    character(*), intent(in) :: text
    type(status_t), intent(inout) :: status
    character(kind=c_char), target :: letters(max(1, len(text)))
    integer(hsize_t) :: none(0)
    integer(hid_t) :: letter_type
    integer :: ignored

    if (status_failed(status)) return
    call h5_letters(text, letters)
    call h5_text_type(len(text), letter_type)
    call write_data(file, name, letter_type, none, c_loc(letters), status)
    call h5tclose_f(letter_type, ignored)
  end subroutine write_text

  !> Write a list of names.
  subroutine write_texts(file, name, texts, status)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: name !! path of the dataset
    character(*), intent(in) :: texts(:)
    type(status_t), intent(inout) :: status
    character(kind=c_char), target :: letters(max(1, len(texts)), max(1, size(texts)))
    integer(hid_t) :: letter_type
    integer :: i, ignored

    if (status_failed(status)) return
    do i = 1, size(texts)
      call h5_letters(trim(texts(i)), letters(:, i))
    end do
    call h5_text_type(len(texts), letter_type)
    call write_data(file, name, letter_type, shape(texts, hsize_t), c_loc(letters), status)
    call h5tclose_f(letter_type, ignored)
  end subroutine write_texts

  subroutine write_real_1(file, name, data, status)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: name !! path of the dataset
    real(dp), intent(in), target, contiguous :: data(:)
    type(status_t), intent(inout) :: status
    type(c_ptr) :: address

    address = c_null_ptr
    if (size(data) > 0) address = c_loc(data)
    call write_data(file, name, h5t_native_double, shape(data, hsize_t), address, status)
  end subroutine write_real_1

  subroutine write_real_2(file, name, data, status)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: name !! path of the dataset
    real(dp), intent(in), target, contiguous :: data(:,:)
    type(status_t), intent(inout) :: status
    type(c_ptr) :: address

    address = c_null_ptr
    if (size(data) > 0) address = c_loc(data)
    call write_data(file, name, h5t_native_double, shape(data, hsize_t), address, status)
  end subroutine write_real_2

  subroutine write_integer_1(file, name, data, status)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: name !! path of the dataset
    integer, intent(in), target, contiguous :: data(:)
    type(status_t), intent(inout) :: status
    type(c_ptr) :: address

    address = c_null_ptr
    if (size(data) > 0) address = c_loc(data)
    call write_data(file, name, h5t_native_integer, shape(data, hsize_t), address, status)
  end subroutine write_integer_1

  subroutine write_integer_2(file, name, data, status)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: name !! path of the dataset
    integer, intent(in), target, contiguous :: data(:,:)
    type(status_t), intent(inout) :: status
    type(c_ptr) :: address

    address = c_null_ptr
    if (size(data) > 0) address = c_loc(data)
    call write_data(file, name, h5t_native_integer, shape(data, hsize_t), address, status)
  end subroutine write_integer_2

  !> Create a dataset, with the groups of its path, and fill it.
  subroutine write_data(file, name, data_type, dims, address, status)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: name            !! path of the dataset
    integer(hid_t), intent(in) :: data_type     !! HDF5 type in memory and in the file
    integer(hsize_t), intent(in) :: dims(:)     !! Fortran order; none for a scalar
    type(c_ptr), intent(in) :: address          !! of the data
    type(status_t), intent(inout) :: status
    integer(hid_t) :: space, parents, dataset
    integer :: ierr, ignored

    if (status_failed(status)) return
    if (size(dims) == 0) then
      call h5screate_f(h5s_scalar_f, space, ierr)
    else
      call h5screate_simple_f(size(dims), dims, space, ierr)
    end if
    call h5pcreate_f(h5p_link_create_f, parents, ierr)
    call h5pset_create_inter_group_f(parents, 1, ierr)
    call h5dcreate_f(file%here, name, data_type, space, dataset, ierr, lcpl_id=parents)
    if (ierr /= 0) then
      call h5_fail(file, name, 'could not be created (does it exist already?)', status)
    else
      if (product(dims) > 0) call h5dwrite_f(dataset, data_type, address, ierr)
      if (ierr /= 0) call h5_fail(file, name, 'could not be written (disk full?)', status)
      call h5dclose_f(dataset, ignored)
    end if
    call h5pclose_f(parents, ignored)
    call h5sclose_f(space, ignored)
  end subroutine write_data

  subroutine attribute_text(file, object, name, text, status)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: object, name !! path of the object, name of the attribute
    character(*), intent(in) :: text
    type(status_t), intent(inout) :: status
    character(kind=c_char), target :: letters(max(1, len(text)))
    integer(hid_t) :: letter_type
    integer :: ignored

    if (status_failed(status)) return
    call h5_letters(text, letters)
    call h5_text_type(len(text), letter_type)
    call write_attribute(file, object, name, letter_type, c_loc(letters), status)
    call h5tclose_f(letter_type, ignored)
  end subroutine attribute_text

  subroutine attribute_real(file, object, name, value, status)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: object, name !! path of the object, name of the attribute
    real(dp), intent(in), target :: value
    type(status_t), intent(inout) :: status

    call write_attribute(file, object, name, h5t_native_double, c_loc(value), status)
  end subroutine attribute_real

  subroutine attribute_integer(file, object, name, value, status)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: object, name !! path of the object, name of the attribute
    integer, intent(in), target :: value
    type(status_t), intent(inout) :: status

    call write_attribute(file, object, name, h5t_native_integer, c_loc(value), status)
  end subroutine attribute_integer

  !> Create or replace a scalar attribute.
  subroutine write_attribute(file, object, name, data_type, address, status)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: object, name   !! path of the object, name of the attribute
    integer(hid_t), intent(in) :: data_type    !! HDF5 type in memory and in the file
    type(c_ptr), intent(in) :: address         !! of the value
    type(status_t), intent(inout) :: status
    integer(hid_t) :: owner, space, attribute
    integer :: ierr, ignored
    logical :: found

    if (status_failed(status)) return
    call h5oopen_f(file%here, object, owner, ierr)
    if (ierr /= 0) then
      call h5_fail(file, object, 'not found, for its attribute '''//name//'''', status)
      return
    end if
    call h5aexists_f(owner, name, found, ierr)
    if (ierr == 0 .and. found) call h5adelete_f(owner, name, ierr)
    call h5screate_f(h5s_scalar_f, space, ignored)
    if (ierr == 0) call h5acreate_f(owner, name, data_type, space, attribute, ierr)
    if (ierr == 0) then
      call h5awrite_f(attribute, data_type, address, ierr)
      call h5aclose_f(attribute, ignored)
    end if
    if (ierr /= 0) call h5_fail(file, object, 'attribute '''//name//''' could not be written', &
      status)
    call h5sclose_f(space, ignored)
    call h5oclose_f(owner, ignored)
  end subroutine write_attribute
end module talus_h5
