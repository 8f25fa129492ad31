! SPDX-License-Identifier: MIT
!> Deformation gradient at every node, as gathers over reference neighbours (src/THEORY.md (4.2),
!> (4.6)). The loops are orphaned work-sharing: call them inside the parallel region of the step.
!> Tensors that are not symmetric are stored as 11, 12, 21, 22, F_ij = dx_i/dX_j.
module talus_strain
  use talus_kinds, only: dp
  use talus_scni, only: scni_t
  implicit none
  private
  public :: strain_first, strain_gradient, per_area

contains

  !> First level: displacement gradient times cell area, y = sum of u b^T.
  subroutine strain_first(scni, u, y)
    type(scni_t), intent(in) :: scni
    real(dp), contiguous, intent(in) :: u(:,:)    !! displacement [m], (2,n)
    real(dp), contiguous, intent(inout) :: y(:,:) !! area times gradient [m2], (4,n)

    call gather(size(y, 2), scni%cell_offset, scni%node, scni%b, u, .false., u, y)
  end subroutine strain_first

  !> Gradient of the first level alone: strain_first and per_area in one pass.
  subroutine strain_gradient(scni, area, u, h)
    type(scni_t), intent(in) :: scni
    real(dp), contiguous, intent(in) :: area(:)   !! cell areas [m2], (n)
    real(dp), contiguous, intent(in) :: u(:,:)    !! displacement [m], (2,n)
    real(dp), contiguous, intent(inout) :: h(:,:) !! displacement gradient F - 1, (4,n)

    call gather(size(h, 2), scni%cell_offset, scni%node, scni%b, u, .true., area, h)
  end subroutine strain_gradient

  !> The gather on plain arrays. Rows of two, and entries taken four at a time, keep the processor
  !> at sums instead of addresses.
  subroutine gather(n, offset, node, b, u, divided, area, y)
    integer, intent(in) :: n, offset(*), node(*)
    real(dp), intent(in) :: b(2,*), u(2,*), area(*)
    logical, intent(in) :: divided !! by the area, which else is not read
    real(dp), intent(inout) :: y(4,*)
    real(dp) :: row_1(2), row_2(2)
    integer :: l, k, i

    !$omp do schedule(static)
    do l = 1, n
      row_1 = 0.0_dp
      row_2 = 0.0_dp
      !GCC$ unroll 4
      do k = offset(l), offset(l+1) - 1
        i = node(k)
        row_1 = row_1 + u(1, i)*b(:, k)
        row_2 = row_2 + u(2, i)*b(:, k)
      end do
      if (divided) then
        row_1 = row_1/area(l)
        row_2 = row_2/area(l)
      end if
      y(1:2, l) = row_1
      y(3:4, l) = row_2
    end do
    !$omp end do
  end subroutine gather

  !> Divide by the cell areas: a gradient or a stress from its product with the area.
  subroutine per_area(area, product)
    real(dp), contiguous, intent(in) :: area(:)         !! [m2], (n)
    real(dp), contiguous, intent(inout) :: product(:,:) !! (4,n)
    integer :: l

    !$omp do schedule(static)
    do l = 1, size(area)
      product(:, l) = product(:, l)/area(l)
    end do
    !$omp end do
  end subroutine per_area
end module talus_strain
