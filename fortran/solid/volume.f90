!> What each control point has of a body's volume: the integrals of its functions over the reference configuration.
module isomortar_solid_volume
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_index, sums_to
  use isomortar_base_status, only: status_folded_initially, status_ok
  use isomortar_nurbs_patch, only: element_count, element_nodes, element_of, line_rule, line_rule_t, patch_t
  use isomortar_nurbs_tensor_product, only: integrate, interpolate, room_for_lines
  use isomortar_solid_points, only: determinants, quotients
  implicit none
  private

  public :: control_volumes

contains

  !> Volumes of the control points of a body (theory 5.14).
  !>
  !> - `patch`: its mesh. `points`: Gauss points of an element by direction.
  !> - `references` (3, control points): of all control points in the reference configuration, L.
  !> - `volumes` (control points): of each of them, L^3.
  !> - `status`, `place`: how it ended (isomortar_base_status), and on failure the element, from 1.
  subroutine control_volumes(patch, points, references, volumes, status, place)
    type(patch_t), intent(in) :: patch
    integer, intent(in) :: points(3)
    real(wp), intent(in) :: references(:, :)
    real(wp), intent(out) :: volumes(:)
    integer, intent(out) :: status, place
    type(line_rule_t), allocatable :: u(:), v(:), w(:)
    integer :: a, at(3), local(product(patch%direction%order + 1))
    real(wp) :: shares(size(local))

    if (contracts) call require(size(volumes) == size(references, 2), "control_volumes: each control point has its own")
    if (contracts) call require(all(is_index(patch%point, size(volumes))), "control_volumes: the patch is among the control points")
    call line_rule(patch%direction(1), points(1), 1, u)
    call line_rule(patch%direction(2), points(2), 1, v)
    call line_rule(patch%direction(3), points(3), 1, w)
    volumes = 0.0_wp
    status = status_ok
    do place = 1, element_count(patch)
      at = element_of(patch, place)
      call element_nodes(patch, at, local)
      call element_volumes(u(at(1)), v(at(2)), w(at(3)), patch%weight(local), references(:, patch%point(local)), shares, status)
      if (status /= status_ok) return
      do a = 1, size(local) ! one may stand twice in an element of a closed ring
        volumes(patch%point(local(a))) = volumes(patch%point(local(a))) + shares(a)
      end do
    end do
    place = 0
  end subroutine control_volumes

  !> The same of one element.
  !>
  !> - `u`, `v`, `w`: functions of the three directions in the element at its Gauss points.
  !> - `weight` (control points), `references` (3, control points): weights and reference positions of its control points, L.
  !> - `shares` (control points): their volumes, L^3. `status`: whether it is folded (isomortar_base_status).
  pure subroutine element_volumes(u, v, w, weight, references, shares, status)
    type(line_rule_t), intent(in) :: u, v, w
    real(wp), intent(in) :: weight(:), references(:, :)
    real(wp), intent(out) :: shares(:)
    integer, intent(out) :: status
    real(wp), allocatable :: coefficients(:, :), denominator(:, :), densities(:, :), det(:), room(:), volume(:)
    real(wp), allocatable :: map(:, :, :), reference(:, :, :), values(:, :, :)
    integer :: a, i, j, k, kind, m

    m = size(u%weight) * size(v%weight) * size(w%weight)
    allocate (coefficients(4, size(weight)), denominator(m, 4), densities(m, 4), det(m), volume(m))
    allocate (map(m, 3, 3), reference(m, 3, 4), values(4, m, 4), room(room_for_lines(u, v, w, 4)))
    do a = 1, size(weight) ! from the first control point, so that a rigid translation costs no digits
      coefficients(1, a) = weight(a)
      coefficients(2:4, a) = weight(a) * (references(:, a) - references(:, 1))
    end do
    call interpolate(u, v, w, 4, coefficients, values, room)
    do kind = 1, 4
      denominator(:, kind) = values(1, :, kind)
      reference(:, :, kind) = transpose(values(2:4, :, kind))
    end do
    call quotients(m, denominator, reference, map)
    call determinants(m, map, det)
    status = merge(status_ok, status_folded_initially, all(det > 0.0_wp))
    if (status /= status_ok) return
    volume = [(((u%weight(i) * v%weight(j) * w%weight(k), i=1, size(u%weight)), j=1, size(v%weight)), k=1, size(w%weight))] * det
    densities = 0.0_wp
    densities(:, 1) = volume / denominator(:, 1)
    call integrate(u, v, w, 1, densities, shares, room)
    shares = weight * shares
    if (contracts) call require(sums_to(shares, sum(volume)), "element_volumes: they sum to the element's volume")
  end subroutine element_volumes

end module isomortar_solid_volume
