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
      if (.not. is_taken(command, word)) then
        call status_set(status, status_deck, 'unexpected "'//word//'" after '//command%word// &
          '; allowed: '//takes(command%word))
        return
      end if
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
        call read_folder(i + 1, command%output, status)
        i = i + 1
      case default
        command%argument = word
      end select
      i = i + 1
    end do
    if ((command%word == 'run' .or. command%word == 'check') .and. len(command%argument) == 0) &
      call status_set(status, status_deck, command%word//' needs a deck: talus '//command%word// &
        ' DECK')
  end subroutine command_read

  !> What may follow a word.
  pure function takes(word) result(text)
    character(*), intent(in) :: word
    character(:), allocatable :: text

    select case (word)
    case ('run')
      text = 'one deck, --threads N, --output DIR, --overwrite'
    case ('check')
      text = 'one deck, --threads N, --spectrum'
    case ('keys')
      text = 'one group'
    case ('bench')
      text = '--quick, --output DIR'
    case default
      text = 'nothing'
    end select
  end function takes

  !> True when the command has a use for an argument. One that starts with - is an option.
  pure logical function is_taken(command, argument)
    type(command_t), intent(in) :: command
    character(*), intent(in) :: argument

    if (index(argument, '-') == 1) then
      is_taken = scan(argument, ' ,') == 0 .and. &
        (index(', '//takes(command%word)//',', ', '//argument//',') > 0 .or. &
         index(', '//takes(command%word), ', '//argument//' ') > 0)
    else
      is_taken = index(takes(command%word), 'one ') == 1 .and. len(command%argument) == 0
    end if
  end function is_taken

  !> Folder for results; an option in its place was surely not meant as one.
  subroutine read_folder(place, folder, status)
    integer, intent(in) :: place
    character(:), allocatable, intent(out) :: folder
    type(status_t), intent(inout) :: status

    folder = argument(place)
    if (len(folder) == 0 .or. index(folder, '-') == 1) call status_set(status, status_deck, &
      '--output '//folder//': allowed: a folder (./-name when its name starts with -)')
  end subroutine read_folder

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
      '  talus check DECK [--threads N] [--spectrum]   resolved deck, what is active, what it '// &
      'costs', &
      '  talus keys [GROUP]              every key with its unit, default and range', &
      '  talus manual                    the same as Markdown (input/README.md)', &
      '  talus bench [--quick] [--output DIR]   how fast, and what each part costs', &
      '  talus version', '  talus help', '', &
      'exit codes: 0 done, 1 results could not be written, 2 bad input, 3 numerical failure'
  end subroutine command_help
end module talus_command
