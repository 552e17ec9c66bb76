!> Residual and tangent of one solid element, by sum factorisation.
!>
!> - `u`, `v`, `w`: functions of the three directions in the element, or their pairs, at its Gauss points.
!> - `weight` (control points): weights of its control points.
!> - `samples`: everything at its Gauss points. `material`: its law. `room`: for what is on the way.
module isomortar_solid_element
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_balanced, is_symmetric
  use isomortar_base_status, only: status_folded, status_folded_initially, status_ok
  use isomortar_nurbs_patch, only: line_rule_t
  use isomortar_nurbs_tensor_product, only: integrate, integrate_pairs, interpolate, line_pairs_t, room_for_lines
  use isomortar_solid_material_law, only: component_pairs, material_t, stretch, stretch_t
  use isomortar_solid_points, only: cofactors, quotients
  implicit none
  private

  public :: element_residual, element_tangent, sample_element

  !> Everything at the quadrature points of an element that residual and tangent are made of.
  type, public :: samples_t
    !> The gradient of function a in the current configuration is w_a gradient(point, i, D) B_aD; B_aD are the value (D = 1) and the
    !> derivatives by the parameters (D = 2, 3, 4) of the product of functions without its weight w_a.
    real(wp), allocatable :: gradient(:, :, :)
    !> Quadrature weight times reference volume.
    real(wp), allocatable :: volume(:)
    type(stretch_t) :: state
    !> Smallest J of the current configuration over the points.
    real(wp) :: smallest_jacobian
  end type samples_t

  !> What is computed on the way to samples and forces, of control points or of quadrature points. A thread keeps it from element to
  !> element: to ask for memory anew each time takes a tenth as long as the forces.
  type, public :: room_t
    real(wp), dimension(:, :, :), allocatable :: cofactor, densities, displacement, gradient, grown, map, reference, stress, values
    real(wp), dimension(:, :), allocatable :: coefficients, denominator, sums
    real(wp), dimension(:), allocatable :: det, lines, scale
  end type room_t

