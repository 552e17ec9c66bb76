!> Functions and reference areas at the quadrature points of a slave face (isomortar_contact_slave).
!> `nodes` are numbered within the face, from 0.
subroutine slave_tables(layout, knots, nknots, point, weight, npoints, axis, side, gauss, reference, n, &
    nlocal, nelements, nquad, nodes, basis, area)
  use iso_c_binding, only: c_double, c_int
  use isomortar_api_unpack, only: unpack_patch
  use isomortar_contact_slave, only: tables => slave_tables
  use isomortar_nurbs_surface, only: face_of
  implicit none
  integer(c_int), intent(in) :: nknots, npoints, n, nlocal, nelements, nquad
  integer(c_int), intent(in) :: layout(9), axis, side, gauss(2), point(npoints)
  real(c_double), intent(in) :: knots(nknots), weight(npoints), reference(3, n)
  integer(c_int), intent(out) :: nodes(nlocal, nelements)
  real(c_double), intent(out) :: basis(nlocal, nquad), area(nquad)

  call tables(face_of(unpack_patch(layout, knots, point, weight), axis, side), gauss, reference, nodes, basis, area)
  nodes = nodes - 1
end subroutine slave_tables

!> Project every slave quadrature point (isomortar_contact_control). `xi` holds starts where `started` is 1.
subroutine project_points(nodes, basis, area, point, nlocal, nelements, nquad, nslave, kind, knots, nknots, master_point, &
    master_weight, nmaster, x, n, started, origin, had, xi, element, fixed, found, doubt, slip, slips, status, place)
  use iso_c_binding, only: c_double, c_int
  use isomortar_api_unpack, only: unpack_gap_map, unpack_slave
  use isomortar_contact_control, only: project => project_points
  use isomortar_contact_gap_map_map, only: gap_map_t, projections_t
  implicit none
  integer(c_int), intent(in) :: nlocal, nelements, nquad, nslave, nknots, nmaster, n
  integer(c_int), intent(in) :: nodes(nlocal, nelements), point(nslave), kind(11), master_point(nmaster)
  integer(c_int), intent(in) :: started(nquad), had(nquad)
  real(c_double), intent(in) :: basis(nlocal, nquad), area(nquad), knots(nknots), master_weight(nmaster), x(3, n)
  real(c_double), intent(in) :: origin(2, nquad)
  real(c_double), intent(inout) :: xi(2, nquad)
  integer(c_int), intent(out) :: element(2, nquad), fixed(2, nquad), found(nquad), doubt(nquad), slips(nquad)
  real(c_double), intent(out) :: slip(2, nquad)
  integer(c_int), intent(out) :: status, place
  class(gap_map_t), allocatable :: map
  type(projections_t) :: projections

  allocate (projections%place(2, nquad), projections%fixed(2, nquad), projections%found(nquad), projections%doubt(nquad), &
    projections%slip(2, nquad), projections%slips(nquad))
  projections%xi = xi
  projections%place = 0
  projections%fixed = .false.
  projections%found = .false.
  projections%doubt = 0
  call unpack_gap_map(kind, knots, master_point, master_weight, map)
  call project(unpack_slave(nodes, basis, area, point), map, x, &
    started /= 0, origin, had /= 0, projections, status, place)
  xi = projections%xi
  element = projections%place - 1
  fixed = merge(1, 0, projections%fixed)
  found = merge(1, 0, projections%found)
  doubt = projections%doubt
  slip = 0.0_c_double
  slips = 0
  if (status /= 0) return
  slip = projections%slip
  slips = merge(1, 0, projections%slips)
end subroutine project_points

!> Control quantities from projections (isomortar_contact_control).
subroutine control_quantities(nodes, basis, area, point, nlocal, nelements, nquad, nslave, kind, knots, nknots, master_point, &
    master_weight, nmaster, x, n, xi, element, fixed, found, slip, weight, square, gap, control_slip, metric, point_metric)
  use iso_c_binding, only: c_double, c_int
  use isomortar_api_unpack, only: unpack_gap_map, unpack_slave
  use isomortar_contact_control, only: control_t, integrate => control_quantities
  use isomortar_contact_gap_map_map, only: gap_map_t, projections_t
  implicit none
  integer(c_int), intent(in) :: nlocal, nelements, nquad, nslave, nknots, nmaster, n
  integer(c_int), intent(in) :: nodes(nlocal, nelements), point(nslave), kind(11), master_point(nmaster)
  integer(c_int), intent(in) :: element(2, nquad), fixed(2, nquad), found(nquad)
  real(c_double), intent(in) :: basis(nlocal, nquad), area(nquad), knots(nknots), master_weight(nmaster), x(3, n)
  real(c_double), intent(in) :: xi(2, nquad), slip(2, nquad)
  real(c_double), intent(out) :: weight(nslave), square(nslave), gap(nslave), control_slip(2, nslave), metric(3, nslave)
  real(c_double), intent(out) :: point_metric(3, nquad)
  class(gap_map_t), allocatable :: map
  type(projections_t) :: projections
  type(control_t) :: control

  projections%xi = xi
  projections%place = element + 1
  projections%fixed = fixed /= 0
  projections%found = found /= 0
  projections%slip = slip
  allocate (control%weight(nslave), control%square(nslave), control%gap(nslave), control%slip(2, nslave), &
    control%metric(3, nslave), control%point_metric(3, nquad))
  call unpack_gap_map(kind, knots, master_point, master_weight, map)
  call integrate(unpack_slave(nodes, basis, area, point), map, x, projections, &
    control)
  weight = control%weight
  square = control%square
  gap = control%gap
  control_slip = control%slip
  metric = control%metric
  point_metric = control%point_metric
