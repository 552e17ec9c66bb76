!> The master of a contact pair: a rigid plane or a face of a deformable body.
module isomortar_contact_master
  use isomortar_base_algebra, only: cross
  use isomortar_base_kinds, only: wp
  use isomortar_nurbs_surface, only: surface_t
  implicit none
  private

  public :: master_order, master_point_count, plane_through

  !> A master. A plane has coordinates along `tangent(:, 1)` and `tangent(:, 2)`, both unit vectors.
  type, public :: master_t
    logical :: is_plane = .false.
    real(wp) :: origin(3) = 0.0_wp
    real(wp) :: normal(3) = 0.0_wp
    real(wp) :: tangent(3, 2) = 0.0_wp
    type(surface_t) :: surface
    !> The face of the same body across from it: how deep the body is.
    type(surface_t) :: opposite
  end type master_t

contains

  !> Rigid plane through a point; normal and first tangent are made orthonormal (theory 3.4).
  pure function plane_through(point, normal, tangent) result(self)
    real(wp), intent(in) :: point(3), normal(3), tangent(3)
    type(master_t) :: self

    self%is_plane = .true.
    self%origin = point
    self%normal = normal / norm2(normal)
    self%tangent(:, 1) = tangent - dot_product(tangent, self%normal) * self%normal
    self%tangent(:, 1) = self%tangent(:, 1) / norm2(self%tangent(:, 1))
    self%tangent(:, 2) = cross(self%normal, self%tangent(:, 1))
  end function plane_through

  !> Number of master control points that bear on one quadrature point.
  pure integer function master_point_count(self)
    type(master_t), intent(in) :: self

    master_point_count = 0
    if (.not. self%is_plane) master_point_count = product(self%surface%direction%order + 1)
  end function master_point_count

  !> Order of surface derivatives that the tangent needs: none of a plane, third ones only with friction.
  pure integer function master_order(self, with_friction)
    type(master_t), intent(in) :: self
    logical, intent(in) :: with_friction

    master_order = merge(0, merge(3, 2, with_friction), self%is_plane)
  end function master_order

end module isomortar_contact_master
