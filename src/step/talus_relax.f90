! SPDX-License-Identifier: MIT
!> Equilibrium of the soil by damped motion with scaled masses (src/THEORY.md section 5.2).
module talus_relax
  use talus_kinds, only: dp
  use talus_const, only: pi
  use talus_disc, only: disc_t
  use talus_ground, only: ground_t
  use talus_state, only: state_t
  use talus_conditions, only: conditions_t, conditions_follow
  use talus_soil_step, only: work_t, motion_t, soil_step, soil_force
  use talus_time_step, only: time_step_stable, water_bulk_modulus
  use talus_soil_law, only: stress_bishop
  use talus_sum, only: sum_products
  use talus_inertia, only: inertia_pairs
  use talus_audit, only: audit_driven
  implicit none
  private
  public :: relax_t, relax, motion_prepare, motion_shorten, unbalanced_ratio, largest_motion

  integer, parameter, public :: relax_balanced = 0, relax_moving = 1, relax_exhausted = 2, &
    relax_broken = 3

  !> Steps between two looks at the balance.
  integer, parameter :: look_every = 25
  !> Steps between two looks at the stable step where pore water carries load: soil that fills with
  !> water becomes stiff.
  integer, parameter :: refresh_every = 250
  !> The step is found again when the soil has moved by this part of the node spacing since.
  real(dp), parameter :: refresh_travel = 0.05_dp

  type :: relax_t
    integer :: outcome = relax_balanced !! one of relax_*
    integer :: steps = 0                !! steps taken
    real(dp) :: ratio = 0.0_dp          !! out-of-balance force over applied force
    real(dp) :: moved = 0.0_dp          !! largest displacement during the relaxation [m]
    integer :: failed = 0               !! see soil_step
  end type relax_t

