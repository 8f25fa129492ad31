! SPDX-License-Identifier: MIT
!> The second level at work: F(L) = sum of S(L,K) A(K) F1(K), and by the same gather its adjoint
!> R(L) = sum of S(K,L) A(K) P(K) (src/THEORY.md (4.6), (4.8)).
module talus_smooth
  use talus_kinds, only: sp, dp
  use talus_two_level, only: two_level_t
  use talus_tie, only: tie_t
  use talus_tie_step, only: tie_slopes
  use talus_stretch, only: stretch_piola
  implicit none
  private
  public :: smooth_gradient, smooth_stress, smooth_gradient_tied, smooth_stress_tied

contains

  !> Gradient smoothed a second time.
  subroutine smooth_gradient(two_level, y, h)
    type(two_level_t), intent(in) :: two_level
    real(dp), contiguous, intent(in) :: y(:,:)    !! area times first-level gradient [m2], (4,n)
    real(dp), contiguous, intent(inout) :: h(:,:) !! smoothed gradient, (4,n)

    if (allocated(two_level%plain)) then
      call gather_plain(two_level%offset, two_level%cell, two_level%plain, y, h)
    else
      call gather(size(h, 2), two_level%offset, two_level%cell, two_level%s, two_level%rest, y, &
                  .false., y, h)
    end if
  end subroutine smooth_gradient

  !> First Piola stress smoothed by the adjoint, and that of the first level added.
  subroutine smooth_stress(two_level, q, stabilised, first, r)
    type(two_level_t), intent(in) :: two_level
    real(dp), contiguous, intent(in) :: q(:,:)     !! area times first Piola stress [N m/m], (4,n)
    logical, intent(in) :: stabilised              !! the first level has a stress, which else is not
                                                   !! read
    real(dp), contiguous, intent(in) :: first(:,:) !! first Piola stress of the first level [Pa], (4,n)
    real(dp), contiguous, intent(inout) :: r(:,:)  !! sum of both [Pa], (4,n)
    integer :: l

    if (allocated(two_level%plain)) then
      call gather_plain(two_level%offset, two_level%cell, two_level%adjoint, q, r)
      if (.not. stabilised) return
      !$omp do schedule(static)
      do l = 1, size(r, 2)
        r(:, l) = r(:, l) + first(:, l)
      end do
      !$omp end do
    else
      call gather(size(r, 2), two_level%offset, two_level%cell, two_level%s, two_level%rest, q, &
                  stabilised, first, r)
    end if
  end subroutine smooth_stress

  !> Gradient smoothed a second time, and by the same reading of the weights what ties the levels.
  subroutine smooth_gradient_tied(two_level, y, weighed, h, mean)
    type(two_level_t), intent(in) :: two_level       !! with symmetric weights
    real(dp), contiguous, intent(in) :: y(:,:)       !! area times first-level gradient [m2], (4,n)
    real(dp), contiguous, intent(in) :: weighed(:,:) !! of tie_measure, (4,n)
    real(dp), contiguous, intent(inout) :: h(:,:)    !! smoothed gradient, (4,n)
    real(dp), contiguous, intent(inout) :: mean(:,:) !! smoothed, (4,n)
    integer :: l

    !$omp do schedule(static)
    do l = 1, size(h, 2)
      call sum_both(l, two_level%offset, two_level%cell, two_level%s, two_level%rest, y, weighed, &
                    h(:, l), mean(:, l))
    end do
    !$omp end do
  end subroutine smooth_gradient_tied

  !> First Piola stress smoothed by the adjoint, that of the first level and that of the tie added.
  subroutine smooth_stress_tied(two_level, tie, area, q, weighed, mean, stretch, first, r, intact, &
    held, loss)
    type(two_level_t), intent(in) :: two_level       !! with symmetric weights
    type(tie_t), intent(in) :: tie
    real(dp), contiguous, intent(in) :: area(:)      !! cell areas [m2], (n)
    real(dp), contiguous, intent(in) :: q(:,:)       !! area times first Piola stress [N m/m], (4,n)
    real(dp), contiguous, intent(in) :: weighed(:,:) !! of tie_means, (4,n)
    real(dp), contiguous, intent(in) :: mean(:,:)    !! of smooth_gradient_tied, (4,n)
    real(dp), contiguous, intent(in) :: stretch(:,:) !! of the first level, (6,n)
    real(dp), contiguous, intent(in) :: first(:,:)   !! Piola stress of the first level [Pa], (4,n)
    real(dp), contiguous, intent(inout) :: r(:,:)    !! sum of all [Pa], (4,n)
    ! Those of a motion; without them all soil is intact, and nothing is lost.
    real(dp), contiguous, intent(in), optional :: intact(:)    !! how intact the soil is, (n)
    real(dp), contiguous, intent(inout), optional :: held(:,:) !! slopes of the energy [Pa] and
                                                               !! stretch, one step ago in, (6,n)
    real(dp), contiguous, intent(inout), optional :: loss(:)   !! sum of energy lost by softening
                                                               !! [J/m], (n)
    real(dp) :: around(4), slope(3), piola(4), weight
    integer :: l

    !$omp do schedule(static)
    do l = 1, size(r, 2)
      call sum_both(l, two_level%offset, two_level%cell, two_level%s, two_level%rest, q, weighed, &
                    r(:, l), around)
      weight = tie%shear(l)
      if (present(intact)) weight = weight*intact(l)
      slope = tie_slopes(weight, stretch(:, l), mean(1, l), around)
      call stretch_piola(stretch(:, l), slope, piola)
      r(:, l) = r(:, l) + first(:, l) + piola
      if (.not. present(held)) cycle
      ! Work of the forces at both ends of the step, less the change of the energy 1/2 slope.U: over
      ! all nodes this is nothing where no weight changes.
      loss(l) = loss(l) + 0.5_dp*area(l)*(dot_product(held(1:3, l), stretch(1:3, l)) &
        - dot_product(slope, held(4:6, l)))
      held(1:3, l) = slope
      held(4:6, l) = stretch(1:3, l)
    end do
    !$omp end do
  end subroutine smooth_stress_tied

  !> The gather below of one cell, of two fields at once.
  pure subroutine sum_both(l, offset, cell, s, rest, one, two, to_one, to_two)
    integer, intent(in) :: l, offset(*), cell(*)
    real(sp), intent(in) :: s(*)
    real(dp), intent(in) :: rest(*), one(4,*), two(4,*)
    real(dp), intent(out) :: to_one(4), to_two(4)
    real(dp) :: even_one(4), odd_one(4), even_two(4), odd_two(4)
    integer :: k, last

    even_one = rest(l)*one(:, l)
    even_two = rest(l)*two(:, l)
    odd_one = 0.0_dp
    odd_two = 0.0_dp
    last = offset(l+1) - 1
    !GCC$ unroll 2
    do k = offset(l), last - 1, 2
      even_one = even_one + real(s(k), dp)*one(:, cell(k))
      even_two = even_two + real(s(k), dp)*two(:, cell(k))
      odd_one = odd_one + real(s(k+1), dp)*one(:, cell(k+1))
      odd_two = odd_two + real(s(k+1), dp)*two(:, cell(k+1))
    end do
    if (mod(last - offset(l), 2) == 0) then
      even_one = even_one + real(s(last), dp)*one(:, cell(last))
      even_two = even_two + real(s(last), dp)*two(:, cell(last))
    end if
    to_one = even_one + odd_one
    to_two = even_two + odd_two
  end subroutine sum_both

  !> The gather with symmetric weights, on plain arrays. Two entries at a time, in sums of their
  !> own, so that an addition need not wait for the one before.
  subroutine gather(n, offset, cell, s, rest, from, added, more, to)
    integer, intent(in) :: n, offset(*), cell(*)
    real(sp), intent(in) :: s(*)
    real(dp), intent(in) :: rest(*), from(4,*)
    logical, intent(in) :: added !! to the sums: `more`, which else is not read
    real(dp), intent(in) :: more(4,*)
    real(dp), intent(inout) :: to(4,*)
    real(dp) :: even(4), odd(4)
    integer :: l, k, last

    !$omp do schedule(static)
    do l = 1, n
      even = rest(l)*from(:, l)
      odd = 0.0_dp
      if (added) odd = more(:, l)
      last = offset(l+1) - 1
      !GCC$ unroll 2
      do k = offset(l), last - 1, 2
        even = even + real(s(k), dp)*from(:, cell(k))
        odd = odd + real(s(k+1), dp)*from(:, cell(k+1))
      end do
      if (mod(last - offset(l), 2) == 0) even = even + real(s(last), dp)*from(:, cell(last))
      to(:, l) = even + odd
    end do
    !$omp end do
  end subroutine gather

  !> The gather with the other weights.
  subroutine gather_plain(offset, cell, weight, from, to)
    integer, contiguous, intent(in) :: offset(:), cell(:)
    real(dp), contiguous, intent(in) :: weight(:), from(:,:)
    real(dp), contiguous, intent(inout) :: to(:,:)
    integer :: l, k

    !$omp do schedule(static)
    do l = 1, size(to, 2)
      to(:, l) = 0.0_dp
      do k = offset(l), offset(l+1) - 1
        to(:, l) = to(:, l) + weight(k)*from(:, cell(k))
      end do
    end do
    !$omp end do
  end subroutine gather_plain
end module talus_smooth
