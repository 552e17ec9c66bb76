!> Constraint rows: of which kinds they are, and which kinds a contact has.
module isomortar_contact_rows
  use isomortar_base_contract, only: contracts, require
  implicit none
  private

  public :: rows_of

  !> Kinds of rows, the first of each: <R^I dg> as pressures do their work on it, <R^I slip^a> that tractions do theirs on,
  !> <R^I dxi^a> over points with a history, <R^I R^I da_ab>, <R^I da_ab zeta^b>. Where pressures do theirs on something else,
  !> <R^I dg> is the last.
  integer, parameter, public :: row_pressure_work = 1
  integer, parameter, public :: row_traction_work = 2
  integer, parameter, public :: row_slip = 4
  integer, parameter, public :: row_metric = 6
  integer, parameter, public :: row_slip_sum = 9

  !> Which kinds there are.
  type, public :: rows_t
    !> Those of friction; of the paper's slip sum.
    logical :: friction, slip_sum
    !> Number of that which is <R^I dg>.
    integer :: gap
  end type rows_t

contains

  !> The kinds that there are, by how many, `kinds` (in Python: ROW_KINDS).
  pure type(rows_t) function rows_of(kinds) result(rows)
    integer, intent(in) :: kinds

    if (contracts) call require(any(kinds == [1, 2, 8, 9, 10]), "rows_of: there are such rows")
    select case (kinds)
    case (1) ! frictionless
      rows = rows_t(friction=.false., slip_sum=.false., gap=row_pressure_work)
    case (2) ! frictionless, averaged
      rows = rows_t(friction=.false., slip_sum=.false., gap=2)
    case (8) ! local
      rows = rows_t(friction=.true., slip_sum=.false., gap=row_pressure_work)
    case (9) ! local, averaged
      rows = rows_t(friction=.true., slip_sum=.false., gap=9)
    case default ! paper, 10
      rows = rows_t(friction=.true., slip_sum=.true., gap=row_pressure_work)
    end select
  end function rows_of

end module isomortar_contact_rows
