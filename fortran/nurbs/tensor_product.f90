!> Sums over the control points or the quadrature points of elements, one direction after the other (sum factorisation).
!>
!> A function of an element is B_a = u_a1 v_a2 w_a3. Kind D = 1 is its value, D = 2, 3, 4 its derivatives by the three
!> parameters. `interpolate` and `integrate`, its transpose, take `lanes` elements side by side, which run fastest.
!>
!> - `u`, `v`, `w`: functions of the three directions in the elements, at their points. `fields`: how many fields.
!> - `first`: the first kind of those there are, 1, or 2 where there are derivatives alone.
!> - `room` (numbers): `room_for_lines` of them at least, for what is on the way.
module isomortar_nurbs_tensor_product
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: lanes, wp
  use isomortar_base_predicate, only: is_index
  use isomortar_nurbs_patch, only: line_rule_t
  implicit none
  private

  public :: integrate, interpolate, room_for_lines, side_by_side

  !> Functions of one direction in elements side by side, at their points.
  type, public :: lines_t
    !> Quadrature weights times the lengths of the elements, shape (lanes, points).
    real(wp), allocatable :: weight(:, :)
    !> Values (0) and derivatives (1) at a point, shape (lanes, functions, 0:1, points).
    real(wp), allocatable :: at_point(:, :, :, :)
    !> The same of a function, shape (lanes, points, 0:1, functions).
    real(wp), allocatable :: of_function(:, :, :, :)
  end type lines_t

  !> One direction of the sums: of every kind from `first` to `kinds` with the values of its functions, of the value also with their
  !> derivatives, which come last. Numbers are counted with all their lanes, from 0.
  type :: stage_t
    integer :: first, kinds
    !> How many sums there are, two ways.
    integer :: counts(2)
    !> On the side of the control points and on that of the quadrature points, how far the next number is: one way, along the line,
    !> the other way, and of the next kind; and how many numbers there are.
    integer :: coarse(4), fine(4), numbers(2)
  end type stage_t

