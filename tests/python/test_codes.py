"""Numbers that Fortran and Python share are the same in both."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from isomortar._arrays import FRICTION_LAWS, LAWS
from isomortar._bindings.statuses import raise_status
from isomortar._codes import ROW_KINDS, FirstRow, PointState, Status
from isomortar.errors import FoldedElementError, KernelError
from isomortar.solve.method import FAILURES

FORTRAN = Path(__file__).parents[2] / "fortran"


def parameters(file: str, prefix: str) -> dict[str, int]:
    """Named whole numbers of a source file that begin with a prefix, without it."""
    return {name: int(number) for name, number in re.findall(rf"\b{prefix}_(\w+) = (\d+)", (FORTRAN / file).read_text())}


@pytest.mark.parametrize(
    ("file", "prefix", "ours"),
    [
        ("base/status.f90", "status", {status.name.lower(): status.value for status in Status}),
        ("contact/friction/return_map.f90", "state", {state.name.lower(): state.value for state in PointState}),
        ("contact/rows.f90", "row", {row.name.lower(): row.value for row in FirstRow}),
        ("solid/material/table.f90", "law", {name.replace("-", "_"): number for name, number in LAWS.items()}),
        ("contact/friction/table.f90", "law", FRICTION_LAWS),
    ],
)
def test_names_and_numbers_of_fortran_are_those_of_python(file: str, prefix: str, ours: dict[str, int]) -> None:
    assert parameters(file, prefix) == ours


def test_kinds_of_rows_are_those_of_python() -> None:
    cases = re.findall(r"case (?:\((\d+)\) ! (.+)|default ! (\w+), (\d+))", (FORTRAN / "contact/rows.f90").read_text())
    assert {name or last: int(kinds or number) for kinds, name, last, number in cases} == ROW_KINDS
    assert ROW_KINDS["paper"] == FirstRow.SLIP_SUM + 1
    assert ROW_KINDS["local"] == FirstRow.SLIP_SUM - 1
    assert ROW_KINDS["frictionless"] == FirstRow.TRACTION_WORK - 1


@pytest.mark.parametrize("status", [s for s in Status if s is not Status.OK])
def test_what_positions_make_cuts_a_load_increment_and_all_else_ends_the_run(status: Status) -> None:
    """A shorter increment has other positions: it helps against these, and against nothing else."""
    of_positions = {Status.FOLDED, Status.FOLDED_INITIALLY, Status.DEGENERATE_SURFACE, Status.NOT_FINITE, Status.PASSED_THROUGH}
    with pytest.raises(KernelError) as raised:
        raise_status(status, 17)
    assert isinstance(raised.value, FAILURES) == (status in of_positions)
    assert isinstance(raised.value, FoldedElementError) == (status in {Status.FOLDED, Status.FOLDED_INITIALLY})
    assert raised.value.place == 17
    assert "17" in str(raised.value)
