! SPDX-License-Identifier: MIT
!> Steady seepage (src/THEORY.md section 5.4): pseudo-transient continuation (Kelley &
!> Keyes 1998). Implicit steps on the storage form grow until storage no longer matters; Newton's
!> method without storage finishes. The fluxes are those of the transient seepage, so a run that
!> starts here stays here while nothing changes.
module talus_steady
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_set, status_numeric, status_deck
  use talus_text, only: text_of
  use talus_disc, only: disc_t
  use talus_ground, only: ground_t
  use talus_state, only: state_t
  use talus_boundary_sets, only: boundary_set_t, boundary_set_build
  use talus_conditions, only: inlets_t, inlet_head, inlet_seepage
  use talus_storage, only: storage_content
  use talus_darcy, only: seepage_t, seepage_shape
  use talus_seepage, only: seepage_supply
  use talus_seepage_newton, only: newton_t, newton_prepare, newton_solve
  implicit none
  private
  public :: steady_solve, steady_heads

  !> First, last and smallest pseudo-step [s].
  real(dp), parameter :: step_first = 3600.0_dp, step_last = 1.0e12_dp, step_least = 1.0e-3_dp
  !> Last relative change of pressure in a pseudo-step and at the end.
  real(dp), parameter :: tolerance_way = 1.0e-5_dp, tolerance_end = 1.0e-9_dp
  !> Imbalance over the largest flux that counts as none where Newton's method circles, and the
  !> pseudo-step from which on what is stored in it counts as none [s].
  real(dp), parameter :: round_off = 1.0e-10_dp, step_settled = 1.0e9_dp
  !> Trials of a line search, and those where even the first pseudo-step is too long: soil whose
  !> water drains within a few pascals needs them to be met between dry and full.
  integer, parameter :: least_halvings = 6, most_halvings = 16
  integer, parameter :: most_way = 40, most_end = 60, most_steps = 300

