! SPDX-License-Identifier: MIT
!> Decks and key tables for the suites.
module decks
  use talus_deck_table, only: table_t, key_t, table_group_index, table_key_index, key_is_required
  use talus_deck_messages, only: messages_t, messages_start
  use talus_deck_store, only: store_t
  use talus_deck_read, only: deck_read
  implicit none
  private
  public :: deck_store, key_named, keys_with, keys_required

contains

  !> The store of a deck called deck.nml, and what is wrong with it.
  subroutine deck_store(text, store, messages)
    character(*), intent(in) :: text
    type(store_t), intent(out) :: store
    type(messages_t), intent(out) :: messages

    call messages_start(messages, 'deck.nml')
    call deck_read(text, store, messages)
  end subroutine deck_store

  !> The record of a key that the table has.
  function key_named(table, group, name) result(key)
    type(table_t), intent(in) :: table
    character(*), intent(in) :: group, name
    type(key_t) :: key

    key = table%key(table_key_index(table, table_group_index(table, group), name))
  end function key_named

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
