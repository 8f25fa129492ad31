! SPDX-License-Identifier: MIT
!> A user's retention table: suction, saturation, relative conductivity.
!!
!! Between points: monotone cubics (Fritsch & Carlson 1980) of the effective saturation and of
!! log k_r over xi = log(1 + (s - s_1)/(s_2 - s_1)), which suits both even and logarithmic
!! spacing. Beyond the last point both stay constant; below the first the soil is saturated.
module talus_retention_table
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_set, status_deck, status_failed
  use talus_table_csv, only: table_csv_t, table_csv_status
  use talus_deck_csv, only: retention_read, retention_check
  use talus_special, only: log1p
  implicit none
  private
  public :: retention_table_t, retention_table_read, retention_table_make, retention_table_check
  public :: retention_table_saturation, retention_table_conductivity

  type :: retention_table_t
    real(dp), allocatable :: suction(:)            !! [Pa], increasing
    real(dp), allocatable :: saturation(:)         !! S_r [-], not increasing
    real(dp), allocatable :: conductivity(:)       !! k_r [-], not increasing, first 1
    real(dp), allocatable, private :: xi(:)
    real(dp), allocatable, private :: effective(:)
    real(dp), allocatable, private :: log_k(:)
    real(dp), allocatable, private :: effective_slope(:), log_k_slope(:)
  end type retention_table_t

contains

  !> Read a CSV file with the header suction_Pa,saturation,relative_conductivity.
  subroutine retention_table_read(path, table, status)
    character(*), intent(in) :: path
    type(retention_table_t), intent(out) :: table
    type(status_t), intent(inout) :: status
    type(table_csv_t) :: points

    call retention_read(path, points)
    call table_csv_status(points, status)
    if (points%faults > 0) return
    call retention_table_make(points%values(1, :), points%values(2, :), points%values(3, :), &
                              table, status)
  end subroutine retention_table_read

  !> A table from its points.
  subroutine retention_table_make(suction, saturation, conductivity, table, status)
    real(dp), intent(in) :: suction(:)      !! [Pa], >= 0, increasing
    real(dp), intent(in) :: saturation(:)   !! S_r [-], not increasing
    real(dp), intent(in) :: conductivity(:) !! k_r [-], > 0, not increasing, first 1
    type(retention_table_t), intent(out) :: table
    type(status_t), intent(inout) :: status
    integer :: i, last

    table%suction = suction
    table%saturation = saturation
    table%conductivity = conductivity
    call retention_table_check(table, status)
    if (status_failed(status)) return
    last = size(suction)
    allocate (table%xi(last))
    do i = 1, last
      table%xi(i) = log1p((suction(i) - suction(1))/(suction(2) - suction(1)))
    end do
    table%effective = (saturation - saturation(last))/(saturation(1) - saturation(last))
    table%log_k = log(conductivity)
    table%effective_slope = monotone_slopes(table%xi, table%effective)
    table%log_k_slope = monotone_slopes(table%xi, table%log_k)
  end subroutine retention_table_make

  !> Refuse a table that is missing, too short, or not monotone.
  subroutine retention_table_check(table, status)
    type(retention_table_t), intent(in) :: table
    type(status_t), intent(inout) :: status
    type(table_csv_t) :: points
    integer :: i

    if (.not. allocated(table%suction)) then
      call status_set(status, status_deck, 'water: retention = ''table'' needs the points of '// &
        'a table: give file, a CSV with suction_Pa,saturation,relative_conductivity')
      return
    end if
    points%place = 'retention table, point '
    allocate (points%values(3, size(table%suction)))
    points%values(1, :) = table%suction
    points%values(2, :) = table%saturation
    points%values(3, :) = table%conductivity
    points%lines = [(i, i=1, size(table%suction))]
    call retention_check(points)
    call table_csv_status(points, status)
  end subroutine retention_table_check

  !> Effective saturation, 1 at the first point and 0 from the last.
  pure real(dp) function retention_table_saturation(table, suction) result(effective)
    type(retention_table_t), intent(in) :: table
    real(dp), intent(in) :: suction !! [Pa]

    effective = cubic_at(table%xi, table%effective, table%effective_slope, xi_of(table, suction))
  end function retention_table_saturation

  !> Relative conductivity.
  pure real(dp) function retention_table_conductivity(table, suction) result(ratio)
    type(retention_table_t), intent(in) :: table
    real(dp), intent(in) :: suction !! [Pa]

    ratio = exp(cubic_at(table%xi, table%log_k, table%log_k_slope, xi_of(table, suction)))
  end function retention_table_conductivity

  pure real(dp) function xi_of(table, suction) result(xi)
    type(retention_table_t), intent(in) :: table
    real(dp), intent(in) :: suction

    xi = log1p(max(0.0_dp, suction - table%suction(1))/(table%suction(2) - table%suction(1)))
  end function xi_of

  !> Slopes of a monotone cubic: the harmonic mean of Fritsch & Butland (1984), which satisfies
  !! the condition of Fritsch & Carlson (1980); one-sided at the ends, limited likewise.
  pure function monotone_slopes(x, f) result(slope)
    real(dp), intent(in) :: x(:) !! increasing
    real(dp), intent(in) :: f(:) !! monotone
    real(dp) :: slope(size(x))
    real(dp) :: h(size(x)-1), secant(size(x)-1), w1, w2
    integer :: i, last

    last = size(x)
    h = x(2:) - x(:last-1)
    secant = (f(2:) - f(:last-1))/h
    if (last == 2) then
      slope = secant(1)
      return
    end if
    do i = 2, last - 1
      slope(i) = 0.0_dp
      if (secant(i-1)*secant(i) > 0.0_dp) then
        w1 = 2.0_dp*h(i) + h(i-1)
        w2 = h(i) + 2.0_dp*h(i-1)
        slope(i) = (w1 + w2)/(w1/secant(i-1) + w2/secant(i))
      end if
    end do
    slope(1) = end_slope(h(1), h(2), secant(1), secant(2))
    slope(last) = end_slope(h(last-1), h(last-2), secant(last-1), secant(last-2))
  end function monotone_slopes

  !> Three-point slope at an end, kept between 0 and 3 secants.
  pure real(dp) function end_slope(h1, h2, secant1, secant2) result(slope)
    real(dp), intent(in) :: h1, h2           !! widths, the end interval first
    real(dp), intent(in) :: secant1, secant2

    slope = ((2.0_dp*h1 + h2)*secant1 - h1*secant2)/(h1 + h2)
    if (slope*secant1 <= 0.0_dp) then
      slope = 0.0_dp
    else if (abs(slope) > 3.0_dp*abs(secant1)) then
      slope = 3.0_dp*secant1
    end if
  end function end_slope

  !> Cubic Hermite interpolation, constant outside.
  pure real(dp) function cubic_at(x, f, slope, at) result(value)
    real(dp), intent(in) :: x(:), f(:), slope(:)
    real(dp), intent(in) :: at
    real(dp) :: h, t
    integer :: low, high, middle

    low = 1
    high = size(x)
    if (at >= x(high)) then
      value = f(high)
      return
    end if
    do while (high - low > 1)
      middle = (low + high)/2
      if (at >= x(middle)) then
        low = middle
      else
        high = middle
      end if
    end do
    h = x(high) - x(low)
    t = max(0.0_dp, (at - x(low))/h)
    value = f(low) + t*h*slope(low) + t*t*((3.0_dp - 2.0_dp*t)*(f(high) - f(low)) &
      - h*((2.0_dp - t)*slope(low) + (1.0_dp - t)*slope(high)))
  end function cubic_at
end module talus_retention_table
