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

    call gather(two_level%offset, two_level%cell, two_level%s, y, h)
  end subroutine smooth_gradient

  !> First Piola stress smoothed by the adjoint.
  subroutine smooth_stress(two_level, q, r)
    type(two_level_t), intent(in) :: two_level
    real(dp), contiguous, intent(in) :: q(:,:)    !! area times first Piola stress [N m/m], (4,n)
    real(dp), contiguous, intent(inout) :: r(:,:) !! smoothed first Piola stress [Pa], (4,n)

    if (allocated(two_level%sa)) then
      call gather(two_level%offset, two_level%cell, two_level%sa, q, r)
    else
      call gather(two_level%offset, two_level%cell, two_level%s, q, r)
    end if
  end subroutine smooth_stress

  subroutine gather(offset, cell, s, from, to)
    integer, contiguous, intent(in) :: offset(:), cell(:)
    real(dp), contiguous, intent(in) :: s(:), from(:,:)
    real(dp), contiguous, intent(inout) :: to(:,:)
    real(dp) :: total(4)
    integer :: l, k

    !$omp do schedule(static)
    do l = 1, size(to, 2)
      total = 0.0_dp
      do k = offset(l), offset(l+1) - 1
        total = total + s(k)*from(:, cell(k))
      end do
      to(:, l) = total
    end do
    !$omp end do
  end subroutine gather
end module talus_smooth
