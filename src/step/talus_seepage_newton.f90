! SPDX-License-Identifier: MIT
!> Implicit seepage on the storage form (src/THEORY.md section 5.5): find pressures p so that
!>
!>   A (w(p) - w_old) rate + net outflow of the faces(p) - supply of the boundary = 0
!>
!> in every cell, by Newton's method with a line search and LAPACK's band solver; rate = 1/step, or 0
!> for the steady state. The Jacobian is differenced from the two-point fluxes; the oblique part of a
!> distorted grid is in the residual alone. Ponds and seepage faces are inequalities (p <= limit, and
!> no more inflow than is supplied), kept by an active set: a node is held at its limit while that
!> takes less than its supply (Hintermueller, Ito & Kunisch 2002).
module talus_seepage_newton
  use talus_kinds, only: dp
  use talus_disc, only: disc_t
  use talus_ground, only: ground_t
  use talus_state, only: state_t
  use talus_conditions, only: inlets_t, inlet_head, inlet_rain, inlet_seepage
  use talus_water_curve, only: curve_at_pressure
  use talus_darcy, only: seepage_t, face_fluxes, face_two_point, cell_outflow
  implicit none
  private
  public :: newton_t, newton_prepare, newton_solve, newton_cost

  type :: newton_t
    integer :: band = 0                     !! greatest difference of two neighbours' numbers
    real(dp), allocatable :: matrix(:,:)    !! in LAPACK's band storage, (3 band + 1, n)
    integer, allocatable :: pivot(:)        !! (n)
    real(dp), allocatable :: residual(:)    !! [m2/s], (n)
    real(dp), allocatable :: change(:,:)    !! Newton's change of pressure [Pa], (n,1)
    real(dp), allocatable :: pressure(:)    !! before a line search [Pa], (n)
    real(dp), allocatable :: probe(:,:)     !! step of differencing, potential and k there, (3,n)
    real(dp), allocatable :: slope(:,:)     !! dq/dp at both ends of a face [m2/(s Pa)], (2,ne)
  end type newton_t

  !> Pressure below which a change is judged absolutely [Pa].
  real(dp), parameter :: pressure_scale = 100.0_dp
  !> Step of differencing relative to the pressure.
  real(dp), parameter :: difference = 1.0e-7_dp
  !> Iterations after which a pond or seepage face is not released again.
  integer, parameter :: patience = 12

  interface
    subroutine dgbsv(n, kl, ku, nrhs, ab, ldab, ipiv, b, ldb, info)
      import :: dp
      integer, intent(in) :: n, kl, ku, nrhs, ldab, ldb
      real(dp), intent(inout) :: ab(ldab,*), b(ldb,*)
      integer, intent(out) :: ipiv(*), info
    end subroutine dgbsv
  end interface

