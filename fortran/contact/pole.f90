!> Poles of a master: edges of one control point, round which the surface is closed. There a coordinate has no length.
!>
!> Feet beside a pole are as any others, if what is a difference of nearly equal numbers there is formed about the pole itself. At
!> the pole the foot is the control point, as on a corner of C0 lines: the pole of a body that deforms is a cone's vertex.
!>
!> - `surface`, `positions` (3, control points): the face; all control points, L.
!> - `place`, `xi`: an element by direction, from 1, and coordinates in it, P. `x`: place of a slave point, L.
!> - `pole`: a for that at the end of direction a, -a at its start. `work`: counts of what is done.
module isomortar_contact_pole
  use isomortar_base_algebra, only: cross
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_unit
  use isomortar_contact_gap_map_map, only: contact_point_t
  use isomortar_contact_work, only: evaluate, work_t
  use isomortar_nurbs_surface, only: homogeneous_net, surface_point, surface_t
  implicit none
  private

  public :: gather_at_pole, hold_at_pole, is_at_pole, look_from_pole, net_about_pole, pole_bound, pole_of

  !> Share of the distance by which it has to fall along a tangent from the pole: less is round-off.
  real(wp), parameter :: least_fall = 16.0_wp * epsilon(1.0_wp)
  !> The pole is a vertex if the distance rises by more than this share all round, or is off the normal by more; else it is smooth.
  real(wp), parameter :: sharp = sqrt(epsilon(1.0_wp))

  !> What a point sees of a surface from its pole.
  type, public :: view_t
    !> The pole, and the mean of the unit normals about it along a_1 x a_2.
    real(wp) :: centre(3), across(3)
    !> The most that the distance falls along unit tangents from the pole (times the distance); place and coordinates of that.
    real(wp) :: fall
    integer :: place(2)
    real(wp) :: xi(2)
    !> Least curvature of the distance along those tangents: one near the surface, zero or less beyond its centre of curvature.
    real(wp) :: bend
    !> Whether it is a vertex where the distance falls along none of them.
    logical :: vertex
  end type view_t

