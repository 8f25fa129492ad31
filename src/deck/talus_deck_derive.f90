! SPDX-License-Identifier: MIT
!> Defaults that depend on other keys or groups (the table marks them with '~').
module talus_deck_derive
  use talus_kinds, only: dp
  use talus_deck_store, only: store_t, store_sections, store_first, store_value
  implicit none
  private
  public :: deck_derive

contains

  !> Set all derived defaults.
  subroutine deck_derive(store, stem)
    type(store_t), intent(inout) :: store
    character(*), intent(in) :: stem !! default of &run name
    integer, allocatable :: at(:)
    logical :: has_water
    integer :: i

    call default_text(store, store_first(store, 'run'), 'name', stem)
    call derive_spacing(store, store_first(store, 'nodes'))
    call store_sections(store, 'water', at)
    has_water = size(at) > 0
    do i = 1, size(at)
      call derive_air_entry(store, at(i))
    end do
    call store_sections(store, 'stage', at)
    do i = 1, size(at)
      call derive_stage(store, at(i), has_water)
    end do
    call derive_after_failure(store, at)
  end subroutine deck_derive

  !> spacing_y = 0 means the same as spacing.
  subroutine derive_spacing(store, section)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: section
    real(dp) :: spacing

    spacing = real_of(store, section, 'spacing_y')
    if (spacing < 0.0_dp .or. spacing > 0.0_dp) return
    spacing = real_of(store, section, 'spacing')
    if (spacing > 0.0_dp) then
      store%section(section)%value(store_value(store, section, 'spacing_y'))%r = [spacing]
    end if
  end subroutine derive_spacing

  !> The 2 cm cut that keeps dk_r/ds bounded for 1 < n < 2, and from which Fredlund, Xing & Huang
  !> measure k_r (src/THEORY.md section 3.6).
  subroutine derive_air_entry(store, section)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: section
    real(dp) :: n
    logical :: needed

    n = real_of(store, section, 'n')
    needed = n > 0.0_dp .and. n < 2.0_dp
    if (store%section(section)%value(store_value(store, section, 'retention'))%s == &
      'fredlund_xing') needed = .true.
    call default_real(store, section, 'air_entry_cut', merge(0.02_dp, 0.0_dp, needed))
  end subroutine derive_air_entry

  subroutine derive_stage(store, section, has_water)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: section
    logical, intent(in) :: has_water
    character(:), allocatable :: kind

    kind = store%section(section)%value(store_value(store, section, 'kind'))%s
    if (has_water .and. kind /= 'geostatic' .and. kind /= 'strength_reduction') then
      call default_text(store, section, 'solve', 'both')
    else
      call default_text(store, section, 'solve', 'soil')
    end if
    if (kind == 'storm') then
      call default_real(store, section, 'storm_step_minimum', &
                        real_of(store, section, 'storm_step')/64.0_dp)
    end if
    call default_real(store, section, 'damping', 0.0_dp)
    call default_logical(store, section, 'mass_scaling', kind /= 'dynamic')
    call default_logical(store, section, 'reset_displacement', kind == 'geostatic')
  end subroutine derive_stage

  !> A failed storm goes on with a later dynamic stage when there is one.
  subroutine derive_after_failure(store, at)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: at(:) !! sections of &stage
    logical :: follows
    integer :: i

    follows = .false.
    do i = size(at), 1, -1
      if (follows) then
        call default_text(store, at(i), 'after_failure', 'dynamic_next')
      else
        call default_text(store, at(i), 'after_failure', 'stop')
      end if
      associate (kind => store%section(at(i))%value(store_value(store, at(i), 'kind')))
        if (kind%s == 'dynamic') follows = .true.
      end associate
    end do
  end subroutine derive_after_failure

  !> A real value, -1 when absent.
  pure real(dp) function real_of(store, section, name)
    type(store_t), intent(in) :: store
    integer, intent(in) :: section
    character(*), intent(in) :: name

    real_of = -1.0_dp
    associate (value => store%section(section)%value(store_value(store, section, name)))
      if (value%is_set) real_of = value%r(1)
    end associate
  end function real_of

  subroutine default_real(store, section, name, default)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: section
    character(*), intent(in) :: name
    real(dp), intent(in) :: default

    associate (value => store%section(section)%value(store_value(store, section, name)))
      if (value%is_given) return
      value%r = [default]
      value%is_set = .true.
    end associate
  end subroutine default_real

  subroutine default_text(store, section, name, default)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: section
    character(*), intent(in) :: name, default

    associate (value => store%section(section)%value(store_value(store, section, name)))
      if (value%is_given .and. (value%is_wrong .or. len(value%s) > 0)) return
      value%s = default
      value%is_set = .true.
    end associate
  end subroutine default_text

  subroutine default_logical(store, section, name, default)
    type(store_t), intent(inout) :: store
    integer, intent(in) :: section
    character(*), intent(in) :: name
    logical, intent(in) :: default

    associate (value => store%section(section)%value(store_value(store, section, name)))
      if (value%is_given) return
      value%l = default
      value%is_set = .true.
    end associate
  end subroutine default_logical
end module talus_deck_derive
