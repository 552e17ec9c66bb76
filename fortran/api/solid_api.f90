!> Add internal forces and, if `with_tangent`, the tangent of one body (isomortar_solid_assembly). `law` and `parameters` name its
!> material (isomortar_solid_material_table).
subroutine add_body(layout, knots, nknots, point, weight, npoints, gauss, law, parameters, nparameters, x, reference, n, forces, &
    with_tangent, start, nstart, column, tangent, nblocks, smallest_jacobian, status, place)
  use iso_c_binding, only: c_double, c_int
  use isomortar_api_unpack, only: unpack_patch, unpack_pattern
  use isomortar_solid_assembly, only: assemble_body => add_body
  use isomortar_solid_material_law, only: material_t
  use isomortar_solid_material_table, only: material_of
  implicit none
  integer(c_int), intent(in) :: nknots, npoints, nparameters, n, nstart, nblocks
  integer(c_int), intent(in) :: layout(9), gauss(3), law, with_tangent
  integer(c_int), intent(in) :: point(npoints), start(nstart), column(nblocks)
  real(c_double), intent(in) :: knots(nknots), weight(npoints), parameters(nparameters), x(3, n), reference(3, n)
  real(c_double), intent(inout) :: forces(3, n), tangent(3, 3, nblocks)
  real(c_double), intent(out) :: smallest_jacobian
  integer(c_int), intent(out) :: status, place
  class(material_t), allocatable :: material

  smallest_jacobian = 0.0_c_double
  place = law
  call material_of(law, parameters, material, status)
  if (status /= 0) return
  if (with_tangent /= 0) then
    call assemble_body(unpack_patch(layout, knots, point, weight), gauss, material, x, reference, forces, &
      smallest_jacobian, status, place, unpack_pattern(start, column), tangent)
  else
    call assemble_body(unpack_patch(layout, knots, point, weight), gauss, material, x, reference, forces, &
      smallest_jacobian, status, place)
  end if
end subroutine add_body

!> First Piola stresses P of a material (see `add_body`) at displacement gradients F - 1, force per reference area. On failure
!> `place` is the first gradient (from 1) with det F <= 0.
subroutine material_stress(law, parameters, nparameters, gradient, n, stress, status, place)
  use iso_c_binding, only: c_double, c_int
  use isomortar_base_algebra, only: identity, inverse
  use isomortar_base_status, only: status_folded
  use isomortar_solid_material_law, only: material_t, stretch, stretch_t
  use isomortar_solid_material_table, only: material_of
  implicit none
  integer(c_int), intent(in) :: nparameters, n, law
  real(c_double), intent(in) :: parameters(nparameters), gradient(3, 3, n)
  real(c_double), intent(out) :: stress(3, 3, n)
  integer(c_int), intent(out) :: status, place
  class(material_t), allocatable :: material
  real(c_double) :: kirchhoff(3, 3)
  type(stretch_t) :: state
  integer :: q

  stress = 0.0_c_double
  place = law
  call material_of(law, parameters, material, status)
  if (status /= 0) return
  do q = 1, n
    place = q
    call stretch(gradient(:, :, q), state)
    if (.not. state%jacobian > 0.0_c_double) then
      status = status_folded
      return
    end if
    call material%stress(state, kirchhoff)
    stress(:, :, q) = matmul(kirchhoff, transpose(inverse(identity + gradient(:, :, q), state%jacobian)))
  end do
end subroutine material_stress
