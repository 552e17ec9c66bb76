"""One contact pair during a load step: kinematics, response of the augmented law, forces, tangent."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property, partial

import numpy as np

from isomortar import _bindings
from isomortar._bindings import Control, Law, Pattern, Projections, Response
from isomortar._codes import ROW_KINDS, PointState
from isomortar._frozen import frozen
from isomortar.errors import LostProjectionError
from isomortar.geometry.patch import FloatArray, IntArray
from isomortar.model import constants
from isomortar.model.held import held_by, nothing_held
from isomortar.model.moments import moment
from isomortar.model.pairs import Pair
from isomortar.model.settings import SolverSettings
from isomortar.model.supports import BoolArray, Supports
from isomortar.solve.apart import Separation
from isomortar.solve.feet import Feet
from isomortar.solve.metric import median, traction_norms
from isomortar.solve.reach import ContactPatterns, Reach
from isomortar.solve.record import ContactResult, ContactState
from isomortar.solve.scales import Scales
from isomortar.solve.timing import Ledger


@frozen
class Kinematics:
    """A pair at given positions: projections and control quantities."""

    projections: Projections
    control: Control


class PutOff(Kinematics):
    """Those of a pair out of reach, where all points are open: computed when somebody asks."""

    _compute: Callable[[], Kinematics]

    def __init__(self, compute: Callable[[], Kinematics]) -> None:
        object.__setattr__(self, "_compute", compute)

    @cached_property
    def _computed(self) -> Kinematics:
        return self._compute()

    @property
    def projections(self) -> Projections:
        """Where the slave quadrature points stand on the master."""
        return self._computed.projections

    @property
    def control(self) -> Control:
        """Control quantities."""
        return self._computed.control


@frozen
class Blocks:
    """What a second pass gives: rows, derivatives of multipliers and trial tractions, geometric tangent, and their patterns."""

    patterns: ContactPatterns
    rows: FloatArray
    changes: FloatArray
    trial: FloatArray
    geometric: FloatArray


#: Pressures, shape (n,), and tractions, shape (n, 2), of the constraints of a pair.
Multipliers = tuple[FloatArray, FloatArray]


def pressure_share(control: Control, law: Law, response: Response) -> FloatArray:
    """Derivatives of a law's pressures by its multipliers, shape (n,): 1 where contact is sharp and closed (theory 4.3, 4.18)."""
    if law.smoothing == 0.0:
        return (response.state > 0).astype(np.float64)
    return response.pressure_slope * control.weight / law.penalties[0]


