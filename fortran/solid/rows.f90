!> Tangents of elements, added to the rows of a system.
!>
!> A thread has rows of its own. Each row is added for all of its elements at once, while it is in the cache, and in their order:
!> the bits of the result do not depend on the number of threads.
module isomortar_solid_rows
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_index
  use isomortar_base_status, only: status_ok, status_out_of_memory
  use isomortar_solid_material_law, only: component_pairs
  use isomortar_sparse_blocks, only: lacks, mark_row, pattern_t
!$ use omp_lib, only: omp_get_max_threads
  implicit none
  private

  public :: add_rows, rows_of

  !> Room for what is known of the rows.
  type, public :: rows_t
    !> Where each row stands among the control points of the elements that are added, counted from 0: the first place, and for each
    !> place the next one, (control point, element); -1: none.
    integer, allocatable :: first(:), next(:, :)
    !> For each share of the rows the block at each column of the row that was marked last.
    integer, allocatable :: columns(:, :)
  end type rows_t

contains

  !> Room for the rows of a system, `self`.
  !>
  !> - `rows`: how many there are. `functions`, `elements`: of an element, and how many are added at once.
  !> - `status`: whether memory ran out (isomortar_base_status).
  subroutine rows_of(rows, functions, elements, self, status)
    integer, intent(in) :: rows, functions, elements
    type(rows_t), intent(out) :: self
    integer, intent(out) :: status
    integer :: failed, shares

    shares = 1
!$  shares = omp_get_max_threads()
    allocate (self%first(rows), stat=failed)
    if (failed == 0) allocate (self%next(functions, elements), stat=failed)
    if (failed == 0) allocate (self%columns(rows, 0:shares - 1), stat=failed)
    status = merge(status_ok, status_out_of_memory, failed == 0)
    if (failed /= 0) return
    self%first(:) = -1
    self%columns(:, :) = 0
  end subroutine rows_of

  !> Add the tangents of some elements.
  !>
  !> - `pattern`, `tangent` (column component, row component, blocks): pattern of the system's tangent, and its blocks, F/L.
  !> - `nodes` (control points, elements), `weight` (control points, elements): control points of the elements, and their weights.
  !> - `blocks` (numbers, elements): their tangents as `element_tangents` gives them. `count`: functions by direction.
  !> - `rows`: room. `lacking`: a row that has no block where one is to be added, 0 without any.
  subroutine add_rows(pattern, nodes, weight, blocks, count, rows, tangent, lacking)
    type(pattern_t), intent(in) :: pattern
    integer, contiguous, intent(in) :: nodes(:, :)
    real(wp), contiguous, intent(in) :: weight(:, :), blocks(:, :)
    integer, intent(in) :: count(3)
    type(rows_t), intent(inout) :: rows
    real(wp), intent(inout) :: tangent(:, :, :)
    integer, intent(out) :: lacking
    integer :: a, element, place, row, share

    if (contracts) call require(size(rows%first) == size(pattern%start) - 1, "add_rows: there is room for the rows")
    if (contracts) call require(all(is_index(nodes, size(rows%first))), "add_rows: control points have rows")
    call list_rows(nodes, rows)
    lacking = 0
    !$omp parallel do default(none) private(a, element, place, row) &
    !$omp shared(blocks, count, nodes, pattern, rows, tangent, weight) reduction(max: lacking)
    do share = 0, size(rows%columns, 2) - 1
      associate (columns => rows%columns(:, share), functions => size(nodes, 1))
        do element = 1, size(nodes, 2)
          do a = 1, functions
            row = nodes(a, element)
            place = a - 1 + functions * (element - 1)
            if (modulo(row, size(rows%columns, 2)) /= share .or. rows%first(row) /= place) cycle
            call mark_row(pattern, row, columns)
            call add_row(row, place, pattern, nodes, weight, blocks, count, rows%next, columns, tangent, lacking)
          end do
        end do
      end associate
    end do
    !$omp end parallel do
    do element = 1, size(nodes, 2)
      do a = 1, size(nodes, 1)
        rows%first(nodes(a, element)) = -1
      end do
    end do
  end subroutine add_rows

  !> Where rows stand among the `nodes` (control points, elements), whose `rows` have no first place yet.
  pure subroutine list_rows(nodes, rows)
    integer, intent(in) :: nodes(:, :)
    type(rows_t), intent(inout) :: rows
    integer :: a, k

    do k = size(nodes, 2), 1, -1
      do a = size(nodes, 1), 1, -1
        rows%next(a, k) = rows%first(nodes(a, k))
        rows%first(nodes(a, k)) = a - 1 + size(nodes, 1) * (k - 1)
      end do
    end do
  end subroutine list_rows

  !> Add a row, which is marked, of all elements that have it, from its place `first` on; the others as of `add_rows`, and `next` as
  !> of rows_t.
  pure subroutine add_row(row, first, pattern, nodes, weight, blocks, count, next, columns, tangent, lacking)
    integer, intent(in) :: row, first, count(3)
    type(pattern_t), intent(in) :: pattern
    integer, contiguous, intent(in) :: nodes(:, :), next(:, :), columns(:)
    real(wp), contiguous, intent(in) :: weight(:, :), blocks(:, :)
    real(wp), intent(inout) :: tangent(:, :, :)
    integer, intent(inout) :: lacking
    integer :: a, element, place

    place = first
    do while (place >= 0)
      a = 1 + modulo(place, size(nodes, 1))
      element = 1 + place / size(nodes, 1)
      if (lacks(pattern, row, columns, nodes(:, element))) then
        lacking = max(lacking, row)
      else
        call add_element(nodes(:, element), weight(:, element), a, count, blocks(:, element), columns, tangent)
      end if
      place = next(a, element)
    end do
  end subroutine add_row

  !> Add what one element has of the row of its function a.
  pure subroutine add_element(nodes, weight, a, count, block, columns, tangent)
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
  end subroutine add_element

end module isomortar_solid_rows
