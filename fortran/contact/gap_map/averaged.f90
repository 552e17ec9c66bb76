!> The gap map of the averaged normal on a face of a deformable body (theory 3.21 to 3.30): nothing in it jumps at a C0 line.
!>
!> Feet are found along a continuous field of normals, forces act along it, slips are measured in the slave's basis. Short vectors:
!> dx - dS, dm, dS,1, dS,2, dm,1, dm,2 with m the field before it is made a unit vector; with friction the variations of the slave's
!> tangents as well, and that of the way from the foot to the place of the last one.
module isomortar_contact_gap_map_averaged
  use isomortar_base_algebra, only: add_product, cross, determinant, first_not_finite, identity, inverse, inverse2, &
    weighted_sums
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_unit, sums_to
  use isomortar_base_status, only: status_not_finite, status_ok, status_passed_through
  use isomortar_contact_gap_map_averaged_climb, only: climb_between
  use isomortar_contact_gap_map_averaged_foot, only: accept, find_foot, foot_equation, foot_t, follow, scope_of, scope_t
  use isomortar_contact_gap_map_map, only: all_components, contact_point_t, for_tangent, gap_map_t, projections_t, &
    variations_t
  use isomortar_contact_gap_map_nodal_normals, only: average, normals_t
  use isomortar_contact_projection, only: shallow_depth, square_depth
  use isomortar_contact_slave, only: slave_normal, slave_position, slave_t, slave_tangents
  use isomortar_contact_work, only: count_points, evaluate, gather_work, work_t
  use isomortar_nurbs_direction, only: element_at
  use isomortar_nurbs_surface, only: surface_basis, surface_nodes, surface_t
  implicit none
  private

  type, extends(gap_map_t), public :: averaged_t
    type(surface_t) :: surface
    !> The face of the same body across from it: how deep the body is.
    type(surface_t) :: opposite
  contains
    procedure :: extend
    procedure :: stencils
    procedure :: bearing
    procedure :: vectors
    procedure :: locate
    procedure :: slip => find_slip
    procedure :: climb => find_climb
    procedure :: at
    procedure, nopass :: first
    procedure, nopass :: metric
    procedure, nopass :: second
  end type averaged_t

  !> Numbers of the short vectors.
  integer, parameter :: apart = 1, field = 2, along = 2, field_along = 4, slave_along = 6, way_back = 9

  public :: averaged_on

