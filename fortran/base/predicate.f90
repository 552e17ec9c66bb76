!> What contracts say of numbers, up to round-off. All of it holds of what is not a number as well: that is told elsewhere.
module isomortar_base_predicate
  use, intrinsic :: iso_fortran_env, only: int32, int64
  use isomortar_base_kinds, only: wp
  implicit none
  private

  public :: is_balanced, is_compressed, is_index, is_permutation, is_symmetric, is_unit, sums_to, within

  !> Share of the numbers that went into a result below which it is round-off: contracts look for faults, not for digits.
  real(wp), parameter, public :: slack = sqrt(epsilon(1.0_wp))

  !> Offsets of compressed rows: from 0 to the number of entries, never down.
  interface is_compressed
    module procedure :: is_compressed_narrow, is_compressed_wide
  end interface is_compressed

contains

  !> Whether `forces` (3, points) have none as their sum.
  pure logical function is_balanced(forces)
    real(wp), intent(in) :: forces(:, :)

    is_balanced = .not. any(abs(sum(forces, 2)) > slack * sum(abs(forces)))
  end function is_balanced

  !> Whether `number` is one of 1 .. `last`.
  elemental logical function is_index(number, last)
    integer, intent(in) :: number, last

    is_index = number >= 1 .and. number <= last
  end function is_index

  !> Whether `start` (rows + 1) is that of compressed rows with so many `entries`; of 32 bits.
  pure logical function is_compressed_narrow(start, entries) result(is)
    integer(int32), intent(in) :: start(:)
    integer, intent(in) :: entries

    is = is_compressed_wide(int(start, int64), entries)
  end function is_compressed_narrow

  !> The same of `start` (rows + 1) and `entries`; of 64 bits.
  pure logical function is_compressed_wide(start, entries) result(is)
    integer(int64), intent(in) :: start(:)
    integer, intent(in) :: entries

    is = size(start) > 0
    if (is) is = start(1) == 0 .and. start(size(start)) == entries .and. all(start(2:) >= start(:size(start) - 1))
  end function is_compressed_wide

  !> Whether each of 0 .. n - 1 is once among `numbers` (n).
  pure logical function is_permutation(numbers) result(is)
    integer(int64), intent(in) :: numbers(:)
    logical, allocatable :: met(:)
    integer :: k

    is = all(numbers >= 0 .and. numbers < size(numbers))
    if (.not. is) return
    allocate (met(0:size(numbers) - 1), source=.false.)
    do k = 1, size(numbers)
      met(numbers(k)) = .true.
    end do
    is = all(met)
  end function is_permutation

  !> Whether `matrix` (n, n) is its transpose.
  pure logical function is_symmetric(matrix)
    real(wp), intent(in) :: matrix(:, :)

    is_symmetric = .not. any(abs(matrix - transpose(matrix)) > slack * maxval(abs(matrix)))
  end function is_symmetric

  !> Whether `vector` (components) has length one.
  pure logical function is_unit(vector)
    real(wp), intent(in) :: vector(:)

    is_unit = .not. abs(norm2(vector) - 1.0_wp) > slack
  end function is_unit

  !> Whether `numbers` (any) have the sum `total`.
  pure logical function sums_to(numbers, total)
    real(wp), intent(in) :: numbers(:), total

    sums_to = .not. abs(sum(numbers) - total) > slack * (sum(abs(numbers)) + abs(total))
  end function sums_to

  !> Whether `number` is between `low` and `high`, or beyond them by at most `share` of their distance.
  elemental logical function within(number, low, high, share)
    real(wp), intent(in) :: number, low, high, share

    within = .not. (number < low - share * (high - low) .or. number > high + share * (high - low))
  end function within

end module isomortar_base_predicate
