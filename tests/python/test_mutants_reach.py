"""Which lines a cell runs, and of which statement a line is."""

from __future__ import annotations

import subprocess

import pytest

from isomortar.harness.collection import collect
from isomortar.harness.mutants import lines_of_kernel, lines_of_python
from isomortar.harness.mutants.bench import Bench, freeze
from isomortar.harness.mutants.reach import that_may_run, without_lines

STATEMENTS = """LIMIT = (
    1
)
@decorated(
    2
)
def f(a, b=3):
    if a > (
        4
    ):
        return g(
            5
        )
    return [
        6 for _ in b
    ]
class C:
    field = 7
    def method(self):
        return 8
"""


@pytest.mark.parametrize(
    ("number", "lines"),
    [
        (2, range(4, 17)), (3, range(4, 17)), (4, range(8, 14)), (5, range(11, 14)), (6, range(14, 17)), (8, range(20, 21)),
    ],
)  # fmt: skip
def test_a_line_is_of_the_statement_that_runs_it(number, lines):
    assert lines_of_python.places(STATEMENTS, [line_of(number)]) == [set(lines)]


@pytest.mark.parametrize("number", [1, 7])
def test_what_an_import_runs_anybody_may_use(number):
    assert lines_of_python.places(STATEMENTS, [line_of(number)]) == []


def line_of(number):
    return 1 + STATEMENTS[: STATEMENTS.index(str(number))].count("\n")


def test_lines_are_of_all_their_statements():
    assert lines_of_python.places(STATEMENTS, [9, 15]) == [{*range(8, 17)}]
    assert lines_of_python.places(STATEMENTS, [15, 1]) == []


ONCE = """from functools import cache, lru_cache
def _made(text):
    return 1, text
def plain(x):
    return 2, x
@cache
def kept(x):
    return 3, x
@functools.lru_cache(maxsize=5)
def few(x):
    return 4, x
TABLE = {"a": _made("b")}
class C:
    def _made(self):
        return plain(5)
"""


@pytest.mark.parametrize(("line", "once"), [(3, True), (5, False), (8, True), (11, True), (12, True), (13, True), (15, True)])
def test_what_runs_once_a_process_anybody_may_use(line, once):
    """By its name: a method that is called like a function that an import calls is taken for it."""
    assert (lines_of_python.places(ONCE, [line]) == []) == once


def test_what_no_cell_runs_all_may_see():
    """Files are run when they are imported, and declarations leave no trace."""
    ran = {"one": {"a.py": [1, 2], "b.py": [7]}, "two": {"a.py": [2, 3]}, "three": {}}
    assert that_may_run(ran, "a.py", [{1}]) == {"one"}
    assert that_may_run(ran, "a.py", [{2, 9}]) == {"one", "two"}
    assert that_may_run(ran, "a.py", [{9}, {3, 4}]) == {"two"}
    assert that_may_run(ran, "a.py", [{1}, {2}]) == {"one"}
    assert that_may_run(ran, "b.py", []) == set(ran)
    assert that_may_run(ran, "b.py", [{8}]) == set(ran)


RUN_CASE = """
from isomortar.harness import Bound, case

@case(claim="Lines.", bounds={"zero": Bound(at_most=1.0, reason="definition: so")}, grid={"k": [1, 2]})
def runs(k):
    from isomortar.geometry.quadrature import which

    for _ in range(3):
        which(k)
    return {"zero": 0.0}
"""
WHICH = """def which(k):
    if k == 1:
        return [
            k for _ in range(2)
        ]
    return -k
"""


def test_lines_that_a_cell_runs(tmp_path):
    """Each cell's own, also those of a function that another cell had run before, and again after every line of it was run."""
    (tmp_path / "cases/runs_family").mkdir(parents=True)
    (tmp_path / "cases/runs_family/runs_cases.py").write_text(RUN_CASE)
    first, second = (cell for case in collect(tmp_path / "cases") for cell in case.cells)
    package, frozen = freeze(tmp_path / "cases", tmp_path / "frozen")
    (package / "geometry/quadrature.py").write_text(WHICH)
    (tmp_path / "sound").mkdir()
    with Bench(package, frozen, tmp_path / "bench", lines_of_python.__name__) as bench:
        for cell, expected in ((first, {1, 2, 3, 4}), (second, {1, 2, 6}), (first, {1, 2, 3, 4})):
            measurement, lines = without_lines(bench.measure(tmp_path / "sound", cell, 60.0))
            assert measurement.numbers == {"zero": 0.0}
            assert set(lines["geometry/quadrature.py"]) == expected


