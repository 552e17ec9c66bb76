!> The slave side of a contact pair: its functions and quadrature, fixed for a whole computation.
!>
!> - `slave`, `positions` (3, control points): the slave side; all control points, L. `q`: a quadrature point, from 1.
module isomortar_contact_slave
  use isomortar_base_algebra, only: add_product, cross, weighted_sums
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_index, is_unit
  use isomortar_nurbs_direction, only: direction_t
  use isomortar_nurbs_quadrature, only: gauss_legendre
  use isomortar_nurbs_surface, only: surface_basis, surface_element_count, surface_element_of, surface_nodes, surface_t
  implicit none
  private

  public :: integrate_functions, slave_normal, slave_position, slave_tables, slave_tangents, weigh_functions

  !> Functions on a slave face, given by element and quadrature point.
  type, public :: functions_t
    !> Number of them.
    integer :: count
    !> Functions that are not zero on each element, shape (functions of an element, elements).
    integer, allocatable :: nodes(:, :)
    !> Their values, shape (functions of an element, quadrature points).
    real(wp), allocatable :: values(:, :)
  end type functions_t

  !> Slave side. Its control points are numbered from 1 on their own; quadrature points run within elements.
  type, public :: slave_t
    !> Functions that interpolate the positions of its control points.
    type(functions_t) :: shape
    !> Functions R^I that constraints are weighted with and multipliers interpolated by (theory 2.8): the mortar method's are those
    !> of the face.
    type(functions_t) :: test
    !> Number of quadrature points of each element.
    integer :: per_element
    !> Derivatives of the shape functions by the face's coordinates, shape (functions of an element, 2, quadrature points).
    real(wp), allocatable :: slopes(:, :, :)
    !> Sign of t_1 x t_2 that points out of the body.
    real(wp) :: outward
    !> Quadrature weight times reference area of each quadrature point.
    real(wp), allocatable :: area(:)
    !> <R^I> over all of them, shape (test functions): what a constraint weighs where all points have a foot.
    real(wp), allocatable :: whole(:)
    !> Global number of each control point.
    integer, allocatable :: point(:)
  end type slave_t

