"""What a trade takes of a run: the numbers of its load steps, and fields at cells of its slave faces by SciPy's functions."""

from __future__ import annotations

import itertools
import tempfile
from pathlib import Path
from unittest.mock import patch

import numpy as np
from rational_functions import shares

from isomortar.accuracy.sampling import slave_grid
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve import timing
from isomortar.trade import run as trades

#: Half of a bowl that is pressed onto a plane and dragged along it; a wall that it does not reach.
SCENE = """
format = 1
symmetry = { y = 0.0 }
[bodies.bowl]
geometry = { kind = "bowl", half_width = 0.5, bottom = 0, rise = 0.1, top = 0.5 }
mesh = { order = [2, 2, 1], elements = [4, 4, 1] }
[contacts]
wall = { slave = "bowl.u1", plane = { point = [2, 0, 0], normal = [-1, 0, 0] }, friction = 0 }
floor = { slave = "bowl.w0", plane = { point = [0, 0, 0] }, friction = 0.3 }
[supports]
side = { edge = "bowl.u0.w1", components = ["y"] }
top.face = "bowl.w1"
[[stages]]
name = "press"
steps = 2
motions.top.translate = [0, 0, -0.05]
[[stages]]
name = "drag"
steps = 1
motions.top.translate = [0.02, 0, 0]
"""
TIMES = np.array([0.5, 1.0, 2.0])


@case(
    claim="A trade takes of a run the forces, moments and ways of its load steps, its counts, and, on cells of slave faces, pressures, "
    "frictions, the area that is pressed, of the whole, and the largest penetration.",
    tier="gate",
    bounds={
        "curves": Bound(at_most=0.0, reason="definition: the numbers of the load steps; every stage has length one"),
        "fields": Bound(at_most=1e-12, reason="round-off: sums of products of polynomials of order two"),
        "areas": Bound(at_most=1e-12, reason="round-off: of sums of areas of cells; what is pressed grows"),
        "gap": Bound(at_most=1e-12, reason="round-off: depth below the plane, over the body's size"),
        "counts": Bound(0.0, 0.0, "definition: counts that are not those of the load steps"),
        "pressed": Bound(at_least=0.1, reason="definition: a tenth of the face, or nothing is compared"),
    },
)
def measured() -> dict[str, float]:
    """Largest differences, fields and areas relative to the largest."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scene.toml"
        path.write_text(SCENE, encoding="utf-8")
        with patch.object(timing, "process_time", itertools.count().__next__):
            run = trades.traded.function(str(path))
    scene = Scene.from_toml(SCENE)
    problem = scene.problem()
    with patch.object(timing, "process_time", itertools.count().__next__):
        steps = list(Simulation(problem).run())
    told = {name: [[getattr(s.reactions[n], name) for s in steps] for n in range(len(problem.supports))] for name in ("force", "moment")}
    told["displacement"] = [[s.reactions[n].displacement for s in steps] for n in range(len(problem.supports))]
    grids = [slave_grid(scene, problem, number) for number in range(2)]
    fields, areas = [], []
    for number, (contact, grid) in enumerate(zip(problem.contacts, grids, strict=True)):
        body = problem.body("bowl").patch
        face = body.face_points(contact.slave.face)
        at = shares(body.face_directions(contact.slave.face), body.weights[face], _places(grid.places))
        pressures = [at @ s.state.contacts[number].pressure for s in steps]
        fields.append((pressures[-1], at @ steps[-1].contacts[number].traction_norm, at @ steps[-1].state.positions[face][:, 2]))
        areas.append([2.0 * grid.weights[p > 0.0].sum() for p in pressures])
    pressure, traction = (np.concatenate([field[k] for field in fields]) for k in (0, 1))
    depth = -float(fields[1][2].min()) / float(np.ptp(problem.body("bowl").patch.control_points, axis=0).max())
    counts = {
        "counts": [len(grid.weights) for grid in grids],
        "images": 2,
        "unknowns": steps[-1].state.positions.size,
        "solves": sum(s.counters["solves"] for s in steps),
        "cuts": sum(s.cuts for s in steps),
        "phases": [sum(s.timings[name] for s in steps) for name in timing.PHASES],
    }
    return {
        "curves": float(np.max([np.abs(run["time"] - TIMES).max(), *(np.abs(np.array(run[name]) - told[name]).max() for name in told)])),
        "fields": float(np.max([np.abs(run[name] - of).max() / of.max() for name, of in (("pressure", pressure), ("traction", traction))])),
        "areas": float(
            np.maximum(np.abs(run["area"] - np.array(areas)).max(), np.abs(run["cells"] - np.concatenate([g.weights for g in grids])).max())
        ),
        "gap": float(np.abs(np.array(run["gap"]) - [0.0, np.maximum(depth, 0.0)]).max()),
        "counts": float(sum(run[name] != count for name, count in counts.items())),
        "pressed": float(areas[1][-1] / 2.0 / grids[1].weights.sum()),
    }


def _places(places: tuple[np.ndarray, ...]) -> np.ndarray:
    """Cell centres of a face, the first direction running fastest, shape (cells, 2)."""
    return np.stack(np.meshgrid(*places), axis=-1).reshape(-1, 2)
