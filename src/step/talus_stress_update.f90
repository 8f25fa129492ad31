! SPDX-License-Identifier: MIT
!> The constitutive update over all nodes: from the new deformation gradient to area times first
!> Piola stress (src/THEORY.md sections 3 and 5.1).
module talus_stress_update
  use talus_kinds, only: dp
  use talus_disc, only: disc_t
  use talus_ground, only: ground_t
  use talus_state, only: state_t
  use talus_objective, only: strain_advance, piola_stress
  use talus_soil_law, only: soil_law_t, soil_update, soil_ok, history_size, &
    history_size_plastic, stress_bishop, stress_net, bishop_factor, bishop_subtract, &
    soil_stored_energy, history_damage
  use talus_suction_strain, only: suction_strain_increment, suction_strain_none
  use talus_storage, only: storage_invert
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
    real(dp) :: f_new(4), stress(4)
    integer :: i, ierr

    !$omp do schedule(static) reduction(max:failed)
    do i = 1, disc%n
      f_new = [1.0_dp + h(1, i), h(2, i), h(3, i), 1.0_dp + h(4, i)]
      if (allocated(state%f_drive)) call advance_drive(drive(:, i), state%f_drive(:, i), &
                                                       state%strain(:, i))
      if (ground%wet) then
        call wet_point(ground, disc%soil(i), i, coupled, f_new, state, stress, ierr)
      else
        call dry_point(ground%law(disc%soil(i)), i, f_new, state, stress, ierr)
      end if
      if (ierr /= soil_ok) failed = max(failed, ierr*disc%n + i)
      if (disc%stabilised) state%stiffness(i) = max(disc%floor, state%stiffness(i))
      state%f(:, i) = f_new
      call piola_stress(f_new, stress, q(:, i))
      q(:, i) = disc%dual%area(i)*q(:, i)
    end do
    !$omp end do
  end subroutine stress_update

  !> Strain history that a smoothed gradient drives.
  pure subroutine advance_drive(h, f, strain)
    real(dp), intent(in) :: h(4)
    real(dp), intent(inout) :: f(4), strain(4)
    real(dp) :: f_new(4)
    integer :: ierr

    f_new = [1.0_dp + h(1), h(2), h(3), 1.0_dp + h(4)]
    call strain_advance(f, f_new, strain, ierr)
    f = f_new
  end subroutine advance_drive

  !> One node without water.
  subroutine dry_point(law, i, f_new, state, stress, ierr)
    type(soil_law_t), intent(in) :: law
    integer, intent(in) :: i
    real(dp), intent(in) :: f_new(4)
    type(state_t), intent(inout) :: state
    real(dp), intent(out) :: stress(4)
    integer, intent(out) :: ierr

    call soil_point(law, i, f_new, 0.0_dp, 0.0_dp, 1.0_dp, state, stress, ierr)
  end subroutine dry_point

  !> One node with water: pore pressure first, then stress, then the total stress.
  subroutine wet_point(ground, soil, i, coupled, f_new, state, stress, ierr)
    type(ground_t), intent(in) :: ground
    integer, intent(in) :: soil, i
    logical, intent(in) :: coupled
    real(dp), intent(in) :: f_new(4)
    type(state_t), intent(inout) :: state
    real(dp), intent(out) :: stress(4)
    integer, intent(out) :: ierr
    real(dp) :: jacobian, change, before, suction, effective, trace

    jacobian = f_new(1)*f_new(4) - f_new(2)*f_new(3)
    change = jacobian - state%jacobian(i)
    if (coupled) call storage_invert(ground%curve(soil), ground%storage(soil), &
      jacobian - 1.0_dp + ground%porosity(soil), jacobian, state%content(i), state%pressure(i), &
      state%saturation(i), state%ratio(i), state%potential(i), state%capacity(i))
    state%jacobian(i) = jacobian
    before = state%suction(i)
    associate (law => ground%law(soil), curve => ground%curve(soil))
      effective = (state%saturation(i) - curve%residual)/(curve%maximum - curve%residual)
      suction = -state%pressure(i)
      if (law%stress == stress_net) suction = max(suction, 0.0_dp)
      trace = sum(state%stress(1:3, i))
      call soil_point(law, i, f_new, before, suction, effective, state, stress, ierr)
      if (law%stress == stress_bishop) then
        state%water_work(i) = state%water_work(i) &
          + bishop_factor(suction, effective)*0.5_dp*(before + suction)*change
        call bishop_subtract(suction, effective, stress)
      else if (law%swelling%kind /= suction_strain_none) then
        state%water_work(i) = state%water_work(i) + 0.5_dp*(trace + sum(state%stress(1:3, i))) &
          *jacobian*suction_strain_increment(law%swelling, before, suction, jacobian)
      end if
    end associate
    state%suction(i) = suction
  end subroutine wet_point

  !> The soil's own law, with the history that exists.
  subroutine soil_point(law, i, f_new, suction_old, suction_new, effective, state, stress, ierr)
    type(soil_law_t), intent(in) :: law
    integer, intent(in) :: i
    real(dp), intent(in) :: f_new(4), suction_old, suction_new, effective
    type(state_t), intent(inout) :: state
    real(dp), intent(out) :: stress(4)
    integer, intent(out) :: ierr
    real(dp) :: strain(4), history(history_size), left, energy
    integer :: kept

    if (allocated(state%strain)) strain = state%strain(:, i)
    if (.not. allocated(state%strain)) strain = 0.0_dp
    kept = 0
    if (allocated(state%history)) kept = size(state%history, 1)
    history = 0.0_dp
    ! Copies of fixed length take no loop.
    if (kept == history_size) then
      history = state%history(:history_size, i)
    else if (kept > 0) then
      history(:history_size_plastic) = state%history(:history_size_plastic, i)
    end if
    energy = soil_stored_energy(law, state%stress(:, i), history(history_damage))
    call soil_update(law, state%f(:, i), f_new, suction_old, suction_new, effective, &
                     state%stress(:, i), strain, history, stress, left, ierr)
    ! A rate law for Cauchy stress works J sigma:D, which is the change of J times the stored energy
    ! less this.
    energy = energy + soil_stored_energy(law, state%stress(:, i), history(history_damage))
    state%volume_work(i) = state%volume_work(i) + 0.5_dp*energy &
      *(f_new(1)*f_new(4) - f_new(2)*f_new(3) &
        - state%f(1, i)*state%f(4, i) + state%f(2, i)*state%f(3, i))
    if (allocated(state%strain)) state%strain(:, i) = strain
    if (kept == history_size) then
      state%history(:history_size, i) = history
    else if (kept > 0) then
      state%history(:history_size_plastic, i) = history(:history_size_plastic)
    end if
    if (allocated(state%stiffness)) then
      state%stiffness_old(i) = state%stiffness(i)
      state%stiffness(i) = left
    end if
  end subroutine soil_point
end module talus_stress_update
