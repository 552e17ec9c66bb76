!> First and second variations of gap and foot on a curved master (isomortar_contact_gap_map_kinematics), against differences of
!> projections found anew.
module test_variations
  use isomortar_base_kinds, only: wp
  use isomortar_contact_gap_map_closest_point, only: closest_point_t
  use isomortar_contact_gap_map_map, only: contact_point_t, for_tangent, projections_t, variations_t
  use isomortar_contact_search, only: descend, search_t, start_at
  use isomortar_contact_slave, only: slave_t
  use isomortar_contact_work, only: work_t
  use surfaces, only: curved, lone_point
  use testing, only: by_difference, expect, random_numbers, step
  implicit none
  private

  public :: variations

  !> Short vectors: dx - dS, dS,1, dS,2, dS,11, dS,12, dS,22.
  integer, parameter :: vectors = 6

  !> Everything at one configuration: foot, kinematics, rows, and the coefficients of the short vectors of the master's points.
  type :: state_t
    real(wp) :: xi(2)
    type(contact_point_t) :: point
    type(variations_t) :: rows
    integer :: points(16)
    real(wp) :: coefficients(16, vectors)
  end type state_t

contains

  subroutine variations()
    type(closest_point_t) :: map
    real(wp), allocatable :: base(:, :), one(:, :), other(:, :), positions(:, :)
    type(state_t) :: here, lower, upper
    real(wp) :: change(3 * vectors), form(3 * vectors, 3 * vectors), numbers(3 * 26)

    call curved(map%surface, base)
    positions = reshape([base, 3.1_wp, 3.0_wp, 0.6_wp], [3, 26])
    allocate (one(3, 26), other(3, 26))
    call random_numbers(numbers)
    one = reshape(numbers, [3, 26])
    call random_numbers(numbers)
    other = reshape(numbers, [3, 26])

    here = state_at(map, positions)
    upper = state_at(map, positions + step * one)
    lower = state_at(map, positions - step * one)
    change = short_vectors(here, one)
    call expect("gap", abs((upper%point%gap - lower%point%gap) / (2.0_wp * step) - dot_product(here%rows%gap(:18), change)), &
      by_difference)
    call expect("foot", maxval(abs((upper%xi - lower%xi) / (2.0_wp * step) - matmul(change, here%rows%projection(:18, :)))), &
      by_difference)

    form = 0.0_wp
    call map%second(here%point, here%rows, 1.0_wp, [0.0_wp, 0.0_wp], form)
    call expect("gap's second variation", abs((gap_by(upper, other) - gap_by(lower, other)) / (2.0_wp * step) &
      - dot_product(short_vectors(here, other), matmul(form, change))), by_difference)
    form = 0.0_wp
    call map%second(here%point, here%rows, 0.0_wp, [0.7_wp, -0.4_wp], form)
    call expect("foot's second variation", abs((foot_by(upper, other) - foot_by(lower, other)) / (2.0_wp * step) &
      - dot_product(short_vectors(here, other), matmul(form, change))), by_difference)
  end subroutine variations

  !> The foot of the last point on the surface of the others, and what follows from it.
  function state_at(map, positions) result(state)
    type(closest_point_t), intent(in) :: map
    real(wp), intent(in) :: positions(:, :)
    type(state_t) :: state
    type(projections_t) :: projections
    type(search_t) :: here
    type(slave_t) :: slave
    type(work_t) :: work

    here = start_at(map%surface, [0.5_wp, 0.5_wp])
    call descend(map%surface, positions, positions(:, 26), here, work)
    state%xi = here%xi
    projections%xi = reshape(here%xi, [2, 1])
    projections%place = reshape(here%place, [2, 1])
    projections%fixed = reshape(here%fixed, [2, 1])
    projections%found = [.true.]
    slave = lone_point(26)
    call map%at(slave, positions, projections, 1, for_tangent, state%point, state%points, state%coefficients, work)
    state%rows = map%first(state%point, vectors)
  end function state_at

  !> The short vectors of a change of the positions, one after the other.
  function short_vectors(state, change) result(components)
    type(state_t), intent(in) :: state
    real(wp), intent(in) :: change(:, :)
    real(wp) :: components(3 * vectors)

    components = reshape(matmul(change(:, state%points), state%coefficients), [3 * vectors])
    components(1:3) = components(1:3) + change(:, 26)
  end function short_vectors

  !> dg of a change.
  real(wp) function gap_by(state, change)
    type(state_t), intent(in) :: state
    real(wp), intent(in) :: change(:, :)

    gap_by = dot_product(state%rows%gap(:18), short_vectors(state, change))
  end function gap_by

  !> 0.7 dxi^1 - 0.4 dxi^2 of a change.
  real(wp) function foot_by(state, change)
    type(state_t), intent(in) :: state
    real(wp), intent(in) :: change(:, :)

    foot_by = dot_product(matmul(short_vectors(state, change), state%rows%slip(:18, :)), [0.7_wp, -0.4_wp])
  end function foot_by

end module test_variations
