! SPDX-License-Identifier: MIT
!> Water retention laws of one soil: effective saturation as a function of suction.
!!
!! src/THEORY.md section 3.6. Suction s = -p_w [Pa] >= 0; effective saturation S_e in 0..1;
!! S_r = S_res + (S_max - S_res) S_e. The parameters are those of a deck (heads in metres);
!! `retention_prepare` checks them and turns them into a `retention_law_t` in pascal.
!! The laws are exact and slow: loops over nodes use the tables of `talus_water_curve`.
!!
!! Air entry. Above an entry suction s_e, S_e = f(s)/f(s_e) and k_r = g(s)/g(s_e); below it both
!! are 1 (Vogel, van Genuchten & Cislerova 2000; Ippisch, Vogel & Bastian 2006). It bounds
!! dk_r/ds, which for a van Genuchten soil with n < 2 is infinite at saturation. Where it is not
!! given it is 0.02 m for van Genuchten with n < 2 and for Fredlund-Xing with fx_n <= 1, else 0.
module talus_retention
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_set, status_deck, status_failed
  use talus_text, only: text_of
  use talus_special, only: log1p, expm1
  use talus_fredlund_xing, only: fredlund_xing_t, fredlund_xing_make, fredlund_xing_saturation
  use talus_retention_table, only: retention_table_t, retention_table_check, &
    retention_table_saturation
  implicit none
  private
  public :: retention_t, retention_law_t, retention_prepare
  public :: retention_saturation, retention_deficit

  !> Names a deck may use for a law, separated by `|`.
  character(*), parameter, public :: retention_choices = &
    'van_genuchten|gardner|brooks_corey|fredlund_xing|table|broadbridge_white'
  !> Numbers of the laws, in the order of `retention_choices`.
  integer, parameter, public :: law_van_genuchten = 1, law_gardner = 2, law_brooks_corey = 3, &
    law_fredlund_xing = 4, law_table = 5, law_broadbridge_white = 6
  !> Greatest suction of every law [Pa]: oven-dry soil (Fredlund & Xing 1994).
  real(dp), parameter, public :: suction_greatest = 1.0e9_dp
  !> Air-entry head where a law needs one, and the least [m].
  real(dp), parameter :: entry_automatic = 0.02_dp, entry_least = 1.0e-4_dp

  !> Parameters of a retention law, as a deck gives them.
  type :: retention_t
    character(20) :: law = 'van_genuchten'   !! one of `retention_choices`
    real(dp) :: unit_weight = 9810.0_dp      !! of water [N/m3]
    real(dp) :: saturation_residual = 0.0_dp !! S_res [-]; a table brings its own
    real(dp) :: saturation_maximum = 1.0_dp  !! S_max [-]; a table brings its own
    real(dp) :: alpha = 0.0_dp               !! van Genuchten, Gardner; 1/lambda_c [1/m]
    real(dp) :: n = 0.0_dp                   !! van Genuchten exponent, > 1; m = 1 - 1/n
    real(dp) :: pore_connectivity = 0.5_dp   !! Mualem's l; Brooks-Corey: 1 gives Burdine's model
    real(dp) :: air_entry = 0.0_dp           !! Brooks-Corey entry head [m]
    real(dp) :: lambda = 0.0_dp              !! Brooks-Corey pore-size index
    real(dp) :: fx_a = 0.0_dp                !! Fredlund-Xing a [m]
    real(dp) :: fx_n = 0.0_dp                !! Fredlund-Xing n
    real(dp) :: fx_m = 0.0_dp                !! Fredlund-Xing m
    real(dp) :: fx_residual_suction = 0.0_dp !! Fredlund-Xing residual suction head [m]
    real(dp) :: c_parameter = 0.0_dp         !! Broadbridge-White C, > 1
    real(dp) :: air_entry_cut = -1.0_dp      !! entry head [m]; negative or NaN: automatic
    real(dp) :: relative_conductivity_minimum = 1.0e-12_dp !! floor of k_r
    type(retention_table_t) :: table         !! points of law 'table'
  end type retention_t

  !> A checked law in pascal.
  type :: retention_law_t
    integer :: law = 0                  !! one of law_*
    real(dp) :: alpha = 0.0_dp          !! [1/Pa]
    real(dp) :: n = 0.0_dp, m = 0.0_dp  !! van Genuchten exponents
    real(dp) :: l = 0.5_dp              !! pore connectivity
    real(dp) :: lambda = 0.0_dp         !! Brooks-Corey index
    real(dp) :: c = 0.0_dp              !! Broadbridge-White C
    real(dp) :: entry = 0.0_dp          !! suction below which the soil is saturated [Pa]
    real(dp) :: scale = 1.0_dp          !! suction over which the law varies [Pa]
    real(dp) :: saturation_residual = 0.0_dp
    real(dp) :: saturation_maximum = 1.0_dp
    real(dp) :: conductivity_minimum = 0.0_dp
    type(fredlund_xing_t) :: fx         !! tabulated integrals of Fredlund-Xing
    type(retention_table_t) :: table
  end type retention_law_t

