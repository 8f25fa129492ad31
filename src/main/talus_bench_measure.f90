! SPDX-License-Identifier: MIT
!> Measurements of the speed report. Everything that is compared is timed in turns within the same
!> rounds, so that other work on the machine slows all of it alike; medians of five rounds are kept.
module talus_bench_measure
  use talus_kinds, only: dp, i8
  use talus_memory, only: memory_held
  use talus_status, only: status_t, status_failed
  use talus_session, only: session_t
  use talus_timer, only: timer_t
  use talus_cost, only: cost_t, cost_of
  use talus_bench_model, only: parts_t, bench_prepare
  use talus_bench_bytes, only: phases, phase_seepage, phase_bytes
  use talus_bench_triad, only: triad_t, triad_bandwidth
  use talus_bench_step, only: block_seconds, block_phases, seepage_seconds
  use omp_lib, only: omp_set_num_threads, omp_get_max_threads
  implicit none
  private
  public :: speed_t, price_t, measure_speed, measure_prices, triads_agree, median

  integer, parameter, public :: rounds = 5
  !> Fewest steps of a timed block.
  integer, parameter :: fewest_steps = 3
  !> Soil steps before the first timing.
  integer, parameter :: warm_steps = 40

  !> One model on one number of threads.
  type :: speed_t
    character(16) :: model = ''
    integer :: nodes = 0, threads = 0
    real(dp) :: step = 0.0_dp            !! a soil step with its share of the water [s]
    real(dp) :: phase(phases) = 0.0_dp   !! each phase in one step, the water in a sub-step [s]
    real(dp) :: bytes(phases) = 0.0_dp   !! the same by count
    real(dp) :: share = 0.0_dp           !! sub-steps of the water in a soil step
    real(dp) :: triad = 0.0_dp           !! bandwidth on so many threads [bytes/s]
    real(dp) :: speedup = 1.0_dp         !! over one thread, by the rounds
    integer(i8) :: peak = 0_i8           !! most memory of the model [bytes]; 0 where not known
    logical :: same = .true.             !! displacements are those of one thread, bit by bit
    type(timer_t) :: timer               !! of the set-up
  end type speed_t

  !> One model of the price list.
  type :: price_t
    character(40) :: name = ''
    integer :: nodes = 0
    real(dp) :: step = 0.0_dp    !! [s]
    real(dp) :: over_first = 1.0_dp, over_before = 1.0_dp !! medians of the rounds' quotients
    real(dp) :: bytes = 0.0_dp   !! memory a node, without the matrix of implicit seepage
    real(dp) :: yielded = 0.0_dp !! share of nodes that have yielded
  end type price_t

