! SPDX-License-Identifier: MIT
!> Unsaturated flow between two points (src/THEORY.md (4.14), (4.15)). The capillary part is the
!> difference of the matric flux potential, exact for any retention law. The gravity part needs a
!> conductivity k_g for the face:
!>
!> - in soil whose conductivity is exponential in pressure (Gardner 1958) the steady flow between
!>   the points is known; it weights k towards the upper point by the Langevin function of half the
!>   Peclet number Pe = drop dk/dPhi (the exponential fit of Scharfetter & Gummel 1969);
!> - in hydrostatic equilibrium k_g goes to dPhi/dp, so that still water stays still in any soil.
!>   The share of that limit falls with the square of the head over the drop, and with it the
!>   small difference that it makes in Gardner's soil.
module talus_face_flow
  use talus_kinds, only: dp
  implicit none
  private
  public :: face_drive, face_mean

contains

  !> Drive of the flow from point 1 to point 2 [Pa]: minus the flux over k_sat/(gamma_w length).
  elemental subroutine face_drive(p1, p2, phi1, phi2, k1, k2, drop, drive, peclet)
    real(dp), intent(in) :: p1, p2     !! pore pressures [Pa]
    real(dp), intent(in) :: phi1, phi2 !! matric flux potentials [Pa]
    real(dp), intent(in) :: k1, k2     !! relative conductivities [-]
    real(dp), intent(in) :: drop       !! gamma_w (y2 - y1) [Pa]
    real(dp), intent(out) :: drive     !! dPhi + k_g drop [Pa]
    real(dp), intent(out) :: peclet    !! cell Peclet number, its magnitude [-]
    real(dp) :: k_gravity, share, head

    peclet = 0.0_dp
    if (abs(phi2 - phi1) > tiny(1.0_dp)) peclet = drop*(k2 - k1)/(phi2 - phi1)
    k_gravity = 0.5_dp*(k1 + k2 + (k2 - k1)*langevin(0.5_dp*peclet))
    head = (p2 - p1) + drop
    share = drop*drop
    if (share > tiny(1.0_dp)) share = share/(share + 4.0_dp*head*head)
    k_gravity = k_gravity + share*(face_mean(p1, p2, phi1, phi2, k1, k2) - k_gravity)
    drive = (phi2 - phi1) + k_gravity*drop
    peclet = abs(peclet)
  end subroutine face_drive

  !> Mean relative conductivity between two pressures [-]: dPhi/dp.
  elemental real(dp) function face_mean(p1, p2, phi1, phi2, k1, k2) result(mean)
    real(dp), intent(in) :: p1, p2     !! pore pressures [Pa]
    real(dp), intent(in) :: phi1, phi2 !! matric flux potentials [Pa]
    real(dp), intent(in) :: k1, k2     !! relative conductivities [-]

    ! Closer pressures than this lose digits in the quotient; the trapezoid is then exact.
    if (abs(p2 - p1) > 1.0e-7_dp*(abs(p1) + abs(p2))) then
      mean = (phi2 - phi1)/(p2 - p1)
    else
      mean = 0.5_dp*(k1 + k2)
    end if
  end function face_mean

  !> coth(x) - 1/x.
  elemental real(dp) function langevin(x)
    real(dp), intent(in) :: x

    if (abs(x) < 0.05_dp) then
      langevin = x/3.0_dp*(1.0_dp - x*x/15.0_dp*(1.0_dp - x*x*2.0_dp/21.0_dp))
    else
      langevin = 1.0_dp/tanh(x) - 1.0_dp/x
    end if
  end function langevin
end module talus_face_flow
