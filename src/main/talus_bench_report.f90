! SPDX-License-Identifier: MIT
!> The speed report as Markdown, which also reads well on a terminal, and as CSV.
module talus_bench_report
  use, intrinsic :: iso_fortran_env, only: compiler_version
  use talus_kinds, only: dp, i8
  use talus_status, only: status_t, status_failed
  use talus_text, only: text_of
  use talus_timer, only: timer_names, timer_seconds
  use talus_place, only: place_folder
  use talus_read_file, only: file_read
  use talus_file, only: file_replace
  use talus_version, only: version, git_hash
  use talus_bench_bytes, only: phases, phase_name
  use talus_bench_measure, only: speed_t, price_t, rounds
  use talus_bench_reach, only: reach_text, reach_traffic
  implicit none
  private
  public :: report_text, report_files, report_keys

  character, parameter :: nl = new_line('a')
  integer, parameter :: notes_most_bytes = 4000000

contains

  !> All tables, those of the targets first, with what people wrote about them.
  function report_text(speed, price, notes) result(text)
    type(speed_t), intent(in) :: speed(:)
    type(price_t), intent(in) :: price(:)
    character(*), intent(in) :: notes
    character(:), allocatable :: text

    text = heading()//nl//reach_text(speed, price)//nl//notes//speed_table(speed)//nl &
      //roofline_table(speed)//nl//setup_table(speed)//nl//price_table(price)
  end function report_text

  !> README.md, scaling.csv, setup.csv and price.csv in a folder. A file NOTES.md there becomes a
  !> part of README.md.
  subroutine report_files(folder, speed, price, status)
    character(*), intent(in) :: folder
    type(speed_t), intent(in) :: speed(:)
    type(price_t), intent(in) :: price(:)
    type(status_t), intent(inout) :: status

    call place_folder(folder//'/README.md', status)
    if (status_failed(status)) return
    call file_replace(folder//'/README.md', '# Speed of TALUS'//nl//nl// &
      'Written by `./talus bench`. Pictures: [scaling](scaling.png), '// &
      '[price list](price_list.png).' &
      //nl//nl//report_text(speed, price, notes_of(folder)), status)
    call file_replace(folder//'/scaling.csv', scaling_csv(speed), status)
    call file_replace(folder//'/setup.csv', setup_csv(speed), status)
    call file_replace(folder//'/price.csv', price_csv(price), status)
  end subroutine report_files

  !> The lines that a script can read, of the models with about so many nodes.
  function report_keys(speed, nodes) result(text)
    type(speed_t), intent(in) :: speed(:)
    integer, intent(in) :: nodes
    character(:), allocatable :: text

    associate (one => speed(found('one level', 1)), two => speed(found('one level', 2)), &
               all => speed(found('everything', 1)))
      text = key('triad_GB_per_s', 1.0e-9_dp*one%triad) &
        //key('one_level_node_steps_per_s', rate(one, one%step)) &
        //key('one_level_roofline_fraction', fraction_of(one)) &
        //key('everything_node_steps_per_s', rate(all, all%step)) &
        //key('two_thread_speedup', two%speedup)
    end associate

  contains

    !> Row of a model next to the size and number of threads.
    pure integer function found(model, threads) result(at)
      character(*), intent(in) :: model
      integer, intent(in) :: threads

      at = minloc(abs(speed%nodes - nodes) + 1000000*abs(speed%threads - threads), dim=1, &
                  mask=speed%model == model)
    end function found

    pure function key(name, value) result(line)
      character(*), intent(in) :: name
      real(dp), intent(in) :: value
      character(:), allocatable :: line

      line = name//' = '//text_of(value, 4)//nl
    end function key
  end function report_keys

  !> Text of NOTES.md in a folder, and an empty line; nothing without that file.
  function notes_of(folder) result(notes)
    character(*), intent(in) :: folder
    character(:), allocatable :: notes
    character(:), allocatable :: problem

    call file_read(folder//'/NOTES.md', 'the working folder', 'notes', notes_most_bytes, notes, &
                   problem)
    if (len(problem) > 0) then
      notes = ''
      return
    end if
    if (notes(len(notes):) /= nl) notes = notes//nl
    notes = notes//nl
  end function notes_of

  !> Machine, date and how to read the tables.
  function heading() result(text)
    character(:), allocatable :: text
    integer :: now(8)
    character(10) :: date

    call date_and_time(values=now)
    write (date, '(i4.4,2("-",i2.2))') now(1:3)
    text = 'Machine: '//processor()//load_average()//'; date: '//date//'; TALUS '// &
      version//' ('//git_hash// &
      '), '// &
      compiler_version()//'.'//nl//nl// &
      'A slope of 375 m2. "one level": one level of smoothing, Drucker-Prager, stabilised. '// &
      '"everything": two levels with a length'//nl// &
      'of three spacings, Drucker-Prager, damage, '// &
      'pore water coupled to the soil, stabilised. Wall times are medians of '//text_of(rounds)// &
      nl// &
      'rounds, in which all that is compared takes turns; the triad is the median of all models on '// &
      'as many threads.'//nl//'Bytes are counted, not measured (src/main/talus_bench_bytes.f90).'//nl
  end function heading

  !> Million node-steps per second, whole and by phase.
  function speed_table(speed) result(text)
    type(speed_t), intent(in) :: speed(:)
    character(:), allocatable :: text
    integer :: i, p

    text = '## Million node-steps per second'//nl//nl// &
      '| model | nodes | threads | whole step |'
    do p = 1, phases
      text = text//' '//trim(phase_name(p))//' |'
    end do
    text = text//' speed-up | same bits |'//nl//'|---|--:|--:|--:|'//repeat('--:|', phases)// &
      '--:|---|'//nl
    do i = 1, size(speed)
      text = text//start(speed(i))//number(1.0e-6_dp*rate(speed(i), speed(i)%step))
      do p = 1, phases
        if (speed(i)%bytes(p) > 0.0_dp) then
          text = text//number(1.0e-6_dp*rate(speed(i), speed(i)%phase(p)))
        else
          text = text//' - |'
        end if
      end do
      text = text//number(speed(i)%speedup)//' '//trim(merge('yes', 'no ', speed(i)%same))//' |'//nl
    end do
    text = text//nl// &
      'Seepage is an explicit sub-step of the water; the whole step holds as many '// &
      'of them as its time does.'//nl
  end function speed_table

  !> Bytes, bandwidth and the fraction of the roofline.
  function roofline_table(speed) result(text)
    type(speed_t), intent(in) :: speed(:)
    character(:), allocatable :: text
    integer :: i

    text = '## Memory traffic'//nl//nl// &
      '| model | nodes | threads | bytes per node-step | GB/s | '// &
      'STREAM triad GB/s | fraction of the roofline | parallel efficiency | '// &
      'peak bytes per node |'//nl// &
      '|---|--:|--:|--:|--:|--:|--:|--:|--:|'//nl
    do i = 1, size(speed)
      text = text//start(speed(i))//number(reach_traffic(speed(i))/real(speed(i)%nodes, dp)) &
        //number(1.0e-9_dp*reach_traffic(speed(i))/speed(i)%step) &
        //number(1.0e-9_dp*speed(i)%triad)//number(fraction_of(speed(i))) &
        //number(speed(i)%speedup/real(speed(i)%threads, dp)) &
        //number(real(speed(i)%peak, dp)/real(speed(i)%nodes, dp))//nl
    end do
  end function roofline_table

  !> Seconds of set-up by phase.
  function setup_table(speed) result(text)
    type(speed_t), intent(in) :: speed(:)
    character(:), allocatable :: text
    integer :: i, p

    text = '## Set-up, seconds'//nl//nl//'| model | nodes |'
    associate (names => timer_names(speed(size(speed))%timer))
      do p = 1, size(names)
        text = text//' '//trim(names(p))//' |'
      end do
      text = text//nl//'|---|--:|'
      do p = 1, size(names)
        text = text//'--:|'
      end do
      text = text//nl
      do i = 1, size(speed)
        if (speed(i)%threads > 1) cycle
        text = text//'| '//trim(speed(i)%model)//' | '//text_of(speed(i)%nodes)//' |'
        do p = 1, size(names)
          text = text//number(timer_seconds(speed(i)%timer, trim(names(p))))
        end do
        text = text//nl
      end do
    end associate
    text = text//nl// &
      '`set_up` holds those that follow it but `stable_step`, the search for the '// &
      'first stable step.'//nl
  end function setup_table

  !> What each part costs.
  function price_table(price) result(text)
    type(price_t), intent(in) :: price(:)
    character(:), allocatable :: text
    integer :: i

    text = '## Price list'//nl//nl// &
      'Each row adds a part to the row above (Bishop''s stress takes '// &
      'the place of net stress). '//text_of(price(1)%nodes)//' nodes, one thread.'//nl//nl// &
      '| model | million node-steps/s | price | over the row above | bytes per node | '// &
      'more bytes | '// &
      'nodes that yielded |'//nl//'|---|--:|--:|--:|--:|--:|--:|'//nl
    do i = 1, size(price)
      text = text//'| '//trim(price(i)%name)//' |'//number(1.0e-6_dp*real(price(i)%nodes, dp) &
        /price(i)%step)//number(price(i)%over_first)//number(price(i)%over_before) &
        //number(price(i)%bytes)//number(price(i)%bytes - price(max(1, i - 1))%bytes) &
        //number(price(i)%yielded)//nl
    end do
  end function price_table

  function scaling_csv(speed) result(text)
    type(speed_t), intent(in) :: speed(:)
    character(:), allocatable :: text
    integer :: i, p

    text = 'model,nodes,threads,phase,node_steps_per_s,bytes_per_node_step,triad_bytes_per_s,'// &
      'roofline_fraction,parallel_efficiency,peak_bytes_per_node'//nl
    do i = 1, size(speed)
      call line('whole', speed(i)%step, reach_traffic(speed(i)))
      do p = 1, phases
        if (speed(i)%bytes(p) > 0.0_dp) call line(trim(phase_name(p)), speed(i)%phase(p), &
                                                  speed(i)%bytes(p))
      end do
    end do

  contains

    subroutine line(phase, seconds, bytes)
      character(*), intent(in) :: phase
      real(dp), intent(in) :: seconds, bytes

      text = text//trim(speed(i)%model)//','//text_of(speed(i)%nodes)//','// &
        text_of(speed(i)%threads)//','//phase//','//text_of(rate(speed(i), seconds))//','// &
        text_of(bytes/real(speed(i)%nodes, dp))//','//text_of(speed(i)%triad)//','// &
        text_of(bytes/max(seconds, tiny(1.0_dp))/speed(i)%triad)//','// &
        text_of(speed(i)%speedup/real(speed(i)%threads, dp))//','// &
        text_of(real(speed(i)%peak, dp)/real(speed(i)%nodes, dp))//nl
    end subroutine line
  end function scaling_csv

  function setup_csv(speed) result(text)
    type(speed_t), intent(in) :: speed(:)
    character(:), allocatable :: text
    integer :: i, p

    text = 'model,nodes,phase,seconds'//nl
    do i = 1, size(speed)
      if (speed(i)%threads > 1) cycle
      associate (names => timer_names(speed(i)%timer))
        do p = 1, size(names)
          text = text//trim(speed(i)%model)//','//text_of(speed(i)%nodes)//','//trim(names(p))// &
            ','// &
            text_of(timer_seconds(speed(i)%timer, trim(names(p))))//nl
        end do
      end associate
    end do
  end function setup_csv

  function price_csv(price) result(text)
    type(price_t), intent(in) :: price(:)
    character(:), allocatable :: text
    integer :: i

    text = 'model,nodes,node_steps_per_s,price,over_row_above,bytes_per_node,yielded'//nl
    do i = 1, size(price)
      text = text//trim(price(i)%name)//','//text_of(price(i)%nodes)//','// &
        text_of(real(price(i)%nodes, dp)/price(i)%step)//','//text_of(price(i)%over_first)//','// &
        text_of(price(i)%over_before)//','//text_of(price(i)%bytes)//','// &
        text_of(price(i)%yielded)//nl
    end do
    text = replaced(text)
  end function price_csv

  !> Names hold a comma: a semicolon there keeps the columns apart.
  pure function replaced(text) result(safe)
    character(*), intent(in) :: text
    character(len(text)) :: safe
    integer :: i

    safe = text
    do i = 1, len(text) - 1
      if (text(i:i+1) == ', ') safe(i:i) = ';'
    end do
  end function replaced

  pure real(dp) function fraction_of(speed) result(fraction)
    type(speed_t), intent(in) :: speed

    fraction = reach_traffic(speed)/speed%step/speed%triad
  end function fraction_of

  pure real(dp) function rate(speed, seconds)
    type(speed_t), intent(in) :: speed
    real(dp), intent(in) :: seconds

    rate = real(speed%nodes, dp)/max(seconds, tiny(1.0_dp))
  end function rate

  pure function start(speed) result(text)
    type(speed_t), intent(in) :: speed
    character(:), allocatable :: text

    text = '| '//trim(speed%model)//' | '//text_of(speed%nodes)//' | '//text_of(speed%threads)//' |'
  end function start

  !> A cell with three digits.
  pure function number(value) result(cell)
    real(dp), intent(in) :: value
    character(:), allocatable :: cell
    character(24) :: buffer

    if (abs(value) >= 100.0_dp) then
      write (buffer, '(i0)') nint(value, i8)
    else if (abs(value) >= 10.0_dp) then
      write (buffer, '(f0.1)') value
    else
      write (buffer, '(f5.2)') value
    end if
    cell = ' '//trim(adjustl(buffer))//' |'
  end function number

  !> What else the machine does: mean number of jobs over five minutes, this one among them.
  function load_average() result(text)
    character(:), allocatable :: text
    real(dp) :: load(2)
    integer :: unit, failed

    text = ''
    open (newunit=unit, file='/proc/loadavg', status='old', action='read', iostat=failed)
    if (failed /= 0) return
    read (unit, *, iostat=failed) load
    if (failed == 0) text = ', '//text_of(load(2), 2)//' jobs at work'
    close (unit, iostat=failed)
  end function load_average

  !> Name of the processor and the number of them, as the kernel tells.
  function processor() result(name)
    use omp_lib, only: omp_get_num_procs
    character(:), allocatable :: name
    character(200) :: line
    integer :: unit, failed

    name = 'unknown processor'
    open (newunit=unit, file='/proc/cpuinfo', status='old', action='read', iostat=failed)
    do while (failed == 0)
      read (unit, '(a)', iostat=failed) line
      if (failed == 0 .and. line(:10) == 'model name') then
        name = trim(adjustl(line(index(line, ':')+1:)))
        exit
      end if
    end do
    close (unit, iostat=failed)
    name = name//', '//text_of(omp_get_num_procs())//' processors'
  end function processor
end module talus_bench_report
