!> Closest-point projection onto a surface: the nearest point of the whole of it, from any start (theory 3.1).
!>
!> A search from a start ends at the nearest place near that. Then every other element whose hull comes nearer is searched too.
!>
!> - `surface`, `opposite`, `hulls`: the face, that across from it, and the hulls of its elements.
!> - `positions` (3, control points): of all control points, L. `x`: place of a slave point, L.
!> - `place`, `xi`: an element by direction, from 1, and coordinates in it, P. `here`: where the search stands.
!> - `work`: counts of what is done.
module isomortar_contact_projection
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_index
  use isomortar_contact_hulls, only: hulls_t, is_farther, nearest_sample
  use isomortar_contact_search, only: descend, search_element, search_t
  use isomortar_contact_work, only: evaluate, work_t
  use isomortar_nurbs_surface, only: element_span, homogeneous_net, surface_element_count, surface_element_of, surface_point, &
    surface_t
  implicit none
  private

  public :: find_too_deep, look_round, shallow_depth, square_depth, start_nearest

  !> Two feet that are at the same distance but for this share are equally near: the one in the lower element is taken, or of lower
  !> coordinates in it if those differ by more than a share of it: about a centre of curvature places side by side are equally near.
  real(wp), parameter :: tie = epsilon(1.0_wp)**0.75_wp, tie_apart = 0.01_wp
  !> Distance times largest curvature up to which an element holds one near point alone.
  real(wp), parameter :: safe_bend = 0.5_wp
  !> Share of the least depth between control points within which a point is not asked how deep the master's body is.
  real(wp), parameter :: shallow_share = 0.25_wp
  real(wp), parameter :: pi = acos(-1.0_wp)