class PairMechanics:
    """A contact pair with what stays for a whole computation.

    Attributes
    ----------
    shared : ndarray of bool, shape (test functions,)
        Those that constrain control points of the slave of another pair as well.
    """

    def __init__(self, pair: Pair, settings: SolverSettings, ledger: Ledger, origin: FloatArray, others: Sequence[Pair]) -> None:
        self.pair = pair
        self._feet = Feet(pair, origin)
        self._separation = Separation(pair)
        self._near: Projections | None = None  # feet of the last positions in the increment where something touched
        self.friction = pair.contact.friction_law
        self.summed = settings.slip_sum == "paper" and self.friction.acts
        self.reach = Reach(pair, self.summed, settings.method == "uzawa")
        n = pair.slave.test.count
        self.diagonal = Pattern(np.arange(n + 1, dtype=np.int32), np.arange(n, dtype=np.int32))
        self.held = nothing_held(pair)
        self.elastic = pair.contact.elastic_slip > 0.0
        self._stretch = np.zeros((n, 2)) if self.elastic else None
        theirs = [point for other in others for point in other.slave.point]
        self.shared = pair.some_carriers(np.isin(np.arange(pair.slave.highest + 1), theirs))
        self._ledger = ledger
        kinds = "frictionless" if not self.friction.acts else ("paper" if self.summed else "local")
        self._kinds = ROW_KINDS[kinds + ", averaged" * pair.contact.averaged]

    @property
    def penalty_area(self) -> float:
        """Area that the penalties are divided by (theory 7.1)."""
        return self.pair.contact.reference_area or self.pair.area

    def begin(self, supports: Supports, start: FloatArray, begun: ContactState, time: float) -> None:
        """Begin a load increment from positions `start` with state `begun` to a load time."""
        self._near = None
        self.reach.begin()
        self.held = held_by(supports, self.pair, start, time)
        self._separation.begin(start, bool(np.any(begun.pressure != 0.0)))
        if self.elastic:
            self._stretch = self._stretched(self.kinematics(start, begun).control, begun)

    def _stretched(self, control: Control, begun: ContactState) -> FloatArray:
        """Stretches that make the tractions of a converged state, shape (n, 2) (theory 4.16)."""
        borne = self.radius(begun.pressure)
        borne = np.where(borne > 0.0, borne, 1.0)  # open ones have no traction
        left = np.maximum(1.0 - traction_norms(control, begun.traction) / borne, 0.0)
        return np.ascontiguousarray(begun.traction / (borne * (1.0 + np.sqrt(left)))[:, None])

    def initial(self, positions: FloatArray) -> ContactState:
        """State before the first load step: no tractions; slips count from where the reference configuration projects (theory 3.20)."""
        n, q = self.pair.slave.test.count, len(self.pair.slave.area)
        nowhere = ContactState(np.zeros(n), np.zeros((n, 2)), np.zeros((q, 2)), np.zeros(q, dtype=np.int32))
        projections = self.kinematics(positions, nowhere).projections
        return replace(nowhere, projection=projections.xi, projected=projections.followed)

    def kinematics(self, positions: FloatArray, start: ContactState) -> Kinematics:
        """Project and integrate the control quantities; slips count from `start`. What is out of reach is put off.

        The nearest point is searched for from the last one in the increment where something touched, which saves half of the search. Feet
        along averaged normals are followed from `start`: they are several, and an iterate that goes astray must not lead to another one.

        Raises
        ------
        LostProjectionError
            A point has passed through its master, or the master has no normal there.
        """
        compute = partial(self._kinematics, positions, start)
        return PutOff(compute) if self._separation.holds(positions) else compute()

    def _kinematics(self, positions: FloatArray, start: ContactState) -> Kinematics:
        """The same, now."""
        pair, counts = self.pair, self._ledger.work
        with self._ledger.phase("projection"):
            try:
                projections = _bindings.project_points(
                    pair.slave, pair.master, positions, start.projection, start.projected, self.friction.acts, counts, self._near
                )
            except LostProjectionError as error:
                raise self._feet.named(error, positions) from error
        with self._ledger.phase("contact"):
            control = _bindings.control_quantities(pair.slave, pair.master, positions, projections, self.friction.acts, counts)
        if np.any(control.gap > 0.0) and not pair.contact.averaged:  # never out of reach: what is put off changes no bit
            self._near = projections
        return Kinematics(projections, self.held.mirrored(control))

    def rests(self, kinematics: Kinematics, pressure: FloatArray, traction: FloatArray) -> bool:
        """Whether all is open and stays so without a look at the kinematics: it is out of reach, and has no multipliers."""
        return isinstance(kinematics, PutOff) and not (np.any(pressure != 0.0) or np.any(traction != 0.0))

    def stiffness(self, scales: Scales) -> float:
        """Largest diagonal entry of the tangents of the pair's bodies, all as soft as the softest (theory 5.7), force per length.

        Parameters taken from a stiffer body fail at stiffness ratios of 1e5.
        """
        return float(np.max(scales.stiffness[self.pair.pieces] * self.pair.softest))

    def parameters(self, control: Control, scales: Scales) -> FloatArray:
        """Complementarity parameters, normal and tangential (theory 6.1): stiffness / median of w^I and a multiple of it."""
        present = control.weight[control.weight > 0]
        normal = self.stiffness(scales) / (median(present) if present.size else self.pair.area)
        return np.array([normal, constants.TANGENTIAL_FACTOR * normal])

    def law(self, penalties: FloatArray, pressure: FloatArray, traction: FloatArray) -> Law:
        """The augmented law with given penalties (normal, tangential) and multipliers."""
        sticks = np.zeros(len(pressure), dtype=np.int32)
        return Law(
            penalties, self.friction, pressure, traction, self.summed, self.held.bears, self.held.free, sticks,
            elastic_slip=self.pair.contact.elastic_slip, stretch=self._stretch, smoothing=self.pair.contact.smoothing,
        )  # fmt: skip

    def bear(self, kinematics: Kinematics) -> bool:
        """Let constraints that supports hold along the normal bear if they are inside the master (theory 4.11); whether there are any."""
        if isinstance(kinematics, PutOff):
            return False
        depth = constants.SUNK * np.sqrt(self.pair.area)
        alone = (self.held.bears == 0) & ~self.held.idle & (kinematics.control.weight > 0)
        sunk = alone & (kinematics.control.gap > depth * kinematics.control.weight)
        self.held.bears[sunk] = 1
        return bool(sunk.any())

    def sliding(self, start: ContactState) -> FloatArray:
        """Tractions of the last converged state, with those of sliding where supports push (theory 4.12); shape (n, 2)."""
        pushed = np.any(self.held.pushed != 0.0, axis=1)
        return np.where(pushed[:, None], self.radius(start.pressure)[:, None] * self.held.pushed, start.traction)

    def resting(self, start: ContactState, kinematics: Kinematics, pressure: FloatArray, traction: FloatArray) -> FloatArray:
        """The tractions, where supports keep control points still those of `start` as far as friction bears them (theory 4.12); (n, 2).

        Nothing else tells them there, but elastic slips do: a pressure that was too low for an iteration would lower them for good.
        """
        still = self.held.still > 0
        if self.elastic or not still.any():
            return traction
        length, borne = traction_norms(kinematics.control, start.traction), self.radius(pressure)
        share = np.divide(borne, length, out=np.ones_like(length), where=length > borne)
        return np.where(still[:, None], share[:, None] * start.traction, traction)

    def radius(self, pressure: FloatArray) -> FloatArray:
        """Largest norms of control tractions under control pressures, 0 where open, shape (n,) (theory 4.6)."""
        return _bindings.friction_radius(self.friction, pressure)

    def respond(self, kinematics: Kinematics, law: Law) -> Response:
        """Multipliers and states of the law."""
        if self.rests(kinematics, law.pressure, law.traction):
            n, q = self.pair.slave.test.count, len(self.pair.slave.area)
            states = np.full(n, PointState.OPEN, dtype=np.int32)
            return Response(np.zeros(n), np.zeros((n, 2)), states, np.zeros(n), np.zeros((n, 6, 2)), np.zeros((q, 2)))
        with self._ledger.phase("contact"):
            return _bindings.augmented_multipliers(self.pair.slave, kinematics.control, law)

    def add_forces(self, positions: FloatArray, kinematics: Kinematics, response: Response, forces: FloatArray) -> None:
        """Add the contact forces of both sides to `forces`, shape (control points, 3).

        Raises
        ------
        LostProjectionError
            Contact acts at a point whose foot does not follow it.
        """
        if not np.any(response.state):
            return
        self._feet.check(positions, kinematics.projections, response)
        with self._ledger.phase("contact"):
            _bindings.contact_forces(
                self.pair.slave, self.pair.master, positions, kinematics.projections, response, forces, self.friction.acts,
                self._ledger.work,
            )  # fmt: skip

    def bearing(self, state: ContactState) -> Response:
        """What the multipliers of a state are as a response, good for forces alone."""
        n, q = self.pair.slave.test.count, len(self.pair.slave.area)
        acts = (state.pressure != 0.0) | np.any(state.traction != 0.0, axis=1)
        states = np.where(acts, PointState.STICK, PointState.OPEN).astype(np.int32)
        return Response(state.pressure, state.traction, states, np.zeros(n), np.zeros((n, 6, 2)), np.zeros((q, 2)))

    def blocks(self, positions: FloatArray, kinematics: Kinematics, law: Law, response: Response) -> Blocks:
        """Constraint rows, derivatives of the multipliers and the geometric tangent."""
        patterns = self.reach.update(kinematics.projections, response.state)
        rows = np.zeros((len(patterns.rows.column), self._kinds, 3))
        geometric = np.zeros((len(patterns.tangent.column), 3, 3))
        with self._ledger.phase("contact"):
            _bindings.contact_blocks(
                self.pair.slave, self.pair.master, positions, kinematics.projections, self.friction.acts, response,
                patterns.rows, rows, patterns.tangent, geometric, self._ledger.work,
            )  # fmt: skip
            if self.friction.acts:
                self.held.mirror(rows, patterns.rows)
            changes, trial = _bindings.multiplier_rows(
                self.pair.slave, kinematics.control, law, response, patterns.rows, rows, self.pair.neighbours, patterns.wide
            )
        self._ledger.counts["contact tangents"] += 1
        return Blocks(patterns, rows, changes, trial, geometric)

    def loose(self, found: IntArray) -> BoolArray:
        """Multipliers whose conditions may repeat others where they are active, shape (constraints, 3) (theory 6.4).

        `found`: 0 of slave quadrature points without a foot.

        Control points of two contacts have six conditions for three components, of which the pressures are not too many; where supports
        have moved them along a plane slips are given, and where these have them just touch one they leave nothing to a pressure; and of
        elements that reach over an edge of the master there may be more than points on it.
        """
        nodes = self.pair.slave.test.nodes
        given = self.shared | self.held.moved
        loose: BoolArray = np.column_stack([self.held.rests, given, given])
        loose[nodes[np.any(found.reshape(len(nodes), -1) == 0, axis=1)]] = True
        if self.elastic:  # these tractions are told by their slips
            loose[:, 1:] = False
        return loose

    def condensed(self, response: Response, blocks: Blocks) -> tuple[Pattern, FloatArray]:
        """The contact tangent with the multipliers eliminated."""
        tangent = blocks.geometric.copy()
        with self._ledger.phase("contact"):
            _bindings.condense_multipliers(
                response.state, blocks.patterns.rows, blocks.rows, blocks.patterns.wide, blocks.changes, blocks.patterns.tangent, tangent
            )
        return blocks.patterns.tangent, tangent

    def work(self, start: FloatArray, begun: ContactState, positions: FloatArray, kinematics: Kinematics, response: Response) -> FloatArray:
        """What friction, and pressures along averaged normals, took up within a load increment, shape (2,) (theory 3.31).

        From positions `start` with state `begun` to `positions`. A slave climbs out of its own dent in the surface at the end alone, and
        into it in that at the start: of both together no work is left.
        """
        acts = response.state > 0
        if not (acts.any() or np.any(begun.pressure != 0.0)):
            return np.zeros(2)
        friction = float(np.sum(response.traction[acts] * kinematics.control.slip[acts]))
        if not self.pair.contact.averaged:
            return np.array([friction, 0.0])
        slave, master = self.pair.slave, self.pair.master
        pressure = 0.5 * self.pair.field(begun.pressure + np.where(acts, response.pressure, 0.0))
        with self._ledger.phase("contact"):
            ends = [_bindings.find_climbs(slave, master, place, kinematics.projections, self._ledger.work) for place in (start, positions)]
        return np.array([friction, -float(np.sum(slave.area * pressure * 0.5 * (ends[0] + ends[1])))])

    def result(self, positions: FloatArray, kinematics: Kinematics, response: Response, work: FloatArray) -> ContactResult:
        """Measured quantities at the end of a load step (theory 8.2), and the work of its increments."""
        control, projections = kinematics.control, kinematics.projections
        slave_forces, forces = np.zeros_like(positions), np.zeros_like(positions)
        self.add_forces(positions, kinematics, response, forces)
        forces = 0.0 - forces  # those that act on the bodies; what balances them is in the residual
        slave_forces[self.pair.slave.point] = forces[self.pair.slave.point]
        master_forces = forces - slave_forces
        field = self.pair.field(response.pressure)[projections.found > 0]
        present = control.weight > 0  # with functions of both signs what is left of a weight may be negative
        return ContactResult(
            force_slave=slave_forces.sum(axis=0),
            force_master=master_forces.sum(axis=0),
            moment_slave=moment(positions, slave_forces),
            moment_master=moment(positions, master_forces),
            active=int(np.count_nonzero(response.state)),
            slip=int(np.count_nonzero(response.state == PointState.SLIP)),
            traction_norm=traction_norms(control, response.traction),
            status=response.state,
            gap=np.where(present, control.gap, 0.0) / np.where(present, control.weight, 1.0),
            pressure_field=np.array([field.min(), field.max()]) if field.size else np.zeros(2),
            excluded=int(np.count_nonzero(projections.found == 0)),
            friction_work=float(work[0]),
            spurious_work=float(work[1]),
        )

    def state(self, kinematics: Kinematics, response: Response) -> ContactState:
        """State to go on from."""
        projections = kinematics.projections
        return ContactState(response.pressure, response.traction, projections.xi, projections.followed)
