!> Add internal forces and, if `with_tangent`, the tangent of one body (isomortar_solid_assembly).
subroutine add_body(layout, knots, nknots, point, weight, npoints, gauss, bulk, shear, x, reference, n, forces, &
    with_tangent, start, nstart, column, tangent, nblocks, smallest_jacobian, status, place)
  use iso_c_binding, only: c_double, c_int
  use isomortar_api_unpack, only: unpack_patch, unpack_pattern
  use isomortar_solid_assembly, only: assemble_body => add_body
  implicit none
  integer(c_int), intent(in) :: nknots, npoints, n, nstart, nblocks
  integer(c_int), intent(in) :: layout(9), gauss(3), with_tangent
  integer(c_int), intent(in) :: point(npoints), start(nstart), column(nblocks)
  real(c_double), intent(in) :: knots(nknots), weight(npoints), bulk, shear, x(3, n), reference(3, n)
  real(c_double), intent(inout) :: forces(3, n), tangent(3, 3, nblocks)
  real(c_double), intent(out) :: smallest_jacobian
  integer(c_int), intent(out) :: status, place

  if (with_tangent /= 0) then
    call assemble_body(unpack_patch(layout, knots, point, weight), gauss, bulk, shear, x, reference, forces, &
      smallest_jacobian, status, place, unpack_pattern(start, column), tangent)
  else
    call assemble_body(unpack_patch(layout, knots, point, weight), gauss, bulk, shear, x, reference, forces, &
      smallest_jacobian, status, place)
  end if
end subroutine add_body
