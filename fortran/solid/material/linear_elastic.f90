!> Hooke's solid of small strain, P = (A1 - 2/3 A2) tr e 1 + 2 A2 e with e = sym(F - 1). Not objective: for small turns alone.
module isomortar_solid_material_linear_elastic
  use isomortar_base_kinds, only: lanes, wp
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
    real(wp), intent(out) :: kirchhoff(lanes, 3, 3)
    real(wp) :: p(lanes, 3, 3)
    integer :: i, k

    associate (h => state%gradient)
      do k = 1, 3
        do i = 1, 3
          p(:, i, k) = self%shear * (h(:, i, k) + h(:, k, i))
        end do
        p(:, k, k) = p(:, k, k) + (self%bulk - 2.0_wp / 3.0_wp * self%shear) * (h(:, 1, 1) + h(:, 2, 2) + h(:, 3, 3))
      end do
      do k = 1, 3
        do i = 1, 3
          kirchhoff(:, i, k) = p(:, i, k) + (p(:, i, 1) * h(:, k, 1) + p(:, i, 2) * h(:, k, 2) + p(:, i, 3) * h(:, k, 3))
        end do
      end do
    end associate
  end subroutine stress

  !> (A1 - 2/3 A2) F_ji F_lk + A2 (delta_ik b_jl + F_li F_jk) (theory 1.11).
  pure subroutine tangent(self, state, moduli)
    class(linear_elastic_t), intent(in) :: self
    type(stretch_t), intent(in) :: state
    real(wp), intent(out) :: moduli(lanes, 3, 3, 6)
    real(wp) :: f(lanes, 3, 3)
    integer :: i, j, k, l, pair

    f = state%gradient
    do i = 1, 3
      f(:, i, i) = 1.0_wp + f(:, i, i)
    end do
    do pair = 1, 6
      i = component_pairs(1, pair)
      k = component_pairs(2, pair)
      do l = 1, 3
        do j = 1, 3
          moduli(:, j, l, pair) = (self%bulk - 2.0_wp / 3.0_wp * self%shear) * f(:, l, k) * f(:, j, i) &
            + self%shear * f(:, l, i) * f(:, j, k)
        end do
      end do
      if (i == k) moduli(:, :, :, pair) = moduli(:, :, :, pair) + self%shear * state%left_cauchy_green
    end do
  end subroutine tangent

end module isomortar_solid_material_linear_elastic