contains

  !> Check the parameters of a law and convert them to pascal.
  subroutine retention_prepare(retention, law, status)
    type(retention_t), intent(in) :: retention  !! as in a deck
    type(retention_law_t), intent(out) :: law   !! ready to evaluate
    type(status_t), intent(inout) :: status
    real(dp) :: weight

    weight = retention%unit_weight
    call require_range('water_unit_weight', weight, 1.0_dp, 1.0e6_dp, 'N/m3', status)
    law%l = retention%pore_connectivity
    law%conductivity_minimum = retention%relative_conductivity_minimum
    call require_range('relative_conductivity_minimum', law%conductivity_minimum, 1.0e-20_dp, &
      0.1_dp, '', status)
    law%saturation_residual = retention%saturation_residual
    law%saturation_maximum = retention%saturation_maximum
    select case (retention%law)
    case ('van_genuchten')
      law%law = law_van_genuchten
      call prepare_van_genuchten(retention, law, status)
    case ('gardner')
      law%law = law_gardner
      call prepare_alpha(retention, law, status)
      law%entry = entry_head(retention, .false.)*weight
    case ('brooks_corey')
      law%law = law_brooks_corey
      call prepare_brooks_corey(retention, law, status)
    case ('fredlund_xing')
      law%law = law_fredlund_xing
      call prepare_fredlund_xing(retention, law, status)
    case ('table')
      law%law = law_table
      call prepare_table(retention, law, status)
    case ('broadbridge_white')
      law%law = law_broadbridge_white
      call prepare_alpha(retention, law, status)
      law%c = retention%c_parameter
      call require_range('c_parameter', law%c, 1.001_dp, 1.0e3_dp, '', status)
    case default
      call status_set(status, status_deck, 'water: retention = '''//trim(retention%law)// &
        ''' is not known; allowed: '//retention_choices)
    end select
    if (status_failed(status)) return
    call require_range('saturation_maximum', law%saturation_maximum, 0.01_dp, 1.0_dp, '', status)
    call require_range('saturation_residual', law%saturation_residual, 0.0_dp, &
      law%saturation_maximum - 1.0e-3_dp, '(below saturation_maximum)', status)
    call require_range('air_entry', law%entry/weight, 0.0_dp, 0.01_dp*suction_greatest/weight, &
      'm', status)
  end subroutine retention_prepare

  subroutine prepare_alpha(retention, law, status)
    type(retention_t), intent(in) :: retention
    type(retention_law_t), intent(inout) :: law
    type(status_t), intent(inout) :: status

    call require_range('alpha', retention%alpha, 1.0e-4_dp, 1.0e4_dp, '1/m', status)
    if (status_failed(status)) return
    law%alpha = retention%alpha/retention%unit_weight
    law%scale = 1.0_dp/law%alpha
  end subroutine prepare_alpha

  subroutine prepare_van_genuchten(retention, law, status)
    type(retention_t), intent(in) :: retention
    type(retention_law_t), intent(inout) :: law
    type(status_t), intent(inout) :: status
    real(dp) :: cut

    call prepare_alpha(retention, law, status)
    law%n = retention%n
    call require_range('n', law%n, 1.001_dp, 20.0_dp, '', status)
    call require_range('pore_connectivity', law%l, -1.0_dp, 10.0_dp, '', status)
    if (status_failed(status)) return
    law%m = 1.0_dp - 1.0_dp/law%n
    cut = entry_head(retention, law%n < 2.0_dp)
    if (law%n < 2.0_dp) call require_range('air_entry_cut', cut, entry_least, 10.0_dp, &
      'm where n < 2 (dk_r/ds is unbounded at saturation otherwise)', status)
    law%entry = cut*retention%unit_weight
  end subroutine prepare_van_genuchten

  subroutine prepare_brooks_corey(retention, law, status)
    type(retention_t), intent(in) :: retention
    type(retention_law_t), intent(inout) :: law
    type(status_t), intent(inout) :: status

    law%lambda = retention%lambda
    call require_range('lambda', law%lambda, 0.01_dp, 20.0_dp, '', status)
    call require_range('air_entry', retention%air_entry, 1.0e-4_dp, 1.0e3_dp, 'm', status)
    call require_range('pore_connectivity', law%l, -1.0_dp, 10.0_dp, '', status)
    law%entry = retention%air_entry*retention%unit_weight
    law%scale = law%entry
  end subroutine prepare_brooks_corey

  subroutine prepare_fredlund_xing(retention, law, status)
    type(retention_t), intent(in) :: retention
    type(retention_law_t), intent(inout) :: law
    type(status_t), intent(inout) :: status
    real(dp) :: cut

    call require_range('fx_a', retention%fx_a, 1.0e-4_dp, 1.0e4_dp, 'm', status)
    call require_range('fx_n', retention%fx_n, 0.1_dp, 20.0_dp, '', status)
    call require_range('fx_m', retention%fx_m, 0.05_dp, 20.0_dp, '', status)
    call require_range('fx_residual_suction', retention%fx_residual_suction, 1.0e-3_dp, &
      1.0e5_dp, 'm', status)
    if (status_failed(status)) return
    cut = entry_head(retention, .true.)
    call require_range('air_entry_cut', cut, entry_least, 10.0_dp, &
      'm with fredlund_xing (k_r is measured from there)', status)
    law%entry = cut*retention%unit_weight
    law%scale = retention%fx_a*retention%unit_weight
    call fredlund_xing_make(law%scale, retention%fx_n, retention%fx_m, &
      retention%fx_residual_suction*retention%unit_weight, suction_greatest, law%fx)
  end subroutine prepare_fredlund_xing

  subroutine prepare_table(retention, law, status)
    type(retention_t), intent(in) :: retention
    type(retention_law_t), intent(inout) :: law
    type(status_t), intent(inout) :: status
    integer :: last

    call retention_table_check(retention%table, status)
    if (status_failed(status)) return
    law%table = retention%table
    last = size(law%table%suction)
    law%entry = law%table%suction(1)
    law%scale = law%table%suction(2) - law%table%suction(1)
    law%saturation_maximum = law%table%saturation(1)
    law%saturation_residual = law%table%saturation(last)
  end subroutine prepare_table

  !> Air-entry head [m]: as given, or automatic where it is negative or not a number.
  pure real(dp) function entry_head(retention, needed) result(head)
    type(retention_t), intent(in) :: retention
    logical, intent(in) :: needed !! the law needs an air entry

    head = merge(entry_automatic, 0.0_dp, needed)
    if (.not. ieee_is_finite(retention%air_entry_cut)) return
    if (retention%air_entry_cut >= 0.0_dp) head = retention%air_entry_cut
  end function entry_head

  !> Effective saturation [-] at a suction [Pa].
  pure real(dp) function retention_saturation(law, suction) result(effective)
    type(retention_law_t), intent(in) :: law
    real(dp), intent(in) :: suction !! s = -p_w [Pa]
    real(dp) :: z

    effective = 1.0_dp
    if (suction <= law%entry) return
    select case (law%law)
    case (law_van_genuchten)
      z = log1p((law%alpha*suction)**law%n) - log1p((law%alpha*law%entry)**law%n)
      effective = exp(-law%m*z)
    case (law_gardner)
      effective = exp(-law%alpha*(suction - law%entry))
    case (law_brooks_corey)
      effective = exp(-law%lambda*log(suction/law%entry))
    case (law_fredlund_xing)
      effective = fredlund_xing_saturation(law%fx, suction)/ &
        fredlund_xing_saturation(law%fx, law%entry)
    case (law_table)
      effective = retention_table_saturation(law%table, suction)
    case (law_broadbridge_white)
      effective = 1.0_dp/(1.0_dp + broadbridge_white_ratio(law, suction))
    end select
  end function retention_saturation

  !> Effective air content 1 - S_e [-], without cancellation near saturation where the law
  !! has a closed form.
  pure real(dp) function retention_deficit(law, suction) result(deficit)
    type(retention_law_t), intent(in) :: law
    real(dp), intent(in) :: suction !! s = -p_w [Pa]
    real(dp) :: z

    deficit = 0.0_dp
    if (suction <= law%entry) return
    select case (law%law)
    case (law_van_genuchten)
      z = log1p((law%alpha*suction)**law%n) - log1p((law%alpha*law%entry)**law%n)
      deficit = -expm1(-law%m*z)
    case (law_gardner)
      deficit = -expm1(-law%alpha*(suction - law%entry))
    case (law_brooks_corey)
      deficit = -expm1(-law%lambda*log1p((suction - law%entry)/law%entry))
    case (law_broadbridge_white)
      z = broadbridge_white_ratio(law, suction)
      deficit = z/(1.0_dp + z)
    case default
      deficit = 1.0_dp - retention_saturation(law, suction)
    end select
  end function retention_deficit

  !> r = (1 - Theta)/Theta of the Broadbridge-White soil (White & Broadbridge 1988), the root of
  !! alpha s = r + log(1 + C r/(C - 1))/C. The right side is concave: Newton's method from
  !! below converges monotonically.
  pure real(dp) function broadbridge_white_ratio(law, suction) result(r)
    type(retention_law_t), intent(in) :: law
    real(dp), intent(in) :: suction !! [Pa]
    real(dp) :: q, change
    integer :: i

    q = law%c/(law%c - 1.0_dp)
    r = law%alpha*suction/q
    do i = 1, 60
      change = (law%alpha*suction - r - log1p(q*r)/law%c)/(1.0_dp + q/(law%c*(1.0_dp + q*r)))
      r = r + change
      if (abs(change) <= 1.0e-15_dp*r) exit
    end do
  end function broadbridge_white_ratio

  !> Record a parameter that is out of its range, or not a number.
  subroutine require_range(key, value, low, high, unit, status)
    character(*), intent(in) :: key  !! deck key of group water
    real(dp), intent(in) :: value
    real(dp), intent(in) :: low, high !! both allowed
    character(*), intent(in) :: unit !! unit and remark, may be empty
    type(status_t), intent(inout) :: status
    logical :: inside

    inside = ieee_is_finite(value)
    if (inside) inside = value >= low .and. value <= high
    if (.not. inside) call status_set(status, status_deck, trim('water: '//key//' = '// &
      text_of(value)//' is not allowed; allowed: '//text_of(low)//' to '//text_of(high)//' '//unit))
  end subroutine require_range
end module talus_retention
