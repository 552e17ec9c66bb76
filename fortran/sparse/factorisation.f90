!> Table of sparse factorisations, the one saved state of the kernel. A handle is a slot of the table and the slot's
!> generation.
!>
!> A matrix A comes in compressed rows (0-based). UMFPACK reads these as the compressed columns of the transpose,
!> factorises that, and solves with the transpose of what it factorised: A x = b.
!>
!> Threads: `analyse` and `release` change the table and run one at a time (the caller holds Python's lock; METIS also
!> draws from the random numbers of the whole process). `factorise` and `solve` touch their own slot only and may run at
!> the same time for different handles: the table therefore never moves in memory, and what they call is `recursive`
!> (locals of their own; without it Fortran 2008 lets them be shared).
module isomortar_sparse_factorisation
  use, intrinsic :: iso_c_binding, only: c_associated, c_double, c_int64_t, c_null_ptr, c_ptr
  use isomortar_base_status, only: status_ok, status_singular, status_stale_handle, status_out_of_memory, &
    status_library
  use isomortar_sparse_umfpack, only: umfpack_dl_defaults, umfpack_dl_symbolic, umfpack_dl_numeric, umfpack_dl_solve, &
    umfpack_dl_get_numeric, umfpack_dl_free_symbolic, umfpack_dl_free_numeric, umfpack_ok, umfpack_singular, &
    umfpack_out_of_memory, umfpack_at, strategy_symmetric, ordering_amd, ordering_metis, control_last, &
    control_dense_row, control_dense_col, control_pivot_tolerance, control_strategy, control_irstep, &
    control_ordering, control_amd_dense, control_sym_pivot_tolerance, info_last, info_size_of_unit, &
    info_peak_memory, info_flops, info_lnz, info_unz, info_rcond
  implicit none
  private

  public :: analyse, factorise, solve, release

  !> Most factorisations alive at once.
  integer(c_int64_t), parameter :: slots = 1024

  !> Rows with more entries than this times sqrt(n) count as dense (16 times as many for COLAMD): UMFPACK's own limits
  !> take most rows of a high-order matrix for dense and spoil the ordering.
  real(c_double), parameter :: dense_limit = 1.0e3_c_double

  !> Threshold of partial pivoting, on the diagonal and off it. UMFPACK's 1e-3 on the diagonal needs refinement to keep
  !> the digits.
  real(c_double), parameter :: pivot_tolerance = 0.1_c_double

  !> One analysed pattern and the factors of the last matrix of that pattern.
  type :: factorisation
    integer(c_int64_t) :: generation = 1
    integer :: ordering = ordering_metis
    type(c_ptr) :: symbolic = c_null_ptr
    type(c_ptr) :: numeric = c_null_ptr
  end type factorisation

  type(factorisation) :: table(0:slots - 1)

