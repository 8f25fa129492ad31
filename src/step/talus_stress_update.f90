! SPDX-License-Identifier: MIT
!> The constitutive update over all nodes: from the new deformation gradient to area times first
!> Piola stress (src/THEORY.md sections 3 and 5.1).
!>
!> Nodes are taken in blocks, of one soil each, by component (talus_points). All points of a block
!> pass through the elastic part in loops that compilers vectorise; those that yield, or ever did,
!> are then put side by side and return to the cone in such loops too.
module talus_stress_update
  use talus_kinds, only: dp
  use talus_disc, only: disc_t
  use talus_ground, only: ground_t
  use talus_state, only: state_t
  use talus_points, only: soil_points, points_take, points_put, points_alike
  use talus_objective, only: strain_advance, piola_stresses
  use talus_soil_law, only: soil_law_t, soil_trial, soil_excess, soil_returns, &
    soil_ok, soil_inverted, history_eqps, history_damage, history_size, &
    stress_bishop, stress_net
  use talus_elastic, only: elastic_energies
  use talus_damage, only: driver_none, damage_parts
  use talus_drucker_prager, only: secant_shear_ratios, stress_roots
  use talus_suction_strain, only: suction_strain_increment, suction_strain_none
  use talus_cell_water, only: cells_invert
  implicit none
  private
  public :: stress_update

