! SPDX-License-Identifier: MIT
!> Which nodes hang together: no force passes between parts of a model that share no shape function.
module talus_bodies
  use talus_scni, only: scni_t
  implicit none
  private
  public :: bodies_of

contains

  !> Number of the body of each node, from 1.
  function bodies_of(scni) result(body)
    type(scni_t), intent(in) :: scni
    integer, allocatable :: body(:)
    integer, allocatable :: waiting(:)
    integer :: start, i, n, bodies

    n = size(scni%cell_offset) - 1
    allocate (body(n), waiting(n))
    body = 0
    bodies = 0
    do start = 1, size(body)
      if (body(start) > 0) cycle
      bodies = bodies + 1
      body(start) = bodies
      waiting(1) = start
      n = 1
      do while (n > 0)
        i = waiting(n)
        n = n - 1
        call take(scni%node(scni%cell_offset(i):scni%cell_offset(i+1)-1))
        call take(scni%cell(scni%node_offset(i):scni%node_offset(i+1)-1))
      end do
    end do

  contains

    !> Neighbours not met before belong to the body and have neighbours to look at.
    subroutine take(neighbour)
      integer, intent(in) :: neighbour(:)
      integer :: k

      do k = 1, size(neighbour)
        if (body(neighbour(k)) > 0) cycle
        body(neighbour(k)) = bodies
        n = n + 1
        waiting(n) = neighbour(k)
      end do
    end subroutine take
  end function bodies_of
end module talus_bodies
