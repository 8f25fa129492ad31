! SPDX-License-Identifier: MIT
!> Sums over nodes whose result does not depend on the number of threads: fixed blocks are summed
!> in parallel, and the block sums in order. Within a block there are several sums that do not wait
!> for each other.
module talus_sum
  use talus_kinds, only: dp
  implicit none
  private
  public :: sum_products, sum_apart, sum_add

  integer, parameter :: block_length = 1024, lanes = 16

contains

  !> Sum of the products of two arrays of n elements.
  real(dp) function sum_products(n, a, b) result(total)
    integer, intent(in) :: n
    real(dp), intent(in) :: a(n), b(n) !! any arrays of n elements
    real(dp), allocatable :: part(:)
    integer :: i, first

    allocate (part((n + block_length - 1)/block_length))
    !$omp parallel do default(none) shared(n, a, b, part) private(i, first) schedule(static)
    do i = 1, size(part)
      first = (i - 1)*block_length + 1
      part(i) = products_apart(min(block_length, n - first + 1), a(first), b(first))
    end do
    !$omp end parallel do
    total = sum(part)
  end function sum_products

  !> Sum of n values on one thread.
  pure real(dp) function sum_apart(n, a) result(total)
    integer, intent(in) :: n
    real(dp), intent(in) :: a(n)
    real(dp) :: lane(lanes)
    integer :: i

    lane = 0.0_dp
    do i = 1, n - lanes + 1, lanes
      lane = lane + a(i:i+lanes-1)
    end do
    total = sum(lane)
    do i = n - modulo(n, lanes) + 1, n
      total = total + a(i)
    end do
  end function sum_apart

  !> Sum of n products on one thread.
  pure real(dp) function products_apart(n, a, b) result(total)
    integer, intent(in) :: n
    real(dp), intent(in) :: a(n), b(n)
    real(dp) :: lane(lanes)
    integer :: i

    lane = 0.0_dp
    do i = 1, n - lanes + 1, lanes
      lane = lane + a(i:i+lanes-1)*b(i:i+lanes-1)
    end do
    total = sum(lane)
    do i = n - modulo(n, lanes) + 1, n
      total = total + a(i)*b(i)
    end do
  end function products_apart

  !> Add a small value to a long-running total without losing its low bits (Kahan 1965).
  pure subroutine sum_add(total, lost, value)
    real(dp), intent(inout) :: total !! the running total
    real(dp), intent(inout) :: lost  !! bits that total cannot hold; 0 at the start
    real(dp), intent(in) :: value    !! what to add
    real(dp) :: corrected, next

    corrected = value - lost
    next = total + corrected
    lost = (next - total) - corrected
    total = next
  end subroutine sum_add
end module talus_sum
