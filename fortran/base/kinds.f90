!> Working precision of the kernel: double. `kinds_extended.f90` takes this file's place in the twin used for verification.
module isomortar_base_kinds
  use, intrinsic :: iso_fortran_env, only: int32, int64, real64
  implicit none
  private

  !> Kind of every real number of the kernel.
  integer, parameter, public :: wp = real64
  !> Kind of counts and numbers of unknowns, elements, control points.
  integer, parameter, public :: ip = int32
  !> Kind of positions in a sparse matrix, and of handles.
  integer, parameter, public :: lp = int64
  !> Elements that are computed side by side: as many as a register of AVX2 holds numbers.
  integer, parameter, public :: lanes = 4

end module isomortar_base_kinds
