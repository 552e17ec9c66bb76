"""What commands say of themselves, and pages of verification and of blessing, come out as they did."""

from __future__ import annotations

import json
import sys
import tempfile
from collections.abc import Iterator
from contextlib import chdir
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np
import typer
from unchanged.trades import MADE
from unchanged.written import json_lines, page_lines

from isomortar.cli.commands import app
from isomortar.harness import Matches, Words, blessing, case, report
from isomortar.harness.collection import collect
from isomortar.harness.compare import Expected, judge
from isomortar.harness.history import Entry
from isomortar.harness.measurement import measure
from isomortar.harness.runner import Result

_SAME = "round-off: the same numbers of the same program; words, and counts, are to be the same"
#: What is told of an option of a command, and what of it that can be asked for.
_TOLD = ("opts", "secondary_opts", "default", "required", "multiple", "is_flag", "min", "max", "metavar", "show_default", "hidden", "help")
#: Cases of each kind of claim, which hold and do not; what is told of a failure is not where it was.
CASES = """
import numpy as np
from isomortar.harness import Bound, Convergence, Curve, Matches, Order, Shown, Words, case, skip

H = 0.5 ** np.arange(1, 6)
SMALL = Bound(at_most=1e-3, reason="round-off: small")

@case(claim="Sines are bounded.", bounds={"error": SMALL, "seen": Shown("theory: to see"), "said": Shown("theory: to read")},
      grid={"order": [1, 2], "family": ["N", "L"]})
def sines(order, family):
    return {"error": 1e-4 * order, "seen": np.sin(np.arange(order) / 3), "said": Words(f"order {order}")}

@case(claim="Errors fall.", bounds=lambda order: {"L2": Order(order + 1, "theory: interpolation"), "along": SMALL},
      grid={"order": [1, 2, 3]})
def falls(order):
    return {"L2": Convergence(H, H ** min(order + 1, 3), {"quadrature": 1e-14}), "along": Curve(H, 1e-4 * H, "size", "error", log_x=True)}

@case(claim="As before.", bounds={"value": Matches("kept", "reference: as it was", 1e-6), "words": Matches("kept", "reference: as it was")},
      grid={"kind": ["same", "other"]})
def before(kind):
    return {"value": [1.0, 2.0 if kind == "same" else 2.5], "words": Words(f"a line of 3.5\\n{kind}")}

@case(claim="It cannot be.", bounds={"error": SMALL}, grid={"way": ["skipped", "large", "odd", "broken"]})
def never(way):
    if way == "skipped":
        skip("there is no such thing")
    return {"error": {"large": 1.0, "odd": np.nan}[way]}
"""


@case(
    claim="Pages of verification, JUnit's file, their data and the page of a blessing hold what they held, of the same cells.",
    bounds={"pages": Matches("pages", _SAME, allowance=1e-6)},
)
def pages() -> dict[str, Words]:
    """Lines of all of them."""
    with tempfile.TemporaryDirectory() as name, chdir(name), mock.patch.object(report, "identity", return_value=MADE):
        family = Path("cases/of_a_page")
        family.mkdir(parents=True)
        (family / "all.py").write_text(CASES)
        try:
            results = [
                _result(number, cell) for number, cell in enumerate(cell for found in collect(Path("cases")) for cell in found.cells)
            ]
        finally:
            sys.path.remove(str(Path("cases").resolve()))
            del sys.modules["of_a_page.all"], sys.modules["of_a_page"]
        runs = [*(_entry(results, factor, "passed") for factor in (1.0, 1.0, 1.0, 3.0, 3.0, 3.0, 3.0)), _entry(results, 1.0)]
        context = report.Context("gate", "family of_a_page", 754.0, datetime(2026, 1, 2, 3, 4, tzinfo=UTC), runs)
        path = Path("report.html")
        report.write(path, results, context)
        said = [*page_lines(path.read_text()), *path.with_suffix(".xml").read_text().splitlines()]
        said += json_lines(json.loads(path.with_suffix(".json").read_text()))
        of_before = [result for result in results if result.cell.case.name.endswith("before")]
        found = blessing.changes(of_before, _kept)
        said += page_lines(blessing.picture(Path(), of_before[0].cell.case, found).read_text())
    return {"pages": Words("\n".join(said))}


def _kept(_: str, __: Any, number: str) -> Expected:
    """What the cases are compared with."""
    if number == "words":
        return Expected(np.zeros(1), np.asarray(1e-9), "self", "a line of 3.5\nsame")
    return Expected(np.array([1.0, 2.0]), np.asarray(1e-9), "other code")


def _result(number: int, cell: Any) -> Result:
    """A cell that was measured, in a time that is no machine's."""
    found = measure(cell)
    last = "".join(found.message.strip().splitlines()[-1:])
    found = replace(found, message=last, seconds=0.5 + number, cpu_seconds=0.25 + number, peak_memory=1e8 * (1 + number), host="here")
    return Result(cell, found, tuple(judge(cell, found, _kept)), number % 2 == 0)


def _entry(results: list[Result], factor: float, state: str = "") -> Entry:
    """A run whose numbers were others by a factor, and which ended in a state, or as it does."""
    cells = {
        result.cell.name: {
            "state": state or result.state,
            "seconds": result.measurement.seconds / factor,
            "values": {check.name: check.value / factor for check in result.checks},
        }
        for result in results
    }
    return Entry("2026-01-01T00:00:00+00:00", "0" * 12, cells)


@case(
    claim="Commands have the options, defaults and limits that they had, and say the same of them.",
    bounds={"options": Matches("options", _SAME)},
)
def options() -> dict[str, Words]:
    """A line each, of all commands."""
    return {"options": Words("\n".join(_options("isomortar", typer.main.get_command(app))))}


def _options(name: str, command: Any) -> Iterator[str]:
    yield f"{name}: {' '.join(str(command.help).split())}"
    for option in command.params:
        kind = option.type_descriptor.annotation
        told = {name: getattr(option, name, None) for name in _TOLD if option.name != "jobs" or name != "default"}  # a machine's cores
        yield f"{name} {getattr(kind, '__name__', kind)} {told}"
    for below, of in getattr(command, "commands", {}).items():
        yield from _options(f"{name} {below}", of)
