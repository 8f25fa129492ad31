! SPDX-License-Identifier: MIT
!> The command line of the program.
module talus_command
  use talus_status, only: status_t, status_set, status_failed, status_deck
  implicit none
  private
  public :: command_t, word_t, command_read, command_parse, command_help

  type :: command_t
    character(:), allocatable :: word     !! run, check, keys, manual, bench, version or help
    character(:), allocatable :: argument !! deck, or group of `keys`
    character(:), allocatable :: output   !! folder for results, '' for the deck's
    integer :: threads = 0                !! 0: the deck's or the environment's
    logical :: overwrite = .false.
    logical :: spectrum = .false.         !! check: all eigenvalues
    logical :: quick = .false.            !! bench: one size only
  end type command_t

  !> One argument, with the blanks that it may end with.
  type :: word_t
    character(:), allocatable :: text
  end type word_t

contains

  !> Read the command line.
  subroutine command_read(command, status)
    type(command_t), intent(out) :: command
    type(status_t), intent(inout) :: status
    type(word_t), allocatable :: words(:)
    integer :: i, length

    allocate (words(command_argument_count()))
    do i = 1, size(words)
      call get_command_argument(i, length=length)
      allocate (character(length) :: words(i)%text)
      if (length > 0) call get_command_argument(i, words(i)%text)
    end do
    call command_parse(words, command, status)
  end subroutine command_read

  !> Understand the arguments; every fault is reported with what is allowed.
  subroutine command_parse(words, command, status)
    type(word_t), intent(in) :: words(:)
    type(command_t), intent(out) :: command
    type(status_t), intent(inout) :: status
    integer :: i

    command%word = 'help'
    command%argument = ''
    command%output = ''
    if (size(words) == 0) return
    command%word = words(1)%text
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
    do while (i <= size(words) .and. .not. status_failed(status))
      if (.not. is_taken(command, words(i)%text)) then
        call status_set(status, status_deck, 'unexpected "'//words(i)%text//'" after '// &
          command%word//'; allowed: '//takes(command%word))
        return
      end if
      select case (words(i)%text)
      case ('--overwrite')
        command%overwrite = .true.
      case ('--spectrum')
        command%spectrum = .true.
      case ('--quick')
        command%quick = .true.
      case ('--threads')
        call read_threads(following(words, i), command%threads, status)
        i = i + 1
      case ('--output')
        call read_folder(following(words, i), command%output, status)
        i = i + 1
      case default
        command%argument = words(i)%text
      end select
      i = i + 1
    end do
    if ((command%word == 'run' .or. command%word == 'check') .and. len(command%argument) == 0) &
      call status_set(status, status_deck, command%word//' needs a deck: talus '//command%word// &
        ' DECK')
  end subroutine command_parse

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
  subroutine read_folder(text, folder, status)
    character(*), intent(in) :: text
    character(:), allocatable, intent(out) :: folder
    type(status_t), intent(inout) :: status

    folder = text
    if (len(folder) == 0 .or. index(folder, '-') == 1) call status_set(status, status_deck, &
      '--output '//folder//': allowed: a folder (./-name when its name starts with -)')
  end subroutine read_folder

  !> Number of threads.
  subroutine read_threads(text, threads, status)
    character(*), intent(in) :: text
    integer, intent(out) :: threads
    type(status_t), intent(inout) :: status
    integer :: failed

    threads = 0
    failed = 1
    if (len(text) > 0 .and. verify(text, '0123456789') == 0) read (text, *, iostat=failed) threads
    if (failed /= 0 .or. threads < 1 .or. threads > 1024) call status_set(status, status_deck, &
      '--threads '//text//': allowed: a whole number from 1 to 1024')
  end subroutine read_threads

  !> The argument after one, '' when there is none.
  pure function following(words, place) result(text)
    type(word_t), intent(in) :: words(:)
    integer, intent(in) :: place
    character(:), allocatable :: text

    text = ''
    if (place < size(words)) text = words(place+1)%text
  end function following

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
