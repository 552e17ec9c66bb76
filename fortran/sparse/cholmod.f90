!> Binding to Cholesky factors by CHOLMOD (cholmod.c) of symmetric matrices some rows of which come last.
!>
!> The matrix comes in compressed rows, both halves; rows and columns count from 0. Codes are those below.
module isomortar_sparse_cholmod
  use, intrinsic :: iso_c_binding, only: c_double, c_int, c_int64_t, c_ptr
  implicit none
  private

  public :: cholesky_order, cholesky_analyse, cholesky_factorise, cholesky_forth, cholesky_back, cholesky_forget

  !> How a call ended.
  integer(c_int), parameter, public :: cholesky_done = 0, cholesky_indefinite = 1, cholesky_out_of_memory = 2

  interface

    !> Order a pattern for little fill.
    !>
    !> - `rows`, `start` (rows + 1), `column` (entries): the pattern. `by_metis`: 1: METIS, 0: AMD.
    !> - `order` (rows): the rows in their order. `flops`: operations of a factorisation by it.
    function cholesky_order(rows, start, column, by_metis, order, flops) result(code) bind(C, name="isomortar_cholesky_order")
      import :: c_double, c_int, c_int64_t
      implicit none
      integer(c_int64_t), value :: rows
      integer(c_int64_t), intent(in) :: start(*), column(*)
      integer(c_int), value :: by_metis
      integer(c_int64_t), intent(out) :: order(*)
      real(c_double), intent(out) :: flops
      integer(c_int) :: code
    end function cholesky_order

    !> Analyse a pattern in a given order but for its last rows.
    !>
    !> - `rows`, `start` (rows + 1), `column` (entries): the pattern, with the diagonal.
    !> - `is_last` (rows): 1 where a row comes last, in the order of their numbers; 0 elsewhere. `order` (rows): that of the others.
    !> - `flops`, `entries`: operations of a factorisation, entries of the factor.
    !> - What the others take is null where the code is not done.
    function cholesky_analyse(rows, start, column, is_last, order, flops, entries, self) result(code) &
      bind(C, name="isomortar_cholesky_analyse")
      import :: c_double, c_int, c_int64_t, c_ptr
      implicit none
      integer(c_int64_t), value :: rows
      integer(c_int64_t), intent(in) :: start(*), column(*), order(*)
      integer(c_int), intent(in) :: is_last(*)
      real(c_double), intent(out) :: flops, entries
      type(c_ptr), intent(out) :: self
      integer(c_int) :: code
    end function cholesky_analyse

    !> Factorise a matrix of the pattern, with more on the diagonal of its last rows.
    !>
    !> - `values` (entries): of the matrix. `share`: what the last diagonals grow by, of themselves; `shift` (last rows): by how
    !>   much each did.
    !> - `corner` (last rows, last rows): the factor's rows and columns of these, lower triangle, zero above.
    !> - `least`: the least pivot as a share of its diagonal.
    function cholesky_factorise(self, values, share, corner, shift, least) result(code) &
      bind(C, name="isomortar_cholesky_factorise")
      import :: c_double, c_int, c_ptr
      implicit none
      type(c_ptr), value :: self
      real(c_double), intent(in) :: values(*)
      real(c_double), value :: share
      real(c_double), intent(out) :: corner(*), shift(*), least
      integer(c_int) :: code
    end function cholesky_factorise

    !> Solve L y = P b: `right` (rows) in the matrix' numbering, `solution` (rows) in the factor's, last rows last.
    function cholesky_forth(self, right, solution) result(code) bind(C, name="isomortar_cholesky_forth")
      import :: c_double, c_int, c_ptr
      implicit none
      type(c_ptr), value :: self
      real(c_double), intent(in) :: right(*)
      real(c_double), intent(out) :: solution(*)
      integer(c_int) :: code
    end function cholesky_forth

    !> Solve L^T P x = y: `right` (rows) in the factor's numbering, `solution` (rows) in the matrix'.
    function cholesky_back(self, right, solution) result(code) bind(C, name="isomortar_cholesky_back")
      import :: c_double, c_int, c_ptr
      implicit none
      type(c_ptr), value :: self
      real(c_double), intent(in) :: right(*)
      real(c_double), intent(out) :: solution(*)
      integer(c_int) :: code
    end function cholesky_back

    !> Free everything, and make the pointer null; nothing happens to a null one.
    subroutine cholesky_forget(self) bind(C, name="isomortar_cholesky_forget")
      import :: c_ptr
      implicit none
      type(c_ptr), intent(inout) :: self
    end subroutine cholesky_forget

  end interface

end module isomortar_sparse_cholmod
