!> Second pass over the slave quadrature points: contact forces, constraint rows and the geometric tangent.
!>
!> The rows are returned apart from what they are multiplied with, so that one pass serves every way of enforcing contact.
module isomortar_contact_blocks
  use isomortar_base_kinds, only: wp
  use isomortar_contact_control, only: point_on_master, projections_t
  use isomortar_contact_kinematics, only: all_components, contact_point_t, first_variations, gap_variation, metric_variation, &
    short_vectors, traction_variation, variations_t
  use isomortar_contact_master, only: master_order, master_point_count, master_t
  use isomortar_contact_slave, only: slave_t
  use isomortar_nurbs_surface, only: derivative_columns
  use isomortar_sparse_blocks, only: mark_row, pattern_t
  implicit none
  private

  public :: integrate_blocks, integrate_forces

  !> Kinds of constraint rows: <R^I dg>, <R^I slip^a> that tractions work on, <R^I dxi^a> over points with a history,
  !> <R^I R^I da_ab>, <R^I da_ab zeta^b>.
  integer, parameter, public :: row_gap = 1
  integer, parameter, public :: row_work = 2
  integer, parameter, public :: row_slip = 4
  integer, parameter, public :: row_metric = 6
  integer, parameter, public :: row_slip_sum = 9
  integer, parameter, public :: all_rows = 10

  !> Control values that the fields are made of.
  type, public :: multipliers_t
    real(wp), allocatable :: pressure(:)
    real(wp), allocatable :: traction(:, :)
    !> Only active control points contribute.
    logical, allocatable :: active(:)
  end type multipliers_t

  !> One slave element: its control points of both sides and its dense contributions.
  type :: element_t
    !> Number of control points; slave ones come first.
    integer :: count
    integer, allocatable :: points(:)
    real(wp), allocatable :: rows(:, :, :)
    real(wp), allocatable :: tangent(:, :)
  end type element_t

  !> One quadrature point: control points within the element, coefficients of the short vectors, variations.
  type :: sample_t
    type(contact_point_t) :: point
    type(variations_t) :: variations
    integer, allocatable :: local(:)
    real(wp), allocatable :: coefficients(:, :)
  end type sample_t

