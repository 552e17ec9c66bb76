!> Residual and tangent of one body.
!>
!> Bundles of elements are computed in batches by all threads. Sums into the system are then formed by row: a thread has rows of its
!> own and goes through the elements in their order, so that the bits of the result do not depend on the number of threads.
module isomortar_solid_assembly
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: lanes, wp
  use isomortar_base_predicate, only: is_compressed, is_index
  use isomortar_base_status, only: status_ok, status_pattern
  use isomortar_nurbs_patch, only: element_count
  use isomortar_nurbs_tensor_product, only: line_pairs, line_pairs_t
  use isomortar_solid_body, only: body_t, bundle_count, bundle_t, geometry_t, take_bundle, take_geometry
  use isomortar_solid_element, only: element_residuals, element_tangents, room_t, sample_elements
  use isomortar_solid_material_law, only: component_pairs, material_t
  use isomortar_sparse_blocks, only: lacks, mark_row, pattern_t
!$ use omp_lib, only: omp_get_max_threads
  implicit none
  private

  public :: add_body

  !> Numbers that the forces or the tangents of a batch may hold, so that they are still in the cache when they are added: 1 MiB.
  integer, parameter :: batch_room = 2**17
  !> Bundles of the smallest batch; it has one for every thread at least.
  integer, parameter :: smallest_batch = 2
  !> Tables for tangents, by direction and element.
  type :: tables_t
    type(line_pairs_t), allocatable :: u(:), v(:), w(:)
  end type tables_t

  !> The elements of some bundles: the last index of every array.
  type :: batch_t
    integer, allocatable :: nodes(:, :)
    real(wp), allocatable :: weight(:, :), forces(:, :, :), tangents(:, :)
    !> Smallest J over the points of each, and whether it is folded (isomortar_base_status).
    real(wp), allocatable :: smallest_jacobian(:)
    integer, allocatable :: status(:)
  end type batch_t

  !> What a thread computes with.
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
  !> - `smallest_jacobian`: least J met; of an element folded initially the determinant of its map.
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
    type(work_t) :: work
    type(geometry_t) :: geometry
    integer :: bundles, first, k, many

    if (contracts) call require(all(shape(positions) == shape(residual)), "add_body: forces are those of the positions")
    if (contracts) call require(all(is_index(body%patch%point, size(positions, 2))), "add_body: the body is among the positions")
    if (contracts) call require(present(pattern) .eqv. present(tangent), "add_body: a tangent has a pattern")
    if (present(tangent)) then
      if (contracts) call require(is_compressed(pattern%start, size(tangent, 3)), "add_body: blocks are those of a pattern")
      call line_pairs(body%u, tables%u)
      call line_pairs(body%v, tables%v)
      call line_pairs(body%w, tables%w)
    end if
    bundles = bundle_count(body)
    call reserve(product(body%patch%direction%order + 1), bundles, present(tangent), batch)
    smallest_jacobian = huge(1.0_wp)
    do first = 0, bundles - 1, size(batch%status) / lanes
      many = min(size(batch%status) / lanes, bundles - first)
      !$omp parallel do default(none) private(geometry, work) schedule(dynamic) &
      !$omp shared(batch, body, first, many, material, positions, tables)
      do k = 1, many
        call take_bundle(body, first + k, work%bundle)
        if (allocated(body%geometry)) then
          call take_elements(body, body%geometry(first + k), material, positions, tables, work, lanes * (k - 1), batch)
        else
          call take_geometry(body, work%bundle, geometry)
          call take_elements(body, geometry, material, positions, tables, work, lanes * (k - 1), batch)
        end if
      end do
      !$omp end parallel do
      many = min(lanes * many, element_count(body%patch) - lanes * first)
      do k = 1, many
        smallest_jacobian = min(smallest_jacobian, batch%smallest_jacobian(k))
        status = batch%status(k)
        place = lanes * first + k
        if (status /= status_ok) return
      end do
      call add_forces(batch, many, residual)
      if (.not. present(tangent)) cycle
      call add_blocks(pattern, batch, many, body%patch%direction%order + 1, tangent, place)
      status = merge(status_pattern, status_ok, place > 0)
      if (status /= status_ok) return
    end do
    place = 0
  end subroutine add_body

  !> Make room for a batch of elements of n functions.
  subroutine reserve(n, bundles, with_tangent, batch)
    integer, intent(in) :: n, bundles
    logical, intent(in) :: with_tangent
    type(batch_t), intent(out) :: batch
    integer :: elements, least

    least = smallest_batch
