!> Where the elements of a surface can be at most: convex hulls of their Bezier points, in oriented boxes, in spheres.
!>
!> A point that is farther from a sphere, box or hull than from some point of the surface has no nearer point in that element.
!>
!> - `surface`, `hulls`: the face, and the hulls of its elements. `positions` (3, control points): of all control points, L.
!> - `x`: place of a point, L. `e`: an element, from 1. `distance`: L.
module isomortar_contact_hulls
  use isomortar_base_algebra, only: cross, identity
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_index
  use isomortar_nurbs_direction, only: basis, direction_t
  use isomortar_nurbs_surface, only: homogeneous_net, surface_element_count, surface_element_of, surface_t
  implicit none
  private

  public :: enclose, is_farther, nearest_sample, within_reach

  !> Hulls of all elements of a surface at given positions, by element.
  type, public :: hulls_t
    !> Spheres: centres, shape (elements, 3), and radii.
    real(wp), allocatable :: centre(:, :), radius(:)
    !> Boxes about the same centres: unit vectors (rows), shape (3, 3, elements), and half lengths along them, (3, elements).
    real(wp), allocatable :: frame(:, :, :), half(:, :)
    !> Bezier points, shape (3, points of an element, elements).
    real(wp), allocatable :: corner(:, :, :)
    !> Points of the surface on a regular grid from bound to bound, as many.
    real(wp), allocatable :: sample(:, :, :)
    !> Largest curvature by the second differences of the Bezier points.
    real(wp), allocatable :: curvature(:)
  end type hulls_t

  !> Boxes are larger by this share: round-off of the Bezier points of high orders.
  real(wp), parameter :: margin = epsilon(1.0_wp)**0.625_wp

