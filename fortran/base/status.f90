!> Status codes: every failure of the kernel is one of these, with the place that it names.
module isomortar_base_status
  implicit none
  private

  !> Done as asked.
  integer, parameter, public :: status_ok = 0
  !> J <= 0 at a quadrature point of the current configuration; the place is the element.
  integer, parameter, public :: status_folded = 1
  !> The initial element is folded; the place is the element.
  integer, parameter, public :: status_folded_initially = 2
  !> The closest-point projection did not settle; the place is the slave quadrature point.
  integer, parameter, public :: status_lost_projection = 3
  !> The master surface has no tangent plane at the projection, or that is not the only nearest place; the place is the slave
  !> quadrature point.
  integer, parameter, public :: status_degenerate_surface = 4
  !> The matrix is singular; the place is the unknown without a pivot.
  integer, parameter, public :: status_singular = 5
  !> A factorisation handle was released before, or never given out.
  integer, parameter, public :: status_stale_handle = 6
  !> Memory ran out.
  integer, parameter, public :: status_out_of_memory = 7
  !> The sparse library reported something else; the place is its own status.
  integer, parameter, public :: status_library = 8
  !> An entry is missing from a compressed pattern; the place is its row.
  integer, parameter, public :: status_pattern = 9
  !> A position is not finite; the place is the control point.
  integer, parameter, public :: status_not_finite = 10
  !> A point that was in contact's reach is deeper than the master's body; the place is the slave quadrature point.
  integer, parameter, public :: status_passed_through = 11
  !> Slips at a foot on a C0 line do not follow the point, beyond the centre of curvature of the element beside it.
  integer, parameter, public :: status_no_slip = 12
  !> No law of material or friction has that number and so many parameters; the place is the number.
  integer, parameter, public :: status_no_such_law = 13

end module isomortar_base_status
