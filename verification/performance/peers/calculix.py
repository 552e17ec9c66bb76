"""The block benchmark with CalculiX: its input deck, and what its output files say.

Contact is surface to surface with a penalty (linear pressure-overclosure), friction with an elastic stick slope. Its neo-Hookean solid is
A2/2 (J^(-2/3) tr C - 3) + A1/2 (J - 1)^2: another volumetric energy than (ln J)^2, the same to first order.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

#: Pressure per overclosure, and traction per slip while a point sticks; force per volume. The block is about 10 stiff and 0.5 high.
PRESSURE_SLOPE, STICK_SLOPE = 1e4, 1e3
_TOTAL_FORCE = re.compile(r"total force .* for set TOP and time\s+(\S+)\s+(\S+)\s+(\S+)\s+(\S+)")


def deck(problem: Mapping[str, Any]) -> str:
    """The input deck of a block problem, its load steps as increments of one step a stage.

    Parameters
    ----------
    problem : mapping
        As `performance.block.description` makes it; without stages a deck that is read and nothing else.
    """
    lines = ["*HEADING", "Sliding a block on a larger one"]
    first_node = first_element = 1
    for name, held, contact in (("slave", "TOP", "S1"), ("master", "BASE", "S2")):
        body = problem[name]
        points, bricks = _box(body["lower"], body["upper"], body["elements"])
        lines += [f"*NODE, NSET={name}", *(f"{first_node + k}, {x:.10g}, {y:.10g}, {z:.10g}" for k, (x, y, z) in enumerate(points))]
        lines += [f"*ELEMENT, TYPE=C3D8, ELSET={name}"]
        lines += [f"{first_element + k}, " + ", ".join(str(first_node + n) for n in brick) for k, brick in enumerate(bricks)]
        layer = body["elements"][0] * body["elements"][1]
        touching, level = (
            (range(layer), body["upper"][2]) if contact == "S1" else (range(len(bricks) - layer, len(bricks)), body["lower"][2])
        )
        lines += [f"*SURFACE, NAME=FACE_{name}", *(f"{first_element + k}, {contact}" for k in touching)]
        lines += [f"*NSET, NSET={held}", *(f"{first_node + k}," for k in np.flatnonzero(np.isclose(points[:, 2], level)))]
        lines += [f"*SOLID SECTION, ELSET={name}, MATERIAL=RUBBER"]
        first_node, first_element = first_node + len(points), first_element + len(bricks)
    lines += ["*MATERIAL, NAME=RUBBER", "*HYPERELASTIC, NEO HOOKE", f"{problem['shear'] / 2:.12g}, {2 / problem['bulk']:.12g}"]
    lines += ["*SURFACE INTERACTION, NAME=RUBBING", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{PRESSURE_SLOPE:g}"]
    lines += ["*FRICTION", f"{problem['friction']:g}, {STICK_SLOPE:g}"]
    lines += ["*CONTACT PAIR, INTERACTION=RUBBING, TYPE=SURFACE TO SURFACE", "FACE_slave, FACE_master"]
    return "\n".join([*lines, *_steps(problem["stages"], problem["tolerance"])]) + "\n"


def _box(lower: Sequence[float], upper: Sequence[float], elements: Sequence[int]) -> tuple[np.ndarray, list[list[int]]]:
    """Points and bricks of a box, the first direction running fastest; nodes of a brick as CalculiX counts them."""
    ticks = [np.linspace(a, b, n + 1) for a, b, n in zip(lower, upper, elements, strict=True)]
    points = np.stack(np.meshgrid(*ticks, indexing="ij"), axis=-1).transpose(2, 1, 0, 3).reshape(-1, 3)
    row, sheet = elements[0] + 1, (elements[0] + 1) * (elements[1] + 1)
    corners = np.array([0, 1, 1 + row, row, sheet, 1 + sheet, 1 + row + sheet, row + sheet])
    origins = [i + row * j + sheet * k for k in range(elements[2]) for j in range(elements[1]) for i in range(elements[0])]
    return points, [(origin + corners).tolist() for origin in origins]


def _steps(stages: Sequence[Mapping[str, Any]], tolerance: float) -> Iterator[str]:
    """A CalculiX step a stage; the top's displacement grows linearly in it. The tolerance bounds the residual over the average force."""
    place = np.zeros(3)
    for stage in stages:
        place = place + stage["translate"]
        share = 1 / stage["steps"]
        yield from ("*STEP, NLGEOM, INC=1000", "*STATIC, SOLVER=SPOOLES", f"{share:.10g}, 1.0, 1e-5, {share:.10g}")
        yield from ("*CONTROLS, PARAMETERS=FIELD", f"{tolerance:g}, 0.01")
        yield from ("*BOUNDARY", "BASE, 1, 3, 0.0", *(f"TOP, {k + 1}, {k + 1}, {value:.10g}" for k, value in enumerate(place)))
        yield from ("*NODE PRINT, NSET=TOP, TOTALS=ONLY", "RF", "*END STEP")


def forces(dat: str, stages: Sequence[Mapping[str, Any]]) -> list[list[float]]:
    """Total force on the top at the end of every load step, from the text of the .dat file; cut increments in between are left out."""
    found = {round(float(time), 6): [float(x) for x in force] for time, *force in _TOTAL_FORCE.findall(dat)}
    ends = [k + (i + 1) / stage["steps"] for k, stage in enumerate(stages) for i in range(stage["steps"])]
    return [found[round(end, 6)] for end in ends if round(end, 6) in found]


def linear_solves(cvg: str) -> int:
    """Iterations, a linear solve each, from the text of the .cvg file: those of increments that failed included."""
    return sum(1 for line in cvg.splitlines() if line.split() and line.split()[0].isdigit())
