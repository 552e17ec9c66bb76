"""What supports hold inside a rigid body: it cannot give way, and forces there are those of the mesh alone."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from isomortar import _bindings
from isomortar._bindings import SlaveArrays
from isomortar.geometry.patch import Direction, FloatArray
from isomortar.model.constants import CLEAR, NO_PART
from isomortar.model.enforcement.face import SlaveFace, grid
from isomortar.model.entities import Contact, Face, Problem
from isomortar.model.sheet import Sheet
from isomortar.solve.equilibrium import Balance, Equilibrium

#: Depth over the size of the body that is held from which it is told: a drum that is pressed onto the held edge of a block by as little as
#: this already bears there, and by more the finer the mesh; what only touches is within round-off of it.
INSIDE = 1e-4


class HeldInside:
    """Warnings of contacts between a rigid body and one that is held where they meet; each is given once.

    Of rigid planes the ways of supports tell before a run.
    """

    def __init__(self, equilibrium: Equilibrium) -> None:
        self._equilibrium, problem = equilibrium, equilibrium.problem
        self._watched = {number: turned for number, contact in enumerate(problem.contacts) if (turned := _soft_first(problem, contact))}

    def after_stage(self, balance: Balance, step: int) -> Iterator[str]:
        """Warnings that the end of a stage gives rise to."""
        for number, contact in list(self._watched.items()):
            if not np.any(balance.responses[number].pressure > 0.0):
                continue
            count, depth = held_inside(self._equilibrium, contact, balance.positions)
            problem = self._equilibrium.problem
            if depth > INSIDE * Sheet.of(problem, contact.slave).size:
                del self._watched[number]
                yield _sentence(problem, contact, count, depth, step)


def held_inside(equilibrium: Equilibrium, contact: Contact, positions: FloatArray) -> tuple[int, float]:
    """How many places of a slave's face supports hold inside its rigid master, and how deep at the most.

    Places are ends and middles of its elements, held where all that moves them along the master's normal is.
    """
    problem, numbering, held = equilibrium.problem, equilibrium.numbering, equilibrium.supports.held
    face = SlaveFace(contact, problem, numbering)
    if not np.any(held[face.point]):
        return 0, 0.0
    nodes, values, _ = face.at(grid(*(_places(direction) for direction in face.directions)))
    fixed = np.all(held[face.point[nodes]] | (np.abs(values) <= CLEAR)[..., None], axis=1)
    nodes, values, fixed = nodes[some := fixed.any(axis=1)], values[some], fixed[some]
    if not len(fixed):
        return 0, 0.0
    places = np.einsum("qa,qai->qi", values, positions[face.point[nodes]])
    depths, normals = _depths(equilibrium, face, positions, places)
    across = np.abs(normals) > NO_PART * np.linalg.norm(normals, axis=1, keepdims=True)
    depths = np.where(np.all(fixed | ~across, axis=1), depths, 0.0)
    return int(np.count_nonzero(depths > 0.0)), float(depths.max(initial=0.0))


def _depths(equilibrium: Equilibrium, face: SlaveFace, positions: FloatArray, places: FloatArray) -> tuple[FloatArray, FloatArray]:
    """How deep places are in the master of a contact, shape (places,), 0 beside it, and the master's normals there, of any length."""
    problem, master = equilibrium.problem, face.contact.master
    assert isinstance(master, Face), "planes are told otherwise"
    assert face.master is not None
    slave = SlaveArrays.of_points(np.arange(len(positions), len(positions) + len(places), dtype=np.int32))
    everywhere = np.vstack([positions, places])
    feet = _bindings.project_points(slave, face.master, everywhere, np.zeros((len(places), 2)), np.zeros(len(places), np.int32))
    gaps = _bindings.control_quantities(slave, face.master, everywhere, feet).gap
    sheet = Sheet.of(problem, master)
    points, functions = _bindings.surface_functions(face.master.patch, face.master.axis, face.master.side, feet.xi)
    of_master = positions[sheet.points(equilibrium.numbering)[sheet.patch.face_points(sheet.face)][points]]
    return np.where(feet.found > 0, gaps, 0.0), np.cross(*np.einsum("qda,qai->dqi", functions[:, 1:3], of_master))


def _places(direction: Direction) -> FloatArray:
    """Ends and middles of the elements along a direction."""
    ends = direction.boundaries
    return np.union1d(ends, 0.5 * (ends[1:] + ends[:-1]))


def _soft_first(problem: Problem, contact: Contact) -> Contact | None:
    """A contact of a body with a rigid one, that as the master, by closest points; None of others."""
    if not isinstance(contact.master, Face):
        return None
    slave, master = (Sheet.of(problem, side).rigid for side in (contact.slave, contact.master))
    if slave == master:
        return None
    sides = (contact.master, contact.slave) if slave else (contact.slave, contact.master)
    return replace(contact, slave=sides[0], master=sides[1], projection="closest")


def _sentence(problem: Problem, contact: Contact, count: int, depth: float, step: int) -> str:
    """The sentence."""
    assert isinstance(contact.master, Face)
    stage = problem.stages[problem.stage_of(step)].name
    return (
        f"contact {contact.name!r}: supports hold {count} places of {contact.slave.words} inside the rigid {contact.master.words}, by "
        f"{depth:.3g} at the end of stage {stage!r}, and those cannot give way: forces there are larger the finer the mesh is. Hold fewer "
        "components, or end the motion before it meets what is held"
    )
