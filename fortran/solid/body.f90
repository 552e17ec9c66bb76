!> A body as its elements see it: the functions at their Gauss points, and what the reference configuration gives there. None of it
!> changes while the body deforms.
!>
!> Elements are computed side by side, `lanes` of them a bundle: the lane runs fastest in every array. The last bundle of a body is
!> filled up by its last element.
!>
!> - `bundle`: elements side by side, their functions, and room for sums over them.
!> - `geometry`: what they have at their Gauss points.
module isomortar_solid_body
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: lanes, wp
  use isomortar_base_predicate, only: is_index
  use isomortar_base_status, only: status_folded_initially, status_ok, status_out_of_memory
  use isomortar_nurbs_patch, only: element_count, element_nodes, element_of, line_rule, line_rule_t, patch_t
  use isomortar_nurbs_tensor_product, only: interpolate, lines_t, room_for_lines, side_by_side
  use isomortar_solid_points, only: cofactors, least, quotients
  implicit none
  private

  public :: body_of, bundle_count, slopes_at, take_bundle, take_geometry

  !> Elements side by side. A thread goes from one to the next with the same room.
  type, public :: bundle_t
    !> How many of them there are beside the repeated ones, and whether memory ran out (isomortar_base_status).
    integer :: many, status
    !> Their numbers by direction, from 1: (direction, lane), and those of their control points in the patch: (control point, lane).
    integer, allocatable :: place(:, :), local(:, :)
    !> Weights of the control points: (lane, control point).
    real(wp), allocatable :: weight(:, :)
    !> Functions of the directions at their Gauss points, and the first kind of them that is used: of a rational body 1, the values,
    !> else 2.
    type(lines_t) :: u, v, w
    integer :: first
    !> Coefficients of a field of three components, (lane, control point, component), the field and its derivatives, (lane,
    !> component, kind, point), and room for sums along lines.
    real(wp), allocatable :: coefficients(:, :, :), values(:, :, :, :), lines(:)
  end type bundle_t

  !> What elements side by side have at their Gauss points in the reference configuration.
  type, public :: geometry_t
    !> Whether any is folded, or memory ran out (isomortar_base_status), and the least determinants of their maps.
    integer :: status
    real(wp) :: smallest(lanes)
    !> Derivatives of the reference position by the parameters, and of these by it: (lane, component, parameter, point), L/P and
    !> P/L.
    real(wp), allocatable :: map(:, :, :, :), inverse(:, :, :, :)
    !> Quadrature weight times reference volume, (lane, point), L^3; where any is folded determinants alone.
    real(wp), allocatable :: volume(:, :)
    !> 1/W, and the derivatives of W by the parameters over W, of the sum W of functions times weights: (lane, 4, point); of a
    !> rational body alone.
    real(wp), allocatable :: weighting(:, :, :)
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
    !> What its bundles have, where that is kept.
    type(geometry_t), allocatable :: geometry(:)
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
    type(bundle_t) :: bundle
    type(geometry_t), allocatable :: geometry(:)
    integer :: a, failed, k

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
    allocate (geometry(bundle_count(self)))
    !$omp parallel do default(none) private(bundle) shared(geometry, self) schedule(static)
    do k = 1, size(geometry)
      call take_bundle(self, k, bundle)
      call take_geometry(self, bundle, geometry(k))
    end do
    !$omp end parallel do
    if (any(geometry%status == status_out_of_memory)) status = status_out_of_memory
    call move_alloc(geometry, self%geometry)
  end subroutine body_of

  !> How many bundles of elements a body has.
  pure integer function bundle_count(self)
    type(body_t), intent(in) :: self

    bundle_count = (element_count(self%patch) + lanes - 1) / lanes
  end function bundle_count

  !> Put the elements of bundle `k`, from 1, of a body, `self`, side by side.
  pure subroutine take_bundle(self, k, bundle)
    type(body_t), intent(in) :: self
    integer, intent(in) :: k
    type(bundle_t), intent(inout) :: bundle
    integer :: a, l, n

    if (contracts) call require(is_index(k, bundle_count(self)), "take_bundle: there are such elements")
    n = product(self%patch%direction%order + 1)
    if (.not. allocated(bundle%place)) allocate (bundle%place(3, lanes), bundle%local(n, lanes), bundle%weight(lanes, n))
    bundle%first = merge(1, 2, self%rational)
    bundle%many = min(lanes, element_count(self%patch) - lanes * (k - 1))
    do l = 1, lanes
      bundle%place(:, l) = element_of(self%patch, lanes * (k - 1) + min(l, bundle%many))
      call element_nodes(self%patch, bundle%place(:, l), bundle%local(:, l))
      do a = 1, n
        bundle%weight(l, a) = self%patch%weight(bundle%local(a, l))
      end do
    end do
    call side_by_side(self%u, bundle%place(1, :), bundle%u)
    call side_by_side(self%v, bundle%place(2, :), bundle%v)
    call side_by_side(self%w, bundle%place(3, :), bundle%w)
    call make_room(bundle)
  end subroutine take_bundle

  !> Make room for fields of the first elements, the others are like them; the status says whether there is.
  pure subroutine make_room(bundle)
    type(bundle_t), intent(inout) :: bundle
    integer :: failed, m

    failed = 0
    m = size(bundle%u%weight, 2) * size(bundle%v%weight, 2) * size(bundle%w%weight, 2)
    if (.not. allocated(bundle%coefficients)) allocate (bundle%coefficients(lanes, size(bundle%weight, 2), 3), stat=failed)
    if (failed == 0 .and. .not. allocated(bundle%values)) allocate (bundle%values(lanes, 3, bundle%first:4, m), stat=failed)
    if (failed == 0 .and. .not. allocated(bundle%lines)) then
      allocate (bundle%lines(room_for_lines(bundle%u, bundle%v, bundle%w, 3)), stat=failed)
    end if
    bundle%status = merge(status_ok, status_out_of_memory, failed == 0)
  end subroutine make_room

  !> Compute the geometry of a bundle of a body, `self`.
  pure subroutine take_geometry(self, bundle, geometry)
    type(body_t), intent(in) :: self
    type(bundle_t), intent(inout) :: bundle
    type(geometry_t), intent(inout) :: geometry

    geometry%smallest = 0.0_wp
    geometry%status = bundle%status
    if (geometry%status == status_ok) call reserve(size(bundle%values, 4), self%rational, geometry)
    if (geometry%status /= status_ok) return
    if (self%rational) call take_weighting(bundle, geometry%weighting)
    call take_map(self%reference, bundle, geometry)
    geometry%status = merge(status_ok, status_folded_initially, all(geometry%smallest > 0.0_wp))
    if (geometry%status == status_ok) call take_volumes(bundle, geometry)
  end subroutine take_geometry

  !> Make room for the geometry of elements of m points; its status says whether there is.
  pure subroutine reserve(m, rational, geometry)
    integer, intent(in) :: m
    logical, intent(in) :: rational
    type(geometry_t), intent(inout) :: geometry
    integer :: failed

    failed = 0
    if (.not. allocated(geometry%map)) allocate (geometry%map(lanes, 3, 3, m), stat=failed)
    if (failed == 0 .and. .not. allocated(geometry%inverse)) allocate (geometry%inverse(lanes, 3, 3, m), stat=failed)
    if (failed == 0 .and. .not. allocated(geometry%volume)) allocate (geometry%volume(lanes, m), stat=failed)
    if (failed == 0 .and. rational .and. .not. allocated(geometry%weighting)) then
      allocate (geometry%weighting(lanes, 4, m), stat=failed)
    end if
    geometry%status = merge(status_ok, status_out_of_memory, failed == 0)
  end subroutine reserve

  !> `weighting` of elements from the sum of their functions times weights (theory 2.4).
  pure subroutine take_weighting(bundle, weighting)
    type(bundle_t), intent(inout) :: bundle
    real(wp), contiguous, intent(out) :: weighting(:, :, :)
    integer :: d

    call interpolate(bundle%u, bundle%v, bundle%w, 1, bundle%weight, 1, weighting, bundle%lines)
    weighting(:, 1, :) = 1.0_wp / weighting(:, 1, :)
    do d = 2, 4
      weighting(:, d, :) = weighting(:, d, :) * weighting(:, 1, :)
    end do
  end subroutine take_weighting

  !> The map from the parameters to the reference positions, `references` (3, control points of the patch), of elements whose
  !> weighting is known, its inverse, its determinants where volumes will be, and their `smallest` (theory 1.3).
  pure subroutine take_map(references, bundle, geometry)
    real(wp), intent(in) :: references(:, :)
    type(bundle_t), intent(inout) :: bundle
    type(geometry_t), intent(inout) :: geometry
    real(wp) :: cofactor(lanes, 3, 3), map(lanes, 3, 3)
    integer :: a, i, j, l, q

    do a = 1, size(bundle%weight, 2) ! from the first control point, so that a rigid translation costs no digits
      do l = 1, lanes
        bundle%coefficients(l, a, :) = bundle%weight(l, a) * (references(:, bundle%local(a, l)) - references(:, bundle%local(1, l)))
      end do
    end do
    call interpolate(bundle%u, bundle%v, bundle%w, 3, bundle%coefficients, bundle%first, bundle%values, bundle%lines)
    geometry%smallest = huge(1.0_wp)
    do q = 1, size(geometry%volume, 2)
      call slopes_at(q, bundle, geometry, map)
      call cofactors(map, cofactor, geometry%volume(:, q))
      geometry%map(:, :, :, q) = map
      do j = 1, 3
        do i = 1, 3
          geometry%inverse(:, i, j, q) = cofactor(:, i, j) / geometry%volume(:, q)
        end do
      end do
      geometry%smallest = least(geometry%smallest, geometry%volume(:, q))
    end do
  end subroutine take_map

  !> Volumes from the determinants in their place (theory 2.8).
  pure subroutine take_volumes(bundle, geometry)
    type(bundle_t), intent(in) :: bundle
    type(geometry_t), intent(inout) :: geometry
    integer :: i, j, k, q

    q = 0
    associate (u => bundle%u%weight, v => bundle%v%weight, w => bundle%w%weight)
      do k = 1, size(w, 2)
        do j = 1, size(v, 2)
          do i = 1, size(u, 2)
            q = q + 1
            geometry%volume(:, q) = u(:, i) * v(:, j) * w(:, k) * geometry%volume(:, q)
          end do
        end do
      end do
    end associate
  end subroutine take_volumes

  !> Derivatives by the parameters of the field in the bundle at its point `q`: `slopes` (lane, component, parameter) (theory 1.3).
  pure subroutine slopes_at(q, bundle, geometry, slopes)
    integer, intent(in) :: q
    type(bundle_t), intent(in) :: bundle
    type(geometry_t), intent(in) :: geometry
    real(wp), intent(out) :: slopes(lanes, 3, 3)

    if (bundle%first == 1) then
      call quotients(geometry%weighting(:, :, q), bundle%values(:, :, :, q), slopes)
    else
      slopes = bundle%values(:, :, :, q)
    end if
  end subroutine slopes_at

end module isomortar_solid_body
