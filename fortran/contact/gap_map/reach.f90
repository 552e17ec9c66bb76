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
    integer :: a, i, k, kind, row

    allocate (carried(size(reached%point), 3, size(forms, 3), size(forms, 4)), source=0.0_wp)
    do kind = 1, size(forms, 4)
      do row = 1, size(forms, 3)
        do a = 1, size(forms, 1)
          associate (form => forms(a, :, row, kind))
            do k = reached%start(a - 1) + 1, reached%start(a)
              do i = 1, 3 ! not by matmul, whose result would be put on the heap each time
                carried(reached%at(k), i, row, kind) = carried(reached%at(k), i, row, kind) + form(1) * reached%slope(1, i, k) &
                  + form(2) * reached%slope(2, i, k) + form(3) * reached%slope(3, i, k)
              end do
            end do
          end associate
        end do
      end do
    end do
  end subroutine carry_rows

  !> A bilinear `form` (right point, left component, right component, left point) in a list of points, `carried` (right point, left
  !> component, right component, left point) to the control points that it has `reached` (theory 3.22).
  pure subroutine carry_form(reached, form, carried)
    type(reached_t), intent(in) :: reached
    real(wp), contiguous, intent(in) :: form(:, :, :, :)
    real(wp), allocatable, intent(out) :: carried(:, :, :, :)
    real(wp), allocatable :: left(:, :, :, :)
    integer :: a, b, i, j, k

    associate (points => size(reached%point))
      allocate (carried(points, 3, 3, points), left(size(form, 1), 3, 3, points), source=0.0_wp)
    end associate
    do a = 1, size(form, 4)
      do k = reached%start(a - 1) + 1, reached%start(a)
        associate (g => reached%at(k))
          do i = 1, 3
            do j = 1, 3
              left(:, i, :, g) = left(:, i, :, g) + reached%slope(j, i, k) * form(:, j, :, a)
            end do
          end do
        end associate
      end do
    end do
    do a = 1, size(left, 4)
      do i = 1, 3
        do b = 1, size(form, 1)
          associate (row => left(b, i, :, a))
            do k = reached%start(b - 1) + 1, reached%start(b)
              do j = 1, 3
                carried(reached%at(k), i, j, a) = carried(reached%at(k), i, j, a) + row(1) * reached%slope(1, j, k) &
                  + row(2) * reached%slope(2, j, k) + row(3) * reached%slope(3, j, k)
              end do
            end do
          end associate
        end do
      end do
    end do
  end subroutine carry_form

end module isomortar_contact_gap_map_reach
