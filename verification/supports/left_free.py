"""Rigid motions that supports leave a body: those of hinges turn it about their axes, those of plates go along their forces."""

from __future__ import annotations

import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case
from isomortar.model.rank import motions_left, moved, rigid_rank
from isomortar.scene import Scene

#: A bar off the origin, deformable or rigid, over a pad: what contact would prevent does not count.
_BAR = """
format = 1
[bodies.bar]
rigid = {rigid}
geometry = {{ kind = "box", lower = [2, 1, -3], upper = [4, 2.5, -2] }}
mesh = {{ order = 1, elements = [2, 1, 1] }}
[bodies.pad]
geometry = {{ kind = "box", lower = [2, 1, -4], upper = [4, 2.5, -3] }}
mesh = {{ order = 1, elements = [2, 1, 1] }}
[contacts]
between = {{ slave = "pad.w1", master = "bar.w0", friction = 0 }}
[supports]
floor.face = "pad.w0"
{supports}
[[stages]]
name = "go"
steps = 1
"""
#: A hinge along y off the body, the same with its centre further along the axis, and such whose axes are others.
_HINGE = 'hinge = { face = "bar.u0", components = ["x", "y", "z"], moment = 0.1, axis = [0, 2, 0], centre = [1.5, CENTRE, -1.2] }'
_SECOND = 'second = { face = "bar.u1", components = ["x", "y", "z"], moment = 0.1, axis = [0, 1, 0], centre = [CENTRE] }'
_PRESSED = 'plate = { face = "bar.w1", components = ["x", "y"], force.z = -0.3 }'
#: A plate across x: as the hinge turns, all of it goes the same way along z, and not along x.
_END = 'end = { face = "bar.u1", components = ["y"], force.ALONG = 0.2 }'
_AXIS, _CENTRE = np.array([0.0, 1.0, 0.0]), np.array([1.5, 9.0, -1.2])


def hinge(centre: str) -> str:
    """The hinge with its centre somewhere along its axis."""
    return _HINGE.replace("CENTRE", centre)


def second(centre: str) -> str:
    """A second hinge about a centre of its own."""
    return _SECOND.replace("CENTRE", centre)


#: Supports, and how many motions they leave a deformable bar: two hinges one, if they have their axis in common.
_LEFT = (
    (hinge("9"), 1),
    (hinge("9") + "\n" + second("1.5, -4, -1.2"), 1),
    (hinge("9") + "\n" + second("1.6, 9, -1.2"), 0),
    (hinge("9") + "\n" + second("1.5, 9, -1.1"), 0),
    (hinge("9") + "\n" + second("-1.5, 9, 1.2"), 0),
    (_PRESSED, 1),
    (hinge("9") + "\n" + _END.replace("ALONG", "z"), 1),
    (hinge("9") + "\n" + _END.replace("ALONG", "x"), 0),
    ('plain.face = "bar.v0"', 0),
)


def motions(rigid: bool, supports: str) -> tuple[int, FloatArray, FloatArray]:
    """How many motions supports are told to prevent, those left, shape (motions, n, 3), of the bar's control points, shape (n, 3)."""
    problem = Scene.from_toml(_BAR.format(rigid=str(rigid).lower(), supports=supports)).problem()
    piece, points = (problem.bodies[0],), problem.bodies[0].patch.control_points
    left = motions_left(problem, piece)
    return rigid_rank(problem, piece), np.array([moved(piece, motion, points) for motion in left]).reshape(-1, *points.shape), points


def apart(motion: FloatArray, expected: FloatArray) -> float:
    """By how much displacements are not a multiple of others, over their size."""
    one, other = motion / np.linalg.norm(motion), expected / np.linalg.norm(expected)
    return float(np.abs(one - np.sum(one * other) * other).max())


@case(
    claim="A hinge leaves a body a turn about its axis through its centre, wherever that is along the axis, and a plate the way of its "
    "force; two hinges leave a turn if their axis is one, else nothing.",
    tier="gate",
    bounds={
        "turn": Bound(at_most=1e-12, reason="round-off: of a cross product, by share of the largest displacement"),
        "way": Bound(at_most=1e-12, reason="round-off: all control points go along z"),
        "counts": Bound(0.0, 0.0, "definition: sets of supports that leave another number of motions"),
    },
)
def left_free() -> dict[str, float]:
    """By how much motions are others, of a deformable bar and of a rigid one; how many counts are wrong, of nine."""
    off = {"turn": 0.0, "way": 0.0}
    for rigid in (False, True):
        for name, support in (("turn", hinge("9")), ("turn", hinge("-20")), ("way", _PRESSED)):
            _, (motion,), points = motions(rigid, support)
            expected = np.cross(_AXIS, points - _CENTRE) if name == "turn" else np.broadcast_to([0.0, 0.0, 1.0], points.shape)
            off[name] = max(off[name], apart(motion, expected))
    found = [motions(False, supports)[:2] for supports, _ in _LEFT]
    wrong = [(len(left), rank) != (count, 6 - count) for (rank, left), (_, count) in zip(found, _LEFT, strict=True)]
    return off | {"counts": float(sum(wrong))}
