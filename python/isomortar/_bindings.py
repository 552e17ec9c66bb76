"""The only importer of the compiled kernel: checks arrays, turns status codes into exceptions.

Arrays have the point index first here (``positions`` is (n, 3)); the kernel sees the same memory with it last.
Control points, elements and unknowns count from 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from isomortar._compiled import kernel as _kernel
from isomortar.errors import FoldedElementError, InputError, KernelError, LostProjectionError

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int32]
LongArray = NDArray[np.int64]

#: Kinds of constraint rows with friction, without, and with the paper's slip sum (isomortar_contact_blocks).
ROW_KINDS = {"frictionless": 1, "local": 8, "paper": 10}
#: Largest number of Gauss points per direction: more is taken for a mistake.
MAX_GAUSS = 64


@dataclass(frozen=True)
class PatchArrays:
    """A volume patch, flat: families, orders and counts; knots one after the other; global control points; weights."""

    layout: IntArray
    knots: FloatArray
    point: IntArray
    weight: FloatArray


@dataclass(frozen=True)
class MasterArrays:
    """A master, flat: axis and end of a face and the layout of its patch, or axis 0 and a plane's vectors in `knots`."""

    kind: IntArray
    knots: FloatArray
    point: IntArray
    weight: FloatArray


@dataclass(frozen=True)
class SlaveArrays:
    """A slave side: control points of each element, functions at the quadrature points, areas, global control points.

    Shapes (elements, local), (points, local), (points,), (slave control points,).
    """

    nodes: IntArray
    basis: FloatArray
    area: FloatArray
    point: IntArray


@dataclass(frozen=True)
class Pattern:
    """Compressed rows of 3x3 blocks."""

    start: IntArray
    column: IntArray


@dataclass(frozen=True)
class Projections:
    """Slave quadrature points on the master: coordinates, element, whether found, slip increment and whether it counts.

    `fixed`: 1 for coordinates that stay while the point moves, on lines across which the master is only continuous, shape (points, 2).
    """

    xi: FloatArray
    element: IntArray
    fixed: IntArray
    found: IntArray
    slip: FloatArray
    slips: IntArray


@dataclass(frozen=True)
class Control:
    """Control quantities of every slave control point: <R>, <R R>, <R g>, <R slip>, <R R a_ab>; a_ab at the points."""

    weight: FloatArray
    square: FloatArray
    gap: FloatArray
    slip: FloatArray
    metric: FloatArray
    point_metric: FloatArray


@dataclass(frozen=True)
class Law:
    """Augmented penalty law: penalties (normal, tangential), friction, current multipliers, the paper's slip sum or the local one.

    What supports hold: control points with `bears` 0 bear nothing, and `free`, shape (n, 2, 2), projects the covariant tractions of the
    others (component, traction) so that nothing is left along it.
    Trials above (1 - `slip_margin`) mu p slip; `held` control points (1) stick whatever their trial; `forgiving` takes the current
    traction for the radial part of the slip derivative (formulation.md Section 6).
    """

    penalties: FloatArray
    friction: float
    pressure: FloatArray
    traction: FloatArray
    summed: bool
    bears: IntArray
    free: FloatArray
    held: IntArray
    slip_margin: float = 0.0
    forgiving: bool = False


@dataclass(frozen=True)
class Response:
    """Control pressures and tractions, states (0 open, 1 stick, 2 slip), and their slopes."""

    pressure: FloatArray
    traction: FloatArray
    state: IntArray
    pressure_slope: FloatArray
    traction_slope: FloatArray
    field_slip: FloatArray


def _checked(name: str, array: NDArray[Any], dtype: type, *shape: int) -> NDArray[Any]:
    """The array, if it has the type, the shape and the memory order that the kernel reads without a copy."""
    if array.dtype != dtype or array.shape != shape or not array.flags.c_contiguous:
        raise InputError(f"is {array.dtype}{array.shape}; the kernel needs contiguous {np.dtype(dtype).name}{shape}", name)
    return array


def _finite(name: str, array: FloatArray) -> FloatArray:
    if not np.isfinite(array).all():
        raise InputError("holds a value that is not finite", name)
    return array


def _raise(status: int, place: int) -> NoReturn:
    """Raise the exception of a status of isomortar_base_status; `place` counts from 0."""
    sentences: dict[int, tuple[type[KernelError], str]] = {
        1: (FoldedElementError, f"element {place} is folded (J <= 0)"),
        2: (FoldedElementError, f"element {place} is folded (J <= 0) in the reference configuration"),
        3: (LostProjectionError, f"the closest-point projection of slave quadrature point {place} did not settle"),
    }
    kind, sentence = sentences.get(status, (KernelError, f"the kernel returned status {status} at {place}"))
    raise kind(sentence, place)


