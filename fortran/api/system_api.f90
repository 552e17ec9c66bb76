! What Python sees of sources of 3x3 blocks and the assembly of linear systems from them (isomortar_sparse_blocks,
! isomortar_sparse_scatter).

!> Where each entry of a source goes in a compressed system.
!>
!> - `pattern`: handle (isomortar_api_descriptors) of the source's pattern, which has `nblocks`.
!> - `row_of`, `column_of`: unknowns of the `nrows` and `ncolumns` of the source, from 0; negative: dropped.
!> - `transposed`: 1 where rows of the source are columns of the system.
!> - `system_start`, `system_column`: rows of the system, `nsystem` - 1, begin here; columns of its `nentries`, from 0.
!> - `places`: (column component, row component, block), from 1; 0 where it is dropped.
!> - `status`: that of a pattern where the system lacks an entry.
subroutine find_places(pattern, nblocks, row_of, nrows, column_of, ncolumns, transposed, system_start, nsystem, system_column, &
    nentries, places, status)
  use iso_c_binding, only: c_int, c_int64_t
  use isomortar_api_descriptors, only: find
  use isomortar_base_status, only: status_ok, status_pattern
  use isomortar_sparse_blocks, only: pattern_t
  use isomortar_sparse_scatter, only: places_of => find_places
  implicit none
  integer(c_int64_t), intent(in) :: pattern, nentries
  integer(c_int), intent(in) :: nblocks, nrows, ncolumns, nsystem, transposed
  integer(c_int), intent(in) :: row_of(nrows), column_of(ncolumns)
  integer(c_int64_t), intent(in) :: system_start(nsystem), system_column(nentries)
  integer(c_int64_t), intent(out) :: places(3, 3, nblocks)
  integer(c_int), intent(out) :: status
  type(pattern_t), pointer :: of_source
  logical :: lacks

  status = status_ok
  call find(pattern, of_source, status)
  if (status /= status_ok) return
  call places_of(of_source, row_of, column_of, transposed /= 0, system_start, system_column, places, lacks)
  status = merge(status_pattern, status_ok, lacks)
end subroutine find_places

!> values(places(k)) += source(k) where places(k) > 0.
!>
!> - `places`, `source`: the `n` entries of the source, and where they go, from 1; 0: nowhere.
!> - `values`: the `m` entries of the system.
subroutine add_values(places, source, n, values, m)
  use iso_c_binding, only: c_double, c_int64_t
  use isomortar_sparse_scatter, only: add => add_values
  implicit none
  integer(c_int64_t), intent(in) :: n, m
  integer(c_int64_t), intent(in) :: places(n)
  real(c_double), intent(in) :: source(n)
  real(c_double), intent(inout) :: values(m)

  call add(places, source, values)
end subroutine add_values

!> Product of the squares of a matrix's entries with a vector.
!>
!> - `pattern`: handle (isomortar_api_descriptors) of the matrix's pattern, which has `nblocks` in `nrows`.
!> - `values`: (column component, row component, block); squared when they are scaled by `scale`.
!> - `vector`: (component, control point) of the `ncolumns`; `product` likewise of the rows.
!> - `status`: that of a handle.
subroutine squares_times(pattern, values, nblocks, scale, vector, ncolumns, nrows, product, status)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_api_descriptors, only: find
  use isomortar_base_status, only: status_ok
  use isomortar_sparse_blocks, only: pattern_t, product_of => squares_times
  implicit none
  integer(c_int64_t), intent(in) :: pattern
  integer(c_int), intent(in) :: nblocks, ncolumns, nrows
  real(c_double), intent(in) :: values(3, 3, nblocks), scale, vector(3, ncolumns)
  real(c_double), intent(out) :: product(3, nrows)
  integer(c_int), intent(out) :: status
  type(pattern_t), pointer :: of_matrix

  status = status_ok
  call find(pattern, of_matrix, status)
  if (status /= status_ok) return
  call product_of(of_matrix, values, scale, vector, product)
end subroutine squares_times
