!> Gap, closest point and their variations at one slave point (theory 3).
!>
!> Variations are linear forms in short vectors: dx - dS, dS,1, dS,2, dS,11, dS,12, dS,22. A frictionless surface needs the first
!> three, friction on a surface all six.
!>
!> - `point`, `variations`: kinematics of a slave point at its foot, and its first variations.
module isomortar_contact_gap_map_kinematics
  use isomortar_base_algebra, only: add_product, cross, inverse2
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_unit
  use isomortar_contact_gap_map_kink_line, only: add_turn
  use isomortar_contact_gap_map_map, only: all_of_any => all_components, contact_point_t, variations_t
  implicit none
  private

  public :: contact_point, first_variations, metric_variation, second_variations

  !> Components of all six short vectors.
  integer, parameter :: all_components = 18
  !> Number of the short vector dS,ab.
  integer, parameter :: second_vector(2, 2) = reshape([4, 5, 5, 6], [2, 2])
  !> Column of S,ab and of S,abc in the table of surface derivatives.
  integer, parameter :: second_column(2, 2) = reshape([4, 5, 5, 6], [2, 2])
  integer, parameter :: third_column(2, 2, 2) = reshape([7, 8, 8, 9, 8, 9, 9, 10], [2, 2, 2])

contains

  !> Kinematics on a deformable surface (theory 3.2, 3.3) of a slave point at `x`, L.
  !>
  !> - `derivatives` (3, columns): S and its derivatives at the foot by column (derivative_column), L/P^order; 0 what is not given.
  !> - `outward`: sign of the normal.
  pure function contact_point(x, derivatives, outward) result(self)
    real(wp), intent(in) :: x(3), derivatives(:, :), outward
    type(contact_point_t) :: self
    integer :: a, b

    if (contracts) call require(size(derivatives, 2) >= 3, "contact_point: derivatives are those to order one")
    self%surface = 0.0_wp
    self%surface(:, 1:size(derivatives, 2)) = derivatives
    self%tangent = self%surface(:, 2:3)
    self%normal = outward * cross(self%tangent(:, 1), self%tangent(:, 2))
    self%normal = self%normal / norm2(self%normal)
    if (contracts) call require(is_unit(self%normal), "contact_point: the normal is a unit vector")
    self%gap = -dot_product(x - self%surface(:, 1), self%normal)
    self%metric = matmul(transpose(self%tangent), self%tangent)
    self%inverse_metric = inverse2(self%metric)
    do b = 1, 2
      do a = 1, 2
        self%curvature(a, b) = dot_product(self%normal, self%surface(:, second_column(a, b)))
      end do
    end do
    self%inverse_h = inverse2(self%metric + self%gap * self%curvature)
  end function contact_point

  !> Components 3 k - 2 .. 3 k of short vector k.
  pure function components(k) result(range)
    integer, intent(in) :: k
    integer :: range(3)

    range = [3 * k - 2, 3 * k - 1, 3 * k]
  end function components

  !> Rows of dg, dxi and the slip (theory 3.5, 3.6, 3.12) over so many short `vectors`.
  pure function first_variations(point, vectors) result(self)
    type(contact_point_t), intent(in) :: point
    integer, intent(in) :: vectors
    type(variations_t) :: self
    real(wp) :: right(all_components, 2)
    integer :: a

    self%gap = 0.0_wp
    self%gap(1:3) = -point%normal
    self%pressure_work = self%gap
    right = 0.0_wp
    do a = 1, 2
      right(1:3, a) = point%tangent(:, a)
      if (vectors > 1) right(components(1 + a), a) = -point%gap * point%normal
    end do
    self%slip(:all_components, :) = matmul(right, point%inverse_h)
    self%projection(:all_components, :) = self%slip(:all_components, :)
    if (.not. any(point%fixed)) return
    do a = 1, 2
      self%projection(:, a) = 0.0_wp
      if (point%fixed(a)) cycle
      self%projection(:all_components, a) = right(:, a) / (point%metric(a, a) + point%gap * point%curvature(a, a))
    end do
  end function first_variations

  !> Rows of dS,a with the projection moving along: dS,a + S,ab dxi^b, three rows (theory 3.7).
  pure function moving_tangent(point, projection, a) result(rows)
    type(contact_point_t), intent(in) :: point
    real(wp), intent(in) :: projection(:, :)
    integer, intent(in) :: a
    real(wp) :: rows(all_components, 3)
    integer :: b, i

    rows = 0.0_wp
    do i = 1, 3
      rows(3 * a + i, i) = 1.0_wp
      do b = 1, 2
        rows(:, i) = rows(:, i) + point%surface(i, second_column(a, b)) * projection(:all_components, b)
      end do
    end do
  end function moving_tangent

  !> Rows of the metric's variation: a_11, a_12, a_22 (theory 3.8).
  pure function metric_variation(point, variations) result(rows)
    type(contact_point_t), intent(in) :: point
    type(variations_t), intent(in) :: variations
    real(wp) :: rows(all_of_any, 3)
    real(wp) :: first(all_components, 3), second(all_components, 3)

    first = moving_tangent(point, variations%projection, 1)
    second = moving_tangent(point, variations%projection, 2)
    rows(:all_components, 1) = 2.0_wp * matmul(first, point%tangent(:, 1))
    rows(:all_components, 2) = matmul(first, point%tangent(:, 2)) + matmul(second, point%tangent(:, 1))
    rows(:all_components, 3) = 2.0_wp * matmul(second, point%tangent(:, 2))
  end function metric_variation

  !> Add `pressure` * Ddg + `traction`_a D(slip)^a, F/L^2 and F/(L P), to a bilinear form over the components (theory 3.9, 3.10,
  !> 3.13): `form` (components, components).
  pure subroutine second_variations(point, variations, pressure, traction, form)
    type(contact_point_t), intent(in) :: point
    type(variations_t), intent(in) :: variations
    real(wp), intent(in) :: pressure, traction(2)
    real(wp), intent(inout) :: form(:, :)

    if (abs(pressure) > 0.0_wp) call gap_variation(point, variations, pressure, form)
    if (size(form, 1) == all_components .and. any(abs(traction) > 0.0_wp)) then
      call traction_variation(point, variations, traction, form)
    end if
  end subroutine second_variations

  !> Add scale * Ddg to a bilinear form over the components (theory 3.9, 3.13).
  pure subroutine gap_variation(point, variations, scale, form)
    type(contact_point_t), intent(in) :: point
    type(variations_t), intent(in) :: variations
    real(wp), intent(in) :: scale
    real(wp), intent(inout) :: form(:, :)
    real(wp) :: lifted(9, 2), slope(9, 2), turned(9, 2), xi(9, 2)
    integer :: a

    xi = variations%projection(1:9, :)
    slope = 0.0_wp
    do a = 1, 2
      slope(components(1 + a), a) = point%normal
    end do
    turned = slope + matmul(xi, point%curvature)
    lifted = point%gap * matmul(turned, point%inverse_metric)
    do a = 1, 2
      call add_product(scale, slope(:, a), xi(:, a), form(1:9, 1:9))
      call add_product(scale, xi(:, a), turned(:, a), form(1:9, 1:9))
      call add_product(scale, turned(:, a), lifted(:, a), form(1:9, 1:9))
    end do
    if (point%turns) call add_turn(point, scale / point%gap, form(1:3, 1:3))
  end subroutine gap_variation

  !> Rows of dx - dS - a_b dxi^b, three rows (theory 3.7).
  pure function moving_distance(point, projection) result(rows)
    type(contact_point_t), intent(in) :: point
    real(wp), intent(in) :: projection(:, :)
    real(wp) :: rows(all_components, 3)
    integer :: i

    rows = 0.0_wp
    do i = 1, 3
      rows(i, i) = 1.0_wp
      rows(:, i) = rows(:, i) - matmul(projection(:all_components, :), point%tangent(i, :))
    end do
  end function moving_distance

  !> Add traction_a D(slip)^a, scaled, to a bilinear form over the components (theory 3.10): d moves with the forces' slips, D with
  !> the projection's own changes.
  pure subroutine traction_variation(point, variations, traction, form)
    type(contact_point_t), intent(in) :: point
    type(variations_t), intent(in) :: variations
    real(wp), intent(in) :: traction(2)
    real(wp), intent(inout) :: form(:, :)
    real(wp), dimension(all_components, 3) :: apart, apart_moving, along, along_moving
    real(wp) :: carried(all_components), row(all_components), theta(2)
    integer :: c, i

    theta = matmul(traction, point%inverse_h)
    apart = moving_distance(point, variations%slip)
    apart_moving = apart
    along = theta(1) * moving_tangent(point, variations%slip, 1) + theta(2) * moving_tangent(point, variations%slip, 2)
    along_moving = along
    if (any(point%fixed)) then
      apart_moving = moving_distance(point, variations%projection)
      along_moving = theta(1) * moving_tangent(point, variations%projection, 1) &
        + theta(2) * moving_tangent(point, variations%projection, 2)
    end if
    do i = 1, 3
      call add_product(1.0_wp, apart(:, i), along_moving(:, i), form)
      call add_product(1.0_wp, along(:, i), apart_moving(:, i), form)
    end do
    do c = 1, 2
      call second_row(point, theta, variations%projection, c, row, carried)
      call add_product(1.0_wp, row, variations%projection(:all_components, c), form)
      call add_product(1.0_wp, variations%slip(:all_components, c), row + carried, form)
    end do
  end subroutine traction_variation

  !> What stands beside dxi^c in the slip's second variation, weighted with theta: the row of the vectors' own changes, and that of
  !> their further derivatives as the projection moves (theory 3.10).
  pure subroutine second_row(point, theta, projection, c, row, carried)
    type(contact_point_t), intent(in) :: point
    real(wp), intent(in) :: theta(2), projection(:, :)
    integer, intent(in) :: c
    real(wp), intent(out) :: row(all_components), carried(all_components)
    real(wp) :: d(3), factor
    integer :: b, m

    d = -point%gap * point%normal
    row = 0.0_wp
    carried = 0.0_wp
    do b = 1, 2
      row(components(1 + c)) = row(components(1 + c)) - theta(b) * point%tangent(:, b)
      row(components(second_vector(b, c))) = row(components(second_vector(b, c))) + theta(b) * d
      do m = 1, 2
        factor = dot_product(d, point%surface(:, third_column(b, c, m))) &
          - dot_product(point%tangent(:, b), point%surface(:, second_column(c, m)))
        carried = carried + theta(b) * factor * projection(:all_components, m)
      end do
    end do
  end subroutine second_row

end module isomortar_contact_gap_map_kinematics