contains

  !> The map onto a face of a body, and the face across from it.
  !> `surface`, `opposite`: the face, and that across from it.
  pure function averaged_on(surface, opposite) result(self)
    type(surface_t), intent(in) :: surface, opposite
    type(averaged_t) :: self

    self%surface = surface
    self%opposite = opposite
    self%counts_all_points = .true.
    self%has_gap_row = .true.
    self%of_tangents = slave_along + 1
  end function averaged_on

  !> Averaged normals of all nodes of the face, and the list of positions with these at its end (theory 3.21).
  pure subroutine extend(self, positions, normals, all, work)
    class(averaged_t), intent(in) :: self
    real(wp), intent(in) :: positions(:, :)
    type(normals_t), intent(out) :: normals
    real(wp), allocatable, intent(out) :: all(:, :)
    type(work_t), intent(inout) :: work

    call average(self%surface, positions, normals, work)
    allocate (all(3, size(positions, 2) + normals%count))
    all(:, :size(positions, 2)) = positions
    all(:, size(positions, 2) + 1:) = normals%normal
  end subroutine extend

  !> Elements of the foot, and of the foot at the last converged load step.
  pure function stencils(self, projections)
    class(averaged_t), intent(in) :: self
    type(projections_t), intent(in) :: projections
    integer, allocatable :: stencils(:, :)
    integer :: a, q

    allocate (stencils(4, size(projections%found)))
    stencils(1:2, :) = projections%place
    stencils(3:4, :) = projections%place
    do q = 1, size(projections%found)
      if (.not. projections%slips(q)) cycle
      do a = 1, 2
        stencils(2 + a, q) = element_at(self%surface%direction(a), projections%origin(a, q))
      end do
    end do
  end function stencils

  !> Control points and normals of the foot's element, and control points of that where the foot was.
  pure integer function bearing(self)
    class(averaged_t), intent(in) :: self

    bearing = 3 * product(self%surface%direction%order + 1)
  end function bearing

  !> The first six without friction, nine with it.
  pure integer function vectors(self, wanted)
    class(averaged_t), intent(in) :: self
    integer, intent(in) :: wanted

    vectors = merge(way_back, slave_along, wanted == for_tangent)
  end function vectors

  !> Find the feet of all points, all threads: from where they were, else anywhere (theory 3.30); none behind the body
  !> (theory 3.19). Where several fail the first point is told.
  subroutine locate(self, slave, positions, started, had, projections, status, place, work)
    class(averaged_t), intent(in) :: self
    type(slave_t), intent(in) :: slave
    real(wp), intent(in) :: positions(:, :)
    logical, intent(in) :: started(:), had(:)
    type(projections_t), intent(inout) :: projections
    integer, intent(out) :: status, place
    type(work_t), intent(inout) :: work
    type(scope_t) :: scope
    type(work_t), allocatable :: works(:)
    logical, allocatable :: passed(:)
    real(wp) :: shallow
    integer :: q

    place = first_not_finite(positions, self%surface%point)
    status = merge(status_not_finite, status_ok, place > 0)
    if (status /= status_ok) return
    scope = scope_of(self%surface, positions)
    shallow = shallow_depth(self%surface, self%opposite, positions)
    allocate (passed(size(slave%area)), works(size(slave%area)))
    !$omp parallel do default(none) shared(self, slave, scope, positions, shallow, started, had, projections, passed, works) &
    !$omp schedule(dynamic, 16)
    do q = 1, size(works)
      call locate_point(self, slave, scope, positions, shallow, started(q), had(q), q, projections, passed(q), works(q))
    end do
    !$omp end parallel do
    call gather_work(works, work)
    place = findloc(passed, .true., dim=1)
    status = merge(status_passed_through, status_ok, place > 0)
    projections%fixed = .false.
    projections%doubt = status_ok
  end subroutine locate

  !> Find the foot of quadrature point `q`; `passed`: it has passed through the master.
  pure subroutine locate_point(self, slave, scope, positions, shallow, started, had, q, projections, passed, work)
    class(averaged_t), intent(in) :: self
    type(slave_t), intent(in) :: slave
    type(scope_t), intent(in) :: scope
    real(wp), intent(in) :: positions(:, :), shallow
    logical, intent(in) :: started, had
    integer, intent(in) :: q
    type(projections_t), intent(inout) :: projections
    logical, intent(out) :: passed
    type(work_t), intent(inout) :: work
    type(foot_t) :: foot
    real(wp) :: across(3), square, x(3)
    logical :: behind, cold, deep

    call count_points(1, work)
    x = slave_position(slave, positions, q)
    across = slave_normal(slave, positions, q)
    foot%found = .false.
    if (started) call follow(self%surface, positions, x, projections%xi(:, q), foot, work)
    deep = foot%found .and. had
    if (deep) deep = foot%gap > scope%deepest
    cold = .not. accept(scope, foot, across)
    work%warm = work%warm + merge(0, 1, cold)
    work%cold = work%cold + merge(1, 0, cold)
    if (cold) call find_foot(self%surface, scope, positions, x, across, foot, work)
    behind = foot%found .and. foot%gap > shallow
    if (behind) then
      call square_depth(self%surface, self%opposite, positions, foot%place, foot%xi, square, work)
      behind = foot%gap**2 > square
    end if
    passed = (deep .and. .not. foot%found) .or. (behind .and. had)
    if (passed) return
    projections%found(q) = foot%found .and. .not. behind
    if (.not. projections%found(q)) return
    projections%xi(:, q) = foot%xi
    projections%place(:, q) = foot%place
  end subroutine locate_point

  !> Components, in the slave's basis, of the way from the last foot to that now (theory 3.25).
  pure subroutine find_slip(self, slave, positions, projections, q, slip, work)
    class(averaged_t), intent(in) :: self
    type(slave_t), intent(in) :: slave
    real(wp), intent(in) :: positions(:, :)
    type(projections_t), intent(in) :: projections
    integer, intent(in) :: q
    real(wp), intent(out) :: slip(2)
    type(work_t), intent(inout) :: work
    type(contact_point_t) :: point
    integer :: points(self%bearing())
    real(wp) :: coefficients(size(points), way_back)

    call self%at(slave, positions, projections, q, for_tangent, point, points, coefficients, work)
    slip = matmul(point%way, point%tangent)
    slip = matmul(point%inverse_metric, slip)
  end subroutine find_slip

  !> How far the foot has climbed since the last load step (theory 3.31).
  pure subroutine find_climb(self, positions, projections, q, climb, work)
    class(averaged_t), intent(in) :: self
    real(wp), intent(in) :: positions(:, :)
    type(projections_t), intent(in) :: projections
    integer, intent(in) :: q
    real(wp), intent(out) :: climb
    type(work_t), intent(inout) :: work

    call climb_between(self%surface, positions, projections%origin(:, q), projections%xi(:, q), climb, work)
  end subroutine find_climb

  !> Kinematics at a foot (theory 3.24). `tangent` and `metric` are the slave's.
  pure subroutine at(self, slave, positions, projections, q, wanted, point, points, coefficients, work)
    class(averaged_t), intent(in) :: self
    type(slave_t), intent(in) :: slave
    real(wp), intent(in) :: positions(:, :)
    type(projections_t), intent(in) :: projections
    integer, intent(in) :: q, wanted
    type(contact_point_t), intent(out) :: point
    integer, intent(out) :: points(:)
    real(wp), intent(out) :: coefficients(:, :)
    type(work_t), intent(inout) :: work
    integer :: n, nodes(size(points) / 3), origin(2)
    real(wp) :: before(size(nodes), 1), equation(3, 3), functions(size(nodes), 3), last(3, 1), x(3)

    if (contracts) call require(projections%found(q), "at: the point has a foot")
    if (contracts) call require(all(shape(coefficients) == [self%bearing(), self%vectors(wanted)]), "at: there is room")
    n = size(nodes)
    x = slave_position(slave, positions, q)
    call surface_nodes(self%surface, projections%place(:, q), nodes)
    call surface_basis(self%surface, projections%place(:, q), nodes, projections%xi(:, q), 1, functions)
    call evaluate(1, 1, work)
    points(:n) = self%surface%point(nodes)
    points(n + 1:2 * n) = size(positions, 2) - size(self%surface%point) + nodes
    points(2 * n + 1:) = points(:n)
    coefficients = 0.0_wp
    coefficients(:n, apart) = -functions(:, 1)
    coefficients(:n, along + 1:along + 2) = functions(:, 2:3)
    coefficients(n + 1:2 * n, field) = functions(:, 1)
    coefficients(n + 1:2 * n, field_along + 1:field_along + 2) = functions(:, 2:3)
    point%surface(:, 1:3) = weighted_sums(positions, points(:n), functions)
    point%field = weighted_sums(positions, points(n + 1:2 * n), functions)
    point%normal = point%field(:, 1) / norm2(point%field(:, 1))
    if (contracts) call require(is_unit(point%normal), "at: the normal is a unit vector")
    if (contracts) call require(sums_to(coefficients(:n, apart), -1.0_wp), "at: the foot moves with the master")
    point%gap = -dot_product(x - point%surface(:, 1), point%normal)
    equation = foot_equation(point%surface(:, 2:3), point%field, point%gap)
    point%inverse_foot = inverse(equation, determinant(equation))
    point%tangent = slave_tangents(slave, positions, q)
    point%metric = matmul(transpose(point%tangent), point%tangent)
    point%inverse_metric = inverse2(point%metric)
    point%facing = cross(point%tangent(:, 1), point%tangent(:, 2))
    point%facing = point%facing / norm2(point%facing)
    point%way = 0.0_wp
    if (wanted /= for_tangent) return
    if (.not. projections%slips(q)) return
    origin = [element_at(self%surface%direction(1), projections%origin(1, q)), &
      element_at(self%surface%direction(2), projections%origin(2, q))]
    call surface_nodes(self%surface, origin, nodes)
    call surface_basis(self%surface, origin, nodes, projections%origin(:, q), 0, before)
    call evaluate(0, 1, work)
    points(2 * n + 1:) = self%surface%point(nodes)
    coefficients(:n, way_back) = -functions(:, 1)
    coefficients(2 * n + 1:, way_back) = before(:, 1)
    last = weighted_sums(positions, points(2 * n + 1:), before)
    point%way = point%surface(:, 1) - last(:, 1)
  end subroutine at

  !> Components 3 k - 2 .. 3 k of short vector k.
  pure function components(k) result(range)
    integer, intent(in) :: k
    integer :: range(3)

    range = [3 * k - 2, 3 * k - 1, 3 * k]
  end function components

  !> Derivative of the unit normal by the field m.
  pure function turning(point) result(matrix)
    type(contact_point_t), intent(in) :: point
    real(wp) :: matrix(3, 3)

    matrix = identity
    call add_product(-1.0_wp, point%normal, point%normal, matrix)
    matrix = matrix / norm2(point%field(:, 1))
  end function turning

  !> Rows of the foot's coordinates (1, 2) and the gap (3) (theory 3.26).
  pure function foot_rows(point) result(rows)
    type(contact_point_t), intent(in) :: point
    real(wp) :: rows(all_components, 3)
    real(wp), dimension(3, 3) :: by_apart, by_field, turn

    turn = turning(point)
    by_apart = transpose(point%inverse_foot)
    by_field = matmul(turn, by_apart) ! of arrays alone: gfortran's library, with BLAS, fails at expressions
    rows = 0.0_wp
    rows(components(apart), :) = by_apart
    rows(components(field), :) = point%gap * by_field
  end function foot_rows

  !> Rows of dg, of what pressures and tractions work on, and of the slip (theory 3.26, 3.27, 3.28).
  pure function first(point, vectors) result(variations)
    type(contact_point_t), intent(in) :: point
    integer, intent(in) :: vectors
    type(variations_t) :: variations
    real(wp) :: rows(all_components, 3), contravariant(3, 2), on_field(3, 2), turn(3, 3), along_foot(2, 2)
    integer :: a

    contravariant = matmul(point%tangent, point%inverse_metric)
    turn = turning(point)
    on_field = matmul(turn, contravariant)
    rows = foot_rows(point)
    variations%gap = rows(:, 3)
    variations%pressure_work = 0.0_wp
    variations%pressure_work(components(apart)) = -point%normal
    variations%slip = 0.0_wp
    variations%slip(components(apart), :) = contravariant
    variations%slip(components(field), :) = point%gap * on_field
    variations%projection = 0.0_wp
    if (vectors < way_back) return
    along_foot = matmul(transpose(point%surface(:, 2:3)), contravariant)
    variations%projection = matmul(rows(:, 1:2), along_foot)
    do a = 1, 2
      variations%projection(components(slave_along + a), :) = basis_change(point, point%way, a)
    end do
    variations%projection(components(way_back), :) = -contravariant
  end function first

  !> Rows of the variation of t_a in that of the slave's dual vectors (by column) times a vector (theory 3.27).
  pure function basis_change(point, vector, a) result(rows)
    type(contact_point_t), intent(in) :: point
    real(wp), intent(in) :: vector(3)
    integer, intent(in) :: a
    real(wp) :: rows(3, 2)
    real(wp) :: contravariant(3, 2)

    contravariant = matmul(point%tangent, point%inverse_metric)
    rows = -dot_product(contravariant(:, a), vector) * contravariant
    call add_product(dot_product(point%facing, vector), point%facing, point%inverse_metric(:, a), rows)
  end function basis_change

  !> Rows of the variation of the slave's metric: a_11, a_12, a_22 (theory 3.8).
  pure function metric(point, variations) result(rows)
    type(contact_point_t), intent(in) :: point
    type(variations_t), intent(in) :: variations
    real(wp) :: rows(all_components, 3)

    rows = 0.0_wp
    rows(components(slave_along + 1), 1) = 2.0_wp * point%tangent(:, 1)
    rows(components(slave_along + 1), 2) = point%tangent(:, 2)
    rows(components(slave_along + 2), 2) = point%tangent(:, 1)
    rows(components(slave_along + 2), 3) = 2.0_wp * point%tangent(:, 2)
  end function metric

  !> Add the variation of the work of a pressure and a traction to a bilinear form over the components (theory 3.29).
  pure subroutine second(point, variations, pressure, traction, form)
    type(contact_point_t), intent(in) :: point
    type(variations_t), intent(in) :: variations
    real(wp), intent(in) :: pressure, traction(2)
    real(wp), intent(inout) :: form(:, :)
    real(wp), dimension(all_components, 3) :: foot, force_change, moving, on_field
    real(wp) :: bent(3, 3), contravariant(3, 2), force(3), pull(3), turn(3, 3), turned(3)
    integer :: a, i, n

    n = size(form, 2)
    turn = turning(point)
    contravariant = matmul(point%tangent, point%inverse_metric)
    pull = matmul(contravariant, traction)
    force = pull - pressure * point%normal
    turned = matmul(turn, force)
    foot = foot_rows(point)
    moving = matmul(foot(:, 1:2), transpose(point%field(:, 2:3)))
    moving(components(field), :) = moving(components(field), :) + identity
    force_change = -pressure * matmul(moving, turn)
    if (n == all_components) then
      do a = 1, 2
        force_change(components(slave_along + a), :) = pull_change(point, pull, a)
      end do
    end if
    bent = -dot_product(force, point%normal) * turn
    call add_product(-1.0_wp, point%normal, turned, bent)
    call add_product(-1.0_wp, turned, point%normal, bent)
    bent = bent / norm2(point%field(:, 1))
    on_field = point%gap * (matmul(force_change, turn) + matmul(moving, bent))
    call add_product(1.0_wp, foot(:, 3), turned, on_field)
    do i = 1, 3
      form(3 * apart - 3 + i, :) = form(3 * apart - 3 + i, :) + force_change(:n, i)
      form(3 * field - 3 + i, :) = form(3 * field - 3 + i, :) + on_field(:n, i)
      do a = 1, 2
        form(3 * (along + a) - 3 + i, :) = form(3 * (along + a) - 3 + i, :) - force(i) * foot(:n, a)
        form(3 * (field_along + a) - 3 + i, :) = form(3 * (field_along + a) - 3 + i, :) + point%gap * turned(i) * foot(:n, a)
      end do
    end do
  end subroutine second

  !> Rows of the variation of t_a in that of a traction vector with constant covariant components, by its component (theory 3.27).
  pure function pull_change(point, pull, a) result(rows)
    type(contact_point_t), intent(in) :: point
    real(wp), intent(in) :: pull(3)
    integer, intent(in) :: a
    real(wp) :: rows(3, 3), contravariant(3, 2)

    contravariant = matmul(point%tangent, point%inverse_metric)
    rows = 0.0_wp
    call add_product(-1.0_wp, pull, contravariant(:, a), rows)
    call add_product(dot_product(contravariant(:, a), pull), point%facing, point%facing, rows)
  end function pull_change

end module isomortar_contact_gap_map_averaged
