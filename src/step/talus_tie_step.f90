! SPDX-License-Identifier: MIT
!> The tie of the levels at work (src/THEORY.md (4.10a), (4.10b)). Node i and cell j within ell share the
!> energy
!>   1/2 A_i A_j S_ij k_i k_j |U_i - e_j|^2, in the elastic moduli of the soil,
!> U the stretch of the first level, k how intact the soil is, and e_j the mean of U that makes the sum
!> least: so nothing acts on e_j, and the force needs no more than a second gather, with that of stress.
!>
!>   tie_measure     U of every node, and what is gathered of it   (smooth_gradient_tied gathers)
!>   tie_means       e_j of every cell, in its place               (smooth_stress_tied gathers)
!>   tie_slopes      derivatives of the energy by U
module talus_tie_step
  use talus_kinds, only: dp
  use talus_tie, only: tie_t
  use talus_stretch, only: stretch_of, stretch_change
  implicit none
  private
  public :: tie_measure, tie_means, tie_slopes

contains

  !> Stretch of each node and its weights. How intact soil is goes by the fourth power of its stiffness
  !> (4.11), and never back: the tie is gone before plastic strain is as large as elastic strain was. Then
  !> the levels are tied as (4.10) says, by what is left.
  subroutine tie_measure(tie, area, h, stretch, weighed, f, stiffness, intact, between, between_old)
    type(tie_t), intent(in) :: tie
    real(dp), contiguous, intent(in) :: area(:)            !! cell areas [m2], (n)
    real(dp), contiguous, intent(in) :: h(:,:)             !! area times first-level gradient [m2], (4,n)
    real(dp), contiguous, intent(inout) :: stretch(:,:)    !! of talus_stretch, (6,n)
    real(dp), contiguous, intent(inout) :: weighed(:,:)    !! area times weight, that times U, for volume
                                                           !! and for shear, (5,n)
    real(dp), contiguous, intent(in), optional :: f(:,:)   !! then h is a small change of this, and all
                                                           !! soil taken as intact, (4,n)
    real(dp), contiguous, intent(in), optional :: stiffness(:) !! left at each node, 0..1, (n)
    real(dp), contiguous, intent(inout), optional :: intact(:) !! how intact the soil is, 0..1, (n)
    ! Stiffness between the levels, now and one step ago, (n).
    real(dp), contiguous, intent(inout), optional :: between(:), between_old(:)
    real(dp) :: bulk, shear
    integer :: i

    !$omp do schedule(static)
    do i = 1, size(area)
      bulk = area(i)*tie%bulk(i)
      shear = area(i)*tie%shear(i)
      if (present(f)) then
        call stretch_change(f(:, i), h(:, i)/area(i), stretch(:, i))
      else
        call stretch_of(h(:, i)/area(i), stretch(:, i))
        intact(i) = min(intact(i), stiffness(i)**4)
        between_old(i) = between(i)
        between(i) = (1.0_dp - intact(i))*stiffness(i)
        bulk = bulk*intact(i)
        shear = shear*intact(i)
      end if
      weighed(:, i) = [bulk, bulk*stretch(1, i), shear, shear*stretch(2, i), shear*stretch(3, i)]
    end do
    !$omp end do
  end subroutine tie_measure

  !> Replace each node's own stretch by the mean around it.
  subroutine tie_means(mean, weighed)
    real(dp), contiguous, intent(in) :: mean(:,:)       !! `weighed` as gathered, (5,n)
    real(dp), contiguous, intent(inout) :: weighed(:,:) !! see tie_measure, (5,n)
    real(dp) :: bulk, shear
    integer :: i

    !$omp do schedule(static)
    do i = 1, size(mean, 2)
      ! Where no soil around is intact nothing is tied.
      bulk = weighed(1, i)/max(mean(1, i), tiny(1.0_dp))
      shear = weighed(3, i)/max(mean(3, i), tiny(1.0_dp))
      weighed(2, i) = bulk*mean(2, i)
      weighed(4, i) = shear*mean(4, i)
      weighed(5, i) = shear*mean(5, i)
    end do
    !$omp end do
  end subroutine tie_means

  !> Derivatives of the energy by the stretch of a node [Pa].
  pure function tie_slopes(bulk, shear, stretch, around) result(slope)
    real(dp), intent(in) :: bulk, shear !! weights of the node [Pa^1/2]
    real(dp), intent(in) :: stretch(6)  !! of the node
    real(dp), intent(in) :: around(5)   !! what tie_means left, as gathered [Pa^1/2]
    real(dp) :: slope(3)

    slope = [bulk*(around(1)*stretch(1) - around(2)), shear*(around(3)*stretch(2) - around(4)), &
             shear*(around(3)*stretch(3) - around(5))]
  end function tie_slopes
end module talus_tie_step
