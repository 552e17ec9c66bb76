!> Sums over slave quadrature points that share their control points: products of matrices, and where they are added.
!>
!> - `slave`, `map`: the slave side, and the gap map onto its master. `batch`: the sums.
module isomortar_contact_batch
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_symmetric
  use isomortar_contact_gap_map_map, only: all_components, gap_map_t
  use isomortar_contact_gap_map_nodal_normals, only: normals_t
  use isomortar_contact_gap_map_reach, only: carry_form, carry_rows, reach, reached_t
  use isomortar_contact_rows, only: row_metric, row_pressure_work, row_slip, row_slip_sum, row_traction_work, rows_of, rows_t
  use isomortar_contact_sample, only: sample_t
  use isomortar_contact_slave, only: slave_t
  use isomortar_sparse_blocks, only: lacks, mark_row, pattern_t
  implicit none
  private

  public :: add_sample, reserve, scatter, sum_up

  !> Quadrature points of a slave element that project on the same master element. They share their control points, so that the sums
  !> over them are products of matrices.
  type, public :: batch_t
    !> Quadrature points in it.
    integer :: count
    !> Area times R^I, (slave control points, quadrature points), and the same with R^I R^I.
    real(wp), allocatable :: weight(:, :), square_weight(:, :)
    !> Coefficients of the short vectors, (control points, vectors, quadrature points).
    real(wp), allocatable :: coefficients(:, :, :)
    !> Variations that the rows integrate, (control points, component, quadrature points, kind).
    real(wp), allocatable :: rows(:, :, :, :)
    !> Second variations by short vectors on the left, by control points on the right:
    !> (right control point, right component, left component, left vector, quadrature points).
    real(wp), allocatable :: second(:, :, :, :, :)
  end type batch_t

  !> What a batch adds, by the control points that it reaches.
  type, public :: sums_t
    integer, allocatable :: points(:)
    !> Constraint rows, (control point, component, slave control point, kind).
    real(wp), allocatable :: rows(:, :, :, :)
    !> Geometric tangent, (right control point, right component, left component, left control point); of maps that bend.
    real(wp), allocatable :: second(:, :, :, :)
  end type sums_t

