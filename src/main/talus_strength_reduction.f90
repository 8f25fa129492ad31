! SPDX-License-Identifier: MIT
!> A stage of strength reduction (src/THEORY.md section 5.9; Griffiths & Lane 1999): the factor by
!> which the strength can be divided until the soil finds no equilibrium.
module talus_strength_reduction
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_failed
  use talus_text, only: text_of
  use talus_deck_types, only: stage_t, deck_given
  use talus_state, only: state_t
  use talus_soil_step, only: motion_t
  use talus_session, only: session_t, reduction_t
  use talus_reduced_ground, only: reduced_ground
  use talus_relax, only: relax_t, relax, relax_balanced, relax_broken
  use talus_soil_law, only: soil_inverted
  use talus_record, only: record_line, record_snapshot, record_named
  use talus_stage_parts, only: take_back, feel_supports
  use talus_progress, only: progress_say
  implicit none
  private
  public :: failure_displacement, strength_reduction, next_factor

  !> Ratio of two factors until one stands and one fails.
  real(dp), parameter :: stride = 1.25_dp
  !> Factors beyond which the search ends.
  real(dp), parameter :: least = 0.01_dp, most = 100.0_dp
  !> Displacement that counts as failure, over the settlement of elastic soil: far past it in stiff
  !> soil, and at least as much as soft soil moves when strength is taken from it.
  real(dp), parameter :: share_stiff = 4.0_dp, share_soft = 0.6_dp
  !> The same over the mean depth, between the two: more changes the shape.
  real(dp), parameter :: share_depth = 0.02_dp

