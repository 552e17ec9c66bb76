!> What stays the same through a computation, handed over once and known by a handle from then on: patches, bodies, laws, slave
!> sides, gap maps, patterns. Nothing in a descriptor ever changes, so that the kernel stays free of state.
!>
!> A handle is a slot of a table and the generation that the slot was in when it was given out: one that was released is told from
!> those after it.
!>
!> - `handle`: of what is kept. `status`: how it ended (isomortar_base_status).
!> - `descriptor`, `patch`, `body`, `material`, `friction`, `slave`, `map`, `pattern`: what is kept; null where a handle does not
!>   stand for it.
module isomortar_api_descriptors
  use, intrinsic :: iso_c_binding, only: c_int64_t
  use isomortar_base_status, only: status_ok, status_out_of_memory, status_stale_handle
  use isomortar_contact_friction_law, only: friction_t
  use isomortar_contact_gap_map_map, only: gap_map_t
  use isomortar_contact_slave, only: slave_t
  use isomortar_nurbs_patch, only: patch_t
  use isomortar_solid_body, only: body_t
  use isomortar_solid_material_law, only: material_t
  use isomortar_sparse_blocks, only: pattern_t
  implicit none
  private

  public :: find, keep, release

  !> What a handle stands for; of one that is stale, or stands for something else, null, and the status says so (else it is left).
  interface find
    module procedure :: find_patch, find_body, find_material, find_friction, find_slave, find_gap_map, find_pattern
  end interface find

  !> Most descriptors at a time.
  integer(c_int64_t), parameter :: slots = 65536

  !> One of these; nothing stands for a law of friction that is none.
  type, public :: descriptor_t
    type(patch_t), allocatable :: patch
    type(body_t), allocatable :: body
    class(material_t), allocatable :: material
    class(friction_t), allocatable :: friction
    type(slave_t), allocatable :: slave
    class(gap_map_t), allocatable :: map
    type(pattern_t), allocatable :: pattern
  end type descriptor_t

  type :: entry_t
    integer(c_int64_t) :: generation = 0
    type(descriptor_t), pointer :: descriptor => null()
  end type entry_t

  type(entry_t) :: table(0:slots - 1)

