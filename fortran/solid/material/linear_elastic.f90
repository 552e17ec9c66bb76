!> Hooke's solid of small strain, P = (A1 - 2/3 A2) tr e 1 + 2 A2 e with e = sym(F - 1). Not objective: for small turns alone.
module isomortar_solid_material_linear_elastic
  use isomortar_base_algebra, only: identity, trace
  use isomortar_base_kinds, only: wp
  use isomortar_solid_material_law, only: component_pairs, material_t, stretch_t
  implicit none
  private

  type, extends(material_t), public :: linear_elastic_t
    !> A1 and A2, force per area.
    real(wp) :: bulk, shear
  contains
    procedure :: stress
    procedure :: tangent
  end type linear_elastic_t

contains

  !> P Fᵀ (theory 1.1, 1.6).
  pure subroutine stress(self, state, kirchhoff)
    class(linear_elastic_t), intent(in) :: self
    type(stretch_t), intent(in) :: state
    real(wp), intent(out) :: kirchhoff(3, 3)
    real(wp) :: p(3, 3)

    associate (h => state%gradient)
      p = (self%bulk - 2.0_wp / 3.0_wp * self%shear) * trace(h) * identity + self%shear * (h + transpose(h))
      kirchhoff = p + matmul(p, transpose(h))
    end associate
  end subroutine stress

  !> (A1 - 2/3 A2) F_ji F_lk + A2 (delta_ik b_jl + F_li F_jk) (theory 1.11).
  pure subroutine tangent(self, state, moduli)
    class(linear_elastic_t), intent(in) :: self
    type(stretch_t), intent(in) :: state
    real(wp), intent(out) :: moduli(3, 3, 6)
    real(wp) :: f(3, 3)
    integer :: i, k, l, pair

    f = identity + state%gradient
    do pair = 1, 6
      i = component_pairs(1, pair)
      k = component_pairs(2, pair)
      do l = 1, 3
        moduli(:, l, pair) = (self%bulk - 2.0_wp / 3.0_wp * self%shear) * f(l, k) * f(:, i) + self%shear * f(l, i) * f(:, k)
      end do
      if (i == k) moduli(:, :, pair) = moduli(:, :, pair) + self%shear * state%left_cauchy_green
    end do
  end subroutine tangent

end module isomortar_solid_material_linear_elastic
