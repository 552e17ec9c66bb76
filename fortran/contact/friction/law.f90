!> What a friction law has to answer at a control point in contact: how large a traction may be under its pressure.
!>
!> A law is one file beside this one, with one entry in `isomortar_contact_friction_table`. The return map does not know which it
!> serves.
!>
!> - `pressure`: control pressure, above 0. `radius`, `slope`: of the disk, and its derivative by the pressure.
module isomortar_contact_friction_law
  use isomortar_base_kinds, only: wp
  implicit none
  private

  !> A friction law: tractions are in a disk, and where they are on its edge, along the slip.
  type, abstract, public :: friction_t
  contains
    procedure(limit_of), deferred :: limit
  end type friction_t

  abstract interface
    !> Radius of the disk under a pressure above 0, both force per area, and its derivative by the pressure (theory 4.6, 4.13).
    !> A pressure that is not a number has a radius that is none.
    pure subroutine limit_of(self, pressure, radius, slope)
      import :: friction_t, wp
      implicit none
      class(friction_t), intent(in) :: self
      real(wp), intent(in) :: pressure
      real(wp), intent(out) :: radius, slope
    end subroutine limit_of
  end interface

end module isomortar_contact_friction_law
