! SPDX-License-Identifier: MIT
!> Interfaces of the eigenvalue solvers of LAPACK.
module talus_lapack
  use talus_kinds, only: dp
  implicit none
  private
  public :: dsyev, dsygv, dgeev

  interface
    !> Eigenvalues `w` of a symmetric matrix in rising order, with jobz = 'V' eigenvectors in `a`.
    subroutine dsyev(jobz, uplo, n, a, lda, w, work, lwork, info)
      import :: dp
      character, intent(in) :: jobz, uplo
      integer, intent(in) :: n, lda, lwork
      real(dp), intent(inout) :: a(lda,*)
      real(dp), intent(out) :: w(*), work(*)
      integer, intent(out) :: info
    end subroutine dsyev

    !> The same of a x = w b x (itype 1), a symmetric and b symmetric positive definite.
    subroutine dsygv(itype, jobz, uplo, n, a, lda, b, ldb, w, work, lwork, info)
      import :: dp
      character, intent(in) :: jobz, uplo
      integer, intent(in) :: itype, n, lda, ldb, lwork
      real(dp), intent(inout) :: a(lda,*), b(ldb,*)
      real(dp), intent(out) :: w(*), work(*)
      integer, intent(out) :: info
    end subroutine dsygv

    !> Eigenvalues wr + i wi of any real matrix, and left and right eigenvectors as asked for.
    subroutine dgeev(jobvl, jobvr, n, a, lda, wr, wi, vl, ldvl, vr, ldvr, work, lwork, info)
      import :: dp
      character, intent(in) :: jobvl, jobvr
      integer, intent(in) :: n, lda, ldvl, ldvr, lwork
      real(dp), intent(inout) :: a(lda,*), vl(ldvl,*), vr(ldvr,*) !! vl, vr only as asked for
      real(dp), intent(out) :: wr(*), wi(*), work(*)
      integer, intent(out) :: info
    end subroutine dgeev
  end interface
end module talus_lapack
