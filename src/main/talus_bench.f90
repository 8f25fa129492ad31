! SPDX-License-Identifier: MIT
!> `talus bench`: how fast the program is on this machine, how close to what the memory allows, and
!> what each part of the physics costs.
module talus_bench
  use, intrinsic :: iso_fortran_env, only: output_unit, error_unit
  use talus_status, only: status_t, status_failed
  use talus_text, only: text_of
  use talus_bench_model, only: parts_t, parts_one_level, parts_everything
  use talus_bench_triad, only: triad_t, triad_allocate, triad_entries
  use talus_bench_measure, only: speed_t, price_t, measure_speed, measure_prices, &
    triads_agree
  use talus_bench_report, only: report_text, report_files, report_keys
  use omp_lib, only: omp_get_num_procs
  implicit none
  private
  public :: bench, price_name, price_parts

  integer, parameter :: nodes_all(4) = [2000, 20000, 200000, 1000000], nodes_quick = 20000
  !> Node-steps of a timed block.
  integer, parameter :: block_node_steps = 1250000

  !> Each row of the price list adds one part to the row above it; in the last but one, Bishop's
  !> stress takes the place of net stress.
  character(36), parameter :: price_name(8) = [character(36) :: 'elastic, one level', &
    '+ second level, 3 spacings', '+ stabilisation', '+ Drucker-Prager', '+ damage', &
    '+ water and seepage', '+ Bishop''s stress', '+ audit every step']
  logical, parameter :: y = .true., n = .false.
  type(parts_t), parameter :: price_parts(8) = [parts_t(n, n, n, n, n, n, n), &
    parts_t(y, n, n, n, n, n, n), parts_t(y, y, n, n, n, n, n), parts_t(y, y, y, n, n, n, n), &
    parts_t(y, y, y, y, n, n, n), parts_t(y, y, y, y, y, n, n), parts_t(y, y, y, y, y, y, n), &
    parts_t(y, y, y, y, y, y, y)]

contains

  !> Measure, print, and store in the folder `output`.
  subroutine bench(quick, output, status)
    logical, intent(in) :: quick         !! one size only, in less than a minute
    character(*), intent(in) :: output   !! folder; '' writes no files
    type(status_t), intent(inout) :: status
    type(triad_t) :: triad
    type(speed_t), allocatable :: speed(:)
    type(price_t) :: price(size(price_name))
    integer, allocatable :: threads(:), nodes(:)
    integer :: i, all

    nodes = nodes_all
    if (quick) nodes = [nodes_quick]
    threads = [1, 2]
    all = omp_get_num_procs()
    if (all > 2 .and. .not. quick) threads = [1, 2, all]
    allocate (speed(0))
    call triad_allocate(triad, triad_entries)
    do i = 1, size(nodes)
      call add('one level', parts_one_level, nodes(i), threads, triad, speed, status)
      call add('everything', parts_everything, nodes(i), threads, triad, speed, status)
      if (status_failed(status)) return
    end do
    deallocate (triad%a, triad%b, triad%c)
    call triads_agree(speed)
    call say('price list')
    call measure_prices(price_name, price_parts, nodes_quick, block_node_steps, price, status)
    if (status_failed(status)) return
    write (output_unit, '(a)') report_text(speed, price, '')
    if (len(output) > 0) call report_files(output, speed, price, status)
    write (output_unit, '(a)', advance='no') report_keys(speed, nodes_quick)
  end subroutine bench

  !> Measure one model and add its rows.
  subroutine add(name, parts, nodes, threads, triad, speed, status)
    character(*), intent(in) :: name
    type(parts_t), intent(in) :: parts
    integer, intent(in) :: nodes, threads(:)
    type(triad_t), intent(inout) :: triad
    type(speed_t), allocatable, intent(inout) :: speed(:)
    type(status_t), intent(inout) :: status
    type(speed_t), allocatable :: rows(:)

    if (status_failed(status)) return
    call say(name//', '//text_of(nodes)//' nodes')
    call measure_speed(name, parts, nodes, threads, block_node_steps, triad, rows, status)
    if (status_failed(status)) return
    speed = [speed, rows]
  end subroutine add

  !> Tell what is being measured, apart from the results.
  subroutine say(what)
    character(*), intent(in) :: what

    write (error_unit, '(2a)') 'bench: ', what
    flush (error_unit)
  end subroutine say
end module talus_bench
