! What Python sees of contact. Numbers of control points, elements and blocks count from 0 outside and from 1 inside. Shapes stand
! in the declarations; units are made of length L, force F and the parameter of a surface (of a plane: length) P. What means the
! same in all routines:
!
! - `slave`, `map`, `friction`: handles (isomortar_api_descriptors) of a slave side, of its master's gap map, of a law of friction.
! - `patch`, `axis`, `side`: handle of a patch, axis across a face of it (1..3), end of the axis where the face is (0, 1).
! - `n`, `nquad`, `ntest`: numbers of control points, of quadrature points of the slave, of its test functions.
! - `x`, `reference`: positions of all control points, now and in the reference configuration, L.
! - `xi`, `element`: coordinates of the feet on the master, P, and their elements by direction.
! - `fixed`, `found`: 1 for coordinates that stay while the point moves (on C0 lines); for points that have a foot.
! - `origin`, `slip`: feet at the last converged load step, from where slips count; slips since then, both P.
! - `slips`: 1 for points whose slip counts: they have a foot, and had one.
! - `weight`, `square`: <R> and <R R>, L^2. `gap`: <R g>, L^3. `control_slip`: <R slip>, P L^2.
! - `metric`, `point_metric`: <R R a_ab>, and a_ab at the points, as 11, 12, 22: L^4/P^2, L^2/P^2.
! - `penalties`: normal and tangential, F/L^3.
! - `pressure`, `traction`: control pressures, F/L^2, and covariant tractions, F/(L P).
! - `state`: of control points: 0 open, 1 stick, 2 slip.
! - `pressure_slope`, `traction_slope`: derivatives of these by <R g>; by pressure, trial traction (2) and metric (3).
! - `field_slip`: field of control slips at the points, P; zero but with the paper's slip sum.
! - `row_pattern`, `pattern`, `wide`: handles of the patterns of constraint rows, of the tangent, of the multipliers' derivatives.
! - `nrows`, `nblocks`, `nwide`: blocks of these patterns. `nkinds`: kinds of rows (isomortar_contact_rows).
! - `rows`, `tangent`: constraint rows (component, kind, block), and the tangent, F/L, (column component, row component, block).
! - `changes`: derivatives of p, t_1, t_2 by positions: (component, multiplier, block).
! - `with_friction`: 1 where tractions may act.
! - `counts`: of what is done (isomortar_contact_work), to which those of the call are added; there are `ncounts`.
! - `status`, `place`: how it ended (isomortar_base_status), and where on failure, from 1; 0: nowhere.

