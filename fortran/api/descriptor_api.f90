! What Python hands over once (isomortar_api_descriptors). Numbers count from 0 outside and from 1 inside. Shapes stand in the
! declarations; units are made of length L and force F.
!
! - `handle`: what stands for it from then on; -1 without success. `status`: how it ended (isomortar_base_status).

!> Keep a patch.
!>
!> - `families`, `orders`, `counts`: by direction: 1 NURBS, 2 Lagrange; order; number of control points.
!> - `knots`: those (of Lagrange elements: boundaries) of the directions, one after the other, `nknots` in all.
!> - `point`, `weight`: global number and weight of each of `npoints` control points, the first direction fastest.
subroutine keep_patch(families, orders, counts, knots, nknots, point, weight, npoints, handle, status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_api_descriptors, only: descriptor_t, keep
  use isomortar_base_kinds, only: wp
  use isomortar_base_status, only: status_out_of_memory
  use isomortar_nurbs_direction, only: family_nurbs, new_direction
  implicit none
  integer(c_int), intent(in) :: nknots, npoints, families(3), orders(3), counts(3), point(npoints)
  real(c_double), intent(in) :: knots(nknots), weight(npoints)
  integer(c_int64_t), intent(out) :: handle
  integer(c_int), intent(out) :: status
  type(descriptor_t) :: descriptor
  integer :: d, failed, first, length

  handle = -1
  status = status_out_of_memory
  allocate (descriptor%patch)
  allocate (descriptor%patch%point(npoints), stat=failed)
  if (failed == 0) allocate (descriptor%patch%weight(npoints), stat=failed)
  if (failed /= 0) return
  first = 1
  do d = 1, 3
    length = merge(counts(d) + orders(d) + 1, (counts(d) - 1) / orders(d) + 1, families(d) == family_nurbs)
    descriptor%patch%direction(d) = new_direction(int(families(d)), int(orders(d)), real(knots(first:first + length - 1), wp))
    first = first + length
  end do
  descriptor%patch%point(:) = point + 1
  descriptor%patch%weight(:) = real(weight, wp)
  call keep(descriptor, handle, status)
end subroutine keep_patch

!> Keep a body (isomortar_solid_body). One that is folded is kept, too: its forces are refused.
!>
!> - `patch`: handle of its mesh. `gauss`: quadrature points of an element by direction.
!> - `reference`: positions of all `n` control points in the reference configuration, L.
!> - `often`: 1 to keep as well what it has at its Gauss points, which is else computed with its forces.
subroutine keep_body(patch, gauss, reference, n, often, handle, status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_api_descriptors, only: descriptor_t, find, keep
  use isomortar_base_kinds, only: wp
  use isomortar_base_status, only: status_out_of_memory
  use isomortar_nurbs_patch, only: patch_t
  use isomortar_solid_body, only: body_of
  implicit none
  integer(c_int64_t), intent(in) :: patch
  integer(c_int), intent(in) :: n, gauss(3), often
  real(c_double), intent(in) :: reference(3, n)
  integer(c_int64_t), intent(out) :: handle
  integer(c_int), intent(out) :: status
  type(descriptor_t) :: descriptor
  type(patch_t), pointer :: mesh
  real(wp), allocatable :: places(:, :)
  integer :: failed

  handle = -1
  status = 0
  call find(patch, mesh, status)
  if (status /= 0) return
  status = status_out_of_memory
  allocate (places(3, n), stat=failed)
  if (failed /= 0) return
  places(:, :) = real(reference, wp)
  allocate (descriptor%body)
  call body_of(mesh, gauss, places, often /= 0, descriptor%body, status)
  if (status == 0) call keep(descriptor, handle, status)
end subroutine keep_body

!> Keep a material.
!>
!> - `law`, `parameters`: number of the law, and its `nparameters` (isomortar_solid_material_table), F/L^2.
subroutine keep_material(law, parameters, nparameters, handle, status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_api_descriptors, only: descriptor_t, keep
  use isomortar_base_kinds, only: wp
  use isomortar_solid_material_table, only: material_of
  implicit none
  integer(c_int), intent(in) :: law, nparameters
  real(c_double), intent(in) :: parameters(nparameters)
  integer(c_int64_t), intent(out) :: handle
  integer(c_int), intent(out) :: status
  type(descriptor_t) :: descriptor

  handle = -1
  call material_of(law, real(parameters, wp), descriptor%material, status)
  if (status == 0) call keep(descriptor, handle, status)
end subroutine keep_material

!> Keep a law of friction.
!>
!> - `law`, `parameters`: number of the law, and its `nparameters` (isomortar_contact_friction_table).
subroutine keep_friction(law, parameters, nparameters, handle, status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_api_descriptors, only: descriptor_t, keep
  use isomortar_base_kinds, only: wp
  use isomortar_contact_friction_table, only: friction_of
  implicit none
  integer(c_int), intent(in) :: law, nparameters
  real(c_double), intent(in) :: parameters(nparameters)
  integer(c_int64_t), intent(out) :: handle
  integer(c_int), intent(out) :: status
  type(descriptor_t) :: descriptor

  handle = -1
  call friction_of(law, real(parameters, wp), descriptor%friction, status)
  if (status == 0) call keep(descriptor, handle, status)
end subroutine keep_friction

!> Keep a slave side of `nelements` with `nquad` quadrature points in all, as many in each.
!>
!> - `shape_nodes`, `shape_values`, `shape_slopes`: the `nshape` functions of an element that interpolate its positions: their
!>   control points on the slave, values, derivatives by the coordinates of the face.
!> - `test_nodes`, `test_values`: the `ntest` functions of an element, of `tests` in all, that constraints are weighted with.
!> - `area`: quadrature weight times reference area, L^2.
!> - `point`: global numbers of its `npoints` control points.
!> - `outward`: sign of t_1 x t_2 that points out of it.
subroutine keep_slave(shape_nodes, shape_values, shape_slopes, nshape, test_nodes, test_values, ntest, tests, area, nelements, &
    nquad, point, npoints, outward, handle, status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_api_descriptors, only: descriptor_t, keep
  use isomortar_base_kinds, only: wp
  use isomortar_base_status, only: status_out_of_memory
  use isomortar_contact_slave, only: weigh_functions
  implicit none
  integer(c_int), intent(in) :: nshape, ntest, tests, nelements, nquad, npoints
  integer(c_int), intent(in) :: shape_nodes(nshape, nelements), test_nodes(ntest, nelements)
  integer(c_int), intent(in) :: point(npoints), outward
  real(c_double), intent(in) :: shape_values(nshape, nquad), shape_slopes(nshape, 2, nquad)
  real(c_double), intent(in) :: test_values(ntest, nquad), area(nquad)
  integer(c_int64_t), intent(out) :: handle
  integer(c_int), intent(out) :: status
  type(descriptor_t) :: descriptor
  integer :: failed

  handle = -1
  status = status_out_of_memory
  allocate (descriptor%slave)
  associate (slave => descriptor%slave)
    allocate (slave%shape%nodes(nshape, nelements), stat=failed)
    if (failed == 0) allocate (slave%shape%values(nshape, nquad), stat=failed)
    if (failed == 0) allocate (slave%slopes(nshape, 2, nquad), stat=failed)
    if (failed == 0) allocate (slave%test%nodes(ntest, nelements), stat=failed)
    if (failed == 0) allocate (slave%test%values(ntest, nquad), stat=failed)
    if (failed == 0) allocate (slave%area(nquad), stat=failed)
    if (failed == 0) allocate (slave%whole(tests), stat=failed)
    if (failed == 0) allocate (slave%point(npoints), stat=failed)
    if (failed /= 0) return
    slave%shape%count = npoints
    slave%shape%nodes(:, :) = shape_nodes + 1
    slave%shape%values(:, :) = real(shape_values, wp)
    slave%slopes(:, :, :) = real(shape_slopes, wp)
    slave%test%count = tests
    slave%test%nodes(:, :) = test_nodes + 1
    slave%test%values(:, :) = real(test_values, wp)
    slave%outward = real(outward, wp)
    slave%per_element = nquad / nelements
    slave%area(:) = real(area, wp)
    slave%point(:) = point + 1
    call weigh_functions(slave)
  end associate
  call keep(descriptor, handle, status)
end subroutine keep_slave

!> Keep the gap map of a rigid plane (isomortar_contact_gap_map_plane).
!>
!> - `origin`, `normal`, `tangent`: a point of it, L; its normal; a direction in it, the first coordinate's.
subroutine keep_plane(origin, normal, tangent, handle, status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_api_descriptors, only: descriptor_t, keep
  use isomortar_base_kinds, only: wp
  use isomortar_contact_gap_map_plane, only: plane_through
  implicit none
  real(c_double), intent(in) :: origin(3), normal(3), tangent(3)
  integer(c_int64_t), intent(out) :: handle
  integer(c_int), intent(out) :: status
  type(descriptor_t) :: descriptor

  allocate (descriptor%map, source=plane_through(real(origin, wp), real(normal, wp), real(tangent, wp)))
  call keep(descriptor, handle, status)
end subroutine keep_plane

!> Keep the gap map of a face of a patch.
!>
!> - `patch`, `axis`, `side`: handle of the patch, axis across the face (1..3), its end there (0, 1).
!> - `averaged`: 1: of the averaged normal (isomortar_contact_gap_map_averaged), 0: of the closest point
!>   (isomortar_contact_gap_map_closest_point).
!> - `brim`: how far it goes on beyond its edges, as a share of the outer elements.
!> - `mirror`: component (1..3) across the plane of symmetry that each edge is on, 0: none; (start and end, direction).
subroutine keep_face(patch, axis, side, averaged, brim, mirror, handle, status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_api_descriptors, only: descriptor_t, find, keep
  use isomortar_contact_gap_map_averaged, only: averaged_on
  use isomortar_contact_gap_map_closest_point, only: closest_point_t
  use isomortar_nurbs_patch, only: patch_t
  use isomortar_nurbs_surface, only: face_of, surface_t
  implicit none
  integer(c_int64_t), intent(in) :: patch
  integer(c_int), intent(in) :: axis, side, averaged, mirror(2, 2)
  real(c_double), intent(in) :: brim
  integer(c_int64_t), intent(out) :: handle
  integer(c_int), intent(out) :: status
  type(descriptor_t) :: descriptor
  type(patch_t), pointer :: body
  type(surface_t) :: surface

  handle = -1
  status = 0
  call find(patch, body, status)
  if (status /= 0) return
  surface = face_of(body, axis, side)
  surface%brim = brim
  surface%mirror = mirror
  if (averaged /= 0) then
    allocate (descriptor%map, source=averaged_on(surface, face_of(body, axis, 1 - side)))
  else
    allocate (descriptor%map, source=closest_point_t(surface=surface, opposite=face_of(body, axis, 1 - side)))
  end if
  call keep(descriptor, handle, status)
end subroutine keep_face

!> Keep a pattern of blocks in compressed rows.
!>
!> - `start`, `column`: where the `nrows` begin, and the columns of `nblocks`.
subroutine keep_pattern(start, nrows, column, nblocks, handle, status)
  use iso_c_binding, only: c_int, c_int64_t
  use isomortar_api_descriptors, only: descriptor_t, keep
  use isomortar_base_status, only: status_out_of_memory
  implicit none
  integer(c_int), intent(in) :: nrows, nblocks
  integer(c_int), intent(in) :: start(nrows + 1), column(nblocks)
  integer(c_int64_t), intent(out) :: handle
  integer(c_int), intent(out) :: status
  type(descriptor_t) :: descriptor
  integer :: failed

  handle = -1
  status = status_out_of_memory
  allocate (descriptor%pattern)
  allocate (descriptor%pattern%start(0:nrows), stat=failed)
  if (failed == 0) allocate (descriptor%pattern%column(nblocks), stat=failed)
  if (failed /= 0) return
  descriptor%pattern%start(:) = start
  descriptor%pattern%column(:) = column + 1
  call keep(descriptor, handle, status)
end subroutine keep_pattern

!> Free what a handle stands for.
subroutine release_descriptor(handle, status)
  use iso_c_binding, only: c_int, c_int64_t
  use isomortar_api_descriptors, only: release
  implicit none
  integer(c_int64_t), intent(in) :: handle
  integer(c_int), intent(out) :: status

  call release(handle, status)
end subroutine release_descriptor
