!> Feet of slave points along the averaged normal of a master (theory 3.24, 3.30).
!>
!> Newton's method on coordinates and gap. Within an element the equation is smooth, from one to the next it is continuous: the path
!> of Newton's steps is followed through the elements that it crosses.
!>
!> - `surface`: the face. `positions` (3, control points and nodes): of all control points, L; normals of its nodes at the end.
!> - `x`, `across`: place of a slave point, L, and its unit normal. `xi`: coordinates of a start, P.
!> - `scope`, `foot`: where feet are looked for, and one that is found, or not. `work`: counts of what is done.
module isomortar_contact_gap_map_averaged_foot
  use isomortar_base_algebra, only: determinant, inverse, weighted_sums
  use isomortar_base_kinds, only: wp
  use isomortar_contact_work, only: evaluate, work_t
  use isomortar_nurbs_direction, only: element_at
  use isomortar_nurbs_surface, only: element_span, first_bound, step_across, surface_basis, surface_element_count, &
    surface_element_of, surface_nodes, surface_t
  implicit none
  private

  public :: accept, find_foot, follow, foot_equation, scope_of

  !> Relative size of the last Newton step: its error is the square of that.
  real(wp), parameter :: last_step = epsilon(1.0_wp)**0.6_wp
  !> Share of an element within which a place is on its bound but for round-off.
  real(wp), parameter :: on_bound = 64.0_wp * epsilon(1.0_wp)
  !> Share of the lengths below which the equation's determinant is none.
  real(wp), parameter :: flat = epsilon(1.0_wp)**0.75_wp
  !> Steps of Newton's method, or into neighbours, at most; in an element alone.
  integer, parameter :: most_steps = 60, most_inside = 16
  !> Cosine of the angle between the normals of both sides above which there is contact.
  real(wp), parameter :: least_facing = 0.2_wp
  !> Gaps, as shares of the master's size, up to which feet are found: open, and closed.
  real(wp), parameter :: open_share = 0.5_wp, deep_share = 0.1_wp

  !> Where a search stands.
  type, public :: foot_t
    logical :: found
    integer :: place(2)
    real(wp) :: xi(2)
    real(wp) :: gap
    real(wp) :: normal(3)
  end type foot_t

  !> Where feet are looked for: largest gaps, and by element a sphere about its control points and their normals' mean and spread.
  type, public :: scope_t
    real(wp) :: deepest, widest
    real(wp), allocatable :: centre(:, :), radius(:), mean(:, :), spread(:)
  end type scope_t

