!> Vectors and 3x3 matrices at all quadrature points of an element: (point, component), (point, row, column).
!>
!> - `m`: points. `a`: the matrices.
module isomortar_solid_points
  use isomortar_base_kinds, only: wp
  implicit none
  private

  public :: cofactors, determinants, least, quotients

contains

  !> Determinants, `det`.
  pure subroutine determinants(m, a, det)
    integer, intent(in) :: m
    real(wp), intent(in) :: a(m, 3, 3)
    real(wp), intent(out) :: det(m)

    det = a(:, 1, 1) * (a(:, 2, 2) * a(:, 3, 3) - a(:, 3, 2) * a(:, 2, 3)) &
      + a(:, 2, 1) * (a(:, 3, 2) * a(:, 1, 3) - a(:, 1, 2) * a(:, 3, 3)) &
      + a(:, 3, 1) * (a(:, 1, 2) * a(:, 2, 3) - a(:, 2, 2) * a(:, 1, 3))
  end subroutine determinants

  !> Determinants, `det`, and cofactors `b`: det times the transposed inverse.
  pure subroutine cofactors(m, a, b, det)
    integer, intent(in) :: m
    real(wp), intent(in) :: a(m, 3, 3)
    real(wp), intent(out) :: b(m, 3, 3), det(m)
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

  !> The first of some `numbers` (numbers) that is not above zero, or else the smallest of them.
  pure real(wp) function least(numbers)
    real(wp), intent(in) :: numbers(:)
    integer :: q

    least = huge(1.0_wp)
    do q = 1, size(numbers)
      if (.not. numbers(q) > 0.0_wp) then
        least = numbers(q)
        return
      end if
      least = min(least, numbers(q))
    end do
  end function least

  !> Derivatives by the parameters of a rational field: `slope` (point, component, parameter) (theory 1.3).
  !>
  !> - `weighting` (point, 4): 1/W, and the derivatives of W over W, by the three parameters.
  !> - `numerator` (point, 3, 4): value and derivatives by the three parameters.
  pure subroutine quotients(m, weighting, numerator, slope)
    integer, intent(in) :: m
    real(wp), intent(in) :: weighting(m, 4), numerator(m, 3, 4)
    real(wp), intent(out) :: slope(m, 3, 3)
    integer :: d, i

    do d = 1, 3
      do i = 1, 3
        slope(:, i, d) = (numerator(:, i, 1 + d) - numerator(:, i, 1) * weighting(:, 1 + d)) * weighting(:, 1)
      end do
    end do
  end subroutine quotients

end module isomortar_solid_points
