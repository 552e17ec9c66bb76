!> Volume patches: the tensor product of three directions, with weights and global control point numbers.
module isomortar_nurbs_patch
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_index, sums_to
  use isomortar_nurbs_direction, only: basis, direction_t
  use isomortar_nurbs_quadrature, only: gauss_legendre
  implicit none
  private

  public :: element_count, element_nodes, element_of, line_rule

  !> A volume patch.
  type, public :: patch_t
    type(direction_t) :: direction(3)
    !> Global number (from 1) of each control point; the first direction runs fastest.
    integer, allocatable :: point(:)
    !> Weight of each control point.
    real(wp), allocatable :: weight(:)
  end type patch_t

  !> Functions of one direction at the quadrature points of one element.
  type, public :: line_rule_t
    !> Quadrature weights times the length of the element.
    real(wp), allocatable :: weight(:)
    !> values(j, k, q): derivative k of function j at point q.
    real(wp), allocatable :: values(:, :, :)
  end type line_rule_t

contains

  !> Number of elements.
  pure integer function element_count(self)
    type(patch_t), intent(in) :: self

    element_count = product(self%direction%elements)
  end function element_count

  !> Element numbers by direction of element number `e` (from 1, first direction fastest).
  pure function element_of(self, e) result(place)
    type(patch_t), intent(in) :: self
    integer, intent(in) :: e
    integer :: place(3)

    if (contracts) call require(is_index(e, element_count(self)), "element_of: there is such an element")
    place(1) = mod(e - 1, self%direction(1)%elements) + 1
    place(2) = mod((e - 1) / self%direction(1)%elements, self%direction(2)%elements) + 1
    place(3) = (e - 1) / (self%direction(1)%elements * self%direction(2)%elements) + 1
  end function element_of

  !> Local numbers (from 1) of the control points of an element, first direction fastest.
  !>
  !> - `place`: the element by direction, from 1.
  !> - `nodes` (functions of an element): these numbers.
  pure subroutine element_nodes(self, place, nodes)
    type(patch_t), intent(in) :: self
    integer, intent(in) :: place(3)
    integer, intent(out) :: nodes(:)
    integer :: a, first(3), i, j, k, d

    if (contracts) call require(all(is_index(place, self%direction%elements)), "element_nodes: there is such an element")
    if (contracts) call require(size(nodes) == product(self%direction%order + 1), "element_nodes: there is room for an element")
    do d = 1, 3
      first(d) = self%direction(d)%first(place(d))
    end do
    a = 0
    do k = first(3), first(3) + self%direction(3)%order
      do j = first(2), first(2) + self%direction(2)%order
        do i = first(1), first(1) + self%direction(1)%order
          a = a + 1
          nodes(a) = 1 + i + self%direction(1)%count * (j + self%direction(2)%count * k)
        end do
      end do
    end do
    if (contracts) call require(all(is_index(nodes, size(self%point))), "element_nodes: they are points of the patch")
  end subroutine element_nodes

  !> Functions and quadrature of every element of one direction.
  !>
  !> - `points`, `derivatives`: Gauss points of an element, and how often functions are differentiated.
  !> - `rule` (elements): what comes of it. `direction`: of the patch.
  pure subroutine line_rule(direction, points, derivatives, rule)
    type(direction_t), intent(in) :: direction
    integer, intent(in) :: points, derivatives
    type(line_rule_t), allocatable, intent(out) :: rule(:)
    real(wp) :: position(points), weight(points), low, length
    integer :: e, q

    call gauss_legendre(position, weight)
    allocate (rule(direction%elements))
    do e = 1, direction%elements
      low = direction%boundary(e - 1)
      length = direction%boundary(e) - low
      allocate (rule(e)%values(0:direction%order, 0:derivatives, points))
      rule(e)%weight = weight * length
      do q = 1, points
        call basis(direction, e, low + position(q) * length, derivatives, rule(e)%values(:, :, q))
      end do
      if (contracts) call require(sums_to(rule(e)%weight, length), "line_rule: weights sum to the element's length")
    end do
  end subroutine line_rule

end module isomortar_nurbs_patch
