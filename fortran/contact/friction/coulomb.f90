!> Coulomb's friction: tractions up to a multiple of the pressure.
module isomortar_contact_friction_coulomb
  use isomortar_base_kinds, only: wp
  use isomortar_contact_friction_law, only: friction_t
  implicit none
  private

  type, extends(friction_t), public :: coulomb_t
    !> Coefficient of friction mu.
    real(wp) :: coefficient
  contains
    procedure :: limit
  end type coulomb_t

contains

  !> mu p, and mu (theory 4.6, 4.13).
  pure subroutine limit(self, pressure, radius, slope)
    class(coulomb_t), intent(in) :: self
    real(wp), intent(in) :: pressure
    real(wp), intent(out) :: radius, slope

    radius = self%coefficient * pressure
    slope = self%coefficient
  end subroutine limit

end module isomortar_contact_friction_coulomb
