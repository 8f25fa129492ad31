! SPDX-License-Identifier: MIT
!> Mass consistent with the strain (src/THEORY.md section 5.11). The strain is a mean over a cell
!> and an edge, and so is softer than the motion it stands for; the inertia of the same mean
!> makes up for that. With the lumped mass m and the mass of the pairs c,
!>
!>   M^-1 = m^-1 (m + L) m^-1,   (L a)_I = sum over the edges I-K of c_IK (a_I - a_K)
!>
!> needs no solution in the step. L is symmetric, not negative, and 0 for a uniform motion.
module talus_inertia
  use talus_kinds, only: dp
  use talus_dual_cells, only: dual_t
  use talus_sum, only: sum_products
  implicit none
  private
  public :: inertia_pairs, inertia_gather, inertia_apply, inertia_momentum

  !> Residual over right-hand side at which the search for the momentum ends: round-off.
  real(dp), parameter :: solve_tolerance = 2.0_dp*epsilon(1.0_dp)
  !> Most turns of that search; an eigenvalue of m^-1 (m + L) above 100 would need as many.
  integer, parameter :: solve_turns = 200

contains

  !> Mass of every pair c_IK [kg/m], at both of its ends in the order of dual%node_neighbour: a
  !> third of the density times N.(X_K - X_I), where N is the normal of the face between the cells.
  pure function inertia_pairs(dual, x, mass) result(pair_mass)
    type(dual_t), intent(in) :: dual
    real(dp), intent(in) :: x(:,:)  !! nodes [m], (2,n)
    real(dp), intent(in) :: mass(:) !! lumped [kg/m], (n)
    real(dp) :: pair_mass(size(dual%node_neighbour))
    real(dp) :: density
    integer :: i, j, k

    do i = 1, size(mass)
      do k = dual%node_offset(i), dual%node_offset(i+1) - 1
        j = dual%node_neighbour(k)
        density = 0.5_dp*(mass(i)/dual%area(i) + mass(j)/dual%area(j))
        pair_mass(k) = density/3.0_dp*dual%node_sign(k) &
          *dot_product(dual%edge_normal(:, dual%node_edge(k)), x(:, j) - x(:, i))
      end do
    end do
  end function inertia_pairs

  !> Acceleration M^-1 f at one node. Neighbours that are held do not accelerate.
  pure function inertia_gather(offset, node, pair_mass, mobility, force, i) result(acceleration)
    integer, contiguous, intent(in) :: offset(:), node(:) !! neighbours of each node
    real(dp), contiguous, intent(in) :: pair_mass(:)      !! [kg/m], as node
    real(dp), contiguous, intent(in) :: mobility(:,:)     !! 1/mass, 0 where held [m/kg], (2,n)
    real(dp), contiguous, intent(in) :: force(:,:)        !! [N/m], (2,n)
    integer, intent(in) :: i                              !! the node
    real(dp) :: acceleration(2) !! [m/s2]
    real(dp) :: own(2), total(2)
    integer :: k

    own = mobility(:, i)*force(:, i)
    total = force(:, i)
    do k = offset(i), offset(i+1) - 1
      total = total + pair_mass(k)*(own - mobility(:, node(k))*force(:, node(k)))
    end do
    acceleration = mobility(:, i)*total
  end function inertia_gather

  !> Accelerations M^-1 f of all nodes.
  subroutine inertia_apply(dual, pair_mass, mobility, force, acceleration)
    type(dual_t), intent(in) :: dual
    real(dp), contiguous, intent(in) :: pair_mass(:)          !! [kg/m]
    real(dp), contiguous, intent(in) :: mobility(:,:)         !! [m/kg], (2,n)
    real(dp), contiguous, intent(in) :: force(:,:)            !! [N/m], (2,n)
    real(dp), contiguous, intent(inout) :: acceleration(:,:)  !! [m/s2], (2,n)
    integer :: i

    !$omp parallel do default(none) shared(dual, pair_mass, mobility, force, acceleration) &
    !$omp private(i) schedule(static)
    do i = 1, size(force, 2)
      acceleration(:, i) = inertia_gather(dual%node_offset, dual%node_neighbour, pair_mass, &
                                          mobility, force, i)
    end do
    !$omp end parallel do
  end subroutine inertia_apply

  !> Momentum M v of the nodes that can move, 0 of the others. (m + L) a = m v by conjugate
  !> gradients with the diagonal as preconditioner, to round-off; then the momentum is m a.
  subroutine inertia_momentum(dual, pair_mass, mobility, v, momentum)
    type(dual_t), intent(in) :: dual
    real(dp), contiguous, intent(in) :: pair_mass(:)  !! [kg/m]
    real(dp), contiguous, intent(in) :: mobility(:,:) !! [m/kg], (2,n)
    real(dp), contiguous, intent(in) :: v(:,:)        !! velocity [m/s], (2,n)
    real(dp), allocatable, intent(out) :: momentum(:,:) !! [kg/s], (2,n)
    real(dp), allocatable :: mass(:,:), diagonal(:,:), a(:,:), r(:,:), z(:,:), d(:,:), image(:,:)
    real(dp) :: rz, rz_start, rz_before, length
    integer :: n, turn

    n = size(v, 2)
    allocate (mass(2, n), diagonal(2, n), image(2, n))
    mass = 0.0_dp
    where (mobility > 0.0_dp) mass = 1.0_dp/mobility
    diagonal = pairs_diagonal(dual, pair_mass, mass)
    a = merge(v, 0.0_dp, mobility > 0.0_dp)
    call spread_mass(dual, pair_mass, mass, a, image)
    r = mass*a - image
    z = r/diagonal
    d = z
    rz = sum_products(2*n, r, z)
    rz_start = sum_products(2*n, mass*a, mass*a/diagonal)
    do turn = 1, solve_turns
      if (rz <= solve_tolerance**2*rz_start) exit
      call spread_mass(dual, pair_mass, mass, d, image)
      length = rz/sum_products(2*n, d, image)
      a = a + length*d
      r = r - length*image
      z = r/diagonal
      rz_before = rz
      rz = sum_products(2*n, r, z)
      d = z + (rz/rz_before)*d
    end do
    momentum = mass*a
  end subroutine inertia_momentum

  !> Diagonal of m + L; 1 where a node is held.
  pure function pairs_diagonal(dual, pair_mass, mass) result(diagonal)
    type(dual_t), intent(in) :: dual
    real(dp), intent(in) :: pair_mass(:), mass(:,:)
    real(dp) :: diagonal(2, size(mass, 2))
    integer :: i

    do i = 1, size(mass, 2)
      diagonal(:, i) = merge(mass(:, i) &
        + sum(pair_mass(dual%node_offset(i):dual%node_offset(i+1) - 1)), 1.0_dp, &
        mass(:, i) > 0.0_dp)
    end do
  end function pairs_diagonal

  !> (m + L) a over the nodes that can move; a is 0 at the others.
  subroutine spread_mass(dual, pair_mass, mass, a, image)
    type(dual_t), intent(in) :: dual
    real(dp), intent(in) :: pair_mass(:), mass(:,:), a(:,:)
    real(dp), intent(inout) :: image(:,:)
    real(dp) :: total(2)
    integer :: i, k

    !$omp parallel do default(none) shared(dual, pair_mass, mass, a, image) private(i, k, total) &
    !$omp schedule(static)
    do i = 1, size(a, 2)
      total = mass(:, i)*a(:, i)
      do k = dual%node_offset(i), dual%node_offset(i+1) - 1
        total = total + pair_mass(k)*(a(:, i) - a(:, dual%node_neighbour(k)))
      end do
      image(:, i) = merge(total, 0.0_dp, mass(:, i) > 0.0_dp)
    end do
    !$omp end parallel do
  end subroutine spread_mass
end module talus_inertia
