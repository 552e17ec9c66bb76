!> Friction with a cohesion, and with a largest traction: min(c + mu p, tau_max).
module isomortar_contact_friction_capped
  use isomortar_base_kinds, only: wp
  use isomortar_contact_friction_law, only: friction_t
  implicit none
  private

  type, extends(friction_t), public :: capped_t
    !> Coefficient of friction mu; cohesion c and largest traction tau_max, force per area.
    real(wp) :: coefficient, cohesion, traction_max
  contains
    procedure :: limit
  end type capped_t

contains

  !> min(c + mu p, tau_max), and mu below the cap (theory 4.6, 4.13). Not by `min`, which drops what is not a number.
  pure subroutine limit(self, pressure, radius, slope)
    class(capped_t), intent(in) :: self
    real(wp), intent(in) :: pressure
    real(wp), intent(out) :: radius, slope

    radius = self%cohesion + self%coefficient * pressure
    slope = self%coefficient
    if (radius > self%traction_max) then
      radius = self%traction_max
      slope = 0.0_wp
    end if
  end subroutine limit

end module isomortar_contact_friction_capped