contains

  !> Functions, their derivatives and reference areas at the quadrature points of a contact patch (theory 2.8).
  !>
  !> - `surface`, `references` (3, control points): the face; all control points in the reference configuration, L.
  !> - `points`: quadrature points of an element by direction.
  !> - `nodes` (functions of an element, elements): control points of each element, numbered within the surface.
  !> - `basis` (functions of an element, points), `slopes` (functions of an element, 2, points): functions; their derivatives, 1/P.
  !> - `area` (points): quadrature weight times reference area, L^2.
  pure subroutine slave_tables(surface, points, references, nodes, basis, slopes, area)
    type(surface_t), intent(in) :: surface
    integer, intent(in) :: points(2)
    real(wp), intent(in) :: references(:, :)
    integer, intent(out) :: nodes(:, :)
    real(wp), intent(out) :: basis(:, :), slopes(:, :, :), area(:)
    real(wp) :: at1(points(1)), at2(points(2)), weight1(points(1)), weight2(points(2))
    real(wp) :: low(2), length(2), tangents(3, 2), values(size(basis, 1), 3)
    integer :: e, i, j, k, place(2)

    if (contracts) call require(size(nodes, 2) == surface_element_count(surface), "slave_tables: a column for each element")
    if (contracts) call require(size(area) == product(points) * size(nodes, 2), "slave_tables: all elements have as many points")
    call gauss_legendre(at1, weight1)
    call gauss_legendre(at2, weight2)
    k = 0
    do e = 1, surface_element_count(surface)
      place = surface_element_of(surface, e)
      call surface_nodes(surface, place, nodes(:, e))
      low = [surface%direction(1)%boundary(place(1) - 1), surface%direction(2)%boundary(place(2) - 1)]
      length = [surface%direction(1)%boundary(place(1)), surface%direction(2)%boundary(place(2))] - low
      do j = 1, points(2)
        do i = 1, points(1)
          k = k + 1
          call surface_basis(surface, place, nodes(:, e), low + length * [at1(i), at2(j)], 1, values)
          basis(:, k) = values(:, 1)
          slopes(:, :, k) = values(:, 2:3)
          tangents = weighted_sums(references, surface%point(nodes(:, e)), values(:, 2:3))
          area(k) = weight1(i) * weight2(j) * product(length) * norm2(cross(tangents(:, 1), tangents(:, 2)))
        end do
      end do
    end do
    if (contracts) call require(.not. any(area < 0.0_wp), "slave_tables: areas are not below zero")
  end subroutine slave_tables

  !> Position of a slave quadrature point.
  pure function slave_position(slave, positions, q) result(x)
    type(slave_t), intent(in) :: slave
    real(wp), intent(in) :: positions(:, :)
    integer, intent(in) :: q
    real(wp) :: x(3)
    integer :: a, e

    if (contracts) call require(is_index(q, size(slave%area)), "slave_position: there is such a point")
    e = (q - 1) / slave%per_element + 1
    x = 0.0_wp
    do a = 1, size(slave%shape%nodes, 1)
      x = x + slave%shape%values(a, q) * positions(:, slave%point(slave%shape%nodes(a, e)))
    end do
  end function slave_position

  !> Tangent vectors t_1, t_2 of the slave at a quadrature point, L/P.
  pure function slave_tangents(slave, positions, q) result(tangents)
    type(slave_t), intent(in) :: slave
    real(wp), intent(in) :: positions(:, :)
    integer, intent(in) :: q
    real(wp) :: tangents(3, 2)
    integer :: a, e

    if (contracts) call require(is_index(q, size(slave%area)), "slave_tangents: there is such a point")
    e = (q - 1) / slave%per_element + 1
    tangents = 0.0_wp
    do a = 1, size(slave%shape%nodes, 1)
      call add_product(1.0_wp, positions(:, slave%point(slave%shape%nodes(a, e))), slave%slopes(a, :, q), tangents)
    end do
  end function slave_tangents

  !> Unit normal of the slave, out of it, at a quadrature point.
  pure function slave_normal(slave, positions, q) result(normal)
    type(slave_t), intent(in) :: slave
    real(wp), intent(in) :: positions(:, :)
    integer, intent(in) :: q
    real(wp) :: normal(3), tangents(3, 2)

    tangents = slave_tangents(slave, positions, q)
    normal = slave%outward * cross(tangents(:, 1), tangents(:, 2))
    normal = normal / norm2(normal)
    if (contracts) call require(is_unit(normal), "slave_normal: it is a unit vector")
  end function slave_normal

  !> Integrate the test functions of a slave whose other components are given: its `whole`, for which there is room.
  pure subroutine weigh_functions(slave)
    type(slave_t), intent(inout) :: slave
    integer :: a, q

    slave%whole(:) = 0.0_wp
    do q = 1, size(slave%area)
      associate (nodes => slave%test%nodes(:, (q - 1) / slave%per_element + 1))
        do a = 1, size(nodes)
          slave%whole(nodes(a)) = slave%whole(nodes(a)) + slave%test%values(a, q) * slave%area(q)
        end do
      end associate
    end do
  end subroutine weigh_functions

  !> <R^I f> (theory 2.8) for every test function, of `fields` (field, points) at the quadrature points: `totals` (field, test
  !> functions).
  pure subroutine integrate_functions(slave, fields, totals)
    type(slave_t), intent(in) :: slave
    real(wp), intent(in) :: fields(:, :)
    real(wp), intent(out) :: totals(:, :)
    real(wp) :: share(size(slave%test%nodes, 1)), sums(size(share), size(fields, 1))
    integer :: a, e, k, q

    if (contracts) call require(size(slave%area) == slave%per_element * size(slave%test%nodes, 2), "integrate_functions: all")
    if (contracts) call require(size(fields, 2) == size(slave%area), "integrate_functions: fields are given at all points")
    if (contracts) call require(all(shape(totals) == [size(fields, 1), slave%test%count]), "integrate_functions: there is room")
    totals = 0.0_wp
    do e = 1, size(slave%test%nodes, 2)
      sums = 0.0_wp
      do q = (e - 1) * slave%per_element + 1, e * slave%per_element
        share = slave%test%values(:, q) * slave%area(q)
        do k = 1, size(fields, 1)
          sums(:, k) = sums(:, k) + share * fields(k, q)
        end do
      end do
      do a = 1, size(share)
        totals(:, slave%test%nodes(a, e)) = totals(:, slave%test%nodes(a, e)) + sums(a, :)
      end do
    end do
  end subroutine integrate_functions

end module isomortar_contact_slave
