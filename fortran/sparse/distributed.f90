!> Factors of a symmetric body by MUMPS on all ranks, with what is not symmetric on its faces by dense LU on the first one.
!>
!> The system is that of `isomortar_sparse_condensed`. K comes scaled to a unit diagonal, so that its pivots are shares of that;
!> MUMPS leaves its Schur complement on the faces (theory 5.18).
!>
!> - `handle`: a pattern that was analysed, and the factors of the last matrix of that pattern.
!> - `place`, `status`: how it ended (isomortar_base_status); where all handles are taken, their number; where MUMPS failed, its
!>   code.
module isomortar_sparse_distributed
  use, intrinsic :: iso_c_binding, only: c_double, c_int, c_int64_t
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_predicate, only: is_compressed, is_permutation
  use isomortar_base_status, only: status_library, status_ok, status_out_of_memory, status_singular, status_stale_handle
  use isomortar_sparse_dense, only: eliminate_dense, pivots_apart, substitute_dense
  use isomortar_sparse_mumps, only: condense, expand, free_instance, instance, instances, perform, task_analyse, task_begin, &
    task_factorise, task_release, task_solve, whole
  implicit none
  private

  public :: analyse_distributed, factorise_distributed, release_distributed, renew_distributed, solve_distributed

  !> Per cent of memory more than MUMPS estimates, first and at most: doubled where it does not suffice.
  integer, parameter :: spare = 30, most_spare = 1000

  !> What the first rank keeps of a factorisation.
  type :: distributed_t
    integer :: unknowns = 0, faces = 0
    !> Of the lower triangle: where its entries stand among the values, their rows and columns from 1, the entries. Of each row:
    !> where its diagonal stands, its place in the order, the inverse root of its diagonal.
    integer(c_int64_t), allocatable :: place(:), diagonal(:)
    integer, pointer :: row(:) => null(), column(:) => null(), order(:) => null(), face(:) => null()
    real(c_double), pointer :: lower(:) => null(), schur(:) => null(), right(:) => null(), reduced(:) => null()
    real(c_double), allocatable :: scale(:)
    !> The least pivot of K.
    real(c_double) :: least = 0
    !> LU factors of the complement with their pivots; not allocated without factors.
    real(c_double), allocatable :: complement(:, :)
    integer(c_int), allocatable :: pivot(:)
  end type distributed_t

  type(distributed_t), target :: table(0:instances - 1)

