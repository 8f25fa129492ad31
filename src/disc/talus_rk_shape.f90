! SPDX-License-Identifier: MIT
!> Reproducing-kernel shape functions with linear basis on the reference configuration
!> (src/THEORY.md (4.1); Liu, Jun & Zhang 1995): Psi_I(X) = H(0)^T M^-1(X) H(X-X_I) phi(X-X_I).
module talus_rk_shape
  use talus_kinds, only: dp
  use talus_kernel, only: kernel_spline
  implicit none
  private
  public :: rk_shape

  !> Smallest pivot of the moment matrix, relative to its kernel sum, that still counts as regular.
  !> A well-surrounded point has 1e-1; nodes in one line have 0.
  real(dp), parameter :: pivot_min = 1.0e-6_dp

contains

  !> Shape functions at one point. They sum to one and reproduce linear functions.
  pure subroutine rk_shape(point, node, support, psi, regular)
    real(dp), intent(in) :: point(2)   !! where [m]
    real(dp), intent(in) :: node(:,:)  !! positions of the nodes that reach the point [m], (2,m)
    real(dp), intent(in) :: support(:) !! their support radii [m], (m)
    real(dp), intent(out) :: psi(:)    !! values, (m)
    logical, intent(out) :: regular    !! false when the nodes do not span a plane
    real(dp) :: scale, d(2), weight, m0, m1(2), m2(3), l1(2), l2, l3, c(3)
    integer :: i

    psi = 0.0_dp
    regular = size(psi) >= 3
    if (.not. regular) return
    scale = 1.0_dp/maxval(support)
    m0 = 0.0_dp
    m1 = 0.0_dp
    m2 = 0.0_dp
    do i = 1, size(psi)
      d = (node(:, i) - point)*scale
      weight = kernel_spline(norm2(node(:, i) - point)/support(i))
      psi(i) = weight
      m0 = m0 + weight
      m1 = m1 + weight*d
      m2 = m2 + weight*[d(1)*d(1), d(1)*d(2), d(2)*d(2)]
    end do
    regular = m0 > tiny(m0)
    if (.not. regular) return
    ! Elimination of the 3 x 3 moment matrix, whose last two rows are the second moments about the
    ! kernel's centroid.
    l1 = m1/m0
    m2 = m2 - [m1(1)*l1(1), m1(1)*l1(2), m1(2)*l1(2)]
    regular = m2(1) > pivot_min*m0
    if (.not. regular) return
    l2 = m2(2)/m2(1)
    l3 = m2(3) - m2(2)*l2
    regular = l3 > pivot_min*m0
    if (.not. regular) return
    c(3) = (-l1(2) + l2*l1(1))/l3
    c(2) = -l1(1)/m2(1) - l2*c(3)
    c(1) = 1.0_dp/m0 - l1(1)*c(2) - l1(2)*c(3)
    do i = 1, size(psi)
      d = (node(:, i) - point)*scale
      psi(i) = psi(i)*(c(1) + c(2)*d(1) + c(3)*d(2))
    end do
  end subroutine rk_shape
end module talus_rk_shape
