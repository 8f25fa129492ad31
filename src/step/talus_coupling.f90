! SPDX-License-Identifier: MIT
!> Water and soil that carry a load together, over one step of the storm clock (src/THEORY.md 5.6).
!>
!> In turns, until both agree: the water moves while the pores give way as at fixed total stress,
!> then the soil finds its equilibrium at the pressures found. Each turn starts from the water
!> before the step, so the fluxes of the last one are those of the step and no water is lost.
!> What the pores then hold at these pressures and the water stored differ by less each turn; the
!> rest is left to the next step, which starts from the water stored.
module talus_coupling
  use talus_kinds, only: dp
  use talus_disc, only: disc_t
  use talus_ground, only: ground_t
  use talus_state, only: state_t, water_balance_t
  use talus_soil_law, only: stress_bishop, bishop_factor
  use talus_cell_water, only: cell_content
  use talus_seepage, only: seepage_invert
  implicit none
  private
  public :: coupling_t, coupling_needed, coupling_start, coupling_give, coupling_take
  public :: coupling_left, coupling_done, coupling_turns

  !> Most turns of a step.
  integer, parameter :: coupling_turns = 30
  !> Pressure that is left to the next step over the greatest change of pressure in this one.
  real(dp), parameter :: tolerance = 1.0e-4_dp
  !> Part of the pressure left that a turn leaves of alternation from node to node, which the soil
  !> hardly feels; elsewhere it is a half at most. And the most that may be left of it.
  real(dp), parameter :: slow = 0.75_dp, most_slow = 1.0e-2_dp

  !> The water before a step, and what the pores gave in the latest turn.
  type :: coupling_t
    type(water_balance_t) :: water
    real(dp), allocatable :: content(:)  !! [m3/m2], (n)
    real(dp), allocatable :: pressure(:) !! [Pa], (n)
    real(dp), allocatable :: gave(:)     !! water that wider pores took up [1/Pa], (n)
  end type coupling_t

contains

  !> True when pore water carries load in some soil.
  pure logical function coupling_needed(ground) result(needed)
    type(ground_t), intent(in) :: ground

    needed = .false.
    if (ground%wet) needed = any(ground%law%stress == stress_bishop)
  end function coupling_needed

  !> Remember the water before a step.
  pure subroutine coupling_start(coupling, state)
    type(coupling_t), intent(out) :: coupling
    type(state_t), intent(in) :: state

    coupling%water = state%water
    coupling%content = state%content
    coupling%pressure = state%pressure
  end subroutine coupling_start

  !> Begin a turn: the water before the step, in pores that give way to a change of pressure by
  !>   S_r chi J/(K + 5/6 G),
  !> a stiffness half-way between soil held sideways, K + 4/3 G, and free, K + 1/3 G.
  subroutine coupling_give(coupling, disc, ground, state)
    type(coupling_t), intent(in) :: coupling
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(state_t), intent(inout) :: state
    real(dp) :: effective
    integer :: i

    state%water = coupling%water
    state%content = coupling%content
    do i = 1, disc%n
      associate (law => ground%law(disc%soil(i)), curve => ground%curve(disc%soil(i)))
        if (law%stress /= stress_bishop) cycle
        effective = (state%saturation(i) - curve%residual)/(curve%maximum - curve%residual)
        state%give(i) = state%saturation(i)*bishop_factor(-state%pressure(i), effective) &
          *state%jacobian(i)/(law%elastic%bulk + 5.0_dp/6.0_dp*law%elastic%shear)
      end associate
    end do
    state%anchor = state%pressure
    call seepage_invert(disc, ground, state)
  end subroutine coupling_give

  !> The water has moved: pores are again as the soil has them.
  pure subroutine coupling_take(coupling, state)
    type(coupling_t), intent(inout) :: coupling
    type(state_t), intent(inout) :: state

    coupling%gave = state%give
    state%capacity = state%capacity - state%give
    state%give = 0.0_dp
  end subroutine coupling_take

  !> Greatest pressure that the next turn would still change, over the greatest change of the step.
  pure real(dp) function coupling_left(coupling, disc, ground, state) result(left)
    type(coupling_t), intent(in) :: coupling
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(state_t), intent(in) :: state
    real(dp) :: change, wanted
    integer :: i

    change = 1.0e-9_dp*maxval(abs(state%pressure)) + tiny(1.0_dp)
    wanted = 0.0_dp
    do i = 1, disc%n
      if (.not. coupling%gave(i) > 0.0_dp) cycle
      change = max(change, abs(state%pressure(i) - coupling%pressure(i)))
      wanted = max(wanted, abs(state%content(i) - cell_content(ground, disc%soil(i), state, i, &
        state%pressure(i)))/(state%capacity(i) + coupling%gave(i)))
    end do
    left = wanted/change
  end function coupling_left

  !> True when no more turns are needed: little is left, or what is left alternates from node to
  !> node. More turns would only bring that into the pressures.
  pure logical function coupling_done(before, left) result(done)
    real(dp), intent(in) :: before !! coupling_left of the turn before; huge() for none
    real(dp), intent(in) :: left   !! of this turn

    done = left <= tolerance .or. (left <= most_slow .and. left > slow*before)
  end function coupling_done
end module talus_coupling
