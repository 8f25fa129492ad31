! SPDX-License-Identifier: MIT
!> Sums over nodes whose result does not depend on the number of threads: fixed blocks are summed
!> in parallel, and the block sums in order.
module talus_sum
  use talus_kinds, only: dp
  implicit none
  private
  public :: sum_blocks, sum_products, sum_add

  integer, parameter :: block_length = 1024

contains

  !> Sum of n values.
  real(dp) function sum_blocks(n, a) result(total)
    integer, intent(in) :: n
    real(dp), intent(in) :: a(n) !! any array of n elements
    real(dp), allocatable :: part(:)
    integer :: b

    allocate (part((n + block_length - 1)/block_length))
    !$omp parallel do default(none) shared(n, a, part) private(b) schedule(static)
    do b = 1, size(part)
      part(b) = sum(a((b-1)*block_length+1:min(n, b*block_length)))
    end do
    !$omp end parallel do
    total = sum(part)
  end function sum_blocks

  !> Sum of the products of two arrays of n elements.
  real(dp) function sum_products(n, a, b) result(total)
    integer, intent(in) :: n
    real(dp), intent(in) :: a(n), b(n) !! any arrays of n elements
    real(dp), allocatable :: part(:)
    integer :: i, first, last

    allocate (part((n + block_length - 1)/block_length))
    !$omp parallel do default(none) shared(n, a, b, part) private(i, first, last) schedule(static)
    do i = 1, size(part)
      first = (i - 1)*block_length + 1
      last = min(n, i*block_length)
      part(i) = dot_product(a(first:last), b(first:last))
    end do
    !$omp end parallel do
    total = sum(part)
  end function sum_products

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
