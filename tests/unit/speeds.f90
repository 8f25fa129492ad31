! SPDX-License-Identifier: MIT
!> Measurements of speed as they could be, for the suites that report them.
module speeds
  use talus_kinds, only: dp
  use talus_bench_bytes, only: phases, phase_strain, phase_stress, phase_seepage
  use talus_bench_measure, only: speed_t, price_t
  use talus_timer, only: timer_start, timer_stop, timer_seconds
  implicit none
  private
  public :: speed_row, price_rows

contains

  !> One model on a number of threads with a memory of 10 GB/s: 800 bytes a node-step in two phases
  !> that take a quarter and three quarters of the step, and a set-up that took some time.
  function speed_row(model, nodes, threads, rate) result(row)
    character(*), intent(in) :: model
    integer, intent(in) :: nodes, threads
    real(dp), intent(in) :: rate !! node-steps per second
    type(speed_t) :: row

    row%model = model
    row%nodes = nodes
    row%threads = threads
    row%step = real(nodes, dp)/rate
    row%phase(phase_strain) = 0.25_dp*row%step
    row%phase(phase_stress) = 0.75_dp*row%step
    row%bytes(phase_strain) = 200.0_dp*real(nodes, dp)
    row%bytes(phase_stress) = 600.0_dp*real(nodes, dp)
    if (model == 'everything') then
      row%share = 0.125_dp
      row%phase(phase_seepage) = row%step
      row%bytes(phase_seepage) = 400.0_dp*real(nodes, dp)
    end if
    row%triad = 1.0e10_dp
    call timer_start(row%timer, 'set_up')
    do while (.not. timer_seconds(row%timer, 'set_up') > 0.0_dp)
    end do
    call timer_stop(row%timer, 'set_up')
  end function speed_row

  !> A price list of 8 rows, each as dear as the one above.
  function price_rows() result(price)
    type(price_t) :: price(8)
    integer :: i

    do i = 1, size(price)
      write (price(i)%name, '(a,i0)') 'row ', i
      price(i)%nodes = 20000
      price(i)%step = 0.01_dp
      price(i)%bytes = 1000.0_dp + 50.0_dp*real(i, dp)
    end do
  end function price_rows
end module speeds
