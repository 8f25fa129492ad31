! SPDX-License-Identifier: MIT
!> Nodal fields as they are reported, derived from the state.
module talus_fields
  use talus_kinds, only: dp
  use talus_disc, only: disc_t
  use talus_ground, only: ground_t
  use talus_state, only: state_t
  use talus_damage, only: damage_part
  use talus_soil_law, only: history_damage, stress_bishop, bishop_subtract
  use talus_objective, only: piola_stress, cauchy_stress
  use talus_stretch, only: stretch_of, stretch_piola
  use talus_strain, only: strain_first, strain_gradient, per_area
  use talus_smooth, only: smooth_gradient, smooth_stress
  implicit none
  private
  public :: field_total_stress, field_acting_stress, field_strain, field_porosity

contains

  !> Total Cauchy stress [Pa], damaged and with pore pressure, (4,n).
  function field_total_stress(disc, ground, state) result(stress)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(state_t), intent(in) :: state
    real(dp) :: stress(4, disc%n)
    real(dp) :: part(4), effective
    integer :: i

    stress = state%stress
    do i = 1, disc%n
      associate (law => ground%law(disc%soil(i)))
        if (law%damage%driver /= 0) then
          call damage_part(law%damage%split, state%stress(:, i), part)
          stress(:, i) = stress(:, i) - state%history(history_damage, i)*part
        end if
        if (law%stress /= stress_bishop) cycle
        associate (curve => ground%curve(disc%soil(i)))
          effective = (state%saturation(i) - curve%residual)/(curve%maximum - curve%residual)
        end associate
        call bishop_subtract(-state%pressure(i), effective, stress(:, i))
      end associate
    end do
  end function field_total_stress

  !> Total Cauchy stress that the nodes feel where stress sees the second level [Pa], (4,n): the
  !> adjoint mean of the stress around, and what ties the levels (src/THEORY.md (4.8), (4.10),
  !> (4.10b)). Across the plane the tie has the stress of elastic soil. What the pairs of the
  !> stabilisation bear is left out.
  function field_acting_stress(disc, ground, state) result(acting)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(state_t), intent(in) :: state
    real(dp) :: acting(4, disc%n)
    real(dp), allocatable :: q(:,:), across(:,:), r(:,:), out(:,:), h(:,:)
    real(dp) :: f(4), piola(4), stretch(6), tie(4), det
    integer :: i

    allocate (q(4, disc%n), across(4, disc%n), r(4, disc%n), out(4, disc%n), h(4, disc%n))
    acting = field_total_stress(disc, ground, state)
    across = 0.0_dp
    call strain_first(disc%scni, state%u, h)
    call per_area(disc%dual%area, h)
    do i = 1, disc%n
      f = state%f(:, i)
      call piola_stress(f, acting(:, i), piola)
      q(:, i) = disc%dual%area(i)*piola
      if (disc%stabilised) q(:, i) = q(:, i) - levels(i, h(:, i))
      across(1, i) = disc%dual%area(i)*(f(1)*f(4) - f(2)*f(3))*acting(3, i)
    end do
    call smooth_stress(disc%two_level, q, .false., q, r)
    call smooth_stress(disc%two_level, across, .false., across, out)
    do i = 1, disc%n
      f = h(:, i) + [1.0_dp, 0.0_dp, 0.0_dp, 1.0_dp]
      det = f(1)*f(4) - f(2)*f(3)
      if (disc%stabilised) r(:, i) = r(:, i) + levels(i, h(:, i))/disc%dual%area(i)
      acting(:, i) = cauchy_stress(f, r(:, i))
      acting(3, i) = out(1, i)/det
      if (.not. disc%tied) cycle
      call stretch_of(h(:, i), stretch)
      call stretch_piola(stretch, state%tied(1:3, i), piola)
      tie = cauchy_stress(f, piola)
      tie(3) = ground%law(disc%soil(i))%elastic%poisson_ratio*(tie(1) + tie(2))
      acting(:, i) = acting(:, i) + tie
    end do

  contains

    !> Area times Piola stress between the levels at node i, by the gradient of the first (4.10).
    pure function levels(i, first) result(apart)
      integer, intent(in) :: i
      real(dp), intent(in) :: first(4)
      real(dp) :: apart(4)

      apart = disc%stabilise%level(i)*(first + [1.0_dp, 0.0_dp, 0.0_dp, 1.0_dp] - state%f(:, i))
      if (disc%tied) then
        apart = apart*state%between(i)
      else
        apart = apart*state%stiffness(i)
      end if
    end function levels
  end function field_acting_stress

  !> Green-Lagrange strain of the motion since displacements were last set to zero: xx, yy, zz, xy.
  function field_strain(disc, state) result(strain)
    type(disc_t), intent(in) :: disc
    type(state_t), intent(in) :: state
    real(dp) :: strain(4, disc%n)
    real(dp), allocatable :: now(:,:), zero(:,:)
    real(dp) :: f0(4), f(4), det
    integer :: i

    now = gradient(disc, state%u)
    zero = gradient(disc, state%u_zero)
    do i = 1, disc%n
      f0 = zero(:, i) + [1.0_dp, 0.0_dp, 0.0_dp, 1.0_dp]
      f = now(:, i) + [1.0_dp, 0.0_dp, 0.0_dp, 1.0_dp]
      det = f0(1)*f0(4) - f0(2)*f0(3)
      f = [f(1)*f0(4) - f(2)*f0(3), f(2)*f0(1) - f(1)*f0(2), &
           f(3)*f0(4) - f(4)*f0(3), f(4)*f0(1) - f(3)*f0(2)]/det
      strain(:, i) = 0.5_dp*[f(1)**2 + f(3)**2 - 1.0_dp, f(2)**2 + f(4)**2 - 1.0_dp, 0.0_dp, &
                             f(1)*f(2) + f(3)*f(4)]
    end do
  end function field_strain

  !> Displacement gradient that the stress sees, (4,n).
  function gradient(disc, u) result(h)
    type(disc_t), intent(in) :: disc
    real(dp), contiguous, intent(in) :: u(:,:)
    real(dp), allocatable :: h(:,:)
    real(dp), allocatable :: y(:,:)

    allocate (y(4, disc%n), h(4, disc%n))
    if (disc%two_levels .and. .not. disc%damage_only) then
      call strain_first(disc%scni, u, y)
      call smooth_gradient(disc%two_level, y, h)
    else
      call strain_gradient(disc%scni, disc%dual%area, u, h)
    end if
  end function gradient

  !> Porosity n = 1 - (1 - n0)/J, (n).
  function field_porosity(disc, ground, state) result(porosity)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(state_t), intent(in) :: state
    real(dp) :: porosity(disc%n)
    integer :: i

    do i = 1, disc%n
      porosity(i) = 1.0_dp - (1.0_dp - ground%porosity(disc%soil(i))) &
        /(state%f(1, i)*state%f(4, i) - state%f(2, i)*state%f(3, i))
    end do
  end function field_porosity
end module talus_fields
