! SPDX-License-Identifier: MIT
!> The resolved deck: a legal namelist with every default written out, which reads back as the same
!! deck. Units stand in comments.
module talus_deck_print
  use talus_deck_store, only: store_t, store_is_used, store_sections
  use talus_deck_report, only: value_text, text_padded
  implicit none
  private
  public :: deck_resolve

  character, parameter :: newline = achar(10)
  !> Column of the comments.
  integer, parameter :: comment_column = 44

contains

  !> The store as namelist text.
  subroutine deck_resolve(store, text)
    type(store_t), intent(in) :: store       !! complete: defaults applied and derived
    character(:), allocatable, intent(out) :: text
    integer, allocatable :: at(:)
    integer :: group, i

    text = '! Resolved deck: all values in use, defaults included.'//newline
    do group = 1, store%table%n_groups
      call store_sections(store, store%table%group(group)%name, at)
      do i = 1, size(at)
        call print_section(store, at(i), text)
      end do
    end do
  end subroutine deck_resolve

  !> One group: the keys in use, and those given although they have no effect.
  subroutine print_section(store, section, text)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section           !! index in store%section
    character(:), allocatable, intent(inout) :: text
    integer :: k
    logical :: is_used

    associate (here => store%section(section), group => &
        store%table%group(store%section(section)%group))
      text = text//newline//'&'//group%name//newline
      do k = 1, size(here%value)
        is_used = store_is_used(store, section, k)
        associate (key => store%table%key(group%first + k - 1), value => here%value(k))
          if (.not. value%is_set) then
            if (is_used) text = text//line('  ! '//key%name, 'absent')
          else if (.not. is_used) then
            if (value%is_given) text = text//assignment(store, section, k, 'no effect')
          else if (value%is_given) then
            text = text//assignment(store, section, k, key%unit)
          else if (len(key%unit) > 0) then
            text = text//assignment(store, section, k, key%unit//', default')
          else
            text = text//assignment(store, section, k, 'default')
          end if
        end associate
      end do
      text = text//'/'//newline
    end associate
  end subroutine print_section

  !> `  key = value   ! note`
  function assignment(store, section, k, note) result(text)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section, k        !! k: position in section%value
    character(*), intent(in) :: note
    character(:), allocatable :: text
    integer :: key

    key = store%table%group(store%section(section)%group)%first + k - 1
    text = line('  '//store%table%key(key)%name//' = '//value_text(store, section, k), note)
  end function assignment

  !> A line with a comment in its column, or without one when there is nothing to say.
  pure function line(content, note) result(text)
    character(*), intent(in) :: content, note
    character(:), allocatable :: text

    text = content
    if (len(note) > 0) then
      text = text_padded(text, comment_column)//' ! '//note
    end if
    text = text//newline
  end function line
end module talus_deck_print
