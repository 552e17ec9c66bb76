!> Working precision of the verification twin: quadruple. Takes the place of `kinds.f90`.
module isomortar_base_kinds
  use, intrinsic :: iso_fortran_env, only: int32, int64, real128
  implicit none
  private

  !> Kind of every real number of the kernel.
  integer, parameter, public :: wp = real128
  !> Kind of counts and numbers of unknowns, elements, control points.
  integer, parameter, public :: ip = int32
  !> Kind of positions in a sparse matrix, and of handles.
  integer, parameter, public :: lp = int64
  !> Elements that are computed side by side: as many as in double precision, so that the same is run.
  integer, parameter, public :: lanes = 4

end module isomortar_base_kinds
