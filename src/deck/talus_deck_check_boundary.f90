! SPDX-License-Identifier: MIT
!> Contradictions in &boundary.
module talus_deck_check_boundary
  use talus_kinds, only: dp
  use talus_text, only: text_of
  use talus_table_csv, only: table_csv_t
  use talus_deck_messages, only: messages_t
  use talus_deck_types, only: deck_t, boundary_t, deck_given, deck_exceeds, &
    deck_acts_in
  use talus_deck_store, only: store_t, store_sections, store_is_wrong
  use talus_deck_check_soil, only: check_region
  use talus_deck_check_file, only: check_hydrograph
  use talus_deck_report, only: complain => report_error, warn => report_warning
  implicit none
  private
  public :: check_boundaries

contains

  !> All &boundary groups.
  subroutine check_boundaries(store, deck, messages)
    type(store_t), intent(in) :: store
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages
    integer, allocatable :: at(:)
    integer :: i

    call store_sections(store, 'boundary', at)
    do i = 1, size(at)
      associate (boundary => deck%boundary(i))
        call check_where(store, at(i), boundary, deck, messages)
        call check_stage_names(store, at(i), boundary, deck, messages)
        call check_motion(store, at(i), boundary, messages)
        call check_floor(store, at(i), boundary, deck, messages)
        call check_water(store, at(i), boundary, deck, messages)
        call check_effect(store, at(i), boundary, messages)
        call check_repeated(store, at(i), i, deck, messages)
      end associate
    end do
  end subroutine check_boundaries

  subroutine check_where(store, section, boundary, deck, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    type(boundary_t), intent(in) :: boundary
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages

    if (boundary%where == 'box') then
      call check_region(store, section, boundary%from_x, boundary%to_x, boundary%from_y, &
                        boundary%to_y, messages)
    end if
    if (boundary%where == 'face' .and. deck%geometry%kind == 'box') then
      call complain(store, section, 'where', 'a box has no slope face', messages, &
                    'left | right | bottom | top | surface | box | all')
    end if
  end subroutine check_where

  subroutine check_stage_names(store, section, boundary, deck, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    type(boundary_t), intent(in) :: boundary
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages
    character(:), allocatable :: list
    logical :: is_known
    integer :: i, j

    list = ''
    do j = 1, size(deck%stage)
      list = list//', '''//deck%stage(j)%name//''''
    end do
    do i = 1, size(boundary%stages)
      is_known = .false.
      do j = 1, size(deck%stage)
        if (deck%stage(j)%name == boundary%stages(i)) is_known = .true.
      end do
      if (is_known) cycle
      call complain(store, section, 'stages', 'unknown stage '''//trim(boundary%stages(i))//'''', &
                    messages, list(3:))
    end do
  end subroutine check_stage_names

  !> A velocity already holds its direction, a velocity gradient both.
  subroutine check_motion(store, section, boundary, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    type(boundary_t), intent(in) :: boundary
    type(messages_t), intent(inout) :: messages

    associate (held => boundary%displacement)
      if (deck_given(boundary%velocity_x) .and. (held == 'fixed' .or. held == 'roller_x')) then
        call complain(store, section, 'velocity_x', 'displacement = '''//held// &
            ''' holds x at rest', &
                      messages, 'velocity_x with ''free'' or ''roller_y''')
      end if
      if (deck_given(boundary%velocity_y) .and. (held == 'fixed' .or. held == 'roller_y')) then
        call complain(store, section, 'velocity_y', 'displacement = '''//held// &
            ''' holds y at rest', &
                      messages, 'velocity_y with ''free'' or ''roller_x''')
      end if
      if (size(boundary%velocity_gradient) == 0) return
      if (size(boundary%velocity_gradient) /= 4) then
        call complain(store, section, 'velocity_gradient', 'not four values', messages, &
                      'dvx/dx, dvx/dy, dvy/dx, dvy/dy')
      else if (any(held == [character(8) :: 'fixed', 'roller_x', 'roller_y']) .or. &
               deck_given(boundary%velocity_x) .or. deck_given(boundary%velocity_y)) then
        call complain(store, section, 'velocity_gradient', 'the motion is prescribed twice', &
                      messages, 'displacement = ''free'', no velocity_x, no velocity_y')
      end if
    end associate
  end subroutine check_motion

  !> Soil lands on a floor in real time only; a stage whose kind was refused may be in real time.
  subroutine check_floor(store, section, boundary, deck, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    type(boundary_t), intent(in) :: boundary
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages
    integer :: i

    if (.not. deck_given(boundary%floor)) return
    do i = 1, size(deck%stage)
      if (deck%stage(i)%kind /= 'dynamic' .and. deck%stage(i)%kind /= '') cycle
      if (deck_acts_in(boundary, deck%stage(i)%name)) return
    end do
    call complain(store, section, 'floor', 'no stage in which it acts is dynamic', messages, &
                  'a floor with a stage of kind = ''dynamic''')
  end subroutine check_floor

  subroutine check_water(store, section, boundary, deck, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    type(boundary_t), intent(in) :: boundary
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages
    logical :: is_solved
    integer :: i

    if (boundary%water == 'none' .or. boundary%water == '') return
    if (size(deck%water) == 0) then
      call complain(store, section, 'water', 'there is no &water', messages, &
          '''none'' without &water')
      return
    end if
    is_solved = .false.
    do i = 1, size(deck%stage)
      if (deck%stage(i)%solve == 'soil') cycle
      if (deck_acts_in(boundary, deck%stage(i)%name)) is_solved = .true.
    end do
    if (.not. is_solved) call warn(store, section, 'water', 'no stage in which it acts solves '// &
                                   'seepage', messages)
    if (boundary%water == 'rain') call check_rain(store, section, boundary, deck, messages)
  end subroutine check_water

  !> Rain falls on the surface and has one source.
  subroutine check_rain(store, section, boundary, deck, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    type(boundary_t), intent(in) :: boundary
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages
    type(table_csv_t) :: table

    if (boundary%where == 'bottom' .or. boundary%where == 'left' .or. boundary%where == 'right') &
        then
      call complain(store, section, 'water', 'rain falls on '''//boundary%where//'''', messages, &
                    '''rain'' with where = surface | top | face | box | all')
    end if
    if (deck_given(boundary%rain) .and. len(boundary%hydrograph) > 0) then
      call complain(store, section, 'hydrograph', 'rain is given as well', messages, &
                    'one of rain and hydrograph')
    else if (.not. deck_given(boundary%rain) .and. len(boundary%hydrograph) == 0) then
      if (.not. store_is_wrong(store, section, 'rain') .and. &
          .not. store_is_wrong(store, section, 'hydrograph')) &
        call complain(store, section, 'water', 'how much rain is not said', messages, &
                      'rain or hydrograph with it')
    end if
    if (len(boundary%hydrograph) == 0) return
    call check_hydrograph(store, section, boundary%hydrograph, messages, table)
    if (size(table%values, 2) > 0) call check_start(store, section, boundary, table%values(1, 1), &
                                                    deck, messages)
    if (size(table%values, 2) > 1) call check_end(store, section, boundary, &
      table%values(:, size(table%values, 2) - 1:), deck, messages)
  end subroutine check_rain

  !> Rain that begins only when its stage is over.
  subroutine check_start(store, section, boundary, start, deck, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    type(boundary_t), intent(in) :: boundary
    real(dp), intent(in) :: start              !! first time of the hydrograph [s]
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages
    integer :: i

    do i = 1, size(deck%stage)
      associate (stage => deck%stage(i))
        if (stage%solve == 'soil' .or. .not. deck_acts_in(boundary, stage%name)) cycle
        if (.not. deck_exceeds(start, stage%duration*(1.0_dp - 1.0e-12_dp))) cycle
        call warn(store, section, 'hydrograph', 'no rain in stage '''//stage%name// &
          ''', which is over after '//text_of(stage%duration)//' s: the first row is at '// &
          text_of(start)//' s', messages)
      end associate
    end do
  end subroutine check_start

  !> A last row that repeats the value before it was meant as the end of the rain, which it is not.
  subroutine check_end(store, section, boundary, rows, deck, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    type(boundary_t), intent(in) :: boundary
    real(dp), intent(in) :: rows(2,2) !! the last two: time [s], rain [mm/h]
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages
    integer :: i

    if (.not. rows(2, 2) > 0.0_dp .or. abs(rows(2, 2) - rows(2, 1)) > 0.0_dp) return
    do i = 1, size(deck%stage)
      associate (stage => deck%stage(i))
        if (stage%solve == 'soil' .or. .not. deck_acts_in(boundary, stage%name)) cycle
        if (.not. deck_exceeds(stage%duration*(1.0_dp - 1.0e-12_dp), rows(1, 2))) cycle
        call warn(store, section, 'hydrograph', 'it rains on in stage '''//stage%name// &
          ''' to its end at '//text_of(stage%duration)//' s: the value of the last row, at '// &
          text_of(rows(1, 2))//' s, holds from there on', messages)
      end associate
    end do
  end subroutine check_end

  !> A group that holds, loads and wets nothing, unless a key that was refused was to do so.
  subroutine check_effect(store, section, boundary, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    type(boundary_t), intent(in) :: boundary
    type(messages_t), intent(inout) :: messages
    real(dp) :: loads(3)

    if (any(store%section(section)%value%is_wrong)) return
    if (boundary%displacement /= 'free' .or. boundary%water /= 'none') return
    if (deck_given(boundary%velocity_x) .or. deck_given(boundary%velocity_y) .or. &
        size(boundary%velocity_gradient) > 0 .or. deck_given(boundary%floor)) return
    loads = [boundary%traction_x, boundary%traction_y, boundary%pressure]
    if (maxval(abs(loads)) > 0.0_dp) return
    call warn(store, section, 'where', 'nothing acts on this boundary', messages)
  end subroutine check_effect

  !> The same part twice in one stage: the later one wins, which may not be meant.
  subroutine check_repeated(store, section, i, deck, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section, i          !! i: the &boundary
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages
    integer :: j, k

    associate (this => deck%boundary(i))
      if (this%where == 'box' .or. this%where == '') return
      do j = 1, i - 1
        associate (that => deck%boundary(j))
          if (that%where /= this%where) cycle
          do k = 1, size(deck%stage)
            if (.not. deck_acts_in(this, deck%stage(k)%name)) cycle
            if (.not. deck_acts_in(that, deck%stage(k)%name)) cycle
            if (acts(that%water, 'none') .and. acts(this%water, 'none')) then
              call warn(store, section, 'water', &
                  'overrides an earlier &boundary of the same part', &
                        messages)
              return
            else if (acts(that%displacement, 'free') .and. acts(this%displacement, 'free')) then
              call warn(store, section, 'displacement', &
                  'an earlier &boundary also holds this part', &
                        messages)
              return
            end if
          end do
        end associate
      end do
    end associate

  contains

    !> True for a choice other than the idle one; a refused choice is blank.
    pure logical function acts(choice, idle)
      character(*), intent(in) :: choice, idle

      acts = choice /= idle .and. choice /= ''
    end function acts
  end subroutine check_repeated
end module talus_deck_check_boundary
