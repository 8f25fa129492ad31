! SPDX-License-Identifier: MIT
!> Retention law of Fredlund & Xing (1994) and the conductivity of Fredlund, Xing & Huang (1994).
!!
!! S(s) = C(s) / log(e + (s/a)^n)^m, with C = 1 - log(1 + s/s_r)/log(1 + s_end/s_r), which is
!! zero at s_end = 1e9 Pa. The conductivity is N(s)/N(s_entry) with, y = log s,
!!
!!     N(s) = integral of (S(s') - S(s))/s'^2 dS from s to s_end
!!          = integral over y of (S(y) - S(s)) dS/dy exp(-2 y) dy :
!!
!! theirs has (S(y) - S(s)) exp(-y) S'(e^y), with S' the slope by suction. N grows without bound
!! as s falls to 0, by log s, since C is linear there: the law needs an air entry.
!! On a grid of y, B(y) = integral of dS/dy exp(-2 y) to the end. From node j+1 to any y below it
!! N(y) = N(j+1) + [integral over y..y(j+1)] + (S(j+1) - S(y)) B(j+1), a sum of positive terms.
module talus_fredlund_xing
  use talus_kinds, only: dp
  use talus_special, only: log1p
  implicit none
  private
  public :: fredlund_xing_t, fredlund_xing_make
  public :: fredlund_xing_saturation, fredlund_xing_integral

  real(dp), parameter :: e_number = 2.718281828459045_dp
  real(dp), parameter :: step = 0.125_dp          ! of log s
  real(dp), parameter :: gauss_x(4) = [0.1834346424956498_dp, 0.5255324099163290_dp, &
    0.7966664774136267_dp, 0.9602898564975363_dp]
  real(dp), parameter :: gauss_w(4) = [0.3626837833783620_dp, 0.3137066458778873_dp, &
    0.2223810344533745_dp, 0.1012285362903763_dp]

  type :: fredlund_xing_t
    real(dp) :: a = 1.0_dp, n = 1.0_dp, m = 1.0_dp !! a in pascal
    real(dp) :: residual = 1.0_dp                  !! s_r [Pa]
    real(dp) :: log_end = 1.0_dp                   !! log(s_end)
    real(dp) :: log_range = 1.0_dp                 !! log(1 + s_end/s_r)
    real(dp), allocatable :: b(:)                  !! B at log s = log_end - j step, j = 0..
    real(dp), allocatable :: nn(:)                 !! N there
  end type fredlund_xing_t

contains

  !> Parameters in pascal; tabulates the two integrals from s_end down to 1e-9 a.
  pure subroutine fredlund_xing_make(a, n, m, residual, suction_end, fx)
    real(dp), intent(in) :: a           !! [Pa]
    real(dp), intent(in) :: n, m        !! exponents
    real(dp), intent(in) :: residual    !! suction s_r of the correction factor [Pa]
    real(dp), intent(in) :: suction_end !! where S = 0 [Pa]
    type(fredlund_xing_t), intent(out) :: fx
    real(dp) :: top, part_b, part_n
    integer :: j, last

    fx%a = a
    fx%n = n
    fx%m = m
    fx%residual = residual
    fx%log_end = log(suction_end)
    fx%log_range = log1p(suction_end/residual)
    last = ceiling((fx%log_end - log(1.0e-9_dp*a))/step)
    allocate (fx%b(0:last), fx%nn(0:last))
    fx%b(0) = 0.0_dp
    fx%nn(0) = 0.0_dp
    do j = 1, last
      top = fx%log_end - real(j - 1, dp)*step
      call integrate(fx, top - step, top, part_b, part_n)
      fx%b(j) = fx%b(j-1) + part_b
      fx%nn(j) = fx%nn(j-1) + part_n + (saturation_at(fx, top) - &
        saturation_at(fx, top - step))*fx%b(j-1)
    end do
  end subroutine fredlund_xing_make

  !> Saturation S(s) before any air-entry cut, 1 at s = 0 and 0 from s_end on.
  pure real(dp) function fredlund_xing_saturation(fx, suction) result(saturation)
    type(fredlund_xing_t), intent(in) :: fx
    real(dp), intent(in) :: suction !! [Pa]

    saturation = 1.0_dp
    if (suction > 0.0_dp) saturation = saturation_at(fx, log(suction))
  end function fredlund_xing_saturation

  !> The integral N(s); the conductivity ratio is N(s)/N(s_entry).
  pure real(dp) function fredlund_xing_integral(fx, suction) result(value)
    type(fredlund_xing_t), intent(in) :: fx
    real(dp), intent(in) :: suction !! [Pa]
    real(dp) :: y, top, part_b, part_n
    integer :: j, last

    last = ubound(fx%nn, 1)
    y = fx%log_end - real(last, dp)*step
    if (suction > 0.0_dp) y = max(y, log(suction))
    j = min(last - 1, int((fx%log_end - y)/step))
    value = 0.0_dp
    if (y >= fx%log_end) return
    top = fx%log_end - real(j, dp)*step
    call integrate(fx, y, top, part_b, part_n)
    value = fx%nn(j) + part_n + (saturation_at(fx, top) - saturation_at(fx, y))*fx%b(j)
  end function fredlund_xing_integral

  !> Integrals over y from `low` to `high` of dS/dy exp(-2 y) and of (S - S(low)) times that,
  !! by eight Gauss points.
  pure subroutine integrate(fx, low, high, part_b, part_n)
    type(fredlund_xing_t), intent(in) :: fx
    real(dp), intent(in) :: low, high      !! log s
    real(dp), intent(out) :: part_b, part_n
    real(dp) :: half, centre, y, weight, s_low
    integer :: i, side

    half = 0.5_dp*(high - low)
    centre = 0.5_dp*(high + low)
    s_low = saturation_at(fx, low)
    part_b = 0.0_dp
    part_n = 0.0_dp
    do i = 1, 4
      do side = -1, 1, 2
        y = centre + real(side, dp)*gauss_x(i)*half
        weight = gauss_w(i)*half*slope_at(fx, y)*exp(-2.0_dp*y)
        part_b = part_b + weight
        part_n = part_n + weight*(saturation_at(fx, y) - s_low)
      end do
    end do
  end subroutine integrate

  pure real(dp) function saturation_at(fx, y) result(saturation)
    type(fredlund_xing_t), intent(in) :: fx
    real(dp), intent(in) :: y !! log s
    real(dp) :: correction, z

    correction = max(0.0_dp, 1.0_dp - log1p(exp(y)/fx%residual)/fx%log_range)
    z = (exp(y)/fx%a)**fx%n
    saturation = correction*exp(-fx%m*log1p(log1p(z/e_number)))
  end function saturation_at

  !> dS/dy, y = log s.
  pure real(dp) function slope_at(fx, y) result(slope)
    type(fredlund_xing_t), intent(in) :: fx
    real(dp), intent(in) :: y !! log s
    real(dp) :: correction, s, z, level, power

    s = exp(y)
    correction = max(0.0_dp, 1.0_dp - log1p(s/fx%residual)/fx%log_range)
    z = (s/fx%a)**fx%n
    level = 1.0_dp + log1p(z/e_number)
    power = exp(-fx%m*log(level))
    slope = -power*(s/(fx%residual + s))/fx%log_range &
      - correction*power*(fx%m/level)*fx%n*z/(e_number + z)
  end function slope_at
end module talus_fredlund_xing