contains

  !> Hulls of the elements of a surface.
  pure subroutine enclose(surface, positions, hulls)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: positions(:, :)
    type(hulls_t), intent(out) :: hulls
    real(wp) :: net(4, surface%direction(1)%order + 1, surface%direction(2)%order + 1)
    integer :: e, elements, place(2), points(2)
    real(wp), allocatable :: functions1(:, :, :), functions2(:, :, :), bezier1(:, :), bezier2(:, :)

    elements = surface_element_count(surface)
    points = surface%direction%order + 1
    if (contracts) call require(all(is_index(surface%point, size(positions, 2))), "enclose: the surface is among the positions")
    allocate (hulls%centre(elements, 3), hulls%radius(elements), hulls%frame(3, 3, elements), hulls%half(3, elements))
    allocate (hulls%corner(3, product(points), elements), hulls%sample(3, product(points), elements), hulls%curvature(elements))
    functions1 = functions_on_grid(surface%direction(1))
    functions2 = functions_on_grid(surface%direction(2))
    bezier1 = bezier_from_grid(points(1))
    bezier2 = bezier_from_grid(points(2))
    do e = 1, elements
      place = surface_element_of(surface, e)
      call homogeneous_net(surface, positions, place, net)
      call bezier_points(net, functions1(:, :, place(1)), functions2(:, :, place(2)), bezier1, bezier2, hulls%sample(:, :, e), &
        hulls%corner(:, :, e))
      call put_in_box(points, e, hulls)
      hulls%curvature(e) = largest_curvature(points, hulls%corner(:, :, e))
    end do
  end subroutine enclose

  !> The functions of every element of a direction (first index) on the grid (second).
  pure function functions_on_grid(direction) result(functions)
    type(direction_t), intent(in) :: direction
    real(wp), allocatable :: functions(:, :, :)
    integer :: e, k, p

    p = direction%order
    allocate (functions(p + 1, p + 1, direction%elements))
    do e = 1, direction%elements
      do k = 0, p
        associate (low => direction%boundary(e - 1), high => direction%boundary(e))
          call basis(direction, e, low + (high - low) * real(k, wp) / real(p, wp), 0, functions(:, k + 1:k + 1, e))
        end associate
      end do
    end do
  end function functions_on_grid

  !> Bezier coefficients of a polynomial (rows) from its values at n points of a regular grid: the inverse of Bernstein's functions.
  pure function bezier_from_grid(n) result(inverse)
    integer, intent(in) :: n
    real(wp) :: inverse(n, n)
    real(wp) :: values(n, n), factor
    integer :: i, k, row

    inverse = 0.0_wp
    do k = 1, n
      values(k, 1) = 1.0_wp
      do i = 1, n - 1 ! de Casteljau's triangle, backwards: functions of order i from those of order i - 1
        associate (t => real(k - 1, wp) / real(n - 1, wp))
          values(k, i + 1) = t * values(k, i)
          do row = i, 2, -1
            values(k, row) = (1.0_wp - t) * values(k, row) + t * values(k, row - 1)
          end do
          values(k, 1) = (1.0_wp - t) * values(k, 1)
        end associate
      end do
      inverse(k, k) = 1.0_wp
    end do
    do k = 1, n ! Gauss and Jordan; the matrix is totally positive and needs no pivots
      factor = 1.0_wp / values(k, k)
      values(k, :) = factor * values(k, :)
      inverse(k, :) = factor * inverse(k, :)
      do row = 1, n
        if (row == k) cycle
        factor = values(row, k)
        values(row, :) = values(row, :) - factor * values(k, :)
        inverse(row, :) = inverse(row, :) - factor * inverse(k, :)
      end do
    end do
  end function bezier_from_grid

  !> Points of an element on the grid, and its Bezier points, by products in each direction of the homogeneous form.
  pure subroutine bezier_points(net, functions1, functions2, bezier1, bezier2, sample, corner)
    real(wp), intent(in) :: net(:, :, :), functions1(:, :), functions2(:, :), bezier1(:, :), bezier2(:, :)
    real(wp), intent(out) :: sample(:, :), corner(:, :)
    real(wp), dimension(4, size(net, 2), size(net, 3)) :: grid, bezier, part
    integer :: i, j, k

    part = 0.0_wp
    grid = 0.0_wp
    do j = 1, size(net, 3)
      do k = 1, size(net, 2)
        do i = 1, size(net, 2)
          part(:, i, j) = part(:, i, j) + functions1(k, i) * net(:, k, j)
        end do
      end do
    end do
    do k = 1, size(net, 3)
      do j = 1, size(net, 3)
        grid(:, :, j) = grid(:, :, j) + functions2(k, j) * part(:, :, k)
      end do
    end do
    part = 0.0_wp
    bezier = 0.0_wp
    do j = 1, size(net, 3)
      do k = 1, size(net, 2)
        do i = 1, size(net, 2)
          part(:, i, j) = part(:, i, j) + bezier1(i, k) * grid(:, k, j)
        end do
      end do
    end do
    do k = 1, size(net, 3)
      do j = 1, size(net, 3)
        bezier(:, :, j) = bezier(:, :, j) + bezier2(j, k) * part(:, :, k)
      end do
    end do
    k = 0
    do j = 1, size(net, 3)
      do i = 1, size(net, 2)
        k = k + 1
        sample(:, k) = grid(1:3, i, j) / grid(4, i, j)
        corner(:, k) = bezier(1:3, i, j) / bezier(4, i, j)
      end do
    end do
  end subroutine bezier_points

  !> Box and sphere of element e, along the diagonals of its corners.
  pure subroutine put_in_box(points, e, hulls)
    integer, intent(in) :: points(2), e
    type(hulls_t), intent(inout) :: hulls
    real(wp) :: local(3, product(points)), low(3), high(3), normal(3), first(3), along(3), frame(3, 3)

    associate (corner => hulls%corner(:, :, e), n => product(points))
      first = corner(:, n) - corner(:, 1)
      normal = cross(first, corner(:, n - points(1) + 1) - corner(:, points(1)))
      along = corner(:, points(1)) - corner(:, 1) + corner(:, n) - corner(:, n - points(1) + 1)
      frame = identity
      if (norm2(normal) > margin * dot_product(first, first)) then
        normal = normal / norm2(normal)
        along = along - dot_product(along, normal) * normal
        if (norm2(along) > margin * norm2(first)) then
          along = along / norm2(along)
          frame = transpose(reshape([along, cross(normal, along), normal], [3, 3]))
        end if
      end if
      local = matmul(frame, corner)
      low = minval(local, 2)
      high = maxval(local, 2)
      hulls%frame(:, :, e) = frame
      hulls%centre(e, :) = matmul(0.5_wp * (low + high), frame)
      hulls%half(:, e) = 0.5_wp * (high - low)
      hulls%half(:, e) = hulls%half(:, e) + margin * maxval(hulls%half(:, e))
      hulls%radius(e) = norm2(hulls%half(:, e))
    end associate
  end subroutine put_in_box

  !> A bound of the curvature (theory 3.17): second differences of the Bezier points over the product of first differences, these
  !> along their means.
  pure real(wp) function largest_curvature(points, corner) result(curvature)
    integer, intent(in) :: points(2)
    real(wp), intent(in) :: corner(:, :)
    real(wp) :: along(2), bend(3), mean(3, 2)
    integer :: i, j, k, m

    m = points(1)
    k = product(points)
    mean(:, 1) = corner(:, m) - corner(:, 1) + corner(:, k) - corner(:, k - m + 1)
    mean(:, 2) = corner(:, k - m + 1) - corner(:, 1) + corner(:, k) - corner(:, m)
    along = huge(1.0_wp)
    bend = 0.0_wp
    do j = 1, points(2)
      do i = 1, m
        k = i + m * (j - 1)
        if (i > 1) along(1) = min(along(1), dot_product(mean(:, 1), corner(:, k) - corner(:, k - 1)))
        if (j > 1) along(2) = min(along(2), dot_product(mean(:, 2), corner(:, k) - corner(:, k - m)))
        if (i > 2) bend(1) = max(bend(1), sum((corner(:, k) - 2.0_wp * corner(:, k - 1) + corner(:, k - 2))**2))
        if (j > 2) bend(3) = max(bend(3), sum((corner(:, k) - 2.0_wp * corner(:, k - m) + corner(:, k - 2 * m))**2))
        if (i == 1 .or. j == 1) cycle
        bend(2) = max(bend(2), sum((corner(:, k) - corner(:, k - 1) - corner(:, k - m) + corner(:, k - m - 1))**2))
      end do
    end do
    curvature = huge(1.0_wp)
    if (.not. all(along > 0.0_wp)) return
    along = real(points - 1, wp) * along / norm2(mean, 1)
    associate (p => real(points - 1, wp))
      bend = sqrt(bend) * [p(1) * (p(1) - 1.0_wp), product(p), p(2) * (p(2) - 1.0_wp)]
    end associate
    curvature = maxval(bend / [along(1)**2, product(along), along(2)**2])
  end function largest_curvature

  !> Elements whose spheres come nearer than `distance` to a point: the first `count` of `list` (elements).
  pure subroutine within_reach(hulls, x, distance, list, count)
    type(hulls_t), intent(in) :: hulls
    real(wp), intent(in) :: x(3), distance
    integer, intent(inout) :: list(:)
    integer, intent(out) :: count
    logical, allocatable :: near(:)
    integer :: e

    allocate (near(size(hulls%radius)))
    near(:) = (x(1) - hulls%centre(:, 1))**2 + (x(2) - hulls%centre(:, 2))**2 + (x(3) - hulls%centre(:, 3))**2 &
      <= (distance + hulls%radius)**2
    count = 0
    do e = 1, size(near)
      if (.not. near(e)) cycle
      count = count + 1
      list(count) = e
    end do
    if (contracts) call require(all(is_index(list(:count), size(hulls%radius))), "within_reach: elements are those with hulls")
  end subroutine within_reach

  !> Whether no point of element e is nearer to x than `distance`: by its sphere, by its box, then by planes, the first one across
  !> the way to a foot at x + `toward`.
  pure logical function is_farther(hulls, e, x, toward, distance) result(farther)
    type(hulls_t), intent(in) :: hulls
    integer, intent(in) :: e
    real(wp), intent(in) :: x(3), toward(3), distance
    real(wp) :: d(3), beyond(3)

    d = x - hulls%centre(e, :)
    farther = dot_product(d, d) >= (distance + hulls%radius(e))**2
    if (farther) return
    beyond = max(abs(matmul(hulls%frame(:, :, e), d)) - hulls%half(:, e), 0.0_wp)
    farther = dot_product(beyond, beyond) >= distance**2
    if (.not. farther) farther = is_behind_plane(hulls%corner(:, :, e), x, toward, distance)
  end function is_farther

  !> Whether a plane across some way from x, at least so far away, has all corners of a hull behind it (Gilbert's method).
  pure logical function is_behind_plane(corner, x, toward, distance) result(behind)
    real(wp), intent(in) :: corner(:, :), x(3), toward(3), distance
    real(wp) :: d(3), way(3), depth(size(corner, 2))
    integer :: attempt

    behind = .false.
    way = toward
    do attempt = 1, 6
      if (.not. dot_product(way, way) > 0.0_wp) return
      depth = matmul(way / norm2(way), corner) - dot_product(way / norm2(way), x)
      behind = minval(depth) >= distance
      if (behind) return
      d = corner(:, minloc(depth, 1)) - x
      if (attempt > 1) d = nearest_on_way(way, d)
      way = d
      if (dot_product(way, way) < distance**2) return
    end do
  end function is_behind_plane

  !> The point nearest to the origin on the way from a to b.
  pure function nearest_on_way(a, b) result(nearest)
    real(wp), intent(in) :: a(3), b(3)
    real(wp) :: nearest(3), square

    square = dot_product(b - a, b - a)
    nearest = b
    if (square > 0.0_wp) nearest = a + min(max(dot_product(a, a - b) / square, 0.0_wp), 1.0_wp) * (b - a)
  end function nearest_on_way

  !> Coordinates `xi`, P, of the sample of element `e` that is nearest to `x`, and the `square` of its distance, L^2.
  pure subroutine nearest_sample(surface, hulls, e, x, xi, square)
    type(surface_t), intent(in) :: surface
    type(hulls_t), intent(in) :: hulls
    integer, intent(in) :: e
    real(wp), intent(in) :: x(3)
    real(wp), intent(out) :: xi(2), square
    real(wp) :: squares(size(hulls%sample, 2))
    integer :: a, grid(2), k, place(2)

    squares = (hulls%sample(1, :, e) - x(1))**2 + (hulls%sample(2, :, e) - x(2))**2 + (hulls%sample(3, :, e) - x(3))**2
    k = minloc(squares, 1)
    square = squares(k)
    grid = [mod(k - 1, surface%direction(1)%order + 1), (k - 1) / (surface%direction(1)%order + 1)]
    place = surface_element_of(surface, e)
    do a = 1, 2
      associate (boundary => surface%direction(a)%boundary, share => real(grid(a), wp) / real(surface%direction(a)%order, wp))
        xi(a) = boundary(place(a) - 1) + (boundary(place(a)) - boundary(place(a) - 1)) * share
      end associate
    end do
  end subroutine nearest_sample

end module isomortar_contact_hulls
