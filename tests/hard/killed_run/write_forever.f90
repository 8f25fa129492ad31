! SPDX-License-Identifier: MIT
!> Writes snapshots, states to start from, history and summary as fast as it can, until somebody
!> kills it, or as many as its argument says.
program write_forever
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_failed
  use talus_result, only: result_t, result_create, result_write_text, result_write_mesh, &
    snapshot_begin, snapshot_field, snapshot_end
  use talus_history, only: history_t, history_create, history_add, history_store
  use talus_restart, only: restart_t, restart_write
  use talus_state, only: state_t
  use talus_summary, only: summary_t, summary_create, summary_set, summary_write
  implicit none
  integer, parameter :: nx = 60, ny = 50, n = nx*ny, ne = (nx - 1)*(ny - 1), rows = 90
  type(status_t) :: status
  type(result_t) :: result
  type(history_t) :: history
  type(summary_t) :: summary
  type(state_t) :: state
  type(restart_t) :: restart
  real(dp) :: nodes(2, n), tensor(4, n)
  integer :: offset(ne+1), corners(4*ne), i, j, e, step, steps
  character(6) :: name
  character(12) :: argument

  call get_command_argument(1, argument)
  steps = huge(steps)
  if (len_trim(argument) > 0) read (argument, *) steps
  do j = 1, ny
    do i = 1, nx
      nodes(:, i + nx*(j-1)) = [real(i, dp), real(j, dp)]
    end do
  end do
  e = 0
  do j = 1, ny - 1
    do i = 1, nx - 1
      offset(e+1) = 4*e + 1
      corners(4*e+1:4*e+4) = i + nx*(j-1) + [0, 1, nx + 1, nx]
      e = e + 1
    end do
  end do
  offset(ne+1) = 4*ne + 1
  call result_create(result, 'killed.h5', 400, .true., .true., status)
  call result_write_text(result, '/deck/text', '&run /', status)
  call result_write_mesh(result, nodes, spread(1, 1, n), ['silt'], spread(1.0_dp, 1, n), offset, &
    corners, status)
  call history_create(history, 'killed_history.csv', ['energy'], ['J/m'], status)
  call summary_create(summary, 'killed_summary.txt')
  allocate (state%u(2, n), state%stress(4, n))
  do step = 0, steps - 1
    tensor = real(step, dp)
    call snapshot_begin(result, real(step, dp), 'storm', step, status)
    call snapshot_field(result, 'displacement', 'm', 'x, y', spread(tensor(1, :), 1, 2), &
      status)
    call snapshot_field(result, 'stress', 'Pa', 'xx, yy, zz, xy', tensor, status)
    call snapshot_field(result, 'damage', '1', 'damage', tensor(1, :), status)
    call snapshot_end(result, status)
    state%u = tensor(:2, :)
    state%stress = tensor
    write (name, '(i6.6)') step
    call restart_write('killed.h5', name, state, restart, status)
    ! The end of a stage may write the state of the last snapshot once more.
    if (mod(step, 3) == 2) call restart_write('killed.h5', name, state, restart, status)
    do i = 1, rows
      call history_add(history, real(rows*step + i, dp), 'storm', step, [real(2*step, dp)], status)
    end do
    call history_store(history, 'killed.h5', status)
    call summary_set(summary, 'steps', step)
    call summary_write(summary, status)
    if (status_failed(status)) error stop 'writing failed'
  end do
end program write_forever
