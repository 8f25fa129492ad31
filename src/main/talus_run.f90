! SPDX-License-Identifier: MIT
!> A run from deck to results: model, discretisation, state, stages, summary.
module talus_run
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_set, status_failed, status_deck
  use talus_text, only: text_of
  use talus_deck_types, only: deck_t, deck_given, deck_moves_soil, deck_keeps_soil
  use talus_session, only: session_t
  use talus_setup_ground, only: setup_ground
  use talus_setup_disc, only: setup_disc
  use talus_dual_cells, only: dual_spacing
  use talus_place, only: place_folder
  use talus_state, only: state_allocate
  use talus_initial, only: initial_hydrostatic, initial_water, initial_k0, weight_masses
  use talus_soil_step, only: work_allocate
  use talus_conditions, only: inlets_t
  use talus_setup_conditions, only: setup_conditions, setup_steady
  use talus_setup_support, only: setup_support
  use talus_steady, only: steady_solve
  use talus_setup_restart, only: setup_restart
  use talus_result, only: result_create, result_write_text, result_write_attribute, &
    result_write_mesh
  use talus_cost, only: snapshots_of
  use talus_history, only: history_store, history_close
  use talus_record, only: record_start
  use talus_stage_parts, only: feel_supports
  use talus_stages, only: stage_run
  use talus_report, only: report_summary
  use talus_timer, only: timer_start, timer_stop
  use talus_version, only: version, git_hash
  implicit none
  private
  public :: run_prepare, run_open, run_deck

