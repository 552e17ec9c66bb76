"""How bodies give way on both sides of a contact: as deep ones do, (1 - nu^2) / E, as layers on what holds them, and how far they go."""

from __future__ import annotations

import numpy as np

from isomortar._bindings import Projections, surface_functions
from isomortar.geometry.patch import FloatArray, opposite
from isomortar.model.entities import Body, Face, Problem
from isomortar.model.numbering import Numbering
from isomortar.model.pairs import Pair
from isomortar.model.rigid import deformation
from isomortar.model.sheet import Sheet

#: Softness of an incompressible layer over (1 - nu^2) / E: it goes sideways beside the contact. Fitted at Poisson's ratio 0.49.
SIDEWAYS = 0.35
#: A body that is glued to one so many times as stiff is a layer on it.
STIFFER = 10.0
#: Times what it is pressed in that a body goes, up to which it does not bend (of balls and cylinders on blocks: 0.7 to 1.2).
STILL = 1.3


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


def gone(problem: Problem, numbering: Numbering, pair: Pair, positions: FloatArray, places: FloatArray, forces: FloatArray) -> FloatArray:
    """How far slave and master have gone where forces at slave points act, from what of their faces has gone least the same way, (2,).

    Zero of what is rigid. Along the mean normal there, and but for rigid motions: a roller that turns has not given way, and a block that
    is squeezed across has not bent (theory 9.10, 9.15).
    """
    pieces = [numbering.piece_points(piece) for piece in range(len(numbering.pieces))]
    ways = np.concatenate([deformation(numbering.reference[own], positions[own]) for own in pieces])
    acting, found = np.flatnonzero(forces), np.zeros(2)
    nodes, own = pair.slave.shape.nodes[acting // pair.slave.per_element], pair.slave.point
    along = ways @ _mean_normal(np.einsum("qda,qac->qdc", pair.slave.slopes[acting], positions[own[nodes]]), forces[acting])
    faces, functions = [own[: pair.slave.highest + 1]], [(nodes, pair.slave.shape.values[acting])]
    if isinstance(pair.contact.master, Face):
        feet, values = surface_functions(*Sheet.of(problem, pair.contact.master).arrays(numbering), places[acting])
        faces.append(pair.master_face)
        functions.append((feet, values[:, 0]))
    for side, (face, (nodes, values)) in enumerate(zip(faces, functions, strict=True)):
        mean = forces[acting] @ np.einsum("qa,qa->q", values, along[face[nodes]]) / forces.sum()
        found[side] = np.abs(along[face] - mean).max()
    return found


def _mean_normal(tangents: FloatArray, forces: FloatArray) -> FloatArray:
    """Unit normal of a surface with given tangents, shape (points, 2, 3), weighted with forces; zero where they cancel each other."""
    normals = np.cross(tangents[:, 0], tangents[:, 1])
    lengths = np.linalg.norm(normals, axis=1)
    normal = forces @ (normals / np.where(lengths > 0.0, lengths, 1.0)[:, None])
    return np.asarray(normal / (np.linalg.norm(normal) or 1.0))


def local(pressed: float, went: float) -> float:
    """Share of how far a body has gone that it is pressed in by, about (theory 9.15): of a beam that bends it is little."""
    return min(1.0, (STILL * pressed / went) ** 2) if went > 0.0 else 1.0


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
