!> Binding to UMFPACK, real matrices; names and numbers of `umfpack.h`, 5.7.
!>
!> Every routine is there with indices of 32 bits (`umfpack_di_*`) and of 64 (`umfpack_dl_*`); which one is meant follows from the
!> kind of the indices.
module isomortar_sparse_umfpack
  use, intrinsic :: iso_c_binding, only: c_double, c_int, c_int64_t, c_ptr
  implicit none
  private

  public :: umfpack_defaults, umfpack_symbolic, umfpack_numeric, umfpack_solve, umfpack_get_numeric
  public :: umfpack_di_free_symbolic, umfpack_dl_free_symbolic, umfpack_di_free_numeric, umfpack_dl_free_numeric

  !> Last entry (from 0) of the arrays of settings and of information.
  integer, parameter, public :: control_last = 19, info_last = 89

  !> Places in the array of settings.
  integer, parameter, public :: control_dense_row = 1, control_dense_col = 2, control_pivot_tolerance = 3, &
    control_strategy = 5, control_irstep = 7, control_ordering = 10, control_amd_dense = 14, &
    control_sym_pivot_tolerance = 15

  !> Places in the array of information.
  integer, parameter, public :: info_size_of_unit = 3, info_variable_peak_estimate = 26, info_peak_memory = 41, &
    info_flops = 42, info_lnz = 43, info_unz = 44, info_rcond = 67

  !> Values of settings.
  integer, parameter, public :: strategy_symmetric = 3, ordering_amd = 1, ordering_metis = 3

  !> Return codes.
  integer, parameter, public :: umfpack_ok = 0, umfpack_singular = 1, umfpack_out_of_memory = -1

  !> System that `umfpack_solve` solves: that of the transpose.
  integer, parameter, public :: umfpack_at = 1

  interface

    !> Fill the array of settings with UMFPACK's own; they do not depend on the kind of indices.
    subroutine umfpack_defaults(control) bind(C, name="umfpack_di_defaults")
      import :: c_double, control_last
      implicit none
      real(c_double), intent(out) :: control(0:control_last)
    end subroutine umfpack_defaults

  end interface

  !> Order and analyse a pattern (compressed columns); `ax` may be null: the pattern alone.
  interface umfpack_symbolic
    function umfpack_di_symbolic(n_row, n_col, ap, ai, ax, symbolic, control, info) result(code) &
      bind(C, name="umfpack_di_symbolic")
      import :: c_double, c_int, c_ptr, control_last, info_last
      implicit none
      integer(c_int), value :: n_row, n_col
      integer(c_int), intent(in) :: ap(*), ai(*)
      type(c_ptr), value :: ax
      type(c_ptr), intent(out) :: symbolic
      real(c_double), intent(in) :: control(0:control_last)
      real(c_double), intent(out) :: info(0:info_last)
      integer(c_int) :: code
    end function umfpack_di_symbolic
    function umfpack_dl_symbolic(n_row, n_col, ap, ai, ax, symbolic, control, info) result(code) &
      bind(C, name="umfpack_dl_symbolic")
      import :: c_double, c_int64_t, c_ptr, control_last, info_last
      implicit none
      integer(c_int64_t), value :: n_row, n_col
      integer(c_int64_t), intent(in) :: ap(*), ai(*)
      type(c_ptr), value :: ax
      type(c_ptr), intent(out) :: symbolic
      real(c_double), intent(in) :: control(0:control_last)
      real(c_double), intent(out) :: info(0:info_last)
      integer(c_int64_t) :: code
    end function umfpack_dl_symbolic
  end interface umfpack_symbolic

  !> Factorise a matrix of the pattern analysed: L U = P R A Q.
  interface umfpack_numeric
    function umfpack_di_numeric(ap, ai, ax, symbolic, numeric, control, info) result(code) &
      bind(C, name="umfpack_di_numeric")
      import :: c_double, c_int, c_ptr, control_last, info_last
      implicit none
      integer(c_int), intent(in) :: ap(*), ai(*)
      real(c_double), intent(in) :: ax(*)
      type(c_ptr), value :: symbolic
      type(c_ptr), intent(out) :: numeric
      real(c_double), intent(in) :: control(0:control_last)
      real(c_double), intent(out) :: info(0:info_last)
      integer(c_int) :: code
    end function umfpack_di_numeric
    function umfpack_dl_numeric(ap, ai, ax, symbolic, numeric, control, info) result(code) &
      bind(C, name="umfpack_dl_numeric")
      import :: c_double, c_int64_t, c_ptr, control_last, info_last
      implicit none
      integer(c_int64_t), intent(in) :: ap(*), ai(*)
      real(c_double), intent(in) :: ax(*)
      type(c_ptr), value :: symbolic
      type(c_ptr), intent(out) :: numeric
      real(c_double), intent(in) :: control(0:control_last)
      real(c_double), intent(out) :: info(0:info_last)
      integer(c_int64_t) :: code
    end function umfpack_dl_numeric
  end interface umfpack_numeric

  !> Solve with the factors; the matrix itself serves the iterative refinement.
  interface umfpack_solve
    function umfpack_di_solve(sys, ap, ai, ax, x, b, numeric, control, info) result(code) &
      bind(C, name="umfpack_di_solve")
      import :: c_double, c_int, c_ptr, control_last, info_last
      implicit none
      integer(c_int), value :: sys
      integer(c_int), intent(in) :: ap(*), ai(*)
      real(c_double), intent(in) :: ax(*)
      real(c_double), intent(out) :: x(*)
      real(c_double), intent(in) :: b(*)
      type(c_ptr), value :: numeric
      real(c_double), intent(in) :: control(0:control_last)
      real(c_double), intent(out) :: info(0:info_last)
      integer(c_int) :: code
    end function umfpack_di_solve
    function umfpack_dl_solve(sys, ap, ai, ax, x, b, numeric, control, info) result(code) &
      bind(C, name="umfpack_dl_solve")
      import :: c_double, c_int64_t, c_ptr, control_last, info_last
      implicit none
      integer(c_int64_t), value :: sys
      integer(c_int64_t), intent(in) :: ap(*), ai(*)
      real(c_double), intent(in) :: ax(*)
      real(c_double), intent(out) :: x(*)
      real(c_double), intent(in) :: b(*)
      type(c_ptr), value :: numeric
      real(c_double), intent(in) :: control(0:control_last)
      real(c_double), intent(out) :: info(0:info_last)
      integer(c_int64_t) :: code
    end function umfpack_dl_solve
  end interface umfpack_solve

  !> Copy parts of the factors; what is passed as null is left out. Of use here: row order `p`, diagonal `dx` of U.
  interface umfpack_get_numeric
    function umfpack_di_get_numeric(lp, lj, lx, up, ui, ux, p, q, dx, do_recip, rs, numeric) result(code) &
      bind(C, name="umfpack_di_get_numeric")
      import :: c_double, c_int, c_ptr
      implicit none
      type(c_ptr), value :: lp, lj, lx, up, ui, ux, q, rs
      integer(c_int), intent(out) :: p(*)
      real(c_double), intent(out) :: dx(*)
      integer(c_int), intent(out) :: do_recip
      type(c_ptr), value :: numeric
      integer(c_int) :: code
    end function umfpack_di_get_numeric
    function umfpack_dl_get_numeric(lp, lj, lx, up, ui, ux, p, q, dx, do_recip, rs, numeric) result(code) &
      bind(C, name="umfpack_dl_get_numeric")
      import :: c_double, c_int64_t, c_ptr
      implicit none
      type(c_ptr), value :: lp, lj, lx, up, ui, ux, q, rs
      integer(c_int64_t), intent(out) :: p(*)
      real(c_double), intent(out) :: dx(*)
      integer(c_int64_t), intent(out) :: do_recip
      type(c_ptr), value :: numeric
      integer(c_int64_t) :: code
    end function umfpack_dl_get_numeric
  end interface umfpack_get_numeric

  !> Free an analysis, or factors, and make the pointer null; nothing happens to a null one.
  interface
    subroutine umfpack_di_free_symbolic(symbolic) bind(C, name="umfpack_di_free_symbolic")
      import :: c_ptr
      implicit none
      type(c_ptr), intent(inout) :: symbolic
    end subroutine umfpack_di_free_symbolic
    subroutine umfpack_di_free_numeric(numeric) bind(C, name="umfpack_di_free_numeric")
      import :: c_ptr
      implicit none
      type(c_ptr), intent(inout) :: numeric
    end subroutine umfpack_di_free_numeric
    subroutine umfpack_dl_free_symbolic(symbolic) bind(C, name="umfpack_dl_free_symbolic")
      import :: c_ptr
      implicit none
      type(c_ptr), intent(inout) :: symbolic
    end subroutine umfpack_dl_free_symbolic
    subroutine umfpack_dl_free_numeric(numeric) bind(C, name="umfpack_dl_free_numeric")
      import :: c_ptr
      implicit none
      type(c_ptr), intent(inout) :: numeric
    end subroutine umfpack_dl_free_numeric
  end interface

end module isomortar_sparse_umfpack
