!> A body as its elements see it: the functions at their Gauss points, and what the reference configuration gives there. None of it
!> changes while the body deforms.
!>
!> - `geometry`: what an element has at its Gauss points. `room`: for what is on the way.
!> - `u`, `v`, `w`: functions of the three directions in an element at its Gauss points.
!> - `weight` (control points): weights of its control points.
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

  public :: body_of, slopes, take_geometry

  !> What an element has at its Gauss points in the reference configuration.
  type, public :: geometry_t
    !> Whether it is folded, or memory ran out (isomortar_base_status), and the least determinant of its map.
    integer :: status
    real(wp) :: smallest
    !> Derivatives of the reference position by the parameters, and of these by it: (point, component, parameter), L/P and P/L.
    real(wp), allocatable :: map(:, :, :), inverse(:, :, :)
    !> Quadrature weight times reference volume, L^3.
    real(wp), allocatable :: volume(:)
    !> 1/W, and the derivatives of W by the parameters over W, of the sum W of functions times weights: (point, 4); of a rational
    !> body alone.
    real(wp), allocatable :: weighting(:, :)
  end type geometry_t

  !> What is computed on the way to the geometry of an element. A thread keeps it from element to element.
  type, public :: geometry_room_t
    real(wp), dimension(:, :, :), allocatable :: numerator, values
    real(wp), allocatable :: coefficients(:, :), det(:), lines(:)
  end type geometry_room_t

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
    !> What its elements have, where that is kept.
    type(geometry_t), allocatable :: element(:)
  end type body_t

