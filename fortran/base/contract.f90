!> Contracts: what a procedure asks of its arguments and promises of its results. They are checked in debug builds and in the twin,
!> where `contract_checked.f90` takes this file's place. Here nothing is left of them: the kernel never stops.
!>
!> A contract is one line, `if (contracts) call require(condition, "procedure: condition in words")`.
module isomortar_base_contract
  implicit none
  private

  public :: require

  !> Whether contracts are compiled in.
  logical, parameter, public :: contracts = .false.

contains

  !> What a contract names; never called. `holds`: whether it is kept. `what`: "procedure: condition in words".
  pure subroutine require(holds, what)
    logical, intent(in) :: holds
    character(*), intent(in) :: what

  end subroutine require

end module isomortar_base_contract
