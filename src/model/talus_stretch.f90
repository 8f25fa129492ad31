! SPDX-License-Identifier: MIT
!> Stretch of one point in plane strain, a strain without rotation that is linear in F, and the
!> Piola stress of an energy that is a function of it (src/THEORY.md (4.10a)).
!>
!> F takes a vector w, as a complex number, to a w + g conj(w). With R the rotation by the angle of
!> a, the stretch U = R^T F has |a| for a and g conj(a)/|a| for g: no root of a tensor is needed.
!> A stretch is stored as half the trace of U - 1, half of U_11 - U_22, U_12, then the cosine and
!> sine of R and how fast R turns with F, one over |a|.
module talus_stretch
  use talus_kinds, only: dp
  implicit none
  private
  public :: stretch_of, stretch_change, stretch_piola

contains

  !> Stretch of F = 1 + h.
  pure subroutine stretch_of(h, stretch)
    real(dp), intent(in) :: h(4)         !! displacement gradient 11, 12, 21, 22 [-]
    real(dp), intent(out) :: stretch(6)

    call rotation(1.0_dp + 0.5_dp*(h(1) + h(4)), 0.5_dp*(h(3) - h(2)), stretch)
    stretch(1) = 1.0_dp/stretch(6) - 1.0_dp
    call deviator(h, stretch)
  end subroutine stretch_of

  !> Change of the stretch with a small change of F, where U is near 1: that of F turned back by the
  !> rotation of F, which stays.
  pure subroutine stretch_change(f, change, stretch)
    real(dp), intent(in) :: f(4)         !! deformation gradient 11, 12, 21, 22 [-]
    real(dp), intent(in) :: change(4)    !! of it
    real(dp), intent(out) :: stretch(6)

    call rotation(0.5_dp*(f(1) + f(4)), 0.5_dp*(f(3) - f(2)), stretch)
    stretch(1) = 0.5_dp*(stretch(4)*(change(1) + change(4)) + stretch(5)*(change(3) - change(2)))
    call deviator(change, stretch)
    stretch(6) = 0.0_dp
  end subroutine stretch_change

  !> Rotation of a, and one over its size.
  pure subroutine rotation(real_part, imaginary, stretch)
    real(dp), intent(in) :: real_part, imaginary
    real(dp), intent(inout) :: stretch(6)

    ! Nothing of a is left only where F turns inside out.
    stretch(6) = 1.0_dp/sqrt(max(real_part**2 + imaginary**2, epsilon(1.0_dp)**2))
    stretch(4) = real_part*stretch(6)
    stretch(5) = imaginary*stretch(6)
  end subroutine rotation

  !> g turned back by R.
  pure subroutine deviator(h, stretch)
    real(dp), intent(in) :: h(4)
    real(dp), intent(inout) :: stretch(6)
    real(dp) :: g(2)

    g = 0.5_dp*[h(1) - h(4), h(2) + h(3)]
    stretch(2) = stretch(4)*g(1) + stretch(5)*g(2)
    stretch(3) = stretch(4)*g(2) - stretch(5)*g(1)
  end subroutine deviator

  !> First Piola stress from the derivatives of an energy by the first three numbers of a stretch.
  pure subroutine stretch_piola(stretch, slope, piola)
    real(dp), intent(in) :: stretch(6)
    real(dp), intent(in) :: slope(3)   !! [Pa]
    real(dp), intent(out) :: piola(4)  !! 11, 12, 21, 22 [Pa]
    real(dp) :: turn, a(2), g(2)

    ! R turns with a, and with it the deviator.
    turn = (slope(2)*stretch(3) - slope(3)*stretch(2))*stretch(6)
    a = [stretch(4)*slope(1) - stretch(5)*turn, stretch(5)*slope(1) + stretch(4)*turn]
    g = [stretch(4)*slope(2) - stretch(5)*slope(3), stretch(5)*slope(2) + stretch(4)*slope(3)]
    piola = 0.5_dp*[a(1) + g(1), g(2) - a(2), g(2) + a(2), a(1) - g(1)]
  end subroutine stretch_piola
end module talus_stretch