contains

  !> Everything up to the first step.
  subroutine run_prepare(deck, session, status)
    type(deck_t), intent(in) :: deck
    type(session_t), intent(out) :: session
    type(status_t), intent(inout) :: status
    integer :: i

    call timer_start(session%timer, 'set_up')
    session%deck = deck
    session%declared = ''
    session%restart_name = ''
    session%soil_moves = deck_moves_soil(deck)
    do i = 1, size(deck%stage)
      if (deck%stage(i)%kind == 'strength_reduction' .and. .not. allocated(session%reduction)) &
        allocate (session%reduction(0))
    end do
    call setup_ground(deck, session%ground, status)
    if (status_failed(status)) return
    call setup_disc(deck, session%ground, session%disc, session%timer, status)
    if (status_failed(status)) return
    call timer_start(session%timer, 'set_up_start')
    call state_allocate(session%state, session%disc, session%ground, deck_keeps_soil(deck))
    if (session%soil_moves) call work_allocate(session%work, session%disc)
    call place_probes(session, status)
    if (status_failed(status)) return
    ! Every stage's boundaries, so that a wrong one is told before anything is written.
    do i = 1, size(deck%stage)
      call setup_conditions(deck, session%disc, deck%stage(i)%name, session%conditions, status)
      if (status_failed(status)) return
      call setup_support(deck, session%disc, deck%stage(i), session%conditions, status)
    end do
    if (status_failed(status)) return
    if (len(deck%initial%from_result) > 0) then
      call setup_restart(session, status)
      if (.not. status_failed(status)) call feel_supports(session)
    else
      call start_state(session, status)
    end if
    call timer_stop(session%timer, 'set_up_start')
    call timer_stop(session%timer, 'set_up')
  end subroutine run_prepare

  !> Run every stage of a deck and write its results to `base`.h5 and files beside it.
  subroutine run_deck(deck, base, overwrite, warning, status)
    type(deck_t), intent(in) :: deck
    character(*), intent(in) :: base     !! path of the result files without ending
    logical, intent(in) :: overwrite     !! results that exist may be replaced
    character(:), allocatable, intent(out) :: warning !! about what the run found, '' for none
    type(status_t), intent(inout) :: status
    type(session_t) :: session
    type(status_t) :: closing
    logical :: slides
    integer :: i

    warning = ''
    call run_prepare(deck, session, status)
    if (status_failed(status)) return
    session%base = base
    call timer_start(session%timer, 'stages')
    call place_folder(base, status)
    if (status_failed(status)) return
    call run_open(session, overwrite, status)
    if (status_failed(status)) return
    slides = .false.
    do i = 1, size(deck%stage)
      ! Lost equilibrium goes on in the next dynamic stage.
      if (slides .and. deck%stage(i)%kind /= 'dynamic') cycle
      call stage_run(session, i, status)
      if (status_failed(status)) exit
      slides = session%lost .and. deck%stage(i)%kind == 'storm'
      if (slides .and. deck%stage(i)%after_failure == 'stop') exit
    end do
    call timer_stop(session%timer, 'stages')
    call history_store(session%history, session%result%path, closing)
    call history_close(session%history, closing)
    call report_summary(session, status, warning, closing)
    if (status_failed(closing)) call status_set(status, closing%code, closing%message)
  end subroutine run_deck

  !> Nodes nearest to the probes.
  subroutine place_probes(session, status)
    type(session_t), intent(inout) :: session
    type(status_t), intent(inout) :: status
    real(dp), allocatable :: spacing(:)
    integer :: i

    associate (output => session%deck%output, x => session%disc%mesh%x)
      allocate (session%probe(size(output%probe_x)))
      spacing = dual_spacing(session%disc%dual, session%disc%mesh)
      do i = 1, size(session%probe)
        session%probe(i) = minloc((x(1, :) - output%probe_x(i))**2 &
                                  + (x(2, :) - output%probe_y(i))**2, dim=1)
        associate (node => session%probe(i))
          if (norm2(x(:, node) - [output%probe_x(i), output%probe_y(i)]) > 2.0_dp*spacing(node)) &
            call status_set(status, status_deck, '&output: probe '//text_of(i)//' ('// &
            text_of(output%probe_x(i))//', '//text_of(output%probe_y(i))// &
            ') lies outside the body; allowed: points of the body')
        end associate
      end do
    end associate
  end subroutine place_probes

  !> Pore pressure, stress and mass at the start.
  subroutine start_state(session, status)
    type(session_t), intent(inout) :: session
    type(status_t), intent(inout) :: status
    type(inlets_t) :: inlets
    real(dp), allocatable :: pressure(:)
    real(dp) :: limit

    associate (initial => session%deck%initial, disc => session%disc, ground => session%ground)
      if (ground%wet) then
        allocate (pressure(disc%n), source=0.0_dp)
        select case (initial%pore_pressure)
        case ('uniform')
          pressure = -initial%suction
        case ('hydrostatic', 'steady')
          limit = huge(1.0_dp)
          if (deck_given(initial%suction_limit)) limit = initial%suction_limit
          pressure = initial_hydrostatic(disc, ground%unit_weight, &
            [initial%water_table, initial%water_table_right], limit)
        end select
        call initial_water(disc, ground, pressure, session%state)
        if (initial%pore_pressure == 'steady') then
          call setup_steady(session%deck, disc, inlets, status)
          if (status_failed(status)) return
          call steady_solve(session%seepage, disc, ground, inlets, session%state, status)
          if (status_failed(status)) return
          pressure = session%state%pressure
          call initial_water(disc, ground, pressure, session%state)
        end if
      end if
      if (.not. session%soil_moves) return
      call weight_masses(disc, ground, session%state)
      if (initial%stress == 'k0') call initial_k0(disc, ground, initial%lateral_stress_ratio, &
                                                  session%state)
    end associate
  end subroutine start_state

  !> Snapshots that the stages write, and two named ones each: mechanism, last_good.
  pure integer function expected_snapshots(session) result(snapshots)
    type(session_t), intent(in) :: session
    real(dp) :: total
    integer :: i

    total = 0.0_dp
    do i = 1, size(session%deck%stage)
      total = total + 2.0_dp + snapshots_of(session, session%deck%stage(i), huge(total))
    end do
    snapshots = int(min(total, 1.0e9_dp))
  end function expected_snapshots

  !> Create the result file with all that does not change, and the history.
  subroutine run_open(session, overwrite, status)
    type(session_t), intent(inout) :: session
    logical, intent(in) :: overwrite
    type(status_t), intent(inout) :: status

    associate (result => session%result, deck => session%deck, disc => session%disc)
      call result_create(result, session%base//'.h5', expected_snapshots(session), overwrite, &
                         deck%output%xdmf, status)
      call result_write_attribute(result, 'version', version, status)
      call result_write_attribute(result, 'git_hash', git_hash, status)
      call result_write_attribute(result, 'title', deck%run%title, status)
      call result_write_attribute(result, 'deck_path', deck%path, status)
      call result_write_text(result, '/deck/text', deck%text, status)
      call result_write_text(result, '/deck/resolved', deck%resolved, status)
      call result_write_mesh(result, disc%mesh%x, disc%soil, session%ground%name, disc%dual%area, &
                             disc%mesh%element_offset, disc%mesh%element_nodes, status)
    end associate
    if (status_failed(status)) return
    call record_start(session, status)
  end subroutine run_open
end module talus_run
