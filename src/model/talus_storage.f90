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
  public :: storage_content, storage_invert, storage_capacity

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
  pure subroutine storage_invert(curve, storage, pore, jacobian, content, pressure, saturation, &
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
    real(dp) :: slope, excess, rise

    ! Water above that at the air entry, and its rise with pressure from there to zero.
    excess = content - pore*(curve%maximum - curve%entry_slope*curve%entry)
    rise = pore*curve%entry_slope + jacobian*storage
    if (excess < 0.0_dp) then
      saturation = content/pore
      call curve_at_saturation(curve, saturation, pressure, ratio, potential, slope)
      pressure = -pressure
      capacity = max(pore*slope, jacobian*storage)
    else
      pressure = excess/rise - curve%entry
      if (pressure > 0.0_dp) pressure = (excess - rise*curve%entry)/(jacobian*storage)
      call curve_at_pressure(curve, pressure, saturation, ratio, potential, slope)
      capacity = storage_capacity(curve, storage, pore, jacobian, pressure, slope)
    end if
  end subroutine storage_invert
end module talus_storage
