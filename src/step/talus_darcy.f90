! SPDX-License-Identifier: MIT
!> Darcy fluxes between the nodal cells in their present shape (src/THEORY.md (4.12)-(4.15)): what
!> explicit, implicit and steady seepage share. Each face carries one flux that leaves one cell and
!> enters the other, so water is conserved to round-off.
module talus_darcy
  use talus_kinds, only: dp
  use talus_disc, only: disc_t
  use talus_dual_cells, only: dual_t
  use talus_ground, only: ground_t
  use talus_state, only: state_t
  use talus_conditions, only: inlets_t, inlets_catch, inlet_head, inlet_rain, inlet_seepage
  use talus_flux, only: flux_t, flux_build
  use talus_face_flow, only: face_drive, face_mean
  use talus_permeability, only: permeability_kozeny_carman
  use talus_water_curve, only: curve_at_pressure
  use talus_head_slope, only: head_slope
  implicit none
  private
  public :: seepage_t, seepage_shape, seepage_hold, face_fluxes, face_two_point, face_oblique
  public :: oblique_mean, cell_outflow, seepage_step_limit, seepage_velocity

  !> Geometry of the seepage in the present shape, and fields of a sub-step.
  type :: seepage_t
    type(flux_t) :: flux
    real(dp), allocatable :: tensor(:,:)   !! J F^-1 k_sat F^-T: xx, yy, xy [m/s], (3,n)
    real(dp), allocatable :: height(:)     !! present elevation [m], (n)
    real(dp), allocatable :: catch(:)      !! length of each inlet [m]
    real(dp), allocatable :: q(:)          !! flux through each face, first to second [m2/s]
    real(dp), allocatable :: q_before(:)   !! the same before the sub-step [m2/s]
    real(dp), allocatable :: content_before(:) !! water content then [m3/m2], (n)
    real(dp), allocatable :: peclet(:)     !! of each face
    real(dp), allocatable :: head(:,:)     !! total head [m], (2,n); second row unused zeros
    real(dp), allocatable :: slope(:,:)    !! area times gradient of head [m2], (4,n)
    logical, allocatable :: held(:)        !! the boundary holds the pressure of the node, (n)
    logical :: explicit_only = .false.     !! never an implicit step
    real(dp) :: safety = 0.95_dp           !! explicit step over its limit
    real(dp) :: stride = 0.0_dp            !! step that accuracy allows, 0 while unknown [s]
    real(dp) :: last = 0.0_dp              !! last explicit step, 0 for none [s]
  end type seepage_t

