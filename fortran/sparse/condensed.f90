!> Factors of a symmetric body with what is not symmetric on its faces: Cholesky within, dense LU of what is left on the faces.
!>
!>     [ K_ii  K_if         0    ]  inner unknowns of the bodies
!>     [ K_fi  K_ff + C_ff  C_fm ]  those of faces in contact
!>     [ 0     C_mf         C_mm ]  multipliers
!>
!> K is factorised with the faces last (`cholmod.c`): L_ff L_ff^T, the end of its factor, is the Schur complement of K on the faces,
!> but for what their diagonal had more (theory 5.11, 5.12).
!>
!> - `values` (entries): of K, both halves, in the order of the pattern. `added` (trailing, trailing): C, faces first.
!> - `code`: how it ended (isomortar_sparse_cholmod).
module isomortar_sparse_condensed
  use, intrinsic :: iso_c_binding, only: c_associated, c_double, c_int, c_int64_t, c_null_ptr, c_ptr
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_predicate, only: is_compressed, is_permutation
  use isomortar_sparse_cholmod, only: cholesky_analyse, cholesky_back, cholesky_done, cholesky_factorise, cholesky_forget, &
    cholesky_forth, cholesky_out_of_memory
  use isomortar_sparse_dense, only: eliminate_dense, pivots_apart, substitute_dense
  implicit none
  private

  public :: condense, eliminate_condensed, eliminate_faces, forget_condensed, is_condensed, substitute_condensed

  !> What the diagonals of faces grow by, of themselves, so that K is definite where contact alone holds them.
  real(c_double), parameter :: face_share = 1

  !> The pattern of K that was analysed, and the factors of the last matrix.
  type, public :: condensed_t
    type(c_ptr) :: body = c_null_ptr
    !> Unknowns of K, and how many of them are of faces.
    integer :: unknowns = 0, faces = 0
    !> L_ff, the lower triangle of the Schur complement of K, and the least pivot of K; not allocated without factors of K.
    real(c_double), allocatable :: corner(:, :), schur(:, :)
    real(c_double) :: least = 0
    !> LU factors of that with what is added, with their pivots; not allocated without factors.
    real(c_double), allocatable :: complement(:, :)
    integer(c_int), allocatable :: pivot(:)
  end type condensed_t

  interface
    subroutine dsyrk(uplo, trans, n, k, alpha, a, lda, beta, c, ldc)
      import :: c_double, c_int
      implicit none
      character, intent(in) :: uplo, trans
      integer(c_int), intent(in) :: n, k, lda, ldc
      real(c_double), intent(in) :: alpha, beta, a(lda, *)
      real(c_double), intent(inout) :: c(ldc, *)
    end subroutine dsyrk
  end interface

