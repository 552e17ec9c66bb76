"""The tangent's error at states that a scene itself reaches, part by part, against the extended-precision twin."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np
from rich.table import Table
from scipy import sparse

from isomortar import _twin
from isomortar._bindings import Pattern
from isomortar._codes import PointState
from isomortar._frozen import frozen
from isomortar.errors import KernelError
from isomortar.geometry.patch import FloatArray, IntArray
from isomortar.harness.visits import PairVisit, Visit, visited_states
from isomortar.model.entities import Problem
from isomortar.model.numbering import body_arrays
from isomortar.solve.contact import PairMechanics, pressure_share
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.system import block_product
from isomortar.solve.timing import Ledger

#: Largest relative error of a product of the tangent, and largest asymmetry of its frictionless part.
BOUND, SYMMETRY_BOUND = 1e-11, 1e-13
#: The same of pressures on faces: their forces are products of two positions, so that differences are exact.
LOADS_BOUND = 1e-12
#: Products smaller than this share of the largest are measured by that: they come from where functions fade out.
HARDLY = 1e-3

#: The parts, in the order of the report.
PARTS = {
    "solid": "internal forces",
    "normal, geometric": "contact forces, pressures held, tractions left out",
    "normal, gap": "<R g> of active constraints",
    "normal, pressure": "control pressures",
    "tangential, geometric": "contact forces, tractions held, pressures left out",
    "tangential, projection": "<R xi> of active constraints",
    "tangential, slip increment": "<R (xi - xi_n)> of active constraints",
    "tangential, metric": "<R R a_ab> of active constraints",
    "stick": "tractions of sticking constraints",
    "slip": "tractions of slipping constraints",
    "multipliers": "control pressures and tractions, and forces, by the multipliers before",
    "whole": "all forces, multipliers condensed",
    "symmetry": "solid and normal parts, relative to their norm",
}
#: What scenes with loads have besides.
LOADS = {"loads": "forces of pressures on faces"}


@frozen
class PartError:
    """Largest relative error of one part over `samples` products, what it is the derivative of, and its bound."""

    part: str
    meaning: str
    samples: int
    error: float
    bound: float

    @property
    def passes(self) -> bool:
        """Whether the error is within its bound."""
        return self.error <= self.bound


@frozen
class TangentReport:
    """Errors of the tangent by part at `states` visited states of a load step.

    `active`, `stick`, `slip`: constraints by state, of each visited state. Parts that a scene does not have are left out.
    `idle`: contacts with no active constraint at any of the states, whose tangent was not measured.
    """

    scene: str
    step: int
    active: tuple[int, ...]
    stick: tuple[int, ...]
    slip: tuple[int, ...]
    idle: tuple[str, ...]
    rows: tuple[PartError, ...]

    @property
    def passes(self) -> bool:
        """Whether there are parts, every one is within its bound, and none was left out because a contact is open."""
        return bool(self.rows) and not self.idle and all(row.passes for row in self.rows)

    def __rich__(self) -> Table:
        counts = ", ".join(f"{a} ({t} stick, {s} slip)" for a, t, s in zip(self.active, self.stick, self.slip, strict=True))
        table = Table(title=f"Tangent of {self.scene}, load step {self.step}", caption=f"Active constraints of the states: {counts}")
        for heading in ("part", "derivative of", "products", "error", "bound", ""):
            table.add_column(heading, justify="left" if heading in ("part", "derivative of", "") else "right")
        for row in self.rows:
            verdict = "[green]passes" if row.passes else "[red]FAILS"
            table.add_row(row.part, row.meaning, str(row.samples), f"{row.error:.1e}", f"{row.bound:.0e}", verdict)
        for name in self.idle:
            table.add_row(f"contact {name!r}", "open at all states: choose another load step", "0", "", "", "[red]NOT MEASURED")
        return table


#: A part, and the product of the tangent and of the twin.
Sample = tuple[str, FloatArray, FloatArray]


def check_tangent(problem: Problem, step: int | None = None, directions: int = 3, seed: int = 0) -> TangentReport:
    """Measure the tangent at states that Newton's method visits in a load step.

    Parameters
    ----------
    problem : Problem
    step : int, optional
        Recorded load step; default: mid-run.
    directions : int
        Random fields of all control points that the tangent is applied to, and as many changes of single contact control points,
        at each state. The solid sees the first field only: its twin costs most, and a field tries all entries at once.
    seed : int
        Of the random numbers.

    Raises
    ------
    InputError
        No such step.
    ConvergenceError
        The scene does not get there.
    KernelError
        A branch switches within the step of the differences: there is no tangent there.
    """
    step = (problem.total_steps + 1) // 2 if step is None else step
    return measure(problem, step, visited_states(problem, step), directions, seed)


def measure(problem: Problem, step: int, visits: Iterable[Visit], directions: int = 3, seed: int = 0, length: float = 1.0) -> TangentReport:
    """Measure the tangent at given states.

    Parameters
    ----------
    length : float
        Of the directions, as a share of the bodies' size. Where a state is next to an edge (of the active set, of a master's element),
        short ones keep the differences on its side: the derivative from that side.

    Others, and errors raised: see `check_tangent`.
    """
    # Condensed, whatever the scene's method: the pattern then has room for the whole tangent.
    equilibrium = Equilibrium(replace(problem, settings=replace(problem.settings, method="uzawa")), Ledger())
    random = np.random.default_rng(seed)
    samples: list[Sample] = []
    states = []
    idle = {pair.pair.contact.name for pair in equilibrium.pairs}
    for visit in visits:
        pairs = [PairState(pair, visit.positions, at) for pair, at in zip(equilibrium.pairs, visit.pairs, strict=True)]
        states.append(np.concatenate([np.zeros(0, np.int32)] + [pair.response.state for pair in pairs]))
        idle -= {pair.pair.pair.contact.name for pair in pairs if np.any(_active(pair.response.state))}
        samples += _sample(equilibrium, visit, pairs, directions, random, length)
    active, stick, slip = (tuple(int(np.count_nonzero(kind(s))) for s in states) for kind in (_active, _sticks, _slips))
    rows = (_part_error(part, samples) for part in PARTS | LOADS)
    return TangentReport(problem.name, step, active, stick, slip, tuple(sorted(idle)), tuple(row for row in rows if row))


def _active(state: IntArray) -> np.ndarray:
    return state > 0


def _sticks(state: IntArray) -> np.ndarray:
    return state == PointState.STICK


def _slips(state: IntArray) -> np.ndarray:
    return state == PointState.SLIP


def _part_error(part: str, samples: list[Sample]) -> PartError | None:
    """The largest relative error of a part; None where the scene has nothing of it.

    A product of a constraint that hardly reaches the part has fewer digits: it is measured by `HARDLY` of the largest product.
    """
    mine = [(ours, twin) for name, ours, twin in samples if name == part and (np.any(ours) or np.any(twin))]
    if not mine:
        return None
    least = HARDLY * float(np.max([np.linalg.norm(twin) for _, twin in mine]))
    errors = [_relative(ours, twin, least) for ours, twin in mine]
    largest = float(np.max(errors))  # of which one that is not a number is the largest
    return PartError(part, (PARTS | LOADS)[part], len(errors), largest, {"symmetry": SYMMETRY_BOUND, "loads": LOADS_BOUND}.get(part, BOUND))


def _relative(ours: FloatArray, twin: FloatArray, least: float) -> float:
    size = max(float(np.linalg.norm(twin)), least)
    return float(np.linalg.norm(ours - twin)) / size if size > 0.0 else float("inf")


class PairState:
    """One contact pair at a visited state, and the twin's derivatives there."""

    def __init__(self, pair: PairMechanics, positions: FloatArray, visit: PairVisit) -> None:
        self.pair, self.visit, self.positions = pair, visit, positions
        self.kinematics = pair.kinematics(positions, visit.start)
        self.response = pair.respond(self.kinematics, visit.law)

    def twin(
        self, along: FloatArray, pressure_along: FloatArray | None = None, traction_along: FloatArray | None = None
    ) -> _twin.ContactChange:
        """The twin's derivatives.

        Raises
        ------
        KernelError
            A branch switches within the step of the differences.
        """
        law, start = self.visit.law, self.visit.start
        change, switched = _twin.contact_difference(
            self.pair.pair.slave, self.pair.pair.master, self.positions, along, self.kinematics.projections, start.projection,
            start.projected, law, np.zeros_like(law.pressure) if pressure_along is None else pressure_along,
            np.zeros_like(law.traction) if traction_along is None else traction_along, self.response,
        )  # fmt: skip
        if switched:
            name = self.pair.pair.contact.name
            raise KernelError(f"contact {name!r}: {switched} branches switch within the step of the differences; there is no tangent")
        return change


