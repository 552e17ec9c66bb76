!> Compressed rows of 3x3 blocks: places are found by marking a row once, never by searching, and `lacks` tells of those
!> that there are not.
!>
!> - `pattern`, `row`: a pattern, and a row of it, from 1.
!> - `place` (columns): of the row that was marked last the block at each column, from 1; 0: none.
module isomortar_sparse_blocks
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_index
  implicit none
  private

  public :: lacks, mark_row, squares_times

  !> Pattern of a matrix of 3x3 blocks; rows and columns are numbered from 1, offsets from 0.
  type, public :: pattern_t
    !> Blocks of row i are start(i - 1) + 1 .. start(i).
    integer, allocatable :: start(:)
    !> Column of each block.
    integer, allocatable :: column(:)
  end type pattern_t

contains

  !> Write the place of each block of a row at its column. Other columns keep what they hold, zero at first.
  pure subroutine mark_row(pattern, row, place)
    type(pattern_t), intent(in) :: pattern
    integer, intent(in) :: row
    integer, intent(inout) :: place(:)
    integer :: k

    if (contracts) call require(is_index(row, size(pattern%start) - 1), "mark_row: there is such a row")
    do k = pattern%start(row - 1) + 1, pattern%start(row)
      place(pattern%column(k)) = k
    end do
  end subroutine mark_row

  !> Whether the row that was marked last has no block at one of some `columns` (number).
  pure function lacks(pattern, row, place, columns)
    type(pattern_t), intent(in) :: pattern
    integer, intent(in) :: row, place(:), columns(:)
    logical :: lacks
    integer :: k

    lacks = .false.
    do k = 1, size(columns)
      lacks = lacks .or. place(columns(k)) <= pattern%start(row - 1) .or. place(columns(k)) > pattern%start(row)
    end do
  end function lacks

  !> Product of the squares of a matrix's entries with a vector: what independent errors of the vector's entries make of its
  !> product with the matrix, in squares (theory 5.5).
  !>
  !> - `pattern`, `values` (column, row, block): the matrix; its entries are scaled by `scale` before they are squared.
  !> - `vector` (component, control point), `product` (component, control point): of the columns, and of the rows.
  pure subroutine squares_times(pattern, values, scale, vector, product)
    type(pattern_t), intent(in) :: pattern
    real(wp), intent(in), contiguous :: values(:, :, :)
    real(wp), intent(in) :: scale, vector(:, :)
    real(wp), intent(out) :: product(:, :)
    real(wp), allocatable :: of_rows(:, :)
    real(wp) :: sums(3, 3)
    integer :: block, i

    if (contracts) call require(size(values, 3) == size(pattern%column), "squares_times: each block has its values")
    if (contracts) call require(all(is_index(pattern%column, size(vector, 2))), "squares_times: all columns have their entries")
    allocate (of_rows(9, size(vector, 2)))
    of_rows(1:3, :) = vector
    of_rows(4:6, :) = vector
    of_rows(7:9, :) = vector
    do i = 1, size(product, 2)
      sums = 0.0_wp
      do block = pattern%start(i - 1) + 1, pattern%start(i)
        call add_squares(values(:, :, block), scale, of_rows(:, pattern%column(block)), sums)
      end do
      product(:, i) = sum(sums, 1)
    end do
  end subroutine squares_times

  !> Add to `sums` the squares of a block's `entries`, scaled, times what stands at their columns, the same `of_rows`: four at once.
  pure subroutine add_squares(entries, scale, of_rows, sums)
    real(wp), intent(in) :: entries(9), scale, of_rows(9)
    real(wp), intent(inout) :: sums(9)
    integer :: j

    !$omp simd
    do j = 1, 9
      sums(j) = sums(j) + (scale * entries(j))**2 * of_rows(j)
    end do
  end subroutine add_squares

end module isomortar_sparse_blocks
