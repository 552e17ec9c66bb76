!> Checks of a test: each is a line, and one that fails is told by the exit code.
module testing
  use isomortar_base_kinds, only: wp
  implicit none
  private

  public :: end_tests, expect, expect_true, random_numbers

  !> Step of central differences: their own error, of its square, and round-off over it are far below `by_difference`.
  real(wp), parameter, public :: step = 1.0e-11_wp
  !> Limit of what a difference tells, relative to numbers of size one.
  real(wp), parameter, public :: by_difference = 1.0e-18_wp
  !> Limit of what holds to round-off.
  real(wp), parameter, public :: round_off = 1.0e-30_wp

  integer :: failures = 0

contains

  !> Expect an error to be a number not above a limit.
  subroutine expect(name, error, limit)
    character(*), intent(in) :: name
    real(wp), intent(in) :: error, limit

    if (error <= limit) then
      print "(3a, es10.2, a, es10.2)", "ok ", name, ":", error, " <=", limit
    else
      print "(3a, es10.2, a, es10.2)", "FAILED ", name, ":", error, " >", limit
      failures = failures + 1
    end if
  end subroutine expect

  !> Expect something to be true.
  subroutine expect_true(name, holds)
    character(*), intent(in) :: name
    logical, intent(in) :: holds

    call expect(name, merge(0.0_wp, 1.0_wp, holds), 0.0_wp)
  end subroutine expect_true

  !> Numbers from -1 to 1, the same in every run.
  subroutine random_numbers(numbers)
    real(wp), intent(out) :: numbers(:)
    integer, save :: state = 12345
    integer :: i

    do i = 1, size(numbers)
      state = mod(16807 * mod(state, 127773) - 2836 * (state / 127773) + 2147483647, 2147483647)
      numbers(i) = 2.0_wp * real(state, wp) / 2147483647.0_wp - 1.0_wp
    end do
  end subroutine random_numbers

  !> End with a word on failures, if there are any.
  subroutine end_tests()
    if (failures > 0) error stop "tests failed"
  end subroutine end_tests

end module testing
