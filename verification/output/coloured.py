"""Colours of bodies by a field: over the range that it has inside, and each face in those of its own values."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from matplotlib.collections import PathCollection
from output import exported
from output.records import load_steps

from isomortar.harness import Bound, case
from isomortar.model.numbering import Numbering
from isomortar.results import style
from isomortar.results.bodies import VIEW
from isomortar.results.coloured import draw_coloured
from isomortar.scene import Scene

#: A box under an affine motion, or moved as a whole.
SCENE = """
format = 1
materials.m = { young = 2, poisson = 0.25 }
bodies.block = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 0.5, 0.8] }, mesh = { order = [2, 1, 1], elements = 1 } }
supports.base.face = "block.w0"
stages = [{ name = "one", steps = 1 }]
"""


@case(
    claim="Bodies are coloured by the field that is asked for, as they are deformed, over its range: from zero on, but J over its own.",
    tier="gate",
    grid={"field": ("stress", "J", "displacement")},
    bounds={
        "range": Bound(at_most=1e-12, reason="round-off: a field that is the same everywhere, against its formula"),
        "colours": Bound(at_most=1e-6, reason="definition: where the range begins at zero all is of its last colour; lines are few"),
    },
)
def coloured(field: str) -> dict[str, float]:
    """Ends of the colour bar, of J its lower one, off what they are to be; by how much the colour of most parts is not the last one."""
    problem = Scene.from_toml(SCENE).problem()
    (step,), at_rest = load_steps(problem), Numbering(problem).reference
    motion = np.eye(3) if field == "displacement" else exported.GRADIENT
    moved = replace(step, state=replace(step.state, positions=at_rest @ motion.T + exported.SHIFT))
    figure = draw_coloured(problem, moved, field)
    *_, mises, ratio = exported.stressed(problem.bodies[0], motion[None])[0]
    exact = {"stress": mises, "J": ratio, "displacement": np.linalg.norm(exported.SHIFT)}[field]
    low, high = figure.axes[1].get_ylim()
    drawn = np.concatenate([c.get_facecolor() for c in figure.axes[0].collections if isinstance(c, PathCollection)])
    alone = field == "J"  # a range of one value, which is drawn wider
    return {
        "range": float(np.abs([low - exact] if alone else [low, high - exact]).max()),
        "colours": 0.0 if alone else float(np.abs(np.median(drawn, axis=0) - style.field_colours()(1.0)).max()),
    }


@case(
    claim="A body that has no stress and its volume, however it has turned, or has not moved, has one colour: that of none.",
    tier="gate",
    grid={"field": ("stress", "J", "displacement")},
    bounds={"colours": Bound(at_most=1e-2, reason="round-off: some parts of 256 colours; a range that round-off fills has all of them")},
)
def round_off(field: str) -> dict[str, float]:
    """Largest distance of a colour from the first one."""
    problem = Scene.from_toml(SCENE).problem()
    (step,), at_rest = load_steps(problem), Numbering(problem).reference
    cosine, sine = np.cos(0.7), np.sin(0.7)
    turned = at_rest @ np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]]) + exported.SHIFT
    moved = replace(step, state=replace(step.state, positions=at_rest if field == "displacement" else turned))
    figure = draw_coloured(problem, moved, field)
    faces = [c for c in figure.axes[0].collections if isinstance(c, PathCollection)]
    drawn = np.concatenate([c.get_facecolor() for c in faces])
    return {"colours": float(np.abs(np.median(drawn, axis=0) - style.field_colours()(0.0)).max())}


@case(
    claim="Each part of a face has the colour of the field in its own middle, wherever it is seen.",
    tier="gate",
    bounds={
        "off": Bound(at_most=0.005, reason="definition: half of parts at most are a colour off, of 256; lines and corners have their own")
    },
)
def in_place() -> dict[str, float]:
    """Median distance of a colour, of all of them, from that of a displacement away from who looks, which grows along the picture."""
    problem = Scene.from_toml(SCENE).problem()
    (step,), at_rest = load_steps(problem), Numbering(problem).reference
    right, up, away = VIEW.axes
    moved = at_rest + np.outer(at_rest @ (0.3 * right + 0.5 * up) + 0.6, away)
    figure = draw_coloured(problem, replace(step, state=replace(step.state, positions=moved)), "displacement")
    (parts,) = (c for c in figure.axes[0].collections if isinstance(c, PathCollection))
    middles = np.array([np.asarray(path.vertices)[:-1].mean(axis=0) for path in parts.get_paths()])
    exact = (middles @ [0.3, 0.5] + 0.6) / figure.axes[1].get_ylim()[1]
    scale = style.field_colours()(np.linspace(0.0, 1.0, 256))
    found = [np.abs(scale - colour).sum(axis=1).argmin() / 255 for colour in np.asarray(parts.get_facecolor())]
    return {"off": float(np.median(np.abs(found - exact)))}
