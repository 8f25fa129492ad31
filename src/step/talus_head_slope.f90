! SPDX-License-Identifier: MIT
!> Gradient of head in the cells, as seepage sees it (src/THEORY.md section 4.6).
module talus_head_slope
  use talus_kinds, only: dp
  use talus_disc, only: disc_t
  use talus_strain, only: strain_first
  implicit none
  private
  public :: head_slope

  !> Least determinant of the moments of a cell's neighbours, over their trace squared, for a
  !> gradient in all directions; 1/4 for a cross, 0 on a line.
  real(dp), parameter :: flat = 1.0e-3_dp

contains

  !> Area times reference gradient of head, within a parallel region: the smoothed gradient, but
  !> near another soil that of the neighbours in the cell's own soil, since the head has a kink
  !> there, and the slope in tight soil times the conductivity of open soil is no flux.
  subroutine head_slope(disc, layered, head, slope)
    type(disc_t), intent(in) :: disc
    logical, intent(in) :: layered                    !! there is more than one soil
    real(dp), contiguous, intent(in) :: head(:,:)     !! head in the first row [m], (2,n)
    real(dp), contiguous, intent(inout) :: slope(:,:) !! dx, dy in the first rows [m2], (4,n)
    integer :: i, first, last

    call strain_first(disc%scni, head, slope)
    if (.not. layered) return
    !$omp do schedule(static)
    do i = 1, disc%n
      first = disc%dual%node_offset(i)
      last = disc%dual%node_offset(i+1) - 1
      if (all(disc%soil(disc%scni%node(disc%scni%cell_offset(i):disc%scni%cell_offset(i+1)-1)) &
              == disc%soil(i))) cycle
      slope(1:2, i) = disc%dual%area(i) &
        *own_gradient(disc, head, i, disc%dual%node_neighbour(first:last))
    end do
    !$omp end do
  end subroutine head_slope

  !> Gradient by least squares over the neighbours in the same soil [m/m]; exact where the head is
  !> linear in that soil. Along the line only where they lie on one.
  pure function own_gradient(disc, head, i, neighbours) result(gradient)
    type(disc_t), intent(in) :: disc
    real(dp), contiguous, intent(in) :: head(:,:) !! head in the first row [m], (2,n)
    integer, intent(in) :: i              !! cell
    integer, intent(in) :: neighbours(:)
    real(dp) :: gradient(2), moment(3), right(2), edge(2), trace, determinant
    integer :: k

    moment = 0.0_dp
    right = 0.0_dp
    do k = 1, size(neighbours)
      if (disc%soil(neighbours(k)) /= disc%soil(i)) cycle
      edge = disc%mesh%x(:, neighbours(k)) - disc%mesh%x(:, i)
      edge = edge/norm2(edge)
      moment = moment + [edge(1)**2, edge(2)**2, edge(1)*edge(2)]
      right = right + edge*(head(1, neighbours(k)) - head(1, i)) &
        /norm2(disc%mesh%x(:, neighbours(k)) - disc%mesh%x(:, i))
    end do
    trace = moment(1) + moment(2)
    determinant = moment(1)*moment(2) - moment(3)**2
    gradient = 0.0_dp
    if (determinant > flat*trace**2) then
      gradient = [moment(2)*right(1) - moment(3)*right(2), &
                  moment(1)*right(2) - moment(3)*right(1)]/determinant
    else if (trace > 0.0_dp) then
      gradient = right/trace
    end if
  end function own_gradient
end module talus_head_slope
