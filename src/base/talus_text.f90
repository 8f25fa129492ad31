! SPDX-License-Identifier: MIT
!> Numbers as text and small string helpers.
module talus_text
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use talus_kinds, only: dp, i8
  implicit none
  private
  public :: text_of, text_lower, text_is_one_of, text_as_word, text_to_real, text_unsigned

  !> Largest power of ten read: larger ones would overflow, which traps in a debug build.
  integer, parameter :: power_max = 300

  !> Shortest readable text of a number: text_of(0.4_dp) is '0.4'.
  interface text_of
    module procedure text_of_integer, text_of_long, text_of_real, text_of_logical
  end interface text_of

contains

  pure function text_of_integer(value) result(text)
    integer, intent(in) :: value
    character(:), allocatable :: text
    character(20) :: buffer

    write (buffer, '(i0)') value
    text = trim(buffer)
  end function text_of_integer

  pure function text_of_long(value) result(text)
    integer(i8), intent(in) :: value
    character(:), allocatable :: text
    character(24) :: buffer

    write (buffer, '(i0)') value
    text = trim(buffer)
  end function text_of_long

  pure function text_of_logical(value) result(text)
    logical, intent(in) :: value
    character(:), allocatable :: text

    text = merge('.true. ', '.false.', value)
    text = trim(text)
  end function text_of_logical

  !> Seven significant digits by default; fewer when they say the same; `digits` up to 17.
  pure function text_of_real(value, digits) result(text)
    real(dp), intent(in) :: value
    integer, intent(in), optional :: digits
    character(:), allocatable :: text
    character(40) :: buffer, form
    integer :: d, e, last

    d = 7
    if (present(digits)) d = digits
    if (ieee_is_nan(value)) then
      text = 'NaN'
      return
    else if (abs(value) > huge(value)) then
      text = merge('Infinity ', '-Infinity', value > 0.0_dp)
      text = trim(text)
      return
    else if (abs(value) < tiny(value)) then
      text = '0.0'
      return
    end if
    e = floor(log10(abs(value)))
    if (e >= -4 .and. e < d) then
      write (form, '(a,i0,a)') '(f40.', max(1, d - 1 - e), ')'
      write (buffer, form) value
      text = trim(adjustl(buffer))
      last = len(text)
      do while (text(last:last) == '0' .and. text(last-1:last-1) /= '.')
        last = last - 1
      end do
      text = text(:last)
    else
      write (form, '(a,i0,a)') '(es40.', max(1, d - 1), 'e3)'
      write (buffer, form) value
      text = mantissa_trimmed(trim(adjustl(buffer)))
    end if
  end function text_of_real

  !> '1.500000E+007' as '1.5e7'.
  pure function mantissa_trimmed(long) result(text)
    character(*), intent(in) :: long
    character(:), allocatable :: text
    integer :: split, last, exponent

    split = index(long, 'E')
    last = split - 1
    do while (long(last:last) == '0' .and. long(last-1:last-1) /= '.')
      last = last - 1
    end do
    read (long(split+1:), *) exponent
    text = long(:last)//'e'//text_of_integer(exponent)
  end function mantissa_trimmed

  !> Lower-case copy (ASCII).
  pure function text_lower(text) result(lower)
    character(*), intent(in) :: text
    character(len(text)) :: lower
    integer :: i, code

    do i = 1, len(text)
      code = iachar(text(i:i))
      if (code >= iachar('A') .and. code <= iachar('Z')) code = code + 32
      lower(i:i) = achar(code)
    end do
  end function text_lower

  !> True when `word` is one of the `|`-separated `choices`, e.g. 'box|slope|file'.
  pure logical function text_is_one_of(word, choices)
    character(*), intent(in) :: word, choices

    text_is_one_of = index(word, '|') == 0 .and. &
      index('|'//choices//'|', '|'//trim(word)//'|') > 0
  end function text_is_one_of

  !> A text as one word, for names of columns: all but letters and digits become underscores.
  pure function text_as_word(text) result(word)
    character(*), intent(in) :: text
    character(:), allocatable :: word
    character(*), parameter :: allowed = 'abcdefghijklmnopqrstuvwxyz'// &
      'ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789'
    integer :: i

    word = text
    do i = 1, len(text)
      if (index(allowed, text(i:i)) == 0) word(i:i) = '_'
    end do
  end function text_as_word

  !> A real number in Fortran's or C's notation; infinities, NaN and anything else are refused.
  pure subroutine text_to_real(text, value, is_right)
    character(*), intent(in) :: text
    real(dp), intent(out) :: value      !! 0 when it is not right
    logical, intent(out) :: is_right
    character(:), allocatable :: mantissa, exponent
    integer :: split, power, iostat

    value = 0.0_dp
    is_right = .false.
    mantissa = text_unsigned(text_lower(text))
    exponent = '0'
    split = scan(mantissa, 'ed')
    if (split > 0) then
      exponent = text_unsigned(mantissa(split+1:))
      mantissa = mantissa(:split-1)
    end if
    if (verify(mantissa, '0123456789.') > 0 .or. scan(mantissa, '0123456789') == 0) return
    if (index(mantissa, '.') /= index(mantissa, '.', back=.true.)) return
    if (len(exponent) == 0 .or. len(exponent) > 3 .or. verify(exponent, '0123456789') > 0) return
    read (exponent, *, iostat=iostat) power
    if (iostat /= 0 .or. power + len(mantissa) > power_max) return
    read (text, *, iostat=iostat) value
    is_right = iostat == 0
  end subroutine text_to_real

  !> Text without a leading sign.
  pure function text_unsigned(text) result(rest)
    character(*), intent(in) :: text
    character(:), allocatable :: rest

    rest = text
    if (len(text) == 0) return
    if (text(1:1) == '+' .or. text(1:1) == '-') rest = text(2:)
  end function text_unsigned
end module talus_text
