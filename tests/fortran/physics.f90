!> Runs the tests of one subject: physics SUBJECT.
program physics
  use test_kinks, only: kinks
  use test_materials, only: materials
  use test_return_map, only: return_maps
  use test_seams, only: seams
  use test_spans, only: spans
  use test_variations, only: variations
  use testing, only: end_tests
  implicit none
  character(32) :: subject

  call get_command_argument(1, subject)
  select case (subject)
  case ("kinks")
    call kinks()
  case ("materials")
    call materials()
  case ("return_map")
    call return_maps()
  case ("seams")
    call seams()
  case ("spans")
    call spans()
  case ("variations")
    call variations()
  case default
    error stop "physics SUBJECT: there is no such subject"
  end select
  call end_tests()
end program physics