contains

  !> Bracket the factor. The stage ends in the state in which it began, in motion where it moved.
  subroutine strength_reduction(session, stage, failed, status)
    type(session_t), intent(inout) :: session
    type(stage_t), intent(in) :: stage
    integer, intent(out) :: failed !! 0, or the node whose numbers failed: see soil_step
    type(status_t), intent(inout) :: status
    type(reduction_t) :: found
    type(state_t) :: mechanism
    real(dp) :: displacement
    logical :: over

    found%stage = session%stage
    found%moved_max = failure_displacement(session, stage)
    displacement = session%greatest_displacement
    session%last_good = session%state
    failed = 0
    call next_factor(stage%factor_first, stage%factor_tolerance, found, session%factor, over)
    do while (.not. over)
      call try_factor(session, stage, found, failed)
      if (failed > 0) return
      if (.not. session%stands) mechanism = session%state
      call record_line(session, progress_of(found, stage), status)
      if (status_failed(status)) return
      call take_back(session)
      call next_factor(stage%factor_first, stage%factor_tolerance, found, session%factor, over)
    end do
    session%factor = 1.0_dp
    session%stands = .true.
    session%greatest_displacement = displacement
    session%reduction = [session%reduction, found]
    if (found%upper > 0.0_dp) then
      call progress_say(session%progress, 'equilibrium lost with strength divided by '// &
        text_of(found%upper, 4))
    end if
    call feel_supports(session)
    ! The state first: viewers show the first of two snapshots of one time.
    call record_snapshot(session, status)
    if (found%upper > 0.0_dp) &
      call record_named(session, mechanism_name(size(session%reduction)), mechanism, status)
  end subroutine strength_reduction

  !> Relax with the strength divided by session%factor.
  subroutine try_factor(session, stage, found, failed)
    type(session_t), intent(inout) :: session
    type(stage_t), intent(in) :: stage
    type(reduction_t), intent(inout) :: found
    integer, intent(out) :: failed !! 0, or the node whose numbers failed
    type(relax_t) :: outcome
    type(motion_t) :: motion

    failed = 0
    motion = session%motion
    session%motion%viscous = 0.0_dp
    session%state%v = 0.0_dp
    session%state%acceleration = 0.0_dp
    session%state%ahead = 0.0_dp
    call relax(session%disc, reduced_ground(session%ground, session%factor), session%conditions, &
               session%motion, stage%tolerance, stage%steps_max, found%moved_max, 0.0_dp, &
               session%state, session%work, outcome)
    ! Every trial begins alike, so that its outcome is that of its factor alone.
    session%motion = motion
    found%trials = found%trials + 1
    session%stands = outcome%outcome == relax_balanced
    if (session%stands) then
      found%lower = session%factor
      found%stood = outcome
      return
    end if
    found%upper = session%factor
    found%fell = outcome
    ! Soil that turns inside out while it looks for equilibrium has found none.
    if (outcome%outcome == relax_broken .and. &
        (outcome%failed - 1)/session%disc%n /= soil_inverted) failed = outcome%failed
  end subroutine try_factor

  !> Displacement that counts as failure [m]: the deck's, or a few times s = g D^2/E with unit weight
  !> g, mean depth D and modulus E, and where that is much, a small part of D, or of s in soft soil.
  !> Equilibrium is lost in the shape that the soil has now; a slide that went further might come to
  !> rest in a flatter one.
  real(dp) function failure_displacement(session, stage) result(displacement)
    type(session_t), intent(in) :: session
    type(stage_t), intent(in) :: stage
    real(dp) :: weight, area, compliance, depth, settlement

    displacement = stage%failure_displacement
    if (deck_given(displacement)) return
    associate (disc => session%disc, law => session%ground%law)
      area = sum(disc%dual%area)
      depth = area/(maxval(disc%mesh%x(1, :)) - minval(disc%mesh%x(1, :)))
      weight = session%ground%gravity*sum(session%state%mass)/area
      compliance = sum(disc%dual%area/law(disc%soil)%elastic%youngs_modulus)/area
    end associate
    settlement = weight*compliance*depth**2
    displacement = min(share_stiff*settlement, max(share_depth*depth, share_soft*settlement))
    if (.not. displacement > 0.0_dp) displacement = huge(1.0_dp)
  end function failure_displacement

  !> The factor to try next: strides up or down until one stands and one fails, then halves.
  pure subroutine next_factor(first, tolerance, found, factor, over)
    real(dp), intent(in) :: first     !! factor of the first trial [-]
    real(dp), intent(in) :: tolerance !! width of the bracket that is asked for [-]
    type(reduction_t), intent(in) :: found !! by the trials so far
    real(dp), intent(out) :: factor   !! [-]
    logical, intent(out) :: over      !! nothing is left to try

    over = .false.
    factor = first
    if (found%trials == 0) return
    if (found%upper < 0.0_dp) then
      factor = found%lower*stride
      over = factor > most
    else if (found%lower < 0.0_dp) then
      factor = found%upper/stride
      over = factor < least
    else
      factor = 0.5_dp*(found%lower + found%upper)
      over = found%upper - found%lower <= tolerance*(1.0_dp + 1.0e-9_dp)
    end if
  end subroutine next_factor

  !> Part of the trials that is done, about.
  pure real(dp) function progress_of(found, stage) result(fraction)
    type(reduction_t), intent(in) :: found
    type(stage_t), intent(in) :: stage
    real(dp) :: left

    left = (stride - 1.0_dp)*max(found%lower, found%upper)
    if (found%lower > 0.0_dp .and. found%upper > 0.0_dp) left = found%upper - found%lower
    left = log(max(1.0_dp, left/stage%factor_tolerance))/log(2.0_dp)
    fraction = real(found%trials, dp)/(real(found%trials, dp) + left)
  end function progress_of

  !> Snapshot of the mechanism of each such stage: mechanism, mechanism_2, ...
  pure function mechanism_name(number) result(name)
    integer, intent(in) :: number !! of the stage among its kind
    character(:), allocatable :: name

    name = 'mechanism'
    if (number > 1) name = name//'_'//text_of(number)
  end function mechanism_name
end module talus_strength_reduction
