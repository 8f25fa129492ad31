! SPDX-License-Identifier: MIT
!> Pore pressure, stress and weight at the start (src/THEORY.md sections 5.3 and 5.4).
module talus_initial
  use talus_kinds, only: dp
  use talus_disc, only: disc_t
  use talus_ground, only: ground_t
  use talus_state, only: state_t
  use talus_nodes, only: mesh_t
  use talus_soil_law, only: stress_net, bishop_factor
  use talus_storage, only: storage_content, storage_invert
  implicit none
  private
  public :: initial_hydrostatic, initial_water, initial_k0, weight_masses, weight_load

  !> Boundary edges sorted into columns, see column_build.
  type :: columns_t
    real(dp) :: left = 0.0_dp, width = 0.0_dp !! [m]
    integer, allocatable :: offset(:)         !! first entry of each column, (columns+1)
    integer, allocatable :: edge(:)           !! columns of mesh%boundary_edge
  end type columns_t

contains

  !> Hydrostatic pore pressure about a straight water table, with the suction limited [Pa], (n).
  pure function initial_hydrostatic(disc, unit_weight, table, suction_limit) result(pressure)
    type(disc_t), intent(in) :: disc
    real(dp), intent(in) :: unit_weight   !! of water [N/m3]
    real(dp), intent(in) :: table(2)      !! elevation at the left and the right end [m]
    real(dp), intent(in) :: suction_limit !! [Pa]; huge() for none
    real(dp) :: pressure(disc%n)
    real(dp) :: left, right

    left = minval(disc%mesh%x(1, :))
    right = maxval(disc%mesh%x(1, :))
    pressure = unit_weight*(table(1) + (table(2) - table(1))*(disc%mesh%x(1, :) - left) &
                            /(right - left) - disc%mesh%x(2, :))
    pressure = max(pressure, -suction_limit)
  end function initial_hydrostatic

  !> Set the pore pressure: stored water, flow properties and the suction that the stress knows.
  subroutine initial_water(disc, ground, pressure, state)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    real(dp), intent(in) :: pressure(:) !! p_w [Pa], (n)
    type(state_t), intent(inout) :: state
    real(dp) :: pore
    integer :: i

    do i = 1, disc%n
      associate (soil => disc%soil(i), jacobian => state%jacobian(i))
        pore = jacobian - 1.0_dp + ground%porosity(soil)
        state%content(i) = storage_content(ground%curve(soil), ground%storage(soil), pore, &
                                           jacobian, pressure(i))
        call storage_invert(ground%curve(soil), ground%storage(soil), pore, jacobian, &
          state%content(i), state%pressure(i), state%saturation(i), state%ratio(i), &
          state%potential(i), state%capacity(i))
        ! The inverse has the round-off of the storage; still water is to stay still.
        state%pressure(i) = pressure(i)
        state%suction(i) = seen_suction(ground, soil, -pressure(i), state%saturation(i))
      end associate
    end do
  end subroutine initial_water

  !> Suction that the stress has seen: s of net stress where it is one, chi s of Bishop's [Pa].
  pure real(dp) function seen_suction(ground, soil, suction, saturation) result(seen)
    type(ground_t), intent(in) :: ground
    integer, intent(in) :: soil
    real(dp), intent(in) :: suction    !! s = -p_w [Pa]
    real(dp), intent(in) :: saturation !! S_r [-]

    if (ground%law(soil)%stress == stress_net) then
      seen = max(suction, 0.0_dp)
    else
      associate (curve => ground%curve(soil))
        seen = suction*bishop_factor(suction, &
                                     (saturation - curve%residual)/(curve%maximum - curve%residual))
      end associate
    end if
  end function seen_suction

  !> Stress from the weight above each node, taken with the node's own unit weight, and a ratio of
  !> horizontal to vertical stress.
  subroutine initial_k0(disc, ground, ratio, state)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    real(dp), intent(in) :: ratio !! [-]
    type(state_t), intent(inout) :: state
    type(columns_t) :: columns
    real(dp) :: vertical, effective
    integer :: i

    call column_build(disc%mesh, columns)
    do i = 1, disc%n
      vertical = -ground%gravity*state%mass(i)/disc%dual%area(i) &
        *(ground_level(disc%mesh, columns, disc%mesh%x(1, i)) - disc%mesh%x(2, i))
      if (ground%wet) then
        associate (curve => ground%curve(disc%soil(i)))
          effective = (state%saturation(i) - curve%residual)/(curve%maximum - curve%residual)
        end associate
        if (ground%law(disc%soil(i))%stress /= stress_net) vertical = vertical &
          + bishop_factor(-state%pressure(i), effective)*state%pressure(i)
      end if
      state%stress(:, i) = [ratio*vertical, vertical, ratio*vertical, 0.0_dp]
    end do
  end subroutine initial_k0

  !> Boundary edges above and below each of as many columns of equal width, so that a node need
  !> look at those of its own column only.
  pure subroutine column_build(mesh, columns)
    type(mesh_t), intent(in) :: mesh
    type(columns_t), intent(out) :: columns
    integer, allocatable :: filled(:)
    integer :: n, k, c, first, last, pass

    n = max(1, size(mesh%boundary_edge, 2))
    columns%left = minval(mesh%x(1, :))
    columns%width = max((maxval(mesh%x(1, :)) - columns%left)/real(n, dp), tiny(1.0_dp))
    allocate (columns%offset(n+1), filled(n))
    do pass = 1, 2
      filled = 0
      do k = 1, size(mesh%boundary_edge, 2)
        associate (x => mesh%x(1, mesh%boundary_edge(:, k)))
          first = column_at(columns, minval(x))
          last = column_at(columns, maxval(x))
        end associate
        do c = first, last
          if (pass == 2) columns%edge(columns%offset(c) + filled(c)) = k
          filled(c) = filled(c) + 1
        end do
      end do
      if (pass == 2) exit
      columns%offset(1) = 1
      do c = 1, n
        columns%offset(c+1) = columns%offset(c) + filled(c)
      end do
      allocate (columns%edge(columns%offset(n+1)-1))
    end do
  end subroutine column_build

  !> Column that holds x. It never falls as x grows, so an edge lies in the columns of its ends and
  !> all between them.
  pure integer function column_at(columns, x) result(c)
    type(columns_t), intent(in) :: columns
    real(dp), intent(in) :: x !! [m]

    c = 1 + int((x - columns%left)/columns%width)
    c = min(max(c, 1), size(columns%offset) - 1)
  end function column_at

  !> Elevation of the ground surface at x [m].
  pure real(dp) function ground_level(mesh, columns, x) result(level)
    type(mesh_t), intent(in) :: mesh
    type(columns_t), intent(in) :: columns
    real(dp), intent(in) :: x !! [m]
    real(dp) :: a(2), b(2)
    integer :: k, c

    level = -huge(level)
    c = column_at(columns, x)
    do k = columns%offset(c), columns%offset(c+1) - 1
      a = mesh%x(:, mesh%boundary_edge(1, columns%edge(k)))
      b = mesh%x(:, mesh%boundary_edge(2, columns%edge(k)))
      if (x < min(a(1), b(1)) .or. x > max(a(1), b(1))) cycle
      if (abs(b(1) - a(1)) > 0.0_dp) then
        level = max(level, a(2) + (b(2) - a(2))*(x - a(1))/(b(1) - a(1)))
      else
        level = max(level, a(2), b(2))
      end if
    end do
  end function ground_level

  !> Nodal masses with the water they hold now: rain makes soil heavier [kg/m].
  subroutine weight_masses(disc, ground, state)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(state_t), intent(inout) :: state
    integer :: i

    do i = 1, disc%n
      associate (soil => disc%soil(i))
        state%mass(i) = (1.0_dp - ground%porosity(soil))*ground%density_solid(soil)
        if (ground%wet) state%mass(i) = state%mass(i) + ground%water_density*state%content(i)
      end associate
      state%mass(i) = state%mass(i)*disc%dual%area(i)
    end do
  end subroutine weight_masses

  !> Weight and tractions [N/m], (2,n).
  pure function weight_load(ground, mass, traction) result(load)
    type(ground_t), intent(in) :: ground
    real(dp), intent(in) :: mass(:)       !! [kg/m], (n)
    real(dp), intent(in) :: traction(:,:) !! [N/m], (2,n)
    real(dp) :: load(2, size(mass))

    load = traction
    load(2, :) = load(2, :) - ground%gravity*mass
  end function weight_load
end module talus_initial
