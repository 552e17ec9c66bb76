!> The material laws (isomortar_solid_material_table): stresses, their tangents, rest and rotation.
module test_materials
  use isomortar_base_algebra, only: identity, inverse
  use isomortar_base_kinds, only: lanes, wp
  use isomortar_solid_material_law, only: component_pairs, material_t, stretch, stretch_t
  use isomortar_solid_material_table, only: law_linear_elastic, law_neo_hookean, law_neo_hookean_j, material_of
  use testing, only: by_difference, expect, random_numbers, round_off, step
  implicit none
  private

  public :: materials

contains

  subroutine materials()
    class(material_t), allocatable :: law
    integer :: status

    call material_of(law_neo_hookean, [2.0_wp, 5.0_wp], law, status)
    call answers("neo-Hookean", law)
    call turns("neo-Hookean", law)
    call material_of(law_neo_hookean_j, [2.0_wp, 5.0_wp], law, status)
    call answers("neo-Hookean in J", law)
    call turns("neo-Hookean in J", law)
    call material_of(law_linear_elastic, [2.0_wp, 5.0_wp], law, status)
    call answers("linear elastic", law)
  end subroutine materials

  !> Of every law: no stress at rest, small stresses of Hooke's law, and a tangent that is the stress's derivative.
  subroutine answers(name, law)
    character(*), intent(in) :: name
    class(material_t), intent(in) :: law
    real(wp) :: along(3, 3), gradient(3, 3), numbers(9), piola(3, 3), small(3, 3), trace

    gradient = 0.0_wp
    call expect(name // ": nothing at rest", maxval(abs(first_piola(law, gradient))), 0.0_wp)
    call random_numbers(numbers)
    along = reshape(numbers, [3, 3])
    small = 0.5_wp * (along + transpose(along))
    piola = (first_piola(law, step * small) - first_piola(law, -step * small)) / (2.0_wp * step)
    trace = small(1, 1) + small(2, 2) + small(3, 3)
    small = 10.0_wp * (small - trace / 3.0_wp * identity) + 2.0_wp * trace * identity
    call expect(name // ": Hooke's law near rest", maxval(abs(piola - small)), by_difference)
    call random_numbers(numbers)
    call tangent_is_derivative(name, law, 0.2_wp * reshape(numbers, [3, 3]))
  end subroutine answers

  !> a_ijkl = F_jJ (dP_iJ / dF_kL) F_lL, component by component.
  subroutine tangent_is_derivative(name, law, gradient)
    character(*), intent(in) :: name
    class(material_t), intent(in) :: law
    real(wp), intent(in) :: gradient(3, 3)
    real(wp) :: change(3, 3), deformation(3, 3), error, moduli(lanes, 3, 3, 6), shift(3, 3)
    type(stretch_t) :: state
    integer :: i, k, l, pair

    deformation = identity + gradient
    call stretch(spread(gradient, 1, lanes), state)
    call law%tangent(state, moduli)
    error = 0.0_wp
    do pair = 1, 6
      i = component_pairs(1, pair)
      k = component_pairs(2, pair)
      do l = 1, 3
        shift = 0.0_wp
        shift(k, :) = step * deformation(l, :)
        change = (first_piola(law, gradient + shift) - first_piola(law, gradient - shift)) / (2.0_wp * step)
        error = max(error, maxval(abs(matmul(deformation, change(i, :)) - moduli(1, :, l, pair))))
      end do
    end do
    call expect(name // ": tangent", error, by_difference)
  end subroutine tangent_is_derivative

  !> A turn of the deformed body turns its stresses.
  subroutine turns(name, law)
    character(*), intent(in) :: name
    class(material_t), intent(in) :: law
    real(wp) :: deformation(3, 3), error, numbers(9), turn(3, 3)

    call random_numbers(numbers)
    deformation = identity + 0.2_wp * reshape(numbers, [3, 3])
    turn = reshape([0.6_wp, 0.0_wp, -0.8_wp, 0.0_wp, 1.0_wp, 0.0_wp, 0.8_wp, 0.0_wp, 0.6_wp], [3, 3])
    error = maxval(abs(first_piola(law, matmul(turn, deformation) - identity) &
      - matmul(turn, first_piola(law, deformation - identity))))
    call expect(name // ": turns with its body", error, round_off)
  end subroutine turns

  !> P = tau F^-T.
  function first_piola(law, gradient) result(piola)
    class(material_t), intent(in) :: law
    real(wp), intent(in) :: gradient(3, 3)
    real(wp) :: kirchhoff(lanes, 3, 3), piola(3, 3)
    type(stretch_t) :: state

    call stretch(spread(gradient, 1, lanes), state)
    call law%stress(state, kirchhoff)
    piola = matmul(kirchhoff(1, :, :), transpose(inverse(identity + gradient, state%jacobian(1))))
  end function first_piola

end module test_materials
