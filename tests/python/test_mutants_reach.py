"""Which lines of Python a cell runs, and of which statement a line is."""

from __future__ import annotations

import pytest

from isomortar.harness.collection import collect
from isomortar.harness.mutants.bench import Bench, freeze
from isomortar.harness.mutants.reach import statements_at, that_may_run, without_lines

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
    assert statements_at(STATEMENTS, [line_of(number)]) == set(lines)


@pytest.mark.parametrize("number", [1, 7])
def test_what_an_import_runs_anybody_may_use(number):
    assert statements_at(STATEMENTS, [line_of(number)]) is None


def line_of(number):
    return 1 + STATEMENTS[: STATEMENTS.index(str(number))].count("\n")


def test_lines_are_of_all_their_statements():
    assert statements_at(STATEMENTS, [9, 15]) == {*range(8, 17)}
    assert statements_at(STATEMENTS, [15, 1]) is None


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
    assert (statements_at(ONCE, [line]) is None) == once


def test_what_no_cell_runs_may_run_at_an_import():
    ran = {"one": {"a.py": [1, 2], "b.py": [7]}, "two": {"a.py": [2, 3]}}
    assert that_may_run(ran, "a.py", {1}) == {"one"}
    assert that_may_run(ran, "a.py", {2, 9}) == {"one", "two"}
    assert that_may_run(ran, "b.py", None) == {"one", "two"}
    assert that_may_run(ran, "b.py", {8}) == {"one", "two"}


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
    with Bench(package, frozen, tmp_path / "bench", "isomortar.harness.mutants.reach") as bench:
        for cell, expected in ((first, {1, 2, 3, 4}), (second, {1, 2, 6}), (first, {1, 2, 3, 4})):
            measurement, lines = without_lines(bench.measure(tmp_path / "sound", cell, 60.0))
            assert measurement.numbers == {"zero": 0.0}
            assert set(lines["geometry/quadrature.py"]) == expected
