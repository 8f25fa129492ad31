! SPDX-License-Identifier: MIT
!> Types of the deck's key table: one record per key, from which reading, checking, printing,
!! `talus keys` and input/README.md all follow. The records themselves are in talus_deck_keys.
module talus_deck_table
  use talus_kinds, only: dp
  use talus_text, only: text_of, text_is_one_of
  implicit none
  private
  public :: key_t, group_t, table_t, table_add_group, table_add_key, table_group_index
  public :: table_key_index, key_is_required, key_has_range, key_in_range, key_allowed

  !> Default text of a key that must be given.
  character(*), parameter, public :: required_mark = '*'
  !> First character of a default copied from another key of the group: '=spacing'.
  character(*), parameter, public :: copied_mark = '='
  !> First character of a default that talus_deck_derive works out; the rest says how.
  character(*), parameter, public :: derived_mark = '~'

  type :: key_t
    character(:), allocatable :: name
    character(:), allocatable :: kind    !! real integer logical string path real_list string_list
    character(:), allocatable :: unit    !! SI unit or other unit of the deck, '' for none
    character(:), allocatable :: default !! text as in a deck; '' absent; or one of the marks above
    character(:), allocatable :: allowed !! range '[0, 1)' of numbers, choices 'a|b' of strings
    character(:), allocatable :: when    !! 'key=a|b': used only then; '' always used
    character(:), allocatable :: text    !! one plain sentence
    real(dp) :: low = -huge(1.0_dp), high = huge(1.0_dp) !! range, in the key's unit
    logical :: low_open = .false., high_open = .false.   !! true when the limit itself is refused
  end type key_t

  type :: group_t
    character(:), allocatable :: name
    character(:), allocatable :: text    !! one plain sentence
    logical :: repeatable = .false.
    logical :: required = .false.
    integer :: first = 1, last = 0       !! its keys in table_t%key
  end type group_t

  type :: table_t
    integer :: n_groups = 0, n_keys = 0
    type(group_t), allocatable :: group(:)
    type(key_t), allocatable :: key(:)
  end type table_t

