!> Small surfaces to test on, and a slave that is one point.
module surfaces
  use isomortar_base_kinds, only: wp
  use isomortar_contact_slave, only: slave_t
  use isomortar_nurbs_direction, only: direction_t, family_lagrange, family_nurbs, new_direction
  use isomortar_nurbs_surface, only: surface_of, surface_t
  implicit none
  private

  public :: curved, lone_point, roof, tube

contains

  !> A surface of two directions, weights of one, control points by number.
  function over(first, second) result(surface)
    type(direction_t), intent(in) :: first, second
    type(surface_t) :: surface
    integer :: i

    surface = surface_of([first, second], [(i, i=1, first%count * second%count)], [(1.0_wp, i=1, first%count * second%count)])
  end function over

  !> A rational surface of two by two elements of order 3, hollow and uneven, and its control points.
  subroutine curved(surface, positions)
    type(surface_t), intent(out) :: surface
    real(wp), allocatable, intent(out) :: positions(:, :)
    real(wp), parameter :: knots(9) = [0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.4_wp, 1.0_wp, 1.0_wp, 1.0_wp, 1.0_wp]
    type(direction_t) :: direction
    real(wp) :: weight(25)
    integer :: i, j

    direction = new_direction(family_nurbs, 3, knots)
    allocate (positions(3, 25))
    do j = 1, 5
      do i = 1, 5
        positions(:, i + 5 * (j - 1)) = [i + 0.1_wp * j, j - 0.05_wp * i * i, 0.1_wp * (i - 3)**2 - 0.07_wp * (j - 2) * (i + j)]
        weight(i + 5 * (j - 1)) = 1.0_wp + 0.1_wp * mod(2 * i + j, 4)
      end do
    end do
    surface = surface_of([direction, direction], [(i, i=1, 25)], weight)
  end subroutine curved

  !> Two linear elements that meet in a ridge along the second direction at x = 1, of a height there, zero at x = 0 and x = 2; y is
  !> from 0 to 1.
  subroutine roof(height, surface, positions)
    real(wp), intent(in) :: height
    type(surface_t), intent(out) :: surface
    real(wp), allocatable, intent(out) :: positions(:, :)
    integer :: i

    surface = over(new_direction(family_lagrange, 1, [0.0_wp, 1.0_wp, 2.0_wp]), &
      new_direction(family_lagrange, 1, [0.0_wp, 1.0_wp]))
    allocate (positions(3, 6))
    do i = 0, 2
      positions(:, 1 + i) = [real(i, wp), 0.0_wp, merge(height, 0.0_wp, i == 1)]
      positions(:, 4 + i) = [real(i, wp), 1.0_wp, merge(height, 0.0_wp, i == 1)]
    end do
  end subroutine roof

  !> A square tube along the second direction, closed in the first one after four linear elements: half a side is one, length one.
  subroutine tube(surface, positions)
    type(surface_t), intent(out) :: surface
    real(wp), allocatable, intent(out) :: positions(:, :)
    real(wp), parameter :: corner(2, 4) = reshape([1, 1, -1, 1, -1, -1, 1, -1], [2, 4])
    type(direction_t) :: round, along
    integer :: i

    round = new_direction(family_lagrange, 1, [0.0_wp, 1.0_wp, 2.0_wp, 3.0_wp, 4.0_wp])
    along = new_direction(family_lagrange, 1, [0.0_wp, 1.0_wp])
    surface = surface_of([round, along], [1, 2, 3, 4, 1, 5, 6, 7, 8, 5], [(1.0_wp, i=1, 10)])
    allocate (positions(3, 8))
    do i = 1, 4
      positions(:, i) = [corner(:, i), 0.0_wp]
      positions(:, 4 + i) = [corner(:, i), 1.0_wp]
    end do
  end subroutine tube

  !> A slave of one quadrature point, which is the control point of a number.
  function lone_point(number) result(slave)
    integer, intent(in) :: number
    type(slave_t) :: slave

    slave%shape%count = 1
    slave%shape%nodes = reshape([1], [1, 1])
    slave%shape%values = reshape([1.0_wp], [1, 1])
    slave%test = slave%shape
    slave%per_element = 1
    slave%slopes = reshape([0.0_wp, 0.0_wp], [1, 2, 1])
    slave%outward = 1.0_wp
    slave%area = [1.0_wp]
    slave%point = [number]
  end function lone_point

end module surfaces
