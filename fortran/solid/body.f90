!> A body as its elements see it: the functions at their Gauss points, and what the reference configuration gives there. It is
!> computed once: none of it changes while the body deforms.
!>
!> - `geometry`: what an element has at its Gauss points.
!> - `u`, `v`, `w`: functions of the three directions in an element at its Gauss points.
module isomortar_solid_body
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_index
  use isomortar_base_status, only: status_folded_initially, status_ok, status_out_of_memory
  use isomortar_nurbs_patch, only: element_count, element_nodes, element_of, line_rule, line_rule_t, patch_t
  use isomortar_nurbs_tensor_product, only: interpolate, room_for_lines
  use isomortar_solid_points, only: cofactors, least, quotients
  implicit none
  private

  public :: body_of, slopes

  !> What an element has at its Gauss points in the reference configuration.
  type, public :: geometry_t
    !> Derivatives of the reference position by the parameters, and of these by it: (point, component, parameter), L and 1/L.
    real(wp), allocatable :: map(:, :, :), inverse(:, :, :)
    !> Quadrature weight times reference volume, L^3.
    real(wp), allocatable :: volume(:)
    !> Sum of the functions times their weights, value and derivatives by the parameters: (point, 4); of a rational body alone.
    real(wp), allocatable :: denominator(:, :)
  end type geometry_t

  !> A body.
  type, public :: body_t
    !> Its mesh; weights that are all the same are 1.
    type(patch_t) :: patch
    !> Whether weights differ: else functions are the products of those of the directions.
    logical :: rational
    !> Reference positions of the patch's control points, shape (3, control points), L.
    real(wp), allocatable :: reference(:, :)
    !> Functions of the directions, by element.
    type(line_rule_t), allocatable :: u(:), v(:), w(:)
    type(geometry_t), allocatable :: element(:)
    !> Whether it is folded or memory ran out (isomortar_base_status), the first such element, from 1, and the least determinant of
    !> the map there.
    integer :: status, place
    real(wp) :: smallest_jacobian
  end type body_t

