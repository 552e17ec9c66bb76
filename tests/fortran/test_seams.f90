!> Seams of closed surfaces (isomortar_nurbs_surface) and searches that cross them (isomortar_contact_search).
module test_seams
  use isomortar_base_kinds, only: wp
  use isomortar_contact_search, only: descend, projection_inside, projection_outside, search_t, start_at
  use isomortar_contact_work, only: work_t
  use isomortar_nurbs_surface, only: shortest_way, step_across, surface_t
  use surfaces, only: curved, tube
  use testing, only: expect, expect_true, round_off
  implicit none
  private

  public :: seams

contains

  subroutine seams()
    type(surface_t) :: open_surface, surface
    real(wp), allocatable :: others(:, :), positions(:, :)
    real(wp) :: xi(2)
    integer :: place(2)
    logical :: within

    call tube(surface, positions)
    call curved(open_surface, others)
    call expect("the way round is the shorter one", &
      maxval(abs(shortest_way(surface, [3.5_wp, 0.5_wp]) - [-0.5_wp, 0.5_wp])), round_off)
    call expect("no way round an open surface", &
      maxval(abs(shortest_way(open_surface, [0.9_wp, 0.5_wp]) - [0.9_wp, 0.5_wp])), 0.0_wp)
    place = [4, 1]
    xi = [3.9_wp, 0.5_wp]
    call step_across(surface, [1, 0], place, xi, within)
    call expect_true("over the seam upwards", within .and. place(1) == 1 .and. abs(xi(1)) <= 0.0_wp)
    call step_across(surface, [-1, 0], place, xi, within)
    call expect_true("and back", within .and. place(1) == 4 .and. abs(xi(1) - 4.0_wp) <= 0.0_wp)
    call step_across(surface, [0, 1], place, xi, within)
    call expect_true("past the end of the tube", .not. within)
    call crosses(surface, positions)
  end subroutine seams

  !> A search that starts before the seam ends at the foot beyond it; beyond the tube's end there is none.
  subroutine crosses(surface, positions)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: positions(:, :)
    type(search_t) :: here
    type(work_t) :: work

    here = start_at(surface, [3.9_wp, 0.5_wp])
    call descend(surface, positions, [0.5_wp, 1.2_wp, 0.5_wp], here, work)
    call expect_true("foot beyond the seam", here%outcome == projection_inside .and. here%place(1) == 1)
    call expect("its coordinates", maxval(abs(here%xi - [0.25_wp, 0.5_wp])), round_off)
    here = start_at(surface, [3.9_wp, 0.5_wp])
    call descend(surface, positions, [0.5_wp, 1.2_wp, 1.5_wp], here, work)
    call expect_true("no foot beyond the end", here%outcome == projection_outside)
  end subroutine crosses

end module test_seams
