"""How deep a slave may be in its master: as deep as the master's body is, whichever way feet are found."""

from __future__ import annotations

import numpy as np
from projection.closest_points import Surface

from isomortar import _bindings
from isomortar.errors import LostProjectionError
from isomortar.geometry.primitives import box
from isomortar.harness import Bound, case
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.timing import Ledger

THICKNESS = 0.05
#: A block whose lower face is above a thin plate of elements with lines between them.
_PLATE = """
format = 1
bodies.block = {{ geometry = {{ kind = "box", lower = [0.3, 0.3, 0.0], upper = [0.6, 0.6, 0.3] }}, mesh.elements = [2, 2, 1] }}
bodies.plate = {{ geometry = {{ kind = "box", lower = [0, 0, -{thickness}], upper = [1, 1, 0] }}, \
mesh = {{ family = "L", order = [{order}, {order}, 1], elements = [4, 4, 1] }} }}
contacts.pair = {{ slave = "block.w0", master = "plate.w1", projection = "{projection}" }}
supports = {{ top.face = "block.w1", base.face = "plate.w0" }}
stages = [{{ name = "rest", steps = 1 }}]
"""
#: Depths below the plate's upper face, as shares of its thickness.
WITHIN, BEHIND = (-4.0, 0.0, 0.5, 0.99), (1.01, 2.0, 4.0, 10.0)


def found(equilibrium: Equilibrium, depth: float, had: int) -> list[float]:
    """Share of points in reach, as deep; 'had': in reach at the last converged state, right there. Nothing of it if they passed through.

    Both as they are found, and as they are followed from an iterate of the increment that had all of them in reach.
    """
    pair, state = equilibrium.pairs[0].pair, equilibrium.initial_state()
    positions, before = state.positions.copy(), np.full_like(state.contacts[0].projected, had)
    positions[np.unique(equilibrium.numbering.points["block"]), 2] -= depth
    start = state.contacts[0].projection
    iterate = _bindings.project_points(pair.slave, pair.master, state.positions, start, before)
    shares = []
    for near in (None, iterate):
        try:
            shares.append(float(np.mean(_bindings.project_points(pair.slave, pair.master, positions, start, before, near=near).found)))
        except LostProjectionError as error:
            shares.append(-float("passed through" in str(error)))
    return shares


@case(
    claim="A slave within a thin body is in contact's reach; behind the body it takes no part, or has passed through, after "
    "whatever iterate.",
    tier="gate",
    grid={"projection": ["closest", "averaged"], "order": [1, 2]},
    bounds={
        "within": Bound(at_least=1.0, at_most=1.0, reason="definition: no deeper than the body"),
        "behind": Bound(at_most=0.0, at_least=0.0, reason="definition: deeper than the body, from the start: no contact"),
        "through": Bound(
            at_least=-1.0, at_most=-1.0, reason="definition: deeper than the body, in reach before: the increment is too long"
        ),
    },
)
def thin_body(projection: str, order: int) -> dict[str, float]:
    """Least share of points in reach within the body; the largest of those behind it from the start, and of those in reach before."""
    text = _PLATE.format(thickness=THICKNESS, order=order, projection=projection)
    equilibrium = Equilibrium(Scene.from_toml(text).problem(), Ledger())
    return {
        "within": float(np.min([found(equilibrium, THICKNESS * share, had) for share in WITHIN for had in (0, 1)])),
        "behind": float(np.max(np.abs([found(equilibrium, THICKNESS * share, 0) for share in BEHIND]))),
        "through": float(np.max([found(equilibrium, THICKNESS * share, 1) for share in BEHIND])),
    }


@case(
    claim="Of many points the one that has passed through is named, whichever it is.",
    bounds={"other": Bound(0.0, 0.0, "definition: points behind the body where none is named, or another")},
)
def which_point() -> dict[str, float]:
    """How many of the points, each alone behind the body, in reach before."""
    plate = Surface(box((0, 0, -THICKNESS), (1, 1, 0)), "w1")
    places = np.random.default_rng(5).uniform(0.1, 0.9, (9, 2))
    other = 0
    for q in range(len(places)):
        targets = np.column_stack([places, np.where(np.arange(len(places)) == q, -2.0 * THICKNESS, 0.0)])
        try:
            plate.project(targets, places)
        except LostProjectionError as error:
            other += error.place != q
        else:
            other += 1
    return {"other": float(other)}
