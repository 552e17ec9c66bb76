!> Residual and tangent of one solid element, by sum factorisation.
!>
!> - `u`, `v`, `w`: functions of the three directions in the element, or their pairs, at its Gauss points.
!> - `weight` (control points): weights of its control points.
!> - `samples`: everything at its Gauss points. `material`: its law.
module isomortar_solid_element
  use isomortar_base_algebra, only: determinant, inverse
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_balanced, is_symmetric
  use isomortar_base_status, only: status_folded, status_folded_initially, status_ok
  use isomortar_nurbs_patch, only: line_rule_t
  use isomortar_nurbs_tensor_product, only: integrate, integrate_pairs, interpolate, line_pairs_t
  use isomortar_solid_material_law, only: component_pairs, material_t, stretch, stretch_t
  implicit none
  private

  public :: element_residual, element_tangent, quotient, sample_element

  !> Everything at the quadrature points of an element that residual and tangent are made of.
  type, public :: samples_t
    !> The gradient of function a in the current configuration is w_a gradient(point, i, D) B_aD; B_aD are the value (D = 1) and the
    !> derivatives by the parameters (D = 2, 3, 4) of the product of functions without its weight w_a.
    real(wp), allocatable :: gradient(:, :, :)
    !> Quadrature weight times reference volume.
    real(wp), allocatable :: volume(:)
    type(stretch_t), allocatable :: state(:)
    !> Smallest J of the current configuration over the points.
    real(wp) :: smallest_jacobian
  end type samples_t

