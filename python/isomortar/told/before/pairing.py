"""What is doubtful of how a slave and a master are paired: which is stiffer, and finer; how their feet are found."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from isomortar.model.entities import Contact, Face, Problem, RigidPlane
from isomortar.model.ratios import times
from isomortar.model.sheet import Sheet
from isomortar.solve.contact import PairMechanics
from isomortar.told.before.dents import AT_POINTS, of_dents

#: A slave this many times stiffer than its master, and finer, has nearly redundant constraints (theory 6).
STIFFER = 10.0
#: Quadrature points are to be no farther apart than elements of the master are long; by this factor, for round-off.
ENOUGH = 0.99


def of_pairing(problem: Problem, pairs: Sequence[PairMechanics]) -> Iterator[str]:
    """Warnings that are due before the first load step."""
    for contact, pair in zip(problem.contacts, pairs, strict=True):
        if isinstance(contact.master, RigidPlane):
            continue
        slave, master = Sheet.of(problem, contact.slave), Sheet.of(problem, contact.master)
        stiffer = _softest(slave) / max(body.modulus for body in master.bodies)
        elements = np.prod(pair.pair.master_elements)
        master_area = _area(master.patch.control_points[master.patch.face_points(master.face)])
        finer = (master_area / elements) / (pair.pair.area / pair.pair.slave.elements)
        if stiffer > STIFFER and finer > 1.0:
            how = "rigid" if slave.rigid else f"{times(stiffer)} times stiffer"
            yield (
                f"contact {contact.name!r}: the slave {contact.slave.body!r} is {how} and its elements "
                f"are {times(finer)} times smaller than the master's; control pressures may be far off. Swap slave and master, or refine "
                "the master"
            )
    for contact in problem.contacts:
        yield from few_points(problem, contact)
        yield from of_dents(problem, contact)
        yield from by_default(contact)


def by_default(contact: Contact) -> Iterator[str]:
    """Averaged normals that nobody asked for."""
    if contact.by_default and isinstance(contact.master, Face):
        yield (
            f"contact {contact.name!r}: the master {contact.master.words} has C0 lines, which are kinks once it "
            f'deforms: feet are found along averaged normals. contacts.{contact.name}.projection = "averaged" says that this is meant, '
            '"closest" takes closest points'
        )


def few_points(problem: Problem, contact: Contact) -> Iterator[str]:
    """Slaves whose quadrature points are farther apart than their master's elements are long: some of these bear nothing (theory 9.5)."""
    if isinstance(contact.master, RigidPlane) or contact.enforcement in AT_POINTS:
        return
    slave, master = Sheet.of(problem, contact.slave), Sheet.of(problem, contact.master)
    apart = slave.element_size / (2**contact.subcells * np.sqrt(np.prod(contact.quadrature)))
    share = float(master.element_size / apart)
    if share < ENOUGH and max(body.modulus for body in slave.bodies) >= _softest(master):
        needed = [int(np.ceil(2.0 * points / share)) for points in contact.quadrature]
        yield (
            f"contact {contact.name!r}: quadrature points of the slave are {1.0 / share:.3g} elements of its softer or equal master apart, "
            f"which dents between them. Swap slave and master, refine the slave, or take contacts.{contact.name}.quadrature = {needed}"
        )


def _softest(sheet: Sheet) -> float:
    """Modulus of the softest of a sheet's bodies."""
    return min(body.modulus for body in sheet.bodies)


def _area(points: np.ndarray) -> float:
    """Rough area of a face: product of the two largest extents of its control points."""
    return float(np.prod(np.sort(np.ptp(points, axis=0))[1:]))
