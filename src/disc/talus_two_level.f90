! SPDX-License-Identifier: MIT
!> Second level of the gradient smoothing (src/THEORY.md (4.6), (4.7); Wang & Li 2013). The gradient
!> of the first level is averaged once more, over a physical length ell: F = W F1. With the default
!> weights W = S A, S symmetric, every row sum one: constant strain is kept and the integration
!> constraint of the first level is kept exactly, and the adjoint is the same operator.
module talus_two_level
  use talus_kinds, only: sp, dp
  use talus_status, only: status_t, status_set, status_failed, status_deck
  use talus_text, only: text_of
  use talus_kernel, only: kernel_spline
  use talus_rk_shape, only: rk_shape
  use talus_cell_list, only: cell_list_t, cell_list_build, cell_list_supports
  implicit none
  private
  public :: two_level_t, two_level_build

  integer, parameter, public :: weights_symmetric = 1, weights_rk = 2, weights_area = 3

  !> Row sums of the symmetric weights agree with one to a few units of round-off.
  real(dp), parameter :: sinkhorn_tolerance = 4.0_dp*epsilon(1.0_dp)
  integer, parameter :: sinkhorn_max = 500

  !> Symmetric weights:
  !>   F(L) = rest(L) A(L) F1(L) + sum of s(k) A(K) F1(K),   R(L) the same of P,       K = cell(k)
  !> others:
  !>   F(L) = sum of plain(k) A(K) F1(K),                    R(L) = sum of adjoint(k) A(K) P(K)
  type :: two_level_t
    integer, allocatable :: offset(:)   !! first entry of each cell, (n+1)
    integer, allocatable :: cell(:)     !! cells within ell, ascending
    real(sp), allocatable :: s(:)       !! symmetric weight over area, rounded [1/m2]
    real(dp), allocatable :: rest(:)    !! what rounding leaves of the row's sum [1/m2], (n)
    real(dp), allocatable :: plain(:)   !! weight over area [1/m2]
    real(dp), allocatable :: adjoint(:) !! the transpose of plain [1/m2]
    integer :: sweeps = 0               !! Sinkhorn sweeps used
  end type two_level_t

