! SPDX-License-Identifier: MIT
!> Drucker-Prager cone with non-associated flow, apex and tension cut-off.
!!
!! f = sqrt(J2) + alpha I1 - k, flow potential sqrt(J2) + alpha_psi I1 (src/THEORY.md (3.4)-(3.7);
!! Drucker & Prager 1952). The plastic strain measure is sqrt(2/3 e_p : e_p) of the deviatoric
!! plastic strain e_p: a return that only changes the mean stress adds nothing to it.
module talus_drucker_prager
  use talus_kinds, only: dp
  implicit none
  private
  public :: cone_t, cone_shape, cone_set, drucker_prager_return, drucker_prager_within
  public :: secant_shear_ratio

  !> Fits of the cone to the Mohr-Coulomb pyramid.
  integer, parameter, public :: fit_plane_strain = 1, fit_compression = 2, fit_extension = 3

  !> The cone at one point and time.
  type :: cone_t
    real(dp) :: alpha = 0.0_dp      !! slope [-]
    real(dp) :: alpha_psi = 0.0_dp  !! slope of the flow potential [-]
    real(dp) :: k = 0.0_dp          !! sqrt(J2) at I1 = 0 [Pa]
    real(dp) :: i1_max = 0.0_dp     !! largest I1: the apex, or the cut-off below it [Pa]
  end type cone_t

  real(dp), parameter :: sqrt3 = 1.7320508075688772_dp
  real(dp), parameter :: third = 1.0_dp/3.0_dp

