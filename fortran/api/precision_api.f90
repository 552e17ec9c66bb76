!> What a compiled kernel says about itself. In both extension modules.

!> Working precision: decimal digits, `digits10`, and the spacing of numbers at one, `spacing1`.
subroutine working_precision(digits10, spacing1)
  use iso_c_binding, only: c_double, c_int
  use isomortar_base_kinds, only: wp
  implicit none
  integer(c_int), intent(out) :: digits10
  real(c_double), intent(out) :: spacing1

  digits10 = int(precision(1.0_wp), c_int)
  spacing1 = real(epsilon(1.0_wp), c_double)
end subroutine working_precision
