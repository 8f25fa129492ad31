! SPDX-License-Identifier: MIT
!> The affine-residual stabilisation at work (src/THEORY.md (4.9)-(4.11)): forces on both nodes of a
!> pair, and the matching part of their first Piola stress, from one energy.
module talus_residual
  use talus_kinds, only: dp
  use talus_stabilise, only: stabilise_t
  implicit none
  private
  public :: residual_gather

contains

  !> Add the pairs' part to area times Piola stress, and give their nodal force. The stiffness of a
  !> pair follows the softer of its nodes, so that a shear band is not bridged from its sides.
  subroutine residual_gather(stabilise, u, h, scale, before, q, force, energy, loss)
    type(stabilise_t), intent(in) :: stabilise
    real(dp), contiguous, intent(in) :: u(:,:)      !! displacement [m], (2,n)
    real(dp), contiguous, intent(in) :: h(:,:)      !! displacement gradient, (4,n)
    real(dp), contiguous, intent(in) :: scale(:)    !! stiffness left at each node, 0..1, (n)
    real(dp), contiguous, intent(in) :: before(:)   !! the same one step ago, (n)
    real(dp), contiguous, intent(inout) :: q(:,:)   !! area times Piola stress [N m/m], (4,n)
    real(dp), contiguous, intent(inout) :: force(:,:) !! force on the nodes [N/m], (2,n)
    real(dp), contiguous, intent(inout) :: energy(:) !! half the energy of a node's pairs [J/m], (n)
    real(dp), contiguous, intent(inout) :: loss(:)  !! sum of energy lost by softening [J/m], (n)
    real(dp) :: r(2), reach(2), kappa, lost, rr, f(2), p(4), total, gone
    integer :: i, j, k

    !$omp do schedule(static)
    do i = 1, size(scale)
      f = 0.0_dp
      p = 0.0_dp
      total = 0.0_dp
      gone = 0.0_dp
      do k = stabilise%offset(i), stabilise%offset(i+1) - 1
        j = stabilise%node(k)
        reach = stabilise%reach(:, k)
        r(1) = u(1, j) - u(1, i) &
          - 0.5_dp*((h(1, i) + h(1, j))*reach(1) + (h(2, i) + h(2, j))*reach(2))
        r(2) = u(2, j) - u(2, i) &
          - 0.5_dp*((h(3, i) + h(3, j))*reach(1) + (h(4, i) + h(4, j))*reach(2))
        kappa = stabilise%stiffness(k)*min(scale(i), scale(j))
        lost = stabilise%stiffness(k)*min(before(i), before(j)) - kappa
        rr = r(1)*r(1) + r(2)*r(2)
        total = total + kappa*rr
        gone = gone + lost*rr
        r = kappa*r
        f = f + r
        p(1) = p(1) + r(1)*reach(1)
        p(2) = p(2) + r(1)*reach(2)
        p(3) = p(3) + r(2)*reach(1)
        p(4) = p(4) + r(2)*reach(2)
      end do
      force(:, i) = f
      q(:, i) = q(:, i) - 0.5_dp*p
      energy(i) = 0.25_dp*total
      loss(i) = loss(i) + 0.25_dp*gone
    end do
    !$omp end do
  end subroutine residual_gather
end module talus_residual
