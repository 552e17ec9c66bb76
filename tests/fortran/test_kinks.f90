!> C0 lines of a master: where a foot stays on one, its gap, and how the normal turns (isomortar_contact_gap_map_kink_line).
module test_kinks
  use isomortar_base_kinds, only: wp
  use isomortar_contact_gap_map_closest_point, only: closest_point_t
  use isomortar_contact_gap_map_map, only: all_components, contact_point_t, for_tangent, projections_t, variations_t
  use isomortar_contact_search, only: descend, projection_inside, search_t, start_at
  use isomortar_contact_slave, only: slave_t
  use isomortar_contact_work, only: work_t
  use surfaces, only: lone_point, roof
  use testing, only: by_difference, expect, expect_true, round_off, step
  implicit none
  private

  public :: kinks

contains

  subroutine kinks()
    type(closest_point_t) :: map
    real(wp), allocatable :: positions(:, :)
    type(search_t) :: here
    type(work_t) :: work
    real(wp) :: x(3)

    call roof(0.4_wp, map%surface, positions)
    x = [1.05_wp, 0.3_wp, 0.6_wp]
    here = start_at(map%surface, [0.2_wp, 0.9_wp])
    call descend(map%surface, positions, x, here, work)
    call expect_true("a foot on the ridge stays on it", &
      here%outcome == projection_inside .and. here%fixed(1) .and. .not. here%fixed(2))
    call expect_true("and belongs to the lower element", here%place(1) == 1)
    call expect("at the height of its point", maxval(abs(here%xi - [1.0_wp, 0.3_wp])), round_off)
    call distance_from_line(map, positions, x, here)
    here = start_at(map%surface, [0.2_wp, 0.9_wp])
    call descend(map%surface, positions, [0.2_wp, 0.3_wp, 0.6_wp], here, work)
    call expect_true("a foot beside it is free", here%outcome == projection_inside .and. .not. any(here%fixed))
  end subroutine kinks

  !> The gap is the distance from the line, its row the way from there, and its second variation that row's derivative.
  subroutine distance_from_line(map, positions, x, here)
    type(closest_point_t), intent(in) :: map
    real(wp), intent(in) :: positions(:, :), x(3)
    type(search_t), intent(in) :: here
    real(wp) :: form(all_components, all_components), lower(3), shift(3), upper(3), way(3)
    type(variations_t) :: variations
    type(contact_point_t) :: point
    integer :: i

    way = x - [1.0_wp, 0.3_wp, 0.4_wp]
    call on_line(map, positions, x, here, point, variations)
    call expect("gap", abs(abs(point%gap) - norm2(way)), round_off)
    call expect("row", maxval(abs(abs(variations%gap(1:3)) - abs(way) / norm2(way))), round_off)
    form = 0.0_wp
    call map%second(point, variations, 1.0_wp, [0.0_wp, 0.0_wp], form(:18, :18))
    do i = 1, 3
      shift = 0.0_wp
      shift(i) = step
      upper = row_at(map, positions, x + shift, here)
      lower = row_at(map, positions, x - shift, here)
      call expect("row's derivative", maxval(abs((upper - lower) / (2.0_wp * step) - form(1:3, i))), by_difference)
    end do
  end subroutine distance_from_line

  function row_at(map, positions, x, here) result(row)
    type(closest_point_t), intent(in) :: map
    real(wp), intent(in) :: positions(:, :), x(3)
    type(search_t), intent(in) :: here
    real(wp) :: row(3)
    type(contact_point_t) :: point
    type(variations_t) :: variations

    call on_line(map, positions, x, here, point, variations)
    row = variations%gap(1:3)
  end function row_at

  !> Kinematics and variations of a point whose foot is on the line, found anew from `here`.
  subroutine on_line(map, positions, x, here, point, variations)
    type(closest_point_t), intent(in) :: map
    real(wp), intent(in) :: positions(:, :), x(3)
    type(search_t), intent(in) :: here
    type(contact_point_t), intent(out) :: point
    type(variations_t), intent(out) :: variations
    type(projections_t) :: projections
    type(search_t) :: moved
    type(slave_t) :: slave
    integer :: points(4)
    real(wp) :: coefficients(4, 6)
    type(work_t) :: work

    moved = here
    call descend(map%surface, positions, x, moved, work)
    projections%xi = reshape(moved%xi, [2, 1])
    projections%place = reshape(moved%place, [2, 1])
    projections%fixed = reshape(moved%fixed, [2, 1])
    projections%found = [.true.]
    slave = lone_point(7)
    call map%at(slave, reshape([positions, x], [3, 7]), projections, 1, for_tangent, point, points, coefficients, work)
    variations = map%first(point, 6)
  end subroutine on_line

end module test_kinks
