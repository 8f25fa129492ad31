! SPDX-License-Identifier: MIT
!> Small models for the suites: a square of soil with everything a step needs.
module models
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_failed
  use talus_nodes, only: mesh_t
  use talus_mesh_box, only: mesh_box
  use talus_mesh_perturb, only: mesh_perturb
  use talus_dual_cells, only: dual_build, dual_spacing
  use talus_scni, only: scni_build, scni_transpose
  use talus_two_level, only: two_level_build, weights_symmetric
  use talus_stabilise, only: stabilise_build
  use talus_tie, only: tie_build
  use talus_disc, only: disc_t
  use talus_ground, only: ground_t
  use talus_soil_law, only: soil_law_prepare
  use talus_retention, only: retention_t
  use talus_water_curve_make, only: water_curve_make
  use talus_state, only: state_t, state_allocate
  use talus_conditions, only: conditions_t, conditions_allocate
  use talus_initial, only: initial_water, weight_masses
  use talus_soil_step, only: work_t, motion_t, work_allocate
  use talus_inertia, only: inertia_pairs
  use talus_boundary_sets, only: boundary_set_t, boundary_set_build
  implicit none
  private
  public :: square_t, model_t, square_disc, ground_elastic, ground_wet, ground_prepare, model_build
  public :: model_set, is_boundary, mesh_area, noise

  !> A square with its lower left corner at the origin.
  type :: square_t
    integer :: nodes = 9                    !! along a side
    real(dp) :: side = 1.0_dp               !! [m]
    real(dp) :: perturbation = 0.0_dp       !! of inner nodes, over spacing
    logical :: slide = .false.              !! boundary nodes move along the sides too
    real(dp) :: smoothing = 0.0_dp          !! ell over spacing; 0 for one level
    integer :: weights = weights_symmetric
    logical :: damage_only = .false.
    real(dp) :: stabilisation = 0.05_dp     !! 0 for none
    real(dp) :: level_stiffness = 0.025_dp  !! between the levels
    logical :: smoothed = .false.           !! elastic strain too
    real(dp) :: support = 1.6_dp            !! kernel support radius over spacing
    logical :: consistent = .false.         !! mass is consistent with the strain
    real(dp) :: layer = huge(1.0_dp)        !! soil 2 is above this elevation [m]
  end type square_t

  type :: model_t
    type(disc_t) :: disc
    type(ground_t) :: ground
    type(state_t) :: state
    type(conditions_t) :: conditions
    type(motion_t) :: motion
    type(work_t) :: work
  end type model_t

