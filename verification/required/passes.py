"""What each pass over contact points takes of the master, and of slips, where there is friction and where there is none."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from isomortar import _bindings
from isomortar._codes import ROW_KINDS, WORK
from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.timing import Ledger

#: A bowl above a block of order 3, both deformable, and how far the bowl is pushed into it.
SCENE = ("bodies.slave.mesh.elements=[2,2,1]", "bodies.master.mesh.order=[3,3,1]", "bodies.master.mesh.elements=[3,3,1]")
DEPTH = 0.15


class Pushed:
    """A contact pair at positions where it touches, its feet warm, and what the kernel counts of a call."""

    def __init__(self, friction: float, projection: str) -> None:
        settings = (*SCENE, f"contacts.interface.friction={friction}", f"contacts.interface.projection={projection}")
        problem = Scene.load("twist", settings).problem()
        self.equilibrium = Equilibrium(problem, Ledger())
        self.mechanics = self.equilibrium.pairs[0]
        self.pair, self.frictional = self.mechanics.pair, self.mechanics.friction.acts
        self.positions: FloatArray = self.equilibrium.numbering.reference.copy()
        self.positions[np.unique(self.equilibrium.numbering.points["slave"])] += [0.01, 0.02, -DEPTH]
        self.start = self.equilibrium.initial_state().contacts[0]
        self.kinematics = self.mechanics.kinematics(self.positions, self.start)
        n = len(self.start.pressure)
        law = self.mechanics.law(np.ones(2), np.ones(n), np.zeros((n, 2)))
        self.response = replace(self.mechanics.respond(self.kinematics, law), field_slip=np.zeros((len(self.pair.slave.area), 2)))
        self.patterns = self.mechanics.reach.update(self.kinematics.projections, self.response.state)

    def counts(self) -> dict[str, dict[str, int]]:
        """Counts of each pass, by name."""
        slave, master, at, feet = self.pair.slave, self.pair.master, self.positions, self.kinematics.projections
        forces, patterns = np.zeros_like(at), self.patterns
        kind = ("local" if self.frictional else "frictionless") + ", averaged" * self.pair.contact.averaged
        rows = np.zeros((len(patterns.rows.column), ROW_KINDS[kind], 3))
        tangent = np.zeros((len(patterns.tangent.column), 3, 3))
        calls: dict[str, tuple[Any, ...]] = {
            "feet": (_bindings.project_points, slave, master, at, self.start.projection, self.start.projected, self.frictional),
            "control": (_bindings.control_quantities, slave, master, at, feet, self.frictional),
            "forces": (_bindings.contact_forces, slave, master, at, feet, self.response, forces, self.frictional),
            "tangent": (
                *(_bindings.contact_blocks, slave, master, at, feet, self.frictional, self.response),
                *(patterns.rows, rows, patterns.tangent, tangent),
            ),
        }
        found = {}
        for name, (call, *arguments) in calls.items():
            numbers = np.zeros(len(WORK), dtype=np.int64)
            call(*arguments, counts=numbers)
            found[name] = dict(zip(WORK, numbers.tolist(), strict=True))
        return found


def evaluated(counts: dict[str, int], least: int) -> int:
    """Places where the master was evaluated to at least an order."""
    return sum(counts[f"evaluations to order {order}"] for order in range(least, 4))


_NONE = "definition: what the scene does not require is not computed"


@case(
    claim="Control quantities take the master's first derivatives and no more. Without friction forces do so too, tangents take the "
    "second, and there are neither slips nor metric; with it forces take the second, and tangents the third, at each point.",
    tier="gate",
    grid={"friction": [0.0, 0.3]},
    bounds=lambda friction: {
        "touching": Bound(at_least=0.3, at_most=1.0, reason="definition: share of the points at which contact acts; else nothing is seen"),
        "control beyond 1": Bound(at_most=0, reason=_NONE),
        "forces beyond": Bound(at_most=0, reason=_NONE),
        "tangent beyond": Bound(at_most=0, reason=_NONE),
        "control at 1": Bound(at_least=1, at_most=1, reason="definition: an evaluation at each point with a foot"),
        "forces": Bound(at_least=1, at_most=1, reason="definition: an evaluation at each point where contact acts"),
        "tangent": Bound(at_least=1, at_most=1, reason="definition: an evaluation at each point where contact acts"),
        "slips and metric": Bound(at_most=0, reason=_NONE)
        if friction == 0.0
        else Bound(at_least=1e-6, reason="definition: the body has moved along, so that they are not zero"),
    },
)
def closest_points(friction: float) -> dict[str, float]:
    """Passes at one state, a call each."""
    pushed = Pushed(friction, "closest")
    counts, feet = pushed.counts(), pushed.kinematics.projections
    acts = np.repeat(np.any(pushed.response.state[pushed.pair.slave.test.nodes] > 0, axis=1), pushed.pair.slave.per_element)
    acting, found = int(np.count_nonzero(acts & (feet.found > 0))), int(np.count_nonzero(feet.found))
    highest = 2 if pushed.frictional else 1
    return {
        "touching": acting / len(acts),
        "control beyond 1": evaluated(counts["control"], 2),
        "forces beyond": evaluated(counts["forces"], highest + 1),
        "tangent beyond": evaluated(counts["tangent"], highest + 2),
        "control at 1": counts["control"]["evaluations to order 1"] / found,
        "forces": counts["forces"][f"evaluations to order {highest}"] / acting,
        "tangent": counts["tangent"][f"evaluations to order {highest + 1}"] / acting,
        "slips and metric": _sizes(pushed),
    }


@case(
    claim="Along averaged normals no pass evaluates a second derivative. Without friction none looks at where feet were, and there are "
    "neither slips nor metric.",
    tier="gate",
    grid={"friction": [0.0, 0.3]},
    bounds=lambda friction: {
        "beyond 1": Bound(at_most=0, reason=_NONE),
        "former feet": Bound(at_most=0, reason=_NONE)
        if friction == 0.0
        else Bound(at_least=1, reason="definition: slips count from them, at each point with a foot"),
        "slips and metric": Bound(at_most=0, reason=_NONE)
        if friction == 0.0
        else Bound(at_least=1e-6, reason="definition: the body has moved along, so that they are not zero"),
    },
)
def averaged_normals(friction: float) -> dict[str, float]:
    """Passes at one state, a call each."""
    pushed = Pushed(friction, "averaged")
    counts, found = pushed.counts(), int(np.count_nonzero(pushed.kinematics.projections.found))
    return {
        "beyond 1": sum(evaluated(one, 2) for one in counts.values()),
        "former feet": sum(one["evaluations to order 0"] for one in counts.values()) / found,
        "slips and metric": _sizes(pushed),
    }


def _sizes(pushed: Pushed) -> float:
    """The smallest of the largest slip, control slip, square, metric, and metric at a point; the largest where there is no friction."""
    control = pushed.kinematics.control
    arrays = (pushed.kinematics.projections.slip, control.slip, control.square, control.metric, control.point_metric)
    sizes = [float(np.abs(array).max()) for array in arrays]
    return min(sizes) if pushed.frictional else max(sizes)
