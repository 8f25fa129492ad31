! SPDX-License-Identifier: MIT
!> Tabulated water curve of one soil: what the explicit seepage loop evaluates at every node.
!!
!! Over suction s = -p_w the table holds saturation S_r(s), relative conductivity k_r(s) and the
!! matric flux potential Phi(p) = integral of k_r dp from the driest suction (src/THEORY.md
!! sections 3 and 4). Built by `water_curve_make` (module `talus_water_curve_make`).
!!
!! Cells. x = 1 + (s - s_entry)/s_ref; the leading bits of x as an IEEE number are the cell, so
!! the cells of each octave of x are even and finding one needs no logarithm. In a cell,
!! v = (s - centre)/half in -1..1, and
!!     S_r = base - Y(v), base = S_max while S_e >= 1/2 and S_res beyond; Y has degree 5;
!!     k_r = K(v), degree 5;  Phi = Phi_0 - half * integral of K dv, so k_r = dPhi/dp exactly;
!!     capacity dS_r/dp = Y'(v)/half: the derivative of the table itself.
!! Storing Y instead of S_r keeps full relative accuracy of 1 - S_e near saturation and of S_e in
!! dry soil. Below s_entry, k_r = 1 and Y is linear in s.
!!
!! Differences of Phi between two pressures are right to round-off of Phi itself, and Phi counts
!! from the dry end, so they stay accurate in dry soil where Phi is small.
module talus_water_curve
  use talus_kinds, only: dp, i4, i8
  implicit none
  private
  public :: water_curve_t, curve_at_pressure, curve_at_saturation, curve_bits

  integer, parameter, public :: curve_degree = 5  !! of the polynomials of a cell
  integer, parameter, public :: mantissa_bits = 52
  integer, parameter, public :: guide_bits = 6    !! guide buckets an octave of |Y|: 2**guide_bits
  !> Rows of `coef`: Y from 1, K from 7, then centre, half, 1/half of the cell [Pa], Phi_0 [Pa].
  integer, parameter, public :: row_y = 1, row_k = 7, row_centre = 13, row_half = 14, &
    row_inverse_half = 15, row_potential = 16, coef_rows = 16
  !> Rows of `inverse`: Y at the wet edge, 1/(range of Y), then v as a polynomial of
  !! t = (Y - edge)/range.
  integer, parameter, public :: row_edge = 1, row_scale = 2, row_v = 3, inverse_rows = 8

  !> Properties where the saturation is known: at one point, or at n of them.
  interface curve_at_saturation
    module procedure at_saturation, at_saturations
  end interface curve_at_saturation

  type :: water_curve_t
    real(dp) :: residual = 0.0_dp          !! S_res [-]
    real(dp) :: maximum = 1.0_dp           !! S_max [-]
    real(dp) :: entry = 0.0_dp             !! air-entry suction, start of the cells [Pa]
    real(dp) :: driest = 0.0_dp            !! greatest suction of the table [Pa]
    real(dp) :: potential_entry = 0.0_dp   !! Phi at the air-entry suction [Pa]
    real(dp) :: entry_slope = 0.0_dp       !! dY/ds below the air entry [1/Pa]
    real(dp) :: inverse_reference = 0.0_dp !! 1/s_ref [1/Pa]
    real(dp) :: wet_limit = 0.0_dp         !! S_max - S_r where base changes
    real(dp) :: error = 0.0_dp             !! greatest relative error of S_e and k_r, measured
    integer :: shift = 0                   !! right shift of the bits of x
    integer :: cells = 0                   !! number of cells
    integer :: wet_cells = 0               !! cells 1..wet_cells have base = S_max
    integer(i8) :: first_bits = 0_i8       !! shifted bits of x in cell 1, less one
    integer(i8) :: wet_bits = 0_i8         !! shifted bits of S_max - S_r, bucket 1, less one
    integer(i8) :: dry_bits = 0_i8         !! shifted bits of S_r - S_res, bucket 1, less one
    real(dp), allocatable :: coef(:, :)    !! (coef_rows, cells)
    real(dp), allocatable :: inverse(:, :) !! (inverse_rows, cells)
    integer(i4), allocatable :: guide_wet(:) !! cell at the low edge of a bucket, rising
    integer(i4), allocatable :: guide_dry(:) !! cell at the low edge of a bucket, falling
  end type water_curve_t