contains

  !> Analyse the pattern of K.
  !>
  !> - `indptr` (unknowns + 1), `indices` (entries): compressed rows, from 0, symmetric, with the diagonal.
  !> - `on_face` (unknowns): 1 for unknowns of faces, 0 for others. `order` (unknowns): that of the others, from 0.
  !> - `flops`, `factor_entries`: operations of a factorisation of K, entries of its factor.
  subroutine condense(self, indptr, indices, on_face, order, flops, factor_entries, code)
    type(condensed_t), intent(inout) :: self
    integer(c_int64_t), contiguous, intent(in) :: indptr(:), indices(:), order(:)
    integer(c_int), contiguous, intent(in) :: on_face(:)
    real(c_double), intent(out) :: flops, factor_entries
    integer(c_int), intent(out) :: code

    if (contracts) call require(is_compressed(indptr, size(indices)), "condense: rows follow one another")
    if (contracts) call require(size(on_face) == size(indptr) - 1, "condense: each unknown is on a face or not")
    if (contracts) call require(is_permutation(order), "condense: unknowns are in some order")
    self%unknowns = size(on_face)
    self%faces = sum(on_face)
    code = cholesky_analyse(int(self%unknowns, c_int64_t), indptr, indices, on_face, order, flops, factor_entries, self%body)
  end subroutine condense

  !> Whether there is a pattern.
  pure recursive function is_condensed(self)
    type(condensed_t), intent(in) :: self
    logical :: is_condensed

    is_condensed = c_associated(self%body)
  end function is_condensed

  !> Factorise; without `cholesky_done` there are no factors afterwards.
  !>
  !> - `rcond`: estimate of the reciprocal condition: the least pivot of K as a share of its diagonal, or smallest over largest
  !>   pivot of what is left on the faces. Not above zero where one of them is not finite.
  recursive subroutine eliminate_condensed(self, values, added, rcond, code)
    type(condensed_t), intent(inout) :: self
    real(c_double), contiguous, intent(in) :: values(:), added(:, :)
    real(c_double), intent(out) :: rcond
    integer(c_int), intent(out) :: code
    real(c_double), allocatable :: shift(:)
    integer(c_int) :: failure

    rcond = 0
    call forget_numbers(self)
    code = cholesky_out_of_memory
    allocate (self%corner(self%faces, self%faces), stat=failure)
    if (failure == 0) allocate (self%schur(self%faces, self%faces), stat=failure)
    if (failure == 0) allocate (shift(self%faces), stat=failure)
    if (failure == 0) code = cholesky_factorise(self%body, values, face_share, self%corner, shift, self%least)
    if (code /= cholesky_done) then
      call forget_numbers(self)
      return
    end if
    call complement_body(self%corner, shift, self%schur)
    call eliminate_faces(self, added, rcond, code)
  end subroutine eliminate_condensed

  !> The lower triangle of the `schur` complement (faces, faces) of K on the faces: without the `shift` (faces) that their diagonal
  !> had, of whose complement `corner` (faces, faces) is the factor (theory 5.12).
  recursive subroutine complement_body(corner, shift, schur)
    real(c_double), contiguous, intent(in) :: corner(:, :), shift(:)
    real(c_double), contiguous, intent(inout) :: schur(:, :)
    integer(c_int) :: n
    integer :: k

    n = size(shift)
    if (n > 0) call dsyrk("L", "N", n, n, 1.0_c_double, corner, n, 0.0_c_double, schur, n) ! of a leading dimension above zero
    do k = 1, n
      schur(k, k) = schur(k, k) - shift(k)
    end do
  end subroutine complement_body

  !> Factorise with another C and the K of the last factors, which there must be (theory 5.12).
  !>
  !> - `rcond`: as of `eliminate_condensed`.
  recursive subroutine eliminate_faces(self, added, rcond, code)
    type(condensed_t), intent(inout) :: self
    real(c_double), contiguous, intent(in) :: added(:, :)
    real(c_double), intent(out) :: rcond
    integer(c_int), intent(out) :: code
    integer :: failure, k, n

    if (contracts) call require(size(added, 1) == size(added, 2), "eliminate_faces: the trailing block is square")
    if (contracts) call require(size(added, 1) >= self%faces, "eliminate_faces: faces and more")
    if (contracts) call require(allocated(self%schur), "eliminate_faces: K is factorised")
    rcond = 0
    n = size(added, 1)
    code = cholesky_out_of_memory
    if (allocated(self%complement)) deallocate (self%complement, self%pivot)
    allocate (self%complement(n, n), stat=failure)
    if (failure == 0) allocate (self%pivot(n), stat=failure)
    if (failure /= 0) then
      call forget_numbers(self)
      return
    end if
    code = cholesky_done
    self%complement(:, :) = added
    do k = 1, self%faces
      associate (column => self%schur(k:, k))
        self%complement(k:self%faces, k) = self%complement(k:self%faces, k) + column
        self%complement(k, k + 1:self%faces) = self%complement(k, k + 1:self%faces) + column(2:)
      end associate
    end do
    call eliminate_dense(self%complement, self%pivot)
    rcond = min(self%least, pivots_apart(self%complement))
  end subroutine eliminate_faces

  !> Solve with the factors (theory 5.12): `b` (size), `x` (size): unknowns of K, then multipliers.
  recursive subroutine substitute_condensed(self, b, x, code)
    type(condensed_t), intent(in) :: self
    real(c_double), contiguous, intent(in) :: b(:)
    real(c_double), contiguous, intent(out) :: x(:)
    integer(c_int), intent(out) :: code
    real(c_double), allocatable :: within(:), trailing(:, :)
    integer :: failure

    if (contracts) call require(size(b) == self%unknowns - self%faces + size(self%pivot), "substitute_condensed: all unknowns")
    if (contracts) call require(size(x) == size(b), "substitute_condensed: and a place for each")
    code = cholesky_out_of_memory
    allocate (within(self%unknowns), stat=failure)
    if (failure == 0) allocate (trailing(size(self%pivot), 1), stat=failure)
    if (failure /= 0) return
    code = cholesky_forth(self%body, b, within)
    if (code /= cholesky_done) return
    associate (faces => within(self%unknowns - self%faces + 1:))
      trailing(:self%faces, 1) = matmul(self%corner, faces)
      trailing(self%faces + 1:, 1) = b(self%unknowns + 1:)
      call substitute_dense(self%complement, self%pivot, trailing)
      faces = matmul(trailing(:self%faces, 1), self%corner)
    end associate
    code = cholesky_back(self%body, within, x)
    x(self%unknowns + 1:) = trailing(self%faces + 1:, 1)
  end subroutine substitute_condensed

  !> Free the factors on the faces and of K; without them there is nothing to solve with.
  pure recursive subroutine forget_numbers(self)
    type(condensed_t), intent(inout) :: self

    if (allocated(self%corner)) deallocate (self%corner)
    if (allocated(self%schur)) deallocate (self%schur)
    if (allocated(self%complement)) deallocate (self%complement)
    if (allocated(self%pivot)) deallocate (self%pivot)
  end subroutine forget_numbers

  !> Free everything.
  subroutine forget_condensed(self)
    type(condensed_t), intent(inout) :: self

    call forget_numbers(self)
    call cholesky_forget(self%body)
  end subroutine forget_condensed

end module isomortar_sparse_condensed
