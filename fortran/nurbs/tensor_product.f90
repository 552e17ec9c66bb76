!> Sums over the control points or the quadrature points of an element, one direction after the other (sum factorisation).
!>
!> A function of an element is B_a = u_a1 v_a2 w_a3. Kind D = 1 is its value, D = 2, 3, 4 its derivatives by the three
!> parameters. `interpolate` and `integrate`, its transpose, leave the indices where they are. The contractions of
!> `integrate_pairs` take the first index of an array away and append the new one as the last, so that after three of them the
!> indices have gone round; of the kinds that are left on the way the first is the value and the second the derivative along the
!> direction that is next.
!>
!> - `u`, `v`, `w`: functions of the three directions in an element, or their pairs, at its points. `fields`: how many fields.
!> - `room` (numbers): `room_for_lines` of them at least, for what is on the way.
module isomortar_nurbs_tensor_product
  use isomortar_base_kinds, only: wp
  use isomortar_nurbs_patch, only: line_rule_t
  implicit none
  private

  public :: integrate, integrate_pairs, interpolate, line_pairs, room_for_lines

  !> Products of two functions of one direction at its points, for integrals of pairs; point and derivatives run fastest.
  type, public :: line_pairs_t
    !> With value or derivative of either function, shape (points * 2 * 2, functions**2); that of the first runs faster.
    real(wp), allocatable :: either(:, :)
    !> With value or derivative of the first, of the second function, shape (points * 2, functions**2).
    real(wp), allocatable :: first(:, :), second(:, :)
    !> With the values, shape (points, functions**2).
    real(wp), allocatable :: values(:, :)
  end type line_pairs_t

