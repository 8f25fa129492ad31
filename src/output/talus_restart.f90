! SPDX-License-Identifier: MIT
!> All of a state in a result file, so that another run can start from it: the group
!> /restart/NAME beside the snapshot /snapshots/NAME. One list of fields serves writing and reading.
module talus_restart
  use talus_kinds, only: dp, i8
  use talus_status, only: status_t, status_failed
  use talus_state, only: state_t
  use talus_h5, only: h5_file_t, h5_open, h5_close, h5_exists, h5_group_begin, h5_group_end, &
    h5_write
  use talus_h5_read, only: h5_read
  implicit none
  private
  public :: restart_t, restart_write, restart_read

  !> What a run knows beside the state of its nodes.
  type :: restart_t
    logical :: lost = .false.           !! the latest storm ended in failure
    logical :: failed = .false.         !! some storm ended in failure
    real(dp) :: trigger_time = -1.0_dp  !! when equilibrium was lost first [s]; -1: never
    real(dp) :: greatest_displacement = 0.0_dp !! since displacements were last reset [m]
    real(dp) :: stride = 0.0_dp, last = 0.0_dp !! steps of the water, see seepage_t [s]
    real(dp), allocatable :: mode(:,:)  !! fastest mode when last looked for, (2,n)
    character(:), allocatable :: missing !! reading: parts that the file lacks, ', ' between
    character(:), allocatable :: surplus !! reading: parts that the run has no place for
  end type restart_t

  !> Numbers of the dataset `scalars`, in the order of `exchange_scalars`.
  integer, parameter :: scalar_count = 18

  !> A file being written or read.
  type :: exchange_t
    type(h5_file_t) :: file
    logical :: writes = .false.
    character(:), allocatable :: group            !! path before the names of datasets
    character(:), allocatable :: missing, surplus !! see restart_t
  end type exchange_t

