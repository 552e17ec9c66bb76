!> Residuals and tangents of solid elements side by side, by sum factorisation.
!>
!> - `bundle`: the elements. `geometry`: what they have in the reference configuration.
!> - `material`: their law. `room`: for what is on the way, with the densities that forces and tangents are integrals of.
module isomortar_solid_element
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: lanes, wp
  use isomortar_base_predicate, only: is_balanced, is_symmetric
  use isomortar_base_status, only: status_folded, status_ok, status_out_of_memory
  use isomortar_nurbs_pairs, only: integrate_pairs, line_pairs_t, pair_of_kinds, room_for_pairs
  use isomortar_nurbs_tensor_product, only: integrate, interpolate
  use isomortar_solid_body, only: body_t, bundle_t, geometry_t, slopes_at
  use isomortar_solid_material_law, only: component_pairs, material_t, stretch, stretch_t
  use isomortar_solid_points, only: cofactors, least
  implicit none
  private

  public :: element_residuals, element_tangents, sample_elements

  !> Everything at a quadrature point of each element that residual and tangent are made of, beside their reference volume.
  type :: sample_t
    !> The gradient of function a in the current configuration is w_a gradient(lane, i, D) B_aD; B_aD are the value (D = 1) and the
    !> derivatives by the parameters (D = 2, 3, 4) of the product of functions without its weight w_a.
    real(wp) :: gradient(lanes, 3, 4)
    type(stretch_t) :: state
  end type sample_t

  !> A thread keeps it from bundle to bundle: to ask for memory anew each time takes as long as a part of the forces.
  type, public :: room_t
    !> Densities of forces, (lane, component, kind, point), and these integrated, (lane, control point, component).
    real(wp), allocatable :: forces(:, :, :, :), sums(:, :, :)
    !> Densities of tangents by element, (pair of components, point, pair of kinds, lane).
    real(wp), allocatable :: tangents(:, :, :, :)
    !> For what is on the way when these are integrated.
    real(wp), allocatable :: pairs(:)
  end type room_t

