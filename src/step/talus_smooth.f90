! SPDX-License-Identifier: MIT
!> The second level at work: F(L) = sum of S(L,K) A(K) F1(K), and by the same gather its adjoint
!> R(L) = sum of S(K,L) A(K) P(K) (src/THEORY.md (4.6), (4.8)).
module talus_smooth
  use talus_kinds, only: dp
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

    call gather(size(h, 2), two_level%offset, two_level%cell, two_level%s, y, h)
  end subroutine smooth_gradient

  !> First Piola stress smoothed by the adjoint.
  subroutine smooth_stress(two_level, q, r)
    type(two_level_t), intent(in) :: two_level
    real(dp), contiguous, intent(in) :: q(:,:)    !! area times first Piola stress [N m/m], (4,n)
    real(dp), contiguous, intent(inout) :: r(:,:) !! smoothed first Piola stress [Pa], (4,n)

    if (allocated(two_level%sa)) then
      call gather(size(r, 2), two_level%offset, two_level%cell, two_level%sa, q, r)
    else
      call gather(size(r, 2), two_level%offset, two_level%cell, two_level%s, q, r)
    end if
  end subroutine smooth_stress

  !> The gather on plain arrays, in rows of two.
  subroutine gather(n, offset, cell, s, from, to)
    integer, intent(in) :: n, offset(*), cell(*)
    real(dp), intent(in) :: s(*), from(4,*)
    real(dp), intent(inout) :: to(4,*)
    real(dp) :: row_1(2), row_2(2)
    integer :: l, k

    !$omp do schedule(static)
    do l = 1, n
      row_1 = 0.0_dp
      row_2 = 0.0_dp
      !GCC$ unroll 4
      do k = offset(l), offset(l+1) - 1
        row_1 = row_1 + s(k)*from(1:2, cell(k))
        row_2 = row_2 + s(k)*from(3:4, cell(k))
      end do
      to(1:2, l) = row_1
      to(3:4, l) = row_2
    end do
    !$omp end do
  end subroutine gather
end module talus_smooth