contains

  !> The body `self` of a `patch`.
  !>
  !> - `points`: Gauss points of an element by direction.
  !> - `references` (3, control points): of all control points in the reference configuration, L.
  subroutine body_of(patch, points, references, self)
    type(patch_t), intent(in) :: patch
    integer, intent(in) :: points(3)
    real(wp), intent(in) :: references(:, :)
    type(body_t), intent(out) :: self
    integer, allocatable :: status(:)
    real(wp), allocatable :: least_det(:)
    integer :: a, e

    if (contracts) call require(all(is_index(patch%point, size(references, 2))), "body_of: the patch is among the control points")
    self%patch = patch
    self%rational = any(abs(patch%weight - patch%weight(1)) > 0.0_wp)
    if (.not. self%rational) self%patch%weight(:) = 1.0_wp
    allocate (self%reference(3, size(patch%point)))
    do a = 1, size(patch%point) ! one by one: a section by a list is copied to the stack first
      self%reference(:, a) = references(:, patch%point(a))
    end do
    call line_rule(patch%direction(1), points(1), 1, self%u)
    call line_rule(patch%direction(2), points(2), 1, self%v)
    call line_rule(patch%direction(3), points(3), 1, self%w)
    allocate (self%element(element_count(patch)), status(element_count(patch)), least_det(element_count(patch)))
    !$omp parallel do default(none) shared(least_det, self, status) schedule(static)
    do e = 1, size(self%element)
      call take_geometry(self, e, self%element(e), least_det(e), status(e))
    end do
    !$omp end parallel do
    self%status = status_ok
    self%smallest_jacobian = minval(least_det)
    self%place = 0
    do e = size(status), 1, -1
      if (status(e) == status_ok) cycle
      self%status = status(e)
      self%smallest_jacobian = least_det(e)
      self%place = e
    end do
  end subroutine body_of

  !> `geometry` of element `e`, from 1, of a body that has all else; the `smallest` determinant of its map, and whether it is folded
  !> or memory ran out: `status`.
  pure subroutine take_geometry(self, e, geometry, smallest, status)
    type(body_t), intent(in) :: self
    integer, intent(in) :: e
    type(geometry_t), intent(inout) :: geometry
    real(wp), intent(out) :: smallest
    integer, intent(out) :: status
    integer :: at(3), local(product(self%patch%direction%order + 1))

    at = element_of(self%patch, e)
    call element_nodes(self%patch, at, local)
    associate (u => self%u(at(1)), v => self%v(at(2)), w => self%w(at(3)), weight => self%patch%weight(local))
      smallest = 0.0_wp
      call reserve(size(u%weight) * size(v%weight) * size(w%weight), self%rational, geometry, status)
      if (status /= status_ok) return
      if (self%rational) call take_denominator(u, v, w, weight, geometry%denominator)
      call take_map(u, v, w, weight, self%reference(:, local), geometry, smallest)
      status = merge(status_ok, status_folded_initially, smallest > 0.0_wp)
    end associate
  end subroutine take_geometry

  !> Make room for the geometry of an element of m Gauss points. `status`: whether there is (isomortar_base_status).
  pure subroutine reserve(m, rational, geometry, status)
    integer, intent(in) :: m
    logical, intent(in) :: rational
    type(geometry_t), intent(inout) :: geometry
    integer, intent(out) :: status
    integer :: failed

    allocate (geometry%map(m, 3, 3), stat=failed)
    if (failed == 0) allocate (geometry%inverse(m, 3, 3), stat=failed)
    if (failed == 0) allocate (geometry%volume(m), stat=failed)
    if (rational .and. failed == 0) allocate (geometry%denominator(m, 4), stat=failed)
    status = merge(status_ok, status_out_of_memory, failed == 0)
  end subroutine reserve

  !> Sum of the functions times their `weight`s, and its derivatives (theory 2.4).
  pure subroutine take_denominator(u, v, w, weight, denominator)
    type(line_rule_t), intent(in) :: u, v, w
    real(wp), intent(in) :: weight(:)
    real(wp), intent(out) :: denominator(:, :)
    real(wp), allocatable :: room(:)

    allocate (room(room_for_lines(u, v, w, 1)))
    call interpolate(u, v, w, 1, weight, denominator, room)
  end subroutine take_denominator

  !> The map from the parameters to the reference positions, `references` (3, control points), of an element whose denominators are
  !> known, its inverse, volumes, and the smallest determinant (theory 1.3, 2.8).
  pure subroutine take_map(u, v, w, weight, references, geometry, smallest)
    type(line_rule_t), intent(in) :: u, v, w
    real(wp), intent(in) :: weight(:), references(:, :)
    type(geometry_t), intent(inout) :: geometry
    real(wp), intent(out) :: smallest
    real(wp), allocatable :: coefficients(:, :), det(:), numerator(:, :, :), room(:), values(:, :, :)
    integer :: a, i, j, k, m

    m = size(geometry%volume)
    allocate (coefficients(3, size(weight)), det(m), numerator(m, 3, 4), room(room_for_lines(u, v, w, 3)), values(3, m, 4))
    do a = 1, size(weight) ! from the first control point, so that a rigid translation costs no digits
      coefficients(:, a) = weight(a) * (references(:, a) - references(:, 1))
    end do
    call interpolate(u, v, w, 3, coefficients, values, room)
    call slopes(geometry, values, numerator, geometry%map)
    call cofactors(m, geometry%map, geometry%inverse, det)
    smallest = least(det)
    if (.not. smallest > 0.0_wp) return
    do j = 1, 3
      do i = 1, 3
        geometry%inverse(:, i, j) = geometry%inverse(:, i, j) / det
      end do
    end do
    geometry%volume(:) = [(((u%weight(i) * v%weight(j) * w%weight(k), i=1, size(u%weight)), j=1, size(v%weight)), &
      k=1, size(w%weight))] * det
  end subroutine take_map

  !> Derivatives by the parameters of a field in three components: `slope` (point, component, parameter) (theory 1.3).
  !>
  !> - `values` (component, point, kind): sums of its coefficients times functions and weights, value and derivatives.
  !> - `numerator` (point, component, kind): room for them.
  pure subroutine slopes(geometry, values, numerator, slope)
    type(geometry_t), intent(in) :: geometry
    real(wp), intent(in) :: values(:, :, :)
    real(wp), contiguous, intent(inout) :: numerator(:, :, :)
    real(wp), contiguous, intent(out) :: slope(:, :, :)
    integer :: d, i

    if (allocated(geometry%denominator)) then
      do d = 1, 4
        do i = 1, 3
          numerator(:, i, d) = values(i, :, d)
        end do
      end do
      call quotients(size(slope, 1), geometry%denominator, numerator, slope)
    else
      do d = 1, 3
        do i = 1, 3
          slope(:, i, d) = values(i, :, 1 + d)
        end do
      end do
    end if
  end subroutine slopes

end module isomortar_solid_body
