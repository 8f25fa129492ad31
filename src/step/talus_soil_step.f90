! SPDX-License-Identifier: MIT
!> One explicit step of the soil (src/THEORY.md (5.1)), the file to read first:
!>
!>   u_n+1   = u_n + dt v_n+1/2                          motion_position
!>   F_n+1   = 1 + G u_n+1, then W F                     strain_gradient, or _first, smooth_gradient
!>   U, e    = stretch, and its mean where soil is intact  tie_measure, smooth_gradient_tied, tie_means
!>   sigma   = law(F_n, F_n+1, suction), P = J sigma F^-T  stress_update
!>   r       = affine residual, its force and its P      residual_gather, or _levels
!>   R       = W^T P, and P of the first level           smooth_stress, or _tied
!>   f       = load + stabilisation - G^T R              force_unbalanced
!>   v_n+3/2 = v_n+1/2 + dt M^-1 f                       motion_velocity
module talus_soil_step
  use talus_kinds, only: dp, i8
  use talus_disc, only: disc_t
  use talus_ground, only: ground_t
  use talus_state, only: state_t
  use talus_strain, only: strain_first, strain_gradient, per_area
  use talus_smooth, only: smooth_gradient, smooth_stress, smooth_gradient_tied, smooth_stress_tied
  use talus_tie_step, only: tie_measure, tie_means
  use talus_stress_update, only: stress_update
  use talus_residual, only: residual_gather, residual_gather_levels
  use talus_force, only: force_unbalanced, motion_position, motion_velocity, motion_damp, &
    motion_velocity_consistent
  implicit none
  private
  public :: work_t, motion_t, work_allocate, soil_step, soil_force, soil_leave_rest
  public :: gradients, unbalanced

  !> Fields that live within a step only.
  type :: work_t
    real(dp), allocatable :: y(:,:)           !! first-level gradient, or area times it, then R, (4,n)
    real(dp), allocatable :: h(:,:)           !! displacement gradient that the stress sees, then with
                                              !! two levels Piola stress of the first [Pa], (4,n)
    real(dp), allocatable :: drive(:,:)       !! the one that drives damage alone, (4,n) or (4,0)
    real(dp), allocatable :: q(:,:)           !! area times first Piola stress [N m/m], (4,n)
    real(dp), allocatable :: stabilising(:,:) !! force of the stabilisation [N/m], (2,n) or (2,0)
    ! What ties the levels, (:,n) or (:,0); see talus_tie_step.
    real(dp), allocatable :: stretch(:,:)     !! of the first level, 6 rows
    real(dp), allocatable :: weighed(:,:)     !! area times weight, that times stretch, 4 rows
    real(dp), allocatable :: mean(:,:)        !! the same, smoothed, 4 rows
    real(dp), allocatable :: force(:,:)       !! out-of-balance force [N/m], (2,n)
    real(dp), allocatable :: pull(:,:)        !! less damping, for a consistent mass, (2,n) or (2,0)
  end type work_t

  !> How the nodes move in a stage.
  type :: motion_t
    real(dp) :: step = 0.0_dp              !! time step [s]
    real(dp) :: local = 0.0_dp             !! local damping, 0..1
    real(dp) :: viscous = 0.0_dp           !! viscous damping [1/s]
    real(dp) :: safety = 1.0_dp            !! step over stable step
    logical :: coupled = .false.           !! pore pressure follows the soil
    logical :: stiffens = .false.          !! and that may stiffen the soil
    logical :: consistent = .false.        !! mass is consistent with the strain, else lumped
    real(dp), allocatable :: mode(:,:)     !! fastest mode when last looked for, (2,n)
    real(dp), allocatable :: place(:,:)    !! displacement when last looked for [m], (2,n)
    real(dp), allocatable :: mobility(:,:) !! one over mass; 0 where held [m/kg], (2,n)
    real(dp), allocatable :: pair_mass(:)  !! of each edge at both ends, if consistent [kg/m]
  end type motion_t

