! SPDX-License-Identifier: MIT
!> The deck's key table, put together.
module talus_deck_keys
  use talus_deck_table, only: table_t
  use talus_deck_keys_model, only: keys_add_run, keys_add_geometry, keys_add_nodes, &
    keys_add_smoothing, keys_add_initial, keys_add_output
  use talus_deck_keys_soil, only: keys_add_soil, keys_add_damage
  use talus_deck_keys_water, only: keys_add_water, keys_add_boundary, keys_add_stage
  implicit none
  private
  public :: deck_table

contains

  !> All groups and keys, in the order of manuals and of the resolved deck.
  subroutine deck_table(table)
    type(table_t), intent(out) :: table

    call keys_add_run(table)
    call keys_add_geometry(table)
    call keys_add_nodes(table)
    call keys_add_smoothing(table)
    call keys_add_soil(table)
    call keys_add_damage(table)
    call keys_add_water(table)
    call keys_add_initial(table)
    call keys_add_boundary(table)
    call keys_add_stage(table)
    call keys_add_output(table)
  end subroutine deck_table
end module talus_deck_keys
