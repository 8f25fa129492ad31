! SPDX-License-Identifier: MIT
!> The name a user probably meant, for misspelt groups and keys.
module talus_deck_suggest
  use talus_deck_table, only: table_t
  implicit none
  private
  public :: suggest_group, suggest_key, edit_distance

contains

  !> '; did you mean &soil?' or '' when no group is near.
  pure function suggest_group(table, name) result(hint)
    type(table_t), intent(in) :: table
    character(*), intent(in) :: name !! as in the deck, lower case
    character(:), allocatable :: hint
    integer :: i, distance, best

    hint = ''
    best = tolerated(name) + 1
    do i = 1, table%n_groups
      distance = likeness(name, table%group(i)%name)
      if (distance >= best) cycle
      best = distance
      hint = '; did you mean &'//table%group(i)%name//'?'
    end do
  end function suggest_group

  !> '; did you mean n?', or which other group has a key of that name, or ''.
  pure function suggest_key(table, group, name) result(hint)
    type(table_t), intent(in) :: table
    integer, intent(in) :: group     !! index of the group the key stands in
    character(*), intent(in) :: name !! as in the deck, lower case
    character(:), allocatable :: hint
    integer :: i, k, distance, best

    hint = ''
    do i = 1, table%n_groups
      do k = table%group(i)%first, table%group(i)%last
        if (table%key(k)%name == name) hint = '; it is a key of &'//table%group(i)%name
      end do
    end do
    if (len(hint) > 0) return
    best = tolerated(name) + 1
    do k = table%group(group)%first, table%group(group)%last
      distance = likeness(name, table%key(k)%name)
      if (distance >= best) cycle
      best = distance
      hint = '; did you mean '//table%key(k)%name//'?'
    end do
  end function suggest_key

  !> Largest edit distance that still looks like a misspelling.
  pure integer function tolerated(name)
    character(*), intent(in) :: name

    tolerated = max(1, len(name)/3)
  end function tolerated

  !> Edit distance, but 1 when a whole name of 4 letters or more is the other's beginning.
  pure integer function likeness(name, known)
    character(*), intent(in) :: name, known

    likeness = edit_distance(name, known)
    if (min(len(name), len(known)) < 4) return
    if (index(known, name) == 1 .or. index(name, known) == 1) likeness = min(likeness, 1)
  end function likeness

  !> Letters to insert, delete or change to make one word from the other (Levenshtein).
  pure integer function edit_distance(from, to) result(distance)
    character(*), intent(in) :: from, to
    integer :: row(0:len(to)), i, j, diagonal, above

    row = [(j, j=0, len(to))]
    do i = 1, len(from)
      diagonal = row(0)
      row(0) = i
      do j = 1, len(to)
        above = row(j)
        row(j) = min(above + 1, row(j-1) + 1, diagonal + merge(0, 1, from(i:i) == to(j:j)))
        diagonal = above
      end do
    end do
    distance = row(len(to))
  end function edit_distance
end module talus_deck_suggest
