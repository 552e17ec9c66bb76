"""How bodies give way on both sides of a contact: (1 - nu^2) / E, at its points."""

from __future__ import annotations

import numpy as np

from isomortar._bindings import Projections, surface_functions
from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Body, Face, Problem
from isomortar.model.numbering import Numbering
from isomortar.model.pairs import Pair
from isomortar.model.sheet import Sheet


def softness(problem: Problem, numbering: Numbering, pair: Pair, projections: Projections) -> tuple[FloatArray, FloatArray]:
    """That of slave and master at the slave's quadrature points, shapes (points,), where several are joined of the body that is there.

    Zero of what is rigid, and of masters beside which a point is.
    """
    soft = np.zeros(numbering.count)
    for body in problem.bodies:
        soft[numbering.points[body.name]] = _soft(body)
    shape = pair.slave.shape
    nodes = np.repeat(shape.nodes, pair.slave.per_element, axis=0)
    of_slave = np.einsum("qa,qa->q", shape.values, soft[pair.slave.point[nodes]])
    of_master = np.zeros(len(of_slave))
    if isinstance(pair.contact.master, Face):
        sheet = Sheet.of(problem, pair.contact.master)
        feet = np.flatnonzero(projections.found > 0)
        nodes, functions = surface_functions(*sheet.arrays(numbering), projections.xi[feet])
        of_master[feet] = np.einsum("qa,qa->q", functions[:, 0], soft[pair.master_face[nodes]])
    return of_slave, of_master


def _soft(body: Body) -> float:
    return 0.0 if body.rigid else (1.0 - body.material.poisson**2) / body.material.young
