"""Gaps of single points, of results: signed distances to masters whose shape is known."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case
from isomortar.model.numbering import Numbering
from isomortar.results.gaps import gaps
from isomortar.scene import Scene

_SCENE = """
format = 1
[bodies.block]
geometry = {{ kind = "box", lower = [0.2, 0.3, 3], upper = [1, 0.8, 4] }}
mesh = {{ order = [2, 1, 1], elements = [2, 1, 1] }}
{master}
[supports]
top.face = "block.w1"
[[stages]]
name = "wait"
steps = 1
"""
_BASE = """
[bodies.base]
geometry = { kind = "box", lower = [-0.5, -0.6, -0.4], upper = [1.6, 1.7, 0] }
mesh = { order = [2, 3, 1], elements = [3, 2, 1] }
[contacts.pair]
slave = "block.w0"
master = "base.w1"
projection = "averaged"
[supports.ground]
face = "base.w0"
"""
_ROLL = """
[bodies.base]
geometry = { kind = "ring", centre = [0.5, 0.4, 1], inner = 0.3, outer = 1.5, width = 0.8 }
mesh = { order = [2, 1, 1], elements = [8, 1, 1] }
[contacts.pair]
slave = "block.w0"
master = "base.v1"
[supports.ground]
face = "base.v0"
"""
_PLANE = """
[contacts.pair]
slave = "block.w0"
plane = { point = [0, 0, 1], normal = [0.6, 0, 0.8] }
"""
#: The master goes by a turn about y and a shift.
TURN = np.array([[0.8, 0.0, 0.6], [0.0, 1.0, 0.0], [-0.6, 0.0, 0.8]])
SHIFT = np.array([0.1, -0.3, 0.7])


def _flat(points: FloatArray) -> FloatArray:
    """Of the upper face of the base, 0.4 thick."""
    there = (points - SHIFT) @ TURN
    beside = np.any((there[:, :2] < [-0.5, -0.6]) | (there[:, :2] > [1.6, 1.7]), axis=1)
    return np.where(beside | (there[:, 2] < -0.4), np.nan, -there[:, 2])


def _round(points: FloatArray) -> FloatArray:
    """Of the outside of the ring, 1.2 thick, whose axis is y."""
    there = (points - SHIFT) @ TURN - [0.5, 0.4, 1.0]
    far = np.hypot(there[:, 0], there[:, 2])
    return np.where((np.abs(there[:, 1]) > 0.4) | (far < 0.3), np.nan, 1.5 - far)


def _plane(points: FloatArray) -> FloatArray:
    return np.asarray(-(points - [0.0, 0.0, 1.0]) @ [0.6, 0.0, 0.8])


#: Masters, and gaps to them: positive in them, not a number where there is no foot.
MASTERS: dict[str, tuple[str, Callable[[FloatArray], FloatArray]]] = {
    "flat": (_BASE, _flat),
    "round": (_ROLL, _round),
    "plane": (_PLANE, _plane),
}


@case(
    claim="Gaps of points are their distances to the master where it is, positive in it; beside it there are none.",
    tier="gate",
    grid={"master": list(MASTERS)},
    bounds=lambda master: {
        "error": Bound(at_most=1e-13, reason="round-off: of distances of size one"),
        "beside": Bound(at_most=0.0, reason="definition: points that are told a gap and have none, or the other way"),
        "both": Bound(at_least=0.0 if master == "plane" else 10.0, reason="definition: there are points with a foot and without"),
    },
)
def distances(master: str) -> dict[str, float]:
    """Largest error of random points around a master that has moved; points with and without a foot."""
    text, exact = MASTERS[master]
    problem = Scene.from_toml(_SCENE.format(master=text)).problem()
    positions = np.ascontiguousarray(Numbering(problem).reference @ TURN.T + SHIFT)
    points = np.random.default_rng(47).uniform([-1.5, -1.5, -1.0], [3.0, 2.5, 3.0], (200, 3))
    found, expected = gaps(problem, problem.contacts[0], positions, points), exact(points)
    known = np.isfinite(expected)
    wrong = np.count_nonzero(known != np.isfinite(found))
    return {
        "error": float(np.nanmax(np.abs(found - expected))),
        "beside": float(wrong),
        "both": float(np.minimum(np.count_nonzero(known), np.count_nonzero(~known))),
    }
