! SPDX-License-Identifier: MIT
!> Contradictions in &geometry, &nodes, &smoothing and &output.
module talus_deck_check_model
  use talus_kinds, only: dp
  use talus_text, only: text_of
  use talus_deck_messages, only: messages_t
  use talus_deck_types, only: deck_t, deck_given, deck_exceeds, deck_moves_soil
  use talus_deck_store, only: store_t, store_first, store_value, store_is_wrong
  use talus_deck_extent, only: extent_t, extent_of, extent_holds
  use talus_deck_check_file, only: check_file
  use talus_deck_report, only: complain => report_error, warn => report_warning
  implicit none
  private
  public :: check_run, check_geometry, check_nodes, check_smoothing, check_output

  !> Node counts that take long, and that no memory holds.
  real(dp), parameter :: nodes_many = 1.0e6_dp, nodes_max = 1.0e8_dp

contains

  !> &run: its name is the first part of file names.
  subroutine check_run(store, deck, messages)
    type(store_t), intent(in) :: store
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages

    if (index(deck%run%name, '/') > 0) call complain(store, store_first(store, 'run'), 'name', &
      'a file name with a slash', messages, 'a name without /; &output directory says where')
  end subroutine check_run

  !> &geometry.
  subroutine check_geometry(store, deck, messages)
    type(store_t), intent(in) :: store
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages
    integer :: section

    section = store_first(store, 'geometry')
    associate (geometry => deck%geometry)
      if (geometry%kind == 'file') call check_file(store, section, 'file', geometry%file, messages)
      if (geometry%kind /= 'slope') return
      if (deck_exceeds(1.0e-9_dp, geometry%base_depth) .and. &
          deck_exceeds(geometry%toe_distance, 0.0_dp)) then
        call complain(store, section, 'toe_distance', 'there is no ground in front of the toe '// &
                      'with base_depth = 0', messages, '0 with base_depth = 0, or base_depth > 0')
      end if
      if (deck_exceeds(geometry%slope_ratio, 10.0_dp)) then
        call warn(store, section, 'slope_ratio', 'very flat; it is horizontal per vertical', &
            messages)
      end if
    end associate
  end subroutine check_geometry

  !> &nodes against the body.
  subroutine check_nodes(store, deck, messages)
    type(store_t), intent(in) :: store
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages
    type(extent_t) :: extent
    integer :: section
    real(dp) :: nodes

    section = store_first(store, 'nodes')
    if (deck%geometry%kind /= 'box' .and. len(deck%geometry%kind) > 0) then
      call check_grading('grading_x', deck%nodes%grading_x)
      call check_grading('grading_y', deck%nodes%grading_y)
    end if
    if (deck%geometry%kind == 'file' .and. deck_given(deck%nodes%spacing)) call warn(store, &
      section, 'spacing', 'has no effect: the nodes are in the file', messages)
    if (deck%geometry%kind /= 'box' .and. deck%geometry%kind /= 'slope') return
    if (.not. deck_given(deck%nodes%spacing)) then
      if (.not. store_is_wrong(store, section, 'spacing')) &
        call complain(store, section, 'spacing', 'missing key', messages)
      return
    end if
    associate (g => deck%geometry, dx => deck%nodes%spacing, dy => deck%nodes%spacing_y)
      if (g%kind == 'box') then
        call check_fit('spacing', dx, 'width', g%width)
        call check_fit('spacing_y', dy, 'height', g%height)
      else
        call check_fit('spacing', dx, 'toe_distance', g%toe_distance)
        call check_fit('spacing', dx, 'crest_width', g%crest_width)
        call check_fit('spacing_y', dy, 'slope_height', g%slope_height)
        call check_fit('spacing_y', dy, 'base_depth', g%base_depth)
      end if
      extent = extent_of(g)
      if (.not. extent%is_known .or. .not. deck_given(dy)) return
      nodes = extent%area/dx/dy
      if (nodes > nodes_max) then
        call complain(store, section, 'spacing', 'about '//text_of(nodes, 2)//' nodes', messages, &
                      'at most '//text_of(nodes_max, 2)//' nodes')
      else if (nodes > nodes_many) then
        call warn(store, section, 'spacing', 'about '//text_of(nodes, 2)//' nodes: a long run', &
            messages)
      end if
    end associate

  contains

    subroutine check_grading(key, ratio)
      character(*), intent(in) :: key
      real(dp), intent(in) :: ratio

      if (.not. deck_given(ratio)) return
      if (abs(ratio - 1.0_dp) > 0.0_dp) call complain(store, section, key, &
        'only a box can be graded', messages, '1 with &geometry kind = '''// &
        deck%geometry%kind//'''')
    end subroutine check_grading

    subroutine check_fit(key, spacing, name, length)
      character(*), intent(in) :: key, name
      real(dp), intent(in) :: spacing, length  !! [m]

      if (.not. deck_exceeds(length, 0.0_dp)) return
      if (deck_exceeds(spacing, length*(1.0_dp + 1.0e-9_dp))) then
        call complain(store, section, key, 'larger than &geometry '//name//' = '//text_of(length), &
                      messages, 'at most '//name)
      end if
    end subroutine check_fit
  end subroutine check_nodes

  !> &smoothing against the node spacing.
  subroutine check_smoothing(store, deck, messages)
    type(store_t), intent(in) :: store
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages
    type(extent_t) :: extent
    integer :: section
    real(dp) :: largest

    section = store_first(store, 'smoothing')
    associate (smoothing => deck%smoothing, nodes => deck%nodes)
      if (deck_moves_soil(deck) .and. .not. deck_exceeds(smoothing%stabilisation, 0.0_dp) &
          .and. deck_given(smoothing%stabilisation)) then
        call warn(store, section, 'stabilisation', &
            'off: a slope under gravity may fly apart in '// &
                  'spurious modes', messages)
      end if
      call check_idle('stabilisation_floor')
      if (smoothing%levels /= 2) return
      call check_idle('level_stiffness')
      call check_idle('elastic_strain')
      call check_local
      if (smoothing%weights == 'rk' .or. smoothing%weights == 'area') then
        call warn(store, section, 'weights', 'these weights fail the patch test', messages)
      end if
      if (smoothing%acts_on == 'damage_only' .and. size(deck%damage) == 0) then
        call complain(store, section, 'acts_on', 'there is no &damage', messages, &
                      '''gradient'' without &damage')
      end if
      if (smoothing%acts_on == 'damage_only') call check_damage_only
      extent = extent_of(deck%geometry)
      if (extent%is_known .and. deck_exceeds(smoothing%length, &
        max(extent%right - extent%left, extent%top - extent%bottom))) call warn(store, section, &
        'length', 'larger than the body: every node is smoothed over nearly all of it', messages)
      if (deck%geometry%kind == 'file' .or. .not. deck_given(nodes%spacing)) return
      largest = nodes%spacing
      if (deck_exceeds(nodes%spacing_y, largest)) largest = nodes%spacing_y
      if (deck_exceeds(3.0_dp*largest*(1.0_dp - 1.0e-9_dp), smoothing%length)) then
        call complain(store, section, 'length', &
            'less than three node spacings, &nodes spacing = '// &
                      text_of(largest), messages, 'at least '//text_of(3.0_dp*largest)// &
                      ', or a smaller spacing')
      end if
    end associate

  contains

    !> A key of the deck that only takes part where there is stabilisation.
    subroutine check_idle(key)
      character(*), intent(in) :: key

      if (deck_exceeds(deck%smoothing%stabilisation, 0.0_dp) .or. &
          .not. deck_given(deck%smoothing%stabilisation)) return
      if (store%section(section)%value(store_value(store, section, key))%is_given) call warn( &
        store, section, key, 'has no effect with stabilisation = 0', messages)
    end subroutine check_idle

    !> Strain of intact soil is chosen where it cannot be had or is not smoothed.
    subroutine check_local
      if (.not. store%section(section)%value(store_value(store, section, 'elastic_strain'))%is_given) &
        return
      if (deck%smoothing%acts_on == 'damage_only') then
        call warn(store, section, 'elastic_strain', 'has no effect with acts_on = ''damage_only''', &
          messages)
      else if (deck%smoothing%weights /= 'symmetric') then
        call warn(store, section, 'elastic_strain', &
          'has no effect with weights = '''//deck%smoothing%weights//'''', messages)
      end if
    end subroutine check_local

    !> The plastic strain of a point is its own: smoothing the damage driver alone cannot reach it.
    subroutine check_damage_only
      integer :: i

      do i = 1, size(deck%damage)
        if (deck%damage(i)%driver /= 'plastic_strain') return
      end do
      if (size(deck%damage) > 0) call warn(store, section, 'acts_on', &
        'has no effect: damage by plastic_strain is local', messages)
    end subroutine check_damage_only
  end subroutine check_smoothing

  !> &output: probes in the body.
  subroutine check_output(store, deck, messages)
    type(store_t), intent(in) :: store
    type(deck_t), intent(in) :: deck
    type(messages_t), intent(inout) :: messages
    integer :: section, i

    section = store_first(store, 'output')
    associate (x => deck%output%probe_x, y => deck%output%probe_y)
      if (len(deck%output%directory) == 0 .and. .not. store_is_wrong(store, section, 'directory')) &
        call complain(store, section, 'directory', 'blank', messages)
      if (size(x) /= size(y)) then
        if (store_is_wrong(store, section, 'probe_x') .or. &
            store_is_wrong(store, section, 'probe_y')) return
        call complain(store, section, 'probe_y', 'number of values '//text_of(size(y))// &
                      ', of probe_x '//text_of(size(x)), messages, 'one value for each probe_x')
        return
      end if
      do i = 1, size(x)
        if (extent_holds(deck%geometry, x(i), y(i))) cycle
        call complain(store, section, 'probe_x', 'probe '//text_of(i)//' ('//text_of(x(i))//', '// &
                      text_of(y(i))//') lies outside the body', messages, 'points of the body')
      end do
    end associate
  end subroutine check_output
end module talus_deck_check_model
