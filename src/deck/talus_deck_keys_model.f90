! SPDX-License-Identifier: MIT
!> Key table, part 1: run, geometry, nodes, smoothing, initial, output.
module talus_deck_keys_model
  use talus_deck_table, only: table_t, group => table_add_group, key => table_add_key
  implicit none
  private
  public :: keys_add_run, keys_add_geometry, keys_add_nodes, keys_add_smoothing
  public :: keys_add_initial, keys_add_output

contains

  !> Keys of &run.
  subroutine keys_add_run(t)
    type(table_t), intent(inout) :: t

    call group(t, 'run', .false., .false., 'Names of the run and constants that hold everywhere.')
    call key(t, 'title', 'string', '', '', '', 'One line shown in summaries and figures.')
    call key(t, 'name', 'string', '', '~the deck''s file name, or its folder''s for case.nml', '', &
             'First part of the names of all result files.')
    call key(t, 'threads', 'integer', '', '0', '[0, 1024]', &
             'OpenMP threads; 0 takes OMP_NUM_THREADS or all cores, --threads overrides.')
    call key(t, 'gravity', 'real', 'm/s2', '9.81', '[0, 1000]', &
             'Acceleration of gravity, acting in -y.')
    call key(t, 'water_unit_weight', 'real', 'N/m3', '9810', '(0, 1e6]', &
             'Unit weight of water.')
  end subroutine keys_add_run

  !> Keys of &geometry.
  subroutine keys_add_geometry(t)
    type(table_t), intent(inout) :: t

    call group(t, 'geometry', .false., .true., &
               'The body: a box, a slope with its toe on the left, or a file.')
    call key(t, 'kind', 'string', '', '*', 'box|slope|file', 'How the body is described.')
    call key(t, 'width', 'real', 'm', '*', '(0, 1e6]', 'Width of the box.', 'kind=box')
    call key(t, 'height', 'real', 'm', '*', '(0, 1e6]', 'Height of the box.', 'kind=box')
    call key(t, 'slope_height', 'real', 'm', '*', '(0, 1e5]', &
             'Height of the crest above the toe.', 'kind=slope')
    call key(t, 'slope_ratio', 'real', '', '*', '[0, 100]', &
             'Horizontal distance per vertical metre of the face; 0 is a vertical cut.', &
             'kind=slope')
    call key(t, 'base_depth', 'real', 'm', '0', '[0, 1e5]', &
             'Depth of the ground below the toe.', 'kind=slope')
    call key(t, 'toe_distance', 'real', 'm', '0', '[0, 1e6]', &
             'Length of level ground in front of the toe; needs base_depth > 0.', 'kind=slope')
    call key(t, 'crest_width', 'real', 'm', '*', '(0, 1e6]', &
             'Length of level ground behind the crest.', 'kind=slope')
    call key(t, 'origin_x', 'real', 'm', '0', '[-1e7, 1e7]', &
             'x of the body''s left end (added to x of a file).')
    call key(t, 'origin_y', 'real', 'm', '0', '[-1e7, 1e7]', &
             'y of the body''s bottom (added to y of a file).')
    call key(t, 'file', 'path', '', '*', '', 'Text file: `nodes N`, then N '// &
             'lines `x y` or `x y soil` (number of the &soil); `elements M`, then M lines `3 a b c` '// &
             'or `4 a b c d` with the corners'' nodes, counted from 1. # begins a comment.', &
             'kind=file')
  end subroutine keys_add_geometry

  !> Keys of &nodes.
  subroutine keys_add_nodes(t)
    type(table_t), intent(inout) :: t

    call group(t, 'nodes', .false., .false., 'The nodes that fill the body.')
    call key(t, 'spacing', 'real', 'm', '', '(0, 1e5]', &
             'Node spacing in x; must be given unless &geometry kind = ''file''.')
    call key(t, 'spacing_y', 'real', 'm', '=spacing', '[0, 1e5]', &
             'Node spacing in y; 0 is the same as spacing.')
    call key(t, 'grading_x', 'real', '', '1', '[0.05, 20]', &
             'Ratio of the last (right) spacing of a box to the first.')
    call key(t, 'grading_y', 'real', '', '1', '[0.05, 20]', &
             'Ratio of the last (top) spacing of a box to the first.')
    call key(t, 'perturbation', 'real', '', '0', '[0, 0.4]', &
             'Random shift of the inner nodes, as a fraction of the spacing.')
    call key(t, 'seed', 'integer', '', '1', '[1, 2000000000]', &
             'Start of the random numbers: the same seed gives the same nodes.')
    call key(t, 'support', 'real', '', '1.6', '[1.45, 4]', &
             'Kernel support radius as a multiple of the node spacing.')
  end subroutine keys_add_nodes

  !> Keys of &smoothing.
  subroutine keys_add_smoothing(t)
    type(table_t), intent(inout) :: t

    call group(t, 'smoothing', .false., .false., &
               'Smoothing of the nodal gradient and its stabilisation (src/THEORY.md section 4).')
    call key(t, 'levels', 'integer', '', '1', '[1, 2]', &
             '1: nodal integration (SCNI) alone; 2: with the second level over a material length.')
    call key(t, 'length', 'real', 'm', '*', '(0, 1e5]', &
             'Support radius of the second level, at least 3 node spacings.', 'levels=2')
    call key(t, 'weights', 'string', '', 'symmetric', 'symmetric|rk|area', &
             'Weights of the second level; rk and area fail the patch test, for comparison only.', &
             'levels=2')
    call key(t, 'acts_on', 'string', '', 'gradient', 'gradient|damage_only', &
             'What the second level smooths: the gradient itself or only what drives damage.', &
             'levels=2')
    call key(t, 'elastic_strain', 'string', '', 'local', 'local|smoothed', &
             'Strain that intact soil resists where the gradient is smoothed: its own, or smoothed like that '// &
             'of yielding soil, which makes bodies of a few lengths soft; local with symmetric weights and '// &
             'stabilisation only.', 'levels=2')
    call key(t, 'stabilisation', 'real', '', '0.05', '[0, 1]', &
             'Stiffness of the affine-residual stabilisation as a fraction of the soil''s.')
    call key(t, 'level_stiffness', 'real', '', '0.025', '[0, 1]', &
             'Stiffness of the difference of both levels of F in yielding or damaged soil, as a fraction '// &
             'of Young''s modulus; none with stabilisation = 0.', 'levels=2')
    call key(t, 'stabilisation_floor', 'real', '', '0.02', '[0, 1]', &
             'Smallest fraction of the stabilisation left in damaged or yielding soil. Times '// &
             'stabilisation and Young''s modulus it is about the strength that this adds for each '// &
             'unit of strain: lower it where soil flows.')
  end subroutine keys_add_smoothing

  !> Keys of &initial.
  subroutine keys_add_initial(t)
    type(table_t), intent(inout) :: t

    call group(t, 'initial', .false., .false., &
               'Pore pressure and stress at the start, or a whole state saved by another run.')
    call key(t, 'from_result', 'path', '', '', '', &
             'Result file (HDF5) of a run of the same nodes: start from a state saved there, '// &
             'with its time; hydrographs count from the start of each stage of this deck.')
    call key(t, 'snapshot', 'string', '', '', '', &
             'Which state of from_result: a number as 12 or 000012, last (of the numbered '// &
             'ones) or last_good; absent: last.')
    call key(t, 'pore_pressure', 'string', '', 'none', 'none|uniform|hydrostatic|steady', &
             'Initial pore pressure; all but none need &water.')
    call key(t, 'suction', 'real', 'Pa', '*', '[-1e9, 1e9]', &
             'Suction everywhere; negative is a positive pore pressure.', 'pore_pressure=uniform')
    call key(t, 'water_table', 'real', 'm', '*', '[-1e7, 1e7]', &
             'Elevation y of the water table, at the left end if it is inclined; with '// &
             'steady it counts where no &boundary gives a head: at the sides, or below the '// &
             'body at the bottom.', &
             'pore_pressure=hydrostatic|steady')
    call key(t, 'water_table_right', 'real', 'm', '=water_table', '[-1e7, 1e7]', &
             'Elevation y of the water table at the right end.', 'pore_pressure=hydrostatic|steady')
    call key(t, 'suction_limit', 'real', 'Pa', '', '[0, 1e9]', &
             'Largest suction above the water table; absent: no limit.', &
             'pore_pressure=hydrostatic')
    call key(t, 'antecedent_rain', 'real', 'mm/h', '0', '[0, 1000]', &
             'Steady rain that has fallen long enough before the start.', 'pore_pressure=steady')
    call key(t, 'stress', 'string', '', 'none', 'none|k0', &
             'Initial stress: none, or the weight above a point with a lateral ratio.')
    call key(t, 'lateral_stress_ratio', 'real', '', '*', '[0, 10]', &
             'Ratio of horizontal to vertical initial stress.', 'stress=k0')
  end subroutine keys_add_initial

  !> Keys of &output.
  subroutine keys_add_output(t)
    type(table_t), intent(inout) :: t

    call group(t, 'output', .false., .false., 'What is written, where and how often.')
    call key(t, 'directory', 'path', '', 'results', '', &
             'Folder of the result files, relative to the deck; --output overrides.')
    call key(t, 'snapshot_interval', 'real', 's', '', '(0, inf)', &
             'Simulated time between snapshots; absent: the stage''s snapshots key decides.')
    call key(t, 'history_interval', 'real', 's', '', '(0, inf)', &
             'Simulated time between history lines; absent: chosen by the stage.')
    call key(t, 'probe_x', 'real_list', 'm', '', '[-1e7, 1e7]', &
             'x of the probes; each takes the nearest node.')
    call key(t, 'probe_y', 'real_list', 'm', '', '[-1e7, 1e7]', &
             'y of the probes, as many as probe_x.')
    call key(t, 'restart', 'string', '', 'stages', 'none|stages|all', &
             'Which snapshots get all of the state, so that a run can start from them: none, '// &
             'those at the ends of stages, or all; last_good has it always.')
    call key(t, 'xdmf', 'logical', '', '.true.', '', &
             'Also write an XDMF file, which ParaView opens.')
  end subroutine keys_add_output
end module talus_deck_keys_model
