! SPDX-License-Identifier: MIT
!> Errors and warnings about a deck, collected so that all are reported at once.
module talus_deck_messages
  use talus_status, only: status_t, status_set, status_deck
  use talus_text, only: text_of
  implicit none
  private
  public :: message_t, messages_t, messages_start, messages_error, messages_warning
  public :: messages_errors, messages_line, messages_text, messages_sort
  public :: messages_lines, messages_status

  type :: message_t
    logical :: is_error = .true.
    integer :: line = 0              !! line in the file, 0 when about the file as a whole
    character(:), allocatable :: text
  end type message_t

  type :: messages_t
    character(:), allocatable :: file
    integer :: count = 0
    type(message_t), allocatable :: item(:)
  end type messages_t

contains

  !> Empty list about one file.
  subroutine messages_start(messages, file)
    type(messages_t), intent(out) :: messages
    character(*), intent(in) :: file !! name as the user wrote it

    messages%file = file
    allocate (messages%item(8))
  end subroutine messages_start

  !> Add an error: the deck cannot be used.
  subroutine messages_error(messages, line, text)
    type(messages_t), intent(inout) :: messages
    integer, intent(in) :: line        !! line in the file, 0 for none
    character(*), intent(in) :: text

    call append(messages, .true., line, text)
  end subroutine messages_error

  !> Add an error for each line of a text that is not blank.
  subroutine messages_lines(messages, line, subject, text)
    type(messages_t), intent(inout) :: messages
    integer, intent(in) :: line        !! line in the file, 0 for none
    character(*), intent(in) :: subject, text !! what goes before each line; the lines
    integer :: first, last

    first = 1
    do while (first <= len(text))
      last = index(text(first:), new_line('a')) + first - 2
      if (last < first - 1) last = len(text)
      if (text(first:last) /= '') call append(messages, .true., line, &
        subject//': '//text(first:last))
      first = last + 2
    end do
  end subroutine messages_lines

  !> Fail with all messages below a title; nothing happens when none is an error.
  subroutine messages_status(messages, title, status)
    type(messages_t), intent(in) :: messages
    character(*), intent(in) :: title
    type(status_t), intent(inout) :: status
    character(:), allocatable :: text

    if (messages_errors(messages) == 0) return
    text = messages_text(messages)
    call status_set(status, status_deck, title//new_line('a')//text(:len(text)-1))
  end subroutine messages_status

  !> Add a warning: the deck can be used, but something looks unintended.
  subroutine messages_warning(messages, line, text)
    type(messages_t), intent(inout) :: messages
    integer, intent(in) :: line        !! line in the file, 0 for none
    character(*), intent(in) :: text

    call append(messages, .false., line, text)
  end subroutine messages_warning

  subroutine append(messages, is_error, line, text)
    type(messages_t), intent(inout) :: messages
    logical, intent(in) :: is_error
    integer, intent(in) :: line
    character(*), intent(in) :: text
    type(message_t), allocatable :: larger(:)

    if (.not. allocated(messages%item)) allocate (messages%item(8))
    if (messages%count == size(messages%item)) then
      allocate (larger(2*messages%count))
      larger(:messages%count) = messages%item
      call move_alloc(larger, messages%item)
    end if
    messages%count = messages%count + 1
    messages%item(messages%count)%is_error = is_error
    messages%item(messages%count)%line = line
    messages%item(messages%count)%text = text
  end subroutine append

  !> Number of errors.
  pure integer function messages_errors(messages) result(n)
    type(messages_t), intent(in) :: messages

    n = 0
    if (messages%count > 0) n = count(messages%item(:messages%count)%is_error)
  end function messages_errors

  !> One message as printed: `file:line: error: ...`.
  pure function messages_line(messages, i) result(text)
    type(messages_t), intent(in) :: messages
    integer, intent(in) :: i             !! 1 to messages%count
    character(:), allocatable :: text

    text = messages%file//':'
    associate (item => messages%item(i))
      if (item%line > 0) text = text//text_of(item%line)//':'
      if (item%is_error) then
        text = text//' error: '//item%text
      else
        text = text//' warning: '//item%text
      end if
    end associate
  end function messages_line

  !> All messages, one a line, each line ended by a newline.
  pure function messages_text(messages) result(text)
    type(messages_t), intent(in) :: messages
    character(:), allocatable :: text
    integer :: i

    text = ''
    do i = 1, messages%count
      text = text//messages_line(messages, i)//new_line('a')
    end do
  end function messages_text

  !> Order by line; equal lines keep the order in which they were found.
  subroutine messages_sort(messages)
    type(messages_t), intent(inout) :: messages
    type(message_t) :: moved
    integer :: i, j

    do i = 2, messages%count
      moved = messages%item(i)
      j = i - 1
      do while (j > 0)
        if (messages%item(j)%line <= moved%line) exit
        messages%item(j+1) = messages%item(j)
        j = j - 1
      end do
      messages%item(j+1) = moved
    end do
  end subroutine messages_sort
end module talus_deck_messages