end subroutine control_quantities

!> Control pressures, tractions, states and their slopes of the augmented law (isomortar_contact_augmentation).
!> `friction` and `parameters` name its law of friction (isomortar_contact_friction_table). `field_slip` is the field of control
!> slips at the quadrature points, with `summed` only.
subroutine augmented_multipliers(nodes, basis, area, point, nlocal, nelements, nquad, nslave, weight, square, gap, control_slip, &
    metric, point_metric, summed, penalties, friction, parameters, nparameters, pressure_k, traction_k, slip_margin, forgiving, &
    held, bears, free, pressure, traction, state, pressure_slope, traction_slope, field_slip, status, place)
  use iso_c_binding, only: c_double, c_int
  use isomortar_api_unpack, only: unpack_slave
  use isomortar_contact_augmentation, only: law_t, respond, response_t
  use isomortar_contact_control, only: control_t
  use isomortar_contact_friction_table, only: friction_of
  implicit none
  integer(c_int), intent(in) :: nlocal, nelements, nquad, nslave, friction, nparameters
  integer(c_int), intent(in) :: nodes(nlocal, nelements), point(nslave), summed, forgiving, held(nslave), bears(nslave)
  real(c_double), intent(in) :: basis(nlocal, nquad), area(nquad), weight(nslave), square(nslave), gap(nslave)
  real(c_double), intent(in) :: control_slip(2, nslave), metric(3, nslave), point_metric(3, nquad), penalties(2)
  real(c_double), intent(in) :: parameters(nparameters), pressure_k(nslave), traction_k(2, nslave), slip_margin, free(2, 2, nslave)
  real(c_double), intent(out) :: pressure(nslave), traction(2, nslave), pressure_slope(nslave), traction_slope(2, 6, nslave)
  real(c_double), intent(out) :: field_slip(2, nquad)
  integer(c_int), intent(out) :: state(nslave), status, place
  type(control_t) :: control
  type(law_t) :: law
  type(response_t) :: response

  pressure = 0.0_c_double
  traction = 0.0_c_double
  state = 0
  pressure_slope = 0.0_c_double
  traction_slope = 0.0_c_double
  field_slip = 0.0_c_double
  place = friction
  call friction_of(friction, parameters, law%friction, status)
  if (status /= 0) return
  control%weight = weight
  control%square = square
  control%gap = gap
  control%slip = control_slip
  control%metric = metric
  control%point_metric = point_metric
  law%normal_penalty = penalties(1)
  law%tangential_penalty = penalties(2)
  law%pressure = pressure_k
  law%traction = traction_k
  law%slip_margin = slip_margin
  law%forgiving = forgiving /= 0
  law%held = held /= 0
  law%bears = bears /= 0
  law%free = free
  call respond(unpack_slave(nodes, basis, area, point), control, law, summed /= 0, response, field_slip)
  pressure = response%multipliers%pressure
  traction = response%multipliers%traction
  state = response%state
  pressure_slope = response%pressure_slope
  traction_slope = response%traction_slope
end subroutine augmented_multipliers

!> Largest norms of control tractions that a law of friction (see `augmented_multipliers`) bears under control pressures: 0 where
!> open, and without friction.
subroutine friction_radius(friction, parameters, nparameters, pressure, n, radius, status, place)
  use iso_c_binding, only: c_double, c_int
  use isomortar_contact_friction_law, only: friction_t
  use isomortar_contact_friction_table, only: friction_of
  implicit none
  integer(c_int), intent(in) :: friction, nparameters, n
  real(c_double), intent(in) :: parameters(nparameters), pressure(n)
  real(c_double), intent(out) :: radius(n)
  integer(c_int), intent(out) :: status, place
  class(friction_t), allocatable :: law
  real(c_double) :: slope
  integer :: i

  radius = 0.0_c_double
  place = friction
  call friction_of(friction, parameters, law, status)
  if (status /= 0 .or. .not. allocated(law)) return
  do i = 1, n
    if (.not. pressure(i) <= 0.0_c_double) call law%limit(pressure(i), radius(i), slope)
  end do
