!> Second pass over the slave quadrature points: contact forces, constraint rows and the geometric tangent.
!>
!> The rows are returned apart from what they are multiplied with, so that one pass serves every way of enforcing contact.
!>
!> - `slave`, `map`: the slave side, and the gap map onto its master.
!> - `positions` (3, control points): of all control points, L. `projections`: feet of the quadrature points there.
!> - `multipliers`: those that act. `with_friction`: whether tractions may act. `work`: counts of what is done.
module isomortar_contact_blocks
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_compressed
  use isomortar_base_status, only: status_ok, status_pattern
  use isomortar_contact_batch, only: add_sample, batch_t, reserve, scatter, sum_up, sums_t
  use isomortar_contact_gap_map_map, only: all_components, for_forces, for_gap, for_tangent, gap_map_t, projections_t
  use isomortar_contact_gap_map_nodal_normals, only: add_turning, carry, normals_t
  use isomortar_contact_rows, only: row_metric
  use isomortar_contact_sample, only: fields_at, multipliers_t, sample_t, take_sample
  use isomortar_contact_slave, only: slave_t, slave_tangents
  use isomortar_contact_work, only: gather_work, work_t
  use isomortar_sparse_blocks, only: lacks, mark_row, pattern_t
  implicit none
  private

  public :: integrate_blocks, integrate_forces

