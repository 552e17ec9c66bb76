!> Functions of a face of a patch at given coordinates and their derivatives to order three (isomortar_nurbs_surface).
!>
!> - `patch`, `axis`, `side`: handle of the patch (isomortar_api_descriptors), axis across the face (1..3), its end there (0, 1).
!> - `xi`: `m` pairs of coordinates.
!> - `nodes`: the `nlocal` control points of the element of each, numbered within the face, from 0.
!> - `functions`: (node, derivative, pair) in the order 1, u, v, uu, uv, vv, uuu, uuv, uvv, vvv.
!> - `status`: how it ended (isomortar_base_status).
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