!> Functions, their derivatives and reference areas at the quadrature points of a face of a patch, by the axis across it (1..3) and
!> its end there (0, 1) (isomortar_contact_slave).
!>
!> - `gauss`: quadrature points of an element by direction.
!> - `nlocal`, `nelements`: functions of an element, elements of the face.
!> - `nodes`: control points of each element, numbered within the face.
!> - `values`, `slopes`: functions, and their derivatives by the coordinates, 1/P.
!> - `area`: quadrature weight times reference area, L^2.
subroutine slave_tables(patch, axis, side, gauss, reference, n, nlocal, nelements, nquad, nodes, values, slopes, area, status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_api_descriptors, only: find
  use isomortar_contact_slave, only: tables => slave_tables
  use isomortar_nurbs_patch, only: patch_t
  use isomortar_nurbs_surface, only: face_of
  implicit none
  integer(c_int64_t), intent(in) :: patch
  integer(c_int), intent(in) :: n, nlocal, nelements, nquad, axis, side, gauss(2)
  real(c_double), intent(in) :: reference(3, n)
  integer(c_int), intent(out) :: nodes(nlocal, nelements), status
  real(c_double), intent(out) :: values(nlocal, nquad), slopes(nlocal, 2, nquad), area(nquad)
  type(patch_t), pointer :: body

  status = 0
  call find(patch, body, status)
  if (status /= 0) return
  call tables(face_of(body, axis, side), gauss, reference, nodes, values, slopes, area)
  nodes = nodes - 1
end subroutine slave_tables

!> Project every slave quadrature point (isomortar_contact_control). `xi` holds starts at first.
!>
!> - `started`, `had`: 1 where `xi` is a start; where there was a foot at the last converged load step.
!> - `doubt`: of points with a foot that does not follow them: the status that says why; else 0.
subroutine project_points(slave, map, x, n, started, origin, had, nquad, with_friction, counts, ncounts, xi, element, fixed, &
    found, doubt, slip, slips, status, place)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_api_descriptors, only: find
  use isomortar_contact_control, only: project => project_points
  use isomortar_contact_gap_map_map, only: gap_map_t, projections_at, projections_t
  use isomortar_contact_slave, only: slave_t
  use isomortar_contact_work, only: add_work, work_t
  implicit none
  integer(c_int64_t), intent(in) :: slave, map
  integer(c_int), intent(in) :: n, nquad, started(nquad), had(nquad), with_friction, ncounts
  integer(c_int64_t), intent(inout) :: counts(ncounts)
  real(c_double), intent(in) :: x(3, n), origin(2, nquad)
  real(c_double), intent(inout) :: xi(2, nquad)
  integer(c_int), intent(out) :: element(2, nquad), fixed(2, nquad), found(nquad), doubt(nquad), slips(nquad), status, place
  real(c_double), intent(out) :: slip(2, nquad)
  type(slave_t), pointer :: side
  class(gap_map_t), pointer :: onto
  type(projections_t) :: projections
  type(work_t) :: work

  status = 0
  place = 0
  call find(slave, side, status)
  call find(map, onto, status)
  if (status /= 0) return
  projections = projections_at(xi)
  call project(side, onto, x, started /= 0, origin, had /= 0, with_friction /= 0, projections, status, place, work)
  call add_work(work, counts)
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
subroutine control_quantities(slave, map, x, n, xi, element, fixed, found, slip, nquad, ntest, with_friction, counts, ncounts, &
    weight, square, gap, control_slip, metric, point_metric, status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_api_descriptors, only: find
  use isomortar_contact_control, only: control_t, integrate => control_quantities
  use isomortar_contact_gap_map_map, only: gap_map_t, projections_t
  use isomortar_contact_slave, only: slave_t
  use isomortar_contact_work, only: add_work, work_t
  implicit none
  integer(c_int64_t), intent(in) :: slave, map
  integer(c_int), intent(in) :: n, nquad, ntest, element(2, nquad), fixed(2, nquad), found(nquad), with_friction, ncounts
  integer(c_int64_t), intent(inout) :: counts(ncounts)
  real(c_double), intent(in) :: x(3, n), xi(2, nquad), slip(2, nquad)
  real(c_double), intent(out) :: weight(ntest), square(ntest), gap(ntest), control_slip(2, ntest), metric(3, ntest)
  real(c_double), intent(out) :: point_metric(3, nquad)
  integer(c_int), intent(out) :: status
  type(slave_t), pointer :: side
  class(gap_map_t), pointer :: onto
  type(projections_t) :: projections
  type(control_t) :: control
  type(work_t) :: work

  status = 0
  call find(slave, side, status)
  call find(map, onto, status)
  if (status /= 0) return
  projections%xi = xi
  projections%place = element + 1
  projections%fixed = fixed /= 0
  projections%found = found /= 0
  projections%slip = slip
  allocate (control%weight(ntest), control%square(ntest), control%gap(ntest), control%slip(2, ntest), control%metric(3, ntest), &
    control%point_metric(3, nquad))
  call integrate(side, onto, x, projections, with_friction /= 0, control, work)
  call add_work(work, counts)
  weight = control%weight
  square = control%square
  gap = control%gap
  control_slip = control%slip
  metric = control%metric
  point_metric = control%point_metric
end subroutine control_quantities

!> How far the foot of every slave quadrature point has climbed since the last converged load step (isomortar_contact_control).
!>
!> - `climbs`: these distances, L; 0 where the slip does not count.
subroutine find_climbs(map, x, n, xi, origin, slips, nquad, counts, ncounts, climbs, status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_api_descriptors, only: find
  use isomortar_contact_control, only: climb => find_climbs
  use isomortar_contact_gap_map_map, only: gap_map_t, projections_t
  use isomortar_contact_work, only: add_work, work_t
  implicit none
  integer(c_int64_t), intent(in) :: map
  integer(c_int), intent(in) :: n, nquad, slips(nquad), ncounts
  integer(c_int64_t), intent(inout) :: counts(ncounts)
  real(c_double), intent(in) :: x(3, n), xi(2, nquad), origin(2, nquad)
  real(c_double), intent(out) :: climbs(nquad)
  integer(c_int), intent(out) :: status
  class(gap_map_t), pointer :: onto
  type(projections_t) :: projections
  type(work_t) :: work

  climbs = 0.0_c_double
  status = 0
  call find(map, onto, status)
  if (status /= 0) return
  projections%xi = xi
  projections%origin = origin
  projections%slips = slips /= 0
  call climb(onto, x, projections, climbs, work)
  call add_work(work, counts)
end subroutine find_climbs

!> Control pressures, tractions, states and their slopes of the augmented law (isomortar_contact_augmentation).
!>
!> - `summed`: 1 for the paper's slip sum, 0 for the local one.
!> - `pressure_k`, `traction_k`: multipliers of the current augmentation.
!> - `slip_margin`: trials above 1 less this share of what friction bears slip.
!> - `forgiving`: 1 to take the current traction for the radial part of the slip derivative (theory 4.14).
!> - `held`, `bears`: 1 for control points that stick whatever their trial; that supports do not hold along the normal.
!> - `free`: projection of covariant tractions that leaves nothing along what supports hold.
!> - `elastic`: 1 for elastic slip: `traction_k` are stretches, L/P, and the tangential penalty is one over the largest elastic
!>   slip, 1/L.
!> - `smoothing`: pressure times distance of smooth contact (theory 4.18), 0 for none.
subroutine augmented_multipliers(slave, friction, weight, square, gap, control_slip, metric, point_metric, nquad, ntest, summed, &
    penalties, pressure_k, traction_k, slip_margin, forgiving, held, bears, free, elastic, smoothing, pressure, traction, state, &
    pressure_slope, traction_slope, field_slip, status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_api_descriptors, only: find
  use isomortar_contact_augmentation, only: law_t, respond, response_t
  use isomortar_contact_control, only: control_t
  use isomortar_contact_friction_law, only: friction_t
  use isomortar_contact_slave, only: slave_t
  implicit none
  integer(c_int64_t), intent(in) :: slave, friction
  integer(c_int), intent(in) :: nquad, ntest, summed, forgiving, held(ntest), bears(ntest), elastic
  real(c_double), intent(in) :: weight(ntest), square(ntest), gap(ntest), control_slip(2, ntest), metric(3, ntest)
  real(c_double), intent(in) :: point_metric(3, nquad), penalties(2), pressure_k(ntest), traction_k(2, ntest), slip_margin
  real(c_double), intent(in) :: smoothing
  real(c_double), intent(in) :: free(2, 2, ntest)
  real(c_double), intent(out) :: pressure(ntest), traction(2, ntest), pressure_slope(ntest), traction_slope(2, 6, ntest)
  real(c_double), intent(out) :: field_slip(2, nquad)
  integer(c_int), intent(out) :: state(ntest), status
  type(slave_t), pointer :: side
  class(friction_t), pointer :: rubs
  type(control_t) :: control
  type(law_t) :: law
  type(response_t) :: response

  status = 0
  call find(slave, side, status)
  call find(friction, rubs, status)
  if (status /= 0) return
  control%weight = weight
  control%square = square
  control%gap = gap
  control%slip = control_slip
  control%metric = metric
  control%point_metric = point_metric
  if (associated(rubs)) allocate (law%friction, source=rubs)
  law%normal_penalty = penalties(1)
  law%tangential_penalty = penalties(2)
  law%pressure = pressure_k
  law%traction = traction_k
  law%slip_margin = slip_margin
  law%forgiving = forgiving /= 0
  law%held = held /= 0
  law%bears = bears /= 0
  law%free = free
  law%elastic = elastic /= 0
  law%smoothing = smoothing
  call respond(side, control, law, summed /= 0, response, field_slip)
  pressure = response%multipliers%pressure
  traction = response%multipliers%traction
  state = response%state
  pressure_slope = response%pressure_slope
  traction_slope = response%traction_slope
end subroutine augmented_multipliers

!> Largest norms of control tractions that a law of friction bears under control pressures.
!>
!> - `radius`: these norms, F/L^2: 0 where open, and without friction. `n` is their number.
subroutine friction_radius(friction, pressure, n, radius, status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_api_descriptors, only: find
  use isomortar_contact_friction_law, only: friction_t
  implicit none
  integer(c_int64_t), intent(in) :: friction
  integer(c_int), intent(in) :: n
  real(c_double), intent(in) :: pressure(n)
  real(c_double), intent(out) :: radius(n)
  integer(c_int), intent(out) :: status
  class(friction_t), pointer :: law
  real(c_double) :: slope
  integer :: i

  radius = 0.0_c_double
  status = 0
  call find(friction, law, status)
  if (.not. associated(law)) return
  do i = 1, n
    if (.not. pressure(i) <= 0.0_c_double) call law%limit(pressure(i), radius(i), slope)
  end do
end subroutine friction_radius

!> Add contact forces on slave and master control points (isomortar_contact_blocks).
!>
!> - `forces`: on all control points, F.
subroutine contact_forces(slave, map, x, n, xi, element, fixed, found, nquad, with_friction, pressure, traction, state, ntest, &
    counts, ncounts, forces, status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_api_descriptors, only: find
  use isomortar_contact_blocks, only: integrate_forces
  use isomortar_contact_gap_map_map, only: gap_map_t, projections_t
  use isomortar_contact_sample, only: multipliers_t
  use isomortar_contact_slave, only: slave_t
  use isomortar_contact_work, only: add_work, work_t
  implicit none
  integer(c_int64_t), intent(in) :: slave, map
  integer(c_int), intent(in) :: n, nquad, ntest, element(2, nquad), fixed(2, nquad), found(nquad), with_friction, state(ntest)
  integer(c_int), intent(in) :: ncounts
  integer(c_int64_t), intent(inout) :: counts(ncounts)
  real(c_double), intent(in) :: x(3, n), xi(2, nquad), pressure(ntest), traction(2, ntest)
  real(c_double), intent(inout) :: forces(3, n)
  integer(c_int), intent(out) :: status
  type(slave_t), pointer :: side
  class(gap_map_t), pointer :: onto
  type(projections_t) :: projections
  type(work_t) :: work

  status = 0
  call find(slave, side, status)
  call find(map, onto, status)
  if (status /= 0) return
  projections%xi = xi
  projections%place = element + 1
  projections%fixed = fixed /= 0
  projections%found = found /= 0
  call integrate_forces(side, onto, x, projections, with_friction /= 0, multipliers_t(pressure, traction, state /= 0), forces, work)
  call add_work(work, counts)
end subroutine contact_forces

!> Add constraint rows and the geometric tangent (isomortar_contact_blocks).
subroutine contact_blocks(slave, map, x, n, xi, element, fixed, found, origin, slips, nquad, with_friction, pressure, traction, &
    state, ntest, field_slip, row_pattern, nrows, nkinds, rows, pattern, nblocks, tangent, counts, ncounts, status, place)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_api_descriptors, only: find
  use isomortar_contact_blocks, only: integrate_blocks
  use isomortar_contact_gap_map_map, only: gap_map_t, projections_t
  use isomortar_contact_sample, only: multipliers_t
  use isomortar_contact_slave, only: slave_t
  use isomortar_contact_work, only: add_work, work_t
  use isomortar_sparse_blocks, only: pattern_t
  implicit none
  integer(c_int64_t), intent(in) :: slave, map, row_pattern, pattern
  integer(c_int), intent(in) :: n, nquad, ntest, nrows, nkinds, nblocks, ncounts
  integer(c_int64_t), intent(inout) :: counts(ncounts)
  integer(c_int), intent(in) :: element(2, nquad), fixed(2, nquad), found(nquad), slips(nquad), with_friction, state(ntest)
  real(c_double), intent(in) :: x(3, n), xi(2, nquad), origin(2, nquad), field_slip(2, nquad)
  real(c_double), intent(in) :: pressure(ntest), traction(2, ntest)
  real(c_double), intent(inout) :: rows(3, nkinds, nrows), tangent(3, 3, nblocks)
  integer(c_int), intent(out) :: status, place
  type(slave_t), pointer :: side
  class(gap_map_t), pointer :: onto
  type(pattern_t), pointer :: of_rows, of_tangent
  type(projections_t) :: projections
  type(work_t) :: work

  status = 0
  place = 0
  call find(slave, side, status)
  call find(map, onto, status)
  call find(row_pattern, of_rows, status)
  call find(pattern, of_tangent, status)
  if (status /= 0) return
  projections%xi = xi
  projections%place = element + 1
  projections%fixed = fixed /= 0
  projections%found = found /= 0
  projections%origin = origin
  projections%slips = slips /= 0
  call integrate_blocks(side, onto, x, projections, with_friction /= 0, multipliers_t(pressure, traction, state /= 0), field_slip, &
    of_rows, rows, of_tangent, tangent, status, place, work)
  call add_work(work, counts)
end subroutine contact_blocks

!> Rows of the multipliers' derivatives of the augmented law (isomortar_contact_augmentation), on the pattern `wide`, which differs
!> from that of `rows` with the paper's slip sum only. `place` is the row of a pattern that lacks a block, 0 where `wide` has other
!> rows.
!>
!> - `neighbours`: handle of the pattern of test functions that overlap.
!> - `trial`: derivatives of the trial tractions by positions: (component, a, block).
subroutine multiplier_rows(slave, weight, square, control_slip, metric, point_metric, nquad, ntest, penalties, state, &
    pressure_slope, traction_slope, row_pattern, nrows, nkinds, rows, neighbours, wide, nwide, changes, trial, status, place)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_api_descriptors, only: find
  use isomortar_base_status, only: status_ok, status_pattern
  use isomortar_contact_augmentation, only: law_t, make_rows => multiplier_rows, response_t
  use isomortar_contact_control, only: control_t
  use isomortar_contact_rows, only: rows_of, rows_t
  use isomortar_contact_slave, only: slave_t
  use isomortar_sparse_blocks, only: pattern_t
  implicit none
  integer(c_int64_t), intent(in) :: slave, row_pattern, neighbours, wide
  integer(c_int), intent(in) :: nquad, ntest, nrows, nkinds, nwide, state(ntest)
  real(c_double), intent(in) :: weight(ntest), square(ntest), control_slip(2, ntest), metric(3, ntest), point_metric(3, nquad)
  real(c_double), intent(in) :: penalties(2), pressure_slope(ntest), traction_slope(2, 6, ntest), rows(3, nkinds, nrows)
  real(c_double), intent(out) :: changes(3, 3, nwide), trial(3, 2, nwide)
  integer(c_int), intent(out) :: status, place
  type(slave_t), pointer :: side
  type(pattern_t), pointer :: of_neighbours, of_rows, of_trial
  type(control_t) :: control
  type(law_t) :: law
  type(response_t) :: response
  type(rows_t) :: there

  status = status_ok
  place = 0
  changes = 0.0_c_double
  trial = 0.0_c_double
  call find(slave, side, status)
  call find(row_pattern, of_rows, status)
  call find(neighbours, of_neighbours, status)
  call find(wide, of_trial, status)
  if (status /= status_ok) return
  control%weight = weight
  control%square = square
  control%slip = control_slip
  control%metric = metric
  control%point_metric = point_metric
  law%tangential_penalty = penalties(2)
  response%state = state
  response%pressure_slope = pressure_slope
  response%traction_slope = traction_slope
  there = rows_of(nkinds)
  status = status_pattern
  if (.not. there%slip_sum .and. any(of_rows%start /= of_trial%start)) return
  call make_rows(side, control, law, response, of_rows, rows, of_neighbours, of_trial, trial, changes, place)
  status = merge(status_pattern, status_ok, place > 0)
end subroutine multiplier_rows

!> Condense multipliers into the tangent (isomortar_contact_augmentation).
subroutine condense_multipliers(state, ntest, row_pattern, nrows, nkinds, rows, wide, nwide, changes, pattern, nblocks, tangent, &
    status, place)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_api_descriptors, only: find
  use isomortar_base_status, only: status_ok, status_pattern
  use isomortar_contact_augmentation, only: condense
  use isomortar_sparse_blocks, only: pattern_t
  implicit none
  integer(c_int64_t), intent(in) :: row_pattern, wide, pattern
  integer(c_int), intent(in) :: ntest, nrows, nkinds, nwide, nblocks, state(ntest)
  real(c_double), intent(in) :: rows(3, nkinds, nrows), changes(3, 3, nwide)
  real(c_double), intent(inout) :: tangent(3, 3, nblocks)
  integer(c_int), intent(out) :: status, place
  type(pattern_t), pointer :: of_changes, of_rows, of_tangent

  status = status_ok
  place = 0
  call find(row_pattern, of_rows, status)
  call find(wide, of_changes, status)
  call find(pattern, of_tangent, status)
  if (status /= status_ok) return
  call condense(state /= 0, of_rows, rows, of_changes, changes, of_tangent, tangent, place)
  status = merge(status_pattern, status_ok, place > 0)
end subroutine condense_multipliers
