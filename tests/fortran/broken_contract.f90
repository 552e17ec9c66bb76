!> Breaks a contract on purpose: knots that fall.
program broken_contract
  use isomortar_base_kinds, only: wp
  use isomortar_nurbs_direction, only: direction_t, family_lagrange, new_direction
  implicit none
  type(direction_t) :: line

  line = new_direction(family_lagrange, 1, [0.0_wp, 2.0_wp, 1.0_wp])
  print "(a, i0)", "contracts are not checked: elements = ", line%elements
end program broken_contract
