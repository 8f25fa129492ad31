! SPDX-License-Identifier: MIT
!> The second level at work: F(L) = sum of S(L,K) A(K) F1(K), and by the same gather its adjoint
!> R(L) = sum of S(K,L) A(K) P(K) (src/THEORY.md (4.6), (4.8)).
module talus_smooth
  use talus_kinds, only: sp, dp
  use talus_two_level, only: two_level_t
  implicit none
  private
  public :: smooth_gradient, smooth_stress

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
