! SPDX-License-Identifier: MIT
!> Water and pressure of one cell: by the storage of the pores as they are, or with what they give
!> as the soil follows the pressure (src/THEORY.md (2.3), (5.4b)).
module talus_cell_water
  use talus_kinds, only: dp
  use talus_ground, only: ground_t
  use talus_state, only: state_t
  use talus_storage, only: storage_content, storage_invert, storage_invert_giving
  implicit none
  private
  public :: cell_content, cell_invert, cells_invert

contains

  !> Water that a cell holds at a pressure [m3/m2].
  pure real(dp) function cell_content(ground, soil, state, i, pressure) result(content)
    type(ground_t), intent(in) :: ground
    integer, intent(in) :: soil      !! number of its soil
    type(state_t), intent(in) :: state
    integer, intent(in) :: i         !! cell
    real(dp), intent(in) :: pressure !! [Pa]

    content = storage_content(ground%curve(soil), ground%storage(soil), &
      state%jacobian(i) - 1.0_dp + ground%porosity(soil), state%jacobian(i), pressure)
    if (allocated(state%give)) content = content + state%give(i)*(pressure - state%anchor(i))
  end function cell_content

  !> Set pressure and flow properties of a cell by its stored water.
  pure subroutine cell_invert(ground, soil, i, state)
    type(ground_t), intent(in) :: ground
    integer, intent(in) :: soil !! number of its soil
    integer, intent(in) :: i    !! cell
    type(state_t), intent(inout) :: state
    real(dp) :: pore

    pore = state%jacobian(i) - 1.0_dp + ground%porosity(soil)
    if (allocated(state%give)) then
      if (state%give(i) > 0.0_dp) then
        call storage_invert_giving(ground%curve(soil), ground%storage(soil), pore, &
          state%jacobian(i), state%give(i), state%anchor(i), state%content(i), state%pressure(i), &
          state%saturation(i), state%ratio(i), state%potential(i), state%capacity(i))
        return
      end if
    end if
    call storage_invert(ground%curve(soil), ground%storage(soil), pore, state%jacobian(i), &
      state%content(i), state%pressure(i), state%saturation(i), state%ratio(i), &
      state%potential(i), state%capacity(i))
  end subroutine cell_invert

  !> Set pressure and flow properties of cells first to first + n - 1, all of one soil.
  pure subroutine cells_invert(ground, soil, first, n, state)
    type(ground_t), intent(in) :: ground
    integer, intent(in) :: soil     !! number of their soil
    integer, intent(in) :: first, n !! cells
    type(state_t), intent(inout) :: state
    real(dp) :: pore(n)
    integer :: i, last

    last = first + n - 1
    if (allocated(state%give)) then
      if (any(state%give(first:last) > 0.0_dp)) then
        do i = first, last
          call cell_invert(ground, soil, i, state)
        end do
        return
      end if
    end if
    pore = state%jacobian(first:last) - 1.0_dp + ground%porosity(soil)
    call storage_invert(ground%curve(soil), ground%storage(soil), n, pore, &
      state%jacobian(first:last), state%content(first:last), state%pressure(first:last), &
      state%saturation(first:last), state%ratio(first:last), state%potential(first:last), &
      state%capacity(first:last))
  end subroutine cells_invert
end module talus_cell_water
