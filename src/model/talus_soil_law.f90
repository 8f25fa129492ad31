! SPDX-License-Identifier: MIT
!> The soil at one point: elasticity, plasticity, suction strain and damage composed.
!!
!! Order of a step (src/THEORY.md section 3): turn the undamaged stress, add the elastic stress
!! of the strain less the suction strain, return to the cone, raise damage, degrade. The cone is
!! that of the plastic strain before the step, so the return satisfies it exactly.
!! Points come in blocks, by component (talus_points): what all of them do are loops that compilers
!! vectorise; the plastic part and damage are left to the points that have any.
!! In `net` the stress carried is net stress and equals total stress above the water table; in
!! `bishop` it is effective stress, and bishop_subtract gives the total.
module talus_soil_law
  use talus_kinds, only: dp
  use talus_points, only: soil_points
  use talus_status, only: status_t, status_set, status_failed, status_deck
  use talus_objective, only: objective_increments, tensors_rotate
  use talus_elastic, only: elastic_t, elastic_prepare, elastic_adds, elastic_energies, &
    elastic_bilinears
  use talus_drucker_prager, only: cones_t, drucker_prager_returns, secant_shear_ratios, &
    openings_close, openings_after
  use talus_strength, only: strength_t, strength_prepare, strength_cones, strength_excess, &
    suction_strength_none
  use talus_suction_strain, only: suction_strain_t, suction_strain_prepare, &
    suction_strain_increment, suction_strain_none
  use talus_damage, only: damage_t, damage_prepare, damage_advance, damage_degrade, &
    damage_energies, driver_none, driver_plastic_strain, split_deviatoric
  implicit none
  private
  public :: soil_law_t, soil_law_prepare, soil_trial, soil_excess, soil_returns
  public :: soil_stored_energies, bishop_factor, bishop_subtract, soil_needs_strain

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

  !> Outcome of soil_returns.
  integer, parameter, public :: soil_ok = 0, soil_inverted = 1, soil_not_finite = 2

  !> Everything the update of one soil needs: set the components, then soil_law_prepare.
  type :: soil_law_t
    integer :: plasticity = plasticity_none !! one of plasticity_*
    integer :: stress = stress_net          !! one of stress_*
    logical :: own_strain = .true.          !! false: strain_advance drives the strain from outside
    logical :: closes = .false.             !! remembers how far it has opened at zero mean stress
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
    if (law%closes .and. (law%plasticity == plasticity_none .or. &
      abs(law%strength%tension_cutoff) > 0.0_dp)) call status_set(status, status_deck, &
      'crack_closure needs plasticity with tension_cutoff = 0')
    if (law%damage%driver == driver_plastic_strain .and. law%plasticity == plasticity_none) &
      call status_set(status, status_deck, 'driver = plastic_strain needs plasticity')
  end subroutine soil_law_prepare

  !> True when the update reads the strain of the point.
  pure logical function soil_needs_strain(law)
    type(soil_law_t), intent(in) :: law

    soil_needs_strain = law%damage%driver /= driver_none .and. &
      law%damage%driver /= driver_plastic_strain
  end function soil_needs_strain

  !> First half of the update, for n points of one soil: turn the stress, add the elastic stress of
  !! the strain less the suction strain.
  pure subroutine soil_trial(law, n, f_old, f_new, suction_old, suction_new, before, strain, &
    trial, det_mid, det_old, det_new)
    type(soil_law_t), intent(in) :: law              !! prepared
    integer, intent(in) :: n
    real(dp), intent(in) :: f_old(soil_points,4)     !! deformation gradient before [-]
    real(dp), intent(in) :: f_new(soil_points,4)     !! deformation gradient after [-]
    real(dp), intent(in) :: suction_old(soil_points) !! s = -p_w before [Pa]
    real(dp), intent(in) :: suction_new(soil_points) !! s after [Pa]
    real(dp), intent(inout) :: before(soil_points,4) !! undamaged stress before, turned out [Pa]
    real(dp), intent(inout) :: strain(soil_points,4) !! total strain [-]; not used without damage
    real(dp), intent(inout) :: trial(soil_points,4)  !! elastic trial stress [Pa]
    real(dp), intent(inout) :: det_mid(soil_points)  !! J of the middle [-]; 0 where inverted
    real(dp), intent(inout) :: det_old(soil_points)  !! J before [-]
    real(dp), intent(inout) :: det_new(soil_points)  !! J after [-]
    real(dp) :: dstrain(soil_points,4), rotation(soil_points,2)
    integer :: i

    call objective_increments(n, f_old, f_new, dstrain, rotation, det_mid, det_old, det_new)
    call tensors_rotate(n, rotation, before)
    if (law%own_strain .and. soil_needs_strain(law)) then
      call tensors_rotate(n, rotation, strain)
      strain(:n, :) = strain(:n, :) + dstrain(:n, :)
    end if
    if (law%swelling%kind /= suction_strain_none) then
      do i = 1, n
        if (det_mid(i) > 0.0_dp) dstrain(i, 1:3) = dstrain(i, 1:3) &
          - suction_strain_increment(law%swelling, suction_old(i), suction_new(i), det_new(i))
      end do
    end if
    call elastic_adds(law%elastic, n, dstrain, before, trial)
  end subroutine soil_trial

  !> Whether soil_returns would change n points that have never yielded nor been damaged: > 0 or not
  !> a number where it would.
  pure subroutine soil_excess(law, n, suction, saturation, trial, excess)
    type(soil_law_t), intent(in) :: law
    integer, intent(in) :: n
    real(dp), intent(in) :: suction(soil_points)    !! s = -p_w after [Pa]
    real(dp), intent(in) :: saturation(soil_points) !! effective saturation after [-]
    real(dp), intent(in) :: trial(soil_points,4)    !! elastic trial stress [Pa]
    real(dp), intent(inout) :: excess(soil_points)  !! only its sign has a meaning
    integer :: i

    if (soil_needs_strain(law)) then
      excess(:n) = 1.0_dp
    else if (law%plasticity == plasticity_drucker_prager) then
      call strength_excess(law%strength, n, suction, saturation, trial, excess)
    else
      do i = 1, n
        excess(i) = 0.0_dp*(trial(i, 1) + trial(i, 2) + trial(i, 3) + trial(i, 4))
      end do
    end if
  end subroutine soil_excess

  !> Second half of the update, at n points: return to the cone, raise damage, degrade.
  !!
  !! On a failure (ierr /= 0) the state of the point is not to be used further. The stiffness
  !! scale is (1 - D) times the secant shear ratio, between 0 and 1; its floor is the caller's.
  pure subroutine soil_returns(law, n, det_mid, volume, suction, saturation, before, strain, &
    effective, history, opening, stress, stiffness_scale, energy_old, energy_new, ierr)
    type(soil_law_t), intent(in) :: law              !! prepared
    integer, intent(in) :: n
    real(dp), intent(in) :: det_mid(soil_points)     !! of soil_trial
    real(dp), intent(in) :: volume(soil_points)      !! mean of J before and after [-]
    real(dp), intent(in) :: suction(soil_points)     !! s = -p_w after [Pa]
    real(dp), intent(in) :: saturation(soil_points)  !! effective saturation after [-]
    real(dp), intent(in) :: before(soil_points,4)    !! undamaged stress before, turned [Pa]
    real(dp), intent(in) :: strain(soil_points,4)    !! total strain after [-]
    real(dp), intent(inout) :: effective(soil_points,4) !! trial in, undamaged stress out [Pa]
    real(dp), intent(inout) :: history(soil_points,history_size) !! see history_*
    real(dp), intent(inout) :: opening(soil_points)  !! volumetric strain it is open by [-], >= 0;
                                                     !! used where the law closes
    real(dp), intent(inout) :: stress(soil_points,4) !! damaged, without pore pressure [Pa]
    real(dp), intent(inout) :: stiffness_scale(soil_points) !! stiffness left over elastic [-]
    real(dp), intent(inout) :: energy_old(soil_points) !! stored before [J/m3]; set with damage only
    real(dp), intent(inout) :: energy_new(soil_points) !! stored after [J/m3]; set with damage only
    integer, intent(inout) :: ierr(soil_points)      !! one of soil_ok, soil_inverted, ...
    real(dp) :: trial(soil_points,4), old(soil_points,4)
    integer :: i

    stiffness_scale(:n) = 1.0_dp
    trial(:n, :) = effective(:n, :)
    if (law%plasticity == plasticity_drucker_prager) call return_to_cone(law, n, suction, &
      saturation, effective, history, opening, stiffness_scale)
    stress(:n, :) = effective(:n, :)
    old(:n, :) = before(:n, :)
    if (law%damage%driver /= driver_none) call wear(law, n, volume, strain, history, old, stress, &
      stiffness_scale, energy_old, energy_new)
    if (law%plasticity == plasticity_drucker_prager) call plastic_work(law, n, volume, trial, &
      effective, old, stress, history)
    do i = 1, n
      ierr(i) = soil_ok
      if (.not. abs(stress(i, 1) + stress(i, 2) + stress(i, 3) + stress(i, 4)) <= huge(1.0_dp)) &
        ierr(i) = soil_not_finite
      if (.not. det_mid(i) > 0.0_dp) ierr(i) = soil_inverted
    end do
  end subroutine soil_returns

  !> Plastic return of trial stresses, with the plastic strain it adds and the shear stiffness left.
  !!
  !! With the split `deviatoric`, damage leaves the full mean pressure but only (1 - D) of the
  !! shear stress that dilation is paid from. Dilation therefore fades with (1 - D) there: at
  !! full dilation a damaged point would create energy.
  pure subroutine return_to_cone(law, n, suction, saturation, effective, history, opening, left)
    type(soil_law_t), intent(in) :: law
    integer, intent(in) :: n
    real(dp), intent(in) :: suction(soil_points)        !! s = -p_w [Pa]
    real(dp), intent(in) :: saturation(soil_points)     !! effective saturation [-]
    real(dp), intent(inout) :: effective(soil_points,4) !! trial in, returned out [Pa]
    real(dp), intent(inout) :: history(soil_points,history_size)
    real(dp), intent(inout) :: opening(soil_points)     !! see soil_returns [-]
    real(dp), intent(inout) :: left(soil_points)        !! secant over elastic shear stiffness [-]
    type(cones_t) :: cones
    real(dp), dimension(soil_points) :: deqps, root, i1

    call strength_cones(law%strength, n, history(:, history_eqps), suction, saturation, cones)
    if (law%damage%split == split_deviatoric .and. law%damage%driver /= driver_none) &
      cones%alpha_psi(:n) = cones%alpha_psi(:n)*(1.0_dp - history(:n, history_damage))
    if (law%closes) then
      call openings_close(n, law%elastic%bulk, opening, effective, cones%alpha_psi)
      i1(:n) = effective(:n, 1) + effective(:n, 2) + effective(:n, 3)
    end if
    call drucker_prager_returns(n, cones, law%elastic%shear, law%elastic%bulk, effective, deqps, &
                                root)
    if (law%closes) call openings_after(n, cones, law%elastic%bulk, i1, deqps, opening)
    history(:n, history_eqps) = history(:n, history_eqps) + deqps(:n)
    call secant_shear_ratios(n, law%elastic%shear, root, history(:, history_eqps), left)
  end subroutine return_to_cone

  !> Damage of the step, the stress it leaves, and the work it dissipates. Both works follow from
  !! the trapezoidal work 1/2 (sigma_old + sigma_new) : d(eps), which they close exactly:
  !! work = change of the stored energy + plastic work + damage work.
  pure subroutine wear(law, n, volume, strain, history, old, stress, left, energy_old, energy_new)
    type(soil_law_t), intent(in) :: law
    integer, intent(in) :: n
    real(dp), intent(in) :: volume(soil_points)      !! J in the middle of the step [-]
    real(dp), intent(in) :: strain(soil_points,4)    !! total strain [-]
    real(dp), intent(inout) :: history(soil_points,history_size)
    real(dp), intent(inout) :: old(soil_points,4)    !! stress before, turned: undamaged in,
                                                     !! damaged out [Pa]
    real(dp), intent(inout) :: stress(soil_points,4) !! stress after: the same
    real(dp), intent(inout) :: left(soil_points)     !! stiffness left over elastic [-]
    real(dp), dimension(soil_points), intent(inout) :: energy_old, energy_new !! stored [J/m3]
    real(dp), dimension(soil_points) :: d_old, released
    real(dp) :: total(4)
    integer :: i

    d_old(:n) = history(:n, history_damage)
    total = 0.0_dp
    do i = 1, n
      if (soil_needs_strain(law)) total = strain(i, :)
      call damage_advance(law%damage, total, history(i, history_eqps), history(i, history_kappa), &
        history(i, history_damage))
    end do
    call damage_degrade(law%damage, law%elastic, n, d_old, history(:, history_damage), old, &
      stress, energy_old, energy_new, released)
    do i = 1, n
      history(i, history_damage_work) = history(i, history_damage_work) + volume(i)*released(i)
      left(i) = left(i)*(1.0_dp - history(i, history_damage))
    end do
  end subroutine wear

  !> Add the plastic work: none where the return left the trial stress as it was.
  pure subroutine plastic_work(law, n, volume, trial, effective, old, stress, history)
    type(soil_law_t), intent(in) :: law
    integer, intent(in) :: n
    real(dp), intent(in) :: volume(soil_points)         !! J in the middle of the step [-]
    real(dp), intent(inout) :: trial(soil_points,4)     !! trial stress [Pa]; lost
    real(dp), intent(in) :: effective(soil_points,4)    !! returned stress [Pa]
    real(dp), intent(inout) :: old(soil_points,4)       !! damaged stress before [Pa]; lost
    real(dp), intent(in) :: stress(soil_points,4)       !! damaged stress after [Pa]
    real(dp), intent(inout) :: history(soil_points,history_size)
    real(dp) :: work(soil_points)
    integer :: i

    trial(:n, :) = trial(:n, :) - effective(:n, :)
    old(:n, :) = 0.5_dp*(old(:n, :) + stress(:n, :))
    call elastic_bilinears(law%elastic, n, trial, old, work)
    do i = 1, n
      history(i, history_plastic_work) = history(i, history_plastic_work) &
        + volume(i)*work(i)
    end do
  end subroutine plastic_work

  !> Energy stored elastically per current volume at n points of a block, reduced by damage.
  pure subroutine soil_stored_energies(law, n, effective, d, energy)
    type(soil_law_t), intent(in) :: law
    integer, intent(in) :: n
    real(dp), intent(in) :: effective(soil_points,4) !! undamaged stress [Pa]
    real(dp), intent(in) :: d(soil_points)           !! damage [-]; not read in soil without
    real(dp), intent(inout) :: energy(n)             !! [J/m3]

    if (law%damage%driver == driver_none) then
      call elastic_energies(law%elastic, n, effective, energy)
    else
      call damage_energies(law%damage, law%elastic, n, effective, d, energy)
    end if
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
