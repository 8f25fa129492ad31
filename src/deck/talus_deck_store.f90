! SPDX-License-Identifier: MIT
!> The deck's values by group and key name, with the line each was read from.
!! Everything is generic over the key table; talus_deck_fill copies it into the typed deck.
module talus_deck_store
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  use talus_kinds, only: dp
  use talus_text, only: text_is_one_of, text_of
  use talus_deck_table, only: table_t, table_key_index, table_group_index
  use talus_deck_types, only: name_length
  implicit none
  private
  public :: value_t, section_t, store_t, store_add_section, store_sections, store_first, store_get
  public :: store_value, store_line, store_is_used, store_is_wrong, real_absent

  !> Value of an integer key that is absent.
  integer, parameter, public :: integer_absent = -huge(1)

  !> One key's value. Only the component of the key's kind is meaningful.
  type :: value_t
    logical :: is_given = .false.  !! written in the deck
    logical :: is_set = .false.    !! given, or a default was found
    logical :: is_read = .false.   !! copied into the typed deck
    logical :: is_wrong = .false.  !! refused; an error was reported
    integer :: line = 0            !! line of the key in the deck
    integer :: i = integer_absent
    logical :: l = .false.
    character(:), allocatable :: s
    real(dp), allocatable :: r(:)  !! scalars: size 1
    character(name_length), allocatable :: names(:)
    character(:), allocatable :: source !! as written in the deck
  end type value_t

  !> One occurrence of a group; value(k) belongs to key first + k - 1 of the group.
  type :: section_t
    integer :: group = 0           !! index in the table
    integer :: line = 0            !! line of &name, 0 when the group is not in the deck
    type(value_t), allocatable :: value(:)
    character(:), allocatable :: missed !! key name asked for that the table lacks
  end type section_t

  type :: store_t
    type(table_t) :: table
    integer :: count = 0
    type(section_t), allocatable :: section(:)
  end type store_t

  !> Copy a key's value by name: call store_get(store, section, 'spacing', spacing).
  interface store_get
    module procedure get_real, get_integer, get_logical, get_string, get_reals, get_names
  end interface store_get

