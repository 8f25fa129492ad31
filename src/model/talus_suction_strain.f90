! SPDX-License-Identifier: MIT
!> Swelling and shrinkage under changes of suction in net stress.
!!
!! d(eps_s) = -ds/D_s on each normal component, so wetting swells (src/THEORY.md (3.9);
!! Alonso, Gens & Josa 1990). Only suction, the positive part of s, acts.
module talus_suction_strain
  use talus_kinds, only: dp
  use talus_const, only: p_atmospheric
  use talus_status, only: status_t, status_set, status_deck
  implicit none
  private
  public :: suction_strain_t, suction_strain_prepare, suction_strain_increment

  integer, parameter, public :: suction_strain_none = 0, suction_strain_constant = 1, &
    suction_strain_alonso = 2

  type :: suction_strain_t
    integer :: kind = suction_strain_none !! one of suction_strain_*
    real(dp) :: modulus = 0.0_dp          !! D_s [Pa], for `constant`
    real(dp) :: kappa_s = 0.0_dp          !! [-], for `alonso`
    real(dp) :: porosity = 0.0_dp         !! initial porosity [-], for `alonso`
  end type suction_strain_t

contains

  !> Check the parameters.
  pure subroutine suction_strain_prepare(law, status)
    type(suction_strain_t), intent(in) :: law
    type(status_t), intent(inout) :: status !! status_deck when out of range

    if (law%kind == suction_strain_constant .and. .not. law%modulus > 0.0_dp) then
      call status_set(status, status_deck, 'suction_strain = constant needs suction_modulus > 0')
    else if (law%kind == suction_strain_alonso) then
      if (.not. law%kappa_s > 0.0_dp) &
        call status_set(status, status_deck, 'suction_strain = alonso needs kappa_s > 0')
      if (.not. (law%porosity >= 0.0_dp .and. law%porosity < 1.0_dp)) &
        call status_set(status, status_deck, 'suction_strain = alonso needs porosity in [0, 1)')
    end if
  end subroutine suction_strain_prepare

  !> Increment of eps_s over a step. Alonso's D_s = 3 (1+e)(s + p_at)/kappa_s is taken at the
  !! mean suction, which integrates it to second order; 1 + e = J/(1 - n0).
  pure real(dp) function suction_strain_increment(law, suction_old, suction_new, det_f)
    type(suction_strain_t), intent(in) :: law
    real(dp), intent(in) :: suction_old !! suction before the step [Pa]
    real(dp), intent(in) :: suction_new !! suction after the step [Pa]
    real(dp), intent(in) :: det_f       !! J [-]
    real(dp) :: old, new

    old = max(0.0_dp, suction_old)
    new = max(0.0_dp, suction_new)
    select case (law%kind)
    case (suction_strain_constant)
      suction_strain_increment = -(new - old)/law%modulus
    case (suction_strain_alonso)
      suction_strain_increment = -(new - old)*law%kappa_s*(1.0_dp - law%porosity) &
        /(3.0_dp*det_f*(0.5_dp*(old + new) + p_atmospheric))
    case default
      suction_strain_increment = 0.0_dp
    end select
  end function suction_strain_increment
end module talus_suction_strain
