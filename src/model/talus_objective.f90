! SPDX-License-Identifier: MIT
!> Incrementally objective kinematics of one point in plane strain.
!!
!! Deformation gradients are stored (11,12,21,22) with F_ij = dx_i/dX_j; symmetric tensors are
!! stored (xx,yy,zz,xy) with tensorial shear. A rotation is stored as (cos, sin) of
!! Q = [cos -sin; sin cos]. Equations: src/THEORY.md (3.1), (3.2); Hughes & Winget (1980).
module talus_objective
  use talus_kinds, only: dp
  implicit none
  private
  public :: objective_increment, tensor_rotate, strain_advance, piola_stress

contains

  !> Strain increment and exact rotation over a step, from h = (F_new - F_old) F_mid^-1:
  !! the symmetric part is the strain increment, the skew part w gives
  !! Q = (1 - w/2)^-1 (1 + w/2), which is orthogonal for a step of any size.
  pure subroutine objective_increment(f_old, f_new, dstrain, rotation, det_new, ierr)
    real(dp), intent(in) :: f_old(4)      !! deformation gradient before the step [-]
    real(dp), intent(in) :: f_new(4)      !! deformation gradient after the step [-]
    real(dp), intent(out) :: dstrain(4)   !! strain increment [-], tension +, zz = 0
    real(dp), intent(out) :: rotation(2)  !! cosine and sine of the rotation of the step [-]
    real(dp), intent(out) :: det_new      !! det F_new [-]
    integer, intent(out) :: ierr          !! 0, or 1 when det F_mid or det F_new is not positive
    real(dp) :: m11, m12, m21, m22, d11, d12, d21, d22, det_mid, inv, h12, h21, a, a2

    m11 = 0.5_dp*(f_old(1) + f_new(1))
    m12 = 0.5_dp*(f_old(2) + f_new(2))
    m21 = 0.5_dp*(f_old(3) + f_new(3))
    m22 = 0.5_dp*(f_old(4) + f_new(4))
    det_mid = m11*m22 - m12*m21
    det_new = f_new(1)*f_new(4) - f_new(2)*f_new(3)
    if (.not. (det_mid > 0.0_dp .and. det_new > 0.0_dp)) then
      ierr = 1
      dstrain = 0.0_dp
      rotation = [1.0_dp, 0.0_dp]
      return
    end if
    ierr = 0
    d11 = f_new(1) - f_old(1)
    d12 = f_new(2) - f_old(2)
    d21 = f_new(3) - f_old(3)
    d22 = f_new(4) - f_old(4)
    inv = 1.0_dp/det_mid
    h12 = (d12*m11 - d11*m12)*inv
    h21 = (d21*m22 - d22*m21)*inv
    dstrain(1) = (d11*m22 - d12*m21)*inv
    dstrain(2) = (d22*m11 - d21*m12)*inv
    dstrain(3) = 0.0_dp
    dstrain(4) = 0.5_dp*(h12 + h21)
    a = 0.25_dp*(h21 - h12)
    a2 = a*a
    inv = 1.0_dp/(1.0_dp + a2)
    rotation(1) = (1.0_dp - a2)*inv
    rotation(2) = 2.0_dp*a*inv
  end subroutine objective_increment

  !> Rotate a symmetric tensor: t becomes Q t Q^T.
  pure subroutine tensor_rotate(rotation, t)
    real(dp), intent(in) :: rotation(2) !! cosine and sine [-]
    real(dp), intent(inout) :: t(4)     !! symmetric tensor, xx, yy, zz, xy
    real(dp) :: cc, ss, cs, xx, yy, xy

    cc = rotation(1)*rotation(1)
    ss = rotation(2)*rotation(2)
    cs = rotation(1)*rotation(2)
    xx = t(1)
    yy = t(2)
    xy = t(4)
    t(1) = cc*xx - 2.0_dp*cs*xy + ss*yy
    t(2) = ss*xx + 2.0_dp*cs*xy + cc*yy
    t(4) = cs*(xx - yy) + (cc - ss)*xy
  end subroutine tensor_rotate

  !> Advance an objectively integrated strain: strain becomes Q strain Q^T + dstrain. Serves the
  !! strain that drives damage when it comes from a smoothed deformation gradient of its own.
  pure subroutine strain_advance(f_old, f_new, strain, ierr)
    real(dp), intent(in) :: f_old(4)     !! deformation gradient before the step [-]
    real(dp), intent(in) :: f_new(4)     !! deformation gradient after the step [-]
    real(dp), intent(inout) :: strain(4) !! total strain [-], tension +
    integer, intent(out) :: ierr         !! 0, or 1 when a determinant is not positive
    real(dp) :: dstrain(4), rotation(2), det_new

    call objective_increment(f_old, f_new, dstrain, rotation, det_new, ierr)
    if (ierr /= 0) return
    call tensor_rotate(rotation, strain)
    strain = strain + dstrain
  end subroutine strain_advance

  !> First Piola-Kirchhoff stress P = J sigma F^-T.
  pure subroutine piola_stress(f, stress, piola)
    real(dp), intent(in) :: f(4)      !! deformation gradient [-]
    real(dp), intent(in) :: stress(4) !! Cauchy stress [Pa], tension +
    real(dp), intent(out) :: piola(4) !! first Piola stress [Pa], 11, 12, 21, 22

    piola(1) = stress(1)*f(4) - stress(4)*f(2)
    piola(2) = stress(4)*f(1) - stress(1)*f(3)
    piola(3) = stress(4)*f(4) - stress(2)*f(2)
    piola(4) = stress(2)*f(1) - stress(4)*f(3)
  end subroutine piola_stress
end module talus_objective