contains

  !> Bits of a positive number, shifted right: exponent and leading bits of the mantissa.
  pure integer(i8) function curve_bits(x, shift) result(bits)
    real(dp), intent(in) :: x     !! > 0
    integer, intent(in) :: shift  !! bits dropped

    bits = ishft(transfer(x, 0_i8), -shift)
  end function curve_bits

  !> All properties at a pore pressure. Below -driest everything stays as at -driest.
  pure subroutine curve_at_pressure(curve, pressure, saturation, conductivity_ratio, &
    flux_potential, capacity)
    type(water_curve_t), intent(in) :: curve
    real(dp), intent(in) :: pressure            !! p_w [Pa], + in compression
    real(dp), intent(out) :: saturation         !! S_r [-]
    real(dp), intent(out) :: conductivity_ratio !! k_r [-]
    real(dp), intent(out) :: flux_potential     !! Phi [Pa], grows with pressure
    real(dp), intent(out) :: capacity           !! dS_r/dp >= 0 [1/Pa]; 0 where saturated
    real(dp) :: s, v
    integer :: i

    s = -pressure
    if (s <= curve%entry) then
      saturation = curve%maximum
      conductivity_ratio = 1.0_dp
      flux_potential = curve%potential_entry + (curve%entry - s)
      capacity = 0.0_dp
      if (s > 0.0_dp) then
        saturation = curve%maximum - curve%entry_slope*s
        capacity = curve%entry_slope
      end if
      return
    end if
    s = min(s, curve%driest)
    i = cell_at(curve, s)
    v = (s - curve%coef(row_centre, i))*curve%coef(row_inverse_half, i)
    call flow_at(curve%coef(:, i), v, conductivity_ratio, flux_potential)
    call storage_at(curve%coef(:, i), v, saturation, capacity)
    saturation = merge(curve%maximum, curve%residual, i <= curve%wet_cells) - saturation
    capacity = capacity*curve%coef(row_inverse_half, i)
  end subroutine curve_at_pressure

  !> The inverse: suction and properties where the saturation is `saturation` < S_max.
  !! At S_max or above: suction 0. Drier than the table: its driest suction.
  pure subroutine at_saturation(curve, saturation, suction, conductivity_ratio, flux_potential, &
    capacity)
    type(water_curve_t), intent(in) :: curve
    real(dp), intent(in) :: saturation          !! S_r [-]
    real(dp), intent(out) :: suction            !! s = -p_w >= 0 [Pa]
    real(dp), intent(out) :: conductivity_ratio !! k_r [-]
    real(dp), intent(out) :: flux_potential     !! Phi [Pa]
    real(dp), intent(out) :: capacity           !! dS_r/dp >= 0 [1/Pa]; 0 where saturated
    real(dp), dimension(1) :: s, k, phi, c

    call at_saturations(curve, 1, [saturation], s, k, phi, c)
    suction = s(1)
    conductivity_ratio = k(1)
    flux_potential = phi(1)
    capacity = c(1)
  end subroutine at_saturation

  !> The inverse at n points: step by step for all of them, so that no point waits for its own last
  !> step while others could go on.
  pure subroutine at_saturations(curve, n, saturation, suction, conductivity_ratio, &
    flux_potential, capacity)
    type(water_curve_t), intent(in) :: curve
    integer, intent(in) :: n
    real(dp), intent(in) :: saturation(n)
    real(dp), dimension(n), intent(out) :: suction, conductivity_ratio, flux_potential, capacity
    real(dp), dimension(n) :: target, v
    integer :: cell(n), j

    do j = 1, n
      target(j) = curve%maximum - saturation(j)
      if (target(j) <= curve%inverse(row_edge, 1)) then
        ! Too wet for the cells: solved somewhere in the first one, and set at the end.
        cell(j) = 1
        target(j) = curve%inverse(row_edge, 1) + 0.5_dp/curve%inverse(row_scale, 1)
      else
        call cell_of(curve, target(j), saturation(j) - curve%residual, cell(j))
        if (cell(j) > curve%wet_cells) target(j) = curve%residual - saturation(j)
      end if
    end do
    call solve_cells(n, cell, curve%coef, curve%inverse, target, v, capacity)
    call flow_in_cells(n, cell, curve%coef, v, suction, conductivity_ratio, flux_potential, &
      capacity)
    do j = 1, n
      target(j) = curve%maximum - saturation(j)
      if (target(j) > curve%inverse(row_edge, 1)) cycle
      suction(j) = 0.0_dp
      capacity(j) = 0.0_dp
      if (target(j) > 0.0_dp) then
        suction(j) = target(j)/curve%entry_slope
        capacity(j) = curve%entry_slope
      end if
      conductivity_ratio(j) = 1.0_dp
      flux_potential(j) = curve%potential_entry + (curve%entry - suction(j))
    end do
  end subroutine at_saturations

  !> Place v of each point in its cell and dY/dv there: one turn of Newton's method from a close
  !> guess, and more where that was not enough.
  pure subroutine solve_cells(n, cell, coef, inverse, target, v, slope)
    integer, intent(in) :: n, cell(n)
    real(dp), intent(in) :: coef(coef_rows,*), inverse(inverse_rows,*)
    real(dp), intent(in) :: target(n)           !! Y
    real(dp), intent(out) :: v(n), slope(n)
    real(dp) :: next(n), t, value
    integer :: i, j

    do j = 1, n
      i = cell(j)
      t = (target(j) - inverse(row_edge, i))*inverse(row_scale, i)
      v(j) = within(horner(inverse(row_v:, i), min(1.0_dp, max(0.0_dp, t))))
    end do
    do j = 1, n
      call storage_at(coef(:, cell(j)), v(j), value, slope(j))
      next(j) = v(j) + (target(j) - value)/slope(j)
    end do
    do j = 1, n
      if (abs(next(j) - v(j)) <= 1.0e-7_dp) then
        v(j) = within(next(j))
      else
        call solve_cell(coef(:, cell(j)), target(j), v(j), slope(j))
      end if
    end do
  end subroutine solve_cells

  !> Suction and flow of points whose place in their cells is known; capacity from dY/dv.
  pure subroutine flow_in_cells(n, cell, coef, v, suction, conductivity_ratio, flux_potential, &
    capacity)
    integer, intent(in) :: n, cell(n)
    real(dp), intent(in) :: coef(coef_rows,*), v(n)
    real(dp), dimension(n), intent(out) :: suction, conductivity_ratio, flux_potential
    real(dp), intent(inout) :: capacity(n) !! in: dY/dv; out: dS_r/dp [1/Pa]
    integer :: i, j

    do j = 1, n
      i = cell(j)
      suction(j) = coef(row_centre, i) + coef(row_half, i)*v(j)
      capacity(j) = capacity(j)*coef(row_inverse_half, i)
      call flow_at(coef(:, i), v(j), conductivity_ratio(j), flux_potential(j))
    end do
  end subroutine flow_in_cells

  !> A place in a cell.
  elemental real(dp) function within(v)
    real(dp), intent(in) :: v

    within = min(1.0_dp, max(-1.0_dp, v))
  end function within

  !> Cell that holds a suction above the air entry.
  pure integer function cell_at(curve, suction) result(i)
    type(water_curve_t), intent(in) :: curve
    real(dp), intent(in) :: suction !! [Pa], entry < s <= driest

    i = int(curve_bits(1.0_dp + (suction - curve%entry)*curve%inverse_reference, curve%shift) &
      - curve%first_bits)
    i = min(i, curve%cells)
  end function cell_at

  !> Root v of Y(v) = target: Newton's method from a close guess, kept in a bracket.
  pure subroutine solve_cell(coef, target, v, slope)
    real(dp), intent(in) :: coef(coef_rows)
    real(dp), intent(in) :: target
    real(dp), intent(inout) :: v       !! in: guess; out: root in -1..1
    real(dp), intent(out) :: slope     !! dY/dv
    real(dp) :: low, high, value, next
    integer :: iteration

    low = -1.0_dp
    high = 1.0_dp
    v = within(v)
    do iteration = 1, 60
      call storage_at(coef, v, value, slope)
      next = v + (target - value)/slope
      if (abs(next - v) <= 1.0e-7_dp) exit
      if (value < target) then
        low = v
      else
        high = v
      end if
      if (next < low .or. next > high) next = 0.5_dp*(low + high)
      v = next
    end do
    v = within(next)
  end subroutine solve_cell

  !> Cell that holds a saturation: a bucket of the guide, then bisection.
  pure subroutine cell_of(curve, deficit, excess, low)
    type(water_curve_t), intent(in) :: curve
    real(dp), intent(in) :: deficit !! S_max - S_r > 0
    real(dp), intent(in) :: excess  !! S_r - S_res, any sign
    integer, intent(out) :: low     !! cell
    real(dp) :: target
    integer :: high, middle, bucket

    if (deficit < curve%wet_limit .or. curve%wet_cells == curve%cells) then
      target = deficit
      bucket = int(curve_bits(deficit, mantissa_bits - guide_bits) - curve%wet_bits)
      bucket = min(max(bucket, 1), size(curve%guide_wet) - 1)
      low = curve%guide_wet(bucket)
      high = curve%guide_wet(bucket+1) + 1
    else
      target = -excess
      bucket = 1
      if (excess > 0.0_dp) bucket = int(curve_bits(excess, mantissa_bits - guide_bits) &
        - curve%dry_bits)
      bucket = min(max(bucket, 1), size(curve%guide_dry) - 1)
      low = curve%guide_dry(bucket+1)
      high = curve%guide_dry(bucket) + 1
    end if
    do while (high - low > 1)
      middle = (low + high)/2
      if (curve%inverse(row_edge, middle) <= target) then
        low = middle
      else
        high = middle
      end if
    end do
  end subroutine cell_of

  !> Y and dY/dv.
  pure subroutine storage_at(coef, v, value, slope)
    real(dp), intent(in) :: coef(coef_rows)
    real(dp), intent(in) :: v
    real(dp), intent(out) :: value, slope

    value = horner(coef(row_y:row_y+5), v)
    slope = coef(2) + v*(2.0_dp*coef(3) + v*(3.0_dp*coef(4) + v*(4.0_dp*coef(5) &
      + v*(5.0_dp*coef(6)))))
  end subroutine storage_at

  !> k_r and Phi.
  pure subroutine flow_at(coef, v, conductivity_ratio, flux_potential)
    real(dp), intent(in) :: coef(coef_rows)
    real(dp), intent(in) :: v
    real(dp), intent(out) :: conductivity_ratio, flux_potential
    real(dp), parameter :: third = 1.0_dp/3.0_dp, sixth = 1.0_dp/6.0_dp

    conductivity_ratio = horner(coef(row_k:row_k+5), v)
    flux_potential = coef(row_potential) - coef(row_half)*v*(coef(7) + v*(0.5_dp*coef(8) &
      + v*(third*coef(9) + v*(0.25_dp*coef(10) + v*(0.2_dp*coef(11) + v*(sixth*coef(12)))))))
  end subroutine flow_at

  !> Polynomial of degree 5.
  pure real(dp) function horner(c, v)
    real(dp), intent(in) :: c(6) !! from the constant
    real(dp), intent(in) :: v

    horner = c(1) + v*(c(2) + v*(c(3) + v*(c(4) + v*(c(5) + v*c(6)))))
  end function horner
end module talus_water_curve