contains

  !> Start a group; the keys added next belong to it.
  subroutine table_add_group(table, name, repeatable, required, text)
    type(table_t), intent(inout) :: table
    character(*), intent(in) :: name, text
    logical, intent(in) :: repeatable, required
    type(group_t), allocatable :: larger(:)

    if (.not. allocated(table%group)) allocate (table%group(16))
    if (table%n_groups == size(table%group)) then
      allocate (larger(2*table%n_groups))
      larger(:table%n_groups) = table%group
      call move_alloc(larger, table%group)
    end if
    table%n_groups = table%n_groups + 1
    associate (group => table%group(table%n_groups))
      group%name = name
      group%text = text
      group%repeatable = repeatable
      group%required = required
      group%first = table%n_keys + 1
      group%last = table%n_keys
    end associate
  end subroutine table_add_group

  !> Add a key to the group started last.
  subroutine table_add_key(table, name, kind, unit, default, allowed, text, when)
    type(table_t), intent(inout) :: table
    character(*), intent(in) :: name, kind, unit, default, allowed, text !! see key_t
    character(*), intent(in), optional :: when                           !! see key_t
    type(key_t), allocatable :: larger(:)

    if (.not. allocated(table%key)) allocate (table%key(256))
    if (table%n_keys == size(table%key)) then
      allocate (larger(2*table%n_keys))
      larger(:table%n_keys) = table%key
      call move_alloc(larger, table%key)
    end if
    table%n_keys = table%n_keys + 1
    table%group(table%n_groups)%last = table%n_keys
    associate (key => table%key(table%n_keys))
      key%name = name
      key%kind = kind
      key%unit = unit
      key%default = default
      key%allowed = allowed
      key%text = text
      key%when = ''
      if (present(when)) key%when = when
      if (key_has_range(key)) call parse_range(key)
    end associate
  end subroutine table_add_key

  !> Read the limits from text such as '[0, 0.5)' or '(0, inf)'.
  subroutine parse_range(key)
    type(key_t), intent(inout) :: key
    character(:), allocatable :: range
    integer :: comma, last

    range = key%allowed
    last = len(range)
    comma = index(range, ',')
    key%low_open = range(1:1) == '('
    key%high_open = range(last:last) == ')'
    if (index(range(:comma), 'inf') == 0) read (range(2:comma-1), *) key%low
    if (index(range(comma:), 'inf') == 0) read (range(comma+1:last-1), *) key%high
  end subroutine parse_range

  !> Index of a group, 0 when there is none of that name.
  pure integer function table_group_index(table, name) result(found)
    type(table_t), intent(in) :: table
    character(*), intent(in) :: name !! lower case

    do found = table%n_groups, 1, -1
      if (table%group(found)%name == name) return
    end do
  end function table_group_index

  !> Index of a group's key in table%key, 0 when there is none of that name.
  pure integer function table_key_index(table, group, name) result(found)
    type(table_t), intent(in) :: table
    integer, intent(in) :: group     !! index of the group
    character(*), intent(in) :: name !! lower case

    do found = table%group(group)%first, table%group(group)%last
      if (table%key(found)%name == name) return
    end do
    found = 0
  end function table_key_index

  !> True when the key must be given (whenever it is used).
  pure logical function key_is_required(key)
    type(key_t), intent(in) :: key

    key_is_required = key%default == required_mark
  end function key_is_required

  !> True when the key holds numbers limited to a range.
  pure logical function key_has_range(key)
    type(key_t), intent(in) :: key

    key_has_range = text_is_one_of(key%kind, 'real|integer|real_list') .and. len(key%allowed) > 0
  end function key_has_range

  !> True when a number lies in the key's range.
  pure logical function key_in_range(key, value)
    type(key_t), intent(in) :: key
    real(dp), intent(in) :: value

    if (key%low_open) then
      key_in_range = value > key%low
    else
      key_in_range = value >= key%low
    end if
    if (key%high_open) then
      key_in_range = key_in_range .and. value < key%high
    else
      key_in_range = key_in_range .and. value <= key%high
    end if
  end function key_in_range

  !> What the key accepts, for messages and manuals: '> 0', 'box | slope', 'real number'.
  pure function key_allowed(key) result(text)
    type(key_t), intent(in) :: key
    character(:), allocatable :: text
    integer :: i

    if (key_has_range(key)) then
      text = range_text(key)
      return
    end if
    text = ''
    do i = 1, len(key%allowed)
      if (key%allowed(i:i) == '|') then
        text = text//' | '
      else
        text = text//key%allowed(i:i)
      end if
    end do
    if (len(text) > 0) return
    select case (key%kind)
    case ('real'); text = 'a real number'
    case ('integer'); text = 'an integer'
    case ('logical'); text = '.true. | .false.'
    case ('string'); text = 'text in quotes'
    case ('path'); text = 'a path in quotes'
    case ('real_list'); text = 'a list of real numbers'
    case ('string_list'); text = 'a list of texts in quotes'
    end select
  end function key_allowed

  !> '> 0', '>= 0 and < 0.5' or '1 to 2'.
  pure function range_text(key) result(text)
    type(key_t), intent(in) :: key
    character(:), allocatable :: text
    logical :: has_low, has_high

    has_low = key%low > -huge(1.0_dp)
    has_high = key%high < huge(1.0_dp)
    text = ''
    if (has_low .and. has_high .and. .not. (key%low_open .or. key%high_open)) then
      text = short(key%low)//' to '//short(key%high)
      return
    end if
    if (has_low) text = trim(merge('> ', '>=', key%low_open))//' '//short(key%low)
    if (has_low .and. has_high) text = text//' and '
    if (has_high) text = text//trim(merge('< ', '<=', key%high_open))//' '//short(key%high)
  end function range_text

  !> Number without a trailing '.0'.
  pure function short(value) result(text)
    real(dp), intent(in) :: value
    character(:), allocatable :: text
    integer :: last

    text = text_of(value)
    last = len(text)
    if (last > 2) then
      if (text(last-1:) == '.0') text = text(:last-2)
    end if
  end function short
end module talus_deck_table
