! SPDX-License-Identifier: MIT
!> The typed deck. Component names are the deck's key names; their units, ranges and meaning are in
!! the key table (talus_deck_keys_*, `talus keys`). Values stay in the deck's units.
!! An absent real is NaN (ask deck_given), absent text is '', an absent list has size 0.
module talus_deck_types
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use talus_kinds, only: dp
  implicit none
  private
  public :: deck_t, run_t, geometry_t, nodes_t, smoothing_t, soil_t, damage_t, water_t, initial_t
  public :: boundary_t, stage_t, output_t, deck_given, deck_soil_index, deck_damage_index
  public :: deck_water_index, deck_acts_in, deck_exceeds, deck_moves_soil, deck_keeps_soil
  public :: deck_held

  !> Longest name of a soil, boundary or stage.
  integer, parameter, public :: name_length = 64

  type :: run_t
    character(:), allocatable :: title, name
    integer :: threads
    real(dp) :: gravity, water_unit_weight
  end type run_t

  type :: geometry_t
    character(:), allocatable :: kind
    real(dp) :: width, height
    real(dp) :: slope_height, slope_ratio, base_depth, toe_distance, crest_width
    real(dp) :: origin_x, origin_y
    character(:), allocatable :: file          !! path that opens from the working folder
    integer :: file_line                       !! where the deck names it
  end type geometry_t

  type :: nodes_t
    real(dp) :: spacing, spacing_y, grading_x, grading_y, perturbation
    integer :: seed
    real(dp) :: support
  end type nodes_t

  type :: smoothing_t
    integer :: levels
    real(dp) :: length
    character(:), allocatable :: weights, acts_on, elastic_strain
    real(dp) :: stabilisation, level_stiffness, stabilisation_floor
  end type smoothing_t

  type :: soil_t
    character(:), allocatable :: name
    real(dp) :: from_x, to_x, from_y, to_y     !! absent bounds are -huge and huge
    real(dp) :: density_solid, porosity, youngs_modulus, poisson_ratio
    character(:), allocatable :: plasticity
    real(dp) :: cohesion, friction_angle, dilation_angle
    character(:), allocatable :: fit
    real(dp) :: tension_cutoff, dilation_limit
    logical :: crack_closure
    character(:), allocatable :: softening
    real(dp) :: softening_strain
    real(dp) :: residual_cohesion, residual_friction_angle, residual_dilation_angle
    real(dp), allocatable :: softening_table_strain(:), softening_table_cohesion(:)
    real(dp), allocatable :: softening_table_friction_angle(:), softening_table_dilation_angle(:)
    character(:), allocatable :: stress, suction_strength
    real(dp) :: phi_b, suction_cohesion_max
    character(:), allocatable :: suction_strain
    real(dp) :: suction_modulus, kappa_s
  end type soil_t

  type :: damage_t
    character(:), allocatable :: soil, driver, law
    real(dp) :: kappa_0, kappa_f, mazars_a, mazars_b, strength_ratio, maximum
    character(:), allocatable :: split
  end type damage_t

  type :: water_t
    character(:), allocatable :: soil, retention
    real(dp) :: conductivity_x, conductivity_y, saturation_residual, saturation_maximum
    real(dp) :: alpha, n, pore_connectivity, air_entry_cut, c_parameter
    real(dp) :: air_entry, lambda
    real(dp) :: fx_a, fx_n, fx_m, fx_residual_suction
    character(:), allocatable :: file          !! path that opens from the working folder
    real(dp) :: relative_conductivity_minimum, specific_storage
    logical :: kozeny_carman
  end type water_t

  type :: initial_t
    character(:), allocatable :: from_result   !! path that opens from the working folder, or ''
    character(:), allocatable :: snapshot
    character(:), allocatable :: pore_pressure
    real(dp) :: suction, water_table, water_table_right, suction_limit, antecedent_rain
    character(:), allocatable :: stress
    real(dp) :: lateral_stress_ratio
  end type initial_t

  type :: boundary_t
    character(:), allocatable :: name, where
    integer :: where_line                      !! line of the deck
    real(dp) :: from_x, to_x, from_y, to_y     !! absent bounds are -huge and huge
    character(name_length), allocatable :: stages(:)
    character(:), allocatable :: displacement
    real(dp) :: velocity_x, velocity_y, traction_x, traction_y, pressure
    real(dp), allocatable :: velocity_gradient(:) !! xx, xy, yx, yy; size 0 when absent
    real(dp) :: centre_x, centre_y
    real(dp) :: floor
    character(:), allocatable :: water
    real(dp) :: head, flux, rain
    character(:), allocatable :: hydrograph    !! path that opens from the working folder
    real(dp) :: pressure_max
  end type boundary_t

  type :: stage_t
    character(:), allocatable :: name, kind, solve
    integer :: name_line                       !! line of the deck
    real(dp) :: duration, storm_step, storm_step_minimum
    real(dp) :: factor_first, factor_tolerance, tolerance
    integer :: steps_max
    real(dp) :: damping
    logical :: mass_scaling
    character(:), allocatable :: mass
    real(dp) :: step_safety
    character(:), allocatable :: water_step
    real(dp) :: water_safety, failure_displacement
    character(:), allocatable :: after_failure
    logical :: only_after_failure
    real(dp) :: rest_velocity
    real(dp) :: spin
    logical :: reset_displacement
    integer :: snapshots
  end type stage_t

  type :: output_t
    character(:), allocatable :: directory     !! path that opens from the working folder
    real(dp) :: snapshot_interval, history_interval
    real(dp), allocatable :: probe_x(:), probe_y(:)
    character(:), allocatable :: restart
    logical :: xdmf
  end type output_t

  type :: deck_t
    character(:), allocatable :: path          !! file the deck was read from
    character(:), &
        allocatable :: folder        !! its folder with a final '/', '' for the working one
    character(:), allocatable :: text          !! the file as it was read
    character(:), allocatable :: resolved      !! the same deck with every default written out
    type(run_t) :: run
    type(geometry_t) :: geometry
    type(nodes_t) :: nodes
    type(smoothing_t) :: smoothing
    type(soil_t), allocatable :: soil(:)
    type(damage_t), allocatable :: damage(:)
    type(water_t), allocatable :: water(:)
    type(initial_t) :: initial
    type(boundary_t), allocatable :: boundary(:)
    type(stage_t), allocatable :: stage(:)
    type(output_t) :: output
  end type deck_t