contains

  !> Add the contact forces r(d) = sum p^I <R^I dg> + sum t_a^I <R^I dxi^a> (theory 4.7) to `forces` (3, control points), F.
  subroutine integrate_forces(slave, map, positions, projections, with_friction, multipliers, forces, work)
    type(slave_t), intent(in) :: slave
    class(gap_map_t), intent(in) :: map
    real(wp), intent(in) :: positions(:, :)
    type(projections_t), intent(in) :: projections
    logical, intent(in) :: with_friction
    type(multipliers_t), intent(in) :: multipliers
    real(wp), contiguous, intent(inout) :: forces(:, :)
    type(work_t), intent(inout) :: work
    type(normals_t) :: normals
    real(wp), allocatable :: extended(:, :), on_normals(:, :)

    if (contracts) call require(all(shape(forces) == shape(positions)), "integrate_forces: forces are those of the positions")
    call map%extend(positions, normals, extended, work)
    allocate (on_normals(3, normals%count), source=0.0_wp)
    call integrate_each(slave, map, extended, projections, with_friction, multipliers, forces, on_normals, work)
    call carry(normals, on_normals, forces)
  end subroutine integrate_forces

  !> Add the contact forces on control points, and those on normals of nodes, which stand after these in `positions`.
  subroutine integrate_each(slave, map, positions, projections, with_friction, multipliers, forces, on_normals, work)
    type(slave_t), intent(in) :: slave
    class(gap_map_t), intent(in) :: map
    real(wp), intent(in) :: positions(:, :)
    type(projections_t), intent(in) :: projections
    logical, intent(in) :: with_friction
    type(multipliers_t), intent(in) :: multipliers
    real(wp), contiguous, intent(inout) :: forces(:, :), on_normals(:, :)
    type(work_t), intent(inout) :: work
    type(sample_t) :: sample
    type(work_t), allocatable :: works(:)
    real(wp), allocatable :: parts(:, :, :)
    integer, allocatable :: points(:, :)
    integer :: e

    allocate (works(size(slave%test%nodes, 2)))
    !$omp parallel default(none) private(sample, parts, points) shared(slave, map, positions, projections, with_friction) &
    !$omp shared(multipliers, forces, on_normals, works)
    !$omp do ordered schedule(dynamic)
    do e = 1, size(works)
      call forces_of_element(slave, map, positions, projections, with_friction, multipliers, e, sample, points, parts, works(e))
      !$omp ordered
      call add_parts(points, parts, forces, on_normals)
      !$omp end ordered
    end do
    !$omp end do
    !$omp end parallel
    call gather_work(works, work)
  end subroutine integrate_each

  !> Forces `parts` (3, bearing, points of an element) of the quadrature points of slave element `e` on what bears there, `points`
  !> (bearing, points of an element): 0 at a point without.
  pure subroutine forces_of_element(slave, map, positions, projections, with_friction, multipliers, e, sample, points, parts, work)
    type(slave_t), intent(in) :: slave
    class(gap_map_t), intent(in) :: map
    real(wp), intent(in) :: positions(:, :)
    type(projections_t), intent(in) :: projections
    logical, intent(in) :: with_friction
    type(multipliers_t), intent(in) :: multipliers
    integer, intent(in) :: e
    type(sample_t), intent(inout) :: sample
    integer, allocatable, intent(inout) :: points(:, :)
    real(wp), allocatable, intent(inout) :: parts(:, :, :)
    type(work_t), intent(inout) :: work
    real(wp) :: field(3), force(3), row(all_components)
    integer :: a, i, k, q

    if (.not. allocated(points)) then
      associate (n => size(slave%shape%nodes, 1) + map%bearing())
        allocate (points(n, slave%per_element), parts(3, n, slave%per_element))
      end associate
    end if
    points = 0
    if (.not. any(multipliers%active(slave%test%nodes(:, e)))) return
    do i = 1, slave%per_element
      q = (e - 1) * slave%per_element + i
      if (.not. projections%found(q)) cycle
      call take_sample(slave, map, positions, projections, e, q, merge(for_forces, for_gap, with_friction), sample, work)
      field = fields_at(slave, multipliers, e, q)
      associate (components => 3 * size(sample%coefficients, 2), slip => sample%variations%slip)
        row(:components) = slave%area(q) * (field(1) * sample%variations%pressure_work(:components) &
          + field(2) * slip(:components, 1) + field(3) * slip(:components, 2))
      end associate
      points(:, i) = sample%points
      do a = 1, size(sample%points)
        force = 0.0_wp
        do k = 1, size(sample%coefficients, 2)
          force = force + sample%coefficients(a, k) * row(3 * k - 2:3 * k)
        end do
        parts(:, a, i) = force
      end do
    end do
  end subroutine forces_of_element

  !> Add the forces of an element's points to those on control points and on normals, which are counted on from these.
  pure subroutine add_parts(points, parts, forces, on_normals)
    integer, intent(in) :: points(:, :)
    real(wp), contiguous, intent(in) :: parts(:, :, :)
    real(wp), contiguous, intent(inout) :: forces(:, :), on_normals(:, :)
    integer :: a, i, n

    n = size(forces, 2)
    do i = 1, size(points, 2)
      if (points(1, i) == 0) cycle
      do a = 1, size(points, 1)
        if (points(a, i) <= n) then
          forces(1:3, points(a, i)) = forces(1:3, points(a, i)) + parts(1:3, a, i)
        else
          on_normals(1:3, points(a, i) - n) = on_normals(1:3, points(a, i) - n) + parts(1:3, a, i)
        end if
      end do
    end do
  end subroutine add_parts

  !> Add constraint rows and the geometric tangent <p Ddg> + <t_a Ddxi^a> (theory 4.8).
  !>
  !> - `field_slip` (2, points): field of control slips, P, for the slip sum's rows.
  !> - `row_pattern`, `rows` (component, kind, blocks): for each test function (row) the control points (columns) that its rows
  !>   reach, and these rows (isomortar_contact_rows).
  !> - `pattern`, `tangent` (column component, row component, blocks): pattern of the tangent, and this, F/L.
  !> - `status`, `place`: how it ended (isomortar_base_status), and on failure the row of a pattern that lacks a block.
  subroutine integrate_blocks(slave, map, positions, projections, with_friction, multipliers, field_slip, row_pattern, rows, &
      pattern, tangent, status, place, work)
    type(slave_t), intent(in) :: slave
    class(gap_map_t), intent(in) :: map
    real(wp), intent(in) :: positions(:, :)
    type(projections_t), intent(in) :: projections
    logical, intent(in) :: with_friction
    type(multipliers_t), intent(in) :: multipliers
    real(wp), intent(in) :: field_slip(:, :)
    type(pattern_t), intent(in) :: row_pattern, pattern
    real(wp), contiguous, intent(inout) :: rows(:, :, :), tangent(:, :, :)
    integer, intent(out) :: status, place
    type(work_t), intent(inout) :: work
    type(sample_t) :: sample
    type(batch_t) :: batch
    type(sums_t) :: sums
    type(normals_t) :: normals
    type(work_t), allocatable :: works(:)
    real(wp), allocatable :: extended(:, :), forces(:, :), on_normals(:, :)
    integer, allocatable :: columns(:), element(:), group(:)
    integer :: g, wanted

    if (contracts) call require(is_compressed(row_pattern%start, size(rows, 3)), "integrate_blocks: rows are those of a pattern")
    if (contracts) call require(size(row_pattern%start) == slave%test%count + 1, "integrate_blocks: each test function has a row")
    if (contracts) call require(is_compressed(pattern%start, size(tangent, 3)), "integrate_blocks: blocks are those of a pattern")
    if (contracts) call require(size(pattern%start) == size(positions, 2) + 1, "integrate_blocks: each control point has a row")
    status = status_pattern
    place = 0
    allocate (columns(size(positions, 2)), source=0)
    call map%extend(positions, normals, extended, work)
    call number_groups(slave, multipliers%active, projections%found, map%stencils(projections), group, element)
    wanted = merge(for_tangent, for_forces, with_friction)
    allocate (works(size(element)))
    !$omp parallel default(none) private(sample, batch, sums) shared(slave, map, extended, projections, multipliers, field_slip) &
    !$omp shared(wanted, element, group, normals, row_pattern, pattern, columns, rows, tangent, place, works)
    call reserve(slave, map, slave%per_element, map%vectors(wanted), size(rows, 2), batch)
    !$omp do ordered schedule(dynamic)
    do g = 1, size(works)
      call take_group(slave, map, extended, projections, multipliers, field_slip, wanted, element(g), &
        group((element(g) - 1) * slave%per_element + 1:element(g) * slave%per_element) == g, sample, batch, works(g))
      call sum_up(normals, size(columns), sample%points, batch, sums)
      !$omp ordered
      if (place == 0) call scatter(slave%test%nodes(:, element(g)), multipliers%active, sums, row_pattern, pattern, columns, rows, &
        tangent, place)
      !$omp end ordered
    end do
    !$omp end do
    !$omp end parallel
    call gather_work(works, work)
    if (place > 0) return
    if (map%counts_all_points .and. with_friction) then
      call add_metric_rows(slave, positions, projections, multipliers%active, row_pattern, columns, rows, place)
      if (place > 0) return
    end if
    if (normals%count > 0) then
      allocate (forces(3, size(positions, 2)), on_normals(3, normals%count), source=0.0_wp)
      call integrate_each(slave, map, extended, projections, with_friction, multipliers, forces, on_normals, work)
      call add_turning(normals, positions, on_normals, pattern, columns, tangent, place, work)
      if (place > 0) return
    end if
    status = status_ok
  end subroutine integrate_blocks

  !> Number the quadrature points that bear on the same control points, of each active slave element: `group` (points), 0 where
  !> there is nothing to add; `element` (groups) of each. `stencils` (any, points) says what a point bears on.
  pure subroutine number_groups(slave, active, found, stencils, group, element)
    type(slave_t), intent(in) :: slave
    logical, intent(in) :: active(:), found(:)
    integer, intent(in) :: stencils(:, :)
    integer, allocatable, intent(out) :: group(:), element(:)
    integer, allocatable :: owner(:)
    integer :: e, groups, k, q

    allocate (group(size(found)), source=0)
    allocate (owner(size(found)))
    groups = 0
    do e = 1, size(slave%test%nodes, 2)
      if (.not. any(active(slave%test%nodes(:, e)))) cycle
      do q = (e - 1) * slave%per_element + 1, e * slave%per_element
        if (.not. found(q) .or. group(q) > 0) cycle
        groups = groups + 1
        owner(groups) = e
        do k = q, e * slave%per_element
          if (found(k) .and. group(k) == 0 .and. all(stencils(:, k) == stencils(:, q))) group(k) = groups
        end do
      end do
    end do
    element = owner(:groups)
  end subroutine number_groups

  !> Put the quadrature points of a group, of slave element `e`, into a batch: those that are `in_group` (points of the element).
  pure subroutine take_group(slave, map, positions, projections, multipliers, field_slip, wanted, e, in_group, sample, batch, work)
    type(slave_t), intent(in) :: slave
    class(gap_map_t), intent(in) :: map
    real(wp), intent(in) :: positions(:, :), field_slip(:, :)
    type(projections_t), intent(in) :: projections
    type(multipliers_t), intent(in) :: multipliers
    integer, intent(in) :: wanted, e
    logical, intent(in) :: in_group(:)
    type(sample_t), intent(inout) :: sample
    type(batch_t), intent(inout) :: batch
    type(work_t), intent(inout) :: work
    integer :: k, q

    batch%count = 0
    do k = 1, size(in_group)
      if (.not. in_group(k)) cycle
      q = (e - 1) * slave%per_element + k
      call take_sample(slave, map, positions, projections, e, q, wanted, sample, work)
      call add_sample(slave, map, q, projections%slips(q), sample, field_slip(:, q), fields_at(slave, multipliers, e, q), batch)
    end do
  end subroutine take_group

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

end module isomortar_contact_blocks
