! SPDX-License-Identifier: MIT
!> Uses one module of the installed library and links to another.
program consumer
  use talus_text, only: text_lower
  use talus_version, only: version
  implicit none

  write (*, '(a)') text_lower('CONSUMER LINKED TO TALUS ')//version
end program consumer
