! SPDX-License-Identifier: MIT
!> The tie of the levels at work (src/THEORY.md (4.10a), (4.10b)). Node I and cell J within ell share
!> the energy
!>   1/2 A_I A_J S_IJ w_I w_J |U_I - e_J|^2, in the elastic moduli of the soil,
!> U the stretch of the first level, w the weight of soil that is intact, and e_J the mean of U that
!> makes the sum least: so nothing acts on e_J, and the force takes no more than a second gather.
!>
!>   tie_measure     U of every node, and what is gathered of it   (smooth_gradient_tied gathers)
!>   tie_means       e_J of every cell, in its place               (smooth_stress_tied gathers)
!>   tie_slopes      derivatives of the energy by U
module talus_tie_step
  use talus_kinds, only: dp
  use talus_tie, only: tie_t
  use talus_stretch, only: stretch_of, stretch_change
  implicit none
  private
  public :: tie_measure, tie_means, tie_slopes

contains

  !> Stretch of each node and its weights. How intact soil is goes by the fourth power of its
  !> stiffness (4.11), and never back: the tie is gone before plastic strain is as large as elastic
  !> strain was. Then the levels are tied as (4.10) says, by what is left.
  subroutine tie_measure(tie, area, h, stretch, weighed, f, stiffness, intact, between, between_old)
    type(tie_t), intent(in) :: tie
    real(dp), contiguous, intent(in) :: area(:)         !! cell areas [m2], (n)
    real(dp), contiguous, intent(in) :: h(:,:)          !! area times first-level gradient [m2], (4,n)
    real(dp), contiguous, intent(inout) :: stretch(:,:) !! of talus_stretch, (6,n)
    real(dp), contiguous, intent(inout) :: weighed(:,:) !! area times weight, and that times U, (4,n)
    ! A small change of this deformation gradient, all soil taken as intact:
    real(dp), contiguous, intent(in), optional :: f(:,:)       !! (4,n)
    ! or a motion:
    real(dp), contiguous, intent(in), optional :: stiffness(:) !! left at each node, 0..1, (n)
    real(dp), contiguous, intent(inout), optional :: intact(:) !! how intact the soil is, 0..1, (n)
    ! Stiffness between the levels, now and one step ago, (n).
    real(dp), contiguous, intent(inout), optional :: between(:), between_old(:)
    real(dp) :: weight
    integer :: i

    !$omp do schedule(static)
    do i = 1, size(area)
      weight = area(i)*tie%shear(i)
      if (present(f)) then
        call stretch_change(f(:, i), h(:, i)/area(i), stretch(:, i))
      else
        call stretch_of(h(:, i)/area(i), stretch(:, i))
        intact(i) = min(intact(i), stiffness(i)**4)
        between_old(i) = between(i)
        between(i) = (1.0_dp - intact(i))*stiffness(i)
        weight = weight*intact(i)
      end if
      weighed(1, i) = weight
      weighed(2:4, i) = weight*stretch(1:3, i)
    end do
    !$omp end do
  end subroutine tie_measure

  !> Replace each node's own stretch by the mean around it, in its moduli.
  subroutine tie_means(tie, mean, weighed)
    type(tie_t), intent(in) :: tie
    real(dp), contiguous, intent(in) :: mean(:,:)       !! `weighed` as gathered, (4,n)
    real(dp), contiguous, intent(inout) :: weighed(:,:) !! of tie_measure; area times weight times the
                                                        !! modulus of volume, that times its mean, and
                                                        !! area times weight times means of shear, (4,n)
    real(dp) :: weight
    integer :: i

    !$omp do schedule(static)
    do i = 1, size(mean, 2)
      ! Where no soil around is intact nothing is tied.
      weight = weighed(1, i)/max(mean(1, i), tiny(1.0_dp))
      weighed(1, i) = tie%volume(i)*weighed(1, i)
      weighed(2, i) = tie%volume(i)*weight*mean(2, i)
      weighed(3:4, i) = weight*mean(3:4, i)
    end do
    !$omp end do
  end subroutine tie_means

  !> Derivatives of the energy by the stretch of a node [Pa].
  pure function tie_slopes(weight, stretch, sum_of_weights, around) result(slope)
    real(dp), intent(in) :: weight         !! of the node [Pa^1/2]
    real(dp), intent(in) :: stretch(6)     !! of the node
    real(dp), intent(in) :: sum_of_weights !! around it, the first of the means [Pa^1/2]
    real(dp), intent(in) :: around(4)      !! what tie_means left, as gathered [Pa^1/2]
    real(dp) :: slope(3)

    slope(1) = weight*(around(1)*stretch(1) - around(2))
    slope(2:3) = weight*(sum_of_weights*stretch(2:3) - around(3:4))
  end function tie_slopes
end module talus_tie_step
