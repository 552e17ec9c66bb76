"""What a scene without contact does beside a plain program for solids, which knows nothing of contact and records nothing."""

from __future__ import annotations

import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model import constants
from isomortar.model.entities import Problem
from isomortar.model.numbering import Numbering
from isomortar.model.solid import Solid
from isomortar.model.supports import Supports
from isomortar.scene import Scene
from isomortar.solve.condensed import Bodies, CondensedSystem
from isomortar.solve.secants import Secants
from isomortar.solve.system import LinearSystem, Source, block_product, entries
from isomortar.solve.timing import Ledger
from isomortar.told.during.unstable import FORCES

#: A block held at two sides, one of which is turned and lifted.
BENT = """
format = 1
bodies.block.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 0.5] }
bodies.block.mesh = { order = [2, 2, 2], elements = [4, 4, 2] }
supports.left.face = "block.u0"
supports.right = { face = "block.u1", axis = [1, 0, 0] }
stages = [{ name = "bend", steps = 4, motions.right = { translate = [0.04, 0, 0.08], rotate = 8 } }]
"""


class Plain:
    """Newton's method with factors that are kept, for one body, from where the last load step leads; `ledger` counts what it did.

    Corrections by kept factors learn from the steps before.

    It asks at its end whether the equilibrium is stable.
    """

    def __init__(self, problem: Problem) -> None:
        self.ledger = ledger = Ledger()
        self.problem, self.numbering = problem, Numbering(problem)
        self.supports, self.solid = Supports(problem, self.numbering), Solid(problem, self.numbering, ledger.counts)
        self.free = self.supports.free
        source = Source(self.solid.pattern, self.supports.equation, self.supports.equation)
        among = entries([source], len(self.free))
        bodies = Bodies(source, among, ledger)
        self.system = CondensedSystem(bodies, len(self.free), [source], lambda: LinearSystem(len(self.free), [source], ledger), ledger)

    def run(self) -> FloatArray:
        """Positions at the end."""
        positions, rate = self.numbering.reference.copy(), None
        for step in range(1, self.problem.total_steps + 1):
            start = positions
            positions = self._balanced(self._pushed(start, step) if rate is None else self._ahead(start + rate, step))
            rate = positions - start
        for force in np.eye(len(self.free))[:FORCES]:  # whether the end of the stage is stable
            self.system.solve_again(force)
        return positions

    def _pushed(self, start: FloatArray, step: int) -> FloatArray:
        """Positions after a solve with what supports prescribe."""
        given = self.supports.increment(start, step)
        tangent = self._factorise(start)
        right = self.solid.forces(start) + block_product(self.solid.pattern, tangent, given)
        return start + self._correction(right) + given

    def _ahead(self, positions: FloatArray, step: int) -> FloatArray:
        """Positions with the supports where they are then."""
        return np.where(self.supports.held, self.supports.place(step), positions)

    def _balanced(self, positions: FloatArray) -> FloatArray:
        """Positions at which forces are in balance."""
        (forces, left), keep = self._residual(positions), False
        while left > self.problem.settings.newton_tolerance:
            if not keep:
                self._factorise(positions)
            correction, before = self._correction(forces), left
            if keep:
                self.secants.reach(positions, correction)
                correction = self.secants.improved(correction)
            positions = positions + correction
            forces, left = self._residual(positions)
            keep = left <= constants.KEPT_SHARE * before
        return positions

    def _residual(self, positions: FloatArray) -> tuple[FloatArray, float]:
        forces = self.solid.forces(positions)
        return forces, float(np.linalg.norm(forces.ravel()[self.free]) / np.linalg.norm(forces))

    def _factorise(self, positions: FloatArray) -> FloatArray:
        _, tangent = self.solid.forces_and_tangent(positions)
        self.system.factorise([tangent])
        self.secants = Secants()
        return tangent

    def _correction(self, forces: FloatArray) -> FloatArray:
        correction = np.zeros_like(forces)
        correction.ravel()[self.free] = -self.system.solve(forces.ravel()[self.free])
        return correction


#: Counts of what both do.
SHARED = ("solid points", "analyses", "factorisations", "solves")


@case(
    claim="A scene without contact visits no more quadrature points than a plain program for solids by the same method, analyses, "
    "factorises and solves no more often, and comes to the same positions, to the last bit.",
    tier="gate",
    bounds={
        "more": Bound(at_most=0, reason="definition: what a scene does not require it does not pay for"),
        "apart": Bound(at_most=0, reason="definition: the same sums in the same order"),
        "solved": Bound(at_least=8, reason="definition: two solves a load step or more, so that the body is bent and factors are kept"),
    },
)
def solid_alone() -> dict[str, float]:
    """Four load steps by both programs."""
    problem = Scene.from_toml(BENT).problem()
    steps = list(Simulation(problem).run())
    plain = Plain(problem)
    positions = plain.run()
    ours = {name: sum(step.counters[name] for step in steps) for name in SHARED}
    return {
        "more": float(np.max([ours[name] - plain.ledger.counts[name] for name in SHARED])),
        "apart": float(np.abs(steps[-1].state.positions - positions).max()),
        "solved": ours["solves"],
    }