end subroutine friction_radius

!> Add contact forces; separately on slave and master control points (isomortar_contact_blocks).
subroutine contact_forces(nodes, basis, area, point, nlocal, nelements, nquad, nslave, kind, knots, nknots, master_point, &
    master_weight, nmaster, x, n, xi, element, fixed, found, with_friction, pressure, traction, state, forces)
  use iso_c_binding, only: c_double, c_int
  use isomortar_api_unpack, only: unpack_gap_map, unpack_slave
  use isomortar_contact_blocks, only: integrate_forces, multipliers_t
  use isomortar_contact_gap_map_map, only: gap_map_t, projections_t
  implicit none
  integer(c_int), intent(in) :: nlocal, nelements, nquad, nslave, nknots, nmaster, n
  integer(c_int), intent(in) :: nodes(nlocal, nelements), point(nslave), kind(11), master_point(nmaster)
  integer(c_int), intent(in) :: element(2, nquad), fixed(2, nquad), found(nquad), with_friction, state(nslave)
  real(c_double), intent(in) :: basis(nlocal, nquad), area(nquad), knots(nknots), master_weight(nmaster), x(3, n)
  real(c_double), intent(in) :: xi(2, nquad), pressure(nslave), traction(2, nslave)
  real(c_double), intent(inout) :: forces(3, n)
  class(gap_map_t), allocatable :: map
  type(projections_t) :: projections

  projections%xi = xi
  projections%place = element + 1
  projections%fixed = fixed /= 0
  projections%found = found /= 0
  call unpack_gap_map(kind, knots, master_point, master_weight, map)
  call integrate_forces(unpack_slave(nodes, basis, area, point), map, x, &
    projections, with_friction /= 0, multipliers_t(pressure, traction, state /= 0), forces)
end subroutine contact_forces

!> Add constraint rows and the geometric tangent (isomortar_contact_blocks).
subroutine contact_blocks(nodes, basis, area, point, nlocal, nelements, nquad, nslave, kind, knots, nknots, master_point, &
    master_weight, nmaster, x, n, xi, element, fixed, found, slips, with_friction, pressure, traction, state, field_slip, &
    row_start, row_column, nrows, nkinds, rows, start, nstart, column, nblocks, tangent, status, place)
  use iso_c_binding, only: c_double, c_int
  use isomortar_api_unpack, only: unpack_gap_map, unpack_pattern, unpack_slave
  use isomortar_contact_blocks, only: integrate_blocks, multipliers_t
  use isomortar_contact_gap_map_map, only: gap_map_t, projections_t
  implicit none
  integer(c_int), intent(in) :: nlocal, nelements, nquad, nslave, nknots, nmaster, n, nrows, nkinds, nstart, nblocks
  integer(c_int), intent(in) :: nodes(nlocal, nelements), point(nslave), kind(11), master_point(nmaster)
  integer(c_int), intent(in) :: element(2, nquad), fixed(2, nquad), found(nquad), slips(nquad), with_friction, state(nslave)
  integer(c_int), intent(in) :: row_start(nslave + 1), row_column(nrows), start(nstart), column(nblocks)
  real(c_double), intent(in) :: basis(nlocal, nquad), area(nquad), knots(nknots), master_weight(nmaster), x(3, n)
  real(c_double), intent(in) :: xi(2, nquad), pressure(nslave), traction(2, nslave), field_slip(2, nquad)
  real(c_double), intent(inout) :: rows(3, nkinds, nrows), tangent(3, 3, nblocks)
  integer(c_int), intent(out) :: status, place
  class(gap_map_t), allocatable :: map
  type(projections_t) :: projections

  projections%xi = xi
  projections%place = element + 1
  projections%fixed = fixed /= 0
  projections%found = found /= 0
  projections%slips = slips /= 0
  call unpack_gap_map(kind, knots, master_point, master_weight, map)
  call integrate_blocks(unpack_slave(nodes, basis, area, point), map, x, &
    projections, with_friction /= 0, multipliers_t(pressure, traction, state /= 0), field_slip, &
    unpack_pattern(row_start, row_column), rows, unpack_pattern(start, column), tangent, status, place)
end subroutine contact_blocks

