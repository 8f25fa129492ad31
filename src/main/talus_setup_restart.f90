! SPDX-License-Identifier: MIT
!> Start from a state that another run has saved (src/THEORY.md section 5.10). Whatever does not
!> fit is told at once.
module talus_setup_restart
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_set, status_failed, status_deck
  use talus_text, only: text_of
  use talus_session, only: session_t
  use talus_disc, only: disc_t
  use talus_h5, only: h5_file_t, h5_open, h5_close, h5_exists, h5_names, h5_name_letters
  use talus_h5_read, only: h5_read
  use talus_restart, only: restart_t, restart_read
  implicit none
  private
  public :: setup_restart

  !> Distance of two nodes that count as the same, over the size of the body.
  real(dp), parameter :: same_place = 1.0e-9_dp
  character(*), parameter :: new_line = achar(10)

  !> Lines that tell what does not fit.
  type :: problems_t
    character(:), allocatable :: path !! of the deck
    character(:), allocatable :: text
  end type problems_t

contains

  !> Take the state, its time and what the earlier run knew. The state is allocated already.
  subroutine setup_restart(session, status)
    type(session_t), intent(inout) :: session
    type(status_t), intent(inout) :: status
    type(h5_file_t) :: file
    type(status_t) :: opening, closing, reading
    type(restart_t) :: restart
    type(problems_t) :: problems
    character(:), allocatable :: name, given

    associate (initial => session%deck%initial)
      problems%path = session%deck%path
      problems%text = ''
      given = 'from_result = '''//initial%from_result//''''
      call h5_open(file, initial%from_result, opening, read_only=.true.)
      if (status_failed(opening)) then
        call add_problem(problems, given, 'this is no HDF5 file', &
                      'a result file of talus')
      else if (.not. is_result(file)) then
        call add_problem(problems, given, &
          'this is no result file of talus: it lacks /mesh, /deck or /snapshots', &
          'a result file of talus')
      else
        call compare_mesh(file, session%disc, problems)
        call find_snapshot(file, initial%snapshot, name, problems)
      end if
      call h5_close(file, closing)
      if (len(problems%text) == 0) then
        call restart_read(initial%from_result, name, session%state, restart, reading)
        if (status_failed(reading)) call add_problem(problems, given, reading%message, &
          'a result file that is whole')
        if (len(restart%missing) > 0) call add_problem(problems, 'from_result', &
          'the saved state lacks what this deck has: '//restart%missing, &
          'the same parts of soil, water and smoothing in both runs')
        if (len(restart%surplus) > 0) call add_problem(problems, 'from_result', &
          'the saved state has what this deck leaves out: '//restart%surplus, &
          'the same parts of soil, water and smoothing in both runs')
      end if
    end associate
    if (len(problems%text) > 0) then
      call status_set(status, status_deck, 'cannot start from the saved state'//problems%text)
      return
    end if
    session%restart_name = name
    session%steps_before = session%state%steps
    session%seepage_steps_before = session%state%seepage_steps
    session%lost = restart%lost
    session%failed = restart%failed
    session%trigger_time = restart%trigger_time
    session%greatest_displacement = restart%greatest_displacement
    session%seepage%stride = restart%stride
    session%seepage%last = restart%last
    if (allocated(restart%mode)) session%motion%mode = restart%mode
    ! A soil that closed in the earlier run and does not now is no longer open.
    if (allocated(session%state%opening)) then
      where (.not. session%ground%law(session%disc%soil)%closes) session%state%opening = 0.0_dp
    end if
  end subroutine setup_restart

  !> True when a file has what every result has.
  logical function is_result(file)
    type(h5_file_t), intent(in) :: file
    logical :: has(3)

    has(1) = h5_exists(file, '/mesh')
    has(2) = h5_exists(file, '/deck')
    has(3) = h5_exists(file, '/snapshots')
    is_result = all(has)
  end function is_result

  !> The same nodes in the same soils.
  subroutine compare_mesh(file, disc, problems)
    type(h5_file_t), intent(in) :: file
    type(disc_t), intent(in) :: disc
    type(problems_t), intent(inout) :: problems
    type(status_t) :: reading
    real(dp), allocatable :: x(:,:), apart(:)
    integer, allocatable :: soil(:)
    integer :: worst, others

    call h5_read(file, '/mesh/nodes', x, reading)
    call h5_read(file, '/mesh/soil', soil, reading)
    if (status_failed(reading)) then
      call add_problem(problems, 'from_result', reading%message, 'a result file that is whole')
      return
    end if
    if (size(x, 2) /= disc%n) then
      call add_problem(problems, 'from_result', 'the saved state has '//text_of(size(x, 2))// &
        ' nodes, this deck '//text_of(disc%n), 'the same &geometry and &nodes in both runs')
      return
    end if
    apart = norm2(x - disc%mesh%x, dim=1)
    worst = maxloc(apart, dim=1)
    if (apart(worst) > same_place*maxval(abs(disc%mesh%x))) call add_problem(problems, &
      'from_result', 'node '//text_of(worst)//' lies at ('//text_of(x(1, worst))//', '// &
      text_of(x(2, worst))//') m there, at ('//text_of(disc%mesh%x(1, worst))//', '// &
      text_of(disc%mesh%x(2, worst))//') m here', 'the same &geometry and &nodes in both runs')
    others = count(soil /= disc%soil)
    if (others > 0) call add_problem(problems, 'from_result', text_of(others)// &
      ' nodes lie in another soil there', 'the same regions of the &soil groups in both runs')
  end subroutine compare_mesh

  !> Name of the snapshot that is asked for, among those of which all of the state is there.
  subroutine find_snapshot(file, wanted, name, problems)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: wanted !! a number, last, last_good, or '' for last
    character(:), allocatable, intent(out) :: name
    type(problems_t), intent(inout) :: problems
    character(h5_name_letters), allocatable :: complete(:), all_names(:)
    character(6) :: digits
    integer :: i, number

    call h5_names(file, '/restart', complete)
    call h5_names(file, '/snapshots', all_names)
    name = wanted
    if (wanted == '' .or. wanted == 'last') then
      do i = 1, size(complete)
        if (is_number(trim(complete(i)))) name = trim(complete(i))
      end do
    else if (is_number(wanted)) then
      read (wanted, *) number
      write (digits, '(i6.6)') number
      name = digits
    end if
    if (any(complete == name)) return
    if (any(all_names == name) .or. wanted == '' .or. wanted == 'last') then
      call add_problem(problems, 'snapshot = '''//wanted//'''', 'not all of the state was saved', &
        list(complete)//'; the earlier run saves more with &output restart = ''all''')
    else
      call add_problem(problems, 'snapshot = '''//wanted//'''', 'no such snapshot', list(complete))
    end if
  end subroutine find_snapshot

  pure logical function is_number(name)
    character(*), intent(in) :: name

    is_number = len(name) > 0 .and. verify(name, '0123456789') == 0
  end function is_number

  !> Names in quotes, or that there are none.
  pure function list(names) result(text)
    character(*), intent(in) :: names(:)
    character(:), allocatable :: text
    integer :: i

    text = ''
    do i = 1, size(names)
      text = text//', '''//trim(names(i))//''''
    end do
    if (len(text) > 0) text = text(3:)
    if (size(names) == 0) text = 'none of this file'
  end function list

  !> Add an error as the deck's own checks word it.
  pure subroutine add_problem(problems, key, problem, allowed)
    type(problems_t), intent(inout) :: problems
    character(*), intent(in) :: key, problem, allowed

    problems%text = problems%text//new_line//problems%path//': error: &initial '//key//': '// &
      problem//'; allowed: '//allowed
  end subroutine add_problem
end module talus_setup_restart
