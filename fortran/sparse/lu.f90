!> LU factors of one sparse matrix by UMFPACK, with indices of 32 bits where the factors fit, else of 64.
!>
!> Narrow indices are a tenth to an eighth faster; they cap the memory of a factorisation (matrix, fronts and factors) at 2 GiB.
!> The matrix A comes in compressed rows (0-based). UMFPACK reads these as the compressed columns of the transpose, factorises that,
!> and solves with the transpose of what it factorised: A x = b.
!>
!> - `values` (entries): entries of the matrix, in the order of the pattern. `code`: what UMFPACK returned.
module isomortar_sparse_lu
  use, intrinsic :: iso_c_binding, only: c_double, c_int, c_int64_t, c_null_ptr, c_ptr
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_predicate, only: is_compressed, is_permutation
  use isomortar_sparse_umfpack, only: umfpack_defaults, umfpack_symbolic, umfpack_numeric, umfpack_solve, &
    umfpack_get_numeric, umfpack_di_free_symbolic, umfpack_dl_free_symbolic, umfpack_di_free_numeric, &
    umfpack_dl_free_numeric, umfpack_ok, umfpack_out_of_memory, umfpack_at, strategy_symmetric, ordering_metis, &
    control_last, control_dense_row, control_dense_col, control_pivot_tolerance, control_strategy, control_irstep, &
    control_ordering, control_amd_dense, control_sym_pivot_tolerance, info_last, info_variable_peak_estimate, &
    info_size_of_unit
  implicit none
  private

  public :: eliminate, forget, forget_factors, order, smallest_pivot, substitute

  !> Rows with more entries than this times sqrt(n) count as dense (16 times as many for COLAMD): UMFPACK's own limits
  !> take most rows of a high-order matrix for dense and spoil the ordering.
  real(c_double), parameter :: dense_limit = 1.0e3_c_double

  !> Threshold of partial pivoting, on the diagonal and off it: no pivot is smaller than what it eliminates. With a tenth
  !> errors grew along a belt of 60 elements, a chain, until no digit was left of a solution whose condition is 1e6; factors
  !> are about as large.
  real(c_double), parameter :: pivot_tolerance = 1.0_c_double

  !> One pattern, its analysis, and the factors of the last matrix of that pattern.
  type, public :: lu_t
    integer :: ordering = ordering_metis
    integer :: unknowns = 0
    !> The pattern, in the indices that are in use; the other pair is not allocated.
    integer(c_int), allocatable :: start(:), column(:)
    integer(c_int64_t), allocatable :: wide_start(:), wide_column(:)
    type(c_ptr) :: symbolic = c_null_ptr
    type(c_ptr) :: numeric = c_null_ptr
  end type lu_t

