!> Contact patches: a face of a volume patch, with derivatives to order three.
!>
!> - `place`: an element by direction, from 1. `xi`: coordinates, P.
!> - `low`, `high`, `length`: lower and upper bounds of an element, and what is between them, P.
!> - `nodes` (functions of an element): its control points, numbered within the surface, from 1.
!> - `positions` (3, control points): of all control points, L.
!> - `net` (4, functions of u, functions of v): control points of an element times their weights, L, and these.
module isomortar_nurbs_surface
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_index, sums_to
  use isomortar_nurbs_direction, only: basis, direction_t
  use isomortar_nurbs_patch, only: patch_t
  implicit none
  private

  public :: element_bounds, element_span, face_of, first_bound, homogeneous_net, shortest_way, step_across, surface_basis, &
    surface_element_count, surface_element_of, surface_nodes, surface_of, surface_point

  !> Column of each partial derivative (k, l) in a table of derivatives to order three.
  integer, parameter, public :: derivative_column(0:3, 0:3) = reshape( &
    [1, 2, 4, 7, 3, 5, 8, 0, 6, 9, 0, 0, 10, 0, 0, 0], [4, 4])
  !> Number of columns of a table of derivatives to order 0..3.
  integer, parameter, public :: derivative_columns(0:3) = [1, 3, 6, 10]

  !> A face of a volume patch. Surface directions are the two others in cyclic order.
  type, public :: surface_t
    type(direction_t) :: direction(2)
    !> Global number (from 1) of each control point; the first surface direction runs fastest.
    integer, allocatable :: point(:)
    real(wp), allocatable :: weight(:)
    !> Whether weights differ: else functions are the products of those of the directions.
    logical :: rational = .false.
    !> Sign of a_1 x a_2 that points out of the body.
    real(wp) :: outward = 1.0_wp
    !> Directions whose first and last row of control points are the same: there the last element meets the first one at a seam.
    logical :: closed(2) = .false.
    !> Poles at the start and the end of each direction, shape (2, directions): edges that are one control point, closed round it.
    logical :: pole(2, 2) = .false.
    !> Component (1 to 3) across the plane of symmetry that an edge is on, beyond which is the mirror image; 0: none. Shape (2,
    !> directions), start and end.
    integer :: mirror(2, 2) = 0
    !> How far the functions of the outer elements go on beyond the edges, as a share of the element (theory 10.7).
    real(wp) :: brim = 0.0_wp
  end type surface_t

