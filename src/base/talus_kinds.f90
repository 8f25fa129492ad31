! SPDX-License-Identifier: MIT
!> Kinds of the numbers used everywhere.
module talus_kinds
  use, intrinsic :: iso_fortran_env, only: sp => real32, dp => real64, i4 => int32, i8 => int64
  implicit none
  private
  public :: sp, dp, i4, i8
end module talus_kinds
