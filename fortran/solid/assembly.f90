!> Residual and tangent of one body.
!>
!> Bundles of elements are computed in batches by all threads. Forces are then added in the order of the elements, and so are rows
!> of the tangent.
module isomortar_solid_assembly
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: lanes, wp
  use isomortar_base_predicate, only: is_compressed, is_index
  use isomortar_base_status, only: status_folded, status_folded_initially, status_ok, status_out_of_memory, status_pattern
  use isomortar_nurbs_patch, only: element_count
  use isomortar_nurbs_pairs, only: line_pairs, line_pairs_t
  use isomortar_solid_body, only: body_t, bundle_count, bundle_t, geometry_t, take_bundle, take_geometry
  use isomortar_solid_element, only: element_residuals, element_tangents, room_t, sample_elements
  use isomortar_solid_material_law, only: material_t
  use isomortar_solid_rows, only: add_rows, rows_of, rows_t
  use isomortar_sparse_blocks, only: pattern_t
!$ use omp_lib, only: omp_get_max_threads, omp_get_thread_num
  implicit none
  private

  public :: add_body

  !> Numbers that the forces or the tangents of a batch should hold, so that they are still in the cache when they are added: 1 MiB.
  integer, parameter :: batch_room = 2**17
  !> Bundles of the smallest batch. Every thread has as many of a batch.
  integer, parameter :: smallest_batch = 2
  !> Tables for tangents, by direction and element.
  type :: tables_t
    type(line_pairs_t), allocatable :: u(:), v(:), w(:)
  end type tables_t

  !> The elements of some bundles: the last index of every array.
  type :: batch_t
    integer, allocatable :: nodes(:, :)
    real(wp), allocatable :: weight(:, :), forces(:, :, :), tangents(:, :)
    !> Smallest J over the points of each, and whether it is folded or memory ran out (isomortar_base_status).
    real(wp), allocatable :: smallest_jacobian(:)
    integer, allocatable :: status(:)
  end type batch_t

  !> What a thread computes with, beside the geometry of its bundle: that may be the body's.
  type :: work_t
    type(bundle_t) :: bundle
    type(room_t) :: room
  end type work_t

contains

  !> Add internal forces and, where a pattern is given, the tangent of a body.
  !>
  !> - `body`, `material`: the body and its law.
  !> - `positions` (3, control points): of all control points, L.
  !> - `residual` (3, control points): forces on all of them, F.
  !> - `pattern`, `tangent` (column component, row component, blocks): pattern of the tangent, and its blocks, F/L.
  !> - `smallest_jacobian`: least J of all elements; where some are folded that of the first of them, whatever the
  !>   number of threads. Of one that is folded initially it is the determinant of its map.
  !> - `status`, `place`: how it ended (isomortar_base_status), and on failure the element, from 1.
  subroutine add_body(body, material, positions, residual, smallest_jacobian, status, place, pattern, tangent)
    type(body_t), intent(in) :: body
    class(material_t), intent(in) :: material
    real(wp), intent(in) :: positions(:, :)
    real(wp), intent(inout) :: residual(:, :)
    real(wp), intent(out) :: smallest_jacobian
    integer, intent(out) :: status, place
    type(pattern_t), intent(in), optional :: pattern
    real(wp), intent(inout), optional :: tangent(:, :, :)
    type(tables_t) :: tables
    type(batch_t) :: batch
    type(rows_t) :: rows
    type(work_t), allocatable :: work(:)
    type(geometry_t), allocatable :: geometry(:)
    integer :: bundles, elements, first, k, many, thread, threads

    if (contracts) call require(all(shape(positions) == shape(residual)), "add_body: forces are those of the positions")
    if (contracts) call require(all(is_index(body%patch%point, size(positions, 2))), "add_body: the body is among the positions")
    if (contracts) call require(present(pattern) .eqv. present(tangent), "add_body: a tangent has a pattern")
    threads = 1
!$  threads = omp_get_max_threads()
    bundles = bundle_count(body)
    place = 1
    smallest_jacobian = 0.0_wp
    call reserve(product(body%patch%direction%order + 1), bundles, threads, present(tangent), batch, status)
    if (status /= status_ok) return
    if (present(tangent)) then
      if (contracts) call require(is_compressed(pattern%start, size(tangent, 3)), "add_body: blocks are those of a pattern")
      call line_pairs(body%u, tables%u)
      call line_pairs(body%v, tables%v)
      call line_pairs(body%w, tables%w)
      call rows_of(size(positions, 2), size(batch%nodes, 1), size(batch%status), rows, status)
      if (status /= status_ok) return
    end if
    allocate (work(threads), geometry(threads))
    smallest_jacobian = huge(1.0_wp)
    do first = 0, bundles - 1, size(batch%status) / lanes
      many = min(size(batch%status) / lanes, bundles - first)
      !$omp parallel do default(none) private(thread) schedule(dynamic) &
      !$omp shared(batch, body, first, geometry, many, material, positions, tables, work)
      do k = 1, many
        thread = 1
