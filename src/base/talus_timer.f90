! SPDX-License-Identifier: MIT
!> Wall-clock time spent in named phases of a run.
module talus_timer
  use talus_kinds, only: dp, i8
  implicit none
  private
  public :: timer_t, timer_start, timer_stop, timer_seconds, timer_names, timer_now

  integer, parameter :: name_length = 32

  !> One phase: its name, the ticks it has taken, and when it was last started (-1: not running).
  type :: phase_t
    character(name_length) :: name = ''
    integer(i8) :: ticks = 0_i8
    integer(i8) :: started = -1_i8
  end type phase_t

  !> Phases in the order of their first start. Not for use inside a parallel region.
  type :: timer_t
    private
    type(phase_t), allocatable :: phases(:)
    integer :: n = 0
  end type timer_t

contains

  !> Start a phase, new or known. A phase that runs already goes on.
  subroutine timer_start(timer, name)
    type(timer_t), intent(inout) :: timer
    character(*), intent(in) :: name !! of the phase; its first 32 characters count
    integer :: i

    i = phase_index(timer, name)
    if (i == 0) then
      call phase_append(timer, name)
      i = timer%n
    end if
    if (timer%phases(i)%started < 0_i8) timer%phases(i)%started = clock_ticks()
  end subroutine timer_start

  !> Stop a phase and add its time. Stopping one that does not run changes nothing.
  subroutine timer_stop(timer, name)
    type(timer_t), intent(inout) :: timer
    character(*), intent(in) :: name !! of the phase
    integer(i8) :: now
    integer :: i

    now = clock_ticks()
    i = phase_index(timer, name)
    if (i == 0) return
    associate (phase => timer%phases(i))
      if (phase%started < 0_i8) return
      phase%ticks = phase%ticks + (now - phase%started)
      phase%started = -1_i8
    end associate
  end subroutine timer_stop

  !> Seconds spent in a phase so far, the running part included; 0 for an unknown phase.
  real(dp) function timer_seconds(timer, name)
    type(timer_t), intent(in) :: timer
    character(*), intent(in) :: name !! of the phase
    integer(i8) :: ticks
    integer :: i

    timer_seconds = 0.0_dp
    i = phase_index(timer, name)
    if (i == 0) return
    ticks = timer%phases(i)%ticks
    if (timer%phases(i)%started >= 0_i8) ticks = ticks + (clock_ticks() - timer%phases(i)%started)
    timer_seconds = real(ticks, dp)/real(clock_rate(), dp)
  end function timer_seconds

  !> Names of the phases in the order of their first start.
  pure function timer_names(timer) result(names)
    type(timer_t), intent(in) :: timer
    character(name_length), allocatable :: names(:)
    integer :: i

    allocate (names(timer%n))
    do i = 1, timer%n
      names(i) = timer%phases(i)%name
    end do
  end function timer_names

  !> Seconds since an arbitrary moment, for differences.
  real(dp) function timer_now()
    timer_now = real(clock_ticks(), dp)/real(clock_rate(), dp)
  end function timer_now

  !> Position of a phase, 0 when there is none of that name.
  pure integer function phase_index(timer, name)
    type(timer_t), intent(in) :: timer
    character(*), intent(in) :: name
    integer :: i

    phase_index = 0
    do i = 1, timer%n
      if (timer%phases(i)%name == name(:min(len(name), name_length))) then
        phase_index = i
        return
      end if
    end do
  end function phase_index

  subroutine phase_append(timer, name)
    type(timer_t), intent(inout) :: timer
    character(*), intent(in) :: name
    type(phase_t), allocatable :: longer(:)

    if (.not. allocated(timer%phases)) allocate (timer%phases(8))
    if (timer%n == size(timer%phases)) then
      allocate (longer(2*timer%n))
      longer(:timer%n) = timer%phases
      call move_alloc(longer, timer%phases)
    end if
    timer%n = timer%n + 1
    timer%phases(timer%n)%name = name(:min(len(name), name_length))
  end subroutine phase_append

  integer(i8) function clock_ticks()
    call system_clock(count=clock_ticks)
  end function clock_ticks

  integer(i8) function clock_rate()
    call system_clock(count_rate=clock_rate)
  end function clock_rate
end module talus_timer
