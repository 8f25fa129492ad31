! SPDX-License-Identifier: MIT
!> What a run writes while it goes on: history lines and snapshots of the active fields.
module talus_record
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_failed
  use talus_text, only: text_of, text_as_word
  use talus_deck_types, only: boundary_t, deck_held
  use talus_conditions, only: conditions_reaction
  use talus_session, only: session_t
  use talus_state, only: state_t
  use talus_soil_law, only: history_eqps, history_damage
  use talus_fields, only: field_total_stress, field_acting_stress, field_strain, field_porosity
  use talus_seepage, only: seepage_velocity
  use talus_audit, only: energies_t, audit_energies, audit_energy_error, audit_stored_water, &
    audit_water_error
  use talus_relax, only: largest_motion
  use talus_history, only: history_create, history_add, history_store, history_name_letters
  use talus_restart, only: restart_t, restart_write
  use talus_result, only: snapshot_begin, snapshot_begin_named, snapshot_field, snapshot_end
  use talus_timer, only: timer_start, timer_stop
  use talus_progress, only: progress_show
  implicit none
  private
  public :: record_start, record_line, record_snapshot, record_named, record_last_good
  public :: record_restart

  !> Columns of one history line.
  type :: columns_t
    integer :: n = 0
    character(history_name_letters), allocatable :: name(:), unit(:)
    real(dp), allocatable :: value(:)
  end type columns_t

