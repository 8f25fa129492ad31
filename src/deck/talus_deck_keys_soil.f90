! SPDX-License-Identifier: MIT
!> Key table, part 2: soil and damage.
module talus_deck_keys_soil
  use talus_deck_table, only: table_t, group => table_add_group, key => table_add_key
  implicit none
  private
  public :: keys_add_soil, keys_add_damage

  character(*), parameter :: plastic = 'plasticity=drucker_prager'
  character(*), parameter :: softens = 'softening=linear|exponential'

contains

  !> Keys of &soil.
  subroutine keys_add_soil(t)
    type(table_t), intent(inout) :: t

    call group(t, 'soil', .true., .true., &
               'A soil and where it lies; where soils overlap, the later one counts.')
    call key(t, 'name', 'string', '', '*', '', &
        'Name, used by &damage and &water and in the results.')
    call key(t, 'from_x', 'real', 'm', '', '[-1e7, 1e7]', &
        'Left end of its region; absent: unbounded.')
    call key(t, 'to_x', 'real', 'm', '', '[-1e7, 1e7]', &
        'Right end of its region; absent: unbounded.')
    call key(t, 'from_y', 'real', 'm', '', '[-1e7, 1e7]', 'Bottom of its layer; absent: unbounded.')
    call key(t, 'to_y', 'real', 'm', '', '[-1e7, 1e7]', 'Top of its layer; absent: unbounded.')
    call key(t, 'density_solid', 'real', 'kg/m3', '2650', '(0, 20000]', &
             'Density of the grains; with porosity 0, of the whole soil.')
    call key(t, 'porosity', 'real', '', '*', '[0, 0.99]', &
             'Initial volume of voids per volume of soil.')
    call key(t, 'youngs_modulus', 'real', 'Pa', '*', '(0, 1e13]', 'Young''s modulus.')
    call key(t, 'poisson_ratio', 'real', '', '*', '[0, 0.5)', 'Poisson''s ratio.')
    call key(t, 'plasticity', 'string', '', 'none', 'none|drucker_prager', &
             'Elastic, or elastic and perfectly plastic or softening.')
    call add_strength(t)
    call add_softening(t)
    call add_suction(t)
  end subroutine keys_add_soil

  !> Keys of the Drucker-Prager cone.
  subroutine add_strength(t)
    type(table_t), intent(inout) :: t

    call key(t, 'cohesion', 'real', 'Pa', '*', '[0, 1e12]', 'Cohesion c''.', plastic)
    call key(t, 'friction_angle', 'real', 'deg', '*', '[0, 89]', 'Angle of friction phi''.', &
        plastic)
    call key(t, 'dilation_angle', 'real', 'deg', '0', '[0, 89]', &
             'Angle of dilation, not above friction_angle.', plastic)
    call key(t, 'fit', 'string', '', 'plane_strain', 'plane_strain|compression|extension', &
             'Where the cone meets the Mohr-Coulomb pyramid; it changes a factor of safety.', &
             plastic)
    call key(t, 'tension_cutoff', 'real', 'Pa', '', '[0, 1e12]', &
             'Largest mean tensile stress; absent: the apex of the cone.', plastic)
    call key(t, 'crack_closure', 'logical', '', '.false.', '', &
             'Soil that opened at tension_cutoff = 0 bears pressure again only when it has closed; '// &
             'false: at once, so that soil that shakes or flows swells.', plastic)
    call key(t, 'dilation_limit', 'real', '', '', '(0, 1e3]', &
             'Equivalent plastic strain at which dilation stops; absent: never.', plastic)
  end subroutine add_strength

  !> Keys of softening.
  subroutine add_softening(t)
    type(table_t), intent(inout) :: t

    call key(t, 'softening', 'string', '', 'none', 'none|linear|exponential|table', &
             'How strength falls with equivalent plastic strain.', plastic)
    call key(t, 'softening_strain', 'real', '', '*', '(0, 1e3]', &
             'Equivalent plastic strain at the residual (linear) or of decay (exponential).', &
             softens)
    call key(t, 'residual_cohesion', 'real', 'Pa', '=cohesion', '[0, 1e12]', &
             'Cohesion after softening.', softens)
    call key(t, 'residual_friction_angle', 'real', 'deg', '=friction_angle', '[0, 89]', &
             'Angle of friction after softening.', softens)
    call key(t, 'residual_dilation_angle', 'real', 'deg', '=dilation_angle', '[0, 89]', &
             'Angle of dilation after softening.', softens)
    call key(t, 'softening_table_strain', 'real_list', '', '*', '[0, 1e3]', &
             'Equivalent plastic strains of the table, rising from 0.', 'softening=table')
    call key(t, 'softening_table_cohesion', 'real_list', 'Pa', '', '[0, 1e12]', &
             'Cohesion at each strain of the table; absent: cohesion.', 'softening=table')
    call key(t, 'softening_table_friction_angle', 'real_list', 'deg', '', '[0, 89]', &
             'Angle of friction at each strain; absent: friction_angle.', 'softening=table')
    call key(t, 'softening_table_dilation_angle', 'real_list', 'deg', '', '[0, 89]', &
             'Angle of dilation at each strain; absent: dilation_angle.', 'softening=table')
  end subroutine add_softening

  !> Keys of the effect of suction on stress, strength and strain.
  subroutine add_suction(t)
    type(table_t), intent(inout) :: t

    call key(t, 'stress', 'string', '', 'net', 'net|bishop', &
             'Stress that the laws see: net, or Bishop''s effective stress (needed below water).')
    call key(t, 'suction_strength', 'string', '', 'none', 'none|phi_b|vanapalli', &
             'Cohesion from suction, with net stress only (Bishop''s stress has it already).', &
             plastic)
    call key(t, 'phi_b', 'real', 'deg', '*', '[0, 89]', &
             'Cohesion rises by tan(phi_b) per unit of suction.', 'suction_strength=phi_b')
    call key(t, 'suction_cohesion_max', 'real', 'Pa', '', '[0, 1e12]', &
             'Largest cohesion from suction; absent: no limit.', 'suction_strength=phi_b|vanapalli')
    call key(t, 'suction_strain', 'string', '', 'none', 'none|constant|alonso', &
             'Swelling on wetting, with net stress only (Bishop''s stress has it already).')
    call key(t, 'suction_modulus', 'real', 'Pa', '*', '(0, 1e13]', &
             'D_s: suction change per unit of linear strain (src/THEORY.md section 3).', &
             'suction_strain=constant')
    call key(t, 'kappa_s', 'real', '', '*', '(0, 1]', &
             'Slope of void ratio over ln(s + p_atmospheric).', 'suction_strain=alonso')
  end subroutine add_suction

  !> Keys of &damage.
  subroutine keys_add_damage(t)
    type(table_t), intent(inout) :: t

    call group(t, 'damage', .true., .false., 'Isotropic damage of one soil or of all.')
    call key(t, 'soil', 'string', '', '', '', &
             'Name of the soil; blank: every soil not named by another &damage.')
    call key(t, 'driver', 'string', '', 'energy', 'energy|mazars|von_mises|plastic_strain', &
             'Equivalent strain that drives damage.')
    call key(t, 'law', 'string', '', 'exponential', 'exponential|linear|mazars', &
             'Damage as a function of the largest equivalent strain so far.')
    call key(t, 'kappa_0', 'real', '', '*', '(0, 1e3]', 'Equivalent strain at which damage starts.')
    call key(t, 'kappa_f', 'real', '', '*', '(0, 1e4]', &
             'Equivalent strain that sets how fast damage grows, above kappa_0.', &
             'law=exponential|linear')
    call key(t, 'mazars_a', 'real', '', '*', '(0, 1.5]', 'A of Mazars'' law.', 'law=mazars')
    call key(t, 'mazars_b', 'real', '', '*', '(0, 1e6]', 'B of Mazars'' law.', 'law=mazars')
    call key(t, 'strength_ratio', 'real', '', '10', '[1, 1000]', &
             'Compressive over tensile strength in the modified von Mises strain.', &
             'driver=von_mises')
    call key(t, 'maximum', 'real', '', '0.99', '[0, 1)', 'Largest damage.')
    call key(t, 'split', 'string', '', 'full', 'full|deviatoric|tensile', &
             'Part of the stress that damage reduces; full also takes the confinement.')
  end subroutine keys_add_damage
end module talus_deck_keys_soil
