! SPDX-License-Identifier: MIT
!> The program `talus`: see `talus help`. Exit codes: 0 done, 1 no results, 2 bad input, 3 numerics.
program talus
  use, intrinsic :: iso_c_binding, only: c_int
  use, intrinsic :: iso_fortran_env, only: error_unit
  use talus_command, only: command_t, command_read, command_help
  use talus_waiting, only: wait_briefly
  use talus_status, only: status_t, status_failed
  use talus_deck_types, only: deck_t
  use talus_deck_messages, only: messages_t, messages_text
  use talus_deck, only: deck_load, deck_verdict
  use talus_setup_disc, only: setup_check_file
  use talus_deck_manual, only: manual_keys, manual_markdown
  use talus_check, only: check_deck
  use talus_run, only: run_deck
  use talus_bench, only: bench
  use talus_place, only: place_results
  use talus_version, only: version, git_hash
  use omp_lib, only: omp_set_num_threads
  implicit none
  interface
    !> Exit of the C library: `stop` would print its code, and `error stop` a backtrace too.
    subroutine leave(code) bind(c, name='exit')
      import :: c_int
      integer(c_int), value :: code
    end subroutine leave
  end interface
  type(command_t) :: command
  type(status_t) :: status
  type(deck_t) :: deck
  character(:), allocatable :: text, base, warning

  call command_read(command, status)
  if (.not. status_failed(status)) then
    if (any(command%word == ['run  ', 'check', 'bench'])) call wait_briefly
    select case (command%word)
    case ('run')
      call load
      if (.not. status_failed(status)) &
        call place_results(deck, command%output, command%overwrite, base, status)
      if (.not. status_failed(status)) call run_deck(deck, base, command%overwrite, &
        warning, status)
      if (.not. status_failed(status)) &
        write (*, '(3a)') 'results: ', base, '.h5, _history.csv, _summary.txt'
      if (allocated(warning)) then
        if (len(warning) > 0) write (error_unit, '(2a)') 'talus: warning: ', warning
      end if
    case ('check')
      call load
      if (.not. status_failed(status)) call check_deck(deck, command%spectrum, status)
    case ('keys')
      call manual_keys(command%argument, text, status)
      if (.not. status_failed(status)) write (*, '(a)', advance='no') text
    case ('manual')
      call manual_markdown(text)
      write (*, '(a)', advance='no') text
    case ('bench')
      call bench(command%quick, command%output, status)
    case ('version')
      write (*, '(5a)') 'talus ', version, ' (', git_hash, ')'
    case default
      call command_help
    end select
  end if
  if (status_failed(status)) write (error_unit, '(2a)') 'talus: ', status%message
  flush (error_unit)
  call leave(int(status%code, c_int))

contains

  !> Read the deck, print every message, and set the threads.
  subroutine load
    type(messages_t) :: messages
    integer :: threads

    call deck_load(command%argument, deck, messages, status)
    if (status_failed(status)) then
      ! A sound deck has its node file read once, when the model is made.
      call setup_check_file(deck, messages)
      status = status_t()
      call deck_verdict(messages, status)
    end if
    write (error_unit, '(a)', advance='no') messages_text(messages)
    if (status_failed(status)) return
    threads = deck%run%threads
    if (command%threads > 0) threads = command%threads
    if (threads > 0) call omp_set_num_threads(threads)
  end subroutine load
end program talus
