!> Where each entry of a blocked source goes in a compressed system; 0 where it is dropped (isomortar_sparse_scatter).
subroutine find_places(start, nstart, column, nblocks, row_of, nrows, column_of, ncolumns, transposed, system_start, nsystem, &
    system_column, nentries, places, missing)
  use iso_c_binding, only: c_int, c_int64_t
  use isomortar_sparse_scatter, only: find => find_places
  implicit none
  integer(c_int), intent(in) :: nstart, nblocks, nrows, ncolumns, nsystem, transposed
  integer(c_int64_t), intent(in) :: nentries
  integer(c_int), intent(in) :: start(nstart), column(nblocks), row_of(nrows), column_of(ncolumns)
  integer(c_int64_t), intent(in) :: system_start(nsystem), system_column(nentries)
  integer(c_int64_t), intent(out) :: places(3, 3, nblocks)
  integer(c_int), intent(out) :: missing
  logical :: lacks

  call find(start, column, row_of, column_of, transposed /= 0, system_start, system_column, places, lacks)
  missing = merge(1, 0, lacks)
end subroutine find_places

!> values(places(k)) += source(k) where places(k) > 0 (isomortar_sparse_scatter).
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
