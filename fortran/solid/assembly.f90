!> Residual and tangent of one body.
module isomortar_solid_assembly
  use isomortar_base_kinds, only: wp
  use isomortar_base_status, only: status_ok
  use isomortar_nurbs_patch, only: element_count, element_nodes, element_of, line_rule, line_rule_t, patch_t
  use isomortar_nurbs_tensor_product, only: line_pairs, line_pairs_t
  use isomortar_solid_element, only: component_pairs, element_residual, element_tangent, sample_element, samples_t
  use isomortar_sparse_blocks, only: mark_row, pattern_t
  implicit none
  private

  public :: add_body

contains

  !> Add internal forces and, where a pattern is given, the tangent of a body.
  !>
  !> Blocks of the tangent are stored as (column component, row component, block). On failure `place` is the element
  !> (from 1). `smallest_jacobian` is the least J met, of an
  !> element folded initially the determinant of its map.
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
    type(line_pairs_t), allocatable :: uu(:), vv(:), ww(:)
    real(wp), allocatable :: forces(:, :), weight(:), block(:)
    integer :: a, at(3), e, n

    call line_rule(patch%direction(1), points(1), 1, u)
    call line_rule(patch%direction(2), points(2), 1, v)
    call line_rule(patch%direction(3), points(3), 1, w)
    n = product(patch%direction%order + 1)
    allocate (local(n), nodes(n), forces(3, n), columns(size(positions, 2)))
    if (present(tangent)) then
      allocate (block(6 * n**2))
      call line_pairs(u, uu)
      call line_pairs(v, vv)
      call line_pairs(w, ww)
    end if
    smallest_jacobian = huge(1.0_wp)
    status = status_ok
    place = 0
    do e = 1, element_count(patch)
      at = element_of(patch, e)
      call element_nodes(patch, at, local)
      nodes(:) = patch%point(local)
      weight = patch%weight(local)
      call sample_element(u(at(1)), v(at(2)), w(at(3)), weight, positions(:, nodes), references(:, nodes), samples, status)
      smallest_jacobian = min(smallest_jacobian, samples%smallest_jacobian)
      if (status /= status_ok) then
        place = e
        return
      end if
      call element_residual(u(at(1)), v(at(2)), w(at(3)), weight, samples, bulk, shear, forces)
      do a = 1, n ! a control point may stand twice in an element of a closed ring
        residual(:, nodes(a)) = residual(:, nodes(a)) + forces(:, a)
      end do
      if (present(tangent)) then
        call element_tangent(uu(at(1)), vv(at(2)), ww(at(3)), samples, bulk, shear, block)
        call add_block(pattern, nodes, weight, patch%direction%order + 1, block, columns, tangent)
      end if
    end do
  end subroutine add_body

  !> Add the tangent of an element, as `element_tangent` gives it, to the compressed one.
  !> `count` is the number of functions by direction.
  pure subroutine add_block(pattern, nodes, weight, count, block, columns, tangent)
    type(pattern_t), intent(in) :: pattern
    integer, intent(in) :: nodes(:), count(3)
    real(wp), intent(in) :: weight(:), block(6, count(1), count(1), count(2), count(2), count(3), count(3))
    integer, intent(inout) :: columns(:)
    real(wp), intent(inout) :: tangent(:, :, :)
    integer :: a, a1, a2, a3, b, b1, b2, b3, i, k, pair
    real(wp) :: both

    do a3 = 1, count(3)
      do a2 = 1, count(2)
        do a1 = 1, count(1)
          a = a1 + count(1) * (a2 - 1 + count(2) * (a3 - 1))
          call mark_row(pattern, nodes(a), columns)
          do b3 = 1, count(3)
            do b2 = 1, count(2)
              do b1 = 1, count(1)
                b = b1 + count(1) * (b2 - 1 + count(2) * (b3 - 1))
                both = weight(a) * weight(b)
                associate (target => tangent(:, :, columns(nodes(b))))
                  do pair = 1, 6
                    i = component_pairs(1, pair)
                    k = component_pairs(2, pair)
                    target(k, i) = target(k, i) + both * block(pair, a1, b1, a2, b2, a3, b3)
                    if (i /= k) target(i, k) = target(i, k) + both * block(pair, b1, a1, b2, a2, b3, a3)
                  end do
                end associate
              end do
            end do
          end do
        end do
      end do
    end do
  end subroutine add_block

end module isomortar_solid_assembly
