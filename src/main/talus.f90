! SPDX-License-Identifier: MIT
!> The program `talus`: prints its version and the words it takes.
program talus
  use, intrinsic :: iso_fortran_env, only: error_unit
  use talus_version, only: version, git_hash
  implicit none
  character(64) :: word

  word = 'help'
  if (command_argument_count() > 0) call get_command_argument(1, word)
  select case (word)
  case ('version', '--version')
    write (*, '(5a)') 'talus ', version, ' (', git_hash, ')'
  case ('help', '--help', '-h')
    write (*, '(a)') 'usage: talus version | help'
  case default
    write (error_unit, '(3a)') 'talus: unknown word "', trim(word), '"; try: talus help'
    error stop 1
  end select
end program talus
