"""The only importer of the extended-precision twin: directional derivatives that measure the tangent's error.

The twin is the same kernel in quadruple precision. It forms central differences of forces and control quantities itself, with
a step so small that the difference's own error is far below double precision.
"""

from __future__ import annotations

import numpy as np

from isomortar import _extended
from isomortar._bindings import (
    BodyArrays,
    FaceArrays,
    FloatArray,
    FrictionArrays,
    IntArray,
    Law,
    MasterArrays,
    MaterialArrays,
    PatchArrays,
    Pattern,
    PlaneArrays,
    Projections,
    Response,
    SlaveArrays,
)
from isomortar._descriptors import Descriptors
from isomortar._frozen import frozen
from isomortar.errors import KernelError

#: Step of the differences, times the direction: errors of its square and of quadruple round-off over it, both about 1e-22.
STEP = 1e-11
_DESCRIPTORS = Descriptors(_extended)


@frozen
class ContactChange:
    """Directional derivatives of a contact pair.

    Of the control quantities <R g>, <R xi>, <R (xi - xi_n)>, <R R a_ab>, of control pressures and tractions, and of the contact
    forces with the pressures held and no tractions, with the tractions held and no pressures, and with those of the law.
    """

    gap: FloatArray
    coordinates: FloatArray
    slip: FloatArray
    metric: FloatArray
    pressure: FloatArray
    traction: FloatArray
    normal_forces: FloatArray
    tangential_forces: FloatArray
    forces: FloatArray


@frozen
class Hulls:
    """Where the elements of a face can be at most (isomortar_contact_hulls).

    Spheres, (elements, 3) and (elements,); boxes about the same centres by unit vectors, (elements, 3, 3), and half lengths,
    (elements, 3); Bezier points and points on a regular grid, (elements, points, 3); bounds of the curvature, (elements,).
    """

    centre: FloatArray
    radius: FloatArray
    frame: FloatArray
    half: FloatArray
    corner: FloatArray
    sample: FloatArray
    curvature: FloatArray


def solid_difference(
    body: BodyArrays,
    material: MaterialArrays,
    positions: FloatArray,
    along: FloatArray,
    step: float = STEP,
) -> FloatArray:
    """Derivative of one body's internal forces along a change of the positions, shape (control points, 3).

    Raises
    ------
    KernelError
        An element is folded.
    """
    forces, status, place = _extended.solid_difference(
        _DESCRIPTORS.handle("body", body, BodyArrays), _DESCRIPTORS.handle("material", material, MaterialArrays), positions.T, along.T, step
    )
    _check(status, place)
    return np.ascontiguousarray(forces.T)


def contact_difference(
    slave: SlaveArrays,
    master: MasterArrays,
    positions: FloatArray,
    along: FloatArray,
    projections: Projections,
    origin: FloatArray,
    had: np.ndarray,
    law: Law,
    pressure_along: FloatArray,
    traction_along: FloatArray,
    held: Response,
) -> tuple[ContactChange, int]:
    """Derivatives of a contact pair along a change of positions and of the law's multipliers.

    Parameters
    ----------
    along, pressure_along, traction_along : ndarray
        The direction; shapes of positions, pressures and tractions (with elastic slip: of what these start from, `Law.base`).
    projections : Projections
        Those of the double-precision kernel: where the projections start, and the branch that is asked for.
    origin, had : ndarray
        Projections at the last converged load step.
    held : Response
        The multipliers of the parts with multipliers held, and the states that are asked for.

    Returns
    -------
    ContactChange
    int
        Points and constraints whose branch (projection, master element, fixed coordinates, state) is not the same on both sides of
        the difference.

    Raises
    ------
    KernelError
        A projection is lost.
    """
    *changes, switched, status, place = _extended.contact_difference(
        _DESCRIPTORS.handle("slave", slave, SlaveArrays), _DESCRIPTORS.handle("master", master, PlaneArrays, FaceArrays),
        _DESCRIPTORS.handle("law.friction", law.friction, FrictionArrays), positions.T, along.T, STEP, projections.xi.T,
        projections.element.T, projections.fixed.T, projections.found, origin.T, had, int(law.summed), law.factors, law.pressure,
        law.base.T, law.bears, law.free.T, int(law.elastic), law.smoothing, pressure_along, traction_along.T, held.pressure,
        held.traction.T, held.state,
    )  # fmt: skip
    _check(status, place)
    return ContactChange(*[np.ascontiguousarray(change.T) for change in changes]), switched


