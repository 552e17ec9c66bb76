"""What is exact or can be counted of every method: patch tests, constraints too many and too few, stability, condition."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from enforcement.collocated import collocated_press
from enforcement.contact import MESHES, METHODS, constraints, enforcement_of, patch_test
from enforcement.mixed import work
from enforcement.passes import PASSES, constraints_of_passes, patch_test_of_passes
from enforcement.patches import AVERAGED_ORDERS, CURVED_ORDERS, PROJECTIONS, ROWS, averaged_patch_test, curved_patch_test
from enforcement.spline import spline_scenes
from enforcement.two_rules import mixed_rule
from patch_tests.contact import ORDERS

from isomortar import model
from isomortar._frozen import frozen
from isomortar.harness.cases import Cell
from isomortar.harness.runner import Result
from isomortar.harness.runs import Computed

#: Of the constraints; they are those of the mortar method in cells too.
COUNTS = ("too many", "too few", "inf-sup", "condition")

#: Patch tests on curved faces by projection, and all of them: flat by closest points, flat along averaged normals, curved.
CURVED = {"closest": "curved", "averaged": "curved, averaged"}
TESTS = (*MESHES, "averaged", *CURVED.values())


@frozen
class Refused:
    """What is no option, and the cells whose numbers say why: by form, those of one order."""

    form: str
    why: str
    cells: tuple[Cell, ...]
    number: str


#: Order of what is refused; two numbers of each: of what there is instead, then its own.
REFUSED_ORDER = 2
REFUSED = (
    Refused(
        "control gaps by the consistent mass matrix, closed by control pressures",
        "pressures do work on open gaps: its share of force times depth, of a paraboloid on a cube; take dual, whose multipliers do not",
        tuple(Cell(work, {"form": form, "order": REFUSED_ORDER}) for form in ("dual", "mixed")),
        "work",
    ),
    Refused(
        "mixed rule: the master's forces by the master's quadrature points",
        "forces on both bodies are not opposite: their sum over one of them; take subcells, which keep the balance and pass the patch test",
        tuple(Cell(mixed_rule, {"points": points, "order": REFUSED_ORDER}) for points in ("slave", "master")),
        "forces",
    ),
    Refused(
        "collocated contact surface: stresses of the bulk in place of virtual work",
        "forces on both bodies are not opposite: their sum over one of them; take subcells, which pass the patch test as well",
        tuple(Cell(collocated_press, {"form": form, "order": REFUSED_ORDER}) for form in ("mortar", "one field")),
        "forces",
    ),
    Refused(
        "spline surface: closest points on sums of the nodes of linear elements",
        "forces stay those of linear elements: pressing force of the block, off that on order 3; take order 2 on as many elements",
        tuple(Cell(spline_scenes, {"surface": surface, "scene": "block"}) for surface in ("order 2", "spline")),
        "force",
    ),
    Refused(
        "two passes: each face is slave once",
        "constraints are too many, by all pressures that both faces hold, of meshes that match; with multipliers as unknowns the system is "
        "singular, and by augmentations each pass bears half; take averaged normals, or cells",
        tuple(Cell(constraints_of_passes, {"passes": passes, "order": REFUSED_ORDER, "meshes": "matching"}) for passes in PASSES),
        "too many",
    ),
)


def cells() -> Iterator[Cell]:
    """Those of the patch test, of the constraints, and of what is refused."""
    for case in (patch_test, averaged_patch_test, curved_patch_test, patch_test_of_passes):
        yield from case.cells
    for entry in REFUSED:
        yield from entry.cells
    yield from constraints.cells


@frozen
class Exact(Computed):
    """A cell of `isomortar verify`."""

    @property
    def name(self) -> str:
        """The cell's."""
        return self.result.cell.name

    @property
    def method(self) -> str:
        """What constrains, or is refused."""
        return str(next(iter(self.result.cell.settings.values())))

    @property
    def ending(self) -> str:
        """``measured`` only where all that is claimed holds."""
        ending = self.result.measurement.ending
        return "out of bounds" if ending == "measured" and self.result.state != "passed" else ending

    @property
    def cpu_seconds(self) -> float:
        """Of the cell; it does not say itself."""
        return self.result.measurement.cpu_seconds


def table(results: Sequence[Result]) -> list[dict[str, Any]]:
    """By method and order: errors of the pressure of all patch tests, and what is counted; NaN: not measured."""
    by_name = {result.cell.name: Exact(result) for result in results}
    return [_row(by_name, method, order) for method in ROWS for order in ORDERS]


def refused(results: Sequence[Result]) -> list[dict[str, Any]]:
    """What is no option, why, and the numbers of what there is instead and its own; NaN: not measured."""
    by_name = {result.cell.name: Exact(result) for result in results}
    rows = []
    for entry in REFUSED:
        instead, own = (by_name[cell.name].number(entry.number) for cell in entry.cells)
        rows.append({"form": entry.form, "why": entry.why, "instead": instead, "own": own})
    return rows


def sizes() -> list[dict[str, Any]]:
    """Lines that are not blank of every file of `isomortar.model.enforcement`: what each method adds, and what all share."""
    folder = Path(model.__file__).parent / "enforcement"
    files = {path.stem: path.read_text(encoding="utf-8").splitlines() for path in sorted(folder.glob("*.py"))}
    return [
        {"file": f"{name}.py", "method": name in METHODS, "lines": sum(map(bool, map(str.strip, text)))} for name, text in files.items()
    ]


def _row(by_name: dict[str, Exact], method: str, order: int) -> dict[str, Any]:
    tested = {meshes: by_name[Cell(patch_test, {"method": method, "order": order, "meshes": meshes}).name] for meshes in MESHES}
    counted = by_name[Cell(constraints, {"method": enforcement_of(method), "order": order}).name]
    if order in AVERAGED_ORDERS:
        tested["averaged"] = by_name[Cell(averaged_patch_test, {"method": method, "order": order}).name]
    for projection in PROJECTIONS if order in CURVED_ORDERS else ():
        settings = {"method": method, "projection": projection, "order": order}
        tested[CURVED[projection]] = by_name[Cell(curved_patch_test, settings).name]
    errors = dict.fromkeys(TESTS, np.nan) | {name: cell.number("pressure") for name, cell in tested.items()}
    return {"method": method, "order": order, **errors, **{name: counted.number(name) for name in COUNTS}}