contains

  !> Evaluate elements at all their quadrature points: the densities of forces in the room and, `with_tangents`, those of tangents.
  !>
  !> - `body`: that they are of. `positions` (3, control points): of all control points, L.
  !> - `smallest`: least J of each. `status`: whether any is folded, or memory ran out (isomortar_base_status).
  pure subroutine sample_elements(body, bundle, geometry, positions, material, with_tangents, room, smallest, status)
    type(body_t), intent(in) :: body
    type(bundle_t), intent(inout) :: bundle
    type(geometry_t), intent(in) :: geometry
    real(wp), intent(in) :: positions(:, :)
    class(material_t), intent(in) :: material
    logical, intent(in) :: with_tangents
    type(room_t), intent(inout) :: room
    real(wp), intent(out) :: smallest(lanes)
    integer, intent(out) :: status
    type(sample_t) :: sample
    integer :: q

    smallest = huge(1.0_wp)
    call make_room(bundle, with_tangents, room, status)
    if (status /= status_ok) return
    call take_displacements(body, positions, bundle)
    call interpolate(bundle%u, bundle%v, bundle%w, 3, bundle%coefficients, bundle%first, bundle%values, bundle%lines)
    do q = 1, size(geometry%volume, 2)
      call take_sample(q, bundle, geometry, sample)
      smallest = least(smallest, sample%state%jacobian)
      if (.not. all(smallest > 0.0_wp)) cycle
      call take_forces(q, bundle%first, geometry, sample, material, room%forces(:, :, :, q))
      if (with_tangents) call take_tangents(q, bundle%first, geometry, sample, material, room%tangents)
    end do
    status = merge(status_ok, status_folded, all(smallest > 0.0_wp))
  end subroutine sample_elements

  !> Make room for the first elements of a body: the others are like them. `status`: whether there is.
  pure subroutine make_room(bundle, with_tangents, room, status)
    type(bundle_t), intent(in) :: bundle
    logical, intent(in) :: with_tangents
    type(room_t), intent(inout) :: room
    integer, intent(out) :: status
    integer :: failed, functions(3), points(3)

    failed = 0
    associate (m => size(bundle%values, 4), n => size(bundle%weight, 2))
      if (.not. allocated(room%forces)) allocate (room%forces(lanes, 3, bundle%first:4, m), stat=failed)
      if (failed == 0 .and. .not. allocated(room%sums)) allocate (room%sums(lanes, n, 3), stat=failed)
      if (failed == 0 .and. with_tangents .and. .not. allocated(room%tangents)) then
        allocate (room%tangents(6, m, 16, lanes), stat=failed)
        functions = [size(bundle%u%at_point, 2), size(bundle%v%at_point, 2), size(bundle%w%at_point, 2)]
        points = [size(bundle%u%weight, 2), size(bundle%v%weight, 2), size(bundle%w%weight, 2)]
        if (failed == 0) allocate (room%pairs(room_for_pairs(functions, points, 6)), stat=failed)
      end if
    end associate
    status = merge(status_ok, status_out_of_memory, failed == 0)
  end subroutine make_room

  !> Displacements of the control points times their weights as `coefficients` of the bundle (theory 1.3).
  pure subroutine take_displacements(body, positions, bundle)
    type(body_t), intent(in) :: body
    real(wp), intent(in) :: positions(:, :)
    type(bundle_t), intent(inout) :: bundle
    real(wp) :: moved(3), origin(3)
    integer :: a, l

    do l = 1, lanes
      associate (local => bundle%local(:, l))
        origin = positions(:, body%patch%point(local(1))) - body%reference(:, local(1))
        do a = 1, size(local) ! from the first control point, so that a rigid translation costs no digits
          moved = positions(:, body%patch%point(local(a))) - body%reference(:, local(a))
          bundle%coefficients(l, a, :) = bundle%weight(l, a) * (moved - origin)
        end do
      end associate
    end do
  end subroutine take_displacements

  !> Deformation and spatial gradients at point `q` (theory 1.3, 2.6).
  pure subroutine take_sample(q, bundle, geometry, sample)
    integer, intent(in) :: q
    type(bundle_t), intent(in) :: bundle
    type(geometry_t), intent(in) :: geometry
    type(sample_t), intent(out) :: sample
    real(wp) :: cofactor(lanes, 3, 3), det(lanes), grown(lanes, 3, 3), h(lanes, 3, 3)
    integer :: d, i, j

    call slopes_at(q, bundle, geometry, grown)
    associate (inverse => geometry%inverse(:, :, :, q))
      do j = 1, 3
        do i = 1, 3
          h(:, i, j) = grown(:, i, 1) * inverse(:, j, 1) + grown(:, i, 2) * inverse(:, j, 2) + grown(:, i, 3) * inverse(:, j, 3)
        end do
      end do
    end associate
    call stretch(h, sample%state)
    call cofactors(geometry%map(:, :, :, q) + grown, cofactor, det)
    det = 1.0_wp / det
    if (bundle%first == 1) det = det * geometry%weighting(:, 1, q)
    do d = 1, 3
      do i = 1, 3
        sample%gradient(:, i, 1 + d) = cofactor(:, i, d) * det
      end do
    end do
    if (bundle%first > 1) return
    associate (g => sample%gradient, weighting => geometry%weighting(:, :, q))
      do i = 1, 3
        g(:, i, 1) = -(g(:, i, 2) * weighting(:, 2) + g(:, i, 3) * weighting(:, 3) + g(:, i, 4) * weighting(:, 4))
      end do
    end associate
  end subroutine take_sample

  !> Densities of forces at point `q`, `forces` (lane, component, kind) (theory 1.7).
  pure subroutine take_forces(q, first, geometry, sample, material, forces)
    integer, intent(in) :: q, first
    type(geometry_t), intent(in) :: geometry
    type(sample_t), intent(in) :: sample
    class(material_t), intent(in) :: material
    real(wp), intent(out) :: forces(lanes, 3, first:4)
    real(wp) :: stress(lanes, 3, 3)
    integer :: d, i

    call material%stress(sample%state, stress)
    associate (g => sample%gradient)
      do d = first, 4
        do i = 1, 3
          forces(:, i, d) = geometry%volume(:, q) * (stress(:, i, 1) * g(:, 1, d) + stress(:, i, 2) * g(:, 2, d) &
            + stress(:, i, 3) * g(:, 3, d))
        end do
      end do
    end associate
  end subroutine take_forces

  !> Densities of tangents at point `q`, as in the room (theory 1.8).
  pure subroutine take_tangents(q, first, geometry, sample, material, tangents)
    integer, intent(in) :: q, first
    type(geometry_t), intent(in) :: geometry
    type(sample_t), intent(in) :: sample
    class(material_t), intent(in) :: material
    real(wp), contiguous, intent(inout) :: tangents(:, :, :, :)
    real(wp) :: along(lanes, 3), moduli(lanes, 3, 3, 6), density(lanes)
    integer :: d, e, j, l, pair

    call material%tangent(sample%state, moduli)
    do l = 1, lanes
      if (contracts) call require(is_symmetric(moduli(l, :, :, 1)), "take_tangents: a_1j1l is symmetric, the law has an energy")
      if (contracts) call require(is_symmetric(moduli(l, :, :, 2)), "take_tangents: so is a_2j2l")
      if (contracts) call require(is_symmetric(moduli(l, :, :, 3)), "take_tangents: so is a_3j3l")
    end do
    associate (g => sample%gradient)
      do e = first, 4
        do pair = 1, 6
          do j = 1, 3
            along(:, j) = geometry%volume(:, q) * (moduli(:, j, 1, pair) * g(:, 1, e) + moduli(:, j, 2, pair) * g(:, 2, e) &
              + moduli(:, j, 3, pair) * g(:, 3, e))
          end do
          do d = first, merge(e, 4, pair <= 3) ! K_ii is symmetric
            density = g(:, 1, d) * along(:, 1) + g(:, 2, d) * along(:, 2) + g(:, 3, d) * along(:, 3)
            tangents(pair, q, pair_of_kinds(d, e, 4), :) = density
            if (pair <= 3) tangents(pair, q, pair_of_kinds(e, d, 4), :) = density
          end do
        end do
      end do
    end associate
  end subroutine take_tangents

  !> Internal forces `residuals` (3, control points, elements), F, of the elements that are not repeated (theory 1.7).
  pure subroutine element_residuals(bundle, room, residuals)
    type(bundle_t), intent(inout) :: bundle
    type(room_t), intent(inout) :: room
    real(wp), intent(out) :: residuals(:, :, :)
    integer :: a, l

    call integrate(bundle%u, bundle%v, bundle%w, 3, room%forces, bundle%first, room%sums, bundle%lines)
    do l = 1, bundle%many
      do a = 1, size(bundle%weight, 2)
        residuals(:, a, l) = bundle%weight(l, a) * room%sums(l, a, :)
      end do
      if (contracts) call require(is_balanced(residuals(:, :, l)), "element_residuals: forces are in balance")
    end do
  end subroutine element_residuals

  !> The tangents K_ik, F/L, of `component_pairs` without the weights of the control points: `tangents` (numbers, elements), as (u,
  !> v, w, pair), where each of u, v, w runs over pairs of functions (theory 1.8).
  !>
  !> - `u` (elements), `v` (elements), `w` (elements): pairs of functions of the elements of each direction.
  pure subroutine element_tangents(u, v, w, bundle, room, tangents)
    type(line_pairs_t), intent(in) :: u(:), v(:), w(:)
    type(bundle_t), intent(in) :: bundle
    type(room_t), intent(inout) :: room
    real(wp), intent(out) :: tangents(:, :)
    integer :: l

    do l = 1, bundle%many
      associate (at => bundle%place(:, l))
        call integrate_pairs(u(at(1)), v(at(2)), w(at(3)), 6, room%tangents(:, :, :, l), bundle%first, tangents(:, l), room%pairs)
      end associate
    end do
  end subroutine element_tangents

end module isomortar_solid_element
