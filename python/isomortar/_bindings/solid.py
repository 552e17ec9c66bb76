"""Bodies: forces, tangents and stresses."""

from __future__ import annotations

import numpy as np

from isomortar import _arguments as check
from isomortar._arguments import FloatArray
from isomortar._arrays import BodyArrays, MaterialArrays, Pattern
from isomortar._bindings import handles
from isomortar._bindings.checks import check_pattern
from isomortar._bindings.statuses import raise_status
from isomortar._compiled import kernel as _kernel

#: What stands for a tangent where none is wanted, and for its pattern.
_NO_BLOCKS, _NO_PATTERN = np.zeros((1, 3, 3)), -1


def add_body(
    body: BodyArrays,
    material: MaterialArrays,
    positions: FloatArray,
    forces: FloatArray,
    pattern: Pattern | None = None,
    tangent: FloatArray | None = None,
) -> float:
    """Add internal forces (and the tangent, shape (blocks, 3, 3), on `pattern`) of one body.

    Returns
    -------
    float
        The smallest J met.

    Raises
    ------
    FoldedElementError
        J <= 0, now or in the reference configuration, with the number of the first such element and the least J at its points.
    """
    check.kind("body", body, BodyArrays)
    n = len(body.reference)
    check.finite("positions", check.array("positions", positions, np.float64, n, 3))
    check.array("forces", forces, np.float64, n, 3)
    of_tangent, values = _NO_PATTERN, _NO_BLOCKS
    if pattern is not None and tangent is not None:
        check_pattern("pattern", pattern, n, n)
        of_tangent, values = handles.pattern("pattern", pattern), check.array("tangent", tangent, np.float64, len(pattern.column), 3, 3)
    jacobian, status, place = _kernel.add_body(
        handles.body(body), handles.material(material), positions.T, forces.T, int(of_tangent != _NO_PATTERN), of_tangent, values.T
    )
    if status:
        raise_status(status, place - 1, jacobian)
    return float(jacobian)


def control_volumes(body: BodyArrays) -> FloatArray:
    """Volumes of control points: integrals of their functions over the reference configuration of one body, shape (control points,).

    Raises
    ------
    FoldedElementError
        With the number of the element.
    """
    volumes, jacobian, status, place = _kernel.control_volumes(handles.body(body), len(body.reference))
    if status:
        raise_status(status, place - 1, jacobian)
    return np.asarray(volumes)


def material_stress(material: MaterialArrays, gradient: FloatArray) -> FloatArray:
    """First Piola stresses, force per reference area, at displacement gradients F - 1, both of shape (points, 3, 3).

    Raises
    ------
    FoldedElementError
        det F <= 0, with the number of the first such gradient.
    """
    check.finite("gradient", check.array("gradient", gradient, np.float64, None, 3, 3))
    handle = handles.material(material)
    stress, status, place = _kernel.material_stress(handle, np.asfortranarray(gradient.transpose(1, 2, 0)))
    if status:
        raise_status(status, place - 1)
    return np.ascontiguousarray(stress.transpose(2, 0, 1))
