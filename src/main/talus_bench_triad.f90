! SPDX-License-Identifier: MIT
!> Bandwidth of memory by the STREAM triad a = b + s c (McCalpin 1995), counted as STREAM does: two
!> arrays read and one written, 24 bytes an entry.
module talus_bench_triad
  use talus_kinds, only: dp
  use talus_timer, only: timer_now
  implicit none
  private
  public :: triad_t, triad_allocate, triad_bandwidth

  !> Three arrays of 128 MB: four times the 32 MB of a large last cache.
  integer, parameter, public :: triad_entries = 16000000
  real(dp), parameter :: factor = 3.0_dp

  type :: triad_t
    real(dp), allocatable :: a(:), b(:), c(:)
  end type triad_t

contains

  !> Allocate and first touch, by the threads that will use them.
  subroutine triad_allocate(triad, entries)
    type(triad_t), intent(out) :: triad
    integer, intent(in) :: entries !! of each array
    integer :: i

    allocate (triad%a(entries), triad%b(entries), triad%c(entries))
    !$omp parallel do default(none) shared(triad, entries) private(i) schedule(static)
    do i = 1, entries
      triad%a(i) = 0.0_dp
      triad%b(i) = 1.0_dp
      triad%c(i) = 2.0_dp
    end do
    !$omp end parallel do
  end subroutine triad_allocate

  !> One pass [bytes/s].
  real(dp) function triad_bandwidth(triad) result(bandwidth)
    type(triad_t), intent(inout) :: triad
    real(dp) :: began

    began = timer_now()
    call triad_pass(triad%a, triad%b, triad%c)
    bandwidth = 24.0_dp*real(size(triad%a), dp)/max(timer_now() - began, tiny(1.0_dp))
  end function triad_bandwidth

  subroutine triad_pass(a, b, c)
    real(dp), contiguous, intent(inout) :: a(:)
    real(dp), contiguous, intent(in) :: b(:), c(:)
    integer :: i

    !$omp parallel do default(none) shared(a, b, c) private(i) schedule(static)
    do i = 1, size(a)
      a(i) = b(i) + factor*c(i)
    end do
    !$omp end parallel do
  end subroutine triad_pass
end module talus_bench_triad
