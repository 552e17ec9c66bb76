!> Residual and tangent of one body.
!>
!> Elements are computed in batches by all threads. Sums into the system are then formed by row: a thread has rows of its own and
!> goes through the elements in their order, so that the bits of the result do not depend on the number of threads.
module isomortar_solid_assembly
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_compressed, is_index
  use isomortar_base_status, only: status_ok, status_pattern
  use isomortar_nurbs_patch, only: element_count, element_nodes, element_of
  use isomortar_nurbs_tensor_product, only: line_pairs, line_pairs_t
  use isomortar_solid_body, only: body_t, geometry_room_t, geometry_t, take_geometry
  use isomortar_solid_element, only: element_residual, element_tangent, room_t, sample_element, samples_t
  use isomortar_solid_material_law, only: component_pairs, material_t
  use isomortar_sparse_blocks, only: lacks, mark_row, pattern_t
!$ use omp_lib, only: omp_get_max_threads
  implicit none
  private

  public :: add_body

  !> Numbers that the tangents of a batch may hold, so that they are still in the cache when they are added: 1 MiB.
  integer, parameter :: batch_room = 2**17
  !> Elements of the smallest batch; it has one for every thread at least.
  integer, parameter :: smallest_batch = 8
  !> Tables for tangents, by direction and element.
  type :: tables_t
    type(line_pairs_t), allocatable :: u(:), v(:), w(:)
  end type tables_t

  !> One element of a batch.
  type :: element_t
    integer, allocatable :: local(:), nodes(:)
    real(wp), allocatable :: weight(:), forces(:, :), block(:)
    !> Smallest J over its points, and whether it is folded (isomortar_base_status).
    real(wp) :: smallest_jacobian
    integer :: status
  end type element_t

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
    type(element_t), allocatable :: batch(:)
    type(geometry_room_t) :: geometry_room
    type(geometry_t) :: geometry
    type(room_t) :: room
    type(samples_t) :: samples
    integer :: elements, first, k, many

    if (contracts) call require(all(shape(positions) == shape(residual)), "add_body: forces are those of the positions")
    if (contracts) call require(all(is_index(body%patch%point, size(positions, 2))), "add_body: the body is among the positions")
    if (contracts) call require(present(pattern) .eqv. present(tangent), "add_body: a tangent has a pattern")
    if (present(tangent)) then
      if (contracts) call require(is_compressed(pattern%start, size(tangent, 3)), "add_body: blocks are those of a pattern")
      call line_pairs(body%u, tables%u)
      call line_pairs(body%v, tables%v)
      call line_pairs(body%w, tables%w)
    end if
    elements = element_count(body%patch)
    call reserve(product(body%patch%direction%order + 1), elements, present(tangent), batch)
    smallest_jacobian = huge(1.0_wp)
    do first = 0, elements - 1, size(batch)
      many = min(size(batch), elements - first)
      !$omp parallel do default(none) private(geometry, geometry_room, room, samples) schedule(dynamic) &
      !$omp shared(batch, body, first, many, material, positions, tables)
      do k = 1, many
        if (allocated(body%element)) then
          call take_element(body, first + k, body%element(first + k), material, positions, tables, room, samples, batch(k))
        else
          call take_geometry(body, first + k, geometry_room, geometry)
          call take_element(body, first + k, geometry, material, positions, tables, room, samples, batch(k))
        end if
      end do
      !$omp end parallel do
      do k = 1, many
        smallest_jacobian = min(smallest_jacobian, batch(k)%smallest_jacobian)
        status = batch(k)%status
        place = first + k
        if (status /= status_ok) return
        call add_forces(batch(k), residual)
      end do
      if (.not. present(tangent)) cycle
      call add_blocks(pattern, batch(:many), body%patch%direction%order + 1, tangent, place)
      status = merge(status_pattern, status_ok, place > 0)
      if (status /= status_ok) return
    end do
    place = 0
  end subroutine add_body

  !> Make room for a batch of elements of n functions.
  subroutine reserve(n, elements, with_tangent, batch)
    integer, intent(in) :: n, elements
    logical, intent(in) :: with_tangent
    type(element_t), allocatable, intent(out) :: batch(:)
    integer :: k, least

    least = smallest_batch
