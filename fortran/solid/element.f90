!> Residual and tangent of one solid element.
module isomortar_solid_element
  use isomortar_base_algebra, only: determinant, identity, inverse
  use isomortar_base_kinds, only: wp
  use isomortar_base_status, only: status_folded, status_folded_initially, status_ok
  use isomortar_nurbs_patch, only: line_rule_t, volume_gradients
  use isomortar_solid_material, only: kirchhoff_stress, stretch, stretch_t, tangent_coefficients
  implicit none
  private

  public :: element_residual, element_tangent, sample_element

  !> Everything at the quadrature points of an element that residual and tangent are made of.
  type, public :: samples_t
    !> Gradients of the functions in the current configuration: (control point, point, component).
    real(wp), allocatable :: gradient(:, :, :)
    !> Quadrature weight times reference volume.
    real(wp), allocatable :: volume(:)
    type(stretch_t), allocatable :: state(:)
    !> Smallest J of the current configuration over the points.
    real(wp) :: smallest_jacobian
    !> Sum of the volumes.
    real(wp) :: total_volume
  end type samples_t

contains

  !> Evaluate an element at all its quadrature points.
  !> `positions` and `references` are its control points, shape (3, control points).
  pure subroutine sample_element(u, v, w, weight, positions, references, samples, status)
    type(line_rule_t), intent(in) :: u, v, w
    real(wp), intent(in) :: weight(:), positions(:, :), references(:, :)
    type(samples_t), intent(inout) :: samples
    integer, intent(out) :: status
    real(wp) :: parametric(size(weight), 3), map(3, 3), det, h(3, 3), f(3, 3), displacements(3, size(weight))
    integer :: i, j, k, q

    status = status_ok
    call reserve(samples, size(weight), size(u%weight) * size(v%weight) * size(w%weight))
    displacements = positions - references
    samples%smallest_jacobian = huge(1.0_wp)
    q = 0
    do k = 1, size(w%weight)
      do j = 1, size(v%weight)
        do i = 1, size(u%weight)
          q = q + 1
          call volume_gradients(u%values(:, :, i), v%values(:, :, j), w%values(:, :, k), weight, parametric)
          map = matmul(references, parametric)
          det = determinant(map)
          if (.not. det > 0.0_wp) then
            status = status_folded_initially
            samples%smallest_jacobian = det
            return
          end if
          h = matmul(matmul(displacements, parametric), inverse(map, det))
          samples%state(q) = stretch(h)
          samples%volume(q) = u%weight(i) * v%weight(j) * w%weight(k) * det
          samples%smallest_jacobian = min(samples%smallest_jacobian, samples%state(q)%jacobian)
          if (.not. samples%state(q)%jacobian > 0.0_wp) then
            status = status_folded
            return
          end if
          f = matmul(identity + h, map)
          samples%gradient(:, q, :) = matmul(parametric, inverse(f, determinant(f)))
        end do
      end do
    end do
    samples%total_volume = sum(samples%volume)
  end subroutine sample_element

  !> Make room for n control points and m quadrature points.
  pure subroutine reserve(samples, n, m)
    type(samples_t), intent(inout) :: samples
    integer, intent(in) :: n, m

    if (allocated(samples%gradient)) then
      if (size(samples%gradient, 1) == n .and. size(samples%volume) == m) return
      deallocate (samples%gradient, samples%volume, samples%state)
    end if
    allocate (samples%gradient(n, m, 3), samples%volume(m), samples%state(m))
  end subroutine reserve

  !> Internal forces, shape (3, control points).
  pure subroutine element_residual(samples, bulk, shear, residual)
    type(samples_t), intent(in) :: samples
    real(wp), intent(in) :: bulk, shear
    real(wp), intent(out) :: residual(:, :)
    real(wp) :: stress(3, 3)
    integer :: q

    residual = 0.0_wp
    do q = 1, size(samples%volume)
      stress = samples%volume(q) * kirchhoff_stress(samples%state(q), bulk, shear)
      residual = residual + matmul(stress, transpose(samples%gradient(:, q, :)))
    end do
  end subroutine element_residual

  !> Tangent, shape (control points, 3, control points, 3), as products of matrices over all quadrature points.
  pure subroutine element_tangent(samples, bulk, shear, tangent)
    type(samples_t), intent(in) :: samples
    real(wp), intent(in) :: bulk, shear
    real(wp), intent(out) :: tangent(:, :, :, :)
    real(wp), allocatable :: left(:, :), right(:, :), stretched(:, :, :), c(:, :), shear_part(:, :)
    integer :: i, k, m, n, q

    n = size(samples%gradient, 1)
    m = size(samples%volume)
    allocate (left(n, 3 * m), right(n, 3 * m), stretched(n, m, 3), c(4, m), shear_part(n, n))
    do q = 1, m
      c(:, q) = samples%volume(q) * tangent_coefficients(samples%state(q), bulk, shear)
      stretched(:, q, :) = matmul(samples%gradient(:, q, :), samples%state(q)%left_cauchy_green)
    end do

    do i = 1, 3
      do q = 1, m
        left(:, (i - 1) * m + q) = c(3, q) * samples%gradient(:, q, i)
        right(:, (i - 1) * m + q) = stretched(:, q, i)
      end do
    end do
    shear_part = matmul(left, transpose(right))

    do k = 1, 3
      do i = 1, k
        do q = 1, m
          left(:, q) = c(1, q) * samples%gradient(:, q, i) - c(4, q) * stretched(:, q, i)
          left(:, m + q) = -c(4, q) * samples%gradient(:, q, i)
          left(:, 2 * m + q) = c(2, q) * samples%gradient(:, q, k)
          right(:, q) = samples%gradient(:, q, k)
          right(:, m + q) = stretched(:, q, k)
          right(:, 2 * m + q) = samples%gradient(:, q, i)
        end do
        tangent(:, i, :, k) = matmul(left, transpose(right))
        if (i == k) then
          tangent(:, i, :, i) = tangent(:, i, :, i) + shear_part
        else
          tangent(:, k, :, i) = transpose(tangent(:, i, :, k))
        end if
      end do
    end do
  end subroutine element_tangent

end module isomortar_solid_element
