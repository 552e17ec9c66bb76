!> Everything of a contact pair whose derivatives the tangent is made of, as a function of positions and multipliers: projected,
!> integrated and put through the law anew. The twin forms differences of it.
module isomortar_api_difference
  use iso_c_binding, only: c_double, c_int
  use isomortar_base_kinds, only: wp
  use isomortar_base_status, only: status_ok
  use isomortar_contact_augmentation, only: law_t, respond, response_t
  use isomortar_contact_blocks, only: integrate_forces
  use isomortar_contact_control, only: control_quantities, control_t, project_points
  use isomortar_contact_friction_law, only: friction_t
  use isomortar_contact_gap_map_map, only: gap_map_t, projections_at, projections_t
  use isomortar_contact_sample, only: multipliers_t
  use isomortar_contact_slave, only: integrate_functions, slave_t
  use isomortar_contact_work, only: work_t
  implicit none
  private

  public :: difference, evaluate_contact, fixed_of, integrate_and_respond, law_of

  !> What stays while positions and multipliers move.
  type, public :: fixed_t
    type(slave_t) :: slave
    class(gap_map_t), allocatable :: map
    !> Starts of the projections.
    real(wp), allocatable :: start(:, :)
    !> Projections at the last converged load step, and whether there were any.
    real(wp), allocatable :: origin(:, :)
    logical, allocatable :: had(:)
    !> Multipliers of the parts that are differentiated with multipliers held.
    type(multipliers_t) :: frozen
    logical :: summed = .false.
  end type fixed_t

  !> The quantities: <R g>, <R xi>, <R (xi - xi_n)>, <R R a_ab>, control pressures and tractions, contact forces with the frozen
  !> pressures alone, with the frozen tractions alone, and with the multipliers of the law.
  type, public :: quantities_t
    type(projections_t) :: projections
    type(control_t) :: control
    type(response_t) :: response
    !> Field of control slips of the paper's slip sum, else zero.
    real(wp), allocatable :: field_slip(:, :)
    real(wp), allocatable :: coordinates(:, :)
    real(wp), allocatable :: normal_forces(:, :), tangential_forces(:, :), forces(:, :)
  end type quantities_t