contains

  !> Open the history with the columns that this run has.
  subroutine record_start(session, status)
    type(session_t), intent(inout) :: session
    type(status_t), intent(inout) :: status
    type(columns_t) :: columns
    type(energies_t) :: none

    call collect(session, none, columns)
    call history_create(session%history, session%base//'_history.csv', columns%name(:columns%n), &
                        columns%unit(:columns%n), status)
  end subroutine record_start

  !> Add a history line and remember the errors of the audit. `fraction` is that of the stage.
  subroutine record_line(session, fraction, status)
    type(session_t), intent(inout) :: session
    real(dp), intent(in) :: fraction !! done of the stage, for the progress line
    type(status_t), intent(inout) :: status
    type(columns_t) :: columns
    type(energies_t) :: now
    real(dp) :: energy_error, water_error

    if (status_failed(status)) return
    call timer_start(session%timer, 'output')
    now = session%energies_start
    energy_error = 0.0_dp
    water_error = 0.0_dp
    associate (stage => session%deck%stage(session%stage))
      if (stage%solve /= 'seepage') then
        now = audit_energies(session%disc, session%ground, session%motion, session%state)
        energy_error = audit_energy_error(session%energies_start, now)
        if (stage%kind == 'dynamic') session%worst_energy_error = &
          max(session%worst_energy_error, abs(energy_error))
      end if
      if (session%ground%wet) water_error = audit_water_error(session%disc, session%state)
      if (stage%kind /= 'geostatic') session%worst_water_error = &
        max(session%worst_water_error, abs(water_error))
      call collect(session, now, columns)
      if (session%soil_moves) session%greatest_displacement = max(session%greatest_displacement, &
        largest_motion(session%disc%n, session%state%u, session%state%u_zero))
      call history_add(session%history, session%state%time, stage%name, &
        int(session%state%steps), columns%value(:columns%n), status)
    end associate
    call progress_show(session%progress, fraction, session%state%time, water_error, energy_error)
    call timer_stop(session%timer, 'output')
  end subroutine record_line

  !> Names, units and values of all columns of this run.
  subroutine collect(session, energies, columns)
    type(session_t), intent(in) :: session
    type(energies_t), intent(in) :: energies
    type(columns_t), intent(out) :: columns
    integer :: i, node

    allocate (columns%name(64), columns%unit(64), columns%value(64))
    associate (state => session%state, disc => session%disc)
      if (session%soil_moves) then
        call add('maximum_displacement', 'm', largest_motion(disc%n, state%u, state%u_zero))
        call add('maximum_velocity', 'm/s', sqrt(maxval(sum(state%v**2, dim=1))))
        call add('energy_kinetic', 'J/m', energies%kinetic)
        call add('energy_strain', 'J/m', energies%strain)
        if (allocated(state%history)) then
          call add('energy_plastic', 'J/m', energies%plastic)
          if (any(session%ground%law%damage%driver /= 0)) &
            call add('energy_damage', 'J/m', energies%damage)
        end if
        if (allocated(state%water_work)) call add('energy_water', 'J/m', energies%water)
        if (allocated(state%stabilising)) call add('energy_stabilisation', 'J/m', &
                                                   energies%stabilisation)
        call add('energy_damping', 'J/m', energies%damping)
        call add('energy_external', 'J/m', energies%external)
        call add('energy_error', '1', audit_energy_error(session%energies_start, energies))
      end if
      do i = 1, size(session%deck%boundary)
        if (session%soil_moves) call add_reaction(session%deck%boundary(i))
      end do
      if (allocated(session%reduction)) then
        call add('factor', '1', session%factor)
        call add('factor_stands', '1', merge(1.0_dp, 0.0_dp, session%stands))
      end if
      if (session%ground%wet) then
        call add('water_in', 'm3/m', state%water%inflow)
        call add('water_out', 'm3/m', state%water%outflow)
        call add('water_runoff', 'm3/m', state%water%runoff)
        call add('water_stored', 'm3/m', audit_stored_water(disc, state))
        call add('water_error', '1', audit_water_error(disc, state))
      end if
      do i = 1, size(session%probe)
        node = session%probe(i)
        if (session%soil_moves) then
          call add('probe_'//text_of(i)//'_displacement_x', 'm', &
                   state%u(1, node) - state%u_zero(1, node))
          call add('probe_'//text_of(i)//'_displacement_y', 'm', &
                   state%u(2, node) - state%u_zero(2, node))
        end if
        if (session%ground%wet) call add('probe_'//text_of(i)//'_pore_pressure', 'Pa', &
                                         state%pressure(node))
      end do
    end associate

  contains

    !> Reaction of a boundary with a name, in the directions that it holds.
    subroutine add_reaction(boundary)
      type(boundary_t), intent(in) :: boundary
      real(dp) :: reaction(2)
      character(:), allocatable :: title

      if (len(boundary%name) == 0 .or. .not. any(deck_held(boundary))) return
      title = 'reaction_'//text_as_word(boundary%name)
      if (any(columns%name(:columns%n) == title//'_x')) return
      reaction = conditions_reaction(session%conditions, boundary%name, session%work%force)
      call add(title//'_x', 'N/m', reaction(1))
      call add(title//'_y', 'N/m', reaction(2))
    end subroutine add_reaction

    subroutine add(name, unit, value)
      character(*), intent(in) :: name, unit
      real(dp), intent(in) :: value

      if (columns%n == size(columns%value)) call columns_double(columns)
      columns%n = columns%n + 1
      columns%name(columns%n) = name
      columns%unit(columns%n) = unit
      columns%value(columns%n) = value
    end subroutine add
  end subroutine collect

  !> Twice the room for columns.
  subroutine columns_double(columns)
    type(columns_t), intent(inout) :: columns

    columns%name = [columns%name, columns%name]
    columns%unit = [columns%unit, columns%unit]
    columns%value = [columns%value, columns%value]
  end subroutine columns_double

  !> Write a numbered snapshot, and the history so far into the result file.
  subroutine record_snapshot(session, status)
    type(session_t), intent(inout) :: session
    type(status_t), intent(inout) :: status

    call timer_start(session%timer, 'output')
    call snapshot_begin(session%result, session%state%time, &
                        session%deck%stage(session%stage)%name, &
                        int(session%state%steps), status)
    call write_fields(session, session%state, status)
    call snapshot_end(session%result, status)
    call history_store(session%history, session%result%path, status)
    call timer_stop(session%timer, 'output')
    if (session%deck%output%restart == 'all') call record_restart(session, status)
  end subroutine record_snapshot

  !> Write all of the present state, to start from, to the numbered snapshot just written.
  subroutine record_restart(session, status)
    type(session_t), intent(inout) :: session
    type(status_t), intent(inout) :: status
    character(6) :: number

    if (session%result%snapshots == 0) return
    write (number, '(i6.6)') session%result%snapshots - 1
    call write_restart(session, number, session%state, status)
  end subroutine record_restart

  !> Write all of a state beside the snapshot of a name.
  subroutine write_restart(session, name, state, status)
    type(session_t), intent(inout) :: session
    character(*), intent(in) :: name !! of the snapshot
    type(state_t), intent(inout) :: state !! is not changed
    type(status_t), intent(inout) :: status
    type(restart_t) :: restart

    if (status_failed(status)) return
    call timer_start(session%timer, 'output')
    restart%lost = session%lost
    restart%failed = session%failed
    restart%trigger_time = session%trigger_time
    restart%greatest_displacement = session%greatest_displacement
    restart%stride = session%seepage%stride
    restart%last = session%seepage%last
    if (allocated(session%motion%mode)) restart%mode = session%motion%mode
    call restart_write(session%result%path, name, state, restart, status)
    call timer_stop(session%timer, 'output')
  end subroutine write_restart

  !> Write a state apart from the numbered ones, and the history so far.
  subroutine record_named(session, name, state, status)
    type(session_t), intent(inout) :: session
    character(*), intent(in) :: name !! of the snapshot
    type(state_t), intent(in) :: state
    type(status_t), intent(inout) :: status

    call timer_start(session%timer, 'output')
    call snapshot_begin_named(session%result, name, state%time, &
      session%deck%stage(session%stage)%name, int(state%steps), status)
    call write_fields(session, state, status)
    call snapshot_end(session%result, status)
    call history_store(session%history, session%result%path, status)
    call timer_stop(session%timer, 'output')
  end subroutine record_named

  !> Write the last good state, after the numbers failed.
  subroutine record_last_good(session, saved)
    type(session_t), intent(inout) :: session
    character(:), allocatable, intent(out) :: saved !! what became of it, for the message of failure
    type(state_t) :: state
    type(status_t) :: status

    saved = 'no good state to save'
    if (.not. allocated(session%last_good%u)) return
    state = session%last_good
    call record_named(session, 'last_good', state, status)
    call write_restart(session, 'last_good', state, status)
    saved = 'last good state at '//text_of(state%time)//' s saved as snapshot last_good'
    if (status_failed(status)) saved = 'last good state not saved: '//status%message
  end subroutine record_last_good

  !> All active fields of a state.
  subroutine write_fields(session, state, status)
    type(session_t), intent(inout) :: session
    type(state_t), intent(in) :: state
    type(status_t), intent(inout) :: status

    if (session%soil_moves) call write_soil(session, state, status)
    if (session%ground%wet) call write_water(session, state, status)
  end subroutine write_fields

  subroutine write_soil(session, state, status)
    type(session_t), intent(inout) :: session
    type(state_t), intent(in) :: state
    type(status_t), intent(inout) :: status
    real(dp), allocatable :: scalar(:), field(:,:)

    associate (result => session%result)
      field = state%u - state%u_zero
      call snapshot_field(result, 'displacement', 'm', 'displacement since it was last reset', &
                          field, status)
      call snapshot_field(result, 'velocity', 'm/s', 'velocity', state%v, status)
      field = field_total_stress(session%disc, session%ground, state)
      call snapshot_field(result, 'stress', 'Pa', &
        'total Cauchy stress xx, yy, zz, xy, tension positive', field, status)
      if (session%disc%two_levels .and. .not. session%disc%damage_only) then
        field = field_acting_stress(session%disc, session%ground, state)
        call snapshot_field(result, 'stress_acting', 'Pa', &
          'total Cauchy stress that acts on the nodes, xx, yy, zz, xy, tension positive', field, &
          status)
      end if
      field = field_strain(session%disc, state)
      call snapshot_field(result, 'strain', '1', &
        'Green-Lagrange strain xx, yy, zz, xy since displacement was last reset', field, status)
      if (.not. allocated(state%history)) return
      scalar = state%history(history_eqps, :)
      call snapshot_field(result, 'plastic_strain', '1', 'equivalent plastic strain', scalar, &
                          status)
      if (allocated(state%opening)) call snapshot_field(result, 'opening', '1', &
        'volumetric strain that soil is open by', state%opening, status)
      if (all(session%ground%law%damage%driver == 0)) return
      scalar = state%history(history_damage, :)
      call snapshot_field(result, 'damage', '1', 'damage, 0 intact', scalar, status)
    end associate
  end subroutine write_soil

  subroutine write_water(session, state, status)
    type(session_t), intent(inout) :: session
    type(state_t), intent(in) :: state
    type(status_t), intent(inout) :: status
    real(dp), allocatable :: scalar(:), field(:,:)

    associate (result => session%result)
      call snapshot_field(result, 'pore_pressure', 'Pa', &
                          'pore water pressure, compression positive', state%pressure, status)
      call snapshot_field(result, 'saturation', '1', 'degree of saturation', state%saturation, &
                          status)
      scalar = max(-state%pressure, 0.0_dp)
      call snapshot_field(result, 'suction', 'Pa', 'suction', scalar, status)
      scalar = field_porosity(session%disc, session%ground, state)
      call snapshot_field(result, 'porosity', '1', 'porosity', scalar, status)
      allocate (field(2, session%disc%n))
      call seepage_velocity(session%disc, session%ground, state, field)
      call snapshot_field(result, 'seepage_velocity', 'm/s', 'Darcy velocity', field, status)
    end associate
  end subroutine write_water
end module talus_record
