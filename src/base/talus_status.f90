! SPDX-License-Identifier: MIT
!> Outcome of a call. Libraries return a status; only the program stops.
module talus_status
  implicit none
  private
  public :: status_t, status_set, status_failed

  !> Exit codes of the program, and the kinds of failure.
  integer, parameter, public :: status_ok = 0, status_io = 1, status_deck = 2, status_numeric = 3

  type :: status_t
    integer :: code = status_ok          !! one of status_*
    character(:), allocatable :: message !! what went wrong, where, and what is allowed
  end type status_t

contains

  !> Record a failure. The first failure is kept: later ones are its consequences.
  pure subroutine status_set(status, code, message)
    type(status_t), intent(inout) :: status
    integer, intent(in) :: code             !! status_io, status_deck or status_numeric
    character(*), intent(in) :: message     !! text for the user

    if (status%code /= status_ok) return
    status%code = code
    status%message = message
  end subroutine status_set

  !> True when a failure was recorded.
  pure logical function status_failed(status)
    type(status_t), intent(in) :: status

    status_failed = status%code /= status_ok
  end function status_failed
end module talus_status
