!> Unit normals at the nodes of a master's face, averaged over the elements that meet there, and how they turn with the control
!> points (theory 3.21, 3.22).
!>
!> To a gap map they are as control points are: vectors that stand after these in the list of positions. What the map makes of them
!> is carried on to the control points here.
!>
!> - `positions` (3, control points): of all control points, L.
!> - `forces` (3, control points), `on_normals` (3, nodes): forces on them, F; those on the normals of nodes, F L.
!> - `work`: counts of what is done.
module isomortar_contact_gap_map_nodal_normals
  use isomortar_base_algebra, only: add_product, cross, identity, inverse2, weighted_sums
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_compressed, is_index, is_unit
  use isomortar_contact_work, only: evaluate, work_t
  use isomortar_nurbs_direction, only: direction_t, element_at, family_nurbs
  use isomortar_nurbs_surface, only: surface_basis, surface_nodes, surface_t
  use isomortar_sparse_blocks, only: lacks, mark_row, pattern_t
  implicit none
  private

  public :: add_turning, average, carry, carry_form, carry_rows, reach

  !> Share of an element's length within which a node is on its bound.
  real(wp), parameter :: on_bound = 1.0e-9_wp

  !> Normals of all nodes of a face; none of a master without.
  type, public :: normals_t
    integer :: count = 0
    type(surface_t) :: surface
    !> Unit normals, shape (3, nodes).
    real(wp), allocatable :: normal(:, :)
    !> Lengths of the sums that they are the directions of.
    real(wp), allocatable :: length(:)
    !> Control points that the normal of node A depends on: column(start(A - 1) + 1 .. start(A)).
    integer, allocatable :: start(:), column(:)
    !> Derivatives of the normal by them, shape (3, 3, entries), and that of the sum's length over this, (3, entries).
    real(wp), allocatable :: slope(:, :, :), stretch(:, :)
  end type normals_t

  !> Control points that a list of points reaches, each once; entries of point a are start(a - 1) + 1 .. start(a).
  type, public :: reached_t
    integer, allocatable :: point(:)
    integer, allocatable :: start(:)
    !> Which of the control points, and the derivative of the point by it, shape (3, 3, entries).
    integer, allocatable :: at(:)
    real(wp), allocatable :: slope(:, :, :)
  end type reached_t

  !> An element's tangent plane at a node.
  type :: facet_t
    !> Global numbers of its control points.
    integer, allocatable :: point(:)
    !> N,a^k a^a of each, shape (3, control points).
    real(wp), allocatable :: lever(:, :)
    real(wp) :: normal(3)
  end type facet_t

