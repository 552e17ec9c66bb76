! What Python sees of the twin: differences that tangents are compared with. Shapes, units and names are those of solid_api.f90 and
! contact_api.f90; `along` is the direction of a derivative, `step` the half length of the central difference.

!> Directional derivative of one body's internal forces (isomortar_solid_assembly).
!>
!> - `body`, `material`, `x`, `n`: as in `add_body`.
!> - `forces`: the derivative, F/L times the unit of `along`.
!> - `status`, `place`: as in `add_body`.
subroutine solid_difference(body, material, x, along, step, n, forces, status, place)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_api_descriptors, only: find
  use isomortar_api_difference, only: difference
  use isomortar_base_kinds, only: wp
  use isomortar_solid_assembly, only: add_body
  use isomortar_solid_body, only: body_t
  use isomortar_solid_material_law, only: material_t
  implicit none
  integer(c_int64_t), intent(in) :: body, material
  integer(c_int), intent(in) :: n
  real(c_double), intent(in) :: x(3, n), along(3, n), step
  real(c_double), intent(out) :: forces(3, n)
  integer(c_int), intent(out) :: status, place
  type(body_t), pointer :: solid
  class(material_t), pointer :: law
  real(wp), allocatable :: sides(:, :, :)
  real(wp) :: smallest_jacobian
  integer :: side

  forces = 0.0_c_double
  status = 0
  place = 0
  call find(body, solid, status)
  call find(material, law, status)
  if (status /= 0) return
  allocate (sides(3, n, 2))
  sides = 0.0_wp
  do side = 1, 2
    call add_body(solid, law, real(x, wp) + (2 * side - 3) * real(step, wp) * real(along, wp), sides(:, :, side), &
      smallest_jacobian, status, place)
    if (status /= 0) return
  end do
  forces = real(difference(sides(:, :, 2), sides(:, :, 1), real(step, wp)), c_double)
end subroutine solid_difference

