!> First pass over the slave quadrature points: projection and control quantities (theory 4.1).
!>
!> - `slave`, `map`: the slave side, and the gap map onto its master.
!> - `positions` (3, control points): of all control points, L. `projections`: feet of the quadrature points there.
!> - `control`: what is integrated. `with_friction`: whether slips and metric are wanted; else they are zero.
!> - `work`: counts of what is done.
module isomortar_contact_control
  use isomortar_base_algebra, only: first_not_finite
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_status, only: status_not_finite, status_ok
  use isomortar_contact_gap_map_map, only: contact_point_t, for_gap, gap_map_t, projections_t
  use isomortar_contact_gap_map_nodal_normals, only: normals_t
  use isomortar_contact_slave, only: integrate_functions, slave_t, slave_tangents
  use isomortar_contact_work, only: count_points, gather_work, work_t
  implicit none
  private

  public :: control_quantities, find_climbs, integrate_slip_sum, project_points

  !> A control point whose weight w^I at the points with a foot is below this share of what it has with all has left the master.
  real(wp), parameter, public :: least_weight = 1.0e-10_wp

  !> Control quantities of every test function, and what they were integrated from.
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

  !> Project every slave quadrature point (theory 3.4, 3.20); coordinates of `projections` hold the starts.
  !>
  !> - `started` (points): whether there is a start; elsewhere the nearest sample of the master is one.
  !> - `origin` (2, points), `had` (points): feet at the last converged load step, P, and whether there were any.
  !> - `status`, `place`: how it ended (isomortar_base_status), and on failure the quadrature point.
  subroutine project_points(slave, map, positions, started, origin, had, with_friction, projections, status, place, work)
    type(slave_t), intent(in) :: slave
    class(gap_map_t), intent(in) :: map
    real(wp), intent(in) :: positions(:, :)
    logical, intent(in) :: started(:), had(:)
    real(wp), intent(in) :: origin(:, :)
    logical, intent(in) :: with_friction
    type(projections_t), intent(inout) :: projections
    integer, intent(out) :: status, place
    type(work_t), intent(inout) :: work
    type(normals_t) :: normals
    type(work_t), allocatable :: works(:)
    real(wp), allocatable :: extended(:, :)
    integer :: q

    if (contracts) call require(size(had) == size(slave%area) .and. size(started) == size(had), "project_points: points")
    place = first_not_finite(positions, slave%point)
    status = merge(status_not_finite, status_ok, place > 0)
    if (status /= status_ok) return
    call map%extend(positions, normals, extended, work)
    call map%locate(slave, extended, started, had, projections, status, place, work)
    if (status /= status_ok) return
    if (contracts) call require(all(projections%found .or. projections%doubt == status_ok), "project_points: doubt is of a foot")
    projections%origin = origin
    projections%slips = projections%found .and. had
    projections%slip = 0.0_wp
    if (.not. with_friction) return
    allocate (works(size(slave%area)))
    !$omp parallel do default(none) shared(slave, map, extended, projections, works) schedule(dynamic, 16)
    do q = 1, size(works)
      if (projections%slips(q)) call map%slip(slave, extended, projections, q, projections%slip(:, q), works(q))
    end do
    !$omp end parallel do
    call gather_work(works, work)
  end subroutine project_points

  !> How far the foot of every slave quadrature point has climbed since the last converged load step, `climbs` (points), L; zero
  !> at points without a slip (theory 3.31).
  pure subroutine find_climbs(map, positions, projections, climbs, work)
    class(gap_map_t), intent(in) :: map
    real(wp), intent(in) :: positions(:, :)
    type(projections_t), intent(in) :: projections
    real(wp), intent(out) :: climbs(:)
    type(work_t), intent(inout) :: work
    type(normals_t) :: normals
    real(wp), allocatable :: all(:, :)
    integer :: q

    call map%extend(positions, normals, all, work)
    climbs = 0.0_wp
    do q = 1, size(climbs)
      if (projections%slips(q)) call map%climb(all, projections, q, climbs(q), work)
    end do
  end subroutine find_climbs

  !> Integrate the control quantities. Points without a projection take no part in any of them (theory 4.1), but in those that need
  !> none where the map is of that kind (theory 3.30).
  subroutine control_quantities(slave, map, positions, projections, with_friction, control, work)
    type(slave_t), intent(in) :: slave
    class(gap_map_t), intent(in) :: map
    real(wp), intent(in) :: positions(:, :)
    type(projections_t), intent(in) :: projections
    logical, intent(in) :: with_friction
    type(control_t), intent(inout) :: control
    type(work_t), intent(inout) :: work
    type(normals_t) :: normals
    type(work_t), allocatable :: works(:)
    real(wp), allocatable :: extended(:, :), fields(:, :), totals(:, :)
    integer :: e

    if (contracts) call require(size(projections%found) == size(slave%area), "control_quantities: points are the slave's")
    if (contracts) call require(size(control%weight) == slave%test%count, "control_quantities: functions are the slave's")
    call map%extend(positions, normals, extended, work)
    associate (wanted => merge(5, 4, map%counts_all_points))
      allocate (fields(wanted, size(slave%area)), totals(wanted, slave%test%count))
    end associate
    fields = 0.0_wp
    control%point_metric = 0.0_wp
    allocate (works(size(slave%area) / slave%per_element))
    !$omp parallel do default(none) shared(slave, map, extended, projections, with_friction, fields, control, works) &
    !$omp schedule(dynamic)
    do e = 1, size(works)
      call quantities_at_points(slave, map, extended, projections, with_friction, e, fields, control%point_metric, works(e))
    end do
    !$omp end parallel do
    call gather_work(works, work)
    call integrate_functions(slave, fields, totals)
    control%weight(:) = totals(1, :)
    if (map%counts_all_points) where (totals(5, :) <= least_weight * totals(1, :)) control%weight = 0.0_wp
    control%gap(:) = totals(2, :)
    control%slip(:, :) = totals(3:4, :)
    control%square = 0.0_wp
    control%metric = 0.0_wp
    if (with_friction) call integrate_squares(slave, fields(1, :), control)
  end subroutine control_quantities

  !> What is integrated, `fields` (field, points), at the quadrature points of slave element `e`, with `point_metric` (3, points).
  pure subroutine quantities_at_points(slave, map, positions, projections, with_friction, e, fields, point_metric, work)
    type(slave_t), intent(in) :: slave
    class(gap_map_t), intent(in) :: map
    real(wp), intent(in) :: positions(:, :)
    type(projections_t), intent(in) :: projections
    logical, intent(in) :: with_friction
    integer, intent(in) :: e
    real(wp), intent(inout) :: fields(:, :), point_metric(:, :)
    type(work_t), intent(inout) :: work
    type(contact_point_t) :: point
    real(wp) :: coefficients(map%bearing(), map%vectors(for_gap)), tangents(3, 2)
    integer :: points(map%bearing()), q

    do q = (e - 1) * slave%per_element + 1, e * slave%per_element
      if (map%counts_all_points .and. .not. projections%found(q)) fields(1, q) = 1.0_wp
      if (with_friction .and. map%counts_all_points .and. .not. projections%found(q)) then
        tangents = slave_tangents(slave, positions, q)
        point_metric(:, q) = [sum(tangents(:, 1)**2), dot_product(tangents(:, 1), tangents(:, 2)), sum(tangents(:, 2)**2)]
      end if
      if (.not. projections%found(q)) cycle
      call count_points(1, work)
      call map%at(slave, positions, projections, q, for_gap, point, points, coefficients, work)
      fields(:4, q) = [1.0_wp, point%gap, projections%slip(:, q)]
      if (map%counts_all_points) fields(5, q) = 1.0_wp
      if (with_friction) point_metric(:, q) = [point%metric(1, 1), point%metric(1, 2), point%metric(2, 2)]
    end do
  end subroutine quantities_at_points

  !> <R^I R^I> and <R^I R^I a_ab> over the points whose `present` is 1 (theory 4.2).
  pure subroutine integrate_squares(slave, present, control)
    type(slave_t), intent(in) :: slave
    real(wp), intent(in) :: present(:)
    type(control_t), intent(inout) :: control
    real(wp) :: share(size(slave%test%nodes, 1)), sums(size(share), 0:3)
    integer :: a, e, k, q

    do e = 1, size(slave%test%nodes, 2)
      sums = 0.0_wp
      do q = (e - 1) * slave%per_element + 1, e * slave%per_element
        share = slave%test%values(:, q)**2 * slave%area(q) * present(q)
        sums(:, 0) = sums(:, 0) + share
        do k = 1, 3
          sums(:, k) = sums(:, k) + share * control%point_metric(k, q)
        end do
      end do
      do a = 1, size(share)
        associate (i => slave%test%nodes(a, e))
          control%square(i) = control%square(i) + sums(a, 0)
          control%metric(:, i) = control%metric(:, i) + sums(a, 1:)
        end associate
      end do
    end do
  end subroutine integrate_squares

  !> <R^I a_ab zeta^b> with zeta the field of control slips (theory 4.5); zero slip where inactive.
  !>
  !> - `point_metric` (3, points): a_ab as 11, 12, 22, L^2/P^2. `control_slip` (2, test functions): control slips, P.
  !> - `field_slip` (2, points): zeta, P. `totals` (2, test functions): the integrals, L^4/P.
  pure subroutine integrate_slip_sum(slave, point_metric, control_slip, field_slip, totals)
    type(slave_t), intent(in) :: slave
    real(wp), intent(in) :: point_metric(:, :), control_slip(:, :)
    real(wp), intent(out) :: field_slip(:, :), totals(:, :)
    real(wp), allocatable :: fields(:, :)
    real(wp) :: slips(2, size(slave%test%nodes, 1))
    integer :: e, q

    if (contracts) call require(size(control_slip, 2) == slave%test%count, "integrate_slip_sum: functions are the slave's")
    allocate (fields(2, size(slave%area)))
    do e = 1, size(slave%test%nodes, 2)
      slips = control_slip(:, slave%test%nodes(:, e))
      do q = (e - 1) * slave%per_element + 1, e * slave%per_element
        field_slip(1, q) = dot_product(slips(1, :), slave%test%values(:, q))
        field_slip(2, q) = dot_product(slips(2, :), slave%test%values(:, q))
        fields(1, q) = point_metric(1, q) * field_slip(1, q) + point_metric(2, q) * field_slip(2, q)
        fields(2, q) = point_metric(2, q) * field_slip(1, q) + point_metric(3, q) * field_slip(2, q)
      end do
    end do
    call integrate_functions(slave, fields, totals)
  end subroutine integrate_slip_sum

end module isomortar_contact_control
