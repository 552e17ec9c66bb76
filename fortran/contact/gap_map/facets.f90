!> Tangent planes of a face's elements at its nodes: what normals are averaged of, and how these planes turn with the control points
!> (theory 3.21 to 3.23).
!>
!> - `surface`, `positions` (3, control points): the face, and positions of all control points, L.
!> - `facets` (elements), `facet`: the planes of the elements that meet at a node, and one of them.
!> - `work`: counts of what is done.
module isomortar_contact_gap_map_facets
  use isomortar_base_algebra, only: add_product, cross, inverse2, weighted_sums
  use isomortar_base_kinds, only: wp
  use isomortar_contact_work, only: evaluate, work_t
  use isomortar_nurbs_direction, only: direction_t, element_at, family_nurbs
  use isomortar_nurbs_surface, only: surface_basis, surface_nodes, surface_t
  implicit none
  private

  public :: add_second, meet, sum_slopes

  !> Share of an element's length within which a node is on its bound.
  real(wp), parameter :: on_bound = 1.0e-9_wp

  !> An element's tangent plane at a node.
  type, public :: facet_t
    !> Global numbers of its control points.
    integer, allocatable :: point(:)
    !> N,a^k a^a of each, shape (3, control points).
    real(wp), allocatable :: lever(:, :)
    real(wp) :: normal(3)
  end type facet_t

contains

  !> Planes of the elements that meet at node `a` of a face, past a seam too.
  pure subroutine meet(surface, positions, a, facets, work)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: positions(:, :)
    integer, intent(in) :: a
    type(facet_t), allocatable, intent(out) :: facets(:)
    type(work_t), intent(inout) :: work
    integer :: count(2), i, j, index(2), place(2, 2)
    real(wp) :: xi(2, 2)

    index = [mod(a - 1, surface%direction(1)%count), (a - 1) / surface%direction(1)%count]
    do i = 1, 2
      call beside_node(surface%direction(i), surface%closed(i), index(i), place(i, :), xi(i, :), count(i))
    end do
    allocate (facets(product(count)))
    call evaluate(1, product(count), work)
    do j = 1, count(2)
      do i = 1, count(1)
        facets(i + count(1) * (j - 1)) = facet_at(surface, positions, [place(1, i), place(2, j)], [xi(1, i), xi(2, j)])
      end do
    end do
  end subroutine meet

  !> Elements of a direction that meet at its control point j (from 0), and its coordinate in each: the node of a Lagrange element,
  !> the Greville abscissa of a spline (theory 3.21).
  pure subroutine beside_node(direction, closed, j, place, xi, count)
    type(direction_t), intent(in) :: direction
    logical, intent(in) :: closed
    integer, intent(in) :: j
    integer, intent(out) :: place(2), count
    real(wp), intent(out) :: xi(2)
    real(wp) :: length, u
    integer :: e

    if (direction%family == family_nurbs) then
      u = sum(direction%knots(j + 1:j + direction%order)) / real(direction%order, wp)
      e = element_at(direction, u)
    else
      e = min(j / direction%order + 1, direction%elements)
      u = direction%boundary(e - 1) + real(j - direction%order * (e - 1), wp) / real(direction%order, wp) &
        * (direction%boundary(e) - direction%boundary(e - 1))
    end if
    length = direction%boundary(e) - direction%boundary(e - 1)
    count = 1
    place = e
    xi = u
    if (u >= direction%boundary(e) - on_bound * length) then
      xi = direction%boundary(e)
      if (e < direction%elements) then
        count = 2
        place(2) = e + 1
      else if (closed) then
        count = 2
        place(2) = 1
        xi(2) = direction%boundary(0)
      end if
    else if (u <= direction%boundary(e - 1) + on_bound * length) then
      xi = direction%boundary(e - 1)
      if (e > 1) then
        count = 2
        place(2) = e - 1
      else if (closed) then
        count = 2
        place(2) = direction%elements
        xi(2) = direction%boundary(direction%elements)
      end if
    end if
  end subroutine beside_node

  !> The tangent plane of an element at a place.
  pure function facet_at(surface, positions, place, xi) result(self)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: positions(:, :), xi(2)
    integer, intent(in) :: place(2)
    type(facet_t) :: self
    integer :: nodes(product(surface%direction%order + 1))
    real(wp) :: contravariant(3, 2), functions(size(nodes), 3), metric(2, 2), tangent(3, 2)

    call surface_nodes(surface, place, nodes)
    call surface_basis(surface, place, nodes, xi, 1, functions)
    self%point = surface%point(nodes)
    tangent = weighted_sums(positions, self%point, functions(:, 2:3))
    self%normal = surface%outward * cross(tangent(:, 1), tangent(:, 2))
    self%normal = self%normal / norm2(self%normal)
    metric = matmul(transpose(tangent), tangent)
    metric = inverse2(metric)
    contravariant = matmul(tangent, metric)
    self%lever = matmul(contravariant, transpose(functions(:, 2:3)))
  end function facet_at

  !> Derivatives of the sum of the facets' normals, `slope` (3, 3, control points), by their control points, each of these once:
  !> `point` (control points) (theory 3.22).
  pure subroutine sum_slopes(facets, point, slope)
    type(facet_t), intent(in) :: facets(:)
    integer, allocatable, intent(out) :: point(:)
    real(wp), allocatable, intent(out) :: slope(:, :, :)
    integer :: all_points(size(facets) * size(facets(1)%point)), at, count, e, k
    real(wp) :: sums(3, 3, size(all_points))

    count = 0
    sums = 0.0_wp
    do e = 1, size(facets)
      do k = 1, size(facets(e)%point)
        at = findloc(all_points(:count), facets(e)%point(k), dim=1)
        if (at == 0) then
          count = count + 1
          at = count
          all_points(at) = facets(e)%point(k)
        end if
        call add_product(-1.0_wp, facets(e)%lever(:, k), facets(e)%normal, sums(:, :, at))
      end do
    end do
    point = all_points(:count)
    slope = sums(:, :, :count)
  end subroutine sum_slopes

  !> Add the second variation of a facet's normal times a `vector` to a `form` (left component, right component, left, right), whose
  !> control points are `point` (control points) (theory 3.23).
  pure subroutine add_second(facet, vector, point, form)
    type(facet_t), intent(in) :: facet
    real(wp), intent(in) :: vector(3)
    integer, intent(in) :: point(:)
    real(wp), intent(inout) :: form(:, :, :, :)
    real(wp) :: share(size(facet%point))
    integer :: at(size(facet%point)), k, l

    share = matmul(vector, facet%lever)
    do k = 1, size(at)
      at(k) = findloc(point, facet%point(k), dim=1)
    end do
    do l = 1, size(at)
      do k = 1, size(at)
        associate (block => form(:, :, at(k), at(l)), n => facet%normal, left => facet%lever(:, k), right => facet%lever(:, l))
          call add_product(share(l), n, left, block)
          call add_product(share(k), right, n, block)
          call add_product(-dot_product(vector, n) * dot_product(left, right), n, n, block)
        end associate
      end do
    end do
  end subroutine add_second

end module isomortar_contact_gap_map_facets
