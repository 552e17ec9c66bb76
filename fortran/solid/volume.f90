!> What each control point has of a body's volume: the integrals of its functions over the reference configuration.
module isomortar_solid_volume
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: lanes, wp
  use isomortar_base_predicate, only: is_index, sums_to
  use isomortar_base_status, only: status_ok
  use isomortar_nurbs_tensor_product, only: integrate
  use isomortar_solid_body, only: body_t, bundle_count, bundle_t, geometry_t, take_bundle, take_geometry
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
    type(bundle_t) :: bundle
    type(geometry_t) :: geometry
    real(wp), allocatable :: shares(:, :)
    integer :: a, k, l

    if (contracts) call require(all(is_index(body%patch%point, size(volumes))), "control_volumes: the body is among them")
    volumes = 0.0_wp
    allocate (shares(lanes, product(body%patch%direction%order + 1)))
    do k = 1, bundle_count(body)
      call take_bundle(body, k, bundle)
      call take_geometry(body, bundle, geometry)
      status = geometry%status
      if (status /= status_ok) then
        l = findloc(geometry%smallest > 0.0_wp, .false., dim=1)
        place = lanes * (k - 1) + l
        smallest = geometry%smallest(l)
        return
      end if
      call take_shares(bundle, geometry, shares)
      do l = 1, bundle%many
        do a = 1, size(shares, 2) ! one may stand twice in an element of a closed ring
          associate (volume => volumes(body%patch%point(bundle%local(a, l))))
            volume = volume + shares(l, a)
          end associate
        end do
      end do
    end do
    smallest = 0.0_wp
    place = 0
  end subroutine control_volumes

  !> The same of elements side by side.
  !>
  !> - `bundle`: they. `geometry`: what they have in the reference configuration.
  !> - `shares` (lanes, control points): volumes of their control points, L^3.
  pure subroutine take_shares(bundle, geometry, shares)
    type(bundle_t), intent(inout) :: bundle
    type(geometry_t), intent(in) :: geometry
    real(wp), contiguous, intent(out) :: shares(:, :)
    real(wp), allocatable :: densities(:, :, :)
    integer :: l

    allocate (densities(lanes, 4, size(geometry%volume, 2)), source=0.0_wp)
    densities(:, 1, :) = geometry%volume
    if (allocated(geometry%weighting)) densities(:, 1, :) = geometry%volume * geometry%weighting(:, 1, :)
    call integrate(bundle%u, bundle%v, bundle%w, 1, densities, 1, shares, bundle%lines)
    shares = bundle%weight * shares
    do l = 1, lanes
      if (contracts) call require(sums_to(shares(l, :), sum(geometry%volume(l, :))), "take_shares: they sum to its volume")
    end do
  end subroutine take_shares

end module isomortar_solid_volume