contains

  !> How many numbers `interpolate` and `integrate` need for so many fields on the way.
  pure integer function room_for_lines(u, v, w, fields) result(numbers)
    type(line_rule_t), intent(in) :: u, v, w
    integer, intent(in) :: fields

    numbers = fields * size(u%weight) * size(w%values, 1) * (2 * size(v%values, 1) + 3 * size(v%weight))
  end function room_for_lines

  !> Fields and their derivatives at all points: from `coefficients` (field, u, v, w) of the control points to `values` (field,
  !> points, kind).
  pure subroutine interpolate(u, v, w, fields, coefficients, values, room)
    type(line_rule_t), intent(in) :: u, v, w
    integer, intent(in) :: fields
    real(wp), intent(in) :: coefficients(fields * size(u%values, 1) * size(v%values, 1) * size(w%values, 1))
    real(wp), intent(out) :: values(fields * size(u%weight) * size(v%weight) * size(w%weight), 4)
    real(wp), contiguous, intent(inout) :: room(:)

    associate (two => 1 + 2 * fields * size(u%weight) * size(v%values, 1) * size(w%values, 1))
      call spread_line(u, 1, fields, size(v%values, 1) * size(w%values, 1), coefficients, room)
      call spread_line(v, 2, fields * size(u%weight), size(w%values, 1), room, room(two:))
      call spread_line(w, 3, fields * size(u%weight) * size(v%weight), 1, room(two:), values)
    end associate
  end subroutine interpolate

  !> One direction of `interpolate`: every kind with the line's values, the value also with its derivatives, which come last.
  !> `before`, `after`: numbers of what runs faster and slower.
  pure subroutine spread_line(line, kinds, before, after, source, target)
    type(line_rule_t), intent(in) :: line
    integer, intent(in) :: kinds, before, after
    real(wp), intent(in) :: source(before, size(line%values, 1), after, kinds)
    real(wp), intent(out) :: target(before, size(line%weight), after, kinds + 1)
    integer :: d, n, q, r

    n = size(line%values, 1)
    do r = 1, after
      do q = 1, size(line%weight)
        do d = 1, kinds
          call sum_columns(before, n, source(:, :, r, d), line%values(:, 0, q), target(:, q, r, d))
        end do
        call sum_columns(before, n, source(:, :, r, 1), line%values(:, 1, q), target(:, q, r, kinds + 1))
      end do
    end do
  end subroutine spread_line

  !> The sum of n columns of m numbers times their shares, `total` (m).
  pure subroutine sum_columns(m, n, columns, shares, total)
    integer, intent(in) :: m, n
    real(wp), intent(in) :: columns(m, n), shares(n)
    real(wp), intent(out) :: total(m)

    select case (n)
    case (1)
      total = columns(:, 1) * shares(1)
    case (2)
      total = columns(:, 1) * shares(1) + columns(:, 2) * shares(2)
    case default
      total = columns(:, 1) * shares(1) + columns(:, 2) * shares(2) + columns(:, 3) * shares(3)
      call add_columns(m, n - 3, columns(:, 4:), shares(4:), total)
    end select
  end subroutine sum_columns

  !> Add n columns of m numbers times their shares to `total` (m), three at a time: the total is read and written less often.
  pure subroutine add_columns(m, n, columns, shares, total)
    integer, intent(in) :: m, n
    real(wp), intent(in) :: columns(m, n), shares(n)
    real(wp), intent(inout) :: total(m)
    integer :: a

    do a = 1, n - 2, 3
      total = total + (columns(:, a) * shares(a) + columns(:, a + 1) * shares(a + 1) + columns(:, a + 2) * shares(a + 2))
    end do
    do a = n - modulo(n, 3) + 1, n
      total = total + columns(:, a) * shares(a)
    end do
  end subroutine add_columns

  !> Sum over points and kinds of `densities` times functions: from (field, points, kind) to `sums` (field, u, v, w) of the
  !> control points.
  pure subroutine integrate(u, v, w, fields, densities, sums, room)
    type(line_rule_t), intent(in) :: u, v, w
    integer, intent(in) :: fields
    real(wp), intent(in) :: densities(fields * size(u%weight) * size(v%weight) * size(w%weight), 4)
    real(wp), intent(out) :: sums(fields * size(u%values, 1) * size(v%values, 1) * size(w%values, 1))
    real(wp), contiguous, intent(inout) :: room(:)

    associate (two => 1 + 2 * fields * size(u%weight) * size(v%values, 1) * size(w%values, 1))
      call gather_line(w, 3, fields * size(u%weight) * size(v%weight), 1, densities, room(two:))
      call gather_line(v, 2, fields * size(u%weight), size(w%values, 1), room(two:), room)
      call gather_line(u, 1, fields, size(v%values, 1) * size(w%values, 1), room, sums)
    end associate
  end subroutine integrate

  !> One direction of `integrate`, the transpose of `spread_line`.
  pure subroutine gather_line(line, kinds, before, after, source, target)
    type(line_rule_t), intent(in) :: line
    integer, intent(in) :: kinds, before, after
    real(wp), intent(in) :: source(before, size(line%weight), after, kinds + 1)
    real(wp), intent(out) :: target(before, size(line%values, 1), after, kinds)
    real(wp) :: values(size(line%weight), size(line%values, 1)), slopes(size(line%weight), size(line%values, 1))
    integer :: a, d, m, r

    m = size(line%weight)
    values = transpose(line%values(:, 0, :))
    slopes = transpose(line%values(:, 1, :))
    do r = 1, after
      do a = 1, size(line%values, 1)
        do d = 1, kinds
          call sum_columns(before, m, source(:, :, r, d), values(:, a), target(:, a, r, d))
        end do
        call add_columns(before, m, source(:, :, r, kinds + 1), slopes(:, a), target(:, a, r, 1))
      end do
    end do
  end subroutine gather_line

  !> The `tables` (elements) for `integrate_pairs` of the elements of a direction, whose functions are `lines` (elements).
  pure subroutine line_pairs(lines, tables)
    type(line_rule_t), intent(in) :: lines(:)
    type(line_pairs_t), allocatable, intent(out) :: tables(:)
    integer :: e

    allocate (tables(size(lines)))
    do e = 1, size(lines)
      call tabulate(lines(e), tables(e))
    end do
  end subroutine line_pairs

  !> Tables of one element.
  pure subroutine tabulate(line, self)
    type(line_rule_t), intent(in) :: line
    type(line_pairs_t), intent(out) :: self
    integer :: a, ab, b, first, m, n, second

    n = size(line%values, 1)
    m = size(line%weight)
    allocate (self%either(4 * m, n**2), self%first(2 * m, n**2), self%second(2 * m, n**2), self%values(m, n**2))
    do b = 1, n
      do a = 1, n
        ab = a + n * (b - 1)
        do second = 0, 1
          do first = 0, 1
            associate (place => (first + 2 * second) * m)
              self%either(place + 1:place + m, ab) = line%values(a - 1, first, :) * line%values(b - 1, second, :)
            end associate
          end do
        end do
        self%values(:, ab) = self%either(:m, ab)
        self%first(:, ab) = self%either(:2 * m, ab)
        self%second(:m, ab) = self%either(:m, ab)
        self%second(m + 1:, ab) = self%either(2 * m + 1:3 * m, ab)
      end do
    end do
  end subroutine tabulate

  !> Sum over points and kinds of `densities` times pairs of functions: from (points, field, kind, kind) to `sums` (field, u, v, w),
  !> where each of u, v, w runs over pairs of functions, the first faster.
  pure subroutine integrate_pairs(u, v, w, fields, densities, sums)
    type(line_pairs_t), intent(in) :: u, v, w
    integer, intent(in) :: fields
    real(wp), intent(in) :: densities(size(u%values, 1) * size(v%values, 1) * size(w%values, 1) * fields, 4, 4)
    real(wp), intent(out) :: sums(fields * size(u%values, 2) * size(v%values, 2) * size(w%values, 2))
    real(wp), allocatable :: one(:, :, :), two(:, :, :)

    allocate (one(size(v%values, 1) * size(w%values, 1) * fields * size(u%values, 2), 3, 3))
    allocate (two(size(w%values, 1) * fields * size(u%values, 2) * size(v%values, 2), 2, 2))
    call gather_pairs(u, 4, size(one, 1) / size(u%values, 2), densities, one)
    call gather_pairs(v, 3, size(two, 1) / size(v%values, 2), one, two)
    call gather_pairs(w, 2, size(sums) / size(w%values, 2), two, sums)
  end subroutine integrate_pairs

  !> One direction of `integrate_pairs`.
  pure subroutine gather_pairs(line, kinds, rest, source, target)
    type(line_pairs_t), intent(in) :: line
    integer, intent(in) :: kinds, rest
    real(wp), intent(in) :: source(size(line%values, 1), rest, kinds, kinds)
    real(wp), intent(out) :: target(rest, size(line%values, 2), kinds - 1, kinds - 1)
    real(wp), allocatable :: beside(:, :), both(:, :)
    integer :: d, e, m

    allocate (beside(rest, 2 * size(line%values, 1)), both(rest, 4 * size(line%values, 1)))
    m = size(line%values, 1) ! few: copies run down the rest, one short copy for each of which costs more than the products
    both(:, :m) = transpose(source(:, :, 1, 1))
    both(:, m + 1:2 * m) = transpose(source(:, :, 2, 1))
    both(:, 2 * m + 1:3 * m) = transpose(source(:, :, 1, 2))
    both(:, 3 * m + 1:) = transpose(source(:, :, 2, 2))
    target(:, :, 1, 1) = matmul(both, line%either)
    do d = 2, kinds - 1
      beside(:, :m) = transpose(source(:, :, 1, d + 1))
      beside(:, m + 1:) = transpose(source(:, :, 2, d + 1))
      target(:, :, 1, d) = matmul(beside, line%first)
      beside(:, :m) = transpose(source(:, :, d + 1, 1))
      beside(:, m + 1:) = transpose(source(:, :, d + 1, 2))
      target(:, :, d, 1) = matmul(beside, line%second)
      do e = 2, kinds - 1
        beside(:, :m) = transpose(source(:, :, e + 1, d + 1))
        target(:, :, e, d) = matmul(beside(:, :m), line%values)
      end do
    end do
  end subroutine gather_pairs

end module isomortar_nurbs_tensor_product
