"""The spline surface: closest points on a smooth surface whose control points are sums of a linear master's nodes (theory 10.16)."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import replace
from functools import partial
from typing import Any
from unittest.mock import patch

import numpy as np
from patch_tests.contact import default_rule, errors, pressure_limit, problem
from scipy import sparse

from isomortar._bindings import Law, Pattern, Response
from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.harness import Bound, Shown, case
from isomortar.march.simulation import Simulation
from isomortar.model.enforcement.integration import integrated
from isomortar.model.entities import Body, Face, Problem
from isomortar.model.numbering import Numbering
from isomortar.model.pairs import Pair
from isomortar.model.pattern import pattern_of
from isomortar.model.sheet import Sheet
from isomortar.model.supports import Supports
from isomortar.scene import Scene
from isomortar.solve import equilibrium
from isomortar.solve.contact import Blocks, Kinematics, PairMechanics
from isomortar.solve.reach import ContactPatterns
from isomortar.solve.record import ContactState, StepResult

#: The body that stands for the surface; it has no material, and its control points go where the nodes have them.
_SURFACE = "surface"
#: Sums of nodes for the second control point of a line, and for those further in.
_BESIDE, _WITHIN = np.array([3.0, 6.0, -1.0]) / 8.0, np.array([-1.0, 7.0, 7.0, -1.0]) / 12.0


def line(elements: int) -> FloatArray:
    """Control points of order 2 as sums of the nodes of even linear elements, shape (elements + 2, elements + 1) (theory 10.16)."""
    sums = np.zeros((elements + 2, elements + 1))
    sums[0, 0] = sums[-1, -1] = 1.0
    sums[1, :3], sums[-2, -3:] = _BESIDE, _BESIDE[::-1]
    for k in range(2, elements):
        sums[k, k - 2 : k + 2] = _WITHIN
    return sums


def with_surface(given: Problem) -> tuple[Problem, sparse.csr_array]:
    """A problem whose contact has the spline surface of its master in place of that, and all control points as sums of the nodes.

    Nodes of elements of order 2 are taken for those of linear ones.
    """
    (contact,) = given.contacts
    assert isinstance(contact.master, Face)
    sheet = Sheet.of(given, contact.master)
    u, v = (line(direction.count - 1) for direction in sheet.directions)
    sums = sparse.csr_array(sparse.kron(sparse.eye_array(2), sparse.kron(v, u)))
    smooth = [Direction("N", 2, np.pad(np.linspace(0.0, 1.0, direction.count), 2, mode="edge")) for direction in sheet.directions]
    shape = Patch((smooth[0], smooth[1], sheet.patch.directions[2]), sums @ sheet.patch.control_points, np.ones(sums.shape[0]))
    surface = Body(_SURFACE, shape, given.bodies[0].material, (1, 1, 1), rigid=True)
    extended = replace(
        given, bodies=(*given.bodies, surface), contacts=(replace(contact, master=Face(_SURFACE, sheet.face), projection="closest"),)
    )
    numbering = Numbering(extended)
    own, nodes = numbering.points[_SURFACE], sheet.points(Numbering(given))
    entries = sparse.coo_array(sums)
    others = np.setdiff1d(np.arange(numbering.count), own)
    rows, columns = np.r_[others, own[entries.coords[0]]], np.r_[others, nodes[entries.coords[1]]]
    whole = sparse.csr_array((np.r_[np.ones(len(others)), entries.data], (rows, columns)), shape=(numbering.count,) * 2)
    return extended, whole


class OnSpline(PairMechanics):
    """A pair whose master's control points are sums of others; the forces and the tangent are those of the others."""

    def __init__(self, sums: sparse.csr_array, pair: Pair, *others: Any) -> None:
        pair.rigid_master = False
        super().__init__(pair, *others)
        self._sums = sums
        self._expanded = sparse.bsr_array((sums.data[:, None, None] * np.eye(3), sums.indices, sums.indptr))
        self._patterns: tuple[ContactPatterns, ContactPatterns] | None = None

    def begin(self, supports: Supports, start: FloatArray, begun: ContactState, time: float) -> None:
        """As of any pair."""
        super().begin(supports, self._sums @ start, begun, time)

    def kinematics(self, positions: FloatArray, start: ContactState) -> Kinematics:
        """As of any pair."""
        return super().kinematics(self._sums @ positions, start)

    def add_forces(self, positions: FloatArray, kinematics: Kinematics, response: Response, forces: FloatArray) -> None:
        """As of any pair."""
        own = np.zeros_like(forces)
        super().add_forces(self._sums @ positions, kinematics, response, own)
        forces += self._sums.T @ own

    def blocks(self, positions: FloatArray, kinematics: Kinematics, law: Law, response: Response) -> Blocks:
        """Rows and geometric tangent by the nodes."""
        own = super().blocks(self._sums @ positions, kinematics, law, response)
        rows, changes, trial = (self._by_nodes(own.patterns.rows, values) for values in (own.rows, own.changes, own.trial))
        geometric = self._expanded.T @ self._by_nodes(own.patterns.tangent, own.geometric)
        return Blocks(self._patterns_by_nodes(own.patterns), *map(_values, (rows, changes, trial, geometric)))

    def _by_nodes(self, pattern: Pattern, values: FloatArray) -> sparse.bsr_array:
        """Blocks with columns of nodes."""
        shape = (len(pattern.start) - 1) * values.shape[1], self._expanded.shape[0]
        return sparse.bsr_array((values, pattern.column, pattern.start), shape=shape) @ self._expanded

    def _patterns_by_nodes(self, own: ContactPatterns) -> ContactPatterns:
        """The same ones as long as those of the surface stand."""
        if self._patterns is None or self._patterns[0] is not own:
            sums = sparse.csr_array(self._sums != 0.0, dtype=np.int32)
            rows, wide, tangent = (
                sparse.csr_array((np.ones_like(p.column), p.column, p.start), shape=(len(p.start) - 1, sums.shape[0])) @ sums
                for p in (own.rows, own.wide, own.tangent)
            )
            self._patterns = own, ContactPatterns(pattern_of(rows), pattern_of(wide), pattern_of(sums.T.tocsr() @ tangent))
        return self._patterns[1]