contains

  !> Build the weights. They do not reach from one kind of soil to another: there strain jumps, and
  !> a mean of both is that of neither. Those of the kernel (weights_rk) know nothing of kinds.
  subroutine two_level_build(two_level, x, area, kind, length, weights, status)
    type(two_level_t), intent(out) :: two_level
    real(dp), contiguous, intent(in) :: x(:,:) !! nodes [m], (2,n)
    real(dp), intent(in) :: area(:) !! cell areas [m2], (n)
    integer, intent(in) :: kind(:)  !! of elastic soil at each node, (n)
    real(dp), intent(in) :: length  !! ell: support radius of the weights [m]
    integer, intent(in) :: weights  !! one of weights_*
    type(status_t), intent(inout) :: status
    real(dp), allocatable :: support(:), weight(:)
    type(cell_list_t) :: list

    allocate (support(size(area)))
    support = length
    call cell_list_build(list, x, support)
    call cell_list_supports(list, x, two_level%offset, two_level%cell, status)
    if (status_failed(status)) return
    if (weights /= weights_rk) call keep_alike(two_level, kind)
    allocate (weight(size(two_level%cell)))
    select case (weights)
    case (weights_rk)
      call fill_rk(two_level, x, area, support, weight, status)
    case default
      call fill_kernel(two_level, x, length, weight)
    end select
    if (weights == weights_area) call normalise_rows(two_level, area, weight)
    if (weights == weights_symmetric) then
      call sinkhorn(two_level, area, weight, status)
      call round_weights(two_level, area, weight)
    else
      call fill_transpose(two_level, weight)
      call move_alloc(weight, two_level%plain)
    end if
  end subroutine two_level_build

  !> Drop the pairs of different kinds.
  pure subroutine keep_alike(two_level, kind)
    type(two_level_t), intent(inout) :: two_level
    integer, intent(in) :: kind(:)
    integer :: l, first, last, kept

    kept = 0
    first = 1
    do l = 1, size(kind)
      last = two_level%offset(l+1) - 1
      associate (near => pack(two_level%cell(first:last), kind(two_level%cell(first:last)) == kind(l)))
        two_level%cell(kept+1:kept+size(near)) = near
        kept = kept + size(near)
      end associate
      first = last + 1
      two_level%offset(l+1) = kept + 1
    end do
    two_level%cell = two_level%cell(:kept)
  end subroutine keep_alike

  !> Kernel values of all pairs.
  subroutine fill_kernel(two_level, x, length, weight)
    type(two_level_t), intent(in) :: two_level
    real(dp), intent(in) :: x(:,:), length
    real(dp), intent(inout) :: weight(:)
    integer :: l, k

    !$omp parallel do default(none) shared(two_level, x, length, weight) private(l, k) &
    !$omp schedule(static)
    do l = 1, size(x, 2)
      do k = two_level%offset(l), two_level%offset(l+1) - 1
        weight(k) = kernel_spline(norm2(x(:, two_level%cell(k)) - x(:, l))/length)
      end do
    end do
    !$omp end parallel do
  end subroutine fill_kernel

  !> Plain area-weighted average.
  pure subroutine normalise_rows(two_level, area, weight)
    type(two_level_t), intent(in) :: two_level
    real(dp), intent(in) :: area(:)
    real(dp), intent(inout) :: weight(:)
    integer :: l

    do l = 1, size(area)
      associate (first => two_level%offset(l), last => two_level%offset(l+1) - 1)
        weight(first:last) = weight(first:last) &
          /dot_product(weight(first:last), area(two_level%cell(first:last)))
      end associate
    end do
  end subroutine normalise_rows

  !> Reproducing-kernel values at the nodes, the paper's reading of the second level.
  subroutine fill_rk(two_level, x, area, support, weight, status)
    type(two_level_t), intent(in) :: two_level
    real(dp), intent(in) :: x(:,:), area(:), support(:)
    real(dp), intent(inout) :: weight(:)
    type(status_t), intent(inout) :: status
    integer :: l, bad
    logical :: regular

    bad = 0
    do l = 1, size(area)
      associate (first => two_level%offset(l), last => two_level%offset(l+1) - 1)
        associate (near => two_level%cell(first:last))
          call rk_shape(x(:, l), x(:, near), support(near), weight(first:last), regular)
          weight(first:last) = weight(first:last)/area(near)
        end associate
      end associate
      if (.not. regular) bad = l
    end do
    if (bad > 0) call status_set(status, status_deck, &
      '&smoothing length: too few nodes within it'// &
      ' of node '//text_of(bad)//'; raise length or reduce spacing')
  end subroutine fill_rk

  !> Scale the kernel to d S d with unit row sums (Sinkhorn & Knopp 1967). The geometric mean of two
  !> sweeps converges fast for symmetric matrices.
  subroutine sinkhorn(two_level, area, weight, status)
    type(two_level_t), intent(inout) :: two_level
    real(dp), intent(in) :: area(:)
    real(dp), intent(inout) :: weight(:)
    type(status_t), intent(inout) :: status
    real(dp), allocatable :: d(:), row(:)
    real(dp) :: worst, before
    integer :: l, k

    allocate (d(size(area)), row(size(area)))
    d = 1.0_dp
    worst = huge(1.0_dp)
    do while (two_level%sweeps < sinkhorn_max)
      before = worst
      worst = 0.0_dp
      !$omp parallel do default(none) shared(two_level, area, weight, d, row) private(l, k) &
      !$omp reduction(max:worst) schedule(static)
      do l = 1, size(area)
        row(l) = 0.0_dp
        do k = two_level%offset(l), two_level%offset(l+1) - 1
          row(l) = row(l) + weight(k)*d(two_level%cell(k))*area(two_level%cell(k))
        end do
        row(l) = row(l)*d(l)
        worst = max(worst, abs(row(l) - 1.0_dp))
      end do
      !$omp end parallel do
      ! Round-off can stop the decrease just above the tolerance.
      if (worst <= sinkhorn_tolerance .or. (worst < 1.0e-14_dp .and. worst >= before)) exit
      d = d/sqrt(row)
      two_level%sweeps = two_level%sweeps + 1
    end do
    if (worst > 1.0e-13_dp) call status_set(status, status_deck, &
      '&smoothing length: the symmetric weights did not converge (row sums off by '// &
      text_of(worst)//'); even out the nodes')
    do l = 1, size(area)
      do k = two_level%offset(l), two_level%offset(l+1) - 1
        weight(k) = d(l)*d(two_level%cell(k))*weight(k)
      end do
    end do
  end subroutine sinkhorn

  !> Keep symmetric weights in single precision: a step reads all of them twice and waits for
  !> memory. Rounded alike on both sides they stay symmetric, and what they miss of the row's sum
  !> goes to the cell itself, so that constants and areas are kept as before.
  pure subroutine round_weights(two_level, area, weight)
    type(two_level_t), intent(inout) :: two_level
    real(dp), intent(in) :: area(:), weight(:)
    integer :: l

    two_level%s = real(weight, sp)
    allocate (two_level%rest(size(area)))
    do l = 1, size(area)
      associate (first => two_level%offset(l), last => two_level%offset(l+1) - 1)
        two_level%rest(l) = (1.0_dp - dot_product(real(two_level%s(first:last), dp), &
          area(two_level%cell(first:last))))/area(l)
      end associate
    end do
  end subroutine round_weights

  !> The transposed weights on the same pattern: K is within ell of L when L is within ell of K.
  pure subroutine fill_transpose(two_level, weight)
    type(two_level_t), intent(inout) :: two_level
    real(dp), intent(in) :: weight(:)
    integer, allocatable :: filled(:)
    integer :: l, k, p

    allocate (two_level%adjoint(size(weight)), filled(size(two_level%offset)-1))
    filled = 0
    do l = 1, size(filled)
      do k = two_level%offset(l), two_level%offset(l+1) - 1
        p = two_level%offset(two_level%cell(k)) + filled(two_level%cell(k))
        two_level%adjoint(p) = weight(k)
        filled(two_level%cell(k)) = filled(two_level%cell(k)) + 1
      end do
    end do
  end subroutine fill_transpose
end module talus_two_level
