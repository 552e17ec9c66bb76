!> What the passes over slave quadrature points do, counted there: the kernel keeps no state, so that who calls adds it up.
module isomortar_contact_work
  use, intrinsic :: iso_fortran_env, only: int64
  implicit none
  private

  public :: add_work, count_points, evaluate, gather_work

  !> Numbers of counts, by what they count: an array of them has one of each.
  integer, parameter, public :: work_warm = 1, work_cold = 2, work_elements = 3, work_points = 4, work_order = 5, work_counts = 8

  !> Counts of one call.
  type, public :: work_t
    !> Points whose feet were looked for near a start alone at first, and on the whole master.
    integer(int64) :: warm = 0, cold = 0
    !> Elements of a master that were searched for a foot, each time that they were.
    integer(int64) :: elements = 0
    !> Quadrature points, each time that a pass computes a foot or kinematics there.
    integer(int64) :: points = 0
    !> Places at which a master's functions were evaluated, by the highest order of their derivatives.
    integer(int64) :: evaluations(0:3) = 0
  end type work_t

contains

  !> Note an evaluation of a master's functions with derivatives up to `order`, at so many `places`, in `work`.
  pure subroutine evaluate(order, places, work)
    integer, intent(in) :: order, places
    type(work_t), intent(inout) :: work

    work%evaluations(order) = work%evaluations(order) + places
  end subroutine evaluate

  !> Note that a pass is at so many `points` in `work`.
  pure subroutine count_points(points, work)
    integer, intent(in) :: points
    type(work_t), intent(inout) :: work

    work%points = work%points + points
  end subroutine count_points

  !> Add the counts of `parts` (any) of a pass, which threads have made each for itself, to those of all, `work`.
  pure subroutine gather_work(parts, work)
    type(work_t), intent(in) :: parts(:)
    type(work_t), intent(inout) :: work
    integer :: k

    work%warm = work%warm + sum(parts%warm)
    work%cold = work%cold + sum(parts%cold)
    work%elements = work%elements + sum(parts%elements)
    work%points = work%points + sum(parts%points)
    do k = 1, size(parts)
      work%evaluations = work%evaluations + parts(k)%evaluations
    end do
  end subroutine gather_work

  !> Add the counts of a call, `work`, to `counts` (work_counts).
  pure subroutine add_work(work, counts)
    type(work_t), intent(in) :: work
    integer(int64), intent(inout) :: counts(:)

    counts = counts + [work%warm, work%cold, work%elements, work%points, work%evaluations]
  end subroutine add_work

end module isomortar_contact_work
