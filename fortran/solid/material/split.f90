!> Neo-Hookean energies that split into volume and shape, W = U(J) + A2/2 (J^(-2/3) tr C - 3): what laws of that kind share.
!>
!> - `state`: the deformations. `spherical` (lane): J U', force per area. `shear`: A2, the same.
module isomortar_solid_material_split
  use isomortar_base_kinds, only: lanes, wp
  use isomortar_solid_material_law, only: component_pairs, stretch_t
  implicit none
  private

  public :: split_stress, split_tangent

contains

  !> Kirchhoff stresses J U' 1 + A2 J^(-2/3) dev b, force per area: `stress` (lane, row, column) (theory 1.6).
  pure subroutine split_stress(state, spherical, shear, stress)
    type(stretch_t), intent(in) :: state
    real(wp), intent(in) :: spherical(lanes), shear
    real(wp), intent(out) :: stress(lanes, 3, 3)
    real(wp) :: scale(lanes)
    integer :: i, k

    scale = shear * state%isochoric
    do k = 1, 3
      do i = 1, 3
        stress(:, i, k) = scale * state%deviator(:, i, k)
      end do
      stress(:, k, k) = spherical + stress(:, k, k)
    end do
  end subroutine split_stress

  !> The `moduli` c1 delta_ij delta_kl + c2 delta_il delta_jk + c3 delta_ik b_jl - c4 (b_ij delta_kl + delta_ij b_kl), force per
  !> area, as (lane, j, l, pair of i and k). `slope` (lane) is J (J U')' (theory 1.9, 1.10).
  pure subroutine split_tangent(state, spherical, slope, shear, moduli)
    type(stretch_t), intent(in) :: state
    real(wp), intent(in) :: spherical(lanes), slope(lanes), shear
    real(wp), intent(out) :: moduli(lanes, 3, 3, 6)
    real(wp) :: c(lanes, 4)
    integer :: i, j, k, l, pair

    c(:, 3) = shear * state%isochoric
    c(:, 1) = slope + 2.0_wp / 9.0_wp * c(:, 3) * state%trace
    c(:, 2) = c(:, 3) * state%trace / 3.0_wp - spherical
    c(:, 4) = 2.0_wp / 3.0_wp * c(:, 3)
    associate (b => state%left_cauchy_green)
      do pair = 1, 6
        i = component_pairs(1, pair)
        k = component_pairs(2, pair)
        do l = 1, 3
          do j = 1, 3
            moduli(:, j, l, pair) = 0.0_wp
            if (i == k) moduli(:, j, l, pair) = c(:, 3) * b(:, j, l)
            if (i == j) moduli(:, j, l, pair) = moduli(:, j, l, pair) - c(:, 4) * b(:, k, l)
            if (k == l) moduli(:, j, l, pair) = moduli(:, j, l, pair) - c(:, 4) * b(:, i, j)
          end do
        end do
        moduli(:, i, k, pair) = moduli(:, i, k, pair) + c(:, 1)
        moduli(:, k, i, pair) = moduli(:, k, i, pair) + c(:, 2)
      end do
    end associate
  end subroutine split_tangent

end module isomortar_solid_material_split
