! SPDX-License-Identifier: MIT
!> The targets of speed beside what was measured: the first table of the speed report.
module talus_bench_reach
  use talus_kinds, only: dp, i8
  use talus_text, only: text_of
  use talus_timer, only: timer_seconds
  use talus_bench_bytes, only: phase_second, phase_seepage
  use talus_bench_measure, only: speed_t, price_t
  implicit none
  private
  public :: reach_text, reach_traffic

  character, parameter :: nl = new_line('a')
  !> A triad of so many bytes a second asks for the whole speed; a slower one for its share.
  real(dp), parameter :: triad_asked = 1.0e10_dp
  !> Rows of the price list, in the order of talus_bench.
  integer, parameter :: row_second = 2, row_damage = 5, row_water = 6, row_audit = 8
  integer, parameter :: digits = 3

contains

  !> One line a target, with what was measured and by how much it is missed. Targets at sizes that
  !> were not run are left out.
  function reach_text(speed, price) result(text)
    type(speed_t), intent(in) :: speed(:)
    type(price_t), intent(in) :: price(:)
    character(:), allocatable :: text
    integer :: one, all

    text = '## Targets'//nl//nl//'| target | limit | measured | |'//nl//'|---|--:|--:|---|'//nl
    one = found(speed, 'one level', 20000, 1)
    all = found(speed, 'everything', 20000, 1)
    if (min(one, all) > 0) text = text &
      //least('one level, 2e4 nodes, one thread: million node-steps/s', &
              5.0_dp*share(speed(one)), 1.0e-6_dp*rate(speed(one))) &
      //least('everything, 2e4 nodes, one thread: million node-steps/s', &
              2.0_dp*share(speed(all)), 1.0e-6_dp*rate(speed(all)))
    one = found(speed, 'one level', 200000, 1)
    if (one > 0) text = text//least('one level, 2e5 nodes, one thread: fraction of the roofline', &
                                    0.6_dp, reach_traffic(speed(one))/speed(one)%step &
                                    /speed(one)%triad)
    text = text//most('price: second level of 3 spacings', 2.0_dp, price(row_second)%over_before) &
      //most('price: damage', 1.15_dp, price(row_damage)%over_before) &
      //most('price: seepage at its own step', 1.2_dp, price(row_water)%over_before) &
      //most('price: audit every step', 1.05_dp, price(row_audit)%over_before) &
      //most('bytes a step moves by count for parts that are switched off', 0.0_dp, idle(speed)) &
      //million('one level', speed)//million('everything', speed) &
      //threads('one level', speed)//threads('everything', speed) &
      //line('results on any number of threads', 'same bits', &
             trim(merge('same bits', 'others   ', all_same(speed))), all_same(speed))
  end function reach_text

  !> Bytes of a whole step by count, with its share of the water.
  pure real(dp) function reach_traffic(speed) result(bytes)
    type(speed_t), intent(in) :: speed

    bytes = sum(speed%bytes) - (1.0_dp - speed%share)*speed%bytes(phase_seepage)
  end function reach_traffic

  !> Targets of a model at 1e6 nodes, on one thread but for the set-up.
  function million(model, speed) result(text)
    character(*), intent(in) :: model
    type(speed_t), intent(in) :: speed(:)
    character(:), allocatable :: text
    real(dp) :: set_up, earlier
    integer :: i, small, before

    text = ''
    i = found(speed, model, 1000000, 1)
    small = found(speed, model, 20000, 1)
    before = found(speed, model, 200000, 1)
    if (min(i, small, before) == 0) return
    set_up = seconds(speed(i))
    earlier = seconds(speed(before))
    ! The system may not tell how much memory was held.
    if (speed(i)%peak > 0_i8) text = most(model//', 1e6 nodes: GB', 3.0_dp, &
                                          1.0e-9_dp*real(speed(i)%peak, dp))
    text = text//most(model//': time per node-step at 1e6 nodes over that at 2e4', 1.3_dp, &
             rate(speed(small))/rate(speed(i))) &
      //most(model//', 1e6 nodes: set-up with the first stable step, s', 20.0_dp, set_up) &
      //line(model//': set-up of 1e6 nodes over that of 2e5', 'O(N): about ' &
             //text_of(real(speed(i)%nodes, dp)/real(speed(before)%nodes, dp), 2), &
             text_of(set_up/earlier, digits), set_up/earlier <= 7.5_dp)
  end function million

  !> Targets of two threads.
  function threads(model, speed) result(text)
    character(*), intent(in) :: model
    type(speed_t), intent(in) :: speed(:)
    character(:), allocatable :: text
    integer :: small, large

    text = ''
    small = found(speed, model, 2000, 2)
    large = found(speed, model, 200000, 2)
    if (large > 0) text = text//least(model//', 2e5 nodes: two threads over one', 1.8_dp, &
                                      speed(large)%speedup)
    if (small > 0) text = text//least(model//', 2e3 nodes: two threads over one', 1.0_dp, &
                                      speed(small)%speedup)
  end function threads

  function least(what, limit, value) result(text)
    character(*), intent(in) :: what
    real(dp), intent(in) :: limit, value
    character(:), allocatable :: text

    text = line(what, '>= '//text_of(limit, digits), text_of(value, digits), value >= limit, &
                value/max(limit, tiny(1.0_dp)))
  end function least

  function most(what, limit, value) result(text)
    character(*), intent(in) :: what
    real(dp), intent(in) :: limit, value
    character(:), allocatable :: text

    if (limit > 0.0_dp) then
      text = line(what, '<= '//text_of(limit, digits), text_of(value, digits), value <= limit, &
                  value/limit)
    else
      ! No number of times nothing.
      text = line(what, '<= '//text_of(limit, digits), text_of(value, digits), value <= limit)
    end if
  end function most

  !> A row of the table.
  function line(what, limit, value, met, over) result(text)
    character(*), intent(in) :: what, limit, value
    logical, intent(in) :: met
    real(dp), intent(in), optional :: over !! measured over limit
    character(:), allocatable :: text

    text = '| '//what//' | '//limit//' | '//value//' |'
    if (met) then
      text = text//' met |'//nl
    else if (present(over)) then
      text = text//' **missed: '//text_of(over, digits)//' of the limit** |'//nl
    else
      text = text//' **missed** |'//nl
    end if
  end function line

  !> Row of a model near a size; 0 when it was not measured.
  pure integer function found(speed, model, nodes, threads) result(at)
    type(speed_t), intent(in) :: speed(:)
    character(*), intent(in) :: model
    integer, intent(in) :: nodes, threads
    integer :: i

    at = 0
    do i = 1, size(speed)
      if (speed(i)%model == model .and. speed(i)%threads == threads .and. &
        abs(speed(i)%nodes - nodes) < nodes/4) at = i
    end do
  end function found

  !> Share of the whole speed that the measured bandwidth asks for.
  pure real(dp) function share(speed)
    type(speed_t), intent(in) :: speed

    share = min(1.0_dp, speed%triad/triad_asked)
  end function share

  pure real(dp) function rate(speed)
    type(speed_t), intent(in) :: speed

    rate = real(speed%nodes, dp)/speed%step
  end function rate

  !> Set-up with the search for the first stable step [s].
  real(dp) function seconds(speed)
    type(speed_t), intent(in) :: speed

    seconds = timer_seconds(speed%timer, 'set_up') + timer_seconds(speed%timer, 'stable_step')
  end function seconds

  !> Bytes of phases that the model "one level" does not have.
  pure real(dp) function idle(speed)
    type(speed_t), intent(in) :: speed(:)
    integer :: i

    idle = 0.0_dp
    do i = 1, size(speed)
      if (speed(i)%model == 'one level') idle = idle + speed(i)%bytes(phase_second) &
        + speed(i)%bytes(phase_seepage)
    end do
  end function idle

  pure logical function all_same(speed)
    type(speed_t), intent(in) :: speed(:)

    all_same = all(speed%same)
  end function all_same
end module talus_bench_reach
