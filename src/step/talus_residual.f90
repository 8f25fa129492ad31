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
    real(dp), contiguous, intent(in), optional :: area(:) !! cell areas, where there is one level
                                                          !! [m2]

    if (present(area)) then
      call gather(size(scale), stabilise%offset, stabilise%node, stabilise%reach, &
                  stabilise%stiffness, u, h, scale, before, .true., area, q, force, energy, loss)
    else
      call gather(size(scale), stabilise%offset, stabilise%node, stabilise%reach, &
                  stabilise%stiffness, u, h, scale, before, .false., scale, q, force, energy, loss)
    end if
  end subroutine residual_gather

  !> The gather on plain arrays.
  subroutine gather(n, offset, node, reach, stiffness, u, h, scale, before, divided, area, q, &
    force, energy, loss)
    integer, intent(in) :: n, offset(*), node(*)
    real(dp), intent(in) :: reach(2,*), stiffness(*), u(2,*), h(4,*), scale(*), before(*), area(*)
    logical, intent(in) :: divided !! by the area, which else is not read
    real(dp), intent(inout) :: q(4,*), force(2,*), energy(*), loss(*)
    real(dp), dimension(2) :: r, f, p_1, p_2, own, h_1, h_2, row_1, row_2, half
    real(dp) :: kappa, lost, rr, total, gone, whole, scale_own, before_own
    integer :: i, j, k

    !$omp do schedule(static)
    do i = 1, n
      f = 0.0_dp
      p_1 = 0.0_dp
      p_2 = 0.0_dp
      total = 0.0_dp
      gone = 0.0_dp
      own = u(:, i)
      h_1 = h(1:2, i)
      h_2 = h(3:4, i)
      scale_own = scale(i)
      before_own = before(i)
      do k = offset(i), offset(i+1) - 1
        j = node(k)
        half = 0.5_dp*reach(:, k)
        row_1 = (h_1 + h(1:2, j))*half
        row_2 = (h_2 + h(3:4, j))*half
        r(1) = u(1, j) - own(1) - (row_1(1) + row_1(2))
        r(2) = u(2, j) - own(2) - (row_2(1) + row_2(2))
        kappa = stiffness(k)*min(scale_own, scale(j))
        lost = stiffness(k)*min(before_own, before(j)) - kappa
        rr = r(1)*r(1) + r(2)*r(2)
        total = total + kappa*rr
        gone = gone + lost*rr
        r = kappa*r
        f = f + r
        p_1 = p_1 + r(1)*half
        p_2 = p_2 + r(2)*half
      end do
      force(:, i) = f
      if (divided) then
        q(1:2, i) = (q(1:2, i) - p_1)/area(i)
        q(3:4, i) = (q(3:4, i) - p_2)/area(i)
      else
        q(1:2, i) = q(1:2, i) - p_1
        q(3:4, i) = q(3:4, i) - p_2
      end if
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
