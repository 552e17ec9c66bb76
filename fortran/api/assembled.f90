!> The tangent of a contact pair as the kernel assembles it, in the twin's precision: the twin checks bounds and contracts.
module isomortar_api_assembled
  use isomortar_api_difference, only: fixed_t, integrate_and_respond, quantities_t
  use isomortar_base_kinds, only: wp
  use isomortar_base_status, only: status_ok, status_pattern
  use isomortar_contact_augmentation, only: condense, law_t, multiplier_rows
  use isomortar_contact_blocks, only: integrate_blocks
  use isomortar_contact_rows, only: rows_of, rows_t
  use isomortar_contact_work, only: work_t
  use isomortar_sparse_blocks, only: pattern_t
  implicit none
  private

  public :: assemble_tangent

  !> Patterns of constraint rows, of test functions that share an element, of the multipliers' derivatives, of the tangent.
  type, public :: patterns_t
    type(pattern_t), pointer :: rows => null(), neighbours => null(), wide => null(), tangent => null()
  end type patterns_t

contains

  !> The tangent, multipliers condensed (theory 4.8).
  !> - `fixed`: what stays. `law`: with the multipliers. `positions` (3, control points): of all control points, L.
  !> - `patterns`, `kinds`: those of the kernel; how many kinds of rows there are (isomortar_contact_rows).
  !> - `tangent` (column component, row component, blocks): this, F/L.
  !> - `status`, `place`: how it ended (isomortar_base_status), and on failure the quadrature point, or the row of a pattern that
  !>   lacks a block, from 1.
  subroutine assemble_tangent(fixed, positions, law, patterns, kinds, tangent, status, place)
    type(fixed_t), intent(in) :: fixed
    real(wp), intent(in) :: positions(:, :)
    type(law_t), intent(in) :: law
    type(patterns_t), intent(in) :: patterns
    integer, intent(in) :: kinds
    real(wp), intent(out) :: tangent(:, :, :)
    integer, intent(out) :: status, place
    real(wp) :: rows(3, kinds, size(patterns%rows%column))
    real(wp), dimension(3, 3, size(patterns%wide%column)) :: changes
    real(wp) :: trial(3, 2, size(patterns%wide%column))
    type(quantities_t) :: at
    type(rows_t) :: there
    type(work_t) :: work

    rows = 0.0_wp
    tangent = 0.0_wp
    call integrate_and_respond(fixed, positions, law, at, status, place)
    if (status /= status_ok) return
    there = rows_of(kinds)
    call integrate_blocks(fixed%slave, fixed%map, positions, at%projections, there%friction, at%response%multipliers, &
      at%field_slip, patterns%rows, rows, patterns%tangent, tangent, status, place, work)
    if (status /= status_ok) return
    call multiplier_rows(fixed%slave, at%control, law, at%response, patterns%rows, rows, patterns%neighbours, patterns%wide, &
      trial, changes, place)
    if (place == 0) call condense(at%response%multipliers%active, patterns%rows, rows, patterns%wide, changes, patterns%tangent, &
      tangent, place)
    status = merge(status_pattern, status_ok, place > 0)
  end subroutine assemble_tangent

end module isomortar_api_assembled
