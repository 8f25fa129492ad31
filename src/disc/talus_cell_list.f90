! SPDX-License-Identifier: MIT
!> Neighbour search by uniform bins: O(N), and any number of neighbours a point.
!> Points are sorted by bin; a search looks at the bins its circle can reach, and skips those
!> whose largest support radius does not reach back, which keeps graded nodes cheap.
module talus_cell_list
  use talus_kinds, only: dp, i8
  use talus_status, only: status_t, status_set, status_numeric
  use talus_text, only: text_of
  implicit none
  private
  public :: cell_list_t, cell_list_build, cell_list_supports

  type :: cell_list_t
    private
    real(dp) :: low(2)                     !! lower left corner of the bins [m]
    real(dp) :: side                       !! side of a bin [m]
    real(dp) :: reach                      !! largest support radius [m]
    integer :: n_bin(2)                    !! bins along x and y
    integer, allocatable :: offset(:)      !! first entry of each bin
    integer, allocatable :: point(:)       !! point numbers sorted by bin, ascending in a bin
    real(dp), allocatable :: x(:,:)        !! their coordinates [m], (2,n)
    real(dp), allocatable :: radius(:)     !! their support radii [m], (n)
    real(dp), allocatable :: bin_radius(:) !! largest support radius in each bin [m]
  end type cell_list_t

contains

  !> Sort points into bins of about one mean support radius.
  pure subroutine cell_list_build(list, x, radius)
    type(cell_list_t), intent(out) :: list
    real(dp), intent(in) :: x(:,:)    !! points [m], (2,n), n >= 1
    real(dp), intent(in) :: radius(:) !! support radius of each point [m], > 0
    integer, allocatable :: bin(:), filled(:)
    real(dp) :: extent(2)
    integer :: i, p, n

    n = size(x, 2)
    list%low = minval(x, dim=2)
    extent = maxval(x, dim=2) - list%low
    list%reach = maxval(radius)
    list%side = sum(radius)/real(n, dp)
    do while (product(1.0_dp + extent/list%side) > 16.0_dp + 4.0_dp*real(n, dp))
      list%side = 1.5_dp*list%side
    end do
    list%n_bin = 1 + int(extent/list%side)
    allocate (bin(n), filled(product(list%n_bin)), list%offset(product(list%n_bin)+1))
    allocate (list%point(n), list%x(2, n), list%radius(n), list%bin_radius(size(filled)))
    filled = 0
    do i = 1, n
      associate (place => min(int((x(:, i) - list%low)/list%side), list%n_bin - 1))
        bin(i) = 1 + place(1) + place(2)*list%n_bin(1)
      end associate
      filled(bin(i)) = filled(bin(i)) + 1
    end do
    list%offset(1) = 1
    do i = 1, size(filled)
      list%offset(i+1) = list%offset(i) + filled(i)
    end do
    filled = 0
    list%bin_radius = 0.0_dp
    do i = 1, n
      p = list%offset(bin(i)) + filled(bin(i))
      filled(bin(i)) = filled(bin(i)) + 1
      list%point(p) = i
      list%x(:, p) = x(:, i)
      list%radius(p) = radius(i)
      list%bin_radius(bin(i)) = max(list%bin_radius(bin(i)), radius(i))
    end do
  end subroutine cell_list_build

  !> For each query, the points whose support covers it: |query - x| < radius of the point.
  subroutine cell_list_supports(list, query, offset, point, status)
    type(cell_list_t), intent(in) :: list
    real(dp), contiguous, intent(in) :: query(:,:) !! positions [m], (2,m)
    integer, allocatable, intent(out) :: offset(:) !! first entry of each query in `point`, (m+1)
    integer, allocatable, intent(out) :: point(:)  !! point numbers, ascending for each query
    type(status_t), intent(inout) :: status
    integer, allocatable :: count(:)
    integer(i8) :: total
    integer :: i, n, none(0)

    allocate (count(size(query, 2)), offset(size(query, 2)+1))
    !$omp parallel do default(none) schedule(static) shared(list, query, count) private(n, none)
    do i = 1, size(query, 2)
      call scan_supports(list, query(:, i), none, n)
      count(i) = n
    end do
    !$omp end parallel do
    total = sum(int(count, i8))
    if (total >= huge(1)) then
      call status_set(status, status_numeric, 'neighbour search: '//text_of(total)// &
        ' pairs, more than '//text_of(huge(1))//': use fewer nodes or a smaller support')
      return
    end if
    offset(1) = 1
    do i = 1, size(count)
      offset(i+1) = offset(i) + count(i)
    end do
    allocate (point(total))
    !$omp parallel do default(none) schedule(static) shared(list, query, offset, point) private(n)
    do i = 1, size(query, 2)
      call scan_supports(list, query(:, i), point(offset(i):offset(i+1)-1), n)
      call sort_ascending(point(offset(i):offset(i+1)-1))
    end do
    !$omp end parallel do
  end subroutine cell_list_supports

  !> Count the points whose support covers a position, and store as many as there is room for.
  pure subroutine scan_supports(list, position, found, n)
    type(cell_list_t), intent(in) :: list
    real(dp), intent(in) :: position(2)
    integer, intent(inout) :: found(:)
    integer, intent(out) :: n
    real(dp) :: corner(2), gap(2)
    integer :: first(2), last(2), i, j, p, bin

    n = 0
    call bin_range(list, position, first, last)
    do j = first(2), last(2)
      do i = first(1), last(1)
        bin = 1 + i + j*list%n_bin(1)
        corner = list%low + list%side*real([i, j], dp)
        gap = max(corner - position, position - corner - list%side, 0.0_dp) - 1.0e-9_dp*list%side
        if (any(gap > list%bin_radius(bin))) cycle
        do p = list%offset(bin), list%offset(bin+1) - 1
          if (sum((list%x(:, p) - position)**2) < list%radius(p)**2) then
            n = n + 1
            if (n <= size(found)) found(n) = list%point(p)
          end if
        end do
      end do
    end do
  end subroutine scan_supports

  !> Bins within reach of a position, counted from 0; none when it is far from them all.
  pure subroutine bin_range(list, position, first, last)
    type(cell_list_t), intent(in) :: list
    real(dp), intent(in) :: position(2)
    integer, intent(out) :: first(2), last(2)
    real(dp) :: high(2), margin

    margin = list%reach + 1.0e-9_dp*list%side
    high = real(list%n_bin - 1, dp)
    first = int(min(max((position - margin - list%low)/list%side, 0.0_dp), high + 1.0_dp))
    last = floor(max(min((position + margin - list%low)/list%side, high), -1.0_dp))
  end subroutine bin_range

  !> Shell sort: mere insertion for the usual short rows.
  pure subroutine sort_ascending(list)
    integer, intent(inout) :: list(:)
    integer :: i, k, gap, value

    gap = 1
    do while (gap < size(list)/8)
      gap = 3*gap + 1
    end do
    do while (gap >= 1)
      do i = gap + 1, size(list)
        value = list(i)
        do k = i - gap, 1, -gap
          if (list(k) <= value) exit
          list(k+gap) = list(k)
        end do
        list(k+gap) = value
      end do
      gap = gap/3
    end do
  end subroutine sort_ascending
end module talus_cell_list
