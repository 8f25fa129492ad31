! SPDX-License-Identifier: MIT
!> From the deck's boundaries to the conditions of one stage.
module talus_setup_conditions
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_failed
  use talus_text, only: text_of
  use talus_deck_types, only: deck_t, boundary_t, deck_given, deck_held, deck_acts_in
  use talus_deck_messages, only: messages_t, messages_start, messages_error, messages_status
  use talus_disc, only: disc_t
  use talus_boundary_sets, only: boundary_set_t, boundary_set_build
  use talus_conditions, only: conditions_t, conditions_allocate, conditions_hold, conditions_load, &
    conditions_deform, conditions_floor, conditions_support, inlet_paint_t, inlets_start, &
    inlets_paint, inlets_finish, inlets_t, inlet_none, inlet_head, inlet_flux, inlet_rain, &
    inlet_seepage
  use talus_rain, only: rain_t, rain_constant, rain_read
  use talus_steady, only: steady_heads
  implicit none
  private
  public :: setup_conditions, setup_steady

contains

  !> Conditions of a stage. Boundaries are laid over each other in the order of the deck.
  subroutine setup_conditions(deck, disc, stage, conditions, status)
    type(deck_t), intent(in) :: deck
    type(disc_t), intent(in) :: disc
    character(*), intent(in) :: stage !! its name
    type(conditions_t), intent(out) :: conditions
    type(status_t), intent(inout) :: status
    type(boundary_set_t) :: sets(size(deck%boundary))
    type(rain_t) :: rains(size(deck%boundary))
    type(inlet_paint_t) :: paint
    type(messages_t) :: messages
    type(status_t) :: empty
    integer :: i

    call messages_start(messages, deck%path)
    call conditions_allocate(conditions, disc%n)
    call inlets_start(paint, disc%n)
    do i = 1, size(deck%boundary)
      rains(i) = rain_constant(0.0_dp)
      associate (boundary => deck%boundary(i))
        if (.not. deck_acts_in(boundary, stage)) cycle
        call boundary_set_build(sets(i), disc%mesh, disc%dual, boundary%where, &
          [boundary%from_x, boundary%to_x, boundary%from_y, boundary%to_y], empty)
        if (status_failed(empty)) then
          call messages_error(messages, boundary%where_line, '&boundary where = '''// &
            boundary%where//''': this model has no nodes there'// &
            '; allowed: a part that has some')
          empty = status_t()
          cycle
        end if
        if (.not. any(sets(i)%length > 0.0_dp) .and. len(needs_edges(boundary)) > 0) then
          call messages_error(messages, boundary%where_line, '&boundary where = '''// &
            boundary%where//''': no edge of the boundary has both ends there, so '// &
            needs_edges(boundary)//' would act on nothing; allowed: a part with an edge of the mesh')
          cycle
        end if
        if (deck_given(boundary%floor)) then
          if (.not. any(disc%mesh%x(2, sets(i)%node) > boundary%floor)) &
            call messages_error(messages, boundary%where_line, '&boundary floor = '// &
              text_of(boundary%floor)//': no node of where = '''//boundary%where// &
              ''' begins above it; allowed: a floor below some of them')
        end if
        call add_supports(boundary, sets(i), disc%mesh%x, conditions)
        call conditions_load(conditions, sets(i), [boundary%traction_x, boundary%traction_y], &
                             boundary%pressure)
        call add_water(boundary, sets(i), i, rains(i), paint, status)
      end associate
    end do
    call messages_status(messages, 'the boundaries do not fit this model', status)
    if (status_failed(status)) return
    call inlets_finish(conditions%inlets, paint, sets, rains)
  end subroutine setup_conditions

  !> What of a boundary acts along its edges: '' for nothing.
  pure function needs_edges(boundary) result(what)
    type(boundary_t), intent(in) :: boundary
    character(:), allocatable :: what

    what = ''
    if (boundary%water == 'flux') what = 'its flux'
    if (boundary%water == 'rain') what = 'its rain'
    if (abs(boundary%pressure) > 0.0_dp) what = 'its pressure'
    if (abs(boundary%traction_x) + abs(boundary%traction_y) > 0.0_dp) what = 'its traction'
  end function needs_edges

  !> Where water crosses the boundary in the steady state before the run: as in the first stage that
  !> moves water, with the antecedent rain in place of its rain, and the water table at the sides if
  !> the deck names no head.
  subroutine setup_steady(deck, disc, inlets, status)
    type(deck_t), intent(in) :: deck
    type(disc_t), intent(in) :: disc
    type(inlets_t), intent(out) :: inlets
    type(status_t), intent(inout) :: status
    type(conditions_t) :: conditions
    integer :: i, first

    first = 1
    do i = size(deck%stage), 1, -1
      if (deck%stage(i)%solve /= 'soil') first = i
    end do
    call setup_conditions(deck, disc, deck%stage(first)%name, conditions, status)
    if (status_failed(status)) return
    inlets = conditions%inlets
    do i = 1, size(inlets%rains)
      inlets%rains(i) = rain_constant(deck%initial%antecedent_rain)
    end do
    call steady_heads(inlets, disc, [deck%initial%water_table, deck%initial%water_table_right], &
                      status)
  end subroutine setup_steady

  !> Held and driven directions.
  subroutine add_supports(boundary, set, x, conditions)
    type(boundary_t), intent(in) :: boundary
    type(boundary_set_t), intent(in) :: set
    real(dp), intent(in) :: x(:,:) !! reference places [m], (2,n)
    type(conditions_t), intent(inout) :: conditions

    if (boundary%displacement == 'fixed' .or. boundary%displacement == 'roller_x') &
      call conditions_hold(conditions, set, 1, 0.0_dp)
    if (boundary%displacement == 'fixed' .or. boundary%displacement == 'roller_y') &
      call conditions_hold(conditions, set, 2, 0.0_dp)
    if (deck_given(boundary%velocity_x)) &
      call conditions_hold(conditions, set, 1, boundary%velocity_x)
    if (deck_given(boundary%velocity_y)) &
      call conditions_hold(conditions, set, 2, boundary%velocity_y)
    if (size(boundary%velocity_gradient) == 4) call conditions_deform(conditions, set, &
      boundary%velocity_gradient, [boundary%centre_x, boundary%centre_y])
    if (deck_given(boundary%floor)) call conditions_floor(conditions, set, x, &
      boundary%floor)
    if (len(boundary%name) > 0 .and. any(deck_held(boundary))) &
      call conditions_support(conditions, set, boundary%name, deck_held(boundary))
  end subroutine add_supports

  !> Where water enters and leaves.
  subroutine add_water(boundary, set, number, rain, paint, status)
    type(boundary_t), intent(in) :: boundary
    type(boundary_set_t), intent(in) :: set
    integer, intent(in) :: number
    type(rain_t), intent(inout) :: rain
    type(inlet_paint_t), intent(inout) :: paint
    type(status_t), intent(inout) :: status

    select case (boundary%water)
    case ('impermeable')
      call inlets_paint(paint, set, number, inlet_none, 0.0_dp, 0)
    case ('head')
      call inlets_paint(paint, set, number, inlet_head, boundary%head, 0)
    case ('flux')
      call inlets_paint(paint, set, number, inlet_flux, boundary%flux, 0)
    case ('seepage_face')
      call inlets_paint(paint, set, number, inlet_seepage, 0.0_dp, 0)
    case ('rain')
      if (len(boundary%hydrograph) > 0) then
        call rain_read(boundary%hydrograph, rain, status)
      else
        rain = rain_constant(boundary%rain)
      end if
      call inlets_paint(paint, set, number, inlet_rain, boundary%pressure_max, number)
    end select
  end subroutine add_water
end module talus_setup_conditions
