! SPDX-License-Identifier: MIT
!> Elementary functions that Fortran 2008 lacks: accurate near zero.
module talus_special
  use talus_kinds, only: dp
  implicit none
  private
  public :: log1p, expm1

contains

  !> log(1 + x) to a few units of round-off for any x > -1 (Kahan's correction).
  elemental real(dp) function log1p(x)
    real(dp), intent(in) :: x !! > -1
    real(dp) :: w

    w = 1.0_dp + x
    if (abs(w - 1.0_dp) > 0.0_dp) then
      log1p = log(w)*(x/(w - 1.0_dp))
    else
      log1p = x
    end if
  end function log1p

  !> exp(x) - 1 to a few units of round-off for any x (Kahan's correction).
  elemental real(dp) function expm1(x)
    real(dp), intent(in) :: x
    real(dp) :: w

    w = exp(x)
    if (x < -40.0_dp) then
      expm1 = -1.0_dp
    else if (abs(w - 1.0_dp) > 0.0_dp) then
      expm1 = (w - 1.0_dp)*(x/log(w))
    else
      expm1 = x
    end if
  end function expm1
end module talus_special