contains

  !> Band and work space of a discretisation.
  subroutine newton_prepare(newton, disc)
    type(newton_t), intent(inout) :: newton
    type(disc_t), intent(in) :: disc

    if (allocated(newton%matrix)) return
    newton%band = maxval(abs(disc%dual%edge_node(2, :) - disc%dual%edge_node(1, :)))
    allocate (newton%matrix(3*newton%band + 1, disc%n), newton%pivot(disc%n), &
      newton%residual(disc%n), newton%change(disc%n, 1), newton%pressure(disc%n), &
      newton%probe(3, disc%n), newton%slope(2, size(disc%dual%edge_node, 2)))
  end subroutine newton_prepare

  !> Explicit steps that take as long as one implicit step: four iterations of assembly and of a band
  !> factorisation with row exchanges, measured against an explicit step of the same nodes.
  pure real(dp) function newton_cost(disc) result(steps)
    type(disc_t), intent(in) :: disc
    real(dp) :: band

    band = real(maxval(abs(disc%dual%edge_node(2, :) - disc%dual%edge_node(1, :))), dp)
    steps = 4.0_dp*(4.0_dp + 0.03_dp*band**2)
  end function newton_cost

  !> Solve for the pressures; the content of `state` is w_old and stays. On return the fluxes in
  !> `seepage` and the flow properties in `state` belong to the pressures found.
  subroutine newton_solve(newton, seepage, disc, ground, inlets, rate, supply, tolerance, most, &
    state, converged, iterations)
    type(newton_t), intent(inout) :: newton
    type(seepage_t), intent(inout) :: seepage
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(inlets_t), intent(in) :: inlets
    real(dp), intent(in) :: rate      !! 1/step [1/s]
    real(dp), intent(in) :: supply(:) !! water offered at each inlet [m2/s]
    real(dp), intent(in) :: tolerance !! of the last relative change of pressure
    integer, intent(in) :: most       !! iterations allowed
    type(state_t), intent(inout) :: state
    logical, intent(out) :: converged
    integer, intent(out) :: iterations
    real(dp) :: before, part, change
    logical :: switched
    integer :: halving, info

    converged = .false.
    call pressures_hold(seepage, ground, inlets, state%pressure)
    call evaluate(newton, seepage, disc, ground, inlets, rate, supply, state)
    do iterations = 1, most
      call switch_inlets(newton, seepage, inlets, iterations <= patience, state%pressure, switched)
      if (switched) call evaluate(newton, seepage, disc, ground, inlets, rate, supply, state)
      before = free_norm(newton, seepage)
      call assemble(newton, seepage, disc, ground, rate, state)
      newton%change(:, 1) = merge(0.0_dp, -newton%residual, seepage%held)
      call dgbsv(disc%n, newton%band, newton%band, 1, newton%matrix, 3*newton%band + 1, &
        newton%pivot, newton%change, disc%n, info)
      if (info /= 0) return
      newton%pressure = state%pressure
      change = maxval(abs(newton%change(:, 1))/(abs(newton%pressure) + pressure_scale))
      if (.not. change < huge(change)) return
      part = 1.0_dp
      do halving = 1, 6
        state%pressure = newton%pressure + part*newton%change(:, 1)
        call evaluate(newton, seepage, disc, ground, inlets, rate, supply, state)
        if (free_norm(newton, seepage) <= (1.0_dp - 1.0e-4_dp*part)*before) exit
        if (change <= tolerance) exit
        part = 0.5_dp*part
      end do
      if (change > tolerance .or. halving > 1) cycle
      call switch_inlets(newton, seepage, inlets, iterations <= patience, state%pressure, switched)
      converged = .not. switched
      if (converged) return
      call evaluate(newton, seepage, disc, ground, inlets, rate, supply, state)
    end do
    iterations = most
  end subroutine newton_solve

  !> Put held nodes at the pressure that holds them.
  pure subroutine pressures_hold(seepage, ground, inlets, pressure)
    type(seepage_t), intent(in) :: seepage
    type(ground_t), intent(in) :: ground
    type(inlets_t), intent(in) :: inlets
    real(dp), intent(inout) :: pressure(:) !! [Pa], (n)
    integer :: k

    do k = 1, size(inlets%node)
      associate (i => inlets%node(k))
        if (.not. seepage%held(i)) cycle
        pressure(i) = inlets%value(k)
        if (inlets%kind(k) == inlet_head) pressure(i) = ground%unit_weight &
          *(inlets%value(k) - seepage%height(i))
      end associate
    end do
  end subroutine pressures_hold

  !> Hold nodes that pass their limit; release those whose limit takes more than their supply.
  pure subroutine switch_inlets(newton, seepage, inlets, may_release, pressure, switched)
    type(newton_t), intent(in) :: newton
    type(seepage_t), intent(inout) :: seepage
    type(inlets_t), intent(in) :: inlets
    logical, intent(in) :: may_release
    real(dp), intent(inout) :: pressure(:) !! [Pa], (n)
    logical, intent(out) :: switched
    integer :: k

    switched = .false.
    do k = 1, size(inlets%node)
      if (inlets%kind(k) /= inlet_rain .and. inlets%kind(k) /= inlet_seepage) cycle
      associate (i => inlets%node(k))
        if (seepage%held(i)) then
          if (newton%residual(i) <= 0.0_dp .or. .not. may_release) cycle
          seepage%held(i) = .false.
        else
          if (pressure(i) <= inlets%value(k)) cycle
          seepage%held(i) = .true.
          pressure(i) = inlets%value(k)
        end if
        switched = .true.
      end associate
    end do
  end subroutine switch_inlets

  !> Flow properties, fluxes and residual at the pressures of the state.
  subroutine evaluate(newton, seepage, disc, ground, inlets, rate, supply, state)
    type(newton_t), intent(inout) :: newton
    type(seepage_t), intent(inout) :: seepage
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(inlets_t), intent(in) :: inlets
    real(dp), intent(in) :: rate, supply(:)
    type(state_t), intent(inout) :: state
    real(dp) :: content, pore, capacity
    integer :: i, k

    !$omp parallel do default(none) shared(disc, ground, state) private(i) schedule(static)
    do i = 1, disc%n
      call curve_at_pressure(ground%curve(disc%soil(i)), state%pressure(i), state%saturation(i), &
        state%ratio(i), state%potential(i), state%capacity(i))
    end do
    !$omp end parallel do
    call face_fluxes(seepage, disc, ground, state)
    !$omp parallel do default(none) shared(newton, seepage, disc, ground, state, rate) &
    !$omp private(i, content, pore, capacity) schedule(static)
    do i = 1, disc%n
      associate (jacobian => state%jacobian(i), soil => disc%soil(i))
        pore = jacobian - 1.0_dp + ground%porosity(soil)
        content = pore*state%saturation(i) &
          + jacobian*ground%storage(soil)*max(state%pressure(i), 0.0_dp)
        capacity = pore*state%capacity(i)
        if (state%pressure(i) >= 0.0_dp) capacity = capacity + jacobian*ground%storage(soil)
        state%capacity(i) = capacity
      end associate
      newton%residual(i) = disc%dual%area(i)*rate*(content - state%content(i)) &
        + cell_outflow(disc%dual, seepage%q, i)
    end do
    !$omp end parallel do
    do k = 1, size(inlets%node)
      newton%residual(inlets%node(k)) = newton%residual(inlets%node(k)) - supply(k)
    end do
  end subroutine evaluate

  !> Euclidean norm of the residual of the nodes that are free.
  pure real(dp) function free_norm(newton, seepage) result(norm)
    type(newton_t), intent(in) :: newton
    type(seepage_t), intent(in) :: seepage

    norm = sqrt(sum(newton%residual**2, mask=.not. seepage%held))
  end function free_norm

  !> Jacobian of the residual in band storage: row i of column j at matrix(2 band + 1 + i - j, j).
  subroutine assemble(newton, seepage, disc, ground, rate, state)
    type(newton_t), intent(inout) :: newton
    type(seepage_t), intent(in) :: seepage
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    real(dp), intent(in) :: rate
    type(state_t), intent(in) :: state
    real(dp) :: unused(2)
    integer :: e, i, j, d

    !$omp parallel default(none) shared(newton, seepage, disc, ground, state) private(i, e, unused)
    !$omp do schedule(static)
    do i = 1, disc%n
      newton%probe(1, i) = -difference*(abs(state%pressure(i)) + pressure_scale)
      call curve_at_pressure(ground%curve(disc%soil(i)), state%pressure(i) + newton%probe(1, i), &
        unused(1), newton%probe(3, i), newton%probe(2, i), unused(2))
    end do
    !$omp end do
    !$omp do schedule(static)
    do e = 1, size(newton%slope, 2)
      call face_slope(newton, seepage, disc, ground, state, e, newton%slope(:, e))
    end do
    !$omp end do
    !$omp end parallel
    newton%matrix = 0.0_dp
    d = 2*newton%band + 1
    do i = 1, disc%n
      newton%matrix(d, i) = disc%dual%area(i)*rate*state%capacity(i)
    end do
    do e = 1, size(newton%slope, 2)
      i = disc%dual%edge_node(1, e)
      j = disc%dual%edge_node(2, e)
      newton%matrix(d, i) = newton%matrix(d, i) + newton%slope(1, e)
      newton%matrix(d+j-i, i) = newton%matrix(d+j-i, i) - newton%slope(1, e)
      newton%matrix(d, j) = newton%matrix(d, j) - newton%slope(2, e)
      newton%matrix(d+i-j, j) = newton%matrix(d+i-j, j) + newton%slope(2, e)
    end do
    do i = 1, disc%n
      if (.not. seepage%held(i)) cycle
      do j = max(1, i - newton%band), min(disc%n, i + newton%band)
        newton%matrix(d+i-j, j) = 0.0_dp
      end do
      newton%matrix(d, i) = 1.0_dp
    end do
  end subroutine assemble

  !> Derivatives of a face's two-point flux by the pressures at its ends.
  pure subroutine face_slope(newton, seepage, disc, ground, state, e, slope)
    type(newton_t), intent(in) :: newton
    type(seepage_t), intent(in) :: seepage
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(state_t), intent(in) :: state
    integer, intent(in) :: e
    real(dp), intent(out) :: slope(2) !! [m2/(s Pa)]
    real(dp) :: p(2), phi(2), k(2), q, q_probe, mean, peclet
    integer :: node(2), side

    node = disc%dual%edge_node(:, e)
    p = state%pressure(node)
    phi = state%potential(node)
    k = state%ratio(node)
    call face_two_point(seepage, disc, ground, e, p, phi, k, q, mean, peclet)
    do side = 1, 2
      p(side) = p(side) + newton%probe(1, node(side))
      phi(side) = newton%probe(2, node(side))
      k(side) = newton%probe(3, node(side))
      call face_two_point(seepage, disc, ground, e, p, phi, k, q_probe, mean, peclet)
      slope(side) = (q_probe - q)/(p(side) - state%pressure(node(side)))
      p(side) = state%pressure(node(side))
      phi(side) = state%potential(node(side))
      k(side) = state%ratio(node(side))
    end do
  end subroutine face_slope
end module talus_seepage_newton