contains

  !> Averaged normals at the nodes of a face, `surface`, with their derivatives (theory 3.21, 3.22).
  pure subroutine average(surface, positions, self, work)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: positions(:, :)
    type(normals_t), intent(out) :: self
    type(work_t), intent(inout) :: work
    type(facet_t), allocatable :: facets(:)
    integer, allocatable :: point(:)
    real(wp), allocatable :: slope(:, :, :)
    real(wp) :: across(3, 3), total(3)
    logical :: cancels(3)
    integer :: a, e, k

    self%surface = surface
    self%count = size(surface%point)
    allocate (self%normal(3, self%count), self%length(self%count), self%start(0:self%count))
    self%start(0) = 0
    allocate (self%column(0), self%slope(3, 3, 0), self%stretch(3, 0))
    do a = 1, self%count
      call meet(surface, positions, a, facets, work)
      total = 0.0_wp
      do e = 1, size(facets)
        total = total + facets(e)%normal
      end do
      cancels = cancels_at(surface, a)
      where (cancels) total = 0.0_wp
      self%length(a) = norm2(total)
      self%normal(:, a) = total / self%length(a)
      if (contracts) call require(is_unit(self%normal(:, a)), "average: normals are unit vectors")
      call sum_slopes(facets, point, slope)
      do k = 1, 3
        if (cancels(k)) slope(k, :, :) = 0.0_wp
      end do
      across = identity
      call add_product(-1.0_wp, self%normal(:, a), self%normal(:, a), across)
      self%start(a) = self%start(a - 1) + size(point)
      call make_room(self%start(a), self)
      do k = 1, size(point)
        associate (at => self%start(a - 1) + k)
          self%column(at) = point(k)
          self%slope(:, :, at) = matmul(across, slope(:, :, k)) / self%length(a)
          self%stretch(:, at) = matmul(self%normal(:, a), slope(:, :, k)) / self%length(a)
        end associate
      end do
    end do
  end subroutine average

  !> Components of the sum of normals at node a that mirror images beyond its edges cancel (theory 3.21).
  pure function cancels_at(surface, a) result(cancels)
    type(surface_t), intent(in) :: surface
    integer, intent(in) :: a
    logical :: cancels(3)
    integer :: d, index(2), k

    if (contracts) call require(all(is_index(surface%mirror + 1, 4)), "cancels_at: mirrors are across components")
    index = [mod(a - 1, surface%direction(1)%count), (a - 1) / surface%direction(1)%count]
    do k = 1, 3
      cancels(k) = .false.
      do d = 1, 2
        if (index(d) == 0) cancels(k) = cancels(k) .or. surface%mirror(1, d) == k
        if (index(d) == surface%direction(d)%count - 1) cancels(k) = cancels(k) .or. surface%mirror(2, d) == k
      end do
    end do
  end function cancels_at

  !> Make room for so many entries, twice of them where there are too few.
  pure subroutine make_room(entries, self)
    integer, intent(in) :: entries
    type(normals_t), intent(inout) :: self
    type(normals_t) :: larger
    integer :: now

    now = size(self%column)
    if (entries <= now) return
    allocate (larger%column(2 * entries), larger%slope(3, 3, 2 * entries), larger%stretch(3, 2 * entries))
    larger%column(:now) = self%column
    larger%slope(:, :, :now) = self%slope
    larger%stretch(:, :now) = self%stretch
    call move_alloc(larger%column, self%column)
    call move_alloc(larger%slope, self%slope)
    call move_alloc(larger%stretch, self%stretch)
  end subroutine make_room

  !> The elements that meet at node a of a face, past a seam too.
  pure subroutine meet(surface, positions, a, facets, work)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: positions(:, :)
    integer, intent(in) :: a
    type(facet_t), allocatable, intent(out) :: facets(:)
    type(work_t), intent(inout) :: work
    integer :: count(2), i, j, index(2), place(2, 2)
    real(wp) :: xi(2, 2)

    index = [mod(a - 1, surface%direction(1)%count), (a - 1) / surface%direction(1)%count]
    do i = 1, 2
      call beside_node(surface%direction(i), surface%closed(i), index(i), place(i, :), xi(i, :), count(i))
    end do
    allocate (facets(product(count)))
    call evaluate(1, product(count), work)
    do j = 1, count(2)
      do i = 1, count(1)
        facets(i + count(1) * (j - 1)) = facet_at(surface, positions, [place(1, i), place(2, j)], [xi(1, i), xi(2, j)])
      end do
    end do
  end subroutine meet

  !> Elements of a direction that meet at its control point j (from 0), and its coordinate in each: the node of a Lagrange element,
  !> the Greville abscissa of a spline (theory 3.21).
  pure subroutine beside_node(direction, closed, j, place, xi, count)
    type(direction_t), intent(in) :: direction
    logical, intent(in) :: closed
    integer, intent(in) :: j
    integer, intent(out) :: place(2), count
    real(wp), intent(out) :: xi(2)
    real(wp) :: length, u
    integer :: e

    if (direction%family == family_nurbs) then
      u = sum(direction%knots(j + 1:j + direction%order)) / real(direction%order, wp)
      e = element_at(direction, u)
    else
      e = min(j / direction%order + 1, direction%elements)
      u = direction%boundary(e - 1) + real(j - direction%order * (e - 1), wp) / real(direction%order, wp) &
        * (direction%boundary(e) - direction%boundary(e - 1))
    end if
    length = direction%boundary(e) - direction%boundary(e - 1)
    count = 1
    place = e
    xi = u
    if (u >= direction%boundary(e) - on_bound * length) then
      xi = direction%boundary(e)
      if (e < direction%elements) then
        count = 2
        place(2) = e + 1
      else if (closed) then
        count = 2
        place(2) = 1
        xi(2) = direction%boundary(0)
      end if
    else if (u <= direction%boundary(e - 1) + on_bound * length) then
      xi = direction%boundary(e - 1)
      if (e > 1) then
        count = 2
        place(2) = e - 1
      else if (closed) then
        count = 2
        place(2) = direction%elements
        xi(2) = direction%boundary(direction%elements)
      end if
    end if
  end subroutine beside_node

  !> The tangent plane of an element at a place.
  pure function facet_at(surface, positions, place, xi) result(self)
    type(surface_t), intent(in) :: surface
    real(wp), intent(in) :: positions(:, :), xi(2)
    integer, intent(in) :: place(2)
    type(facet_t) :: self
    integer :: nodes(product(surface%direction%order + 1))
    real(wp) :: contravariant(3, 2), functions(size(nodes), 3), metric(2, 2), tangent(3, 2)

    call surface_nodes(surface, place, nodes)
    call surface_basis(surface, place, nodes, xi, 1, functions)
    self%point = surface%point(nodes)
    tangent = weighted_sums(positions, self%point, functions(:, 2:3))
    self%normal = surface%outward * cross(tangent(:, 1), tangent(:, 2))
    self%normal = self%normal / norm2(self%normal)
    metric = matmul(transpose(tangent), tangent)
    metric = inverse2(metric)
    contravariant = matmul(tangent, metric)
    self%lever = matmul(contravariant, transpose(functions(:, 2:3)))
  end function facet_at

  !> Derivatives of the sum of the facets' normals by their control points, each of these once (theory 3.22).
  pure subroutine sum_slopes(facets, point, slope)
    type(facet_t), intent(in) :: facets(:)
    integer, allocatable, intent(out) :: point(:)
    real(wp), allocatable, intent(out) :: slope(:, :, :)
    integer :: all_points(size(facets) * size(facets(1)%point)), at, count, e, k
    real(wp) :: sums(3, 3, size(all_points))

    count = 0
    sums = 0.0_wp
    do e = 1, size(facets)
      do k = 1, size(facets(e)%point)
        at = findloc(all_points(:count), facets(e)%point(k), dim=1)
        if (at == 0) then
          count = count + 1
          at = count
          all_points(at) = facets(e)%point(k)
        end if
        call add_product(-1.0_wp, facets(e)%lever(:, k), facets(e)%normal, sums(:, :, at))
      end do
    end do
    point = all_points(:count)
    slope = sums(:, :, :count)
  end subroutine sum_slopes

  !> Add to the forces on control points those on the normals of nodes.
  pure subroutine carry(self, on_normals, forces)
    type(normals_t), intent(in) :: self
    real(wp), intent(in) :: on_normals(:, :)
    real(wp), intent(inout) :: forces(:, :)
    integer :: a, k

    do a = 1, self%count
      if (.not. any(abs(on_normals(:, a)) > 0.0_wp)) cycle
      do k = self%start(a - 1) + 1, self%start(a)
        forces(:, self%column(k)) = forces(:, self%column(k)) + matmul(on_normals(:, a), self%slope(:, :, k))
      end do
    end do
  end subroutine carry

  !> What a list of `points` (number) reaches: its control points, and those that the normals among it depend on: `reached`. The
  !> numbers of normals count on from the number `n` of control points.
  pure subroutine reach(self, n, points, reached)
    type(normals_t), intent(in) :: self
    integer, intent(in) :: n, points(:)
    type(reached_t), intent(out) :: reached
    integer :: a, count, entries, k

    entries = 0
    do a = 1, size(points)
      entries = entries + 1
      if (points(a) > n) entries = entries - 1 + self%start(points(a) - n) - self%start(points(a) - n - 1)
    end do
    allocate (reached%start(0:size(points)), reached%at(entries), reached%slope(3, 3, entries), reached%point(entries))
    entries = 0
    count = 0
    reached%start(0) = 0
    do a = 1, size(points)
      if (points(a) <= n) then
        call add_reached(points(a), identity, count, entries, reached)
      else
        do k = self%start(points(a) - n - 1) + 1, self%start(points(a) - n)
          call add_reached(self%column(k), self%slope(:, :, k), count, entries, reached)
        end do
      end if
      reached%start(a) = entries
    end do
    reached%point = reached%point(:count)
    if (contracts) call require(is_compressed(reached%start, size(reached%at)), "reach: entries follow one another by points")
    if (contracts) call require(all(is_index(reached%at, count)) .and. all(is_index(reached%point, n)), "reach: to control points")
  end subroutine reach

  !> Add an entry to the last point of a list: a control point, and the derivative by it.
  pure subroutine add_reached(point, slope, count, entries, reached)
    integer, intent(in) :: point
    real(wp), intent(in) :: slope(3, 3)
    integer, intent(inout) :: count, entries
    type(reached_t), intent(inout) :: reached
    integer :: at

    at = findloc(reached%point(:count), point, dim=1)
    if (at == 0) then
      count = count + 1
      reached%point(count) = point
      at = count
    end if
    entries = entries + 1
    reached%at(entries) = at
    reached%slope(:, :, entries) = slope
  end subroutine add_reached

  !> Linear `forms` (points, component, row, kind) in a list of points, `carried` (reached, component, row, kind) to the control
  !> points that it has `reached`.
  pure subroutine carry_rows(reached, forms, carried)
    type(reached_t), intent(in) :: reached
    real(wp), contiguous, intent(in) :: forms(:, :, :, :)
    real(wp), allocatable, intent(out) :: carried(:, :, :, :)
    integer :: a, i, k, kind, row

    allocate (carried(size(reached%point), 3, size(forms, 3), size(forms, 4)), source=0.0_wp)
    do kind = 1, size(forms, 4)
      do row = 1, size(forms, 3)
        do a = 1, size(forms, 1)
          associate (form => forms(a, :, row, kind))
            do k = reached%start(a - 1) + 1, reached%start(a)
              do i = 1, 3 ! not by matmul, whose result would be put on the heap each time
                carried(reached%at(k), i, row, kind) = carried(reached%at(k), i, row, kind) + form(1) * reached%slope(1, i, k) &
                  + form(2) * reached%slope(2, i, k) + form(3) * reached%slope(3, i, k)
              end do
            end do
          end associate
        end do
      end do
    end do
  end subroutine carry_rows

  !> A bilinear `form` (right point, left component, right component, left point) in a list of points, `carried` (right point, left
  !> component, right component, left point) to the control points that it has `reached`.
  pure subroutine carry_form(reached, form, carried)
    type(reached_t), intent(in) :: reached
    real(wp), contiguous, intent(in) :: form(:, :, :, :)
    real(wp), allocatable, intent(out) :: carried(:, :, :, :)
    real(wp), allocatable :: left(:, :, :, :)
    integer :: a, b, i, j, k

    associate (points => size(reached%point))
      allocate (carried(points, 3, 3, points), left(size(form, 1), 3, 3, points), source=0.0_wp)
    end associate
    do a = 1, size(form, 4)
      do k = reached%start(a - 1) + 1, reached%start(a)
        associate (g => reached%at(k))
          do i = 1, 3
            do j = 1, 3
              left(:, i, :, g) = left(:, i, :, g) + reached%slope(j, i, k) * form(:, j, :, a)
            end do
          end do
        end associate
      end do
    end do
    do a = 1, size(left, 4)
      do i = 1, 3
        do b = 1, size(form, 1)
          associate (row => left(b, i, :, a))
            do k = reached%start(b - 1) + 1, reached%start(b)
              do j = 1, 3
                carried(reached%at(k), i, j, a) = carried(reached%at(k), i, j, a) + row(1) * reached%slope(1, j, k) &
                  + row(2) * reached%slope(2, j, k) + row(3) * reached%slope(3, j, k)
              end do
            end do
          end associate
        end do
      end do
    end do
  end subroutine carry_form

  !> Add the second variation of the normals, times forces on them, to a tangent (theory 3.23).
  !>
  !> - `pattern`, `tangent` (column component, row component, blocks): pattern of the tangent, and this, F/L.
  !> - `columns` (control points): to mark places of blocks in (isomortar_sparse_blocks), zero at first.
  !> - `lacking`: a row of the pattern without one of the blocks, 0: none.
  pure subroutine add_turning(self, positions, on_normals, pattern, columns, tangent, lacking, work)
    type(normals_t), intent(in) :: self
    real(wp), intent(in) :: positions(:, :), on_normals(:, :)
    type(pattern_t), intent(in) :: pattern
    integer, intent(inout) :: columns(:)
    real(wp), intent(inout) :: tangent(:, :, :)
    integer, intent(out) :: lacking
    type(work_t), intent(inout) :: work
    real(wp), allocatable :: form(:, :, :, :)
    integer :: a, k, l

    lacking = 0
    do a = 1, self%count
      if (.not. any(abs(on_normals(:, a)) > 0.0_wp)) cycle
      associate (point => self%column(self%start(a - 1) + 1:self%start(a)))
        call turning_of(self, positions, a, on_normals(:, a), form, work)
        do k = 1, size(point)
          lacking = point(k)
          call mark_row(pattern, lacking, columns)
          if (lacks(pattern, lacking, columns, point)) return
          do l = 1, size(point)
            associate (block => tangent(:, :, columns(point(l))))
              block = block + transpose(form(:, :, k, l))
            end associate
          end do
        end do
      end associate
    end do
    lacking = 0
  end subroutine add_turning

  !> Second variation of the normal at node a times a force on it, by the control points that it depends on: (left component, right
  !> component, left, right) (theory 3.23).
  pure subroutine turning_of(self, positions, a, force, form, work)
    type(normals_t), intent(in) :: self
    real(wp), intent(in) :: positions(:, :), force(3)
    integer, intent(in) :: a
    real(wp), allocatable, intent(out) :: form(:, :, :, :)
    type(work_t), intent(inout) :: work
    type(facet_t), allocatable :: facets(:)
    real(wp) :: along, across(3)
    integer :: e, first, k, l, last

    first = self%start(a - 1) + 1
    last = self%start(a)
    allocate (form(3, 3, last - first + 1, last - first + 1))
    along = dot_product(force, self%normal(:, a))
    across = (force - along * self%normal(:, a)) / self%length(a)
    where (cancels_at(self%surface, a)) across = 0.0_wp
    do l = first, last
      do k = first, last
        associate (block => form(:, :, k - first + 1, l - first + 1))
          block = -along * matmul(transpose(self%slope(:, :, k)), self%slope(:, :, l))
          call add_product(-1.0_wp, self%stretch(:, k), matmul(force, self%slope(:, :, l)), block)
          call add_product(-1.0_wp, matmul(force, self%slope(:, :, k)), self%stretch(:, l), block)
        end associate
      end do
    end do
    call meet(self%surface, positions, a, facets, work)
    do e = 1, size(facets)
      call add_facet(facets(e), across, self%column(first:last), form)
    end do
  end subroutine turning_of

  !> Add the second variation of a facet's normal times a vector; `point` numbers the control points of the form (theory 3.23).
  pure subroutine add_facet(facet, vector, point, form)
    type(facet_t), intent(in) :: facet
    real(wp), intent(in) :: vector(3)
    integer, intent(in) :: point(:)
    real(wp), intent(inout) :: form(:, :, :, :)
    real(wp) :: share(size(facet%point))
    integer :: at(size(facet%point)), k, l

    share = matmul(vector, facet%lever)
    do k = 1, size(at)
      at(k) = findloc(point, facet%point(k), dim=1)
    end do
    do l = 1, size(at)
      do k = 1, size(at)
        associate (block => form(:, :, at(k), at(l)), n => facet%normal, left => facet%lever(:, k), right => facet%lever(:, l))
          call add_product(share(l), n, left, block)
          call add_product(share(k), right, n, block)
          call add_product(-dot_product(vector, n) * dot_product(left, right), n, n, block)
        end associate
      end do
    end do
  end subroutine add_facet

end module isomortar_contact_gap_map_nodal_normals
