! SPDX-License-Identifier: MIT
!> The deck's manual, made from the key table: for the terminal and as Markdown (input/README.md).
module talus_deck_manual
  use talus_status, only: status_t, status_set, status_deck
  use talus_text, only: text_lower
  use talus_deck_table, only: table_t, group_t, key_t, table_group_index, key_is_required, &
    key_allowed, copied_mark, derived_mark
  use talus_deck_keys, only: deck_table
  use talus_deck_suggest, only: suggest_group
  use talus_deck_report, only: text_padded
  implicit none
  private
  public :: manual_keys, manual_markdown

  character, parameter :: newline = achar(10)
  !> Width of the terminal's text.
  integer, parameter :: columns = 100

contains

  !> Text of `talus keys` (all groups) or `talus keys GROUP`.
  subroutine manual_keys(name, text, status)
    character(*), intent(in) :: name         !! group, with or without '&'; '' for all
    character(:), allocatable, intent(out) :: text
    type(status_t), intent(inout) :: status
    type(table_t) :: table
    character(:), allocatable :: wanted
    integer :: group, found, k

    call deck_table(table)
    wanted = text_lower(trim(name))
    if (index(wanted, '&') == 1) wanted = wanted(2:)
    found = table_group_index(table, wanted)
    text = ''
    if (found == 0 .and. len(wanted) > 0) then
      text = 'no group &'//wanted//suggest_group(table, wanted)//'; groups:'
      do group = 1, table%n_groups
        text = text//' '//table%group(group)%name
      end do
      call status_set(status, status_deck, text)
      return
    end if
    do group = 1, table%n_groups
      if (found > 0 .and. group /= found) cycle
      if (len(text) > 0) text = text//newline
      text = text//wrapped('&'//table%group(group)%name//group_note(table%group(group))//': '// &
                           table%group(group)%text, 0)
      do k = table%group(group)%first, table%group(group)%last
        text = text//key_lines(table%key(k))
      end do
    end do
  end subroutine manual_keys

  !> Two or more lines about a key: its columns, then its meaning.
  pure function key_lines(key) result(text)
    type(key_t), intent(in) :: key
    character(:), allocatable :: text, meaning

    text = '  '//text_padded(key%name, 30)//' '//text_padded(key%kind, 11)//' '// &
           text_padded(key%unit, 6)//' '//key_allowed(key)
    meaning = key%text//default_sentence(key)//condition(key)
    if (len(text) > columns) then
      text = text(:len(text)-len(key_allowed(key)))
      meaning = meaning//' Allowed: '//key_allowed(key)//'.'
    end if
    text = trim(text)//newline//wrapped(meaning, 6)
  end function key_lines

  !> ' Default 0.5.', ' Required.' or ' Optional.'; '' when the meaning says what absence means.
  pure function default_sentence(key) result(text)
    type(key_t), intent(in) :: key
    character(:), allocatable :: text

    if (key_is_required(key)) then
      text = ' Required.'
    else if (index(key%text, 'absent') > 0) then
      text = ''
    else if (len(key%default) == 0) then
      text = ' Optional.'
    else
      text = ' Default '//default_text(key)
      if (index(text, '.', back=.true.) < len(text)) text = text//'.'
    end if
  end function default_sentence

  !> A default for the reader: '0.5', 'same as spacing', '0.8, or ...'.
  pure function default_text(key) result(text)
    type(key_t), intent(in) :: key
    character(:), allocatable :: text

    if (key_is_required(key)) then
      text = 'required'
    else if (len(key%default) == 0) then
      text = ''
    else if (key%default(1:1) == copied_mark) then
      text = 'same as '//key%default(2:)
    else if (key%default(1:1) == derived_mark) then
      text = key%default(2:)
    else
      text = key%default
    end if
  end function default_text

  !> ' Used with kind = box.' or ''.
  pure function condition(key) result(text)
    type(key_t), intent(in) :: key
    character(:), allocatable :: text

    text = ''
    if (len(key%when) == 0) return
    text = ' Used with '//replaced(replaced(key%when, '=', ' = '), '|', ' or ')//'.'
  end function condition

  pure function group_note(group) result(text)
    type(group_t), intent(in) :: group
    character(:), allocatable :: text

    text = ' (optional'
    if (group%required) text = ' (required'
    if (group%repeatable) text = text//', may be repeated'
    text = text//')'
  end function group_note

  !> The whole of input/README.md.
  subroutine manual_markdown(text)
    character(:), allocatable, intent(out) :: text
    type(table_t) :: table
    integer :: group, k

    call deck_table(table)
    text = introduction()
    do group = 1, table%n_groups
      text = text//newline//'## &'//table%group(group)%name//newline//newline// &
             wrapped(table%group(group)%text//group_note(table%group(group)), 0)//newline// &
             '| key | type | unit | default | allowed | meaning |'//newline// &
             '|---|---|---|---|---|---|'//newline
      do k = table%group(group)%first, table%group(group)%last
        text = text//markdown_row(table%key(k))
      end do
    end do
  end subroutine manual_markdown

  pure function markdown_row(key) result(row)
    type(key_t), intent(in) :: key
    character(:), allocatable :: row

    row = '| `'//key%name//'` | '//key%kind//' | '//key%unit//' | '// &
          default_text(key)//' | '//replaced(key_allowed(key), ' | ', ', ')//' | '// &
          key%text//condition(key)//' |'//newline
  end function markdown_row

  pure function introduction() result(text)
    character(:), allocatable :: text

    text = '# Deck reference'//newline//newline// &
      '<!-- Made from the key table in src/deck by `talus manual`; do not edit. -->'// &
      newline//newline// &
      wrapped('A deck is a Fortran namelist file: groups from `&name` to `/`, `key = value` '// &
      'lines, text in quotes, comments after `!`, lists with commas. Names are '// &
      'case-insensitive. SI units (m, s, kg, Pa), except where the table says otherwise: '// &
      'angles in degrees, rain in mm/h. x points right, y up; the toe of a slope is on the '// &
      'left. Paths are relative to the deck''s folder. `./talus check DECK` reports every '// &
      'mistake at once and prints the deck with all defaults; `./talus keys GROUP` prints the '// &
      'tables below in the terminal.', 0)//newline// &
      wrapped('Suction is counted once. With `stress = ''net''` it may add cohesion '// &
      '(`suction_strength`) and strain (`suction_strain`). With `stress = ''bishop''` the '// &
      'effective stress already holds both effects, so both keys must stay `none`.', 0)
  end function introduction

  !> Text broken at spaces to fit the columns, every line indented and ended by a newline.
  pure function wrapped(text, indent) result(lines)
    character(*), intent(in) :: text
    integer, intent(in) :: indent            !! spaces before each line
    character(:), allocatable :: lines
    integer :: start, last

    lines = ''
    start = 1
    do while (start <= len(text))
      last = len(text)
      if (last - start + 1 > columns - indent) then
        last = start - 1 + index(text(start:start+columns-indent), ' ', back=.true.)
      end if
      lines = lines//text_padded('', indent)//trim(text(start:last))//newline
      start = last + 1
    end do
  end function wrapped

  !> Every `old` in a text replaced by `new`.
  pure function replaced(text, old, new) result(copy)
    character(*), intent(in) :: text, old, new
    character(:), allocatable :: copy
    integer :: at, found

    copy = ''
    at = 1
    do
      found = index(text(at:), old)
      if (found == 0) exit
      copy = copy//text(at:at+found-2)//new
      at = at + found - 1 + len(old)
    end do
    copy = copy//text(at:)
  end function replaced
end module talus_deck_manual
