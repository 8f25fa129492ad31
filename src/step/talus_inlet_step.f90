! SPDX-License-Identifier: MIT
!> Water across the boundary in one seepage sub-step. Rain enters until the pressure reaches its
!> limit; what the soil does not take runs off. A seepage face lets out what would raise its
!> pressure above zero. Both follow from the storage, so nothing is lost when they switch.
module talus_inlet_step
  use talus_kinds, only: dp
  use talus_disc, only: disc_t
  use talus_ground, only: ground_t
  use talus_state, only: state_t, water_balance_t
  use talus_sum, only: sum_add
  use talus_conditions, only: inlets_t, inlets_rules, inlet_head, inlet_flux, inlet_rain, &
    inlet_seepage
  use talus_rain, only: rain_total
  use talus_cell_water, only: cell_content, cell_invert
  implicit none
  private
  public :: inlets_apply, inlets_heads

contains

  !> Apply every inlet after the inner fluxes of a sub-step, and keep the account.
  subroutine inlets_apply(inlets, catch, height, disc, ground, time, step, state)
    type(inlets_t), intent(in) :: inlets
    real(dp), intent(in) :: catch(:)  !! boundary length of each inlet [m]
    real(dp), intent(in) :: height(:) !! elevation of the nodes [m], (n)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    real(dp), intent(in) :: time, step !! of the sub-step [s]
    type(state_t), intent(inout) :: state
    real(dp) :: depth(size(inlets%rains)), volume
    integer :: i, k

    do i = 1, size(depth)
      depth(i) = rain_total(inlets%rains(i), time, time + step)
    end do
    volume = 0.0_dp
    do k = 1, size(inlets%node)
      i = inlets%node(k)
      associate (area => disc%dual%area(i), balance => state%water)
        select case (inlets%kind(k))
        case (inlet_flux)
          state%content(i) = state%content(i) + inlets%value(k)*catch(k)*step/area
          call book(balance, inlets%value(k)*catch(k)*step)
        case (inlet_head)
          call set_pressure(i, ground%unit_weight*(inlets%value(k) - height(i)))
        case (inlet_rain, inlet_seepage)
          if (inlets%kind(k) == inlet_rain) volume = volume + depth(inlets%rain(k))*catch(k)
          if (.not. inlets_rules(inlets, k)) cycle
          call rain_in(i, inlets%value(k), volume)
          volume = 0.0_dp
        end select
      end associate
    end do

  contains

    !> Water that a node holds at a pressure [m3/m2].
    pure real(dp) function held(i, pressure)
      integer, intent(in) :: i
      real(dp), intent(in) :: pressure

      held = cell_content(ground, disc%soil(i), state, i, pressure)
    end function held

    subroutine set_pressure(i, pressure)
      integer, intent(in) :: i
      real(dp), intent(in) :: pressure
      real(dp) :: content

      content = held(i, pressure)
      call book(state%water, (content - state%content(i))*disc%dual%area(i))
      state%content(i) = content
    end subroutine set_pressure

    !> Rain of a given volume [m2] onto a node whose pressure may not pass a limit.
    subroutine rain_in(i, limit, volume)
      integer, intent(in) :: i
      real(dp), intent(in) :: limit, volume
      real(dp) :: most, excess, entered

      most = held(i, limit)
      state%content(i) = state%content(i) + volume/disc%dual%area(i)
      excess = 0.0_dp
      if (state%content(i) > most) then
        excess = (state%content(i) - most)*disc%dual%area(i)
        state%content(i) = most
      end if
      entered = volume - excess
      call book(state%water, entered)
      call sum_add(state%water%runoff, state%water%runoff_lost, min(volume, excess))
    end subroutine rain_in
  end subroutine inlets_apply

  !> Give the nodes with a head their pressure, before the first fluxes are taken.
  subroutine inlets_heads(inlets, height, disc, ground, state)
    type(inlets_t), intent(in) :: inlets
    real(dp), intent(in) :: height(:) !! elevation of the nodes [m], (n)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(state_t), intent(inout) :: state
    real(dp) :: content
    integer :: k

    do k = 1, size(inlets%node)
      if (inlets%kind(k) /= inlet_head) cycle
      associate (i => inlets%node(k), soil => disc%soil(inlets%node(k)))
        content = cell_content(ground, soil, state, i, &
          ground%unit_weight*(inlets%value(k) - height(i)))
        if (.not. abs(content - state%content(i)) > 0.0_dp) cycle
        call book(state%water, (content - state%content(i))*disc%dual%area(i))
        state%content(i) = content
        call cell_invert(ground, soil, i, state)
      end associate
    end do
  end subroutine inlets_heads

  !> Book a volume as inflow or, when negative, as outflow.
  pure subroutine book(balance, volume)
    type(water_balance_t), intent(inout) :: balance
    real(dp), intent(in) :: volume !! inward positive [m2]

    if (volume >= 0.0_dp) then
      call sum_add(balance%inflow, balance%inflow_lost, volume)
    else
      call sum_add(balance%outflow, balance%outflow_lost, -volume)
    end if
  end subroutine book
end module talus_inlet_step
