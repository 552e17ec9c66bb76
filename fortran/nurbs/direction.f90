!> One parametric direction of a patch: elements, and the functions that do not vanish on each of them.
!>
!> - `u`: coordinate, P. `element`: of the direction, from 1.
module isomortar_nurbs_direction
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_index, sums_to
  implicit none
  private

  public :: new_direction, basis, element_at, is_kink

  integer, parameter, public :: family_nurbs = 1
  integer, parameter, public :: family_lagrange = 2
  !> Largest order of either family.
  integer, parameter, public :: max_order = 10

  !> A direction with its elements (non-empty knot spans).
  type, public :: direction_t
    integer :: family = family_nurbs
    integer :: order = 0
    !> Number of control points.
    integer :: count = 0
    !> Number of elements.
    integer :: elements = 0
    !> Full knot vector (NURBS), numbered from 0, or element boundaries (Lagrange).
    real(wp), allocatable :: knots(:)
    !> Element boundaries, 0..elements.
    real(wp), allocatable :: boundary(:)
    !> First control point (from 0) of the functions that do not vanish on element e = 1..elements.
    integer, allocatable :: first(:)
  end type direction_t

contains

  !> A direction of a `family` (family_nurbs, family_lagrange) and `order` from its `knots` (knots), as `direction_t` has
  !> them, P. The knots have been validated by the caller.
  pure function new_direction(family, order, knots) result(self)
    integer, intent(in) :: family, order
    real(wp), intent(in) :: knots(:)
    type(direction_t) :: self
    integer :: i, last

    if (contracts) call require(order >= 1 .and. order <= max_order, "new_direction: the order is one that there is")
    if (contracts) call require(all(knots(2:) >= knots(:size(knots) - 1)), "new_direction: knots do not fall")
    self%family = family
    self%order = order
    last = size(knots) - 1
    allocate (self%knots(0:last), self%boundary(0:last), self%first(last))
    self%knots(:) = knots
    self%boundary(0) = knots(1)
    do i = 0, last - 1
      if (self%knots(i + 1) > self%knots(i)) then
        self%elements = self%elements + 1
        self%boundary(self%elements) = self%knots(i + 1)
        self%first(self%elements) = merge(i - order, i * order, family == family_nurbs)
      end if
    end do
    self%count = merge(last - order, order * last + 1, family == family_nurbs)
    if (contracts) call require(self%elements >= 1, "new_direction: there is an element")
    if (contracts) call require(self%first(self%elements) + order == self%count - 1, "new_direction: elements end at the end")
  end function new_direction

  !> The element that holds coordinate `u`; the one above where `u` is a boundary, the last one at the end.
  pure function element_at(self, u) result(element)
    type(direction_t), intent(in) :: self
    real(wp), intent(in) :: u
    integer :: element
    integer :: low, high

    low = 1
    high = self%elements
    do while (low < high)
      element = (low + high) / 2
      if (u < self%boundary(element)) then
        high = element
      else
        low = element + 1
      end if
    end do
    element = low
    if (contracts) call require(is_index(element, self%elements), "element_at: there is such an element")
    if (contracts) call require(element == 1 .or. .not. u < self%boundary(element - 1), "element_at: u is not below it")
    if (contracts) call require(element == self%elements .or. .not. u > self%boundary(element), "element_at: u is not above it")
  end function element_at

  !> Whether functions are only continuous from `element` to the next (theory 2.9). From the last one on, at a seam, they are:
  !> knots are open.
  pure logical function is_kink(self, element)
    type(direction_t), intent(in) :: self
    integer, intent(in) :: element

    if (contracts) call require(is_index(element, self%elements), "is_kink: there is such an element")
    is_kink = element == self%elements
    if (.not. is_kink) is_kink = self%first(element + 1) - self%first(element) >= self%order
  end function is_kink

  !> The order + 1 functions of an `element` at `u`, and so many `derivatives`: `values`(j, k) is the k-th derivative of function
  !> j, 1/P^k.
  pure subroutine basis(self, element, u, derivatives, values)
    type(direction_t), intent(in) :: self
    integer, intent(in) :: element
    real(wp), intent(in) :: u
    integer, intent(in) :: derivatives
    real(wp), intent(out) :: values(0:self%order, 0:derivatives)

    if (contracts) call require(is_index(element, self%elements), "basis: there is such an element")
    if (contracts) call require(derivatives >= 0, "basis: derivatives have an order")
    if (self%family == family_nurbs) then
      call bspline_basis(self, self%first(element) + self%order, u, derivatives, values)
    else
      call lagrange_basis(self, element, u, derivatives, values)
    end if
    if (contracts) call require(sums_to(values(:, 0), 1.0_wp), "basis: functions sum to one")
    if (contracts) call require(derivatives == 0 .or. sums_to(values(:, derivatives), 0.0_wp), "basis: derivatives sum to zero")
  end subroutine basis

  !> Cox and de Boor: raise the order by the recurrence order - k times, then k times by its derivative.
  pure subroutine bspline_basis(self, span, u, derivatives, values)
    type(direction_t), intent(in) :: self
    integer, intent(in) :: span
    real(wp), intent(in) :: u
    integer, intent(in) :: derivatives
    real(wp), intent(out) :: values(0:self%order, 0:derivatives)
    integer :: highest, k, q

    highest = min(derivatives, self%order)
    values(:, highest + 1:) = 0.0_wp
    values(0, highest) = 1.0_wp
    do q = 1, self%order - highest
      call raise(self, span, q, u, values(:, highest))
    end do
    do k = highest, 1, -1
      q = self%order - k
      values(0:q, k - 1) = values(0:q, k)
      call raise(self, span, q + 1, u, values(:, k - 1))
      call differentiate_up(self, span, q, values(:, k))
    end do
  end subroutine bspline_basis

  !> From values of order q - 1 to those of order q on the same span, in their place (theory 2.1).
  pure subroutine raise(self, span, q, u, values)
    type(direction_t), intent(in) :: self
    integer, intent(in) :: span, q
    real(wp), intent(in) :: u
    real(wp), intent(inout), contiguous :: values(0:)
    real(wp) :: carried, share
    integer :: j, left, right

    carried = 0.0_wp
    do j = 0, q - 1
      left = span - q + 1 + j
      right = left + q
      share = values(j) / (self%knots(right) - self%knots(left))
      values(j) = carried + (self%knots(right) - u) * share
      carried = (u - self%knots(left)) * share
    end do
    values(q) = carried
  end subroutine raise

  !> From values of order q to derivative number order - q of the functions of full order, in their place (theory 2.2).
  pure subroutine differentiate_up(self, span, q, values)
    type(direction_t), intent(in) :: self
    integer, intent(in) :: span, q
    real(wp), intent(inout), contiguous :: values(0:)
    real(wp) :: carried, share
    integer :: j, left, order, right

    do order = q + 1, self%order
      carried = 0.0_wp
      do j = 0, order - 1
        left = span - order + 1 + j
        right = left + order
        share = real(order, wp) * values(j) / (self%knots(right) - self%knots(left))
        values(j) = carried - share
        carried = share
      end do
      values(order) = carried
    end do
  end subroutine differentiate_up

  !> Nodal Lagrange functions on equally spaced nodes, multiplied up factor by factor with their derivatives (theory 2.3).
  pure subroutine lagrange_basis(self, element, u, derivatives, values)
    type(direction_t), intent(in) :: self
    integer, intent(in) :: element
    real(wp), intent(in) :: u
    integer, intent(in) :: derivatives
    real(wp), intent(out) :: values(0:self%order, 0:derivatives)
    real(wp) :: scale, factor, slope, t
    integer :: j, k, m

    scale = real(self%order, wp) / (self%boundary(element) - self%boundary(element - 1))
    t = (u - self%boundary(element - 1)) * scale
    do j = 0, self%order
      values(j, 0) = 1.0_wp
      values(j, 1:) = 0.0_wp
      do m = 0, self%order
        if (m == j) cycle
        slope = 1.0_wp / real(j - m, wp)
        factor = (t - real(m, wp)) * slope
        do k = derivatives, 1, -1
          values(j, k) = values(j, k) * factor + real(k, wp) * values(j, k - 1) * slope
        end do
        values(j, 0) = values(j, 0) * factor
      end do
    end do
    do k = 1, derivatives
      values(:, k) = values(:, k) * scale**k
    end do
  end subroutine lagrange_basis

end module isomortar_nurbs_direction
