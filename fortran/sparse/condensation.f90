!> Factorisations of bodies with their faces by handle (isomortar_sparse_handles).
!>
!> - `handle`: a pattern that was analysed, and the factors of the last matrix of that pattern.
!> - `status`, `place`: how it ended (isomortar_base_status); where all slots are taken, their number, else -1.
module isomortar_sparse_condensation
  use, intrinsic :: iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_base_status, only: status_library, status_ok, status_out_of_memory, status_singular, status_stale_handle
  use isomortar_sparse_cholmod, only: cholesky_done, cholesky_indefinite, cholesky_order, cholesky_out_of_memory
  use isomortar_sparse_condensed, only: condense, eliminate_condensed, eliminate_faces, is_condensed, substitute_condensed
  use isomortar_sparse_handles, only: free_slot, handle_of, slot_of, slots, table
  implicit none
  private

  public :: order_bodies, analyse_bodies, factorise_bodies, factorise_faces, solve_bodies

contains

  !> Order the unknowns of the bodies for little fill.
  !>
  !> - `indptr` (unknowns + 1), `indices` (entries): compressed rows, from 0, symmetric. `by_metis`: METIS's nested dissection;
  !>   otherwise AMD.
  !> - `order` (unknowns): the unknowns, from 0, in their order. `flops`: operations of a factorisation by it.
  subroutine order_bodies(indptr, indices, by_metis, order, flops, status)
    integer(c_int64_t), contiguous, intent(in) :: indptr(:), indices(:)
    logical, intent(in) :: by_metis
    integer(c_int64_t), contiguous, intent(out) :: order(:)
    real(c_double), intent(out) :: flops
    integer, intent(out) :: status

    integer(c_int) :: metis

    order = 0
    metis = merge(1, 0, by_metis)
    status = status_of(cholesky_order(size(order, kind=c_int64_t), indptr, indices, metis, order, flops))
  end subroutine order_bodies

  !> Analyse the pattern of the bodies' stiffness, and take a slot for it.
  !>
  !> - `indptr` (unknowns + 1), `indices` (entries): compressed rows, from 0, symmetric, with the diagonal.
  !> - `on_face` (unknowns): 1 for unknowns of faces in contact, 0 for others. `order` (unknowns): that of the others, from 0.
  !> - `flops`, `factor_entries`: operations of a factorisation of the stiffness, entries of its factor.
  subroutine analyse_bodies(indptr, indices, on_face, order, handle, flops, factor_entries, place, status)
    integer(c_int64_t), contiguous, intent(in) :: indptr(:), indices(:), order(:)
    integer(c_int), contiguous, intent(in) :: on_face(:)
    integer(c_int64_t), intent(out) :: handle, place
    real(c_double), intent(out) :: flops, factor_entries
    integer, intent(out) :: status

    integer(c_int64_t) :: slot
    integer(c_int) :: code

    handle = 0
    place = -1
    flops = 0
    factor_entries = 0
    status = status_out_of_memory
    slot = free_slot()
    if (slot == slots) then
      place = slots
      return
    end if

    call condense(table(slot)%condensed, indptr, indices, on_face, order, flops, factor_entries, code)
    status = status_of(code)
    if (status == status_ok) handle = handle_of(slot)
  end subroutine analyse_bodies

  !> Factorise a stiffness of the pattern analysed, with what is added on faces and beyond; takes the place of the factors before.
  !>
  !> - `values` (entries): of the stiffness. `added` (trailing, trailing): unknowns of faces by their numbers, then others.
  !> - `rcond`: estimate of the reciprocal condition; below `rcond_min`, or where the stiffness is not definite, the status is
  !>   singular.
  recursive subroutine factorise_bodies(handle, values, added, rcond_min, rcond, status)
    integer(c_int64_t), intent(in) :: handle
    real(c_double), contiguous, intent(in) :: values(:), added(:, :)
    real(c_double), intent(in) :: rcond_min
    real(c_double), intent(out) :: rcond
    integer, intent(out) :: status

    integer(c_int64_t) :: slot
    integer(c_int) :: code

    rcond = 0
    slot = slot_of(handle)
    status = status_stale_handle
    if (slot == slots) return
    if (.not. is_condensed(table(slot)%condensed)) return

    call eliminate_condensed(table(slot)%condensed, values, added, rcond, code)
    status = judged(code, rcond, rcond_min)
  end subroutine factorise_bodies

  !> The same with what is `added` (trailing, trailing) anew, and the stiffness of the last `factorise_bodies`, whose factors stay.
  !>
  !> - `rcond`: estimate of the reciprocal condition; below `rcond_min` the status is singular.
  recursive subroutine factorise_faces(handle, added, rcond_min, rcond, status)
    integer(c_int64_t), intent(in) :: handle
    real(c_double), contiguous, intent(in) :: added(:, :)
    real(c_double), intent(in) :: rcond_min
    real(c_double), intent(out) :: rcond
    integer, intent(out) :: status

    integer(c_int64_t) :: slot
    integer(c_int) :: code

    rcond = 0
    slot = slot_of(handle)
    status = status_stale_handle
    if (slot == slots) return
    if (.not. allocated(table(slot)%condensed%schur)) return

    call eliminate_faces(table(slot)%condensed, added, rcond, code)
    status = judged(code, rcond, rcond_min)
  end subroutine factorise_faces

  !> Our status for factors: singular too where the reciprocal condition is below the smallest that passes, or not a number.
  pure recursive function judged(code, rcond, rcond_min) result(status)
    integer(c_int), intent(in) :: code
    real(c_double), intent(in) :: rcond, rcond_min
    integer :: status

    status = status_of(code)
    if (status == status_ok .and. .not. rcond >= rcond_min) status = status_singular
  end function judged

  !> Solve with the last factors: `b` (size), `x` (size): unknowns, then others.
  recursive subroutine solve_bodies(handle, b, x, status)
    integer(c_int64_t), intent(in) :: handle
    real(c_double), contiguous, intent(in) :: b(:)
    real(c_double), contiguous, intent(out) :: x(:)
    integer, intent(out) :: status

    integer(c_int64_t) :: slot
    integer(c_int) :: code

    x = 0
    slot = slot_of(handle)
    status = status_stale_handle
    if (slot == slots) return
    if (.not. allocated(table(slot)%condensed%pivot)) return

    call substitute_condensed(table(slot)%condensed, b, x, code)
    status = status_of(code)
  end subroutine solve_bodies

  !> Our status for a code of the Cholesky factors.
  pure recursive function status_of(code) result(status)
    integer(c_int), intent(in) :: code
    integer :: status

    select case (code)
    case (cholesky_done)
      status = status_ok
    case (cholesky_indefinite)
      status = status_singular
    case (cholesky_out_of_memory)
      status = status_out_of_memory
    case default
      status = status_library
    end select
  end function status_of

end module isomortar_sparse_condensation
