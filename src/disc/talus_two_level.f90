! SPDX-License-Identifier: MIT
!> Second level of the gradient smoothing (src/THEORY.md (4.6), (4.7); Wang & Li 2013). The gradient
!> of the first level is averaged once more, over a physical length ell: F = W F1. With the default
!> weights W = S A, S symmetric, every row sum one: constant strain is kept and the integration
!> constraint of the first level is kept exactly, and the adjoint is the same operator.
module talus_two_level
  use talus_kinds, only: dp
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

  !>   F(L) = sum of s(k) A(K) F1(K),     R(L) = sum of sa(k) A(K) P(K),   K = cell(k)
  type :: two_level_t
    integer, allocatable :: offset(:) !! first entry of each cell, (n+1)
    integer, allocatable :: cell(:)   !! cells within ell, ascending
    real(dp), allocatable :: s(:)     !! weight over area [1/m2]
    real(dp), allocatable :: sa(:)    !! the transpose of s, when it differs from s [1/m2]
    integer :: sweeps = 0             !! Sinkhorn sweeps used
  end type two_level_t

contains

  !> Build the weights.
  subroutine two_level_build(two_level, x, area, length, weights, status)
    type(two_level_t), intent(out) :: two_level
    real(dp), contiguous, intent(in) :: x(:,:) !! nodes [m], (2,n)
    real(dp), intent(in) :: area(:) !! cell areas [m2], (n)
    real(dp), intent(in) :: length  !! ell: support radius of the weights [m]
    integer, intent(in) :: weights  !! one of weights_*
    type(status_t), intent(inout) :: status
    real(dp), allocatable :: support(:)
    type(cell_list_t) :: list

    allocate (support(size(area)))
    support = length
    call cell_list_build(list, x, support)
    call cell_list_supports(list, x, two_level%offset, two_level%cell, status)
    if (status_failed(status)) return
    allocate (two_level%s(size(two_level%cell)))
    select case (weights)
    case (weights_rk)
      call fill_rk(two_level, x, area, support, status)
    case default
      call fill_kernel(two_level, x, length)
    end select
    if (weights == weights_area) call normalise_rows(two_level, area)
    if (weights == weights_symmetric) then
      call sinkhorn(two_level, area, status)
    else
      call fill_transpose(two_level)
    end if
  end subroutine two_level_build

  !> Kernel values of all pairs.
  subroutine fill_kernel(two_level, x, length)
    type(two_level_t), intent(inout) :: two_level
    real(dp), intent(in) :: x(:,:), length
    integer :: l, k

    !$omp parallel do default(none) shared(two_level, x, length) private(l, k) schedule(static)
    do l = 1, size(x, 2)
      do k = two_level%offset(l), two_level%offset(l+1) - 1
        two_level%s(k) = kernel_spline(norm2(x(:, two_level%cell(k)) - x(:, l))/length)
      end do
    end do
    !$omp end parallel do
  end subroutine fill_kernel

  !> Plain area-weighted average.
  pure subroutine normalise_rows(two_level, area)
    type(two_level_t), intent(inout) :: two_level
    real(dp), intent(in) :: area(:)
    integer :: l

    do l = 1, size(area)
      associate (first => two_level%offset(l), last => two_level%offset(l+1) - 1)
        two_level%s(first:last) = two_level%s(first:last) &
          /dot_product(two_level%s(first:last), area(two_level%cell(first:last)))
      end associate
    end do
  end subroutine normalise_rows

  !> Reproducing-kernel values at the nodes, the paper's reading of the second level.
  subroutine fill_rk(two_level, x, area, support, status)
    type(two_level_t), intent(inout) :: two_level
    real(dp), intent(in) :: x(:,:), area(:), support(:)
    type(status_t), intent(inout) :: status
    integer :: l, bad
    logical :: regular

    bad = 0
    do l = 1, size(area)
      associate (first => two_level%offset(l), last => two_level%offset(l+1) - 1)
        associate (near => two_level%cell(first:last))
          call rk_shape(x(:, l), x(:, near), support(near), two_level%s(first:last), regular)
          two_level%s(first:last) = two_level%s(first:last)/area(near)
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
  subroutine sinkhorn(two_level, area, status)
    type(two_level_t), intent(inout) :: two_level
    real(dp), intent(in) :: area(:)
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
      !$omp parallel do default(none) shared(two_level, area, d, row) private(l, k) &
      !$omp reduction(max:worst) schedule(static)
      do l = 1, size(area)
        row(l) = 0.0_dp
        do k = two_level%offset(l), two_level%offset(l+1) - 1
          row(l) = row(l) + two_level%s(k)*d(two_level%cell(k))*area(two_level%cell(k))
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
        two_level%s(k) = d(l)*d(two_level%cell(k))*two_level%s(k)
      end do
    end do
  end subroutine sinkhorn

  !> The transposed weights on the same pattern: K is within ell of L when L is within ell of K.
  pure subroutine fill_transpose(two_level)
    type(two_level_t), intent(inout) :: two_level
    integer, allocatable :: filled(:)
    integer :: l, k, p

    allocate (two_level%sa(size(two_level%s)), filled(size(two_level%offset)-1))
    filled = 0
    do l = 1, size(filled)
      do k = two_level%offset(l), two_level%offset(l+1) - 1
        p = two_level%offset(two_level%cell(k)) + filled(two_level%cell(k))
        two_level%sa(p) = two_level%s(k)
        filled(two_level%cell(k)) = filled(two_level%cell(k)) + 1
      end do
    end do
  end subroutine fill_transpose
end module talus_two_level
