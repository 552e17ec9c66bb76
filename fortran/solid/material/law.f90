!> What a material law has to answer at quadrature points, and the deformations that it is asked about.
!>
!> A law is one file beside this one, with one entry in `isomortar_solid_material_table`. The element does not know which it serves.
!> Laws answer for a point of each of several elements at once, the lane running fastest: a processor does the same for all of them.
!>
!> - `state`: the deformations.
module isomortar_solid_material_law
  use isomortar_base_algebra, only: log1p
  use isomortar_base_kinds, only: lanes, wp
  use isomortar_solid_points, only: determinants
  implicit none
  private

  public :: stretch

  !> Components i, k of the six tangents K_ik that are integrated; K_ki of control points a, b is K_ik of b, a.
  integer, parameter, public :: component_pairs(2, 6) = reshape([1, 1, 2, 2, 3, 3, 1, 2, 1, 3, 2, 3], [2, 6])

  !> Deformations at a point, with the digits of small displacement gradients kept: arrays (lane), (lane, row, column).
  type, public :: stretch_t
    !> h = F - 1.
    real(wp) :: gradient(lanes, 3, 3)
    !> J = det F, J - 1 and ln J (0 where J is not above 0).
    real(wp) :: jacobian(lanes), growth(lanes), log_jacobian(lanes)
    !> J^(-2/3) (1 where J is not above 0).
    real(wp) :: isochoric(lanes)
    !> b = F Fᵀ, and its deviator from b - 1: no cancellation near the reference state.
    real(wp) :: left_cauchy_green(lanes, 3, 3), deviator(lanes, 3, 3)
    !> tr b.
    real(wp) :: trace(lanes)
  end type stretch_t

  !> A material law: a stored energy per reference volume.
  type, abstract, public :: material_t
  contains
    procedure(stress_of), deferred :: stress
    procedure(tangent_of), deferred :: tangent
  end type material_t

  abstract interface
    !> P Fᵀ, force per reference area turned to the current configuration: of an objective law the Kirchhoff stress J sigma,
    !> `kirchhoff` (lane, row, column) (theory 1.6).
    pure subroutine stress_of(self, state, kirchhoff)
      import :: lanes, material_t, stretch_t, wp
      implicit none
      class(material_t), intent(in) :: self
      type(stretch_t), intent(in) :: state
      real(wp), intent(out) :: kirchhoff(lanes, 3, 3)
    end subroutine stress_of

    !> a_ijkl = F_jJ (dP_iJ / dF_kL) F_lL as `moduli` (lane, j, l, pair of i and k), force per area: with spatial gradients g of
    !> control points a and b K_ik = g_jᵃ a_ijkl g_lᵇ (theory 1.8).
    pure subroutine tangent_of(self, state, moduli)
      import :: lanes, material_t, stretch_t, wp
      implicit none
      class(material_t), intent(in) :: self
      type(stretch_t), intent(in) :: state
      real(wp), intent(out) :: moduli(lanes, 3, 3, 6)
    end subroutine tangent_of
  end interface

contains

  !> Stretches of displacement gradients `h` (lane, row, column), F - 1. J - 1 is summed from the invariants of h (theory 1.4).
  pure subroutine stretch(h, self)
    real(wp), intent(in) :: h(lanes, 3, 3)
    type(stretch_t), intent(out) :: self
    integer :: i, k, l

    associate (b => self%left_cauchy_green, e => self%deviator)
      self%gradient = h
      call determinants(h, self%growth)
      self%growth = self%growth + (h(:, 1, 1) + h(:, 2, 2) + h(:, 3, 3)) + (h(:, 1, 1) * h(:, 2, 2) - h(:, 1, 2) * h(:, 2, 1) &
        + h(:, 2, 2) * h(:, 3, 3) - h(:, 2, 3) * h(:, 3, 2) + h(:, 1, 1) * h(:, 3, 3) - h(:, 1, 3) * h(:, 3, 1))
      self%jacobian = 1.0_wp + self%growth
      do l = 1, lanes ! one by one: vector functions have fewer digits, and none where numbers are not rounded to nearest
        self%log_jacobian(l) = 0.0_wp
        self%isochoric(l) = 1.0_wp
        if (self%jacobian(l) > 0.0_wp) then
          self%log_jacobian(l) = log1p(self%growth(l))
          self%isochoric(l) = exp(-2.0_wp / 3.0_wp * self%log_jacobian(l))
        end if
      end do
      do k = 1, 3
        do i = 1, k
          e(:, i, k) = h(:, i, k) + h(:, k, i) + (h(:, i, 1) * h(:, k, 1) + h(:, i, 2) * h(:, k, 2) + h(:, i, 3) * h(:, k, 3))
          b(:, i, k) = e(:, i, k) + merge(1.0_wp, 0.0_wp, i == k)
          e(:, k, i) = e(:, i, k)
          b(:, k, i) = b(:, i, k)
        end do
      end do
      self%trace = e(:, 1, 1) + e(:, 2, 2) + e(:, 3, 3)
      do i = 1, 3
        e(:, i, i) = e(:, i, i) - self%trace / 3.0_wp
      end do
      self%trace = 3.0_wp + self%trace
    end associate
  end subroutine stretch

end module isomortar_solid_material_law
