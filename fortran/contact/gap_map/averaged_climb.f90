!> How far a foot has climbed along the averaged normal (theory 3.31): of pressures this makes spurious work.
module isomortar_contact_gap_map_averaged_climb
  use isomortar_base_algebra, only: weighted_sums
  use isomortar_base_kinds, only: wp
  use isomortar_contact_work, only: evaluate, work_t
  use isomortar_nurbs_direction, only: element_at
  use isomortar_nurbs_quadrature, only: gauss_legendre
  use isomortar_nurbs_surface, only: element_span, first_bound, shortest_way, step_across, surface_basis, surface_nodes, surface_t
  implicit none
  private

  public :: climb_between

contains

  !> Integral of n dS along the shortest way between two feet, element by element: the `climb`, L (theory 3.31).
  !>
  !> - `surface`: the face. `positions` (3, control points and nodes): of all control points, L; normals of its nodes at the end.
  !> - `from`, `to`: coordinates of the feet, P. `work`: counts of what is done.
  pure subroutine climb_between(surface, positions, from, to, climb, work)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: positions(:, :), from(2), to(2)
    real(wp), intent(out) :: climb
    type(work_t), intent(inout) :: work
    real(wp) :: left(2), length(2), low(2), share, xi(2)
    integer :: across, k, place(2), way(2)
    logical :: within

    climb = 0.0_wp
    xi = from
    left = shortest_way(surface, to - from)
    place = [element_at(surface%direction(1), xi(1)), element_at(surface%direction(2), xi(2))]
    do k = 1, sum(surface%direction%elements) + 2
      call element_span(surface, place, low, length)
      call first_bound(xi, left, low, length, share, across)
      climb = climb + climb_inside(surface, positions, place, xi, share * left)
      call evaluate(1, sum(surface%direction%order) + 1, work)
      if (.not. share < 1.0_wp) return
      xi = xi + share * left
      left = (1.0_wp - share) * left
      way = 0
      way(across) = merge(1, -1, left(across) > 0.0_wp)
      call step_across(surface, way, place, xi, within)
      if (.not. within) return
    end do
  end subroutine climb_between

  !> That of a straight way within an element (theory 3.31).
  pure real(wp) function climb_inside(surface, positions, place, from, way) result(climb)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: positions(:, :), from(2), way(2)
    integer, intent(in) :: place(2)
    integer :: k, nodes(product(surface%direction%order + 1))
    real(wp) :: functions(size(nodes), 3), normal(3, 1), tangents(3, 2)
    real(wp), dimension(sum(surface%direction%order) + 1) :: points, weights

    climb = 0.0_wp
    call surface_nodes(surface, place, nodes)
    call gauss_legendre(points, weights)
    do k = 1, size(points)
      call surface_basis(surface, place, nodes, from + points(k) * way, 1, functions)
      normal = weighted_sums(positions, size(positions, 2) - size(surface%point) + nodes, functions(:, :1))
      tangents = weighted_sums(positions, surface%point(nodes), functions(:, 2:3))
      climb = climb + weights(k) * dot_product(normal(:, 1), matmul(tangents, way)) / norm2(normal)
    end do
  end function climb_inside

end module isomortar_contact_gap_map_averaged_climb
