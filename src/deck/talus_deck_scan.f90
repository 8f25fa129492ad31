! SPDX-License-Identifier: MIT
!> Namelist grammar: from tokens to a flat list of groups and `key = values` with their lines.
!! Errors are collected and reading goes on, so that one pass finds them all.
module talus_deck_scan
  use talus_text, only: text_lower, text_of
  use talus_deck_messages, only: messages_t, messages_error
  use talus_deck_token, only: token_t, tokens_of, token_word, token_quoted, token_equals, &
    token_comma, token_slash, token_group, token_end
  implicit none
  private
  public :: word_t, entry_t, entries_of, entry_source

  !> Most values of one key.
  integer, parameter :: values_max = 10000

  type :: word_t
    character(:), allocatable :: text
    logical :: is_quoted = .false.
  end type word_t

  !> A group's opening, or one key with its values.
  type :: entry_t
    logical :: is_group = .false.
    integer :: line = 0
    character(:), allocatable :: name      !! lower case
    type(word_t), allocatable :: value(:)
  end type entry_t

  !> Where the scan stands.
  type :: cursor_t
    integer :: at = 1                      !! next token
    integer :: count = 0                   !! entries found
    logical :: in_group = .false.
    character(:), allocatable :: group     !! name of the open group
    integer :: line = 0                    !! where it was opened
  end type cursor_t

