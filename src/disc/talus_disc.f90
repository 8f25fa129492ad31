! SPDX-License-Identifier: MIT
!> The discretisation: everything that depends on the reference configuration alone.
module talus_disc
  use talus_kinds, only: dp
  use talus_nodes, only: mesh_t
  use talus_dual_cells, only: dual_t
  use talus_scni, only: scni_t
  use talus_two_level, only: two_level_t
  use talus_stabilise, only: stabilise_t
  use talus_tie, only: tie_t
  implicit none
  private
  public :: disc_t

  type :: disc_t
    integer :: n = 0                  !! nodes
    type(mesh_t) :: mesh              !! nodes and the grid they came with
    integer, allocatable :: soil(:)   !! soil of each node, (n)
    type(dual_t) :: dual              !! nodal cells
    type(scni_t) :: scni              !! first level
    logical :: two_levels = .false.   !! the second level exists
    logical :: damage_only = .false.  !! and acts on the damage driver alone
    type(two_level_t) :: two_level
    logical :: stabilised = .false.
    real(dp) :: floor = 0.0_dp        !! least stiffness left to the stabilisation [-]
    type(stabilise_t) :: stabilise
    logical :: tied = .false.         !! intact soil feels the first level as well
    type(tie_t) :: tie
  end type disc_t
end module talus_disc
