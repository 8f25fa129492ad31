! SPDX-License-Identifier: MIT
!> Key table, part 3: water, boundary and stage.
module talus_deck_keys_water
  use talus_deck_table, only: table_t, group => table_add_group, key => table_add_key
  implicit none
  private
  public :: keys_add_water, keys_add_boundary, keys_add_stage

contains

  !> Keys of &water.
  subroutine keys_add_water(t)
    type(table_t), intent(inout) :: t
    character(*), parameter :: fx = 'retention=fredlund_xing', bc = 'retention=brooks_corey'
    character(*), parameter :: vg = 'retention=van_genuchten', law = &
      'retention=van_genuchten|gardner|brooks_corey|fredlund_xing|broadbridge_white'

    call group(t, 'water', .true., .false., &
               'Retention and conductivity of one soil or of all; without it there is no water.')
    call key(t, 'soil', 'string', '', '', '', &
             'Name of the soil; blank: every soil not named by another &water.')
    call key(t, 'retention', 'string', '', '*', &
             'van_genuchten|gardner|brooks_corey|fredlund_xing|table|broadbridge_white', &
             'Retention law.')
    call key(t, 'conductivity_x', 'real', 'm/s', '*', '(0, 10]', &
             'Saturated hydraulic conductivity along x.')
    call key(t, 'conductivity_y', 'real', 'm/s', '=conductivity_x', '(0, 10]', &
             'Saturated hydraulic conductivity along y.')
    call key(t, 'saturation_residual', 'real', '', '0', '[0, 1)', &
             'Degree of saturation that no suction removes.', law)
    call key(t, 'saturation_maximum', 'real', '', '1', '(0, 1]', &
             'Degree of saturation at zero suction.', law)
    call key(t, 'alpha', 'real', '1/m', '*', '[1e-4, 1e4]', &
             'alpha of van Genuchten or Gardner, or 1/lambda_c of Broadbridge and White, per '// &
             'metre of suction head.', 'retention=van_genuchten|gardner|broadbridge_white')
    call key(t, 'n', 'real', '', '*', '[1.001, 20]', 'n of van Genuchten; m = 1 - 1/n.', vg)
    call key(t, 'pore_connectivity', 'real', '', '0.5', '[-1, 10]', &
             'Exponent of the effective saturation in Mualem''s conductivity; with Brooks and '// &
             'Corey 1 gives Burdine''s.', 'retention=van_genuchten|brooks_corey')
    call key(t, 'air_entry_cut', 'real', 'm', '~0.02 with fredlund_xing or n < 2, else 0', &
             '[0, 10]', 'Suction head below which the soil stays saturated.', &
             'retention=van_genuchten|fredlund_xing')
    call key(t, 'air_entry', 'real', 'm', '*', '[1e-4, 1e3]', 'Air-entry suction head.', bc)
    call key(t, 'lambda', 'real', '', '*', '[0.01, 20]', 'Pore-size index of Brooks and Corey.', bc)
    call key(t, 'c_parameter', 'real', '', '*', '[1.001, 1000]', &
             'C of Broadbridge and White, above 1: weak to strong nonlinearity as it falls to 1.', &
             'retention=broadbridge_white')
    call key(t, 'fx_a', 'real', 'm', '*', '[1e-4, 1e4]', 'a of Fredlund and Xing, as a head.', fx)
    call key(t, 'fx_n', 'real', '', '*', '[0.1, 20]', 'n of Fredlund and Xing.', fx)
    call key(t, 'fx_m', 'real', '', '*', '[0.05, 20]', 'm of Fredlund and Xing.', fx)
    call key(t, 'fx_residual_suction', 'real', 'm', '*', '[1e-3, 1e5]', &
             'Residual suction head of Fredlund and Xing.', fx)
    call key(t, 'file', 'path', '', '*', '', &
             'CSV file of suction_Pa, saturation, relative_conductivity.', 'retention=table')
    call key(t, 'relative_conductivity_minimum', 'real', '', '1e-12', '[1e-20, 0.1]', &
             'Smallest relative conductivity.')
    call key(t, 'specific_storage', 'real', '1/Pa', '1e-9', '(0, 1e-3]', &
             'Water stored per volume of saturated soil and Pa, by compressibility.')
    call key(t, 'kozeny_carman', 'logical', '', '.false.', '', &
             'Conductivity follows porosity by Kozeny and Carman.')
  end subroutine keys_add_water

  !> Keys of &boundary.
  subroutine keys_add_boundary(t)
    type(table_t), intent(inout) :: t

    call group(t, 'boundary', .true., .false., &
               'A part of the boundary and what acts there. Supports and loads add up; '// &
               'of its conditions for water the last counts.')
    call key(t, 'name', 'string', '', '', '', &
             'Name, for messages; where nodes are held or driven, '// &
             'the history has their reaction: '// &
             'the force on the soil.')
    call key(t, 'where', 'string', '', '*', 'left|right|bottom|top|face|surface|box|all', &
             'Which part: a side, the face of a slope, the surface (top and face), a box or all. '// &
             'Of a box, supports and heads count for every node in it, also inside the body; loads '// &
             'and water count along the boundary edges with both ends in it.')
    call key(t, 'from_x', 'real', 'm', '', '[-1e7, 1e7]', &
        'Left end of the box; absent: unbounded.', &
             'where=box')
    call key(t, 'to_x', 'real', 'm', '', '[-1e7, 1e7]', &
        'Right end of the box; absent: unbounded.', &
             'where=box')
    call key(t, 'from_y', 'real', 'm', '', '[-1e7, 1e7]', 'Bottom of the box; absent: unbounded.', &
             'where=box')
    call key(t, 'to_y', 'real', 'm', '', '[-1e7, 1e7]', 'Top of the box; absent: unbounded.', &
             'where=box')
    call key(t, 'stages', 'string_list', '', '', '', &
             'Names of the stages in which it acts; absent: in all.')
    call key(t, 'displacement', 'string', '', 'free', 'free|fixed|roller_x|roller_y', &
             'Held displacement: roller_x holds x, roller_y holds y, fixed holds both.')
    call key(t, 'velocity_x', 'real', 'm/s', '', '[-1e3, 1e3]', &
             'Prescribed velocity along x, held still in a geostatic stage; absent: none.')
    call key(t, 'velocity_y', 'real', 'm/s', '', '[-1e3, 1e3]', &
             'Prescribed velocity along y, held still in a geostatic stage; absent: none.')
    call key(t, 'velocity_gradient', 'real_list', '1/s', '', '[-1e3, 1e3]', &
             'Prescribed homogeneous motion: dvx/dx, dvx/dy, dvy/dx, dvy/dy about the centre, '// &
             'held still in a geostatic stage; a spin w is 0, -w, w, 0; absent: none.')
    call key(t, 'centre_x', 'real', 'm', '0', '[-1e7, 1e7]', &
             'x of the fixed point of velocity_gradient.')
    call key(t, 'centre_y', 'real', 'm', '0', '[-1e7, 1e7]', &
             'y of the fixed point of velocity_gradient.')
    call key(t, 'floor', 'real', 'm', '', '[-1e7, 1e7]', &
             'Elevation y of rigid, rough ground: nodes that begin above it and come down to it '// &
             'in a dynamic stage stay there, in later stages of any kind, too; absent: none.')
    call key(t, 'traction_x', 'real', 'Pa', '0', '[-1e10, 1e10]', 'Traction along x.')
    call key(t, 'traction_y', 'real', 'Pa', '0', '[-1e10, 1e10]', &
        'Traction along y, upward positive.')
    call key(t, 'pressure', 'real', 'Pa', '0', '[-1e10, 1e10]', &
             'Pressure normal to the boundary, positive inward.')
    call key(t, 'water', 'string', '', 'none', 'none|impermeable|head|flux|rain|seepage_face', &
             'Water condition; none leaves what an earlier boundary set (impermeable at first).')
    call key(t, 'head', 'real', 'm', '*', '[-1e7, 1e7]', &
             'Total head: elevation at which water would stand.', 'water=head')
    call key(t, 'flux', 'real', 'm/s', '*', '[-10, 10]', &
             'Volume per area and time, inward positive.', 'water=flux')
    call key(t, 'rain', 'real', 'mm/h', '', '[0, 1000]', &
             'Rain per horizontal area; give this or hydrograph.', 'water=rain')
    call key(t, 'hydrograph', 'path', '', '', '', &
             'CSV file of time_s, mm_per_h; time counts from the start of the stage. A value '// &
             'holds up to the next time, the last one to the end of the stage; before the first '// &
             'time there is no rain.', 'water=rain')
    call key(t, 'pressure_max', 'real', 'Pa', '0', '[0, 1e6]', &
             'Pore pressure at which rain ponds and the rest runs off.', 'water=rain')
  end subroutine keys_add_boundary

  !> Keys of &stage.
  subroutine keys_add_stage(t)
    type(table_t), intent(inout) :: t
    character(*), parameter :: timed = 'kind=storm|dynamic', &
      reduced = 'kind=strength_reduction', still = 'kind=geostatic|storm|strength_reduction'

    call group(t, 'stage', .true., .true., &
        'A part of the run; stages follow in the order of the deck.')
    call key(t, 'name', 'string', '', '*', '', 'Name, used by &boundary and in the results.')
    call key(t, 'kind', 'string', '', '*', 'geostatic|storm|dynamic|strength_reduction', &
             'Relax to equilibrium; a storm of hours with soil in equilibrium; real time; '// &
             'or the '// &
             'factor of safety of the soil as it is.')
    call key(t, 'solve', 'string', '', &
             '~soil without &water or if geostatic or strength_reduction, else both', &
             'soil|seepage|both', 'What moves: the soil, the water or both.')
    call key(t, 'duration', 'real', 's', '*', '(0, 1e11]', 'Simulated time of the stage.', timed)
    call key(t, 'storm_step', 'real', 's', '*', '(0, 1e9]', &
             'Step of the storm clock between two equilibria of the soil.', 'kind=storm')
    call key(t, 'storm_step_minimum', 'real', 's', '~storm_step/64', '(0, 1e9]', &
             'Smallest step when the time of failure is bisected.', 'kind=storm')
    call key(t, 'factor_first', 'real', '', '1', '[0.02, 50]', &
             'First factor that divides the strength; where the soil does not stand there, '// &
             'smaller ones follow.', reduced)
    call key(t, 'factor_tolerance', 'real', '', '0.01', '[1e-4, 1]', &
             'Largest distance of the factors at which the soil stands and fails.', reduced)
    call key(t, 'tolerance', 'real', '', '1e-5', '(0, 0.1]', &
             'Out-of-balance force over applied force that counts as equilibrium.', still)
    call key(t, 'steps_max', 'integer', '', '20000', '[1, 2000000000]', &
             'Most steps of one relaxation.', still)
    call key(t, 'damping', 'real', '', '0', '[0, 0.99]', &
             'Local damping, a fraction of the out-of-balance force; relaxations are damped '// &
             'critically as well.')
    call key(t, 'mass_scaling', 'logical', '', '~.false. if dynamic, else .true.', '', &
             'Scale the masses so that relaxation takes few steps.')
    call key(t, 'mass', 'string', '', 'lumped', 'lumped|consistent', &
             'Inertia in real time: at the nodes, or consistent with the cell means of the '// &
             'strain, which makes waves run at their speed on coarse nodes too, at a step '// &
             'shorter by about a third.', 'kind=dynamic')
    call key(t, 'step_safety', 'real', '', '0.9', '(0, 1.2]', &
             'Time step of the soil over the largest stable one; above 1 it is unstable.')
    call key(t, 'water_step', 'string', '', 'automatic', 'automatic|explicit', &
             'Steps of the water: explicit or implicit, whichever gets further, or explicit '// &
             'ones alone.', 'kind=storm|dynamic')
    call key(t, 'water_safety', 'real', '', '0.95', '(0, 2]', &
             'Explicit step of the water over its limit (src/THEORY.md (5.4)); above 1 it '// &
             'may be unstable, see `talus check`.', 'kind=storm|dynamic')
    call key(t, 'failure_displacement', 'real', 'm', '', '(0, 1e4]', &
             'Displacement within storm_step, or in a trial of strength reduction, that counts as '// &
             'failure; absent: in a storm none, else by the settlement of elastic soil s and the '// &
             'mean depth D: min(4 s, max(D/50, 0.6 s)).', 'kind=storm|strength_reduction')
    call key(t, 'after_failure', 'string', '', &
             '~dynamic_next if a dynamic stage follows, else stop', 'dynamic_next|stop', &
             'On failure go on with the next dynamic stage, or stop the run.', 'kind=storm')
    call key(t, 'only_after_failure', 'logical', '', '.false.', '', &
             'Skip this stage unless the storm before it ended in failure.', 'kind=dynamic')
    call key(t, 'rest_velocity', 'real', 'm/s', '0', '[0, 100]', &
             'Largest velocity that counts as rest and ends the stage; 0: run to the end.', &
             'kind=dynamic')
    call key(t, 'spin', 'real', 'rad/s', '0', '[-1e3, 1e3]', &
             'Angular velocity about its centre of mass with which the body starts.', &
             'kind=dynamic')
    call key(t, 'reset_displacement', 'logical', '', '~.true. if geostatic, else .false.', '', &
             'Set displacement and plastic strain to zero at the end of the stage; damage stays.')
    call key(t, 'snapshots', 'integer', '', '10', '[0, 100000]', &
             'Number of snapshots in the stage, besides its start.')
  end subroutine keys_add_stage
end module talus_deck_keys_water
