! SPDX-License-Identifier: MIT
!> Builds the table of a water curve from a retention law, once per soil.
!!
!! In each cell S_r and k_r are interpolated at the six Chebyshev-Lobatto points, and k_r is
!! integrated exactly for Phi. The number of cells an octave is doubled until the error measured
!! between the points is below `error_wanted`.
!!
!! Two small additions keep storage invertible and the explicit step finite at every suction:
!!     k_r = k_min + (1 - k_min) k_law,        S_e = (1 - d) S_law + d (1 - T(s)/T(s_driest)),
!! d = `tail_fraction`; T = s/scale up to the air entry, then grows as log(1 + (s - s_entry)/scale).
!! So S_e differs from the law by less than 1e-8, but dS_e/ds never vanishes.
module talus_water_curve_make
  use talus_kinds, only: dp, i4, i8
  use talus_status, only: status_t, status_failed
  use talus_special, only: log1p
  use talus_retention, only: retention_t, retention_law_t, retention_prepare, &
    retention_saturation, retention_deficit, suction_greatest, law_table
  use talus_permeability, only: permeability_relative
  use talus_water_curve, only: water_curve_t, curve_degree, mantissa_bits, guide_bits, &
    row_y, row_k, row_centre, row_half, row_inverse_half, row_potential, coef_rows, &
    row_edge, row_scale, row_v, inverse_rows, curve_bits
  implicit none
  private
  public :: water_curve_make

  !> Weight d of the logarithmic tail that keeps dS_e/ds above zero.
  real(dp), parameter, public :: tail_fraction = 1.0e-8_dp
  !> Error asked of S_e (relative to S_e where S_e > 1e-8) and of k_r (relative). A user's table
  !! has kinks in its slope, at its last point one in S_e: its error of S_e is taken absolute,
  !! and a few 1e-4 there is what the finest cells give.
  real(dp), parameter :: error_wanted = 1.0e-9_dp
  !> First cell: this power of two times the scale of the law, over the cells of an octave.
  integer, parameter :: reference_power = -18
  integer, parameter :: cell_bits_least = 3, cell_bits_most = 7
  integer, parameter :: d5 = curve_degree

  !> Samples of a law in one cell.
  type :: sample_t
    real(dp) :: y(0:d5) !! Y
    real(dp) :: k(0:d5) !! k_r
  end type sample_t

