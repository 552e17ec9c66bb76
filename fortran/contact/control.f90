!> First pass over the slave quadrature points: projection and control quantities (theory 4.1).
module isomortar_contact_control
  use isomortar_base_kinds, only: wp
  use isomortar_base_status, only: status_degenerate_surface, status_lost_projection, status_no_slip, status_not_finite, &
    status_ok, status_passed_through
  use isomortar_contact_hulls, only: enclose, hulls_t, within_reach
  use isomortar_contact_kinematics, only: contact_point, contact_point_t, plane_point
  use isomortar_contact_kink, only: hold_on_lines
  use isomortar_contact_master, only: master_t
  use isomortar_contact_pole, only: gather_at_pole, hold_at_pole, is_at_pole, pole_of
  use isomortar_contact_projection, only: is_too_deep, look_round, start_nearest
  use isomortar_contact_search, only: descend, is_isolated, projection_degenerate, projection_inside, projection_lost, &
    projection_outside, search_t, start_at
  use isomortar_contact_slave, only: integrate_functions, slave_t
  use isomortar_nurbs_surface, only: derivative_columns, shortest_way, surface_basis, surface_nodes
  implicit none
  private

  public :: control_quantities, integrate_slip_sum, point_on_master, project_points

  !> Share of the least depth between control points within which a point is not asked how deep the master's body is.
  real(wp), parameter :: shallow_share = 0.25_wp

  !> Where the slave quadrature points stand on the master.
  type, public :: projections_t
    !> Master coordinates.
    real(wp), allocatable :: xi(:, :)
    !> Master element by direction; 0 where there is none (plane, no projection).
    integer, allocatable :: place(:, :)
    !> Coordinates that stay while the point moves (on C0 lines; of points that are found), shape (2, points).
    logical, allocatable :: fixed(:, :)
    logical, allocatable :: found(:)
    !> Of a point that is found: status_ok, or why its foot does not follow it. Then its distance alone means something.
    integer, allocatable :: doubt(:)
    !> Slip increment since the last converged load step; zero without a history.
    real(wp), allocatable :: slip(:, :)
    !> The slip follows the motion: found now and at the last converged load step.
    logical, allocatable :: slips(:)
  end type projections_t

  !> Control quantities of every slave control point, and what they were integrated from.
  type, public :: control_t
    !> w^I = <R^I> and <R^I R^I>.
    real(wp), allocatable :: weight(:), square(:)
    !> <R^I g>.
    real(wp), allocatable :: gap(:)
    !> <R^I (xi - xi_n)>, shape (2, I).
    real(wp), allocatable :: slip(:, :)
    !> <R^I R^I a_ab> as 11, 12, 22, shape (3, I).
    real(wp), allocatable :: metric(:, :)
    !> Metric at the quadrature points, shape (3, points).
    real(wp), allocatable :: point_metric(:, :)
  end type control_t

