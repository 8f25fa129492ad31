! SPDX-License-Identifier: MIT
!> Small runs for the suites: a column of silt from its deck to its results, and what they hold.
module runs
  use, intrinsic :: iso_c_binding, only: c_char, c_int, c_null_char
  use, intrinsic :: iso_fortran_env, only: output_unit
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_failed
  use talus_deck_types, only: deck_t
  use talus_deck_messages, only: messages_t, messages_text
  use talus_deck, only: deck_load_text
  use talus_session, only: session_t
  use talus_state, only: state_t
  use talus_run, only: run_prepare, run_open
  use talus_stages, only: stage_run
  use talus_history, only: history_close
  use talus_file, only: file_delete
  use talus_h5, only: h5_file_t, h5_open, h5_close, h5_exists
  implicit none
  private
  public :: column, column_retention, column_water, column_weight, load_deck, prepare, run_stages
  public :: delete_results
  public :: result_has, content, value_of, state_difference, write_text
  public :: capture_start, capture_end

  character, parameter :: nl = new_line('a')

  !> Water for a column, and the same in equilibrium with a water table at its base.
  character(*), parameter :: column_retention = &
    '&water retention = "van_genuchten" alpha = 1.0 n = 2.0 conductivity_x = 1e-5 /'//nl
  character(*), parameter :: column_water = column_retention// &
    '&initial pore_pressure = "hydrostatic" water_table = 0.0 /'//nl

  !> Unit weight of its dry soil [N/m3].
  real(dp), parameter :: column_weight = 2650.0_dp*0.6_dp*9.81_dp

  !> Where standard output went before it was caught.
  integer(c_int), save :: kept = -1_c_int

  interface
    integer(c_int) function c_creat(path, mode) bind(c, name='creat')
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int), value :: mode
    end function c_creat

    integer(c_int) function c_dup(descriptor) bind(c, name='dup')
      import :: c_int
      integer(c_int), value :: descriptor
    end function c_dup

    integer(c_int) function c_dup2(from, to) bind(c, name='dup2')
      import :: c_int
      integer(c_int), value :: from, to
    end function c_dup2

    integer(c_int) function c_close(descriptor) bind(c, name='close')
      import :: c_int
      integer(c_int), value :: descriptor
    end function c_close
  end interface