contains

  !> Table of the law of a soil. Fails when a parameter of the law is not allowed.
  subroutine water_curve_make(retention, curve, status)
    type(retention_t), intent(in) :: retention !! law and parameters, as in a deck
    type(water_curve_t), intent(out) :: curve
    type(status_t), intent(inout) :: status
    type(retention_law_t) :: law
    integer :: bits
    logical :: monotone

    call retention_prepare(retention, law, status)
    if (status_failed(status)) return
    do bits = cell_bits_least, cell_bits_most
      call build_cells(law, bits, curve)
      call measure_cells(law, curve, .false., curve%error, monotone)
      if (monotone .and. curve%error <= error_wanted) exit
    end do
    if (.not. monotone) call measure_cells(law, curve, .true., curve%error, monotone)
    call accumulate_potential(curve)
    call build_inverse(curve)
    call build_guides(curve)
  end subroutine water_curve_make

  !> Interpolate Y and k_r in every cell.
  subroutine build_cells(law, bits, curve)
    type(retention_law_t), intent(in) :: law
    integer, intent(in) :: bits !! 2**bits cells an octave
    type(water_curve_t), intent(out) :: curve
    type(sample_t) :: sample
    real(dp) :: matrix(0:d5, 0:d5), v(0:d5), y_end, k_end, low, high, reference
    integer :: octaves, i, j
    logical :: wet

    curve%residual = law%saturation_residual
    curve%maximum = law%saturation_maximum
    curve%entry = law%entry
    curve%driest = suction_greatest
    octaves = exponent((curve%driest - curve%entry)/law%scale) - reference_power
    reference = (curve%driest - curve%entry)/(2.0_dp**octaves - 1.0_dp)
    curve%inverse_reference = 1.0_dp/reference
    curve%entry_slope = (curve%maximum - curve%residual)*tail_fraction/(law%scale* &
      tail(law, curve%driest))
    curve%shift = mantissa_bits - bits
    curve%first_bits = curve_bits(1.0_dp, curve%shift) - 1_i8
    curve%cells = octaves*2**bits
    curve%wet_cells = curve%cells
    allocate (curve%coef(coef_rows, curve%cells))
    v = lobatto_points()
    matrix = monomial_matrix(v)
    wet = .true.
    high = curve%entry
    do i = 1, curve%cells
      low = high
      high = curve%entry + reference*(cell_edge(i, bits) - 1.0_dp)
      if (i == curve%cells) high = curve%driest
      curve%coef(row_centre, i) = 0.5_dp*(low + high)
      curve%coef(row_half, i) = 0.5_dp*(high - low)
      curve%coef(row_inverse_half, i) = 2.0_dp/(high - low)
      call sample_at(law, wet, low, sample%y(0), sample%k(0))
      if (wet .and. retention_saturation(law, low) < 0.5_dp) then
        wet = .false.
        curve%wet_cells = i - 1
        call sample_at(law, wet, low, sample%y(0), sample%k(0))
      end if
      do j = 1, d5 - 1
        call sample_at(law, wet, curve%coef(row_centre, i) + curve%coef(row_half, i)*v(j), &
          sample%y(j), sample%k(j))
      end do
      call sample_at(law, wet, high, y_end, k_end)
      sample%y(d5) = y_end
      sample%k(d5) = k_end
      curve%coef(row_y:row_y+d5, i) = fit(matrix, sample%y)
      curve%coef(row_k:row_k+d5, i) = fit(matrix, sample%k)
    end do
  end subroutine build_cells

  !> Coefficients of the polynomial through samples, from differences to the first one so that
  !! small variations keep their relative accuracy.
  pure function fit(matrix, samples) result(c)
    real(dp), intent(in) :: matrix(0:d5, 0:d5) !! monomial coefficients of Lagrange polynomials
    real(dp), intent(in) :: samples(0:d5)
    real(dp) :: c(0:d5), change(0:d5)

    change = samples - samples(0)
    c = matmul(matrix, change)
    c(0) = c(0) + samples(0)
  end function fit

  !> Y (base S_max if wet, else S_res) and k_r with its floor.
  pure subroutine sample_at(law, wet, suction, y, k)
    type(retention_law_t), intent(in) :: law
    logical, intent(in) :: wet
    real(dp), intent(in) :: suction !! [Pa]
    real(dp), intent(out) :: y, k
    real(dp) :: part, range

    range = law%saturation_maximum - law%saturation_residual
    part = tail(law, suction)/tail(law, suction_greatest)
    if (wet) then
      y = range*((1.0_dp - tail_fraction)*retention_deficit(law, suction) + tail_fraction*part)
    else
      y = -range*((1.0_dp - tail_fraction)*retention_saturation(law, suction) &
        + tail_fraction*(1.0_dp - part))
    end if
    k = law%conductivity_minimum + (1.0_dp - law%conductivity_minimum)* &
      permeability_relative(law, suction)
  end subroutine sample_at

  !> T(s) of the tail.
  pure real(dp) function tail(law, suction)
    type(retention_law_t), intent(in) :: law
    real(dp), intent(in) :: suction !! [Pa]

    tail = min(suction, law%entry)/law%scale
    if (suction > law%entry) tail = tail + log1p((suction - law%entry)/law%scale)
  end function tail

  !> x at the dry edge of cell i: cells of an octave are even.
  pure real(dp) function cell_edge(i, bits) result(x)
    integer, intent(in) :: i, bits

    x = 2.0_dp**(i/2**bits)*(1.0_dp + real(mod(i, 2**bits), dp)/real(2**bits, dp))
  end function cell_edge

  !> Error of the table between its points, and whether it is monotone; with `repair` a cell
  !! that is not becomes linear (only tables of a user that jump need it).
  subroutine measure_cells(law, curve, repair, error, monotone)
    type(retention_law_t), intent(in) :: law
    type(water_curve_t), intent(inout) :: curve
    logical, intent(in) :: repair
    real(dp), intent(out) :: error
    logical, intent(out) :: monotone
    integer, parameter :: points = 4
    real(dp), parameter :: powers(0:d5) = [0.0_dp, 1.0_dp, 2.0_dp, 3.0_dp, 4.0_dp, 5.0_dp]
    real(dp) :: v, basis(0:d5), slope(0:d5), y, k, y_law, k_law, least, c(0:d5)
    integer :: i, j
    logical :: y_falls, k_rises

    error = 0.0_dp
    monotone = .true.
    least = tail_fraction*(curve%maximum - curve%residual)
    if (law%law == law_table) least = curve%maximum - curve%residual
    do i = 1, curve%cells
      y_falls = .false.
      k_rises = .false.
      do j = -points, points
        v = real(j, dp)/real(points, dp)
        basis = [1.0_dp, v, v**2, v**3, v**4, v**5]
        slope = powers*[0.0_dp, basis(:d5-1)]
        y_falls = y_falls .or. dot_product(slope, curve%coef(row_y:row_y+d5, i)) <= 0.0_dp
        c = curve%coef(row_k:row_k+d5, i)
        k = dot_product(basis, c)
        k_rises = k_rises .or. dot_product(slope, c) > 1.0e-13_dp .or. k <= 0.0_dp
        y = dot_product(basis, curve%coef(row_y:row_y+d5, i))
        call sample_at(law, i <= curve%wet_cells, curve%coef(row_centre, i) &
          + v*curve%coef(row_half, i), y_law, k_law)
        error = max(error, abs(k - k_law)/k_law, abs(y - y_law)/max(least, &
          merge(curve%maximum - curve%residual, abs(y_law), i <= curve%wet_cells)))
      end do
      monotone = monotone .and. .not. (y_falls .or. k_rises)
      if (repair .and. y_falls) call make_linear(curve%coef(row_y:row_y+d5, i))
      if (repair .and. k_rises) call make_linear(curve%coef(row_k:row_k+d5, i))
    end do
  end subroutine measure_cells

  !> Replace a polynomial by the straight line between its ends.
  pure subroutine make_linear(c)
    real(dp), intent(inout) :: c(0:d5)

    c(0) = c(0) + c(2) + c(4)
    c(1) = c(1) + c(3) + c(5)
    c(2:) = 0.0_dp
  end subroutine make_linear

  !> Phi at the centre of every cell, from 0 at the driest suction.
  pure subroutine accumulate_potential(curve)
    type(water_curve_t), intent(inout) :: curve
    real(dp) :: k(0:d5), potential, even, odd
    integer :: i

    potential = 0.0_dp
    do i = curve%cells, 1, -1
      k = curve%coef(row_k:row_k+d5, i)
      even = k(0) + k(2)/3.0_dp + k(4)/5.0_dp
      odd = k(1)/2.0_dp + k(3)/4.0_dp + k(5)/6.0_dp
      curve%coef(row_potential, i) = potential + curve%coef(row_half, i)*(even + odd)
      potential = potential + 2.0_dp*curve%coef(row_half, i)*even
    end do
    curve%potential_entry = potential
  end subroutine accumulate_potential

  !> First guess of the inverse in every cell: v(t) through the Lobatto points.
  pure subroutine build_inverse(curve)
    type(water_curve_t), intent(inout) :: curve
    real(dp) :: v(0:d5), y(0:d5), t(0:d5), c(0:d5), matrix(0:d5, 0:d5)
    integer :: i, j

    allocate (curve%inverse(inverse_rows, curve%cells))
    v = lobatto_points()
    do i = 1, curve%cells
      c = curve%coef(row_y:row_y+d5, i)
      y = [(c(1)*(v(j) + 1.0_dp) + c(2)*(v(j)**2 - 1.0_dp) + c(3)*(v(j)**3 + 1.0_dp) &
        + c(4)*(v(j)**4 - 1.0_dp) + c(5)*(v(j)**5 + 1.0_dp), j=0, d5)]
      t = y/y(d5)
      curve%inverse(row_edge, i) = c(0) - c(1) + c(2) - c(3) + c(4) - c(5)
      curve%inverse(row_scale, i) = 1.0_dp/y(d5)
      if (all(t(1:) - t(:d5-1) > 1.0e-3_dp)) then
        matrix = monomial_matrix(t)
        curve%inverse(row_v:, i) = matmul(matrix, v)
      else
        curve%inverse(row_v:, i) = [-1.0_dp, 2.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp]
      end if
    end do
    curve%inverse(row_edge, 1) = curve%entry_slope*curve%entry
  end subroutine build_inverse

  !> Guides from the leading bits of S_max - S_r (wet) and S_r - S_res (dry) to a cell.
  pure subroutine build_guides(curve)
    type(water_curve_t), intent(inout) :: curve
    integer, parameter :: shift = mantissa_bits - guide_bits
    real(dp) :: range, bound
    integer(i8) :: last
    integer :: b, i, n

    range = curve%maximum - curve%residual
    i = curve%wet_cells
    curve%wet_limit = sum(curve%coef(row_y:row_y+d5, max(i, 1)))
    if (i == 0) curve%wet_limit = 0.0_dp
    curve%wet_bits = curve_bits(max(curve%inverse(row_edge, 1), 1.0e-17_dp), shift) - 1_i8
    last = curve_bits(max(curve%wet_limit, 1.0e-16_dp), shift)
    n = int(last - curve%wet_bits)
    allocate (curve%guide_wet(n+1))
    i = 1
    do b = 1, n
      bound = bits_value(curve%wet_bits + int(b, i8), shift)
      do while (i < curve%wet_cells)
        if (curve%inverse(row_edge, i+1) > bound) exit
        i = i + 1
      end do
      curve%guide_wet(b) = int(i, i4)
    end do
    curve%guide_wet(1) = 1_i4
    curve%guide_wet(n+1) = int(max(1, curve%wet_cells), i4)
    curve%dry_bits = curve_bits(1.0e-3_dp*tail_fraction*range, shift) - 1_i8
    last = curve_bits(range, shift)
    n = int(last - curve%dry_bits)
    allocate (curve%guide_dry(n+1))
    i = curve%cells
    do b = 1, n
      bound = bits_value(curve%dry_bits + int(b, i8), shift)
      do while (i > curve%wet_cells + 1)
        if (curve%inverse(row_edge, i) <= -bound) exit
        i = i - 1
      end do
      curve%guide_dry(b) = int(i, i4)
    end do
    curve%guide_dry(1) = int(curve%cells, i4)
    curve%guide_dry(n+1) = int(min(curve%wet_cells + 1, curve%cells), i4)
  end subroutine build_guides

  !> Least number with given leading bits: the inverse of `curve_bits`.
  pure real(dp) function bits_value(bits, shift) result(x)
    integer(i8), intent(in) :: bits
    integer, intent(in) :: shift

    x = transfer(ishft(bits, shift), 0.0_dp)
  end function bits_value

  !> The six Chebyshev-Lobatto points in -1..1.
  pure function lobatto_points() result(v)
    real(dp) :: v(0:d5)
    real(dp), parameter :: outer = 0.8090169943749475_dp, inner = 0.3090169943749474_dp

    v = [-1.0_dp, -outer, -inner, inner, outer, 1.0_dp]
  end function lobatto_points

  !> Column j: monomial coefficients of the Lagrange polynomial that is 1 at x(j).
  pure function monomial_matrix(x) result(matrix)
    real(dp), intent(in) :: x(0:) !! six distinct points
    real(dp) :: matrix(0:d5, 0:d5), c(0:d5)
    integer :: i, j

    do j = 0, d5
      c = 0.0_dp
      c(0) = 1.0_dp
      do i = 0, d5
        if (i == j) cycle
        c = ([0.0_dp, c(:d5-1)] - x(i)*c)/(x(j) - x(i))
      end do
      matrix(:, j) = c
    end do
  end function monomial_matrix
end module talus_water_curve_make
