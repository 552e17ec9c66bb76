"""How much work it takes to find feet: elements searched, and places where the master is evaluated, on masters of all classes."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from projection.averaged_on_splines import INNER, block_over_splines
from projection.closest_points import Surface
from projection.from_a_pole import cone, unequal
from projection.in_extended_precision import FACES, targets_of
from projection.poles import face as dome_face
from projection.poles import turned

from isomortar import _bindings
from isomortar._arguments import LongArray
from isomortar._bindings import Projections
from isomortar._codes import WORK
from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, Matches, case
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.record import ContactState
from isomortar.solve.timing import Ledger

#: Targets beside each master; how far warm starts are from where they end, as a share of the face; and by how much work may differ.
TARGETS, NEAR, SHARE = 300, 1e-3, 5e-3
#: Distance of targets from a pole, over the size of its surface.
FAR = 1e8
MASTERS: dict[str, Callable[[], Surface]] = {**FACES, "unequal cone": lambda: cone(2, unequal(2), np.array([0.0, 0.0, -2.0]))}
_SAME = "reference: the same searches take the same work but for round-off, which leads one in hundreds another way; less is to be blessed"


def _matches(reference: str, *starts: str) -> dict[str, Matches]:
    return {f"{start}: {work}": Matches(reference, _SAME, allowance=SHARE) for start in starts for work in WORK}


def _named(start: str, counts: LongArray) -> dict[str, float]:
    return {f"{start}: {work}": float(count) for work, count in zip(WORK, counts, strict=True)}


@case(
    claim="Feet are found with as much work as they were, to half a per cent: from no start, from any, from where they almost are, "
    "and from an end of the face, which may be a pole.",
    tier="gate",
    grid={"master": list(MASTERS)},
    bounds=_matches("searches", "none", "any", "near", "end"),
)
def searches(master: str) -> dict[str, float]:
    """Work of four searches for the feet of the same targets, those that have one."""
    face, random = MASTERS[master](), np.random.default_rng(4)
    targets, (low, high) = targets_of(face, TARGETS), face.ends
    feet, numbers = _searched(face, targets, None, "none")
    targets, there = targets[feet.found == 1], feet.xi[feet.found == 1]  # from a start, what is deeper than the body is refused as a whole
    anywhere, other = random.uniform(low, high, (2, len(targets), 2))
    starts = {"any": anywhere, "near": np.clip(there + NEAR * (other - low), low, high), "end": np.where([0, 1], high, anywhere)}
    for start, xi in starts.items():
        numbers |= _searched(face, targets, xi, start)[1]
    return numbers


def _searched(face: Surface, targets: FloatArray, start: FloatArray | None, name: str) -> tuple[Projections, dict[str, float]]:
    counts = np.zeros(len(WORK), dtype=np.int64)
    return face.project(targets, start, counts), _named(name, counts)


@case(
    claim="Feet beside a pole, of targets so far off that coordinates are known to round-off of the distance alone, take the same work at "
    "whichever end of whichever direction the pole is.",
    tier="gate",
    bounds={
        "work": Bound(at_most=0.02, reason="round-off: other coordinates, which lead one in hundreds another way"),
        "missing": Bound(0.0, 0.0, "definition: round the pole there is no edge"),
    },
)
def at_any_end() -> dict[str, float]:
    """Most evaluations over the fewest, less one, of the four ends; targets without a foot."""
    random, n = np.random.default_rng(5), TARGETS // 2
    angle, off = random.uniform(0.0, 2 * np.pi, n), 10.0 ** random.uniform(-11.0, -0.5, n)
    normals = np.column_stack([np.sin(off) * np.cos(angle), np.sin(off) * np.sin(angle), np.cos(off)])
    targets, work, missing = FAR * random.uniform(0.5, 1.0, (n, 1)) * normals, [], 0
    for way in ("high first", "low first", "high second", "low second"):
        feet, counts = _searched(turned(dome_face("N2"), way), targets, None, "none")
        work.append(counts["none: evaluations to order 2"])
        missing += int(np.count_nonzero(feet.found == 0))
    return {"work": max(work) / min(work) - 1.0, "missing": float(missing)}


@case(
    claim="Along averaged normals feet, and ways between them, are found with as much work as they were, to half a per cent.",
    tier="gate",
    grid={"order": [2, 3], "knots": list(INNER)},
    bounds=_matches("averaged_searches", "feet", "ways"),
)
def along_averaged_normals(order: int, knots: str) -> dict[str, float]:
    """Work of a search for all feet from random starts, and of the ways to them from there."""
    problem, ledger = block_over_splines(order, knots), Ledger()
    equilibrium = Equilibrium(problem, ledger)
    (pair,), positions = equilibrium.pairs, equilibrium.numbering.reference
    n, points = len(pair.pair.slave.point), len(pair.pair.slave.area)
    before = np.random.default_rng(6).uniform(0.0, 1.0, (points, 2))
    start = ContactState(np.zeros(n), np.zeros((n, 2)), before, np.ones(points, dtype=np.int32))
    feet = pair.kinematics(positions, start).projections
    searched, ways = ledger.work.copy(), np.zeros(len(WORK), dtype=np.int64)
    _bindings.find_climbs(pair.pair.slave, pair.pair.master, positions, feet, ways)
    return _named("feet", searched) | _named("ways", ways)
