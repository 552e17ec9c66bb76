!> Assembly of a linear system from blocked sources through places that are found once per pattern.
module isomortar_sparse_scatter
  use, intrinsic :: iso_c_binding, only: c_int, c_int64_t
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_compressed, is_index
  use isomortar_sparse_blocks, only: pattern_t
  implicit none
  private

  public :: add_values, find_places

contains

  !> Where each entry of a matrix of 3x3 blocks goes in a compressed matrix.
  !>
  !> - `pattern`: of the matrix of blocks, the source.
  !> - `row_of` (rows), `column_of` (columns): rows and columns of the system for those of the source, all from 0; negative:
  !>   dropped.
  !> - `transposed`: whether rows of the source are columns of the system.
  !> - `system_start` (unknowns + 1), `system_column` (entries): compressed rows of the system, from 0.
  !> - `places` (column, row, block): in the system, from 1; 0 where it is dropped.
  !> - `missing`: whether the system lacks an entry.
  pure subroutine find_places(pattern, row_of, column_of, transposed, system_start, system_column, places, missing)
    type(pattern_t), intent(in) :: pattern
    integer(c_int), intent(in) :: row_of(0:), column_of(0:)
    logical, intent(in) :: transposed
    integer(c_int64_t), intent(in) :: system_start(0:), system_column(:)
    integer(c_int64_t), intent(out) :: places(:, :, :)
    logical, intent(out) :: missing
    integer(c_int64_t), allocatable :: mark(:)
    integer(c_int64_t) :: k
    integer :: block, i, j, r, row

    if (contracts) call require(is_compressed(system_start, size(system_column)), "find_places: rows follow one another")
    if (contracts) call require(size(row_of) == 3 * (size(pattern%start) - 1), "find_places: all rows have their unknowns")
    if (contracts) call require(all(is_index(pattern%column, size(column_of) / 3)), "find_places: and all columns")
    missing = .false.
    places = 0
    if (transposed) then
      call find_transposed(pattern, row_of, column_of, system_start, system_column, places, missing)
      return
    end if
    allocate (mark(0:max(maxval(column_of), 0)))
    mark = 0
    do i = 0, size(pattern%start) - 2
      do r = 1, 3
        row = row_of(3 * i + r - 1)
        if (row < 0) cycle
        do k = system_start(row) + 1, system_start(row + 1)
          if (system_column(k) <= ubound(mark, 1)) mark(system_column(k)) = k
        end do
        do block = pattern%start(i) + 1, pattern%start(i + 1)
          do j = 1, 3
            associate (target => column_of(3 * (pattern%column(block) - 1) + j - 1))
              if (target < 0) cycle
              places(j, r, block) = mark(target)
              missing = missing .or. mark(target) <= system_start(row) .or. mark(target) > system_start(row + 1)
            end associate
          end do
        end do
      end do
    end do
  end subroutine find_places

  !> The same where rows of the source are columns of the system: by bisection, as its rows are met out of order.
  pure subroutine find_transposed(pattern, row_of, column_of, system_start, system_column, places, missing)
    type(pattern_t), intent(in) :: pattern
    integer(c_int), intent(in) :: row_of(0:), column_of(0:)
    integer(c_int64_t), intent(in) :: system_start(0:), system_column(:)
    integer(c_int64_t), intent(inout) :: places(:, :, :)
    logical, intent(inout) :: missing
    integer(c_int64_t) :: high, low, middle
    integer :: block, i, j, r, row, wanted

    do i = 0, size(pattern%start) - 2
      do block = pattern%start(i) + 1, pattern%start(i + 1)
        do j = 1, 3
          row = column_of(3 * (pattern%column(block) - 1) + j - 1)
          if (row < 0) cycle
          do r = 1, 3
            wanted = row_of(3 * i + r - 1)
            if (wanted < 0) cycle
            low = system_start(row) + 1
            high = system_start(row + 1)
            if (low > high) then
              missing = .true.
              cycle
            end if
            do while (low < high)
              middle = (low + high) / 2
              if (system_column(middle) < wanted) then
                low = middle + 1
              else
                high = middle
              end if
            end do
            places(j, r, block) = low
            missing = missing .or. system_column(low) /= wanted
          end do
        end do
      end do
    end do
  end subroutine find_transposed

  !> Add each number of `source` (entries) to that of `values` (system entries) at its place, `places` (entries), from 1, where it
  !> has one.
  pure subroutine add_values(places, source, values)
    integer(c_int64_t), intent(in) :: places(:)
    real(wp), intent(in) :: source(:)
    real(wp), intent(inout) :: values(:)
    integer(c_int64_t) :: k

    if (contracts) call require(size(places) == size(source), "add_values: each entry has its place")
    if (contracts) call require(all(places >= 0 .and. places <= size(values)), "add_values: places are those of the values")
    do k = 1, size(places, kind=c_int64_t)
      if (places(k) > 0) values(places(k)) = values(places(k)) + source(k)
    end do
  end subroutine add_values

end module isomortar_sparse_scatter
