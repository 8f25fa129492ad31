! SPDX-License-Identifier: MIT
!> Isotropic damage driven by strain (src/THEORY.md (3.10), (3.11)).
!!
!! Order at a point: equivalent strain, kappa = max over time, D(kappa) that never decreases,
!! stress = undamaged stress - D P(undamaged stress), where P takes the whole stress (`full`), its
!! deviator (`deviatoric`) or its positive principal part (`tensile`).
module talus_damage
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_set, status_deck
  use talus_text, only: text_of
  use talus_points, only: soil_points
  use talus_elastic, only: elastic_t, elastic_bilinears
  implicit none
  private
  public :: damage_t, damage_prepare, damage_driver, damage_law, damage_advance
  public :: damage_part, damage_parts, damage_degrade, damage_energies

  integer, parameter, public :: driver_none = 0, driver_energy = 1, driver_mazars = 2, &
    driver_von_mises = 3, driver_plastic_strain = 4
  integer, parameter, public :: damage_exponential = 1, damage_linear = 2, damage_mazars = 3
  integer, parameter, public :: split_full = 1, split_deviatoric = 2, split_tensile = 3

  !> Parameters of damage; those not needed by the switches are ignored.
  type :: damage_t
    integer :: driver = driver_none        !! one of driver_*; none switches damage off
    integer :: law = damage_exponential    !! one of damage_*
    integer :: split = split_full          !! one of split_*
    real(dp) :: kappa_0 = 0.0_dp           !! equivalent strain where damage begins [-]
    real(dp) :: kappa_f = 0.0_dp           !! strain scale of the exponential and linear laws [-]
    real(dp) :: mazars_a = 0.0_dp          !! [-]
    real(dp) :: mazars_b = 0.0_dp          !! [-]
    real(dp) :: strength_ratio = 10.0_dp   !! compressive over tensile strength, von Mises driver
    real(dp) :: maximum = 0.99_dp          !! cap of D [-], below 1
    real(dp), private :: lame_over_e = 0.0_dp, shear_over_e = 0.0_dp !! lambda/E, 2 G/E [-]
    real(dp), private :: vm_linear = 0.0_dp, vm_square = 0.0_dp, vm_j2 = 0.0_dp
  end type damage_t

