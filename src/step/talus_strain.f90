! SPDX-License-Identifier: MIT
!> Deformation gradient at every node, as gathers over reference neighbours (src/THEORY.md (4.2),
!> (4.6)). The loops are orphaned work-sharing: call them inside the parallel region of the step.
!> Tensors that are not symmetric are stored as 11, 12, 21, 22, F_ij = dx_i/dX_j.
module talus_strain
  use talus_kinds, only: dp
  use talus_scni, only: scni_t
  implicit none
  private
  public :: strain_first, strain_one_level

contains

  !> First level: displacement gradient times cell area, y = sum of u b^T.
  subroutine strain_first(scni, u, y)
    type(scni_t), intent(in) :: scni
    real(dp), contiguous, intent(in) :: u(:,:)    !! displacement [m], (2,n)
    real(dp), contiguous, intent(inout) :: y(:,:) !! area times gradient [m2], (4,n)
    real(dp) :: s11, s12, s21, s22
    integer :: l, k, i

    !$omp do schedule(static)
    do l = 1, size(y, 2)
      s11 = 0.0_dp
      s12 = 0.0_dp
      s21 = 0.0_dp
      s22 = 0.0_dp
      do k = scni%cell_offset(l), scni%cell_offset(l+1) - 1
        i = scni%node(k)
        s11 = s11 + u(1, i)*scni%b(1, k)
        s12 = s12 + u(1, i)*scni%b(2, k)
        s21 = s21 + u(2, i)*scni%b(1, k)
        s22 = s22 + u(2, i)*scni%b(2, k)
      end do
      y(1, l) = s11
      y(2, l) = s12
      y(3, l) = s21
      y(4, l) = s22
    end do
    !$omp end do
  end subroutine strain_first

  !> Gradient of the first level alone.
  subroutine strain_one_level(area, y, h)
    real(dp), contiguous, intent(in) :: area(:)   !! cell areas [m2], (n)
    real(dp), contiguous, intent(in) :: y(:,:)    !! area times gradient [m2], (4,n)
    real(dp), contiguous, intent(inout) :: h(:,:) !! displacement gradient F - 1, (4,n)
    integer :: l

    !$omp do schedule(static)
    do l = 1, size(area)
      h(:, l) = y(:, l)/area(l)
    end do
    !$omp end do
  end subroutine strain_one_level
end module talus_strain
