! SPDX-License-Identifier: MIT
!> The tie of the levels (src/THEORY.md (4.10b)): intact soil resists what the second level does not
!> see of the first by its own elastic moduli. Both ends of a pair have the same.
module talus_tie
  use talus_kinds, only: dp
  implicit none
  private
  public :: tie_t, tie_build

  type :: tie_t
    real(dp), allocatable :: shear(:)  !! root of 4 mu [Pa^1/2], (n)
    real(dp), allocatable :: volume(:) !! (lambda + mu)/mu [-], (n)
  end type tie_t

contains

  !> Moduli of every node.
  pure subroutine tie_build(tie, youngs_modulus, poisson_ratio)
    type(tie_t), intent(out) :: tie
    real(dp), intent(in) :: youngs_modulus(:) !! at each node [Pa], (n)
    real(dp), intent(in) :: poisson_ratio(:)  !! at each node [-], (n)

    tie%shear = sqrt(2.0_dp*youngs_modulus/(1.0_dp + poisson_ratio))
    tie%volume = 1.0_dp/(1.0_dp - 2.0_dp*poisson_ratio)
  end subroutine tie_build
end module talus_tie