class PairTangent(PairState):
    """The tangent of one contact pair at a visited state where some constraint is active, in double precision, in parts."""

    def __init__(self, pair: PairMechanics, positions: FloatArray, visit: PairVisit) -> None:
        super().__init__(pair, positions, visit)
        self.blocks = pair.blocks(positions, self.kinematics, visit.law, self.response)
        self.pattern, self.condensed = pair.condensed(self.response, self.blocks)
        pressures = replace(self.response, traction=np.zeros_like(self.response.traction))
        tractions = replace(self.response, pressure=np.zeros_like(self.response.pressure))
        self.normal = pair.blocks(positions, self.kinematics, visit.law, pressures).geometric
        self.tangential = pair.blocks(positions, self.kinematics, visit.law, tractions).geometric

    def along_positions(self, along: FloatArray) -> tuple[list[Sample], FloatArray, FloatArray]:
        """Samples of all parts, and the contact forces' change by the condensed tangent and by the twin."""
        twin = self.twin(along)
        state = self.response.state
        rows = row_product(self.blocks.patterns.rows, self.blocks.rows, along)
        averaged = self.pair.pair.contact.averaged
        off_lines = _active(state) & ~self._near_lines()  # on C0 lines tractions work on more than the projection's change
        changes = row_product(self.blocks.patterns.wide, self.blocks.changes, along)
        samples = [
            ("normal, geometric", block_product(self.pattern, self.normal, along), twin.normal_forces),
            ("normal, gap", rows[_active(state), -1 if averaged else 0], twin.gap[_active(state)]),
            ("normal, pressure", changes[:, 0], twin.pressure),
        ]
        if self.pair.friction.acts and not averaged:  # along it they work in the slave's basis, not on coordinates of the master
            samples.append(("tangential, projection", rows[off_lines, 1:3], twin.coordinates[off_lines]))
        if self.pair.friction.acts:
            samples += [
                ("tangential, geometric", block_product(self.pattern, self.tangential, along), twin.tangential_forces),
                ("tangential, slip increment", rows[_active(state), 3:5], twin.slip[_active(state)]),
                ("tangential, metric", rows[_active(state), 5:8], twin.metric[_active(state)]),
                ("stick", changes[_sticks(state), 1:], twin.traction[_sticks(state)]),
                ("slip", changes[_slips(state), 1:], twin.traction[_slips(state)]),
            ]
        return samples, block_product(self.pattern, self.condensed, along), twin.forces

    def _near_lines(self) -> np.ndarray:
        """Whether a foot within the reach of a constraint is on a C0 line, shape (constraints,)."""
        slave = self.pair.pair.slave
        elements = np.any(self.kinematics.projections.fixed.reshape(slave.elements, -1), axis=1)
        near = np.zeros(slave.test.count, dtype=bool)
        near[slave.test.nodes[elements]] = True
        return near

    def along_multipliers(self, random: np.random.Generator, length: float) -> list[Sample]:
        """Change of the law's pressures and tractions, and of the forces, with the multipliers that it starts from."""
        law, response = self.visit.law, self.response
        pressure = length * random.standard_normal(law.pressure.shape) * np.abs(response.pressure).max()
        traction = length * random.standard_normal(law.traction.shape) * np.abs(response.traction).max()
        twin = self.twin(np.zeros_like(self.positions), pressure, traction)
        slope, pressures = response.traction_slope, pressure_share(self.kinematics.control, law, response) * pressure
        tractions = slope[:, 0] * pressures[:, None] + np.einsum("iba,ib->ia", slope[:, 1:3], traction)
        ours = np.column_stack([pressures, tractions])
        changed = np.column_stack([twin.pressure, twin.traction])
        owner = np.repeat(np.arange(len(ours)), np.diff(self.blocks.patterns.rows.start))
        forces = np.zeros_like(self.positions)
        np.add.at(forces, self.blocks.patterns.rows.column, np.einsum("bk,bkc->bc", ours[owner], self.blocks.rows[:, :3]))
        return [("multipliers", ours, changed), ("multipliers", forces, twin.forces)]

    def single_points(self, count: int, random: np.random.Generator, length: float) -> Iterator[FloatArray]:
        """Changes of single control points that bear on the contact, `count` on each side."""
        reached = np.unique(self.blocks.patterns.rows.column)
        on_slave = np.isin(reached, self.pair.pair.slave.point)
        size = length * float(np.linalg.norm(np.ptp(self.positions, axis=0)))
        for side in (reached[on_slave], reached[~on_slave]):
            for point in random.choice(side, min(count, side.size)) if side.size else ():
                along = np.zeros_like(self.positions)
                along[point] = size * random.standard_normal(3)
                yield along