!> Directional derivatives of all that a contact pair's tangent is made of (isomortar_api_difference).
!>
!> - `slave`, `map`, `friction`, `n`, `nquad`, `ntest`, `x`, `origin`, `had`, `status`, `place`: as in `project_points`.
!> - `xi`, `element`, `fixed`, `found`, `state`: those of the double-precision kernel.
!> - `summed`, `penalties`, `pressure_k`, `traction_k`, `bears`, `free`, `elastic`, `smoothing`: the law, as in
!>   `augmented_multipliers`.
!> - `pressure_along`, `traction_along`: directions of its multipliers.
!> - `pressure`, `traction`: multipliers that are held where forces are differentiated alone.
!> - `gap`, `coordinates`, `slip`, `metric`: derivatives of <R g>, <R xi>, <R slip>, <R R a_ab>.
!> - `pressure_change`, `traction_change`: those of the law's multipliers.
!> - `normal_forces`, `tangential_forces`, `forces`: those of forces with held pressures, held tractions, the law's multipliers.
!> - `switched`: points and control points for which element, foot or state are not the same on both sides.
subroutine contact_difference(slave, map, friction, x, along, step, n, xi, element, fixed, found, origin, had, nquad, summed, &
    penalties, pressure_k, traction_k, bears, free, elastic, smoothing, pressure_along, traction_along, pressure, traction, state, &
    ntest, gap, coordinates, slip, metric, pressure_change, traction_change, normal_forces, tangential_forces, forces, switched, &
    status, place)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_api_descriptors, only: find
  use isomortar_api_difference, only: difference, evaluate_contact, fixed_of, fixed_t, law_of, quantities_t
  use isomortar_base_kinds, only: wp
  use isomortar_contact_augmentation, only: law_t
  use isomortar_contact_friction_law, only: friction_t
  use isomortar_contact_gap_map_map, only: gap_map_t
  use isomortar_contact_sample, only: multipliers_t
  use isomortar_contact_slave, only: slave_t
  implicit none
  integer(c_int64_t), intent(in) :: slave, map, friction
  integer(c_int), intent(in) :: n, nquad, ntest
  integer(c_int), intent(in) :: element(2, nquad), fixed(2, nquad), found(nquad), had(nquad), summed, state(ntest), elastic
  integer(c_int), intent(in) :: bears(ntest)
  real(c_double), intent(in) :: x(3, n), along(3, n), step, xi(2, nquad), origin(2, nquad), penalties(2), smoothing
  real(c_double), intent(in) :: pressure_k(ntest), traction_k(2, ntest), free(2, 2, ntest)
  real(c_double), intent(in) :: pressure_along(ntest), traction_along(2, ntest), pressure(ntest), traction(2, ntest)
  real(c_double), intent(out) :: gap(ntest), coordinates(2, ntest), slip(2, ntest), metric(3, ntest), pressure_change(ntest)
  real(c_double), intent(out) :: traction_change(2, ntest), normal_forces(3, n), tangential_forces(3, n), forces(3, n)
  integer(c_int), intent(out) :: switched, status, place
  type(slave_t), pointer :: slave_side
  class(gap_map_t), pointer :: onto
  class(friction_t), pointer :: rubs
  type(fixed_t) :: kept
  type(law_t) :: law
  type(quantities_t) :: sides(2)
  real(wp) :: h, shift
  integer :: side

  switched = 0
  status = 0
  place = 0
  call find(slave, slave_side, status)
  call find(map, onto, status)
  call find(friction, rubs, status)
  if (status /= 0) return
  kept = fixed_of(slave_side, onto, xi, origin, had, summed)
  kept%frozen = multipliers_t(real(pressure, wp), real(traction, wp), state /= 0)
  law = law_of(rubs, penalties, bears, free, elastic, smoothing)
  h = real(step, wp)
  do side = 1, 2
    shift = (2 * side - 3) * h
    law%pressure = real(pressure_k, wp) + shift * pressure_along
    law%traction = real(traction_k, wp) + shift * traction_along
    call evaluate_contact(kept, real(x, wp) + shift * along, law, sides(side), status, place)
    if (status /= 0) return
    switched = switched + count(sides(side)%response%state /= state) + count(sides(side)%projections%found .neqv. (found /= 0)) &
      + count(any(sides(side)%projections%place /= element + 1 .or. (sides(side)%projections%fixed .neqv. fixed /= 0), dim=1) &
      .and. found /= 0)
  end do
  gap = real(difference(sides(2)%control%gap, sides(1)%control%gap, h), c_double)
  coordinates = real(difference(sides(2)%coordinates, sides(1)%coordinates, h), c_double)
  slip = real(difference(sides(2)%control%slip, sides(1)%control%slip, h), c_double)
  metric = real(difference(sides(2)%control%metric, sides(1)%control%metric, h), c_double)
  pressure_change = real(difference(sides(2)%response%multipliers%pressure, sides(1)%response%multipliers%pressure, h), c_double)
  traction_change = real(difference(sides(2)%response%multipliers%traction, sides(1)%response%multipliers%traction, h), c_double)
  normal_forces = real(difference(sides(2)%normal_forces, sides(1)%normal_forces, h), c_double)
  tangential_forces = real(difference(sides(2)%tangential_forces, sides(1)%tangential_forces, h), c_double)
  forces = real(difference(sides(2)%forces, sides(1)%forces, h), c_double)
end subroutine contact_difference

!> The tangent of a contact pair, multipliers condensed, as the kernel assembles it (isomortar_api_assembled).
!>
!> - `slave`, `map`, `friction`, `n`, `nquad`, `ntest`, `x`, `xi`, `origin`, `had`, `status`, `place`: as in `contact_difference`.
!> - `summed`, `penalties`, `pressure_k`, `traction_k`, `bears`, `free`, `elastic`, `smoothing`: likewise.
!> - `row_pattern`, `neighbours`, `wide`, `pattern`, `nkinds`, `nblocks`, `tangent`: as in `contact_blocks` and `multiplier_rows`.
subroutine contact_tangent(slave, map, friction, x, n, xi, origin, had, nquad, summed, penalties, pressure_k, traction_k, bears, &
    free, elastic, smoothing, ntest, row_pattern, neighbours, wide, pattern, nkinds, nblocks, tangent, status, place)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_api_assembled, only: assemble_tangent, patterns_t
  use isomortar_api_descriptors, only: find
  use isomortar_api_difference, only: fixed_of, fixed_t, law_of
  use isomortar_base_kinds, only: wp
  use isomortar_contact_augmentation, only: law_t
  use isomortar_contact_friction_law, only: friction_t
  use isomortar_contact_gap_map_map, only: gap_map_t
  use isomortar_contact_slave, only: slave_t
  implicit none
  integer(c_int64_t), intent(in) :: slave, map, friction, row_pattern, neighbours, wide, pattern
  integer(c_int), intent(in) :: n, nquad, ntest, nkinds, nblocks, had(nquad), summed, bears(ntest), elastic
  real(c_double), intent(in) :: x(3, n), xi(2, nquad), origin(2, nquad), penalties(2), pressure_k(ntest), traction_k(2, ntest)
  real(c_double), intent(in) :: free(2, 2, ntest), smoothing
  real(c_double), intent(out) :: tangent(3, 3, nblocks)
  integer(c_int), intent(out) :: status, place
  type(slave_t), pointer :: slave_side
  class(gap_map_t), pointer :: onto
  class(friction_t), pointer :: rubs
  type(patterns_t) :: patterns
  type(fixed_t) :: kept
  type(law_t) :: law
  real(wp) :: sum_of_blocks(3, 3, nblocks)

  status = 0
  place = 0
  tangent = 0.0_c_double
  call find(slave, slave_side, status)
  call find(map, onto, status)
  call find(friction, rubs, status)
  call find(row_pattern, patterns%rows, status)
  call find(neighbours, patterns%neighbours, status)
  call find(wide, patterns%wide, status)
  call find(pattern, patterns%tangent, status)
  if (status /= 0) return
  kept = fixed_of(slave_side, onto, xi, origin, had, summed)
  law = law_of(rubs, penalties, bears, free, elastic, smoothing)
  law%pressure = real(pressure_k, wp)
  law%traction = real(traction_k, wp)
  call assemble_tangent(kept, real(x, wp), law, patterns, nkinds, sum_of_blocks, status, place)
  tangent = real(sum_of_blocks, c_double)
