! SPDX-License-Identifier: MIT
!> Numbers against time: a CSV file with one flushed line a record, and the same columns in the
!> group /history of the result file, brought up to date at each snapshot.
module talus_history
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_set, status_failed, status_io
  use talus_text, only: text_of
  use talus_h5, only: h5_file_t, h5_open, h5_close, h5_attribute, h5_group_begin, h5_group_end
  use talus_h5_append, only: h5_append, h5_append_series, h5_start_series, h5_series_letters
  implicit none
  private
  public :: history_create, history_add, history_store, history_close

  !> Letters of a column's name and of its unit: those of a boundary's name, and what is about it.
  integer, parameter, public :: history_name_letters = 80

  !> Records for which the result file has room at first.
  integer, parameter :: least_room = 512

  !> A history being written. Its first columns are always time, stage and step.
  type, public :: history_t
    private
    character(:), allocatable :: path                          !! of the CSV file
    character(history_name_letters), allocatable :: names(:)   !! of the further columns
    character(history_name_letters), allocatable :: units(:)   !! of the further columns, 1 for none
    integer :: unit = -1                                       !! of the open CSV file
    integer :: stored = 0                                      !! records in the result file
    integer :: room = 0                                        !! records it can take as it is
    integer :: rows = 0                                        !! not yet in the result file
    real(dp), allocatable :: time(:), values(:,:)              !! [s], (rows, columns)
    integer, allocatable :: step(:)
    character(h5_series_letters), allocatable :: stage(:)
  end type history_t

