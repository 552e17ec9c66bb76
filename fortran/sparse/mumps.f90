!> Instances of MUMPS, one a factorisation, on all ranks alike: each task that the first rank sets is done by all of them.
!>
!> - `slot`: which instance, from 0.
!> - `choice`: what the task leaves open: of `task_factorise` per cent of memory more than estimated, of `task_solve` what is solved
!>   (`whole`, `condense`, `expand`).
!> - `compression`: the bound below which blocks of low rank leave out what is left, or zero; for `task_begin`.
module isomortar_sparse_mumps
  use, intrinsic :: iso_c_binding, only: c_double, c_int64_t
  use isomortar_sparse_ranks, only: all_ranks, are_joined, hear, join, leave, tell
  implicit none
  private

  public :: end_ranks, free_instance, perform, serve_first_rank

  include 'dmumps_struc.h'

  !> Most instances alive at once.
  integer, parameter, public :: instances = 64
  !> Tasks.
  integer, parameter, public :: task_end = 0, task_begin = 1, task_analyse = 2, task_factorise = 3, task_solve = 4, task_release = 5
  !> What is solved: all, from right-hand sides to those of the faces, from solutions on the faces to all.
  integer, parameter, public :: whole = 0, condense = 1, expand = 2

  type, public :: instance_t
    type(dmumps_struc), pointer :: mumps => null()
  end type instance_t

  type(instance_t), public :: instance(0:instances - 1)

  interface
    subroutine dmumps(self)
      import :: dmumps_struc
      implicit none
      type(dmumps_struc), intent(inout) :: self
    end subroutine dmumps
  end interface

contains

  !> First slot without an instance; `instances` where all have one.
  function free_instance() result(slot)
    integer :: slot

    do slot = 0, instances - 1
      if (.not. associated(instance(slot)%mumps)) return
    end do
  end function free_instance

  !> On the first rank: have a `task` done by all.
  subroutine perform(task, slot, choice, compression)
    integer, intent(in) :: task, slot, choice
    real(c_double), intent(in) :: compression
    real(c_double) :: word(4)

    word = [real(task, c_double), real(slot, c_double), real(choice, c_double), compression]
    call tell(word)
    call work(task, slot, choice, compression)
  end subroutine perform

  !> On the other ranks: do what the first one sets, until it ends.
  !>
  !> - `rank`: which one this is; nothing is done on the first one, but that the others are told to end.
  subroutine serve_first_rank(rank)
    integer, intent(out) :: rank
    real(c_double) :: word(4)
    integer :: ranks

    call join(ranks, rank)
    if (rank == 0) then
      call end_ranks()
      return
    end if
    do
      call hear(word)
      if (nint(word(1)) == task_end) exit
      call work(nint(word(1)), nint(word(2)), nint(word(3)), word(4))
    end do
    call leave()
  end subroutine serve_first_rank

  !> On the first rank: end the others, and MPI, where that was not done.
  subroutine end_ranks()
    real(c_double) :: word(4)

    if (.not. are_joined()) return
    word = 0
    call tell(word)
    call leave()
  end subroutine end_ranks

  !> The share of this rank in a task.
  subroutine work(task, slot, choice, compression)
    integer, intent(in) :: task, slot, choice
    real(c_double), intent(in) :: compression

    if (task == task_begin) allocate (instance(slot)%mumps)
    associate (mumps => instance(slot)%mumps)
      select case (task)
      case (task_begin)
        call begin(mumps, compression)
        return
      case (task_analyse)
        mumps%job = 1
      case (task_factorise)
        mumps%job = 2
        mumps%icntl(14) = choice
      case (task_solve)
        mumps%job = 3
        mumps%icntl(26) = choice
      case default ! task_release
        mumps%job = -2
      end select
      call dmumps(mumps)
    end associate
    if (task == task_release) deallocate (instance(slot)%mumps)
  end subroutine work

  !> A new instance, silent, for definite matrices that come scaled and in an order of ours.
  subroutine begin(mumps, compression)
    type(dmumps_struc), intent(inout) :: mumps
    real(c_double), intent(in) :: compression

    mumps%comm = all_ranks
    mumps%sym = 1
    mumps%par = 1
    mumps%job = -1
    call dmumps(mumps)
    mumps%icntl(1:3) = -1
    mumps%icntl(4) = 0
    mumps%icntl(6) = 0
    mumps%icntl(7) = 1
    mumps%icntl(8) = 0
    if (compression > 0) then
      mumps%icntl(35) = 2
      mumps%cntl(7) = compression
    end if
  end subroutine begin

end module isomortar_sparse_mumps
