!> How a slave point finds its master point, and what varies with it.
!>
!> A gap map is one file beside this one, with a routine that keeps one in api/descriptor_api.f90. The two passes over the slave
!> quadrature points do not know which they serve. Variations are linear forms in short vectors, three components each: the first
!> is dx - dS, the others are the map's own, as sums over the master control points that bear on the point.
!>
!> What means the same for all maps:
!>
!> - `slave`, `positions` (3, control points): the slave side; all control points, and normals of nodes after them where a map has
!>   any, L.
!> - `projections`: feet of the quadrature points. `q`: one of these points, from 1.
!> - `point`, `variations`: kinematics of a slave point at its foot, and its first variations. `wanted`: what of them (for_gap,
!>   for_forces, for_tangent). `work`: counts of what is done.
module isomortar_contact_gap_map_map
  use isomortar_base_kinds, only: wp
  use isomortar_contact_gap_map_nodal_normals, only: normals_t
  use isomortar_contact_slave, only: slave_t
  use isomortar_contact_work, only: work_t
  implicit none
  private

  public :: projections_at

  !> Components of all short vectors of any map.
  integer, parameter, public :: all_components = 27

  !> What of a point's kinematics is wanted: gap, normal and metric; also what first variations of slips and second ones of the gap
  !> take; also what second variations of slips take. Each takes a derivative of the master more; the rest means nothing.
  integer, parameter, public :: for_gap = 1, for_forces = 2, for_tangent = 3

  !> Where the slave quadrature points stand on the master.
  type, public :: projections_t
    !> Master coordinates.
    real(wp), allocatable :: xi(:, :)
    !> Master element by direction; 0 where there is none (plane, no projection).
    integer, allocatable :: place(:, :)
    !> Coordinates that stay while the point moves (on C0 lines; of points that are found), shape (2, points).
    logical, allocatable :: fixed(:, :)
    logical, allocatable :: found(:)
    !> Of a point that is found: status_ok, or why its foot does not follow it. Then its distance alone means something.
    integer, allocatable :: doubt(:)
    !> Master coordinates at the last converged load step, from where slips count.
    real(wp), allocatable :: origin(:, :)
    !> Slip increment since then; zero without a history.
    real(wp), allocatable :: slip(:, :)
    !> The slip follows the motion: found now and at the last converged load step.
    logical, allocatable :: slips(:)
  end type projections_t

  !> A slave point and its projection.
  type, public :: contact_point_t
    !> Penetration: positive inside the master.
    real(wp) :: gap
    real(wp) :: normal(3)
    !> Tangent vectors a_1, a_2.
    real(wp) :: tangent(3, 2)
    real(wp) :: metric(2, 2)
    real(wp) :: inverse_metric(2, 2)
    !> Curvature b_ab = normal . S,ab; zero for a plane.
    real(wp) :: curvature(2, 2)
    !> Inverse of H_ab = a_ab + g b_ab.
    real(wp) :: inverse_h(2, 2)
    !> Coordinates that stay while the point moves: the foot is on a C0 line.
    logical :: fixed(2) = .false.
    !> The normal turns about such a line with the slave point.
    logical :: turns = .false.
    !> Slips across such a line follow the slave point: H of the face that goes on is positive.
    logical :: slips = .true.
    !> Surface derivatives by column (derivative_column), up to the order that is needed.
    real(wp) :: surface(3, 10)
    !> Of an averaged normal: the field that it is the direction of, and its derivatives; unit normal t_1 x t_2 of the slave; way
    !> from the foot of the last converged load step to the foot; inverse of the derivative of the foot's equation by foot and gap.
    real(wp) :: field(3, 3), facing(3), way(3), inverse_foot(3, 3)
  end type contact_point_t

  !> First variations as rows over the components of the short vectors.
  type, public :: variations_t
    real(wp) :: gap(all_components)
    !> What pressures do their work on: dg, but without its spurious part where that has a row of its own.
    real(wp) :: pressure_work(all_components)
    !> dxi.
    real(wp) :: projection(all_components, 2)
    !> The slip that tractions do their work on: dxi; on a C0 line, where that is zero, as if the element's face went on.
    real(wp) :: slip(all_components, 2)
  end type variations_t

  !> A gap map onto a certain master.
  type, abstract, public :: gap_map_t
    !> Variations change with the positions.
    logical :: bends = .true.
    !> Slave points without a foot count in weights and metric, which are the slave's.
    logical :: counts_all_points = .false.
    !> The gap's own variation has a row apart from that which pressures do their work on.
    logical :: has_gap_row = .false.
    !> Number of the first of two short vectors that are variations of the slave's tangents; 0: none are.
    integer :: of_tangents = 0
  contains
    procedure :: extend => add_nothing
    procedure :: stencils => elements
    procedure(count_bearing), deferred :: bearing
    procedure(count_vectors), deferred :: vectors
    procedure(locate_points), deferred :: locate
    procedure(slip_between), deferred :: slip
    procedure :: climb => stay_level
    procedure(point_at), deferred :: at
    procedure(first_of), deferred, nopass :: first
    procedure(metric_of), deferred, nopass :: metric
    procedure(second_of), deferred, nopass :: second
  end type gap_map_t

  abstract interface
    !> Number of master control points, and normals of nodes, that bear on one slave point.
    pure integer function count_bearing(self)
      import :: gap_map_t
      implicit none
      class(gap_map_t), intent(in) :: self
    end function count_bearing

    !> Number of short vectors in what is wanted.
    pure integer function count_vectors(self, wanted)
      import :: gap_map_t
      implicit none
      class(gap_map_t), intent(in) :: self
      integer, intent(in) :: wanted
    end function count_vectors

    !> Find the master points of all slave quadrature points: all of `projections` but the slips; its coordinates hold starts.
    !>
    !> - `started` (points), `had` (points): whether there is a start; whether there was a foot at the last converged load step.
    !> - `status`, `place`: how it ended (isomortar_base_status), and on failure the quadrature point.
    subroutine locate_points(self, slave, positions, started, had, projections, status, place, work)
      import :: gap_map_t, projections_t, slave_t, work_t, wp
      implicit none
      class(gap_map_t), intent(in) :: self
      type(slave_t), intent(in) :: slave
      real(wp), intent(in) :: positions(:, :)
      logical, intent(in) :: started(:), had(:)
      type(projections_t), intent(inout) :: projections
      integer, intent(out) :: status, place
      type(work_t), intent(inout) :: work
    end subroutine locate_points

    !> The `slip` of quadrature point `q`, P, from its foot at the last converged load step to that which it has now.
    pure subroutine slip_between(self, slave, positions, projections, q, slip, work)
      import :: gap_map_t, projections_t, slave_t, work_t, wp
      implicit none
      class(gap_map_t), intent(in) :: self
      type(slave_t), intent(in) :: slave
      real(wp), intent(in) :: positions(:, :)
      type(projections_t), intent(in) :: projections
      integer, intent(in) :: q
      real(wp), intent(out) :: slip(2)
      type(work_t), intent(inout) :: work
    end subroutine slip_between

    !> Kinematics of slave quadrature point `q`, which has a projection, and what bears on it.
    !>
    !> - `points` (bearing): master control points, and normals of nodes, counted on from these.
    !> - `coefficients` (bearing, vectors): of each in the short vectors.
    pure subroutine point_at(self, slave, positions, projections, q, wanted, point, points, coefficients, work)
      import :: contact_point_t, gap_map_t, projections_t, slave_t, work_t, wp
      implicit none
      class(gap_map_t), intent(in) :: self
      type(slave_t), intent(in) :: slave
      real(wp), intent(in) :: positions(:, :)
      type(projections_t), intent(in) :: projections
      integer, intent(in) :: q, wanted
      type(contact_point_t), intent(out) :: point
      integer, intent(out) :: points(:)
      real(wp), intent(out) :: coefficients(:, :)
      type(work_t), intent(inout) :: work
    end subroutine point_at

    !> Rows of dg, dxi and what pressures and tractions work on, over so many short `vectors`.
    pure function first_of(point, vectors) result(variations)
      import :: contact_point_t, variations_t
      implicit none
      type(contact_point_t), intent(in) :: point
      integer, intent(in) :: vectors
      type(variations_t) :: variations
    end function first_of

    !> Rows of the metric's variation: a_11, a_12, a_22.
    pure function metric_of(point, variations) result(rows)
      import :: all_components, contact_point_t, variations_t, wp
      implicit none
      type(contact_point_t), intent(in) :: point
      type(variations_t), intent(in) :: variations
      real(wp) :: rows(all_components, 3)
    end function metric_of

    !> Add `pressure` * Ddg + `traction`_a D(slip)^a, F/L^2 and F/(L P), to a bilinear form over the components of the short
    !> vectors: `form` (components, components).
    pure subroutine second_of(point, variations, pressure, traction, form)
      import :: contact_point_t, variations_t, wp
      implicit none
      type(contact_point_t), intent(in) :: point
      type(variations_t), intent(in) :: variations
      real(wp), intent(in) :: pressure, traction(2)
      real(wp), intent(inout) :: form(:, :)
    end subroutine second_of
  end interface