contains

  !> Write a state under the name of its snapshot; what was there before is replaced.
  subroutine restart_write(path, name, state, restart, status)
    character(*), intent(in) :: path !! of the result file
    character(*), intent(in) :: name !! of the snapshot
    type(state_t), intent(inout) :: state     !! is not changed
    type(restart_t), intent(inout) :: restart !! is not changed
    type(status_t), intent(inout) :: status
    type(exchange_t) :: exchange

    exchange%writes = .true.
    exchange%group = ''
    call h5_open(exchange%file, path, status)
    call h5_group_begin(exchange%file, status)
    call exchange_all(exchange, state, restart, status)
    call h5_group_end(exchange%file, '/restart/'//name, status, replace=.true.)
    call h5_close(exchange%file, status)
  end subroutine restart_write

  !> Read a state. `state` comes allocated as the run needs it; where the file has less or more than
  !> that, the parts are named in restart%missing and restart%surplus, and the state is of no use.
  subroutine restart_read(path, name, state, restart, status)
    character(*), intent(in) :: path !! of the result file
    character(*), intent(in) :: name !! of the snapshot
    type(state_t), intent(inout) :: state
    type(restart_t), intent(out) :: restart
    type(status_t), intent(inout) :: status
    type(exchange_t) :: exchange

    exchange%group = '/restart/'//name//'/'
    exchange%missing = ''
    exchange%surplus = ''
    call h5_open(exchange%file, path, status, read_only=.true.)
    allocate (restart%mode(2, size(state%u, 2)), source=0.0_dp)
    call exchange_all(exchange, state, restart, status)
    if (.not. any(abs(restart%mode) > 0.0_dp)) deallocate (restart%mode)
    call h5_close(exchange%file, status)
    restart%missing = exchange%missing
    restart%surplus = exchange%surplus
  end subroutine restart_read

  !> Every part of the state, in one order for both directions.
  subroutine exchange_all(x, state, restart, status)
    type(exchange_t), intent(inout) :: x
    type(state_t), intent(inout) :: state
    type(restart_t), intent(inout) :: restart
    type(status_t), intent(inout) :: status
    logical :: soil

    call exchange_scalars(x, state, restart, status)
    call field_2(x, 'u', 'displacement', state%u, status)
    call field_2(x, 'f', 'deformation gradient', state%f, status)
    call field_1(x, 'jacobian', 'water', state%jacobian, status)
    call field_1(x, 'content', 'water', state%content, status)
    call field_1(x, 'pressure', 'water', state%pressure, status)
    call field_1(x, 'saturation', 'water', state%saturation, status)
    call field_1(x, 'ratio', 'water', state%ratio, status)
    call field_1(x, 'potential', 'water', state%potential, status)
    call field_1(x, 'capacity', 'water', state%capacity, status)
    call field_1(x, 'suction', 'water', state%suction, status)
    ! A run of the water alone keeps no soil: what starts from it starts with soil at rest.
    soil = allocated(state%stress)
    if (.not. x%writes) soil = h5_exists(x%file, x%group//'stress')
    if (soil) call exchange_soil(x, state, restart, status)
  end subroutine exchange_all

  !> What only soil that moves has.
  subroutine exchange_soil(x, state, restart, status)
    type(exchange_t), intent(inout) :: x
    type(state_t), intent(inout) :: state
    type(restart_t), intent(inout) :: restart
    type(status_t), intent(inout) :: status
    real(dp), allocatable :: mode(:,:)

    call field_1(x, 'water_work', 'work of pore water', state%water_work, status)
    call field_2(x, 'u_zero', 'displacement', state%u_zero, status)
    call field_2(x, 'v', 'velocity', state%v, status)
    call field_2(x, 'acceleration', 'velocity', state%acceleration, status)
    call field_2(x, 'f_drive', 'smoothed gradient of damage', state%f_drive, status)
    call field_2(x, 'stress', 'stress', state%stress, status)
    call field_2(x, 'strain', 'strain that drives damage', state%strain, status)
    call field_2(x, 'history', 'plasticity and damage', state%history, status)
    call field_1(x, 'opening', 'crack closure', state%opening, status)
    call field_1(x, 'stiffness', 'stabilisation', state%stiffness, status)
    call field_1(x, 'stiffness_old', 'stabilisation', state%stiffness_old, status)
    if (.not. x%writes .and. allocated(state%stiffness)) then
      if (h5_exists(x%file, x%group//'settled')) state%settled = 0.0_dp*state%stiffness
    end if
    call field_1(x, 'settled', 'stabilisation', state%settled, status)
    call field_1(x, 'stabilising', 'stabilisation', state%stabilising, status)
    call field_1(x, 'stabilising_lost', 'stabilisation', state%stabilising_lost, status)
    call field_1(x, 'intact', 'tie of the levels', state%intact, status)
    call field_1(x, 'between', 'tie of the levels', state%between, status)
    call field_1(x, 'between_old', 'tie of the levels', state%between_old, status)
    call field_2(x, 'tied', 'tie of the levels', state%tied, status)
    call field_1(x, 'volume_work', 'stress', state%volume_work, status)
    call field_1(x, 'damped', 'velocity', state%damped, status)
    call field_1(x, 'mass', 'velocity', state%mass, status)
    call field_2(x, 'load', 'displacement', state%load, status)
    call field_2(x, 'u_load', 'displacement', state%u_load, status)
    ! A run that never looked for the fastest mode of its soil has none: zeros in the file.
    mode = 0.0_dp*state%u
    if (allocated(restart%mode)) mode = restart%mode
    call field_2(x, 'mode', 'displacement', mode, status)
    if (.not. x%writes) restart%mode = mode
  end subroutine exchange_soil

  !> Numbers that are not fields.
  subroutine exchange_scalars(x, state, restart, status)
    type(exchange_t), intent(inout) :: x
    type(state_t), intent(inout) :: state
    type(restart_t), intent(inout) :: restart
    type(status_t), intent(inout) :: status
    real(dp), allocatable :: s(:)

    associate (water => state%water)
      if (x%writes) then
        s = [state%time, real(state%steps, dp), real(state%seepage_steps, dp), state%ahead, &
             state%external, water%stored_start, water%inflow, water%outflow, water%runoff, &
             water%inflow_lost, water%outflow_lost, water%runoff_lost, &
             merge(1.0_dp, 0.0_dp, restart%lost), merge(1.0_dp, 0.0_dp, restart%failed), &
             restart%trigger_time, restart%greatest_displacement, restart%stride, restart%last]
        call h5_write(x%file, 'scalars', s, status)
        return
      end if
      allocate (s(scalar_count), source=0.0_dp)
      call field_1(x, 'scalars', 'time', s, status)
      state%time = s(1)
      state%steps = nint(s(2), i8)
      state%seepage_steps = nint(s(3), i8)
      state%ahead = s(4)
      state%external = s(5)
      water%stored_start = s(6)
      water%inflow = s(7)
      water%outflow = s(8)
      water%runoff = s(9)
      water%inflow_lost = s(10)
      water%outflow_lost = s(11)
      water%runoff_lost = s(12)
      restart%lost = s(13) > 0.5_dp
      restart%failed = s(14) > 0.5_dp
      restart%trigger_time = s(15)
      restart%greatest_displacement = s(16)
      restart%stride = s(17)
      restart%last = s(18)
    end associate
  end subroutine exchange_scalars

  !> Write a field that is there, or read one for which there is a place.
  subroutine field_1(x, name, part, data, status)
    type(exchange_t), intent(inout) :: x
    character(*), intent(in) :: name !! of the dataset
    character(*), intent(in) :: part !! what it belongs to, for messages
    real(dp), allocatable, intent(inout) :: data(:)
    type(status_t), intent(inout) :: status
    real(dp), allocatable :: found(:)

    if (status_failed(status)) return
    if (x%writes) then
      if (allocated(data)) call h5_write(x%file, name, data, status)
    else if (has_place(x, name, part, allocated(data))) then
      call h5_read(x%file, x%group//name, found, status)
      if (size(found) == size(data)) then
        data = found
      else
        call add(x%missing, part)
      end if
    end if
  end subroutine field_1

  !> The same for a field of several components.
  subroutine field_2(x, name, part, data, status)
    type(exchange_t), intent(inout) :: x
    character(*), intent(in) :: name !! of the dataset
    character(*), intent(in) :: part !! what it belongs to, for messages
    real(dp), allocatable, intent(inout) :: data(:,:)
    type(status_t), intent(inout) :: status
    real(dp), allocatable :: found(:,:)

    if (status_failed(status)) return
    if (x%writes) then
      if (allocated(data)) call h5_write(x%file, name, data, status)
    else if (has_place(x, name, part, allocated(data))) then
      call h5_read(x%file, x%group//name, found, status)
      if (all(shape(found) == shape(data))) then
        data = found
      else if (size(found, 1) > size(data, 1)) then
        call add(x%surplus, part)
      else
        call add(x%missing, part)
      end if
    end if
  end subroutine field_2

  !> True when a field is in the file and has a place in the run; notes where only one holds.
  logical function has_place(x, name, part, wanted)
    type(exchange_t), intent(inout) :: x
    character(*), intent(in) :: name, part
    logical, intent(in) :: wanted
    logical :: found

    found = h5_exists(x%file, x%group//name)
    has_place = found .and. wanted
    if (wanted .and. .not. found) call add(x%missing, part)
    if (found .and. .not. wanted) call add(x%surplus, part)
  end function has_place

  !> Add a part to a list that does not have it yet.
  pure subroutine add(list, part)
    character(:), allocatable, intent(inout) :: list
    character(*), intent(in) :: part

    if (index(', '//list//',', ', '//part//',') > 0) return
    if (len(list) > 0) list = list//', '
    list = list//part
  end subroutine add
end module talus_restart