contains

  !> Order and analyse a pattern, and take a slot for it.
  subroutine analyse(indptr, indices, by_metis, handle, place, status)
    !> Compressed rows, 0-based, columns increasing within a row.
    integer(c_int64_t), contiguous, intent(in) :: indptr(:), indices(:)
    !> METIS's nested dissection; otherwise AMD.
    logical, intent(in) :: by_metis
    integer(c_int64_t), intent(out) :: handle
    !> UMFPACK's return code when that is the failure; else -1.
    integer(c_int64_t), intent(out) :: place
    integer, intent(out) :: status

    real(c_double) :: info(0:info_last)
    integer(c_int64_t) :: slot, code

    handle = 0
    place = -1
    status = status_out_of_memory
    slot = free_slot()
    if (slot == slots) return

    associate (entry => table(slot), n => size(indptr, kind=c_int64_t) - 1)
      entry%ordering = merge(ordering_metis, ordering_amd, by_metis)
      code = umfpack_dl_symbolic(n, n, indptr, indices, c_null_ptr, entry%symbolic, settings(entry%ordering, 0), info)
      status = status_of(code)
      if (status == status_ok) then
        handle = entry%generation * slots + slot
      else
        if (status == status_library) place = code
        call umfpack_dl_free_symbolic(entry%symbolic)
      end if
    end associate
  end subroutine analyse

  !> Factorise a matrix of the pattern analysed; takes the place of the factors before.
  !>
  !> With a reciprocal condition below `rcond_min` (or none) the status is singular, and no factors are kept.
  recursive subroutine factorise(handle, indptr, indices, values, rcond_min, rcond, flops, peak_bytes, factor_entries, &
    place, status)
    integer(c_int64_t), intent(in) :: handle
    integer(c_int64_t), contiguous, intent(in) :: indptr(:), indices(:)
    real(c_double), contiguous, intent(in) :: values(:)
    !> Smallest reciprocal condition that passes for regular.
    real(c_double), intent(in) :: rcond_min
    !> Estimate of the reciprocal condition: smallest over largest pivot.
    real(c_double), intent(out) :: rcond
    !> Floating-point operations, peak memory (analysis included), entries of L and U.
    real(c_double), intent(out) :: flops, peak_bytes, factor_entries
    !> The unknown (0-based) that is determined least when singular, UMFPACK's return code when that is the failure; else -1.
    integer(c_int64_t), intent(out) :: place
    integer, intent(out) :: status

    real(c_double) :: info(0:info_last)
    integer(c_int64_t) :: slot, code

    rcond = 0
    flops = 0
    peak_bytes = 0
    factor_entries = 0
    place = -1
    slot = slot_of(handle)
    status = status_stale_handle
    if (slot == slots) return

    associate (entry => table(slot))
      call umfpack_dl_free_numeric(entry%numeric)
      code = umfpack_dl_numeric(indptr, indices, values, entry%symbolic, entry%numeric, settings(entry%ordering, 0), &
        info)
      status = status_of(code)
      if (status == status_library) place = code
      if (.not. c_associated(entry%numeric)) return

      rcond = info(info_rcond)
      flops = info(info_flops)
      peak_bytes = info(info_peak_memory) * info(info_size_of_unit)
      factor_entries = info(info_lnz) + info(info_unz)
      ! Written so that a condition that is not a number counts as singular too.
      if (rcond >= rcond_min .and. status == status_ok) return
      status = status_singular
      place = undetermined_unknown(entry, indptr, indices, values)
      call umfpack_dl_free_numeric(entry%numeric)
    end associate
  end subroutine factorise

  !> Solve A x = b for several right-hand sides with the factors of the last `factorise`.
  recursive subroutine solve(handle, indptr, indices, values, b, refine, x, place, status)
    integer(c_int64_t), intent(in) :: handle
    !> The matrix that was factorised.
    integer(c_int64_t), contiguous, intent(in) :: indptr(:), indices(:)
    real(c_double), contiguous, intent(in) :: values(:)
    !> Right-hand sides, shape (n, number).
    real(c_double), contiguous, intent(in) :: b(:, :)
    !> Most steps of iterative refinement; UMFPACK stops when they gain nothing.
    integer, intent(in) :: refine
    real(c_double), contiguous, intent(out) :: x(:, :)
    !> UMFPACK's return code when that is the failure; else -1.
    integer(c_int64_t), intent(out) :: place
    integer, intent(out) :: status

    real(c_double) :: control(0:control_last), info(0:info_last)
    integer(c_int64_t) :: slot, code
    integer :: column

    x = 0
    place = -1
    slot = slot_of(handle)
    status = status_stale_handle
    if (slot == slots) return
    if (.not. c_associated(table(slot)%numeric)) return

    status = status_ok
    control = settings(table(slot)%ordering, refine)
    do column = 1, size(b, 2)
      code = umfpack_dl_solve(umfpack_at, indptr, indices, values, x(:, column), b(:, column), table(slot)%numeric, &
        control, info)
      status = status_of(code)
      if (status == status_library) place = code
      if (status /= status_ok) return
    end do
  end subroutine solve

  !> Free what a handle owns. The handle is stale from then on, its slot free for others.
  subroutine release(handle, status)
    integer(c_int64_t), intent(in) :: handle
    integer, intent(out) :: status

    integer(c_int64_t) :: slot

    slot = slot_of(handle)
    status = status_stale_handle
    if (slot == slots) return
    call umfpack_dl_free_numeric(table(slot)%numeric)
    call umfpack_dl_free_symbolic(table(slot)%symbolic)
    table(slot)%generation = table(slot)%generation + 1
    status = status_ok
  end subroutine release

  !> First slot that is free; `slots` when none is.
  function free_slot() result(slot)
    integer(c_int64_t) :: slot

    do slot = 0, slots - 1
      if (.not. c_associated(table(slot)%symbolic)) return
    end do
  end function free_slot

  !> Slot of a handle; `slots` when the handle was never given out or was released.
  recursive function slot_of(handle) result(slot)
    integer(c_int64_t), intent(in) :: handle
    integer(c_int64_t) :: slot

    slot = modulo(handle, slots)
    if (handle / slots /= table(slot)%generation .or. .not. c_associated(table(slot)%symbolic)) slot = slots
  end function slot_of

  !> UMFPACK's settings for matrices of elements: nearly symmetric pattern, few rows that are really dense.
  recursive function settings(ordering, refine) result(control)
    integer, intent(in) :: ordering, refine
    real(c_double) :: control(0:control_last)

    call umfpack_dl_defaults(control)
    control(control_strategy) = strategy_symmetric
    control(control_ordering) = ordering
    control(control_amd_dense) = dense_limit
    control(control_dense_row) = dense_limit
    control(control_dense_col) = dense_limit
    control(control_pivot_tolerance) = pivot_tolerance
    control(control_sym_pivot_tolerance) = pivot_tolerance
    control(control_irstep) = refine
  end function settings

  !> Unknown (0-based) that a singular matrix determines least: the largest entry of its null vector, which is what a solve
  !> gives, for any right-hand side; where a pivot is zero, that of the pivot.
  recursive function undetermined_unknown(entry, indptr, indices, values) result(unknown)
    type(factorisation), intent(in) :: entry
    integer(c_int64_t), contiguous, intent(in) :: indptr(:), indices(:)
    real(c_double), contiguous, intent(in) :: values(:)
    integer(c_int64_t) :: unknown

    real(c_double) :: b(size(indptr) - 1), info(0:info_last), x(size(indptr) - 1)
    integer(c_int64_t) :: code
    integer :: i

    b = [(1.0_c_double + modulo(i * 0.618_c_double, 1.0_c_double), i=1, size(b))]
    code = umfpack_dl_solve(umfpack_at, indptr, indices, values, x, b, entry%numeric, settings(entry%ordering, 0), info)
    if (code == umfpack_ok .and. all(abs(x) <= huge(x))) then
      unknown = maxloc(abs(x), dim=1) - 1
    else
      unknown = unknown_of_smallest_pivot(entry%numeric, size(x))
    end if
  end function undetermined_unknown

  !> Unknown (0-based) with the smallest pivot: the rows UMFPACK pivots are the columns of A.
  recursive function unknown_of_smallest_pivot(numeric, n) result(unknown)
    type(c_ptr), intent(in) :: numeric
    integer, intent(in) :: n
    integer(c_int64_t) :: unknown

    integer(c_int64_t) :: rows(n), do_recip, code
    real(c_double) :: pivots(n)

    unknown = -1
    code = umfpack_dl_get_numeric(c_null_ptr, c_null_ptr, c_null_ptr, c_null_ptr, c_null_ptr, c_null_ptr, rows, &
      c_null_ptr, pivots, do_recip, c_null_ptr, numeric)
    if (code == umfpack_ok) unknown = rows(minloc(abs(pivots), dim=1))
  end function unknown_of_smallest_pivot

  !> Our status for a return code of UMFPACK.
  pure recursive function status_of(code) result(status)
    integer(c_int64_t), intent(in) :: code
    integer :: status

    select case (code)
    case (umfpack_ok)
      status = status_ok
    case (umfpack_singular)
      status = status_singular
    case (umfpack_out_of_memory)
      status = status_out_of_memory
    case default
      status = status_library
    end select
  end function status_of

end module isomortar_sparse_factorisation
