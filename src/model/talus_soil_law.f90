! SPDX-License-Identifier: MIT
!> The soil at one point: elasticity, plasticity, suction strain and damage composed.
!!
!! Order of a step (src/THEORY.md section 3): turn the undamaged stress, add the elastic stress
!! of the strain less the suction strain, return to the cone, raise damage, degrade. The cone is
!! that of the plastic strain before the step, so the return satisfies it exactly.
!! In `net` the stress carried is net stress and equals total stress above the water table; in
!! `bishop` it is effective stress, and bishop_subtract gives the total.
module talus_soil_law
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_set, status_failed, status_deck
  use talus_objective, only: objective_increments, tensors_rotate
  use talus_elastic, only: elastic_t, elastic_prepare, elastic_adds, elastic_energy, &
    elastic_energies, elastic_bilinear
  use talus_drucker_prager, only: cone_t, drucker_prager_return, secant_shear_ratio
  use talus_strength, only: strength_t, strength_prepare, strength_cone, strength_within, &
    suction_strength_none
  use talus_suction_strain, only: suction_strain_t, suction_strain_prepare, &
    suction_strain_increment, suction_strain_none
  use talus_damage, only: damage_t, damage_prepare, damage_advance, damage_part, &
    damage_dissipation, damage_stored, driver_none, driver_plastic_strain, &
    split_deviatoric
  implicit none
  private
  public :: soil_law_t, soil_law_prepare, soil_update, soil_trial, soil_stays_elastic, soil_return
  public :: soil_stored_energy, soil_stored_energies
  public :: bishop_factor, bishop_subtract, soil_needs_strain

  integer, parameter, public :: plasticity_none = 0, plasticity_drucker_prager = 1
  integer, parameter, public :: stress_net = 1, stress_bishop = 2

  !> Entries of the history of a point besides its stress and strain. Works are per volume of
  !! the reference configuration, so that their sum over the nodes is sum(work*reference area).
  integer, parameter, public :: history_eqps = 1         !! equivalent plastic strain [-]
  integer, parameter, public :: history_plastic_work = 2 !! [J/m3]
  integer, parameter, public :: history_kappa = 3        !! largest equivalent strain [-]
  integer, parameter, public :: history_damage = 4       !! D [-]
  integer, parameter, public :: history_damage_work = 5  !! [J/m3]
  !> All of them, and those that soil without damage needs.
  integer, parameter, public :: history_size = 5, history_size_plastic = 2

  !> Most points that are updated at once: their fields stay in the first cache.
  integer, parameter, public :: soil_points = 64

  !> Outcome of soil_update.
  integer, parameter, public :: soil_ok = 0, soil_inverted = 1, soil_not_finite = 2

  !> Everything the update of one soil needs: set the components, then soil_law_prepare.
  type :: soil_law_t
    integer :: plasticity = plasticity_none !! one of plasticity_*
    integer :: stress = stress_net          !! one of stress_*
    logical :: own_strain = .true.          !! false: strain_advance drives the strain from outside
    type(elastic_t) :: elastic
    type(strength_t) :: strength
    type(suction_strain_t) :: swelling
    type(damage_t) :: damage
  end type soil_law_t

