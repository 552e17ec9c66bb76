"""What is said of contact that is narrower than its slave can carry by constraints that are not those on averages."""

from __future__ import annotations

import re

import numpy as np
from told.narrow import BALL, QUARTER, depth, run, truth

from isomortar.harness import Bound, case
from isomortar.scene import Scene
from isomortar.told.during import narrow


@case(
    claim="Contact of a ball that is too narrow for its slave is told with every way of enforcing it: of dual constraints and of those at "
    "points forces are too large; of a slave with twice as many elements nothing is said.",
    tier="gate",
    grid={"enforcement": ("dual", "kts", "knots")},
    bounds={
        "said": Bound(1.0, 1.0, "definition: sentences of the coarse slave"),
        "too large": Bound(at_least=0.2, reason="definition: share of the force: or there is nothing to tell of"),
        "others": Bound(0.0, 0.0, "definition: sentences of the finer slave"),
        "left": Bound(at_most=0.1, reason="definition: what the force of the finer slave is off by"),
    },
)
def by_enforcement(enforcement: str) -> dict[str, float]:
    """What is said of both, the finer one a quarter, and how far they are off constraints on averages of as fine a slave."""
    method = ("solver.method='uzawa'",) if enforcement == "kts" else ()
    (said, force), (others, finer) = (
        run(text, (depth(0.025), f"bodies.a.mesh.elements={mesh}", f"contacts.c.enforcement='{enforcement}'", *method))
        for text, mesh in ((BALL, "[8, 8, 4]"), (QUARTER, "[16, 16, 6]"))
    )
    true = truth(0.025)
    return {
        "said": float(len(said)),
        "too large": force / true - 1.0,
        "others": float(len(others)),
        "left": abs(finer / true - 1.0),
    }


#: Balls by constraints that are not those of `mortar`: elements, depths, and where the ball is.
OTHERWISE = tuple((elements, way, at) for elements in (6, 8) for way in (0.015, 0.03) for at in ((0.05, 0.03), (0.125, 0.125)))


@case(
    claim="What is told of forces of narrow contact by dual constraints, and by constraints at points, is what they are off by on the "
    "whole, and at the worst.",
    tier=lambda enforcement: "nightly" if enforcement == "kts" else "gate",
    grid={"enforcement": ("dual", "kts", "knots", "greville")},
    bounds={
        "said": Bound(at_least=4.0, reason="definition: scenes of eight of which something is said, or there is nothing to compare"),
        "worst": Bound(at_most=1.0, reason="definition: the largest error over the worst that is told"),
        "mean": Bound(at_least=0.5, at_most=2.0, reason="definition: what is told over the mean error, an estimate by its order of size"),
    },
)
def told_otherwise(enforcement: str) -> dict[str, float]:
    """Of balls on blocks that are told of, against a quarter of 16 x 16 elements."""
    told, off = [], []
    for elements, way, at in OTHERWISE:
        method = ("solver.method='uzawa'",) if enforcement == "kts" else ()
        mesh = (f"bodies.a.mesh.elements=[{elements}, {elements}, 4]", f"contacts.c.enforcement='{enforcement}'")
        said, force = run(BALL.replace("[0.05, 0.03]", str(list(at))), (depth(way), *mesh, *method))
        for words in said:
            shares = [0.01 * float(share) for share in re.findall(r"\d+", words["share"])] or [0.33]
            told.append((shares[0], shares[-1]))
            off.append(abs(force / truth(way) - 1.0))
    about, worst = np.array(told or [(np.nan, np.nan)]).T
    return {"said": float(len(off)), "worst": float(np.max(off / worst)), "mean": float(np.mean(about) / np.mean(off))}


#: A bowl on a plane, of which what is beyond a plane may be left out.
PARTS = """
format = 1
PLANES
solver.method = "uzawa"
bodies.bowl = { geometry = { kind = "bowl", half_width = 0.5, bottom = 0, rise = 0.1, top = 0.5 }, mesh = { order = 2, elements = 4 } }
contacts.c = { slave = "bowl.w0", plane = {}, friction = 0, enforcement = "KIND" }
supports.top.face = "bowl.w1"
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.01] }]
"""
#: Rows below which a contact is too narrow, where elements have two rows along one coordinate and six along the other.
LEAST = {"mortar": (1.3, 1.3), "knots": (1.3, 1.3), "dual": (2.02, 2.02), "kts": (1.3, 3.0)}


@case(
    claim="By dual functions and at Gauss points more rows are too few than by others, but for parts of a body beside a mirror.",
    tier="gate",
    grid={"enforcement": tuple(LEAST)},
    bounds={"wrong": Bound(0.0, 0.0, "definition: of the whole, a half and a quarter those with other numbers of rows")},
)
def too_few(enforcement: str) -> dict[str, float]:
    """How many."""
    wrong = 0
    for planes in ("", "symmetry = { x = 0 }", "symmetry = { x = 0, y = 0 }"):
        problem = Scene.from_toml(PARTS.replace("KIND", enforcement).replace("PLANES", planes)).problem()
        least = narrow._least(problem, problem.contacts[0], np.array([2.0, 6.0]))
        wrong += least.tolist() != list(LEAST["mortar" if planes else enforcement])
    return {"wrong": float(wrong)}
