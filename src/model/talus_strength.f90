! SPDX-License-Identifier: MIT
!> Strength of the soil skeleton: softening with plastic strain, and suction.
!!
!! Cohesion, friction angle and dilation angle follow the equivalent plastic strain; in net
!! stress, suction adds cohesion (src/THEORY.md (3.8); Vanapalli et al. 1996). Cones that do
!! not change are prepared once, so that sines are taken only while the angles move.
module talus_strength
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_set, status_failed, status_deck
  use talus_text, only: text_of
  use talus_points, only: soil_points
  use talus_drucker_prager, only: cone_t, cones_t, cone_shape, cones_set, drucker_prager_excess
  implicit none
  private
  public :: strength_t, strength_prepare, strength_cone, strength_cones, strength_excess, &
    strength_at

  integer, parameter, public :: softening_none = 0, softening_linear = 1, &
    softening_exponential = 2, softening_table = 3
  integer, parameter, public :: suction_strength_none = 0, suction_strength_phi_b = 1, &
    suction_strength_vanapalli = 2

  !> A cone per unit cohesion, with the cohesion that goes with it.
  type :: shape_t
    real(dp) :: alpha = 0.0_dp     !! slope [-]
    real(dp) :: alpha_psi = 0.0_dp !! slope of the flow potential [-]
    real(dp) :: k_over_c = 0.0_dp  !! [-]
    real(dp) :: cohesion = 0.0_dp  !! c' [Pa]
    real(dp) :: tan_phi = 0.0_dp   !! tangent of the friction angle [-]
  end type shape_t

  !> Parameters of the strength; those not needed by the switches are ignored.
  type :: strength_t
    integer :: fit = 1                                    !! one of fit_*
    integer :: softening = softening_none                 !! one of softening_*
    integer :: suction = suction_strength_none            !! one of suction_strength_*
    real(dp) :: cohesion = 0.0_dp                         !! [Pa]
    real(dp) :: friction_angle = 0.0_dp                   !! [rad]
    real(dp) :: dilation_angle = 0.0_dp                   !! [rad]
    real(dp) :: tension_cutoff = -1.0_dp                  !! largest mean stress [Pa]; < 0 = none
    real(dp) :: dilation_limit = huge(1.0_dp)             !! equivalent plastic strain [-]
    real(dp) :: softening_strain = 0.0_dp                 !! plastic strain of the softening [-]
    real(dp) :: residual_cohesion = 0.0_dp                !! [Pa]
    real(dp) :: residual_friction_angle = 0.0_dp          !! [rad]
    real(dp) :: residual_dilation_angle = 0.0_dp          !! [rad]
    real(dp), allocatable :: table_strain(:)              !! rising plastic strains [-]
    real(dp), allocatable :: table_cohesion(:)            !! [Pa]
    real(dp), allocatable :: table_friction_angle(:)      !! [rad]
    real(dp), allocatable :: table_dilation_angle(:)      !! [rad]
    real(dp) :: phi_b = 0.0_dp                            !! [rad]
    real(dp) :: suction_cohesion_max = huge(1.0_dp)       !! cap of the suction's part [Pa]
    real(dp) :: factor = 1.0_dp !! F > 0 that divides cohesion, tan(phi) and suction's part [-]
    type(shape_t), private :: peak                        !! before any plastic strain
    type(shape_t), private :: residual                    !! where nothing changes any more
    real(dp), private :: peak_until = 0.0_dp              !! plastic strain where `peak` ends [-]
    real(dp), private :: constant_from = huge(1.0_dp)     !! plastic strain of `residual` [-]
    real(dp), private :: tan_phi_b = 0.0_dp               !! divided by the factor [-]
    real(dp), private :: added_most = huge(1.0_dp)        !! cap divided by the factor [Pa]
  end type strength_t

