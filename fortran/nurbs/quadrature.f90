!> Gauss-Legendre quadrature of any number of points.
module isomortar_nurbs_quadrature
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: sums_to
  implicit none
  private

  public :: gauss_legendre

contains

  !> The `points` (number) and their `weights` (number) on [0, 1], by Newton's method on the Legendre polynomial (theory 2.7).
  pure subroutine gauss_legendre(points, weights)
    real(wp), intent(out) :: points(:), weights(:)
    real(wp), parameter :: pi = acos(-1.0_wp)
    integer :: i, iteration, n
    real(wp) :: z, value, slope, step

    n = size(points)
    if (contracts) call require(n >= 1 .and. size(weights) == n, "gauss_legendre: as many weights as points")
    do i = 1, n
      z = -cos(pi * (real(i, wp) - 0.25_wp) / (real(n, wp) + 0.5_wp))
      do iteration = 1, 100
        call legendre(n, z, value, slope)
        step = value / slope
        z = z - step
        if (abs(step) <= 4.0_wp * epsilon(1.0_wp)) exit
      end do
      call legendre(n, z, value, slope)
      points(i) = 0.5_wp * (1.0_wp + z)
      weights(i) = 1.0_wp / ((1.0_wp - z) * (1.0_wp + z) * slope**2)
    end do
    if (contracts) call require(all([points, 1.0_wp] > [0.0_wp, points]), "gauss_legendre: points rise from 0 to 1")
    if (contracts) call require(all(weights > 0.0_wp) .and. sums_to(weights, 1.0_wp), "gauss_legendre: weights sum to 1")
  end subroutine gauss_legendre

  !> Legendre polynomial of degree n and its derivative at z, by the three-term recurrence.
  pure subroutine legendre(n, z, value, slope)
    integer, intent(in) :: n
    real(wp), intent(in) :: z
    real(wp), intent(out) :: value, slope
    integer :: k
    real(wp) :: previous, next

    previous = 1.0_wp
    value = z
    do k = 2, n
      next = (real(2 * k - 1, wp) * z * value - real(k - 1, wp) * previous) / real(k, wp)
      previous = value
      value = next
    end do
    slope = real(n, wp) * (z * value - previous) / ((z - 1.0_wp) * (z + 1.0_wp))
  end subroutine legendre

end module isomortar_nurbs_quadrature
