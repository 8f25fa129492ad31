! SPDX-License-Identifier: MIT
!> Everything one run holds, from the deck to the open result files.
module talus_session
  use talus_kinds, only: dp, i8
  use talus_deck_types, only: deck_t
  use talus_ground, only: ground_t
  use talus_disc, only: disc_t
  use talus_state, only: state_t
  use talus_conditions, only: conditions_t
  use talus_soil_step, only: work_t, motion_t
  use talus_seepage, only: seepage_t
  use talus_relax, only: relax_t
  use talus_audit, only: energies_t
  use talus_timer, only: timer_t
  use talus_result, only: result_t
  use talus_history, only: history_t
  use talus_summary, only: summary_t
  use talus_progress, only: progress_t
  implicit none
  private
  public :: session_t, reduction_t

  !> What a stage of strength reduction found.
  type :: reduction_t
    integer :: stage = 0             !! its number
    real(dp) :: lower = -1.0_dp      !! largest factor that stands; -1: none found [-]
    real(dp) :: upper = -1.0_dp      !! smallest factor that does not; -1: none found [-]
    integer :: trials = 0
    real(dp) :: moved_max = huge(1.0_dp) !! displacement that counts as failure [m]
    type(relax_t) :: stood, fell     !! relaxations at `lower` and `upper`
  end type reduction_t

  type :: session_t
    type(deck_t) :: deck
    type(ground_t) :: ground                !! soils of the deck
    type(disc_t) :: disc
    type(state_t) :: state
    type(state_t) :: last_good              !! to fall back on when the numbers fail
    type(conditions_t) :: conditions        !! of the present stage
    type(work_t) :: work
    type(motion_t) :: motion                !! of the present stage
    type(seepage_t) :: seepage
    character(:), allocatable :: restart_name !! snapshot that the run started from; '' for none
    integer(i8) :: steps_before = 0_i8, seepage_steps_before = 0_i8 !! of the runs before
    integer, allocatable :: probe(:)        !! node of each probe
    integer :: stage = 0                    !! number of the present stage
    real(dp) :: stage_start = 0.0_dp        !! time at which it began [s]
    type(energies_t) :: energies_start      !! at the start of the stage
    logical :: soil_moves = .false.         !! some stage solves the soil
    logical :: lost = .false.               !! the latest storm ended in failure
    logical :: failed = .false.             !! some storm ended in failure
    real(dp) :: trigger_time = -1.0_dp      !! when it was lost first [s]; -1: never
    real(dp) :: factor = 1.0_dp             !! that divides the strength in the present trial
    logical :: stands = .true.              !! outcome of the latest trial of a factor
    type(reduction_t), allocatable :: reduction(:) !! of each stage of strength reduction so far
    logical :: joint = .false.              !! water and soil of the stage agree in each step
    real(dp), allocatable :: u_window(:,:)  !! displacement when the full step of the storm that its
                                            !! clock is in began [m], (2,n)
    logical :: new_load = .false.           !! the stage began with other loads than the last one had
    real(dp) :: coupling_error = -1.0_dp    !! greatest coupling_left of all storm steps; -1: none
    real(dp) :: worst_water_error = 0.0_dp  !! over all stages but geostatic
    real(dp) :: worst_energy_error = 0.0_dp !! over all dynamic stages
    real(dp) :: greatest_displacement = 0.0_dp !! since displacements were last reset [m]
    character(:), allocatable :: declared   !! scaled masses and damping of the stages
    type(timer_t) :: timer
    type(progress_t) :: progress
    character(:), allocatable :: base       !! path of the result files without ending
    type(result_t) :: result
    type(history_t) :: history
    type(summary_t) :: summary
  end type session_t
end module talus_session
