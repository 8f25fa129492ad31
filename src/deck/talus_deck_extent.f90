! SPDX-License-Identifier: MIT
!> Outline of the deck's body, for checks before any node exists.
module talus_deck_extent
  use talus_kinds, only: dp
  use talus_deck_types, only: geometry_t, deck_given
  implicit none
  private
  public :: extent_t, extent_of, extent_holds

  type :: extent_t
    logical :: is_known = .false.  !! false for a file, or when the geometry has errors
    real(dp) :: left = 0.0_dp, right = 0.0_dp, bottom = 0.0_dp, top = 0.0_dp !! [m]
    real(dp) :: area = 0.0_dp      !! [m2]
  end type extent_t

contains

  !> Bounding box and area of a box or a slope.
  pure type(extent_t) function extent_of(geometry) result(extent)
    type(geometry_t), intent(in) :: geometry

    select case (geometry%kind)
    case ('box')
      extent%is_known = all(deck_given([geometry%width, geometry%height]))
      if (.not. extent%is_known) return
      extent%right = geometry%width
      extent%top = geometry%height
      extent%area = geometry%width*geometry%height
    case ('slope')
      associate (g => geometry)
        extent%is_known = all(deck_given([g%slope_height, g%slope_ratio, g%base_depth, &
                                          g%toe_distance, g%crest_width]))
        if (.not. extent%is_known) return
        extent%right = g%toe_distance + g%slope_ratio*g%slope_height + g%crest_width
        extent%top = g%base_depth + g%slope_height
        extent%area = extent%right*g%base_depth &
                      + (g%crest_width + 0.5_dp*g%slope_ratio*g%slope_height)*g%slope_height
      end associate
    end select
    if (.not. all(deck_given([geometry%origin_x, geometry%origin_y]))) extent%is_known = .false.
    if (.not. extent%is_known) return
    extent%left = geometry%origin_x
    extent%right = extent%right + geometry%origin_x
    extent%bottom = geometry%origin_y
    extent%top = extent%top + geometry%origin_y
  end function extent_of

  !> True when a point lies in the body (or its outline is not known).
  pure logical function extent_holds(geometry, x, y) result(holds)
    type(geometry_t), intent(in) :: geometry
    real(dp), intent(in) :: x, y   !! [m]
    type(extent_t) :: extent
    real(dp) :: slack, rise

    holds = .true.
    extent = extent_of(geometry)
    if (.not. extent%is_known) return
    slack = 1.0e-9_dp*(extent%right - extent%left + extent%top - extent%bottom)
    holds = x > extent%left - slack .and. x < extent%right + slack &
            .and. y > extent%bottom - slack .and. y < extent%top + slack
    if (geometry%kind /= 'slope' .or. .not. holds) return
    rise = y - extent%bottom - geometry%base_depth
    if (rise > slack) then
      holds = x - extent%left > geometry%toe_distance + geometry%slope_ratio*rise - slack
    end if
  end function extent_holds
end module talus_deck_extent