contains

  !> All groups and keys of a deck's text, in order.
  subroutine entries_of(text, entries, messages)
    character(*), intent(in) :: text
    type(entry_t), allocatable, intent(out) :: entries(:)
    type(messages_t), intent(inout) :: messages
    type(token_t), allocatable :: tokens(:)
    type(cursor_t) :: cursor

    call tokens_of(text, tokens, messages)
    allocate (entries(64))
    cursor%group = ''
    do while (tokens(cursor%at)%kind /= token_end)
      if (cursor%in_group) then
        call scan_inside(tokens, cursor, entries, messages)
      else
        call scan_outside(tokens, cursor, entries, messages)
      end if
    end do
    if (cursor%in_group) call report_open(cursor, messages)
    entries = entries(:cursor%count)
  end subroutine entries_of

  !> Between groups: the next group, or stray text up to it.
  subroutine scan_outside(tokens, cursor, entries, messages)
    type(token_t), intent(in) :: tokens(:)
    type(cursor_t), intent(inout) :: cursor
    type(entry_t), allocatable, intent(inout) :: entries(:)
    type(messages_t), intent(inout) :: messages

    associate (token => tokens(cursor%at))
      if (token%kind == token_group) then
        call open_group(token, cursor, entries, messages)
        cursor%at = cursor%at + 1
        return
      end if
      call messages_error(messages, token%line, ''''//token%text// &
          ''' stands outside any group; '// &
                          'allowed: comments, and groups from &name to /')
    end associate
    do while (tokens(cursor%at)%kind /= token_group .and. tokens(cursor%at)%kind /= token_end)
      cursor%at = cursor%at + 1
    end do
  end subroutine scan_outside

  !> In a group: a key with its values, the group's end, or something out of place.
  subroutine scan_inside(tokens, cursor, entries, messages)
    type(token_t), intent(in) :: tokens(:)
    type(cursor_t), intent(inout) :: cursor
    type(entry_t), allocatable, intent(inout) :: entries(:)
    type(messages_t), intent(inout) :: messages

    associate (token => tokens(cursor%at))
      if (starts_key(tokens, cursor%at)) then
        call scan_key(tokens, cursor, entries, messages)
        return
      end if
      select case (token%kind)
      case (token_slash)
        cursor%in_group = .false.
      case (token_group)
        if (text_lower(token%text) == 'end') then
          cursor%in_group = .false.
        else
          call report_open(cursor, messages)
          call open_group(token, cursor, entries, messages)
        end if
      case (token_comma)
        continue
      case default
        call messages_error(messages, token%line, '&'//cursor%group//': '''//token%text// &
                            ''' belongs to no key; allowed: key = value')
      end select
    end associate
    cursor%at = cursor%at + 1
  end subroutine scan_inside

  !> `key = values` up to the next key or the group's end.
  subroutine scan_key(tokens, cursor, entries, messages)
    type(token_t), intent(in) :: tokens(:)
    type(cursor_t), intent(inout) :: cursor
    type(entry_t), allocatable, intent(inout) :: entries(:)
    type(messages_t), intent(inout) :: messages
    type(entry_t) :: entry
    logical :: after_separator, is_wrong

    entry%line = tokens(cursor%at)%line
    entry%name = text_lower(tokens(cursor%at)%text)
    allocate (entry%value(0))
    cursor%at = cursor%at + 2
    after_separator = .true.
    is_wrong = .false.
    do while (.not. starts_key(tokens, cursor%at))
      select case (tokens(cursor%at)%kind)
      case (token_word, token_quoted)
        call add_value(tokens, cursor%at, entry%value)
        after_separator = .false.
      case (token_comma)
        if (after_separator) is_wrong = .true.
        after_separator = .true.
      case (token_equals)
        is_wrong = .true.
      case default
        exit
      end select
      cursor%at = cursor%at + 1
    end do
    if (is_wrong .or. size(entry%value) == 0) then
      call messages_error(messages, entry%line, '&'//cursor%group//' '//entry%name//' = '// &
        entry_source(entry)// &
        ': a value is missing; allowed: key = value or key = value, value, ...')
    end if
    call append(entries, cursor%count, entry)
  end subroutine scan_key

  !> Append one value, or n copies of it for n*value.
  subroutine add_value(tokens, at, values)
    type(token_t), intent(in) :: tokens(:)
    integer, intent(inout) :: at           !! moves on when the repeated value is quoted
    type(word_t), allocatable, intent(inout) :: values(:)
    type(word_t) :: word
    character(:), allocatable :: text
    integer :: star, copies, iostat, i

    text = tokens(at)%text
    word%text = text
    word%is_quoted = tokens(at)%kind == token_quoted
    copies = 1
    star = index(text, '*')
    if (.not. word%is_quoted .and. star > 1) then
      read (text(:star-1), '(i12)', iostat=iostat) copies
      if (verify(text(:star-1), '0123456789') /= 0) iostat = 1
      if (iostat /= 0 .or. copies > values_max) copies = 1
      if (iostat == 0) word%text = text(star+1:)
      if (len(word%text) == 0 .and. tokens(at+1)%kind == token_quoted) then
        at = at + 1
        word%text = tokens(at)%text
        word%is_quoted = .true.
      end if
    end if
    values = [values, (word, i=1, copies)]
  end subroutine add_value

  !> True when a key starts here: a word followed by '='.
  pure logical function starts_key(tokens, at)
    type(token_t), intent(in) :: tokens(:)
    integer, intent(in) :: at

    starts_key = .false.
    if (tokens(at)%kind == token_word) starts_key = tokens(at+1)%kind == token_equals
  end function starts_key

  subroutine open_group(token, cursor, entries, messages)
    type(token_t), intent(in) :: token
    type(cursor_t), intent(inout) :: cursor
    type(entry_t), allocatable, intent(inout) :: entries(:)
    type(messages_t), intent(inout) :: messages
    type(entry_t) :: entry

    cursor%in_group = .true.
    cursor%group = text_lower(token%text)
    cursor%line = token%line
    if (cursor%group == '' .or. cursor%group == 'end') then
      call messages_error(messages, token%line, '&'//cursor%group// &
          ' opens no group; allowed: &name')
    end if
    entry%is_group = .true.
    entry%line = token%line
    entry%name = cursor%group
    allocate (entry%value(0))
    call append(entries, cursor%count, entry)
  end subroutine open_group

  subroutine report_open(cursor, messages)
    type(cursor_t), intent(in) :: cursor
    type(messages_t), intent(inout) :: messages

    call messages_error(messages, cursor%line, '&'//cursor%group// &
                        ' is not closed; allowed: a / at its end, before the next group')
  end subroutine report_open

  subroutine append(entries, count, entry)
    type(entry_t), allocatable, intent(inout) :: entries(:)
    integer, intent(inout) :: count
    type(entry_t), intent(in) :: entry
    type(entry_t), allocatable :: larger(:)

    if (count == size(entries)) then
      allocate (larger(2*count))
      larger(:count) = entries
      call move_alloc(larger, entries)
    end if
    count = count + 1
    entries(count) = entry
  end subroutine append

  !> A key's values as the user wrote them, at most six.
  pure function entry_source(entry) result(text)
    type(entry_t), intent(in) :: entry
    character(:), allocatable :: text
    integer :: i

    text = ''
    do i = 1, size(entry%value)
      if (i > 1) text = text//', '
      if (i > 6) then
        text = text//'... ('//text_of(size(entry%value))//' values)'
        return
      end if
      if (entry%value(i)%is_quoted) then
        text = text//''''//entry%value(i)%text//''''
      else
        text = text//entry%value(i)%text
      end if
    end do
  end function entry_source
end module talus_deck_scan
