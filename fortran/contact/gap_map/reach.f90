!> What a list of control points and normals of nodes comes down to: the control points alone, on to which rows and tangents are
!> carried.
!>
!> - `reached`: the control points that the list depends on.
module isomortar_contact_gap_map_reach
  use isomortar_base_algebra, only: identity
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_compressed, is_index
  use isomortar_contact_gap_map_nodal_normals, only: normals_t
  implicit none
  private

  public :: carry_form, carry_rows, reach

  !> Control points that a list of points reaches, each once; entries of point a are start(a - 1) + 1 .. start(a).
  type, public :: reached_t
    integer, allocatable :: point(:)
    integer, allocatable :: start(:)
    !> Which of the control points, and the derivative of the point by it, shape (3, 3, entries).
    integer, allocatable :: at(:)
    real(wp), allocatable :: slope(:, :, :)
  end type reached_t

contains

  !> What a list of `points` (number) reaches: its control points, and those that the normals among it depend on: `reached`. The
  !> numbers of normals count on from the number `n` of control points (theory 3.22).
  pure subroutine reach(self, n, points, reached)
    type(normals_t), intent(in) :: self
    integer, intent(in) :: n, points(:)
    type(reached_t), intent(out) :: reached
    integer :: a, count, entries, k

    entries = 0
    do a = 1, size(points)
      entries = entries + 1
      if (points(a) > n) entries = entries - 1 + self%start(points(a) - n) - self%start(points(a) - n - 1)
    end do
    allocate (reached%start(0:size(points)), reached%at(entries), reached%slope(3, 3, entries), reached%point(entries))
    entries = 0
    count = 0
    reached%start(0) = 0
    do a = 1, size(points)
      if (points(a) <= n) then
        call add_reached(points(a), identity, count, entries, reached)
      else
        do k = self%start(points(a) - n - 1) + 1, self%start(points(a) - n)
          call add_reached(self%column(k), self%slope(:, :, k), count, entries, reached)
        end do
      end if
      reached%start(a) = entries
    end do
    reached%point = reached%point(:count)
    if (contracts) call require(is_compressed(reached%start, size(reached%at)), "reach: entries follow one another by points")
    if (contracts) call require(all(is_index(reached%at, count)) .and. all(is_index(reached%point, n)), "reach: to control points")
  end subroutine reach

  !> Add an entry to the last point of a list: a control point, and the derivative by it.
  pure subroutine add_reached(point, slope, count, entries, reached)
    integer, intent(in) :: point
    real(wp), intent(in) :: slope(3, 3)
    integer, intent(inout) :: count, entries
    type(reached_t), intent(inout) :: reached
    integer :: at

    at = findloc(reached%point(:count), point, dim=1)
    if (at == 0) then
      count = count + 1
      reached%point(count) = point
      at = count
    end if
    entries = entries + 1
    reached%at(entries) = at
    reached%slope(:, :, entries) = slope
  end subroutine add_reached

  !> Linear `forms` (points, component, row, kind) in a list of points, `carried` (reached, component, row, kind) to the control
  !> points that it has `reached` (theory 3.22).
  pure subroutine carry_rows(reached, forms, carried)
    type(reached_t), intent(in) :: reached
    real(wp), contiguous, intent(in) :: forms(:, :, :, :)
    real(wp), allocatable, intent(out) :: carried(:, :, :, :)
    real(wp), allocatable :: given(:, :, :), made(:, :, :)

    associate (n => size(forms, 1), points => size(reached%point), rows => size(forms, 3) * size(forms, 4))
      allocate (given(rows, 3, n), made(rows, 3, points), carried(points, 3, size(forms, 3), size(forms, 4)))
      call turn(n, rows, forms, given)
      call carry_columns(reached, rows, given, made)
      call turn(rows, points, made, carried)
    end associate
  end subroutine carry_rows

  !> A bilinear `form` (right point, right component, left component, left point) in a list of points, `carried` (right point, right
  !> component, left component, left point) to the control points that it has `reached` (theory 3.22).
  pure subroutine carry_form(reached, form, carried)
    type(reached_t), intent(in) :: reached
    real(wp), contiguous, intent(in) :: form(:, :, :, :)
    real(wp), allocatable, intent(out) :: carried(:, :, :, :)
    real(wp), allocatable :: given(:, :, :), left(:, :, :), made(:, :, :)

    associate (n => size(form, 1), points => size(reached%point))
      allocate (left(3 * n, 3, points), given(3 * points, 3, n), made(3 * points, 3, points), carried(points, 3, 3, points))
      call carry_columns(reached, 3 * n, form, left)
      call turn(n, 3 * points, left, given)
      call carry_columns(reached, 3 * points, given, made)
      call turn(3 * points, points, made, carried)
    end associate
  end subroutine carry_form

  !> Rows of a form in a list, (row, component, point), by the control points that it has reached: `carried` (row, component,
  !> control point). Rows are contiguous: they are many.
  pure subroutine carry_columns(reached, rows, form, carried)
    type(reached_t), intent(in) :: reached
    integer, intent(in) :: rows
    real(wp), intent(in) :: form(rows, 3, size(reached%start) - 1)
    real(wp), intent(out) :: carried(rows, 3, size(reached%point))
    integer :: a, i, k

    carried = 0.0_wp
    do a = 1, size(form, 3)
      do k = reached%start(a - 1) + 1, reached%start(a)
        associate (g => reached%at(k), slope => reached%slope(:, :, k))
          do i = 1, 3
            carried(:, i, g) = carried(:, i, g) + (slope(1, i) * form(:, 1, a) + slope(2, i) * form(:, 2, a) &
              + slope(3, i) * form(:, 3, a))
          end do
        end associate
      end do
    end do
  end subroutine carry_columns

  !> A form (row, component, column) with rows for columns.
  pure subroutine turn(rows, columns, form, turned)
    integer, intent(in) :: rows, columns
    real(wp), intent(in) :: form(rows, 3, columns)
    real(wp), intent(out) :: turned(columns, 3, rows)
    integer :: i, row

    do row = 1, rows
      do i = 1, 3
        turned(:, i, row) = form(row, i, :)
      end do
    end do
  end subroutine turn

end module isomortar_contact_gap_map_reach
