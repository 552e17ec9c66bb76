!> Search for the place of a surface that is nearest to a point, among those near a start (theory 3.15, 3.16).
!>
!> Each element is searched by Newton's method within its bounds; where the distance still falls across a boundary the search goes
!> on in the neighbour. The distance falls strictly from element to element, so the search ends: inside an element, on a line that
!> neither side improves (a C0 line), at a pole, or on the edge of the patch (no projection). Coordinates across such a line are
!> fixed, and the foot belongs to the lower element, wherever the search came from.
!>
!> - `surface`, `positions` (3, control points): the face; all control points, L.
!> - `x`, `xi`: place of a slave point, L; coordinates, P. `here`: where the search stands. `work`: counts of what is done.
module isomortar_contact_search
  use isomortar_base_algebra, only: cross
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_index, slack, within
  use isomortar_contact_pole, only: look_from_pole, net_about_pole, pole_bound, pole_of, view_t
  use isomortar_contact_work, only: evaluate, work_t
  use isomortar_nurbs_direction, only: element_at, is_kink
  use isomortar_nurbs_surface, only: element_bounds, homogeneous_net, step_across, surface_element_count, surface_point, &
    surface_t
  implicit none
  private

  public :: descend, is_isolated, search_element, start_at

  !> The point has no projection: its nearest point lies on the edge of the patch.
  integer, parameter, public :: projection_outside = 0
  !> An ordinary projection.
  integer, parameter, public :: projection_inside = 1
  !> The search did not settle.
  integer, parameter, public :: projection_lost = -1
  !> The foot does not follow the point: the surface is collapsed there, or places beside the foot are as near.
  integer, parameter, public :: projection_degenerate = -2

  !> Relative size of the last Newton step: its error is the square of that.
  real(wp), parameter :: last_step = epsilon(1.0_wp)**0.6_wp
  !> Squared distances whose ratio is less are the same but for round-off.
  real(wp), parameter :: same_distance = 1.0_wp + 8.0_wp * epsilon(1.0_wp)
  !> Squared length or sine below which two tangents span no surface: a place on a collapsed edge, say.
  real(wp), parameter :: flat_metric = epsilon(1.0_wp)
  !> The same beside a pole, where lengths are exact: what is nearer to it, as the square of a share of the element, is the pole.
  real(wp), parameter :: at_pole = epsilon(1.0_wp)**1.5_wp
  !> Share of the metric below which the distance has no curvature but round-off.
  real(wp), parameter :: flat_distance = epsilon(1.0_wp)**0.75_wp

  !> Where a search stands.
  type, public :: search_t
    integer :: place(2)
    real(wp) :: xi(2)
    !> Coordinates that stay on a C0 line while the point moves.
    logical :: fixed(2)
    integer :: outcome
    !> Half of the squared distance, the way from the point to the surface, and a_1 x a_2 there.
    real(wp) :: distance, way(3), across(3)
    !> For each coordinate -1 or 1 where the distance falls across the lower or upper bound of the element, else 0.
    integer :: pressing(2)
    logical :: settled
    !> Coordinates along which the surface has no length, and whether its tangents are parallel or without length.
    logical :: collapsed(2), degenerate
    !> Hessian of the distance over the metric: its diagonal, and its determinant.
    real(wp) :: bend(2), bend_both
  end type search_t

