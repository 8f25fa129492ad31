! SPDX-License-Identifier: MIT
!> Memory that the program holds, by the kernel's account.
module talus_memory
  use talus_kinds, only: i8
  implicit none
  private
  public :: memory_held

contains

  !> Memory of the program [bytes]; 0 where the kernel does not say.
  integer(i8) function memory_held(label) result(bytes)
    character(*), intent(in) :: label !! 'VmRSS:' for now, 'VmHWM:' for the most so far
    character(200) :: line
    integer :: unit, failed, kilobytes

    bytes = 0_i8
    open (newunit=unit, file='/proc/self/status', status='old', action='read', iostat=failed)
    if (failed /= 0) return
    do
      read (unit, '(a)', iostat=failed) line
      if (failed /= 0) exit
      if (line(:len(label)) /= label) cycle
      read (line(len(label)+1:index(line, 'kB')-1), *, iostat=failed) kilobytes
      if (failed == 0) bytes = int(kilobytes, i8)*1024_i8
      exit
    end do
    close (unit)
  end function memory_held
end module talus_memory