contains

  !> The body `self` of a `patch`.
  !>
  !> - `points`: Gauss points of an element by direction.
  !> - `references` (3, control points): of all control points in the reference configuration, L.
  !> - `keeps`: whether what the elements have is computed here, once. `status`: whether memory ran out (isomortar_base_status).
  subroutine body_of(patch, points, references, keeps, self, status)
    type(patch_t), intent(in) :: patch
    integer, intent(in) :: points(3)
    real(wp), intent(in) :: references(:, :)
    logical, intent(in) :: keeps
    type(body_t), intent(out) :: self
    integer, intent(out) :: status
    type(geometry_room_t) :: room
    type(geometry_t), allocatable :: element(:)
    integer :: a, e, failed

    if (contracts) call require(all(is_index(patch%point, size(references, 2))), "body_of: the patch is among the control points")
    status = status_out_of_memory
    self%patch = patch
    self%rational = any(abs(patch%weight - patch%weight(1)) > 0.0_wp)
    if (.not. self%rational) self%patch%weight(:) = 1.0_wp
    allocate (self%reference(3, size(patch%point)), stat=failed)
    if (failed /= 0) return
    do a = 1, size(patch%point) ! one by one: a section by a list is copied to the stack first
      self%reference(:, a) = references(:, patch%point(a))
    end do
    call line_rule(patch%direction(1), points(1), 1, self%u)
    call line_rule(patch%direction(2), points(2), 1, self%v)
    call line_rule(patch%direction(3), points(3), 1, self%w)
    status = status_ok
    if (.not. keeps) return
    allocate (element(element_count(patch)))
    !$omp parallel do default(none) private(room) shared(element, self) schedule(static)
    do e = 1, size(element)
      call take_geometry(self, e, room, element(e))
    end do
    !$omp end parallel do
    if (any(element%status == status_out_of_memory)) status = status_out_of_memory
    call move_alloc(element, self%element)
  end subroutine body_of

  !> Compute the geometry of element `e`, from 1, of a body, `self`.
  pure subroutine take_geometry(self, e, room, geometry)
    type(body_t), intent(in) :: self
    integer, intent(in) :: e
    type(geometry_room_t), intent(inout) :: room
    type(geometry_t), intent(inout) :: geometry
    integer :: at(3), local(product(self%patch%direction%order + 1))

    at = element_of(self%patch, e)
    call element_nodes(self%patch, at, local)
    associate (u => self%u(at(1)), v => self%v(at(2)), w => self%w(at(3)), weight => self%patch%weight(local))
      geometry%smallest = 0.0_wp
      call reserve(size(u%weight) * size(v%weight) * size(w%weight), self%rational, geometry)
      if (geometry%status == status_ok) call make_room(u, v, w, size(weight), room, geometry%status)
      if (geometry%status /= status_ok) return
      if (self%rational) call take_weighting(u, v, w, weight, room%lines, geometry%weighting)
      call take_map(u, v, w, weight, self%reference(:, local), room, geometry)
    end associate
  end subroutine take_geometry

  !> Make room for the geometry of an element of m Gauss points; its status says whether there is.
  pure subroutine reserve(m, rational, geometry)
    integer, intent(in) :: m
    logical, intent(in) :: rational
    type(geometry_t), intent(inout) :: geometry
    integer :: failed

    failed = 0
    if (.not. allocated(geometry%map)) allocate (geometry%map(m, 3, 3), stat=failed)
    if (failed == 0 .and. .not. allocated(geometry%inverse)) allocate (geometry%inverse(m, 3, 3), stat=failed)
    if (failed == 0 .and. .not. allocated(geometry%volume)) allocate (geometry%volume(m), stat=failed)
    if (failed == 0 .and. rational .and. .not. allocated(geometry%weighting)) allocate (geometry%weighting(m, 4), stat=failed)
    geometry%status = merge(status_ok, status_out_of_memory, failed == 0)
  end subroutine reserve

  !> Make room for the first element, of n control points: the others are like it. `status`: whether there is.
  pure subroutine make_room(u, v, w, n, room, status)
    type(line_rule_t), intent(in) :: u, v, w
    integer, intent(in) :: n
    type(geometry_room_t), intent(inout) :: room
    integer, intent(out) :: status
    integer :: failed, m

    failed = 0
    m = size(u%weight) * size(v%weight) * size(w%weight)
    if (.not. allocated(room%numerator)) allocate (room%numerator(m, 3, 4), stat=failed)
    if (failed == 0 .and. .not. allocated(room%values)) allocate (room%values(3, m, 4), stat=failed)
    if (failed == 0 .and. .not. allocated(room%coefficients)) allocate (room%coefficients(3, n), stat=failed)
    if (failed == 0 .and. .not. allocated(room%det)) allocate (room%det(m), stat=failed)
    if (failed == 0 .and. .not. allocated(room%lines)) allocate (room%lines(room_for_lines(u, v, w, 3)), stat=failed)
    status = merge(status_ok, status_out_of_memory, failed == 0)
  end subroutine make_room

  !> `weighting` of an element from the sum of its functions times weights (theory 2.4).
  pure subroutine take_weighting(u, v, w, weight, lines, weighting)
    type(line_rule_t), intent(in) :: u, v, w
    real(wp), intent(in) :: weight(:)
    real(wp), contiguous, intent(inout) :: lines(:)
    real(wp), contiguous, intent(out) :: weighting(:, :)
    integer :: d

    call interpolate(u, v, w, 1, weight, weighting, lines)
    weighting(:, 1) = 1.0_wp / weighting(:, 1)
    do d = 2, 4
      weighting(:, d) = weighting(:, d) * weighting(:, 1)
    end do
  end subroutine take_weighting

  !> The map from the parameters to the reference positions, `references` (3, control points), of an element whose weighting is
  !> known, its inverse, volumes, and whether it is folded (theory 1.3, 2.8).
  pure subroutine take_map(u, v, w, weight, references, room, geometry)
    type(line_rule_t), intent(in) :: u, v, w
    real(wp), intent(in) :: weight(:), references(:, :)
    type(geometry_room_t), intent(inout) :: room
    type(geometry_t), intent(inout) :: geometry
    integer :: a, i, j, k, q

    do a = 1, size(weight) ! from the first control point, so that a rigid translation costs no digits
      room%coefficients(:, a) = weight(a) * (references(:, a) - references(:, 1))
    end do
    call interpolate(u, v, w, 3, room%coefficients, room%values, room%lines)
    call slopes(room%values, room%numerator, geometry%map, geometry%weighting)
    call cofactors(size(room%det), geometry%map, geometry%inverse, room%det)
    geometry%smallest = least(room%det)
    geometry%status = merge(status_ok, status_folded_initially, geometry%smallest > 0.0_wp)
    if (geometry%status /= status_ok) return
    do j = 1, 3
      do i = 1, 3
        geometry%inverse(:, i, j) = geometry%inverse(:, i, j) / room%det
      end do
    end do
    q = 0
    do k = 1, size(w%weight)
      do j = 1, size(v%weight)
        do i = 1, size(u%weight)
          q = q + 1
          geometry%volume(q) = u%weight(i) * v%weight(j) * w%weight(k) * room%det(q)
        end do
      end do
    end do
  end subroutine take_map

  !> Derivatives by the parameters of a field in three components: `slope` (point, component, parameter) (theory 1.3).
  !>
  !> - `values` (component, point, kind): sums of its coefficients times functions and weights, value and derivatives.
  !> - `numerator` (point, component, kind): room for them.
  !> - `weighting` (point, 4): of a rational element, as of geometry_t.
  pure subroutine slopes(values, numerator, slope, weighting)
    real(wp), contiguous, intent(in) :: values(:, :, :)
    real(wp), contiguous, intent(inout) :: numerator(:, :, :)
    real(wp), contiguous, intent(out) :: slope(:, :, :)
    real(wp), contiguous, intent(in), optional :: weighting(:, :)
    integer :: d, i

    if (present(weighting)) then
      do d = 1, 4
        do i = 1, 3
          numerator(:, i, d) = values(i, :, d)
        end do
      end do
      call quotients(size(slope, 1), weighting, numerator, slope)
    else
      do d = 1, 3
        do i = 1, 3
          slope(:, i, d) = values(i, :, 1 + d)
        end do
      end do
    end if
  end subroutine slopes

end module isomortar_solid_body
