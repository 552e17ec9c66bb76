!> Closest-point projection onto a surface, element by element, from any start.
!>
!> Each element is searched by Newton's method within its bounds; where the distance still falls across a boundary the
!> search goes on in the neighbour. The distance falls strictly from element to element, so the search ends: inside an
!> element, on a line that neither side improves (a C0 line), or on the edge of the patch (no projection).
!> Coordinates across such a line are fixed, and the foot belongs to the lower element, wherever the search came from.
module isomortar_contact_projection
  use isomortar_base_kinds, only: wp
  use isomortar_nurbs_direction, only: element_at, is_kink
  use isomortar_nurbs_surface, only: derivative_columns, step_across, surface_basis, surface_element_count, &
    surface_element_of, surface_nodes, surface_t
  implicit none
  private

  public :: nearest_start, project, sample_surface

  !> The point has no projection: its nearest point lies on the edge of the patch.
  integer, parameter, public :: projection_outside = 0
  !> An ordinary projection.
  integer, parameter, public :: projection_inside = 1
  !> The search did not settle.
  integer, parameter, public :: projection_lost = -1

  !> Relative size of the last Newton step: its error is the square of that.
  real(wp), parameter :: last_step = epsilon(1.0_wp)**0.6_wp
  !> Squared distances whose ratio is less are the same but for round-off.
  real(wp), parameter :: same_distance = 1.0_wp + 8.0_wp * epsilon(1.0_wp)

  !> Where a search stands.
  type :: search_t
    integer :: place(2)
    real(wp) :: xi(2)
    !> Half of the squared distance.
    real(wp) :: distance
    !> For each coordinate -1 or 1 where the distance falls across the lower or upper bound of the element, else 0.
    integer :: pressing(2)
    logical :: settled
  end type search_t