contains

  !> Update every node. `failed` is the greatest code*n + node of a failure, or 0. When `coupled`,
  !> the pore pressure follows the change of pore volume at constant water; else it is left alone.
  subroutine stress_update(disc, ground, coupled, h, drive, state, q, failed)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    logical, intent(in) :: coupled
    real(dp), contiguous, intent(in) :: h(:,:)      !! displacement gradient, (4,n)
    real(dp), contiguous, intent(in) :: drive(:,:)  !! the same, smoothed for damage alone, (4,n)
    type(state_t), intent(inout) :: state
    real(dp), contiguous, intent(inout) :: q(:,:)   !! area times Piola stress [N m/m], (4,n)
    integer, intent(inout) :: failed
    integer :: first, last, start, alike, i, ierr

    !$omp do schedule(static) reduction(max:failed)
    do start = 1, disc%n, soil_points
      last = min(disc%n, start + soil_points - 1)
      if (allocated(state%f_drive)) then
        do i = start, last
          call advance_drive(drive(:, i), state%f_drive(:, i), state%strain(:, i), ierr)
          if (ierr /= 0) failed = max(failed, soil_inverted*disc%n + i)
        end do
      end if
      first = start
      do while (first <= last)
        alike = points_alike(disc%soil(first:last))
        call update_block(disc, ground, disc%soil(first), coupled, first, alike, h, state, q, &
          failed)
        first = first + alike
      end do
    end do
    !$omp end do
  end subroutine stress_update

  !> Strain history that a smoothed gradient drives.
  pure subroutine advance_drive(h, f, strain, ierr)
    real(dp), intent(in) :: h(4)
    real(dp), intent(inout) :: f(4), strain(4)
    integer, intent(out) :: ierr !! 0, or 1 when a determinant is not positive
    real(dp) :: f_new(4)

    f_new = [1.0_dp + h(1), h(2), h(3), 1.0_dp + h(4)]
    call strain_advance(f, f_new, strain, ierr)
    f = f_new
  end subroutine advance_drive

  !> Nodes first to first + n - 1, all of one soil.
  subroutine update_block(disc, ground, soil, coupled, first, n, h, state, q, failed)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    integer, intent(in) :: soil, first, n
    logical, intent(in) :: coupled
    real(dp), contiguous, intent(in) :: h(:,:)
    type(state_t), intent(inout) :: state
    real(dp), contiguous, intent(inout) :: q(:,:)
    integer, intent(inout) :: failed
    real(dp), dimension(soil_points,4) :: f_old, f_new, strain, before, effective, stress
    real(dp), dimension(soil_points) :: suction_old, suction, saturation, det_mid, det_old, &
      det_new, energy, energy_new, worn, excess, left, reduced, trace_old
    integer :: list(soil_points), last, listed, j

    last = first + n - 1
    call points_take(n, state%f(:, first:last), f_old)
    call points_take(n, h(:, first:last), f_new)
    f_new(:n, 1) = 1.0_dp + f_new(:n, 1)
    f_new(:n, 4) = 1.0_dp + f_new(:n, 4)
    call points_take(n, state%stress(:, first:last), before)
    if (allocated(state%strain)) call points_take(n, state%strain(:, first:last), strain)
    if (ground%wet) then
      call water_block(ground, soil, coupled, first, n, f_new, state, suction_old, suction, &
                       saturation)
    else
      suction_old(:n) = 0.0_dp
      suction(:n) = 0.0_dp
      saturation(:n) = 1.0_dp
    end if
    call history_get(state, first, n, worn)

    associate (law => ground%law(soil))
      call elastic_energies(law%elastic, n, before, energy)
      call soil_trial(law, n, f_old, f_new, suction_old, suction, before, strain, effective, &
                      det_mid, det_old, det_new)
      if (law%swelling%kind /= suction_strain_none) call damaged_traces(law, first, n, before, &
        state, trace_old)
      call soil_excess(law, n, suction, saturation, effective, excess)
      stress(:n, :) = effective(:n, :)
      left(:n) = 1.0_dp
      listed = 0
      do j = 1, n
        if (excess(j) <= 0.0_dp .and. worn(j) <= 0.0_dp .and. det_mid(j) > 0.0_dp) cycle
        listed = listed + 1
        list(listed) = j
      end do
      if (listed > 0) call return_block(law, first, listed, list, det_mid, det_old, det_new, &
        suction, saturation, before, strain, effective, stress, left, energy, reduced, state, &
          failed)
      call elastic_energies(law%elastic, n, effective, energy_new)
      if (law%damage%driver /= driver_none) then
        do j = 1, listed
          energy_new(list(j)) = reduced(j)
        end do
      end if
    end associate
    if (ground%wet) call water_work_block(ground, soil, first, n, suction_old, suction, &
      saturation, det_old, det_new, trace_old, state, stress)
    ! A rate law for Cauchy stress works J sigma:D, which is the change of J times the stored energy
    ! less this.
    do j = 1, n
      state%volume_work(first+j-1) = state%volume_work(first+j-1) &
        + 0.5_dp*(energy(j) + energy_new(j))*(det_new(j) - det_old(j))
    end do
    call points_put(n, effective, state%stress(:, first:last))
    call points_put(n, f_new, state%f(:, first:last))
    if (allocated(state%strain)) call points_put(n, strain, state%strain(:, first:last))
    if (allocated(state%stiffness)) then
      state%stiffness_old(first:last) = state%stiffness(first:last)
      if (allocated(state%settled)) call soften_settled(ground%law(soil), first, n, effective, &
        state, left)
      state%stiffness(first:last) = max(disc%floor, left(:n))
    end if
    call piola_stresses(n, disc%dual%area(first:last), f_new, stress, q(:, first:last))
  end subroutine update_block

  !> Stiffness left where some plastic strain of a block counts as none: it is softened all the same.
  pure subroutine soften_settled(law, first, n, effective, state, left)
    type(soil_law_t), intent(in) :: law
    integer, intent(in) :: first, n
    real(dp), intent(in) :: effective(soil_points,4)  !! undamaged stress after [Pa]
    type(state_t), intent(in) :: state
    real(dp), intent(inout) :: left(soil_points)
    real(dp), dimension(soil_points) :: eqps, ratio, root
    integer :: j

    eqps(:n) = state%settled(first:first+n-1) + state%history(history_eqps, first:first+n-1)
    call stress_roots(n, effective, root)
    call secant_shear_ratios(n, law%elastic%shear, root, eqps, ratio)
    do j = 1, n
      if (.not. state%settled(first+j-1) > 0.0_dp) cycle
      left(j) = ratio(j)
      if (law%damage%driver /= driver_none) left(j) = left(j) &
        *(1.0_dp - state%history(history_damage, first+j-1))
    end do
  end subroutine soften_settled

  !> Whether each point of a block ever yielded, is open or was damaged: > 0.
  pure subroutine history_get(state, first, n, worn)
    type(state_t), intent(in) :: state
    integer, intent(in) :: first, n
    real(dp), intent(inout) :: worn(soil_points)
    integer :: j

    if (.not. allocated(state%history)) then
      worn(:n) = 0.0_dp
    else if (size(state%history, 1) == history_size) then
      do j = 1, n
        worn(j) = max(state%history(history_eqps, first+j-1), &
                      state%history(history_damage, first+j-1))
      end do
    else
      worn(:n) = state%history(history_eqps, first:first+n-1)
    end if
    if (allocated(state%opening)) worn(:n) = max(worn(:n), state%opening(first:first+n-1))
  end subroutine history_get

  !> The points of a block that do not stay elastic: put side by side, returned, and put back.
  subroutine return_block(law, first, m, list, det_mid, det_old, det_new, suction, saturation, &
    before, strain, effective, stress, left, energy, reduced, state, failed)
    type(soil_law_t), intent(in) :: law
    integer, intent(in) :: first, m, list(soil_points) !! points of the block that first begins
    real(dp), dimension(soil_points), intent(in) :: det_mid, det_old, det_new, suction, &
      saturation
    real(dp), dimension(soil_points,4), intent(in) :: before, strain
    real(dp), dimension(soil_points,4), intent(inout) :: effective, stress
    real(dp), dimension(soil_points), intent(inout) :: left, energy !! energy stored before [J/m3]
    real(dp), intent(inout) :: reduced(soil_points) !! by damage: energy stored after, by place in
                                                    !! the list [J/m3]; set only with damage
    type(state_t), intent(inout) :: state
    integer, intent(inout) :: failed
    real(dp), dimension(soil_points,4) :: turned, total, trial, total_stress
    real(dp) :: history(soil_points,history_size)
    real(dp), dimension(soil_points) :: middle, volume, pull, wet, opening, scale, energy_old
    integer :: code(soil_points), i, j, kept

    kept = 0
    if (allocated(state%history)) kept = size(state%history, 1)
    do i = 1, m
      j = list(i)
      middle(i) = det_mid(j)
      volume(i) = 0.5_dp*(det_old(j) + det_new(j))
      pull(i) = suction(j)
      wet(i) = saturation(j)
      turned(i, :) = before(j, :)
      trial(i, :) = effective(j, :)
      if (allocated(state%strain)) total(i, :) = strain(j, :)
      if (kept > 0) history(i, :kept) = state%history(:, first+j-1)
      history(i, kept+1:) = 0.0_dp
      if (allocated(state%opening)) opening(i) = state%opening(first+j-1)
    end do
    call soil_returns(law, m, middle, volume, pull, wet, turned, total, trial, history, opening, &
                      total_stress, scale, energy_old, reduced, code)
    do i = 1, m
      j = list(i)
      effective(j, :) = trial(i, :)
      stress(j, :) = total_stress(i, :)
      left(j) = scale(i)
      if (law%damage%driver /= driver_none) energy(j) = energy_old(i)
      if (kept > 0) state%history(:, first+j-1) = history(i, :kept)
      if (allocated(state%opening)) state%opening(first+j-1) = opening(i)
      if (code(i) /= soil_ok) failed = max(failed, code(i)*size(state%volume_work) + first + j - 1)
    end do
  end subroutine return_block

  !> Pore pressure of a block at the new volume, and the suction and saturation its stress sees.
  pure subroutine water_block(ground, soil, coupled, first, n, f_new, state, suction_old, suction, &
    saturation)
    type(ground_t), intent(in) :: ground
    integer, intent(in) :: soil, first, n
    logical, intent(in) :: coupled
    real(dp), intent(in) :: f_new(soil_points,4)
    type(state_t), intent(inout) :: state
    real(dp), dimension(soil_points), intent(inout) :: suction_old, suction, saturation
    real(dp) :: over_range
    integer :: last, j

    last = first + n - 1
    do j = 1, n
      state%jacobian(first+j-1) = f_new(j, 1)*f_new(j, 4) - f_new(j, 2)*f_new(j, 3)
      suction_old(j) = state%suction(first+j-1)
    end do
    if (coupled) call cells_invert(ground, soil, first, n, state)
    over_range = 1.0_dp/(ground%curve(soil)%maximum - ground%curve(soil)%residual)
    suction(:n) = -state%pressure(first:last)
    saturation(:n) = (state%saturation(first:last) - ground%curve(soil)%residual)*over_range
    if (ground%law(soil)%stress /= stress_net) return
    suction(:n) = max(suction(:n), 0.0_dp)
    state%suction(first:last) = suction(:n)
  end subroutine water_block

  !> Trace of the damaged stress of a block before the step [Pa]; turning does not change it.
  pure subroutine damaged_traces(law, first, n, before, state, trace)
    type(soil_law_t), intent(in) :: law
    integer, intent(in) :: first, n
    real(dp), intent(in) :: before(soil_points,4) !! undamaged stress before [Pa]
    type(state_t), intent(in) :: state            !! with the damage before
    real(dp), intent(inout) :: trace(soil_points)
    real(dp) :: part(soil_points,4)

    trace(:n) = before(:n, 1) + before(:n, 2) + before(:n, 3)
    if (law%damage%driver == driver_none) return
    call damage_parts(law%damage%split, n, before, part)
    trace(:n) = trace(:n) - state%history(history_damage, first:first+n-1) &
      *(part(:n, 1) + part(:n, 2) + part(:n, 3))
  end subroutine damaged_traces

  !> Work that a block exchanges with its water, and its total stress.
  pure subroutine water_work_block(ground, soil, first, n, suction_old, suction, saturation, &
    det_old, det_new, trace_old, state, stress)
    type(ground_t), intent(in) :: ground
    integer, intent(in) :: soil, first, n
    real(dp), intent(in) :: suction_old(soil_points) !! that the stress saw before [Pa]
    real(dp), intent(in) :: suction(soil_points)     !! s = -p_w after [Pa]
    real(dp), intent(in) :: saturation(soil_points)                      !! effective [-]
    real(dp), dimension(soil_points), intent(in) :: det_old, det_new     !! J before and after [-]
    real(dp), intent(in) :: trace_old(soil_points)    !! of damaged_traces; set with swelling only
    type(state_t), intent(inout) :: state
    real(dp), intent(inout) :: stress(soil_points,4)  !! damaged in, total out [Pa]
    real(dp) :: pull
    integer :: i, j

    associate (law => ground%law(soil))
      if (law%stress == stress_bishop) then
        do j = 1, n
          i = first + j - 1
          pull = merge(saturation(j), 1.0_dp, suction(j) > 0.0_dp)*suction(j)
          state%water_work(i) = state%water_work(i) &
            + 0.5_dp*(suction_old(j) + pull)*(det_new(j) - det_old(j))
          state%suction(i) = pull
          stress(j, 1) = stress(j, 1) + pull
          stress(j, 2) = stress(j, 2) + pull
          stress(j, 3) = stress(j, 3) + pull
        end do
      else if (law%swelling%kind /= suction_strain_none) then
        do j = 1, n
          i = first + j - 1
          state%water_work(i) = state%water_work(i) + 0.25_dp*(det_old(j) + det_new(j)) &
            *(trace_old(j) + (stress(j, 1) + stress(j, 2) + stress(j, 3))) &
            *suction_strain_increment(law%swelling, suction_old(j), suction(j), det_new(j))
        end do
      end if
    end associate
  end subroutine water_work_block
end module talus_stress_update