contains

  !> Check the parameters and prepare what depends on the elastic constants.
  pure subroutine damage_prepare(damage, elastic, status)
    type(damage_t), intent(inout) :: damage
    type(elastic_t), intent(in) :: elastic   !! prepared
    type(status_t), intent(inout) :: status  !! status_deck when out of range
    real(dp) :: ratio, nu

    if (damage%driver == driver_none) return
    call check_ranges(damage, status)
    damage%lame_over_e = elastic%lame/elastic%youngs_modulus
    damage%shear_over_e = 2.0_dp*elastic%shear/elastic%youngs_modulus
    ! Modified von Mises strain, de Vree et al. (1995).
    ratio = damage%strength_ratio
    nu = elastic%poisson_ratio
    damage%vm_linear = (ratio - 1.0_dp)/(2.0_dp*ratio*(1.0_dp - 2.0_dp*nu))
    damage%vm_square = damage%vm_linear**2
    damage%vm_j2 = 3.0_dp/(ratio*(1.0_dp + nu)**2)
  end subroutine damage_prepare

  pure subroutine check_ranges(damage, status)
    type(damage_t), intent(in) :: damage
    type(status_t), intent(inout) :: status
    real(dp) :: slope

    if (.not. damage%kappa_0 > 0.0_dp) call status_set(status, status_deck, &
      'kappa_0 must be positive, not '//text_of(damage%kappa_0))
    if (.not. (damage%maximum >= 0.0_dp .and. damage%maximum < 1.0_dp)) call status_set(status, &
      status_deck, 'maximum damage must lie in [0, 1), not '//text_of(damage%maximum))
    if (damage%driver == driver_von_mises .and. .not. damage%strength_ratio >= 1.0_dp) &
      call status_set(status, status_deck, 'strength_ratio must be at least 1, not ' &
      //text_of(damage%strength_ratio))
    if (damage%law == damage_mazars) then
      if (.not. (damage%mazars_a > 0.0_dp .and. damage%mazars_b > 0.0_dp)) then
        call status_set(status, status_deck, 'law = mazars needs mazars_a > 0 and mazars_b > 0')
      else if (damage%kappa_0 > 0.0_dp) then
        slope = 1.0_dp - damage%mazars_a + damage%mazars_a*damage%mazars_b*damage%kappa_0
        if (slope < 0.0_dp) call status_set(status, status_deck, &
          'law = mazars starts with falling damage: needs A (1 - B kappa_0) <= 1')
      end if
    else if (.not. damage%kappa_f > damage%kappa_0) then
      call status_set(status, status_deck, 'kappa_f must exceed kappa_0')
    end if
  end subroutine check_ranges

  !> Equivalent strain of a total strain, or the equivalent plastic strain.
  pure real(dp) function damage_driver(damage, strain, eqps)
    type(damage_t), intent(in) :: damage
    real(dp), intent(in) :: strain(4) !! total strain [-], tension +
    real(dp), intent(in) :: eqps      !! equivalent plastic strain [-]
    real(dp) :: trace, squares, centre, radius, j2

    select case (damage%driver)
    case (driver_energy) ! sqrt(eps : C : eps / E), Simo & Ju (1987)
      trace = strain(1) + strain(2) + strain(3)
      squares = strain(1)**2 + strain(2)**2 + strain(3)**2 + 2.0_dp*strain(4)**2
      damage_driver = sqrt(max(0.0_dp, damage%lame_over_e*trace*trace &
        + damage%shear_over_e*squares))
    case (driver_mazars) ! norm of the positive principal strains, Mazars (1986)
      centre = 0.5_dp*(strain(1) + strain(2))
      radius = sqrt((0.5_dp*(strain(1) - strain(2)))**2 + strain(4)**2)
      damage_driver = sqrt(max(0.0_dp, centre + radius)**2 + max(0.0_dp, centre - radius)**2 &
        + max(0.0_dp, strain(3))**2)
    case (driver_von_mises)
      trace = strain(1) + strain(2) + strain(3)
      squares = strain(1)**2 + strain(2)**2 + strain(3)**2 + 2.0_dp*strain(4)**2
      j2 = max(0.0_dp, 0.5_dp*(squares - trace*trace/3.0_dp))
      damage_driver = damage%vm_linear*trace &
        + sqrt(damage%vm_square*trace*trace + damage%vm_j2*j2)
    case (driver_plastic_strain)
      damage_driver = eqps
    case default
      damage_driver = 0.0_dp
    end select
  end function damage_driver

  !> Damage of a history variable kappa, between 0 and the cap.
  pure real(dp) function damage_law(damage, kappa) result(d)
    type(damage_t), intent(in) :: damage
    real(dp), intent(in) :: kappa !! largest equivalent strain so far [-]

    d = 0.0_dp
    if (kappa <= damage%kappa_0) return
    select case (damage%law)
    case (damage_exponential)
      d = 1.0_dp - damage%kappa_0/kappa &
        *exp(-(kappa - damage%kappa_0)/(damage%kappa_f - damage%kappa_0))
    case (damage_linear)
      d = damage%kappa_f*(kappa - damage%kappa_0)/(kappa*(damage%kappa_f - damage%kappa_0))
    case (damage_mazars)
      d = 1.0_dp - (1.0_dp - damage%mazars_a)*damage%kappa_0/kappa &
        - damage%mazars_a*exp(-damage%mazars_b*(kappa - damage%kappa_0))
    end select
    d = min(max(d, 0.0_dp), damage%maximum)
  end function damage_law

  !> Raise kappa and D to the present equivalent strain; neither ever falls.
  pure subroutine damage_advance(damage, strain, eqps, kappa, d)
    type(damage_t), intent(in) :: damage
    real(dp), intent(in) :: strain(4)  !! total strain [-], tension +
    real(dp), intent(in) :: eqps       !! equivalent plastic strain [-]
    real(dp), intent(inout) :: kappa   !! largest equivalent strain so far [-]
    real(dp), intent(inout) :: d       !! damage [-]
    real(dp) :: driver

    driver = damage_driver(damage, strain, eqps)
    if (driver <= kappa) return
    kappa = driver
    d = max(d, damage_law(damage, kappa))
  end subroutine damage_advance

  !> Degraded part P of the undamaged stress: the stress of the point is stress - D P.
  pure subroutine damage_part(split, stress, part)
    integer, intent(in) :: split       !! one of split_*
    real(dp), intent(in) :: stress(4)  !! undamaged stress [Pa], tension +
    real(dp), intent(out) :: part(4)   !! its degraded part [Pa]
    real(dp), dimension(soil_points,4) :: whole, degraded

    whole(1, :) = stress
    call damage_parts(split, 1, whole, degraded)
    part = degraded(1, :)
  end subroutine damage_part

  !> The same at n points of a block.
  pure subroutine damage_parts(split, n, stress, part)
    integer, intent(in) :: split                   !! one of split_*
    integer, intent(in) :: n
    real(dp), intent(in) :: stress(soil_points,4)  !! undamaged stress [Pa], tension +
    real(dp), intent(inout) :: part(soil_points,4) !! its degraded part [Pa]
    real(dp) :: mean, centre, half, radius, upper, lower, ratio
    integer :: i

    select case (split)
    case (split_deviatoric)
      do i = 1, n
        mean = (stress(i, 1) + stress(i, 2) + stress(i, 3))/3.0_dp
        part(i, 1) = stress(i, 1) - mean
        part(i, 2) = stress(i, 2) - mean
        part(i, 3) = stress(i, 3) - mean
        part(i, 4) = stress(i, 4)
      end do
    case (split_tensile)
      do i = 1, n
        centre = 0.5_dp*(stress(i, 1) + stress(i, 2))
        half = 0.5_dp*(stress(i, 1) - stress(i, 2))
        radius = sqrt(half*half + stress(i, 4)*stress(i, 4))
        upper = 0.5_dp*max(0.0_dp, centre + radius)
        lower = 0.5_dp*max(0.0_dp, centre - radius)
        ! Zero over the least number where there is no shear.
        ratio = (upper - lower)/max(radius, tiny(1.0_dp))
        part(i, 1) = upper + lower + ratio*half
        part(i, 2) = upper + lower - ratio*half
        part(i, 3) = max(0.0_dp, stress(i, 3))
        part(i, 4) = ratio*stress(i, 4)
      end do
    case default
      part(:n, :) = stress(:n, :)
    end select
  end subroutine damage_parts

  !> Degrade n points of a block from damage d_old before to d_new after a step: stresses, stored
  !> energies, and the energy that damage releases, per current volume.
  !!
  !! The work 1/2 (sigma_old + sigma_new) : d(eps_e) of the damaged stress less the change of
  !! 1/2 (s - D P(s)) : C^-1 : s is exactly 1/2 (D_new P_new : C^-1 : s_old - D_old P_old : C^-1 :
  !! s_new), which tends to dD times the stored energy of the degraded part. With `full` and
  !! `deviatoric` it vanishes while D stands still. The positive part of a stress has no
  !! potential, so that `tensile` may store or release a little when principal axes turn.
  pure subroutine damage_degrade(damage, elastic, n, d_old, d_new, old, new, energy_old, &
    energy_new, released)
    type(damage_t), intent(in) :: damage
    type(elastic_t), intent(in) :: elastic
    integer, intent(in) :: n
    real(dp), dimension(soil_points), intent(in) :: d_old, d_new !! damage before and after [-]
    real(dp), intent(inout) :: old(soil_points,4) !! undamaged stress before in, turned with the
                                                  !! step; damaged stress out [Pa]
    real(dp), intent(inout) :: new(soil_points,4) !! undamaged stress after in, damaged out [Pa]
    real(dp), dimension(soil_points), intent(inout) :: energy_old, energy_new !! stored [J/m3]
    real(dp), intent(inout) :: released(soil_points) !! [J/m3]
    real(dp), dimension(soil_points,4) :: whole, other, part
    real(dp) :: across(soil_points)
    integer :: c

    whole(:n, :) = new(:n, :)
    other(:n, :) = old(:n, :)
    call damage_parts(damage%split, n, whole, part)
    call elastic_bilinears(elastic, n, part, other, released)
    do c = 1, 4
      new(:n, c) = whole(:n, c) - d_new(:n)*part(:n, c)
    end do
    call elastic_bilinears(elastic, n, new, whole, energy_new)
    call damage_parts(damage%split, n, other, part)
    call elastic_bilinears(elastic, n, part, whole, across)
    do c = 1, 4
      old(:n, c) = other(:n, c) - d_old(:n)*part(:n, c)
    end do
    call elastic_bilinears(elastic, n, old, other, energy_old)
    energy_old(:n) = 0.5_dp*energy_old(:n)
    energy_new(:n) = 0.5_dp*energy_new(:n)
    released(:n) = 0.5_dp*(d_new(:n)*released(:n) - d_old(:n)*across(:n))
  end subroutine damage_degrade

  !> Energies stored at n damaged points of a block, 1/2 (s - D P(s)) : C^-1 : s.
  pure subroutine damage_energies(damage, elastic, n, stress, d, energy)
    type(damage_t), intent(in) :: damage
    type(elastic_t), intent(in) :: elastic
    integer, intent(in) :: n
    real(dp), intent(in) :: stress(soil_points,4) !! undamaged stress s [Pa]
    real(dp), intent(in) :: d(soil_points)        !! damage [-]
    real(dp), intent(inout) :: energy(n)          !! [J/m3]
    real(dp) :: part(soil_points,4)
    integer :: c

    call damage_parts(damage%split, n, stress, part)
    do c = 1, 4
      part(:n, c) = stress(:n, c) - d(:n)*part(:n, c)
    end do
    call elastic_bilinears(elastic, n, part, stress, energy)
    energy = 0.5_dp*energy
  end subroutine damage_energies
end module talus_damage
