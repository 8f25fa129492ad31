! SPDX-License-Identifier: MIT
!> Contradictions in &stage, and between stages.
module talus_deck_check_stage
  use talus_kinds, only: dp
  use talus_deck_messages, only: messages_t
  use talus_deck_types, only: deck_t, stage_t, soil_t, deck_given, deck_exceeds, deck_acts_in, &
    deck_held
  use talus_deck_store, only: store_t, store_sections
  use talus_deck_report, only: complain => report_error, warn => report_warning
  implicit none
  private
  public :: check_stages

contains

  !> All &stage groups.
  subroutine check_stages(store, deck, messages)
    type(store_t), intent(in) :: store
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages
    integer, allocatable :: at(:)
    integer :: i, j

    call store_sections(store, 'stage', at)
    do i = 1, size(at)
      associate (stage => deck%stage(i))
        do j = 1, i - 1
          if (deck%stage(j)%name /= stage%name .or. len(stage%name) == 0) cycle
          call complain(store, at(i), 'name', 'another stage has this name', messages, &
                        'a name of its own')
          exit
        end do
        call check_solve(store, at(i), stage, deck, messages)
        call check_mass(store, at(i), stage, deck, messages)
        call check_clock(store, at(i), stage, messages)
        call check_order(store, at(i), i, deck, messages)
        if (stage%kind /= '' .and. (stage%solve == 'soil' .or. stage%solve == 'both')) then
          call check_support(store, at(i), stage, deck, messages)
          call check_landed(store, at(i), i, deck, messages)
        end if
      end associate
    end do
  end subroutine check_stages

  !> What a stage of its kind can solve.
  subroutine check_solve(store, section, stage, deck, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    type(stage_t), intent(in) :: stage
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages

    if (stage%solve == 'seepage' .or. stage%solve == 'both') then
      if (size(deck%water) == 0) then
        call complain(store, section, 'solve', 'there is no &water', messages, &
            '''soil'' without &water')
      else if (stage%kind == 'geostatic') then
        call complain(store, section, 'solve', &
            'a geostatic stage keeps the initial pore pressure', &
                      messages, '''soil'' with kind = ''geostatic''')
      else if (stage%kind == 'strength_reduction') then
        call complain(store, section, 'solve', &
            'strength is divided at the pore pressure of that moment', &
                      messages, '''soil'' with kind = ''strength_reduction''')
      end if
    end if
    if (stage%kind == 'dynamic' .and. stage%solve == 'seepage') then
      call complain(store, section, 'solve', 'seepage alone has no dynamics', messages, &
                    '''seepage'' with kind = ''storm''')
    end if
    if (stage%kind == 'dynamic' .and. stage%mass_scaling) then
      call warn(store, section, 'mass_scaling', &
          'a dynamic stage without its true mass: times and '// &
                'velocities mean nothing', messages)
    end if
  end subroutine check_solve

  !> What a consistent mass cannot be combined with.
  subroutine check_mass(store, section, stage, deck, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    type(stage_t), intent(in) :: stage
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages
    integer :: i

    if (stage%mass /= 'consistent') return
    if (stage%mass_scaling) call complain(store, section, 'mass', &
      'a scaled mass is not that of the soil', messages, &
      '''lumped'' with mass_scaling, or mass_scaling = .false.')
    do i = 1, size(deck%boundary)
      if (.not. deck_acts_in(deck%boundary(i), stage%name)) cycle
      if (size(deck%boundary(i)%velocity_gradient) > 0) then
        call complain(store, section, 'mass', &
          'the acceleration of nodes with a velocity_gradient does not reach their neighbours', &
          messages, '''lumped'' where a velocity_gradient acts')
        return
      else if (deck_given(deck%boundary(i)%floor)) then
        call complain(store, section, 'mass', &
          'a node that lands on a floor does not stop the mass that it shares', &
          messages, '''lumped'' where soil comes down to a floor')
        return
      end if
    end do
  end subroutine check_mass

  subroutine check_clock(store, section, stage, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    type(stage_t), intent(in) :: stage
    type(messages_t), intent(inout) :: messages

    if (deck_exceeds(stage%step_safety, 1.0_dp)) call warn(store, section, 'step_safety', &
      'above 1: the motion is unstable', messages)
    if (stage%kind /= 'storm' .and. stage%kind /= 'dynamic') return
    if (deck_exceeds(stage%water_safety, 1.0_dp)) call warn(store, section, 'water_safety', &
      'above 1: the water may be unstable', messages)
    if (stage%kind /= 'storm') return
    if (deck_exceeds(stage%storm_step, stage%duration)) then
      call complain(store, section, 'storm_step', 'longer than the stage', messages, &
                    'storm_step <= duration')
    end if
    if (deck_exceeds(stage%storm_step_minimum, stage%storm_step)) then
      call complain(store, section, 'storm_step_minimum', 'larger than storm_step', messages, &
                    'storm_step_minimum <= storm_step')
    end if
  end subroutine check_clock

  !> What comes before and after a stage.
  subroutine check_order(store, section, i, deck, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section, i          !! i: the stage
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages
    logical :: can_start
    integer :: j

    associate (stage => deck%stage(i))
      select case (stage%kind)
      case ('geostatic')
        if (i > 1) call warn(store, section, 'kind', 'a geostatic stage after another one', &
            messages)
        if (i == 1 .and. len(deck%initial%from_result) > 0) call warn(store, section, 'kind', &
            'a geostatic stage after from_result: the saved state is relaxed anew', messages)
      case ('storm')
        if (stage%after_failure == 'dynamic_next' .and. &
            .not. any(kind_is(deck%stage(i+1:), 'dynamic'))) then
          call complain(store, section, 'after_failure', 'no dynamic stage follows', messages, &
                        '''stop'', or a later &stage with kind = ''dynamic''')
        end if
        if (stage%solve /= 'seepage' .and. starts_weightless(deck, i)) &
          call warn(store, section, 'kind', &
              'no geostatic stage before it and no initial stress: '// &
                    'settlement under the own weight comes with the storm', messages)
      case ('strength_reduction')
        if (.not. any(is_plastic(deck%soil))) call complain(store, section, 'kind', &
            'no soil has a strength to divide', messages, &
            'a &soil with plasticity = ''drucker_prager''')
        if (starts_weightless(deck, i)) call warn(store, section, 'kind', &
            'no geostatic stage before it and no initial stress: '// &
                  'every trial feels the jolt of its own weight', messages)
      case ('dynamic')
        if (.not. stage%only_after_failure) return
        ! Whether a storm failed before it is told by the saved state.
        can_start = len(deck%initial%from_result) > 0
        do j = 1, i - 1
          if (deck%stage(j)%kind /= 'storm' .or. deck%stage(j)%solve == 'seepage') cycle
          if (deck%stage(j)%after_failure == 'dynamic_next') can_start = .true.
        end do
        if (.not. can_start) call complain(store, section, 'only_after_failure', &
            'no storm before it '// &
          'can fail', messages, '.true. after a storm that solves the soil')
      end select
    end associate
  end subroutine check_order

  !> True when a stage is the first to feel gravity.
  pure logical function starts_weightless(deck, i)
    type(deck_t), intent(in) :: deck
    integer, intent(in) :: i !! the stage

    starts_weightless = deck%initial%stress == 'none' .and. &
      len(deck%initial%from_result) == 0 .and. &
      deck_exceeds(deck%run%gravity, 0.0_dp) .and. &
      .not. any(feels_weight(deck%stage(:i-1)))
  end function starts_weightless

  !> Which stages leave a soil that bears its weight; trials of strength leave it as it was.
  elemental logical function feels_weight(stage)
    type(stage_t), intent(in) :: stage

    feels_weight = stage%kind /= 'strength_reduction' .and. stage%solve /= 'seepage'
  end function feels_weight

  !> Which soils have a strength.
  elemental logical function is_plastic(soil)
    type(soil_t), intent(in) :: soil

    is_plastic = soil%plasticity /= 'none'
  end function is_plastic

  !> Which stages are of a kind.
  elemental logical function kind_is(stage, kind)
    type(stage_t), intent(in) :: stage
    character(*), intent(in) :: kind

    kind_is = stage%kind == kind
  end function kind_is

  !> A body under gravity must be held to find rest.
  subroutine check_support(store, section, stage, deck, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    type(stage_t), intent(in) :: stage
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages
    logical :: holds(2), lands
    integer :: i

    if (.not. deck_exceeds(deck%run%gravity, 0.0_dp)) return
    holds = .false.
    lands = .false.
    do i = 1, size(deck%boundary)
      associate (boundary => deck%boundary(i))
        if (.not. deck_acts_in(boundary, stage%name)) cycle
        if (boundary%displacement == '') return
        holds = holds .or. deck_held(boundary)
        lands = lands .or. deck_given(boundary%floor)
      end associate
    end do
    if (stage%kind == 'dynamic') then
      if (.not. (holds(2) .or. lands)) call warn(store, section, 'name', &
          'no &boundary holds y in this stage: the '// &
                                   'body falls freely', messages)
      return
    end if
    if (.not. holds(2)) call complain(store, section, 'name', &
      'no &boundary holds y in this stage', messages, &
      'a &boundary with displacement = ''fixed'' or ''roller_y''')
    if (.not. holds(1)) call complain(store, section, 'name', &
      'no &boundary holds x in this stage', messages, &
      'a &boundary with displacement = ''fixed'' or ''roller_x''')
  end subroutine check_support

  !> What has landed in a dynamic stage needs its floor in the stages that look for equilibrium too.
  subroutine check_landed(store, section, i, deck, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section, i          !! i: the stage
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages
    integer :: j, k

    if (deck%stage(i)%kind == 'dynamic') return
    if (.not. deck_exceeds(deck%run%gravity, 0.0_dp)) return
    do j = 1, size(deck%boundary)
      associate (boundary => deck%boundary(j))
        if (.not. deck_given(boundary%floor)) cycle
        if (deck_acts_in(boundary, deck%stage(i)%name)) cycle
        do k = 1, i - 1
          if (deck%stage(k)%kind /= 'dynamic') cycle
          if (.not. deck_acts_in(boundary, deck%stage(k)%name)) cycle
          call warn(store, section, 'name', 'the floor of stage '''//deck%stage(k)%name// &
            ''' does not act in this one: what has landed falls on', messages)
          return
        end do
      end associate
    end do
  end subroutine check_landed
end module talus_deck_check_stage
