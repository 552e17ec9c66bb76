!> Friction at a control point: the return map of a trial traction, by any law, and its exact derivative (theory 4.6).
!>
!> - `metric`: a_ab as 11, 12, 22, L^2/P^2. `traction`, `trial`: covariant tractions, F/(L P).
module isomortar_contact_friction_return_map
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: slack
  use isomortar_contact_friction_law, only: friction_t
  implicit none
  private

  public :: metric_norm, metric_matrix, raise_index, return_map

  integer, parameter, public :: state_open = 0
  integer, parameter, public :: state_stick = 1
  integer, parameter, public :: state_slip = 2

contains

  !> Symmetric 2x2 matrix from its 11, 12, 22 `entries`.
  pure function metric_matrix(entries) result(m)
    real(wp), intent(in) :: entries(3)
    real(wp) :: m(2, 2)

    m = reshape([entries(1), entries(2), entries(2), entries(3)], [2, 2])
  end function metric_matrix

  !> Contravariant components of `covariant` (2) ones, in a metric.
  pure function raise_index(covariant, metric) result(contravariant)
    real(wp), intent(in) :: covariant(2), metric(3)
    real(wp) :: contravariant(2)

    contravariant(1) = metric(3) * covariant(1) - metric(2) * covariant(2)
    contravariant(2) = metric(1) * covariant(2) - metric(2) * covariant(1)
    contravariant = contravariant / (metric(1) * metric(3) - metric(2)**2)
  end function raise_index

  !> Norm of covariant components in a metric; not a number where one of them is none, which `max` would drop (theory 4.2).
  pure real(wp) function metric_norm(traction, metric)
    real(wp), intent(in) :: traction(2), metric(3)
    real(wp) :: square

    square = dot_product(traction, raise_index(traction, metric))
    if (square < 0.0_wp) square = 0.0_wp
    metric_norm = sqrt(square)
  end function metric_norm

  !> Return the `trial` traction of a control point under `pressure`, F/L^2, to the disk of its `friction` law (theory 4.6, 4.13).
  !>
  !> - `margin`: a trial above (1 - margin) of the radius slips. `state`: state_open, state_stick or state_slip.
  !> - `derivative`(a, :): d traction_a by the pressure (1), the trial traction (2:3) and the metric (4:6: 11, 12, 22).
  !> - `radial`: replaces the traction in the part of the derivative that shortens the trial: the current traction there is more
  !>   forgiving on the way and the same at the solution (theory 4.14).
  pure subroutine return_map(trial, pressure, friction, metric, margin, traction, state, derivative, radial)
    real(wp), intent(in) :: trial(2), pressure
    class(friction_t), intent(in) :: friction
    real(wp), intent(in) :: metric(3), margin
    real(wp), intent(out) :: traction(2)
    integer, intent(out) :: state
    real(wp), intent(out) :: derivative(2, 6)
    real(wp), intent(in), optional :: radial(2)
    real(wp) :: radius, slope, length, along(2), contravariant(2), ratio, by_metric(3), shortened(2)
    integer :: a

    if (contracts) call require(margin >= 0.0_wp .and. margin <= 1.0_wp, "return_map: the margin is a share")
    call friction%limit(pressure, radius, slope)
    if (contracts) call require(.not. radius < 0.0_wp, "return_map: friction has no negative limit")
    length = metric_norm(trial, metric)
    derivative = 0.0_wp
    if (length <= radius * (1.0_wp - margin)) then
      state = state_stick
      traction = trial
      derivative(1, 2) = 1.0_wp
      derivative(2, 3) = 1.0_wp
      return
    end if
    state = state_slip
    along = trial / length
    contravariant = raise_index(along, metric)
    ratio = radius / length
    traction = radius * along
    if (contracts) call require(.not. abs(metric_norm(traction, metric) - radius) > slack * radius, "return_map: to the edge")
    shortened = traction / length
    if (present(radial)) shortened = onto_disk(radial, radius, metric) / length
    by_metric = -0.5_wp * length * [contravariant(1)**2, 2.0_wp * contravariant(1) * contravariant(2), contravariant(2)**2]
    do a = 1, 2
      derivative(a, 1) = slope * along(a)
      derivative(a, 1 + a) = ratio
      derivative(a, 2:3) = derivative(a, 2:3) - shortened(a) * contravariant
      derivative(a, 4:6) = -shortened(a) * by_metric
    end do
  end subroutine return_map

  !> A traction, shortened to a radius where it is longer (theory 4.14).
  pure function onto_disk(traction, radius, metric) result(shortened)
    real(wp), intent(in) :: traction(2), radius, metric(3)
    real(wp) :: shortened(2)
    real(wp) :: length

    shortened = traction
    length = metric_norm(traction, metric)
    if (length > radius) shortened = traction * (radius / length)
  end function onto_disk

end module isomortar_contact_friction_return_map
