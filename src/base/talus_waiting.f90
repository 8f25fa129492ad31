! SPDX-License-Identifier: MIT
!> What libraries must be told before the program is loaded; so the program sets it and starts once
!> more. Threads wait for each other briefly: libgomp lets them spin at a barrier for long, which
!> stalls a run many times over as soon as others use the cores too. Memory comes in large pages
!> where the system has them: gathers reach over many pages, and small ones take a tenth of a step.
module talus_waiting
  use, intrinsic :: iso_c_binding, only: c_int, c_size_t, c_intptr_t, c_char, c_ptr, c_loc, &
    c_null_ptr, c_null_char
  implicit none
  private
  public :: wait_briefly

  !> Rounds that a thread spins before it sleeps: longer than the loops of a step differ, far
  !> shorter than a slice of the scheduler.
  character(*, c_char), parameter :: rounds = '1000'
  !> Advice to the system to use large pages, for the allocator of glibc; others do not read it.
  character(*, c_char), parameter :: large_pages = 'glibc.malloc.hugetlb=1'
  integer, parameter :: path_letters = 4096
  integer, parameter :: no_variable = 1 ! status of get_environment_variable

  interface
    function setenv(name, text, overwrite) bind(c) result(failed)
      import :: c_int, c_char
      character(kind=c_char), intent(in) :: name(*), text(*)
      integer(c_int), value :: overwrite
      integer(c_int) :: failed
    end function setenv

    function readlink(path, target_path, letters) bind(c) result(length)
      import :: c_char, c_size_t, c_intptr_t
      character(kind=c_char), intent(in) :: path(*)
      character(kind=c_char), intent(out) :: target_path(*)
      integer(c_size_t), value :: letters
      integer(c_intptr_t) :: length ! ssize_t
    end function readlink

    function execv(path, arguments) bind(c) result(failed)
      import :: c_int, c_char, c_ptr
      character(kind=c_char), intent(in) :: path(*)
      type(c_ptr), intent(in) :: arguments(*)
      integer(c_int) :: failed
    end function execv
  end interface

contains

  !> Start the program once more with GOMP_SPINCOUNT and GLIBC_TUNABLES set, to be called before
  !> anything is read or written. Leaves alone what the user has set, and does nothing where the
  !> system does not say which program this is.
  subroutine wait_briefly
    character(kind=c_char) :: path(path_letters)
    integer(c_int) :: failed(2)
    integer(c_intptr_t) :: length
    integer :: policy, spins, tunables

    call get_environment_variable('OMP_WAIT_POLICY', status=policy)
    call get_environment_variable('GOMP_SPINCOUNT', status=spins)
    call get_environment_variable('GLIBC_TUNABLES', status=tunables)
    if (policy /= no_variable) spins = policy
    if (spins /= no_variable .and. tunables /= no_variable) return
    length = readlink('/proc/self/exe'//c_null_char, path, int(path_letters, c_size_t))
    if (length < 1 .or. length >= path_letters) return
    path(length+1) = c_null_char
    ! Once both are set, the second start returns above.
    failed = 0
    if (spins == no_variable) &
      failed(1) = setenv('GOMP_SPINCOUNT'//c_null_char, rounds//c_null_char, 1_c_int)
    if (tunables == no_variable) &
      failed(2) = setenv('GLIBC_TUNABLES'//c_null_char, large_pages//c_null_char, 1_c_int)
    if (all(failed == 0)) call start_again(path)
  end subroutine wait_briefly

  !> Replace the process by another start of the program with the same words; returns where the
  !> system refuses.
  subroutine start_again(path)
    character(kind=c_char), intent(in) :: path(:)
    character(kind=c_char), allocatable, target :: letters(:) ! all words, each ended by a null
    type(c_ptr) :: arguments(command_argument_count() + 2)
    integer :: i, k, first, length
    integer(c_int) :: failed

    length = 0
    do i = 0, command_argument_count()
      call get_command_argument(i, length=k)
      length = length + k + 1
    end do
    allocate (letters(length))
    first = 1
    do i = 0, command_argument_count()
      call get_command_argument(i, length=length)
      call put_argument(i, letters(first:first+length))
      arguments(i+1) = c_loc(letters(first))
      first = first + length + 1
    end do
    arguments(size(arguments)) = c_null_ptr
    failed = execv(path, arguments)
  end subroutine start_again

  !> One word of the command line, ended by a null.
  subroutine put_argument(place, letters)
    integer, intent(in) :: place
    character(kind=c_char), intent(out) :: letters(:)
    character(size(letters)) :: word
    integer :: k

    call get_command_argument(place, word)
    do k = 1, size(letters) - 1
      letters(k) = word(k:k)
    end do
    letters(size(letters)) = c_null_char
  end subroutine put_argument
end module talus_waiting
