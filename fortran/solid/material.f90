!> Neo-Hookean solid with volumetric-deviatoric split, in the current configuration (theory 1).
module isomortar_solid_material
  use isomortar_base_algebra, only: determinant, identity, log1p, trace
  use isomortar_base_kinds, only: wp
  implicit none
  private

  public :: stretch, kirchhoff_stress, tangent_coefficients

  !> What the material needs of a deformation, with the digits of a small displacement gradient kept.
  type, public :: stretch_t
    !> J = det F.
    real(wp) :: jacobian
    !> ln J.
    real(wp) :: log_jacobian
    !> b = F Fᵀ.
    real(wp) :: left_cauchy_green(3, 3)
    !> Deviator of b, from b - 1: no cancellation near the reference state.
    real(wp) :: deviator(3, 3)
    !> tr b.
    real(wp) :: trace
  end type stretch_t

contains

  !> Stretch of the displacement gradient h = F - 1. J - 1 is summed from the invariants of h (theory 1.4).
  pure function stretch(h) result(self)
    real(wp), intent(in) :: h(3, 3)
    type(stretch_t) :: self
    real(wp) :: growth, increment(3, 3), second

    second = h(1, 1) * h(2, 2) - h(1, 2) * h(2, 1) + h(2, 2) * h(3, 3) - h(2, 3) * h(3, 2) &
      + h(1, 1) * h(3, 3) - h(1, 3) * h(3, 1)
    growth = trace(h) + second + determinant(h)
    self%jacobian = 1.0_wp + growth
    self%log_jacobian = 0.0_wp
    if (self%jacobian > 0.0_wp) self%log_jacobian = log1p(growth)
    increment = h + transpose(h) + matmul(h, transpose(h))
    self%left_cauchy_green = identity + increment
    self%deviator = increment - trace(increment) / 3.0_wp * identity
    self%trace = 3.0_wp + trace(increment)
  end function stretch

  !> Kirchhoff stress J sigma = A1 ln J 1 + A2 J^(-2/3) dev b; the first Piola stress is this times F⁻ᵀ (theory 1.1, 1.6).
  pure function kirchhoff_stress(state, bulk, shear) result(stress)
    type(stretch_t), intent(in) :: state
    real(wp), intent(in) :: bulk, shear
    real(wp) :: stress(3, 3)

    stress = bulk * state%log_jacobian * identity + isochoric(state, shear) * state%deviator
  end function kirchhoff_stress

  !> Coefficients of the tangent of control points a, b with spatial gradients g, h = b g (theory 1.9):
  !> K_ik = c1 g_i^a g_k^b + c2 g_k^a g_i^b + c3 (g^a.h^b) delta_ik - c4 (h_i^a g_k^b + g_i^a h_k^b).
  pure function tangent_coefficients(state, bulk, shear) result(c)
    type(stretch_t), intent(in) :: state
    real(wp), intent(in) :: bulk, shear
    real(wp) :: c(4)

    c(3) = isochoric(state, shear)
    c(1) = bulk + 2.0_wp / 9.0_wp * c(3) * state%trace
    c(2) = c(3) * state%trace / 3.0_wp - bulk * state%log_jacobian
    c(4) = 2.0_wp / 3.0_wp * c(3)
  end function tangent_coefficients

  !> A2 J^(-2/3).
  pure real(wp) function isochoric(state, shear)
    type(stretch_t), intent(in) :: state
    real(wp), intent(in) :: shear

    isochoric = shear * exp(-2.0_wp / 3.0_wp * state%log_jacobian)
  end function isochoric

end module isomortar_solid_material
