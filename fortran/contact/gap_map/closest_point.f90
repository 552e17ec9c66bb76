!> The gap map of the closest point on a face of a deformable body (theory 3): inside the face, on its C0 lines, at its poles.
module isomortar_contact_gap_map_closest_point
  use isomortar_base_algebra, only: first_not_finite, weighted_sums
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: sums_to
  use isomortar_base_status, only: status_degenerate_surface, status_lost_projection, status_no_slip, status_not_finite, &
    status_ok, status_passed_through
  use isomortar_contact_gap_map_kinematics, only: contact_point, first_variations, metric_variation, second_variations
  use isomortar_contact_gap_map_kink_line, only: hold_on_lines
  use isomortar_contact_gap_map_map, only: contact_point_t, for_forces, for_gap, for_tangent, gap_map_t, &
    projections_t
  use isomortar_contact_hulls, only: enclose, hulls_t, within_reach
  use isomortar_contact_pole, only: gather_at_pole, hold_at_pole, is_at_pole, pole_of
  use isomortar_contact_projection, only: find_too_deep, look_round, shallow_depth, start_nearest
  use isomortar_contact_search, only: descend, is_isolated, projection_degenerate, projection_inside, projection_lost, &
    projection_outside, search_t, start_at
  use isomortar_contact_slave, only: slave_position, slave_t
  use isomortar_contact_work, only: count_points, evaluate, gather_work, work_t
  use isomortar_nurbs_surface, only: derivative_columns, shortest_way, surface_basis, surface_nodes, surface_t
  implicit none
  private

  type, extends(gap_map_t), public :: closest_point_t
    type(surface_t) :: surface
    !> The face of the same body across from it: how deep the body is.
    type(surface_t) :: opposite
  contains
    procedure :: bearing
    procedure :: vectors
    procedure :: locate
    procedure :: slip => find_slip
    procedure :: at
    procedure, nopass :: first => first_variations
    procedure, nopass :: metric => metric_variation
    procedure, nopass :: second => second_variations
  end type closest_point_t

