! What Python sees of solids. Shapes stand in the declarations; units are made of length L and force F. `body`, `material` and
! `pattern` are handles (isomortar_api_descriptors); `status` says how it ended (isomortar_base_status).

!> Add internal forces and the tangent of one body (isomortar_solid_assembly).
!>
!> - `x`: positions of all `n` control points, L.
!> - `forces`: on all control points, F.
!> - `with_tangent`: 1 to add to `tangent`, F/L, (column component, row component, block) on `pattern` of `nblocks`.
!> - `smallest_jacobian`: least J of all elements; where some are folded that of the first of them, whatever the number
!>   of threads. Of one that is folded initially it is the determinant of its map.
!> - `place`: on failure the element, from 1.
subroutine add_body(body, material, x, n, forces, with_tangent, pattern, nblocks, tangent, smallest_jacobian, status, place)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_api_descriptors, only: find
  use isomortar_solid_assembly, only: assemble_body => add_body
  use isomortar_solid_body, only: body_t
  use isomortar_solid_material_law, only: material_t
  use isomortar_sparse_blocks, only: pattern_t
  implicit none
  integer(c_int64_t), intent(in) :: body, material, pattern
  integer(c_int), intent(in) :: n, nblocks, with_tangent
  real(c_double), intent(in) :: x(3, n)
  real(c_double), intent(inout) :: forces(3, n), tangent(3, 3, nblocks)
  real(c_double), intent(out) :: smallest_jacobian
  integer(c_int), intent(out) :: status, place
  type(body_t), pointer :: solid
  class(material_t), pointer :: law
  type(pattern_t), pointer :: of_tangent

  smallest_jacobian = 0.0_c_double
  status = 0
  place = 0
  call find(body, solid, status)
  call find(material, law, status)
  if (with_tangent /= 0) call find(pattern, of_tangent, status)
  if (status /= 0) return
  if (with_tangent /= 0) then
    call assemble_body(solid, law, x, forces, smallest_jacobian, status, place, of_tangent, tangent)
  else
    call assemble_body(solid, law, x, forces, smallest_jacobian, status, place)
  end if
end subroutine add_body

!> Volumes of the control points of one body (isomortar_solid_volume).
!>
!> - `volumes`: of each of all `n` control points, L^3.
!> - `smallest_jacobian`: of an element folded initially the determinant of its map. `place`: on failure the element, from 1.
subroutine control_volumes(body, n, volumes, smallest_jacobian, status, place)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_api_descriptors, only: find
  use isomortar_solid_body, only: body_t
  use isomortar_solid_volume, only: volumes_of => control_volumes
  implicit none
  integer(c_int64_t), intent(in) :: body
  integer(c_int), intent(in) :: n
  real(c_double), intent(out) :: volumes(n), smallest_jacobian
  integer(c_int), intent(out) :: status, place
  type(body_t), pointer :: solid

  volumes = 0.0_c_double
  smallest_jacobian = 0.0_c_double
  status = 0
  place = 0
  call find(body, solid, status)
  if (status /= 0) return
  call volumes_of(solid, volumes, smallest_jacobian, status, place)
end subroutine control_volumes

!> First Piola stresses of a material.
!>
!> - `gradient`: `n` displacement gradients F - 1.
!> - `stress`: at each of them, force per reference area.
!> - `place`: on failure the first gradient (from 1) with det F <= 0.
subroutine material_stress(material, gradient, n, stress, status, place)
  use iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_api_descriptors, only: find
  use isomortar_base_algebra, only: identity, inverse
  use isomortar_base_kinds, only: lanes
  use isomortar_base_status, only: status_folded, status_ok
  use isomortar_solid_material_law, only: material_t, stretch, stretch_t
  implicit none
  integer(c_int64_t), intent(in) :: material
  integer(c_int), intent(in) :: n
  real(c_double), intent(in) :: gradient(3, 3, n)
  real(c_double), intent(out) :: stress(3, 3, n)
  integer(c_int), intent(out) :: status, place
  class(material_t), pointer :: law
  real(c_double) :: kirchhoff(lanes, 3, 3)
  type(stretch_t) :: state
  integer :: q

  stress = 0.0_c_double
  status = status_ok
  place = 0
  call find(material, law, status)
  if (status /= status_ok) return
  do q = 1, n
    call stretch(spread(gradient(:, :, q), 1, lanes), state)
    if (.not. state%jacobian(1) > 0.0_c_double) then
      place = q
      status = status_folded
      return
    end if
    call law%stress(state, kirchhoff)
    stress(:, :, q) = matmul(kirchhoff(1, :, :), transpose(inverse(identity + gradient(:, :, q), state%jacobian(1))))
  end do
end subroutine material_stress
