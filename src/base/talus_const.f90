! SPDX-License-Identifier: MIT
!> Physical and mathematical constants.
module talus_const
  use talus_kinds, only: dp
  implicit none
  private
  real(dp), parameter, public :: pi = 3.141592653589793_dp
  !> Degrees to radians [rad/deg].
  real(dp), parameter, public :: deg = pi/180.0_dp
  !> Reference atmospheric pressure [Pa].
  real(dp), parameter, public :: p_atmospheric = 101325.0_dp
  !> Millimetres per hour to metres per second.
  real(dp), parameter, public :: mm_per_hour = 1.0e-3_dp/3600.0_dp
end module talus_const
