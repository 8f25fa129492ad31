! SPDX-License-Identifier: MIT
!> The kernel of the method: the cubic B-spline (src/THEORY.md (4.1); Liu, Jun & Zhang 1995).
module talus_kernel
  use talus_kinds, only: dp
  implicit none
  private
  public :: kernel_spline

contains

  !> Cubic B-spline of unit support radius, 2/3 at the centre, twice continuously differentiable.
  elemental real(dp) function kernel_spline(q) result(value)
    real(dp), intent(in) :: q !! distance over support radius, >= 0

    if (q < 0.5_dp) then
      value = 2.0_dp/3.0_dp + 4.0_dp*q*q*(q - 1.0_dp)
    else if (q < 1.0_dp) then
      value = 4.0_dp/3.0_dp*(1.0_dp - q)**3
    else
      value = 0.0_dp
    end if
  end function kernel_spline
end module talus_kernel
