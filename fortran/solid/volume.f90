!> What each control point has of a body's volume: the integrals of its functions over the reference configuration.
module isomortar_solid_volume
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_index, sums_to
  use isomortar_base_status, only: status_ok
  use isomortar_nurbs_patch, only: element_count, element_nodes, element_of, line_rule_t
  use isomortar_nurbs_tensor_product, only: integrate, room_for_lines
  use isomortar_solid_body, only: body_t, geometry_room_t, geometry_t, take_geometry
  implicit none
  private

  public :: control_volumes

contains

  !> Volumes of the control points of a `body` (theory 5.14).
  !>
  !> - `volumes` (control points): of each of all control points, L^3.
  !> - `status`, `place`: how it ended (isomortar_base_status), and on failure the element, from 1; `smallest`: then the least
  !>   determinant of its map.
  subroutine control_volumes(body, volumes, smallest, status, place)
    type(body_t), intent(in) :: body
    real(wp), intent(out) :: volumes(:), smallest
    integer, intent(out) :: status, place
    type(geometry_room_t) :: room
    type(geometry_t) :: geometry
    integer :: a, at(3), local(product(body%patch%direction%order + 1))
    real(wp) :: shares(size(local))

    if (contracts) call require(all(is_index(body%patch%point, size(volumes))), "control_volumes: the body is among them")
    volumes = 0.0_wp
    do place = 1, element_count(body%patch)
      at = element_of(body%patch, place)
      call element_nodes(body%patch, at, local)
      call take_geometry(body, place, room, geometry)
      status = geometry%status
      smallest = geometry%smallest
      if (status /= status_ok) return
      call element_volumes(body%u(at(1)), body%v(at(2)), body%w(at(3)), body%patch%weight(local), geometry, shares)
      do a = 1, size(local) ! one may stand twice in an element of a closed ring
        volumes(body%patch%point(local(a))) = volumes(body%patch%point(local(a))) + shares(a)
      end do
    end do
    place = 0
  end subroutine control_volumes

  !> The same of one element.
  !>
  !> - `u`, `v`, `w`: functions of the three directions in the element at its Gauss points.
  !> - `weight` (control points): weights of its control points. `geometry`: what it has in the reference configuration.
  !> - `shares` (control points): their volumes, L^3.
  pure subroutine element_volumes(u, v, w, weight, geometry, shares)
    type(line_rule_t), intent(in) :: u, v, w
    real(wp), intent(in) :: weight(:)
    type(geometry_t), intent(in) :: geometry
    real(wp), intent(out) :: shares(:)
    real(wp), allocatable :: densities(:, :), room(:)

    allocate (densities(size(geometry%volume), 4), source=0.0_wp)
    allocate (room(room_for_lines(u, v, w, 1)))
    densities(:, 1) = geometry%volume
    if (allocated(geometry%weighting)) densities(:, 1) = geometry%volume * geometry%weighting(:, 1)
    call integrate(u, v, w, 1, densities, shares, room)
    shares = weight * shares
    if (contracts) call require(sums_to(shares, sum(geometry%volume)), "element_volumes: they sum to the element's volume")
  end subroutine element_volumes

end module isomortar_solid_volume
