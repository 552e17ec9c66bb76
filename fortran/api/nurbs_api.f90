!> Functions of a face of a patch (a handle, see isomortar_api_descriptors) at given coordinates and their derivatives to order
!> three (isomortar_nurbs_surface): nodes within the face, from 0, and functions(node, derivative, point) in the order 1, u, v, uu,
!> uv, vv, uuu, uuv, uvv, vvv.
subroutine surface_functions(patch, axis, side, xi, m, nlocal, nodes, functions, status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_api_descriptors, only: find
  use isomortar_nurbs_direction, only: element_at
  use isomortar_nurbs_patch, only: patch_t
  use isomortar_nurbs_surface, only: face_of, surface_basis, surface_nodes, surface_t
  implicit none
  integer(c_int64_t), intent(in) :: patch
  integer(c_int), intent(in) :: m, nlocal, axis, side
  real(c_double), intent(in) :: xi(2, m)
  integer(c_int), intent(out) :: nodes(nlocal, m), status
  real(c_double), intent(out) :: functions(nlocal, 10, m)
  type(patch_t), pointer :: body
  type(surface_t) :: surface
  integer :: k, place(2)

  status = 0
  call find(patch, body, status)
  if (status /= 0) return
  surface = face_of(body, axis, side)
  do k = 1, m
    place = [element_at(surface%direction(1), xi(1, k)), element_at(surface%direction(2), xi(2, k))]
    call surface_nodes(surface, place, nodes(:, k))
    call surface_basis(surface, place, nodes(:, k), xi(:, k), 3, functions(:, :, k))
  end do
  nodes = nodes - 1
end subroutine surface_functions
