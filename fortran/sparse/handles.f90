!> Table of factorisations, the one saved state of the kernel. A handle is a slot of the table and the slot's generation.
!>
!> Threads: what takes a slot or frees it runs one at a time (the caller holds Python's lock; METIS also draws from the random
!> numbers of the whole process). What factorises and solves touches its own slot only and may run at the same time for different
!> handles: the table therefore never moves in memory, and what they call is `recursive` (locals of their own; without it
!> Fortran 2008 lets them be shared).
!>
!> - `handle`: a pattern that was analysed, and the factors of the last matrix of that pattern.
module isomortar_sparse_handles
  use, intrinsic :: iso_c_binding, only: c_associated, c_int64_t
  use isomortar_base_status, only: status_ok, status_stale_handle
  use isomortar_sparse_condensed, only: condensed_t, forget_condensed, is_condensed
  use isomortar_sparse_lu, only: forget, lu_t
  implicit none
  private

  public :: free_slot, handle_of, release, slot_of

  !> Most factorisations alive at once.
  integer(c_int64_t), parameter, public :: slots = 1024

  !> One slot: the factors of a general matrix, or of a body with its faces.
  type :: slot_t
    integer(c_int64_t) :: generation = 1
    type(lu_t) :: lu
    type(condensed_t) :: condensed
  end type slot_t

  type(slot_t), public :: table(0:slots - 1)

contains

  !> First slot that is free; `slots` when none is.
  function free_slot() result(slot)
    integer(c_int64_t) :: slot

    do slot = 0, slots - 1
      if (.not. is_taken(slot)) return
    end do
  end function free_slot

  !> Handle of a `slot` that was taken.
  function handle_of(slot) result(handle)
    integer(c_int64_t), intent(in) :: slot
    integer(c_int64_t) :: handle

    handle = table(slot)%generation * slots + slot
  end function handle_of

  !> Slot of a handle; `slots` when the handle was never given out or was released.
  recursive function slot_of(handle) result(slot)
    integer(c_int64_t), intent(in) :: handle
    integer(c_int64_t) :: slot

    slot = modulo(handle, slots)
    if (handle / slots /= table(slot)%generation .or. .not. is_taken(slot)) slot = slots
  end function slot_of

  !> Free what a handle owns. The handle is stale from then on, its slot free for others. `status`: whether it was not before.
  subroutine release(handle, status)
    integer(c_int64_t), intent(in) :: handle
    integer, intent(out) :: status

    integer(c_int64_t) :: slot

    slot = slot_of(handle)
    status = status_stale_handle
    if (slot == slots) return
    call forget(table(slot)%lu)
    call forget_condensed(table(slot)%condensed)
    table(slot)%generation = table(slot)%generation + 1
    status = status_ok
  end subroutine release

  !> Whether a slot has a pattern.
  recursive function is_taken(slot)
    integer(c_int64_t), intent(in) :: slot
    logical :: is_taken

    is_taken = c_associated(table(slot)%lu%symbolic) .or. is_condensed(table(slot)%condensed)
  end function is_taken

end module isomortar_sparse_handles
