! SPDX-License-Identifier: MIT
!> Drucker-Prager cone with non-associated flow, apex and tension cut-off.
!!
!! f = sqrt(J2) + alpha I1 - k, flow potential sqrt(J2) + alpha_psi I1 (src/THEORY.md (3.4)-(3.7);
!! Drucker & Prager 1952). The plastic strain measure is sqrt(2/3 e_p : e_p) of the deviatoric
!! plastic strain e_p: a return that only changes the mean stress adds nothing to it. The plural
!! procedures take a block of points, by component (talus_points), without branches.
module talus_drucker_prager
  use talus_kinds, only: dp
  use talus_points, only: soil_points
  implicit none
  private
  public :: cone_t, cones_t, cone_shape, cones_set, drucker_prager_returns, drucker_prager_excess
  public :: openings_close, openings_after
  public :: secant_shear_ratios, stress_roots

  !> Fits of the cone to the Mohr-Coulomb pyramid.
  integer, parameter, public :: fit_plane_strain = 1, fit_compression = 2, fit_extension = 3

  !> The cone at one point and time.
  type :: cone_t
    real(dp) :: alpha = 0.0_dp      !! slope [-]
    real(dp) :: alpha_psi = 0.0_dp  !! slope of the flow potential [-]
    real(dp) :: k = 0.0_dp          !! sqrt(J2) at I1 = 0 [Pa]
    real(dp) :: i1_max = 0.0_dp     !! largest I1: the apex, or the cut-off below it [Pa]
  end type cone_t

  !> The cones of a block of points.
  type :: cones_t
    real(dp), dimension(soil_points) :: alpha, alpha_psi, k, i1_max !! see cone_t
  end type cones_t

  !> Keeps the apex of a cylinder finite.
  real(dp), parameter :: nearly_flat = 1.0e-30_dp
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

  !> Complete the cones of a block, whose slopes and k are known, with the limit of I1.
  pure subroutine cones_set(n, tension_cutoff, cones)
    integer, intent(in) :: n
    real(dp), intent(in) :: tension_cutoff !! largest mean stress [Pa]; negative = none
    type(cones_t), intent(inout) :: cones
    real(dp) :: most
    integer :: i

    most = huge(1.0_dp)
    if (tension_cutoff >= 0.0_dp) most = 3.0_dp*tension_cutoff
    do i = 1, n
      cones%i1_max(i) = min(cones%k(i)/max(cones%alpha(i), nearly_flat), most)
    end do
  end subroutine cones_set

  !> Return n trial stresses to their cones.
  !!
  !! Smooth part: dlambda = f/(G + 9 K alpha alpha_psi). When that leaves I1 above i1_max, the
  !! stress lies on the plane I1 = i1_max, with sqrt(J2) kept or reduced to the edge where cone
  !! and plane meet. Without cut-off the edge is the apex, for any dilation angle. Either way
  !! sqrt(J2) is k - alpha I1 of the returned I1, where it is not less; so no case needs a branch,
  !! and a stress inside stays as it is to the last bit.
  pure subroutine drucker_prager_returns(n, cones, shear, bulk, stress, deqps, root)
    integer, intent(in) :: n
    type(cones_t), intent(in) :: cones
    real(dp), intent(in) :: shear                    !! G [Pa]
    real(dp), intent(in) :: bulk                     !! K [Pa]
    real(dp), intent(inout) :: stress(soil_points,4) !! trial in, returned out [Pa], tension +
    real(dp), intent(inout) :: deqps(soil_points)    !! increment of sqrt(2/3 e_p:e_p) [-], >= 0
    real(dp), intent(inout) :: root(soil_points)     !! sqrt(J2) of the returned stress [Pa]
    real(dp) :: i1, mean, sx, sy, sz, sqrt_j2, radius, dlambda, i1_new, change, shift
    integer :: i

    do i = 1, n
      i1 = stress(i, 1) + stress(i, 2) + stress(i, 3)
      mean = i1*third
      sx = stress(i, 1) - mean
      sy = stress(i, 2) - mean
      sz = stress(i, 3) - mean
      sqrt_j2 = sqrt(0.5_dp*(sx*sx + sy*sy + sz*sz) + stress(i, 4)*stress(i, 4))
      radius = cones%k(i) - cones%alpha(i)*i1
      dlambda = max(0.0_dp, sqrt_j2 - radius) &
        /(shear + 9.0_dp*bulk*cones%alpha(i)*cones%alpha_psi(i))
      i1_new = min(i1 - 9.0_dp*bulk*cones%alpha_psi(i)*dlambda, cones%i1_max(i))
      root(i) = min(sqrt_j2, max(0.0_dp, cones%k(i) - cones%alpha(i)*i1_new))
      deqps(i) = (sqrt_j2 - root(i))/(shear*sqrt3)
      ! The deviator shrinks in proportion; one over tiny where there is none.
      change = root(i)/max(sqrt_j2, tiny(1.0_dp)) - 1.0_dp
      shift = (i1_new - i1)*third
      stress(i, 1) = stress(i, 1) + (change*sx + shift)
      stress(i, 2) = stress(i, 2) + (change*sy + shift)
      stress(i, 3) = stress(i, 3) + (change*sz + shift)
      stress(i, 4) = stress(i, 4) + change*stress(i, 4)
    end do
  end subroutine drucker_prager_returns

  !> Begin the step of soil that remembers how far it has opened (src/THEORY.md (3.7a)): while its
  !! grains are apart nothing compresses them, and it does not dilate.
  pure subroutine openings_close(n, bulk, opening, stress, alpha_psi)
    integer, intent(in) :: n
    real(dp), intent(in) :: bulk                     !! K [Pa]
    real(dp), intent(in) :: opening(soil_points)     !! volumetric strain it is open by [-], >= 0
    real(dp), intent(inout) :: stress(soil_points,4) !! trial stress [Pa], tension +
    real(dp), intent(inout) :: alpha_psi(soil_points) !! see cone_t
    integer :: i

    do i = 1, n
      stress(i, 1:3) = stress(i, 1:3) + bulk*opening(i)
      if (opening(i) > 0.0_dp) alpha_psi(i) = 0.0_dp
    end do
  end subroutine openings_close

  !> End the step: how far the soil is open now (src/THEORY.md (3.7b)), by the trial stress that
  !! openings_close left. The largest mean stress has to be zero.
  pure subroutine openings_after(n, cones, bulk, i1, deqps, opening)
    integer, intent(in) :: n
    type(cones_t), intent(in) :: cones
    real(dp), intent(in) :: bulk                     !! K [Pa]
    real(dp), intent(in) :: i1(soil_points)          !! of that trial stress [Pa]
    real(dp), intent(in) :: deqps(soil_points)       !! of drucker_prager_returns
    real(dp), intent(inout) :: opening(soil_points)  !! volumetric strain [-], >= 0
    integer :: i

    do i = 1, n
      opening(i) = max(0.0_dp, i1(i)*third/bulk - 3.0_dp*sqrt3*cones%alpha_psi(i)*deqps(i))
    end do
  end subroutine openings_after

  !> Whether n trial stresses lie outside their cones: > 0 outside, not a number where the stress is
  !> not, else inside.
  pure subroutine drucker_prager_excess(n, cones, stress, excess)
    integer, intent(in) :: n
    type(cones_t), intent(in) :: cones
    real(dp), intent(in) :: stress(soil_points,4)  !! trial stress [Pa], tension +
    real(dp), intent(inout) :: excess(soil_points) !! only its sign has a meaning
    real(dp) :: i1, mean, j2, radius
    integer :: i

    do i = 1, n
      i1 = stress(i, 1) + stress(i, 2) + stress(i, 3)
      mean = i1*third
      j2 = 0.5_dp*((stress(i, 1) - mean)**2 + (stress(i, 2) - mean)**2 &
        + (stress(i, 3) - mean)**2) + stress(i, 4)*stress(i, 4)
      radius = cones%k(i) - cones%alpha(i)*i1
      ! max forgets what is not a number, zero times it does not.
      excess(i) = max(i1 - cones%i1_max(i), -radius, j2 - radius*radius) + 0.0_dp*j2
    end do
  end subroutine drucker_prager_excess

  !> sqrt(J2) at n points [Pa].
  pure subroutine stress_roots(n, stress, root)
    integer, intent(in) :: n
    real(dp), intent(in) :: stress(soil_points,4)
    real(dp), intent(inout) :: root(soil_points)
    real(dp) :: mean
    integer :: i

    do i = 1, n
      mean = (stress(i, 1) + stress(i, 2) + stress(i, 3))*third
      root(i) = sqrt(0.5_dp*((stress(i, 1) - mean)**2 + (stress(i, 2) - mean)**2 &
        + (stress(i, 3) - mean)**2) + stress(i, 4)*stress(i, 4))
    end do
  end subroutine stress_roots

  !> Secant shear stiffness of the plastic state over the elastic one at n points,
  !! sqrt(J2)/(sqrt(J2) + G gamma_p), with gamma_p = sqrt(3) times the equivalent plastic strain,
  !! the plastic partner of the elastic shear strain sqrt(J2)/G. One at a point that never
  !! yielded; zero when no shear stress is left: the caller sets the floor.
  pure subroutine secant_shear_ratios(n, shear, root, eqps, ratio)
    integer, intent(in) :: n
    real(dp), intent(in) :: shear                 !! G [Pa]
    real(dp), intent(in) :: root(soil_points)     !! sqrt(J2) of the undamaged stress [Pa]
    real(dp), intent(in) :: eqps(soil_points)     !! equivalent plastic strain [-]
    real(dp), intent(inout) :: ratio(soil_points) !! [-]
    integer :: i

    ! The least number makes one of nothing over nothing.
    do i = 1, n
      ratio(i) = (root(i) + tiny(1.0_dp))/(root(i) + tiny(1.0_dp) + shear*sqrt3*eqps(i))
    end do
  end subroutine secant_shear_ratios
end module talus_drucker_prager