def add_body(
    patch: PatchArrays,
    gauss: tuple[int, int, int],
    bulk: float,
    shear: float,
    positions: FloatArray,
    reference: FloatArray,
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
        J <= 0, with the number of the element.
    """
    n = len(reference)
    _finite("positions", _checked("positions", positions, np.float64, n, 3))
    _checked("forces", forces, np.float64, n, 3)
    if pattern is None or tangent is None:
        pattern = Pattern(np.zeros(1, np.int32), np.zeros(1, np.int32))
        tangent = np.zeros((1, 3, 3))
        with_tangent = 0
    else:
        _checked("tangent", tangent, np.float64, len(pattern.column), 3, 3)
        with_tangent = 1
    jacobian, status, place = _kernel.add_body(
        patch.layout, patch.knots, patch.point, patch.weight, np.asarray(gauss, np.int32), bulk, shear, positions.T, reference.T,
        forces.T, with_tangent, pattern.start, pattern.column, tangent.T,
    )  # fmt: skip
    if status:
        _raise(status, place - 1)
    return float(jacobian)


def surface_functions(patch: PatchArrays, axis: int, side: int, xi: FloatArray) -> tuple[IntArray, FloatArray]:
    """Functions of a face (axis 1..3, side 0 or 1) at coordinates of shape (points, 2).

    Returns
    -------
    nodes : ndarray of int32, shape (points, local)
        Control points within the face.
    functions : ndarray, shape (points, 10, local)
        Values and partial derivatives: 1, u, v, uu, uv, vv, uuu, uuv, uvv, vvv.
    """
    orders = patch.layout[3:6]
    local = int(np.prod(orders + 1)) // int(orders[axis - 1] + 1)
    nodes, functions = _kernel.surface_functions(patch.layout, patch.knots, patch.point, patch.weight, axis, side, xi.T, local)
    return np.ascontiguousarray(nodes.T), np.ascontiguousarray(functions.T)


def slave_tables(
    patch: PatchArrays, axis: int, side: int, gauss: tuple[int, int], reference: FloatArray, local: int, elements: int
) -> tuple[IntArray, FloatArray, FloatArray]:
    """Functions and reference areas at the quadrature points of a face; nodes are numbered within the face."""
    points = elements * gauss[0] * gauss[1]
    nodes, basis, area = _kernel.slave_tables(
        patch.layout, patch.knots, patch.point, patch.weight, axis, side, np.asarray(gauss, np.int32), reference.T, local, elements, points
    )
    return np.ascontiguousarray(nodes.T), np.ascontiguousarray(basis.T), area


def project_points(slave: SlaveArrays, master: MasterArrays, positions: FloatArray, origin: FloatArray, had: IntArray) -> Projections:
    """Project every slave quadrature point, from `origin` where `had` is 1, from a coarse search elsewhere.

    `origin` is also where the slip increment is counted from.

    Raises
    ------
    LostProjectionError
        With the number of the quadrature point.
    """
    q = len(slave.area)
    _checked("origin", origin, np.float64, q, 2)
    _checked("had", had, np.int32, q)
    xi = origin.copy()
    element, fixed, found, slip, slips, status, place = _kernel.project_points(
        slave.nodes.T, slave.basis.T, slave.area, slave.point, master.kind, master.knots, master.point, master.weight, positions.T,
        had, origin.T, had, xi.T,
    )  # fmt: skip
    if status:
        _raise(status, place - 1)
    return Projections(xi, element.T, fixed.T, found, slip.T, slips)


def control_quantities(slave: SlaveArrays, master: MasterArrays, positions: FloatArray, projections: Projections) -> Control:
    """Integrate the control quantities of every slave control point."""
    weight, square, gap, slip, metric, point_metric = _kernel.control_quantities(
        slave.nodes.T, slave.basis.T, slave.area, slave.point, master.kind, master.knots, master.point, master.weight, positions.T,
        projections.xi.T, projections.element.T, projections.fixed.T, projections.found, projections.slip.T,
    )  # fmt: skip
    return Control(weight, square, gap, slip.T, metric.T, point_metric.T)


def augmented_multipliers(slave: SlaveArrays, control: Control, law: Law) -> Response:
    """Control pressures, tractions and states of the law, with their slopes."""
    n = len(slave.point)
    _checked("pressure", law.pressure, np.float64, n)
    _checked("traction", law.traction, np.float64, n, 2)
    _checked("bears", law.bears, np.int32, n)
    _checked("free", law.free, np.float64, n, 2, 2)
    pressure, traction, state, pressure_slope, traction_slope, field_slip = _kernel.augmented_multipliers(
        slave.nodes.T, slave.basis.T, slave.area, slave.point, control.weight, control.square, control.gap, control.slip.T,
        control.metric.T, control.point_metric.T, int(law.summed), law.penalties, law.friction, law.pressure, law.traction.T,
        law.slip_margin, int(law.forgiving), law.held, law.bears, law.free.T,
    )  # fmt: skip
    return Response(pressure, traction.T, state, pressure_slope, traction_slope.T, field_slip.T)


def contact_forces(
    slave: SlaveArrays,
    master: MasterArrays,
    positions: FloatArray,
    projections: Projections,
    friction: float,
    response: Response,
    forces: FloatArray,
) -> None:
    """Add the contact forces on slave and master control points."""
    _checked("forces", forces, np.float64, len(positions), 3)
    _kernel.contact_forces(
        slave.nodes.T, slave.basis.T, slave.area, slave.point, master.kind, master.knots, master.point, master.weight, positions.T,
        projections.xi.T, projections.element.T, projections.fixed.T, projections.found, int(friction > 0), response.pressure,
        response.traction.T, response.state, forces.T,
    )  # fmt: skip


def contact_blocks(
    slave: SlaveArrays,
    master: MasterArrays,
    positions: FloatArray,
    projections: Projections,
    friction: float,
    response: Response,
    row_pattern: Pattern,
    rows: FloatArray,
    pattern: Pattern,
    tangent: FloatArray,
) -> None:
    """Add constraint rows, shape (blocks, kinds, 3), and the geometric tangent, shape (blocks, 3, 3)."""
    _checked("rows", rows, np.float64, len(row_pattern.column), rows.shape[1], 3)
    _checked("tangent", tangent, np.float64, len(pattern.column), 3, 3)
    _kernel.contact_blocks(
        slave.nodes.T, slave.basis.T, slave.area, slave.point, master.kind, master.knots, master.point, master.weight, positions.T,
        projections.xi.T, projections.element.T, projections.fixed.T, projections.found, projections.slips, int(friction > 0),
        response.pressure, response.traction.T, response.state, response.field_slip.T, row_pattern.start, row_pattern.column, rows.T,
        pattern.start, pattern.column, tangent.T,
    )  # fmt: skip


def multiplier_rows(
    slave: SlaveArrays,
    control: Control,
    law: Law,
    response: Response,
    row_pattern: Pattern,
    rows: FloatArray,
    neighbours: Pattern,
    wide: Pattern,
) -> tuple[FloatArray, FloatArray]:
    """Derivatives by the positions of p, t_1, t_2, shape (blocks of `wide`, 3, 3), and of the trial tractions, (blocks, 2, 3)."""
    changes, trial = _kernel.multiplier_rows(
        slave.nodes.T, slave.basis.T, slave.area, slave.point, control.weight, control.square, control.slip.T, control.metric.T,
        control.point_metric.T, int(law.summed), law.penalties, law.friction, response.state, response.pressure_slope,
        response.traction_slope.T, row_pattern.start, row_pattern.column, rows.T, neighbours.start, neighbours.column,
        wide.start, wide.column,
    )  # fmt: skip
    return changes.T, trial.T


def condense_multipliers(
    state: IntArray, row_pattern: Pattern, rows: FloatArray, wide: Pattern, changes: FloatArray, pattern: Pattern, tangent: FloatArray
) -> None:
    """Add the product of constraint rows and derivatives of the multipliers to a tangent."""
    _kernel.condense_multipliers(
        state, row_pattern.start, row_pattern.column, rows.T, wide.start, wide.column, changes.T, pattern.start, pattern.column, tangent.T
    )


def find_places(
    pattern: Pattern, row_of: IntArray, column_of: IntArray, transposed: bool, system_start: LongArray, system_column: LongArray
) -> LongArray:
    """Where each entry of a blocked source goes in a compressed system (from 1; 0: dropped), shape (blocks, 3, 3).

    Raises
    ------
    KernelError
        The system lacks an entry of the source.
    """
    places, missing = _kernel.find_places(pattern.start, pattern.column, row_of, column_of, int(transposed), system_start, system_column)
    if missing:
        raise KernelError("the pattern of the linear system lacks an entry of one of its sources")
    return places.T


def add_values(places: LongArray, source: FloatArray, values: FloatArray) -> None:
    """values[places - 1] += source, where places > 0."""
    _kernel.add_values(places.reshape(-1), source.reshape(-1), values)
