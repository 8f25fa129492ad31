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
  !> `energy` comes in as that of one step ago. With `area`, the sum is divided by it.
  subroutine residual_gather(stabilise, u, h, scale, before, q, force, energy, loss, area)
    type(stabilise_t), intent(in) :: stabilise
    real(dp), contiguous, intent(in) :: u(:,:)      !! displacement [m], (2,n)
    real(dp), contiguous, intent(in) :: h(:,:)      !! displacement gradient, (4,n)
    real(dp), contiguous, intent(in) :: scale(:)    !! stiffness left at each node, 0..1, (n)
    real(dp), contiguous, intent(in) :: before(:)   !! the same one step ago, (n)
    real(dp), contiguous, intent(inout) :: q(:,:)   !! area times Piola stress [N m/m], (4,n)
    real(dp), contiguous, intent(inout) :: force(:,:) !! force on the nodes [N/m], (2,n)
    real(dp), contiguous, intent(inout) :: energy(:) !! half the energy of a node's pairs [J/m], (n)
    real(dp), contiguous, intent(inout) :: loss(:)  !! sum of energy lost by softening [J/m], (n)
    real(dp), contiguous, intent(in), optional :: area(:) !! cell areas, where there is one level [m2]

    if (present(area)) then
      call gather(size(scale), stabilise%offset, stabilise%node, stabilise%reach, &
                  stabilise%stiffness, u, h, scale, before, .true., area, q, force, energy, loss)
    else
      call gather(size(scale), stabilise%offset, stabilise%node, stabilise%reach, &
                  stabilise%stiffness, u, h, scale, before, .false., scale, q, force, energy, loss)
    end if
  end subroutine residual_gather

  !> The gather on plain arrays.
  subroutine gather(n, offset, node, reach, stiffness, u, h, scale, before, divided, area, q, force, &
    energy, loss)
    integer, intent(in) :: n, offset(*), node(*)
    real(dp), intent(in) :: reach(2,*), stiffness(*), u(2,*), h(4,*), scale(*), before(*), area(*)
    logical, intent(in) :: divided !! by the area, which else is not read
    real(dp), intent(inout) :: q(4,*), force(2,*), energy(*), loss(*)
    real(dp) :: r1, r2, x, y, kappa, lost, rr, f1, f2, p11, p12, p21, p22, total, gone, whole
    integer :: i, j, k

    !$omp do schedule(static)
    do i = 1, n
      f1 = 0.0_dp
      f2 = 0.0_dp
      p11 = 0.0_dp
      p12 = 0.0_dp
      p21 = 0.0_dp
      p22 = 0.0_dp
      total = 0.0_dp
      gone = 0.0_dp
      do k = offset(i), offset(i+1) - 1
        j = node(k)
        x = 0.5_dp*reach(1, k)
        y = 0.5_dp*reach(2, k)
        r1 = u(1, j) - u(1, i) - ((h(1, i) + h(1, j))*x + (h(2, i) + h(2, j))*y)
        r2 = u(2, j) - u(2, i) - ((h(3, i) + h(3, j))*x + (h(4, i) + h(4, j))*y)
        kappa = stiffness(k)*min(scale(i), scale(j))
        lost = stiffness(k)*min(before(i), before(j)) - kappa
        rr = r1*r1 + r2*r2
        total = total + kappa*rr
        gone = gone + lost*rr
        r1 = kappa*r1
        r2 = kappa*r2
        f1 = f1 + r1
        f2 = f2 + r2
        p11 = p11 + r1*x
        p12 = p12 + r1*y
        p21 = p21 + r2*x
        p22 = p22 + r2*y
      end do
      force(1, i) = f1
      force(2, i) = f2
      q(1, i) = q(1, i) - p11
      q(2, i) = q(2, i) - p12
      q(3, i) = q(3, i) - p21
      q(4, i) = q(4, i) - p22
      if (divided) q(:, i) = q(:, i)/area(i)
      ! Forces at both ends of the step work, so what softening takes is 1/2 lost r_old.r_new. All
      ! residuals of a node are taken to change by one ratio, the root of that of its energies.
      whole = total + gone
      if (abs(gone) > 0.0_dp .and. whole > 0.0_dp) &
        loss(i) = loss(i) + 0.5_dp*gone*sqrt(energy(i))/sqrt(whole)
      energy(i) = 0.25_dp*total
    end do
    !$omp end do
  end subroutine gather
end module talus_residual
