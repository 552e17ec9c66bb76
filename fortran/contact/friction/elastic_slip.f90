!> Friction with elastic slip: the traction of a control point is a smooth function of its stretch, the slip that it gives back over
!> the largest one (theory 4.15).
!>
!> - `stretch` (2): its covariant components, L/P; its norm in the metric is a number.
!> - `metric` (3): a_ab as 11, 12, 22, L^2/P^2. `traction` (2): covariant, F/(L P).
module isomortar_contact_friction_elastic_slip
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_contact_friction_law, only: friction_t
  use isomortar_contact_friction_return_map, only: metric_norm, raise_index, state_slip, state_stick
  implicit none
  private

  public :: elastic_return

contains

  !> Traction of a `stretch` under `pressure`, F/L^2, by a law of `friction`, and its exact derivative (theory 4.15, 4.17).
  !>
  !> - `held`: take the slope of no stretch. Contact that has slid and turns back has none to tell how far it goes.
  !> - `state`: state_stick or state_slip.
  !> - `derivative` (2, 6): of the traction by the pressure (1), the stretch (2:3) and the metric (4:6).
  pure subroutine elastic_return(stretch, pressure, friction, metric, held, traction, state, derivative)
    real(wp), intent(in) :: stretch(2), pressure
    class(friction_t), intent(in) :: friction
    real(wp), intent(in) :: metric(3)
    logical, intent(in) :: held
    real(wp), intent(out) :: traction(2)
    integer, intent(out) :: state
    real(wp), intent(out) :: derivative(2, 6)
    real(wp) :: radius, slope, length, factor, by_length, contravariant(2), by_metric(3)
    integer :: a

    call friction%limit(pressure, radius, slope)
    if (contracts) call require(.not. radius < 0.0_wp, "elastic_return: friction has no negative limit")
    length = metric_norm(stretch, metric)
    if (length < 1.0_wp) then
      state = state_stick
      factor = 2.0_wp - length
      by_length = -1.0_wp
    else
      state = state_slip
      factor = 1.0_wp / length
      by_length = -factor**2
    end if
    traction = radius * factor * stretch
    derivative = 0.0_wp
    derivative(:, 1) = slope * factor * stretch
    if (held) factor = 2.0_wp
    derivative(1, 2) = radius * factor
    derivative(2, 3) = radius * factor
    if (held .or. length <= 0.0_wp) return
    contravariant = raise_index(stretch / length, metric)
    by_metric = -0.5_wp * length * [contravariant(1)**2, 2.0_wp * contravariant(1) * contravariant(2), contravariant(2)**2]
    do a = 1, 2
      derivative(a, 2:3) = derivative(a, 2:3) + radius * by_length * stretch(a) * contravariant
      derivative(a, 4:6) = radius * by_length * stretch(a) * by_metric
    end do
  end subroutine elastic_return

end module isomortar_contact_friction_elastic_slip
