! SPDX-License-Identifier: MIT
!> Longest step at which explicit seepage is stable: 2/lambda of the greatest eigenvalue of
!>
!>   lambda A C dp = net outflow of the faces by dp,   dp = 0 in held cells
!>
!> in the present state, C = dw/dp (src/THEORY.md (5.4a)), found without a matrix. The fluxes are
!> all of them: two-point and oblique, capillary and by gravity. Runs use the shorter step (5.4).
module talus_seepage_stable
  use talus_kinds, only: dp
  use talus_disc, only: disc_t
  use talus_ground, only: ground_t
  use talus_state, only: state_t
  use talus_rayleigh, only: search_t, search_begin, search_turn, direction_start, &
    direction_residual
  use talus_darcy, only: seepage_t
  use talus_seepage_slope, only: slope_t, slope_prepare, slope_faces, slope_outflow
  implicit none
  private
  public :: seepage_step_stable

  !> Relative change of the rate in a turn at which the search ends: on regular nodes many modes are
  !> nearly as fast as the fastest, and the search is slow.
  real(dp), parameter :: tolerance = 1.0e-7_dp

contains

  !> Longest stable step [s], without safety; huge where no water moves.
  !>
  !> Pressures count by A C k_r, so that the eigenvectors of a two-point flux in one soil are
  !> orthogonal: it is symmetric in the potential.
  real(dp) function seepage_step_stable(seepage, disc, ground, state) result(step)
    type(seepage_t), intent(in) :: seepage !! with the fluxes of the state
    type(disc_t), intent(in) :: disc
    type(ground_t), intent(in) :: ground
    type(state_t), intent(in) :: state
    type(slope_t) :: slope
    type(search_t) :: search
    real(dp), allocatable :: mobility(:,:), weight(:), storage(:)

    step = huge(1.0_dp)
    if (all(seepage%held)) return
    call slope_prepare(slope, disc)
    call slope_faces(slope, seepage, disc, ground, state)
    weight = max(state%ratio, tiny(1.0_dp)/epsilon(1.0_dp)**2)
    allocate (mobility(1, disc%n))
    allocate (search%now%d(1, disc%n), search%now%m(1, disc%n), search%now%k(1, disc%n))
    storage = disc%dual%area*state%capacity*weight
    mobility(1, :) = merge(0.0_dp, 1.0_dp/storage, seepage%held)
    search%symmetric = .false.
    search%tolerance = tolerance
    associate (now => search%now, ahead => search%ahead)
      call direction_start(mobility, now%d)
      now%m(1, :) = storage*now%d(1, :)
      call conduct(now%d, now%k)
      call search_begin(search)
      do while (.not. search%done)
        call direction_residual(now, search%quotient, ahead%m)
        ahead%d = mobility*ahead%m
        call conduct(ahead%d, ahead%k)
        call search_turn(search)
      end do
    end associate
    if (search%quotient > 2.0_dp/huge(1.0_dp)) step = 2.0_dp/search%quotient

  contains

    subroutine conduct(d, k)
      real(dp), contiguous, intent(in) :: d(:,:)    !! pressures [Pa], (1,n)
      real(dp), contiguous, intent(inout) :: k(:,:) !! outflow times k_r [m2/s], (1,n)

      call slope_outflow(slope, seepage, disc, ground, state%ratio, d, .true., k)
      k(1, :) = weight*k(1, :)
    end subroutine conduct
  end function seepage_step_stable
end module talus_seepage_stable
