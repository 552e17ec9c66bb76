!> 3x3 matrices at a quadrature point of each of several elements: (lane, row, column).
!>
!> - `a`: the matrices.
module isomortar_solid_points
  use isomortar_base_kinds, only: lanes, wp
  implicit none
  private

  public :: cofactors, determinants, least, quotients

contains

  !> Determinants, `det`.
  pure subroutine determinants(a, det)
    real(wp), intent(in) :: a(lanes, 3, 3)
    real(wp), intent(out) :: det(lanes)

    det = a(:, 1, 1) * (a(:, 2, 2) * a(:, 3, 3) - a(:, 3, 2) * a(:, 2, 3)) &
      + a(:, 2, 1) * (a(:, 3, 2) * a(:, 1, 3) - a(:, 1, 2) * a(:, 3, 3)) &
      + a(:, 3, 1) * (a(:, 1, 2) * a(:, 2, 3) - a(:, 2, 2) * a(:, 1, 3))
  end subroutine determinants

  !> Determinants, `det`, and cofactors `b`: det times the transposed inverse.
  pure subroutine cofactors(a, b, det)
    real(wp), intent(in) :: a(lanes, 3, 3)
    real(wp), intent(out) :: b(lanes, 3, 3), det(lanes)
    integer :: i, j, k

    do i = 1, 3
      j = modulo(i, 3) + 1
      k = modulo(j, 3) + 1
      b(:, 1, i) = a(:, 2, j) * a(:, 3, k) - a(:, 3, j) * a(:, 2, k)
      b(:, 2, i) = a(:, 3, j) * a(:, 1, k) - a(:, 1, j) * a(:, 3, k)
      b(:, 3, i) = a(:, 1, j) * a(:, 2, k) - a(:, 2, j) * a(:, 1, k)
    end do
    det = a(:, 1, 1) * b(:, 1, 1) + a(:, 2, 1) * b(:, 2, 1) + a(:, 3, 1) * b(:, 3, 1)
  end subroutine cofactors

  !> The smaller one of two numbers, `first` and `second`, or the one that is none, which `min` would drop.
  elemental real(wp) function least(first, second)
    real(wp), intent(in) :: first, second

    least = merge(second, first, first >= -huge(first) .and. .not. second >= first)
  end function least

  !> Derivatives by the parameters of a rational field: `slope` (lane, component, parameter) (theory 1.3).
  !>
  !> - `weighting` (lane, 4): 1/W, and the derivatives of W over W, by the three parameters.
  !> - `numerator` (lane, component, 4): value and derivatives by the three parameters.
  pure subroutine quotients(weighting, numerator, slope)
    real(wp), intent(in) :: weighting(lanes, 4), numerator(lanes, 3, 4)
    real(wp), intent(out) :: slope(lanes, 3, 3)
    integer :: d, i

    do d = 1, 3
      do i = 1, 3
        slope(:, i, d) = (numerator(:, i, 1 + d) - numerator(:, i, 1) * weighting(:, 1 + d)) * weighting(:, 1)
      end do
    end do
  end subroutine quotients

end module isomortar_solid_points
