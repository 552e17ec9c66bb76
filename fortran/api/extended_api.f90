!> Directional derivative of one body's internal forces, by a central difference (isomortar_solid_assembly).
subroutine solid_difference(layout, knots, nknots, point, weight, npoints, gauss, law, parameters, nparameters, x, along, step, &
    reference, n, forces, status, place)
  use iso_c_binding, only: c_double, c_int
  use isomortar_api_difference, only: difference
  use isomortar_api_unpack, only: unpack_patch
  use isomortar_base_kinds, only: wp
  use isomortar_solid_assembly, only: add_body
  use isomortar_solid_material_law, only: material_t
  use isomortar_solid_material_table, only: material_of
  implicit none
  integer(c_int), intent(in) :: nknots, npoints, nparameters, n
  integer(c_int), intent(in) :: layout(9), gauss(3), law, point(npoints)
  real(c_double), intent(in) :: knots(nknots), weight(npoints), parameters(nparameters), x(3, n), along(3, n), step, reference(3, n)
  real(c_double), intent(out) :: forces(3, n)
  integer(c_int), intent(out) :: status, place
  class(material_t), allocatable :: material
  real(wp), allocatable :: sides(:, :, :)
  real(wp) :: smallest_jacobian
  integer :: side

  forces = 0.0_c_double
  place = law
  call material_of(law, real(parameters, wp), material, status)
  if (status /= 0) return
  allocate (sides(3, n, 2))
  sides = 0.0_wp
  do side = 1, 2
    call add_body(unpack_patch(layout, knots, point, weight), gauss, material, &
      real(x, wp) + (2 * side - 3) * real(step, wp) * real(along, wp), real(reference, wp), sides(:, :, side), smallest_jacobian, &
      status, place)
    if (status /= 0) return
  end do
  forces = real(difference(sides(:, :, 2), sides(:, :, 1), real(step, wp)), c_double)
end subroutine solid_difference

!> Directional derivatives of all that a contact pair's tangent is made of (isomortar_api_difference), by central differences along
!> `along` of the positions and `pressure_along`, `traction_along` of the law's multipliers. `xi`, `element`, `fixed`, `found` and
!> `state` are those of the double-precision kernel; `switched` counts points and control points for which they are not the same on
!> both sides.
subroutine contact_difference(nodes, basis, area, point, nlocal, nelements, nquad, nslave, kind, knots, nknots, master_point, &
    master_weight, nmaster, x, along, step, n, xi, element, fixed, found, origin, had, summed, penalties, friction, parameters, &
    nparameters, pressure_k, traction_k, bears, free, pressure_along, traction_along, pressure, traction, state, gap, coordinates, &
    slip, metric, pressure_change, traction_change, normal_forces, tangential_forces, forces, switched, status, place)
  use iso_c_binding, only: c_double, c_int
  use isomortar_api_difference, only: difference, evaluate_contact, fixed_t, quantities_t
  use isomortar_api_unpack, only: unpack_gap_map, unpack_slave
  use isomortar_base_kinds, only: wp
  use isomortar_contact_augmentation, only: law_t
  use isomortar_contact_blocks, only: multipliers_t
  use isomortar_contact_friction_table, only: friction_of
  implicit none
  integer(c_int), intent(in) :: nlocal, nelements, nquad, nslave, nknots, nmaster, n, friction, nparameters
  integer(c_int), intent(in) :: nodes(nlocal, nelements), point(nslave), kind(11), master_point(nmaster)
  integer(c_int), intent(in) :: element(2, nquad), fixed(2, nquad), found(nquad), had(nquad), summed, state(nslave)
  integer(c_int), intent(in) :: bears(nslave)
  real(c_double), intent(in) :: basis(nlocal, nquad), area(nquad), knots(nknots), master_weight(nmaster), x(3, n), along(3, n), step
  real(c_double), intent(in) :: xi(2, nquad), origin(2, nquad), penalties(2), parameters(nparameters)
  real(c_double), intent(in) :: pressure_k(nslave), traction_k(2, nslave)
  real(c_double), intent(in) :: pressure_along(nslave), traction_along(2, nslave), pressure(nslave), traction(2, nslave)
  real(c_double), intent(in) :: free(2, 2, nslave)
  real(c_double), intent(out) :: gap(nslave), coordinates(2, nslave), slip(2, nslave), metric(3, nslave), pressure_change(nslave)
  real(c_double), intent(out) :: traction_change(2, nslave), normal_forces(3, n), tangential_forces(3, n), forces(3, n)
  integer(c_int), intent(out) :: switched, status, place
  type(fixed_t) :: kept
  type(law_t) :: law
  type(quantities_t) :: sides(2)
  real(wp) :: h, shift
  integer :: side

  switched = 0
  place = friction
  call friction_of(friction, real(parameters, wp), law%friction, status)
  if (status /= 0) return
  kept%slave = unpack_slave(nodes, basis, area, point)
  call unpack_gap_map(kind, knots, master_point, master_weight, kept%map)
  kept%start = real(xi, wp)
  kept%origin = real(origin, wp)
  kept%had = had /= 0
  kept%frozen = multipliers_t(real(pressure, wp), real(traction, wp), state /= 0)
  kept%summed = summed /= 0
  law%normal_penalty = real(penalties(1), wp)
  law%tangential_penalty = real(penalties(2), wp)
  law%bears = bears /= 0
  law%free = real(free, wp)
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

!> Hulls of the elements of a master's face (isomortar_contact_hulls): spheres, boxes, Bezier points, samples, curvatures.
subroutine surface_hulls(kind, knots, nknots, point, weight, npoints, x, n, nelements, nlocal, centre, radius, frame, half, &
    corner, sample, curvature)
  use iso_c_binding, only: c_double, c_int
  use isomortar_api_unpack, only: unpack_face
  use isomortar_base_kinds, only: wp
  use isomortar_contact_hulls, only: enclose, hulls_t
  implicit none
  integer(c_int), intent(in) :: nknots, npoints, n, nelements, nlocal
  integer(c_int), intent(in) :: kind(11), point(npoints)
  real(c_double), intent(in) :: knots(nknots), weight(npoints), x(3, n)
  real(c_double), intent(out) :: centre(nelements, 3), radius(nelements), frame(3, 3, nelements), half(3, nelements)
  real(c_double), intent(out) :: corner(3, nlocal, nelements), sample(3, nlocal, nelements), curvature(nelements)
  type(hulls_t) :: hulls

  call enclose(unpack_face(kind(3:11), knots, point, weight, kind(1), kind(2)), real(x, wp), hulls)
  centre = real(hulls%centre, c_double)
  radius = real(hulls%radius, c_double)
  frame = real(hulls%frame, c_double)
  half = real(hulls%half, c_double)
  corner = real(hulls%corner, c_double)
  sample = real(hulls%sample, c_double)
  curvature = real(min(hulls%curvature, real(huge(1.0_c_double), wp)), c_double)
end subroutine surface_hulls
