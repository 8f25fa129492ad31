! SPDX-License-Identifier: MIT
!> Motion with a constant velocity gradient about a fixed centre: turning, stretching, shearing.
module talus_homogeneous_motion
  use talus_kinds, only: dp
  implicit none
  private
  public :: motion_map, motion_velocity_about

contains

  !> Where a constant velocity gradient L takes distances from its centre: exp(L time), by the
  !> closed form for 2 x 2 matrices (src/THEORY.md (2.5)). A spin gives an exact rotation.
  pure function motion_map(gradient, time) result(map)
    real(dp), intent(in) :: gradient(4) !! L xx, xy, yx, yy [1/s]
    real(dp), intent(in) :: time        !! [s]
    real(dp) :: map(4)                  !! xx, xy, yx, yy [-]
    real(dp) :: a(4), mean, square, even, odd

    a = gradient*time
    mean = 0.5_dp*(a(1) + a(4))
    a([1, 4]) = a([1, 4]) - mean
    square = a(2)*a(3) - a(1)*a(4)
    if (abs(square) < 1.0e-6_dp) then
      ! Both series, of which the next terms are below 1e-20.
      even = 1.0_dp + square*(1.0_dp/2.0_dp + square*(1.0_dp/24.0_dp + square/720.0_dp))
      odd = 1.0_dp + square*(1.0_dp/6.0_dp + square*(1.0_dp/120.0_dp + square/5040.0_dp))
    else if (square > 0.0_dp) then
      even = cosh(sqrt(square))
      odd = sinh(sqrt(square))/sqrt(square)
    else
      even = cos(sqrt(-square))
      odd = sin(sqrt(-square))/sqrt(-square)
    end if
    map = exp(mean)*(odd*a + even*[1.0_dp, 0.0_dp, 0.0_dp, 1.0_dp])
  end function motion_map

  !> Constant velocity that takes a point in one step to where the motion takes it [m/s].
  pure function motion_velocity_about(map, arm, step) result(velocity)
    real(dp), intent(in) :: map(4) !! of the step, see motion_map
    real(dp), intent(in) :: arm(2) !! distance from the centre now [m]
    real(dp), intent(in) :: step   !! [s]
    real(dp) :: velocity(2)

    velocity = [(map(1) - 1.0_dp)*arm(1) + map(2)*arm(2), &
                map(3)*arm(1) + (map(4) - 1.0_dp)*arm(2)]/step
  end function motion_velocity_about
end module talus_homogeneous_motion
