! SPDX-License-Identifier: MIT
!> The tables that a deck names: hydrographs and retention tables, read from CSV files and checked.
module talus_deck_csv
  use talus_text, only: text_of
  use talus_kinds, only: dp
  use talus_table_csv, only: table_csv_t, table_csv_read, table_csv_fault
  implicit none
  private
  public :: hydrograph_read, retention_read, retention_check

  !> As the key `rain` of &boundary allows [mm/h].
  real(dp), parameter, public :: intensity_greatest = 1.0e3_dp
  real(dp), parameter :: conductivity_least = 1.0e-20_dp ! log k_r is interpolated

contains

  !> A hydrograph from a CSV file with the header time_s,mm_per_h.
  subroutine hydrograph_read(path, table)
    character(*), intent(in) :: path
    type(table_csv_t), intent(out) :: table !! with all that is wrong

    call table_csv_read(path, 'time_s,mm_per_h', table)
    call hydrograph_check(table)
  end subroutine hydrograph_read

  !> Times increase, intensities are rain.
  subroutine hydrograph_check(table)
    type(table_csv_t), intent(inout) :: table
    integer :: i

    associate (time => table%values(1, :), rain => table%values(2, :))
      do i = 1, size(time)
        if (rain(i) < 0.0_dp .or. rain(i) > intensity_greatest) &
          call refuse(table, i, 2, 'mm_per_h', '0 to '//text_of(intensity_greatest))
        if (i == 1) cycle
        if (time(i) <= time(i-1)) call refuse(table, i, 1, 'time_s', &
          '> '//text_of(time(i-1))//' (times increase)')
      end do
    end associate
  end subroutine hydrograph_check

  !> A retention table from a CSV file with the header suction_Pa,saturation,relative_conductivity.
  subroutine retention_read(path, table)
    character(*), intent(in) :: path
    type(table_csv_t), intent(out) :: table !! with all that is wrong

    call table_csv_read(path, 'suction_Pa,saturation,relative_conductivity', table)
    call retention_check(table)
  end subroutine retention_read

  !> Range and order of the points of a retention table.
  subroutine retention_check(table)
    type(table_csv_t), intent(inout) :: table
    integer :: i, last, before

    last = size(table%values, 2)
    if (last < 2) then
      ! With faults, the missing points are those that were refused.
      if (table%faults == 0) call table_csv_fault(table, 0, &
        'a retention table needs more points; allowed: 2 or more')
      return
    end if
    associate (suction => table%values(1, :), saturation => table%values(2, :), &
               conductivity => table%values(3, :))
      if (suction(1) < 0.0_dp) call refuse(table, 1, 1, 'suction_Pa', '>= 0')
      do i = 1, last
        before = max(i - 1, 1)
        if (suction(i) > 1.0e9_dp) then
          call refuse(table, i, 1, 'suction_Pa', '<= 1e9')
        else if (i > 1 .and. suction(i) <= suction(before)) then
          call refuse(table, i, 1, 'suction_Pa', &
                      '> '//text_of(suction(before))//' (suctions increase)')
        end if
        if (saturation(i) < 0.0_dp .or. saturation(i) > 1.0_dp) then
          call refuse(table, i, 2, 'saturation', '0 to 1')
        else if (saturation(i) > saturation(before)) then
          call refuse(table, i, 2, 'saturation', &
                      '<= '//text_of(saturation(before))//' (it falls with suction)')
        end if
        if (i == 1 .and. abs(conductivity(1) - 1.0_dp) > 1.0e-9_dp) then
          call refuse(table, i, 3, 'relative_conductivity', '1 at the first point')
        else if (conductivity(i) < conductivity_least .or. conductivity(i) > 1.0_dp) then
          call refuse(table, i, 3, 'relative_conductivity', '1e-20 to 1')
        else if (conductivity(i) > conductivity(before)) then
          call refuse(table, i, 3, 'relative_conductivity', &
                      '<= '//text_of(conductivity(before))//' (it falls with suction)')
        end if
      end do
      ! A last saturation above the one before it is told already.
      if (saturation(last) >= saturation(1) .and. saturation(last) <= saturation(last-1)) &
        call refuse(table, last, 2, 'saturation', '< '//text_of(saturation(1))//' (the first one)')
    end associate
  end subroutine retention_check

  !> Add the fault of one value.
  subroutine refuse(table, row, column, name, allowed)
    type(table_csv_t), intent(inout) :: table
    integer, intent(in) :: row, column
    character(*), intent(in) :: name, allowed

    call table_csv_fault(table, table%lines(row), name//' = '// &
      text_of(table%values(column, row))//' is not allowed; allowed: '//allowed)
  end subroutine refuse
end module talus_deck_csv
