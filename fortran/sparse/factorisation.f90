!> Sparse LU factorisations by handle (isomortar_sparse_handles).
!>
!> - `handle`: a pattern that was analysed, and the factors of the last matrix of that pattern.
!> - `values` (entries): entries of the matrix, in the order of the pattern.
!> - `status`, `place`: how it ended (isomortar_base_status); on failure UMFPACK's return code, else -1.
module isomortar_sparse_factorisation
  use, intrinsic :: iso_c_binding, only: c_associated, c_double, c_int64_t
  use isomortar_base_status, only: status_ok, status_singular, status_stale_handle, status_out_of_memory, &
    status_library
  use isomortar_sparse_handles, only: free_slot, handle_of, slot_of, slots, table
  use isomortar_sparse_lu, only: eliminate, forget_factors, lu_t, order, smallest_pivot, substitute
  use isomortar_sparse_umfpack, only: umfpack_ok, umfpack_singular, umfpack_out_of_memory, ordering_amd, ordering_metis, &
    info_last, info_size_of_unit, info_peak_memory, info_flops, info_lnz, info_unz, info_rcond
  implicit none
  private

  public :: analyse, factorise, solve

contains

  !> Order and analyse a pattern, and take a slot for it; where all are taken, `place` is their number.
  !>
  !> - `indptr` (unknowns + 1), `indices` (entries): compressed rows, from 0, columns increasing within a row.
  !> - `by_metis`: METIS's nested dissection; otherwise AMD.
  !> - `narrow`: whether indices of 32 bits are in use: for a factorisation that is estimated at no more than `narrow_limit` bytes.
  subroutine analyse(indptr, indices, by_metis, narrow_limit, handle, narrow, place, status)
    integer(c_int64_t), contiguous, intent(in) :: indptr(:), indices(:)
    logical, intent(in) :: by_metis
    real(c_double), intent(in) :: narrow_limit
    integer(c_int64_t), intent(out) :: handle
    logical, intent(out) :: narrow
    integer(c_int64_t), intent(out) :: place
    integer, intent(out) :: status

    integer(c_int64_t) :: slot, code

    handle = 0
    narrow = .false.
    place = -1
    status = status_out_of_memory
    slot = free_slot()
    if (slot == slots) then
      place = slots
      return
    end if

    call order(table(slot)%lu, indptr, indices, merge(ordering_metis, ordering_amd, by_metis), narrow_limit, code)
    narrow = allocated(table(slot)%lu%start)
    status = status_of(code)
    if (status == status_ok) handle = handle_of(slot)
    if (status == status_library) place = code
  end subroutine analyse

  !> Factorise a matrix of the pattern analysed; takes the place of the factors before.
  !>
  !> With a reciprocal condition below `rcond_min` (or none) the status is singular, no factors are kept, and `place` is the unknown
  !> (from 0) that is determined least.
  !>
  !> - `rcond`: estimate of the reciprocal condition: smallest over largest pivot.
  !> - `flops`, `peak_bytes`, `factor_entries`: operations, peak memory (analysis included), entries of L and U.
  recursive subroutine factorise(handle, values, rcond_min, rcond, flops, peak_bytes, factor_entries, place, status)
    integer(c_int64_t), intent(in) :: handle
    real(c_double), contiguous, intent(in) :: values(:)
    real(c_double), intent(in) :: rcond_min
    real(c_double), intent(out) :: rcond
    real(c_double), intent(out) :: flops, peak_bytes, factor_entries
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

    associate (lu => table(slot)%lu)
      call eliminate(lu, values, info, code)
      status = status_of(code)
      if (status == status_library) place = code
      if (.not. c_associated(lu%numeric)) return

      rcond = info(info_rcond)
      flops = info(info_flops)
      peak_bytes = info(info_peak_memory) * info(info_size_of_unit)
      factor_entries = info(info_lnz) + info(info_unz)
      ! Written so that a condition that is not a number counts as singular too.
      if (rcond >= rcond_min .and. status == status_ok) return
      status = status_singular
      place = undetermined_unknown(lu, values)
      call forget_factors(lu)
    end associate
  end subroutine factorise

  !> Solve A x = b for several right-hand sides with the factors of the last `factorise`.
  !>
  !> - `b` (unknowns, right-hand sides), `x` (unknowns, right-hand sides): these, and their solutions.
  !> - `refine`: most steps of iterative refinement.
  recursive subroutine solve(handle, values, b, refine, x, place, status)
    integer(c_int64_t), intent(in) :: handle
    real(c_double), contiguous, intent(in) :: values(:)
    real(c_double), contiguous, intent(in) :: b(:, :)
    integer, intent(in) :: refine
    real(c_double), contiguous, intent(out) :: x(:, :)
    integer(c_int64_t), intent(out) :: place
    integer, intent(out) :: status

    integer(c_int64_t) :: slot, code
    integer :: column

    x = 0
    place = -1
    slot = slot_of(handle)
    status = status_stale_handle
    if (slot == slots) return
    if (.not. c_associated(table(slot)%lu%numeric)) return

    status = status_ok
    do column = 1, size(b, 2)
      call substitute(table(slot)%lu, values, b(:, column), refine, x(:, column), code)
      status = status_of(code)
      if (status == status_library) place = code
      if (status /= status_ok) return
    end do
  end subroutine solve

  !> Unknown (0-based) that a singular matrix determines least: the largest entry of its null vector, which is what a solve
  !> gives, for any right-hand side; where a pivot is zero, that of the pivot.
  recursive function undetermined_unknown(lu, values) result(unknown)
    type(lu_t), intent(in) :: lu
    real(c_double), contiguous, intent(in) :: values(:)
    integer(c_int64_t) :: unknown

    real(c_double), allocatable :: b(:), x(:)
    integer(c_int64_t) :: code
    integer :: i

    allocate (b(lu%unknowns), x(lu%unknowns))
    do i = 1, size(b)
      b(i) = 1.0_c_double + modulo(i * 0.618_c_double, 1.0_c_double)
    end do
    call substitute(lu, values, b, 0, x, code)
    if (code == umfpack_ok .and. all(abs(x) <= huge(x))) then
      unknown = maxloc(abs(x), dim=1) - 1
    else
      unknown = smallest_pivot(lu)
    end if
  end function undetermined_unknown

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