contains

  !> Open the CSV file, replacing an older one, and write its header: name[unit],...
  subroutine history_create(history, path, names, units, status)
    type(history_t), intent(out) :: history
    character(*), intent(in) :: path     !! of the CSV file
    character(*), intent(in) :: names(:) !! of the columns after time, stage and step
    character(*), intent(in) :: units(:) !! of these columns, 1 for none
    type(status_t), intent(inout) :: status
    character(:), allocatable :: header
    character(256) :: reason
    integer :: i, failed

    history%path = path
    history%names = names
    history%units = units
    allocate (history%time(64), history%stage(64), history%step(64))
    allocate (history%values(64, size(names)))
    if (status_failed(status)) return
    header = 'time[s],stage,step'
    do i = 1, size(names)
      header = header//','//trim(names(i))
      if (units(i) /= '1') header = header//'['//trim(units(i))//']'
    end do
    open (newunit=history%unit, file=path, status='replace', action='write', iostat=failed, &
      iomsg=reason)
    if (failed /= 0) history%unit = -1
    if (failed == 0) write (history%unit, '(a)', iostat=failed, iomsg=reason) header
    if (failed == 0) flush (history%unit, iostat=failed, iomsg=reason)
    if (failed /= 0) call fail(history, reason, status)
  end subroutine history_create

  subroutine fail(history, reason, status)
    type(history_t), intent(in) :: history
    character(*), intent(in) :: reason
    type(status_t), intent(inout) :: status

    call status_set(status, status_io, &
      'history file '''//history%path//''': could not be written: '//trim(reason))
  end subroutine fail

  !> Double the room for records that wait for the next history_store.
  subroutine rows_double(history)
    type(history_t), intent(inout) :: history
    real(dp), allocatable :: time(:), values(:,:)
    integer, allocatable :: step(:)
    character(h5_series_letters), allocatable :: stage(:)
    integer :: n

    n = size(history%time)
    allocate (time(2*n), stage(2*n), step(2*n), values(2*n, size(history%names)))
    time(:n) = history%time
    stage(:n) = history%stage
    step(:n) = history%step
    values(:n, :) = history%values
    call move_alloc(time, history%time)
    call move_alloc(stage, history%stage)
    call move_alloc(step, history%step)
    call move_alloc(values, history%values)
  end subroutine rows_double

  !> Add one record, flushed to the CSV file at once.
  subroutine history_add(history, time, stage, step, values, status)
    type(history_t), intent(inout) :: history
    real(dp), intent(in) :: time      !! simulated time [s]
    character(*), intent(in) :: stage !! name of the stage
    integer, intent(in) :: step       !! number of soil steps so far
    real(dp), intent(in) :: values(:) !! in the order of the columns and in their units
    type(status_t), intent(inout) :: status
    character(:), allocatable :: line
    character(256) :: reason
    integer :: i, failed

    if (status_failed(status)) return
    if (size(values) /= size(history%names)) then
      call fail(history, text_of(size(values))//' values for '//text_of(size(history%names))// &
        ' columns', status)
      return
    end if
    if (history%rows == size(history%time)) call rows_double(history)
    history%rows = history%rows + 1
    history%time(history%rows) = time
    history%stage(history%rows) = stage
    history%step(history%rows) = step
    history%values(history%rows, :) = values
    line = number(time)//','//quoted(trim(stage))//','//text_of(step)
    do i = 1, size(values)
      line = line//','//number(values(i))
    end do
    write (history%unit, '(a)', iostat=failed, iomsg=reason) line
    if (failed == 0) flush (history%unit, iostat=failed, iomsg=reason)
    if (failed /= 0) call fail(history, reason, status)
  end subroutine history_add

  !> Seventeen significant digits: reading gives the same number back.
  pure function number(value) result(text)
    real(dp), intent(in) :: value
    character(:), allocatable :: text

    text = text_of(value, 17)
  end function number

  !> A text as one CSV field.
  pure function quoted(text) result(field)
    character(*), intent(in) :: text
    character(:), allocatable :: field
    integer :: i

    field = text
    if (scan(text, ',"') == 0) return
    field = '"'
    do i = 1, len(text)
      if (text(i:i) == '"') field = field//'"'
      field = field//text(i:i)
    end do
    field = field//'"'
  end function quoted

  !> Append the records since the last call to the group /history of a result file.
  subroutine history_store(history, h5_path, status)
    type(history_t), intent(inout) :: history
    character(*), intent(in) :: h5_path !! of the result file, closed at the moment
    type(status_t), intent(inout) :: status
    type(h5_file_t) :: file

    if (status_failed(status)) return
    call h5_open(file, h5_path, status)
    if (history%stored + history%rows <= history%room) then
      call append_rows(history, file, '/history/', status)
    else
      call rebuild(history, file, status)
    end if
    call h5_close(file, status)
    if (status_failed(status)) return
    history%stored = history%stored + history%rows
    history%rows = 0
  end subroutine history_store

  !> Write the group /history anew, with room for twice as many records at least.
  subroutine rebuild(history, file, status)
    type(history_t), intent(inout) :: history
    type(h5_file_t), intent(inout) :: file
    type(status_t), intent(inout) :: status
    integer :: i

    history%room = max(least_room, 2*(history%stored + history%rows))
    call h5_group_begin(file, status)
    call h5_start_series(file, 'time', 'real', history%room, status)
    call h5_attribute(file, 'time', 'units', 's', status)
    call h5_start_series(file, 'stage', 'text', history%room, status)
    call h5_start_series(file, 'step', 'integer', history%room, status)
    do i = 1, size(history%names)
      call h5_start_series(file, trim(history%names(i)), 'real', history%room, status)
      call h5_attribute(file, trim(history%names(i)), 'units', trim(history%units(i)), status)
    end do
    if (history%stored > 0) then
      call h5_append_series(file, 'time', '/history/time', status)
      call h5_append_series(file, 'stage', '/history/stage', status)
      call h5_append_series(file, 'step', '/history/step', status)
      do i = 1, size(history%names)
        call h5_append_series(file, trim(history%names(i)), '/history/'//trim(history%names(i)), &
          status)
      end do
    end if
    call append_rows(history, file, '', status)
    call h5_group_end(file, '/history', status, replace=.true.)
  end subroutine rebuild

  !> Append the records that are not yet in the file.
  subroutine append_rows(history, file, group, status)
    type(history_t), intent(in) :: history
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: group !! path before the names of the series
    type(status_t), intent(inout) :: status
    integer :: i

    associate (n => history%rows)
      call h5_append(file, group//'time', history%time(:n), status)
      call h5_append(file, group//'stage', history%stage(:n), status)
      call h5_append(file, group//'step', history%step(:n), status)
      do i = 1, size(history%names)
        call h5_append(file, group//trim(history%names(i)), history%values(:n, i), status)
      end do
    end associate
  end subroutine append_rows

  !> Close the CSV file.
  subroutine history_close(history, status)
    type(history_t), intent(inout) :: history
    type(status_t), intent(inout) :: status
    character(256) :: reason
    integer :: failed

    if (history%unit == -1) return
    close (history%unit, iostat=failed, iomsg=reason)
    if (failed /= 0) call fail(history, reason, status)
    history%unit = -1
  end subroutine history_close
end module talus_history