contains

  !> Quiet NaN: value of a real key that is absent.
  function real_absent() result(value)
    real(dp) :: value

    value = ieee_value(1.0_dp, ieee_quiet_nan)
  end function real_absent

  !> Append an empty section of a group; returns its index in store%section.
  subroutine store_add_section(store, group, line, added)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: group  !! index in the table
    integer, intent(in) :: line   !! line of &name, 0 when not in the deck
    integer, intent(out) :: added
    type(section_t), allocatable :: larger(:)
    integer :: k

    if (.not. allocated(store%section)) allocate (store%section(16))
    if (store%count == size(store%section)) then
      allocate (larger(2*store%count))
      larger(:store%count) = store%section
      call move_alloc(larger, store%section)
    end if
    store%count = store%count + 1
    added = store%count
    associate (section => store%section(added), range => store%table%group(group))
      section%group = group
      section%line = line
      section%missed = ''
      allocate (section%value(range%last - range%first + 1))
      do k = 1, size(section%value)
        section%value(k)%s = ''
        section%value(k)%source = ''
        allocate (section%value(k)%r(0), section%value(k)%names(0))
      end do
    end associate
  end subroutine store_add_section

  !> Indices in store%section of all sections of a group, in deck order.
  pure subroutine store_sections(store, name, found)
    type(store_t), intent(in) :: store
    character(*), intent(in) :: name !! group
    integer, allocatable, intent(out) :: found(:)
    integer :: i, group

    group = table_group_index(store%table, name)
    found = pack([(i, i=1, store%count)], [(store%section(i)%group == group, i=1, store%count)])
  end subroutine store_sections

  !> Index in store%section of the first section of a group, 0 when there is none.
  pure integer function store_first(store, name) result(found)
    type(store_t), intent(in) :: store
    character(*), intent(in) :: name !! group
    integer :: group

    group = table_group_index(store%table, name)
    do found = 1, store%count
      if (store%section(found)%group == group) return
    end do
    found = 0
  end function store_first

  !> Position of a key in section%value, 0 when the group has no such key.
  pure integer function store_value(store, section, name) result(k)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section   !! index in store%section
    character(*), intent(in) :: name !! key

    associate (group => store%section(section)%group)
      k = table_key_index(store%table, group, name)
      if (k > 0) k = k - store%table%group(group)%first + 1
    end associate
  end function store_value

  !> Line of a key, or of its group when the key is not in the deck.
  pure integer function store_line(store, section, name) result(line)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section   !! index in store%section
    character(*), intent(in) :: name !! key

    line = store%section(section)%value(store_value(store, section, name))%line
    if (line == 0) line = store%section(section)%line
  end function store_line

  !> True when the deck gives a key that was refused: what depends on it cannot be judged.
  pure logical function store_is_wrong(store, section, name) result(is_wrong)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section   !! index in store%section
    character(*), intent(in) :: name !! key

    is_wrong = store%section(section)%value(store_value(store, section, name))%is_wrong
  end function store_is_wrong

  !> True when a key takes part: it has no condition, or its condition 'key=a|b' holds.
  pure recursive logical function store_is_used(store, section, k) result(used)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section !! index in store%section
    integer, intent(in) :: k       !! position in section%value
    integer :: equals, other

    associate (group => store%section(section)%group)
      associate (when => store%table%key(store%table%group(group)%first + k - 1)%when)
        used = .true.
        if (len(when) == 0) return
        equals = index(when, '=')
        other = store_value(store, section, when(:equals-1))
        used = store_is_used(store, section, other)
        associate (value => store%section(section)%value(other))
          if (value%i /= integer_absent) then
            used = used .and. text_is_one_of(text_of(value%i), when(equals+1:))
          else
            used = used .and. text_is_one_of(value%s, when(equals+1:))
          end if
        end associate
      end associate
    end associate
  end function store_is_used

  !> Position of a key that is being copied; notes it as read or as missed.
  subroutine claim(store, section, name, k)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: section
    character(*), intent(in) :: name
    integer, intent(out) :: k

    k = store_value(store, section, name)
    if (k > 0) then
      store%section(section)%value(k)%is_read = .true.
    else
      store%section(section)%missed = name
    end if
  end subroutine claim

  subroutine get_real(store, section, name, value)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: section
    character(*), intent(in) :: name
    real(dp), intent(out) :: value !! NaN when absent
    integer :: k

    value = real_absent()
    call claim(store, section, name, k)
    if (k == 0) return
    if (store%section(section)%value(k)%is_set) value = store%section(section)%value(k)%r(1)
  end subroutine get_real

  subroutine get_integer(store, section, name, value)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: section
    character(*), intent(in) :: name
    integer, intent(out) :: value  !! integer_absent when absent
    integer :: k

    value = integer_absent
    call claim(store, section, name, k)
    if (k > 0) value = store%section(section)%value(k)%i
  end subroutine get_integer

  subroutine get_logical(store, section, name, value)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: section
    character(*), intent(in) :: name
    logical, intent(out) :: value
    integer :: k

    value = .false.
    call claim(store, section, name, k)
    if (k > 0) value = store%section(section)%value(k)%l
  end subroutine get_logical

  subroutine get_string(store, section, name, value)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: section
    character(*), intent(in) :: name
    character(:), allocatable, intent(out) :: value !! '' when absent
    integer :: k

    value = ''
    call claim(store, section, name, k)
    if (k > 0) value = store%section(section)%value(k)%s
  end subroutine get_string

  subroutine get_reals(store, section, name, value)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: section
    character(*), intent(in) :: name
    real(dp), allocatable, intent(out) :: value(:) !! size 0 when absent
    integer :: k

    allocate (value(0))
    call claim(store, section, name, k)
    if (k > 0) value = store%section(section)%value(k)%r
  end subroutine get_reals

  subroutine get_names(store, section, name, value)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: section
    character(*), intent(in) :: name
    character(name_length), allocatable, intent(out) :: value(:) !! size 0 when absent
    integer :: k

    allocate (value(0))
    call claim(store, section, name, k)
    if (k > 0) value = store%section(section)%value(k)%names
  end subroutine get_names
end module talus_deck_store
