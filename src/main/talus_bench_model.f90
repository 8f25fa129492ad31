! SPDX-License-Identifier: MIT
!> The models that are timed: one slope of 375 m2 with a chosen number of nodes and chosen parts of
!> the physics, written as a deck, so that each can be run by itself too.
module talus_bench_model
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_failed
  use talus_text, only: text_of
  use talus_deck_types, only: deck_t
  use talus_deck_messages, only: messages_t, messages_text
  use talus_deck, only: deck_load_text
  use talus_session, only: session_t
  use talus_run, only: run_prepare
  use talus_setup_conditions, only: setup_conditions
  use talus_initial, only: weight_load
  use talus_audit, only: audit_load
  use talus_relax, only: motion_prepare
  use talus_seepage, only: seepage_shape, seepage_step_limit, face_fluxes
  use talus_soil_step, only: soil_step
  use talus_timer, only: timer_start, timer_stop
  implicit none
  private
  public :: parts_t, parts_one_level, parts_everything, bench_deck, bench_prepare

  !> Parts of the physics.
  type :: parts_t
    logical :: two_levels = .false. !! second level of 3 spacings
    logical :: stabilised = .false.
    logical :: plastic = .false.    !! Drucker-Prager
    logical :: damage = .false.     !! of the plastic strain
    logical :: water = .false.      !! pore pressure follows the soil, seepage at its own step
    logical :: bishop = .false.     !! Bishop's stress in place of net stress
    logical :: audit = .false.      !! all energies after every step
  end type parts_t

  type(parts_t), parameter :: parts_one_level = parts_t(stabilised=.true., plastic=.true.)
  type(parts_t), parameter :: parts_everything = parts_t(two_levels=.true., stabilised=.true., &
    plastic=.true., damage=.true., water=.true.)

  !> Area of the slope's section [m2].
  real(dp), parameter :: section = 375.0_dp
  character, parameter :: nl = new_line('a')

contains

  !> Text of the deck with about so many nodes.
  pure function bench_deck(parts, nodes) result(deck)
    type(parts_t), intent(in) :: parts
    integer, intent(in) :: nodes
    character(:), allocatable :: deck
    character(:), allocatable :: spacing
    real(dp) :: h

    ! Nodes on the outline, of 100 m, have half a cell only.
    h = sqrt(section/real(nodes, dp))
    h = sqrt(section/(real(nodes, dp) - 50.0_dp/h))
    spacing = text_of(h, 7)
    deck = "&run title = 'Speed of TALUS' name = 'bench' /"//nl// &
      "&geometry kind = 'slope' slope_height = 10.0 slope_ratio = 1.0 base_depth = 5.0"//nl// &
      "  toe_distance = 10.0 crest_width = 15.0 /"//nl// &
      "&nodes spacing = "//spacing//" /"//nl//"&smoothing levels = "//merge('2', '1', &
      parts%two_levels)
    if (parts%two_levels) deck = deck//" length = "//text_of(3.001_dp*h, 7)
    if (.not. parts%stabilised) deck = deck//" stabilisation = 0.0"
    deck = deck//" /"//nl//soil_text(parts)
    if (parts%damage) deck = deck//"&damage driver = 'plastic_strain' law = 'exponential'"//nl// &
      "  kappa_0 = 1.0e-5 kappa_f = 0.5 split = 'tensile' /"//nl
    if (parts%water) deck = deck//"&water retention = 'van_genuchten' conductivity_x = 6.0e-6"// &
      nl// &
      "  alpha = 0.3 n = 1.8 saturation_residual = 0.15 specific_storage = 1.0e-7 /"//nl
    deck = deck//"&initial stress = 'k0' lateral_stress_ratio = 0.5"
    if (parts%water) deck = deck//nl//"  pore_pressure = 'hydrostatic' water_table = -2.0"// &
      " suction_limit = 30.0e3"
    deck = deck//" /"//nl//"&boundary name = 'base' where = 'bottom' displacement = 'fixed' /"// &
      nl// &
      "&boundary name = 'left' where = 'left' displacement = 'roller_x' /"//nl// &
      "&boundary name = 'right' where = 'right' displacement = 'roller_x' /"//nl
    if (parts%water) deck = deck// &
      "&boundary name = 'rain' where = 'surface' water = 'rain' rain = 25.0 /"//nl
    deck = deck//"&stage name = 'slide' kind = 'dynamic' solve = '"// &
      trim(merge('both', 'soil', parts%water))//"' duration = 1.0 /"//nl
  end function bench_deck

  !> The soil.
  pure function soil_text(parts) result(deck)
    type(parts_t), intent(in) :: parts
    character(:), allocatable :: deck

    deck = "&soil name = 'silt' porosity = 0.45 youngs_modulus = 20.0e6 poisson_ratio = 0.3"//nl
    if (parts%plastic) deck = deck//"  plasticity = 'drucker_prager' cohesion = 6.5e3"// &
      " friction_angle = 28.0"//nl//"  dilation_angle = 0.0 tension_cutoff = 0.0"//nl
    if (parts%water .and. .not. parts%bishop) then
      deck = deck//"  stress = 'net'"
      if (parts%plastic) deck = deck//" suction_strength = 'phi_b' phi_b = 18.0"
      deck = deck//nl
    end if
    if (parts%bishop) deck = deck//"  stress = 'bishop'"//nl
    deck = deck//"/"//nl
  end function soil_text

  !> A session ready to step, with its state in `last_good` too, and the step that accuracy allows
  !> the water. `warm` soil steps bring soil to yield.
  subroutine bench_prepare(parts, nodes, warm, session, water_step, status)
    type(parts_t), intent(in) :: parts
    integer, intent(in) :: nodes, warm
    type(session_t), intent(inout) :: session
    real(dp), intent(out) :: water_step !! [s]
    type(status_t), intent(inout) :: status
    type(deck_t) :: deck
    type(messages_t) :: messages
    integer :: i, failed

    water_step = huge(1.0_dp)
    call deck_load_text(bench_deck(parts, nodes), 'bench.nml', deck, messages, status)
    if (status_failed(status)) then
      status%message = messages_text(messages)
      return
    end if
    call run_prepare(deck, session, status)
    if (status_failed(status)) return
    call timer_start(session%timer, 'stable_step')
    call setup_conditions(deck, session%disc, deck%stage(1)%name, session%conditions, status)
    if (status_failed(status)) return
    call audit_load(session%disc%n, weight_load(session%ground, session%state%mass, &
                                                session%conditions%traction), session%state)
    session%motion%coupled = parts%water
    call motion_prepare(session%disc, session%ground, session%conditions, session%state, .false., &
                        0.9_dp, session%motion, session%work)
    call timer_stop(session%timer, 'stable_step')
    do i = 1, warm
      call soil_step(session%disc, session%ground, session%motion, session%state, session%work, &
        failed)
    end do
    if (parts%water) then
      call seepage_shape(session%seepage, session%disc, session%ground, session%conditions%inlets, &
                         session%state)
      call face_fluxes(session%seepage, session%disc, session%ground, session%state)
      water_step = seepage_step_limit(session%seepage, session%disc, session%ground, session%state)
    end if
    session%last_good = session%state
  end subroutine bench_prepare
end module talus_bench_model
