!> The material laws by number. Another law: its file, a number, and a case here.
module isomortar_solid_material_table
  use isomortar_base_kinds, only: wp
  use isomortar_base_status, only: status_no_such_law, status_ok
  use isomortar_solid_material_law, only: material_t
  use isomortar_solid_material_linear_elastic, only: linear_elastic_t
  use isomortar_solid_material_neo_hookean, only: neo_hookean_t
  use isomortar_solid_material_neo_hookean_j, only: neo_hookean_j_t
  implicit none
  private

  public :: material_of

  !> Numbers of the laws, here and in Python (isomortar._arrays). Each has the parameters A1, A2.
  integer, parameter, public :: law_neo_hookean = 1, law_neo_hookean_j = 2, law_linear_elastic = 3

contains

  !> The law of a number with its parameters.
  !>
  !> - `law`, `parameters` (number): which one, and what it takes, A1 and A2, force per area.
  !> - `material`: the law. `status`: whether there is one that takes so many (isomortar_base_status).
  subroutine material_of(law, parameters, material, status)
    integer, intent(in) :: law
    real(wp), intent(in) :: parameters(:)
    class(material_t), allocatable, intent(out) :: material
    integer, intent(out) :: status

    status = status_no_such_law
    if (size(parameters) /= 2) return
    select case (law)
    case (law_neo_hookean)
      allocate (material, source=neo_hookean_t(parameters(1), parameters(2)))
    case (law_neo_hookean_j)
      allocate (material, source=neo_hookean_j_t(parameters(1), parameters(2)))
    case (law_linear_elastic)
      allocate (material, source=linear_elastic_t(parameters(1), parameters(2)))
    case default
      return
    end select
    status = status_ok
  end subroutine material_of

end module isomortar_solid_material_table