contains

  !> Project every slave quadrature point; `xi` holds starts where `started`, elsewhere the nearest sample of the master is one.
  !> `origin` and `had` are the projections at the last converged load step (theory 3.4, 3.20). On failure `place` is the quadrature
  !> point.
  subroutine project_points(slave, master, positions, started, origin, had, projections, status, place)
    type(slave_t), intent(in) :: slave
    type(master_t), intent(in) :: master
    real(wp), intent(in) :: positions(:, :)
    logical, intent(in) :: started(:), had(:)
    real(wp), intent(in) :: origin(:, :)
    type(projections_t), intent(inout) :: projections
    integer, intent(out) :: status, place
    type(hulls_t) :: hulls
    real(wp) :: shallow
    integer :: e, last, per_element, q

    status = status_ok
    place = 0
    per_element = size(slave%area) / size(slave%nodes, 2)
    place = first_not_finite(positions, slave%point)
    if (place == 0 .and. .not. master%is_plane) place = first_not_finite(positions, master%surface%point)
    if (place > 0) then
      status = status_not_finite
      return
    end if
    if (.not. master%is_plane) then
      call enclose(master%surface, positions, hulls)
      shallow = shallow_share * least_depth(master, positions)
    end if
    do e = 1, size(slave%nodes, 2)
      last = per_element * e
      if (master%is_plane) then
        do q = last - per_element + 1, last
          projections%xi(:, q) = matmul(slave_position(slave, positions, q) - master%origin, master%tangent)
          projections%fixed(:, q) = .false.
          projections%found(q) = .true.
          projections%doubt(q) = status_ok
        end do
      else
        call project_element(slave, master, hulls, positions, started, had, shallow, last - per_element, projections, status, place)
        if (status /= status_ok) return
      end if
    end do
    projections%slips = projections%found .and. had
    do q = 1, size(slave%area)
      projections%slip(:, q) = merge(projections%xi(:, q) - origin(:, q), 0.0_wp, projections%slips(q))
      if (.not. master%is_plane) projections%slip(:, q) = shortest_way(master%surface, projections%slip(:, q))
    end do
  end subroutine project_points

  !> Project the quadrature points of a slave element, which are near each other: those after number `before` (theory 3.19).
  pure subroutine project_element(slave, master, hulls, positions, started, had, shallow, before, projections, status, place)
    type(slave_t), intent(in) :: slave
    type(master_t), intent(in) :: master
    type(hulls_t), intent(in) :: hulls
    real(wp), intent(in) :: positions(:, :), shallow
    logical, intent(in) :: started(:), had(:)
    integer, intent(in) :: before
    type(projections_t), intent(inout) :: projections
    integer, intent(inout) :: status, place
    type(search_t) :: here(size(slave%area) / size(slave%nodes, 2))
    real(wp) :: x(3, size(here)), middle(3), reach
    type(contact_point_t) :: point
    integer :: count, doubt, list(size(hulls%radius)), nodes(product_of_orders(master)), q
    real(wp) :: functions(size(nodes), derivative_columns(2))

    do q = 1, size(here)
      x(:, q) = slave_position(slave, positions, before + q)
      here(q) = start_at(master%surface, projections%xi(:, before + q))
      if (.not. started(before + q)) here(q) = start_nearest(master%surface, hulls, x(:, q))
      call descend(master%surface, positions, x(:, q), here(q))
    end do
    middle = sum(x, 2) / size(here)
    reach = maxval(norm2(x - spread(middle, 2, size(here)), 1) + sqrt(2.0_wp * here%distance))
    call within_reach(hulls, middle, reach, list, count)
    do q = 1, size(here)
      call look_round(master%surface, hulls, positions, x(:, q), list(:count), here(q))
      doubt = status_ok
      if (here(q)%outcome == projection_inside .and. .not. is_isolated(here(q))) doubt = status_degenerate_surface
      if (here(q)%outcome == projection_lost) doubt = status_lost_projection
      if (doubt /= status_ok) here(q)%outcome = projection_inside
      if (here(q)%outcome == projection_degenerate) then
        status = status_degenerate_surface
        place = before + q
        return
      end if
      if (here(q)%outcome == projection_inside .and. 2.0_wp * here(q)%distance > shallow**2) then
        if (is_too_deep(master%surface, master%opposite, positions, here(q))) here(q)%outcome = projection_outside
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
        call point_on_master(slave, master, positions, projections, before + q, 2, point, nodes, functions)
        if (.not. point%slips) projections%doubt(before + q) = status_no_slip
      end if
    end do
  end subroutine project_element

  !> The first of some control points whose position is not finite; 0 where there is none.
  pure integer function first_not_finite(positions, points) result(point)
    real(wp), intent(in) :: positions(:, :)
    integer, intent(in) :: points(:)
    integer :: a

    do a = 1, size(points)
      point = points(a)
      if (.not. all(abs(positions(:, point)) <= huge(1.0_wp))) return
    end do
    point = 0
  end function first_not_finite

  !> Least distance of a control point of the master from that across the body.
  pure real(wp) function least_depth(master, positions)
    type(master_t), intent(in) :: master
    real(wp), intent(in) :: positions(:, :)
    integer :: a

    least_depth = huge(1.0_wp)
    do a = 1, size(master%surface%point)
      least_depth = min(least_depth, norm2(positions(:, master%surface%point(a)) - positions(:, master%opposite%point(a))))
    end do
  end function least_depth

  !> Position of a slave quadrature point.
  pure function slave_position(slave, positions, q) result(x)
    type(slave_t), intent(in) :: slave
    real(wp), intent(in) :: positions(:, :)
    integer, intent(in) :: q
    real(wp) :: x(3)
    integer :: a, e

    e = (q - 1) / (size(slave%area) / size(slave%nodes, 2)) + 1
    x = 0.0_wp
    do a = 1, size(slave%nodes, 1)
      x = x + slave%basis(a, q) * positions(:, slave%point(slave%nodes(a, e)))
    end do
  end function slave_position

  !> Kinematics at a slave quadrature point that has a projection, with surface derivatives up to `order`.
  !> On a surface, `nodes` are its control points within the master and `functions` their values and derivatives.
  pure subroutine point_on_master(slave, master, positions, projections, q, order, point, nodes, functions)
    type(slave_t), intent(in) :: slave
    type(master_t), intent(in) :: master
    real(wp), intent(in) :: positions(:, :)
    type(projections_t), intent(in) :: projections
    integer, intent(in) :: q, order
    type(contact_point_t), intent(out) :: point
    integer, intent(out) :: nodes(:)
    real(wp), intent(out) :: functions(:, :)
    real(wp) :: x(3)
    integer :: pole

    x = slave_position(slave, positions, q)
    if (master%is_plane) then
      point = plane_point(x, master%origin, master%normal, master%tangent)
      return
    end if
    associate (surface => master%surface, columns => derivative_columns(order))
      call surface_nodes(surface, projections%place(:, q), nodes)
      call surface_basis(surface, projections%place(:, q), nodes, projections%xi(:, q), order, functions(:, 1:columns))
      pole = pole_of(surface, projections%place(:, q), projections%xi(:, q))
      if (pole /= 0) call gather_at_pole(surface, pole, functions(:, 1:columns))
      if (is_at_pole(surface, projections%place(:, q), projections%xi(:, q))) then
        call hold_at_pole(surface, positions, x, pole, point)
        return
      end if
      point = contact_point(x, matmul(positions(:, surface%point(nodes)), functions(:, 1:columns)), surface%outward)
      if (.not. any(projections%fixed(:, q))) return
      call hold_on_lines(surface, positions, x, projections%xi(:, q), projections%place(:, q), projections%fixed(:, q), point)
    end associate
  end subroutine point_on_master

  !> Integrate the control quantities. Points without a projection take no part in any of them (theory 4.1).
  pure subroutine control_quantities(slave, master, positions, projections, control)
    type(slave_t), intent(in) :: slave
    type(master_t), intent(in) :: master
    real(wp), intent(in) :: positions(:, :)
    type(projections_t), intent(in) :: projections
    type(control_t), intent(inout) :: control
    type(contact_point_t) :: point
    real(wp), allocatable :: fields(:, :), functions(:, :), totals(:, :)
    integer, allocatable :: nodes(:)
    integer :: q

    allocate (fields(4, size(slave%area)), totals(4, slave%count))
    allocate (nodes(product_of_orders(master)), functions(product_of_orders(master), derivative_columns(2)))
    fields = 0.0_wp
    control%point_metric = 0.0_wp
    do q = 1, size(slave%area)
      if (.not. projections%found(q)) cycle
      call point_on_master(slave, master, positions, projections, q, merge(0, 2, master%is_plane), point, nodes, functions)
      fields(:, q) = [1.0_wp, point%gap, projections%slip(:, q)]
      control%point_metric(:, q) = [point%metric(1, 1), point%metric(1, 2), point%metric(2, 2)]
    end do
    call integrate_functions(slave, fields, totals)
    control%weight(:) = totals(1, :)
    control%gap(:) = totals(2, :)
    control%slip(:, :) = totals(3:4, :)
    call integrate_squares(slave, fields(1, :), control)
  end subroutine control_quantities

  !> Number of master control points at a quadrature point; one, unused, for a plane.
  pure integer function product_of_orders(master)
    type(master_t), intent(in) :: master

    product_of_orders = 1
    if (.not. master%is_plane) product_of_orders = product(master%surface%direction%order + 1)
  end function product_of_orders

  !> <R^I R^I> and <R^I R^I a_ab> over the points whose `present` is 1 (theory 4.2).
  pure subroutine integrate_squares(slave, present, control)
    type(slave_t), intent(in) :: slave
    real(wp), intent(in) :: present(:)
    type(control_t), intent(inout) :: control
    real(wp) :: share
    integer :: a, e, i, per_element, q

    control%square = 0.0_wp
    control%metric = 0.0_wp
    per_element = size(slave%area) / size(slave%nodes, 2)
    do q = 1, size(slave%area)
      e = (q - 1) / per_element + 1
      do a = 1, size(slave%nodes, 1)
        i = slave%nodes(a, e)
        share = slave%basis(a, q)**2 * slave%area(q) * present(q)
        control%square(i) = control%square(i) + share
        control%metric(:, i) = control%metric(:, i) + share * control%point_metric(:, q)
      end do
    end do
  end subroutine integrate_squares

  !> <R^I a_ab zeta^b> with zeta the field of control slips (theory 4.5); zero slip where inactive.
  pure subroutine integrate_slip_sum(slave, point_metric, control_slip, field_slip, totals)
    type(slave_t), intent(in) :: slave
    real(wp), intent(in) :: point_metric(:, :), control_slip(:, :)
    real(wp), intent(out) :: field_slip(:, :), totals(:, :)
    real(wp), allocatable :: fields(:, :)
    integer :: e, per_element, q

    allocate (fields(2, size(slave%area)))
    per_element = size(slave%area) / size(slave%nodes, 2)
    do q = 1, size(slave%area)
      e = (q - 1) / per_element + 1
      field_slip(:, q) = matmul(control_slip(:, slave%nodes(:, e)), slave%basis(:, q))
      fields(1, q) = point_metric(1, q) * field_slip(1, q) + point_metric(2, q) * field_slip(2, q)
      fields(2, q) = point_metric(2, q) * field_slip(1, q) + point_metric(3, q) * field_slip(2, q)
    end do
    call integrate_functions(slave, fields, totals)
  end subroutine integrate_slip_sum

end module isomortar_contact_control