contains

  !> Deck of a column of silt, 1 m wide and 4 m high with 3 x 9 nodes, on a fixed base between
  !> rollers.
  pure function column(soil, rest) result(text)
    character(*), intent(in) :: soil !! more of its keys
    character(*), intent(in) :: rest !! stages and what else there is
    character(:), allocatable :: text

    text = '&geometry kind = "box" width = 1.0 height = 4.0 /'//nl//'&nodes spacing = 0.5 /'//nl// &
      '&soil name = "silt" porosity = 0.4 youngs_modulus = 1e8 poisson_ratio = 0.3'//nl//'  '// &
      soil//' /'//nl//'&boundary name = "base" where = "bottom" displacement = "fixed" /'//nl// &
      '&boundary where = "left" displacement = "roller_x" /'//nl// &
      '&boundary where = "right" displacement = "roller_x" /'//nl//rest
  end function column

  !> A deck that must be sound.
  subroutine load_deck(text, deck)
    character(*), intent(in) :: text
    type(deck_t), intent(out) :: deck
    type(messages_t) :: messages
    type(status_t) :: status

    call deck_load_text(text, 'model.nml', deck, messages, status)
    if (.not. status_failed(status)) return
    write (*, '(a)') messages_text(messages)
    error stop 'load_deck failed'
  end subroutine load_deck

  !> A session that is ready to run.
  subroutine prepare(text, session)
    character(*), intent(in) :: text !! deck
    type(session_t), intent(out) :: session
    type(deck_t) :: deck
    type(status_t) :: status

    call load_deck(text, deck)
    call run_prepare(deck, session, status)
    if (.not. status_failed(status)) return
    write (*, '(a)') status%message
    error stop 'prepare failed'
  end subroutine prepare

  !> Run the first stages of a session that is ready, and write its results.
  subroutine run_stages(session, base, stages, status)
    type(session_t), intent(inout) :: session
    character(*), intent(in) :: base  !! path of the results without ending
    integer, intent(in) :: stages     !! how many
    type(status_t), intent(inout) :: status
    type(status_t) :: closing
    integer :: i

    session%base = base
    call run_open(session, .true., status)
    do i = 1, stages
      if (status_failed(status)) exit
      call stage_run(session, i, status)
    end do
    call history_close(session%history, closing)
  end subroutine run_stages

  !> Delete all that a run writes.
  subroutine delete_results(base)
    character(*), intent(in) :: base !! path of the results without ending

    call file_delete(base//'.h5')
    call file_delete(base//'.xdmf')
    call file_delete(base//'_history.csv')
    call file_delete(base//'_summary.txt')
  end subroutine delete_results

  !> True when the result file of a run has an object.
  logical function result_has(base, name)
    character(*), intent(in) :: base !! path of the results without ending
    character(*), intent(in) :: name !! path in the file
    type(h5_file_t) :: file
    type(status_t) :: status

    call h5_open(file, base//'.h5', status, read_only=.true.)
    result_has = h5_exists(file, name)
    call h5_close(file, status)
  end function result_has

  !> Text of a file.
  function content(path) result(text)
    character(*), intent(in) :: path
    character(:), allocatable :: text
    integer :: unit, bytes

    inquire (file=path, size=bytes)
    allocate (character(max(0, bytes)) :: text)
    if (bytes <= 0) return
    open (newunit=unit, file=path, access='stream', form='unformatted', action='read')
    read (unit) text
    close (unit)
  end function content

  !> Give a file a text.
  subroutine write_text(path, text)
    character(*), intent(in) :: path, text
    integer :: unit

    open (newunit=unit, file=path, action='write', status='replace')
    write (unit, '(a)') text
    close (unit)
  end subroutine write_text

  !> What follows `key` on the first line that begins with it, '(none)' where no line does.
  function value_of(text, key) result(value)
    character(*), intent(in) :: text !! lines ended by newlines
    character(*), intent(in) :: key  !! with what stands between it and the value: 'nodes = '
    character(:), allocatable :: value
    integer :: first

    value = '(none)'
    first = index(nl//text, nl//key)
    if (first == 0) return
    value = text(first+len(key):)
    value = value(:index(value//nl, nl)-1)
  end function value_of

  !> Name of the first part in which two states are not the same bits, '' for none.
  function state_difference(one, other) result(name)
    type(state_t), intent(in) :: one, other
    character(:), allocatable :: name

    name = ''
    if (one%steps /= other%steps .or. one%seepage_steps /= other%seepage_steps) name = 'steps'
    call compare('clock and work', [one%time, one%ahead, one%external], &
                 [other%time, other%ahead, other%external])
    associate (a => one%water, b => other%water)
      call compare('water balance', [a%stored_start, a%inflow, a%outflow, a%runoff, &
        a%inflow_lost, a%outflow_lost, a%runoff_lost], [b%stored_start, b%inflow, b%outflow, &
        b%runoff, b%inflow_lost, b%outflow_lost, b%runoff_lost])
    end associate
    call compare_2('u', one%u, other%u)
    call compare_2('u_zero', one%u_zero, other%u_zero)
    call compare_2('v', one%v, other%v)
    call compare_2('acceleration', one%acceleration, other%acceleration)
    call compare_2('f', one%f, other%f)
    call compare_2('f_drive', one%f_drive, other%f_drive)
    call compare_2('stress', one%stress, other%stress)
    call compare_2('strain', one%strain, other%strain)
    call compare_2('history', one%history, other%history)
    call compare_2('load', one%load, other%load)
    call compare_2('u_load', one%u_load, other%u_load)
    call compare_1('stiffness', one%stiffness, other%stiffness)
    call compare_1('stiffness_old', one%stiffness_old, other%stiffness_old)
    call compare_1('settled', one%settled, other%settled)
    call compare_1('stabilising', one%stabilising, other%stabilising)
    call compare_1('stabilising_lost', one%stabilising_lost, other%stabilising_lost)
    call compare_1('volume_work', one%volume_work, other%volume_work)
    call compare_1('damped', one%damped, other%damped)
    call compare_1('mass', one%mass, other%mass)
    call compare_1('jacobian', one%jacobian, other%jacobian)
    call compare_1('content', one%content, other%content)
    call compare_1('pressure', one%pressure, other%pressure)
    call compare_1('saturation', one%saturation, other%saturation)
    call compare_1('ratio', one%ratio, other%ratio)
    call compare_1('potential', one%potential, other%potential)
    call compare_1('capacity', one%capacity, other%capacity)
    call compare_1('suction', one%suction, other%suction)
    call compare_1('water_work', one%water_work, other%water_work)

  contains

    subroutine compare(part, a, b)
      character(*), intent(in) :: part
      real(dp), intent(in) :: a(:), b(:)

      if (len(name) > 0) return
      if (size(a) /= size(b)) then
        name = part
      else if (.not. all(abs(a - b) <= 0.0_dp)) then
        name = part
      end if
    end subroutine compare

    subroutine compare_1(part, a, b)
      character(*), intent(in) :: part
      real(dp), allocatable, intent(in) :: a(:), b(:)

      if (len(name) == 0 .and. (allocated(a) .neqv. allocated(b))) name = part
      if (allocated(a) .and. allocated(b)) call compare(part, a, b)
    end subroutine compare_1

    subroutine compare_2(part, a, b)
      character(*), intent(in) :: part
      real(dp), allocatable, intent(in) :: a(:,:), b(:,:)

      if (len(name) == 0 .and. (allocated(a) .neqv. allocated(b))) name = part
      if (allocated(a) .and. allocated(b)) call compare(part, [a], [b])
    end subroutine compare_2
  end function state_difference

  !> Send what is printed to a file, until capture_end.
  subroutine capture_start(path)
    character(*), intent(in) :: path
    integer(c_int) :: file, done

    flush (output_unit)
    kept = c_dup(1_c_int)
    file = c_creat(path//c_null_char, int(o'600', c_int))
    done = c_dup2(file, 1_c_int)
    if (min(kept, file, done) < 0_c_int) error stop 'capture_start failed'
    done = c_close(file)
  end subroutine capture_start

  subroutine capture_end()
    integer(c_int) :: done

    flush (output_unit)
    done = c_dup2(kept, 1_c_int)
    done = c_close(kept)
  end subroutine capture_end
end module runs
