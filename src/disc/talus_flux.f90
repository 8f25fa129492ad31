! SPDX-License-Identifier: MIT
!> Faces of the nodal cells for seepage (src/THEORY.md (4.12), (4.13)). The flux through the face
!> between nodes I and K joins the smoothed gradient of both cells with the head's affine residual:
!>
!>   q = -[ a k_e (h_K - h_I) + k_e rest.(grad h_I + grad h_K)/2 ],  T N = a (X_K - X_I) + rest
!>
!> N is the face's reference normal times its length and T = J F^-1 k_sat F^-T. On an orthogonal
!> grid rest = 0 and the face is a two-point flux; a linear head always gives its exact flux.
module talus_flux
  use talus_kinds, only: dp
  use talus_dual_cells, only: dual_t
  implicit none
  private
  public :: flux_t, flux_build

  !> A rest below this fraction of |T N| is round-off: the face is orthogonal.
  real(dp), parameter :: orthogonal = 1.0e-10_dp

  !> Least cosine between T N and the edge that a counts with: very anisotropic soil on an irregular
  !> grid can turn T N away from the edge, and a must stay positive.
  real(dp), parameter :: least_cosine = 0.2_dp

  type :: flux_t
    real(dp), allocatable :: along(:)     !! a of each face [m/s]
    real(dp), allocatable :: share(:,:)   !! the two sides' part in the resistance of a face, (2,ne)
    real(dp), allocatable :: rest(:,:)    !! part of T N that is not along the edge [m2/s], (2,ne)
    logical :: oblique = .false.          !! some face has a rest
  end type flux_t

contains

  !> Build, or rebuild after the soil has moved.
  subroutine flux_build(flux, x, dual, conductivity)
    type(flux_t), intent(inout) :: flux
    real(dp), intent(in) :: x(:,:)            !! reference coordinates [m], (2,n)
    type(dual_t), intent(in) :: dual
    real(dp), intent(in) :: conductivity(:,:) !! T: xx, yy, xy [m/s], (3,n)
    real(dp) :: tn(2,2), edge(2), a(2), middle(2)
    integer :: e, k, n_edge
    logical :: oblique

    n_edge = size(dual%edge_node, 2)
    if (.not. allocated(flux%along)) then
      allocate (flux%along(n_edge), flux%share(2, n_edge), flux%rest(2, n_edge))
    end if
    oblique = .false.
    !$omp parallel do default(none) shared(flux, x, dual, conductivity, n_edge) &
    !$omp private(e, k, tn, edge, a, middle) reduction(.or.:oblique) schedule(static)
    do e = 1, n_edge
      edge = x(:, dual%edge_node(2, e)) - x(:, dual%edge_node(1, e))
      do k = 1, 2
        tn(:, k) = tensor_times(conductivity(:, dual%edge_node(k, e)), dual%edge_normal(:, e))
        a(k) = dot_product(tn(:, k), tn(:, k))/max(dot_product(tn(:, k), edge), &
                                                   least_cosine*norm2(tn(:, k))*norm2(edge))
      end do
      ! The two halves of an edge are resistances in series.
      flux%along(e) = 2.0_dp*a(1)*a(2)/(a(1) + a(2))
      flux%share(:, e) = [a(2), a(1)]/(a(1) + a(2))
      middle = flux%share(1, e)*tn(:, 1) + flux%share(2, e)*tn(:, 2)
      flux%rest(:, e) = middle - flux%along(e)*edge
      if (norm2(flux%rest(:, e)) > orthogonal*norm2(middle)) then
        oblique = .true.
      else
        flux%rest(:, e) = 0.0_dp
      end if
    end do
    !$omp end parallel do
    flux%oblique = oblique
  end subroutine flux_build

  !> Symmetric tensor (xx, yy, xy) times a vector.
  pure function tensor_times(t, vector) result(product)
    real(dp), intent(in) :: t(3), vector(2)
    real(dp) :: product(2)

    product = [t(1)*vector(1) + t(3)*vector(2), t(3)*vector(1) + t(2)*vector(2)]
  end function tensor_times
end module talus_flux