end subroutine contact_tangent

!> Feet of every slave quadrature point (isomortar_contact_control). `xi` holds starts at first.
!>
!> - `slave`, `map`, `x`, `n`, `started`, `nquad`, `element`, `fixed`, `found`, `doubt`, `status`, `place`: as in `project_points`.
subroutine extended_feet(slave, map, x, n, started, nquad, xi, element, fixed, found, doubt, status, place)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_api_descriptors, only: find
  use isomortar_base_kinds, only: wp
  use isomortar_contact_control, only: project_points
  use isomortar_contact_gap_map_map, only: gap_map_t, projections_at, projections_t
  use isomortar_contact_slave, only: slave_t
  use isomortar_contact_work, only: work_t
  implicit none
  integer(c_int64_t), intent(in) :: slave, map
  integer(c_int), intent(in) :: n, nquad, started(nquad)
  real(c_double), intent(in) :: x(3, n)
  real(c_double), intent(inout) :: xi(2, nquad)
  integer(c_int), intent(out) :: element(2, nquad), fixed(2, nquad), found(nquad), doubt(nquad), status, place
  type(slave_t), pointer :: side
  class(gap_map_t), pointer :: onto
  type(projections_t) :: projections
  type(work_t) :: work

  status = 0
  place = 0
  call find(slave, side, status)
  call find(map, onto, status)
  if (status /= 0) return
  projections = projections_at(real(xi, wp))
  call project_points(side, onto, real(x, wp), started /= 0, real(xi, wp), started /= 0, .true., projections, status, place, work)
  xi = real(projections%xi, c_double)
  element = projections%place - 1
  fixed = merge(1, 0, projections%fixed)
  found = merge(1, 0, projections%found)
  doubt = projections%doubt
end subroutine extended_feet