def _values(blocks: sparse.bsr_array) -> FloatArray:
    """Blocks in the order of a pattern, shape (blocks, rows, columns)."""
    blocks.sort_indices()
    return np.ascontiguousarray(blocks.data)


@contextmanager
def on_spline(given: Problem) -> Iterator[Problem]:
    """The problem with the spline surface of its master; what is computed inside takes it as such."""
    extended, sums = with_surface(given)
    with patch.object(equilibrium, "PairMechanics", partial(OnSpline, sums)):
        yield extended


#: Master elements on the three of the slave.
ELEMENTS = (4, 5, 7)
_IN_CELLS = Bound(at_most=1e-10, reason="round-off: every integral is exact; Newton's 1e-13 times the condition of the bases")


def shrinking(elements: int, integration: str, order: int) -> Problem:
    """The patch test of order 2 on a master of Lagrange elements, in whole elements or by what the program chooses."""
    given = problem(2, order, 0.0, default_rule(2)[0], elements, "L" if order > 1 else "N")
    return replace(given, contacts=(integrated(given.contacts[0], given),)) if integration == "cells" else given


def smooth_errors(given: Problem) -> float:
    """Of the patch test on the spline surface."""
    with on_spline(given) as smooth:
        return errors(smooth).field


@case(
    claim="A uniform pressure passes the spline surface of linear elements, to its rim, as it passes order 2; in cells to round-off.",
    tier="nightly",
    grid={"elements": ELEMENTS, "integration": ("whole", "cells")},
    bounds=lambda elements, integration: {
        "spline": _IN_CELLS
        if integration == "cells"
        else Bound(
            at_most=pressure_limit(2, 2, elements, default_rule(2)[0]),
            reason="quadrature: error of the load of order 2 on these elements, times the norm of the loads' inverse",
        ),
        "elements": _IN_CELLS if integration == "cells" else Shown("quadrature: slopes jump inside the slave's elements"),
    },
)
def spline_patch(elements: int, integration: str) -> dict[str, float]:
    """Largest relative errors of the pressure field."""
    given = shrinking(elements, integration, 1)
    return {"elements": errors(given).field, "spline": smooth_errors(given)}