contains

  !> Order and analyse a pattern.
  !>
  !> - `indptr` (unknowns + 1), `indices` (entries): compressed rows, from 0, columns increasing within a row.
  !> - `ordering`: UMFPACK's number of it.
  !> - `narrow_limit`: indices are narrow where the memory of a factorisation is estimated at no more than so many bytes.
  subroutine order(self, indptr, indices, ordering, narrow_limit, code)
    type(lu_t), intent(inout) :: self
    integer(c_int64_t), contiguous, intent(in) :: indptr(:), indices(:)
    integer, intent(in) :: ordering
    real(c_double), intent(in) :: narrow_limit
    integer(c_int64_t), intent(out) :: code
    real(c_double) :: info(0:info_last)

    if (contracts) call require(is_compressed(indptr, size(indices)), "order: rows follow one another")
    if (contracts) call require(all(indices >= 0 .and. indices < size(indptr) - 1), "order: columns are unknowns")
    self%ordering = ordering
    self%unknowns = size(indptr) - 1
    if (size(indices, kind=c_int64_t) <= huge(1_c_int)) then
      call order_narrow(self, indptr, indices, info, code)
      if (code == umfpack_ok .and. info(info_variable_peak_estimate) * info(info_size_of_unit) <= narrow_limit) return
      call forget(self)
    end if
    call order_wide(self, indptr, indices, info, code)
    if (code /= umfpack_ok) call forget(self)
  end subroutine order

  !> With indices of 32 bits.
  subroutine order_narrow(self, indptr, indices, info, code)
    type(lu_t), intent(inout) :: self
    integer(c_int64_t), contiguous, intent(in) :: indptr(:), indices(:)
    real(c_double), intent(out) :: info(0:info_last)
    integer(c_int64_t), intent(out) :: code
    integer :: failure

    info = 0
    code = umfpack_out_of_memory
    allocate (self%start(size(indptr)), stat=failure)
    if (failure == 0) allocate (self%column(size(indices)), stat=failure)
    if (failure /= 0) return
    self%start(:) = int(indptr, c_int)
    self%column(:) = int(indices, c_int)
    associate (n => int(self%unknowns, c_int))
      code = umfpack_symbolic(n, n, self%start, self%column, c_null_ptr, self%symbolic, settings(self), info)
    end associate
  end subroutine order_narrow

  !> With indices of 64 bits.
  subroutine order_wide(self, indptr, indices, info, code)
    type(lu_t), intent(inout) :: self
    integer(c_int64_t), contiguous, intent(in) :: indptr(:), indices(:)
    real(c_double), intent(out) :: info(0:info_last)
    integer(c_int64_t), intent(out) :: code
    integer :: failure

    info = 0
    code = umfpack_out_of_memory
    allocate (self%wide_start(size(indptr)), stat=failure)
    if (failure == 0) allocate (self%wide_column(size(indices)), stat=failure)
    if (failure /= 0) return
    self%wide_start(:) = indptr
    self%wide_column(:) = indices
    associate (n => int(self%unknowns, c_int64_t))
      code = umfpack_symbolic(n, n, self%wide_start, self%wide_column, c_null_ptr, self%symbolic, settings(self), info)
    end associate
  end subroutine order_wide

  !> Factorise a matrix of the pattern; the factors take the place of those before. `info` is what UMFPACK tells of it.
  recursive subroutine eliminate(self, values, info, code)
    type(lu_t), intent(inout) :: self
    real(c_double), contiguous, intent(in) :: values(:)
    real(c_double), intent(out) :: info(0:info_last)
    integer(c_int64_t), intent(out) :: code

    call forget_factors(self)
    if (allocated(self%start)) then
      if (contracts) call require(size(values) == size(self%column), "eliminate: entries are those of the pattern")
      code = umfpack_numeric(self%start, self%column, values, self%symbolic, self%numeric, settings(self), info)
    else
      if (contracts) call require(size(values) == size(self%wide_column), "eliminate: entries are those of the pattern")
      code = umfpack_numeric(self%wide_start, self%wide_column, values, self%symbolic, self%numeric, settings(self), info)
    end if
  end subroutine eliminate

  !> Solve A x = b with the factors: `b` (unknowns), `x` (unknowns). At most `refine` steps of iterative refinement; UMFPACK stops
  !> when they gain nothing.
  recursive subroutine substitute(self, values, b, refine, x, code)
    type(lu_t), intent(in) :: self
    real(c_double), contiguous, intent(in) :: values(:), b(:)
    integer, intent(in) :: refine
    real(c_double), contiguous, intent(out) :: x(:)
    integer(c_int64_t), intent(out) :: code
    real(c_double) :: control(0:control_last), info(0:info_last)

    if (contracts) call require(size(b) == self%unknowns .and. size(x) == size(b), "substitute: vectors are those of the matrix")
    control = settings(self)
    control(control_irstep) = refine
    if (allocated(self%start)) then
      code = umfpack_solve(int(umfpack_at, c_int), self%start, self%column, values, x, b, self%numeric, control, info)
    else
      code = umfpack_solve(int(umfpack_at, c_int64_t), self%wide_start, self%wide_column, values, x, b, self%numeric, control, info)
    end if
  end subroutine substitute

  !> Unknown (0-based) with the smallest pivot, -1 if UMFPACK does not tell: the rows UMFPACK pivots are the columns of A.
  recursive function smallest_pivot(self) result(unknown)
    type(lu_t), intent(in) :: self
    integer(c_int64_t) :: unknown
    integer(c_int), allocatable :: rows(:)
    integer(c_int64_t), allocatable :: wide_rows(:)
    real(c_double), allocatable :: pivots(:)
    integer(c_int) :: do_recip
    integer(c_int64_t) :: wide_do_recip

    unknown = -1
    allocate (pivots(self%unknowns))
    associate (none => c_null_ptr)
      if (allocated(self%start)) then
        allocate (rows(self%unknowns))
        if (umfpack_get_numeric(none, none, none, none, none, none, rows, none, pivots, do_recip, none, self%numeric) &
          == umfpack_ok) unknown = rows(minloc(abs(pivots), dim=1))
        if (contracts) call require(unknown < 0 .or. is_permutation(int(rows, c_int64_t)), "smallest_pivot: rows are in some order")
      else
        allocate (wide_rows(self%unknowns))
        if (umfpack_get_numeric(none, none, none, none, none, none, wide_rows, none, pivots, wide_do_recip, none, &
          self%numeric) == umfpack_ok) unknown = wide_rows(minloc(abs(pivots), dim=1))
        if (contracts) call require(unknown < 0 .or. is_permutation(wide_rows), "smallest_pivot: rows are in some order")
      end if
    end associate
  end function smallest_pivot

  !> Free the factors.
  recursive subroutine forget_factors(self)
    type(lu_t), intent(inout) :: self

    if (allocated(self%start)) then
      call umfpack_di_free_numeric(self%numeric)
    else
      call umfpack_dl_free_numeric(self%numeric)
    end if
  end subroutine forget_factors

  !> Free everything.
  subroutine forget(self)
    type(lu_t), intent(inout) :: self

    call forget_factors(self)
    if (allocated(self%start)) then
      call umfpack_di_free_symbolic(self%symbolic)
    else
      call umfpack_dl_free_symbolic(self%symbolic)
    end if
    if (allocated(self%start)) deallocate (self%start)
    if (allocated(self%column)) deallocate (self%column)
    if (allocated(self%wide_start)) deallocate (self%wide_start)
    if (allocated(self%wide_column)) deallocate (self%wide_column)
  end subroutine forget

  !> UMFPACK's settings for matrices of elements: nearly symmetric pattern, few rows that are really dense.
  recursive function settings(self) result(control)
    type(lu_t), intent(in) :: self
    real(c_double) :: control(0:control_last)

    call umfpack_defaults(control)
    control(control_strategy) = strategy_symmetric
    control(control_ordering) = self%ordering
    control(control_amd_dense) = dense_limit
    control(control_dense_row) = dense_limit
    control(control_dense_col) = dense_limit
    control(control_pivot_tolerance) = pivot_tolerance
    control(control_sym_pivot_tolerance) = pivot_tolerance
  end function settings

end module isomortar_sparse_lu