contains

  !> Evaluate an element at all its quadrature points (theory 1.3, 2.6, 2.8).
  !>
  !> - `positions` (3, control points), `references` (3, control points): its own, now and in the reference configuration, L.
  !> - `status`: whether it is folded (isomortar_base_status).
  pure subroutine sample_element(u, v, w, weight, positions, references, room, samples, status)
    type(line_rule_t), intent(in) :: u, v, w
    real(wp), intent(in) :: weight(:), positions(:, :), references(:, :)
    type(room_t), intent(inout) :: room
    type(samples_t), intent(inout) :: samples
    integer, intent(out) :: status
    integer :: i, j, k, m

    if (contracts) call require(all(shape(references) == shape(positions)), "sample_element: references are those of the positions")
    if (contracts) call require(all(shape(positions) == [3, size(weight)]), "sample_element: positions are those of the element")
    m = size(u%weight) * size(v%weight) * size(w%weight)
    call reserve(samples, m)
    call make_room(u, v, w, room)
    call fields_at_points(u, v, w, weight, positions, references, room)
    call quotients(m, room%denominator, room%reference, room%map)
    call cofactors(m, room%map, room%cofactor, room%det)
    samples%smallest_jacobian = least(room%det)
    status = merge(status_ok, status_folded_initially, samples%smallest_jacobian > 0.0_wp)
    if (status /= status_ok) return
    samples%volume(:) = [(((u%weight(i) * v%weight(j) * w%weight(k), i=1, size(u%weight)), j=1, size(v%weight)), &
      k=1, size(w%weight))] * room%det
    call quotients(m, room%denominator, room%displacement, room%grown)
    room%scale(:) = 1.0_wp / room%det
    associate (cofactor => room%cofactor, grown => room%grown)
      do j = 1, 3
        do i = 1, 3
          room%gradient(:, i, j) = (grown(:, i, 1) * cofactor(:, j, 1) + grown(:, i, 2) * cofactor(:, j, 2) &
            + grown(:, i, 3) * cofactor(:, j, 3)) * room%scale
        end do
      end do
    end associate
    call stretch(room%gradient, samples%state)
    samples%smallest_jacobian = least(samples%state%jacobian)
    status = merge(status_ok, status_folded, samples%smallest_jacobian > 0.0_wp)
    if (status /= status_ok) return
    room%map(:, :, :) = room%map + room%grown
    call cofactors(m, room%map, room%cofactor, room%det)
    call spatial_gradients(m, room%cofactor, room%det, room%denominator, samples%gradient)
  end subroutine sample_element

  !> Make room for the first element of a body: the others are like it.
  pure subroutine make_room(u, v, w, room)
    type(line_rule_t), intent(in) :: u, v, w
    type(room_t), intent(inout) :: room
    integer :: m, n

    if (allocated(room%det)) return
    m = size(u%weight) * size(v%weight) * size(w%weight)
    n = size(u%values, 1) * size(v%values, 1) * size(w%values, 1)
    allocate (room%cofactor(m, 3, 3), room%gradient(m, 3, 3), room%grown(m, 3, 3), room%map(m, 3, 3), room%stress(m, 3, 3))
    allocate (room%displacement(m, 3, 4), room%reference(m, 3, 4), room%densities(3, m, 4), room%values(7, m, 4))
    allocate (room%coefficients(7, n), room%denominator(m, 4), room%sums(3, n))
    allocate (room%det(m), room%lines(room_for_lines(u, v, w, 7)), room%scale(m))
  end subroutine make_room

  !> `gradient` of samples_t, from `cofactor` and determinant, `det`, of the current map (theory 2.8).
  pure subroutine spatial_gradients(m, cofactor, det, denominator, gradient)
    integer, intent(in) :: m
    real(wp), intent(in) :: cofactor(m, 3, 3), det(m), denominator(m, 4)
    real(wp), intent(out) :: gradient(m, 3, 4)
    real(wp) :: by_det(m), by_weight(m)
    integer :: i

    by_weight = 1.0_wp / denominator(:, 1)
    by_det = by_weight / det
    do i = 1, 3
      gradient(:, i, 2) = cofactor(:, i, 1) * by_det
      gradient(:, i, 3) = cofactor(:, i, 2) * by_det
      gradient(:, i, 4) = cofactor(:, i, 3) * by_det
      gradient(:, i, 1) = -by_weight * (gradient(:, i, 2) * denominator(:, 2) + gradient(:, i, 3) * denominator(:, 3) &
        + gradient(:, i, 4) * denominator(:, 4))
    end do
  end subroutine spatial_gradients

  !> Weight, and weight times reference position and displacement, at the points, values and derivatives by the parameters:
  !> `denominator` (point, 4), `reference` (point, 3, 4), `displacement` (point, 3, 4) of the room.
  pure subroutine fields_at_points(u, v, w, weight, positions, references, room)
    type(line_rule_t), intent(in) :: u, v, w
    real(wp), intent(in) :: weight(:), positions(:, :), references(:, :)
    type(room_t), intent(inout) :: room
    integer :: a, i, kind

    do a = 1, size(weight) ! from the first control point, so that a rigid translation costs no digits
      room%coefficients(1, a) = weight(a)
      room%coefficients(2:4, a) = weight(a) * (references(:, a) - references(:, 1))
      room%coefficients(5:7, a) = weight(a) * ((positions(:, a) - references(:, a)) - (positions(:, 1) - references(:, 1)))
    end do
    call interpolate(u, v, w, 7, room%coefficients, room%values, room%lines)
    do kind = 1, 4
      room%denominator(:, kind) = room%values(1, :, kind)
      do i = 1, 3
        room%reference(:, i, kind) = room%values(1 + i, :, kind)
        room%displacement(:, i, kind) = room%values(4 + i, :, kind)
      end do
    end do
  end subroutine fields_at_points

  !> The first of some numbers that is not above zero, or else the smallest of them.
  pure real(wp) function least(numbers)
    real(wp), intent(in) :: numbers(:)
    integer :: q

    least = huge(1.0_wp)
    do q = 1, size(numbers)
      if (.not. numbers(q) > 0.0_wp) then
        least = numbers(q)
        return
      end if
      least = min(least, numbers(q))
    end do
  end function least

  !> Make room for m quadrature points.
  pure subroutine reserve(samples, m)
    type(samples_t), intent(inout) :: samples
    integer, intent(in) :: m

    if (allocated(samples%volume)) then
      if (size(samples%volume) == m) return
      deallocate (samples%gradient, samples%volume)
    end if
    allocate (samples%gradient(m, 3, 4), samples%volume(m))
  end subroutine reserve

  !> Internal forces `residual` (3, control points), F (theory 1.7), in the room that the samples were made in.
  pure subroutine element_residual(u, v, w, weight, samples, material, room, residual)
    type(line_rule_t), intent(in) :: u, v, w
    real(wp), intent(in) :: weight(:)
    type(samples_t), intent(in) :: samples
    class(material_t), intent(in) :: material
    type(room_t), intent(inout) :: room
    real(wp), intent(out) :: residual(:, :)
    integer :: a, d, i

    call material%stress(samples%state, room%stress)
    associate (g => samples%gradient, stress => room%stress)
      do i = 1, 3
        do d = 1, 4
          room%densities(i, :, d) = samples%volume * (stress(:, i, 1) * g(:, 1, d) + stress(:, i, 2) * g(:, 2, d) &
            + stress(:, i, 3) * g(:, 3, d))
        end do
      end do
    end associate
    call integrate(u, v, w, 3, room%densities, room%sums, room%lines)
    do a = 1, size(weight)
      residual(:, a) = weight(a) * room%sums(:, a)
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
    integer :: d, e, j, m, pair, q

    m = size(samples%volume)
    allocate (along(m, 3), densities(m, 6, 4, 4), moduli(m, 3, 3, 6))
    call material%tangent(samples%state, moduli)
    do q = 1, merge(m, 0, contracts) ! at all points, where contracts are looked at
      if (contracts) call require(is_symmetric(moduli(q, :, :, 1)), "element_tangent: a_1j1l is symmetric, the law has an energy")
      if (contracts) call require(is_symmetric(moduli(q, :, :, 2)), "element_tangent: so is a_2j2l")
      if (contracts) call require(is_symmetric(moduli(q, :, :, 3)), "element_tangent: so is a_3j3l")
    end do
    associate (g => samples%gradient)
      do e = 1, 4
        do pair = 1, 6
          do j = 1, 3
            along(:, j) = samples%volume * (moduli(:, j, 1, pair) * g(:, 1, e) + moduli(:, j, 2, pair) * g(:, 2, e) &
              + moduli(:, j, 3, pair) * g(:, 3, e))
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