contains

  !> From the pressures of `state`, a first guess, to those of steady flow. Its content is that of a
  !> step on the way and is to be set by the caller; rains count with their intensity at time 0.
  subroutine steady_solve(seepage, disc, ground, inlets, state, status)
    type(seepage_t), intent(inout) :: seepage !! on return with the steady fluxes
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(inlets_t), intent(in) :: inlets
    type(state_t), intent(inout) :: state
    type(status_t), intent(inout) :: status
    type(newton_t) :: newton
    real(dp), allocatable :: supply(:), pressure(:)
    logical, allocatable :: held(:)
    real(dp) :: step, growth, tolerance
    logical :: converged
    integer :: iterations, i

    if (.not. any(inlets%kind == inlet_head .or. inlets%kind == inlet_seepage)) then
      call status_set(status, status_deck, 'pore_pressure = ''steady'': no boundary lets '// &
        'water out; allowed: at least one &boundary with water = ''head'' or ''seepage_face'', '// &
        'or a water_table')
      return
    end if
    call seepage_shape(seepage, disc, ground, inlets, state)
    call newton_prepare(newton, disc)
    newton%balanced = .false.
    supply = seepage_supply(seepage, inlets, 0.0_dp, 1.0_dp)
    step = step_first
    growth = 10.0_dp
    tolerance = tolerance_end
    do i = 1, most_steps
      pressure = state%pressure
      held = seepage%held
      newton%tolerance = merge(tolerance_way, tolerance, step < step_last)
      newton%most = merge(most_way, most_end, step < step_last)
      newton%on_the_way = step < step_settled
      newton%halvings = merge(most_halvings, least_halvings, step < step_first)
      call newton_solve(newton, seepage, disc, ground, inlets, &
        merge(1.0_dp/step, 0.0_dp, step < step_last), supply, state, converged, iterations)
      if (converged .and. step >= step_last) return
      if (.not. converged .and. step >= step_settled .and. all(held .eqv. seepage%held) .and. &
          maxval(abs(newton%residual), mask=.not. seepage%held) &
          <= round_off*maxval(abs(seepage%q))) return
      ! At the kink of saturated soil Newton's method may circle in the last digits.
      if (step >= step_last) tolerance = min(10.0_dp*tolerance, tolerance_way)
      if (converged) then
        call store(disc, ground, state)
        step = step*merge(growth, 2.0_dp, iterations <= 6)
      else
        state%pressure = pressure
        seepage%held = held
        step = min(step, step_last)/5.0_dp
        growth = max(2.0_dp, 0.5_dp*growth)
        if (step < step_least) exit
      end if
    end do
    call status_set(status, status_numeric, 'pore_pressure = ''steady'': no steady seepage '// &
      'found; last pseudo-step '//text_of(step)//' s after '//text_of(min(i, most_steps))// &
      ' steps, largest imbalance '// &
      text_of(maxval(abs(newton%residual), mask=.not. seepage%held))//' m2/s of an offer of '// &
      text_of(sum(supply))//' m2/s; '//steady_advice(sum(supply)))
  end subroutine steady_solve

  !> What to do where no steady state was found.
  pure function steady_advice(offer) result(text)
    real(dp), intent(in) :: offer !! [m2/s]
    character(:), allocatable :: text

    text = 'take a smaller spacing or soil that drains less abruptly (smaller alpha or n), or '// &
      'start with ''hydrostatic'' and let a storm stage run until the flow is steady'
    if (offer > 0.0_dp) text = 'the rain may exceed what the ground can drain; else '//text
  end function steady_advice

  !> Take the water of the present pressures as stored.
  subroutine store(disc, ground, state)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(state_t), intent(inout) :: state
    integer :: i

    do i = 1, disc%n
      associate (soil => disc%soil(i), jacobian => state%jacobian(i))
        state%content(i) = storage_content(ground%curve(soil), ground%storage(soil), &
          jacobian - 1.0_dp + ground%porosity(soil), jacobian, state%pressure(i))
      end associate
    end do
  end subroutine store

  !> Where a deck names no head: the water table at the left and right side up to its elevation, or,
  !> where it lies below the body, at the bottom.
  subroutine steady_heads(inlets, disc, table, status)
    type(inlets_t), intent(inout) :: inlets
    type(disc_t), intent(in) :: disc
    real(dp), intent(in) :: table(2) !! elevation at the left and the right end [m]
    type(status_t), intent(inout) :: status
    type(boundary_set_t) :: set
    character(6), parameter :: side(2) = ['left  ', 'right ']
    real(dp) :: left, right, level
    integer :: k, i

    if (any(inlets%kind == inlet_head)) return
    do k = 1, 2
      call boundary_set_build(set, disc%mesh, disc%dual, trim(side(k)), &
        spread(0.0_dp, 1, 4), status)
      do i = 1, size(set%node)
        if (disc%mesh%x(2, set%node(i)) <= table(k)) call add_head(inlets, set%node(i), table(k))
      end do
    end do
    if (any(inlets%kind == inlet_head)) return
    left = minval(disc%mesh%x(1, :))
    right = maxval(disc%mesh%x(1, :))
    call boundary_set_build(set, disc%mesh, disc%dual, 'bottom', spread(0.0_dp, 1, 4), status)
    do i = 1, size(set%node)
      level = table(1) + (table(2) - table(1))*(disc%mesh%x(1, set%node(i)) - left)/(right - left)
      call add_head(inlets, set%node(i), level)
    end do
  end subroutine steady_heads

  !> Make a node one with a head, whether or not it was an inlet.
  pure subroutine add_head(inlets, node, head)
    type(inlets_t), intent(inout) :: inlets
    integer, intent(in) :: node
    real(dp), intent(in) :: head !! [m]
    integer :: m

    m = size(inlets%node)
    where (inlets%node == node)
      inlets%kind = inlet_head
      inlets%value = head
    end where
    if (any(inlets%node == node)) return
    inlets%node = [inlets%node, node]
    inlets%kind = [inlets%kind, inlet_head]
    inlets%value = [inlets%value, head]
    inlets%rain = [inlets%rain, 0]
    inlets%offset = [inlets%offset, inlets%offset(m+1)]
  end subroutine add_head
end module talus_steady