def row_product(pattern: Pattern, rows: FloatArray, along: FloatArray) -> FloatArray:
    """Products of constraint rows, shape (blocks, kinds, 3), with a field, shape (constraints, kinds)."""
    products = np.zeros((len(pattern.start) - 1, rows.shape[1]))
    owner = np.repeat(np.arange(len(products)), np.diff(pattern.start))
    np.add.at(products, owner, np.einsum("bkc,bc->bk", rows, along[pattern.column]))
    return products


def _sample(
    equilibrium: Equilibrium, visit: Visit, pairs: list[PairState], directions: int, random: np.random.Generator, length: float
) -> Iterator[Sample]:
    """Products of all parts at one state with random directions."""
    _, solid = equilibrium.solid.forces_and_tangent(visit.positions)
    fields = length * equilibrium.numbering.size * random.standard_normal((directions, *visit.positions.shape))
    ours, twin = block_product(equilibrium.solid.pattern, solid, fields[0]), solid_twin(equilibrium, visit.positions, fields[0])
    yield "solid", ours, twin
    for field in fields if equilibrium.problem.loads else ():
        yield "loads", *load_changes(equilibrium, visit, field)
    loads, exact = load_changes(equilibrium, visit, fields[0])
    ours, twin = ours + loads, twin + exact
    linear = [PairTangent(pair.pair, visit.positions, pair.visit) for pair in pairs if np.any(pair.response.state)]
    for pair in pairs:
        if not np.any(pair.response.state):
            twin = twin + pair.twin(fields[0]).forces  # no tangent, so it had better be zero
    for tangent in linear:
        samples, our_forces, twin_forces = tangent.along_positions(fields[0])
        yield from samples
        ours, twin = ours + our_forces, twin + twin_forces
    yield "whole", ours, twin
    for tangent in linear:
        for along in (*fields[1:], *tangent.single_points(directions, random, length)):
            yield from tangent.along_positions(along)[0]
        if tangent.pair.friction.acts:
            yield from tangent.along_multipliers(random, length)
    if not any(tangent.pair.pair.contact.averaged for tangent in linear):  # along an averaged normal pressures are not conservative
        yield _symmetry(equilibrium, solid, linear)