KERNEL = """module kernel
  integer, parameter :: limit = 1
contains
  !> function of nothing
  pure subroutine step(a, &
      b) bind(c)
    integer, value :: a
    integer, intent(inout) :: b
    integer, parameter :: by = 2
    if (a > limit .and. & ! not
        a < 10) then
      b = b + by
    else
      b = inner(a)
    end if
  contains
    pure integer function inner(c)
      integer, intent(in) :: c
      inner = 2 * &
        c
    end function inner
  end subroutine step
end module kernel
"""


@pytest.mark.parametrize(
    ("line", "statement", "procedure"),
    [
        (9, {9}, range(5, 23)), (11, {10, 11}, range(5, 23)), (12, {12}, range(5, 23)), (5, {5, 6}, range(5, 23)),
        (20, {19, 20}, range(17, 22)),
    ],
)  # fmt: skip
def test_a_line_of_the_kernel_is_of_a_statement_and_a_procedure(line, statement, procedure):
    assert lines_of_kernel.places(KERNEL, [line]) == [statement, set(procedure)]


def test_what_a_module_declares_anybody_may_use():
    assert lines_of_kernel.places(KERNEL, [2]) == []
    assert lines_of_kernel.places(KERNEL, [12, 2]) == []


RUN_KERNEL = """
import ctypes
import subprocess
import sys
from pathlib import Path

import isomortar
from isomortar.harness import Bound, case

PATH = str(Path(isomortar.__file__).parent / "_counted.so")
STEP = "import ctypes, sys; ctypes.CDLL(sys.argv[1]).step(0, ctypes.byref(ctypes.c_int()))"

@case(claim="Lines.", bounds={"zero": Bound(at_most=1.0, reason="definition: so")}, grid={"a": [0, 5], "elsewhere": [False, True]})
def runs(a, elsewhere):
    if elsewhere:
        subprocess.run([sys.executable, "-c", STEP, PATH], check=True)
    ctypes.CDLL(PATH).step(a, ctypes.byref(ctypes.c_int()))
    return {"zero": 0.0}
"""


def test_lines_of_the_kernel_that_a_cell_runs(tmp_path):
    """Each cell's own, also those that another process runs for it."""
    for folder in ("cases/kernel_family", "fortran", "build", "sound"):
        (tmp_path / folder).mkdir(parents=True)
    (tmp_path / "cases/kernel_family/kernel_cases.py").write_text(RUN_KERNEL)
    (tmp_path / "fortran/kernel.f90").write_text(KERNEL)
    (tmp_path / "build/counts.c").write_text(lines_of_kernel.COUNTS)
    sources = ["../fortran/kernel.f90", "counts.c", "-o", str(tmp_path / "sound/_counted.so")]
    subprocess.run(["gfortran", "--coverage", "-shared", "-fPIC", *sources], cwd=tmp_path / "build", check=True)
    cells = [cell for case in collect(tmp_path / "cases") for cell in case.cells]
    package, frozen = freeze(tmp_path / "cases", tmp_path / "frozen")
    (package / "_counted.so").touch()
    with Bench(package, frozen, tmp_path / "bench", lines_of_kernel.__name__) as bench:
        for cell in cells:
            measurement, lines = without_lines(bench.measure(tmp_path / "sound", cell, 60.0))
            assert measurement.numbers == {"zero": 0.0}, measurement.message
            ran = set(lines["kernel.f90"])
            assert 10 in ran
            assert (12 in ran) == (cell.settings["a"] == 5)
            assert (14 in ran) == (cell.settings["a"] == 0 or cell.settings["elsewhere"])
