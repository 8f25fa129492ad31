! SPDX-License-Identifier: MIT
!> All eigenfrequencies of the soil and all rates of the water of a small model by LAPACK, to see
!> that no mode is spurious and that the estimates of the stable steps are sharp (src/THEORY.md
!> sections 4.5, 5.1 and 5.5).
module talus_spectrum
  use talus_kinds, only: dp
  use talus_lapack, only: dsyev, dsygv, dgeev
  use talus_disc, only: disc_t
  use talus_ground, only: ground_t
  use talus_state, only: state_t
  use talus_soil_step, only: work_t, motion_t
  use talus_inertia, only: inertia_apply
  use talus_time_step, only: stiffness_apply, water_bulk_modulus
  use talus_darcy, only: seepage_t
  use talus_seepage_slope, only: slope_t, slope_prepare, slope_faces, slope_outflow
  implicit none
  private
  public :: spectrum_frequencies, spectrum_rates

  !> Largest model whose dense matrix is reasonable: (2n)^2 numbers.
  integer, parameter, public :: spectrum_most_nodes = 1500

contains

  !> Squares of the eigenfrequencies of M^-1 K over the directions that can move, ascending.
  subroutine spectrum_frequencies(disc, ground, state, motion, work, square)
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(state_t), intent(in) :: state
    type(motion_t), intent(in) :: motion
    type(work_t), intent(inout) :: work
    real(dp), allocatable, intent(out) :: square(:) !! omega^2 [1/s2]
    real(dp), allocatable :: a(:,:), b(:,:), d(:,:), nothing(:,:), bulk(:), root(:)
    real(dp), allocatable :: lapack_work(:)
    integer, allocatable :: free(:)
    integer :: i, k, m, info

    allocate (d(2, disc%n), nothing(2, disc%n), bulk(disc%n))
    nothing = 0.0_dp
    call water_bulk_modulus(disc, ground, state, motion%coupled, bulk)
    root = sqrt(reshape(motion%mobility, [2*disc%n]))
    free = pack([(i, i=1, 2*disc%n)], root > 0.0_dp)
    m = size(free)
    allocate (a(m, m), square(m), lapack_work(max(1, 34*m)))
    do k = 1, m
      d = 0.0_dp
      d(1 + modulo(free(k) - 1, 2), 1 + (free(k) - 1)/2) = root(free(k))
      call stiffness_apply(disc, ground, state, bulk, nothing, d, work)
      do i = 1, m
        a(i, k) = root(free(i))*work%force(1 + modulo(free(i) - 1, 2), 1 + (free(i) - 1)/2)
      end do
    end do
    a = 0.5_dp*(a + transpose(a))
    if (motion%consistent) then
      ! A B x = omega^2 x with A = m^-1/2 K m^-1/2 and B = m^1/2 M^-1 m^1/2.
      call inverse_mass(disc, motion, free, root, b)
      call dsygv(2, 'N', 'U', m, a, m, b, m, square, lapack_work, size(lapack_work), info)
    else
      call dsyev('N', 'U', m, a, m, square, lapack_work, size(lapack_work), info)
    end if
    if (info /= 0) square = -1.0_dp
  end subroutine spectrum_frequencies

  !> The inverse of the consistent mass over the directions that can move, times the root of the
  !> lumped one from both sides.
  subroutine inverse_mass(disc, motion, free, root, b)
    type(disc_t), intent(in) :: disc
    type(motion_t), intent(in) :: motion
    integer, intent(in) :: free(:)   !! directions 2*(node - 1) + axis
    real(dp), intent(in) :: root(:)  !! of the mobility
    real(dp), allocatable, intent(out) :: b(:,:)
    real(dp), allocatable :: d(:,:), column(:,:)
    integer :: i, k

    allocate (b(size(free), size(free)), d(2, disc%n), column(2, disc%n))
    do k = 1, size(free)
      d = 0.0_dp
      d(1 + modulo(free(k) - 1, 2), 1 + (free(k) - 1)/2) = 1.0_dp/root(free(k))
      call inertia_apply(disc%dual, motion%pair_mass, motion%mobility, d, column)
      do i = 1, size(free)
        b(i, k) = column(1 + modulo(free(i) - 1, 2), 1 + (free(i) - 1)/2)/root(free(i))
      end do
    end do
  end subroutine inverse_mass

  !> Rates at which small changes of the pressures of free cells decay, the eigenvalues of C^-1 K;
  !> the fluxes are not quite symmetric on distorted grids and under gravity, so a few may be
  !> complex.
  subroutine spectrum_rates(seepage, disc, ground, state, rate)
    type(seepage_t), intent(in) :: seepage !! with the fluxes of the state
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(state_t), intent(in) :: state
    complex(dp), allocatable, intent(out) :: rate(:) !! [1/s], in LAPACK's order
    type(slope_t) :: slope
    real(dp), allocatable :: a(:,:), change(:), outflow(:), parts(:,:), lapack_work(:)
    real(dp) :: left(1, 1), right(1, 1)
    integer, allocatable :: free(:)
    integer :: i, k, m, info

    free = pack([(i, i=1, disc%n)], .not. seepage%held)
    m = size(free)
    allocate (a(m, m), rate(m), parts(m, 2), lapack_work(max(1, 34*m)))
    allocate (change(disc%n), outflow(disc%n))
    call slope_prepare(slope, disc)
    call slope_faces(slope, seepage, disc, ground, state)
    do k = 1, m
      change = 0.0_dp
      change(free(k)) = 1.0_dp
      call slope_outflow(slope, seepage, disc, ground, state%ratio, change, .true., outflow)
      a(:, k) = outflow(free)/(disc%dual%area(free)*state%capacity(free))
    end do
    call dgeev('N', 'N', m, a, m, parts(:, 1), parts(:, 2), left, 1, right, 1, lapack_work, &
      size(lapack_work), info)
    rate = cmplx(parts(:, 1), parts(:, 2), dp)
    if (info /= 0) rate = (-1.0_dp, 0.0_dp)
  end subroutine spectrum_rates
end module talus_spectrum
