!> Feet of slave points on C0 lines of the master (theory 3.11): there the normal is the direction of the distance.
!>
!> Gap and normal are continuous from a face onto the line, along it, and onto the next face.
module isomortar_contact_gap_map_kink_line
  use isomortar_base_algebra, only: add_product, cross, determinant2, inverse2, weighted_sums
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_unit
  use isomortar_contact_gap_map_map, only: contact_point_t
  use isomortar_contact_work, only: evaluate, work_t
  use isomortar_nurbs_surface, only: derivative_columns, step_across, surface_basis, surface_nodes, surface_t
  implicit none
  private

  public :: add_turn, hold_on_lines

  !> A distance below this share of the element's size has no direction.
  real(wp), parameter :: least_distance = 1.0e-10_wp

  !> Share of the metric below which H is zero or negative but for round-off.
  real(wp), parameter :: least_h = epsilon(1.0_wp)**0.75_wp

contains

  !> Kinematics at a foot with fixed coordinates, from those of the lower element's face at the same place (theory 3.11, 3.14).
  !>
  !> - `surface`, `positions` (3, control points): the master's face, and all control points, L.
  !> - `x`: place of the slave point, L. `xi`, `place`, `fixed`: coordinates of its foot, P, their element, and which do not vary.
  !> - `point`: the kinematics. `work`: counts of what is done.
  pure subroutine hold_on_lines(surface, positions, x, xi, place, fixed, point, work)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: positions(:, :), x(3), xi(2)
    integer, intent(in) :: place(2)
    logical, intent(in) :: fixed(2)
    type(contact_point_t), intent(inout) :: point
    type(work_t), intent(inout) :: work
    real(wp) :: d(3), facing(3), h(2, 2)
    integer :: a, b

    if (contracts) call require(any(fixed), "hold_on_lines: the foot is on a line")
    d = x - point%surface(:, 1)
    facing = mean_normal(surface, positions, xi, place, fixed)
    call evaluate(1, product(merge(2, 1, fixed)), work)
    point%fixed = fixed
    point%turns = norm2(d) > least_distance * element_size(surface, place, point)
    point%normal = facing
    if (point%turns) point%normal = sign(1.0_wp, dot_product(d, facing)) * d / norm2(d)
    if (contracts) call require(is_unit(point%normal), "hold_on_lines: the normal is a unit vector")
    point%gap = -dot_product(d, point%normal)
    point%inverse_metric = 0.0_wp
    do a = 1, 2
      do b = 1, 2
        point%curvature(a, b) = dot_product(point%normal, point%surface(:, 2 + a + b))
      end do
      if (.not. fixed(a)) point%inverse_metric(a, a) = 1.0_wp / point%metric(a, a)
    end do
    h = point%metric + point%gap * point%curvature
    point%slips = minval([h(1, 1) / point%metric(1, 1), h(2, 2) / point%metric(2, 2)]) > least_h
    if (point%slips) point%slips = determinant2(h) > least_h * determinant2(point%metric)
    point%inverse_h = 0.0_wp
    if (point%slips) point%inverse_h = inverse2(h)
  end subroutine hold_on_lines

  !> Mean of the outward unit normals of the faces that meet on the lines: `place` is the lowest of their elements (theory 3.11).
  pure function mean_normal(surface, positions, xi, place, fixed) result(normal)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: positions(:, :), xi(2)
    integer, intent(in) :: place(2)
    logical, intent(in) :: fixed(2)
    real(wp) :: normal(3)
    integer :: nodes(product(surface%direction%order + 1)), i, j, there(2)
    real(wp) :: values(size(nodes), derivative_columns(1)), tangents(3, 2), face(3), at(2)
    logical :: within

    normal = 0.0_wp
    do j = 0, merge(1, 0, fixed(2))
      do i = 0, merge(1, 0, fixed(1))
        there = place
        at = xi
        call step_across(surface, [i, j], there, at, within)
        call surface_nodes(surface, there, nodes)
        call surface_basis(surface, there, nodes, at, 1, values)
        tangents = weighted_sums(positions, surface%point(nodes), values(:, 2:3))
        face = surface%outward * cross(tangents(:, 1), tangents(:, 2))
        normal = normal + face / norm2(face)
      end do
    end do
    normal = normal / norm2(normal)
  end function mean_normal

  !> The longer of an element's lengths along its coordinates (theory 3.14).
  pure real(wp) function element_size(surface, place, point)
    type(surface_t), intent(in) :: surface
    integer, intent(in) :: place(2)
    type(contact_point_t), intent(in) :: point
    integer :: a

    element_size = 0.0_wp
    do a = 1, 2
      associate (boundary => surface%direction(a)%boundary)
        element_size = max(element_size, (boundary(place(a)) - boundary(place(a) - 1)) * norm2(point%tangent(:, a)))
      end associate
    end do
  end function element_size

  !> Add `scale` * (dx - dS)^T P (Dx - DS), P the projector across the normal and the free tangents, to `form` (components,
  !> components): at a `point` on a C0 line (theory 3.13).
  pure subroutine add_turn(point, scale, form)
    type(contact_point_t), intent(in) :: point
    real(wp), intent(in) :: scale
    real(wp), intent(inout) :: form(:, :)
    integer :: a, i

    do i = 1, 3
      form(i, i) = form(i, i) + scale
    end do
    call add_product(-scale, point%normal, point%normal, form)
    do a = 1, 2
      call add_product(-scale * point%inverse_metric(a, a), point%tangent(:, a), point%tangent(:, a), form)
    end do
  end subroutine add_turn

end module isomortar_contact_gap_map_kink_line
