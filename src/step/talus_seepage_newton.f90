! SPDX-License-Identifier: MIT
!> Implicit seepage on the storage form (src/THEORY.md section 5.5): find pressures p so that
!>
!>   A (w(p) - w_old) rate + net outflow of the faces(p) - supply of the boundary = 0
!>
!> in every cell, by Newton's method with a line search and LAPACK's band solver; rate = 1/step, or
!> 0 for the steady state. The Jacobian is differenced from the face fluxes with the smoothed
!> gradient of a distorted grid as it is; inner iterations with the same factors add the change of
!> that.
!> Ponds and seepage faces are inequalities (p <= limit, and no more inflow than is supplied), kept
!> by an active set: a node is held at its limit while that takes less than its supply
!> (Hintermueller, Ito & Kunisch 2002).
module talus_seepage_newton
  use talus_kinds, only: dp
  use talus_disc, only: disc_t
  use talus_ground, only: ground_t
  use talus_state, only: state_t
  use talus_conditions, only: inlets_t, inlets_rules, inlet_head, inlet_rain, inlet_seepage
  use talus_storage, only: storage_capacity
  use talus_water_curve, only: curve_at_pressure
  use talus_darcy, only: seepage_t, face_fluxes, cell_outflow
  use talus_seepage_slope, only: slope_t, slope_prepare, slope_faces, slope_outflow
  implicit none
  private
  public :: newton_t, newton_prepare, newton_solve, newton_cost

  type :: newton_t
    integer :: band = 0                     !! greatest difference of two neighbours' numbers
    real(dp), allocatable :: matrix(:,:)    !! in LAPACK's band storage, (3 band + 1, n)
    integer, allocatable :: pivot(:)        !! (n)
    real(dp), allocatable :: residual(:)    !! [m2/s], (n)
    real(dp), allocatable :: change(:,:)    !! Newton's change of pressure [Pa], (n,1)
    real(dp), allocatable :: inner(:,:)     !! the same in an inner iteration [Pa], (n,1)
    real(dp) :: tolerance = 1.0e-7_dp       !! of the last relative change of pressure
    integer :: most = 15                    !! iterations allowed
    logical :: balanced = .true.            !! also the water left over must be worth no more
    integer :: halvings = 6                 !! trials of a line search
    logical :: on_the_way = .false.         !! only to get nearer to a steady state
    real(dp), allocatable :: pressure(:)    !! before a line search [Pa], (n)
    type(slope_t) :: slope                  !! of the fluxes
  end type newton_t

  !> Pressure below which a change is judged absolutely [Pa].
  real(dp), parameter :: pressure_scale = 100.0_dp
  !> A node's pressure changes by its own size and this at most in an iteration [Pa].
  real(dp), parameter :: reach = 5000.0_dp
  !> Inner iterations for the oblique fluxes, and their last relative change.
  integer, parameter :: most_inner = 30
  real(dp), parameter :: inner_tolerance = 1.0e-4_dp
  !> Imbalance over the largest flux below which, on the way, a line search has nothing to gain: the
  !> pressures of dry soil, through which next to nothing flows, settle there.
  real(dp), parameter :: round_off = 1.0e-12_dp
  !> Iterations after which a pond or seepage face is not released again.
  integer, parameter :: patience = 12

  interface
    subroutine dgbtrf(m, n, kl, ku, ab, ldab, ipiv, info)
      import :: dp
      integer, intent(in) :: m, n, kl, ku, ldab
      real(dp), intent(inout) :: ab(ldab,*)
      integer, intent(out) :: ipiv(*), info
    end subroutine dgbtrf
    subroutine dgbtrs(trans, n, kl, ku, nrhs, ab, ldab, ipiv, b, ldb, info)
      import :: dp
      character, intent(in) :: trans
      integer, intent(in) :: n, kl, ku, nrhs, ldab, ldb, ipiv(*)
      real(dp), intent(in) :: ab(ldab,*)
      real(dp), intent(inout) :: b(ldb,*)
      integer, intent(out) :: info
    end subroutine dgbtrs
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
      newton%inner(disc%n, 1))
    call slope_prepare(newton%slope, disc)
  end subroutine newton_prepare

  !> Explicit steps that take as long as one implicit step: four iterations of assembly and of a
  !> band factorisation with row exchanges, measured against an explicit step of the same nodes.
  pure real(dp) function newton_cost(disc) result(steps)
    type(disc_t), intent(in) :: disc
    real(dp) :: band

    band = real(maxval(abs(disc%dual%edge_node(2, :) - disc%dual%edge_node(1, :))), dp)
    steps = 4.0_dp*(4.0_dp + 0.03_dp*band**2)
  end function newton_cost

  !> Solve for the pressures; the content of `state` is w_old and stays. On return the fluxes in
  !> `seepage` and the flow properties in `state` belong to the pressures found.
  subroutine newton_solve(newton, seepage, disc, ground, inlets, rate, supply, state, converged, &
    iterations)
    type(newton_t), intent(inout) :: newton
    type(seepage_t), intent(inout) :: seepage
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(inlets_t), intent(in) :: inlets
    real(dp), intent(in) :: rate      !! 1/step [1/s]
    real(dp), intent(in) :: supply(:) !! water offered at each inlet [m2/s]
    type(state_t), intent(inout) :: state
    logical, intent(out) :: converged
    integer, intent(out) :: iterations
    real(dp) :: before, part, change, over, over_before
    logical :: switched
    integer :: halving
    logical :: solved

    converged = .false.
    over = huge(1.0_dp)
    call pressures_hold(seepage, ground, inlets, state%pressure)
    call evaluate(newton, seepage, disc, ground, inlets, rate, supply, state)
    do iterations = 1, newton%most
      call switch_inlets(newton, seepage, inlets, iterations <= patience, state%pressure, switched)
      if (switched) call evaluate(newton, seepage, disc, ground, inlets, rate, supply, state)
      before = free_norm(newton, seepage)
      call assemble(newton, seepage, disc, ground, rate, state)
      call find_change(newton, seepage, disc, ground, state%ratio, solved)
      if (.not. solved) return
      newton%pressure = state%pressure
      newton%change(:, 1) = sign(min(abs(newton%change(:, 1)), abs(newton%pressure) + reach), &
        newton%change(:, 1))
      change = maxval(abs(newton%change(:, 1))/(abs(newton%pressure) + pressure_scale))
      if (.not. change < huge(change)) return
      part = 1.0_dp
      do halving = 1, newton%halvings
        state%pressure = newton%pressure + part*newton%change(:, 1)
        call evaluate(newton, seepage, disc, ground, inlets, rate, supply, state)
        if (free_norm(newton, seepage) <= (1.0_dp - 1.0e-4_dp*part)*before) exit
        if (change <= newton%tolerance) exit
        if (newton%on_the_way .and. &
            free_norm(newton, seepage) <= round_off*maxval(abs(seepage%q))) exit
        part = 0.5_dp*part
      end do
      if (change > newton%tolerance .or. halving > 1) cycle
      if (newton%balanced) then
        over_before = over
        over = left_over(newton, seepage, disc, rate, state)
        ! Until it is well below the tolerance, or at the round-off of the fluxes.
        if (over > 1.0e-3_dp*newton%tolerance .and. over < 0.8_dp*over_before .and. &
            iterations < newton%most) cycle
      end if
      call switch_inlets(newton, seepage, inlets, iterations <= patience, state%pressure, switched)
      converged = .not. switched
      if (converged) return
      call evaluate(newton, seepage, disc, ground, inlets, rate, supply, state)
    end do
    iterations = newton%most
  end subroutine newton_solve

  !> Newton's change of pressure. Where the grid is oblique the factors of the two-point part solve
  !> for the rest by inner iterations; where these diverge it is left to the outer ones.
  subroutine find_change(newton, seepage, disc, ground, ratio, solved)
    type(newton_t), intent(inout) :: newton
    type(seepage_t), intent(in) :: seepage
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    real(dp), intent(in) :: ratio(:) !! k_r, (n)
    logical, intent(out) :: solved
    real(dp), allocatable :: first(:)
    real(dp) :: difference_now, difference_before
    integer :: info, inner, rows

    rows = 3*newton%band + 1
    newton%change(:, 1) = merge(0.0_dp, -newton%residual, seepage%held)
    call dgbtrf(disc%n, disc%n, newton%band, newton%band, newton%matrix, rows, newton%pivot, info)
    solved = info == 0
    if (.not. solved) return
    call dgbtrs('N', disc%n, newton%band, newton%band, 1, newton%matrix, rows, newton%pivot, &
      newton%change, disc%n, info)
    if (.not. seepage%flux%oblique) return
    first = newton%change(:, 1)
    difference_before = huge(1.0_dp)
    do inner = 1, most_inner
      call slope_outflow(newton%slope, seepage, disc, ground, ratio, newton%change, .false., &
        newton%inner)
      call dgbtrs('N', disc%n, newton%band, newton%band, 1, newton%matrix, rows, newton%pivot, &
        newton%inner, disc%n, info)
      newton%inner(:, 1) = first - newton%inner(:, 1)
      difference_now = maxval(abs(newton%inner(:, 1) - newton%change(:, 1)))
      if (.not. difference_now < difference_before) then
        newton%change(:, 1) = first
        return
      end if
      newton%change = newton%inner
      if (difference_now <= inner_tolerance*maxval(abs(newton%change))) return
      difference_before = difference_now
    end do
  end subroutine find_change

  !> Water left over by the pressures found, as a relative pressure.
  pure real(dp) function left_over(newton, seepage, disc, rate, state) result(worst)
    type(newton_t), intent(in) :: newton
    type(seepage_t), intent(in) :: seepage
    type(disc_t), intent(in) :: disc
    real(dp), intent(in) :: rate !! [1/s]
    type(state_t), intent(in) :: state

    worst = maxval(abs(newton%residual)/(disc%dual%area*rate*state%capacity* &
      (abs(state%pressure) + pressure_scale)), mask=.not. seepage%held)
  end function left_over

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
      if (.not. inlets_rules(inlets, k)) cycle
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
    real(dp) :: content, pore
    integer :: i, k

    !$omp parallel do default(none) shared(disc, ground, state) private(i) schedule(static)
    do i = 1, disc%n
      call curve_at_pressure(ground%curve(disc%soil(i)), state%pressure(i), state%saturation(i), &
        state%ratio(i), state%potential(i), state%capacity(i))
    end do
    !$omp end parallel do
    call face_fluxes(seepage, disc, ground, state)
    !$omp parallel do default(none) shared(newton, seepage, disc, ground, state, rate) &
    !$omp private(i, content, pore) schedule(static)
    do i = 1, disc%n
      associate (jacobian => state%jacobian(i), soil => disc%soil(i))
        pore = jacobian - 1.0_dp + ground%porosity(soil)
        content = pore*state%saturation(i) + jacobian*ground%storage(soil) &
          *max(state%pressure(i) + ground%curve(soil)%entry, 0.0_dp)
        state%capacity(i) = storage_capacity(ground%curve(soil), ground%storage(soil), pore, &
          jacobian, state%pressure(i), state%capacity(i))
      end associate
      if (allocated(state%give)) then
        content = content + state%give(i)*(state%pressure(i) - state%anchor(i))
        state%capacity(i) = state%capacity(i) + state%give(i)
      end if
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
  !> On the way to a steady state a face counts only as far as more pressure on one side drives
  !> more water to the other. Where the fluxes (4.15) answer the other way, from wet soil up into
  !> soil far drier than at rest, Newton's method would dry the soil that water enters, and never
  !> return.
  subroutine assemble(newton, seepage, disc, ground, rate, state)
    type(newton_t), intent(inout) :: newton
    type(seepage_t), intent(in) :: seepage
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    real(dp), intent(in) :: rate
    type(state_t), intent(in) :: state
    real(dp) :: slope(2)
    integer :: e, i, j, d

    call slope_faces(newton%slope, seepage, disc, ground, state)
    newton%matrix = 0.0_dp
    d = 2*newton%band + 1
    do i = 1, disc%n
      newton%matrix(d, i) = disc%dual%area(i)*rate*state%capacity(i)
    end do
    do e = 1, size(disc%dual%edge_node, 2)
      i = disc%dual%edge_node(1, e)
      j = disc%dual%edge_node(2, e)
      slope = newton%slope%face(:, e)
      if (newton%on_the_way) slope = [max(slope(1), 0.0_dp), min(slope(2), 0.0_dp)]
      newton%matrix(d, i) = newton%matrix(d, i) + slope(1)
      newton%matrix(d+j-i, i) = newton%matrix(d+j-i, i) - slope(1)
      newton%matrix(d, j) = newton%matrix(d, j) - slope(2)
      newton%matrix(d+i-j, j) = newton%matrix(d+i-j, j) + slope(2)
    end do
    do i = 1, disc%n
      if (.not. seepage%held(i)) cycle
      do j = max(1, i - newton%band), min(disc%n, i + newton%band)
        newton%matrix(d+i-j, j) = 0.0_dp
      end do
      newton%matrix(d, i) = 1.0_dp
    end do
  end subroutine assemble
end module talus_seepage_newton
