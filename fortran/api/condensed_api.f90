! What Python sees of factors of bodies with their faces (isomortar_sparse_condensation). Compressed rows, all numbers from 0.
!
! - `handle`: a pattern that was analysed, and the factors of the last matrix of that pattern; `sparse_release` frees it.
! - `n`, `nnz`: numbers of the bodies' unknowns, of the entries of their stiffness. `trailing`: unknowns of faces and others.
! - `status`, `place`: how it ended (isomortar_base_status); where all slots are taken, their number, else -1.
! `condensed_factorise`, `condensed_renew` and `condensed_solve` run without Python's lock: one call at a time for one handle.

!> Order the bodies' unknowns for little fill.
!>
!> - `indptr`, `indices`: where rows begin, and the columns of their entries, which rise; symmetric. `by_metis`: 1: METIS, 0: AMD.
!> - `order`: the unknowns in their order. `flops`: operations of a factorisation by it.
subroutine condensed_order(n, nnz, indptr, indices, by_metis, order, flops, status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_sparse_condensation, only: order_bodies
  implicit none
  integer(c_int64_t), intent(in) :: n, nnz
  integer(c_int64_t), intent(in) :: indptr(n + 1), indices(nnz)
  integer(c_int), intent(in) :: by_metis
  integer(c_int64_t), intent(out) :: order(n)
  real(c_double), intent(out) :: flops
  integer(c_int), intent(out) :: status

  call order_bodies(indptr, indices, by_metis == 1, order, flops, status)
end subroutine condensed_order

!> Analyse the pattern of the bodies' stiffness.
!>
!> - `indptr`, `indices`: where rows begin, and the columns of their entries, which rise; symmetric, with the diagonal.
!> - `on_face`: 1 for unknowns of faces in contact, 0 for others. `order`: that of the others.
!> - `flops`, `factor_entries`: operations of a factorisation of the stiffness, entries of its factor.
subroutine condensed_analyse(n, nnz, indptr, indices, on_face, order, handle, flops, factor_entries, place, status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_sparse_condensation, only: analyse_bodies
  implicit none
  integer(c_int64_t), intent(in) :: n, nnz
  integer(c_int64_t), intent(in) :: indptr(n + 1), indices(nnz), order(n)
  integer(c_int), intent(in) :: on_face(n)
  integer(c_int64_t), intent(out) :: handle, place
  real(c_double), intent(out) :: flops, factor_entries
  integer(c_int), intent(out) :: status

  call analyse_bodies(indptr, indices, on_face, order, handle, flops, factor_entries, place, status)
end subroutine condensed_analyse

!> Factorise a stiffness of the pattern analysed, with what is added on faces and beyond.
!>
!> - `values`: the stiffness. `added`: unknowns of faces by their numbers, then others.
!> - `rcond_min`: smallest reciprocal condition that passes for regular. `rcond`: its estimate.
recursive subroutine condensed_factorise(handle, nnz, trailing, values, added, rcond_min, rcond, status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_sparse_condensation, only: factorise_bodies
  implicit none
  !f2py threadsafe
  integer(c_int64_t), intent(in) :: handle, nnz, trailing
  real(c_double), intent(in) :: values(nnz), added(trailing, trailing), rcond_min
  real(c_double), intent(out) :: rcond
  integer(c_int), intent(out) :: status

  call factorise_bodies(handle, values, added, rcond_min, rcond, status)
end subroutine condensed_factorise

!> Factorise what is added on faces and beyond anew, with the stiffness of the last `condensed_factorise`, whose factors stay.
!>
!> - `added`, `rcond_min`, `rcond`: as there.
recursive subroutine condensed_renew(handle, trailing, added, rcond_min, rcond, status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_sparse_condensation, only: factorise_faces
  implicit none
  !f2py threadsafe
  integer(c_int64_t), intent(in) :: handle, trailing
  real(c_double), intent(in) :: added(trailing, trailing), rcond_min
  real(c_double), intent(out) :: rcond
  integer(c_int), intent(out) :: status

  call factorise_faces(handle, added, rcond_min, rcond, status)
end subroutine condensed_renew

!> Solve with the factors of the last `condensed_factorise` or `condensed_renew`.
!>
!> - `b`, `x`: right-hand side and solution, `n` unknowns: those of bodies, then others.
recursive subroutine condensed_solve(handle, n, b, x, status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_sparse_condensation, only: solve_bodies
  implicit none
  !f2py threadsafe
  integer(c_int64_t), intent(in) :: handle, n
  real(c_double), intent(in) :: b(n)
  real(c_double), intent(out) :: x(n)
  integer(c_int), intent(out) :: status

  call solve_bodies(handle, b, x, status)
end subroutine condensed_solve
