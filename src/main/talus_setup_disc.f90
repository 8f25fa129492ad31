! SPDX-License-Identifier: MIT
!> From the deck's geometry to the discretisation.
module talus_setup_disc
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_set, status_failed, status_deck
  use talus_text, only: text_of
  use talus_read_file, only: file_problem
  use talus_deck_types, only: deck_t, deck_keeps_soil
  use talus_deck_messages, only: messages_t, messages_start, messages_error, messages_lines, &
    messages_status
  use talus_ground, only: ground_t
  use talus_nodes, only: mesh_t
  use talus_mesh_box, only: mesh_box
  use talus_mesh_slope, only: mesh_slope
  use talus_mesh_file, only: mesh_file_read
  use talus_mesh_perturb, only: mesh_perturb
  use talus_renumber, only: mesh_renumber
  use talus_dual_cells, only: dual_build, dual_spacing
  use talus_scni, only: scni_build, scni_transpose
  use talus_two_level, only: two_level_build, weights_symmetric, weights_rk, weights_area
  use talus_stabilise, only: stabilise_build
  use talus_tie, only: tie_build
  use talus_disc, only: disc_t
  use talus_timer, only: timer_t, timer_start, timer_stop
  implicit none
  private
  public :: setup_disc, setup_check_file

contains

  !> Nodes, cells and operators, each timed. Water alone needs the first level only.
  subroutine setup_disc(deck, ground, disc, timer, status)
    type(deck_t), intent(in) :: deck
    type(ground_t), intent(in) :: ground
    type(disc_t), intent(out) :: disc
    type(timer_t), intent(inout) :: timer
    type(status_t), intent(inout) :: status
    real(dp), allocatable :: support(:)
    integer, allocatable :: old_number(:)

    call timer_start(timer, 'set_up_nodes')
    call make_mesh(deck, disc%mesh, status)
    if (status_failed(status)) return
    call mesh_perturb(disc%mesh, deck%nodes%perturbation, deck%nodes%seed, .false.)
    call mesh_renumber(disc%mesh, old_number)
    disc%n = size(disc%mesh%x, 2)
    call timer_stop(timer, 'set_up_nodes')
    call timer_start(timer, 'set_up_cells')
    call dual_build(disc%dual, disc%mesh, status)
    if (status_failed(status)) return
    call assign_soils(deck, disc, status)
    support = deck%nodes%support*dual_spacing(disc%dual, disc%mesh)
    call timer_stop(timer, 'set_up_cells')
    call timer_start(timer, 'set_up_first_level')
    call scni_build(disc%scni, disc%mesh, disc%dual, support, status)
    if (.not. status_failed(status) .and. deck_keeps_soil(deck)) call scni_transpose(disc%scni)
    call timer_stop(timer, 'set_up_first_level')
    if (status_failed(status) .or. .not. deck_keeps_soil(deck)) return
    call timer_start(timer, 'set_up_smoothing')
    call build_smoothing(deck, ground, support/deck%nodes%support, disc, status)
    call timer_stop(timer, 'set_up_smoothing')
  end subroutine setup_disc

  !> Second level and stabilisation.
  subroutine build_smoothing(deck, ground, spacing, disc, status)
    type(deck_t), intent(in) :: deck
    type(ground_t), intent(in) :: ground
    real(dp), intent(in) :: spacing(:) !! of the nodes [m], (n)
    type(disc_t), intent(inout) :: disc
    type(status_t), intent(inout) :: status
    real(dp), allocatable :: modulus(:), poisson(:)
    integer :: weights

    weights = weights_symmetric
    disc%two_levels = deck%smoothing%levels == 2
    if (disc%two_levels) then
      disc%damage_only = deck%smoothing%acts_on == 'damage_only'
      if (3.0_dp*sum(spacing)/real(disc%n, dp) > 1.05_dp*deck%smoothing%length) &
        call status_set(status, status_deck, '&smoothing length = '// &
        text_of(deck%smoothing%length)//': less than three of the mean node spacing '// &
        text_of(sum(spacing)/real(disc%n, dp), 4)//' m; allowed: a longer one, or closer nodes')
      if (status_failed(status)) return
      if (deck%smoothing%weights == 'rk') weights = weights_rk
      if (deck%smoothing%weights == 'area') weights = weights_area
      call two_level_build(disc%two_level, disc%mesh%x, disc%dual%area, elastic_kind(ground, disc%soil), &
                           deck%smoothing%length, weights, status)
    end if
    disc%stabilised = deck%smoothing%stabilisation > 0.0_dp
    disc%floor = deck%smoothing%stabilisation_floor
    if (.not. disc%stabilised) return
    modulus = ground%law(disc%soil)%elastic%youngs_modulus
    call stabilise_build(disc%stabilise, disc%mesh%x, disc%dual, modulus, &
                         deck%smoothing%stabilisation, disc%two_levels .and. .not. disc%damage_only, &
                         deck%smoothing%level_stiffness)
    disc%tied = disc%two_levels .and. .not. disc%damage_only .and. weights == weights_symmetric &
      .and. deck%smoothing%elastic_strain == 'local'
    if (.not. disc%tied) return
    poisson = ground%law(disc%soil)%elastic%poisson_ratio
    call tie_build(disc%tie, modulus, poisson)
  end subroutine build_smoothing

  !> The first soil with the same elastic moduli, at each node.
  pure function elastic_kind(ground, soil) result(kind)
    type(ground_t), intent(in) :: ground
    integer, intent(in) :: soil(:) !! of each node, (n)
    integer :: kind(size(soil))
    integer :: first(size(ground%law)), k

    do k = 1, size(first)
      associate (law => ground%law)
        first(k) = findloc(abs(law%elastic%youngs_modulus - law(k)%elastic%youngs_modulus) <= 0.0_dp &
          .and. abs(law%elastic%poisson_ratio - law(k)%elastic%poisson_ratio) <= 0.0_dp, .true., dim=1)
      end associate
    end do
    kind = first(soil)
  end function elastic_kind

  !> Nodes and the grid they come with.
  subroutine make_mesh(deck, mesh, status)
    type(deck_t), intent(in) :: deck
    type(mesh_t), intent(out) :: mesh
    type(status_t), intent(inout) :: status

    associate (geometry => deck%geometry, nodes => deck%nodes)
      select case (geometry%kind)
      case ('box')
        call mesh_box(mesh, geometry%width, geometry%height, nodes%spacing, nodes%spacing_y, &
                      nodes%grading_x, nodes%grading_y, [geometry%origin_x, geometry%origin_y], &
                      status)
      case ('slope')
        call mesh_slope(mesh, geometry%slope_height, geometry%slope_ratio, geometry%base_depth, &
                        geometry%toe_distance, geometry%crest_width, nodes%spacing, &
                        nodes%spacing_y, [geometry%origin_x, geometry%origin_y], status)
      case default
        call read_node_file(deck, mesh, status)
        if (status_failed(status)) return
        mesh%x(1, :) = mesh%x(1, :) + geometry%origin_x
        mesh%x(2, :) = mesh%x(2, :) + geometry%origin_y
      end select
    end associate
  end subroutine make_mesh

  !> Nodes from a file; what is wrong with it is told as the deck's own errors are.
  subroutine read_node_file(deck, mesh, status)
    type(deck_t), intent(in) :: deck
    type(mesh_t), intent(out) :: mesh
    type(status_t), intent(inout) :: status
    type(messages_t) :: messages
    type(status_t) :: reading

    call mesh_file_read(mesh, deck%geometry%file, reading)
    if (.not. status_failed(reading)) return
    call messages_start(messages, deck%path)
    call messages_lines(messages, deck%geometry%file_line, node_file(deck), reading%message)
    call messages_status(messages, 'no model can be made of the node file', status)
  end subroutine read_node_file

  !> Add what is wrong with the node file to the errors of a deck that has others.
  subroutine setup_check_file(deck, messages)
    type(deck_t), intent(in) :: deck           !! as far as it could be read
    type(messages_t), intent(inout) :: messages
    type(mesh_t) :: mesh
    type(status_t) :: reading

    if (.not. allocated(deck%geometry%kind)) return
    if (deck%geometry%kind /= 'file' .or. len(deck%geometry%file) == 0) return
    ! That it cannot be opened was told before.
    if (len(file_problem(deck%geometry%file, '')) > 0) return
    call mesh_file_read(mesh, deck%geometry%file, reading)
    if (status_failed(reading)) call messages_lines(messages, deck%geometry%file_line, &
      node_file(deck), reading%message)
  end subroutine setup_check_file

  !> The key that names the node file.
  pure function node_file(deck) result(text)
    type(deck_t), intent(in) :: deck
    character(:), allocatable :: text

    text = '&geometry file = '''//deck%geometry%file//''''
  end function node_file

  !> Soil of each node: its number in the node file, or the last soil whose region holds it.
  subroutine assign_soils(deck, disc, status)
    type(deck_t), intent(in) :: deck
    type(disc_t), intent(inout) :: disc
    type(status_t), intent(inout) :: status
    type(messages_t) :: messages
    integer :: i, k

    if (allocated(disc%mesh%soil)) then
      disc%soil = disc%mesh%soil
      if (maxval(disc%soil) <= size(deck%soil)) return
      call messages_start(messages, deck%path)
      call messages_error(messages, deck%geometry%file_line, node_file(deck)//': soil numbers '// &
        'go up to '//text_of(maxval(disc%soil))//'; allowed: 1 to '//text_of(size(deck%soil))// &
        ', the &soil groups in the order of the deck')
      call messages_status(messages, 'the node file does not fit the deck', status)
      return
    end if
    allocate (disc%soil(disc%n), source=0)
    do k = 1, size(deck%soil)
      associate (soil => deck%soil(k), x => disc%mesh%x)
        where (x(1, :) >= soil%from_x .and. x(1, :) <= soil%to_x .and. x(2, :) >= soil%from_y &
               .and. x(2, :) <= soil%to_y) disc%soil = k
      end associate
    end do
    do i = 1, disc%n
      if (disc%soil(i) > 0) cycle
      call status_set(status, status_deck, '&soil: no soil at ('//text_of(disc%mesh%x(1, i))// &
        ', '//text_of(disc%mesh%x(2, i))//') m; the regions must cover the body')
      return
    end do
  end subroutine assign_soils
end module talus_setup_disc
