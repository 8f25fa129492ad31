! SPDX-License-Identifier: MIT
!> Reads a deck's text into the store by the key table, reporting every error it meets, and applies
!! the table's defaults.
module talus_deck_read
  use talus_text, only: text_of, text_lower
  use talus_deck_messages, only: messages_t, messages_error, messages_errors
  use talus_deck_table, only: table_group_index, table_key_index, key_is_required, copied_mark, &
    derived_mark
  use talus_deck_keys, only: deck_table
  use talus_deck_scan, only: entry_t, entries_of, entry_source
  use talus_deck_store, only: store_t, value_t, store_add_section, store_first, store_value, &
    store_is_used
  use talus_deck_convert, only: convert_words, convert_default
  use talus_deck_suggest, only: suggest_group, suggest_key
  use talus_deck_report, only: report_error, report_warning
  implicit none
  private
  public :: deck_read

contains

  !> Text of a deck to a store with defaults applied.
  subroutine deck_read(text, store, messages)
    character(*), intent(in) :: text            !! whole file, lines ended by newlines
    type(store_t), intent(out) :: store
    type(messages_t), intent(inout) :: messages
    type(entry_t), allocatable :: entries(:)
    integer :: i, section

    call deck_table(store%table)
    call entries_of(text, entries, messages)
    if (size(entries) == 0) then
      if (messages_errors(messages) == 0) call messages_error(messages, 0, &
          'the deck has no groups; &
        &allowed: '//group_list(store))
      return
    end if
    section = 0
    do i = 1, size(entries)
      if (entries(i)%is_group) then
        call read_group(store, entries(i), section, messages)
      else if (section > 0) then
        call read_key(store, section, entries(i), messages)
      end if
    end do
    call add_absent_groups(store, messages)
    do section = 1, store%count
      call apply_defaults(store, section)
      call check_presence(store, section, messages)
    end do
  end subroutine deck_read

  !> Open a section, or report an unknown or repeated group. Keys of an unknown one are skipped.
  subroutine read_group(store, entry, section, messages)
    type(store_t), intent(inout) :: store
    type(entry_t), intent(in) :: entry
    integer, intent(out) :: section             !! 0 when unknown
    type(messages_t), intent(inout) :: messages
    integer :: group, earlier

    section = 0
    group = table_group_index(store%table, entry%name)
    if (group == 0) then
      if (entry%name == '' .or. entry%name == 'end') return
      call messages_error(messages, entry%line, '&'//entry%name//': unknown group'// &
        suggest_group(store%table, entry%name)//'; allowed: '//group_list(store))
      return
    end if
    earlier = store_first(store, entry%name)
    if (earlier > 0 .and. .not. store%table%group(group)%repeatable) then
      call messages_error(messages, entry%line, '&'//entry%name// &
          ': repeated group, first in line '// &
        text_of(store%section(earlier)%line)//'; allowed: one &'//entry%name)
    end if
    call store_add_section(store, group, entry%line, section)
  end subroutine read_group

  !> Convert one key's values, or report an unknown, duplicate or wrong key.
  subroutine read_key(store, section, entry, messages)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: section
    type(entry_t), intent(in) :: entry
    type(messages_t), intent(inout) :: messages
    character(:), allocatable :: problem, start
    integer :: group, key, k

    group = store%section(section)%group
    ! A key with an index was meant; only its value cannot be taken.
    start = entry%name//'('
    k = store_value(store, section, start(:index(start, '(')-1))
    key = table_key_index(store%table, group, entry%name)
    start = '&'//store%table%group(group)%name//' '//entry%name//' = '//entry_source(entry)//': '
    if (key == 0 .and. index(entry%name, '(') > 0) then
      if (size(entry%value) > 0) call messages_error(messages, entry%line, start// &
          'no indices; allowed: key = value, value, ...')
      if (k > 0) call mark_given(store%section(section)%value(k), entry)
      if (k > 0) store%section(section)%value(k)%is_wrong = .true.
      return
    else if (key == 0) then
      call messages_error(messages, entry%line, start//'unknown key'// &
        suggest_key(store%table, group, entry%name)//'; allowed: '//key_list(store, group))
      return
    end if
    if (store%section(section)%value(k)%is_given) then
      call messages_error(messages, entry%line, start//'duplicate key, first in line '// &
        text_of(store%section(section)%value(k)%line)//'; allowed: once in a group')
      return
    end if
    call mark_given(store%section(section)%value(k), entry)
    if (size(entry%value) == 0) then
      store%section(section)%value(k)%is_wrong = .true.
      return
    end if
    call convert_words(store%table%key(key), entry%value, store%section(section)%value(k), problem)
    if (len(problem) > 0) call report_error(store, section, entry%name, problem, messages)
  end subroutine read_key

  !> Note where a key stands in the deck, and what it was given.
  subroutine mark_given(value, entry)
    type(value_t), intent(inout) :: value
    type(entry_t), intent(in) :: entry

    value%is_given = .true.
    value%line = entry%line
    value%source = entry_source(entry)
  end subroutine mark_given

  !> Report required groups that are absent; give the others an empty section for their defaults.
  subroutine add_absent_groups(store, messages)
    type(store_t), intent(inout) :: store
    type(messages_t), intent(inout) :: messages
    integer :: group, added

    do group = 1, store%table%n_groups
      if (store_first(store, store%table%group(group)%name) > 0) cycle
      if (store%table%group(group)%required) then
        call messages_error(messages, 0, '&'//store%table%group(group)%name// &
          ': missing group; allowed: one'// &
          trim(merge(' or more', '        ', store%table%group(group)%repeatable))// &
          ', for '//purpose(store%table%group(group)%text))
      end if
      if (.not. store%table%group(group)%repeatable) then
        call store_add_section(store, group, 0, added)
      end if
    end do
  end subroutine add_absent_groups

  !> What a group is for, to go on in a sentence: the table's text without capital and full stop.
  pure function purpose(text)
    character(*), intent(in) :: text
    character(:), allocatable :: purpose

    purpose = text_lower(text(:1))//text(2:)
    if (index(text, '.', back=.true.) == len(text)) purpose = purpose(:len(text)-1)
  end function purpose

  !> Table defaults of the keys that are not in the deck; derived ones come later.
  subroutine apply_defaults(store, section)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: section
    integer :: k, other

    associate (here => store%section(section), group => &
        store%table%group(store%section(section)%group))
      do k = 1, size(here%value)
        if (here%value(k)%is_given) cycle
        associate (key => store%table%key(group%first + k - 1))
          if (len(key%default) == 0 .or. key_is_required(key)) cycle
          if (key%default(1:1) == derived_mark) cycle
          if (key%default(1:1) == copied_mark) then
            other = store_value(store, section, key%default(2:))
            here%value(k)%is_set = here%value(other)%is_set
            here%value(k)%r = here%value(other)%r
          else
            call convert_default(key, here%value(k))
          end if
        end associate
      end do
    end associate
  end subroutine apply_defaults

  !> Report required keys that are absent, and given ones that have no effect.
  subroutine check_presence(store, section, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    type(messages_t), intent(inout) :: messages
    integer :: k
    logical :: is_used

    associate (here => store%section(section), group => &
        store%table%group(store%section(section)%group))
      do k = 1, size(here%value)
        associate (key => store%table%key(group%first + k - 1))
          is_used = store_is_used(store, section, k)
          if (key_is_required(key) .and. is_used .and. .not. here%value(k)%is_given) then
            if (group%required .and. here%line == 0) cycle
            call report_error(store, section, key%name, 'missing key'//used_when(key%when), &
                messages)
          else if (here%value(k)%is_given .and. .not. is_used) then
            if (controller_is_wrong(store, section, unmet_condition(store, section, k))) cycle
            call report_warning(store, section, key%name, 'has no effect; used only'// &
                                used_when(unmet_condition(store, section, k)), messages)
          end if
        end associate
      end do
    end associate
  end subroutine check_presence

  !> ' with kind = slope | box', '' for a key without condition.
  pure function used_when(when) result(text)
    character(*), intent(in) :: when
    character(:), allocatable :: text
    integer :: i

    text = ''
    if (len(when) == 0) return
    text = ' with '
    do i = 1, len(when)
      if (when(i:i) == '=' .or. when(i:i) == '|') then
        text = text//' '//when(i:i)//' '
      else
        text = text//when(i:i)
      end if
    end do
  end function used_when

  !> The condition for which a key is not used: its own, or that of the key it asks about.
  pure recursive function unmet_condition(store, section, k) result(when)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section, k !! k: position in section%value
    character(:), allocatable :: when
    integer :: other

    when = store%table%key(store%table%group(store%section(section)%group)%first + k - 1)%when
    other = store_value(store, section, when(:index(when, '=')-1))
    if (.not. store_is_used(store, section, other)) when = unmet_condition(store, section, other)
  end function unmet_condition

  !> True when the key that a condition asks about was refused or is missing.
  pure logical function controller_is_wrong(store, section, when) result(is_wrong)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    character(*), intent(in) :: when !! 'key=a|b'

    associate (value => store%section(section)%value(store_value(store, section, &
                                                                 when(:index(when, '=')-1))))
      is_wrong = value%is_wrong .or. .not. value%is_set
    end associate
  end function controller_is_wrong

  !> '&run, &geometry, ...'
  pure function group_list(store) result(text)
    type(store_t), intent(in) :: store
    character(:), allocatable :: text
    integer :: i

    text = '&'//store%table%group(1)%name
    do i = 2, store%table%n_groups
      text = text//', &'//store%table%group(i)%name
    end do
  end function group_list

  !> 'name, from_x, ...': all keys of a group.
  pure function key_list(store, group) result(text)
    type(store_t), intent(in) :: store
    integer, intent(in) :: group
    character(:), allocatable :: text
    integer :: k

    text = store%table%key(store%table%group(group)%first)%name
    do k = store%table%group(group)%first + 1, store%table%group(group)%last
      text = text//', '//store%table%key(k)%name
    end do
  end function key_list
end module talus_deck_read