contains

  !> True when an optional real key has a value.
  elemental logical function deck_given(value)
    real(dp), intent(in) :: value !! a real component of the deck

    deck_given = .not. ieee_is_nan(value)
  end function deck_given

  !> True when both values are given and the first is larger.
  elemental logical function deck_exceeds(value, limit)
    real(dp), intent(in) :: value, limit !! real components of the deck

    deck_exceeds = .false.
    if (deck_given(value) .and. deck_given(limit)) deck_exceeds = value > limit
  end function deck_exceeds

  !> Position of a soil by name, 0 when there is none.
  pure integer function deck_soil_index(deck, name) result(found)
    type(deck_t), intent(in) :: deck
    character(*), intent(in) :: name !! soil

    do found = size(deck%soil), 1, -1
      if (deck%soil(found)%name == name) return
    end do
  end function deck_soil_index

  !> The &damage of a soil: the one that names it, else the one with a blank soil, else 0.
  pure integer function deck_damage_index(deck, name) result(found)
    type(deck_t), intent(in) :: deck
    character(*), intent(in) :: name !! soil

    do found = size(deck%damage), 1, -1
      if (deck%damage(found)%soil == name) return
    end do
    do found = size(deck%damage), 1, -1
      if (deck%damage(found)%soil == '') return
    end do
  end function deck_damage_index

  !> The &water of a soil: the one that names it, else the one with a blank soil, else 0.
  pure integer function deck_water_index(deck, name) result(found)
    type(deck_t), intent(in) :: deck
    character(*), intent(in) :: name !! soil

    do found = size(deck%water), 1, -1
      if (deck%water(found)%soil == name) return
    end do
    do found = size(deck%water), 1, -1
      if (deck%water(found)%soil == '') return
    end do
  end function deck_water_index

  !> True when any stage solves the soil.
  pure logical function deck_moves_soil(deck)
    type(deck_t), intent(in) :: deck
    integer :: i

    deck_moves_soil = .false.
    do i = 1, size(deck%stage)
      if (deck%stage(i)%solve == 'soil' .or. deck%stage(i)%solve == 'both') deck_moves_soil = .true.
    end do
  end function deck_moves_soil

  !> True when a run keeps the state of the soil: for its own stages, or because it starts from a
  !> saved state and is to hand on what that has.
  pure logical function deck_keeps_soil(deck)
    type(deck_t), intent(in) :: deck

    deck_keeps_soil = deck_moves_soil(deck) .or. len(deck%initial%from_result) > 0
  end function deck_keeps_soil

  !> Directions that a boundary holds or drives.
  pure function deck_held(boundary) result(held)
    type(boundary_t), intent(in) :: boundary
    logical :: held(2) !! x, y

    held = size(boundary%velocity_gradient) > 0 .or. boundary%displacement == 'fixed'
    held = held .or. deck_given([boundary%velocity_x, boundary%velocity_y]) .or. &
           boundary%displacement == ['roller_x', 'roller_y']
  end function deck_held

  !> True when a boundary acts in a stage.
  pure logical function deck_acts_in(boundary, stage)
    type(boundary_t), intent(in) :: boundary
    character(*), intent(in) :: stage !! name

    deck_acts_in = size(boundary%stages) == 0
    if (.not. deck_acts_in) deck_acts_in = any(boundary%stages == stage)
  end function deck_acts_in
end module talus_deck_types