contains

  !> Project x from coordinates `xi`, which are replaced by the result; `place` is its element by direction, and `fixed` says
  !> which coordinates stay on a C0 line while x moves.
  pure subroutine project(surface, positions, x, xi, place, fixed, outcome)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: positions(:, :), x(3)
    real(wp), intent(inout) :: xi(2)
    integer, intent(out) :: place(2), outcome
    logical, intent(out) :: fixed(2)
    type(search_t) :: here
    logical :: moved
    integer :: visit

    here%place = [element_at(surface%direction(1), xi(1)), element_at(surface%direction(2), xi(2))]
    here%xi = xi
    call search_element(surface, positions, x, here)
    fixed = .false.
    outcome = projection_lost
    do visit = 1, 8 + 2 * surface_element_count(surface)
      if (.not. here%settled) return
      xi = here%xi
      place = here%place
      outcome = projection_inside
      if (all(here%pressing == 0)) return
      if (all(here%pressing == 0 .or. on_edge(surface, here))) then
        outcome = projection_outside
        return
      end if
      call cross_boundary(surface, positions, x, here, moved)
      if (.not. moved) then
        if (any(on_edge(surface, here))) outcome = projection_outside
        call settle_on_lines(surface, here%pressing, xi, place, fixed)
        return
      end if
      outcome = projection_lost
    end do
  end subroutine project

  !> Fix the coordinates that press against a C0 line which neither side improves.
  pure subroutine settle_on_lines(surface, pressing, xi, place, fixed)
    type(surface_t), intent(in) :: surface
    integer, intent(in) :: pressing(2)
    real(wp), intent(inout) :: xi(2)
    integer, intent(inout) :: place(2)
    logical, intent(inout) :: fixed(2)
    integer :: a, line

    do a = 1, 2
      if (pressing(a) == 0) cycle
      line = place(a) + min(pressing(a), 0)
      if (surface%closed(a) .and. line == 0) line = surface%direction(a)%elements
      if (line == 0 .or. (line == surface%direction(a)%elements .and. .not. surface%closed(a))) cycle
      fixed(a) = is_kink(surface%direction(a), line)
      if (.not. fixed(a)) cycle
      place(a) = line
      xi(a) = surface%direction(a)%boundary(line)
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

  !> Go on in the neighbour across the boundary (the diagonal one first) in which the distance falls further, or, where round-off
  !> hides that, in which the search ends inside.
  pure subroutine cross_boundary(surface, positions, x, here, moved)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: positions(:, :), x(3)
    type(search_t), intent(inout) :: here
    logical, intent(out) :: moved
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
      call search_element(surface, positions, x, there)
      moved = there%distance < here%distance ! where the search there does not settle, the point is lost and not on a line
      if (there%settled .and. all(there%pressing == 0)) moved = there%distance <= here%distance * same_distance
      if (moved) exit
    end do
    if (moved) here = there
  end subroutine cross_boundary

  !> Least distance within one element: Newton's method on the free coordinates, steps kept inside the bounds.
  pure subroutine search_element(surface, positions, x, here)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: positions(:, :), x(3)
    type(search_t), intent(inout) :: here
    real(wp) :: points(3, product(surface%direction%order + 1))
    integer :: nodes(product(surface%direction%order + 1))
    real(wp) :: low(2), high(2), slope(2), hessian(2, 2), metric(2, 2), step(2)
    integer :: a, iteration

    call surface_nodes(surface, here%place, nodes)
    points = positions(:, surface%point(nodes))
    do a = 1, 2
      low(a) = surface%direction(a)%boundary(here%place(a) - 1)
      high(a) = surface%direction(a)%boundary(here%place(a))
    end do
    here%xi = min(max(here%xi, low), high)
    here%settled = .false.
    do iteration = 1, 100
      call distance_derivatives(surface, here%place, nodes, points, x, here%xi, here%distance, slope, hessian, metric)
      call find_pressing(here, slope, metric, low, high)
      step = newton_step(slope, hessian, metric, here%pressing == 0)
      if (maxval(abs(step) / (high - low)) > 1.0e-3_wp) then
        call limit_step(surface, here, nodes, points, x, slope, low, high, step)
      end if
      step = min(max(here%xi + step, low), high) - here%xi
      here%xi = here%xi + step
      here%settled = all(abs(step) <= last_step * (high - low))
      if (here%settled) return
    end do
  end subroutine search_element

  !> Half the squared distance, its slope, its Hessian, and the metric of the surface.
  pure subroutine distance_derivatives(surface, place, nodes, points, x, xi, distance, slope, hessian, metric)
    type(surface_t), intent(in) :: surface
    integer, intent(in) :: place(2), nodes(:)
    real(wp), intent(in) :: points(:, :), x(3), xi(2)
    real(wp), intent(out) :: distance, slope(2), hessian(2, 2), metric(2, 2)
    real(wp) :: values(size(nodes), derivative_columns(2)), s(3, derivative_columns(2)), d(3)

    call surface_basis(surface, place, nodes, xi, 2, values)
    s = matmul(points, values)
    d = x - s(:, 1)
    distance = 0.5_wp * dot_product(d, d)
    slope = -matmul(d, s(:, 2:3))
    metric = matmul(transpose(s(:, 2:3)), s(:, 2:3))
    hessian(1, 1) = metric(1, 1) - dot_product(d, s(:, 4))
    hessian(1, 2) = metric(1, 2) - dot_product(d, s(:, 5))
    hessian(2, 1) = hessian(1, 2)
    hessian(2, 2) = metric(2, 2) - dot_product(d, s(:, 6))
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

  !> Newton's step on the free coordinates; with the metric for Hessian where that is not positive definite.
  pure function newton_step(slope, hessian, metric, free) result(step)
    real(wp), intent(in) :: slope(2), hessian(2, 2), metric(2, 2)
    logical, intent(in) :: free(2)
    real(wp) :: step(2), m(2, 2)
    integer :: a

    step = 0.0_wp
    if (all(free)) then
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

  !> Halve a long step until the distance falls as its slope promises (Armijo's rule on the bounded step).
  pure subroutine limit_step(surface, here, nodes, points, x, slope, low, high, step)
    type(surface_t), intent(in) :: surface
    type(search_t), intent(in) :: here
    integer, intent(in) :: nodes(:)
    real(wp), intent(in) :: points(:, :), x(3), slope(2), low(2), high(2)
    real(wp), intent(inout) :: step(2)
    real(wp) :: d(3), target(2), values(size(nodes), 1)
    integer :: halving

    do halving = 1, 40
      target = min(max(here%xi + step, low), high)
      call surface_basis(surface, here%place, nodes, target, 0, values)
      d = x - matmul(points, values(:, 1))
      if (0.5_wp * dot_product(d, d) <= here%distance + 1.0e-4_wp * dot_product(slope, target - here%xi)) return
      step = 0.5_wp * step
    end do
  end subroutine limit_step

  !> Points of the surface on a grid in every element, for `nearest_start`.
  pure subroutine sample_surface(surface, positions, coordinates, points)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: positions(:, :)
    real(wp), allocatable, intent(out) :: coordinates(:, :), points(:, :)
    integer :: nodes(product(surface%direction%order + 1)), e, i, j, k, m(2), place(2)
    real(wp) :: low(2), high(2), values(size(nodes), 1)

    m = surface%direction%order + 1
    allocate (coordinates(2, product(m) * surface_element_count(surface)), points(3, product(m) * surface_element_count(surface)))
    k = 0
    do e = 1, surface_element_count(surface)
      place = surface_element_of(surface, e)
      call surface_nodes(surface, place, nodes)
      low = [surface%direction(1)%boundary(place(1) - 1), surface%direction(2)%boundary(place(2) - 1)]
      high = [surface%direction(1)%boundary(place(1)), surface%direction(2)%boundary(place(2))]
      do j = 1, m(2)
        do i = 1, m(1)
          k = k + 1
          coordinates(:, k) = low + (high - low) * (real([i, j], wp) - 0.5_wp) / real(m, wp)
          call surface_basis(surface, place, nodes, coordinates(:, k), 0, values)
          points(:, k) = matmul(positions(:, surface%point(nodes)), values(:, 1))
        end do
      end do
    end do
  end subroutine sample_surface

  !> Coordinates of the sample nearest to x.
  pure function nearest_start(coordinates, points, x) result(xi)
    real(wp), intent(in) :: coordinates(:, :), points(:, :), x(3)
    real(wp) :: xi(2)
    integer :: k, nearest
    real(wp) :: distance, least

    least = huge(1.0_wp)
    nearest = 1
    do k = 1, size(points, 2)
      distance = sum((x - points(:, k))**2)
      if (distance < least) then
        least = distance
        nearest = k
      end if
    end do
    xi = coordinates(:, nearest)
  end function nearest_start

end module isomortar_contact_projection
