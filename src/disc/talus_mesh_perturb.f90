! SPDX-License-Identifier: MIT
!> Random displacement of nodes, to take the regularity out of a generated grid.
module talus_mesh_perturb
  use talus_kinds, only: dp, i8
  use talus_nodes, only: mesh_t, mesh_corner_jacobian
  implicit none
  private
  public :: mesh_perturb

  !> Fraction of its smallest corner Jacobian that every element keeps.
  real(dp), parameter :: jacobian_kept = 0.1_dp
  !> Factor on the displacements of an element that would keep less.
  real(dp), parameter :: shrinkage = 0.7_dp
  !> Rounds of shrinking after which such nodes are put back where they were.
  integer, parameter :: rounds = 40

contains

  !> Move every interior node to a point drawn uniformly from a disc around it. Boundary nodes
  !> stay, or slide along straight boundaries. Where an element would keep less than a tenth of its
  !> smallest corner Jacobian, its nodes' displacements are shrunk until none does. The same seed
  !> gives the same nodes on every compiler and machine.
  pure subroutine mesh_perturb(mesh, perturbation, seed, slide)
    type(mesh_t), intent(inout) :: mesh   !! with its boundary known
    real(dp), intent(in) :: perturbation  !! disc radius over shortest edge there [-], 0..0.4
    integer, intent(in) :: seed           !! any integer
    logical, intent(in) :: slide          !! also move boundary nodes along straight boundaries
    real(dp), allocatable :: shift(:,:), regular(:,:), least(:)
    integer :: e

    if (.not. perturbation > 0.0_dp) return
    allocate (least(size(mesh%element_offset)-1))
    do e = 1, size(least)
      least(e) = jacobian_kept*mesh_corner_jacobian(mesh, e)
    end do
    call draw_shifts(mesh, perturbation, seed, shift)
    call hold_boundary(mesh, slide, shift)
    regular = mesh%x
    call shrink_until_valid(mesh, regular, least, shift)
  end subroutine mesh_perturb

  !> A displacement for every node, drawn in the order of the nodes; without trigonometry, whose
  !> last digit differs between libraries.
  pure subroutine draw_shifts(mesh, perturbation, seed, shift)
    type(mesh_t), intent(in) :: mesh
    real(dp), intent(in) :: perturbation
    integer, intent(in) :: seed
    real(dp), allocatable, intent(out) :: shift(:,:)
    real(dp), allocatable :: shortest(:)
    real(dp) :: length, point(2)
    integer(i8) :: state
    integer :: e, i, a, b, k

    allocate (shortest(size(mesh%x, 2)), shift(2, size(mesh%x, 2)))
    shortest = huge(1.0_dp)
    do e = 1, size(mesh%element_offset) - 1
      a = mesh%element_nodes(mesh%element_offset(e+1)-1)
      do k = mesh%element_offset(e), mesh%element_offset(e+1) - 1
        b = mesh%element_nodes(k)
        length = norm2(mesh%x(:, a) - mesh%x(:, b))
        shortest(a) = min(shortest(a), length)
        shortest(b) = min(shortest(b), length)
        a = b
      end do
    end do
    state = 1_i8 + modulo(int(seed, i8), 2147483646_i8)
    do i = 1, 10
      call draw(state, length)
    end do
    do i = 1, size(shortest)
      do
        call draw(state, point(1))
        call draw(state, point(2))
        point = 2.0_dp*point - 1.0_dp
        if (sum(point**2) <= 1.0_dp) exit
      end do
      shift(:, i) = perturbation*shortest(i)*point
    end do
  end subroutine draw_shifts

  !> Next number between 0 and 1 (Park & Miller 1988, with the multiplier of 1993).
  pure subroutine draw(state, value)
    integer(i8), intent(inout) :: state
    real(dp), intent(out) :: value

    state = modulo(48271_i8*state, 2147483647_i8)
    value = real(state, dp)/2147483647.0_dp
  end subroutine draw

  !> Keep boundary nodes in place; with `slide`, leave the tangential part of the shift to those
  !> between two edges in line and of the same tag.
  pure subroutine hold_boundary(mesh, slide, shift)
    type(mesh_t), intent(in) :: mesh
    logical, intent(in) :: slide
    real(dp), intent(inout) :: shift(:,:)
    integer, allocatable :: before(:), after(:)
    real(dp) :: along(2), back(2)
    integer :: i, node

    allocate (before(size(mesh%x, 2)), after(size(mesh%x, 2)))
    before = 0
    after = 0
    do i = 1, size(mesh%boundary_tag)
      after(mesh%boundary_edge(1, i)) = i
      before(mesh%boundary_edge(2, i)) = i
    end do
    do node = 1, size(before)
      if (after(node) == 0) cycle
      along = mesh%x(:, mesh%boundary_edge(2, after(node))) - mesh%x(:, node)
      back = mesh%x(:, node) - mesh%x(:, mesh%boundary_edge(1, before(node)))
      if (slide .and. mesh%boundary_tag(before(node)) == mesh%boundary_tag(after(node)) .and. &
          abs(along(1)*back(2) - along(2)*back(1)) < 1.0e-9_dp*norm2(along)*norm2(back)) then
        along = along/norm2(along)
        shift(:, node) = dot_product(shift(:, node), along)*along
      else
        shift(:, node) = 0.0_dp
      end if
    end do
  end subroutine hold_boundary

  !> Apply the shifts, shrinking them around every element that would become too thin.
  pure subroutine shrink_until_valid(mesh, regular, least, shift)
    type(mesh_t), intent(inout) :: mesh
    real(dp), intent(in) :: regular(:,:)   !! coordinates before [m]
    real(dp), intent(in) :: least(:)       !! corner Jacobian that each element must keep [m2]
    real(dp), intent(inout) :: shift(:,:)  !! [m]
    logical, allocatable :: thin(:)
    integer :: e, round

    allocate (thin(size(mesh%x, 2)))
    round = 0
    do
      mesh%x = regular + shift
      thin = .false.
      do e = 1, size(least)
        if (mesh_corner_jacobian(mesh, e) >= least(e)) cycle
        thin(mesh%element_nodes(mesh%element_offset(e):mesh%element_offset(e+1)-1)) = .true.
      end do
      if (.not. any(thin)) exit
      round = round + 1
      do e = 1, size(thin)
        if (thin(e)) shift(:, e) = merge(shrinkage, 0.0_dp, round < rounds)*shift(:, e)
      end do
    end do
  end subroutine shrink_until_valid
end module talus_mesh_perturb
