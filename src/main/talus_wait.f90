! SPDX-License-Identifier: MIT
!> How threads wait for each other. GNU's OpenMP lets them spin for long, which stalls a run by far
!> where the processors have other work too: a thread that waits keeps the one it waits for from
!> running. It reads its settings once, as the program is loaded, so the program starts itself anew.
module talus_wait
  use, intrinsic :: iso_c_binding, only: c_char, c_int, c_loc, c_null_char, c_null_ptr, c_ptr
  implicit none
  private
  public :: wait_briefly

  interface
    integer(c_int) function setenv(name, value, overwrite) bind(c)
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: name(*), value(*)
      integer(c_int), value :: overwrite
    end function setenv

    integer(c_int) function execv(path, arguments) bind(c)
      import :: c_char, c_int, c_ptr
      character(kind=c_char), intent(in) :: path(*)
      type(c_ptr), intent(in) :: arguments(*)
    end function execv
  end interface

contains

  !> Start the program anew with short spinning, unless the user has said how threads wait. Comes
  !> back where that is said already, or where the program cannot be started anew.
  subroutine wait_briefly
    character(:), allocatable, target :: words
    type(c_ptr), allocatable :: arguments(:)
    integer, allocatable :: first(:)
    integer :: i, n, no_spin, no_policy

    call get_environment_variable('GOMP_SPINCOUNT', status=no_spin)
    call get_environment_variable('OMP_WAIT_POLICY', status=no_policy)
    if (min(no_spin, no_policy) == 0) return
    if (setenv('GOMP_SPINCOUNT'//c_null_char, '1000'//c_null_char, 0_c_int) /= 0) return
    n = command_argument_count()
    allocate (first(0:n), arguments(n + 2))
    words = ''
    do i = 0, n
      first(i) = len(words) + 1
      words = words//argument(i)//c_null_char
    end do
    do i = 0, n
      arguments(i+1) = c_loc(words(first(i):first(i)))
    end do
    arguments(n+2) = c_null_ptr
    ! Comes back only where it fails; the run is then the same, but slower on a busy machine.
    i = execv('/proc/self/exe'//c_null_char, arguments)
  end subroutine wait_briefly

  function argument(i) result(word)
    integer, intent(in) :: i !! 0: the program
    character(:), allocatable :: word
    integer :: length

    call get_command_argument(i, length=length)
    allocate (character(length) :: word)
    call get_command_argument(i, word)
  end function argument
end module talus_wait
