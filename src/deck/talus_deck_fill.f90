! SPDX-License-Identifier: MIT
!> From the generic store to the typed deck: one line a key.
module talus_deck_fill
  use talus_kinds, only: dp
  use talus_deck_types, only: deck_t, run_t, geometry_t, nodes_t, smoothing_t, soil_t, damage_t, &
    water_t, initial_t, boundary_t, stage_t, output_t, deck_given
  use talus_deck_store, only: store_t, store_sections, store_first, store_line, get => store_get
  use talus_deck_path, only: path_from_deck
  implicit none
  private
  public :: deck_fill

contains

  !> Copy all values; deck%folder must be known. Keys missing in the table are noted in the store.
  subroutine deck_fill(store, deck)
    type(store_t), intent(inout) :: store !! with defaults applied
    type(deck_t), intent(inout) :: deck
    integer, allocatable :: at(:)
    integer :: i

    call fill_run(store, store_first(store, 'run'), deck%run)
    call fill_geometry(store, store_first(store, 'geometry'), deck%folder, deck%geometry)
    call fill_nodes(store, store_first(store, 'nodes'), deck%nodes)
    call fill_smoothing(store, store_first(store, 'smoothing'), deck%smoothing)
    call fill_initial(store, store_first(store, 'initial'), deck%folder, deck%initial)
    call fill_output(store, store_first(store, 'output'), deck%folder, deck%output)
    call store_sections(store, 'soil', at)
    allocate (deck%soil(size(at)))
    do i = 1, size(at)
      call fill_soil(store, at(i), deck%soil(i))
    end do
    call store_sections(store, 'damage', at)
    allocate (deck%damage(size(at)))
    do i = 1, size(at)
      call fill_damage(store, at(i), deck%damage(i))
    end do
    call store_sections(store, 'water', at)
    allocate (deck%water(size(at)))
    do i = 1, size(at)
      call fill_water(store, at(i), deck%folder, deck%water(i))
    end do
    call store_sections(store, 'boundary', at)
    allocate (deck%boundary(size(at)))
    do i = 1, size(at)
      call fill_boundary(store, at(i), deck%folder, deck%boundary(i))
    end do
    call store_sections(store, 'stage', at)
    allocate (deck%stage(size(at)))
    do i = 1, size(at)
      call fill_stage(store, at(i), deck%stage(i))
    end do
  end subroutine deck_fill

  subroutine fill_run(store, s, run)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: s
    type(run_t), intent(out) :: run

    call get(store, s, 'title', run%title)
    call get(store, s, 'name', run%name)
    call get(store, s, 'threads', run%threads)
    call get(store, s, 'gravity', run%gravity)
    call get(store, s, 'water_unit_weight', run%water_unit_weight)
  end subroutine fill_run

  subroutine fill_geometry(store, s, folder, geometry)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: s
    character(*), intent(in) :: folder
    type(geometry_t), intent(out) :: geometry

    call get(store, s, 'kind', geometry%kind)
    call get(store, s, 'width', geometry%width)
    call get(store, s, 'height', geometry%height)
    call get(store, s, 'slope_height', geometry%slope_height)
    call get(store, s, 'slope_ratio', geometry%slope_ratio)
    call get(store, s, 'base_depth', geometry%base_depth)
    call get(store, s, 'toe_distance', geometry%toe_distance)
    call get(store, s, 'crest_width', geometry%crest_width)
    call get(store, s, 'origin_x', geometry%origin_x)
    call get(store, s, 'origin_y', geometry%origin_y)
    call get_path(store, s, folder, 'file', geometry%file)
    geometry%file_line = store_line(store, s, 'file')
  end subroutine fill_geometry

  subroutine fill_nodes(store, s, nodes)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: s
    type(nodes_t), intent(out) :: nodes

    call get(store, s, 'spacing', nodes%spacing)
    call get(store, s, 'spacing_y', nodes%spacing_y)
    call get(store, s, 'grading_x', nodes%grading_x)
    call get(store, s, 'grading_y', nodes%grading_y)
    call get(store, s, 'perturbation', nodes%perturbation)
    call get(store, s, 'seed', nodes%seed)
    call get(store, s, 'support', nodes%support)
  end subroutine fill_nodes

  subroutine fill_smoothing(store, s, smoothing)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: s
    type(smoothing_t), intent(out) :: smoothing

    call get(store, s, 'levels', smoothing%levels)
    call get(store, s, 'length', smoothing%length)
    call get(store, s, 'weights', smoothing%weights)
    call get(store, s, 'acts_on', smoothing%acts_on)
    call get(store, s, 'elastic_strain', smoothing%elastic_strain)
    call get(store, s, 'stabilisation', smoothing%stabilisation)
    call get(store, s, 'level_stiffness', smoothing%level_stiffness)
    call get(store, s, 'stabilisation_floor', smoothing%stabilisation_floor)
  end subroutine fill_smoothing

  subroutine fill_soil(store, s, soil)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: s
    type(soil_t), intent(out) :: soil

    call get(store, s, 'name', soil%name)
    call fill_bounds(store, s, soil%from_x, soil%to_x, soil%from_y, soil%to_y)
    call get(store, s, 'density_solid', soil%density_solid)
    call get(store, s, 'porosity', soil%porosity)
    call get(store, s, 'youngs_modulus', soil%youngs_modulus)
    call get(store, s, 'poisson_ratio', soil%poisson_ratio)
    call get(store, s, 'plasticity', soil%plasticity)
    call get(store, s, 'cohesion', soil%cohesion)
    call get(store, s, 'friction_angle', soil%friction_angle)
    call get(store, s, 'dilation_angle', soil%dilation_angle)
    call get(store, s, 'fit', soil%fit)
    call get(store, s, 'tension_cutoff', soil%tension_cutoff)
    call get(store, s, 'crack_closure', soil%crack_closure)
    call get(store, s, 'dilation_limit', soil%dilation_limit)
    call get(store, s, 'softening', soil%softening)
    call get(store, s, 'softening_strain', soil%softening_strain)
    call get(store, s, 'residual_cohesion', soil%residual_cohesion)
    call get(store, s, 'residual_friction_angle', soil%residual_friction_angle)
    call get(store, s, 'residual_dilation_angle', soil%residual_dilation_angle)
    call get(store, s, 'softening_table_strain', soil%softening_table_strain)
    call get(store, s, 'softening_table_cohesion', soil%softening_table_cohesion)
    call get(store, s, 'softening_table_friction_angle', soil%softening_table_friction_angle)
    call get(store, s, 'softening_table_dilation_angle', soil%softening_table_dilation_angle)
    call get(store, s, 'stress', soil%stress)
    call get(store, s, 'suction_strength', soil%suction_strength)
    call get(store, s, 'phi_b', soil%phi_b)
    call get(store, s, 'suction_cohesion_max', soil%suction_cohesion_max)
    call get(store, s, 'suction_strain', soil%suction_strain)
    call get(store, s, 'suction_modulus', soil%suction_modulus)
    call get(store, s, 'kappa_s', soil%kappa_s)
  end subroutine fill_soil

  subroutine fill_damage(store, s, damage)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: s
    type(damage_t), intent(out) :: damage

    call get(store, s, 'soil', damage%soil)
    call get(store, s, 'driver', damage%driver)
    call get(store, s, 'law', damage%law)
    call get(store, s, 'kappa_0', damage%kappa_0)
    call get(store, s, 'kappa_f', damage%kappa_f)
    call get(store, s, 'mazars_a', damage%mazars_a)
    call get(store, s, 'mazars_b', damage%mazars_b)
    call get(store, s, 'strength_ratio', damage%strength_ratio)
    call get(store, s, 'maximum', damage%maximum)
    call get(store, s, 'split', damage%split)
  end subroutine fill_damage

  subroutine fill_water(store, s, folder, water)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: s
    character(*), intent(in) :: folder
    type(water_t), intent(out) :: water

    call get(store, s, 'soil', water%soil)
    call get(store, s, 'retention', water%retention)
    call get(store, s, 'conductivity_x', water%conductivity_x)
    call get(store, s, 'conductivity_y', water%conductivity_y)
    call get(store, s, 'saturation_residual', water%saturation_residual)
    call get(store, s, 'saturation_maximum', water%saturation_maximum)
    call get(store, s, 'alpha', water%alpha)
    call get(store, s, 'n', water%n)
    call get(store, s, 'pore_connectivity', water%pore_connectivity)
    call get(store, s, 'c_parameter', water%c_parameter)
    call get(store, s, 'air_entry_cut', water%air_entry_cut)
    call get(store, s, 'air_entry', water%air_entry)
    call get(store, s, 'lambda', water%lambda)
    call get(store, s, 'fx_a', water%fx_a)
    call get(store, s, 'fx_n', water%fx_n)
    call get(store, s, 'fx_m', water%fx_m)
    call get(store, s, 'fx_residual_suction', water%fx_residual_suction)
    call get_path(store, s, folder, 'file', water%file)
    call get(store, s, 'relative_conductivity_minimum', water%relative_conductivity_minimum)
    call get(store, s, 'specific_storage', water%specific_storage)
    call get(store, s, 'kozeny_carman', water%kozeny_carman)
  end subroutine fill_water

  subroutine fill_initial(store, s, folder, initial)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: s
    character(*), intent(in) :: folder
    type(initial_t), intent(out) :: initial

    call get_path(store, s, folder, 'from_result', initial%from_result)
    call get(store, s, 'snapshot', initial%snapshot)
    call get(store, s, 'pore_pressure', initial%pore_pressure)
    call get(store, s, 'suction', initial%suction)
    call get(store, s, 'water_table', initial%water_table)
    call get(store, s, 'water_table_right', initial%water_table_right)
    call get(store, s, 'suction_limit', initial%suction_limit)
    call get(store, s, 'antecedent_rain', initial%antecedent_rain)
    call get(store, s, 'stress', initial%stress)
    call get(store, s, 'lateral_stress_ratio', initial%lateral_stress_ratio)
  end subroutine fill_initial

  subroutine fill_boundary(store, s, folder, boundary)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: s
    character(*), intent(in) :: folder
    type(boundary_t), intent(out) :: boundary

    call get(store, s, 'name', boundary%name)
    call get(store, s, 'where', boundary%where)
    boundary%where_line = store_line(store, s, 'where')
    call fill_bounds(store, s, boundary%from_x, boundary%to_x, boundary%from_y, boundary%to_y)
    call get(store, s, 'stages', boundary%stages)
    call get(store, s, 'displacement', boundary%displacement)
    call get(store, s, 'velocity_x', boundary%velocity_x)
    call get(store, s, 'velocity_y', boundary%velocity_y)
    call get(store, s, 'velocity_gradient', boundary%velocity_gradient)
    call get(store, s, 'centre_x', boundary%centre_x)
    call get(store, s, 'centre_y', boundary%centre_y)
    call get(store, s, 'floor', boundary%floor)
    call get(store, s, 'traction_x', boundary%traction_x)
    call get(store, s, 'traction_y', boundary%traction_y)
    call get(store, s, 'pressure', boundary%pressure)
    call get(store, s, 'water', boundary%water)
    call get(store, s, 'head', boundary%head)
    call get(store, s, 'flux', boundary%flux)
    call get(store, s, 'rain', boundary%rain)
    call get_path(store, s, folder, 'hydrograph', boundary%hydrograph)
    call get(store, s, 'pressure_max', boundary%pressure_max)
  end subroutine fill_boundary

  subroutine fill_stage(store, s, stage)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: s
    type(stage_t), intent(out) :: stage

    call get(store, s, 'name', stage%name)
    stage%name_line = store_line(store, s, 'name')
    call get(store, s, 'kind', stage%kind)
    call get(store, s, 'solve', stage%solve)
    call get(store, s, 'duration', stage%duration)
    call get(store, s, 'storm_step', stage%storm_step)
    call get(store, s, 'storm_step_minimum', stage%storm_step_minimum)
    call get(store, s, 'factor_first', stage%factor_first)
    call get(store, s, 'factor_tolerance', stage%factor_tolerance)
    call get(store, s, 'tolerance', stage%tolerance)
    call get(store, s, 'steps_max', stage%steps_max)
    call get(store, s, 'damping', stage%damping)
    call get(store, s, 'mass_scaling', stage%mass_scaling)
    call get(store, s, 'mass', stage%mass)
    ! Relaxation has masses of its own.
    if (stage%kind /= 'dynamic') stage%mass = 'lumped'
    call get(store, s, 'step_safety', stage%step_safety)
    call get(store, s, 'water_step', stage%water_step)
    call get(store, s, 'water_safety', stage%water_safety)
    call get(store, s, 'failure_displacement', stage%failure_displacement)
    call get(store, s, 'after_failure', stage%after_failure)
    call get(store, s, 'only_after_failure', stage%only_after_failure)
    call get(store, s, 'rest_velocity', stage%rest_velocity)
    call get(store, s, 'spin', stage%spin)
    call get(store, s, 'reset_displacement', stage%reset_displacement)
    call get(store, s, 'snapshots', stage%snapshots)
  end subroutine fill_stage

  subroutine fill_output(store, s, folder, output)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: s
    character(*), intent(in) :: folder
    type(output_t), intent(out) :: output

    call get_path(store, s, folder, 'directory', output%directory)
    call get(store, s, 'snapshot_interval', output%snapshot_interval)
    call get(store, s, 'history_interval', output%history_interval)
    call get(store, s, 'probe_x', output%probe_x)
    call get(store, s, 'probe_y', output%probe_y)
    call get(store, s, 'restart', output%restart)
    call get(store, s, 'xdmf', output%xdmf)
  end subroutine fill_output

  !> Bounds of a region; absent ones become -huge and huge.
  subroutine fill_bounds(store, s, from_x, to_x, from_y, to_y)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: s
    real(dp), intent(out) :: from_x, to_x, from_y, to_y !! [m]

    call get(store, s, 'from_x', from_x)
    call get(store, s, 'to_x', to_x)
    call get(store, s, 'from_y', from_y)
    call get(store, s, 'to_y', to_y)
    if (.not. deck_given(from_x)) from_x = -huge(from_x)
    if (.not. deck_given(from_y)) from_y = -huge(from_y)
    if (.not. deck_given(to_x)) to_x = huge(to_x)
    if (.not. deck_given(to_y)) to_y = huge(to_y)
  end subroutine fill_bounds

  !> A path key as a path that opens from the working folder; '' when absent.
  subroutine get_path(store, s, folder, name, path)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: s
    character(*), intent(in) :: folder, name
    character(:), allocatable, intent(out) :: path

    call get(store, s, name, path)
    path = path_from_deck(folder, path)
  end subroutine get_path
end module talus_deck_fill
