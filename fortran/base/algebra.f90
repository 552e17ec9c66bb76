!> Small dense algebra: 3-vectors, 3x3 and 2x2 matrices.
module isomortar_base_algebra
  use isomortar_base_kinds, only: wp
  implicit none
  private

  public :: add_product, cross, determinant, determinant2, first_not_finite, inverse, inverse2, identity, log1p, weighted_sums

  !> 3x3 unit matrix.
  real(wp), parameter :: identity(3, 3) = reshape([1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 1.0_wp], [3, 3])

contains

  !> Vector product `a` x `b`.
  pure function cross(a, b) result(c)
    real(wp), intent(in) :: a(3), b(3)
    real(wp) :: c(3)

    c(1) = a(2) * b(3) - a(3) * b(2)
    c(2) = a(3) * b(1) - a(1) * b(3)
    c(3) = a(1) * b(2) - a(2) * b(1)
  end function cross

  !> Determinant of a 3x3 matrix `a`.
  pure function determinant(a) result(d)
    real(wp), intent(in) :: a(3, 3)
    real(wp) :: d

    d = dot_product(a(:, 1), cross(a(:, 2), a(:, 3)))
  end function determinant

  !> Inverse of a 3x3 matrix `a` whose determinant, `det`, is known.
  pure function inverse(a, det) result(b)
    real(wp), intent(in) :: a(3, 3)
    real(wp), intent(in) :: det
    real(wp) :: b(3, 3), scale

    scale = 1.0_wp / det
    b(1, :) = cross(a(:, 2), a(:, 3)) * scale
    b(2, :) = cross(a(:, 3), a(:, 1)) * scale
    b(3, :) = cross(a(:, 1), a(:, 2)) * scale
  end function inverse

  !> Determinant of a 2x2 matrix `a`.
  pure function determinant2(a) result(d)
    real(wp), intent(in) :: a(2, 2)
    real(wp) :: d

    d = a(1, 1) * a(2, 2) - a(1, 2) * a(2, 1)
  end function determinant2

  !> Inverse of a 2x2 matrix `a`.
  pure function inverse2(a) result(b)
    real(wp), intent(in) :: a(2, 2)
    real(wp) :: b(2, 2)

    b(1, 1) = a(2, 2)
    b(2, 2) = a(1, 1)
    b(1, 2) = -a(1, 2)
    b(2, 1) = -a(2, 1)
    b = b / determinant2(a)
  end function inverse2

  !> ln(1 + `y`) without losing the digits of a small `y` (theory 1.5, Kahan's correction of the sum), in every mode of rounding.
  elemental function log1p(y) result(r)
    real(wp), intent(in) :: y
    real(wp) :: r
    real(wp) :: sum, added

    sum = 1.0_wp + y
    added = sum - 1.0_wp
    if (abs(added) > 0.0_wp) then
      r = log(sum) * (y / added)
    else
      r = y
    end if
  end function log1p

  !> Sums of those of the `vectors` (3, vectors) that `numbers` (terms) lists, times `weights` (terms, sums).
  pure function weighted_sums(vectors, numbers, weights) result(sums)
    real(wp), intent(in) :: vectors(:, :)
    real(wp), contiguous, intent(in) :: weights(:, :)
    integer, intent(in) :: numbers(:)
    real(wp) :: sums(3, size(weights, 2))
    real(wp) :: term(4, size(numbers)), total(4) ! four numbers fill a processor's register
    integer :: a, column

    do a = 1, size(numbers)
      term(:, a) = [vectors(1, numbers(a)), vectors(2, numbers(a)), vectors(3, numbers(a)), 0.0_wp]
    end do
    do column = 1, size(weights, 2)
      total = 0.0_wp
      do a = 1, size(numbers)
        total = total + weights(a, column) * term(:, a)
      end do
      sums(:, column) = total(1:3)
    end do
  end function weighted_sums

  !> Add a number, `scale`, times the product of `left` (rows) and the transpose of `right` (columns) to `form` (rows, columns).
  pure subroutine add_product(scale, left, right, form)
    real(wp), intent(in) :: scale, left(:), right(:)
    real(wp), intent(inout) :: form(:, :)
    integer :: k

    do k = 1, size(right)
      form(:, k) = form(:, k) + (scale * right(k)) * left
    end do
  end subroutine add_product

  !> The first of some control points, `points` (number), whose place in `positions` (3, control points) is not finite; 0: none.
  pure integer function first_not_finite(positions, points) result(point)
    real(wp), intent(in) :: positions(:, :)
    integer, intent(in) :: points(:)
    integer :: a

    do a = 1, size(points)
      point = points(a)
      if (.not. all(abs(positions(:, point)) <= huge(1.0_wp))) return
    end do
    point = 0
  end function first_not_finite

end module isomortar_base_algebra