contains

  !> Number of control points of an element of the face.
  pure integer function bearing(self)
    class(closest_point_t), intent(in) :: self

    bearing = product(self%surface%direction%order + 1)
  end function bearing

  !> dx - dS, dS,1, dS,2, and dS,11, dS,12, dS,22 for second variations of the slip.
  pure integer function vectors(self, wanted)
    class(closest_point_t), intent(in) :: self
    integer, intent(in) :: wanted

    vectors = merge(6, 3, wanted == for_tangent)
  end function vectors

  !> Project all points, element by element, all threads (theory 3.1). Where several fail the first element is told.
  subroutine locate(self, slave, positions, started, had, projections, status, place, work)
    class(closest_point_t), intent(in) :: self
    type(slave_t), intent(in) :: slave
    real(wp), intent(in) :: positions(:, :)
    logical, intent(in) :: started(:), had(:)
    type(projections_t), intent(inout) :: projections
    integer, intent(out) :: status, place
    type(work_t), intent(inout) :: work
    type(hulls_t) :: hulls
    type(work_t), allocatable :: works(:)
    integer, allocatable :: places(:), statuses(:)
    real(wp) :: shallow
    integer :: e, elements

    place = first_not_finite(positions, self%surface%point)
    status = merge(status_not_finite, status_ok, place > 0)
    if (status /= status_ok) return
    call enclose(self%surface, positions, hulls)
    shallow = shallow_depth(self%surface, self%opposite, positions)
    elements = size(slave%area) / slave%per_element
    allocate (places(elements), statuses(elements), works(elements))
    !$omp parallel do default(none) shared(self, slave, hulls, positions, started, had, shallow, projections) &
    !$omp shared(elements, places, statuses, works) schedule(dynamic)
    do e = 1, elements
      call project_element(self, slave, hulls, positions, started, had, shallow, slave%per_element * (e - 1), projections, &
        statuses(e), places(e), works(e))
    end do
    !$omp end parallel do
    call gather_work(works, work)
    e = findloc(statuses /= status_ok, .true., dim=1)
    if (e == 0) return
    status = statuses(e)
    place = places(e)
  end subroutine locate

  !> Project the quadrature points of a slave element, which are near each other: those after number `before` (theory 3.19).
  pure subroutine project_element(self, slave, hulls, positions, started, had, shallow, before, projections, status, place, &
      work)
    class(closest_point_t), intent(in) :: self
    type(slave_t), intent(in) :: slave
    type(hulls_t), intent(in) :: hulls
    real(wp), intent(in) :: positions(:, :), shallow
    logical, intent(in) :: started(:), had(:)
    integer, intent(in) :: before
    type(projections_t), intent(inout) :: projections
    integer, intent(out) :: status, place
    type(work_t), intent(inout) :: work
    type(search_t) :: here(slave%per_element)
    real(wp) :: x(3, size(here)), middle(3), reach
    type(contact_point_t) :: point
    integer, allocatable :: list(:)
    integer :: doubt, near, points(self%bearing()), q
    real(wp) :: coefficients(size(points), self%vectors(for_forces))
    logical :: deep

    status = status_ok
    place = 0
    call count_points(size(here), work)
    work%warm = work%warm + count(started(before + 1:before + size(here)))
    work%cold = work%cold + count(.not. started(before + 1:before + size(here)))
    do q = 1, size(here)
      x(:, q) = slave_position(slave, positions, before + q)
      here(q) = start_at(self%surface, projections%xi(:, before + q))
      if (.not. started(before + q)) here(q) = start_nearest(self%surface, hulls, x(:, q))
      call descend(self%surface, positions, x(:, q), here(q), work)
    end do
    middle = sum(x, 2) / size(here)
    reach = maxval(norm2(x - spread(middle, 2, size(here)), 1) + sqrt(2.0_wp * here%distance))
    allocate (list(size(hulls%radius)))
    call within_reach(hulls, middle, reach, list, near)
    do q = 1, size(here)
      call look_round(self%surface, hulls, positions, x(:, q), list(:near), here(q), work)
      doubt = status_ok
      if (here(q)%outcome == projection_inside .and. .not. is_isolated(here(q))) doubt = status_degenerate_surface
      if (here(q)%outcome == projection_lost) doubt = status_lost_projection
      if (contracts) call require(here(q)%outcome /= projection_inside .or. here(q)%settled, "project_element: a foot has settled")
      if (doubt /= status_ok) here(q)%outcome = projection_inside
      if (here(q)%outcome == projection_degenerate) then
        status = status_degenerate_surface
        place = before + q
        return
      end if
      if (here(q)%outcome == projection_inside .and. 2.0_wp * here(q)%distance > shallow**2) then
        call find_too_deep(self%surface, self%opposite, positions, here(q), deep, work)
        if (deep) here(q)%outcome = projection_outside
        if (here(q)%outcome == projection_outside .and. had(before + q)) then
          status = status_passed_through
          place = before + q
          return
        end if
      end if
      projections%xi(:, before + q) = here(q)%xi
      projections%place(:, before + q) = here(q)%place
      projections%fixed(:, before + q) = here(q)%fixed
      projections%found(before + q) = here(q)%outcome == projection_inside
      projections%doubt(before + q) = merge(doubt, status_ok, projections%found(before + q))
      if (projections%found(before + q) .and. doubt == status_ok .and. any(here(q)%fixed)) then
        call self%at(slave, positions, projections, before + q, for_forces, point, points, coefficients, work)
        if (.not. point%slips) projections%doubt(before + q) = status_no_slip
      end if
    end do
  end subroutine project_element

  !> The difference of the coordinates, the shortest way round a closed face (theory 3.20).
  pure subroutine find_slip(self, slave, positions, projections, q, slip, work)
    class(closest_point_t), intent(in) :: self
    type(slave_t), intent(in) :: slave
    real(wp), intent(in) :: positions(:, :)
    type(projections_t), intent(in) :: projections
    integer, intent(in) :: q
    real(wp), intent(out) :: slip(2)
    type(work_t), intent(inout) :: work

    slip = shortest_way(self%surface, projections%xi(:, q) - projections%origin(:, q))
  end subroutine find_slip

  !> Kinematics of a foot inside an element, on C0 lines or at a pole (theory 3.2, 3.3, 3.11).
  pure subroutine at(self, slave, positions, projections, q, wanted, point, points, coefficients, work)
    class(closest_point_t), intent(in) :: self
    type(slave_t), intent(in) :: slave
    real(wp), intent(in) :: positions(:, :)
    type(projections_t), intent(in) :: projections
    integer, intent(in) :: q, wanted
    type(contact_point_t), intent(out) :: point
    integer, intent(out) :: points(:)
    real(wp), intent(out) :: coefficients(:, :)
    type(work_t), intent(inout) :: work
    integer :: nodes(size(points)), pole
    real(wp) :: functions(size(points), derivative_columns(wanted)), x(3)

    if (contracts) call require(projections%found(q), "at: the point has a foot")
    if (contracts) call require(all(shape(coefficients) == [self%bearing(), self%vectors(wanted)]), "at: there is room")
    x = slave_position(slave, positions, q)
    associate (surface => self%surface, place => projections%place(:, q), xi => projections%xi(:, q))
      call surface_nodes(surface, place, nodes)
      call surface_basis(surface, place, nodes, xi, wanted, functions)
      call evaluate(wanted, 1, work)
      pole = pole_of(surface, place, xi)
      if (pole /= 0) call gather_at_pole(surface, pole, functions)
      points = surface%point(nodes)
      coefficients(:, 1) = -functions(:, 1)
      coefficients(:, 2:) = functions(:, 2:size(coefficients, 2))
      if (contracts) call require(sums_to(coefficients(:, 1), -1.0_wp), "at: the foot moves with the master")
      if (is_at_pole(surface, place, xi)) then
        call hold_at_pole(surface, positions, x, pole, point, work)
        return
      end if
      point = contact_point(x, weighted_sums(positions, points, functions), surface%outward)
      if (any(projections%fixed(:, q))) call hold_on_lines(surface, positions, x, xi, place, projections%fixed(:, q), point, work)
    end associate
  end subroutine at

end module isomortar_contact_gap_map_closest_point
