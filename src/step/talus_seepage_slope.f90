! SPDX-License-Identifier: MIT
!> How the fluxes (src/THEORY.md (4.13)) answer to a change of the pressures: the two-point part by
!> differences at both ends of each face, the oblique part, which is linear in the head, as it is.
!> Newton's method solves with it, and the stability of explicit steps rests on it.
module talus_seepage_slope
  use talus_kinds, only: dp
  use talus_disc, only: disc_t
  use talus_ground, only: ground_t
  use talus_state, only: state_t
  use talus_water_curve, only: curve_at_pressure
  use talus_darcy, only: seepage_t, face_two_point, face_oblique, oblique_mean, cell_outflow
  use talus_head_slope, only: head_slope
  implicit none
  private
  public :: slope_t, slope_prepare, slope_faces, slope_outflow

  type :: slope_t
    real(dp), allocatable :: face(:,:)     !! dq/dp at both ends of a face [m2/(s Pa)], (2,ne)
    real(dp), allocatable :: probe(:,:)    !! step of differencing, potential and k there, (3,n)
    real(dp), allocatable :: head(:,:)     !! head of a change [m], (2,n); second row unused zeros
    real(dp), allocatable :: gradient(:,:) !! area times its gradient [m2], (4,n)
    real(dp), allocatable :: q(:)          !! flux of a change through each face [m2/s], (ne)
  end type slope_t

  !> Pressure below which the step of differencing is absolute [Pa], and that step over it.
  real(dp), parameter :: pressure_scale = 100.0_dp, difference = 1.0e-7_dp

contains

  !> Work space of a discretisation.
  subroutine slope_prepare(slope, disc)
    type(slope_t), intent(inout) :: slope
    type(disc_t), intent(in) :: disc
    integer :: faces

    faces = size(disc%dual%edge_node, 2)
    allocate (slope%face(2, faces), slope%probe(3, disc%n), slope%gradient(4, disc%n), &
      slope%q(faces))
    allocate (slope%head(2, disc%n), source=0.0_dp)
  end subroutine slope_prepare

  !> Derivatives of all faces' fluxes in the present state.
  subroutine slope_faces(slope, seepage, disc, ground, state)
    type(slope_t), intent(inout) :: slope
    type(seepage_t), intent(in) :: seepage !! with the fluxes of the state
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(state_t), intent(in) :: state
    real(dp) :: unused(2)
    integer :: e, i

    !$omp parallel default(none) shared(slope, seepage, disc, ground, state) private(i, e, unused)
    !$omp do schedule(static)
    do i = 1, disc%n
      slope%probe(1, i) = -difference*(abs(state%pressure(i)) + pressure_scale)
      call curve_at_pressure(ground%curve(disc%soil(i)), state%pressure(i) + slope%probe(1, i), &
        unused(1), slope%probe(3, i), slope%probe(2, i), unused(2))
    end do
    !$omp end do
    !$omp do schedule(static)
    do e = 1, size(slope%face, 2)
      call face_slope(slope%probe, seepage, disc, ground, state, e, slope%face(:, e))
    end do
    !$omp end do
    !$omp end parallel
  end subroutine slope_faces

  !> Derivatives of a face's flux by the pressures at its ends, with the smoothed gradient of the
  !> oblique part as it is.
  pure subroutine face_slope(probe, seepage, disc, ground, state, e, slope)
    real(dp), intent(in) :: probe(:,:) !! step of differencing, potential and k there, (3,n)
    type(seepage_t), intent(in) :: seepage
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(state_t), intent(in) :: state
    integer, intent(in) :: e
    real(dp), intent(out) :: slope(2) !! [m2/(s Pa)]
    real(dp) :: p(2), phi(2), k(2), q, q_probe, peclet, mean, q_oblique
    integer :: node(2), side

    node = disc%dual%edge_node(:, e)
    p = state%pressure(node)
    phi = state%potential(node)
    k = state%ratio(node)
    call face_two_point(seepage, disc, ground, e, p, phi, k, q, peclet)
    if (seepage%flux%oblique) then
      mean = oblique_mean(seepage%flux%share(:, e), k)
      q_oblique = face_oblique(seepage, disc, e, state%ratio, seepage%slope)
    end if
    do side = 1, 2
      p(side) = p(side) + probe(1, node(side))
      phi(side) = probe(2, node(side))
      k(side) = probe(3, node(side))
      call face_two_point(seepage, disc, ground, e, p, phi, k, q_probe, peclet)
      if (seepage%flux%oblique) q_probe = q_probe + q_oblique &
        *(oblique_mean(seepage%flux%share(:, e), k)/mean - 1.0_dp)
      slope(side) = (q_probe - q)/(p(side) - state%pressure(node(side)))
      p(side) = state%pressure(node(side))
      phi(side) = state%potential(node(side))
      k(side) = state%ratio(node(side))
    end do
  end subroutine face_slope

  !> Net outflow of the cells by a change of pressure, 0 in held cells: of all fluxes, or of what
  !> the change of the smoothed gradient adds alone.
  subroutine slope_outflow(slope, seepage, disc, ground, ratio, change, all_fluxes, outflow)
    type(slope_t), intent(inout) :: slope
    type(seepage_t), intent(in) :: seepage
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    real(dp), contiguous, intent(in) :: ratio(:)  !! k_r, (n)
    real(dp), intent(in) :: change(disc%n)        !! of pressure [Pa], any array of n
    logical, intent(in) :: all_fluxes
    real(dp), intent(inout) :: outflow(disc%n)    !! [m2/s], any array of n
    integer :: e, i

    !$omp parallel default(none) private(e, i) &
    !$omp shared(slope, seepage, disc, ground, ratio, change, all_fluxes, outflow)
    if (seepage%flux%oblique) then
      !$omp do schedule(static)
      do i = 1, disc%n
        slope%head(1, i) = change(i)/ground%unit_weight
      end do
      !$omp end do
      call head_slope(disc, size(ground%law) > 1, slope%head, slope%gradient)
    end if
    !$omp do schedule(static)
    do e = 1, size(slope%q)
      slope%q(e) = 0.0_dp
      if (all_fluxes) slope%q(e) = dot_product(slope%face(:, e), change(disc%dual%edge_node(:, e)))
      if (seepage%flux%oblique) slope%q(e) = slope%q(e) &
        + face_oblique(seepage, disc, e, ratio, slope%gradient)
    end do
    !$omp end do
    !$omp do schedule(static)
    do i = 1, disc%n
      outflow(i) = 0.0_dp
      if (.not. seepage%held(i)) outflow(i) = cell_outflow(disc%dual, slope%q, i)
    end do
    !$omp end do
    !$omp end parallel
  end subroutine slope_outflow
end module talus_seepage_slope
