! SPDX-License-Identifier: MIT
!> Incrementally objective kinematics of one point in plane strain.
!!
!! Deformation gradients are stored (11,12,21,22) with F_ij = dx_i/dX_j; symmetric tensors are
!! stored (xx,yy,zz,xy) with tensorial shear. A rotation is stored as (cos, sin) of
!! Q = [cos -sin; sin cos]. Equations: src/THEORY.md (3.1), (3.2); Hughes & Winget (1980).
!! The plural procedures take a block of points, by component (talus_points): loops without
!! branches, which compilers vectorise.
module talus_objective
  use talus_kinds, only: dp
  use talus_points, only: soil_points
  implicit none
  private
  public :: objective_increment, objective_increments, tensor_rotate, tensors_rotate
  public :: strain_advance, piola_stress, piola_stresses, cauchy_stress

contains

  !> Strain increment and exact rotation over a step, from h = (F_new - F_old) F_mid^-1:
  !! the symmetric part is the strain increment in the middle of the step, the skew part w gives
  !! Q = (1 - w/2)^-1 (1 + w/2), which is orthogonal for a step of any size. The increment is turned
  !! on by the other half of the rotation: left where it is, it makes the rule first order in steps
  !! that turn and strain (Simo & Hughes 1998, section 8.3).
  pure subroutine objective_increment(f_old, f_new, dstrain, rotation, det_new, ierr)
    real(dp), intent(in) :: f_old(4)      !! deformation gradient before the step [-]
    real(dp), intent(in) :: f_new(4)      !! deformation gradient after the step [-]
    real(dp), intent(out) :: dstrain(4)   !! strain increment at the end [-], tension +, zz = 0
    real(dp), intent(out) :: rotation(2)  !! cosine and sine of the rotation of the step [-]
    real(dp), intent(out) :: det_new      !! det F_new [-]
    integer, intent(out) :: ierr          !! 0, or 1 when det F_mid or det F_new is not positive
    real(dp), dimension(soil_points,4) :: before, after, change
    real(dp) :: turn(soil_points,2)
    real(dp), dimension(soil_points) :: det_mid, det_old, det

    before(1, :) = f_old
    after(1, :) = f_new
    call objective_increments(1, before, after, change, turn, det_mid, det_old, det)
    dstrain = change(1, :)
    rotation = turn(1, :)
    det_new = det(1)
    ierr = merge(0, 1, det_mid(1) > 0.0_dp)
  end subroutine objective_increment

  !> The same at n points of a block. Where det F_mid or det F_new is not positive, det_mid is
  !! returned as zero, with no strain and no rotation.
  pure subroutine objective_increments(n, f_old, f_new, dstrain, rotation, det_mid, det_old, &
    det_new)
    integer, intent(in) :: n
    real(dp), intent(in) :: f_old(soil_points,4)      !! deformation gradient before the step [-]
    real(dp), intent(in) :: f_new(soil_points,4)      !! deformation gradient after the step [-]
    real(dp), intent(inout) :: dstrain(soil_points,4) !! strain increment at the end [-], zz = 0
    real(dp), intent(inout) :: rotation(soil_points,2) !! cosine and sine of the rotation [-]
    real(dp), intent(inout) :: det_mid(soil_points)   !! det F_mid [-], or 0
    real(dp), intent(inout) :: det_old(soil_points)   !! det F_old [-]
    real(dp), intent(inout) :: det_new(soil_points)   !! det F_new [-]
    real(dp) :: m11, m12, m21, m22, d11, d12, d21, d22, inv, xx, yy, xy, h12, h21, a, a2, turned
    integer :: i

    ! A loop of its own: compilers would make a branch of a zero that they see divided.
    do i = 1, n
      det_old(i) = f_old(i, 1)*f_old(i, 4) - f_old(i, 2)*f_old(i, 3)
      det_new(i) = f_new(i, 1)*f_new(i, 4) - f_new(i, 2)*f_new(i, 3)
      det_mid(i) = 0.25_dp*((f_old(i, 1) + f_new(i, 1))*(f_old(i, 4) + f_new(i, 4)) &
        - (f_old(i, 2) + f_new(i, 2))*(f_old(i, 3) + f_new(i, 3)))
      det_mid(i) = merge(det_mid(i), 0.0_dp, min(det_mid(i), det_new(i)) > 0.0_dp)
    end do
    do i = 1, n
      m11 = 0.5_dp*(f_old(i, 1) + f_new(i, 1))
      m12 = 0.5_dp*(f_old(i, 2) + f_new(i, 2))
      m21 = 0.5_dp*(f_old(i, 3) + f_new(i, 3))
      m22 = 0.5_dp*(f_old(i, 4) + f_new(i, 4))
      d11 = f_new(i, 1) - f_old(i, 1)
      d12 = f_new(i, 2) - f_old(i, 2)
      d21 = f_new(i, 3) - f_old(i, 3)
      d22 = f_new(i, 4) - f_old(i, 4)
      ! One over det_mid, or 0 where that is 0, without a branch.
      inv = det_mid(i)/max(det_mid(i)*det_mid(i), tiny(1.0_dp))
      h12 = (d12*m11 - d11*m12)*inv
      h21 = (d21*m22 - d22*m21)*inv
      xx = (d11*m22 - d12*m21)*inv
      yy = (d22*m11 - d21*m12)*inv
      xy = 0.5_dp*(h12 + h21)
      a = 0.25_dp*(h21 - h12)
      a2 = a*a
      inv = 1.0_dp/(1.0_dp + a2)
      ! Half the rotation has the cosine sqrt(inv) and the sine a sqrt(inv): only squares enter.
      turned = inv*(a2*(yy - xx) - 2.0_dp*a*xy)
      dstrain(i, 1) = xx + turned
      dstrain(i, 2) = yy - turned
      dstrain(i, 3) = 0.0_dp
      dstrain(i, 4) = xy + inv*(a*(xx - yy) - 2.0_dp*a2*xy)
      rotation(i, 1) = (1.0_dp - a2)*inv
      rotation(i, 2) = 2.0_dp*a*inv
    end do
  end subroutine objective_increments

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

  !> The same at n points of a block.
  pure subroutine tensors_rotate(n, rotation, t)
    integer, intent(in) :: n
    real(dp), intent(in) :: rotation(soil_points,2) !! cosine and sine [-]
    real(dp), intent(inout) :: t(soil_points,4)     !! symmetric tensors, xx, yy, zz, xy
    real(dp) :: cc, ss, cs, xx, yy, xy
    integer :: i

    do i = 1, n
      cc = rotation(i, 1)*rotation(i, 1)
      ss = rotation(i, 2)*rotation(i, 2)
      cs = rotation(i, 1)*rotation(i, 2)
      xx = t(i, 1)
      yy = t(i, 2)
      xy = t(i, 4)
      t(i, 1) = cc*xx - 2.0_dp*cs*xy + ss*yy
      t(i, 2) = ss*xx + 2.0_dp*cs*xy + cc*yy
      t(i, 4) = cs*(xx - yy) + (cc - ss)*xy
    end do
  end subroutine tensors_rotate

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

  !> Cauchy stress sigma = P F^T/J in the plane; zz is left at 0.
  pure function cauchy_stress(f, piola) result(stress)
    real(dp), intent(in) :: f(4)     !! deformation gradient [-]
    real(dp), intent(in) :: piola(4) !! first Piola stress [Pa], 11, 12, 21, 22
    real(dp) :: stress(4)            !! [Pa], tension +

    stress = [piola(1)*f(1) + piola(2)*f(2), piola(3)*f(3) + piola(4)*f(4), 0.0_dp, &
              0.5_dp*(piola(1)*f(3) + piola(2)*f(4) + piola(3)*f(1) + piola(4)*f(2))] &
              /(f(1)*f(4) - f(2)*f(3))
  end function cauchy_stress

  !> Area times first Piola-Kirchhoff stress at n points of a block, by node.
  pure subroutine piola_stresses(n, area, f, stress, piola)
    integer, intent(in) :: n
    real(dp), intent(in) :: area(n)               !! area of the point's cell [m2]
    real(dp), intent(in) :: f(soil_points,4)      !! deformation gradient [-]
    real(dp), intent(in) :: stress(soil_points,4) !! Cauchy stress [Pa], tension +
    real(dp), intent(inout) :: piola(4,n)         !! area times first Piola stress [N m/m]
    integer :: i

    do i = 1, n
      piola(1, i) = area(i)*(stress(i, 1)*f(i, 4) - stress(i, 4)*f(i, 2))
      piola(2, i) = area(i)*(stress(i, 4)*f(i, 1) - stress(i, 1)*f(i, 3))
      piola(3, i) = area(i)*(stress(i, 4)*f(i, 4) - stress(i, 2)*f(i, 2))
      piola(4, i) = area(i)*(stress(i, 2)*f(i, 1) - stress(i, 4)*f(i, 3))
    end do
  end subroutine piola_stresses
end module talus_objective
