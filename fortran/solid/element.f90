!> Residual and tangent of one solid element, by sum factorisation.
!>
!> - `u`, `v`, `w`: functions of the three directions in the element, or their pairs, at its Gauss points.
!> - `weight` (control points): weights of its control points. `geometry`: what it has in the reference configuration.
!> - `samples`: everything at its Gauss points. `material`: its law. `room`: for what is on the way.
module isomortar_solid_element
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_balanced, is_symmetric
  use isomortar_base_status, only: status_folded, status_ok
  use isomortar_nurbs_patch, only: line_rule_t
  use isomortar_nurbs_tensor_product, only: integrate, integrate_pairs, interpolate, line_pairs_t, room_for_lines
  use isomortar_solid_body, only: geometry_t, slopes
  use isomortar_solid_material_law, only: component_pairs, material_t, stretch, stretch_t
  use isomortar_solid_points, only: cofactors, least
  implicit none
  private

  public :: element_residual, element_tangent, sample_element

  !> Everything at the quadrature points of an element that residual and tangent are made of, beside its reference volume.
  type, public :: samples_t
    !> The gradient of function a in the current configuration is w_a gradient(point, i, D) B_aD; B_aD are the value (D = 1) and the
    !> derivatives by the parameters (D = 2, 3, 4) of the product of functions without its weight w_a.
    real(wp), allocatable :: gradient(:, :, :)
    type(stretch_t) :: state
    !> Smallest J of the current configuration over the points.
    real(wp) :: smallest_jacobian
  end type samples_t

  !> What is computed on the way to samples and forces, of control points or of quadrature points. A thread keeps it from element to
  !> element: to ask for memory anew each time takes a tenth as long as the forces.
  type, public :: room_t
    real(wp), dimension(:, :, :), allocatable :: cofactor, densities, gradient, grown, map, numerator, stress, values
    real(wp), dimension(:, :), allocatable :: coefficients, sums
    real(wp), dimension(:), allocatable :: det, lines
  end type room_t