contains

  !> A search that starts at the nearest sample of all elements; at the first element's where no squared distance is a number.
  pure function start_nearest(surface, hulls, x) result(here)
    type(surface_t), intent(in) :: surface
    type(hulls_t), intent(in) :: hulls
    real(wp), intent(in) :: x(3)
    type(search_t) :: here
    real(wp) :: least, square, xi(2)
    integer :: e

    least = huge(1.0_wp)
    do e = 1, surface_element_count(surface)
      call nearest_sample(surface, hulls, e, x, xi, square)
      if (e > 1 .and. .not. square < least) cycle
      least = square
      here%place = surface_element_of(surface, e)
      here%xi = xi
    end do
    if (contracts) call require(all(is_index(here%place, surface%direction%elements)), "start_nearest: there is such an element")
  end function start_nearest

  !> Search the elements of a `list` (number) that may hold a nearer point than the one found, and go on from there: first from
  !> what samples are nearer, then in all elements that may still hold one (theory 3.1).
  pure subroutine look_round(surface, hulls, positions, x, list, here, work)
    type(surface_t), intent(in) :: surface
    type(hulls_t), intent(in) :: hulls
    real(wp), intent(in) :: positions(:, :), x(3)
    integer, intent(in) :: list(:)
    type(search_t), intent(inout) :: here
    type(work_t), intent(inout) :: work
    type(search_t) :: there
    real(wp) :: square
    integer, allocatable :: near(:)
    integer :: count, k

    if (contracts) call require(all(is_index(list, surface_element_count(surface))), "look_round: there are such elements")
    allocate (near(size(list)))
    count = 0
    do k = 1, size(list)
      if (is_settled(surface, hulls, list(k), x, here)) cycle
      count = count + 1
      near(count) = list(k)
      there%place = surface_element_of(surface, list(k))
      call nearest_sample(surface, hulls, list(k), x, there%xi, square)
      if (square < 2.0_wp * here%distance) call go_on(surface, positions, x, there, here, work)
    end do
    do k = 1, count
      if (is_settled(surface, hulls, near(k), x, here)) cycle
      there%place = surface_element_of(surface, near(k))
      if (is_plain(hulls, near(k), here)) then
        call nearest_sample(surface, hulls, near(k), x, there%xi, square)
        call go_on(surface, positions, x, there, here, work)
      else
        call search_thoroughly(surface, positions, x, there%place, here, work)
      end if
    end do
  end subroutine look_round

  !> Whether an element holds no nearer point than the one found: it is farther, or it is that point's own.
  pure logical function is_settled(surface, hulls, e, x, here)
    type(surface_t), intent(in) :: surface
    type(hulls_t), intent(in) :: hulls
    integer, intent(in) :: e
    real(wp), intent(in) :: x(3)
    type(search_t), intent(in) :: here
    integer :: place(2)

    place = surface_element_of(surface, e)
    is_settled = all(place == here%place .or. (here%fixed .and. place == mod(here%place, surface%direction%elements) + 1))
    if (is_settled) is_settled = is_plain(hulls, e, here)
    if (.not. is_settled) is_settled = is_farther(hulls, e, x, here%way, sqrt(2.0_wp * here%distance))
  end function is_settled

  !> Whether a point at the distance of the one found has one near point alone in an element (theory 3.17).
  pure logical function is_plain(hulls, e, here)
    type(hulls_t), intent(in) :: hulls
    integer, intent(in) :: e
    type(search_t), intent(in) :: here

    is_plain = sqrt(2.0_wp * here%distance) * hulls%curvature(e) < safe_bend
  end function is_plain

  !> Search the element of a start, and go on from where that ends if it is better.
  pure subroutine go_on(surface, positions, x, start, here, work)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: positions(:, :), x(3)
    type(search_t), intent(in) :: start
    type(search_t), intent(inout) :: here
    type(work_t), intent(inout) :: work
    type(search_t) :: there

    there = start
    call search_element(surface, positions, x, there, work)
    if (.not. is_preferred(surface, there, here)) return
    here = there
    call descend(surface, positions, x, here, work)
  end subroutine go_on

  !> Search an element that may hold several near points, from places of a fine grid (Chebyshev's: denser at the bounds)
  !> that are lowest along one of its lines and not farther than the point found by more than the way to their neighbours.
  pure subroutine search_thoroughly(surface, positions, x, place, here, work)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: positions(:, :), x(3)
    integer, intent(in) :: place(2)
    type(search_t), intent(inout) :: here
    type(work_t), intent(inout) :: work
    type(search_t) :: there
    real(wp) :: square(0:grid_size(surface, 1) + 1, 0:grid_size(surface, 2) + 1), xi(2, size(square, 1), size(square, 2))
    real(wp) :: net(4, surface%direction(1)%order + 1, surface%direction(2)%order + 1), s(3, 6), share(2)
    real(wp) :: point(3, size(square, 1) - 2, size(square, 2) - 2)
    integer :: a, i, j

    call homogeneous_net(surface, positions, place, net)
    square = huge(1.0_wp)
    do j = 1, ubound(square, 2) - 1
      do i = 1, ubound(square, 1) - 1
        share = 0.5_wp - 0.5_wp * cos(pi * real([i, j] - 1, wp) / real(ubound(square) - 2, wp))
        do a = 1, 2
          associate (boundary => surface%direction(a)%boundary)
            xi(a, i, j) = boundary(place(a) - 1) + share(a) * (boundary(place(a)) - boundary(place(a) - 1))
          end associate
        end do
        call surface_point(surface, place, net, xi(:, i, j), s)
        call evaluate(2, 1, work)
        point(:, i, j) = s(:, 1)
        square(i, j) = sum((x - s(:, 1))**2)
      end do
    end do
    do j = 1, ubound(square, 2) - 1
      do i = 1, ubound(square, 1) - 1
        if (square(i, j) > minval(square(i - 1:i + 1, j)) .and. square(i, j) > minval(square(i, j - 1:j + 1))) cycle
        if (sqrt(square(i, j)) > sqrt(2.0_wp * here%distance) + way_to_neighbours(point, i, j)) cycle
        there%place = place
        there%xi = xi(:, i, j)
        call go_on(surface, positions, x, there, here, work)
      end do
    end do
  end subroutine search_thoroughly

  !> The longest way from a point of a grid to one beside it.
  pure real(wp) function way_to_neighbours(point, i, j) result(longest)
    real(wp), intent(in) :: point(:, :, :)
    integer, intent(in) :: i, j
    integer :: k

    longest = 0.0_wp
    do k = max(i - 1, 1), min(i + 1, size(point, 2))
      longest = max(longest, norm2(point(:, k, j) - point(:, i, j)))
    end do
    do k = max(j - 1, 1), min(j + 1, size(point, 3))
      longest = max(longest, norm2(point(:, i, k) - point(:, i, j)))
    end do
  end function way_to_neighbours

  !> Points along a direction of the grid in an element that is searched thoroughly.
  pure integer function grid_size(surface, direction)
    type(surface_t), intent(in) :: surface
    integer, intent(in) :: direction

    grid_size = surface%direction(direction)%order + 6
  end function grid_size

  !> Whether a foot is nearer than another one, or as near and lower.
  pure logical function is_preferred(surface, there, here)
    type(surface_t), intent(in) :: surface
    type(search_t), intent(in) :: there, here

    is_preferred = there%distance < here%distance * (1.0_wp - tie)
    if (.not. is_preferred .and. there%settled .and. all(there%pressing == 0)) then
      is_preferred = there%distance <= here%distance * (1.0_wp + tie)
      if (is_preferred) is_preferred = is_lower(surface, there, here)
    end if
  end function is_preferred

  !> Whether a foot is in a lower element than another one, or in the same at lower coordinates; the second direction counts first.
  pure logical function is_lower(surface, there, here)
    type(surface_t), intent(in) :: surface
    type(search_t), intent(in) :: there, here
    real(wp) :: low(2), length(2), off(2)
    integer :: a

    call element_span(surface, here%place, low, length)
    off = merge(there%xi - here%xi, 0.0_wp, abs(there%xi - here%xi) > tie_apart * length)
    where (there%place /= here%place) off = real(there%place - here%place, wp)
    a = merge(2, 1, abs(off(2)) > 0.0_wp)
    is_lower = off(a) < 0.0_wp
  end function is_lower

  !> Whether a point is behind the surface by more than its body's depth below the foot: `deep` (theory 3.19).
  pure subroutine find_too_deep(surface, opposite, positions, here, deep, work)
    type(surface_t), intent(in) :: surface, opposite
    real(wp), intent(in) :: positions(:, :)
    type(search_t), intent(in) :: here
    logical, intent(out) :: deep
    type(work_t), intent(inout) :: work
    real(wp) :: square

    deep = surface%outward * dot_product(here%way, here%across) > 0.0_wp
    if (.not. deep) return
    call square_depth(surface, opposite, positions, here%place, here%xi, square, work)
    deep = 2.0_wp * here%distance > square
  end subroutine find_too_deep

  !> The `square` of the depth of the body below a place of its surface, L^2 (theory 3.19).
  pure subroutine square_depth(surface, opposite, positions, place, xi, square, work)
    type(surface_t), intent(in) :: surface, opposite
    real(wp), intent(in) :: positions(:, :), xi(2)
    integer, intent(in) :: place(2)
    real(wp), intent(out) :: square
    type(work_t), intent(inout) :: work
    real(wp) :: net(4, surface%direction(1)%order + 1, surface%direction(2)%order + 1), near(3, 6), far(3, 6)

    call homogeneous_net(surface, positions, place, net)
    call surface_point(surface, place, net, xi, near)
    call homogeneous_net(opposite, positions, place, net)
    call surface_point(opposite, place, net, xi, far)
    square = sum((far(:, 1) - near(:, 1))**2)
    call evaluate(2, 2, work)
  end subroutine square_depth

  !> Distance from a surface up to which its body is deep enough anywhere: a share of the least distance of its control points from
  !> those across the body (theory 3.19).
  pure real(wp) function shallow_depth(surface, opposite, positions)
    type(surface_t), intent(in) :: surface, opposite
    real(wp), intent(in) :: positions(:, :)
    integer :: a

    shallow_depth = huge(1.0_wp)
    do a = 1, size(surface%point)
      shallow_depth = min(shallow_depth, norm2(positions(:, surface%point(a)) - positions(:, opposite%point(a))))
    end do
    shallow_depth = shallow_share * shallow_depth
  end function shallow_depth

end module isomortar_contact_projection
