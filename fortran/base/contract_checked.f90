!> Contracts of debug builds and of the twin, in the manner of PRIMA. Takes the place of `contract.f90`.
!>
!> A broken contract is a fault of the kernel, or of a caller that does not check what it hands over: the process ends there. What
!> sound calls can meet (a folded element, a lost foot, a pattern without a block) has a status and is no contract.
module isomortar_base_contract
  implicit none
  private

  public :: require

  !> Whether contracts are compiled in.
  logical, parameter, public :: contracts = .true.

contains

  !> End with the words of a contract unless it holds.
  !> `holds`: whether the contract is kept. `what`: "procedure: condition in words".
  pure subroutine require(holds, what)
    logical, intent(in) :: holds
    character(*), intent(in) :: what

    if (.not. holds) error stop "contract broken: " // what
  end subroutine require

end module isomortar_base_contract
