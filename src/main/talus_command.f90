! SPDX-License-Identifier: MIT
!> The command line of the program.
module talus_command
  use talus_status, only: status_t, status_set, status_failed, status_deck
  implicit none
  private
  public :: command_t, command_read, command_help

  type :: command_t
    character(:), allocatable :: word     !! run, check, keys, manual, bench, version or help
    character(:), allocatable :: argument !! deck, or group of `keys`
    character(:), allocatable :: output   !! folder for results, '' for the deck's
    integer :: threads = 0                !! 0: the deck's or the environment's
    logical :: overwrite = .false.
    logical :: spectrum = .false.         !! check: all eigenvalues
    logical :: quick = .false.            !! bench: one size only
  end type command_t

contains

  !> Read the command line; every fault is reported with what is allowed.
  subroutine command_read(command, status)
    type(command_t), intent(out) :: command
    type(status_t), intent(inout) :: status
    character(:), allocatable :: word
    integer :: i

    command%word = 'help'
    command%argument = ''
    command%output = ''
    if (command_argument_count() == 0) return
    command%word = argument(1)
    select case (command%word)
    case ('run', 'check', 'keys', 'manual', 'bench', 'version', 'help')
    case ('--version', '-V')
      command%word = 'version'
    case ('--help', '-h')
      command%word = 'help'
    case default
      call status_set(status, status_deck, 'unknown word "'//command%word// &
        '"; allowed: run, check, keys, manual, bench, version, help')
      return
    end select
    i = 2
    do while (i <= command_argument_count() .and. .not. status_failed(status))
      word = argument(i)
      select case (word)
      case ('--overwrite')
        command%overwrite = .true.
      case ('--spectrum')
        command%spectrum = .true.
      case ('--quick')
        command%quick = .true.
      case ('--threads')
        call read_threads(i + 1, command%threads, status)
        i = i + 1
      case ('--output')
        command%output = argument(i + 1)
        if (len(command%output) == 0) call status_set(status, status_deck, &
          '--output needs a folder')
        i = i + 1
      case default
        if (word(:min(1, len(word))) == '-' .or. len(command%argument) > 0) then
          call status_set(status, status_deck, 'unexpected "'//word//'" after '//command%word// &
            '; allowed: one deck, --threads N, --output DIR, --overwrite, --spectrum, --quick')
        else
          command%argument = word
        end if
      end select
      i = i + 1
    end do
    if ((command%word == 'run' .or. command%word == 'check') .and. len(command%argument) == 0) &
      call status_set(status, status_deck, command%word//' needs a deck: talus '//command%word// &
        ' DECK')
  end subroutine command_read

  !> Number of threads.
  subroutine read_threads(place, threads, status)
    integer, intent(in) :: place
    integer, intent(out) :: threads
    type(status_t), intent(inout) :: status
    integer :: failed
    character(:), allocatable :: text

    text = argument(place)
    threads = 0
    failed = 1
    if (len(text) > 0 .and. verify(text, '0123456789') == 0) read (text, *, iostat=failed) threads
    if (failed /= 0 .or. threads < 1 .or. threads > 1024) call status_set(status, status_deck, &
      '--threads '//text//': allowed: a whole number from 1 to 1024')
  end subroutine read_threads

  !> One argument, '' when there is none.
  function argument(place) result(text)
    integer, intent(in) :: place
    character(:), allocatable :: text
    integer :: length

    call get_command_argument(place, length=length)
    allocate (character(length) :: text)
    if (length > 0) call get_command_argument(place, text)
  end function argument

  !> What the program can do.
  subroutine command_help
    write (*, '(a)') 'talus: slopes that fail in the rain, from a namelist deck', '', &
      '  talus run DECK [--threads N] [--output DIR] [--overwrite]   run a deck', &
      '  talus check DECK [--spectrum]   resolved deck, what is active and what it costs', &
      '  talus keys [GROUP]              every key with its unit, default and range', &
      '  talus manual                    the same as Markdown (input/README.md)', &
      '  talus bench [--quick] [--output DIR]   how fast, and what each part costs', &
      '  talus version', '  talus help', '', &
      'exit codes: 0 done, 1 files could not be read or written, 2 bad input, 3 numerical failure'
  end subroutine command_help
end module talus_command
