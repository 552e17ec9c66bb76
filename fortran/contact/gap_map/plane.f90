!> The gap map of a rigid plane (theory 3.4): coordinates are lengths along two unit vectors in it.
module isomortar_contact_gap_map_plane
  use isomortar_base_algebra, only: cross
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_unit
  use isomortar_base_status, only: status_ok
  use isomortar_contact_gap_map_map, only: all_components, contact_point_t, gap_map_t, projections_t, variations_t
  use isomortar_contact_slave, only: slave_position, slave_t
  use isomortar_contact_work, only: count_points, work_t
  implicit none
  private

  public :: plane_through

  type, extends(gap_map_t), public :: plane_t
    real(wp) :: origin(3), normal(3)
    !> Unit vectors of the coordinates.
    real(wp) :: tangent(3, 2)
  contains
    procedure :: bearing
    procedure :: vectors
    procedure :: locate
    procedure :: slip => find_slip
    procedure :: at
    procedure, nopass :: first
    procedure, nopass :: metric
    procedure, nopass :: second
  end type plane_t

contains

  !> Rigid plane through a `point`, L; `normal` and first `tangent` are made orthonormal (theory 3.4).
  pure function plane_through(point, normal, tangent) result(self)
    real(wp), intent(in) :: point(3), normal(3), tangent(3)
    type(plane_t) :: self

    self%bends = .false.
    self%origin = point
    self%normal = normal / norm2(normal)
    self%tangent(:, 1) = tangent - dot_product(tangent, self%normal) * self%normal
    self%tangent(:, 1) = self%tangent(:, 1) / norm2(self%tangent(:, 1))
    self%tangent(:, 2) = cross(self%normal, self%tangent(:, 1))
    if (contracts) call require(is_unit(self%normal) .and. is_unit(self%tangent(:, 2)), "plane_through: unit vectors across")
  end function plane_through

  !> None: the plane is rigid.
  pure integer function bearing(self)
    class(plane_t), intent(in) :: self

    bearing = 0
  end function bearing

  !> dx alone.
  pure integer function vectors(self, wanted)
    class(plane_t), intent(in) :: self
    integer, intent(in) :: wanted

    vectors = 1
  end function vectors

  !> Every point has its foot.
  subroutine locate(self, slave, positions, started, had, projections, status, place, work)
    class(plane_t), intent(in) :: self
    type(slave_t), intent(in) :: slave
    real(wp), intent(in) :: positions(:, :)
    logical, intent(in) :: started(:), had(:)
    type(projections_t), intent(inout) :: projections
    integer, intent(out) :: status, place
    type(work_t), intent(inout) :: work
    integer :: q

    call count_points(size(slave%area), work)
    do q = 1, size(slave%area)
      projections%xi(:, q) = matmul(slave_position(slave, positions, q) - self%origin, self%tangent)
    end do
    projections%fixed = .false.
    projections%found = .true.
    projections%doubt = status_ok
    status = status_ok
    place = 0
  end subroutine locate

  !> The difference of the coordinates.
  pure subroutine find_slip(self, slave, positions, projections, q, slip, work)
    class(plane_t), intent(in) :: self
    type(slave_t), intent(in) :: slave
    real(wp), intent(in) :: positions(:, :)
    type(projections_t), intent(in) :: projections
    integer, intent(in) :: q
    real(wp), intent(out) :: slip(2)
    type(work_t), intent(inout) :: work

    slip = projections%xi(:, q) - projections%origin(:, q)
  end subroutine find_slip

  !> Kinematics (theory 3.4); no master control points.
  pure subroutine at(self, slave, positions, projections, q, wanted, point, points, coefficients, work)
    class(plane_t), intent(in) :: self
    type(slave_t), intent(in) :: slave
    real(wp), intent(in) :: positions(:, :)
    type(projections_t), intent(in) :: projections
    integer, intent(in) :: q, wanted
    type(contact_point_t), intent(out) :: point
    integer, intent(out) :: points(:)
    real(wp), intent(out) :: coefficients(:, :)
    type(work_t), intent(inout) :: work

    points = 0
    coefficients = 0.0_wp
    point%surface = 0.0_wp
    point%normal = self%normal
    point%tangent = self%tangent
    point%gap = -dot_product(slave_position(slave, positions, q) - self%origin, self%normal)
    point%metric = reshape([1.0_wp, 0.0_wp, 0.0_wp, 1.0_wp], [2, 2])
    point%inverse_metric = point%metric
    point%curvature = 0.0_wp
    point%inverse_h = point%metric
  end subroutine at

  !> dg = -n dx, dxi^a = t_a dx (theory 3.4).
  pure function first(point, vectors) result(variations)
    type(contact_point_t), intent(in) :: point
    integer, intent(in) :: vectors
    type(variations_t) :: variations

    variations%gap = 0.0_wp
    variations%slip = 0.0_wp
    variations%gap(1:3 * vectors) = -point%normal
    variations%pressure_work = variations%gap
    variations%slip(1:3 * vectors, :) = point%tangent
    variations%projection = variations%slip
  end function first

  !> The metric stays as it is.
  pure function metric(point, variations) result(rows)
    type(contact_point_t), intent(in) :: point
    type(variations_t), intent(in) :: variations
    real(wp) :: rows(all_components, 3)

    rows = 0.0_wp
  end function metric

  !> Nothing: a plane does not bend.
  pure subroutine second(point, variations, pressure, traction, form)
    type(contact_point_t), intent(in) :: point
    type(variations_t), intent(in) :: variations
    real(wp), intent(in) :: pressure, traction(2)
    real(wp), intent(inout) :: form(:, :)

  end subroutine second

end module isomortar_contact_gap_map_plane
