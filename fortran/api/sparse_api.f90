! What Python sees of the sparse LU (isomortar_sparse_factorisation). Compressed rows, all numbers from 0.
!
! - `handle`: a pattern that was analysed, and the factors of the last matrix of that pattern.
! - `n`, `nnz`: numbers of unknowns, of entries. `values`: the entries, in the order of the pattern.
! - `status`, `place`: how it ended (isomortar_base_status); on failure UMFPACK's return code, else -1.
! `sparse_factorise` and `sparse_solve` run without Python's lock: one call at a time for one handle.

!> Order and analyse a pattern.
!>
!> - `indptr`, `indices`: where rows begin, and the columns of their entries, which rise.
!> - `by_metis`: 1: METIS, 0: AMD.
!> - `narrow`: 1: indices of 32 bits, where a factorisation is estimated at no more than `narrow_limit` bytes; 0: of 64.
subroutine sparse_analyse(n, nnz, indptr, indices, by_metis, narrow_limit, handle, narrow, place, status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_sparse_factorisation, only: analyse
  implicit none
  integer(c_int64_t), intent(in) :: n, nnz
  integer(c_int64_t), intent(in) :: indptr(n + 1), indices(nnz)
  integer(c_int), intent(in) :: by_metis
  real(c_double), intent(in) :: narrow_limit
  integer(c_int64_t), intent(out) :: handle, place
  integer(c_int), intent(out) :: narrow, status
  logical :: is_narrow

  call analyse(indptr, indices, by_metis == 1, narrow_limit, handle, is_narrow, place, status)
  narrow = merge(1, 0, is_narrow)
end subroutine sparse_analyse

!> Factorise a matrix of the pattern analysed; when singular, `place` is the unknown that is determined least.
!>
!> - `rcond_min`: smallest reciprocal condition that passes for regular.
!> - `rcond`: estimate of the reciprocal condition: smallest over largest pivot.
!> - `flops`, `peak_bytes`, `factor_entries`: operations, peak memory (analysis included), entries of L and U.
recursive subroutine sparse_factorise(handle, nnz, values, rcond_min, rcond, flops, peak_bytes, factor_entries, place, status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_sparse_factorisation, only: factorise
  implicit none
  !f2py threadsafe
  integer(c_int64_t), intent(in) :: handle, nnz
  real(c_double), intent(in) :: values(nnz), rcond_min
  real(c_double), intent(out) :: rcond, flops, peak_bytes, factor_entries
  integer(c_int64_t), intent(out) :: place
  integer(c_int), intent(out) :: status

  call factorise(handle, values, rcond_min, rcond, flops, peak_bytes, factor_entries, place, status)
end subroutine sparse_factorise

!> Solve for several right-hand sides.
!>
!> - `b`, `x`: the right-hand sides, `columns` of them, and their solutions.
!> - `refine`: most steps of iterative refinement of each.
recursive subroutine sparse_solve(handle, n, nnz, columns, values, b, refine, x, place, status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_sparse_factorisation, only: solve
  implicit none
  !f2py threadsafe
  integer(c_int64_t), intent(in) :: handle, n, nnz, columns
  real(c_double), intent(in) :: values(nnz), b(n, columns)
  integer(c_int), intent(in) :: refine
  real(c_double), intent(out) :: x(n, columns)
  integer(c_int64_t), intent(out) :: place
  integer(c_int), intent(out) :: status

  call solve(handle, values, b, refine, x, place, status)
end subroutine sparse_solve

!> Free what a handle owns.
subroutine sparse_release(handle, status)
  use iso_c_binding, only: c_int, c_int64_t
  use isomortar_sparse_handles, only: release
  implicit none
  integer(c_int64_t), intent(in) :: handle
  integer(c_int), intent(out) :: status

  call release(handle, status)
end subroutine sparse_release
