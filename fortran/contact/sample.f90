!> A slave quadrature point as the passes over it see it: the control points that bear on it, its variations, the fields there.
!>
!> - `slave`, `map`: the slave side, and the gap map onto its master. `e`, `q`: a slave element, and a quadrature point, from 1.
!> - `positions` (3, control points and nodes): of all control points, L; normals of nodes at the end, where the map has any.
!> - `projections`: feet of the quadrature points. `sample`: what bears on the point.
module isomortar_contact_sample
  use isomortar_base_kinds, only: wp
  use isomortar_contact_gap_map_map, only: contact_point_t, for_tangent, gap_map_t, projections_t, variations_t
  use isomortar_contact_slave, only: slave_t
  use isomortar_contact_work, only: count_points, work_t
  implicit none
  private

  public :: fields_at, take_sample

  !> Control values that the fields are made of.
  type, public :: multipliers_t
    real(wp), allocatable :: pressure(:)
    real(wp), allocatable :: traction(:, :)
    !> Only active control points contribute.
    logical, allocatable :: active(:)
  end type multipliers_t

  !> One quadrature point: control points of the slave and the master element, coefficients of the short vectors (control points,
  !> vectors), variations.
  type, public :: sample_t
    type(contact_point_t) :: point
    type(variations_t) :: variations
    integer, allocatable :: points(:)
    real(wp), allocatable :: coefficients(:, :)
  end type sample_t

contains

  !> The fields p, t_1, t_2 of `multipliers` at a quadrature point, F/L^2 and F/(L P) (theory 4.7).
  pure function fields_at(slave, multipliers, e, q) result(field)
    type(slave_t), intent(in) :: slave
    type(multipliers_t), intent(in) :: multipliers
    integer, intent(in) :: e, q
    real(wp) :: field(3)
    integer :: a, i

    field = 0.0_wp
    do a = 1, size(slave%test%nodes, 1)
      i = slave%test%nodes(a, e)
      if (multipliers%active(i)) field = field + slave%test%values(a, q) * [multipliers%pressure(i), multipliers%traction(:, i)]
    end do
  end function fields_at

  !> Control points, kinematics, variations and coefficients of the short vectors at a quadrature point.
  !>
  !> - `wanted`: what of them (isomortar_contact_gap_map_map). `work`: counts of what is done.
  pure subroutine take_sample(slave, map, positions, projections, e, q, wanted, sample, work)
    type(slave_t), intent(in) :: slave
    class(gap_map_t), intent(in) :: map
    real(wp), intent(in) :: positions(:, :)
    type(projections_t), intent(in) :: projections
    integer, intent(in) :: e, q, wanted
    type(sample_t), intent(inout) :: sample
    type(work_t), intent(inout) :: work
    integer :: n

    call count_points(1, work)
    n = size(slave%shape%nodes, 1)
    if (.not. allocated(sample%points)) then
      allocate (sample%points(n + map%bearing()), sample%coefficients(n + map%bearing(), map%vectors(wanted)))
      sample%coefficients = 0.0_wp
    end if
    call map%at(slave, positions, projections, q, wanted, sample%point, sample%points(n + 1:), sample%coefficients(n + 1:, :), work)
    sample%variations = map%first(sample%point, size(sample%coefficients, 2))
    sample%points(:n) = slave%point(slave%shape%nodes(:, e))
    sample%coefficients(:n, 1) = slave%shape%values(:, q)
    associate (first => map%of_tangents)
      if (first > 0 .and. wanted == for_tangent) sample%coefficients(:n, first:first + 1) = slave%slopes(:, :, q)
    end associate
  end subroutine take_sample

end module isomortar_contact_sample
