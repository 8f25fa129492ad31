! SPDX-License-Identifier: MIT
!> Everything about a deck that no single key can tell: contradictions between keys and groups.
!! All are reported; a key that was refused before is not judged again.
module talus_deck_check
  use talus_deck_messages, only: messages_t
  use talus_deck_types, only: deck_t
  use talus_deck_store, only: store_t
  use talus_deck_check_model, only: check_run, check_geometry, check_nodes, &
    check_smoothing, check_output
  use talus_deck_check_soil, only: check_soils, check_damages
  use talus_deck_check_water, only: check_waters, check_initial
  use talus_deck_check_boundary, only: check_boundaries
  use talus_deck_check_stage, only: check_stages
  implicit none
  private
  public :: deck_check

contains

  !> Add errors and warnings about a filled deck.
  subroutine deck_check(store, deck, messages)
    type(store_t), intent(in) :: store
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages

    call check_run(store, deck, messages)
    call check_geometry(store, deck, messages)
    call check_nodes(store, deck, messages)
    call check_smoothing(store, deck, messages)
    call check_soils(store, deck, messages)
    call check_damages(store, deck, messages)
    call check_waters(store, deck, messages)
    call check_initial(store, deck, messages)
    call check_boundaries(store, deck, messages)
    call check_stages(store, deck, messages)
    call check_output(store, deck, messages)
  end subroutine deck_check
end module talus_deck_check