def load_changes(equilibrium: Equilibrium, visit: Visit, along: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Change of what loads leave out of balance, by their tangent and by a central difference, exact of whatever length (theory 5.16)."""
    ours, loads = np.zeros_like(along), equilibrium.loads
    for pattern, values in loads.tangents(visit.positions, visit.time):
        ours -= block_product(pattern, values, along)
    ahead, behind = (loads.forces(visit.positions + way * along, visit.time) for way in (1.0, -1.0))
    return ours, sum((0.5 * (b - a) for a, b in zip(ahead, behind, strict=True)), np.zeros_like(along))


def solid_twin(equilibrium: Equilibrium, positions: FloatArray, along: FloatArray) -> FloatArray:
    """The twin's derivative of all internal forces, shape (control points, 3)."""
    numbering, total = equilibrium.numbering, np.zeros_like(positions)
    for body in equilibrium.problem.deformable:
        of_patch = _twin.solid_difference(
            body_arrays(body), body.material.arrays, numbering.of_patch(body.name, positions), numbering.of_patch(body.name, along)
        )
        numbering.add_of_patch(body.name, of_patch, total)
    return total


def _symmetry(equilibrium: Equilibrium, solid: FloatArray, linear: list[PairTangent]) -> Sample:
    """The frictionless part and its transpose: solid, normal geometric part, and gap rows times their pressures."""
    n = equilibrium.numbering.count
    total = _matrix(equilibrium.solid.pattern, solid, n)
    for tangent in linear:
        total = total + _matrix(tangent.pattern, tangent.normal, n)
        rows, wide = tangent.blocks.patterns.rows, tangent.blocks.patterns.wide
        gap = _matrix(rows, tangent.blocks.rows[:, :1], n)
        pressure = _matrix(wide, np.ascontiguousarray(tangent.blocks.changes[:, :1]), n)
        total = total + gap.T @ pressure
    apart = sparse.coo_array(total - total.T).data
    size = float(np.linalg.norm(total.data))
    return "symmetry", np.array([size + float(np.linalg.norm(apart))]), np.array([size])


def _matrix(pattern: Pattern, blocks: FloatArray, columns: int) -> sparse.csr_array:
    """The sparse matrix of blocks, shape (blocks, m, 3)."""
    rows = (len(pattern.start) - 1) * blocks.shape[1]
    return sparse.csr_array(sparse.bsr_array((blocks, pattern.column, pattern.start), shape=(rows, 3 * columns)))
