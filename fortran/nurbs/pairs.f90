!> Integrals of pairs of functions over an element, one direction after the other (sum factorisation).
!>
!> Functions and kinds are those of isomortar_nurbs_tensor_product, of one element alone. The contractions of `integrate_pairs` take
!> the last index of an array away and put the new one in front, so that nothing is copied in between: after w, v, u the indices
!> have gone round. Of the kinds that are left on the way the last is the derivative along the direction that is next, and pairs of
!> kinds are in the order of `pair_of_kinds`: those that are summed stand together.
!>
!> - `u`, `v`, `w`: pairs of functions of the three directions in the element, at its points. `fields`: how many fields.
!> - `first`: the first kind of those there are, 1, or 2 where there are derivatives alone.
!> - `room` (numbers): `room_for_pairs` of them at least, for what is on the way.
module isomortar_nurbs_pairs
  use isomortar_base_kinds, only: wp
  use isomortar_nurbs_patch, only: line_rule_t
  implicit none
  private

  public :: integrate_pairs, line_pairs, pair_of_kinds, room_for_pairs

  !> Products of two functions of one direction at its points, for integrals of pairs; points run faster than derivatives.
  type, public :: line_pairs_t
    !> With value or derivative of either function, shape (functions**2, points * 2 * 2); that of the first runs faster.
    real(wp), allocatable :: either(:, :)
    !> With value or derivative of the first, of the second function, shape (functions**2, points * 2).
    real(wp), allocatable :: first(:, :), second(:, :)
    !> With the values, shape (functions**2, points).
    real(wp), allocatable :: values(:, :)
  end type line_pairs_t

contains

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
    allocate (self%either(n**2, 4 * m), self%first(n**2, 2 * m), self%second(n**2, 2 * m), self%values(n**2, m))
    do b = 1, n
      do a = 1, n
        ab = a + n * (b - 1)
        do second = 0, 1
          do first = 0, 1
            associate (place => (first + 2 * second) * m)
              self%either(ab, place + 1:place + m) = line%values(a - 1, first, :) * line%values(b - 1, second, :)
            end associate
          end do
        end do
        self%values(ab, :) = self%either(ab, :m)
        self%first(ab, :) = self%either(ab, :2 * m)
        self%second(ab, :m) = self%either(ab, :m)
        self%second(ab, m + 1:) = self%either(ab, 2 * m + 1:3 * m)
      end do
    end do
  end subroutine tabulate

  !> Where the pair of kinds `d` and `e` stands among those of `kinds` by `kinds`, from 1: of value and last derivative, 1, k, the
  !> pairs 11, k1, 1k, kk; of each other one i then 1i, ki; then i1, ik; then the others.
  pure integer function pair_of_kinds(d, e, kinds) result(place)
    integer, intent(in) :: d, e, kinds
    logical :: inner(2)

    inner = [d, e] > 1 .and. [d, e] < kinds
    if (all(inner)) then
      place = 4 * (kinds - 1) + d - 1 + (kinds - 2) * (e - 2)
    else if (inner(1)) then
      place = 2 * (kinds + d) - 3 + merge(1, 0, e == kinds)
    else if (inner(2)) then
      place = 2 * e + 1 + merge(1, 0, d == kinds)
    else
      place = 1 + merge(1, 0, d == kinds) + merge(2, 0, e == kinds)
    end if
  end function pair_of_kinds

  !> How many numbers `integrate_pairs` needs for so many fields on the way, of an element of so many `functions` (3) and `points`
  !> (3) by direction.
  pure integer function room_for_pairs(functions, points, fields) result(numbers)
    integer, intent(in) :: functions(3), points(3), fields

    numbers = fields * functions(3)**2 * points(1) * (9 * points(2) + 4 * functions(2)**2)
  end function room_for_pairs

  !> Sum over points and kinds of `densities` times pairs of functions: from (field, points, pair of kinds) to `sums` (u, v, w,
  !> field), where each of u, v, w runs over pairs of functions, the first faster.
  pure subroutine integrate_pairs(u, v, w, fields, densities, first, sums, room)
    type(line_pairs_t), intent(in) :: u, v, w
    integer, intent(in) :: fields, first
    real(wp), intent(in) :: densities(fields * size(u%values, 2) * size(v%values, 2) * size(w%values, 2), 16)
    real(wp), intent(out) :: sums(size(u%values, 1) * size(v%values, 1) * size(w%values, 1) * fields)
    real(wp), contiguous, intent(inout) :: room(:)

    associate (mu => size(u%values, 2), mv => size(v%values, 2), pv => size(v%values, 1), pw => size(w%values, 1))
      associate (two => 1 + 9 * pw * fields * mu * mv)
        call gather_pairs(w, first, 4, fields * mu * mv, densities, room)
        call gather_pairs(v, 1, 3, pw * fields * mu, room, room(two:))
        call gather_pairs(u, 1, 2, pv * pw * fields, room(two:), sums)
      end associate
    end associate
  end subroutine integrate_pairs

  !> One direction of `integrate_pairs`.
  pure subroutine gather_pairs(line, first, kinds, rest, source, target)
    type(line_pairs_t), intent(in) :: line
    integer, intent(in) :: first, kinds, rest
    real(wp), intent(in) :: source(rest * size(line%values, 2), kinds**2)
    real(wp), intent(out) :: target(size(line%values, 1) * rest, (kinds - 1)**2)
    integer :: d, e, m, without

    m = size(line%values, 2)
    without = first - 1 ! values, which come first
    call contract(line%either(:, 1 + 3 * m * without:), rest, source(:, 1 + 3 * without:4), target(:, 1))
    do d = 2, kinds - 1
      associate (pair => pair_of_kinds(1, d, kinds))
        call contract(line%first(:, 1 + m * without:), rest, source(:, pair + without:pair + 1), &
          target(:, pair_of_kinds(1, d, kinds - 1)))
      end associate
      associate (pair => pair_of_kinds(d, 1, kinds))
        call contract(line%second(:, 1 + m * without:), rest, source(:, pair + without:pair + 1), &
          target(:, pair_of_kinds(d, 1, kinds - 1)))
      end associate
      do e = 2, kinds - 1
        call contract(line%values, rest, source(:, pair_of_kinds(d, e, kinds)), target(:, pair_of_kinds(d, e, kinds - 1)))
      end do
    end do
  end subroutine gather_pairs

  !> Sum over the last index of `source`, the columns of a `table` of `line_pairs_t`; the `rest` of its indices stay.
  pure subroutine contract(table, rest, source, target)
    real(wp), contiguous, intent(in) :: table(:, :)
    integer, intent(in) :: rest
    real(wp), intent(in) :: source(rest, size(table, 2))
    real(wp), intent(out) :: target(size(table, 1), rest)

    target = matmul(table, transpose(source))
  end subroutine contract

end module isomortar_nurbs_pairs
