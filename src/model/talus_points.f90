! SPDX-License-Identifier: MIT
!> Points that are updated together. The fields of the nodes keep the components of a node side by
!> side, as gathers want them; blocks keep one component of all points after the other, so that
!> loops over the points run straight through memory and compilers turn them into vector
!> instructions.
module talus_points
  use talus_kinds, only: dp
  implicit none
  private
  public :: points_take, points_put, points_alike

  !> Most points in a block: their fields stay in the first cache.
  integer, parameter, public :: soil_points = 64

contains

  !> A block from the fields of n nodes.
  pure subroutine points_take(n, field, block)
    integer, intent(in) :: n
    real(dp), intent(in) :: field(4,n)             !! by node
    real(dp), intent(inout) :: block(soil_points,4) !! by component; points after n are left
    integer :: i

    do i = 1, n
      block(i, 1) = field(1, i)
      block(i, 2) = field(2, i)
      block(i, 3) = field(3, i)
      block(i, 4) = field(4, i)
    end do
  end subroutine points_take

  !> The way back.
  pure subroutine points_put(n, block, field)
    integer, intent(in) :: n
    real(dp), intent(in) :: block(soil_points,4) !! by component
    real(dp), intent(inout) :: field(4,n)        !! by node
    integer :: i

    do i = 1, n
      field(1, i) = block(i, 1)
      field(2, i) = block(i, 2)
      field(3, i) = block(i, 3)
      field(4, i) = block(i, 4)
    end do
  end subroutine points_put

  !> How many points from the first on are of its soil.
  pure integer function points_alike(soil) result(n)
    integer, intent(in) :: soil(:)

    do n = 1, size(soil) - 1
      if (soil(n+1) /= soil(1)) return
    end do
    n = size(soil)
  end function points_alike
end module talus_points