contains

  !> Evaluate an element at all its quadrature points (theory 1.3, 2.6).
  !>
  !> - `positions` (3, control points), `references` (3, control points): its own, now and in the reference configuration, L.
  !> - `status`: whether it is folded (isomortar_base_status).
  pure subroutine sample_element(u, v, w, geometry, weight, positions, references, room, samples, status)
    type(line_rule_t), intent(in) :: u, v, w
    type(geometry_t), intent(in) :: geometry
    real(wp), intent(in) :: weight(:), positions(:, :), references(:, :)
    type(room_t), intent(inout) :: room
    type(samples_t), intent(inout) :: samples
    integer, intent(out) :: status
    integer :: a, i, j

    if (contracts) call require(all(shape(references) == shape(positions)), "sample_element: references are those of the positions")
    if (contracts) call require(all(shape(positions) == [3, size(weight)]), "sample_element: positions are those of the element")
    call reserve(samples, size(geometry%volume))
    call make_room(u, v, w, size(geometry%volume), room)
    do a = 1, size(weight) ! from the first control point, so that a rigid translation costs no digits
      room%coefficients(:, a) = weight(a) * ((positions(:, a) - references(:, a)) - (positions(:, 1) - references(:, 1)))
    end do
    call interpolate(u, v, w, 3, room%coefficients, room%values, room%lines)
    call slopes(room%values, room%numerator, room%grown, geometry%weighting)
    associate (inverse => geometry%inverse, grown => room%grown)
      do j = 1, 3
        do i = 1, 3
          room%gradient(:, i, j) = grown(:, i, 1) * inverse(:, j, 1) + grown(:, i, 2) * inverse(:, j, 2) &
            + grown(:, i, 3) * inverse(:, j, 3)
        end do
      end do
    end associate
    call stretch(room%gradient, samples%state)
    samples%smallest_jacobian = least(samples%state%jacobian)
    status = merge(status_ok, status_folded, samples%smallest_jacobian > 0.0_wp)
    if (status /= status_ok) return
    room%map(:, :, :) = geometry%map + room%grown
    call cofactors(size(geometry%volume), room%map, room%cofactor, room%det)
    call spatial_gradients(geometry, room%cofactor, room%det, samples%gradient)
  end subroutine sample_element

  !> Make room for the first element of a body, of m quadrature points: the others are like it.
  pure subroutine make_room(u, v, w, m, room)
    type(line_rule_t), intent(in) :: u, v, w
    integer, intent(in) :: m
    type(room_t), intent(inout) :: room
    integer :: n

    if (allocated(room%det)) return
    n = size(u%values, 1) * size(v%values, 1) * size(w%values, 1)
    allocate (room%cofactor(m, 3, 3), room%gradient(m, 3, 3), room%grown(m, 3, 3), room%map(m, 3, 3), room%stress(m, 3, 3))
    allocate (room%numerator(m, 3, 4), room%densities(3, m, 4), room%values(3, m, 4))
    allocate (room%coefficients(3, n), room%sums(3, n), room%det(m), room%lines(room_for_lines(u, v, w, 3)))
  end subroutine make_room

  !> `gradient` of samples_t, from `cofactor` and determinant of the current map; `det`, this, is used up (theory 2.6).
  pure subroutine spatial_gradients(geometry, cofactor, det, gradient)
    type(geometry_t), intent(in) :: geometry
    real(wp), contiguous, intent(in) :: cofactor(:, :, :)
    real(wp), contiguous, intent(inout) :: det(:)
    real(wp), contiguous, intent(out) :: gradient(:, :, :)
    integer :: d, i

    det = 1.0_wp / det
    if (allocated(geometry%weighting)) det = det * geometry%weighting(:, 1)
    do d = 1, 3
      do i = 1, 3
        gradient(:, i, 1 + d) = cofactor(:, i, d) * det
      end do
    end do
    gradient(:, :, 1) = 0.0_wp
    if (.not. allocated(geometry%weighting)) return
    associate (weighting => geometry%weighting)
      do i = 1, 3
        gradient(:, i, 1) = -(gradient(:, i, 2) * weighting(:, 2) + gradient(:, i, 3) * weighting(:, 3) &
          + gradient(:, i, 4) * weighting(:, 4))
      end do
    end associate
  end subroutine spatial_gradients

  !> Make room for m quadrature points.
  pure subroutine reserve(samples, m)
    type(samples_t), intent(inout) :: samples
    integer, intent(in) :: m

    if (allocated(samples%gradient)) then
      if (size(samples%gradient, 1) == m) return
      deallocate (samples%gradient)
    end if
    allocate (samples%gradient(m, 3, 4))
  end subroutine reserve

  !> Internal forces `residual` (3, control points), F (theory 1.7), in the room that the samples were made in.
  pure subroutine element_residual(u, v, w, geometry, weight, samples, material, room, residual)
    type(line_rule_t), intent(in) :: u, v, w
    type(geometry_t), intent(in) :: geometry
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
          room%densities(i, :, d) = geometry%volume * (stress(:, i, 1) * g(:, 1, d) + stress(:, i, 2) * g(:, 2, d) &
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
  pure subroutine element_tangent(u, v, w, geometry, samples, material, tangent)
    type(line_pairs_t), intent(in) :: u, v, w
    type(geometry_t), intent(in) :: geometry
    type(samples_t), intent(in) :: samples
    class(material_t), intent(in) :: material
    real(wp), intent(out) :: tangent(:)
    real(wp), allocatable :: along(:, :), densities(:, :, :, :), moduli(:, :, :, :)
    integer :: d, e, j, m, pair, q

    m = size(geometry%volume)
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
            along(:, j) = geometry%volume * (moduli(:, j, 1, pair) * g(:, 1, e) + moduli(:, j, 2, pair) * g(:, 2, e) &
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
