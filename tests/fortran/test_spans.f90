!> Knot spans and the functions on them (isomortar_nurbs_direction).
module test_spans
  use isomortar_base_kinds, only: wp
  use isomortar_nurbs_direction, only: basis, direction_t, element_at, family_lagrange, family_nurbs, is_kink, new_direction
  use testing, only: by_difference, expect, expect_true, round_off, step
  implicit none
  private

  public :: spans

contains

  subroutine spans()
    type(direction_t) :: line

    line = new_direction(family_nurbs, 2, [0.0_wp, 0.0_wp, 0.0_wp, 1.0_wp, 1.0_wp, 2.0_wp, 3.0_wp, 3.0_wp, 3.0_wp])
    call expect_true("spans without length are none", line%elements == 3 .and. line%count == 6)
    call expect_true("a boundary belongs to the element above", element_at(line, 1.0_wp) == 2)
    call expect_true("the end belongs to the last element", element_at(line, 3.0_wp) == 3)
    call expect_true("beyond an end: the element there", element_at(line, -1.0_wp) == 1 .and. element_at(line, 9.0_wp) == 3)
    call expect_true("a knot as often as the order is a kink", is_kink(line, 1) .and. .not. is_kink(line, 2))
    call sum_to_one("NURBS", line)
    line = new_direction(family_lagrange, 3, [0.0_wp, 0.5_wp, 2.0_wp])
    call expect_true("Lagrange elements meet in kinks", is_kink(line, 1) .and. line%count == 7)
    call sum_to_one("Lagrange", line)
  end subroutine spans

  !> In every element: functions sum to one, and derivatives are those of the functions.
  subroutine sum_to_one(name, line)
    character(*), intent(in) :: name
    type(direction_t), intent(in) :: line
    real(wp), dimension(0:line%order, 0:2) :: lower, upper, values
    real(wp) :: u
    integer :: e, k

    do e = 1, line%elements
      u = 0.3_wp * line%boundary(e - 1) + 0.7_wp * line%boundary(e)
      call basis(line, e, u, 2, values)
      call basis(line, e, u + step, 2, upper)
      call basis(line, e, u - step, 2, lower)
      call expect(name // ": sum", abs(sum(values(:, 0)) - 1.0_wp), round_off)
      do k = 0, 1
        call expect(name // ": derivative", &
          maxval(abs((upper(:, k) - lower(:, k)) / (2.0_wp * step) - values(:, k + 1))), by_difference)
      end do
    end do
  end subroutine sum_to_one

end module test_spans
