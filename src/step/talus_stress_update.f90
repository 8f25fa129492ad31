! SPDX-License-Identifier: MIT
!> The constitutive update over all nodes: from the new deformation gradient to area times first
!> Piola stress (src/THEORY.md sections 3 and 5.1).
!>
!> Nodes are taken in blocks, of one soil each. All points of a block pass through the elastic part
!> in loops that compilers vectorise; those that yield, or ever did, then return to the cone one by
!> one.
module talus_stress_update
  use talus_kinds, only: dp
  use talus_disc, only: disc_t
  use talus_ground, only: ground_t
  use talus_state, only: state_t
  use talus_objective, only: strain_advance, piola_stresses
  use talus_soil_law, only: soil_trial, soil_stays_elastic, soil_return, soil_stored_energies, &
    soil_points, soil_ok, history_size, history_size_plastic, stress_bishop, stress_net, &
    bishop_factor, bishop_subtract
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
    integer :: first, last, start, i

    !$omp do schedule(static) reduction(max:failed)
    do start = 1, disc%n, soil_points
      last = min(disc%n, start + soil_points - 1)
      if (allocated(state%f_drive)) then
        do i = start, last
          call advance_drive(drive(:, i), state%f_drive(:, i), state%strain(:, i))
        end do
      end if
      first = start
      do while (first <= last)
        i = first
        do while (i < last)
          if (disc%soil(i+1) /= disc%soil(first)) exit
          i = i + 1
        end do
        call update_block(disc, ground, disc%soil(first), coupled, first, i - first + 1, h, state, &
                          q, failed)
        first = i + 1
      end do
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
    real(dp), dimension(4,soil_points) :: f_new, strain, effective, stress
    real(dp), dimension(soil_points) :: suction_old, suction, saturation, det_mid, det_old, &
      det_new, energy, energy_new, stays, left
    real(dp) :: history(history_size,soil_points)
    integer :: last, i, j, ierr

    last = first + n - 1
    do j = 1, n
      f_new(1, j) = 1.0_dp + h(1, first+j-1)
      f_new(2:3, j) = h(2:3, first+j-1)
      f_new(4, j) = 1.0_dp + h(4, first+j-1)
    end do
    if (ground%wet) then
      call water_block(ground, soil, coupled, first, n, f_new, state, suction_old, suction, &
                       saturation)
    else
      suction_old(:n) = 0.0_dp
      suction(:n) = 0.0_dp
      saturation(:n) = 1.0_dp
    end if
    call history_get(state, first, n, strain, history)

    call soil_trial(ground%law(soil), n, state%f(:, first:last), f_new, suction_old, suction, &
                    state%stress(:, first:last), strain, effective, det_mid, det_old, det_new)
    call soil_stored_energies(ground%law(soil), n, history, state%stress(:, first:last), energy)
    call soil_stays_elastic(ground%law(soil), n, history, suction, saturation, det_mid, effective, &
                            stays)
    stress(:, :n) = effective(:, :n)
    left(:n) = 1.0_dp
    do j = 1, n
      if (stays(j) > 0.0_dp) cycle
      i = first + j - 1
      call soil_return(ground%law(soil), det_mid(j), 0.5_dp*(det_old(j) + det_new(j)), suction(j), &
                       saturation(j), state%stress(:, i), strain(:, j), effective(:, j), &
                       history(:, j), stress(:, j), left(j), ierr)
      if (ierr /= soil_ok) failed = max(failed, ierr*disc%n + i)
      call history_put(state, i, history(:, j))
    end do
    call soil_stored_energies(ground%law(soil), n, history, effective, energy_new)
    if (ground%wet) call water_work_block(ground, soil, first, n, suction_old, suction, &
      saturation, det_old, det_new, effective, state, stress)
    ! A rate law for Cauchy stress works J sigma:D, which is the change of J times the stored energy
    ! less this.
    state%volume_work(first:last) = state%volume_work(first:last) &
      + 0.5_dp*(energy(:n) + energy_new(:n))*(det_new(:n) - det_old(:n))
    state%stress(:, first:last) = effective(:, :n)
    state%f(:, first:last) = f_new(:, :n)
    if (allocated(state%strain)) state%strain(:, first:last) = strain(:, :n)
    if (allocated(state%stiffness)) then
      state%stiffness_old(first:last) = state%stiffness(first:last)
      state%stiffness(first:last) = max(disc%floor, left(:n))
    end if
    call piola_stresses(n, disc%dual%area(first:last), f_new, stress, q(:, first:last))
  end subroutine update_block

  !> Strain and history of a block, zero where the run has none.
  pure subroutine history_get(state, first, n, strain, history)
    type(state_t), intent(in) :: state
    integer, intent(in) :: first, n
    real(dp), intent(out) :: strain(4,n), history(history_size,n)
    integer :: kept, j

    if (allocated(state%strain)) then
      strain = state%strain(:, first:first+n-1)
    else
      strain = 0.0_dp
    end if
    kept = 0
    if (allocated(state%history)) kept = size(state%history, 1)
    ! Copies of fixed length take no loop.
    if (kept == history_size) then
      do j = 1, n
        history(:, j) = state%history(:history_size, first + j - 1)
      end do
    else
      history = 0.0_dp
      if (kept == 0) return
      do j = 1, n
        history(:history_size_plastic, j) = state%history(:history_size_plastic, first + j - 1)
      end do
    end if
  end subroutine history_get

  !> Keep the history of one node.
  pure subroutine history_put(state, i, history)
    type(state_t), intent(inout) :: state
    integer, intent(in) :: i
    real(dp), intent(in) :: history(history_size)

    if (.not. allocated(state%history)) return
    if (size(state%history, 1) == history_size) then
      state%history(:, i) = history
    else
      state%history(:, i) = history(:history_size_plastic)
    end if
  end subroutine history_put

  !> Pore pressure of a block at the new volume, and the suction and saturation its stress sees.
  pure subroutine water_block(ground, soil, coupled, first, n, f_new, state, suction_old, suction, &
    saturation)
    type(ground_t), intent(in) :: ground
    integer, intent(in) :: soil, first, n
    logical, intent(in) :: coupled
    real(dp), intent(in) :: f_new(4,n)
    type(state_t), intent(inout) :: state
    real(dp), intent(out) :: suction_old(n), suction(n), saturation(n)
    real(dp) :: jacobian, over_range
    integer :: i, j

    over_range = 1.0_dp/(ground%curve(soil)%maximum - ground%curve(soil)%residual)
    do j = 1, n
      i = first + j - 1
      jacobian = f_new(1, j)*f_new(4, j) - f_new(2, j)*f_new(3, j)
      if (coupled) call storage_invert(ground%curve(soil), ground%storage(soil), &
        jacobian - 1.0_dp + ground%porosity(soil), jacobian, state%content(i), state%pressure(i), &
        state%saturation(i), state%ratio(i), state%potential(i), state%capacity(i))
      state%jacobian(i) = jacobian
      suction_old(j) = state%suction(i)
      suction(j) = -state%pressure(i)
      saturation(j) = (state%saturation(i) - ground%curve(soil)%residual)*over_range
    end do
    if (ground%law(soil)%stress == stress_net) suction = max(suction, 0.0_dp)
    state%suction(first:first+n-1) = suction
  end subroutine water_block

  !> Work that a block exchanges with its water, and its total stress.
  pure subroutine water_work_block(ground, soil, first, n, suction_old, suction, saturation, &
    det_old, det_new, effective, state, stress)
    type(ground_t), intent(in) :: ground
    integer, intent(in) :: soil, first, n
    real(dp), intent(in) :: suction_old(n), suction(n), saturation(n) !! [Pa], [Pa], [-]
    real(dp), intent(in) :: det_old(n), det_new(n) !! J before and after [-]
    real(dp), intent(in) :: effective(4,n)         !! undamaged stress after [Pa]
    type(state_t), intent(inout) :: state          !! with the stress before
    real(dp), intent(inout) :: stress(4,n)         !! effective in, total out [Pa]
    integer :: i, j

    associate (law => ground%law(soil))
      if (law%stress == stress_bishop) then
        do j = 1, n
          i = first + j - 1
          state%water_work(i) = state%water_work(i) + bishop_factor(suction(j), saturation(j)) &
            *0.5_dp*(suction_old(j) + suction(j))*(det_new(j) - det_old(j))
          call bishop_subtract(suction(j), saturation(j), stress(:, j))
        end do
      else if (law%swelling%kind /= suction_strain_none) then
        do j = 1, n
          i = first + j - 1
          state%water_work(i) = state%water_work(i) &
            + 0.5_dp*(sum(state%stress(1:3, i)) + sum(effective(1:3, j)))*det_new(j) &
            *suction_strain_increment(law%swelling, suction_old(j), suction(j), det_new(j))
        end do
      end if
    end associate
  end subroutine water_work_block
end module talus_stress_update