def contact_tangent(
    slave: SlaveArrays,
    master: MasterArrays,
    positions: FloatArray,
    projections: Projections,
    origin: FloatArray,
    had: np.ndarray,
    law: Law,
    kinds: int,
    row_pattern: Pattern,
    neighbours: Pattern,
    wide: Pattern,
    pattern: Pattern,
) -> FloatArray:
    """The tangent of a contact pair as the kernel assembles it, multipliers condensed, shape (blocks of `pattern`, 3, 3).

    Parameters
    ----------
    kinds : int
        Of constraint rows.
    row_pattern, neighbours, wide, pattern : Pattern
        As the kernel has them (`isomortar._bindings.contact_blocks`, `multiplier_rows`).

    Others: see `contact_difference`.

    Raises
    ------
    KernelError
        A projection is lost, or a pattern lacks a block.
    """
    tangent, status, place = _extended.contact_tangent(
        _DESCRIPTORS.handle("slave", slave, SlaveArrays), _DESCRIPTORS.handle("master", master, PlaneArrays, FaceArrays),
        _DESCRIPTORS.handle("law.friction", law.friction, FrictionArrays), positions.T, projections.xi.T, origin.T, had,
        int(law.summed), law.factors, law.pressure, law.base.T, law.bears, law.free.T, int(law.elastic), law.smoothing,
        *(_DESCRIPTORS.handle("pattern", arrays, Pattern) for arrays in (row_pattern, neighbours, wide, pattern)),
        kinds, len(pattern.column),
    )  # fmt: skip
    _check(status, place)
    return np.ascontiguousarray(tangent.T)


def project_points(slave: SlaveArrays, master: MasterArrays, positions: FloatArray, origin: FloatArray, had: IntArray) -> Projections:
    """Project every slave quadrature point as the kernel does, without slips.

    Raises
    ------
    KernelError
        A projection is lost.
    """
    xi = origin.copy()
    element, fixed, found, doubt, status, place = _extended.extended_feet(
        _DESCRIPTORS.handle("slave", slave, SlaveArrays), _DESCRIPTORS.handle("master", master, PlaneArrays, FaceArrays),
        positions.T, had, xi.T,
    )  # fmt: skip
    _check(status, place)
    return Projections(xi, element.T, fixed.T, found, doubt, origin, np.zeros_like(xi), np.zeros_like(had))


def surface_hulls(master: FaceArrays, positions: FloatArray) -> Hulls:
    """Hulls of the elements of a master's face, the first direction fastest."""
    local = np.prod(master.patch.face(master.axis)[:2])
    handle = _DESCRIPTORS.handle("patch", master.patch, PatchArrays)
    centre, radius, frame, half, corner, sample, curvature, status = _extended.surface_hulls(
        handle, master.axis, master.side, positions.T, int(np.prod(master.elements)), int(local)
    )
    _check(status, 0)
    return Hulls(centre, radius, frame.T.transpose(0, 2, 1), half.T, corner.T, sample.T, curvature)


def surface_points(master: FaceArrays, positions: FloatArray, xi: FloatArray) -> FloatArray:
    """Points of a master's face as the search evaluates them: S, S,1, S,2, S,11, S,12, S,22, shape (points, 6, 3)."""
    handle = _DESCRIPTORS.handle("patch", master.patch, PatchArrays)
    derivatives, status = _extended.surface_points(handle, master.axis, master.side, positions.T, xi.T)
    _check(status, 0)
    return np.ascontiguousarray(derivatives.T)


def surface_prospects(master: FaceArrays, positions: FloatArray, targets: FloatArray, ways: FloatArray) -> tuple[FloatArray, IntArray]:
    """What the search learns of each element of a master's face first, for points with ways from them to some place of the face.

    Returns
    -------
    xi : ndarray, shape (points, elements, 2)
        Coordinates of the nearest sample of each element.
    farther : ndarray of int32, shape (points, elements)
        1 where an element is found to be farther from the point than that place.
    """
    handle = _DESCRIPTORS.handle("patch", master.patch, PatchArrays)
    count = int(np.prod(master.elements))
    xi, farther, status = _extended.surface_prospects(handle, master.axis, master.side, positions.T, targets.T, ways.T, count)
    _check(status, 0)
    return xi.T, farther.T


def _check(status: int, place: int) -> None:
    if status:
        raise KernelError(f"the extended-precision twin returned status {status} at {place - 1}", place - 1)
