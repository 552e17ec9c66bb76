!> Second pass over the slave quadrature points: contact forces, constraint rows and the geometric tangent.
!>
!> The rows are returned apart from what they are multiplied with, so that one pass serves every way of enforcing contact.
module isomortar_contact_blocks
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_compressed, is_symmetric
  use isomortar_base_status, only: status_ok, status_pattern
  use isomortar_contact_gap_map_map, only: all_components, contact_point_t, gap_map_t, projections_t, variations_t
  use isomortar_contact_gap_map_nodal_normals, only: add_turning, carry, carry_form, carry_rows, normals_t, reach, reached_t
  use isomortar_contact_slave, only: slave_t, slave_tangents
  use isomortar_sparse_blocks, only: lacks, mark_row, pattern_t
  implicit none
  private

  public :: gap_row, has_friction, integrate_blocks, integrate_forces

  !> Kinds of constraint rows: <R^I dg> as pressures work on it, <R^I slip^a> that tractions work on, <R^I dxi^a> over points with a
  !> history, <R^I R^I da_ab>, <R^I da_ab zeta^b>. After these, where a map `leans`, <R^I dg> as it is.
  integer, parameter, public :: row_push = 1
  integer, parameter, public :: row_work = 2
  integer, parameter, public :: row_slip = 4
  integer, parameter, public :: row_metric = 6
  integer, parameter, public :: row_slip_sum = 9
  integer, parameter :: all_rows = 10

  !> Control values that the fields are made of.
  type, public :: multipliers_t
    real(wp), allocatable :: pressure(:)
    real(wp), allocatable :: traction(:, :)
    !> Only active control points contribute.
    logical, allocatable :: active(:)
  end type multipliers_t

  !> One quadrature point: control points of the slave and the master element, coefficients of the short vectors (control points,
  !> vectors), variations.
  type :: sample_t
    type(contact_point_t) :: point
    type(variations_t) :: variations
    integer, allocatable :: points(:)
    real(wp), allocatable :: coefficients(:, :)
  end type sample_t

  !> Quadrature points of a slave element that project on the same master element. They share their control points, so that the sums
  !> over them are products of matrices.
  type :: batch_t
    !> Quadrature points in it.
    integer :: count
    !> Area times R^I, (slave control points, quadrature points), and the same with R^I R^I.
    real(wp), allocatable :: weight(:, :), square_weight(:, :)
    !> Coefficients of the short vectors, (control points, vectors, quadrature points).
    real(wp), allocatable :: coefficients(:, :, :)
    !> Variations that the rows integrate, (control points, component, quadrature points, kind).
    real(wp), allocatable :: rows(:, :, :, :)
    !> Second variations by short vectors on the left, by control points on the right:
    !> (right control point, left component, right component, left vector, quadrature points).
    real(wp), allocatable :: second(:, :, :, :, :)
  end type batch_t

