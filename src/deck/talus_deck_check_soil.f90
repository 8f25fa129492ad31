! SPDX-License-Identifier: MIT
!> Contradictions in &soil and &damage.
module talus_deck_check_soil
  use talus_kinds, only: dp
  use talus_const, only: deg
  use talus_text, only: text_of
  use talus_deck_messages, only: messages_t
  use talus_deck_types, only: deck_t, soil_t, smoothing_t, deck_given, deck_exceeds, deck_soil_index, &
    deck_water_index, deck_damage_index
  use talus_deck_store, only: store_t, store_sections, store_is_wrong
  use talus_deck_extent, only: extent_t, extent_of, extent_holds
  use talus_deck_report, only: complain => report_error, warn => report_warning
  implicit none
  private
  public :: check_soils, check_damages, check_region, soil_list

contains

  !> All &soil groups.
  subroutine check_soils(store, deck, messages)
    type(store_t), intent(in) :: store
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages
    type(extent_t) :: extent
    integer, allocatable :: at(:)
    integer :: i, j

    call store_sections(store, 'soil', at)
    extent = extent_of(deck%geometry)
    do i = 1, size(at)
      associate (soil => deck%soil(i))
        do j = 1, i - 1
          if (deck%soil(j)%name /= soil%name .or. len(soil%name) == 0) cycle
          call complain(store, at(i), 'name', 'another soil has this name', messages, &
                        'a name of its own')
          exit
        end do
        call check_region(store, at(i), soil%from_x, soil%to_x, soil%from_y, soil%to_y, messages)
        if (extent%is_known) call check_place(store, at(i), soil, extent, messages)
        call check_units(store, at(i), soil, deck, messages)
        if (soil%plasticity == 'drucker_prager') then
          call check_strength(store, at(i), soil, messages)
          call check_softening(store, at(i), soil, deck%smoothing%levels, messages)
          call check_closure(store, at(i), soil, deck%smoothing, messages)
        end if
        call check_suction(store, at(i), soil, deck, messages)
      end associate
    end do
    if (extent%is_known .and. size(at) > 0) call check_cover(store, at(1), deck, extent, messages)
  end subroutine check_soils

  !> Every part of the body needs a soil; looked at on a grid of points, gaps finer than that are
  !! found when the nodes are made.
  subroutine check_cover(store, section, deck, extent, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section             !! of the first soil
    type(deck_t), intent(in) :: deck
    type(extent_t), intent(in) :: extent
    type(messages_t), intent(inout) :: messages
    integer, parameter :: n = 100
    real(dp) :: x, y
    logical :: is_covered
    integer :: i, j, k

    do j = 1, n
      y = extent%bottom + (real(j, dp) - 0.5_dp)/real(n, dp)*(extent%top - extent%bottom)
      do i = 1, n
        x = extent%left + (real(i, dp) - 0.5_dp)/real(n, dp)*(extent%right - extent%left)
        if (.not. extent_holds(deck%geometry, x, y)) cycle
        is_covered = .false.
        do k = 1, size(deck%soil)
          associate (soil => deck%soil(k))
            is_covered = is_covered .or. (x >= soil%from_x .and. x <= soil%to_x .and. &
                                          y >= soil%from_y .and. y <= soil%to_y)
          end associate
        end do
        if (is_covered) cycle
        call complain(store, section, 'name', 'no soil at x = '//text_of(x, 3)//', y = '// &
                      text_of(y, 3), messages, &
                      'soils that fill the body, e.g. a first one without '// &
                      'bounds')
        return
      end do
    end do
  end subroutine check_cover

  !> A region whose ends are in the wrong order is empty.
  subroutine check_region(store, section, from_x, to_x, from_y, to_y, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    real(dp), intent(in) :: from_x, to_x, from_y, to_y !! [m]
    type(messages_t), intent(inout) :: messages

    if (from_x >= to_x) then
      call complain(store, section, 'from_x', 'the region is empty', messages, 'from_x < to_x')
    end if
    if (from_y >= to_y) then
      call complain(store, section, 'from_y', 'the region is empty', messages, 'from_y < to_y')
    end if
  end subroutine check_region

  subroutine check_place(store, section, soil, extent, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    type(soil_t), intent(in) :: soil
    type(extent_t), intent(in) :: extent
    type(messages_t), intent(inout) :: messages

    if (soil%from_x >= extent%right .or. soil%to_x <= extent%left .or. &
        soil%from_y >= extent%top .or. soil%to_y <= extent%bottom) then
      call warn(store, section, 'name', 'its region lies outside the body', messages)
    end if
  end subroutine check_place

  !> Values that look like kPa or radians.
  subroutine check_units(store, section, soil, deck, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    type(soil_t), intent(in) :: soil
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages

    if (.not. deck_exceeds(deck%run%gravity, 0.0_dp)) return
    if (deck_exceeds(1.0e4_dp, soil%youngs_modulus)) then
      call warn(store, section, 'youngs_modulus', 'very soft; the unit is Pa', messages)
    end if
    if (soil%plasticity /= 'drucker_prager') return
    if (deck_exceeds(100.0_dp, soil%cohesion) .and. deck_exceeds(soil%cohesion, 0.0_dp)) then
      call warn(store, section, 'cohesion', 'very low; the unit is Pa', messages)
    end if
    if (deck_exceeds(1.6_dp, soil%friction_angle) .and. deck_exceeds(soil%friction_angle, 0.0_dp)) &
        then
      call warn(store, section, 'friction_angle', 'very low; the unit is degrees', messages)
    end if
  end subroutine check_units

  subroutine check_strength(store, section, soil, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    type(soil_t), intent(in) :: soil
    type(messages_t), intent(inout) :: messages

    if (deck_exceeds(soil%dilation_angle, soil%friction_angle)) then
      call complain(store, section, 'dilation_angle', &
          'larger than friction_angle, so plastic work '// &
                    'would be gained', messages, 'dilation_angle <= friction_angle')
    end if
    if (.not. all(deck_given([soil%cohesion, soil%friction_angle]))) return
    if (max(soil%cohesion, soil%friction_angle) <= 0.0_dp) then
      call complain(store, section, 'cohesion', 'the soil has no strength at all', messages, &
                    'cohesion > 0 or friction_angle > 0')
    else if (soil%friction_angle > 0.0_dp) then
      if (deck_exceeds(soil%tension_cutoff, soil%cohesion/tan(soil%friction_angle*deg))) then
        call warn(store, section, 'tension_cutoff', 'has no effect: the apex of the cone, '// &
                  'cohesion/tan(friction_angle), is lower', messages)
      end if
    end if
  end subroutine check_strength

  !> Soil that closes again has to open without stress, and by its own volume: that of two levels
  !! counts what opened within their length, for good where the neighbours have left.
  subroutine check_closure(store, section, soil, smoothing, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    type(soil_t), intent(in) :: soil
    type(smoothing_t), intent(in) :: smoothing
    type(messages_t), intent(inout) :: messages

    if (.not. soil%crack_closure) return
    if (.not. deck_given(soil%tension_cutoff) .or. deck_exceeds(soil%tension_cutoff, 0.0_dp)) &
      call complain(store, section, 'crack_closure', 'soil that closes again must open without '// &
                    'tension', messages, 'tension_cutoff = 0')
    if (smoothing%levels > 1 .and. smoothing%acts_on /= 'damage_only') &
      call complain(store, section, 'crack_closure', 'at two levels soil beside a crack counts '// &
                    'as open, too', messages, &
                    '&smoothing levels = 1, or acts_on = ''damage_only''')
  end subroutine check_closure

  subroutine check_softening(store, section, soil, levels, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    type(soil_t), intent(in) :: soil
    integer, intent(in) :: levels
    type(messages_t), intent(inout) :: messages
    logical :: falls

    select case (soil%softening)
    case ('linear', 'exponential')
      falls = deck_exceeds(soil%cohesion, soil%residual_cohesion) .or. &
              deck_exceeds(soil%friction_angle, soil%residual_friction_angle) .or. &
              deck_exceeds(soil%dilation_angle, soil%residual_dilation_angle)
      if (.not. falls) call complain(store, section, 'softening', &
          'no residual value is below its '// &
        'peak', messages, &
        'residual_cohesion, residual_friction_angle or residual_dilation_angle '// &
        'below the peak')
      call check_residual(store, section, 'cohesion', soil%residual_cohesion, soil%cohesion, &
          messages)
      call check_residual(store, section, 'friction_angle', soil%residual_friction_angle, &
                          soil%friction_angle, messages)
      call check_residual(store, section, 'dilation_angle', soil%residual_dilation_angle, &
                          soil%dilation_angle, messages)
      if (deck_exceeds(soil%residual_dilation_angle, soil%residual_friction_angle)) then
        call complain(store, section, 'residual_dilation_angle', 'larger than '// &
          'residual_friction_angle', messages, 'residual_dilation_angle <= residual_friction_angle')
      end if
    case ('table')
      call check_softening_table(store, section, soil, messages)
    case default
      return
    end select
    if (levels == 1) call warn(store, section, 'softening', &
        'with &smoothing levels = 1 the width of '// &
                               'a shear band depends on the node spacing', messages)
  end subroutine check_softening

  subroutine check_residual(store, section, name, residual, peak, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    character(*), intent(in) :: name           !! key of the peak value
    real(dp), intent(in) :: residual, peak
    type(messages_t), intent(inout) :: messages

    if (deck_exceeds(residual, peak)) then
      call complain(store, section, 'residual_'//name, 'larger than '//name, messages, &
                    'residual_'//name//' <= '//name)
    end if
  end subroutine check_residual

  subroutine check_softening_table(store, section, soil, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    type(soil_t), intent(in) :: soil
    type(messages_t), intent(inout) :: messages
    integer :: n

    n = size(soil%softening_table_strain)
    if (n == 0) return
    associate (strain => soil%softening_table_strain)
      if (n < 2 .or. strain(1) > 0.0_dp .or. any(strain(2:) <= strain(:n-1))) then
        call complain(store, section, 'softening_table_strain', 'not a rising list', messages, &
                      'two or more values, the first 0, each larger than the one before')
      end if
    end associate
    if (size(soil%softening_table_cohesion) + size(soil%softening_table_friction_angle) &
        + size(soil%softening_table_dilation_angle) == 0) then
      call complain(store, section, 'softening', 'the table has strains only', messages, &
                    'softening_table_cohesion, _friction_angle or _dilation_angle with it')
    end if
    call check_length('softening_table_cohesion', size(soil%softening_table_cohesion))
    call check_length('softening_table_friction_angle', size(soil%softening_table_friction_angle))
    call check_length('softening_table_dilation_angle', size(soil%softening_table_dilation_angle))
    if (any(deck_exceeds(at_strains(soil%softening_table_dilation_angle, soil%dilation_angle), &
                         at_strains(soil%softening_table_friction_angle, soil%friction_angle))) &
        .and. .not. deck_exceeds(soil%dilation_angle, soil%friction_angle)) then
      call complain(store, section, 'softening_table_dilation_angle', &
                    'larger than the angle of friction at a strain of the table', messages, &
                    'at each strain, angle of dilation <= angle of friction')
    end if

  contains

    !> An angle at each strain: from its list, if that is as long, else the constant one.
    pure function at_strains(list, constant) result(angles)
      real(dp), intent(in) :: list(:), constant !! [deg]
      real(dp) :: angles(n)

      angles = constant
      if (size(list) == n) angles = list
    end function at_strains

    subroutine check_length(name, length)
      character(*), intent(in) :: name
      integer, intent(in) :: length

      if (length == 0 .or. length == n) return
      call complain(store, section, name, 'not as many values as softening_table_strain', &
          messages, &
                    'one value for each strain')
    end subroutine check_length
  end subroutine check_softening_table

  !> Suction may act once: through Bishop's stress, or through c(s) and eps_s (src/THEORY.md 3).
  subroutine check_suction(store, section, soil, deck, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    type(soil_t), intent(in) :: soil
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages
    logical :: has_strength, has_strain, is_bishop

    is_bishop = soil%stress == 'bishop'
    has_strength = soil%plasticity == 'drucker_prager' .and. soil%suction_strength /= 'none' &
                   .and. soil%suction_strength /= ''
    has_strain = soil%suction_strain == 'constant' .or. soil%suction_strain == 'alonso'
    if (is_bishop .and. has_strength) then
      call complain(store, section, 'suction_strength', &
          'suction is counted twice: Bishop''s stress '// &
        'already strengthens the soil', messages, '''none'' with stress = ''bishop''')
    end if
    if (is_bishop .and. has_strain) then
      call complain(store, section, 'suction_strain', &
          'suction is counted twice: Bishop''s stress '// &
        'already strains the soil', messages, '''none'' with stress = ''bishop''')
    end if
    if (size(deck%water) > 0) then
      if (deck_water_index(deck, soil%name) > 0 .and. deck_exceeds(1.0e-6_dp, soil%porosity)) then
        call complain(store, section, 'porosity', 'no room for water, but &water names this soil', &
                      messages, '> 0 with &water')
      end if
      return
    end if
    if (is_bishop) call complain(store, section, 'stress', &
        'there is no pore pressure without &water', &
                                 messages, '''net'' without &water')
    if (has_strength) call complain(store, section, 'suction_strength', 'there is no suction '// &
                                    'without &water', messages, '''none'' without &water')
    if (has_strain) call complain(store, section, 'suction_strain', 'there is no suction '// &
                                  'without &water', messages, '''none'' without &water')
  end subroutine check_suction

  !> All &damage groups.
  subroutine check_damages(store, deck, messages)
    type(store_t), intent(in) :: store
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages
    integer, allocatable :: at(:)
    integer :: i, j

    call store_sections(store, 'damage', at)
    do i = 1, size(at)
      associate (damage => deck%damage(i))
        if (len(damage%soil) > 0 .and. deck_soil_index(deck, damage%soil) == 0) then
          call complain(store, at(i), 'soil', 'unknown soil', messages, soil_list(deck))
        end if
        do j = 1, i - 1
          if (deck%damage(j)%soil /= damage%soil) cycle
          if (store_is_wrong(store, at(i), 'soil') .or. store_is_wrong(store, at(j), 'soil')) cycle
          call complain(store, at(i), 'soil', 'another &damage already has this soil', messages, &
                        'one &damage a soil')
          exit
        end do
        if (.not. deck_exceeds(damage%kappa_f, damage%kappa_0) .and. damage%law /= 'mazars' .and. &
            all(deck_given([damage%kappa_f, damage%kappa_0]))) then
          call complain(store, at(i), 'kappa_f', 'not above kappa_0', messages, 'kappa_f > kappa_0')
        end if
        call check_driver(store, at(i), i, deck, messages)
        if (deck%smoothing%levels == 1) call warn(store, at(i), 'law', &
            'with &smoothing levels = 1 '// &
          'the width of a damaged zone depends on the node spacing', messages)
      end associate
    end do
  end subroutine check_damages

  !> Damage driven by plastic strain needs plasticity in its soils.
  subroutine check_driver(store, section, i, deck, messages)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section, i          !! i: the &damage
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages
    integer :: j

    if (deck%damage(i)%driver /= 'plastic_strain') return
    do j = 1, size(deck%soil)
      if (deck_damage_index(deck, deck%soil(j)%name) /= i) cycle
      if (deck%soil(j)%plasticity /= 'none') cycle
      call complain(store, section, 'driver', 'soil '''//deck%soil(j)%name//''' has no plastic '// &
                    'strain', messages, '''plastic_strain'' with plasticity = ''drucker_prager''')
    end do
  end subroutine check_driver

  !> Names of all soils, for messages.
  pure function soil_list(deck) result(text)
    type(deck_t), intent(in) :: deck
    character(:), allocatable :: text
    integer :: i

    text = ''
    do i = 1, size(deck%soil)
      text = text//', '''//deck%soil(i)%name//''''
    end do
    text = text(3:)
  end function soil_list
end module talus_deck_check_soil
