! SPDX-License-Identifier: MIT
!> Stands between HDF5 and the file: a program linked with it logs all that HDF5 writes, in order,
!> so that a test can look at the file as a kill before each of these writes would have left it.
!> The log writes.log is a sequence of records of eight-byte integers: 0, offset, bytes, then the
!> bytes themselves; or 1, length, 0 when the file was cut or lengthened.
module log_writes
  use, intrinsic :: iso_c_binding, only: c_f_pointer, c_int, c_int64_t, c_ptr, c_signed_char, &
    c_size_t
  implicit none
  private
  public :: pwrite, ftruncate, log_close

  integer :: unit = 0 !! of the log, 0 before the first write

  interface
    !> The C library's own pwrite, under its other name.
    integer(c_size_t) function c_pwrite64(file, bytes, n, offset) bind(c, name='pwrite64')
      import :: c_int, c_int64_t, c_ptr, c_size_t
      integer(c_int), value :: file
      type(c_ptr), value :: bytes
      integer(c_size_t), value :: n
      integer(c_int64_t), value :: offset
    end function c_pwrite64

    !> The C library's own ftruncate, under its other name.
    integer(c_int) function c_ftruncate64(file, length) bind(c, name='ftruncate64')
      import :: c_int, c_int64_t
      integer(c_int), value :: file
      integer(c_int64_t), value :: length
    end function c_ftruncate64
  end interface

contains

  !> What HDF5 calls to write.
  integer(c_size_t) function pwrite(file, bytes, n, offset) bind(c, name='pwrite')
    integer(c_int), value :: file
    type(c_ptr), value :: bytes
    integer(c_size_t), value :: n
    integer(c_int64_t), value :: offset
    integer(c_signed_char), pointer :: content(:)

    call c_f_pointer(bytes, content, [n])
    call log_open()
    write (unit) 0_c_int64_t, offset, int(n, c_int64_t), content
    pwrite = c_pwrite64(file, bytes, n, offset)
  end function pwrite

  !> What HDF5 calls to cut or lengthen a file.
  integer(c_int) function ftruncate(file, length) bind(c, name='ftruncate')
    integer(c_int), value :: file
    integer(c_int64_t), value :: length

    call log_open()
    write (unit) 1_c_int64_t, length, 0_c_int64_t
    ftruncate = c_ftruncate64(file, length)
  end function ftruncate

  subroutine log_open()
    if (unit == 0) open (newunit=unit, file='writes.log', access='stream', form='unformatted', &
                         status='replace', action='write')
  end subroutine log_open

  !> End the log.
  subroutine log_close()
    if (unit /= 0) close (unit)
    unit = 0
  end subroutine log_close
end module log_writes
