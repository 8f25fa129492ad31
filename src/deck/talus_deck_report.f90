! SPDX-License-Identifier: MIT
!> The one wording of messages about a key: `&group key = value: problem; allowed: ...`.
module talus_deck_report
  use talus_kinds, only: dp
  use talus_text, only: text_of
  use talus_deck_messages, only: messages_t, messages_error, messages_warning
  use talus_deck_table, only: key_allowed
  use talus_deck_store, only: store_t, store_value, store_line
  implicit none
  private
  public :: report_error, report_warning, report_sentence, value_text, number_text, text_padded

contains

  !> Report a key of a section as an error.
  subroutine report_error(store, section, name, problem, messages, allowed)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section              !! index in store%section
    character(*), intent(in) :: name            !! key
    character(*), intent(in) :: problem         !! what is wrong
    type(messages_t), intent(inout) :: messages
    character(*), intent(in), optional :: allowed !! default: what the table allows

    call messages_error(messages, store_line(store, section, name), &
                        report_sentence(store, section, name, problem, allowed))
  end subroutine report_error

  !> Report a key of a section as a warning; without `allowed` nothing is said about it.
  subroutine report_warning(store, section, name, problem, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section              !! index in store%section
    character(*), intent(in) :: name            !! key
    character(*), intent(in) :: problem         !! what looks unintended
    type(messages_t), intent(inout) :: messages

    call messages_warning(messages, store_line(store, section, name), &
                          report_sentence(store, section, name, problem, ''))
  end subroutine report_warning

  !> `&group key = value: problem; allowed: ...`
  function report_sentence(store, section, name, problem, allowed) result(text)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    character(*), intent(in) :: name, problem
    character(*), intent(in), optional :: allowed
    character(:), allocatable :: text
    integer :: k, group

    k = store_value(store, section, name)
    group = store%section(section)%group
    text = '&'//store%table%group(group)%name//' '//name
    if (store%section(section)%value(k)%is_given) then
      text = text//' = '//store%section(section)%value(k)%source
    else if (store%section(section)%value(k)%is_set) then
      text = text//' = '//value_text(store, section, k)//' (default)'
    end if
    text = text//': '//problem
    if (.not. present(allowed)) then
      text = text//'; allowed: '// &
          key_allowed(store%table%key(store%table%group(group)%first + k - 1))
    else if (len(allowed) > 0) then
      text = text//'; allowed: '//allowed
    end if
  end function report_sentence

  !> A value as it is written in a deck.
  function value_text(store, section, k) result(text)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section, k !! k: position in section%value
    character(:), allocatable :: text
    integer :: i, key

    key = store%table%group(store%section(section)%group)%first + k - 1
    associate (value => store%section(section)%value(k))
      select case (store%table%key(key)%kind)
      case ('integer')
        text = text_of(value%i)
      case ('logical')
        text = text_of(value%l)
      case ('string', 'path')
        text = quoted(value%s)
      case ('string_list')
        text = ''
        do i = 1, size(value%names)
          text = text//', '//quoted(trim(value%names(i)))
        end do
        text = text(3:)
      case default
        text = ''
        do i = 1, size(value%r)
          text = text//', '//number_text(value%r(i))
        end do
        text = text(3:)
      end select
    end associate
  end function value_text

  !> Shortest text that reads back as exactly the same number.
  function number_text(value) result(text)
    real(dp), intent(in) :: value
    character(:), allocatable :: text
    real(dp) :: back
    integer :: digits

    do digits = 7, 17
      text = text_of(value, digits)
      read (text, *) back
      if (abs(back - value) <= 0.0_dp) return
    end do
  end function number_text

  !> Text with spaces up to a width.
  pure function text_padded(text, width) result(cell)
    character(*), intent(in) :: text
    integer, intent(in) :: width
    character(:), allocatable :: cell

    cell = text
    do while (len(cell) < width)
      cell = cell//' '
    end do
  end function text_padded

  !> Text in single quotes, with those inside doubled.
  pure function quoted(text) result(literal)
    character(*), intent(in) :: text
    character(:), allocatable :: literal
    integer :: i

    literal = ''''
    do i = 1, len(text)
      literal = literal//text(i:i)
      if (text(i:i) == '''') literal = literal//''''
    end do
    literal = literal//''''
  end function quoted
end module talus_deck_report
