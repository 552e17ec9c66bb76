!> Functions of a face at given coordinates and their derivatives to order three (isomortar_nurbs_surface): nodes within the face,
!> from 0, and functions(node, derivative, point) in the order 1, u, v, uu, uv, vv, uuu, uuv, uvv, vvv.
subroutine surface_functions(layout, knots, nknots, point, weight, npoints, axis, side, xi, m, nlocal, nodes, functions)
  use iso_c_binding, only: c_double, c_int
  use isomortar_api_unpack, only: unpack_patch
  use isomortar_nurbs_direction, only: element_at
  use isomortar_nurbs_surface, only: face_of, surface_basis, surface_nodes, surface_t
  implicit none
  integer(c_int), intent(in) :: nknots, npoints, m, nlocal
  integer(c_int), intent(in) :: layout(9), axis, side, point(npoints)
  real(c_double), intent(in) :: knots(nknots), weight(npoints), xi(2, m)
  integer(c_int), intent(out) :: nodes(nlocal, m)
  real(c_double), intent(out) :: functions(nlocal, 10, m)
  type(surface_t) :: surface
  integer :: k, place(2)

  surface = face_of(unpack_patch(layout, knots, point, weight), axis, side)
  do k = 1, m
    place = [element_at(surface%direction(1), xi(1, k)), element_at(surface%direction(2), xi(2, k))]
    call surface_nodes(surface, place, nodes(:, k))
    call surface_basis(surface, place, nodes(:, k), xi(:, k), 3, functions(:, :, k))
  end do
  nodes = nodes - 1
end subroutine surface_functions