contains

  !> Which row kind of so many is <R^I dg>: of a map that leans the last, of others that which pressures work on.
  pure integer function gap_row(kinds)
    integer, intent(in) :: kinds

    gap_row = merge(kinds, row_push, kinds == row_push + 1 .or. kinds == row_slip_sum)
  end function gap_row

  !> Whether so many row kinds are those of friction.
  pure logical function has_friction(kinds)
    integer, intent(in) :: kinds

    has_friction = kinds > row_push + 1
  end function has_friction

  !> Add the contact forces r(d) = sum p^I <R^I dg> + sum t_a^I <R^I dxi^a> (theory 4.7).
  subroutine integrate_forces(slave, map, positions, projections, with_friction, multipliers, forces)
    type(slave_t), intent(in) :: slave
    class(gap_map_t), intent(in) :: map
    real(wp), intent(in) :: positions(:, :)
    type(projections_t), intent(in) :: projections
    logical, intent(in) :: with_friction
    type(multipliers_t), intent(in) :: multipliers
    real(wp), intent(inout) :: forces(:, :)
    type(normals_t) :: normals
    real(wp), allocatable :: extended(:, :), on_normals(:, :)

    if (contracts) call require(all(shape(forces) == shape(positions)), "integrate_forces: forces are those of the positions")
    call map%extend(positions, normals, extended)
    allocate (on_normals(3, normals%count), source=0.0_wp)
    call integrate_each(slave, map, extended, projections, multipliers, forces, on_normals)
    call carry(normals, on_normals, forces)
  end subroutine integrate_forces

  !> Add the contact forces on control points, and those on normals of nodes, which stand after these in `positions`.
  subroutine integrate_each(slave, map, positions, projections, multipliers, forces, on_normals)
    type(slave_t), intent(in) :: slave
    class(gap_map_t), intent(in) :: map
    real(wp), intent(in) :: positions(:, :)
    type(projections_t), intent(in) :: projections
    type(multipliers_t), intent(in) :: multipliers
    real(wp), intent(inout) :: forces(:, :), on_normals(:, :)
    type(sample_t) :: sample
    real(wp) :: field(3), force(3), row(all_components)
    integer :: a, e, n, q

    n = size(forces, 2)
    do e = 1, size(slave%test%nodes, 2)
      if (.not. any(multipliers%active(slave%test%nodes(:, e)))) cycle
      do q = (e - 1) * slave%per_element + 1, e * slave%per_element
        if (.not. projections%found(q)) cycle
        call take_sample(slave, map, positions, projections, e, q, .false., sample)
        field = fields_at(slave, multipliers, e, q)
        associate (components => 3 * size(sample%coefficients, 2))
          row(:components) = slave%area(q) * (field(1) * sample%variations%push(:components) &
            + matmul(sample%variations%slip(:components, :), field(2:3)))
        end associate
        do a = 1, size(sample%points)
          force = matmul(reshape(row(1:3 * size(sample%coefficients, 2)), [3, size(sample%coefficients, 2)]), &
            sample%coefficients(a, :))
          if (sample%points(a) <= n) then
            forces(:, sample%points(a)) = forces(:, sample%points(a)) + force
          else
            on_normals(:, sample%points(a) - n) = on_normals(:, sample%points(a) - n) + force
          end if
        end do
      end do
    end do
  end subroutine integrate_each

  !> Add constraint rows and the geometric tangent <p Ddg> + <t_a Ddxi^a> (theory 4.8).
  !>
  !> `row_pattern` holds for each slave control point (row) the control points (columns) that its rows reach;
  !> rows(component, kind, block). `field_slip` is the field of control slips, used by the slip sum's rows. On failure
  !> `place` is the row of a pattern that lacks a block.
  subroutine integrate_blocks(slave, map, positions, projections, with_friction, multipliers, field_slip, row_pattern, rows, &
      pattern, tangent, status, place)
    type(slave_t), intent(in) :: slave
    class(gap_map_t), intent(in) :: map
    real(wp), intent(in) :: positions(:, :)
    type(projections_t), intent(in) :: projections
    logical, intent(in) :: with_friction
    type(multipliers_t), intent(in) :: multipliers
    real(wp), intent(in) :: field_slip(:, :)
    type(pattern_t), intent(in) :: row_pattern, pattern
    real(wp), intent(inout) :: rows(:, :, :), tangent(:, :, :)
    integer, intent(out) :: status, place
    type(sample_t) :: sample
    type(batch_t) :: batch
    logical :: pending(slave%per_element), together(slave%per_element)
    type(normals_t) :: normals
    real(wp), allocatable :: extended(:, :), forces(:, :), on_normals(:, :)
    integer, allocatable :: stencils(:, :)
    integer :: columns(size(positions, 2))
    integer :: before, e, k

    if (contracts) call require(is_compressed(row_pattern%start, size(rows, 3)), "integrate_blocks: rows are those of a pattern")
    if (contracts) call require(size(row_pattern%start) == slave%test%count + 1, "integrate_blocks: each test function has a row")
    if (contracts) call require(is_compressed(pattern%start, size(tangent, 3)), "integrate_blocks: blocks are those of a pattern")
    if (contracts) call require(size(pattern%start) == size(positions, 2) + 1, "integrate_blocks: each control point has a row")
    status = status_pattern
    place = 0
    columns = 0
    call map%extend(positions, normals, extended)
    stencils = map%stencils(projections)
    call reserve(slave, map, size(pending), map%vectors(with_friction), size(rows, 2), batch)
    do e = 1, size(slave%test%nodes, 2)
      if (.not. any(multipliers%active(slave%test%nodes(:, e)))) cycle
      before = (e - 1) * size(pending)
      pending = projections%found(before + 1:before + size(pending))
      do while (any(pending))
        k = findloc(pending, .true., dim=1)
        together = pending .and. same_stencil(stencils(:, before + 1:before + size(pending)), k)
        pending = pending .and. .not. together
        batch%count = 0
        do k = 1, size(together)
          if (.not. together(k)) cycle
          call take_sample(slave, map, extended, projections, e, before + k, with_friction, sample)
          call add_sample(slave, map, before + k, projections%slips(before + k), sample, field_slip(:, before + k), &
            fields_at(slave, multipliers, e, before + k), batch)
        end do
        call scatter(normals, slave%test%nodes(:, e), multipliers%active, batch, sample%points, row_pattern, pattern, columns, &
          rows, tangent, place)
        if (place > 0) return
      end do
    end do
    if (map%whole .and. with_friction) then
      call add_metric_rows(slave, positions, projections, multipliers%active, row_pattern, columns, rows, place)
      if (place > 0) return
    end if
    if (normals%count > 0) then
      allocate (forces(3, size(positions, 2)), on_normals(3, normals%count), source=0.0_wp)
      call integrate_each(slave, map, extended, projections, multipliers, forces, on_normals)
      call add_turning(normals, positions, on_normals, pattern, columns, tangent, place)
      if (place > 0) return
    end if
    status = status_ok
  end subroutine integrate_blocks

  !> Add the sums of a batch, in which control points bear and normals of nodes, to what these depend on; `lacking` is a row of a
  !> pattern without one of the blocks, 0: none.
  pure subroutine scatter(normals, nodes, active, batch, points, row_pattern, pattern, columns, rows, tangent, lacking)
    type(normals_t), intent(in) :: normals
    integer, intent(in) :: nodes(:), points(:)
    logical, intent(in) :: active(:)
    type(batch_t), intent(in) :: batch
    type(pattern_t), intent(in) :: row_pattern, pattern
    integer, intent(inout) :: columns(:)
    real(wp), intent(inout) :: rows(:, :, :), tangent(:, :, :)
    integer, intent(out) :: lacking
    type(reached_t) :: reached

    if (normals%count > 0) then
      call reach(normals, size(columns), points, reached)
      call scatter_rows(nodes, active, carry_rows(reached, sum_rows(batch)), reached%point, row_pattern, columns, rows, lacking)
      if (lacking > 0) return
      call scatter_tangent(carry_form(reached, sum_second(batch)), reached%point, pattern, columns, tangent, lacking)
    else
      call scatter_rows(nodes, active, sum_rows(batch), points, row_pattern, columns, rows, lacking)
      if (lacking > 0 .or. .not. allocated(batch%second)) return
      call scatter_tangent(sum_second(batch), points, pattern, columns, tangent, lacking)
    end if
  end subroutine scatter

  !> Which columns are the same as column k.
  pure function same_stencil(stencils, k) result(same)
    integer, intent(in) :: stencils(:, :), k
    logical :: same(size(stencils, 2))
    integer :: a

    same = .true.
    do a = 1, size(stencils, 1)
      same = same .and. stencils(a, :) == stencils(a, k)
    end do
  end function same_stencil

  !> Make room for the quadrature points of an element.
  pure subroutine reserve(slave, map, per_element, vectors, kinds, batch)
    type(slave_t), intent(in) :: slave
    class(gap_map_t), intent(in) :: map
    integer, intent(in) :: per_element, vectors, kinds
    type(batch_t), intent(out) :: batch
    integer :: n

    n = size(slave%shape%nodes, 1) + map%bearing()
    allocate (batch%weight(size(slave%test%nodes, 1), per_element), batch%square_weight(size(slave%test%nodes, 1), per_element))
    allocate (batch%coefficients(n, vectors, per_element), batch%rows(n, 3, per_element, kinds))
    if (map%bends) allocate (batch%second(n, 3, 3, vectors, per_element))
  end subroutine reserve

  !> p, t_1, t_2 at a quadrature point (theory 4.7).
  pure function fields_at(slave, multipliers, e, q) result(field)
    type(slave_t), intent(in) :: slave
    type(multipliers_t), intent(in) :: multipliers
    integer, intent(in) :: e, q
    real(wp) :: field(3)
    integer :: a, i

    field = 0.0_wp
    do a = 1, size(slave%test%nodes, 1)
      i = slave%test%nodes(a, e)
      if (multipliers%active(i)) field = field + slave%test%values(a, q) * [multipliers%pressure(i), multipliers%traction(:, i)]
    end do
  end function fields_at

  !> Control points, kinematics, variations and coefficients of the short vectors at a quadrature point.
  pure subroutine take_sample(slave, map, positions, projections, e, q, of_slip, sample)
    type(slave_t), intent(in) :: slave
    class(gap_map_t), intent(in) :: map
    real(wp), intent(in) :: positions(:, :)
    type(projections_t), intent(in) :: projections
    integer, intent(in) :: e, q
    logical, intent(in) :: of_slip
    type(sample_t), intent(inout) :: sample
    integer :: n

    n = size(slave%shape%nodes, 1)
    if (.not. allocated(sample%points)) then
      allocate (sample%points(n + map%bearing()), sample%coefficients(n + map%bearing(), map%vectors(of_slip)))
      sample%coefficients = 0.0_wp
    end if
    call map%at(slave, positions, projections, q, of_slip, sample%point, sample%points(n + 1:), sample%coefficients(n + 1:, :))
    sample%variations = map%first(sample%point, size(sample%coefficients, 2))
    sample%points(:n) = slave%point(slave%shape%nodes(:, e))
    sample%coefficients(:n, 1) = slave%shape%values(:, q)
    if (map%of_tangents > 0 .and. of_slip) sample%coefficients(:n, map%of_tangents:map%of_tangents + 1) = slave%slopes(:, :, q)
  end subroutine take_sample

  !> Add a quadrature point to a batch.
  pure subroutine add_sample(slave, map, q, slips, sample, field_slip, field, batch)
    type(slave_t), intent(in) :: slave
    class(gap_map_t), intent(in) :: map
    integer, intent(in) :: q
    logical, intent(in) :: slips
    type(sample_t), intent(in) :: sample
    real(wp), intent(in) :: field_slip(2), field(3)
    type(batch_t), intent(inout) :: batch

    batch%count = batch%count + 1
    associate (m => batch%count)
      batch%weight(:, m) = slave%area(q) * slave%test%values(:, q)
      batch%square_weight(:, m) = slave%area(q) * slave%test%values(:, q)**2
      batch%coefficients(:, :, m) = sample%coefficients
      call spread_rows(map, sample, slips, field_slip, size(batch%rows, 4), batch%rows(:, :, m, :))
      if (map%bends) call spread_geometric(map, sample, slave%area(q), field, batch%second(:, :, :, :, m))
    end associate
  end subroutine add_sample

  !> Variations that the constraint rows integrate, by control points: (control point, component, kind).
  pure subroutine spread_rows(map, sample, slips, field_slip, kinds, rows)
    class(gap_map_t), intent(in) :: map
    type(sample_t), intent(in) :: sample
    logical, intent(in) :: slips
    real(wp), intent(in) :: field_slip(2)
    integer, intent(in) :: kinds
    real(wp), intent(out) :: rows(:, :, :)
    real(wp) :: forms(all_components, kinds), metric(all_components, 3)
    real(wp) :: by_vector(size(sample%coefficients, 2), 3 * kinds)
    integer :: i, kind

    forms(:, row_push) = sample%variations%push
    if (map%leans) forms(:, kinds) = sample%variations%gap
    if (has_friction(kinds)) then
      metric = map%metric(sample%point, sample%variations)
      forms(:, row_work:row_work + 1) = sample%variations%slip
      forms(:, row_slip:row_slip + 1) = merge(1.0_wp, 0.0_wp, slips) * sample%variations%projection
      forms(:, row_metric:row_metric + 2) = metric
    end if
    if (kinds == all_rows) then
      forms(:, row_slip_sum) = metric(:, 1) * field_slip(1) + metric(:, 2) * field_slip(2)
      forms(:, row_slip_sum + 1) = metric(:, 2) * field_slip(1) + metric(:, 3) * field_slip(2)
    end if
    do kind = 1, kinds
      do i = 1, 3
        by_vector(:, 3 * (kind - 1) + i) = forms(i:3 * size(by_vector, 1):3, kind)
      end do
    end do
    rows = reshape(matmul(sample%coefficients, by_vector), shape(rows))
  end subroutine spread_rows

  !> area * (p Ddg + t_a Ddxi^a) by short vectors on the left and control points on the right:
  !> (right control point, left component, right component, left vector).
  pure subroutine spread_geometric(map, sample, area, field, second)
    class(gap_map_t), intent(in) :: map
    type(sample_t), intent(in) :: sample
    real(wp), intent(in) :: area, field(3)
    real(wp), intent(out) :: second(:, :, :, :)
    real(wp) :: form(3 * size(second, 4), 3 * size(second, 4)), by_vector(size(second, 4), 3, 3, size(second, 4))
    integer :: k, l, vectors

    vectors = size(second, 4)
    form = 0.0_wp
    call map%second(sample%point, sample%variations, area * field(1), area * field(2:3), form)
    if (contracts .and. norm2(field(2:3)) <= 0.0_wp) call require(map%leans .or. is_symmetric(form), "spread_geometric: so is Ddg")
    do k = 1, vectors
      do l = 1, vectors
        by_vector(l, :, :, k) = form(3 * k - 2:3 * k, 3 * l - 2:3 * l)
      end do
    end do
    second = reshape(matmul(sample%coefficients, reshape(by_vector, [vectors, 9 * vectors])), shape(second))
  end subroutine spread_geometric

  !> Add <R^I R^I da_ab> over the points without a foot, of the slave's own metric; `lacking` as above (theory 3.30).
  pure subroutine add_metric_rows(slave, positions, projections, active, pattern, columns, rows, lacking)
    type(slave_t), intent(in) :: slave
    real(wp), intent(in) :: positions(:, :)
    type(projections_t), intent(in) :: projections
    logical, intent(in) :: active(:)
    type(pattern_t), intent(in) :: pattern
    integer, intent(inout) :: columns(:)
    real(wp), intent(inout) :: rows(:, :, :)
    integer, intent(out) :: lacking
    integer :: a, b, e, q
    real(wp) :: changes(3, 3), tangents(3, 2)

    do q = 1, size(slave%area)
      if (projections%found(q)) cycle
      e = (q - 1) / slave%per_element + 1
      tangents = slave_tangents(slave, positions, q)
      do a = 1, size(slave%test%nodes, 1)
        if (.not. active(slave%test%nodes(a, e))) cycle
        lacking = slave%test%nodes(a, e)
        call mark_row(pattern, lacking, columns)
        if (lacks(pattern, lacking, columns, slave%point(slave%shape%nodes(:, e)))) return
        do b = 1, size(slave%shape%nodes, 1)
          associate (slope => slave%slopes(b, :, q), column => columns(slave%point(slave%shape%nodes(b, e))))
            changes(:, 1) = 2.0_wp * slope(1) * tangents(:, 1)
            changes(:, 2) = slope(1) * tangents(:, 2) + slope(2) * tangents(:, 1)
            changes(:, 3) = 2.0_wp * slope(2) * tangents(:, 2)
            rows(:, row_metric:row_metric + 2, column) = rows(:, row_metric:row_metric + 2, column) &
              + slave%area(q) * slave%test%values(a, q)**2 * changes
          end associate
        end do
      end do
    end do
    lacking = 0
  end subroutine add_metric_rows

  !> Rows of a batch, summed over its quadrature points: (control point, component, slave control point, kind).
  pure function sum_rows(batch) result(sums)
    type(batch_t), intent(in) :: batch
    real(wp) :: sums(size(batch%rows, 1), 3, size(batch%weight, 1), size(batch%rows, 4))
    integer :: kind

    associate (points => size(sums, 1), nodes => size(sums, 3))
      do kind = 1, size(sums, 4)
        if (kind >= row_metric .and. kind < row_metric + 3) then
          call sum_points(3 * points, batch%count, nodes, batch%rows(:, :, :, kind), batch%square_weight, sums(:, :, :, kind))
        else
          call sum_points(3 * points, batch%count, nodes, batch%rows(:, :, :, kind), batch%weight, sums(:, :, :, kind))
        end if
      end do
    end associate
  end function sum_rows

  !> Add the rows of a batch to those of its active slave control points; `lacking` is a row without one of the blocks, 0: none.
  pure subroutine scatter_rows(nodes, active, sums, points, pattern, columns, rows, lacking)
    integer, intent(in) :: nodes(:), points(:)
    logical, intent(in) :: active(:)
    real(wp), intent(in) :: sums(:, :, :, :)
    type(pattern_t), intent(in) :: pattern
    integer, intent(inout) :: columns(:)
    real(wp), intent(inout) :: rows(:, :, :)
    integer, intent(out) :: lacking
    integer :: a, i

    do i = 1, size(nodes)
      if (.not. active(nodes(i))) cycle
      lacking = nodes(i)
      call mark_row(pattern, lacking, columns)
      if (lacks(pattern, lacking, columns, points)) return
      do a = 1, size(points)
        associate (row => rows(:, :, columns(points(a))))
          row = row + sums(a, :, i, :)
        end associate
      end do
    end do
    lacking = 0
  end subroutine scatter_rows

  !> sums = left right^T, over m quadrature points.
  pure subroutine sum_points(n_left, m, n_right, left, right, sums)
    integer, intent(in) :: n_left, m, n_right
    real(wp), intent(in) :: left(n_left, m), right(n_right, m)
    real(wp), intent(out) :: sums(n_left, n_right)

    sums = matmul(left, transpose(right))
  end subroutine sum_points

  !> Geometric tangent of a batch: (right control point, left component, right component, left control point).
  pure function sum_second(batch) result(sums)
    type(batch_t), intent(in) :: batch
    real(wp) :: sums(size(batch%second, 1), 3, 3, size(batch%second, 1))

    associate (points => size(sums, 1))
      call sum_points(9 * points, size(batch%coefficients, 2) * batch%count, points, batch%second, batch%coefficients, sums)
    end associate
  end function sum_second

  !> Add the geometric tangent of a batch; `lacking` as above.
  pure subroutine scatter_tangent(sums, points, pattern, columns, tangent, lacking)
    real(wp), intent(in) :: sums(:, :, :, :)
    integer, intent(in) :: points(:)
    type(pattern_t), intent(in) :: pattern
    integer, intent(inout) :: columns(:)
    real(wp), intent(inout) :: tangent(:, :, :)
    integer, intent(out) :: lacking
    integer :: a, b

    do a = 1, size(points)
      lacking = points(a)
      call mark_row(pattern, lacking, columns)
      if (lacks(pattern, lacking, columns, points)) return
      do b = 1, size(points)
        associate (block => tangent(:, :, columns(points(b))))
          block = block + transpose(sums(b, :, :, a))
        end associate
      end do
    end do
    lacking = 0
  end subroutine scatter_tangent

end module isomortar_contact_blocks
