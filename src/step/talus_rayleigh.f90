! SPDX-License-Identifier: MIT
!> Directions in which a body may move, with what mass and stiffness make of them, and the sum of up
!> to three of them that has the greatest quotient of Rayleigh d.K d/(d.M d): the turn of the locally
!> optimal conjugate gradients of Knyazev (2001).
module talus_rayleigh
  use talus_kinds, only: dp
  use talus_sum, only: sum_products
  implicit none
  private
  public :: direction_t, direction_blend, direction_residual, direction_unit, &
    direction_across
  public :: rayleigh_best

  type :: direction_t
    real(dp), allocatable :: d(:,:) !! displacement [m], (2,n)
    real(dp), allocatable :: m(:,:) !! mass times it, M d [kg], (2,n)
    real(dp), allocatable :: k(:,:) !! stiffness times it, K d [N/m], (2,n)
  end type direction_t

  !> A direction that keeps a smaller part of its length across others is round-off: the root of
  !> the relative precision.
  real(dp), parameter :: share_least = 1.0e-8_dp

  interface
    subroutine dsyev(jobz, uplo, n, a, lda, w, work, lwork, info)
      import :: dp
      character, intent(in) :: jobz, uplo
      integer, intent(in) :: n, lda, lwork
      real(dp), intent(inout) :: a(lda,*)
      real(dp), intent(out) :: w(*), work(*)
      integer, intent(out) :: info
    end subroutine dsyev
  end interface

contains

  !> to = a from + b to.
  subroutine direction_blend(a, from, b, to)
    real(dp), intent(in) :: a, b
    type(direction_t), intent(in) :: from
    type(direction_t), intent(inout) :: to
    integer :: i

    !$omp parallel do default(none) shared(a, from, b, to) private(i) schedule(static)
    do i = 1, size(to%d, 2)
      to%d(:, i) = a*from%d(:, i) + b*to%d(:, i)
      to%m(:, i) = a*from%m(:, i) + b*to%m(:, i)
      to%k(:, i) = a*from%k(:, i) + b*to%k(:, i)
    end do
    !$omp end parallel do
  end subroutine direction_blend

  !> Residual K d - quotient M d of a direction [N/m].
  subroutine direction_residual(direction, quotient, residual)
    type(direction_t), intent(in) :: direction
    real(dp), intent(in) :: quotient                     !! of Rayleigh [1/s2]
    real(dp), contiguous, intent(inout) :: residual(:,:) !! (2,n)
    integer :: i

    !$omp parallel do default(none) shared(direction, quotient, residual) private(i) schedule(static)
    do i = 1, size(residual, 2)
      residual(:, i) = direction%k(:, i) - quotient*direction%m(:, i)
    end do
    !$omp end parallel do
  end subroutine direction_residual

  !> Give a direction unit length, d.M d = 1. `regular` is false, and nothing changes, where it has
  !> no length to speak of.
  subroutine direction_unit(direction, regular)
    type(direction_t), intent(inout) :: direction
    logical, intent(out) :: regular

    call scale_length(direction, tiny(1.0_dp), regular)
  end subroutine direction_unit

  !> Take from a direction its parts along one or two others of unit length, which are orthogonal,
  !> and give what is left unit length. `regular` is false where next to nothing is left: that is
  !> round-off, and what is left of K d is not the stiffness of what is left of d. So there are
  !> never more directions than free displacements.
  subroutine direction_across(other, regular, one, two)
    type(direction_t), intent(inout) :: other
    logical, intent(out) :: regular
    type(direction_t), intent(in) :: one
    type(direction_t), intent(in), optional :: two

    call direction_unit(other, regular)
    if (.not. regular) return
    call take_part(one, other)
    if (present(two)) call take_part(two, other)
    call scale_length(other, share_least**2, regular)
  end subroutine direction_across

  subroutine take_part(one, other)
    type(direction_t), intent(in) :: one
    type(direction_t), intent(inout) :: other

    call direction_blend(-sum_products(size(other%d), other%d, one%m), one, 1.0_dp, other)
  end subroutine take_part

  !> Give a direction unit length unless the square of its length is below `least`.
  subroutine scale_length(direction, least, regular)
    type(direction_t), intent(inout) :: direction
    real(dp), intent(in) :: least
    logical, intent(out) :: regular
    real(dp) :: square, factor
    integer :: i

    square = sum_products(size(direction%d), direction%d, direction%m)
    regular = square > least
    if (.not. regular) return
    factor = 1.0_dp/sqrt(square)
    !$omp parallel do default(none) shared(direction, factor) private(i) schedule(static)
    do i = 1, size(direction%d, 2)
      direction%d(:, i) = factor*direction%d(:, i)
      direction%m(:, i) = factor*direction%m(:, i)
      direction%k(:, i) = factor*direction%k(:, i)
    end do
    !$omp end parallel do
  end subroutine scale_length

  !> Shares of the directions in the sum of unit length with the greatest quotient. All are of unit
  !> length, and orthogonal with respect to M.
  subroutine rayleigh_best(one, two, three, counts, share, quotient)
    type(direction_t), intent(in) :: one, two, three
    logical, intent(in) :: counts         !! `three` counts
    real(dp), intent(out) :: share(3)     !! 0 of a direction that does not count
    real(dp), intent(out) :: quotient     !! d.K d/(d.M d) of the sum [1/s2]
    real(dp) :: a(3,3), w(3), lapack_work(9)
    integer :: n, most, info

    n = size(one%d)
    most = merge(3, 2, counts)
    a = 0.0_dp
    a(1, 1) = sum_products(n, one%d, one%k)
    a(1, 2) = sum_products(n, one%d, two%k)
    a(2, 2) = sum_products(n, two%d, two%k)
    if (counts) then
      a(1, 3) = sum_products(n, one%d, three%k)
      a(2, 3) = sum_products(n, two%d, three%k)
      a(3, 3) = sum_products(n, three%d, three%k)
    end if
    call dsyev('V', 'U', most, a, 3, w, lapack_work, size(lapack_work), info)
    share = 0.0_dp
    share(:most) = a(:most, most)
    quotient = w(most)
  end subroutine rayleigh_best
end module talus_rayleigh
