"""Verdicts on what a study states, and on the tangent's parts."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from judge.ways import BOUNDS, WAYS, told

from isomortar.harness import case
from isomortar.harness.statement import Judgement, NotMeasuredError, Statement, StatementState, Values, Verdict
from isomortar.harness.tangents import BOUND, LOADS, LOADS_BOUND, PARTS, SYMMETRY_BOUND, PartError, TangentReport, _part_error

NAN, INF = np.nan, np.inf


@dataclass(frozen=True)
class Runs:
    """By one method: the values that they come to (None: a run is missing), and what they had to do without."""

    values: Values | None
    without: str = ""
    method: str = "ours"


def measure(runs: Runs) -> Values:
    """The values, where there are any."""
    if runs.values is None:
        raise NotMeasuredError("a run has not come to its end")
    return runs.values


#: Limits, values and the verdict.
TABLE = (
    *((-1.0, 2.0, values, "holds") for values in ({"a": -1.0}, {"a": 2.0}, {"a": -1.0, "b": 2.0})),
    *((-1.0, 2.0, values, "does not hold") for values in ({"a": -1.1}, {"a": 2.1}, {"a": 0.0, "b": 2.1}, {"a": -1.1, "b": 0.0})),
    *((None, 2.0, {"a": value}, state) for value, state in ((-1e9, "holds"), (2.1, "does not hold"))),
    *((-1.0, None, {"a": value}, state) for value, state in ((1e9, "holds"), (-1.1, "does not hold"))),
    *((-1.0, 2.0, values, "not measured") for values in (None, {}, {"a": NAN}, {"a": INF}, {"a": 0.0, "b": NAN}, {"a": 5.0, "b": -INF})),
)  # fmt: skip


@case(
    claim="A statement holds where all of its values are within its limits, by all methods; one that is not finite or missing was not "
    "measured, and what was measured in part holds in part.",
    tier="gate",
    grid={"way": WAYS},
    bounds=BOUNDS,
)
def statements(way: str) -> dict[str, float]:
    """How many verdicts are wrong."""
    wrong = []
    for low, high, values, state in TABLE:
        stated = Statement("1", "It holds.", (), measure, "1", "so", high, low)
        for without in ("", "some runs"):
            expected = "partly measured" if without and state == "holds" else state
            found = stated.judged([Runs(values, without)])
            wrong += [f"{low} {values} {high} {without}: {found.state}"] * ((found.state, found.verdicts[0].state) != (expected, expected))
    states: tuple[StatementState, ...] = ("holds", "partly measured", "not measured", "does not hold")
    for count in (1, 2, 3):
        for of in product(states, repeat=count):
            expected = "does not hold" if "does not hold" in of else of[0] if len(set(of)) == 1 else "partly measured"
            judged = Judgement(Statement("1", "It holds.", (), measure, "1", "so"), tuple(Verdict("ours", state, {}) for state in of)).state
            wrong += [f"{of}: {judged}"] * (judged != expected)
    wrong += ["by none"] * (Judgement(Statement("1", "It holds.", (), measure, "1", "so"), ()).state != "not measured")
    return told(wrong, way)


@case(
    claim="A part of the tangent passes where its worst product is within its bound; a tangent where it has parts, all of them pass, and "
    "no contact was open at all states.",
    tier="gate",
    grid={"way": WAYS},
    bounds=BOUNDS,
)
def tangents(way: str) -> dict[str, float]:
    """How many verdicts are wrong."""
    wrong, random = [], np.random.default_rng(2)
    bounds = dict.fromkeys(PARTS | LOADS, BOUND) | {"symmetry": SYMMETRY_BOUND, "loads": LOADS_BOUND}
    for part, bound in bounds.items():
        twins = [random.normal(size=30) for _ in range(20)]
        for share, passes in ((0.5, True), (3.0, False), (-3.0, False), (NAN, False), (INF, False)):
            for worst in (0, 7, 19):
                samples = [(part, twin * (1.0 + (share * bound if k == worst else 0.0)), twin) for k, twin in enumerate(twins)]
                found = _part_error(part, [*samples, ("solid" if part != "solid" else "whole", twins[0], 2.0 * twins[0])])
                wrong += [f"{part}, {share}: {found}"] * (found is None or found.passes != passes or found.samples != 20)
    faint = [("solid", twin, twin) for twin in (np.array([1.0, 0.0]), np.array([1e-9, 0.0]))]
    for off, passes in ((0.5, True), (2.0, False)):
        found = _part_error("solid", [*faint, ("solid", np.array([0.0, off * 1e-3 * BOUND]), np.zeros(2))])
        wrong += [f"faint {off}: {found}"] * (found is None or found.passes != passes)
    wrong += ["nothing"] * (_part_error("solid", [("solid", np.zeros(2), np.zeros(2))]) is not None)
    wrong += ["of nothing"] * (getattr(_part_error("solid", [("solid", np.ones(2), np.zeros(2))]), "passes", True))
    good, bad = (PartError("solid", "forces", 1, error, BOUND) for error in (0.5 * BOUND, 2.0 * BOUND))
    for rows, idle, passes in (((good,), (), True), ((good, bad), (), False), ((), (), False), ((good,), ("floor",), False)):
        wrong += [f"{rows}, {idle}"] * (TangentReport("scene", 1, (), (), (), idle, rows).passes != passes)
    return told(wrong, way)
