! SPDX-License-Identifier: MIT
!> The ground with its strength divided by a factor (src/THEORY.md section 5.9).
module talus_reduced_ground
  use talus_kinds, only: dp
  use talus_status, only: status_t
  use talus_ground, only: ground_t
  use talus_soil_law, only: soil_law_prepare
  implicit none
  private
  public :: reduced_ground

contains

  !> The same ground with cohesion (that of suction too) and tan(phi) of every soil divided by a
  !> factor, at every plastic strain. Elasticity, damage, water and a tension cut-off stay.
  pure function reduced_ground(ground, factor) result(reduced)
    type(ground_t), intent(in) :: ground !! prepared
    real(dp), intent(in) :: factor       !! F > 0 [-]; 1 gives back the same strength
    type(ground_t) :: reduced
    type(status_t) :: status
    integer :: i

    reduced = ground
    do i = 1, size(reduced%law)
      reduced%law(i)%strength%factor = ground%law(i)%strength%factor*factor
      call soil_law_prepare(reduced%law(i), status)
    end do
  end function reduced_ground
end module talus_reduced_ground
