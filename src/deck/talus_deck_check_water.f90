! SPDX-License-Identifier: MIT
!> Contradictions in &water and &initial.
module talus_deck_check_water
  use talus_kinds, only: dp
  use talus_const, only: mm_per_hour
  use talus_deck_messages, only: messages_t
  use talus_deck_types, only: deck_t, deck_given, deck_exceeds, deck_soil_index, deck_water_index, &
    deck_moves_soil
  use talus_deck_store, only: store_t, store_sections, store_first, store_is_wrong
  use talus_deck_extent, only: extent_t, extent_of
  use talus_deck_check_file, only: check_file, check_retention
  use talus_deck_check_soil, only: soil_list
  use talus_deck_report, only: complain => report_error, warn => report_warning
  implicit none
  private
  public :: check_waters, check_initial

contains

  !> All &water groups.
  subroutine check_waters(store, deck, messages)
    type(store_t), intent(in) :: store
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages
    integer, allocatable :: at(:)
    integer :: i, j

    call store_sections(store, 'water', at)
    if (size(at) == 0) return
    do i = 1, size(at)
      associate (water => deck%water(i))
        if (len(water%soil) > 0 .and. deck_soil_index(deck, water%soil) == 0) then
          call complain(store, at(i), 'soil', 'unknown soil', messages, soil_list(deck))
        end if
        do j = 1, i - 1
          if (deck%water(j)%soil /= water%soil) cycle
          if (store_is_wrong(store, at(i), 'soil') .or. store_is_wrong(store, at(j), 'soil')) cycle
          call complain(store, at(i), 'soil', 'another &water already has this soil', messages, &
                        'one &water a soil')
          exit
        end do
        if (deck_exceeds(water%saturation_residual, water%saturation_maximum - 1.0e-6_dp)) then
          call complain(store, at(i), 'saturation_residual', 'not below saturation_maximum', &
                        messages, 'saturation_residual < saturation_maximum')
        end if
        if (deck_exceeds(1.0e-4_dp, water%air_entry_cut)) then
          if (water%retention == 'fredlund_xing') call complain(store, at(i), 'air_entry_cut', &
            'this law measures the conductivity from there', messages, '0.0001 to 10')
          if (water%retention == 'van_genuchten' .and. deck_exceeds(2.0_dp, water%n)) &
            call complain(store, at(i), 'air_entry_cut', 'with n < 2 the conductivity falls '// &
              'infinitely fast at saturation', messages, '0.0001 to 10; 0.01 to 0.02 is usual')
        end if
        if (deck_exceeds(water%conductivity_x, 0.1_dp)) then
          call warn(store, at(i), 'conductivity_x', 'very large; the unit is m/s', messages)
        end if
        if (water%retention == 'table') call check_retention(store, at(i), water%file, messages)
      end associate
    end do
    call store_sections(store, 'soil', at)
    do i = 1, size(at)
      if (len(deck%soil(i)%name) == 0 .or. deck_water_index(deck, deck%soil(i)%name) > 0) cycle
      call complain(store, at(i), 'name', 'this soil has no &water although others have', &
          messages, &
                    'a &water for it, or one &water with a blank soil')
    end do
  end subroutine check_waters

  !> &initial against &water, the stages and the body.
  subroutine check_initial(store, deck, messages)
    type(store_t), intent(in) :: store
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages
    integer :: section

    section = store_first(store, 'initial')
    if (len(deck%initial%from_result) > 0) then
      call check_restart(store, section, deck, messages)
      return
    end if
    if (len(deck%initial%snapshot) > 0) &
      call complain(store, section, 'snapshot', 'there is no from_result', messages, &
      'a snapshot of the file from_result')
    associate (initial => deck%initial)
      if (initial%pore_pressure == 'none') then
        if (size(deck%water) > 0) call complain(store, section, 'pore_pressure', &
            'with &water the '// &
          'initial pore pressure must be stated', messages, &
          '''uniform'', ''hydrostatic'' or ''steady''')
        return
      end if
      if (size(deck%water) == 0 .and. len(initial%pore_pressure) > 0) then
        call complain(store, section, 'pore_pressure', 'there is no &water', messages, &
                      '''none'' without &water')
        return
      end if
      if (initial%pore_pressure == 'uniform') return
      if (initial%pore_pressure == 'steady' .and. &
          any(deck_exceeds(initial%antecedent_rain*mm_per_hour, deck%water%conductivity_y))) &
        call warn(store, section, 'antecedent_rain', &
                  'more than the saturated conductivity_y: the rest runs off', messages)
      call check_water_table(store, section, deck, messages)
    end associate
  end subroutine check_initial

  !> A saved state has pore pressure and stress already. What is in the file is read later.
  subroutine check_restart(store, section, deck, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages

    call check_file(store, section, 'from_result', deck%initial%from_result, messages)
    if (deck%initial%pore_pressure /= 'none') call complain(store, section, 'pore_pressure', &
      'the state of from_result has a pore pressure already', messages, &
      '''none'' with from_result')
    if (deck%initial%stress /= 'none') call complain(store, section, 'stress', &
      'the state of from_result has a stress already', messages, '''none'' with from_result')
    if (.not. is_snapshot(deck%initial%snapshot)) call complain(store, section, 'snapshot', &
      'no name of a snapshot to start from', messages, 'a number, ''last'' or ''last_good''')
  end subroutine check_restart

  !> True for none, 'last', 'last_good' and numbers of up to six digits.
  pure logical function is_snapshot(name)
    character(*), intent(in) :: name

    is_snapshot = name == '' .or. name == 'last' .or. name == 'last_good' .or. &
      (len(name) > 0 .and. len(name) <= 6 .and. verify(name, '0123456789') == 0)
  end function is_snapshot

  subroutine check_water_table(store, section, deck, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages
    type(extent_t) :: extent
    character(:), allocatable :: key
    real(dp) :: highest
    integer :: i

    extent = extent_of(deck%geometry)
    if (.not. extent%is_known) return
    associate (initial => deck%initial)
      if (.not. all(deck_given([initial%water_table, initial%water_table_right]))) return
      highest = max(initial%water_table, initial%water_table_right)
      key = 'water_table'
      if (initial%water_table < highest) key = 'water_table_right'
      if (highest > extent%top) then
        call warn(store, section, key, &
            'above the body; water standing on the ground has '// &
                  'no weight here', messages)
      end if
      if (highest > extent%bottom .and. deck_moves_soil(deck)) then
        do i = 1, size(deck%soil)
          if (deck%soil(i)%stress /= 'net' .or. deck%soil(i)%from_y >= highest) cycle
          call warn(store, section, key, 'soil '''//deck%soil(i)%name// &
              ''' has stress = '// &
                    '''net'', which knows no uplift below the water table', messages)
        end do
      end if
    end associate
  end subroutine check_water_table
end module talus_deck_check_water
