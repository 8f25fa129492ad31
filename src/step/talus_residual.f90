! SPDX-License-Identifier: MIT
!> The affine-residual stabilisation at work (src/THEORY.md (4.9)-(4.11)): forces on both nodes of a
!> pair, and the matching part of their first Piola stress, from one energy; with two levels, the stress
!> between them, too.
module talus_residual
  use talus_kinds, only: dp
  use talus_stabilise, only: stabilise_t
  implicit none
  private
  public :: residual_gather, residual_gather_levels

contains

  !> With one level: add the pairs' part to area times Piola stress and divide the sum by the area, and
  !> give the pairs' nodal force. The stiffness of a pair follows the softer of its nodes, so that a
  !> shear band is not bridged from its sides. `energy` comes in as that of one step ago.
  subroutine residual_gather(stabilise, area, u, h, scale, before, q, force, energy, loss)
    type(stabilise_t), intent(in) :: stabilise
    real(dp), contiguous, intent(in) :: area(:)     !! cell areas [m2], (n)
    real(dp), contiguous, intent(in) :: u(:,:)      !! displacement [m], (2,n)
    real(dp), contiguous, intent(in) :: h(:,:)      !! displacement gradient, (4,n)
    real(dp), contiguous, intent(in) :: scale(:)    !! stiffness left at each node, 0..1, (n)
    real(dp), contiguous, intent(in) :: before(:)   !! the same one step ago, (n)
    real(dp), contiguous, intent(inout) :: q(:,:)   !! area times Piola stress in [N m/m], Piola
                                                    !! stress out [Pa], (4,n)
    real(dp), contiguous, intent(inout) :: force(:,:) !! force on the nodes [N/m], (2,n)
    real(dp), contiguous, intent(inout) :: energy(:) !! half the energy of a node's pairs [J/m], (n)
    real(dp), contiguous, intent(inout) :: loss(:)  !! sum of energy lost by softening [J/m], (n)
    real(dp) :: none(4,0)

    call gather(size(scale), stabilise%offset, stabilise%node, stabilise%reach, &
                stabilise%stiffness, area, u, h, scale, before, .false., stabilise%level, scale, &
                before, none, q, force, energy, loss)
  end subroutine residual_gather

  !> With two levels: the pairs feel the first. Give their nodal force, take the stress between the
  !> levels from area times Piola stress of the second, and give that which the first gets.
  subroutine residual_gather_levels(stabilise, area, u, first, scale, before, between, between_old, &
    h, q, force, energy, loss)
    type(stabilise_t), intent(in) :: stabilise
    real(dp), contiguous, intent(in) :: area(:)     !! cell areas [m2], (n)
    real(dp), contiguous, intent(in) :: u(:,:)      !! displacement [m], (2,n)
    real(dp), contiguous, intent(in) :: first(:,:)  !! displacement gradient of the first level, (4,n)
    real(dp), contiguous, intent(in) :: scale(:)    !! stiffness left at each node, 0..1, (n)
    real(dp), contiguous, intent(in) :: before(:)   !! the same one step ago, (n)
    real(dp), contiguous, intent(in) :: between(:)  !! stiffness between the levels, 0..1, (n)
    real(dp), contiguous, intent(in) :: between_old(:) !! the same one step ago, (n)
    real(dp), contiguous, intent(inout) :: h(:,:)   !! gradient of the second level in, Piola stress of
                                                    !! the first out [Pa], (4,n)
    real(dp), contiguous, intent(inout) :: q(:,:)   !! area times Piola stress of the second level
                                                    !! [N m/m], (4,n)
    real(dp), contiguous, intent(inout) :: force(:,:) !! force on the nodes [N/m], (2,n)
    real(dp), contiguous, intent(inout) :: energy(:) !! half the energy of a node's pairs, and that
                                                     !! between the levels [J/m], (n)
    real(dp), contiguous, intent(inout) :: loss(:)  !! sum of energy lost by softening [J/m], (n)

    call gather(size(scale), stabilise%offset, stabilise%node, stabilise%reach, &
                stabilise%stiffness, area, u, first, scale, before, .true., stabilise%level, between, &
                between_old, h, q, force, energy, loss)
  end subroutine residual_gather_levels

  !> The gather on plain arrays.
  subroutine gather(n, offset, node, reach, stiffness, area, u, h, scale, before, levels, level, &
    between, between_old, second, q, force, energy, loss)
    integer, intent(in) :: n, offset(*), node(*)
    real(dp), intent(in) :: reach(2,*), stiffness(*), area(*), u(2,*), h(4,*), scale(*), before(*)
    logical, intent(in) :: levels !! there are two; else `second` and what is between are not read
    real(dp), intent(in) :: level(*), between(*), between_old(*)
    real(dp), intent(inout) :: second(4,*), q(4,*), force(2,*), energy(*), loss(*)
    real(dp), dimension(2) :: r, f, p_1, p_2, own, h_1, h_2, row_1, row_2, half, apart_1, apart_2
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
      if (levels) then
        apart_1 = h_1 - second(1:2, i)
        apart_2 = h_2 - second(3:4, i)
        kappa = level(i)*between(i)
        rr = 2.0_dp*(sum(apart_1*apart_1) + sum(apart_2*apart_2))
        total = total + kappa*rr
        gone = gone + (level(i)*between_old(i) - kappa)*rr
        apart_1 = kappa*apart_1
        apart_2 = kappa*apart_2
        q(1:2, i) = q(1:2, i) - apart_1
        q(3:4, i) = q(3:4, i) - apart_2
        second(1:2, i) = (apart_1 - p_1)/area(i)
        second(3:4, i) = (apart_2 - p_2)/area(i)
      else
        q(1:2, i) = (q(1:2, i) - p_1)/area(i)
        q(3:4, i) = (q(3:4, i) - p_2)/area(i)
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