contains

  !> Make room for the quadrature points of an element, of which there are `per_element`.
  !>
  !> - `vectors`, `kinds`: numbers of short vectors, and of kinds of constraint rows.
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

  !> Add quadrature point `q` to a batch.
  !>
  !> - `slips`: whether its slip counts. `sample`: what bears on it.
  !> - `field_slip`: field of control slips there, P. `field`: p, t_1, t_2 there, F/L^2 and F/(L P).
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
    type(rows_t) :: there
    integer :: i, kind

    there = rows_of(kinds)
    forms(:, row_pressure_work) = sample%variations%pressure_work
    if (map%has_gap_row) forms(:, there%gap) = sample%variations%gap
    if (there%friction) then
      metric = map%metric(sample%point, sample%variations)
      forms(:, row_traction_work:row_traction_work + 1) = sample%variations%slip
      forms(:, row_slip:row_slip + 1) = merge(1.0_wp, 0.0_wp, slips) * sample%variations%projection
      forms(:, row_metric:row_metric + 2) = metric
    end if
    if (there%slip_sum) then
      forms(:, row_slip_sum) = metric(:, 1) * field_slip(1) + metric(:, 2) * field_slip(2)
      forms(:, row_slip_sum + 1) = metric(:, 2) * field_slip(1) + metric(:, 3) * field_slip(2)
    end if
    do kind = 1, kinds
      do i = 1, 3
        by_vector(:, 3 * (kind - 1) + i) = forms(i:3 * size(by_vector, 1):3, kind)
      end do
    end do
    call to_points(sample%coefficients, 3 * kinds, by_vector, rows)
  end subroutine spread_rows

  !> area * (p Ddg + t_a Ddxi^a) by short vectors on the left and control points on the right:
  !> (right control point, right component, left component, left vector).
  pure subroutine spread_geometric(map, sample, area, field, second)
    class(gap_map_t), intent(in) :: map
    type(sample_t), intent(in) :: sample
    real(wp), intent(in) :: area, field(3)
    real(wp), contiguous, intent(out) :: second(:, :, :, :)
    real(wp) :: form(3 * size(second, 4), 3 * size(second, 4)), by_vector(size(second, 4), 3, 3, size(second, 4))
    integer :: k, l, vectors

    vectors = size(second, 4)
    form = 0.0_wp
    call map%second(sample%point, sample%variations, area * field(1), area * field(2:3), form)
    if (contracts .and. norm2(field(2:3)) <= 0.0_wp) call require(map%has_gap_row .or. is_symmetric(form), "spread_geometric: Ddg")
    do k = 1, vectors
      do l = 1, vectors
        by_vector(l, :, :, k) = transpose(form(3 * k - 2:3 * k, 3 * l - 2:3 * l))
      end do
    end do
    call to_points(sample%coefficients, 9 * vectors, by_vector, second)
  end subroutine spread_geometric

  !> Of m numbers for each short vector those for each control point.
  pure subroutine to_points(coefficients, m, by_vector, by_point)
    integer, intent(in) :: m
    real(wp), intent(in) :: coefficients(:, :), by_vector(size(coefficients, 2), m)
    real(wp), intent(out) :: by_point(size(coefficients, 1), m)

    by_point = matmul(coefficients, by_vector)
  end subroutine to_points

  !> The `sums` of a batch, in which control points bear and normals of nodes, by the control points that these depend on.
  !>
  !> - `normals`: normals of nodes. `n`: number of control points. `points` (bearing): what bears, normals counted on from these.
  pure subroutine sum_up(normals, n, points, batch, sums)
    type(normals_t), intent(in) :: normals
    integer, intent(in) :: n, points(:)
    type(batch_t), intent(in) :: batch
    type(sums_t), intent(inout) :: sums
    type(reached_t) :: reached
    real(wp), allocatable :: rows(:, :, :, :), second(:, :, :, :)

    if (normals%count > 0) then
      call reach(normals, n, points, reached)
      sums%points = reached%point
      call sum_rows(batch, rows)
      call carry_rows(reached, rows, sums%rows)
      if (.not. allocated(batch%second)) return
      call sum_second(batch, second)
      call carry_form(reached, second, sums%second)
    else
      sums%points = points
      call sum_rows(batch, sums%rows)
      if (allocated(batch%second)) call sum_second(batch, sums%second)
    end if
  end subroutine sum_up

  !> Add the `sums` of a batch to constraint rows and tangent.
  !>
  !> - `nodes` (functions of an element), `active` (test functions): test functions of the element; which of all act.
  !> - `row_pattern`, `rows` (component, kind, blocks): pattern of the constraint rows, and these (isomortar_contact_rows).
  !> - `pattern`, `tangent` (column component, row component, blocks): pattern of the tangent, and this, F/L.
  !> - `columns` (control points): to mark places of blocks in (isomortar_sparse_blocks), zero at first.
  !> - `lacking`: a row of a pattern without one of the blocks, 0: none.
  pure subroutine scatter(nodes, active, sums, row_pattern, pattern, columns, rows, tangent, lacking)
    integer, intent(in) :: nodes(:)
    logical, intent(in) :: active(:)
    type(sums_t), intent(in) :: sums
    type(pattern_t), intent(in) :: row_pattern, pattern
    integer, intent(inout) :: columns(:)
    real(wp), contiguous, intent(inout) :: rows(:, :, :), tangent(:, :, :)
    integer, intent(out) :: lacking

    call scatter_rows(nodes, active, sums%rows, sums%points, row_pattern, columns, rows, lacking)
    if (lacking > 0 .or. .not. allocated(sums%second)) return
    call scatter_tangent(sums%second, sums%points, pattern, columns, tangent, lacking)
  end subroutine scatter

  !> Rows of a batch, summed over its quadrature points: (control point, component, slave control point, kind).
  pure subroutine sum_rows(batch, sums)
    type(batch_t), intent(in) :: batch
    real(wp), allocatable, intent(out) :: sums(:, :, :, :)
    integer :: kind

    allocate (sums(size(batch%rows, 1), 3, size(batch%weight, 1), size(batch%rows, 4)))
    associate (points => size(sums, 1), nodes => size(sums, 3))
      do kind = 1, size(sums, 4)
        if (kind >= row_metric .and. kind < row_metric + 3) then
          call sum_points(3 * points, batch%count, nodes, batch%rows(:, :, :, kind), batch%square_weight, sums(:, :, :, kind))
        else
          call sum_points(3 * points, batch%count, nodes, batch%rows(:, :, :, kind), batch%weight, sums(:, :, :, kind))
        end if
      end do
    end associate
  end subroutine sum_rows

  !> Geometric tangent of a batch: (right control point, right component, left component, left control point).
  pure subroutine sum_second(batch, sums)
    type(batch_t), intent(in) :: batch
    real(wp), allocatable, intent(out) :: sums(:, :, :, :)

    allocate (sums(size(batch%second, 1), 3, 3, size(batch%second, 1)))
    associate (points => size(sums, 1))
      call sum_points(9 * points, size(batch%coefficients, 2) * batch%count, points, batch%second, batch%coefficients, sums)
    end associate
  end subroutine sum_second

  !> sums = left right^T, over m quadrature points.
  pure subroutine sum_points(n_left, m, n_right, left, right, sums)
    integer, intent(in) :: n_left, m, n_right
    real(wp), intent(in) :: left(n_left, m), right(n_right, m)
    real(wp), intent(out) :: sums(n_left, n_right)

    sums = matmul(left, transpose(right))
  end subroutine sum_points

  !> Add the rows of a batch to those of its active slave control points; `lacking` is a row without one of the blocks, 0: none.
  pure subroutine scatter_rows(nodes, active, sums, points, pattern, columns, rows, lacking)
    integer, intent(in) :: nodes(:), points(:)
    logical, intent(in) :: active(:)
    real(wp), contiguous, intent(in) :: sums(:, :, :, :)
    type(pattern_t), intent(in) :: pattern
    integer, intent(inout) :: columns(:)
    real(wp), contiguous, intent(inout) :: rows(:, :, :)
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

  !> Add the geometric tangent of a batch; `lacking` as above.
  pure subroutine scatter_tangent(sums, points, pattern, columns, tangent, lacking)
    real(wp), contiguous, intent(in) :: sums(:, :, :, :)
    integer, intent(in) :: points(:)
    type(pattern_t), intent(in) :: pattern
    integer, intent(inout) :: columns(:)
    real(wp), contiguous, intent(inout) :: tangent(:, :, :)
    integer, intent(out) :: lacking
    integer :: a, b, i

    do a = 1, size(points)
      lacking = points(a)
      call mark_row(pattern, lacking, columns)
      if (lacks(pattern, lacking, columns, points)) return
      do b = 1, size(points)
        associate (block => tangent(:, :, columns(points(b))))
          do i = 1, 3
            block(1:3, i) = block(1:3, i) + sums(b, 1:3, i, a)
          end do
        end associate
      end do
    end do
    lacking = 0
  end subroutine scatter_tangent

end module isomortar_contact_batch
