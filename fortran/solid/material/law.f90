!> What a material law has to answer at a quadrature point, and the deformation that it is asked about.
!>
!> A law is one file beside this one, with one entry in `isomortar_solid_material_table`. The element does not know which it serves.
!>
!> - `state`: the deformation.
module isomortar_solid_material_law
  use isomortar_base_algebra, only: determinant, identity, log1p, trace
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_symmetric
  implicit none
  private

  public :: stretch

  !> Components i, k of the six tangents K_ik that are integrated; K_ki of control points a, b is K_ik of b, a.
  integer, parameter, public :: component_pairs(2, 6) = reshape([1, 1, 2, 2, 3, 3, 1, 2, 1, 3, 2, 3], [2, 6])

  !> A deformation at a point, with the digits of a small displacement gradient kept.
  type, public :: stretch_t
    !> h = F - 1.
    real(wp) :: gradient(3, 3)
    !> J = det F, J - 1 and ln J (0 where J is not above 0).
    real(wp) :: jacobian, growth, log_jacobian
    !> b = F Fᵀ, and its deviator from b - 1: no cancellation near the reference state.
    real(wp) :: left_cauchy_green(3, 3), deviator(3, 3)
    !> tr b.
    real(wp) :: trace
  end type stretch_t

  !> A material law: a stored energy per reference volume.
  type, abstract, public :: material_t
  contains
    procedure(stress_of), deferred :: stress
    procedure(tangent_of), deferred :: tangent
  end type material_t

  abstract interface
    !> P Fᵀ, force per reference area turned to the current configuration: of an objective law the Kirchhoff stress J sigma,
    !> `kirchhoff` (theory 1.6).
    pure subroutine stress_of(self, state, kirchhoff)
      import :: material_t, stretch_t, wp
      implicit none
      class(material_t), intent(in) :: self
      type(stretch_t), intent(in) :: state
      real(wp), intent(out) :: kirchhoff(3, 3)
    end subroutine stress_of

    !> a_ijkl = F_jJ (dP_iJ / dF_kL) F_lL as `moduli` (j, l, pair of i and k), force per area: with spatial gradients g of control
    !> points a and b K_ik = g_jᵃ a_ijkl g_lᵇ (theory 1.8).
    pure subroutine tangent_of(self, state, moduli)
      import :: material_t, stretch_t, wp
      implicit none
      class(material_t), intent(in) :: self
      type(stretch_t), intent(in) :: state
      real(wp), intent(out) :: moduli(3, 3, 6)
    end subroutine tangent_of
  end interface

contains

  !> Stretch of the displacement gradient `h` = F - 1. J - 1 is summed from the invariants of h (theory 1.4).
  pure subroutine stretch(h, self)
    real(wp), intent(in) :: h(3, 3)
    type(stretch_t), intent(out) :: self
    real(wp) :: increment(3, 3), second

    second = h(1, 1) * h(2, 2) - h(1, 2) * h(2, 1) + h(2, 2) * h(3, 3) - h(2, 3) * h(3, 2) &
      + h(1, 1) * h(3, 3) - h(1, 3) * h(3, 1)
    self%gradient = h
    self%growth = trace(h) + second + determinant(h)
    self%jacobian = 1.0_wp + self%growth
    self%log_jacobian = 0.0_wp
    if (self%jacobian > 0.0_wp) self%log_jacobian = log1p(self%growth)
    increment = h + transpose(h) + matmul(h, transpose(h))
    self%left_cauchy_green = identity + increment
    self%deviator = increment - trace(increment) / 3.0_wp * identity
    self%trace = 3.0_wp + trace(increment)
    if (contracts) call require(is_symmetric(self%left_cauchy_green), "stretch: b is symmetric")
  end subroutine stretch

end module isomortar_solid_material_law