contains

  !> What stays, from what Python hands over.
  !> - `slave`, `map`: the slave side, and its master's gap map. `summed`: 1 for the paper's slip sum.
  !> - `xi` (2, points), `origin` (2, points): starts of the projections, and those at the last converged load step, P.
  !> - `had` (points): 1 where there was one.
  function fixed_of(slave, map, xi, origin, had, summed) result(fixed)
    type(slave_t), intent(in) :: slave
    class(gap_map_t), intent(in) :: map
    real(c_double), intent(in) :: xi(:, :), origin(:, :)
    integer(c_int), intent(in) :: had(:), summed
    type(fixed_t) :: fixed

    fixed%slave = slave
    allocate (fixed%map, source=map)
    fixed%start = real(xi, wp)
    fixed%origin = real(origin, wp)
    fixed%had = had /= 0
    fixed%summed = summed /= 0
  end function fixed_of

  !> The law without its multipliers, likewise.
  !> - `friction`: null where there is none. `penalties`: normal and tangential, F/L^3.
  !> - `bears` (test functions): which bear pressure. `free` (2, 2, test functions): what of their tractions supports leave.
  !> - `elastic`: 1 where slip is elastic. `smoothing`: pressure times distance of smooth contact, F/L.
  function law_of(friction, penalties, bears, free, elastic, smoothing) result(law)
    class(friction_t), pointer, intent(in) :: friction
    real(c_double), intent(in) :: penalties(2), free(:, :, :), smoothing
    integer(c_int), intent(in) :: bears(:), elastic
    type(law_t) :: law

    if (associated(friction)) allocate (law%friction, source=friction)
    law%normal_penalty = real(penalties(1), wp)
    law%tangential_penalty = real(penalties(2), wp)
    law%bears = bears /= 0
    law%free = real(free, wp)
    law%elastic = elastic /= 0
    law%smoothing = real(smoothing, wp)
  end function law_of

  !> Central difference (`upper` - `lower`) / (2 `step`), theory 9.4.
  elemental function difference(upper, lower, step) result(slope)
    real(wp), intent(in) :: upper, lower, step
    real(wp) :: slope

    slope = (upper - lower) / (2.0_wp * step)
  end function difference

  !> The quantities at given positions and multipliers.
  !> - `fixed`: what stays. `law`: with the multipliers.
  !> - `positions` (3, control points): of all control points, L.
  !> - `quantities`: what comes of it.
  !> - `status`, `place`: how it ended (isomortar_base_status), and on failure the quadrature point, from 1.
  subroutine evaluate_contact(fixed, positions, law, quantities, status, place)
    type(fixed_t), intent(in) :: fixed
    real(wp), intent(in) :: positions(:, :)
    type(law_t), intent(in) :: law
    type(quantities_t), intent(out) :: quantities
    integer, intent(out) :: status, place
    type(multipliers_t) :: pressures, tractions

    call integrate_and_respond(fixed, positions, law, quantities, status, place)
    if (status /= status_ok) return
    allocate (quantities%coordinates(2, fixed%slave%test%count))
    associate (feet => quantities%projections)
      call integrate_functions(fixed%slave, merge(feet%xi, 0.0_wp, spread(feet%found, 1, 2)), quantities%coordinates)
    end associate

    pressures = fixed%frozen
    pressures%traction = 0.0_wp
    tractions = fixed%frozen
    tractions%pressure = 0.0_wp
    call contact_forces(fixed, positions, quantities%projections, law, pressures, quantities%normal_forces)
    call contact_forces(fixed, positions, quantities%projections, law, tractions, quantities%tangential_forces)
    call contact_forces(fixed, positions, quantities%projections, law, quantities%response%multipliers, quantities%forces)
  end subroutine evaluate_contact

  !> Of the quantities: projections, control quantities and what the law makes of these.
  !> - `fixed`, `positions` (3, control points), `law`, `quantities`, `status`, `place`: as in `evaluate_contact`.
  subroutine integrate_and_respond(fixed, positions, law, quantities, status, place)
    type(fixed_t), intent(in) :: fixed
    real(wp), intent(in) :: positions(:, :)
    type(law_t), intent(in) :: law
    type(quantities_t), intent(out) :: quantities
    integer, intent(out) :: status, place
    logical, allocatable :: started(:)
    type(work_t) :: work
    integer :: points

    points = size(fixed%slave%area)
    quantities%projections = projections_at(fixed%start)
    allocate (started(points), source=.true.)
    call project_points(fixed%slave, fixed%map, positions, started, fixed%origin, fixed%had, .true., quantities%projections, &
      status, place, work)
    if (status /= status_ok) return
    call reserve(fixed%slave%test%count, points, quantities%control)
    call control_quantities(fixed%slave, fixed%map, positions, quantities%projections, .true., quantities%control, work)
    allocate (quantities%field_slip(2, points))
    call respond(fixed%slave, quantities%control, law, fixed%summed, quantities%response, quantities%field_slip)
  end subroutine integrate_and_respond

  !> Contact forces alone.
  subroutine contact_forces(fixed, positions, projections, law, multipliers, forces)
    type(fixed_t), intent(in) :: fixed
    real(wp), intent(in) :: positions(:, :)
    type(projections_t), intent(in) :: projections
    type(law_t), intent(in) :: law
    type(multipliers_t), intent(in) :: multipliers
    real(wp), allocatable, intent(out) :: forces(:, :)
    type(work_t) :: work

    allocate (forces(3, size(positions, 2)))
    forces = 0.0_wp
    call integrate_forces(fixed%slave, fixed%map, positions, projections, .true., multipliers, forces, work)
  end subroutine contact_forces

  !> Make room for n control points and m quadrature points.
  pure subroutine reserve(n, m, control)
    integer, intent(in) :: n, m
    type(control_t), intent(inout) :: control

    allocate (control%weight(n), control%square(n), control%gap(n), control%slip(2, n), control%metric(3, n), &
      control%point_metric(3, m))
  end subroutine reserve

end module isomortar_api_difference