!> Rows of the multipliers' derivatives of the augmented law (isomortar_contact_augmentation): changes(component, multiplier, block)
!> and of their trial tractions, trial(component, a, block), on the pattern `wide`; it and `neighbours` differ from the rows'
!> pattern with `summed` only. `place` is the row of a pattern that lacks a block, 0 where `wide` has other rows.
subroutine multiplier_rows(nodes, basis, area, point, nlocal, nelements, nquad, nslave, weight, square, control_slip, metric, &
    point_metric, summed, penalties, state, pressure_slope, traction_slope, row_start, row_column, nrows, nkinds, rows, &
    neighbour_start, neighbour_column, nneighbours, wide_start, wide_column, nwide, changes, trial, status, place)
  use iso_c_binding, only: c_double, c_int
  use isomortar_api_unpack, only: unpack_pattern, unpack_slave
  use isomortar_base_status, only: status_ok, status_pattern
  use isomortar_contact_augmentation, only: combine => multiplier_rows, law_t, response_t, trial_rows, trial_rows_summed
  use isomortar_contact_control, only: control_t
  use isomortar_sparse_blocks, only: pattern_t
  implicit none
  integer(c_int), intent(in) :: nlocal, nelements, nquad, nslave, nrows, nkinds, nneighbours, nwide
  integer(c_int), intent(in) :: nodes(nlocal, nelements), point(nslave), summed, state(nslave)
  integer(c_int), intent(in) :: row_start(nslave + 1), row_column(nrows), neighbour_start(nslave + 1), neighbour_column(nneighbours)
  integer(c_int), intent(in) :: wide_start(nslave + 1), wide_column(nwide)
  real(c_double), intent(in) :: basis(nlocal, nquad), area(nquad), weight(nslave), square(nslave)
  real(c_double), intent(in) :: control_slip(2, nslave), metric(3, nslave), point_metric(3, nquad), penalties(2)
  real(c_double), intent(in) :: pressure_slope(nslave), traction_slope(2, 6, nslave), rows(3, nkinds, nrows)
  real(c_double), intent(out) :: changes(3, 3, nwide), trial(3, 2, nwide)
  integer(c_int), intent(out) :: status, place
  type(control_t) :: control
  type(law_t) :: law
  type(response_t) :: response
  type(pattern_t) :: narrow, neighbours, wide

  control%weight = weight
  control%square = square
  control%slip = control_slip
  control%metric = metric
  control%point_metric = point_metric
  law%tangential_penalty = penalties(2)
  response%state = state
  response%pressure_slope = pressure_slope
  response%traction_slope = traction_slope
  changes = 0.0_c_double
  trial = 0.0_c_double
  narrow = unpack_pattern(row_start, row_column)
  neighbours = unpack_pattern(neighbour_start, neighbour_column)
  wide = unpack_pattern(wide_start, wide_column)
  status = status_pattern
  place = 0
  if (summed == 0 .and. any(narrow%start /= wide%start)) return
  if (nkinds > 1 .and. summed /= 0) then
    call trial_rows_summed(unpack_slave(nodes, basis, area, point), control, law, state /= 0, narrow, rows, neighbours, wide, &
      trial, place)
  else if (nkinds > 1) then
    call trial_rows(control, law, state /= 0, narrow, rows, trial)
  end if
  if (place == 0) call combine(control, response, narrow, rows, wide, trial, changes, place)
  status = merge(status_pattern, status_ok, place > 0)
end subroutine multiplier_rows

!> Condense multipliers into the tangent (isomortar_contact_augmentation).
subroutine condense_multipliers(state, nslave, row_start, row_column, nrows, nkinds, rows, wide_start, wide_column, nwide, &
    changes, start, nstart, column, nblocks, tangent, status, place)
  use iso_c_binding, only: c_double, c_int
  use isomortar_api_unpack, only: unpack_pattern
  use isomortar_base_status, only: status_ok, status_pattern
  use isomortar_contact_augmentation, only: condense
  implicit none
  integer(c_int), intent(in) :: nslave, nrows, nkinds, nwide, nstart, nblocks
  integer(c_int), intent(in) :: state(nslave), row_start(nslave + 1), row_column(nrows), wide_start(nslave + 1), wide_column(nwide)
  integer(c_int), intent(in) :: start(nstart), column(nblocks)
  real(c_double), intent(in) :: rows(3, nkinds, nrows), changes(3, 3, nwide)
  real(c_double), intent(inout) :: tangent(3, 3, nblocks)
  integer(c_int), intent(out) :: status, place

  call condense(state /= 0, unpack_pattern(row_start, row_column), rows, unpack_pattern(wide_start, wide_column), changes, &
    unpack_pattern(start, column), tangent, place)
  status = merge(status_pattern, status_ok, place > 0)
end subroutine condense_multipliers