contains

  !> Keep a descriptor, which is left empty. Without memory or a free slot the status says so, and the handle is -1.
  subroutine keep(descriptor, handle, status)
    type(descriptor_t), intent(inout) :: descriptor
    integer(c_int64_t), intent(out) :: handle
    integer, intent(out) :: status
    type(descriptor_t), pointer :: kept
    integer(c_int64_t) :: slot
    integer :: failed

    handle = -1
    status = status_out_of_memory
    do slot = 0, slots - 1
      if (.not. associated(table(slot)%descriptor)) exit
    end do
    if (slot == slots) return
    allocate (kept, stat=failed)
    if (failed /= 0) return
    call move_alloc(descriptor%patch, kept%patch)
    call move_alloc(descriptor%body, kept%body)
    call move_alloc(descriptor%material, kept%material)
    call move_alloc(descriptor%friction, kept%friction)
    call move_alloc(descriptor%slave, kept%slave)
    call move_alloc(descriptor%map, kept%map)
    call move_alloc(descriptor%pattern, kept%pattern)
    table(slot)%descriptor => kept
    handle = table(slot)%generation * slots + slot
    status = status_ok
  end subroutine keep

  !> Free a descriptor. Its handle is stale from then on.
  subroutine release(handle, status)
    integer(c_int64_t), intent(in) :: handle
    integer, intent(out) :: status

    status = status_stale_handle
    if (.not. associated(descriptor_of(handle))) return
    associate (entry => table(modulo(handle, slots)))
      deallocate (entry%descriptor)
      entry%generation = entry%generation + 1
    end associate
    status = status_ok
  end subroutine release

  !> The descriptor of a handle; null of one that was released or never given out.
  function descriptor_of(handle) result(descriptor)
    integer(c_int64_t), intent(in) :: handle
    type(descriptor_t), pointer :: descriptor

    descriptor => null()
    associate (entry => table(modulo(handle, slots)))
      if (handle / slots == entry%generation .and. handle >= 0) descriptor => entry%descriptor
    end associate
  end function descriptor_of

  subroutine find_patch(handle, patch, status)
    integer(c_int64_t), intent(in) :: handle
    type(patch_t), pointer, intent(out) :: patch
    integer, intent(inout) :: status
    type(descriptor_t), pointer :: descriptor

    patch => null()
    descriptor => descriptor_of(handle)
    if (associated(descriptor)) then
      if (allocated(descriptor%patch)) patch => descriptor%patch
    end if
    if (.not. associated(patch)) status = status_stale_handle
  end subroutine find_patch

  subroutine find_body(handle, body, status)
    integer(c_int64_t), intent(in) :: handle
    type(body_t), pointer, intent(out) :: body
    integer, intent(inout) :: status
    type(descriptor_t), pointer :: descriptor

    body => null()
    descriptor => descriptor_of(handle)
    if (associated(descriptor)) then
      if (allocated(descriptor%body)) body => descriptor%body
    end if
    if (.not. associated(body)) status = status_stale_handle
  end subroutine find_body

  subroutine find_material(handle, material, status)
    integer(c_int64_t), intent(in) :: handle
    class(material_t), pointer, intent(out) :: material
    integer, intent(inout) :: status
    type(descriptor_t), pointer :: descriptor

    material => null()
    descriptor => descriptor_of(handle)
    if (associated(descriptor)) then
      if (allocated(descriptor%material)) material => descriptor%material
    end if
    if (.not. associated(material)) status = status_stale_handle
  end subroutine find_material

  !> Null, too, where there is no friction.
  subroutine find_friction(handle, friction, status)
    integer(c_int64_t), intent(in) :: handle
    class(friction_t), pointer, intent(out) :: friction
    integer, intent(inout) :: status
    type(descriptor_t), pointer :: descriptor

    friction => null()
    descriptor => descriptor_of(handle)
    if (associated(descriptor)) then
      if (allocated(descriptor%friction)) friction => descriptor%friction
      if (associated(friction) .or. is_empty(descriptor)) return
    end if
    status = status_stale_handle
  end subroutine find_friction

  pure logical function is_empty(descriptor)
    type(descriptor_t), intent(in) :: descriptor

    associate (d => descriptor)
      is_empty = .not. (allocated(d%patch) .or. allocated(d%body) .or. allocated(d%material) .or. allocated(d%friction) &
        .or. allocated(d%slave) .or. allocated(d%map) .or. allocated(d%pattern))
    end associate
  end function is_empty

  subroutine find_slave(handle, slave, status)
    integer(c_int64_t), intent(in) :: handle
    type(slave_t), pointer, intent(out) :: slave
    integer, intent(inout) :: status
    type(descriptor_t), pointer :: descriptor

    slave => null()
    descriptor => descriptor_of(handle)
    if (associated(descriptor)) then
      if (allocated(descriptor%slave)) slave => descriptor%slave
    end if
    if (.not. associated(slave)) status = status_stale_handle
  end subroutine find_slave

  subroutine find_gap_map(handle, map, status)
    integer(c_int64_t), intent(in) :: handle
    class(gap_map_t), pointer, intent(out) :: map
    integer, intent(inout) :: status
    type(descriptor_t), pointer :: descriptor

    map => null()
    descriptor => descriptor_of(handle)
    if (associated(descriptor)) then
      if (allocated(descriptor%map)) map => descriptor%map
    end if
    if (.not. associated(map)) status = status_stale_handle
  end subroutine find_gap_map

  subroutine find_pattern(handle, pattern, status)
    integer(c_int64_t), intent(in) :: handle
    type(pattern_t), pointer, intent(out) :: pattern
    integer, intent(inout) :: status
    type(descriptor_t), pointer :: descriptor

    pattern => null()
    descriptor => descriptor_of(handle)
    if (associated(descriptor)) then
      if (allocated(descriptor%pattern)) pattern => descriptor%pattern
    end if
    if (.not. associated(pattern)) status = status_stale_handle
  end subroutine find_pattern

end module isomortar_api_descriptors