contains

  !> Slopes of the cone and its k per unit cohesion from the Mohr-Coulomb angles.
  pure subroutine cone_shape(fit, sin_phi, cos_phi, sin_psi, alpha, alpha_psi, k_over_c)
    integer, intent(in) :: fit            !! one of fit_*
    real(dp), intent(in) :: sin_phi       !! sine of the friction angle [-]
    real(dp), intent(in) :: cos_phi       !! its cosine [-]
    real(dp), intent(in) :: sin_psi       !! sine of the dilation angle [-]
    real(dp), intent(out) :: alpha        !! slope of the cone [-]
    real(dp), intent(out) :: alpha_psi    !! slope of the flow potential [-]
    real(dp), intent(out) :: k_over_c     !! k/c [-]
    real(dp) :: root, across

    select case (fit)
    case (fit_plane_strain)
      alpha_psi = sin_psi/sqrt(9.0_dp + 3.0_dp*sin_psi*sin_psi)
      root = sqrt(1.0_dp - 3.0_dp*alpha_psi*alpha_psi)
      alpha = sin_phi/(3.0_dp*(root + alpha_psi*sin_phi))
      k_over_c = cos_phi*(1.0_dp - 3.0_dp*alpha*alpha_psi)/root
    case (fit_compression)
      alpha_psi = 2.0_dp*sin_psi/(sqrt3*(3.0_dp - sin_psi))
      across = 1.0_dp/(sqrt3*(3.0_dp - sin_phi))
      alpha = 2.0_dp*sin_phi*across
      k_over_c = 6.0_dp*cos_phi*across
    case default
      alpha_psi = 2.0_dp*sin_psi/(sqrt3*(3.0_dp + sin_psi))
      across = 1.0_dp/(sqrt3*(3.0_dp + sin_phi))
      alpha = 2.0_dp*sin_phi*across
      k_over_c = 6.0_dp*cos_phi*across
    end select
  end subroutine cone_shape

  !> Complete a cone whose slopes are known with its k and the limit of I1.
  pure subroutine cone_set(cone, k, tension_cutoff)
    type(cone_t), intent(inout) :: cone
    real(dp), intent(in) :: k              !! sqrt(J2) at I1 = 0 [Pa], >= 0
    real(dp), intent(in) :: tension_cutoff !! largest mean stress [Pa]; negative = none
    real(dp), parameter :: nearly_flat = 1.0e-30_dp !! keeps the apex of a cylinder finite

    cone%k = k
    cone%i1_max = k/max(cone%alpha, nearly_flat)
    if (tension_cutoff >= 0.0_dp) cone%i1_max = min(cone%i1_max, 3.0_dp*tension_cutoff)
  end subroutine cone_set

  !> Return a trial stress to the cone.
  !!
  !! Smooth part: dlambda = f/(G + 9 K alpha alpha_psi). When that leaves I1 above i1_max, the
  !! stress lies on the plane I1 = i1_max, with sqrt(J2) kept or reduced to the edge where cone
  !! and plane meet. Without cut-off the edge is the apex, for any dilation angle.
  pure subroutine drucker_prager_return(cone, shear, bulk, stress, deqps, yielded)
    type(cone_t), intent(in) :: cone
    real(dp), intent(in) :: shear        !! G [Pa]
    real(dp), intent(in) :: bulk         !! K [Pa]
    real(dp), intent(inout) :: stress(4) !! trial stress in, returned stress out [Pa], tension +
    real(dp), intent(out) :: deqps       !! increment of sqrt(2/3 e_p:e_p) [-], >= 0
    logical, intent(out) :: yielded      !! true when the trial stress was outside
    real(dp) :: i1, mean, sx, sy, sz, j2, radius, edge, dlambda, root, root_new, ratio

    i1 = stress(1) + stress(2) + stress(3)
    mean = i1*third
    sx = stress(1) - mean
    sy = stress(2) - mean
    sz = stress(3) - mean
    j2 = 0.5_dp*(sx*sx + sy*sy + sz*sz) + stress(4)*stress(4)
    radius = cone%k - cone%alpha*i1
    deqps = 0.0_dp
    yielded = i1 > cone%i1_max .or. radius < 0.0_dp .or. j2 > radius*radius
    if (.not. yielded) return

    root = sqrt(j2)
    dlambda = max(0.0_dp, (root - radius)/(shear + 9.0_dp*bulk*cone%alpha*cone%alpha_psi))
    i1 = i1 - 9.0_dp*bulk*cone%alpha_psi*dlambda
    root_new = root - shear*dlambda
    if (i1 > cone%i1_max) then
      i1 = cone%i1_max
      edge = max(0.0_dp, cone%k - cone%alpha*i1)
      root_new = min(root, edge)
    end if
    root_new = max(0.0_dp, root_new)
    ratio = 1.0_dp
    if (root > root_new) then
      ratio = root_new/root
      deqps = (root - root_new)/(shear*sqrt3)
    end if
    mean = i1*third
    stress(1) = ratio*sx + mean
    stress(2) = ratio*sy + mean
    stress(3) = ratio*sz + mean
    stress(4) = ratio*stress(4)
  end subroutine drucker_prager_return

  !> Which of n trial stresses lie inside a cone: 1, or 0 where outside or not a number.
  pure subroutine drucker_prager_within(n, cone, stress, within)
    integer, intent(in) :: n
    type(cone_t), intent(in) :: cone
    real(dp), intent(in) :: stress(4,n) !! trial stress [Pa], tension +
    real(dp), intent(out) :: within(n)  !! 1 or 0
    real(dp) :: i1, mean, j2, radius
    integer :: i

    do i = 1, n
      i1 = stress(1, i) + stress(2, i) + stress(3, i)
      mean = i1*third
      j2 = 0.5_dp*((stress(1, i) - mean)**2 + (stress(2, i) - mean)**2 &
        + (stress(3, i) - mean)**2) + stress(4, i)*stress(4, i)
      radius = cone%k - cone%alpha*i1
      within(i) = merge(1.0_dp, 0.0_dp, i1 <= cone%i1_max)*merge(1.0_dp, 0.0_dp, radius >= 0.0_dp) &
        *merge(1.0_dp, 0.0_dp, j2 <= radius*radius)
    end do
  end subroutine drucker_prager_within

  !> Secant shear stiffness of the plastic state over the elastic one,
  !! sqrt(J2)/(sqrt(J2) + G gamma_p), with gamma_p = sqrt(3) times the equivalent plastic strain,
  !! the plastic partner of the elastic shear strain sqrt(J2)/G. One at a point that never
  !! yielded; zero when no shear stress is left: the caller sets the floor.
  pure real(dp) function secant_shear_ratio(shear, stress, eqps)
    real(dp), intent(in) :: shear     !! G [Pa]
    real(dp), intent(in) :: stress(4) !! undamaged stress [Pa]
    real(dp), intent(in) :: eqps      !! equivalent plastic strain [-]
    real(dp) :: mean, root

    secant_shear_ratio = 1.0_dp
    if (.not. eqps > 0.0_dp) return
    mean = (stress(1) + stress(2) + stress(3))*third
    root = sqrt(0.5_dp*((stress(1) - mean)**2 + (stress(2) - mean)**2 + (stress(3) - mean)**2) &
      + stress(4)**2)
    secant_shear_ratio = root/(root + shear*sqrt3*eqps)
  end function secant_shear_ratio
end module talus_drucker_prager