contains

  !> Where to look for feet on a face (theory 3.30).
  pure function scope_of(surface, positions) result(self)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: positions(:, :)
    type(scope_t) :: self
    integer :: a, e, elements, nodes(product(surface%direction%order + 1)), normals
    real(wp) :: high(3), low(3), size_of_master

    elements = surface_element_count(surface)
    normals = size(positions, 2) - size(surface%point)
    allocate (self%centre(3, elements), self%radius(elements), self%mean(3, elements), self%spread(elements))
    high = -huge(high)
    low = huge(low)
    do a = 1, size(surface%point)
      high = max(high, positions(:, surface%point(a)))
      low = min(low, positions(:, surface%point(a)))
    end do
    size_of_master = norm2(high - low)
    self%deepest = deep_share * size_of_master
    self%widest = open_share * size_of_master
    do e = 1, elements
      call surface_nodes(surface, surface_element_of(surface, e), nodes)
      self%centre(:, e) = sum(positions(:, surface%point(nodes)), 2) / size(nodes)
      self%mean(:, e) = sum(positions(:, normals + nodes), 2) / size(nodes)
      self%radius(e) = 0.0_wp
      self%spread(e) = 0.0_wp
      do a = 1, size(nodes)
        self%radius(e) = max(self%radius(e), norm2(positions(:, surface%point(nodes(a))) - self%centre(:, e)))
        self%spread(e) = max(self%spread(e), norm2(positions(:, normals + nodes(a)) - self%mean(:, e)))
      end do
    end do
  end function scope_of

  !> Whether a foot that was found is one that contact may act at: the sides face each other, and the gap is within the scope
  !> (theory 3.30).
  pure logical function accept(scope, foot, across)
    type(scope_t), intent(in) :: scope
    type(foot_t), intent(in) :: foot
    real(wp), intent(in) :: across(3)

    accept = .false.
    if (.not. foot%found) return
    accept = foot%gap <= scope%deepest .and. foot%gap >= -scope%widest .and. -dot_product(foot%normal, across) > least_facing
  end function accept

  !> Derivative of S - g n by the coordinates and the gap (theory 3.26).
  !>
  !> - `tangents`: S,1 and S,2, L/P. `field`: the normal before it is made a unit vector, and its derivatives, 1/P. `gap`: g, L.
  pure function foot_equation(tangents, field, gap) result(matrix)
    real(wp), intent(in) :: tangents(3, 2), field(3, 3), gap
    real(wp) :: matrix(3, 3)
    real(wp) :: length, normal(3)
    integer :: a

    length = norm2(field(:, 1))
    normal = field(:, 1) / length
    do a = 1, 2
      matrix(:, a) = tangents(:, a) - gap / length * (field(:, 1 + a) - dot_product(normal, field(:, 1 + a)) * normal)
    end do
    matrix(:, 3) = -normal
  end function foot_equation

  !> Newton's step of a foot in its element, and whether there is one. The gap is that along the normal at `foot` at first.
  pure subroutine newton_step(surface, positions, x, foot, step, regular, work)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: positions(:, :), x(3)
    type(foot_t), intent(inout) :: foot
    real(wp), intent(out) :: step(3)
    logical, intent(out) :: regular
    type(work_t), intent(inout) :: work
    integer :: nodes(product(surface%direction%order + 1))
    real(wp) :: away(3), det, equation(3, 3), field(3, 3), functions(size(nodes), 3), s(3, 3)

    call surface_nodes(surface, foot%place, nodes)
    call surface_basis(surface, foot%place, nodes, foot%xi, 1, functions)
    call evaluate(1, 1, work)
    s = weighted_sums(positions, surface%point(nodes), functions)
    field = weighted_sums(positions, size(positions, 2) - size(surface%point) + nodes, functions)
    foot%normal = field(:, 1) / norm2(field(:, 1))
    foot%gap = -dot_product(x - s(:, 1), foot%normal)
    equation = foot_equation(s(:, 2:3), field, foot%gap)
    det = determinant(equation)
    regular = abs(det) > flat * norm2(s(:, 2)) * norm2(s(:, 3))
    step = 0.0_wp
    if (.not. regular) return
    equation = inverse(equation, det)
    away = x - s(:, 1) + foot%gap * foot%normal
    step = matmul(equation, away)
  end subroutine newton_step

  !> From given coordinates along Newton's path to a foot, if it stays on the face (theory 3.30).
  pure subroutine follow(surface, positions, x, xi, foot, work)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: positions(:, :), x(3), xi(2)
    type(foot_t), intent(inout) :: foot
    type(work_t), intent(inout) :: work
    real(wp) :: length(2), low(2), share, step(3)
    integer :: across, k, way(2)
    logical :: regular, within

    foot%place = [element_at(surface%direction(1), xi(1)), element_at(surface%direction(2), xi(2))]
    foot%xi = xi
    foot%found = .false.
    work%elements = work%elements + 1
    do k = 1, most_steps
      call newton_step(surface, positions, x, foot, step, regular, work)
      if (.not. regular) return
      call element_span(surface, foot%place, low, length)
      call first_bound(foot%xi, step(1:2), low, length, share, across)
      if (share < 1.0_wp .and. maxval(abs(step(1:2)) / length) > on_bound) then
        foot%xi = foot%xi + share * step(1:2)
        way = 0
        way(across) = merge(1, -1, step(across) > 0.0_wp)
        call step_across(surface, way, foot%place, foot%xi, within)
        if (.not. within) return
        work%elements = work%elements + 1
        cycle
      end if
      foot%xi = min(max(foot%xi + step(1:2), low), low + length)
      foot%gap = foot%gap + step(3)
      foot%found = maxval(abs(step(1:2)) / length) <= last_step
      if (foot%found) return
    end do
  end subroutine follow

  !> The foot with the smallest gap among those of all elements that may hold one (theory 3.30).
  pure subroutine find_foot(surface, scope, positions, x, across, foot, work)
    type(surface_t), intent(in) :: surface
    type(scope_t), intent(in) :: scope
    real(wp), intent(in) :: positions(:, :), x(3), across(3)
    type(foot_t), intent(out) :: foot
    type(work_t), intent(inout) :: work
    type(foot_t) :: there
    integer :: e

    foot%found = .false.
    foot%place = 0
    foot%xi = 0.0_wp
    foot%gap = huge(1.0_wp)
    foot%normal = 0.0_wp
    do e = 1, surface_element_count(surface)
      if (.not. may_hold(scope, e, x)) cycle
      call search_inside(surface, positions, x, surface_element_of(surface, e), there, work)
      if (.not. accept(scope, there, across)) cycle
      if (abs(there%gap) < abs(foot%gap)) foot = there
    end do
  end subroutine find_foot

  !> Whether an element may hold a foot: normals within their spread come from its sphere to the point.
  pure logical function may_hold(scope, e, x)
    type(scope_t), intent(in) :: scope
    integer, intent(in) :: e
    real(wp), intent(in) :: x(3)
    real(wp) :: arm(3), distance, reach

    arm = x - scope%centre(:, e)
    distance = norm2(arm)
    reach = scope%radius(e) + 2.0_wp * scope%spread(e) * (distance + scope%radius(e))
    may_hold = distance <= scope%radius(e) + max(scope%deepest, scope%widest)
    if (.not. may_hold) return
    associate (axis => scope%mean(:, e) / norm2(scope%mean(:, e)))
      may_hold = norm2(arm - dot_product(arm, axis) * axis) <= reach
    end associate
  end function may_hold

  !> Newton's method in one element from its middle, its surface and normals carried on beyond the bounds; what ends a little beyond
  !> them goes on from there (theory 3.30).
  pure subroutine search_inside(surface, positions, x, place, foot, work)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: positions(:, :), x(3)
    integer, intent(in) :: place(2)
    type(foot_t), intent(out) :: foot
    type(work_t), intent(inout) :: work
    real(wp) :: length(2), low(2), step(3)
    integer :: k
    logical :: regular

    work%elements = work%elements + 1
    call element_span(surface, place, low, length)
    foot%found = .false.
    foot%place = place
    foot%xi = low + 0.5_wp * length
    do k = 1, most_inside
      call newton_step(surface, positions, x, foot, step, regular, work)
      if (.not. regular) return
      foot%xi = foot%xi + step(1:2) / max(1.0_wp, maxval(abs(step(1:2)) / length))
      if (any(abs(foot%xi - low - 0.5_wp * length) > 2.0_wp * length)) return
      if (maxval(abs(step(1:2)) / length) <= sqrt(last_step)) exit
    end do
    if (k > most_inside .or. any(abs(foot%xi - low - 0.5_wp * length) > (0.5_wp + sqrt(last_step)) * length)) return
    call follow(surface, positions, x, min(max(foot%xi, low), low + length), foot, work)
  end subroutine search_inside

end module isomortar_contact_gap_map_averaged_foot
