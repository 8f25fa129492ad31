! SPDX-License-Identifier: MIT
!> The ground: the laws of all its soils.
module talus_ground
  use talus_kinds, only: dp
  use talus_soil_law, only: soil_law_t
  use talus_water_curve, only: water_curve_t
  implicit none
  private
  public :: ground_t

  type :: ground_t
    real(dp) :: gravity = 0.0_dp                 !! acceleration in -y [m/s2]
    real(dp) :: unit_weight = 0.0_dp             !! of water [N/m3]
    real(dp) :: water_density = 0.0_dp           !! [kg/m3]
    character(64), allocatable :: name(:)        !! of each soil
    type(soil_law_t), allocatable :: law(:)      !! of each soil
    real(dp), allocatable :: density_solid(:)    !! [kg/m3]
    real(dp), allocatable :: porosity(:)         !! n0 [-]
    logical :: wet = .false.                     !! water is modelled; else no rest
    type(water_curve_t), allocatable :: curve(:) !! of each soil
    real(dp), allocatable :: conductivity(:,:)   !! saturated, along x and y [m/s], (2,soils)
    real(dp), allocatable :: storage(:)          !! S_s [1/Pa]
    logical, allocatable :: kozeny_carman(:)     !! conductivity follows porosity
  end type ground_t
end module talus_ground