contains

  !> Add the contact forces r(d) = sum p^I <R^I dg> + sum t_a^I <R^I dxi^a>.
  subroutine integrate_forces(slave, master, positions, projections, with_friction, multipliers, forces)
    type(slave_t), intent(in) :: slave
    type(master_t), intent(in) :: master
    real(wp), intent(in) :: positions(:, :)
    type(projections_t), intent(in) :: projections
    logical, intent(in) :: with_friction
    type(multipliers_t), intent(in) :: multipliers
    real(wp), intent(inout) :: forces(:, :)
    type(element_t) :: element
    type(sample_t) :: sample
    real(wp) :: field(3), row(all_components)
    integer, allocatable :: mark(:)
    integer :: a, e, per_element, q

    allocate (mark(size(positions, 2)))
    mark = 0
    per_element = size(slave%area) / size(slave%nodes, 2)
    call reserve(slave, master, per_element, element, sample)
    do e = 1, size(slave%nodes, 2)
      if (.not. any(multipliers%active(slave%nodes(:, e)))) cycle
      call begin_element(slave, e, element)
      do q = (e - 1) * per_element + 1, e * per_element
        if (.not. projections%found(q)) cycle
        call take_sample(slave, master, positions, projections, e, q, merge(0, 2, master%is_plane), with_friction, &
          element, mark, sample)
        field = fields_at(slave, multipliers, e, q)
        row = slave%area(q) * (field(1) * sample%variations%gap + matmul(sample%variations%slip, field(2:3)))
        do a = 1, size(sample%local)
          associate (force => forces(:, element%points(sample%local(a))))
            force = force + matmul(reshape(row(1:3 * size(sample%coefficients, 2)), [3, size(sample%coefficients, 2)]), &
              sample%coefficients(a, :))
          end associate
        end do
      end do
      mark(element%points(1:element%count)) = 0
    end do
  end subroutine integrate_forces

  !> Add constraint rows and the geometric tangent <p Ddg> + <t_a Ddxi^a>.
  !>
  !> `row_pattern` holds for each slave control point (row) the control points (columns) that its rows reach;
  !> rows(component, kind, block). `field_slip` is the field of control slips, used by the slip sum's rows.
  subroutine integrate_blocks(slave, master, positions, projections, with_friction, multipliers, field_slip, row_pattern, rows, &
      pattern, tangent)
    type(slave_t), intent(in) :: slave
    type(master_t), intent(in) :: master
    real(wp), intent(in) :: positions(:, :)
    type(projections_t), intent(in) :: projections
    logical, intent(in) :: with_friction
    type(multipliers_t), intent(in) :: multipliers
    real(wp), intent(in) :: field_slip(:, :)
    type(pattern_t), intent(in) :: row_pattern, pattern
    real(wp), intent(inout) :: rows(:, :, :), tangent(:, :, :)
    type(element_t) :: element
    type(sample_t) :: sample
    integer, allocatable :: mark(:), columns(:)
    integer :: e, met, per_element, q

    allocate (mark(size(positions, 2)), columns(size(positions, 2)))
    mark = 0
    per_element = size(slave%area) / size(slave%nodes, 2)
    call reserve(slave, master, per_element, element, sample)
    allocate (element%rows(3 * size(element%points), size(rows, 2), size(slave%nodes, 1)))
    allocate (element%tangent(3 * size(element%points), 3 * size(element%points)))
    element%rows = 0.0_wp
    element%tangent = 0.0_wp
    do e = 1, size(slave%nodes, 2)
      if (.not. any(multipliers%active(slave%nodes(:, e)))) cycle
      call begin_element(slave, e, element)
      do q = (e - 1) * per_element + 1, e * per_element
        if (.not. projections%found(q)) cycle
        call take_sample(slave, master, positions, projections, e, q, master_order(master, with_friction), with_friction, element, &
          mark, sample)
        call add_rows(sample, slave%basis(:, q), slave%area(q), projections%slips(q), field_slip(:, q), element%rows)
        if (.not. master%is_plane) call add_geometric(sample, slave%area(q), fields_at(slave, multipliers, e, q), element%tangent)
      end do
      call scatter_rows(slave%nodes(:, e), multipliers%active, element, row_pattern, columns, rows)
      if (.not. master%is_plane) call scatter_tangent(element, pattern, columns, tangent)
      mark(element%points(1:element%count)) = 0
      met = 3 * element%count ! clear what was used alone: the room is for the largest element there could be
      element%rows(:met, :, :) = 0.0_wp
      element%tangent(:met, :met) = 0.0_wp
    end do
  end subroutine integrate_blocks

  !> Make room for the largest element: every quadrature point on a master element of its own.
  pure subroutine reserve(slave, master, per_element, element, sample)
    type(slave_t), intent(in) :: slave
    type(master_t), intent(in) :: master
    integer, intent(in) :: per_element
    type(element_t), intent(inout) :: element
    type(sample_t), intent(inout) :: sample
    integer :: most

    most = per_element * master_point_count(master)
    if (.not. master%is_plane) most = min(most, size(master%surface%point))
    allocate (element%points(size(slave%nodes, 1) + most))
    allocate (sample%local(size(slave%nodes, 1) + master_point_count(master)))
  end subroutine reserve

  !> Start an element with its slave control points.
  pure subroutine begin_element(slave, e, element)
    type(slave_t), intent(in) :: slave
    integer, intent(in) :: e
    type(element_t), intent(inout) :: element

    element%count = size(slave%nodes, 1)
    element%points(1:element%count) = slave%point(slave%nodes(:, e))
  end subroutine begin_element

  !> p, t_1, t_2 at a quadrature point.
  pure function fields_at(slave, multipliers, e, q) result(field)
    type(slave_t), intent(in) :: slave
    type(multipliers_t), intent(in) :: multipliers
    integer, intent(in) :: e, q
    real(wp) :: field(3)
    integer :: a, i

    field = 0.0_wp
    do a = 1, size(slave%nodes, 1)
      i = slave%nodes(a, e)
      if (multipliers%active(i)) field = field + slave%basis(a, q) * [multipliers%pressure(i), multipliers%traction(:, i)]
    end do
  end function fields_at

  !> Kinematics, variations and coefficients of the short vectors at a quadrature point; master control points that the
  !> element has not met yet are appended to it (`mark` holds the place of those it has).
  pure subroutine take_sample(slave, master, positions, projections, e, q, order, with_friction, element, mark, sample)
    type(slave_t), intent(in) :: slave
    type(master_t), intent(in) :: master
    real(wp), intent(in) :: positions(:, :)
    type(projections_t), intent(in) :: projections
    integer, intent(in) :: e, q, order
    logical, intent(in) :: with_friction
    type(element_t), intent(inout) :: element
    integer, intent(inout) :: mark(:)
    type(sample_t), intent(inout) :: sample
    integer :: a, n, nodes(master_point_count(master)), vectors
    real(wp) :: functions(master_point_count(master), derivative_columns(order))

    n = size(slave%nodes, 1)
    vectors = short_vectors(master%is_plane, with_friction .and. order > 2)
    call point_on_master(slave, master, positions, projections, q, order, sample%point, nodes, functions)
    sample%variations = first_variations(sample%point, vectors)
    if (.not. allocated(sample%coefficients)) allocate (sample%coefficients(size(sample%local), vectors))
    sample%coefficients = 0.0_wp
    sample%coefficients(1:n, 1) = slave%basis(:, q)
    do a = 1, n
      sample%local(a) = a
      mark(slave%point(slave%nodes(a, e))) = a
    end do
    if (master%is_plane) return
    do a = 1, size(nodes)
      associate (global => master%surface%point(nodes(a)))
        if (mark(global) == 0) then
          element%count = element%count + 1
          element%points(element%count) = global
          mark(global) = element%count
        end if
        sample%local(n + a) = mark(global)
      end associate
    end do
    sample%coefficients(n + 1:, 1) = -functions(:, 1)
    sample%coefficients(n + 1:, 2:vectors) = functions(:, 2:vectors)
  end subroutine take_sample

  !> Add the constraint rows of one quadrature point: row(component of the element, kind, slave control point).
  pure subroutine add_rows(sample, basis, area, slips, field_slip, rows)
    type(sample_t), intent(in) :: sample
    real(wp), intent(in) :: basis(:), area, field_slip(2)
    logical, intent(in) :: slips
    real(wp), intent(inout) :: rows(:, :, :)
    real(wp) :: forms(all_components, size(rows, 2)), metric(all_components, 3), factor(size(rows, 2)), spread(3, size(rows, 2))
    integer :: a, b, i, kind, vectors

    forms(:, row_gap) = sample%variations%gap
    if (size(rows, 2) > 1) then
      metric = metric_variation(sample%point, sample%variations)
      forms(:, row_work:row_work + 1) = sample%variations%slip
      forms(:, row_slip:row_slip + 1) = merge(1.0_wp, 0.0_wp, slips) * sample%variations%projection
      forms(:, row_metric:row_metric + 2) = metric
    end if
    if (size(rows, 2) == all_rows) then
      forms(:, row_slip_sum) = metric(:, 1) * field_slip(1) + metric(:, 2) * field_slip(2)
      forms(:, row_slip_sum + 1) = metric(:, 2) * field_slip(1) + metric(:, 3) * field_slip(2)
    end if
    vectors = size(sample%coefficients, 2)
    do a = 1, size(sample%local)
      spread = 0.0_wp
      do kind = 1, size(rows, 2)
        do b = 1, vectors
          spread(:, kind) = spread(:, kind) + sample%coefficients(a, b) * forms(3 * b - 2:3 * b, kind)
        end do
      end do
      do i = 1, size(basis)
        factor = basis(i) * area
        if (size(rows, 2) > 1) factor(row_metric:row_metric + 2) = basis(i)**2 * area
        do kind = 1, size(rows, 2)
          associate (row => rows(3 * sample%local(a) - 2:3 * sample%local(a), kind, i))
            row = row + factor(kind) * spread(:, kind)
          end associate
        end do
      end do
    end do
  end subroutine add_rows

  !> Add area * (p Ddg + t_a Ddxi^a) of one quadrature point.
  pure subroutine add_geometric(sample, area, field, tangent)
    type(sample_t), intent(in) :: sample
    real(wp), intent(in) :: area, field(3)
    real(wp), intent(inout) :: tangent(:, :)
    real(wp) :: form(3 * size(sample%coefficients, 2), 3 * size(sample%coefficients, 2))
    real(wp) :: column(3 * size(sample%coefficients, 2))
    integer :: a, b, j, k, l, vectors

    vectors = size(sample%coefficients, 2)
    form = 0.0_wp
    if (abs(field(1)) > 0.0_wp) call gap_variation(sample%point, sample%variations, area * field(1), form)
    if (vectors == 6 .and. any(abs(field(2:3)) > 0.0_wp)) then
      call traction_variation(sample%point, sample%variations, area * field(2:3), form)
    end if
    do b = 1, size(sample%local)
      do j = 1, 3
        column = 0.0_wp
        do l = 1, vectors
          column = column + sample%coefficients(b, l) * form(:, 3 * (l - 1) + j)
        end do
        associate (target => tangent(:, 3 * (sample%local(b) - 1) + j))
          do a = 1, size(sample%local)
            do k = 1, vectors
              associate (three => target(3 * sample%local(a) - 2:3 * sample%local(a)))
                three = three + sample%coefficients(a, k) * column(3 * k - 2:3 * k)
              end associate
            end do
          end do
        end associate
      end do
    end do
  end subroutine add_geometric

  !> Add the rows of an element to those of its active slave control points.
  pure subroutine scatter_rows(nodes, active, element, pattern, columns, rows)
    integer, intent(in) :: nodes(:)
    logical, intent(in) :: active(:)
    type(element_t), intent(in) :: element
    type(pattern_t), intent(in) :: pattern
    integer, intent(inout) :: columns(:)
    real(wp), intent(inout) :: rows(:, :, :)
    integer :: a, i

    do i = 1, size(nodes)
      if (.not. active(nodes(i))) cycle
      call mark_row(pattern, nodes(i), columns)
      do a = 1, element%count
        associate (row => rows(:, :, columns(element%points(a))))
          row = row + element%rows(3 * a - 2:3 * a, :, i)
        end associate
      end do
    end do
  end subroutine scatter_rows

  !> Add the geometric tangent of an element.
  pure subroutine scatter_tangent(element, pattern, columns, tangent)
    type(element_t), intent(in) :: element
    type(pattern_t), intent(in) :: pattern
    integer, intent(inout) :: columns(:)
    real(wp), intent(inout) :: tangent(:, :, :)
    integer :: a, b

    do a = 1, element%count
      call mark_row(pattern, element%points(a), columns)
      do b = 1, element%count
        associate (block => tangent(:, :, columns(element%points(b))))
          block = block + transpose(element%tangent(3 * a - 2:3 * a, 3 * b - 2:3 * b))
        end associate
      end do
    end do
  end subroutine scatter_tangent

end module isomortar_contact_blocks