contains

  !> Take the present shape of the soil.
  subroutine seepage_shape(seepage, disc, ground, inlets, state)
    type(seepage_t), intent(inout) :: seepage
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(inlets_t), intent(in) :: inlets
    type(state_t), intent(in) :: state
    real(dp) :: k(2), jacobian
    integer :: i, soil

    if (.not. allocated(seepage%tensor)) then
      allocate (seepage%tensor(3, disc%n), seepage%height(disc%n))
      allocate (seepage%held(disc%n))
      allocate (seepage%q(size(disc%dual%edge_node, 2)))
      allocate (seepage%peclet(size(disc%dual%edge_node, 2)))
    end if
    !$omp parallel do default(none) shared(seepage, disc, ground, state) &
    !$omp private(i, soil, k, jacobian) schedule(static)
    do i = 1, disc%n
      soil = disc%soil(i)
      jacobian = state%jacobian(i)
      k = present_conductivity(ground, soil, jacobian)
      associate (f => state%f(:, i))
        ! F^-1 = [f22, -f12; -f21, f11]/J.
        seepage%tensor(1, i) = (k(1)*f(4)**2 + k(2)*f(2)**2)/jacobian
        seepage%tensor(2, i) = (k(1)*f(3)**2 + k(2)*f(1)**2)/jacobian
        seepage%tensor(3, i) = -(k(1)*f(3)*f(4) + k(2)*f(1)*f(2))/jacobian
      end associate
      seepage%height(i) = disc%mesh%x(2, i) + state%u(2, i)
    end do
    !$omp end parallel do
    call flux_build(seepage%flux, disc%mesh%x, disc%dual, seepage%tensor)
    if (seepage%flux%oblique .and. .not. allocated(seepage%head)) then
      allocate (seepage%head(2, disc%n), seepage%slope(4, disc%n))
      seepage%head = 0.0_dp
    end if
    if (allocated(seepage%catch)) deallocate (seepage%catch)
    allocate (seepage%catch(size(inlets%node)))
    call inlets_catch(inlets, disc, state%u, seepage%catch)
    call seepage_hold(seepage, inlets, state%pressure)
  end subroutine seepage_shape

  !> Find the nodes whose pressure the boundary holds: heads, and ponds and seepage faces at their
  !> limit.
  pure subroutine seepage_hold(seepage, inlets, pressure)
    type(seepage_t), intent(inout) :: seepage
    type(inlets_t), intent(in) :: inlets
    real(dp), intent(in) :: pressure(:) !! p_w [Pa], (n)
    real(dp), parameter :: near = 1.0e-3_dp
    integer :: k

    seepage%held = .false.
    do k = 1, size(inlets%node)
      associate (i => inlets%node(k))
        if (inlets%kind(k) == inlet_head) seepage%held(i) = .true.
        if (inlets%kind(k) == inlet_rain .or. inlets%kind(k) == inlet_seepage) &
          seepage%held(i) = pressure(i) >= inlets%value(k) - near
      end associate
    end do
  end subroutine seepage_hold

  !> Net flux out of a cell [m2/s].
  pure real(dp) function cell_outflow(dual, q, i) result(outflow)
    type(dual_t), intent(in) :: dual
    real(dp), contiguous, intent(in) :: q(:)
    integer, intent(in) :: i
    integer :: k

    outflow = 0.0_dp
    do k = dual%node_offset(i), dual%node_offset(i+1) - 1
      outflow = outflow + dual%node_sign(k)*q(dual%node_edge(k))
    end do
  end function cell_outflow

  !> Flux through every face in the present state.
  subroutine face_fluxes(seepage, disc, ground, state)
    type(seepage_t), intent(inout) :: seepage
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(state_t), intent(in) :: state
    integer :: e, i

    !$omp parallel default(none) shared(seepage, disc, ground, state) private(e, i)
    if (seepage%flux%oblique) then
      !$omp do schedule(static)
      do i = 1, disc%n
        seepage%head(1, i) = state%pressure(i)/ground%unit_weight + seepage%height(i)
      end do
      !$omp end do
      call head_slope(disc, size(ground%law) > 1, seepage%head, seepage%slope)
    end if
    !$omp do schedule(static)
    do e = 1, size(seepage%q)
      call face_flux(seepage, disc, ground, state, e, seepage%q(e), seepage%peclet(e))
    end do
    !$omp end do
    !$omp end parallel
  end subroutine face_fluxes

  !> Flux through one face.
  pure subroutine face_flux(seepage, disc, ground, state, e, q, peclet)
    type(seepage_t), intent(in) :: seepage
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(state_t), intent(in) :: state
    integer, intent(in) :: e
    real(dp), intent(out) :: q, peclet
    integer :: i, j

    i = disc%dual%edge_node(1, e)
    j = disc%dual%edge_node(2, e)
    call face_two_point(seepage, disc, ground, e, [state%pressure(i), state%pressure(j)], &
      [state%potential(i), state%potential(j)], [state%ratio(i), state%ratio(j)], q, peclet)
    if (seepage%flux%oblique) q = q + face_oblique(seepage, disc, e, state%ratio, seepage%slope)
  end subroutine face_flux

  !> The part of a face's flux on a distorted grid that follows the smoothed gradient of head.
  !> It fades where the conductivity changes much between the two nodes: there the two-point flux,
  !> which knows no over- and undershoot, stands alone.
  pure real(dp) function face_oblique(seepage, disc, e, ratio, slope) result(q)
    type(seepage_t), intent(in) :: seepage
    type(disc_t), intent(in) :: disc
    integer, intent(in) :: e
    real(dp), intent(in) :: ratio(:)   !! k_r, (n)
    real(dp), intent(in) :: slope(:,:) !! area times gradient of head [m2], (4,n)
    real(dp) :: gradient(2)

    associate (i => disc%dual%edge_node(1, e), j => disc%dual%edge_node(2, e), &
               share => seepage%flux%share(:, e))
      gradient = 0.5_dp*(slope(1:2, i)/disc%dual%area(i) + slope(1:2, j)/disc%dual%area(j))
      q = -oblique_mean(share, [ratio(i), ratio(j)])*dot_product(gradient, seepage%flux%rest(:, e))
    end associate
  end function face_oblique

  !> Conductivity of two halves of an edge in series, times 4 k1 k2/(k1 + k2)^2.
  pure real(dp) function oblique_mean(share, k) result(mean)
    real(dp), intent(in) :: share(2) !! of each half in the resistance at equal conductivity
    real(dp), intent(in) :: k(2)     !! relative conductivities [-]

    mean = k(1)*k(2)/(share(1)*k(2) + share(2)*k(1))*4.0_dp*k(1)*k(2)/(k(1) + k(2))**2
  end function oblique_mean

  !> The part of a face's flux that the two nodes beside it decide.
  pure subroutine face_two_point(seepage, disc, ground, e, p, phi, k, q, peclet)
    type(seepage_t), intent(in) :: seepage
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    integer, intent(in) :: e
    real(dp), intent(in) :: p(2)    !! pore pressures [Pa]
    real(dp), intent(in) :: phi(2)  !! matric flux potentials [Pa]
    real(dp), intent(in) :: k(2)    !! relative conductivities [-]
    real(dp), intent(out) :: q      !! first to second [m2/s]
    real(dp), intent(out) :: peclet !! [-]
    real(dp) :: drop, drive
    integer :: i, j

    i = disc%dual%edge_node(1, e)
    j = disc%dual%edge_node(2, e)
    drop = ground%unit_weight*(seepage%height(j) - seepage%height(i))
    if (disc%soil(i) == disc%soil(j)) then
      call face_drive(p(1), p(2), phi(1), phi(2), k(1), k(2), drop, drive, peclet)
    else
      call layered_drive(ground, disc%soil(i), disc%soil(j), p(1), p(2), seepage%flux%share(:, e), &
        drop, drive)
      peclet = 1.0_dp
    end if
    q = -seepage%flux%along(e)*drive/ground%unit_weight
  end subroutine face_two_point

  !> Between two soils: each half of the edge has its own soil's mean conductivity, and the halves
  !> are resistances in series.
  pure subroutine layered_drive(ground, soil_i, soil_j, p_i, p_j, share, drop, drive)
    type(ground_t), intent(in) :: ground
    integer, intent(in) :: soil_i, soil_j
    real(dp), intent(in) :: p_i, p_j, share(2), drop
    real(dp), intent(out) :: drive
    real(dp) :: k(2), mean

    k(1) = own_mean(ground, soil_i, p_i, p_j)
    k(2) = own_mean(ground, soil_j, p_i, p_j)
    mean = 1.0_dp/(share(1)/k(1) + share(2)/k(2))
    drive = mean*((p_j - p_i) + drop)
  end subroutine layered_drive

  !> Mean conductivity of one soil between two pressures.
  pure real(dp) function own_mean(ground, soil, p_i, p_j) result(mean)
    type(ground_t), intent(in) :: ground
    integer, intent(in) :: soil
    real(dp), intent(in) :: p_i, p_j
    real(dp) :: saturation, k(2), potential(2), capacity

    call curve_at_pressure(ground%curve(soil), p_i, saturation, k(1), potential(1), capacity)
    call curve_at_pressure(ground%curve(soil), p_j, saturation, k(2), potential(2), capacity)
    mean = face_mean(p_i, p_j, potential(1), potential(2), k(1), k(2))
  end function own_mean

  !> Longest step that keeps every cell's own pressure from overshooting its neighbours' [s]: the
  !> stability limit of explicit diffusion, from the fluxes just found. Held nodes do not count.
  real(dp) function seepage_step_limit(seepage, disc, ground, state) result(step)
    type(seepage_t), intent(in) :: seepage
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(state_t), intent(in) :: state
    real(dp) :: fastest, around, k_face
    integer :: i, k, e, j

    fastest = tiny(1.0_dp)
    !$omp parallel do default(none) shared(seepage, disc, ground, state) &
    !$omp private(i, k, e, j, around, k_face) reduction(max:fastest) schedule(static)
    do i = 1, disc%n
      if (seepage%held(i)) cycle
      around = 0.0_dp
      do k = disc%dual%node_offset(i), disc%dual%node_offset(i+1) - 1
        e = disc%dual%node_edge(k)
        j = disc%dual%node_neighbour(k)
        k_face = state%ratio(i)
        if (disc%soil(i) /= disc%soil(j)) k_face = max(k_face, state%ratio(j))
        around = around + seepage%flux%along(e)*k_face*(1.0_dp + seepage%peclet(e))
      end do
      fastest = max(fastest, around/(ground%unit_weight*disc%dual%area(i)*state%capacity(i)))
    end do
    !$omp end parallel do
    step = 1.0_dp/fastest
  end function seepage_step_limit

  !> Saturated conductivity along x and y at the present porosity [m/s].
  pure function present_conductivity(ground, soil, jacobian) result(k)
    type(ground_t), intent(in) :: ground
    integer, intent(in) :: soil
    real(dp), intent(in) :: jacobian !! J [-]
    real(dp) :: k(2)

    k = ground%conductivity(:, soil)
    if (ground%kozeny_carman(soil)) k = k*permeability_kozeny_carman( &
      1.0_dp - (1.0_dp - ground%porosity(soil))/jacobian, ground%porosity(soil))
  end function present_conductivity

  !> Darcy velocity at the nodes [m/s], for output.
  subroutine seepage_velocity(disc, ground, state, velocity)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(state_t), intent(in) :: state
    real(dp), intent(out) :: velocity(:,:) !! (2,n)
    real(dp), allocatable :: head(:,:), slope(:,:)
    real(dp) :: gradient(2), k(2)
    integer :: i

    allocate (head(2, disc%n), slope(4, disc%n))
    head(1, :) = state%pressure/ground%unit_weight + disc%mesh%x(2, :) + state%u(2, :)
    head(2, :) = 0.0_dp
    call head_slope(disc, size(ground%law) > 1, head, slope)
    do i = 1, disc%n
      associate (f => state%f(:, i), g => slope(1:2, i)/disc%dual%area(i))
        ! Present gradient F^-T grad.
        gradient = [f(4)*g(1) - f(3)*g(2), f(1)*g(2) - f(2)*g(1)]/state%jacobian(i)
      end associate
      k = present_conductivity(ground, disc%soil(i), state%jacobian(i))
      velocity(:, i) = -state%ratio(i)*k*gradient
    end do
  end subroutine seepage_velocity
end module talus_darcy
