!> Residual and tangent of one body.
module isomortar_solid_assembly
  use isomortar_base_kinds, only: wp
  use isomortar_base_status, only: status_ok
  use isomortar_nurbs_patch, only: element_count, element_nodes, element_of, line_rule, line_rule_t, patch_t
  use isomortar_solid_element, only: element_residual, element_tangent, sample_element, samples_t
  use isomortar_sparse_blocks, only: mark_row, pattern_t
  implicit none
  private

  public :: add_body

contains

  !> Add internal forces and, where a pattern is given, the tangent of a body.
  !>
  !> Blocks of the tangent are stored as (column component, row component, block). On failure `place` is the element
  !> (from 1). `smallest_jacobian` is the least J met.
  subroutine add_body(patch, points, bulk, shear, positions, references, residual, smallest_jacobian, status, place, &
      pattern, tangent)
    type(patch_t), intent(in) :: patch
    integer, intent(in) :: points(3)
    real(wp), intent(in) :: bulk, shear
    real(wp), intent(in) :: positions(:, :), references(:, :)
    real(wp), intent(inout) :: residual(:, :)
    real(wp), intent(out) :: smallest_jacobian
    integer, intent(out) :: status, place
    type(pattern_t), intent(in), optional :: pattern
    real(wp), intent(inout), optional :: tangent(:, :, :)
    type(line_rule_t), allocatable :: u(:), v(:), w(:)
    type(samples_t) :: samples
    integer, allocatable :: local(:), nodes(:), columns(:)
    real(wp), allocatable :: forces(:, :), block(:, :, :, :)
    integer :: a, at(3), e, n

    call line_rule(patch%direction(1), points(1), 1, u)
    call line_rule(patch%direction(2), points(2), 1, v)
    call line_rule(patch%direction(3), points(3), 1, w)
    n = product(patch%direction%order + 1)
    allocate (local(n), nodes(n), forces(3, n), columns(size(positions, 2)))
    if (present(tangent)) allocate (block(n, 3, n, 3))
    smallest_jacobian = huge(1.0_wp)
    status = status_ok
    place = 0
    do e = 1, element_count(patch)
      at = element_of(patch, e)
      call element_nodes(patch, at, local)
      nodes(:) = patch%point(local)
      call sample_element(u(at(1)), v(at(2)), w(at(3)), patch%weight(local), positions(:, nodes), &
        references(:, nodes), samples, status)
      smallest_jacobian = min(smallest_jacobian, samples%smallest_jacobian)
      if (status /= status_ok) then
        place = e
        return
      end if
      call element_residual(samples, bulk, shear, forces)
      do a = 1, n ! a control point may stand twice in an element of a closed ring
        residual(:, nodes(a)) = residual(:, nodes(a)) + forces(:, a)
      end do
      if (present(tangent)) then
        call element_tangent(samples, bulk, shear, block)
        call add_block(pattern, nodes, block, columns, tangent)
      end if
    end do
  end subroutine add_body

  !> Add a dense element matrix to the compressed one.
  pure subroutine add_block(pattern, nodes, block, columns, tangent)
    type(pattern_t), intent(in) :: pattern
    integer, intent(in) :: nodes(:)
    real(wp), intent(in) :: block(:, :, :, :)
    integer, intent(inout) :: columns(:)
    real(wp), intent(inout) :: tangent(:, :, :)
    integer :: a, b, i, k

    do a = 1, size(nodes)
      call mark_row(pattern, nodes(a), columns)
      do b = 1, size(nodes)
        associate (target => tangent(:, :, columns(nodes(b))))
          do i = 1, 3
            do k = 1, 3
              target(k, i) = target(k, i) + block(a, i, b, k)
            end do
          end do
        end associate
      end do
    end do
  end subroutine add_block

end module isomortar_solid_assembly
