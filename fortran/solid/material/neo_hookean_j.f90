!> The compressible neo-Hookean solid of Abaqus and CalculiX: U = A1/2 (J - 1)^2.
module isomortar_solid_material_neo_hookean_j
  use isomortar_base_kinds, only: lanes, wp
  use isomortar_solid_material_law, only: material_t, stretch_t
  use isomortar_solid_material_split, only: split_stress, split_tangent
  implicit none
  private

  type, extends(material_t), public :: neo_hookean_j_t
    !> A1 and A2, force per area.
    real(wp) :: bulk, shear
  contains
    procedure :: stress
    procedure :: tangent
  end type neo_hookean_j_t

contains

  !> Kirchhoff stress (theory 1.1).
  pure subroutine stress(self, state, kirchhoff)
    class(neo_hookean_j_t), intent(in) :: self
    type(stretch_t), intent(in) :: state
    real(wp), intent(out) :: kirchhoff(lanes, 3, 3)

    call split_stress(state, self%bulk * state%jacobian * state%growth, self%shear, kirchhoff)
  end subroutine stress

  !> Moduli (theory 1.10).
  pure subroutine tangent(self, state, moduli)
    class(neo_hookean_j_t), intent(in) :: self
    type(stretch_t), intent(in) :: state
    real(wp), intent(out) :: moduli(lanes, 3, 3, 6)
    real(wp) :: slope(lanes)

    slope = self%bulk * state%jacobian * (state%jacobian + state%growth)
    call split_tangent(state, self%bulk * state%jacobian * state%growth, slope, self%shear, moduli)
  end subroutine tangent

end module isomortar_solid_material_neo_hookean_j
