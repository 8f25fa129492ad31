! SPDX-License-Identifier: MIT
!> Relative conductivity of unsaturated soil, and the effect of porosity on permeability.
!!
!! src/THEORY.md section 3.6. With the effective saturation S_e of `talus_retention`:
!!   van Genuchten-Mualem: k_r = S_e^l (1 - (1 - S_e^(1/m))^m)^2, m = 1 - 1/n (Mualem 1976);
!!   Gardner (1958): k_r = exp(-alpha s);
!!   Brooks & Corey with Mualem: k_r = S_e^(2 + l + 2/lambda); l = 1 is Burdine's 3 + 2/lambda;
!!   Fredlund, Xing & Huang (1994): the integral in `talus_fredlund_xing`;
!!   Broadbridge & White (1988): k_r = (C - 1) S_e^2/(C - S_e).
!! With an air entry every law is divided by its value there (Ippisch et al. 2006).
module talus_permeability
  use talus_kinds, only: dp
  use talus_special, only: log1p, expm1
  use talus_retention, only: retention_law_t, retention_saturation, law_van_genuchten, &
    law_gardner, law_brooks_corey, law_fredlund_xing, law_table, law_broadbridge_white
  use talus_fredlund_xing, only: fredlund_xing_integral
  use talus_retention_table, only: retention_table_conductivity
  implicit none
  private
  public :: permeability_relative, permeability_kozeny_carman

contains

  !> Relative conductivity k_r [-] of a law at a suction, without the floor.
  pure real(dp) function permeability_relative(law, suction) result(ratio)
    type(retention_law_t), intent(in) :: law
    real(dp), intent(in) :: suction !! s = -p_w [Pa]
    real(dp) :: effective

    ratio = 1.0_dp
    if (suction <= law%entry) return
    select case (law%law)
    case (law_van_genuchten)
      ratio = retention_saturation(law, suction)**law%l* &
        (mualem(law, suction)/mualem(law, law%entry))**2
    case (law_gardner)
      ratio = exp(-law%alpha*(suction - law%entry))
    case (law_brooks_corey)
      ratio = exp(-(law%lambda*(2.0_dp + law%l) + 2.0_dp)*log(suction/law%entry))
    case (law_fredlund_xing)
      ratio = fredlund_xing_integral(law%fx, suction)/fredlund_xing_integral(law%fx, law%entry)
    case (law_table)
      ratio = retention_table_conductivity(law%table, suction)
    case (law_broadbridge_white)
      effective = retention_saturation(law, suction)
      ratio = (law%c - 1.0_dp)*effective**2/(law%c - effective)
    end select
  end function permeability_relative

  !> Mualem's factor 1 - (1 - S^(1/m))^m = 1 - (z/(1 + z))^m, z = (alpha s)^n, accurate for
  !! small and large z.
  pure real(dp) function mualem(law, suction)
    type(retention_law_t), intent(in) :: law
    real(dp), intent(in) :: suction !! [Pa]
    real(dp) :: z

    z = (law%alpha*suction)**law%n
    mualem = 1.0_dp
    if (z > 1.0e-300_dp) mualem = -expm1(-law%m*log1p(1.0_dp/z))
  end function mualem

  !> Factor on the saturated conductivity when porosity changes from `porosity_0`
  !! (Kozeny 1927, Carman 1937): n^3/(1 - n)^2 over its reference value.
  elemental real(dp) function permeability_kozeny_carman(porosity, porosity_0) result(factor)
    real(dp), intent(in) :: porosity   !! n [-], 0 < n < 1
    real(dp), intent(in) :: porosity_0 !! reference [-], 0 < n < 1

    factor = (porosity/porosity_0)**3*((1.0_dp - porosity_0)/(1.0_dp - porosity))**2
  end function permeability_kozeny_carman
end module talus_permeability