contains

  !> A search that starts at given coordinates.
  pure function start_at(surface, xi) result(here)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: xi(2)
    type(search_t) :: here

    here%place = [element_at(surface%direction(1), xi(1)), element_at(surface%direction(2), xi(2))]
    here%xi = xi
  end function start_at

  !> From where a search stands to the next place that is nearest to x among those near it (theory 3.1).
  pure subroutine descend(surface, positions, x, here, work)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: positions(:, :), x(3)
    type(search_t), intent(inout) :: here
    type(work_t), intent(inout) :: work
    logical :: left, moved
    integer :: visit

    left = .false.
    call search_element(surface, positions, x, here, work)
    do visit = 1, 8 + 2 * surface_element_count(surface)
      here%outcome = merge(projection_degenerate, projection_lost, here%degenerate)
      here%fixed = .false.
      if (.not. here%settled) return
      if (is_beyond_edge(surface, here)) then
        here%outcome = projection_outside
        return
      end if
      if (here%degenerate) then
        if (.not. collapses(surface, here)) return
        if (.not. left) call leave_pole(surface, positions, x, here, left, work)
        if (.not. here%degenerate) cycle
        call stay_at_pole(surface, positions, x, here, work)
        return
      end if
      here%outcome = projection_inside
      if (all(here%pressing == 0)) return
      call cross_boundary(surface, positions, x, here, moved, work)
      if (.not. moved .and. .not. left) then ! beside a pole round-off may hide that the distance falls farther round it
        call leave_pole(surface, positions, x, here, left, work)
        moved = left
      end if
      if (moved) cycle
      if (any(on_edge(surface, here))) here%outcome = projection_outside
      call settle_on_lines(surface, here)
      return
    end do
    here%outcome = projection_lost
  end subroutine descend

  !> Whether a search has come to a pole.
  pure logical function collapses(surface, here)
    type(surface_t), intent(in) :: surface
    type(search_t), intent(in) :: here
    integer :: pole

    pole = pole_of(surface, here%place, here%xi)
    collapses = pole /= 0
    if (collapses) collapses = here%collapsed(3 - abs(pole))
  end function collapses

  !> Go on from the pole of an element along the line on which the distance falls most, if that ends no farther away.
  pure subroutine leave_pole(surface, positions, x, here, left, work)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: positions(:, :), x(3)
    type(search_t), intent(inout) :: here
    logical, intent(out) :: left
    type(work_t), intent(inout) :: work
    type(search_t) :: there
    type(view_t) :: view
    integer :: pole

    left = .false.
    pole = pole_of(surface, here%place, here%xi)
    if (pole == 0) return
    call look_from_pole(surface, positions, x, pole, view, work)
    if (.not. view%fall > 0.0_wp) return
    there%place = view%place
    there%xi = view%xi
    call search_element(surface, positions, x, there, work)
    left = there%settled .and. .not. there%degenerate .and. there%distance <= here%distance * same_distance
    if (left) here = there
  end subroutine leave_pole

  !> Take the pole of an element for the foot.
  pure subroutine stay_at_pole(surface, positions, x, here, work)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: positions(:, :), x(3)
    type(search_t), intent(inout) :: here
    type(work_t), intent(inout) :: work
    type(view_t) :: view
    integer :: pole

    pole = pole_of(surface, here%place, here%xi)
    call look_from_pole(surface, positions, x, pole, view, work)
    here%place(3 - abs(pole)) = 1
    here%xi(3 - abs(pole)) = surface%direction(3 - abs(pole))%boundary(0)
    here%xi(abs(pole)) = pole_bound(surface, pole)
    here%way = view%centre - x
    here%distance = 0.5_wp * dot_product(here%way, here%way)
    here%across = view%across
    here%outcome = projection_inside
    here%fixed = .true.
    here%pressing = 0
    here%bend = merge(1.0_wp, view%bend, view%vertex)
  end subroutine stay_at_pole

  !> Whether the distance grows from a foot in all directions that are free there (theory 3.18).
  pure logical function is_isolated(here)
    type(search_t), intent(in) :: here

    is_isolated = all(here%bend > flat_distance .or. (here%fixed .and. .not. here%degenerate))
    if (.not. any(here%fixed)) is_isolated = is_isolated .and. here%bend_both > flat_distance
  end function is_isolated

  !> Fix the coordinates that press against a C0 line which neither side improves.
  pure subroutine settle_on_lines(surface, here)
    type(surface_t), intent(in) :: surface
    type(search_t), intent(inout) :: here
    integer :: a, line

    do a = 1, 2
      if (here%pressing(a) == 0) cycle
      line = here%place(a) + min(here%pressing(a), 0)
      if (surface%closed(a) .and. line == 0) line = surface%direction(a)%elements
      if (line == 0 .or. (line == surface%direction(a)%elements .and. .not. surface%closed(a))) cycle
      here%fixed(a) = is_kink(surface%direction(a), line)
      if (.not. here%fixed(a)) cycle
      here%place(a) = line
      here%xi(a) = surface%direction(a)%boundary(line)
    end do
  end subroutine settle_on_lines

  !> Where the search presses against the edge of the patch.
  pure function on_edge(surface, here) result(edge)
    type(surface_t), intent(in) :: surface
    type(search_t), intent(in) :: here
    logical :: edge(2)

    edge = .not. surface%closed .and. &
      ((here%pressing < 0 .and. here%place == 1) .or. (here%pressing > 0 .and. here%place == surface%direction%elements))
  end function on_edge

  !> Whether the search presses against the edge of the patch alone; a pole, round which the surface is closed, is no edge.
  pure logical function is_beyond_edge(surface, here)
    type(surface_t), intent(in) :: surface
    type(search_t), intent(in) :: here

    is_beyond_edge = any(here%pressing /= 0) .and. all(here%pressing == 0 .or. on_edge(surface, here)) &
      .and. .not. any(here%collapsed .and. surface%closed)
  end function is_beyond_edge

  !> Go on in the neighbour across the boundary (the diagonal one first) in which the distance falls further, or, where round-off
  !> hides that, in which the search ends inside.
  pure subroutine cross_boundary(surface, positions, x, here, moved, work)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: positions(:, :), x(3)
    type(search_t), intent(inout) :: here
    logical, intent(out) :: moved
    type(work_t), intent(inout) :: work
    integer, parameter :: mask(2, 3) = reshape([1, 1, 1, 0, 0, 1], [2, 3])
    type(search_t) :: there
    integer :: attempt, step(2)
    logical :: within

    moved = .false.
    do attempt = 1, 3
      step = mask(:, attempt) * merge(0, here%pressing, on_edge(surface, here))
      if (all(step == 0)) cycle
      there = here
      call step_across(surface, step, there%place, there%xi, within)
      call search_element(surface, positions, x, there, work)
      moved = there%distance < here%distance ! where the search there does not settle, the point is lost and not on a line
      if (there%settled .and. all(there%pressing == 0)) moved = there%distance <= here%distance * same_distance
      if (moved) exit
    end do
    if (moved) here = there
  end subroutine cross_boundary

  !> Least distance within one element: Newton's method on the free coordinates, steps kept inside the bounds (theory 3.16).
  pure subroutine search_element(surface, positions, x, here, work)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: positions(:, :), x(3)
    type(search_t), intent(inout) :: here
    type(work_t), intent(inout) :: work
    real(wp) :: net(4, surface%direction(1)%order + 1, surface%direction(2)%order + 1)
    real(wp) :: low(2), high(2), slope(2), hessian(2, 2), metric(2, 2), step(2), target(3), centre(3), lengths(2), flat
    integer :: iteration, pole

    if (contracts) call require(all(is_index(here%place, surface%direction%elements)), "search_element: there is such an element")
    work%elements = work%elements + 1
    call homogeneous_net(surface, positions, here%place, net)
    target = x
    flat = flat_metric
    pole = pole_of(surface, here%place, here%xi)
    if (pole /= 0) then
      call net_about_pole(surface, positions, pole, net, centre)
      target = x - centre
      flat = at_pole
    end if
    call element_bounds(surface, here%place, low, high)
    here%xi = min(max(here%xi, low), high)
    here%settled = .false.
    do iteration = 1, 100
      call distance_derivatives(surface, net, target, flat, high - low, here, slope, hessian, metric)
      call evaluate(2, 1, work)
      call find_pressing(here, slope, metric, low, high)
      step = newton_step(here, slope, hessian, metric)
      if (maxval(abs(step) / (high - low)) > 1.0e-3_wp) then
        call limit_step(surface, here, net, target, slope, low, high, step, work)
      end if
      step = min(max(here%xi + step, low), high) - here%xi
      here%xi = here%xi + step
      if (contracts) call require(all(within(here%xi, low, high, slack)), "search_element: xi is in the element")
      here%settled = all(abs(step) <= last_step * (high - low))
      if (pole /= 0 .and. .not. here%settled) then ! a coordinate is known to round-off of the distance over its length
        lengths = abs(step) * sqrt([metric(1, 1), metric(2, 2)])
        here%settled = all(abs(step) <= last_step * (high - low) .or. lengths <= 4.0_wp * epsilon(1.0_wp) * norm2(here%way))
      end if
      if (here%degenerate) here%settled = all(abs(step) <= sqrt(flat) * (high - low))
      if (here%settled) return
    end do
  end subroutine search_element

  !> Way and distance of a search, the distance's slope and Hessian, and the metric of the surface (theory 3.15).
  pure subroutine distance_derivatives(surface, net, x, flat, span, here, slope, hessian, metric)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: net(:, :, :), x(3), flat, span(2)
    type(search_t), intent(inout) :: here
    real(wp), intent(out) :: slope(2), hessian(2, 2), metric(2, 2)
    real(wp) :: s(3, 6), length(2)

    call surface_point(surface, here%place, net, here%xi, s)
    here%way = s(:, 1) - x
    here%distance = 0.5_wp * dot_product(here%way, here%way)
    here%across = cross(s(:, 2), s(:, 3))
    slope = [dot_product(here%way, s(:, 2)), dot_product(here%way, s(:, 3))]
    metric(1, 1) = dot_product(s(:, 2), s(:, 2))
    metric(1, 2) = dot_product(s(:, 2), s(:, 3))
    metric(2, 1) = metric(1, 2)
    metric(2, 2) = dot_product(s(:, 3), s(:, 3))
    hessian(1, 1) = metric(1, 1) + dot_product(here%way, s(:, 4))
    hessian(1, 2) = metric(1, 2) + dot_product(here%way, s(:, 5))
    hessian(2, 1) = hessian(1, 2)
    hessian(2, 2) = metric(2, 2) + dot_product(here%way, s(:, 6))
    length = [metric(1, 1), metric(2, 2)]
    here%collapsed = .not. length * span**2 > flat * maxval(length * span**2)
    here%degenerate = any(here%collapsed) .or. .not. dot_product(here%across, here%across) > flat_metric * product(length)
    where (here%collapsed) slope = 0.0_wp
    if (here%degenerate) return
    here%bend = [hessian(1, 1), hessian(2, 2)] / length
    here%bend_both = (hessian(1, 1) * hessian(2, 2) - hessian(1, 2)**2) / dot_product(here%across, here%across)
  end subroutine distance_derivatives

  !> Note the bounds across which the distance falls by more than round-off.
  pure subroutine find_pressing(here, slope, metric, low, high)
    type(search_t), intent(inout) :: here
    real(wp), intent(in) :: slope(2), metric(2, 2), low(2), high(2)
    real(wp) :: shift
    integer :: a

    here%pressing = 0
    do a = 1, 2
      shift = 64.0_wp * epsilon(1.0_wp) * (high(a) - low(a)) * metric(a, a)
      if (here%xi(a) <= low(a) .and. slope(a) > shift) here%pressing(a) = -1
      if (here%xi(a) >= high(a) .and. slope(a) < -shift) here%pressing(a) = 1
    end do
  end subroutine find_pressing

  !> Newton's step on the free coordinates; with the metric for Hessian where that is not positive definite (theory 3.15).
  pure function newton_step(here, slope, hessian, metric) result(step)
    type(search_t), intent(in) :: here
    real(wp), intent(in) :: slope(2), hessian(2, 2), metric(2, 2)
    real(wp) :: step(2), m(2, 2)
    logical :: free(2)
    integer :: a

    step = 0.0_wp
    free = here%pressing == 0 .and. .not. here%collapsed
    if (all(free) .and. .not. here%degenerate) then
      m = hessian
      if (m(1, 1) * m(2, 2) - m(1, 2)**2 <= 1.0e-6_wp * metric(1, 1) * metric(2, 2) .or. m(1, 1) + m(2, 2) <= 0.0_wp) m = metric
      step(1) = -(m(2, 2) * slope(1) - m(1, 2) * slope(2))
      step(2) = -(m(1, 1) * slope(2) - m(1, 2) * slope(1))
      step = step / (m(1, 1) * m(2, 2) - m(1, 2)**2)
    else
      do a = 1, 2
        if (free(a)) step(a) = -slope(a) / merge(hessian(a, a), metric(a, a), hessian(a, a) > 1.0e-6_wp * metric(a, a))
      end do
    end if
  end function newton_step

  !> Halve a long step until the distance falls as its slope promises (theory 3.16, Armijo's rule on the bounded step).
  pure subroutine limit_step(surface, here, net, x, slope, low, high, step, work)
    type(surface_t), intent(in) :: surface
    type(search_t), intent(in) :: here
    real(wp), intent(in) :: net(:, :, :), x(3), slope(2), low(2), high(2)
    real(wp), intent(inout) :: step(2)
    type(work_t), intent(inout) :: work
    real(wp) :: d(3), s(3, 6), target(2), promised
    integer :: halving

    do halving = 1, 40
      target = min(max(here%xi + step, low), high)
      call surface_point(surface, here%place, net, target, s)
      call evaluate(2, 1, work)
      d = x - s(:, 1)
      promised = 1.0e-4_wp * dot_product(slope, target - here%xi)
      if (0.5_wp * dot_product(d, d) <= here%distance * same_distance + promised) return
      step = 0.5_wp * step
    end do
  end subroutine limit_step

end module isomortar_contact_search