contains

  !> Check the parameters and prepare the cones that do not change.
  pure subroutine strength_prepare(strength, status)
    type(strength_t), intent(inout) :: strength
    type(status_t), intent(inout) :: status !! status_deck when out of range

    call check_ranges(strength, status)
    if (strength%softening == softening_table) call check_table(strength, status)
    if (status_failed(status)) return
    strength%tan_phi_b = tan(strength%phi_b)/strength%factor
    strength%added_most = strength%suction_cohesion_max
    if (strength%added_most < 1.0e-9_dp*huge(1.0_dp)) &
      strength%added_most = strength%added_most/strength%factor
    strength%peak_until = 0.0_dp
    select case (strength%softening)
    case (softening_none)
      strength%peak_until = strength%dilation_limit
      strength%constant_from = 0.0_dp
    case (softening_linear)
      strength%constant_from = strength%softening_strain
    case (softening_exponential)
      ! exp(-40) is 4e-18: nothing is left to soften.
      strength%constant_from = 40.0_dp*strength%softening_strain
    case (softening_table)
      strength%constant_from = strength%table_strain(size(strength%table_strain))
    end select
    if (strength%dilation_limit < 0.1_dp*huge(1.0_dp)) &
      strength%constant_from = max(strength%constant_from, strength%dilation_limit)
    call shape_at(strength, 0.0_dp, strength%peak)
    call shape_at(strength, strength%constant_from, strength%residual)
  end subroutine strength_prepare

  pure subroutine check_ranges(strength, status)
    type(strength_t), intent(in) :: strength
    type(status_t), intent(inout) :: status
    real(dp), parameter :: right_angle = 1.5707_dp

    call need(strength%cohesion >= 0.0_dp, 'cohesion must not be negative', status)
    call need(angles_fit(strength%friction_angle, strength%dilation_angle), &
      'angles must obey 0 <= dilation_angle <= friction_angle < 90 degrees', status)
    call need(strength%dilation_limit >= 0.0_dp, 'dilation_limit must not be negative', status)
    call need(strength%phi_b >= 0.0_dp .and. strength%phi_b < right_angle, &
      'phi_b must lie in [0, 90) degrees', status)
    call need(strength%suction_cohesion_max >= 0.0_dp, &
      'suction_cohesion_max must not be negative', status)
    call need(strength%factor > 0.0_dp, 'the factor that divides strength must be positive', &
      status)
    if (strength%softening /= softening_linear .and. &
      strength%softening /= softening_exponential) return
    call need(strength%softening_strain > 0.0_dp, 'softening_strain must be positive, not ' &
      //text_of(strength%softening_strain), status)
    call need(strength%residual_cohesion >= 0.0_dp, &
      'residual_cohesion must not be negative', status)
    call need(angles_fit(strength%residual_friction_angle, strength%residual_dilation_angle), &
      'residual angles must obey 0 <= dilation <= friction < 90 degrees', status)
  end subroutine check_ranges

  pure subroutine check_table(strength, status)
    type(strength_t), intent(in) :: strength
    type(status_t), intent(inout) :: status
    integer :: n

    if (.not. (allocated(strength%table_strain) .and. allocated(strength%table_cohesion) .and. &
      allocated(strength%table_friction_angle) .and. &
      allocated(strength%table_dilation_angle))) then
      call status_set(status, status_deck, 'softening = table needs all four softening_table_*')
      return
    end if
    n = size(strength%table_strain)
    if (n < 2 .or. size(strength%table_cohesion) /= n .or. &
      size(strength%table_friction_angle) /= n .or. &
      size(strength%table_dilation_angle) /= n) then
      call status_set(status, status_deck, &
        'softening_table_* must have the same number of entries, at least two')
      return
    end if
    call need(strength%table_strain(1) >= 0.0_dp .and. &
      all(strength%table_strain(2:) > strength%table_strain(:n-1)), &
      'softening_table_strain must rise from zero or above', status)
    call need(all(strength%table_cohesion >= 0.0_dp), &
      'softening_table_cohesion must not be negative', status)
    call need(all(angles_fit(strength%table_friction_angle, strength%table_dilation_angle)), &
      'table angles must obey 0 <= dilation <= friction < 90 degrees', status)
  end subroutine check_table

  elemental logical function angles_fit(phi, psi)
    real(dp), intent(in) :: phi !! friction angle [rad]
    real(dp), intent(in) :: psi !! dilation angle [rad]
    real(dp), parameter :: right_angle = 1.5707_dp

    angles_fit = psi >= 0.0_dp .and. psi <= phi .and. phi < right_angle
  end function angles_fit

  pure subroutine need(holds, message, status)
    logical, intent(in) :: holds
    character(*), intent(in) :: message
    type(status_t), intent(inout) :: status

    if (.not. holds) call status_set(status, status_deck, message)
  end subroutine need

  !> Cone of a point from its plastic strain, suction and effective saturation.
  pure subroutine strength_cone(strength, eqps, suction, saturation, cone)
    type(strength_t), intent(in) :: strength
    real(dp), intent(in) :: eqps       !! equivalent plastic strain [-]
    real(dp), intent(in) :: suction    !! s = -p_w [Pa]; no part when negative
    real(dp), intent(in) :: saturation !! effective saturation [-], 0 to 1
    type(cone_t), intent(out) :: cone
    type(cones_t) :: cones
    real(dp), dimension(soil_points) :: strain, pull, wet

    strain(1) = eqps
    pull(1) = suction
    wet(1) = saturation
    call strength_cones(strength, 1, strain, pull, wet, cones)
    cone = cone_t(cones%alpha(1), cones%alpha_psi(1), cones%k(1), cones%i1_max(1))
  end subroutine strength_cone

  !> The same at n points of a block.
  pure subroutine strength_cones(strength, n, eqps, suction, saturation, cones)
    type(strength_t), intent(in) :: strength
    integer, intent(in) :: n
    real(dp), intent(in) :: eqps(soil_points)       !! equivalent plastic strain [-]
    real(dp), intent(in) :: suction(soil_points)    !! s = -p_w [Pa]; no part when negative
    real(dp), intent(in) :: saturation(soil_points) !! effective saturation [-], 0 to 1
    type(cones_t), intent(inout) :: cones
    type(shape_t) :: shape
    type(cones_t) :: one
    integer :: i

    if (maxval(eqps(:n)) < strength%peak_until) then
      call shape_cones(strength, strength%peak, n, suction, saturation, cones)
      return
    end if
    do i = 1, n
      if (eqps(i) <= 0.0_dp .or. eqps(i) < strength%peak_until) then
        shape = strength%peak
      else if (eqps(i) >= strength%constant_from) then
        shape = strength%residual
      else
        call shape_at(strength, eqps(i), shape)
      end if
      call shape_cones(strength, shape, 1, suction(i:i), saturation(i:i), one)
      cones%alpha(i) = one%alpha(1)
      cones%alpha_psi(i) = one%alpha_psi(1)
      cones%k(i) = one%k(1)
      cones%i1_max(i) = one%i1_max(1)
    end do
  end subroutine strength_cones

  !> Cones of one shape, with the part of suction in the cohesion: min(s tan(phi_b) or
  !> S_e s tan(phi'), dc_max).
  pure subroutine shape_cones(strength, shape, n, suction, saturation, cones)
    type(strength_t), intent(in) :: strength
    type(shape_t), intent(in) :: shape
    integer, intent(in) :: n
    real(dp), intent(in) :: suction(n), saturation(n)
    type(cones_t), intent(inout) :: cones
    integer :: i

    cones%alpha(:n) = shape%alpha
    cones%alpha_psi(:n) = shape%alpha_psi
    select case (strength%suction)
    case (suction_strength_phi_b)
      do i = 1, n
        cones%k(i) = (shape%cohesion + min(max(0.0_dp, suction(i))*strength%tan_phi_b, &
                                           strength%added_most))*shape%k_over_c
      end do
    case (suction_strength_vanapalli)
      do i = 1, n
        cones%k(i) = (shape%cohesion + min(max(0.0_dp, suction(i))*saturation(i)*shape%tan_phi, &
                                           strength%added_most))*shape%k_over_c
      end do
    case default
      cones%k(:n) = shape%cohesion*shape%k_over_c
    end select
    call cones_set(n, strength%tension_cutoff, cones)
  end subroutine shape_cones

  !> Whether n trial stresses lie outside the cone of soil that has not yielded yet: > 0 or not a
  !> number where they do.
  pure subroutine strength_excess(strength, n, suction, saturation, stress, excess)
    type(strength_t), intent(in) :: strength
    integer, intent(in) :: n
    real(dp), intent(in) :: suction(soil_points)    !! s = -p_w [Pa]
    real(dp), intent(in) :: saturation(soil_points) !! effective saturation [-]
    real(dp), intent(in) :: stress(soil_points,4)   !! trial stress [Pa], tension +
    real(dp), intent(inout) :: excess(soil_points)  !! only its sign has a meaning
    type(cones_t) :: cones

    call shape_cones(strength, strength%peak, n, suction, saturation, cones)
    call drucker_prager_excess(n, cones, stress, excess)
  end subroutine strength_excess

  pure subroutine shape_at(strength, eqps, shape)
    type(strength_t), intent(in) :: strength
    real(dp), intent(in) :: eqps
    type(shape_t), intent(out) :: shape
    real(dp) :: phi, psi, sin_phi, cos_phi

    call strength_at(strength, eqps, shape%cohesion, phi, psi)
    sin_phi = sin(phi)
    cos_phi = cos(phi)
    call cone_shape(strength%fit, sin_phi, cos_phi, sin(psi), shape%alpha, shape%alpha_psi, &
      shape%k_over_c)
    shape%tan_phi = sin_phi/cos_phi
  end subroutine shape_at

  !> Softened cohesion and angles at an equivalent plastic strain, divided by the factor. Dilation
  !> stays, but for an angle that would exceed that of the divided friction.
  pure subroutine strength_at(strength, eqps, cohesion, phi, psi)
    type(strength_t), intent(in) :: strength
    real(dp), intent(in) :: eqps      !! equivalent plastic strain [-]
    real(dp), intent(out) :: cohesion !! c' without suction [Pa]
    real(dp), intent(out) :: phi      !! friction angle [rad]
    real(dp), intent(out) :: psi      !! dilation angle [rad]; 0 from dilation_limit on
    real(dp) :: left

    select case (strength%softening)
    case (softening_table)
      call table_at(strength, eqps, cohesion, phi, psi)
    case default
      left = 1.0_dp
      if (strength%softening == softening_linear) then
        left = max(0.0_dp, 1.0_dp - eqps/strength%softening_strain)
      else if (strength%softening == softening_exponential) then
        left = exp(-eqps/strength%softening_strain)
      end if
      cohesion = left*strength%cohesion + (1.0_dp - left)*strength%residual_cohesion
      phi = left*strength%friction_angle + (1.0_dp - left)*strength%residual_friction_angle
      psi = left*strength%dilation_angle + (1.0_dp - left)*strength%residual_dilation_angle
    end select
    if (eqps >= strength%dilation_limit) psi = 0.0_dp
    if (abs(strength%factor - 1.0_dp) > 0.0_dp) then
      cohesion = cohesion/strength%factor
      phi = atan(tan(phi)/strength%factor)
      psi = min(psi, phi)
    end if
  end subroutine strength_at

  !> Straight lines between the table's rows; constant beyond its ends.
  pure subroutine table_at(strength, eqps, cohesion, phi, psi)
    type(strength_t), intent(in) :: strength
    real(dp), intent(in) :: eqps
    real(dp), intent(out) :: cohesion, phi, psi
    integer :: row
    real(dp) :: t, first, last

    row = 1
    do while (row < size(strength%table_strain) - 1)
      if (eqps < strength%table_strain(row+1)) exit
      row = row + 1
    end do
    first = strength%table_strain(row)
    last = strength%table_strain(row+1)
    t = min(1.0_dp, max(0.0_dp, (eqps - first)/(last - first)))
    cohesion = strength%table_cohesion(row) &
      + t*(strength%table_cohesion(row+1) - strength%table_cohesion(row))
    phi = strength%table_friction_angle(row) &
      + t*(strength%table_friction_angle(row+1) - strength%table_friction_angle(row))
    psi = strength%table_dilation_angle(row) &
      + t*(strength%table_dilation_angle(row+1) - strength%table_dilation_angle(row))
  end subroutine table_at
end module talus_strength