contains

  !> Speed of one model on each of several numbers of threads, the first of which is 1.
  subroutine measure_speed(name, parts, nodes, threads, block, triad, speed, status)
    character(*), intent(in) :: name
    type(parts_t), intent(in) :: parts
    integer, intent(in) :: nodes, threads(:)
    integer, intent(in) :: block !! node-steps of a timed block
    type(triad_t), intent(inout) :: triad
    type(speed_t), allocatable, intent(out) :: speed(:) !! one a number of threads
    type(status_t), intent(inout) :: status
    type(session_t) :: session
    real(dp), allocatable :: whole(:,:), phase(:,:,:), band(:,:), u(:,:)
    real(dp) :: water_step
    integer(i8) :: held
    integer :: r, t, p, steps, most

    most = omp_get_max_threads()
    held = memory_held('VmRSS:')
    call memory_forget
    allocate (speed(size(threads)), whole(rounds, size(threads)), band(rounds, size(threads)))
    allocate (phase(rounds, phases, size(threads)), source=0.0_dp)
    call bench_prepare(parts, nodes, warm_steps, session, water_step, status)
    if (status_failed(status)) return
    steps = max(fewest_steps, block/session%disc%n)
    speed%model = name
    speed%nodes = session%disc%n
    speed%threads = threads
    if (parts%water) speed%share = session%motion%step/water_step
    do r = 1, rounds
      do t = 1, size(threads)
        call omp_set_num_threads(threads(t))
        band(r, t) = triad_bandwidth(triad)
        whole(r, t) = block_seconds(session, steps, parts%audit)
        if (r == 1 .and. t == 1) u = session%state%u
        speed(t)%same = speed(t)%same .and. .not. any(abs(session%state%u - u) > 0.0_dp)
        phase(r, :, t) = block_phases(session, steps)
        if (parts%water) phase(r, phase_seepage, t) = seepage_seconds(session, water_step)
        whole(r, t) = whole(r, t) + speed(t)%share*phase(r, phase_seepage, t)
      end do
    end do
    call omp_set_num_threads(most)
    do t = 1, size(threads)
      speed(t)%step = median(whole(:, t))
      speed(t)%triad = median(band(:, t))
      speed(t)%speedup = median(whole(:, 1)/whole(:, t))
      speed(t)%bytes = phase_bytes(session)
      speed(t)%timer = session%timer
      do p = 1, phases
        speed(t)%phase(p) = median(phase(:, p, t))
      end do
    end do
    if (held > 0_i8) speed%peak = memory_held('VmHWM:') - held
  end subroutine measure_speed

  !> Give all models on as many threads one triad, the median of theirs: there is one memory, and
  !> what else used it while one model was measured says nothing of that model.
  pure subroutine triads_agree(speed)
    type(speed_t), intent(inout) :: speed(:)
    real(dp) :: own(size(speed))
    integer :: i

    own = speed%triad
    do i = 1, size(speed)
      speed(i)%triad = median(pack(own, speed%threads == speed(i)%threads))
    end do
  end subroutine triads_agree

  !> Prices of models, on one thread; the first is the unit.
  subroutine measure_prices(names, parts, nodes, block, price, status)
    character(*), intent(in) :: names(:)
    type(parts_t), intent(in) :: parts(:)
    integer, intent(in) :: nodes
    integer, intent(in) :: block !! node-steps of a timed block
    type(price_t), intent(out) :: price(:)
    type(status_t), intent(inout) :: status
    type(session_t), allocatable :: session(:)
    type(cost_t) :: cost
    real(dp) :: whole(rounds, size(parts)), water_step(size(parts))
    integer :: r, i, steps, most

    most = omp_get_max_threads()
    call omp_set_num_threads(1)
    allocate (session(size(parts)))
    do i = 1, size(parts)
      call bench_prepare(parts(i), nodes, warm_steps, session(i), water_step(i), status)
      if (status_failed(status)) return
    end do
    do r = 1, rounds
      do i = 1, size(parts)
        steps = max(fewest_steps, block/session(i)%disc%n)
        whole(r, i) = block_seconds(session(i), steps, parts(i)%audit)
        if (parts(i)%water) whole(r, i) = whole(r, i) &
          + session(i)%motion%step/water_step(i)*seepage_seconds(session(i), water_step(i))
      end do
    end do
    do i = 1, size(parts)
      cost = cost_of(session(i))
      price(i)%name = names(i)
      price(i)%nodes = session(i)%disc%n
      price(i)%step = median(whole(:, i))
      price(i)%over_first = median(whole(:, i)/whole(:, 1))
      price(i)%over_before = median(whole(:, i)/whole(:, max(1, i - 1)))
      price(i)%bytes = real(cost%total - cost%matrix, dp)/real(session(i)%disc%n, dp)
      if (allocated(session(i)%last_good%history)) price(i)%yielded = &
        real(count(session(i)%last_good%history(1, :) > 0.0_dp), dp)/real(session(i)%disc%n, dp)
    end do
    call omp_set_num_threads(most)
  end subroutine measure_prices

  !> The middle of an odd number of values, the mean of the two middle ones of an even number.
  pure real(dp) function median(values)
    real(dp), intent(in) :: values(:) !! one at least
    real(dp) :: sorted(size(values)), kept
    integer :: i, j

    sorted = values
    do i = 2, size(sorted)
      kept = sorted(i)
      do j = i - 1, 1, -1
        if (sorted(j) <= kept) exit
        sorted(j+1) = sorted(j)
      end do
      sorted(j+1) = kept
    end do
    median = 0.5_dp*(sorted((size(sorted) + 1)/2) + sorted(size(sorted)/2 + 1))
  end function median

  !> Let the kernel count the most memory anew.
  subroutine memory_forget
    integer :: unit, failed

    open (newunit=unit, file='/proc/self/clear_refs', action='write', iostat=failed)
    if (failed /= 0) return
    write (unit, '(a)', iostat=failed) '5'
    close (unit, iostat=failed)
  end subroutine memory_forget
end module talus_bench_measure
