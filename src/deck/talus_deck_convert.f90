! SPDX-License-Identifier: MIT
!> From the words of a deck to values of the key's kind, with the kind, range and choices checked.
module talus_deck_convert
  use talus_kinds, only: dp
  use talus_text, only: text_lower, text_is_one_of, text_of, text_to_real, text_unsigned
  use talus_deck_table, only: key_t, key_in_range, key_has_range, key_is_required
  use talus_deck_types, only: name_length
  use talus_deck_store, only: value_t
  use talus_deck_scan, only: word_t
  implicit none
  private
  public :: convert_words, convert_default

contains

  !> Convert all words of one key. `problem` is '' when they are right.
  subroutine convert_words(key, words, value, problem)
    type(key_t), intent(in) :: key
    type(word_t), intent(in) :: words(:)
    type(value_t), intent(inout) :: value
    character(:), allocatable, intent(out) :: problem

    problem = ''
    value%is_wrong = .true.
    if (size(words) /= 1 .and. index(key%kind, '_list') == 0) then
      problem = 'one value expected, '//text_of(size(words))//' found'
      return
    end if
    select case (key%kind)
    case ('real', 'real_list')
      call convert_reals(key, words, value%r, problem)
    case ('integer')
      call convert_integer(key, words(1), value%i, problem)
    case ('logical')
      call convert_logical(words(1), value%l, problem)
    case ('string', 'path')
      call convert_string(key, words(1), value%s, problem)
    case default
      call convert_names(words, value%names, problem)
    end select
    value%is_set = len(problem) == 0
    value%is_wrong = .not. value%is_set
  end subroutine convert_words

  !> Set a value from the table's default text, which is one word.
  subroutine convert_default(key, value)
    type(key_t), intent(in) :: key
    type(value_t), intent(inout) :: value
    type(word_t) :: words(1)
    character(:), allocatable :: problem

    words(1)%text = key%default
    words(1)%is_quoted = text_is_one_of(key%kind, 'string|path|string_list')
    call convert_words(key, words, value, problem)
  end subroutine convert_default

  subroutine convert_reals(key, words, values, problem)
    type(key_t), intent(in) :: key
    type(word_t), intent(in) :: words(:)
    real(dp), allocatable, intent(inout) :: values(:)
    character(:), allocatable, intent(inout) :: problem
    real(dp) :: found(size(words))
    logical :: is_right
    integer :: i

    do i = 1, size(words)
      call text_to_real(words(i)%text, found(i), is_right)
      is_right = is_right .and. .not. words(i)%is_quoted
      if (.not. is_right) then
        problem = 'a real number expected'
        if (words(i)%is_quoted) problem = 'a real number expected, text found'
        return
      end if
      if (key_has_range(key)) then
        if (.not. key_in_range(key, found(i))) then
          problem = 'out of range'
          if (size(words) > 1) problem = words(i)%text//' is out of range'
          return
        end if
      end if
    end do
    values = found
  end subroutine convert_reals

  subroutine convert_integer(key, word, value, problem)
    type(key_t), intent(in) :: key
    type(word_t), intent(in) :: word
    integer, intent(inout) :: value
    character(:), allocatable, intent(inout) :: problem
    character(:), allocatable :: digits
    integer :: found, iostat

    digits = text_unsigned(word%text)
    if (word%is_quoted .or. len(digits) == 0 .or. verify(digits, '0123456789') > 0) then
      problem = 'an integer expected'
      return
    end if
    read (word%text, '(i40)', iostat=iostat) found
    if (iostat /= 0) then
      problem = 'out of range'
      return
    end if
    if (key_has_range(key)) then
      if (.not. key_in_range(key, real(found, dp))) then
        problem = 'out of range'
        return
      end if
    end if
    value = found
  end subroutine convert_integer

  subroutine convert_logical(word, value, problem)
    type(word_t), intent(in) :: word
    logical, intent(inout) :: value
    character(:), allocatable, intent(inout) :: problem
    character(:), allocatable :: text

    text = text_lower(word%text)
    if (word%is_quoted .or. index(text, '|') > 0 .or. &
        .not. text_is_one_of(text, '.true.|.false.|t|f|.t.|.f.|true|false')) then
      problem = 'a logical value expected'
      return
    end if
    value = index(text, 't') == 1 .or. index(text, '.t') == 1
  end subroutine convert_logical

  subroutine convert_string(key, word, value, problem)
    type(key_t), intent(in) :: key
    type(word_t), intent(in) :: word
    character(:), allocatable, intent(inout) :: value
    character(:), allocatable, intent(inout) :: problem

    if (.not. word%is_quoted) then
      problem = 'text needs quotes'
    else if (key_is_required(key) .and. len_trim(word%text) == 0) then
      problem = 'a value is missing'
    else if (len(key%allowed) > 0) then
      if (text_is_one_of(text_lower(word%text), key%allowed) .and. len_trim(word%text) > 0 &
          .and. index(word%text, '|') == 0) then
        value = text_lower(trim(word%text))
      else
        problem = 'not among the choices'
      end if
    else if (key%name == 'name' .and. len(word%text) > name_length) then
      problem = 'longer than '//text_of(name_length)//' characters'
    else
      value = trim(adjustl(word%text))
    end if
  end subroutine convert_string

  subroutine convert_names(words, names, problem)
    type(word_t), intent(in) :: words(:)
    character(name_length), allocatable, intent(inout) :: names(:)
    character(:), allocatable, intent(inout) :: problem
    character(name_length) :: found(size(words))
    integer :: i

    do i = 1, size(words)
      if (.not. words(i)%is_quoted) then
        problem = 'text needs quotes'
        return
      else if (len(words(i)%text) > name_length) then
        problem = 'longer than '//text_of(name_length)//' characters'
        return
      end if
      found(i) = adjustl(words(i)%text)
    end do
    names = found
  end subroutine convert_names
end module talus_deck_convert
