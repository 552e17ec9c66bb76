!> Unit normals at the nodes of a master's face, averaged over the elements that meet there, and how they turn with the control
!> points (theory 3.21, 3.22).
!>
!> To a gap map they are as control points are: vectors that stand after these in the list of positions. What the map makes of them
!> is carried on to the control points: forces here, rows and tangents in isomortar_contact_gap_map_reach.
!>
!> - `positions` (3, control points): of all control points, L.
!> - `forces` (3, control points), `on_normals` (3, nodes): forces on them, F; those on the normals of nodes, F L.
!> - `work`: counts of what is done.
module isomortar_contact_gap_map_nodal_normals
  use isomortar_base_algebra, only: add_product, identity
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_index, is_unit
  use isomortar_contact_gap_map_facets, only: add_second, facet_t, meet, sum_slopes
  use isomortar_contact_work, only: work_t
  use isomortar_nurbs_surface, only: surface_t
  use isomortar_sparse_blocks, only: lacks, mark_row, pattern_t
  implicit none
  private

  public :: add_turning, average, carry

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
      call add_second(facets(e), across, self%column(first:last), form)
    end do
  end subroutine turning_of

end module isomortar_contact_gap_map_nodal_normals
