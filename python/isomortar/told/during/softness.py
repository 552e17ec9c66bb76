"""How bodies give way on both sides of a contact, at its points: as deep ones do, (1 - nu^2) / E, and as layers on what holds them."""

from __future__ import annotations

import numpy as np

from isomortar._bindings import Projections, surface_functions
from isomortar.geometry.patch import FloatArray, opposite
from isomortar.model.entities import Body, Face, Problem
from isomortar.model.numbering import Numbering
from isomortar.model.pairs import Pair
from isomortar.model.sheet import Sheet
from isomortar.solve.equilibrium import Equilibrium

#: Softness of an incompressible layer over (1 - nu^2) / E: it goes sideways beside the contact. Fitted at Poisson's ratio 0.49.
SIDEWAYS = 0.35
#: How far a pressure presses in a layer on what holds it, over its thickness, as a share of pressure times softness where it cannot go
#: sideways: fitted to 224 forces of balls and cylinders on layers a twentieth to one radius thick (theory 9.10).
LAYER = 0.85
#: A body that is glued to one so many times as stiff is a layer on it.
STIFFER = 10.0


def pressed_in(equilibrium: Equilibrium, pair: Pair, projections: Projections, pressure: FloatArray) -> FloatArray:
    """How far pressures at a slave's points, none below zero, press in slave and master, about, in their mean, shape (2,) (theory 9.10).

    Zeros where there are none.
    """
    acting = pair.slave.area * pressure
    if not acting.any():
        return np.zeros(2)
    at = (equilibrium.problem, equilibrium.numbering, pair, projections)
    spread, mean = np.sqrt(equilibrium.problem.images * (acting @ pressure)), acting @ pressure / acting.sum()
    sides = zip(softness(*at), thinness(*at, equilibrium.supports.stage), strict=True)
    return np.array([acting @ (soft * np.minimum(spread, _of_layers(mean, thin))) for soft, thin in sides]) / acting.sum()


def _of_layers(pressure: float, thin: FloatArray) -> FloatArray:
    """How far a pressure presses in layers of one over these thicknesses, over their softness; infinity of what is none."""
    return np.divide(LAYER * pressure, thin, out=np.full_like(thin, np.inf), where=thin > 0.0)


def softness(problem: Problem, numbering: Numbering, pair: Pair, projections: Projections) -> tuple[FloatArray, FloatArray]:
    """That of slave and master at the slave's quadrature points, shapes (points,), where several are joined of the body that is there.

    Zero of what is rigid, and of masters beside which a point is.
    """
    soft = np.zeros(numbering.count)
    for body in problem.bodies:
        soft[numbering.points[body.name]] = _soft(body)
    return _at_points(problem, numbering, pair, projections, soft)


def thinness(problem: Problem, numbering: Numbering, pair: Pair, projections: Projections, stage: int) -> tuple[FloatArray, FloatArray]:
    """One over the thickness of both where something holds the opposite face as a whole in a stage, else zero; shapes as of `softness`.

    Of a layer that gives way as if nothing went sideways: thinner, the higher Poisson's ratio is (theory 9.10).
    """
    thin = np.zeros(numbering.count)
    for side in (pair.contact.slave, pair.contact.master):
        for face in side.faces if isinstance(side, Face) else ():
            points, body = numbering.points[face.body], problem.body(face.body)
            if _is_held(problem, body, Face(face.body, opposite(face.face)), stage):
                here, behind = (points[body.patch.face_points(name)] for name in (face.face, opposite(face.face)))
                thickness = np.linalg.norm(numbering.reference[here] - numbering.reference[behind], axis=1)
                thin[here] = 1.0 / (_confined(body) * thickness)
    return _at_points(problem, numbering, pair, projections, thin)


def _at_points(
    problem: Problem, numbering: Numbering, pair: Pair, projections: Projections, values: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Values of control points at the slave's quadrature points and at their feet, shapes (points,); zero where there is none."""
    shape = pair.slave.shape
    nodes = np.repeat(shape.nodes, pair.slave.per_element, axis=0)
    of_slave = np.einsum("qa,qa->q", shape.values, values[pair.slave.point[nodes]])
    of_master = np.zeros(len(of_slave))
    if isinstance(pair.contact.master, Face):
        sheet = Sheet.of(problem, pair.contact.master)
        feet = np.flatnonzero(projections.found > 0)
        nodes, functions = surface_functions(*sheet.arrays(numbering), projections.xi[feet])
        of_master[feet] = np.einsum("qa,qa->q", functions[:, 0], values[pair.master_face[nodes]])
    return of_slave, of_master


def _soft(body: Body) -> float:
    return 0.0 if body.rigid else (1.0 - body.material.poisson**2) / body.material.young


def _is_held(problem: Problem, body: Body, face: Face, stage: int) -> bool:
    """Whether supports hold a face of a body as a whole in a stage, or a body does that is glued to it and much stiffer."""
    glued = [problem.body(other.body) for pair in problem.glue for one, other in (pair, pair[::-1]) if one == face]
    return problem.holds(face, stage) or any(other.modulus > STIFFER * body.modulus for other in glued)


def _confined(body: Body) -> float:
    """How soft a layer is that cannot go sideways, over (1 - nu^2) / E; no less than what goes sideways within it leaves."""
    poisson = 0.0 if body.rigid else body.material.poisson
    return max(SIDEWAYS, (1.0 - 2.0 * poisson) / (1.0 - poisson) ** 2)
