"""Shallow ironing: a tool with a round underside is pressed into a softer base and slides along it (Fischer and Wriggers 2006)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from published.benchmark import Benchmark, Beside, Drawing, Quantity, among, points, ratios, reaction

from isomortar.harness import Bound, Shown, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.program.declaration import LoadStep
from isomortar.scene import Scene

#: One element of unit thickness across; the underside is an exact arc of radius 0.75, 0.2 above the base.
_SCENE = """
format = 1
name = "shallow-ironing"
materials.tool = { young = 6896.0, poisson = 0.32 }
materials.base = { young = 689.6, poisson = 0.32 }
bodies.tool.material = "tool"
bodies.base.material = "base"
bodies.base.geometry = { kind = "box", lower = [0, 0, -4], upper = [12, 1, 0] }
contacts.sliding = { slave = "tool.w0", master = "base.w1", friction = 0.3 }
stages = [
    { name = "press", steps = 20, motions.top.translate = [0, 0, -1] },
    { name = "slide", steps = 100, motions.top.translate = [10, 0, 0] },
]

[bodies.tool.patch]
order = [2, 1, 1]
knots = [[0, 0, 0, 1, 1, 1], [0, 0, 1, 1], [0, 0, 1, 1]]
control_points = [
    [0.2, 0, 0.5], [0.8, 0, -0.3], [1.4, 0, 0.5], [0.2, 1, 0.5], [0.8, 1, -0.3], [1.4, 1, 0.5],
    [0.2, 0, 1.4], [0.8, 0, 1.4], [1.4, 0, 1.4], [0.2, 1, 1.4], [0.8, 1, 1.4], [1.4, 1, 1.4],
]
weights = [1, 0.6, 1, 1, 0.6, 1, 1, 1, 1, 1, 1, 1]