contains

  !> Masses and step of a stage. Scaled masses give every node the same stable step, near one
  !> second; true ones give real time. Lumped or consistent, as motion%consistent says.
  subroutine motion_prepare(disc, ground, conditions, state, scaled, safety, motion, work)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(conditions_t), intent(in) :: conditions
    type(state_t), intent(in) :: state
    logical, intent(in) :: scaled  !! scale the masses
    real(dp), intent(in) :: safety !! step over stable step
    type(motion_t), intent(inout) :: motion
    type(work_t), intent(inout) :: work
    real(dp), allocatable :: mass(:), bulk(:)
    integer :: i, k

    allocate (mass(disc%n))
    mass = state%mass
    if (scaled) then
      allocate (bulk(disc%n))
      call water_bulk_modulus(disc, ground, state, motion%coupled, bulk)
      do i = 1, disc%n
        associate (elastic => ground%law(disc%soil(i))%elastic)
          mass(i) = 0.0_dp
          do k = disc%dual%node_offset(i), disc%dual%node_offset(i+1) - 1
            mass(i) = mass(i) + (elastic%bulk + elastic%shear*4.0_dp/3.0_dp + bulk(i)) &
              *disc%dual%area(i)/sum((disc%mesh%x(:, disc%dual%node_neighbour(k)) &
                                      - disc%mesh%x(:, i))**2)
          end do
        end associate
      end do
    end if
    if (.not. allocated(motion%mobility)) allocate (motion%mobility(2, disc%n))
    do i = 1, disc%n
      motion%mobility(:, i) = merge(0.0_dp, 1.0_dp/mass(i), conditions%held(:, i))
    end do
    call prepare_inertia(disc, mass, motion, work)
    motion%safety = safety
    motion%stiffens = motion%coupled .and. any(ground%law%stress == stress_bishop)
    motion%step = huge(1.0_dp)
    call motion_refresh(disc, ground, state, motion, work)
    ! Without a node that can move, any step will do.
    if (motion%step > 0.1_dp*huge(1.0_dp)) motion%step = 1.0_dp
  end subroutine motion_prepare

  !> What a consistent mass needs; nothing for a lumped one.
  subroutine prepare_inertia(disc, mass, motion, work)
    type(disc_t), intent(in) :: disc
    real(dp), intent(in) :: mass(:) !! lumped [kg/m], (n)
    type(motion_t), intent(inout) :: motion
    type(work_t), intent(inout) :: work

    if (allocated(motion%pair_mass)) deallocate (motion%pair_mass)
    deallocate (work%pull)
    allocate (work%pull(2, merge(disc%n, 0, motion%consistent .and. motion%local > 0.0_dp)), &
              source=0.0_dp)
    if (motion%consistent) motion%pair_mass = inertia_pairs(disc%dual, disc%mesh%x, mass)
  end subroutine prepare_inertia

  !> Shorten the step where the body has become stiffer since it was last set.
  subroutine motion_refresh(disc, ground, state, motion, work)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(state_t), intent(in) :: state
    type(motion_t), intent(inout) :: motion
    type(work_t), intent(inout) :: work
    real(dp), allocatable :: force(:,:)
    real(dp) :: stable

    force = work%force
    stable = time_step_stable(disc, ground, state, motion, work)
    work%force = force
    ! Local damping adds up to its fraction to a force that opposes the motion.
    if (stable > 0.0_dp) &
      motion%step = min(motion%step, motion%safety*stable/sqrt(1.0_dp + motion%local))
    motion%place = state%u
  end subroutine motion_refresh

  !> The same while the soil moves. The velocity half a step ahead becomes that of the shorter step,
  !> which keeps the energy.
  subroutine motion_shorten(disc, ground, state, motion, work)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(state_t), intent(inout) :: state
    type(motion_t), intent(inout) :: motion
    type(work_t), intent(inout) :: work
    real(dp) :: before

    before = motion%step
    call motion_refresh(disc, ground, state, motion, work)
    state%v = state%v + 0.5_dp*(motion%step - before)*state%acceleration
    if (state%ahead > 0.0_dp) state%ahead = 0.5_dp*motion%step
  end subroutine motion_shorten

  !> Relax until the out-of-balance force is below `tolerance` of the applied one, the soil has
  !> moved by more than `moved_max`, or `steps_max` steps were taken. Soil that is squeezed thin
  !> needs a shorter step: who takes the motion back restores `motion%step`, too. Driven nodes first
  !> travel as far as their velocity takes them in `travel` seconds, and are then held.
  subroutine relax(disc, ground, conditions, motion, tolerance, steps_max, moved_max, travel, &
    state, work, outcome, from)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(conditions_t), intent(in) :: conditions
    type(motion_t), intent(inout) :: motion
    real(dp), intent(in) :: tolerance !! [-]
    integer, intent(in) :: steps_max
    real(dp), intent(in) :: moved_max !! displacement that counts as failure [m]; huge() for none
    real(dp), intent(in) :: travel    !! time that driven nodes move on [s]; 0 holds them
    type(state_t), intent(inout) :: state
    type(work_t), intent(inout) :: work
    type(relax_t), intent(out) :: outcome
    real(dp), intent(in), optional :: from(:,:) !! that displacement counts from [m], (2,n); absent:
                                                !! from the start
    real(dp), allocatable :: u_start(:,:), force(:,:)
    real(dp) :: spacing, travelled
    integer :: ramp
    logical :: travels

    u_start = state%u
    if (present(from)) u_start = from
    spacing = sqrt(sum(disc%dual%area)/real(disc%n, dp))
    ramp = 0
    if (conditions%driven .and. abs(travel) > 0.0_dp) ramp = min(ramp_steps(disc), steps_max)
    if (ramp > 0) call soil_force(disc, ground, motion%coupled, state, work, outcome%failed)
    outcome%outcome = relax_exhausted
    do while (outcome%steps < steps_max)
      if (modulo(outcome%steps + 1, look_every) == 0) force = work%force
      travels = outcome%steps < ramp
      if (travels .or. outcome%steps == ramp) call drive_nodes(disc, conditions, &
        travel*ramp_share(outcome%steps + 1, ramp), motion%step, state)
      if (travels) call audit_driven(motion, work%force, state)
      call soil_step(disc, ground, motion, state, work, outcome%failed)
      outcome%steps = outcome%steps + 1
      if (outcome%failed > 0) then
        outcome%outcome = relax_broken
        return
      end if
      if (travels) call audit_driven(motion, work%force, state)
      if (modulo(outcome%steps, look_every) /= 0 .and. outcome%steps < steps_max) cycle
      if (allocated(force)) motion%viscous = critical_damping(disc%n, motion, state, work, force)
      outcome%ratio = unbalanced_ratio(disc%n, motion, state, work)
      outcome%moved = largest_motion(disc%n, state%u, u_start)
      if (outcome%ratio <= tolerance .and. outcome%steps > ramp) then
        outcome%outcome = relax_balanced
        return
      else if (outcome%moved > moved_max) then
        outcome%outcome = relax_moving
        return
      end if
      travelled = largest_motion(disc%n, state%u, motion%place)
      if (travelled > refresh_travel*spacing .or. &
          (motion%stiffens .and. modulo(outcome%steps, refresh_every) == 0)) &
        call motion_shorten(disc, ground, state, motion, work)
    end do
  end subroutine relax

  !> Steps over which driven nodes travel: a wave, which passes about one spacing a step, crosses
  !> the body twice, so that their neighbours are not crushed.
  pure integer function ramp_steps(disc)
    type(disc_t), intent(in) :: disc
    real(dp) :: extent(2)

    extent = maxval(disc%mesh%x, dim=2) - minval(disc%mesh%x, dim=2)
    ramp_steps = 1 + ceiling(2.0_dp*maxval(extent)/sqrt(sum(disc%dual%area)/real(disc%n, dp)))
  end function ramp_steps

  !> Share of the travel in one step of a ramp: smooth, adding up to one; 0 after it.
  pure real(dp) function ramp_share(step, ramp) result(share)
    integer, intent(in) :: step, ramp

    share = 0.0_dp
    if (step > ramp) return
    share = 1.0_dp
    if (ramp > 1) share = (1.0_dp - cos(2.0_dp*pi*(real(step, dp) - 0.5_dp)/real(ramp, dp))) &
                          /real(ramp, dp)
  end function ramp_share

  !> Let driven nodes move in one step as far as their velocity takes them in a time, and held ones
  !> rest.
  pure subroutine drive_nodes(disc, conditions, time, step, state)
    type(disc_t), intent(in) :: disc
    type(conditions_t), intent(in) :: conditions
    real(dp), intent(in) :: time !! [s]
    real(dp), intent(in) :: step !! [s]
    type(state_t), intent(inout) :: state

    where (conditions%held) state%v = time/step*conditions%given
    if (allocated(conditions%motion)) call conditions_follow(conditions, disc%mesh%x, state%u, &
                                                             time, step, state%v)
  end subroutine drive_nodes

  !> Critical damping of the motion as it is now [1/s]: twice its frequency, by the quotient of
  !> Rayleigh of the last step (Underwood 1983). `before` is the force one step ago.
  real(dp) function critical_damping(n, motion, state, work, before) result(viscous)
    integer, intent(in) :: n
    type(motion_t), intent(in) :: motion
    type(state_t), intent(in) :: state
    type(work_t), intent(in) :: work
    real(dp), intent(in) :: before(:,:) !! [N/m], (2,n)
    real(dp), allocatable :: moved(:,:), momentum(:,:)
    real(dp) :: inertia, stiffness

    ! The velocity that led from the force before to the force now.
    moved = merge(state%v - motion%step*state%acceleration, 0.0_dp, motion%mobility > 0.0_dp)
    momentum = moved
    where (motion%mobility > 0.0_dp) momentum = moved/motion%mobility
    inertia = sum_products(2*n, moved, momentum)
    stiffness = sum_products(2*n, moved, before) - sum_products(2*n, moved, work%force)
    viscous = 0.0_dp
    if (stiffness > 0.0_dp .and. inertia > 0.0_dp) &
      viscous = 2.0_dp*sqrt(stiffness/(motion%step*inertia))
    viscous = min(viscous, 1.0_dp/motion%step)
  end function critical_damping

  !> Out-of-balance force on the nodes that can move over the load or, when larger, the reactions.
  real(dp) function unbalanced_ratio(n, motion, state, work) result(ratio)
    integer, intent(in) :: n
    type(motion_t), intent(in) :: motion
    type(state_t), intent(in) :: state
    type(work_t), intent(in) :: work
    real(dp), allocatable :: free(:,:), held(:,:)
    real(dp) :: applied

    free = merge(work%force, 0.0_dp, motion%mobility > 0.0_dp)
    held = work%force - free
    applied = max(sum_products(2*n, state%load, state%load), sum_products(2*n, held, held))
    ratio = 0.0_dp
    if (applied > 0.0_dp) ratio = sqrt(sum_products(2*n, free, free)/applied)
  end function unbalanced_ratio

  !> Largest distance between two sets of positions [m].
  real(dp) function largest_motion(n, u, u_start) result(largest)
    integer, intent(in) :: n
    real(dp), intent(in) :: u(2,n), u_start(2,n)
    integer :: i

    largest = 0.0_dp
    !$omp parallel do default(none) shared(n, u, u_start) private(i) reduction(max:largest) &
    !$omp schedule(static)
    do i = 1, n
      largest = max(largest, sum((u(:, i) - u_start(:, i))**2))
    end do
    !$omp end parallel do
    largest = sqrt(largest)
  end function largest_motion
end module talus_relax
