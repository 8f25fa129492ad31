! SPDX-License-Identifier: MIT
!> From the deck's soils to the ground: laws with their parameters in SI units.
module talus_setup_ground
  use talus_kinds, only: dp
  use talus_const, only: deg
  use talus_status, only: status_t, status_failed
  use talus_deck_types, only: deck_t, soil_t, damage_deck_t => damage_t, water_t, deck_given, &
    deck_damage_index, deck_water_index
  use talus_ground, only: ground_t
  use talus_soil_law, only: soil_law_t, soil_law_prepare, plasticity_none, &
    plasticity_drucker_prager, stress_net, stress_bishop
  use talus_drucker_prager, only: fit_plane_strain, fit_compression, fit_extension
  use talus_strength, only: strength_t, softening_none, softening_linear, softening_exponential, &
    softening_table, suction_strength_none, suction_strength_phi_b, suction_strength_vanapalli
  use talus_suction_strain, only: suction_strain_none, suction_strain_constant, &
    suction_strain_alonso
  use talus_damage, only: damage_t, driver_none, driver_energy, driver_mazars, driver_von_mises, &
    driver_plastic_strain, damage_exponential, damage_linear, damage_mazars, split_full, &
    split_deviatoric, split_tensile
  use talus_retention, only: retention_t
  use talus_retention_table, only: retention_table_read
  use talus_water_curve_make, only: water_curve_make
  implicit none
  private
  public :: setup_ground, ground_intact