contains

  !> Analyse the pattern of the bodies' stiffness.
  !>
  !> - `indptr` (unknowns + 1), `indices` (entries): compressed rows, from 0, symmetric, with the diagonal.
  !> - `on_face` (unknowns): 1 for unknowns of faces in contact, 0 for others. `order` (unknowns): that of the others, from 0.
  !> - `compression`: bound of what blocks of low rank leave out, of a matrix with a unit diagonal; 0: nothing.
  subroutine analyse_distributed(indptr, indices, on_face, order, compression, handle, place, status)
    integer(c_int64_t), contiguous, intent(in) :: indptr(:), indices(:), order(:)
    integer(c_int), contiguous, intent(in) :: on_face(:)
    real(c_double), intent(in) :: compression
    integer(c_int), intent(out) :: handle
    integer(c_int64_t), intent(out) :: place
    integer, intent(out) :: status
    integer :: failure

    if (contracts) call require(is_compressed(indptr, size(indices)), "analyse_distributed: rows follow one another")
    if (contracts) call require(size(on_face) == size(indptr) - 1, "analyse_distributed: each unknown is on a face or not")
    if (contracts) call require(is_permutation(order), "analyse_distributed: unknowns are in some order")
    handle = free_instance()
    place = instances
    status = status_out_of_memory
    if (handle == instances) return
    place = -1
    call make_room(table(handle), size(indices, kind=c_int64_t), on_face, failure)
    if (failure /= 0) return
    call keep_pattern(table(handle), indptr, indices, on_face, order)
    call perform(task_begin, handle, 0, compression)
    call show_pattern(table(handle), handle)
    call perform(task_analyse, handle, 0, 0.0_c_double)
    call judge(handle, place, status)
    if (status /= status_ok) call release_distributed(handle)
  end subroutine analyse_distributed

  !> Room for a pattern of so many `entries`; `failure`: not zero where memory ran out.
  subroutine make_room(self, entries, on_face, failure)
    type(distributed_t), intent(inout) :: self
    integer(c_int64_t), intent(in) :: entries
    integer(c_int), contiguous, intent(in) :: on_face(:)
    integer, intent(out) :: failure
    integer(c_int64_t) :: lower

    self%unknowns = size(on_face)
    self%faces = sum(on_face)
    lower = (entries + self%unknowns) / 2
    allocate (self%place(lower), stat=failure)
    if (failure == 0) allocate (self%row(lower), stat=failure)
    if (failure == 0) allocate (self%column(lower), stat=failure)
    if (failure == 0) allocate (self%diagonal(self%unknowns), stat=failure)
    if (failure == 0) allocate (self%scale(self%unknowns), stat=failure)
    if (failure == 0) allocate (self%order(self%unknowns), stat=failure)
    if (failure == 0) allocate (self%right(self%unknowns), stat=failure)
    if (failure == 0) allocate (self%reduced(self%faces), stat=failure)
    if (failure == 0) allocate (self%face(self%faces), stat=failure)
    if (failure /= 0) call forget_pattern(self)
  end subroutine make_room

  !> The lower triangle of the pattern, and its order with the faces last.
  subroutine keep_pattern(self, indptr, indices, on_face, order)
    type(distributed_t), intent(inout) :: self
    integer(c_int64_t), contiguous, intent(in) :: indptr(:), indices(:), order(:)
    integer(c_int), contiguous, intent(in) :: on_face(:)
    integer(c_int64_t) :: entry, next
    integer :: row, k

    self%face(:) = pack([(row, row=1, self%unknowns)], on_face == 1)
    next = 0
    do row = 1, self%unknowns
      do entry = indptr(row) + 1, indptr(row + 1)
        if (indices(entry) >= row) exit
        next = next + 1
        self%place(next) = entry
        self%row(next) = row
        self%column(next) = int(indices(entry)) + 1
      end do
      self%diagonal(row) = next
    end do
    next = 0
    do k = 1, self%unknowns
      if (on_face(order(k) + 1) == 1) cycle
      next = next + 1
      self%order(order(k) + 1) = int(next)
    end do
    self%order(self%face) = [(int(next) + k, k=1, self%faces)]
  end subroutine keep_pattern

  !> Show the pattern to MUMPS on the first rank.
  subroutine show_pattern(self, handle)
    type(distributed_t), intent(in) :: self
    integer, intent(in) :: handle

    associate (mumps => instance(handle)%mumps)
      mumps%n = self%unknowns
      mumps%nnz = size(self%row, kind=c_int64_t)
      mumps%irn => self%row
      mumps%jcn => self%column
      mumps%perm_in => self%order
      if (self%faces == 0) return
      mumps%icntl(19) = 1
      mumps%size_schur = self%faces
      mumps%listvar_schur => self%face
    end associate
  end subroutine show_pattern

  !> Factorise a stiffness of the pattern analysed, with what is added on faces and beyond; takes the place of the factors before.
  !>
  !> - `values` (entries): of the stiffness. `added` (trailing, trailing): unknowns of faces by their numbers, then others.
  !> - `rcond`: estimate of the reciprocal condition; below `rcond_min`, or where the stiffness is not definite, the status is
  !>   singular.
  !> - `factor_entries`: entries of the factors on all ranks, as they are kept.
  subroutine factorise_distributed(handle, values, added, rcond_min, rcond, factor_entries, place, status)
    integer(c_int), intent(in) :: handle
    real(c_double), contiguous, intent(in) :: values(:), added(:, :)
    real(c_double), intent(in) :: rcond_min
    real(c_double), intent(out) :: rcond, factor_entries
    integer(c_int64_t), intent(out) :: place
    integer, intent(out) :: status

    rcond = 0
    factor_entries = 0
    place = -1
    status = status_stale_handle
    if (.not. is_taken(handle)) return
    if (contracts) call require(size(added, 1) == size(added, 2), "factorise_distributed: the trailing block is square")
    if (contracts) call require(size(added, 1) >= table(handle)%faces, "factorise_distributed: faces and more")
    associate (self => table(handle))
      if (allocated(self%complement)) deallocate (self%complement)
      if (allocated(self%pivot)) deallocate (self%pivot)
      if (associated(self%schur)) deallocate (self%schur)
      call eliminate_inner(self, handle, values, self%least, factor_entries, place, status)
    end associate
    if (status == status_ok) call renew_distributed(handle, added, rcond_min, rcond, status)
  end subroutine factorise_distributed

  !> The same with what is `added` (trailing, trailing) anew, and the factors of the stiffness of the last `factorise_distributed`.
  !>
  !> - `rcond`: estimate of the reciprocal condition; below `rcond_min` the status is singular.
  subroutine renew_distributed(handle, added, rcond_min, rcond, status)
    integer(c_int), intent(in) :: handle
    real(c_double), contiguous, intent(in) :: added(:, :)
    real(c_double), intent(in) :: rcond_min
    real(c_double), intent(out) :: rcond
    integer, intent(out) :: status
    integer :: failure

    rcond = 0
    status = status_stale_handle
    if (.not. is_taken(handle)) return
    if (.not. associated(table(handle)%schur)) return
    if (contracts) call require(size(added, 1) == size(added, 2), "renew_distributed: the trailing block is square")
    if (contracts) call require(size(added, 1) >= table(handle)%faces, "renew_distributed: faces and more")
    status = status_out_of_memory
    associate (self => table(handle))
      if (allocated(self%complement)) deallocate (self%complement)
      if (allocated(self%pivot)) deallocate (self%pivot)
      allocate (self%complement(size(added, 1), size(added, 2)), stat=failure)
      if (failure /= 0) return
      allocate (self%pivot(size(added, 1)), stat=failure)
      if (failure /= 0) return
      call complement_schur(self, added)
      call eliminate_dense(self%complement, self%pivot)
      rcond = min(self%least, pivots_apart(self%complement))
    end associate
    ! Written so that a condition that is not a number counts as singular too.
    status = status_ok
    if (.not. rcond >= rcond_min) status = status_singular
  end subroutine renew_distributed

  !> Have the ranks eliminate what is within the bodies; more memory is tried where the estimate was short.
  subroutine eliminate_inner(self, handle, values, rcond, factor_entries, place, status)
    type(distributed_t), target, intent(inout) :: self
    integer, intent(in) :: handle
    real(c_double), contiguous, intent(in) :: values(:)
    real(c_double), intent(out) :: rcond, factor_entries
    integer(c_int64_t), intent(out) :: place
    integer, intent(out) :: status
    integer :: failure, more

    rcond = 0
    factor_entries = 0
    place = -1
    call scale_lower(self, values, status)
    if (status /= status_ok) return
    status = status_out_of_memory
    allocate (self%schur(self%faces * int(self%faces, c_int64_t)), stat=failure)
    if (failure /= 0) return
    associate (mumps => instance(handle)%mumps)
      mumps%a => self%lower
      mumps%schur => self%schur
      more = spare
      do
        call perform(task_factorise, handle, more, 0.0_c_double)
        if (.not. any(mumps%infog(1) == [-8, -9, -14, -15, -17, -20]) .or. more >= most_spare) exit
        more = 2 * more
      end do
      call judge(handle, place, status)
      if (status == status_ok .and. mumps%infog(12) > 0) status = status_singular
      factor_entries = merge(-1e6_c_double, 1.0_c_double, mumps%infog(35) < 0) * mumps%infog(35)
      if (status == status_ok) rcond = mumps%rinfog(19) ! the least pivot
      mumps%a => null()
    end associate
    deallocate (self%lower)
    if (status /= status_ok) deallocate (self%schur)
  end subroutine eliminate_inner

  !> The lower triangle, scaled to a unit diagonal (theory 5.18); the status is singular where the diagonal is not positive.
  subroutine scale_lower(self, values, status)
    type(distributed_t), intent(inout) :: self
    real(c_double), contiguous, intent(in) :: values(:)
    integer, intent(out) :: status
    integer(c_int64_t) :: k
    integer :: failure, row

    status = status_singular
    do row = 1, self%unknowns
      associate (diagonal => values(self%place(self%diagonal(row))))
        if (.not. diagonal > 0) return
        self%scale(row) = 1 / sqrt(diagonal)
      end associate
    end do
    status = status_out_of_memory
    allocate (self%lower(size(self%row, kind=c_int64_t)), stat=failure)
    if (failure /= 0) return
    do k = 1, size(self%row, kind=c_int64_t)
      self%lower(k) = values(self%place(k)) * self%scale(self%row(k)) * self%scale(self%column(k))
    end do
    status = status_ok
  end subroutine scale_lower

  !> The Schur complement of K on the faces, with what is added (theory 5.18): MUMPS leaves its lower triangle, by rows.
  subroutine complement_schur(self, added)
    type(distributed_t), intent(inout) :: self
    real(c_double), contiguous, intent(in) :: added(:, :)
    real(c_double) :: factor
    integer(c_int64_t) :: before
    integer :: i, j

    self%complement(:, :) = added
    do i = 1, self%faces
      before = (i - 1) * int(self%faces, c_int64_t)
      do j = 1, i
        factor = self%schur(before + j) / (self%scale(self%face(i)) * self%scale(self%face(j)))
        self%complement(j, i) = self%complement(j, i) + factor
        if (i /= j) self%complement(i, j) = self%complement(i, j) + factor
      end do
    end do
  end subroutine complement_schur

  !> Solve with the factors of the last `factorise_distributed`: `b` (size), `x` (size): unknowns, then others.
  subroutine solve_distributed(handle, b, x, place, status)
    integer(c_int), intent(in) :: handle
    real(c_double), contiguous, intent(in) :: b(:)
    real(c_double), contiguous, intent(out) :: x(:)
    integer(c_int64_t), intent(out) :: place
    integer, intent(out) :: status
    real(c_double), allocatable :: trailing(:, :)
    integer :: failure

    x = 0
    place = -1
    status = status_stale_handle
    if (.not. is_taken(handle)) return
    if (.not. allocated(table(handle)%pivot)) return
    associate (self => table(handle))
      if (contracts) call require(size(b) == self%unknowns - self%faces + size(self%pivot), "solve_distributed: all unknowns")
      if (contracts) call require(size(x) == size(b), "solve_distributed: and a place for each")
      status = status_out_of_memory
      allocate (trailing(size(self%pivot), 1), stat=failure)
      if (failure /= 0) return
      trailing(self%faces + 1:, 1) = b(self%unknowns + 1:)
      self%right(:) = self%scale * b(:self%unknowns)
      if (self%faces > 0) then
        call substitute_inner(self, handle, condense, place, status)
        if (status /= status_ok) return
        trailing(:self%faces, 1) = self%reduced / self%scale(self%face)
        call substitute_dense(self%complement, self%pivot, trailing)
        self%reduced(:) = trailing(:self%faces, 1) / self%scale(self%face)
        call substitute_inner(self, handle, expand, place, status)
      else
        call substitute_dense(self%complement, self%pivot, trailing)
        call substitute_inner(self, handle, whole, place, status)
      end if
      x(:self%unknowns) = self%scale * self%right
      x(self%unknowns + 1:) = trailing(self%faces + 1:, 1)
    end associate
  end subroutine solve_distributed

  !> Have the ranks substitute within the bodies; `part`: to the faces, or from them.
  subroutine substitute_inner(self, handle, part, place, status)
    type(distributed_t), target, intent(inout) :: self
    integer, intent(in) :: handle, part
    integer(c_int64_t), intent(out) :: place
    integer, intent(out) :: status

    associate (mumps => instance(handle)%mumps)
      mumps%nrhs = 1
      mumps%lrhs = self%unknowns
      mumps%rhs => self%right
      mumps%lredrhs = self%faces
      mumps%redrhs => self%reduced
    end associate
    call perform(task_solve, handle, part, 0.0_c_double)
    call judge(handle, place, status)
  end subroutine substitute_inner

  !> Free everything, on all ranks; nothing happens to a handle that was released.
  subroutine release_distributed(handle)
    integer(c_int), intent(in) :: handle

    if (.not. is_taken(handle)) return
    associate (mumps => instance(handle)%mumps) ! MUMPS would free what it is shown
      mumps%irn => null()
      mumps%jcn => null()
      mumps%a => null()
      mumps%rhs => null()
      mumps%redrhs => null()
      mumps%perm_in => null()
      mumps%listvar_schur => null()
      mumps%schur => null()
    end associate
    call perform(task_release, handle, 0, 0.0_c_double)
    call forget_pattern(table(handle))
  end subroutine release_distributed

  !> Free what the first rank keeps.
  subroutine forget_pattern(self)
    type(distributed_t), intent(inout) :: self

    if (associated(self%row)) deallocate (self%row)
    if (associated(self%column)) deallocate (self%column)
    if (associated(self%order)) deallocate (self%order)
    if (associated(self%face)) deallocate (self%face)
    if (associated(self%right)) deallocate (self%right)
    if (associated(self%reduced)) deallocate (self%reduced)
    if (associated(self%lower)) deallocate (self%lower)
    if (associated(self%schur)) deallocate (self%schur)
    self = distributed_t()
  end subroutine forget_pattern

  !> Whether a handle is one.
  function is_taken(handle)
    integer(c_int), intent(in) :: handle
    logical :: is_taken

    is_taken = handle >= 0 .and. handle < instances
    if (is_taken) is_taken = associated(instance(handle)%mumps)
  end function is_taken

  !> Our status for MUMPS's code, the worst one of all ranks.
  subroutine judge(handle, place, status)
    integer, intent(in) :: handle
    integer(c_int64_t), intent(out) :: place
    integer, intent(out) :: status

    place = -1
    select case (instance(handle)%mumps%infog(1))
    case (0:)
      status = status_ok
    case (-10, -40)
      status = status_singular
    case (-5, -7, -8, -9, -11, -13, -14, -15, -17, -18, -19, -20)
      status = status_out_of_memory
    case default
      status = status_library
      place = instance(handle)%mumps%infog(1)
    end select
  end subroutine judge

end module isomortar_sparse_distributed
