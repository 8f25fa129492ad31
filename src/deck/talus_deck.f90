! SPDX-License-Identifier: MIT
!> A deck from a file or a text: read, filled, checked and resolved. Nothing is printed here.
module talus_deck
  use talus_status, only: status_t, status_set, status_deck
  use talus_text, only: text_of
  use talus_deck_messages, only: messages_t, messages_start, messages_error, messages_errors, &
    messages_sort
  use talus_deck_types, only: deck_t
  use talus_deck_store, only: store_t
  use talus_deck_path, only: path_folder, path_stem
  use talus_read_file, only: file_read
  use talus_deck_read, only: deck_read
  use talus_deck_derive, only: deck_derive
  use talus_deck_fill, only: deck_fill
  use talus_deck_check, only: deck_check
  use talus_deck_print, only: deck_resolve
  implicit none
  private
  public :: deck_load, deck_load_text, deck_load_store, deck_verdict

  !> Largest deck [bytes].
  integer, parameter :: bytes_max = 4000000

contains

  !> Read a deck file. All errors and warnings are in `messages`; any error fails the status.
  subroutine deck_load(path, deck, messages, status)
    character(*), intent(in) :: path           !! file
    type(deck_t), intent(out) :: deck          !! complete only when the status is good
    type(messages_t), intent(out) :: messages
    type(status_t), intent(inout) :: status
    character(:), allocatable :: text, problem

    call file_read(path, 'the working folder', 'a namelist', bytes_max, text, problem)
    if (len(problem) > 0) then
      call messages_start(messages, path)
      call messages_error(messages, 0, problem)
      call status_set(status, status_deck, 'cannot read the deck '//path)
      return
    end if
    call deck_load_text(text, path, deck, messages, status)
  end subroutine deck_load

  !> The same from a text in memory.
  subroutine deck_load_text(text, name, deck, messages, status)
    character(*), intent(in) :: text           !! lines ended by newlines
    character(*), intent(in) :: name           !! path the deck would have
    type(deck_t), intent(out) :: deck          !! complete only when the status is good
    type(messages_t), intent(out) :: messages
    type(status_t), intent(inout) :: status
    type(store_t) :: store

    call deck_load_store(text, name, deck, store, messages)
    call deck_verdict(messages, status)
  end subroutine deck_load_text

  !> Put the messages in order; any error fails the status, with the number of all.
  subroutine deck_verdict(messages, status)
    type(messages_t), intent(inout) :: messages
    type(status_t), intent(inout) :: status
    integer :: n

    call messages_sort(messages)
    n = messages_errors(messages)
    if (n > 0) call status_set(status, status_deck, text_of(n)// &
      ' error'//trim(merge('s', ' ', n > 1))//' in the deck '//messages%file)
  end subroutine deck_verdict

  !> All steps from text to checked deck. The store is handed out for tests of the key table.
  subroutine deck_load_store(text, name, deck, store, messages)
    character(*), intent(in) :: text           !! lines ended by newlines
    character(*), intent(in) :: name           !! path the deck would have
    type(deck_t), intent(out) :: deck
    type(store_t), intent(out) :: store
    type(messages_t), intent(out) :: messages

    call messages_start(messages, name)
    deck%path = name
    deck%folder = path_folder(name)
    deck%text = text
    call deck_read(text, store, messages)
    if (store%count == 0) return
    call deck_derive(store, path_stem(name))
    call deck_fill(store, deck)
    call deck_check(store, deck, messages)
    call deck_resolve(store, deck%resolved)
  end subroutine deck_load_store
end module talus_deck