contains

  !> Put elements of one direction, whose functions are `lines` (elements), side by side: those of the numbers `places` (lanes).
  pure subroutine side_by_side(lines, places, self)
    type(line_rule_t), intent(in) :: lines(:)
    integer, intent(in) :: places(:)
    type(lines_t), intent(inout) :: self
    integer :: a, d, l, m, n, q

    if (contracts) call require(all(is_index(places(:lanes), size(lines))), "side_by_side: there are such elements")
    m = size(lines(1)%weight)
    n = size(lines(1)%values, 1)
    if (.not. allocated(self%weight)) then
      allocate (self%weight(lanes, m), self%at_point(lanes, n, 0:1, m), self%of_function(lanes, m, 0:1, n))
    end if
    do l = 1, lanes
      associate (line => lines(places(l)))
        self%weight(l, :) = line%weight
        do q = 1, m
          do d = 0, 1
            do a = 1, n
              self%at_point(l, a, d, q) = line%values(a - 1, d, q)
              self%of_function(l, q, d, a) = line%values(a - 1, d, q)
            end do
          end do
        end do
      end associate
    end do
  end subroutine side_by_side

  !> How many numbers `interpolate` and `integrate` need for so many fields on the way.
  pure integer function room_for_lines(u, v, w, fields) result(numbers)
    type(lines_t), intent(in) :: u, v, w
    integer, intent(in) :: fields

    numbers = lanes * fields * size(u%weight, 2) * size(w%at_point, 2) * (2 * size(v%at_point, 2) + 3 * size(v%weight, 2))
  end function room_for_lines

  !> The three directions: u, v and w of the way to the quadrature points, w, v and u of the way back.
  pure function stages(u, v, w, fields, first) result(stage)
    type(lines_t), intent(in) :: u, v, w
    integer, intent(in) :: fields, first
    type(stage_t) :: stage(3)
    integer :: layer, mu, mv, mw, nu, nv, nw, point, second, third

    mu = size(u%weight, 2)
    mv = size(v%weight, 2)
    mw = size(w%weight, 2)
    nu = size(u%at_point, 2)
    nv = size(v%at_point, 2)
    nw = size(w%at_point, 2)
    second = mu * nv * nw * fields
    third = mu * mv * nw * fields
    layer = mu * mv
    point = fields * (5 - first)
    stage(1) = stage_t(1, 1, [nv * nw * fields, 1], [nu, 1, 0, 0], [mu, 1, 0, second], [nu * nv * nw * fields, 2 * second])
    stage(2) = stage_t(1, 2, [mu, nw * fields], [1, mu, mu * nv, second], [1, mu, layer, third], [2 * second, 3 * third])
    stage(3) = stage_t(first, 3, [layer, fields], [1, layer, layer * nw, third], [point, layer * point, 1, fields], &
      [3 * third, point * layer * mw])
  end function stages

  !> Fields and their derivatives at all points: from `coefficients` (lanes, u, v, w, field) of the control points to `values`
  !> (lanes, field, kind, points).
  pure subroutine interpolate(u, v, w, fields, coefficients, first, values, room)
    type(lines_t), intent(in) :: u, v, w
    integer, intent(in) :: fields, first
    real(wp), intent(in) :: coefficients(lanes * size(u%at_point, 2) * size(v%at_point, 2) * size(w%at_point, 2) * fields)
    real(wp), intent(out) :: values(lanes * fields * (5 - first) * size(u%weight, 2) * size(v%weight, 2) * size(w%weight, 2))
    real(wp), contiguous, intent(inout) :: room(:)
    type(stage_t) :: stage(3)

    stage = stages(u, v, w, fields, first)
    associate (two => 1 + 2 * lanes * stage(1)%fine(4))
      call spread_line(u, stage(1), coefficients, room)
      call spread_line(v, stage(2), room, room(two:))
      call spread_line(w, stage(3), room(two:), values)
    end associate
  end subroutine interpolate

  !> One direction of `interpolate`, from control points to quadrature points.
  pure subroutine spread_line(line, stage, source, target)
    type(lines_t), intent(in) :: line
    type(stage_t), intent(in) :: stage
    real(wp), intent(in) :: source(lanes, 0:stage%numbers(1) - 1)
    real(wp), intent(inout) :: target(lanes, 0:stage%numbers(2) - 1)
    integer :: d, place, q

    do q = 1, size(line%weight, 2)
      place = stage%fine(2) * (q - 1)
      do d = stage%first, stage%kinds
        call sum_columns(stage%counts, source(1, stage%coarse(4) * (d - 1)), stage%coarse, line%at_point(:, :, 0, q), &
          target(1, place + stage%fine(4) * (d - stage%first)), stage%fine)
      end do
      call sum_columns(stage%counts, source(1, 0), stage%coarse, line%at_point(:, :, 1, q), &
        target(1, place + stage%fine(4) * (stage%kinds + 1 - stage%first)), stage%fine)
    end do
  end subroutine spread_line

  !> Sum over points and kinds of `densities` times functions: from (lanes, field, kind, points) to `sums` (lanes, u, v, w, field)
  !> of the control points.
  pure subroutine integrate(u, v, w, fields, densities, first, sums, room)
    type(lines_t), intent(in) :: u, v, w
    integer, intent(in) :: fields, first
    real(wp), intent(in) :: densities(lanes * fields * (5 - first) * size(u%weight, 2) * size(v%weight, 2) * size(w%weight, 2))
    real(wp), intent(out) :: sums(lanes * size(u%at_point, 2) * size(v%at_point, 2) * size(w%at_point, 2) * fields)
    real(wp), contiguous, intent(inout) :: room(:)
    type(stage_t) :: stage(3)

    stage = stages(u, v, w, fields, first)
    associate (two => 1 + 2 * lanes * stage(1)%fine(4))
      call gather_line(w, stage(3), densities, room(two:))
      call gather_line(v, stage(2), room(two:), room)
      call gather_line(u, stage(1), room, sums)
    end associate
  end subroutine integrate

  !> One direction of `integrate`, from quadrature points to control points: the transpose of `spread_line`.
  pure subroutine gather_line(line, stage, source, target)
    type(lines_t), intent(in) :: line
    type(stage_t), intent(in) :: stage
    real(wp), intent(in) :: source(lanes, 0:stage%numbers(2) - 1)
    real(wp), intent(inout) :: target(lanes, 0:stage%numbers(1) - 1)
    integer :: a, d, place

    do a = 1, size(line%at_point, 2)
      place = stage%coarse(2) * (a - 1)
      call sum_columns(stage%counts, source(1, stage%fine(4) * (stage%kinds + 1 - stage%first)), stage%fine, &
        line%of_function(:, :, 1, a), target(1, place), stage%coarse)
      if (stage%first == 1) call add_columns(1, stage%counts, source(1, 0), stage%fine, line%of_function(:, :, 0, a), &
        target(1, place), stage%coarse)
      do d = 2, stage%kinds
        call sum_columns(stage%counts, source(1, stage%fine(4) * (d - stage%first)), stage%fine, line%of_function(:, :, 0, a), &
          target(1, place + stage%coarse(4) * (d - 1)), stage%coarse)
      end do
    end do
  end subroutine gather_line

  !> Sums of columns of numbers times their shares, of which every lane has its own. `counts`: as of stage_t, and so are `step` of
  !> the columns and `jump` of the sums, `total`. Up to four columns are summed in registers and written once, others then added.
  pure subroutine sum_columns(counts, columns, step, shares, total, jump)
    integer, intent(in) :: counts(2), step(4), jump(4)
    real(wp), contiguous, intent(in) :: shares(:, :)
    real(wp), intent(in) :: columns(lanes, 0:dot_product(step(:3), [counts(1), size(shares, 2), counts(2)] - 1))
    real(wp), intent(inout) :: total(lanes, 0:dot_product(jump(:3), [counts(1), 1, counts(2)] - 1))
    integer :: b, c, next, r, t

    next = step(2)
    do r = 0, counts(2) - 1
      c = step(3) * r
      t = jump(3) * r
      select case (size(shares, 2))
      case (1)
        do b = 1, counts(1)
          total(:, t) = columns(:, c) * shares(:, 1)
          c = c + step(1)
          t = t + jump(1)
        end do
      case (2)
        do b = 1, counts(1)
          total(:, t) = columns(:, c) * shares(:, 1) + columns(:, c + next) * shares(:, 2)
          c = c + step(1)
          t = t + jump(1)
        end do
      case (3)
        do b = 1, counts(1)
          total(:, t) = columns(:, c) * shares(:, 1) + columns(:, c + next) * shares(:, 2) + columns(:, c + 2 * next) * shares(:, 3)
          c = c + step(1)
          t = t + jump(1)
        end do
      case default
        do b = 1, counts(1)
          total(:, t) = columns(:, c) * shares(:, 1) + columns(:, c + next) * shares(:, 2) &
            + columns(:, c + 2 * next) * shares(:, 3) + columns(:, c + 3 * next) * shares(:, 4)
          c = c + step(1)
          t = t + jump(1)
        end do
      end select
    end do
    call add_columns(5, counts, columns, step, shares, total, jump)
  end subroutine sum_columns

  !> Add the columns from number `from` on to such sums, two at a time: the sums are read and written less often.
  pure subroutine add_columns(from, counts, columns, step, shares, total, jump)
    integer, intent(in) :: from, counts(2), step(4), jump(4)
    real(wp), contiguous, intent(in) :: shares(:, :)
    real(wp), intent(in) :: columns(lanes, 0:dot_product(step(:3), [counts(1), size(shares, 2), counts(2)] - 1))
    real(wp), intent(inout) :: total(lanes, 0:dot_product(jump(:3), [counts(1), 1, counts(2)] - 1))
    integer :: a, b, c, next, r, t

    next = step(2)
    do a = from, size(shares, 2), 2
      do r = 0, counts(2) - 1
        c = step(3) * r + next * (a - 1)
        t = jump(3) * r
        if (a == size(shares, 2)) then
          do b = 1, counts(1)
            total(:, t) = total(:, t) + columns(:, c) * shares(:, a)
            c = c + step(1)
            t = t + jump(1)
          end do
        else
          do b = 1, counts(1)
            total(:, t) = total(:, t) + (columns(:, c) * shares(:, a) + columns(:, c + next) * shares(:, a + 1))
            c = c + step(1)
            t = t + jump(1)
          end do
        end if
      end do
    end do
  end subroutine add_columns

end module isomortar_nurbs_tensor_product