@case(
    claim="With elements of order 2 the same sums of nodes fail the patch test.",
    tier="gate",
    bounds={
        "pressure": Bound(at_least=1e-2, reason="theory: a uniform pressure loads their nodes in turns, and those of linear ones alike")
    },
)
def spline_of_quadratic() -> dict[str, float]:
    """Largest relative error of the pressure field, in cells."""
    return {"pressure": smooth_errors(shrinking(2, "cells", 2))}


#: Scenes with fewer load steps and what is looked at in them: force on the support that moves, or its moment.
SCENES: dict[str, tuple[tuple[str, ...], str, int]] = {
    "block": ((), "force", 0),
    "twist": (("stages.press.steps=5", "stages.twist.steps=20"), "moment", 2),
    "iron": (("stages.press.steps=5", "stages.drag.steps=20"), "force", 0),
}
_COUNTERS = {"tangents": "factorisations", "solves": "solves"}
#: Surfaces of a master: of linear elements by normals or by sums of nodes, and of as many elements of order 2.
SURFACES = ("averaged", "spline", "order 2")


def with_master(kind: str, scene: str) -> Problem:
    """A scene with a master of ``L1`` elements, or of ``N2`` or ``N3``, as many."""
    mesh = (f"family={kind[0]}", f"order={[int(kind[1])] * 3}")
    changes = (*SCENES[scene][0], *(f"bodies.master.mesh.{change}" for change in mesh), "contacts.interface.projection=closest")
    return Scene.load(scene, list(changes)).problem()


def slid(given: Problem, scene: str) -> tuple[list[StepResult], FloatArray]:
    """Load steps, and of those in the last three quarters of the last stage what is looked at and the normal force, shape (steps, 2)."""
    _, kind, component = SCENES[scene]
    results = list(Simulation(given).run())
    moving = next(k for k, support in enumerate(given.supports) if support.moves)
    reactions = [result.reactions[moving] for result in results[-(3 * given.stages[-1].steps) // 4 :]]
    return results, np.array([[getattr(reaction, kind)[component], reaction.force[2]] for reaction in reactions])


@case(
    claim="On the spline surface of linear elements every load step converges, without spurious work; how far forces are off is shown.",
    tier="nightly",
    grid={"surface": SURFACES, "scene": tuple(SCENES)},
    bounds=lambda surface, scene: {  # noqa: ARG005
        "missing": Bound(at_most=0.0, reason="definition: load steps that are not there were not computed"),
        "force": Shown("discretisation: mean normal force, off that on elements of order 3"),
        "along": Shown("discretisation: mean force or moment of sliding, likewise"),
        "rough": Shown("discretisation: root mean square second difference of that over its mean"),
        "spurious": Shown("discretisation: work of pressures along averaged normals over friction work")
        if surface == "averaged"
        else Bound(at_most=0.0, reason="theory: feet are closest points"),
        "tangents": Shown("definition: factorised in all load steps"),
        "solves": Shown("definition: of all load steps"),
        "cuts": Shown("definition: of load increments"),
    },
)
def spline_scenes(surface: str, scene: str) -> dict[str, float]:
    """Means, roughness and cost of a scene, by surface of its master."""
    given = with_master("N2" if surface == "order 2" else "L1", scene)
    if surface == "averaged":
        given = replace(given, contacts=(replace(given.contacts[0], projection="averaged"),))
    with on_spline(given) if surface == "spline" else nullcontext(given) as taken:
        results, curves = slid(taken, scene)
    means, expected = (found.mean(axis=0) for found in (curves, slid(with_master("N3", scene), scene)[1]))
    along, force = np.abs(means / expected - 1.0)
    works = np.array([[result.contacts[0].friction_work, result.contacts[0].spurious_work] for result in results]).sum(axis=0)
    return {
        "missing": float(given.total_steps - len(results)),
        "force": float(force),
        "along": float(along),
        "rough": float(np.sqrt((np.diff(curves[:, 0], 2) ** 2).mean()) / abs(means[0])),
        "spurious": float(works[1] / works[0]),
        **{name: float(sum(result.counters[counter] for result in results)) for name, counter in _COUNTERS.items()},
        "cuts": float(sum(result.cuts for result in results)),
    }
