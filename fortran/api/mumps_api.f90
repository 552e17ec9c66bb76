! What Python sees of factors of bodies on several ranks (isomortar_sparse_distributed), in an extension of its own, which
! is built where MUMPS and MPI are to be used. Compressed rows, all numbers from 0. On the first rank, one call at a time.
!
! - `handle`: a pattern that was analysed, and the factors of the last matrix of that pattern; `mumps_release` frees it.
! - `n`, `nnz`: numbers of the bodies' unknowns, of the entries of their stiffness. `trailing`: unknowns of faces and others.
! - `status`, `place`: how it ended (isomortar_base_status); where all handles are taken, their number; else MUMPS's own code.

!> Begin MPI, where that was not done.
!>
!> - `ranks`: how many processes there are; 0 where MPI has ended. `rank`: which one this is.
subroutine mumps_join(ranks, rank)
  use iso_c_binding, only: c_int
  use isomortar_sparse_ranks, only: join
  implicit none
  integer(c_int), intent(out) :: ranks, rank

  call join(ranks, rank)
end subroutine mumps_join

!> Do what the first rank sets, until it ends.
!>
!> - `rank`: which one this is; on the first one nothing is done.
subroutine mumps_serve(rank)
  use iso_c_binding, only: c_int
  use isomortar_sparse_mumps, only: serve_first_rank
  implicit none
  integer(c_int), intent(out) :: rank

  call serve_first_rank(rank)
end subroutine mumps_serve

!> End the other ranks, and MPI.
subroutine mumps_end()
  use isomortar_sparse_mumps, only: end_ranks
  implicit none

  call end_ranks()
end subroutine mumps_end

!> Analyse the pattern of the bodies' stiffness.
!>
!> - `indptr`, `indices`: where rows begin, and the columns of their entries, which rise; symmetric, with the diagonal.
!> - `on_face`: 1 for unknowns of faces in contact, 0 for others. `order`: that of the others.
!> - `compression`: bound of what blocks of low rank leave out, of a matrix with a unit diagonal; 0: nothing.
subroutine mumps_analyse(n, nnz, indptr, indices, on_face, order, compression, handle, place, status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_sparse_distributed, only: analyse_distributed
  implicit none
  !f2py threadsafe
  integer(c_int64_t), intent(in) :: n, nnz
  integer(c_int64_t), intent(in) :: indptr(n + 1), indices(nnz), order(n)
  integer(c_int), intent(in) :: on_face(n)
  real(c_double), intent(in) :: compression
  integer(c_int), intent(out) :: handle
  integer(c_int64_t), intent(out) :: place
  integer(c_int), intent(out) :: status

  call analyse_distributed(indptr, indices, on_face, order, compression, handle, place, status)
end subroutine mumps_analyse

!> Factorise a stiffness of the pattern analysed, with what is added on faces and beyond.
!>
!> - `values`: the stiffness. `added`: unknowns of faces by their numbers, then others.
!> - `rcond_min`: smallest reciprocal condition that passes for regular. `rcond`: its estimate.
!> - `factor_entries`: entries of the factors on all ranks, as they are kept.
subroutine mumps_factorise(handle, nnz, trailing, values, added, rcond_min, rcond, factor_entries, place, status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_sparse_distributed, only: factorise_distributed
  implicit none
  !f2py threadsafe
  integer(c_int), intent(in) :: handle
  integer(c_int64_t), intent(in) :: nnz, trailing
  real(c_double), intent(in) :: values(nnz), added(trailing, trailing), rcond_min
  real(c_double), intent(out) :: rcond, factor_entries
  integer(c_int64_t), intent(out) :: place
  integer(c_int), intent(out) :: status

  call factorise_distributed(handle, values, added, rcond_min, rcond, factor_entries, place, status)
end subroutine mumps_factorise

!> Factorise what is added on faces and beyond anew, with the stiffness of the last `mumps_factorise`, whose factors stay.
!>
!> - `added`, `rcond_min`, `rcond`: as there.
subroutine mumps_renew(handle, trailing, added, rcond_min, rcond, status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_sparse_distributed, only: renew_distributed
  implicit none
  !f2py threadsafe
  integer(c_int), intent(in) :: handle
  integer(c_int64_t), intent(in) :: trailing
  real(c_double), intent(in) :: added(trailing, trailing), rcond_min
  real(c_double), intent(out) :: rcond
  integer(c_int), intent(out) :: status

  call renew_distributed(handle, added, rcond_min, rcond, status)
end subroutine mumps_renew

!> Solve with the factors of the last `mumps_factorise` or `mumps_renew`.
!>
!> - `b`, `x`: right-hand side and solution, `n` unknowns: those of bodies, then others.
subroutine mumps_solve(handle, n, b, x, place, status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_sparse_distributed, only: solve_distributed
  implicit none
  !f2py threadsafe
  integer(c_int), intent(in) :: handle
  integer(c_int64_t), intent(in) :: n
  real(c_double), intent(in) :: b(n)
  real(c_double), intent(out) :: x(n)
  integer(c_int64_t), intent(out) :: place
  integer(c_int), intent(out) :: status

  call solve_distributed(handle, b, x, place, status)
end subroutine mumps_solve

!> Free the factors on all ranks.
subroutine mumps_release(handle)
  use iso_c_binding, only: c_int
  use isomortar_sparse_distributed, only: release_distributed
  implicit none
  !f2py threadsafe
  integer(c_int), intent(in) :: handle

  call release_distributed(handle)
end subroutine mumps_release
