! SPDX-License-Identifier: MIT
!> Affine-residual stabilisation (src/THEORY.md (4.9), (4.10)). Nodal integration does not see some
!> deformations; on every edge I-K of the nodes' grid the residual
!>   r = x_K - x_I - (F_I + F_K)/2 (X_K - X_I),
!> F of the first level, does, and vanishes in every affine motion. Its energy is kappa |r|^2/2,
!>   kappa = alpha_s E (A_I + A_K)/(8 |X_K - X_I|^2).
!> The second level does not see how F varies within its length. There the difference of the F of both
!> levels has the energy c |F_1 - F|^2/2 at a node, c = alpha_l E A; intact soil has its own moduli there
!> instead (talus_tie).
module talus_stabilise
  use talus_kinds, only: dp
  use talus_dual_cells, only: dual_t
  implicit none
  private
  public :: stabilise_t, stabilise_build

  type :: stabilise_t
    integer, allocatable :: offset(:)    !! first pair of each node, (n+1)
    integer, allocatable :: node(:)      !! other node of the pair
    real(dp), allocatable :: reach(:,:)  !! X_K - X_I [m], (2,np)
    real(dp), allocatable :: stiffness(:) !! kappa of the intact soil [N/m per m]
    real(dp), allocatable :: level(:)    !! c over what is left and not intact [N], (n); (0) with one level
  end type stabilise_t

contains

  !> Pairs of every node, each pair stored at both of its ends.
  pure subroutine stabilise_build(stabilise, x, dual, modulus, alpha, smoothed, alpha_level)
    type(stabilise_t), intent(out) :: stabilise
    real(dp), intent(in) :: x(:,:)      !! nodes [m], (2,n)
    type(dual_t), intent(in) :: dual
    real(dp), intent(in) :: modulus(:)  !! Young's modulus at each node [Pa], (n)
    real(dp), intent(in) :: alpha       !! strength of the stabilisation, > 0
    logical, intent(in) :: smoothed     !! the stress sees the second level
    real(dp), intent(in) :: alpha_level !! then stiffness between the levels, over Young's modulus
    real(dp) :: pair_modulus
    integer :: i, j, k

    stabilise%offset = dual%node_offset
    stabilise%node = dual%node_neighbour
    allocate (stabilise%level(merge(size(modulus), 0, smoothed)))
    if (smoothed) stabilise%level = alpha_level*modulus*dual%area
    allocate (stabilise%reach(2, size(stabilise%node)), stabilise%stiffness(size(stabilise%node)))
    do i = 1, size(x, 2)
      do k = stabilise%offset(i), stabilise%offset(i+1) - 1
        j = stabilise%node(k)
        stabilise%reach(:, k) = x(:, j) - x(:, i)
        ! Two springs in series where soils meet.
        pair_modulus = 2.0_dp*modulus(i)*modulus(j)/(modulus(i) + modulus(j))
        stabilise%stiffness(k) = alpha*pair_modulus*(dual%area(i) + dual%area(j)) &
                                 /(8.0_dp*sum(stabilise%reach(:, k)**2))
      end do
    end do
  end subroutine stabilise_build
end module talus_stabilise