contains

  !> Build every soil of the deck.
  subroutine setup_ground(deck, ground, status)
    type(deck_t), intent(in) :: deck
    type(ground_t), intent(out) :: ground
    type(status_t), intent(inout) :: status
    integer :: i, n, water

    n = size(deck%soil)
    ground%gravity = deck%run%gravity
    ground%unit_weight = deck%run%water_unit_weight
    ! The unit weight of water belongs to the earth's gravity also where a deck changes gravity.
    ground%water_density = deck%run%water_unit_weight/9.81_dp
    ground%wet = size(deck%water) > 0
    allocate (ground%name(n), ground%law(n), ground%density_solid(n), ground%porosity(n))
    if (ground%wet) allocate (ground%curve(n), ground%conductivity(2, n), ground%storage(n), &
                              ground%kozeny_carman(n))
    do i = 1, n
      ground%name(i) = deck%soil(i)%name
      ground%density_solid(i) = deck%soil(i)%density_solid
      ground%porosity(i) = deck%soil(i)%porosity
      call fill_law(deck%soil(i), ground%law(i))
      ground%law(i)%own_strain = .not. (deck%smoothing%levels == 2 .and. &
                                        deck%smoothing%acts_on == 'damage_only')
      if (deck_damage_index(deck, deck%soil(i)%name) > 0) &
        call fill_damage(deck%damage(deck_damage_index(deck, deck%soil(i)%name)), &
                         ground%law(i)%damage)
      call soil_law_prepare(ground%law(i), status)
      if (.not. ground%wet) cycle
      water = deck_water_index(deck, deck%soil(i)%name)
      call fill_water(deck%water(water), ground, i, status)
    end do
  end subroutine setup_ground

  !> The same ground without damage and softening, and elastic unless `plastic`: in it gravity is
  !> first switched on, since the history of the ground before the run is not a failure.
  function ground_intact(ground, plastic) result(intact)
    type(ground_t), intent(in) :: ground
    logical, intent(in) :: plastic
    type(ground_t) :: intact
    type(status_t) :: status
    integer :: i

    intact = ground
    do i = 1, size(intact%law)
      intact%law(i)%damage%driver = driver_none
      if (.not. plastic) then
        intact%law(i)%plasticity = plasticity_none
        intact%law(i)%closes = .false.
      end if
      intact%law(i)%strength%softening = softening_none
      call soil_law_prepare(intact%law(i), status)
    end do
  end function ground_intact

  !> Elasticity, strength and the effect of suction.
  pure subroutine fill_law(soil, law)
    type(soil_t), intent(in) :: soil
    type(soil_law_t), intent(inout) :: law

    law%elastic%youngs_modulus = soil%youngs_modulus
    law%elastic%poisson_ratio = soil%poisson_ratio
    law%plasticity = merge(plasticity_drucker_prager, plasticity_none, &
                           soil%plasticity == 'drucker_prager')
    law%stress = merge(stress_bishop, stress_net, soil%stress == 'bishop')
    if (law%plasticity == plasticity_drucker_prager) then
      call fill_strength(soil, law%strength)
      law%closes = soil%crack_closure
    end if
    select case (soil%suction_strain)
    case ('constant')
      law%swelling%kind = suction_strain_constant
      law%swelling%modulus = soil%suction_modulus
    case ('alonso')
      law%swelling%kind = suction_strain_alonso
      law%swelling%kappa_s = soil%kappa_s
      law%swelling%porosity = soil%porosity
    case default
      law%swelling%kind = suction_strain_none
    end select
  end subroutine fill_law

  !> The cone, its softening and its gain from suction.
  pure subroutine fill_strength(soil, strength)
    type(soil_t), intent(in) :: soil
    type(strength_t), intent(inout) :: strength

    select case (soil%fit)
    case ('compression')
      strength%fit = fit_compression
    case ('extension')
      strength%fit = fit_extension
    case default
      strength%fit = fit_plane_strain
    end select
    strength%cohesion = soil%cohesion
    strength%friction_angle = soil%friction_angle*deg
    strength%dilation_angle = soil%dilation_angle*deg
    if (deck_given(soil%tension_cutoff)) strength%tension_cutoff = soil%tension_cutoff
    if (deck_given(soil%dilation_limit)) strength%dilation_limit = soil%dilation_limit
    select case (soil%softening)
    case ('linear', 'exponential')
      strength%softening = merge(softening_linear, softening_exponential, &
                                 soil%softening == 'linear')
      strength%softening_strain = soil%softening_strain
      strength%residual_cohesion = soil%residual_cohesion
      strength%residual_friction_angle = soil%residual_friction_angle*deg
      strength%residual_dilation_angle = soil%residual_dilation_angle*deg
    case ('table')
      strength%softening = softening_table
      strength%table_strain = soil%softening_table_strain
      strength%table_cohesion = column(soil%softening_table_cohesion, soil%cohesion)
      strength%table_friction_angle = column(soil%softening_table_friction_angle, &
                                             soil%friction_angle)*deg
      strength%table_dilation_angle = column(soil%softening_table_dilation_angle, &
                                             soil%dilation_angle)*deg
    case default
      strength%softening = softening_none
    end select
    select case (soil%suction_strength)
    case ('phi_b')
      strength%suction = suction_strength_phi_b
      strength%phi_b = soil%phi_b*deg
    case ('vanapalli')
      strength%suction = suction_strength_vanapalli
    case default
      strength%suction = suction_strength_none
    end select
    if (deck_given(soil%suction_cohesion_max)) &
      strength%suction_cohesion_max = soil%suction_cohesion_max

  contains

    !> A column of the softening table; an absent one keeps the soil's own value.
    pure function column(values, alone) result(filled)
      real(dp), intent(in) :: values(:), alone
      real(dp), allocatable :: filled(:)

      if (size(values) > 0) then
        filled = values
      else
        filled = spread(alone, 1, size(soil%softening_table_strain))
      end if
    end function column
  end subroutine fill_strength

  !> Driver, law and split of damage.
  pure subroutine fill_damage(from, damage)
    type(damage_deck_t), intent(in) :: from
    type(damage_t), intent(inout) :: damage

    select case (from%driver)
    case ('energy')
      damage%driver = driver_energy
    case ('mazars')
      damage%driver = driver_mazars
    case ('von_mises')
      damage%driver = driver_von_mises
    case default
      damage%driver = driver_plastic_strain
    end select
    select case (from%law)
    case ('linear')
      damage%law = damage_linear
    case ('mazars')
      damage%law = damage_mazars
    case default
      damage%law = damage_exponential
    end select
    select case (from%split)
    case ('deviatoric')
      damage%split = split_deviatoric
    case ('tensile')
      damage%split = split_tensile
    case default
      damage%split = split_full
    end select
    damage%kappa_0 = from%kappa_0
    if (deck_given(from%kappa_f)) damage%kappa_f = from%kappa_f
    if (deck_given(from%mazars_a)) damage%mazars_a = from%mazars_a
    if (deck_given(from%mazars_b)) damage%mazars_b = from%mazars_b
    damage%strength_ratio = from%strength_ratio
    damage%maximum = from%maximum
  end subroutine fill_damage

  !> Retention, conductivity and storage of soil i.
  subroutine fill_water(water, ground, i, status)
    type(water_t), intent(in) :: water
    type(ground_t), intent(inout) :: ground
    integer, intent(in) :: i
    type(status_t), intent(inout) :: status
    type(retention_t) :: retention

    if (status_failed(status)) return
    retention%law = water%retention
    retention%unit_weight = ground%unit_weight
    retention%saturation_residual = water%saturation_residual
    retention%saturation_maximum = water%saturation_maximum
    retention%alpha = given_or(water%alpha, retention%alpha)
    retention%n = given_or(water%n, retention%n)
    retention%pore_connectivity = given_or(water%pore_connectivity, retention%pore_connectivity)
    retention%c_parameter = given_or(water%c_parameter, retention%c_parameter)
    retention%air_entry = given_or(water%air_entry, retention%air_entry)
    retention%air_entry_cut = given_or(water%air_entry_cut, retention%air_entry_cut)
    retention%lambda = given_or(water%lambda, retention%lambda)
    retention%fx_a = given_or(water%fx_a, retention%fx_a)
    retention%fx_n = given_or(water%fx_n, retention%fx_n)
    retention%fx_m = given_or(water%fx_m, retention%fx_m)
    retention%fx_residual_suction = given_or(water%fx_residual_suction, &
                                             retention%fx_residual_suction)
    retention%relative_conductivity_minimum = water%relative_conductivity_minimum
    if (water%retention == 'table') call retention_table_read(water%file, retention%table, status)
    call water_curve_make(retention, ground%curve(i), status)
    ground%conductivity(:, i) = [water%conductivity_x, water%conductivity_y]
    ground%storage(i) = water%specific_storage
    ground%kozeny_carman(i) = water%kozeny_carman
  end subroutine fill_water

  pure real(dp) function given_or(value, other)
    real(dp), intent(in) :: value, other

    given_or = other
    if (deck_given(value)) given_or = value
  end function given_or
end module talus_setup_ground