contains

  !> Allocate the fields of a step.
  subroutine work_allocate(work, disc)
    type(work_t), intent(out) :: work
    type(disc_t), intent(in) :: disc

    allocate (work%y(4, disc%n), work%h(4, disc%n), work%q(4, disc%n), work%force(2, disc%n), &
              source=0.0_dp)
    allocate (work%stabilising(2, merge(disc%n, 0, disc%stabilised)), source=0.0_dp)
    allocate (work%drive(4, merge(disc%n, 0, disc%damage_only)), source=0.0_dp)
    associate (tied => merge(disc%n, 0, disc%tied))
      allocate (work%stretch(6, tied), work%weighed(4, tied), work%mean(4, tied), source=0.0_dp)
    end associate
    allocate (work%pull(2, 0))
  end subroutine work_allocate

  !> Advance the soil by one step. `failed` is 0, or code*n + node of the worst failure (codes of
  !> talus_soil_law).
  subroutine soil_step(disc, ground, motion, state, work, failed)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(motion_t), intent(in) :: motion
    type(state_t), intent(inout) :: state
    type(work_t), intent(inout) :: work
    integer, intent(out) :: failed

    failed = 0
    !$omp parallel default(none) shared(disc, ground, motion, state, work, failed)
    call motion_position(motion%step, state%v, state%u)
    call forces(disc, ground, motion%coupled, state, work, failed)
    call accelerate(disc, motion, state, work)
    !$omp end parallel
    state%steps = state%steps + 1_i8
  end subroutine soil_step

  !> From rest, at the present position, to the velocity half a step ahead. Without it, motion from
  !> rest would lag half a step behind.
  subroutine soil_leave_rest(disc, ground, motion, state, work, failed)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(motion_t), intent(in) :: motion
    type(state_t), intent(inout) :: state
    type(work_t), intent(inout) :: work
    integer, intent(out) :: failed

    failed = 0
    state%v = 0.0_dp
    !$omp parallel default(none) shared(disc, ground, motion, state, work, failed)
    call forces(disc, ground, motion%coupled, state, work, failed)
    call accelerate(disc, motion, state, work)
    !$omp end parallel
    state%v = 0.5_dp*state%v
  end subroutine soil_leave_rest

  !> Velocities at the next half step; within a parallel region.
  subroutine accelerate(disc, motion, state, work)
    type(disc_t), intent(in) :: disc
    type(motion_t), intent(in) :: motion
    type(state_t), intent(inout) :: state
    type(work_t), intent(inout) :: work

    if (motion%consistent) then
      call move_consistent(disc, motion, state, work)
    else
      call motion_velocity(motion%step, motion%local, motion%viscous, motion%mobility, work%force, &
                           state%v, state%acceleration, state%damped)
    end if
  end subroutine accelerate

  !> Velocities with the consistent mass; within a parallel region.
  subroutine move_consistent(disc, motion, state, work)
    type(disc_t), intent(in) :: disc
    type(motion_t), intent(in) :: motion
    type(state_t), intent(inout) :: state
    type(work_t), intent(inout) :: work

    associate (offset => disc%dual%node_offset, node => disc%dual%node_neighbour)
      if (motion%local > 0.0_dp) then
        call motion_damp(motion%local, work%force, state%v, work%pull)
        call motion_velocity_consistent(motion%step, offset, node, motion%pair_mass, &
          motion%mobility, work%force, work%pull, state%v, state%acceleration, state%damped)
      else
        call motion_velocity_consistent(motion%step, offset, node, motion%pair_mass, &
          motion%mobility, work%force, work%force, state%v, state%acceleration, state%damped)
      end if
    end associate
  end subroutine move_consistent

  !> Stress and out-of-balance force at the present position, without moving.
  subroutine soil_force(disc, ground, coupled, state, work, failed)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    logical, intent(in) :: coupled
    type(state_t), intent(inout) :: state
    type(work_t), intent(inout) :: work
    integer, intent(out) :: failed

    failed = 0
    !$omp parallel default(none) shared(disc, ground, coupled, state, work, failed)
    call forces(disc, ground, coupled, state, work, failed)
    !$omp end parallel
  end subroutine soil_force

  !> From displacement to out-of-balance force; within a parallel region.
  subroutine forces(disc, ground, coupled, state, work, failed)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    logical, intent(in) :: coupled
    type(state_t), intent(inout) :: state
    type(work_t), intent(inout) :: work
    integer, intent(inout) :: failed
    real(dp) :: none(0)

    call gradients(disc, state%u, work, stiffness=state%stiffness, intact=state%intact, &
                   between=state%between, between_old=state%between_old)
    call stress_update(disc, ground, coupled, work%h, work%drive, state, work%q, failed)
    if (disc%stabilised) then
      call unbalanced(disc, state%u, state%stiffness, state%stiffness_old, state%load, work, &
                      state%stabilising, state%stabilising_lost, state%between, state%between_old, &
                      state%intact, state%tied)
    else
      call unbalanced(disc, state%u, none, none, state%load, work, none, none)
    end if
  end subroutine forces

  !> Displacement gradients of all levels; within a parallel region.
  subroutine gradients(disc, u, work, f, stiffness, intact, between, between_old)
    type(disc_t), intent(in) :: disc
    real(dp), contiguous, intent(in) :: u(:,:) !! displacement [m], (2,n)
    type(work_t), intent(inout) :: work        !! y, h and drive come out, and what ties the levels
    ! What tie_measure says of these; only for levels that are tied.
    real(dp), contiguous, intent(in), optional :: f(:,:), stiffness(:)
    real(dp), contiguous, intent(inout), optional :: intact(:), between(:), between_old(:)

    if (.not. disc%two_levels) then
      call strain_gradient(disc%scni, disc%dual%area, u, work%h)
    else if (disc%damage_only) then
      call strain_first(disc%scni, u, work%h)
      call smooth_gradient(disc%two_level, work%h, work%drive)
      call per_area(disc%dual%area, work%h)
    else
      call strain_first(disc%scni, u, work%y)
      if (disc%tied) then
        call tie_measure(disc%tie, disc%dual%area, work%y, work%stretch, work%weighed, f, stiffness, &
          intact, between, between_old)
        call smooth_gradient_tied(disc%two_level, work%y, work%weighed, work%h, work%mean)
        call tie_means(disc%tie, work%mean, work%weighed)
      else
        call smooth_gradient(disc%two_level, work%y, work%h)
      end if
      if (disc%stabilised) call per_area(disc%dual%area, work%y)
    end if
  end subroutine gradients

  !> Out-of-balance force from the gradients and the stress; within a parallel region.
  subroutine unbalanced(disc, u, scale, before, load, work, energy, loss, between, between_old, &
    intact, tied)
    type(disc_t), intent(in) :: disc
    real(dp), contiguous, intent(in) :: u(:,:)       !! displacement [m], (2,n)
    ! What residual_gather says of these; without stabilisation none is read.
    real(dp), contiguous, intent(in) :: scale(:), before(:)
    real(dp), contiguous, intent(in) :: load(:,:)    !! weight and tractions [N/m], (2,n)
    type(work_t), intent(inout) :: work              !! from y, h and q to force
    real(dp), contiguous, intent(inout) :: energy(:), loss(:)
    ! For levels that are tied: what residual_gather_levels says of these, and of a motion what
    ! smooth_stress_tied says.
    real(dp), contiguous, intent(in), optional :: between(:), between_old(:)
    real(dp), contiguous, intent(in), optional :: intact(:)
    real(dp), contiguous, intent(inout), optional :: tied(:,:)

    associate (area => disc%dual%area)
      if (disc%two_levels .and. .not. disc%damage_only) then
        if (disc%tied) then
          call residual_gather_levels(disc%stabilise, area, u, work%y, scale, before, between, &
            between_old, work%h, work%q, work%stabilising, energy, loss)
          call smooth_stress_tied(disc%two_level, disc%tie, area, work%q, work%weighed, work%mean, &
            work%stretch, work%h, work%y, intact, tied, loss)
        else
          if (disc%stabilised) call residual_gather_levels(disc%stabilise, area, u, work%y, scale, &
            before, scale, before, work%h, work%q, work%stabilising, energy, loss)
          call smooth_stress(disc%two_level, work%q, disc%stabilised, work%h, work%y)
        end if
        call force_unbalanced(disc%scni, work%y, load, work%stabilising, work%force)
      else
        if (disc%stabilised) then
          call residual_gather(disc%stabilise, area, u, work%h, scale, before, work%q, &
            work%stabilising, energy, loss)
        else
          call per_area(area, work%q)
        end if
        call force_unbalanced(disc%scni, work%q, load, work%stabilising, work%force)
      end if
    end associate
  end subroutine unbalanced
end module talus_soil_step