!$  least = max(least, omp_get_max_threads())
    allocate (batch(min(elements, max(least, batch_room / (6 * n**2)))))
    do k = 1, size(batch)
      allocate (batch(k)%local(n), batch(k)%nodes(n), batch(k)%weight(n), batch(k)%forces(3, n))
      if (with_tangent) allocate (batch(k)%block(6 * n**2))
    end do
  end subroutine reserve

  !> Sample element `e`, from 1, compute its forces and, where there are `tables`, its tangent.
  pure subroutine take_element(body, e, geometry, material, positions, tables, room, samples, element)
    type(body_t), intent(in) :: body
    integer, intent(in) :: e
    type(geometry_t), intent(in) :: geometry
    class(material_t), intent(in) :: material
    real(wp), intent(in) :: positions(:, :)
    type(tables_t), intent(in) :: tables
    type(room_t), intent(inout) :: room
    type(samples_t), intent(inout) :: samples
    type(element_t), intent(inout) :: element
    integer :: at(3)

    element%status = geometry%status
    element%smallest_jacobian = geometry%smallest
    if (element%status /= status_ok) return
    at = element_of(body%patch, e)
    call element_nodes(body%patch, at, element%local)
    element%nodes(:) = body%patch%point(element%local)
    element%weight(:) = body%patch%weight(element%local)
    associate (u => body%u(at(1)), v => body%v(at(2)), w => body%w(at(3)))
      call sample_element(u, v, w, geometry, element%weight, positions(:, element%nodes), body%reference(:, element%local), room, &
        samples, element%status)
      element%smallest_jacobian = samples%smallest_jacobian
      if (element%status /= status_ok) return
      call element_residual(u, v, w, geometry, element%weight, samples, material, room, element%forces)
    end associate
    if (.not. allocated(tables%u)) return
    call element_tangent(tables%u(at(1)), tables%v(at(2)), tables%w(at(3)), geometry, samples, material, element%block)
  end subroutine take_element

  !> Add the forces of an element; a control point may stand twice in an element of a closed ring.
  pure subroutine add_forces(element, residual)
    type(element_t), intent(in) :: element
    real(wp), intent(inout) :: residual(:, :)
    integer :: a

    do a = 1, size(element%nodes)
      residual(:, element%nodes(a)) = residual(:, element%nodes(a)) + element%forces(:, a)
    end do
  end subroutine add_forces

  !> Add the tangents of a batch of elements, shares of the rows at the same time. `count` is the number of functions by direction,
  !> `lacking` a row that has no block where one is to be added, 0 without any.
  subroutine add_blocks(pattern, batch, count, tangent, lacking)
    type(pattern_t), intent(in) :: pattern
    type(element_t), intent(in) :: batch(:)
    integer, intent(in) :: count(3)
    real(wp), intent(inout) :: tangent(:, :, :)
    integer, intent(out) :: lacking
    integer, allocatable :: columns(:)
    integer :: a, a1, a2, a3, k, shares, share

    shares = 1
!$  shares = omp_get_max_threads()
    lacking = 0
    !$omp parallel do default(none) private(a, a1, a2, a3, columns, k) shared(batch, count, pattern, shares, tangent) &
    !$omp reduction(max: lacking)
    do share = 0, shares - 1
      allocate (columns(size(pattern%start) - 1), source=0)
      do k = 1, size(batch)
        associate (element => batch(k))
          a = 0
          do a3 = 1, count(3)
            do a2 = 1, count(2)
              do a1 = 1, count(1)
                a = a + 1
                if (modulo(element%nodes(a), shares) /= share) cycle
                call mark_row(pattern, element%nodes(a), columns)
                if (lacks(pattern, element%nodes(a), columns, element%nodes)) then
                  lacking = max(lacking, element%nodes(a))
                  cycle
                end if
                call add_row(element, [a1, a2, a3], a, count, element%block, columns, tangent)
              end do
            end do
          end do
        end associate
      end do
      deallocate (columns)
    end do
    !$omp end parallel do
  end subroutine add_blocks

  !> Add one row of blocks of an element's tangent, as `element_tangent` gives it: that of function a, in the directions `at`.
  pure subroutine add_row(element, at, a, count, block, columns, tangent)
    type(element_t), intent(in) :: element
    integer, intent(in) :: at(3), a, count(3), columns(:)
    real(wp), intent(in) :: block(6, count(1), count(1), count(2), count(2), count(3), count(3))
    real(wp), intent(inout) :: tangent(:, :, :)
    integer :: b, b1, b2, b3, i, k, pair
    real(wp) :: both

    b = 0
    do b3 = 1, count(3)
      do b2 = 1, count(2)
        do b1 = 1, count(1)
          b = b + 1
          both = element%weight(a) * element%weight(b)
          associate (target => tangent(:, :, columns(element%nodes(b))))
            do pair = 1, 6
              i = component_pairs(1, pair)
              k = component_pairs(2, pair)
              target(k, i) = target(k, i) + both * block(pair, at(1), b1, at(2), b2, at(3), b3)
              if (i /= k) target(i, k) = target(i, k) + both * block(pair, b1, at(1), b2, at(2), b3, at(3))
            end do
          end associate
        end do
      end do
    end do
  end subroutine add_row

end module isomortar_solid_assembly
