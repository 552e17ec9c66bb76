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
  use isomortar_contact_batch, only: add_sample, batch_t, reserve, scatter
  use isomortar_contact_gap_map_map, only: all_components, for_forces, for_gap, for_tangent, gap_map_t, projections_t
  use isomortar_contact_gap_map_nodal_normals, only: add_turning, carry, normals_t
  use isomortar_contact_rows, only: row_metric
  use isomortar_contact_sample, only: fields_at, multipliers_t, sample_t, take_sample
  use isomortar_contact_slave, only: slave_t, slave_tangents
  use isomortar_contact_work, only: work_t
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
    real(wp), intent(inout) :: forces(:, :)
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
    real(wp), intent(inout) :: forces(:, :), on_normals(:, :)
    type(work_t), intent(inout) :: work
    type(sample_t) :: sample
    real(wp) :: field(3), force(3), row(all_components)
    integer :: a, e, k, n, q

    n = size(forces, 2)
    do e = 1, size(slave%test%nodes, 2)
      if (.not. any(multipliers%active(slave%test%nodes(:, e)))) cycle
      do q = (e - 1) * slave%per_element + 1, e * slave%per_element
        if (.not. projections%found(q)) cycle
        call take_sample(slave, map, positions, projections, e, q, merge(for_forces, for_gap, with_friction), sample, work)
        field = fields_at(slave, multipliers, e, q)
        associate (components => 3 * size(sample%coefficients, 2), slip => sample%variations%slip)
          row(:components) = slave%area(q) * (field(1) * sample%variations%pressure_work(:components) &
            + field(2) * slip(:components, 1) + field(3) * slip(:components, 2))
        end associate
        do a = 1, size(sample%points)
          force = 0.0_wp
          do k = 1, size(sample%coefficients, 2)
            force = force + sample%coefficients(a, k) * row(3 * k - 2:3 * k)
          end do
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
    real(wp), intent(inout) :: rows(:, :, :), tangent(:, :, :)
    integer, intent(out) :: status, place
    type(work_t), intent(inout) :: work
    type(sample_t) :: sample
    type(batch_t) :: batch
    logical :: pending(slave%per_element), together(slave%per_element)
    type(normals_t) :: normals
    real(wp), allocatable :: extended(:, :), forces(:, :), on_normals(:, :)
    integer, allocatable :: columns(:), stencils(:, :)
    integer :: before, e, k, wanted

    if (contracts) call require(is_compressed(row_pattern%start, size(rows, 3)), "integrate_blocks: rows are those of a pattern")
    if (contracts) call require(size(row_pattern%start) == slave%test%count + 1, "integrate_blocks: each test function has a row")
    if (contracts) call require(is_compressed(pattern%start, size(tangent, 3)), "integrate_blocks: blocks are those of a pattern")
    if (contracts) call require(size(pattern%start) == size(positions, 2) + 1, "integrate_blocks: each control point has a row")
    status = status_pattern
    place = 0
    allocate (columns(size(positions, 2)), source=0)
    call map%extend(positions, normals, extended, work)
    stencils = map%stencils(projections)
    wanted = merge(for_tangent, for_forces, with_friction)
    call reserve(slave, map, size(pending), map%vectors(wanted), size(rows, 2), batch)
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
          call take_sample(slave, map, extended, projections, e, before + k, wanted, sample, work)
          call add_sample(slave, map, before + k, projections%slips(before + k), sample, field_slip(:, before + k), &
            fields_at(slave, multipliers, e, before + k), batch)
        end do
        call scatter(normals, slave%test%nodes(:, e), multipliers%active, batch, sample%points, row_pattern, pattern, columns, &
          rows, tangent, place)
        if (place > 0) return
      end do
    end do
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
