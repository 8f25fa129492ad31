! SPDX-License-Identifier: MIT
!> Decks and key tables for the suites.
module decks
  use talus_kinds, only: dp
  use talus_text, only: text_of
  use talus_deck_table, only: table_t, key_t, table_group_index, table_key_index, &
    key_is_required, key_in_range
  use talus_deck_messages, only: messages_t, messages_start, messages_text
  use talus_deck_types, only: deck_t
  use talus_deck_store, only: store_t
  use talus_deck_read, only: deck_read
  use talus_deck_derive, only: deck_derive
  use talus_deck_fill, only: deck_fill
  implicit none
  private
  public :: deck_store, deck_filled, tells, key_named, key_default, keys_with, keys_required, limits_fault

contains

  !> The store of a deck called deck.nml, and what is wrong with it.
  subroutine deck_store(text, store, messages)
    character(*), intent(in) :: text
    type(store_t), intent(out) :: store
    type(messages_t), intent(out) :: messages

    call messages_start(messages, 'deck.nml')
    call deck_read(text, store, messages)
  end subroutine deck_store

  !> A deck that is read and filled but not checked yet, and messages to put the checks' own into.
  subroutine deck_filled(text, store, deck, messages)
    character(*), intent(in) :: text
    type(store_t), intent(out) :: store
    type(deck_t), intent(out) :: deck
    type(messages_t), intent(out) :: messages

    call deck_store(text, store, messages)
    call deck_derive(store, 'deck')
    deck%folder = ''
    call deck_fill(store, deck)
    call messages_start(messages, 'deck.nml')
  end subroutine deck_filled

  !> '' when there is one message, which holds a text, else all the messages.
  function tells(messages, text) result(fault)
    type(messages_t), intent(in) :: messages
    character(*), intent(in) :: text
    character(:), allocatable :: fault

    fault = messages_text(messages)
    if (messages%count == 1 .and. index(fault, text) > 0) then
      fault = ''
    else if (messages%count == 0) then
      fault = 'no message'
    end if
  end function tells

  !> The record of a key that the table has.
  function key_named(table, group, name) result(key)
    type(table_t), intent(in) :: table
    character(*), intent(in) :: group, name
    type(key_t) :: key

    key = table%key(table_key_index(table, table_group_index(table, group), name))
  end function key_named

  !> The default of a key as the table has it.
  function key_default(table, group, name) result(text)
    type(table_t), intent(in) :: table
    character(*), intent(in) :: group, name
    character(:), allocatable :: text
    type(key_t) :: key

    key = key_named(table, group, name)
    text = key%default
  end function key_default

  !> '' when a key takes all of some values and none of others, else its name and the last value
  !> for which that is not so.
  function limits_fault(table, group, name, inside, outside) result(fault)
    type(table_t), intent(in) :: table
    character(*), intent(in) :: group, name
    real(dp), intent(in) :: inside(:), outside(:)
    character(:), allocatable :: fault
    type(key_t) :: key
    integer :: i

    key = key_named(table, group, name)
    fault = ''
    do i = 1, size(inside)
      if (.not. key_in_range(key, inside(i))) fault = name//' refuses '//text_of(inside(i))//'; '
    end do
    do i = 1, size(outside)
      if (key_in_range(key, outside(i))) fault = name//' takes '//text_of(outside(i))//'; '
    end do
  end function limits_fault

  !> 'a b': the keys of a group that are used on one condition, those without one for ''.
  function keys_with(table, group, when) result(names)
    type(table_t), intent(in) :: table
    character(*), intent(in) :: group, when
    character(:), allocatable :: names

    names = chosen(table, group, when, .false.)
  end function keys_with

  !> The same of those that must be given.
  function keys_required(table, group, when) result(names)
    type(table_t), intent(in) :: table
    character(*), intent(in) :: group, when
    character(:), allocatable :: names

    names = chosen(table, group, when, .true.)
  end function keys_required

  function chosen(table, group, when, required) result(names)
    type(table_t), intent(in) :: table
    character(*), intent(in) :: group, when
    logical, intent(in) :: required
    character(:), allocatable :: names
    integer :: k

    names = ''
    associate (keys => table%group(table_group_index(table, group)))
      do k = keys%first, keys%last
        if (table%key(k)%when /= when) cycle
        if (required .and. .not. key_is_required(table%key(k))) cycle
        names = names//' '//table%key(k)%name
      end do
    end associate
    names = trim(adjustl(names))
  end function chosen
end module decks
