!> From the flat double-precision arrays outside to the types inside. Numbers count from 0 outside and from 1 inside.
module isomortar_api_unpack
  use, intrinsic :: iso_c_binding, only: c_double, c_int
  use isomortar_base_kinds, only: wp
  use isomortar_contact_gap_map_closest_point, only: closest_point_t
  use isomortar_contact_gap_map_map, only: gap_map_t
  use isomortar_contact_gap_map_plane, only: plane_through
  use isomortar_contact_slave, only: slave_t
  use isomortar_nurbs_direction, only: direction_t, family_nurbs, new_direction
  use isomortar_nurbs_patch, only: patch_t
  use isomortar_nurbs_surface, only: face_of, surface_t
  use isomortar_sparse_blocks, only: pattern_t
  implicit none
  private

  public :: unpack_face, unpack_gap_map, unpack_patch, unpack_pattern, unpack_slave

contains

  !> A patch. `layout` holds families (1 NURBS, 2 Lagrange), orders and numbers of control points of the three
  !> directions; their knots follow one another.
  pure function unpack_patch(layout, knots, point, weight) result(patch)
    integer(c_int), intent(in) :: layout(9), point(:)
    real(c_double), intent(in) :: knots(:), weight(:)
    type(patch_t) :: patch
    integer :: count, d, first

    first = 1
    do d = 1, 3
      associate (family => layout(d), order => layout(3 + d), points => layout(6 + d))
        count = merge(points + order + 1, (points - 1) / order + 1, family == family_nurbs)
        patch%direction(d) = new_direction(int(family), int(order), real(knots(first:first + count - 1), wp))
        first = first + count
      end associate
    end do
    allocate (patch%point, source=int(point) + 1)
    allocate (patch%weight, source=real(weight, wp))
  end function unpack_patch

  !> A gap map: a case for each. `kind` holds axis (1..3) and end (0, 1) of the master's face, then the layout of its patch;
  !> axis 0 is a plane, whose origin, normal and first tangent stand in `knots`.
  subroutine unpack_gap_map(kind, knots, point, weight, map)
    integer(c_int), intent(in) :: kind(11), point(:)
    real(c_double), intent(in) :: knots(:), weight(:)
    class(gap_map_t), allocatable, intent(out) :: map

    if (kind(1) == 0) then
      allocate (map, source=plane_through(real(knots(1:3), wp), real(knots(4:6), wp), real(knots(7:9), wp)))
    else
      allocate (map, source=closest_point_t(surface=unpack_face(kind(3:11), knots, point, weight, kind(1), kind(2)), &
        opposite=unpack_face(kind(3:11), knots, point, weight, kind(1), 1 - kind(2))))
    end if
  end subroutine unpack_gap_map

  !> A face of a patch, by the axis across it and its end there.
  pure function unpack_face(layout, knots, point, weight, axis, side) result(face)
    integer(c_int), intent(in) :: layout(9), point(:), axis, side
    real(c_double), intent(in) :: knots(:), weight(:)
    type(surface_t) :: face

    face = face_of(unpack_patch(layout, knots, point, weight), int(axis), int(side))
  end function unpack_face

  !> A slave side from its tables.
  pure function unpack_slave(nodes, basis, area, point) result(slave)
    integer(c_int), intent(in) :: nodes(:, :), point(:)
    real(c_double), intent(in) :: basis(:, :), area(:)
    type(slave_t) :: slave

    slave%count = size(point)
    allocate (slave%nodes, source=int(nodes) + 1)
    allocate (slave%basis, source=real(basis, wp))
    allocate (slave%area, source=real(area, wp))
    allocate (slave%point, source=int(point) + 1)
  end function unpack_slave

  !> A compressed pattern of blocks.
  pure function unpack_pattern(start, column) result(pattern)
    integer(c_int), intent(in) :: start(:), column(:)
    type(pattern_t) :: pattern

    allocate (pattern%start(0:size(start) - 1))
    pattern%start(:) = start
    allocate (pattern%column, source=int(column) + 1)
  end function unpack_pattern

end module isomortar_api_unpack
