!> The return map onto the disk of a friction law (isomortar_contact_friction_return_map).
module test_return_map
  use isomortar_base_kinds, only: wp
  use isomortar_base_status, only: status_no_such_law, status_ok
  use isomortar_contact_friction_law, only: friction_t
  use isomortar_contact_friction_return_map, only: metric_norm, return_map, state_slip, state_stick
  use isomortar_contact_friction_table, only: friction_of, law_capped, law_coulomb, law_none
  use testing, only: by_difference, expect, expect_true, round_off, step
  implicit none
  private

  public :: return_maps

  real(wp), parameter :: metric(3) = [2.0_wp, 0.3_wp, 0.7_wp]

contains

  subroutine return_maps()
    class(friction_t), allocatable :: law
    integer :: status

    call friction_of(law_coulomb, [0.4_wp], law, status)
    call sticks_within("Coulomb", law, 3.0_wp, 1.2_wp)
    call slips_beyond("Coulomb", law, 3.0_wp, 1.2_wp)
    call friction_of(law_capped, [0.4_wp, 0.5_wp, 1.0_wp], law, status)
    call slips_beyond("below the cap", law, 1.0_wp, 0.9_wp)
    call slips_beyond("at the cap", law, 3.0_wp, 1.0_wp)
    call friction_of(law_none, [real(wp) ::], law, status)
    call expect_true("no friction is no law", status == status_ok .and. .not. allocated(law))
    call friction_of(law_coulomb, [real(wp) ::], law, status)
    call expect_true("a law without its parameters is none", status == status_no_such_law)
  end subroutine return_maps

  !> Trials within the radius stay; a margin takes those near it for slip.
  subroutine sticks_within(name, law, pressure, radius)
    character(*), intent(in) :: name
    class(friction_t), intent(in) :: law
    real(wp), intent(in) :: pressure, radius
    real(wp) :: derivative(2, 6), direction(2), traction(2), trial(2)
    integer :: state

    direction = [0.6_wp, -0.8_wp]
    trial = 0.999_wp * radius / metric_norm(direction, metric) * direction
    call return_map(trial, pressure, law, metric, 0.0_wp, traction, state, derivative)
    call expect_true(name // ": sticks", state == state_stick)
    call expect(name // ": keeps its trial", maxval(abs(traction - trial)), 0.0_wp)
    call return_map(trial, pressure, law, metric, 0.01_wp, traction, state, derivative)
    call expect_true(name // ": slips by margin", state == state_slip)
  end subroutine sticks_within

  !> Trials beyond are shortened to the radius, along themselves; derivatives by pressure, trial and metric.
  subroutine slips_beyond(name, law, pressure, radius)
    character(*), intent(in) :: name
    class(friction_t), intent(in) :: law
    real(wp), intent(in) :: pressure, radius
    real(wp) :: at(6), derivative(2, 6), lower(2), traction(2), unused(2, 6), upper(2)
    integer :: k, state

    at = [pressure, 1.1_wp, 1.7_wp, metric]
    call evaluate(law, at, traction, state, derivative)
    call expect_true(name // ": slips", state == state_slip)
    call expect(name // ": as far as it bears", abs(metric_norm(traction, metric) - radius), round_off)
    call expect(name // ": along the trial", abs(traction(1) * at(3) - traction(2) * at(2)), round_off)
    do k = 1, 6
      at(k) = at(k) + step
      call evaluate(law, at, upper, state, unused)
      at(k) = at(k) - 2.0_wp * step
      call evaluate(law, at, lower, state, unused)
      at(k) = at(k) + step
      call expect(name // ": derivative", maxval(abs((upper - lower) / (2.0_wp * step) - derivative(:, k))), by_difference)
    end do
  end subroutine slips_beyond

  subroutine evaluate(law, at, traction, state, derivative)
    class(friction_t), intent(in) :: law
    real(wp), intent(in) :: at(6)
    real(wp), intent(out) :: traction(2), derivative(2, 6)
    integer, intent(out) :: state

    call return_map(at(2:3), at(1), law, at(4:6), 0.0_wp, traction, state, derivative)
  end subroutine evaluate

end module test_return_map