!$      thread = 1 + omp_get_thread_num()
        call take_bundle(body, first + k, work(thread)%bundle)
        if (allocated(body%geometry)) then
          call take_elements(body, body%geometry(first + k), material, positions, tables, work(thread), lanes * (k - 1), batch)
        else
          call take_geometry(body, work(thread)%bundle, geometry(thread))
          call take_elements(body, geometry(thread), material, positions, tables, work(thread), lanes * (k - 1), batch)
        end if
      end do
      !$omp end parallel do
      elements = min(lanes * many, element_count(body%patch) - lanes * first)
      do k = 1, elements
        smallest_jacobian = min(smallest_jacobian, batch%smallest_jacobian(k))
        status = batch%status(k)
        place = lanes * first + k
        if (status /= status_ok) return
      end do
      call add_forces(batch, elements, residual)
      if (.not. present(tangent)) cycle
      call add_rows(pattern, batch%nodes(:, :elements), batch%weight(:, :elements), batch%tangents(:, :elements), &
        body%patch%direction%order + 1, rows, tangent, place)
      status = merge(status_pattern, status_ok, place > 0)
      if (status /= status_ok) return
    end do
    place = 0
  end subroutine add_body

  !> Make room for a batch of elements of n functions, as many bundles for each of the threads. `status`: whether there is.
  pure subroutine reserve(n, bundles, threads, with_tangent, batch, status)
    integer, intent(in) :: n, bundles, threads
    logical, intent(in) :: with_tangent
    type(batch_t), intent(out) :: batch
    integer, intent(out) :: status
    integer :: elements, failed, turns

    turns = max(1, batch_room / (lanes * threads * merge(6 * n**2, 3 * n, with_tangent)))
    elements = lanes * min(bundles, max(smallest_batch, threads * turns))
    allocate (batch%smallest_jacobian(elements), stat=failed)
    if (failed == 0) allocate (batch%status(elements), stat=failed)
    if (failed == 0) allocate (batch%nodes(n, elements), stat=failed)
    if (failed == 0) allocate (batch%weight(n, elements), stat=failed)
    if (failed == 0) allocate (batch%forces(3, n, elements), stat=failed)
    if (failed == 0 .and. with_tangent) allocate (batch%tangents(6 * n**2, elements), stat=failed)
    status = merge(status_ok, status_out_of_memory, failed == 0)
  end subroutine reserve

  !> Sample the elements of a bundle, compute their forces and, where there are `tables`, their tangents: those of the batch from
  !> number `before` + 1 on.
  pure subroutine take_elements(body, geometry, material, positions, tables, work, before, batch)
    type(body_t), intent(in) :: body
    type(geometry_t), intent(in) :: geometry
    class(material_t), intent(in) :: material
    real(wp), intent(in) :: positions(:, :)
    type(tables_t), intent(in) :: tables
    type(work_t), intent(inout) :: work
    integer, intent(in) :: before
    type(batch_t), intent(inout) :: batch
    real(wp) :: smallest(lanes)
    integer :: a, l, last, status

    last = before + work%bundle%many
    associate (bundle => work%bundle, room => work%room)
      do l = 1, bundle%many
        do a = 1, size(batch%nodes, 1)
          batch%nodes(a, before + l) = body%patch%point(bundle%local(a, l))
          batch%weight(a, before + l) = bundle%weight(l, a)
        end do
      end do
      smallest = geometry%smallest
      status = merge(geometry%status, bundle%status, bundle%status == status_ok)
      if (status == status_ok) then
        call sample_elements(body, bundle, geometry, positions, material, allocated(tables%u), room, smallest, status)
      end if
      batch%smallest_jacobian(before + 1:last) = smallest(:bundle%many)
      batch%status(before + 1:last) = status
      if (status == status_folded .or. status == status_folded_initially) then ! perhaps not all of them
        batch%status(before + 1:last) = merge(status_ok, status, smallest(:bundle%many) > 0.0_wp)
      end if
      if (status /= status_ok) return
      call element_residuals(bundle, room, batch%forces(:, :, before + 1:last))
      if (.not. allocated(tables%u)) return
      call element_tangents(tables%u, tables%v, tables%w, bundle, room, batch%tangents(:, before + 1:last))
    end associate
  end subroutine take_elements

  !> Add the forces of the first `many` elements of a batch; a control point may stand twice in an element of a closed ring.
  pure subroutine add_forces(batch, many, residual)
    type(batch_t), intent(in) :: batch
    integer, intent(in) :: many
    real(wp), intent(inout) :: residual(:, :)
    integer :: a, k

    do k = 1, many
      do a = 1, size(batch%nodes, 1)
        residual(:, batch%nodes(a, k)) = residual(:, batch%nodes(a, k)) + batch%forces(:, a, k)
      end do
    end do
  end subroutine add_forces

end module isomortar_solid_assembly