contains

  !> Projections that begin at coordinates `start` (2, points), P: there are no feet yet.
  pure function projections_at(start) result(projections)
    real(wp), intent(in) :: start(:, :)
    type(projections_t) :: projections

    associate (n => size(start, 2))
      allocate (projections%place(2, n), projections%fixed(2, n), projections%found(n), projections%doubt(n))
      allocate (projections%slip(2, n), projections%slips(n))
    end associate
    projections%xi = start
    projections%place = 0
    projections%fixed = .false.
    projections%found = .false.
    projections%doubt = 0
  end function projections_at

  !> The `normals` of nodes, which bear on points like control points do, and the list of positions of both that all the above
  !> take, `all` (3, control points and nodes): of control points alone.
  pure subroutine add_nothing(self, positions, normals, all, work)
    class(gap_map_t), intent(in) :: self
    real(wp), intent(in) :: positions(:, :)
    type(normals_t), intent(out) :: normals
    real(wp), allocatable, intent(out) :: all(:, :)
    type(work_t), intent(inout) :: work

    normals%count = 0
    allocate (all, source=positions)
  end subroutine add_nothing

  !> What decides which control points bear on each quadrature point, by column: its master element.
  pure function elements(self, projections) result(stencils)
    class(gap_map_t), intent(in) :: self
    type(projections_t), intent(in) :: projections
    integer, allocatable :: stencils(:, :)

    stencils = projections%place
  end function elements

  !> Integral of n dS along the way of quadrature point `q`'s foot since the last converged load step, `climb`, L: none where
  !> normals are at right angles to the face (theory 3.31).
  pure subroutine stay_level(self, positions, projections, q, climb, work)
    class(gap_map_t), intent(in) :: self
    real(wp), intent(in) :: positions(:, :)
    type(projections_t), intent(in) :: projections
    integer, intent(in) :: q
    real(wp), intent(out) :: climb
    type(work_t), intent(inout) :: work

    climb = 0.0_wp
  end subroutine stay_level

end module isomortar_contact_gap_map_map
