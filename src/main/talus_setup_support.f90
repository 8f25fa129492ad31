! SPDX-License-Identifier: MIT
!> Every body of a model must be held where it has to find its equilibrium.
module talus_setup_support
  use talus_kinds, only: dp
  use talus_status, only: status_t
  use talus_text, only: text_of
  use talus_deck_types, only: deck_t, stage_t
  use talus_deck_messages, only: messages_t, messages_start, messages_error, messages_status
  use talus_disc, only: disc_t
  use talus_bodies, only: bodies_of
  use talus_conditions, only: conditions_t
  implicit none
  private
  public :: setup_support

contains

  !> Refuse bodies that nothing holds. A dynamic stage may let them fall.
  subroutine setup_support(deck, disc, stage, conditions, status)
    type(deck_t), intent(in) :: deck
    type(disc_t), intent(in) :: disc
    type(stage_t), intent(in) :: stage
    type(conditions_t), intent(in) :: conditions !! of the stage
    type(status_t), intent(inout) :: status
    type(messages_t) :: messages
    integer, allocatable :: body(:)
    integer :: i

    if (stage%kind == 'dynamic' .or. stage%solve == 'seepage') return
    if (.not. deck%run%gravity > 0.0_dp) return
    body = bodies_of(disc%scni)
    ! The deck's own check has looked at a single one.
    if (maxval(body) == 1) return
    call messages_start(messages, deck%path)
    do i = 1, maxval(body)
      call look_at('x', any(conditions%held(1, :) .and. body == i))
      call look_at('y', any(conditions%held(2, :) .and. body == i))
    end do
    call messages_status(messages, 'the boundaries do not fit this model', status)

  contains

    subroutine look_at(direction, held)
      character, intent(in) :: direction
      logical, intent(in) :: held
      real(dp) :: middle(2)

      if (held) return
      middle = sum(disc%mesh%x, dim=2, mask=spread(body == i, 1, 2))/real(count(body == i), dp)
      call messages_error(messages, stage%name_line, '&stage name = '''//stage%name// &
        ''': no &boundary holds '//direction//' of the separate body of '// &
        text_of(count(body == i))//' nodes around ('//text_of(middle(1), 3)//', '// &
        text_of(middle(2), 3)//') m; allowed: a &boundary with displacement = ''fixed'' or '// &
        '''roller_'//direction//''' on it')
    end subroutine look_at
  end subroutine setup_support
end module talus_setup_support
