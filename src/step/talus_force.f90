! SPDX-License-Identifier: MIT
!> Internal force as the adjoint of the strain, gathered by node (src/THEORY.md (4.8)), and the
!> motion it causes: central differences (5.1) with the lumped or the consistent mass (5.11).
module talus_force
  use talus_kinds, only: dp
  use talus_scni, only: scni_t
  use talus_inertia, only: inertia_gather
  implicit none
  private
  public :: force_unbalanced, motion_position, motion_velocity
  public :: motion_damp, motion_velocity_consistent

contains

  !> Out-of-balance force: load plus stabilisation minus internal force.
  subroutine force_unbalanced(scni, r, load, stabilising, force)
    type(scni_t), intent(in) :: scni
    real(dp), contiguous, intent(in) :: r(:,:)    !! smoothed Piola stress [Pa], (4,n)
    real(dp), contiguous, intent(in) :: load(:,:) !! weight and tractions [N/m], (2,n)
    real(dp), contiguous, intent(in) :: stabilising(:,:) !! force of the pairs [N/m], (2,n); (2,0)
                                                         !! without
    real(dp), contiguous, intent(inout) :: force(:,:)    !! out-of-balance force [N/m], (2,n)

    call gather(size(load, 2), scni%node_offset, scni%cell, scni%bt, r, load, &
                size(stabilising, 2) > 0, stabilising, force)
  end subroutine force_unbalanced

  !> The gather on plain arrays, a block of nodes at a time: first the products, row by row, then
  !> what is added at the node.
  subroutine gather(n, offset, cell, b, r, load, stabilised, stabilising, force)
    integer, intent(in) :: n, offset(*), cell(*)
    real(dp), intent(in) :: b(2,*), r(4,*), load(2,*), stabilising(2,*)
    logical, intent(in) :: stabilised
    real(dp), intent(inout) :: force(2,*)
    integer, parameter :: block_length = 64
    real(dp) :: product(4,block_length), s(4)
    integer :: first, i, j, k, l, m

    !$omp do schedule(static)
    do first = 0, n - 1, block_length
      m = min(block_length, n - first)
      do j = 1, m
        s = 0.0_dp
        !GCC$ unroll 4
        do k = offset(first+j), offset(first+j+1) - 1
          l = cell(k)
          s(1:2) = s(1:2) + r(1:2, l)*b(:, k)
          s(3:4) = s(3:4) + r(3:4, l)*b(:, k)
        end do
        product(:, j) = s
      end do
      do j = 1, m
        i = first + j
        force(1, i) = load(1, i) - (product(1, j) + product(2, j))
        force(2, i) = load(2, i) - (product(3, j) + product(4, j))
        if (stabilised) force(:, i) = force(:, i) + stabilising(:, i)
      end do
    end do
    !$omp end do
  end subroutine gather

  !> Positions at the next whole step.
  subroutine motion_position(step, v, u)
    real(dp), intent(in) :: step                  !! time step [s]
    real(dp), contiguous, intent(in) :: v(:,:)    !! velocity half a step back [m/s], (2,n)
    real(dp), contiguous, intent(inout) :: u(:,:) !! displacement [m], (2,n)

    call advance(size(u), step, v, u)
  end subroutine motion_position

  !> Both components of all nodes in one row.
  subroutine advance(n, step, v, u)
    integer, intent(in) :: n
    real(dp), intent(in) :: step, v(*)
    real(dp), intent(inout) :: u(*)
    integer :: i

    !$omp do schedule(static)
    do i = 1, n
      u(i) = u(i) + step*v(i)
    end do
    !$omp end do
  end subroutine advance

  !> Velocities at the next half step. Local damping takes a fraction of the out-of-balance force
  !> against the velocity (Cundall 1987); viscous damping is proportional to momentum, at the mean
  !> velocity of the step. `mobility` is one over mass, and 0 where motion is held.
  subroutine motion_velocity(step, local, viscous, mobility, force, v, acceleration, damped)
    real(dp), intent(in) :: step    !! time step [s]
    real(dp), intent(in) :: local   !! local damping, fraction 0..1
    real(dp), intent(in) :: viscous !! viscous damping [1/s]
    real(dp), contiguous, intent(in) :: mobility(:,:)        !! [m/kg], (2,n)
    real(dp), contiguous, intent(in) :: force(:,:)           !! out-of-balance force [N/m], (2,n)
    real(dp), contiguous, intent(inout) :: v(:,:)            !! velocity [m/s], (2,n)
    real(dp), contiguous, intent(inout) :: acceleration(:,:) !! with damping [m/s2], (2,n)
    real(dp), contiguous, intent(inout) :: damped(:)         !! energy damped so far [J/m], (n)
    real(dp) :: f, next, middle, over_step, kept, gain
    integer :: i, j

    if (.not. (local > 0.0_dp .or. viscous > 0.0_dp)) then
      call accelerate(size(v), step, mobility, force, v, acceleration)
      return
    end if
    over_step = 1.0_dp/step
    gain = 1.0_dp/(1.0_dp + 0.5_dp*step*viscous)
    kept = (1.0_dp - 0.5_dp*step*viscous)*gain
    gain = step*gain
    !$omp do schedule(static)
    do i = 1, size(damped)
      do j = 1, 2
        if (.not. mobility(j, i) > 0.0_dp) then
          acceleration(j, i) = 0.0_dp
          cycle
        end if
        f = force(j, i)
        if (local > 0.0_dp .and. abs(v(j, i)) > 0.0_dp) f = f - sign(local*abs(f), v(j, i))
        next = kept*v(j, i) + gain*f*mobility(j, i)
        acceleration(j, i) = (next - v(j, i))*over_step
        middle = 0.5_dp*(v(j, i) + next)
        damped(i) = damped(i) + step*middle*(force(j, i) - f + viscous*middle/mobility(j, i))
        v(j, i) = next
      end do
    end do
    !$omp end do
  end subroutine motion_velocity

  !> The same without damping, both components of all nodes in one row. Where motion is held the
  !> velocity stays, and the difference is zero.
  subroutine accelerate(n, step, mobility, force, v, acceleration)
    integer, intent(in) :: n
    real(dp), intent(in) :: step, mobility(*), force(*)
    real(dp), intent(inout) :: v(*), acceleration(*)
    real(dp) :: next, over_step
    integer :: i

    over_step = 1.0_dp/step
    !$omp do schedule(static)
    do i = 1, n
      next = v(i) + step*force(i)*mobility(i)
      acceleration(i) = (next - v(i))*over_step
      v(i) = next
    end do
    !$omp end do
  end subroutine accelerate

  !> Out-of-balance force less local damping, as in motion_velocity, for the consistent mass: a node
  !> is also moved by the force on its neighbours.
  subroutine motion_damp(local, force, v, pull)
    real(dp), intent(in) :: local !! local damping, fraction 0..1
    real(dp), contiguous, intent(in) :: force(:,:)   !! out-of-balance force [N/m], (2,n)
    real(dp), contiguous, intent(in) :: v(:,:)       !! velocity half a step back [m/s], (2,n)
    real(dp), contiguous, intent(inout) :: pull(:,:) !! what is left of the force [N/m], (2,n)
    integer :: i, j

    !$omp do schedule(static)
    do i = 1, size(v, 2)
      do j = 1, 2
        pull(j, i) = force(j, i)
        if (abs(v(j, i)) > 0.0_dp) pull(j, i) = force(j, i) - sign(local*abs(force(j, i)), v(j, i))
      end do
    end do
    !$omp end do
  end subroutine motion_damp

  !> Velocities at the next half step with the consistent mass (src/THEORY.md (5.11)). Held nodes
  !> keep theirs.
  subroutine motion_velocity_consistent(step, offset, node, pair_mass, mobility, force, pull, v, &
                                        acceleration, damped)
    real(dp), intent(in) :: step !! time step [s]
    integer, contiguous, intent(in) :: offset(:), node(:)    !! neighbours of each node
    real(dp), contiguous, intent(in) :: pair_mass(:)         !! of each neighbour [kg/m]
    real(dp), contiguous, intent(in) :: mobility(:,:)        !! [m/kg], (2,n)
    real(dp), contiguous, intent(in) :: force(:,:)           !! out-of-balance force [N/m], (2,n)
    real(dp), contiguous, intent(in) :: pull(:,:)            !! the same less damping [N/m], (2,n)
    real(dp), contiguous, intent(inout) :: v(:,:)            !! velocity [m/s], (2,n)
    real(dp), contiguous, intent(inout) :: acceleration(:,:) !! with damping [m/s2], (2,n)
    real(dp), contiguous, intent(inout) :: damped(:)         !! energy damped so far [J/m], (n)
    real(dp) :: middle(2)
    integer :: i

    !$omp do schedule(static)
    do i = 1, size(damped)
      acceleration(:, i) = inertia_gather(offset, node, pair_mass, mobility, pull, i)
      middle = v(:, i) + 0.5_dp*step*acceleration(:, i)
      v(:, i) = v(:, i) + step*acceleration(:, i)
      damped(i) = damped(i) + step*dot_product(middle, &
        merge(force(:, i) - pull(:, i), 0.0_dp, mobility(:, i) > 0.0_dp))
    end do
    !$omp end do
  end subroutine motion_velocity_consistent
end module talus_force