!$  least = max(least, omp_get_max_threads())
    elements = lanes * min(bundles, max(least, batch_room / (lanes * merge(6 * n**2, 3 * n, with_tangent))))
    allocate (batch%nodes(n, elements), batch%weight(n, elements), batch%forces(3, n, elements))
    allocate (batch%smallest_jacobian(elements), batch%status(elements))
    if (with_tangent) allocate (batch%tangents(6 * n**2, elements))
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
      batch%status(before + 1:last) = merge(status_ok, status, smallest(:bundle%many) > 0.0_wp)
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

  !> Add the tangents of a batch's first `many` elements, shares of the rows at the same time, each row for all of its elements at
  !> once: it stays in the cache. `count`: functions by direction, `lacking`: a row that has no block where one is to be added, 0
  !> without any.
  subroutine add_blocks(pattern, batch, many, count, tangent, lacking)
    type(pattern_t), intent(in) :: pattern
    type(batch_t), intent(in) :: batch
    integer, intent(in) :: many, count(3)
    real(wp), intent(inout) :: tangent(:, :, :)
    integer, intent(out) :: lacking
    integer, allocatable :: columns(:), first(:), next(:, :)
    integer :: a, k, row, share, shares, turn

    shares = 1
!$  shares = omp_get_max_threads()
    lacking = 0
    allocate (first(size(pattern%start) - 1), next(size(batch%nodes, 1), many))
    call list_rows(batch%nodes(:, :many), first, next)
    !$omp parallel do default(none) private(a, columns, k, row, turn) &
    !$omp shared(batch, count, first, many, next, pattern, shares, tangent) reduction(max: lacking)
    do share = 0, shares - 1
      allocate (columns(size(pattern%start) - 1), source=0)
      do turn = 0, size(next) - 1
        row = batch%nodes(1 + modulo(turn, size(next, 1)), 1 + turn / size(next, 1))
        if (modulo(row, shares) /= share .or. first(row) /= turn) cycle
        call mark_row(pattern, row, columns)
        k = turn
        do while (k >= 0)
          a = 1 + modulo(k, size(next, 1))
          associate (element => 1 + k / size(next, 1))
            if (lacks(pattern, row, columns, batch%nodes(:, element))) then
              lacking = max(lacking, row)
            else
              call add_row(batch%nodes(:, element), batch%weight(:, element), a, count, batch%tangents(:, element), columns, &
                tangent)
            end if
            k = next(a, element)
          end associate
        end do
      end do
      deallocate (columns)
    end do
    !$omp end parallel do
  end subroutine add_blocks

  !> Where a row stands among the `nodes` (control points, elements): the `first` place (rows) and the `next` after each, -1 after
  !> the last, all counted from 0 through the elements in their order.
  pure subroutine list_rows(nodes, first, next)
    integer, intent(in) :: nodes(:, :)
    integer, intent(out) :: first(:), next(:, :)
    integer :: a, k

    first = -1
    do k = size(nodes, 2), 1, -1
      do a = size(nodes, 1), 1, -1
        next(a, k) = first(nodes(a, k))
        first(nodes(a, k)) = a - 1 + size(nodes, 1) * (k - 1)
      end do
    end do
  end subroutine list_rows

  !> Add one row of blocks of an element's tangent, as `element_tangents` gives it: that of function a.
  pure subroutine add_row(nodes, weight, a, count, block, columns, tangent)
    integer, intent(in) :: nodes(:), a, count(3), columns(:)
    real(wp), intent(in) :: weight(:)
    real(wp), intent(in) :: block(count(1), count(1), count(2), count(2), count(3), count(3), 6)
    real(wp), intent(inout) :: tangent(:, :, :)
    integer :: at(3), b, b1, b2, b3, i, k, pair
    real(wp) :: both

    at = 1 + modulo((a - 1) / [1, count(1), count(1) * count(2)], count)
    b = 0
    do b3 = 1, count(3)
      do b2 = 1, count(2)
        do b1 = 1, count(1)
          b = b + 1
          both = weight(a) * weight(b)
          associate (target => tangent(:, :, columns(nodes(b))))
            do pair = 1, 6
              i = component_pairs(1, pair)
              k = component_pairs(2, pair)
              target(k, i) = target(k, i) + both * block(at(1), b1, at(2), b2, at(3), b3, pair)
              if (i /= k) target(i, k) = target(i, k) + both * block(b1, at(1), b2, at(2), b3, at(3), pair)
            end do
          end associate
        end do
      end do
    end do
  end subroutine add_row

end module isomortar_solid_assembly