contains

  !> Evaluate an element at all its quadrature points (theory 1.3, 2.6, 2.8).
  !>
  !> - `positions` (3, control points), `references` (3, control points): its own, now and in the reference configuration, L.
  !> - `status`: whether it is folded (isomortar_base_status).
  pure subroutine sample_element(u, v, w, weight, positions, references, samples, status)
    type(line_rule_t), intent(in) :: u, v, w
    real(wp), intent(in) :: weight(:), positions(:, :), references(:, :)
    type(samples_t), intent(inout) :: samples
    integer, intent(out) :: status
    real(wp) :: coefficients(size(weight), 7), values(7, size(u%weight) * size(v%weight) * size(w%weight), 4)
    real(wp) :: f(3, 3), grown(3, 3), map(3, 3), reference_map(3, 3), det
    integer :: d, i, j, k, q

    status = status_ok
    if (contracts) call require(all(shape(references) == shape(positions)), "sample_element: references are those of the positions")
    if (contracts) call require(all(shape(positions) == [3, size(weight)]), "sample_element: positions are those of the element")
    call reserve(samples, size(values, 2))
    coefficients(:, 1) = weight
    do d = 1, 3 ! from the first control point, so that a rigid translation costs no digits
      coefficients(:, 1 + d) = weight * (references(d, :) - references(d, 1))
      coefficients(:, 4 + d) = weight * ((positions(d, :) - references(d, :)) - (positions(d, 1) - references(d, 1)))
    end do
    call interpolate(u, v, w, 7, coefficients, values)
    samples%smallest_jacobian = huge(1.0_wp)
    q = 0
    do k = 1, size(w%weight)
      do j = 1, size(v%weight)
        do i = 1, size(u%weight)
          q = q + 1
          reference_map = quotient(values(1, q, :), values(2:4, q, :))
          det = determinant(reference_map)
          if (.not. det > 0.0_wp) then
            status = status_folded_initially
            samples%smallest_jacobian = det
            return
          end if
          grown = quotient(values(1, q, :), values(5:7, q, :))
          call stretch(matmul(grown, inverse(reference_map, det)), samples%state(q))
          samples%volume(q) = u%weight(i) * v%weight(j) * w%weight(k) * det
          samples%smallest_jacobian = min(samples%smallest_jacobian, samples%state(q)%jacobian)
          if (.not. samples%state(q)%jacobian > 0.0_wp) then
            status = status_folded
            return
          end if
          map = reference_map + grown
          f = transpose(inverse(map, determinant(map))) / values(1, q, 1)
          samples%gradient(q, :, 1) = -matmul(f, values(1, q, 2:4)) / values(1, q, 1)
          samples%gradient(q, :, 2:4) = f
        end do
      end do
    end do
  end subroutine sample_element

  !> Derivatives by the parameters of a rational field: (component, parameter) (theory 1.3). `denominator` (4), `numerator` (3, 4):
  !> value and derivatives by the three parameters.
  pure function quotient(denominator, numerator) result(slope)
    real(wp), intent(in) :: denominator(4), numerator(3, 4)
    real(wp) :: slope(3, 3), scale
    integer :: d

    scale = 1.0_wp / denominator(1)
    do d = 1, 3
      slope(:, d) = (numerator(:, 1 + d) - numerator(:, 1) * (denominator(1 + d) * scale)) * scale
    end do
  end function quotient

  !> Make room for m quadrature points.
  pure subroutine reserve(samples, m)
    type(samples_t), intent(inout) :: samples
    integer, intent(in) :: m

    if (allocated(samples%volume)) then
      if (size(samples%volume) == m) return
      deallocate (samples%gradient, samples%volume, samples%state)
    end if
    allocate (samples%gradient(m, 3, 4), samples%volume(m), samples%state(m))
  end subroutine reserve

  !> Internal forces `residual` (3, control points), F (theory 1.7).
  pure subroutine element_residual(u, v, w, weight, samples, material, residual)
    type(line_rule_t), intent(in) :: u, v, w
    real(wp), intent(in) :: weight(:)
    type(samples_t), intent(in) :: samples
    class(material_t), intent(in) :: material
    real(wp), intent(out) :: residual(:, :)
    real(wp) :: densities(size(samples%volume), 3, 4), stress(3, 3), sums(3, size(weight))
    integer :: a, q

    do q = 1, size(samples%volume)
      call material%stress(samples%state(q), stress)
      densities(q, :, :) = matmul(samples%volume(q) * stress, samples%gradient(q, :, :))
    end do
    call integrate(u, v, w, 3, densities, sums)
    do a = 1, size(weight)
      residual(:, a) = weight(a) * sums(:, a)
    end do
    if (contracts) call require(is_balanced(residual), "element_residual: forces are in balance")
  end subroutine element_residual

  !> The tangents K_ik, F/L, of `component_pairs` without the weights of the control points: `tangent` (numbers), as (pair, u, v,
  !> w), where each of u, v, w runs over pairs of functions (theory 1.8).
  pure subroutine element_tangent(u, v, w, samples, material, tangent)
    type(line_pairs_t), intent(in) :: u, v, w
    type(samples_t), intent(in) :: samples
    class(material_t), intent(in) :: material
    real(wp), intent(out) :: tangent(:)
    real(wp), allocatable :: along(:, :), densities(:, :, :, :), moduli(:, :, :, :)
    real(wp) :: point(3, 3, 6)
    integer :: d, e, j, m, pair, q

    m = size(samples%volume)
    allocate (along(m, 3), densities(m, 6, 4, 4), moduli(m, 3, 3, 6))
    do q = 1, m
      call material%tangent(samples%state(q), point)
      if (contracts) call require(is_symmetric(point(:, :, 1)), "element_tangent: a_1j1l is symmetric, the law has an energy")
      if (contracts) call require(is_symmetric(point(:, :, 2)), "element_tangent: so is a_2j2l")
      if (contracts) call require(is_symmetric(point(:, :, 3)), "element_tangent: so is a_3j3l")
      moduli(q, :, :, :) = samples%volume(q) * point
    end do
    associate (g => samples%gradient)
      do e = 1, 4
        do pair = 1, 6
          do j = 1, 3
            along(:, j) = moduli(:, j, 1, pair) * g(:, 1, e) + moduli(:, j, 2, pair) * g(:, 2, e) &
              + moduli(:, j, 3, pair) * g(:, 3, e)
          end do
          do d = 1, merge(e, 4, pair <= 3) ! K_ii is symmetric
            densities(:, pair, d, e) = g(:, 1, d) * along(:, 1) + g(:, 2, d) * along(:, 2) + g(:, 3, d) * along(:, 3)
            if (pair <= 3) densities(:, pair, e, d) = densities(:, pair, d, e)
          end do
        end do
      end do
    end associate
    call integrate_pairs(u, v, w, 6, densities, tangent)
  end subroutine element_tangent

end module isomortar_solid_element
