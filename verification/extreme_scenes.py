"""Scenes that sweeps to the extremes start from, as data of scene files, and closed forms of what is right in them."""

from __future__ import annotations

import copy
from pathlib import Path
from typing import Any

import numpy as np
from extremes.trials import Trial, run
from scipy.optimize import brentq

from isomortar.geometry.patch import FloatArray
from isomortar.scene.source import parse
from isomortar.scene.toml_text import dump

Data = dict[str, Any]

SCENES = Path(__file__).parent / "extremes" / "scenes"
#: Young's modulus and Poisson's ratio where a sweep does not change them.
YOUNG, POISSON = 10.0, 0.3


def loaded(name: str) -> Data:
    """A scene of the folder ``extremes/scenes``, to be changed."""
    return parse((SCENES / f"{name}.toml").read_text(encoding="utf-8"), name)


def changed(data: Data, changes: Data) -> Data:
    """A copy with some values changed; keys are dotted paths, numbers stand for entries of lists."""
    data = copy.deepcopy(data)
    for path, value in changes.items():
        *parents, last = path.split(".")
        node: Any = data
        for part in parents:
            node = node[int(part)] if isinstance(node, list) else node.setdefault(part, {})
        node[int(last) if isinstance(node, list) else last] = value
    return data


def ran(data: Data, **limits: int) -> Trial:
    """The run of a scene given as data."""
    return run(dump(data), **limits)


def column(size: tuple[float, float, float] = (1.0, 1.0, 1.0), press: float = 0.2, young: float = YOUNG, poisson: float = POISSON) -> Data:
    """A box on a rigid plane without friction, pressed by a share of its height and free to widen: a homogeneous state."""
    return {
        "format": 1,
        "materials": {"m": {"young": young, "poisson": poisson}},
        "bodies": {
            "b": {
                "geometry": {"kind": "box", "lower": [0.0, 0.0, 0.0], "upper": list(size)},
                "mesh": {"order": [2] * 3, "elements": [2] * 3},
            }
        },
        "contacts": {"f": {"slave": "b.w0", "plane": {"point": [0, 0, 0]}, "friction": 0.0}},
        "supports": {
            "top": {"face": "b.w1", "components": ["z"]},
            "x": {"face": "b.u0", "components": ["x"]},
            "y": {"face": "b.v0", "components": ["y"]},
        },
        "stages": [{"name": "press", "steps": 2, "motions": {"top": {"translate": [0, 0, -press * size[2]]}}}],
    }


def column_pressure(stretch: float, poisson: float = POISSON) -> float:
    """Force per reference area of a column at an axial stretch: the lateral traction (theory 8.3) is zero.

    With ``e = ln J`` that traction is ``bulk e + shear exp(-2e/3) (exp(e)/stretch - stretch^2) / 3 = 0``, well conditioned where the body
    is nearly incompressible.
    """
    bulk, shear = YOUNG / (3.0 * (1.0 - 2.0 * poisson)), YOUNG / (2.0 * (1.0 + poisson))
    ratio = bulk / shear

    def lateral(e: float) -> float:
        return ratio * e + np.exp(-2.0 * e / 3.0) * (np.exp(e) / stretch - stretch**2) / 3.0

    e = brentq(lateral, -30.0, 30.0, xtol=1e-300, rtol=1e-15)
    return float(-shear * np.exp(-2.0 * e / 3.0) * (stretch**2 - np.exp(e) / stretch) / stretch)


def confined_pressure(compression: float) -> float:
    """Force per area of a column that can not widen, shortened by a share of its height, however small."""
    bulk, shear = YOUNG / (3.0 * (1.0 - 2.0 * POISSON)), YOUNG / (2.0 * (1.0 + POISSON))
    stretch = 1.0 - compression
    deviator = 2.0 / 3.0 * compression * (compression - 2.0) * stretch ** (-2.0 / 3.0)
    return float(-(bulk * np.log1p(-compression) + shear * deviator) / stretch)


def stack(ratio: float, slave: int, master: int, press: float = 0.4) -> Data:
    """Two cubes that can not widen, one on the other without friction; the slave, on top, is `ratio` times as stiff as the master.

    `slave`, `master`: elements along x and y of each.
    """
    bodies, materials, supports = {}, {}, {}
    for name, low, elements, young in (("upper", 1.0, slave, ratio), ("lower", 0.0, master, 1.0)):
        materials[name] = {"young": YOUNG * young, "poisson": POISSON}
        box = {"kind": "box", "lower": [0.0, 0.0, low], "upper": [1.0, 1.0, low + 1.0]}
        bodies[name] = {"material": name, "geometry": box, "mesh": {"order": [2] * 3, "elements": [elements, elements, 1]}}
        for face, component in (("u0", "x"), ("u1", "x"), ("v0", "y"), ("v1", "y")):
            supports[f"{name}-{face}"] = {"face": f"{name}.{face}", "components": [component]}
    supports |= {"top": {"face": "upper.w1", "components": ["z"]}, "floor": {"face": "lower.w0", "components": ["z"]}}
    return {
        "format": 1,
        "materials": materials,
        "bodies": bodies,
        "contacts": {"c": {"slave": "upper.w0", "master": "lower.w1", "friction": 0.0}},
        "supports": supports,
        "stages": [{"name": "press", "steps": 2, "motions": {"top": {"translate": [0, 0, -press]}}}],
    }


def stack_pressure(ratio: float, press: float) -> float:
    """Force of `stack`: the two columns carry the same, and the stiffer one's share of the compression may be very small."""
    stiffer, softer = max(ratio, 1.0), min(ratio, 1.0)

    def difference(logarithm: float) -> float:
        share = np.exp(logarithm)
        return float(np.log(stiffer * confined_pressure(press * share)) - np.log(softer * confined_pressure(press * (1.0 - share))))

    share = np.exp(brentq(difference, -200.0, -1e-9, rtol=1e-15))
    return softer * confined_pressure(press * (1.0 - share))


def press_of(done: Trial) -> FloatArray:
    """Downward forces of the support `top` on its body, shape (steps,)."""
    return -done.force("top")[:, 2]


def worst(*kept: float) -> float:
    """The fewest digits of several results; NaN if one of them is."""
    return float(np.min(kept))