contains

  !> Nodes, cells and operators.
  subroutine square_disc(square, ground, disc)
    type(square_t), intent(in) :: square
    type(ground_t), intent(in) :: ground
    type(disc_t), intent(out) :: disc
    type(status_t) :: status
    real(dp), allocatable :: support(:), modulus(:), poisson(:)
    real(dp) :: spacing

    spacing = square%side/real(square%nodes - 1, dp)
    call mesh_box(disc%mesh, square%side, square%side, spacing, 0.0_dp, 1.0_dp, 1.0_dp, &
                  [0.0_dp, 0.0_dp], status)
    call mesh_perturb(disc%mesh, square%perturbation, 3, square%slide)
    disc%n = size(disc%mesh%x, 2)
    allocate (disc%soil(disc%n))
    disc%soil = merge(2, 1, disc%mesh%x(2, :) > square%layer)
    call dual_build(disc%dual, disc%mesh, status)
    support = square%support*dual_spacing(disc%dual, disc%mesh)
    call scni_build(disc%scni, disc%mesh, disc%dual, support, status)
    call scni_transpose(disc%scni)
    disc%two_levels = square%smoothing > 0.0_dp
    disc%damage_only = square%damage_only
    if (disc%two_levels) call two_level_build(disc%two_level, disc%mesh%x, disc%dual%area, &
      disc%soil, square%smoothing*spacing, square%weights, status)
    disc%stabilised = square%stabilisation > 0.0_dp
    disc%floor = 0.02_dp
    modulus = ground%law(disc%soil)%elastic%youngs_modulus
    if (disc%stabilised) call stabilise_build(disc%stabilise, disc%mesh%x, disc%dual, modulus, &
      square%stabilisation, disc%two_levels .and. .not. disc%damage_only, square%level_stiffness)
    disc%tied = disc%stabilised .and. disc%two_levels .and. .not. disc%damage_only &
      .and. square%weights == weights_symmetric .and. .not. square%smoothed
    poisson = ground%law(disc%soil)%elastic%poisson_ratio
    if (disc%tied) call tie_build(disc%tie, modulus, poisson)
    if (status_failed(status)) error stop 'square_disc failed'
  end subroutine square_disc

  !> Dry elastic soils, all alike, without gravity.
  subroutine ground_elastic(ground, modulus, poisson, density, soils)
    type(ground_t), intent(out) :: ground
    real(dp), intent(in) :: modulus !! Young's [Pa]
    real(dp), intent(in) :: poisson !! ratio [-]
    real(dp), intent(in) :: density !! [kg/m3]
    integer, intent(in) :: soils    !! how many

    ground%unit_weight = 9810.0_dp
    ground%water_density = 1000.0_dp
    allocate (ground%name(soils), ground%law(soils), ground%density_solid(soils))
    allocate (ground%porosity(soils))
    ground%name = 'soil'
    ground%law%elastic%youngs_modulus = modulus
    ground%law%elastic%poisson_ratio = poisson
    ground%density_solid = density
    ground%porosity = 0.0_dp
    call ground_prepare(ground)
  end subroutine ground_elastic

  !> Let water into a ground: porosity 0.4, the same retention and conductivity in all soils.
  subroutine ground_wet(ground, retention, conductivity, storage)
    type(ground_t), intent(inout) :: ground
    type(retention_t), intent(in) :: retention
    real(dp), intent(in) :: conductivity(2) !! saturated, along x and y [m/s]
    real(dp), intent(in) :: storage         !! S_s [1/Pa]
    type(status_t) :: status
    integer :: i, soils

    soils = size(ground%law)
    ground%wet = .true.
    ground%porosity = 0.4_dp
    allocate (ground%curve(soils), ground%storage(soils), ground%kozeny_carman(soils))
    ground%conductivity = spread(conductivity, 2, soils)
    ground%storage = storage
    ground%kozeny_carman = .false.
    do i = 1, soils
      call water_curve_make(retention, ground%curve(i), status)
    end do
    if (status_failed(status)) error stop 'ground_wet failed'
  end subroutine ground_wet

  !> Derive the constants of all laws, after a change of their parameters.
  subroutine ground_prepare(ground)
    type(ground_t), intent(inout) :: ground
    type(status_t) :: status
    integer :: i

    do i = 1, size(ground%law)
      call soil_law_prepare(ground%law(i), status)
    end do
    if (status_failed(status)) error stop 'ground_prepare failed'
  end subroutine ground_prepare

  !> Everything, at rest, without supports and loads. Wet soil starts saturated at zero pressure.
  subroutine model_build(model, square, ground)
    type(model_t), intent(out) :: model
    type(square_t), intent(in) :: square
    type(ground_t), intent(in) :: ground

    model%ground = ground
    model%ground%law%own_strain = .not. square%damage_only
    call square_disc(square, ground, model%disc)
    call state_allocate(model%state, model%disc, model%ground, .true.)
    if (ground%wet) call initial_water(model%disc, model%ground, &
      spread(0.0_dp, 1, model%disc%n), model%state)
    call weight_masses(model%disc, model%ground, model%state)
    call conditions_allocate(model%conditions, model%disc%n)
    call work_allocate(model%work, model%disc)
    model%motion%mobility = 1.0_dp/spread(model%state%mass, 1, 2)
    model%motion%consistent = square%consistent
    if (square%consistent) model%motion%pair_mass = inertia_pairs(model%disc%dual, &
      model%disc%mesh%x, model%state%mass)
  end subroutine model_build

  !> A named part of the boundary.
  function model_set(disc, where) result(set)
    type(disc_t), intent(in) :: disc
    character(*), intent(in) :: where
    type(boundary_set_t) :: set
    type(status_t) :: status

    call boundary_set_build(set, disc%mesh, disc%dual, where, spread(0.0_dp, 1, 4), status)
    if (status_failed(status)) error stop 'model_set failed'
  end function model_set

  !> Which nodes lie on the boundary.
  function is_boundary(disc) result(outer)
    type(disc_t), intent(in) :: disc
    logical :: outer(disc%n)

    outer = .false.
    outer(disc%mesh%boundary_edge(1, :)) = .true.
  end function is_boundary

  !> Area inside the boundary [m2], by the boundary edges alone.
  pure real(dp) function mesh_area(mesh) result(area)
    type(mesh_t), intent(in) :: mesh
    real(dp) :: a(2), b(2)
    integer :: i

    area = 0.0_dp
    do i = 1, size(mesh%boundary_edge, 2)
      a = mesh%x(:, mesh%boundary_edge(1, i)) - mesh%x(:, 1)
      b = mesh%x(:, mesh%boundary_edge(2, i)) - mesh%x(:, 1)
      area = area + 0.5_dp*(a(1)*b(2) - a(2)*b(1))
    end do
  end function mesh_area

  !> Reproducible values between -1/2 and 1/2 without a pattern.
  pure function noise(rows, columns) result(values)
    integer, intent(in) :: rows, columns
    real(dp) :: values(rows, columns)
    real(dp) :: x
    integer :: i, j

    do j = 1, columns
      do i = 1, rows
        x = 43758.5453_dp*sin(12.9898_dp*real(i, dp) + 78.233_dp*real(j, dp))
        values(i, j) = x - real(floor(x), dp) - 0.5_dp
      end do
    end do
  end function noise
end module models