!> Hulls of the elements of a face of a patch (isomortar_contact_hulls).
!>
!> - `patch`, `axis`, `side`, `x`, `n`, `status`: as in `slave_tables`. `nelements`, `nlocal`: elements, points of each.
!> - `centre`, `radius`: spheres, L.
!> - `frame`, `half`: boxes about the same centres: unit vectors (rows), half lengths along them, L.
!> - `corner`, `sample`: Bezier points, and points of the surface on a regular grid, L.
!> - `curvature`: largest of each element, 1/L.
subroutine surface_hulls(patch, axis, side, x, n, nelements, nlocal, centre, radius, frame, half, corner, sample, curvature, &
    status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_api_descriptors, only: find
  use isomortar_base_kinds, only: wp
  use isomortar_contact_hulls, only: enclose, hulls_t
  use isomortar_nurbs_patch, only: patch_t
  use isomortar_nurbs_surface, only: face_of
  implicit none
  integer(c_int64_t), intent(in) :: patch
  integer(c_int), intent(in) :: n, nelements, nlocal, axis, side
  real(c_double), intent(in) :: x(3, n)
  real(c_double), intent(out) :: centre(nelements, 3), radius(nelements), frame(3, 3, nelements), half(3, nelements)
  real(c_double), intent(out) :: corner(3, nlocal, nelements), sample(3, nlocal, nelements), curvature(nelements)
  integer(c_int), intent(out) :: status
  type(patch_t), pointer :: body
  type(hulls_t) :: hulls

  status = 0
  call find(patch, body, status)
  if (status /= 0) return
  call enclose(face_of(body, axis, side), real(x, wp), hulls)
  centre = real(hulls%centre, c_double)
  radius = real(hulls%radius, c_double)
  frame = real(hulls%frame, c_double)
  half = real(hulls%half, c_double)
  corner = real(hulls%corner, c_double)
  sample = real(hulls%sample, c_double)
  curvature = real(min(hulls%curvature, real(huge(1.0_c_double), wp)), c_double)
end subroutine surface_hulls

!> Points of a face of a patch with their derivatives, as the search for feet evaluates them (isomortar_nurbs_surface).
!>
!> - `patch`, `axis`, `side`, `x`, `n`, `status`: as in `slave_tables`. `xi`, `m`: coordinates of points, P, and their number.
!> - `derivatives`: S, S,1, S,2, S,11, S,12, S,22, L/P^order.
subroutine surface_points(patch, axis, side, x, n, xi, m, derivatives, status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_api_descriptors, only: find
  use isomortar_base_kinds, only: wp
  use isomortar_nurbs_direction, only: element_at
  use isomortar_nurbs_patch, only: patch_t
  use isomortar_nurbs_surface, only: face_of, homogeneous_net, surface_point, surface_t
  implicit none
  integer(c_int64_t), intent(in) :: patch
  integer(c_int), intent(in) :: n, m, axis, side
  real(c_double), intent(in) :: x(3, n), xi(2, m)
  real(c_double), intent(out) :: derivatives(3, 6, m)
  integer(c_int), intent(out) :: status
  type(patch_t), pointer :: body
  type(surface_t) :: surface
  real(wp), allocatable :: net(:, :, :)
  real(wp) :: s(3, 6)
  integer :: k, place(2)

  derivatives = 0.0_c_double
  status = 0
  call find(patch, body, status)
  if (status /= 0) return
  surface = face_of(body, axis, side)
  allocate (net(4, surface%direction(1)%order + 1, surface%direction(2)%order + 1))
  do k = 1, m
    place = [element_at(surface%direction(1), real(xi(1, k), wp)), element_at(surface%direction(2), real(xi(2, k), wp))]
    call homogeneous_net(surface, real(x, wp), place, net)
    call surface_point(surface, place, net, real(xi(:, k), wp), s)
    derivatives(:, :, k) = real(s, c_double)
  end do
end subroutine surface_points

!> What the search of a whole face learns of each element before it is searched (isomortar_contact_hulls).
!>
!> - `patch`, `axis`, `side`, `x`, `n`, `status`: as in `slave_tables`. `nelements`: of the face.
!> - `targets`, `ways`, `m`: points, L, the ways from these to some place of the face, L, and their number.
!> - `xi`: coordinates of the sample of the element that is nearest to the point, P.
!> - `farther`: 1 where the element is found to be farther than that place.
subroutine surface_prospects(patch, axis, side, x, n, targets, ways, m, nelements, xi, farther, status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_api_descriptors, only: find
  use isomortar_base_kinds, only: wp
  use isomortar_contact_hulls, only: enclose, hulls_t, is_farther, nearest_sample
  use isomortar_nurbs_patch, only: patch_t
  use isomortar_nurbs_surface, only: face_of, surface_t
  implicit none
  integer(c_int64_t), intent(in) :: patch
  integer(c_int), intent(in) :: n, m, nelements, axis, side
  real(c_double), intent(in) :: x(3, n), targets(3, m), ways(3, m)
  real(c_double), intent(out) :: xi(2, nelements, m)
  integer(c_int), intent(out) :: farther(nelements, m), status
  type(patch_t), pointer :: body
  type(surface_t) :: surface
  type(hulls_t) :: hulls
  real(wp) :: sample(2), square, target(3), way(3)
  integer :: e, k

  xi = 0.0_c_double
  farther = 0
  status = 0
  call find(patch, body, status)
  if (status /= 0) return
  surface = face_of(body, axis, side)
  call enclose(surface, real(x, wp), hulls)
  do k = 1, m
    target = real(targets(:, k), wp)
    way = real(ways(:, k), wp)
    do e = 1, nelements
      call nearest_sample(surface, hulls, e, target, sample, square)
      xi(:, e, k) = real(sample, c_double)
      farther(e, k) = merge(1, 0, is_farther(hulls, e, target, way, norm2(way)))
    end do
  end do
end subroutine surface_prospects
