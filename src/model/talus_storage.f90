! SPDX-License-Identifier: MIT
!> Water stored in deforming soil, and its inverse (src/THEORY.md (2.3)): per reference area
!>   w = pore S_r(p) + J S_s <p + s_entry>+,   pore = J n = J - 1 + n0.
!> It rises strictly with pressure, so the stored water gives the pressure, also when saturated.
!> Below the air-entry suction s_entry the soil is saturated in tension and stores water by the
!> same compressibility; without that the pressure there would be round-off of the stored water.
module talus_storage
  use talus_kinds, only: dp
  use talus_water_curve, only: water_curve_t, curve_at_pressure, curve_at_saturation
  implicit none
  private
  public :: storage_content, storage_invert, storage_invert_giving, storage_capacity

  !> Iterations of storage_invert_giving; its brackets shrink in each, and a few suffice.
  integer, parameter :: most_iterations = 100

  !> The inverse of storage_content: of one cell, or of n cells of one soil.
  interface storage_invert
    module procedure invert_one, invert_all
  end interface storage_invert

contains

  !> Water per reference area at a pore pressure [m3/m2].
  pure real(dp) function storage_content(curve, storage, pore, jacobian, pressure) result(content)
    type(water_curve_t), intent(in) :: curve
    real(dp), intent(in) :: storage  !! S_s [1/Pa]
    real(dp), intent(in) :: pore     !! pore volume per reference area [-]
    real(dp), intent(in) :: jacobian !! J [-]
    real(dp), intent(in) :: pressure !! p_w [Pa]
    real(dp) :: saturation, ratio, potential, capacity

    call curve_at_pressure(curve, pressure, saturation, ratio, potential, capacity)
    content = pore*saturation + jacobian*storage*max(pressure + curve%entry, 0.0_dp)
  end function storage_content

  !> dw/dp from dS_r/dp [1/Pa].
  pure real(dp) function storage_capacity(curve, storage, pore, jacobian, pressure, slope) &
    result(capacity)
    type(water_curve_t), intent(in) :: curve
    real(dp), intent(in) :: storage  !! S_s [1/Pa]
    real(dp), intent(in) :: pore     !! pore volume per reference area [-]
    real(dp), intent(in) :: jacobian !! J [-]
    real(dp), intent(in) :: pressure !! p_w [Pa]
    real(dp), intent(in) :: slope    !! dS_r/dp [1/Pa]

    capacity = pore*slope
    if (pressure + curve%entry >= 0.0_dp) capacity = capacity + jacobian*storage
  end function storage_capacity

  !> Pressure and flow properties of stored water.
  pure subroutine invert_one(curve, storage, pore, jacobian, content, pressure, saturation, &
    ratio, potential, capacity)
    type(water_curve_t), intent(in) :: curve
    real(dp), intent(in) :: storage     !! S_s [1/Pa]
    real(dp), intent(in) :: pore        !! pore volume per reference area [-]
    real(dp), intent(in) :: jacobian    !! J [-]
    real(dp), intent(in) :: content     !! w [m3/m2]
    real(dp), intent(out) :: pressure   !! p_w [Pa]
    real(dp), intent(out) :: saturation !! S_r [-]
    real(dp), intent(out) :: ratio      !! k_r [-]
    real(dp), intent(out) :: potential  !! Phi [Pa]
    real(dp), intent(out) :: capacity   !! dw/dp, at least that of the saturated state [1/Pa]
    real(dp), dimension(1) :: p, s, k, phi, c

    call invert_all(curve, storage, 1, [pore], [jacobian], [content], p, s, k, phi, c)
    pressure = p(1)
    saturation = s(1)
    ratio = k(1)
    potential = phi(1)
    capacity = c(1)
  end subroutine invert_one

  !> The same of n cells of one soil.
  pure subroutine invert_all(curve, storage, n, pore, jacobian, content, pressure, saturation, &
    ratio, potential, capacity)
    type(water_curve_t), intent(in) :: curve
    real(dp), intent(in) :: storage
    integer, intent(in) :: n
    real(dp), dimension(n), intent(in) :: pore, jacobian, content
    real(dp), dimension(n), intent(out) :: pressure, saturation, ratio, potential, capacity
    real(dp) :: excess, rise, slope
    integer :: j

    saturation = content/pore
    call curve_at_saturation(curve, n, saturation, pressure, ratio, potential, capacity)
    do j = 1, n
      ! Water above that at the air entry, and its rise with pressure from there to zero.
      excess = content(j) - pore(j)*(curve%maximum - curve%entry_slope*curve%entry)
      if (excess < 0.0_dp) then
        pressure(j) = -pressure(j)
        capacity(j) = max(pore(j)*capacity(j), jacobian(j)*storage)
        cycle
      end if
      rise = pore(j)*curve%entry_slope + jacobian(j)*storage
      pressure(j) = excess/rise - curve%entry
      if (pressure(j) > 0.0_dp) pressure(j) = (excess - rise*curve%entry)/(jacobian(j)*storage)
      call curve_at_pressure(curve, pressure(j), saturation(j), ratio(j), potential(j), slope)
      capacity(j) = storage_capacity(curve, storage, pore(j), jacobian(j), pressure(j), slope)
    end do
  end subroutine invert_all

  !> The same where the pores widen with the pressure too: w = storage_content + give (p - anchor)
  !> (src/THEORY.md (5.4b)), by Newton's method between brackets. `pressure` is the first guess.
  pure subroutine storage_invert_giving(curve, storage, pore, jacobian, give, anchor, content, &
    pressure, saturation, ratio, potential, capacity)
    type(water_curve_t), intent(in) :: curve
    real(dp), intent(in) :: storage     !! S_s [1/Pa]
    real(dp), intent(in) :: pore        !! pore volume per reference area at the anchor [-]
    real(dp), intent(in) :: jacobian    !! J there [-]
    real(dp), intent(in) :: give        !! water that wider pores take up [1/Pa], > 0
    real(dp), intent(in) :: anchor      !! pressure of the shape as it is [Pa]
    real(dp), intent(in) :: content     !! w [m3/m2]
    real(dp), intent(inout) :: pressure !! p_w [Pa]
    real(dp), intent(out) :: saturation !! S_r [-]
    real(dp), intent(out) :: ratio      !! k_r [-]
    real(dp), intent(out) :: potential  !! Phi [Pa]
    real(dp), intent(out) :: capacity   !! dw/dp [1/Pa]
    real(dp) :: low, high, excess, change, slope
    integer :: i

    low = -huge(1.0_dp)
    high = huge(1.0_dp)
    do i = 1, most_iterations
      call curve_at_pressure(curve, pressure, saturation, ratio, potential, slope)
      capacity = storage_capacity(curve, storage, pore, jacobian, pressure, slope) + give
      excess = pore*saturation + jacobian*storage*max(pressure + curve%entry, 0.0_dp) &
        + give*(pressure - anchor) - content
      ! The slope is `give` at least, so the root is no further than this.
      if (excess > 0.0_dp) then
        high = min(high, pressure)
        low = max(low, pressure - excess/give)
      else
        low = max(low, pressure)
        high = min(high, pressure - excess/give)
      end if
      ! As near as the round-off of the water lets it come.
      if (abs(excess) <= 4.0_dp*epsilon(1.0_dp)*(content + give*abs(pressure - anchor))) return
      change = -excess/capacity
      if (pressure + change < low .or. pressure + change > high) &
        change = 0.5_dp*(low + high) - pressure
      pressure = pressure + change
    end do
  end subroutine storage_invert_giving
end module talus_storage