contains

  !> The face of a `patch`: `axis` 1..3 is the direction that is constant, at its start (`end` = 0) or end (`end` = 1) (theory 3.2).
  pure function face_of(patch, axis, end) result(self)
    type(patch_t), intent(in) :: patch
    integer, intent(in) :: axis, end
    type(surface_t) :: self
    integer :: first, second, i, j, index(3), a
    type(direction_t) :: direction(2)
    integer, allocatable :: point(:)
    real(wp), allocatable :: weight(:)

    if (contracts) call require(is_index(axis, 3) .and. is_index(end + 1, 2), "face_of: the face is one of the six")
    first = mod(axis, 3) + 1
    second = mod(axis + 1, 3) + 1
    index(axis) = merge(patch%direction(axis)%count - 1, 0, end == 1)
    a = patch%direction(first)%count * patch%direction(second)%count
    allocate (point(a), weight(a)) ! and not sections by a list, which are copied to the stack
    a = 0
    do j = 0, patch%direction(second)%count - 1
      do i = 0, patch%direction(first)%count - 1
        index(first) = i
        index(second) = j
        a = a + 1
        associate (local => 1 + index(1) + patch%direction(1)%count * (index(2) + patch%direction(2)%count * index(3)))
          point(a) = patch%point(local)
          weight(a) = patch%weight(local)
        end associate
      end do
    end do
    direction(1) = patch%direction(first)
    direction(2) = patch%direction(second)
    self = surface_of(direction, point, weight)
    self%outward = merge(1.0_wp, -1.0_wp, end == 1)
    if (contracts) call require(all(is_index(self%point, maxval(patch%point))), "face_of: control points are the patch's")
  end function face_of

  !> A surface of some directions, `direction` (2), with the numbers and weights of its control points, `point` (control points) and
  !> `weight` (control points); where it is closed, and its poles, are told by the numbers.
  pure function surface_of(direction, point, weight) result(self)
    type(direction_t), intent(in) :: direction(2)
    integer, intent(in) :: point(:)
    real(wp), intent(in) :: weight(:)
    type(surface_t) :: self

    if (contracts) call require(all([size(point), size(weight)] == product(direction%count)), "surface_of: a number, a weight each")
    self%direction = direction
    allocate (self%point, source=point)
    allocate (self%weight, source=weight)
    self%rational = any(abs(weight - weight(1)) > 0.0_wp)
    associate (count => direction%count)
      self%closed(1) = all(self%point(1::count(1)) == self%point(count(1)::count(1)))
      self%closed(2) = all(self%point(:count(1)) == self%point(size(self%point) - count(1) + 1:))
      self%pole(1, 1) = self%closed(2) .and. all(self%point(1::count(1)) == self%point(1))
      self%pole(2, 1) = self%closed(2) .and. all(self%point(count(1)::count(1)) == self%point(count(1)))
      self%pole(1, 2) = self%closed(1) .and. all(self%point(:count(1)) == self%point(1))
      self%pole(2, 2) = self%closed(1) .and. all(self%point(size(self%point) - count(1) + 1:) == self%point(size(self%point)))
    end associate
  end function surface_of

  !> Go to the element `step` (-1, 0 or 1 by direction) further on, past a seam too; `xi` is put on the line that is crossed.
  !> Not `within`: past the edge of the patch.
  pure subroutine step_across(self, step, place, xi, within)
    type(surface_t), intent(in) :: self
    integer, intent(in) :: step(2)
    integer, intent(inout) :: place(2)
    real(wp), intent(inout) :: xi(2)
    logical, intent(out) :: within
    integer :: a

    if (contracts) call require(all(is_index(place, self%direction%elements)), "step_across: there is such an element")
    if (contracts) call require(all(abs(step) <= 1), "step_across: steps lead to neighbours")
    within = .true.
    do a = 1, 2
      associate (last => self%direction(a)%elements)
        place(a) = place(a) + step(a)
        if (place(a) < 1 .or. place(a) > last) then
          within = within .and. self%closed(a)
          place(a) = merge(1, last, step(a) > 0)
        end if
        if (step(a) /= 0) xi(a) = self%direction(a)%boundary(place(a) - merge(1, 0, step(a) > 0))
      end associate
    end do
    if (contracts) call require(all(is_index(place, self%direction%elements)), "step_across: there is such a neighbour")
  end subroutine step_across

  !> Bounds of an element's coordinates, a brim beyond edges of the patch included (theory 10.7).
  pure subroutine element_bounds(self, place, low, high)
    type(surface_t), intent(in) :: self
    integer, intent(in) :: place(2)
    real(wp), intent(out) :: low(2), high(2)
    real(wp) :: beyond
    integer :: a

    do a = 1, 2
      low(a) = self%direction(a)%boundary(place(a) - 1)
      high(a) = self%direction(a)%boundary(place(a))
      if (self%brim <= 0.0_wp .or. self%closed(a)) cycle
      beyond = self%brim * (high(a) - low(a))
      if (place(a) == 1 .and. .not. self%pole(1, a)) low(a) = low(a) - beyond
      if (place(a) == self%direction(a)%elements .and. .not. self%pole(2, a)) high(a) = high(a) + beyond
    end do
  end subroutine element_bounds

  !> Lower bounds and lengths of an element.
  pure subroutine element_span(self, place, low, length)
    type(surface_t), intent(in) :: self
    integer, intent(in) :: place(2)
    real(wp), intent(out) :: low(2), length(2)

    call element_bounds(self, place, low, length)
    length = length - low
  end subroutine element_span

  !> The `share` of a `step`, P, from `xi` up to the first bound of an element that it comes to, at most one, and the coordinate
  !> `across` it.
  pure subroutine first_bound(xi, step, low, length, share, across)
    real(wp), intent(in) :: xi(2), step(2), low(2), length(2)
    real(wp), intent(out) :: share
    integer, intent(out) :: across
    real(wp) :: bound
    integer :: a

    share = 1.0_wp
    across = 1
    do a = 1, 2
      bound = merge(low(a) + length(a), low(a), step(a) > 0.0_wp)
      if (.not. abs(step(a)) > abs(bound - xi(a))) cycle
      if (abs(bound - xi(a)) >= share * abs(step(a))) cycle
      share = abs(bound - xi(a)) / abs(step(a))
      across = a
    end do
  end subroutine first_bound

  !> A `difference` of coordinates, P, the shortest way round in closed directions (theory 3.20).
  pure function shortest_way(self, difference) result(way)
    type(surface_t), intent(in) :: self
    real(wp), intent(in) :: difference(2)
    real(wp) :: way(2), period
    integer :: a

    way = difference
    do a = 1, 2
      if (.not. self%closed(a)) cycle
      period = self%direction(a)%boundary(self%direction(a)%elements) - self%direction(a)%boundary(0)
      way(a) = way(a) - period * anint(way(a) / period)
    end do
  end function shortest_way

  !> Number of surface elements.
  pure integer function surface_element_count(self)
    type(surface_t), intent(in) :: self

    surface_element_count = self%direction(1)%elements * self%direction(2)%elements
  end function surface_element_count

  !> Element numbers by direction of surface element `e` (from 1, first direction fastest).
  pure function surface_element_of(self, e) result(place)
    type(surface_t), intent(in) :: self
    integer, intent(in) :: e
    integer :: place(2)

    place(1) = mod(e - 1, self%direction(1)%elements) + 1
    place(2) = (e - 1) / self%direction(1)%elements + 1
  end function surface_element_of

  !> Numbers, within the surface, of the control points of an element.
  pure subroutine surface_nodes(self, place, nodes)
    type(surface_t), intent(in) :: self
    integer, intent(in) :: place(2)
    integer, intent(out) :: nodes(:)
    integer :: a, i, j

    if (contracts) call require(all(is_index(place, self%direction%elements)), "surface_nodes: there is such an element")
    if (contracts) call require(size(nodes) == product(self%direction%order + 1), "surface_nodes: there is room for an element")
    a = 0
    do j = self%direction(2)%first(place(2)), self%direction(2)%first(place(2)) + self%direction(2)%order
      do i = self%direction(1)%first(place(1)), self%direction(1)%first(place(1)) + self%direction(1)%order
        a = a + 1
        nodes(a) = 1 + i + self%direction(1)%count * j
      end do
    end do
    if (contracts) call require(all(is_index(nodes, size(self%point))), "surface_nodes: they are points of the surface")
  end subroutine surface_nodes

  !> Control points of an element in homogeneous form: times their weights, and these.
  pure subroutine homogeneous_net(self, positions, place, net)
    type(surface_t), intent(in) :: self
    real(wp), intent(in) :: positions(:, :)
    integer, intent(in) :: place(2)
    real(wp), intent(out) :: net(:, 0:, 0:)
    integer :: a, i, j

    do j = 0, self%direction(2)%order
      do i = 0, self%direction(1)%order
        a = 1 + self%direction(1)%first(place(1)) + i + self%direction(1)%count * (self%direction(2)%first(place(2)) + j)
        net(1:3, i, j) = self%weight(a) * positions(:, self%point(a))
        net(4, i, j) = self%weight(a)
      end do
    end do
    if (contracts) call require(all(net(4, :, :) > 0.0_wp), "homogeneous_net: weights are positive")
  end subroutine homogeneous_net

  !> Point of an element and its `derivatives` to order 2, L/P^order (columns: derivative_column), from its `net` (theory 2.5).
  pure subroutine surface_point(self, place, net, xi, derivatives)
    type(surface_t), intent(in) :: self
    integer, intent(in) :: place(2)
    real(wp), intent(in) :: net(:, 0:, 0:), xi(2)
    real(wp), intent(out) :: derivatives(3, 6)
    real(wp) :: u(0:self%direction(1)%order, 0:2), v(0:self%direction(2)%order, 0:2), row(4, 0:2), h(4, 6)
    integer :: i, j

    call basis(self%direction(1), place(1), xi(1), 2, u)
    call basis(self%direction(2), place(2), xi(2), 2, v)
    h = 0.0_wp
    do j = 0, self%direction(2)%order
      row = 0.0_wp
      do i = 0, self%direction(1)%order
        row(:, 0) = row(:, 0) + u(i, 0) * net(1:4, i, j)
        row(:, 1) = row(:, 1) + u(i, 1) * net(1:4, i, j)
        row(:, 2) = row(:, 2) + u(i, 2) * net(1:4, i, j)
      end do
      h(:, 1) = h(:, 1) + v(j, 0) * row(:, 0)
      h(:, 2) = h(:, 2) + v(j, 0) * row(:, 1)
      h(:, 3) = h(:, 3) + v(j, 1) * row(:, 0)
      h(:, 4) = h(:, 4) + v(j, 0) * row(:, 2)
      h(:, 5) = h(:, 5) + v(j, 1) * row(:, 1)
      h(:, 6) = h(:, 6) + v(j, 2) * row(:, 0)
    end do
    h = h / h(4, 1)
    associate (s => derivatives, w => h(4, :))
      s(:, 1) = h(1:3, 1)
      s(:, 2) = h(1:3, 2) - w(2) * s(:, 1)
      s(:, 3) = h(1:3, 3) - w(3) * s(:, 1)
      s(:, 4) = h(1:3, 4) - 2.0_wp * w(2) * s(:, 2) - w(4) * s(:, 1)
      s(:, 5) = h(1:3, 5) - w(2) * s(:, 3) - w(3) * s(:, 2) - w(5) * s(:, 1)
      s(:, 6) = h(1:3, 6) - 2.0_wp * w(3) * s(:, 3) - w(6) * s(:, 1)
    end associate
  end subroutine surface_point

  !> Rational functions of an element at `xi` and their partial derivatives up to `order` (columns: derivative_column) (theory 2.4):
  !> `values` (functions of an element, derivatives). Quotient rule on the homogeneous form, Piegl and Tiller 1997, Section 4.5,
  !> where weights differ.
  pure subroutine surface_basis(self, place, nodes, xi, order, values)
    type(surface_t), intent(in) :: self
    integer, intent(in) :: place(2), nodes(:)
    real(wp), intent(in) :: xi(2)
    integer, intent(in) :: order
    real(wp), contiguous, intent(out) :: values(:, :)
    real(wp) :: u(0:self%direction(1)%order, 0:order), v(0:self%direction(2)%order, 0:order)
    integer :: a, column, i, j, k, l

    if (contracts) call require(order >= 0 .and. order <= 3, "surface_basis: derivatives are those in the table")
    if (contracts) call require(size(values, 1) == size(nodes), "surface_basis: there is a row for each control point")
    if (contracts) call require(size(values, 2) >= derivative_columns(order), "surface_basis: there is room for derivatives")
    call basis(self%direction(1), place(1), xi(1), order, u)
    call basis(self%direction(2), place(2), xi(2), order, v)
    do l = 0, order
      do k = 0, order - l
        column = derivative_column(k, l)
        a = 0
        do j = 0, ubound(v, 1)
          do i = 0, ubound(u, 1)
            a = a + 1
            values(a, column) = u(i, k) * v(j, l)
          end do
        end do
      end do
    end do
    if (self%rational) call make_rational(order, self%weight(nodes), values)
    if (contracts) call require(sums_to(values(:, 1), 1.0_wp), "surface_basis: functions sum to one")
    if (contracts) call require(order == 0 .or. sums_to(values(:, min(2, order + 1)), 0.0_wp), "surface_basis: slopes sum to zero")
  end subroutine surface_basis

  !> From functions without weights and their derivatives up to `order` to those with `weight`s (functions) (theory 2.4, 2.5).
  pure subroutine make_rational(order, weight, values)
    integer, intent(in) :: order
    real(wp), contiguous, intent(in) :: weight(:)
    real(wp), contiguous, intent(inout) :: values(:, :)
    integer, parameter :: binomial(0:3, 0:3) = reshape([1, 1, 1, 1, 0, 1, 2, 3, 0, 0, 1, 3, 0, 0, 0, 1], [4, 4])
    real(wp) :: total(10)
    integer :: column, degree, i, j, k, l

    do column = 1, derivative_columns(order)
      values(:, column) = weight * values(:, column)
      total(column) = sum(values(:, column))
    end do
    do degree = 0, order
      do l = 0, degree
        k = degree - l
        column = derivative_column(k, l)
        do j = 0, l
          do i = 0, k
            if (i + j == 0) cycle
            values(:, column) = values(:, column) - real(binomial(k, i) * binomial(l, j), wp) &
              * total(derivative_column(i, j)) * values(:, derivative_column(k - i, l - j))
          end do
        end do
        values(:, column) = values(:, column) / total(1)
      end do
    end do
  end subroutine make_rational

end module isomortar_nurbs_surface
