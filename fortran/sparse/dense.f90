!> Dense LU factors of what is left on the faces of bodies, by LAPACK.
!>
!> - `lu` (n, n): the matrix, its factors from `eliminate_dense` on. `pivot` (n): rows that changed places.
module isomortar_sparse_dense
  use, intrinsic :: iso_c_binding, only: c_double, c_int
  implicit none
  private

  public :: eliminate_dense, pivots_apart, substitute_dense

  interface
    subroutine dgetrf(m, n, a, lda, ipiv, info)
      import :: c_double, c_int
      implicit none
      integer(c_int), intent(in) :: m, n, lda
      real(c_double), intent(inout) :: a(lda, *)
      integer(c_int), intent(out) :: ipiv(*), info
    end subroutine dgetrf
    subroutine dgetrs(trans, n, nrhs, a, lda, ipiv, b, ldb, info)
      import :: c_double, c_int
      implicit none
      character, intent(in) :: trans
      integer(c_int), intent(in) :: n, nrhs, lda, ldb
      real(c_double), intent(in) :: a(lda, *)
      integer(c_int), intent(in) :: ipiv(*)
      real(c_double), intent(inout) :: b(ldb, *)
      integer(c_int), intent(out) :: info
    end subroutine dgetrs
  end interface

contains

  !> Factorise; whether that went well is told by `pivots_apart`.
  recursive subroutine eliminate_dense(lu, pivot)
    real(c_double), contiguous, intent(inout) :: lu(:, :)
    integer(c_int), contiguous, intent(out) :: pivot(:)
    integer(c_int) :: n, failure

    n = size(pivot)
    if (n > 0) call dgetrf(n, n, lu, n, pivot, failure) ! LAPACK takes no leading dimension of zero
  end subroutine eliminate_dense

  !> Solve with the factors; the solution takes the place of `right` (n, 1).
  recursive subroutine substitute_dense(lu, pivot, right)
    real(c_double), contiguous, intent(in) :: lu(:, :)
    integer(c_int), contiguous, intent(in) :: pivot(:)
    real(c_double), contiguous, intent(inout) :: right(:, :)
    integer(c_int) :: n, failure

    n = size(pivot)
    if (n > 0) call dgetrs("N", n, 1_c_int, lu, n, pivot, right, n, failure)
  end subroutine substitute_dense

  !> Smallest over largest pivot of the factors; zero where one is zero or not finite.
  pure recursive function pivots_apart(lu) result(ratio)
    real(c_double), intent(in) :: lu(:, :)
    real(c_double) :: ratio
    real(c_double), allocatable :: pivots(:)
    integer :: k

    allocate (pivots(size(lu, 1)))
    do k = 1, size(pivots)
      pivots(k) = abs(lu(k, k))
    end do
    ratio = 1
    if (maxval(pivots) > 0) ratio = minval(pivots) / maxval(pivots)
    if (any(.not. (pivots > 0 .and. pivots <= huge(pivots)))) ratio = 0
  end function pivots_apart

end module isomortar_sparse_dense
