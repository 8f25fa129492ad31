! SPDX-License-Identifier: MIT
!> Isotropic linear elasticity in plane strain (src/THEORY.md section 3).
module talus_elastic
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_set, status_deck
  use talus_text, only: text_of
  use talus_points, only: soil_points
  use talus_objective, only: piola_stress
  implicit none
  private
  public :: elastic_t, elastic_prepare, elastic_add, elastic_adds, elastic_energies
  public :: elastic_bilinears, elastic_piola_tangent

  type :: elastic_t
    real(dp) :: youngs_modulus = 0.0_dp !! [Pa]
    real(dp) :: poisson_ratio = 0.0_dp  !! [-]
    real(dp) :: shear = 0.0_dp          !! G [Pa], set by elastic_prepare
    real(dp) :: bulk = 0.0_dp           !! K [Pa], set by elastic_prepare
    real(dp) :: lame = 0.0_dp           !! K - 2G/3 [Pa], set by elastic_prepare
    real(dp), private :: over_bulk = 0.0_dp  !! 1/K [1/Pa]
    real(dp), private :: over_shear = 0.0_dp !! 1/(2 G) [1/Pa]
  end type elastic_t

contains

  !> Derive the moduli from Young's modulus and Poisson's ratio.
  pure subroutine elastic_prepare(elastic, status)
    type(elastic_t), intent(inout) :: elastic  !! both input components set
    type(status_t), intent(inout) :: status    !! status_deck when out of range

    if (.not. elastic%youngs_modulus > 0.0_dp) then
      call status_set(status, status_deck, 'youngs_modulus must be positive, not ' &
        //text_of(elastic%youngs_modulus))
    else if (.not. (elastic%poisson_ratio > -1.0_dp .and. elastic%poisson_ratio < 0.5_dp)) then
      call status_set(status, status_deck, 'poisson_ratio must lie in (-1, 0.5), not ' &
        //text_of(elastic%poisson_ratio))
    else
      elastic%shear = elastic%youngs_modulus/(2.0_dp*(1.0_dp + elastic%poisson_ratio))
      elastic%bulk = elastic%youngs_modulus/(3.0_dp*(1.0_dp - 2.0_dp*elastic%poisson_ratio))
      elastic%lame = elastic%bulk - elastic%shear*2.0_dp/3.0_dp
      elastic%over_bulk = 1.0_dp/elastic%bulk
      elastic%over_shear = 0.5_dp/elastic%shear
    end if
  end subroutine elastic_prepare

  !> Add the stress of a strain increment: stress + C : dstrain.
  pure subroutine elastic_add(elastic, dstrain, stress)
    type(elastic_t), intent(in) :: elastic
    real(dp), intent(in) :: dstrain(4)   !! strain increment [-], tension +
    real(dp), intent(inout) :: stress(4) !! stress [Pa], tension +
    real(dp) :: volumetric, two_g

    volumetric = elastic%lame*(dstrain(1) + dstrain(2) + dstrain(3))
    two_g = 2.0_dp*elastic%shear
    stress(1) = stress(1) + volumetric + two_g*dstrain(1)
    stress(2) = stress(2) + volumetric + two_g*dstrain(2)
    stress(3) = stress(3) + volumetric + two_g*dstrain(3)
    stress(4) = stress(4) + two_g*dstrain(4)
  end subroutine elastic_add

  !> The same at n points of a block, from the stress before to the stress after.
  pure subroutine elastic_adds(elastic, n, dstrain, before, stress)
    type(elastic_t), intent(in) :: elastic
    integer, intent(in) :: n
    real(dp), intent(in) :: dstrain(soil_points,4)   !! strain increment [-], tension +
    real(dp), intent(in) :: before(soil_points,4)    !! stress [Pa], tension +
    real(dp), intent(inout) :: stress(soil_points,4) !! before + C : dstrain [Pa]
    real(dp) :: volumetric, two_g
    integer :: i

    two_g = 2.0_dp*elastic%shear
    do i = 1, n
      volumetric = elastic%lame*(dstrain(i, 1) + dstrain(i, 2) + dstrain(i, 3))
      stress(i, 1) = before(i, 1) + volumetric + two_g*dstrain(i, 1)
      stress(i, 2) = before(i, 2) + volumetric + two_g*dstrain(i, 2)
      stress(i, 3) = before(i, 3) + volumetric + two_g*dstrain(i, 3)
      stress(i, 4) = before(i, 4) + two_g*dstrain(i, 4)
    end do
  end subroutine elastic_adds

  !> Stored elastic energy density 1/2 stress : C^-1 : stress at n points of a block.
  pure subroutine elastic_energies(elastic, n, stress, energy)
    type(elastic_t), intent(in) :: elastic
    integer, intent(in) :: n
    real(dp), intent(in) :: stress(soil_points,4) !! stress [Pa]
    real(dp), intent(inout) :: energy(n)          !! [J/m3]
    real(dp), parameter :: third = 1.0_dp/3.0_dp
    real(dp) :: mean, deviatoric
    integer :: i

    do i = 1, n
      mean = (stress(i, 1) + stress(i, 2) + stress(i, 3))*third
      deviatoric = (stress(i, 1) - mean)**2 + (stress(i, 2) - mean)**2 &
        + (stress(i, 3) - mean)**2 + 2.0_dp*stress(i, 4)*stress(i, 4)
      energy(i) = 0.5_dp*(mean*mean*elastic%over_bulk + deviatoric*elastic%over_shear)
    end do
  end subroutine elastic_energies

  !> Elastic energy density a : C^-1 : b of two stresses at n points of a block, without the half.
  pure subroutine elastic_bilinears(elastic, n, a, b, energy)
    type(elastic_t), intent(in) :: elastic
    integer, intent(in) :: n
    real(dp), intent(in) :: a(soil_points,4) !! stress [Pa]
    real(dp), intent(in) :: b(soil_points,4) !! stress [Pa]
    real(dp), intent(inout) :: energy(n)     !! [J/m3]
    real(dp), parameter :: third = 1.0_dp/3.0_dp
    real(dp) :: mean_a, mean_b, deviatoric
    integer :: i

    do i = 1, n
      mean_a = (a(i, 1) + a(i, 2) + a(i, 3))*third
      mean_b = (b(i, 1) + b(i, 2) + b(i, 3))*third
      deviatoric = (a(i, 1) - mean_a)*(b(i, 1) - mean_b) + (a(i, 2) - mean_a)*(b(i, 2) - mean_b) &
        + (a(i, 3) - mean_a)*(b(i, 3) - mean_b) + 2.0_dp*a(i, 4)*b(i, 4)
      energy(i) = mean_a*mean_b*elastic%over_bulk + deviatoric*elastic%over_shear
    end do
  end subroutine elastic_bilinears

  !> Elastic tangent for the stable step: dP = J dsigma F^-T of a change dF at F, with
  !! dsigma = C : sym(dF F^-1) + K_w tr(dF F^-1) 1. The geometric terms, of the order of
  !! stress over modulus, are left out.
  pure subroutine elastic_piola_tangent(elastic, water_bulk, f, df, dpiola)
    type(elastic_t), intent(in) :: elastic
    real(dp), intent(in) :: water_bulk !! added volumetric modulus of the pore water [Pa], >= 0
    real(dp), intent(in) :: f(4)       !! deformation gradient [-], det > 0
    real(dp), intent(in) :: df(4)      !! change of the deformation gradient [-]
    real(dp), intent(out) :: dpiola(4) !! change of the first Piola stress [Pa]
    real(dp) :: inv, h11, h12, h21, h22, dstrain(4), dstress(4)

    inv = 1.0_dp/(f(1)*f(4) - f(2)*f(3))
    h11 = (df(1)*f(4) - df(2)*f(3))*inv
    h12 = (df(2)*f(1) - df(1)*f(2))*inv
    h21 = (df(3)*f(4) - df(4)*f(3))*inv
    h22 = (df(4)*f(1) - df(3)*f(2))*inv
    dstrain = [h11, h22, 0.0_dp, 0.5_dp*(h12 + h21)]
    dstress = water_bulk*(h11 + h22)
    dstress(4) = 0.0_dp
    call elastic_add(elastic, dstrain, dstress)
    call piola_stress(f, dstress, dpiola)
  end subroutine elastic_piola_tangent
end module talus_elastic
