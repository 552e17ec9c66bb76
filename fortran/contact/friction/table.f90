!> The friction laws by number. Another law: its file, a number, and a case here.
module isomortar_contact_friction_table
  use isomortar_base_kinds, only: wp
  use isomortar_base_status, only: status_no_such_law, status_ok
  use isomortar_contact_friction_capped, only: capped_t
  use isomortar_contact_friction_coulomb, only: coulomb_t
  use isomortar_contact_friction_law, only: friction_t
  implicit none
  private

  public :: friction_of

  !> Numbers of the laws, here and in Python (isomortar._arrays). None has no parameters, Coulomb's the coefficient, the capped
  !> one coefficient, cohesion and largest traction.
  integer, parameter, public :: law_none = 0, law_coulomb = 1, law_capped = 2

contains

  !> The law of a number with its parameters; not allocated where there is no friction.
  !> - `law`, `parameters` (number): which one, and what it takes.
  !> - `friction`: the law. `status`: whether there is one that takes so many (isomortar_base_status).
  subroutine friction_of(law, parameters, friction, status)
    integer, intent(in) :: law
    real(wp), intent(in) :: parameters(:)
    class(friction_t), allocatable, intent(out) :: friction
    integer, intent(out) :: status

    status = status_no_such_law
    select case (law)
    case (law_none)
      if (size(parameters) /= 0) return
    case (law_coulomb)
      if (size(parameters) /= 1) return
      allocate (friction, source=coulomb_t(parameters(1)))
    case (law_capped)
      if (size(parameters) /= 3) return
      allocate (friction, source=capped_t(parameters(1), parameters(2), parameters(3)))
    case default
      return
    end select
    status = status_ok
  end subroutine friction_of

end module isomortar_contact_friction_table