contains

  !> The pole of an element, 0: none. Of two the one that is nearer to `xi`.
  pure integer function pole_of(surface, place, xi) result(pole)
    type(surface_t), intent(in) :: surface
    integer, intent(in) :: place(2)
    real(wp), intent(in) :: xi(2)
    integer :: a

    pole = 0
    if (.not. any(surface%pole)) return
    do a = 1, 2
      if (surface%pole(1, a) .and. place(a) == 1) pole = -a
      if (.not. (surface%pole(2, a) .and. place(a) == surface%direction(a)%elements)) cycle
      if (pole == -a .and. xi(a) - pole_bound(surface, -a) < pole_bound(surface, a) - xi(a)) cycle
      pole = a
    end do
  end function pole_of

  !> The coordinate at which a pole is.
  pure real(wp) function pole_bound(surface, pole) result(bound)
    type(surface_t), intent(in) :: surface
    integer, intent(in) :: pole

    associate (direction => surface%direction(abs(pole)))
      bound = direction%boundary(merge(0, direction%elements, pole < 0))
    end associate
  end function pole_bound

  !> Whether coordinates are those of a pole.
  pure logical function is_at_pole(surface, place, xi) result(is)
    type(surface_t), intent(in) :: surface
    integer, intent(in) :: place(2)
    real(wp), intent(in) :: xi(2)
    integer :: pole

    pole = pole_of(surface, place, xi)
    is = pole /= 0
    if (is) is = .not. abs(xi(abs(pole)) - pole_bound(surface, pole)) > 0.0_wp
  end function is_at_pole

  !> Number, within the surface, of the first control point of a pole.
  pure integer function pole_node(surface, pole) result(node)
    type(surface_t), intent(in) :: surface
    integer, intent(in) :: pole

    node = 1
    if (pole == 1) node = surface%direction(1)%count
    if (pole == 2) node = size(surface%point)
  end function pole_node

  !> Count an element's `net` (4, functions of u, functions of v) from the pole, at `centre`, L, in homogeneous form: what is left
  !> there is exactly nothing.
  pure subroutine net_about_pole(surface, positions, pole, net, centre)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: positions(:, :)
    integer, intent(in) :: pole
    real(wp), intent(inout) :: net(:, :, :)
    real(wp), intent(out) :: centre(3)
    integer :: i

    centre = positions(:, surface%point(pole_node(surface, pole)))
    do i = 1, 3
      net(i, :, :) = net(i, :, :) - net(4, :, :) * centre(i)
    end do
  end subroutine net_about_pole

  !> Give the `functions` (functions of an element, derivatives) of the pole's row, which all belong to one control point, to the
  !> first one of them: what the others leave of one, and of zero.
  pure subroutine gather_at_pole(surface, pole, functions)
    type(surface_t), intent(in) :: surface
    integer, intent(in) :: pole
    real(wp), intent(inout) :: functions(:, :)
    integer :: a, k, row(merge(surface%direction(2)%order, surface%direction(1)%order, abs(pole) == 1) + 1)

    associate (points => surface%direction%order + 1)
      a = merge(1, points(1), abs(pole) == 2)
      row = [(1 + a * (k - 1), k = 1, size(row))]
      if (pole > 0) row = row + merge(points(1) * (points(2) - 1), points(1) - 1, pole == 2)
    end associate
    functions(row, :) = 0.0_wp
    functions(row(1), :) = -sum(functions, 1)
    functions(row(1), 1) = 1.0_wp + functions(row(1), 1)
  end subroutine gather_at_pole

  !> What a point sees from the pole, looking along lines of all elements round it: `view` (theory 3.11).
  pure subroutine look_from_pole(surface, positions, x, pole, view, work)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: positions(:, :), x(3)
    integer, intent(in) :: pole
    type(view_t), intent(out) :: view
    type(work_t), intent(inout) :: work
    real(wp) :: net(4, surface%direction(1)%order + 1, surface%direction(2)%order + 1), s(3, 6), inwards(3), xi(2), normal(3)
    integer :: across, e, k, place(2), round

    across = abs(pole)
    round = 3 - across
    place(across) = merge(1, surface%direction(across)%elements, pole < 0)
    xi(across) = pole_bound(surface, pole)
    view%fall = -huge(1.0_wp)
    view%bend = huge(1.0_wp)
    view%across = 0.0_wp
    associate (direction => surface%direction(round))
      do e = 1, direction%elements
        place(round) = e
        call homogeneous_net(surface, positions, place, net)
        call net_about_pole(surface, positions, pole, net, view%centre)
        do k = 0, 2 * direction%order
          xi(round) = direction%boundary(e - 1) + (direction%boundary(e) - direction%boundary(e - 1)) * real(k, wp) &
            / real(2 * direction%order, wp)
          call surface_point(surface, place, net, xi, s)
          call evaluate(2, 1, work)
          inwards = sign(1.0_wp, -real(pole, wp)) * s(:, 1 + across)
          normal = cross(s(:, 5), s(:, 1 + across)) ! a_1 grows with S,12 from a pole of direction 2, a_2 from one of direction 1
          if (across == 1) normal = -normal
          view%across = view%across + sign(1.0_wp, -real(pole, wp)) * normal / norm2(normal)
          associate (fall => dot_product(x - view%centre, inwards) / norm2(inwards), square => dot_product(inwards, inwards))
            if (fall > view%fall) then
              view%fall = fall
              view%place = place
              view%xi = xi
            end if
            view%bend = min(view%bend, 1.0_wp - dot_product(x - view%centre, s(:, merge(4, 6, across == 1))) / square)
          end associate
        end do
      end do
    end associate
    view%across = view%across / norm2(view%across)
    associate (distance => norm2(x - view%centre))
      if (view%fall < least_fall * distance) view%fall = min(view%fall, 0.0_wp)
      ! on the boundary of a vertex's cone it is level along one line alone: then the way is not that of the normals all round
      view%vertex = max(-view%fall, norm2(cross(x - view%centre, view%across))) > sharp * distance
    end associate
  end subroutine look_from_pole

  !> Kinematics of a foot at a pole, `point` (theory 3.11): it stays the foot of what moves about it if the distance rises in all
  !> directions.
  pure subroutine hold_at_pole(surface, positions, x, pole, point, work)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: positions(:, :), x(3)
    integer, intent(in) :: pole
    type(contact_point_t), intent(inout) :: point
    type(work_t), intent(inout) :: work
    type(view_t) :: view
    real(wp) :: d(3)

    if (contracts) call require(pole /= 0, "hold_at_pole: there is a pole")
    call look_from_pole(surface, positions, x, pole, view, work)
    d = x - view%centre
    point%surface = 0.0_wp
    point%surface(:, 1) = view%centre
    point%fixed = .true.
    point%turns = view%vertex
    point%normal = surface%outward * view%across
    if (point%turns) point%normal = sign(1.0_wp, dot_product(d, point%normal)) * d / norm2(d)
    if (contracts) call require(is_unit(point%normal), "hold_at_pole: the normal is a unit vector")
    point%gap = -dot_product(d, point%normal)
    point%tangent = 0.0_wp
    point%metric = 0.0_wp
    point%inverse_metric = 0.0_wp
    point%curvature = 0.0_wp
    point%inverse_h = 0.0_wp
  end subroutine hold_at_pole

end module isomortar_contact_pole
