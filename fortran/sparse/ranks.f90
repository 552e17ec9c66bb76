!> Processes that factorise together (MPI): the first one tells what to do, the others listen.
!>
!> They wait for the next word asleep: a rank that spins would take a core from the assembly on the first one.
module isomortar_sparse_ranks
  use, intrinsic :: iso_c_binding, only: c_double, c_int
  use mpi, only: mpi_comm_rank, mpi_comm_size, mpi_comm_world, mpi_double_precision, mpi_finalize, mpi_finalized, mpi_ibcast, &
    mpi_init_thread, mpi_initialized, mpi_status_ignore, mpi_test, mpi_thread_serialized, mpi_wait
  implicit none
  private

  public :: are_joined, hear, join, leave, tell

  !> The communicator of all of them.
  integer, parameter, public :: all_ranks = mpi_comm_world
  !> Microseconds between two looks for the next word.
  integer(c_int), parameter :: nap = 100

  !> Whether MPI was begun here, and not by the program around us.
  logical :: ours = .false.

  interface
    function usleep(microseconds) result(failure) bind(C, name="usleep")
      import :: c_int
      implicit none
      integer(c_int), value :: microseconds
      integer(c_int) :: failure
    end function usleep
  end interface

contains

  !> Begin MPI, where that was not done; once ended it cannot be begun again.
  !>
  !> - `ranks`: how many processes there are; 0 where MPI has ended. `rank`: which one this is, from 0.
  subroutine join(ranks, rank)
    integer, intent(out) :: ranks, rank
    logical :: done
    integer :: failure, level

    ranks = 0
    rank = 0
    call mpi_finalized(done, failure)
    if (done) return
    call mpi_initialized(done, failure)
    if (.not. done) call mpi_init_thread(mpi_thread_serialized, level, failure)
    ours = ours .or. .not. done
    call mpi_comm_size(all_ranks, ranks, failure)
    call mpi_comm_rank(all_ranks, rank, failure)
  end subroutine join

  !> Whether ranks hear each other: MPI was begun, and has not ended.
  function are_joined()
    logical :: are_joined
    logical :: ended
    integer :: failure

    call mpi_initialized(are_joined, failure)
    call mpi_finalized(ended, failure)
    are_joined = are_joined .and. .not. ended
  end function are_joined

  !> End MPI, where it was begun here; all ranks have to.
  subroutine leave()
    integer :: failure

    if (ours) call mpi_finalize(failure)
    ours = .false.
  end subroutine leave

  !> Send words from the first rank to all others: `word` (words).
  subroutine tell(word)
    real(c_double), contiguous, intent(inout) :: word(:)
    integer :: request, failure

    call mpi_ibcast(word, size(word), mpi_double_precision, 0, all_ranks, request, failure)
    call mpi_wait(request, mpi_status_ignore, failure)
  end subroutine tell

  !> Wait for words of the first rank: `word` (words).
  subroutine hear(word)
    real(c_double), contiguous, asynchronous, intent(inout) :: word(:)
    logical :: heard
    integer :: request, failure
    integer(c_int) :: woken

    call mpi_ibcast(word, size(word), mpi_double_precision, 0, all_ranks, request, failure)
    do
      call mpi_test(request, heard, mpi_status_ignore, failure)
      if (heard) return
      woken = usleep(nap)
    end do
  end subroutine hear

end module isomortar_sparse_ranks
