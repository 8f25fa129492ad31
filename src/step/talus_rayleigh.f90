! SPDX-License-Identifier: MIT
!> Search for the greatest eigenvalue of K d = quotient M d without a matrix, by the locally optimal
!> conjugate gradients of Knyazev (2001): each turn takes, of all sums of three directions, the one
!> with the greatest quotient of Rayleigh d.K d/(d.M d). The soil asks for it with displacements,
!> mass and stiffness, the water with pressures, storage and conductance. A caller turns like this:
!>
!>   direction_start, d = M^-1 m, k = K d; search_begin
!>   until done: direction_residual, d = M^-1 m, k = K d; search_turn
!>
!> Where K is not symmetric the greatest eigenvalue of K as the three directions see it takes the
!> place of the greatest quotient; both agree once the direction has settled.
module talus_rayleigh
  use talus_kinds, only: dp
  use talus_lapack, only: dsyev, dgeev
  use talus_sum, only: sum_products
  implicit none
  private
  public :: direction_t, direction_start, direction_residual
  public :: search_t, search_begin, search_turn

  type :: direction_t
    real(dp), allocatable :: d(:,:) !! displacement, 2 rows, or pressure, 1 row; (:,n)
    real(dp), allocatable :: m(:,:) !! M d, (:,n)
    real(dp), allocatable :: k(:,:) !! K d, (:,n)
  end type direction_t

  type :: search_t
    type(direction_t) :: now            !! best so far
    type(direction_t) :: ahead          !! where its residual points
    real(dp) :: quotient = 0.0_dp       !! of `now`, d.K d/(d.M d)
    logical :: symmetric = .true.       !! K is
    real(dp) :: tolerance = 1.0e-5_dp   !! relative change of the quotient at which the search ends
    logical :: done = .false.
    type(direction_t), private :: back  !! what the last turn added
    logical, private :: turned = .false.
    integer, private :: turns = 0
  end type search_t

  !> Most turns of a search.
  integer, parameter :: turns_most = 200
  !> A direction that keeps a smaller part of its length across others is round-off: the root of
  !> the relative precision.
  real(dp), parameter :: share_least = 1.0e-8_dp