contains

  !> Check a law and derive its constants. The first fault is reported.
  pure subroutine soil_law_prepare(law, status)
    type(soil_law_t), intent(inout) :: law
    type(status_t), intent(inout) :: status !! status_deck when the law cannot be used

    call elastic_prepare(law%elastic, status)
    if (status_failed(status)) return
    if (law%plasticity == plasticity_drucker_prager) call strength_prepare(law%strength, status)
    call suction_strain_prepare(law%swelling, status)
    call damage_prepare(law%damage, law%elastic, status)
    if (law%stress == stress_bishop) then
      if (law%strength%suction /= suction_strength_none .or. &
        law%swelling%kind /= suction_strain_none) call status_set(status, status_deck, &
        'stress = bishop counts suction already: suction_strength and suction_strain must be none')
    end if
    if (law%damage%driver == driver_plastic_strain .and. law%plasticity == plasticity_none) &
      call status_set(status, status_deck, 'driver = plastic_strain needs plasticity')
  end subroutine soil_law_prepare

  !> True when the update reads the strain of the point.
  pure logical function soil_needs_strain(law)
    type(soil_law_t), intent(in) :: law

    soil_needs_strain = law%damage%driver /= driver_none .and. &
      law%damage%driver /= driver_plastic_strain
  end function soil_needs_strain

  !> Advance one point over one step.
  !!
  !! On a failure (ierr /= 0) the state of the point is not to be used further. The stiffness
  !! scale is (1 - D) times the secant shear ratio, between 0 and 1; its floor is the caller's.
  pure subroutine soil_update(law, f_old, f_new, suction_old, suction_new, saturation, &
    effective, strain, history, stress, stiffness_scale, ierr)
    type(soil_law_t), intent(in) :: law            !! prepared
    real(dp), intent(in) :: f_old(4)               !! deformation gradient before [-]
    real(dp), intent(in) :: f_new(4)               !! deformation gradient after [-]
    real(dp), intent(in) :: suction_old            !! s = -p_w before [Pa]
    real(dp), intent(in) :: suction_new            !! s after [Pa]
    real(dp), intent(in) :: saturation             !! effective saturation after [-]
    real(dp), intent(inout) :: effective(4)        !! undamaged stress [Pa], tension +
    real(dp), intent(inout) :: strain(4)           !! total strain [-]; kept only for damage
    real(dp), intent(inout) :: history(history_size) !! see history_*
    real(dp), intent(out) :: stress(4)             !! damaged stress without pore pressure [Pa]
    real(dp), intent(out) :: stiffness_scale       !! stiffness left over the elastic one [-]
    integer, intent(out) :: ierr                   !! one of soil_ok, soil_inverted, ...
    real(dp) :: before(4,1), det_mid(1), det_old(1), det_new(1), suctions(2)

    suctions = [suction_old, suction_new]
    before(:, 1) = effective
    call soil_trial(law, 1, f_old, f_new, suctions(1:1), suctions(2:2), before, strain, effective, &
                    det_mid, det_old, det_new)
    call soil_return(law, det_mid(1), 0.5_dp*(det_old(1) + det_new(1)), suction_new, saturation, &
                     before(:, 1), strain, effective, history, stress, stiffness_scale, ierr)
  end subroutine soil_update

  !> First half of the update, for n points of one soil: turn the stress, add the elastic stress of
  !! the strain less the suction strain.
  pure subroutine soil_trial(law, n, f_old, f_new, suction_old, suction_new, before, strain, &
    trial, det_mid, det_old, det_new)
    type(soil_law_t), intent(in) :: law      !! prepared
    integer, intent(in) :: n                 !! soil_points at most
    real(dp), intent(in) :: f_old(4,n)       !! deformation gradient before [-]
    real(dp), intent(in) :: f_new(4,n)       !! deformation gradient after [-]
    real(dp), intent(in) :: suction_old(n)   !! s = -p_w before [Pa]
    real(dp), intent(in) :: suction_new(n)   !! s after [Pa]
    real(dp), intent(inout) :: before(4,n)   !! undamaged stress before in, turned out [Pa]
    real(dp), intent(inout) :: strain(4,*)   !! total strain [-], (4,n); not used without damage
    real(dp), intent(out) :: trial(4,n)      !! elastic trial stress [Pa]
    real(dp), intent(out) :: det_mid(n)      !! J of the middle of the step [-]; 0 where inverted
    real(dp), intent(out) :: det_old(n)      !! J before [-]
    real(dp), intent(out) :: det_new(n)      !! J after [-]
    real(dp) :: dstrain(4,soil_points), rotation(2,soil_points)
    integer :: i

    call objective_increments(n, f_old, f_new, dstrain, rotation, det_mid, det_old, det_new)
    call tensors_rotate(n, rotation, before)
    if (law%own_strain .and. soil_needs_strain(law)) then
      call tensors_rotate(n, rotation, strain)
      strain(:, :n) = strain(:, :n) + dstrain(:, :n)
    end if
    if (law%swelling%kind /= suction_strain_none) then
      do i = 1, n
        if (det_mid(i) > 0.0_dp) dstrain(1:3, i) = dstrain(1:3, i) &
          - suction_strain_increment(law%swelling, suction_old(i), suction_new(i), det_new(i))
      end do
    end if
    call elastic_adds(law%elastic, n, dstrain, before, trial)
  end subroutine soil_trial

  !> Which of n points soil_return would leave as they are: 1, or 0 for the others. These are
  !! points that have never yielded nor been damaged, and whose trial stress is inside the cone.
  pure subroutine soil_stays_elastic(law, n, history, suction, saturation, det_mid, trial, stays)
    type(soil_law_t), intent(in) :: law
    integer, intent(in) :: n
    real(dp), intent(in) :: history(history_size,n) !! see history_*
    real(dp), intent(in) :: suction(n)         !! s = -p_w after [Pa]
    real(dp), intent(in) :: saturation(n)      !! effective saturation after [-]
    real(dp), intent(in) :: det_mid(n)         !! of soil_trial
    real(dp), intent(in) :: trial(4,n)         !! elastic trial stress [Pa]
    real(dp), intent(out) :: stays(n)          !! 1 or 0
    integer :: i

    stays = 0.0_dp
    if (soil_needs_strain(law)) return
    if (law%plasticity == plasticity_drucker_prager) then
      call strength_within(law%strength, n, suction, saturation, trial, stays)
    else
      do i = 1, n
        stays(i) = merge(1.0_dp, 0.0_dp, &
          abs(trial(1, i) + trial(2, i) + trial(3, i) + trial(4, i)) <= huge(1.0_dp))
      end do
    end if
    do i = 1, n
      stays(i) = stays(i)*merge(1.0_dp, 0.0_dp, det_mid(i) > 0.0_dp) &
        *merge(0.0_dp, 1.0_dp, max(history(history_eqps, i), history(history_damage, i)) > 0.0_dp)
    end do
  end subroutine soil_stays_elastic

  !> Second half of the update, at one point: return to the cone, raise damage, degrade.
  pure subroutine soil_return(law, det_mid, volume, suction, saturation, before, strain, &
    effective, history, stress, stiffness_scale, ierr)
    type(soil_law_t), intent(in) :: law            !! prepared
    real(dp), intent(in) :: det_mid                !! of soil_trial
    real(dp), intent(in) :: volume                 !! mean of J before and after [-]
    real(dp), intent(in) :: suction                !! s = -p_w after [Pa]
    real(dp), intent(in) :: saturation             !! effective saturation after [-]
    real(dp), intent(in) :: before(4)              !! undamaged stress before, turned [Pa]
    real(dp), intent(in) :: strain(4)              !! total strain after [-]
    real(dp), intent(inout) :: effective(4)        !! trial stress in, undamaged stress out [Pa]
    real(dp), intent(inout) :: history(history_size) !! see history_*
    real(dp), intent(out) :: stress(4)             !! damaged stress without pore pressure [Pa]
    real(dp), intent(out) :: stiffness_scale       !! stiffness left over the elastic one [-]
    integer, intent(out) :: ierr                   !! one of soil_ok, soil_inverted, ...
    logical :: yielded

    stiffness_scale = 1.0_dp
    stress = effective
    ierr = soil_inverted
    if (.not. det_mid > 0.0_dp) return
    ierr = soil_ok
    yielded = .false.
    if (law%plasticity == plasticity_drucker_prager) then
      call return_to_cone(law, suction, saturation, effective, history, yielded)
      stiffness_scale = secant_shear_ratio(law%elastic%shear, effective, history(history_eqps))
    end if
    if (yielded .or. law%damage%driver /= driver_none) then
      call dissipate(law, volume, yielded, before, strain, effective, history, stress)
      stiffness_scale = stiffness_scale*(1.0_dp - history(history_damage))
    end if
    if (.not. ieee_is_finite(stress(1) + stress(2) + stress(3) + stress(4))) &
      ierr = soil_not_finite
  end subroutine soil_return

  !> Plastic return of a trial stress, with the plastic strain it adds.
  !!
  !! With the split `deviatoric`, damage leaves the full mean pressure but only (1 - D) of the
  !! shear stress that dilation is paid from. Dilation therefore fades with (1 - D) there: at
  !! full dilation a damaged point would create energy.
  pure subroutine return_to_cone(law, suction, saturation, effective, history, yielded)
    type(soil_law_t), intent(in) :: law
    real(dp), intent(in) :: suction                  !! s = -p_w [Pa]
    real(dp), intent(in) :: saturation               !! effective saturation [-]
    real(dp), intent(inout) :: effective(4)          !! trial in, returned out [Pa]
    real(dp), intent(inout) :: history(history_size)
    logical, intent(out) :: yielded
    type(cone_t) :: cone
    real(dp) :: deqps

    call strength_cone(law%strength, history(history_eqps), suction, saturation, cone)
    if (law%damage%split == split_deviatoric) &
      cone%alpha_psi = cone%alpha_psi*(1.0_dp - history(history_damage))
    call drucker_prager_return(cone, law%elastic%shear, law%elastic%bulk, effective, deqps, yielded)
    history(history_eqps) = history(history_eqps) + deqps
  end subroutine return_to_cone

  !> Damage of the step, the stress it leaves, and the works dissipated. Both works follow from
  !! the trapezoidal work 1/2 (sigma_old + sigma_new) : d(eps), which they close exactly:
  !! work = change of the stored energy + plastic work + damage work.
  pure subroutine dissipate(law, volume, yielded, before, strain, effective, history, stress)
    type(soil_law_t), intent(in) :: law
    real(dp), intent(in) :: volume       !! J in the middle of the step [-]
    logical, intent(in) :: yielded
    real(dp), intent(in) :: before(4)    !! undamaged stress before, turned [Pa]
    real(dp), intent(in) :: strain(4)    !! total strain [-]
    real(dp), intent(in) :: effective(4) !! undamaged stress after [Pa]
    real(dp), intent(inout) :: history(history_size)
    real(dp), intent(inout) :: stress(4) !! trial stress in, damaged stress out [Pa]
    real(dp) :: trial(4), part(4), old(4), d_old

    trial = stress
    stress = effective
    old = before
    if (law%damage%driver /= driver_none) then
      d_old = history(history_damage)
      call damage_advance(law%damage, strain, history(history_eqps), history(history_kappa), &
        history(history_damage))
      if (history(history_damage) > 0.0_dp) then
        call damage_part(law%damage%split, effective, part)
        stress = effective - history(history_damage)*part
        call damage_part(law%damage%split, before, part)
        old = before - d_old*part
        history(history_damage_work) = history(history_damage_work) + volume &
          *damage_dissipation(law%damage, law%elastic, before, d_old, effective, &
          history(history_damage))
      end if
    end if
    if (yielded) then
      trial = trial - effective
      old = 0.5_dp*(old + stress)
      history(history_plastic_work) = history(history_plastic_work) &
        + volume*elastic_bilinear(law%elastic, trial, old)
    end if
  end subroutine dissipate

  !> Energy stored elastically per current volume [J/m3], reduced by damage.
  pure real(dp) function soil_stored_energy(law, effective, d)
    type(soil_law_t), intent(in) :: law
    real(dp), intent(in) :: effective(4) !! undamaged stress [Pa]
    real(dp), intent(in) :: d            !! damage [-]

    if (d > 0.0_dp) then
      soil_stored_energy = damage_stored(law%damage, law%elastic, effective, d)
    else
      soil_stored_energy = elastic_energy(law%elastic, effective)
    end if
  end function soil_stored_energy

  !> The same at n points.
  pure subroutine soil_stored_energies(law, n, history, effective, energy)
    type(soil_law_t), intent(in) :: law
    integer, intent(in) :: n
    real(dp), intent(in) :: history(history_size,n) !! see history_*
    real(dp), intent(in) :: effective(4,n)   !! undamaged stress [Pa]
    real(dp), intent(out) :: energy(n)       !! [J/m3]
    integer :: i

    call elastic_energies(law%elastic, n, effective, energy)
    do i = 1, n
      if (history(history_damage, i) > 0.0_dp) energy(i) = &
        soil_stored_energy(law, effective(:, i), history(history_damage, i))
    end do
  end subroutine soil_stored_energies

  !> Part chi of the pore pressure in the total stress: S_e above, 1 below the water table.
  elemental real(dp) function bishop_factor(suction, saturation)
    real(dp), intent(in) :: suction    !! s = -p_w [Pa]
    real(dp), intent(in) :: saturation !! effective saturation [-]

    bishop_factor = 1.0_dp
    if (suction > 0.0_dp) bishop_factor = saturation
  end function bishop_factor

  !> Total stress from effective stress: sigma = sigma' - chi p_w 1, with p_w = -s.
  pure subroutine bishop_subtract(suction, saturation, stress)
    real(dp), intent(in) :: suction      !! s = -p_w [Pa]
    real(dp), intent(in) :: saturation   !! effective saturation [-]
    real(dp), intent(inout) :: stress(4) !! effective in, total out [Pa], tension +
    real(dp) :: pull

    pull = bishop_factor(suction, saturation)*suction
    stress(1) = stress(1) + pull
    stress(2) = stress(2) + pull
    stress(3) = stress(3) + pull
  end subroutine bishop_subtract
end module talus_soil_law
