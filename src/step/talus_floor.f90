! SPDX-License-Identifier: MIT
!> A rigid, rough floor that soil comes down to while it moves (src/THEORY.md section 5.7).
module talus_floor
  use talus_kinds, only: dp
  use talus_conditions, only: conditions_t, floor_t
  use talus_state, only: state_t
  use talus_soil_step, only: motion_t
  implicit none
  private
  public :: floor_land, floor_hold

contains

  !> Stop for good the nodes that have come down to the floor. They stay where they are, at most one
  !> step's travel below it, so that no force has worked on the way; the kinetic energy of the
  !> impact is booked with the damped energy. For the rest of the stage they count as held.
  pure subroutine floor_land(floor, x, motion, state)
    type(floor_t), intent(in) :: floor
    real(dp), intent(in) :: x(:,:)          !! reference places [m], (2,n)
    type(motion_t), intent(inout) :: motion !! its mobility becomes 0 where a node lands
    type(state_t), intent(inout) :: state
    integer :: i, k

    do k = 1, size(floor%node)
      i = floor%node(k)
      if (x(2, i) + state%u(2, i) > floor%level(k)) cycle
      ! A node held in one direction only slides along its support, and lands as any other.
      if (.not. any(motion%mobility(:, i) > 0.0_dp)) cycle
      state%damped(i) = state%damped(i) + impact_energy(motion, state, i)
      motion%mobility(:, i) = 0.0_dp
      state%v(:, i) = 0.0_dp
      state%acceleration(:, i) = 0.0_dp
    end do
  end subroutine floor_land

  !> Hold the nodes that lie on the floor, in a stage whose motion is no real one.
  pure subroutine floor_hold(place, conditions)
    real(dp), intent(in) :: place(:,:) !! present places [m], (2,n)
    type(conditions_t), intent(inout) :: conditions
    integer :: i, k

    do k = 1, size(conditions%floor%node)
      i = conditions%floor%node(k)
      if (place(2, i) > conditions%floor%level(k)) cycle
      where (.not. conditions%held(:, i)) conditions%given(:, i) = 0.0_dp
      conditions%held(:, i) = .true.
    end do
  end subroutine floor_hold

  !> Kinetic energy (5.5) of a node at the end of a step [J/m], in the directions in which it can
  !> move.
  pure real(dp) function impact_energy(motion, state, i) result(energy)
    type(motion_t), intent(in) :: motion
    type(state_t), intent(in) :: state
    integer, intent(in) :: i !! node
    integer :: j

    energy = 0.0_dp
    do j = 1, 2
      if (motion%mobility(j, i) > 0.0_dp) energy = energy + 0.5_dp*state%v(j, i) &
        *(state%v(j, i) - motion%step*state%acceleration(j, i))/motion%mobility(j, i)
    end do
  end function impact_energy
end module talus_floor