contains

  !> Alternating values with an irregular part, so that no mode is left out.
  pure subroutine direction_start(mobility, d)
    real(dp), intent(in) :: mobility(:,:) !! 0 where nothing can move, (:,n)
    real(dp), intent(out) :: d(:,:)       !! (:,n)
    integer :: i, j

    do i = 1, size(d, 2)
      do j = 1, size(d, 1)
        ! The product of the remainders, which stays small with any number of nodes.
        d(j, i) = real(modulo(modulo(i, 1009)*modulo(7919 + 104729*j, 1009), 1009), dp)/1009.0_dp &
          - 0.5_dp
      end do
    end do
    where (mobility <= 0.0_dp) d = 0.0_dp
  end subroutine direction_start

  !> Start from search%now, whose d, m and k are given.
  subroutine search_begin(search)
    type(search_t), intent(inout) :: search
    logical :: regular

    call direction_unit(search%now, regular)
    search%ahead = search%now
    search%back = search%now
    search%quotient = sum_products(size(search%now%d), search%now%d, search%now%k)
    search%turned = .false.
    search%turns = 0
    search%done = .not. regular
  end subroutine search_begin

  !> One turn with search%ahead, whose d, m and k are given.
  subroutine search_turn(search)
    type(search_t), intent(inout) :: search
    real(dp) :: before, share(3)
    logical :: regular

    associate (now => search%now, ahead => search%ahead, back => search%back)
      call direction_across(ahead, regular, now)
      search%done = .not. regular
      if (search%done) return
      if (search%turned) call direction_across(back, search%turned, now, ahead)
      before = search%quotient
      call rayleigh_best(search, share)
      ! What is added in this turn is the third direction of the next.
      call direction_blend(share(2), ahead, share(3), back)
      call direction_blend(1.0_dp, back, share(1), now)
      call direction_unit(now, regular)
    end associate
    search%turned = .true.
    search%turns = search%turns + 1
    search%done = abs(search%quotient - before) <= search%tolerance*search%quotient &
      .or. search%turns == turns_most
  end subroutine search_turn

  !> to = a from + b to.
  subroutine direction_blend(a, from, b, to)
    real(dp), intent(in) :: a, b
    type(direction_t), intent(in) :: from
    type(direction_t), intent(inout) :: to

    call blend(size(to%d), a, from%d, b, to%d)
    call blend(size(to%m), a, from%m, b, to%m)
    call blend(size(to%k), a, from%k, b, to%k)
  end subroutine direction_blend

  !> The same for one array of n elements, taken as one row.
  subroutine blend(n, a, from, b, to)
    integer, intent(in) :: n
    real(dp), intent(in) :: a, b
    real(dp), intent(in) :: from(n)
    real(dp), intent(inout) :: to(n)
    integer :: i

    !$omp parallel do default(none) shared(n, a, from, b, to) private(i) schedule(static)
    do i = 1, n
      to(i) = a*from(i) + b*to(i)
    end do
    !$omp end parallel do
  end subroutine blend

  !> Residual K d - quotient M d of a direction: of displacements [N/m], of pressures [m2/s].
  subroutine direction_residual(direction, quotient, residual)
    type(direction_t), intent(in) :: direction
    real(dp), intent(in) :: quotient                     !! of Rayleigh: [1/s2], or [1/s]
    real(dp), contiguous, intent(inout) :: residual(:,:) !! (2,n), or (1,n)
    integer :: i

    !$omp parallel do default(none) shared(direction, quotient, residual) private(i) &
    !$omp schedule(static)
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

    square = sum_products(size(direction%d), direction%d, direction%m)
    regular = square > least
    if (.not. regular) return
    factor = 1.0_dp/sqrt(square)
    call multiply(size(direction%d), factor, direction%d)
    call multiply(size(direction%m), factor, direction%m)
    call multiply(size(direction%k), factor, direction%k)
  end subroutine scale_length

  !> Multiply an array of n elements, taken as one row.
  subroutine multiply(n, factor, a)
    integer, intent(in) :: n
    real(dp), intent(in) :: factor
    real(dp), intent(inout) :: a(n)
    integer :: i

    !$omp parallel do default(none) shared(n, factor, a) private(i) schedule(static)
    do i = 1, n
      a(i) = factor*a(i)
    end do
    !$omp end parallel do
  end subroutine multiply

  !> Shares of the directions in the sum of unit length with the greatest quotient. All are of unit
  !> length, and orthogonal with respect to M.
  subroutine rayleigh_best(search, share)
    type(search_t), intent(inout) :: search
    real(dp), intent(out) :: share(3) !! 0 of a direction that does not count
    real(dp) :: a(3,3), w(3), lapack_work(9)
    integer :: n, most, info

    associate (one => search%now, two => search%ahead, three => search%back)
      n = size(one%d)
      most = merge(3, 2, search%turned)
      a = 0.0_dp
      a(1, 1) = sum_products(n, one%d, one%k)
      a(1, 2) = sum_products(n, one%d, two%k)
      a(2, 2) = sum_products(n, two%d, two%k)
      if (search%turned) then
        a(1, 3) = sum_products(n, one%d, three%k)
        a(2, 3) = sum_products(n, two%d, three%k)
        a(3, 3) = sum_products(n, three%d, three%k)
      end if
      share = 0.0_dp
      if (search%symmetric) then
        call dsyev('V', 'U', most, a, 3, w, lapack_work, size(lapack_work), info)
        share(:most) = a(:most, most)
        search%quotient = w(most)
        return
      end if
      a(2, 1) = sum_products(n, two%d, one%k)
      if (search%turned) then
        a(3, 1) = sum_products(n, three%d, one%k)
        a(3, 2) = sum_products(n, three%d, two%k)
      end if
    end associate
    call greatest_of_any(a(:most, :most), share(:most), search%quotient)
  end subroutine rayleigh_best

  !> Greatest real part of the eigenvalues of a small matrix, and the real part of its vector.
  subroutine greatest_of_any(matrix, vector, greatest)
    real(dp), intent(in) :: matrix(:,:)
    real(dp), intent(out) :: vector(:), greatest
    real(dp) :: a(size(vector), size(vector)), right(size(vector), size(vector)), unused(1, 1)
    real(dp) :: w(size(vector)), imaginary(size(vector)), lapack_work(8*size(vector))
    integer :: info, n, k

    n = size(vector)
    a = matrix
    call dgeev('N', 'V', n, a, n, w, imaginary, unused, 1, right, n, lapack_work, &
      size(lapack_work), info)
    k = maxloc(w, dim=1)
    vector = right(:, k)
    greatest = w(k)
  end subroutine greatest_of_any
end module talus_rayleigh