[supports]
top.face = "tool.w1"
bottom.face = "base.w0"
tool-front = { face = "tool.v0", components = ["y"] }
tool-back = { face = "tool.v1", components = ["y"] }
base-front = { face = "base.v0", components = ["y"] }
base-back = { face = "base.v1", components = ["y"] }
"""
#: Elements of the tool and of the base, along and in depth.
Elements = tuple[tuple[int, int], tuple[int, int]]
MESHES: dict[str, Elements] = {"coarse": ((8, 6), (60, 8)), "fine": ((12, 8), (90, 10))}
#: Kinds of elements, each on the two meshes; linear ones are half as long, as quadratic ones have a node in the middle.
KINDS = ("N2", "N3", "N4", "L1", "L2")
#: Where both stages end, in load steps.
PRESSED, ENDED = 20, 120


def scene(kind: str, elements: Elements, changes: Sequence[str] = ()) -> Scene:
    """The scene by a kind of elements. Lagrange elements are a master with kinks, along averaged normals."""
    order, parts = int(kind[1:]), 2 if kind == "L1" else 1
    changes = [*changes, *(['contacts.sliding.projection="averaged"'] if kind[0] == "L" else [])]
    for body, (along, up) in zip(("tool", "base"), elements, strict=True):
        changes += [f'bodies.{body}.mesh={{family="{kind[0]}",order=[{order},1,{order}],elements=[{parts * along},1,{parts * up}]}}']
    return Scene.from_toml(_SCENE, overrides=changes)


@case(
    claim="A tool that slides along a softer base takes a force within the range of what is published, and the base bears the same.",
    tier="nightly",
    grid={"mesh": tuple(f"{kind} {name}" for kind in KINDS for name in MESHES)},
    bounds={
        "unbalanced": Bound(at_most=1e-6, reason="theory: equilibrium of both bodies, to the tolerance of Newton's method times ten"),
        "ratio at 1.5": Bound(at_least=0.3, at_most=0.53, reason="reference: the range of what is published; and friction alone makes 0.3"),
        "time": Shown("load time, a stage each unit"),
        "horizontal": Shown("force on the tool's top along the drag, N"),
        "vertical": Shown("force on the tool's top downwards, N"),
        "horizontal at 1": Shown("the same after pressing, N"),
        "vertical at 1": Shown("the same after pressing, N"),
        "horizontal at 1.5": Shown("the same after half of the way, N"),
        "vertical at 1.5": Shown("the same after half of the way, N"),
    },
)
def shallow_ironing(mesh: str) -> dict[str, Any]:
    """Press and slide."""
    kind, size = mesh.split()
    problem = scene(kind, MESHES[size]).problem()
    steps = list(Simulation(problem).run())
    forces = np.array([[reaction.force for reaction in step.reactions] for step in steps])
    top = [support.name for support in problem.supports].index("top")
    horizontal, vertical = forces[:, top, 0], -forces[:, top, 2]
    time = np.concatenate([np.arange(1, PRESSED + 1) / PRESSED, 1.0 + np.arange(1, ENDED - PRESSED + 1) / (ENDED - PRESSED)])
    middle = PRESSED + (ENDED - PRESSED) // 2 - 1
    return {
        "unbalanced": float(np.abs(forces.sum(axis=1)).max() / vertical.max()),
        "ratio at 1.5": float(horizontal[middle] / vertical[middle]),
        "time": time,
        "horizontal": horizontal,
        "vertical": vertical,
        "horizontal at 1": float(horizontal[PRESSED - 1]),
        "vertical at 1": float(vertical[PRESSED - 1]),
        "horizontal at 1.5": float(horizontal[middle]),
        "vertical at 1.5": float(vertical[middle]),
    }


#: Elements beside other programs, the law that all of them have, and half of the way.
_COARSER, _HALF = ((4, 3), (30, 4)), (ENDED - PRESSED) // 2
_BESIDE = (
    *(f'materials.{body}.law="neo-hookean-j"' for body in ("tool", "base")),
    *(f"stages.slide.{change}" for change in (f"steps={_HALF}", "motions.top.translate=[5,0,0]")),
)


def by_others(problem: Problem, steps: Sequence[LoadStep]) -> dict[str, float]:
    """Forces after pressing, and after half of the way."""
    found: dict[str, float] = {}
    for name, number in (("1", PRESSED - 1), ("1.5", PRESSED + _HALF - 1)):
        horizontal, _, vertical = reaction(problem, steps[number], "top")
        found |= {f"horizontal at {name}": float(horizontal), f"vertical at {name}": -float(vertical)}
    return found | {"ratio at 1.5": found["horizontal at 1.5"] / found["vertical at 1.5"]}


_CURVES = {name: points("shallow_ironing", name) for name in ("horizontal", "vertical")}
_OPEN = (
    "Papers differ in how bodies are pressed on where the arc ends: the corner of the tool digs into the base, and pressures there have no "
    "limit. The law is taken as the neo-Hookean one of the other scenes, in plane strain, and steps as 20 and 100 equal ones."
)


def _at(direction: str, time: float) -> Quantity:
    return Quantity(f"{direction} at {time:g}", f"{direction} force at t = {time:g}", "N/mm", among(_CURVES[direction], time))


BENCHMARKS = (
    Benchmark(
        "shallow_ironing",
        "Shallow ironing",
        "A block with an arc of radius 0.75 below, ten times stiffer than its base, is pressed 1 mm down (t = 1) and slides 10 mm (t = 2) "
        "with friction 0.3, in plane strain.",
        _OPEN,
        ("N3 fine", "N4 coarse"),
        (
            Quantity(
                "ratio at 1.5",
                "horizontal over vertical force at t = 1.5",
                "",
                ratios(among(_CURVES["horizontal"], 1.5), among(_CURVES["vertical"], 1.5)),
                "published values scatter by a factor of nearly two",
            ),
            *(_at(direction, time) for time in (1.0, 1.5) for direction in _CURVES),
        ),
        tuple(Drawing("time", name, "t", f"{name} force, N/mm", curve) for name, curve in _CURVES.items()),
        Beside(
            "Half of the way on half of the coarse elements along each direction, with the law neo-hookean-j, which CalculiX has. "
            "Elements are linear, so that bodies have kinks.",
            lambda kind: scene(kind, _COARSER, _BESIDE).problem(),
            by_others,
            {
                "ratio at 1.5": Bound(at_least=0.3, at_most=0.53, reason="reference: the range of what is published"),
                **{f"{name} at {time}": Shown("N") for time in ("1", "1.5") for name in ("horizontal", "vertical")},
            },
            ("L1",),
            {
                "L1 GetFEM": "stops in load step 15 of 70: Newton's method does not converge, after more than 100 iterations",
                "L1 CalculiX": "stops in load step 6 of 70: too many cutbacks",
            },
        ),
    ),
)
