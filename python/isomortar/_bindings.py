"""The only importer of the compiled kernel but `_sparse`: checks arguments, turns status codes into exceptions.

Arrays are laid out as `_arrays` says.
"""

from __future__ import annotations

import math
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

from isomortar import _arguments as check
from isomortar._arguments import FloatArray, IntArray
from isomortar._arrays import (
    AveragedFaceArrays,
    Control,
    FaceArrays,
    FrictionArrays,
    FunctionArrays,
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
from isomortar._codes import ROW_KINDS, Status
from isomortar._compiled import kernel as _kernel
from isomortar._descriptors import Descriptors
from isomortar.errors import FoldedElementError, InputError, KernelError, LostProjectionError

LongArray = NDArray[np.int64]

# With the arrays, which those who call take from here.
__all__ = [
    "AveragedFaceArrays", "Control", "FaceArrays", "FloatArray", "FrictionArrays", "FunctionArrays", "IntArray", "Law", "LongArray",
    "MasterArrays", "MaterialArrays", "PatchArrays", "Pattern", "PlaneArrays", "Projections", "Response", "SlaveArrays", "add_body",
    "add_values", "augmented_multipliers",
    "condense_multipliers", "contact_blocks", "contact_forces", "control_quantities", "find_climbs", "find_places", "friction_radius",
    "material_stress", "multiplier_rows", "project_points", "slave_tables", "surface_functions",
]  # fmt: skip

_DESCRIPTORS = Descriptors(_kernel)
#: What stands for a tangent where none is wanted, and for its pattern.
_NO_BLOCKS, _NO_PATTERN = np.zeros((1, 3, 3)), -1


def _raise(status: int, place: int, jacobian: float = math.nan) -> NoReturn:
    """Raise the exception of a status; `place` counts from 0, `jacobian` is the J of a folded element."""
    folded = "J <= 0" if math.isnan(jacobian) else f"J = {jacobian:.3g}"
    sentences: dict[int, tuple[type[KernelError], str]] = {
        Status.FOLDED: (FoldedElementError, f"element {place} is folded ({folded})"),
        Status.FOLDED_INITIALLY: (FoldedElementError, f"element {place} is folded ({folded}) in the reference configuration"),
        Status.DEGENERATE_SURFACE: (
            LostProjectionError,
            f"the master has no normal at the closest point of slave quadrature point {place}",
        ),
        Status.PATTERN: (
            KernelError,
            f"a pattern does not fit what is added to it: block missing in row {place} (-1: it has other rows)",
        ),
        Status.NOT_FINITE: (LostProjectionError, f"the position of control point {place} is not finite"),
        Status.PASSED_THROUGH: (LostProjectionError, f"slave quadrature point {place} has passed through the master's body"),
    }
    kind, sentence = sentences.get(status, (KernelError, f"the kernel returned status {Status(status).name} at {place}"))
    raise kind(sentence, place)


def _patch(patch: PatchArrays) -> int:
    return _DESCRIPTORS.handle("patch", patch, PatchArrays)


def _slave(slave: SlaveArrays) -> int:
    return _DESCRIPTORS.handle("slave", slave, SlaveArrays)


def _master(master: MasterArrays) -> int:
    return _DESCRIPTORS.handle("master", master, PlaneArrays, FaceArrays)


def _friction(name: str, friction: FrictionArrays) -> int:
    return _DESCRIPTORS.handle(name, friction, FrictionArrays)


def _pattern(name: str, pattern: Pattern) -> int:
    return _DESCRIPTORS.handle(name, pattern, Pattern)


def _check_bodies(positions: FloatArray, slave: SlaveArrays, master: MasterArrays) -> None:
    check.kind("slave", slave, SlaveArrays)
    check.kind("master", master, PlaneArrays, FaceArrays)
    check.finite("positions", check.array("positions", positions, np.float64, None, 3))
    check.below("slave.point", slave.highest, len(positions), "control point")
    check.below("master.point", master.highest, len(positions), "control point")


def _check_projections(projections: Projections, slave: SlaveArrays, master: MasterArrays) -> None:
    check.kind("projections", projections, Projections)
    check.array("projections.found", projections.found, np.int32, len(slave.area))
    low, first, second = projections.range
    if master.elements is not None and not (low >= 0 and first < master.elements[0] and second < master.elements[1]):
        raise InputError(f"names elements {low} to {first}, {second}; the master has {master.elements}", "projections.element")


def _check_control(control: Control, slave: SlaveArrays) -> None:
    check.kind("slave", slave, SlaveArrays)
    check.kind("control", control, Control)
    n = slave.test.count
    for name, value, shape in (
        ("weight", control.weight, (n,)),
        ("square", control.square, (n,)),
        ("gap", control.gap, (n,)),
        ("slip", control.slip, (n, 2)),
        ("metric", control.metric, (n, 3)),
        ("point_metric", control.point_metric, (len(slave.area), 3)),
    ):
        check.array(f"control.{name}", value, np.float64, *shape)


def _check_law(law: Law, slave: SlaveArrays) -> None:
    check.kind("law", law, Law)
    check.kind("law.friction", law.friction, FrictionArrays)
    n = slave.test.count
    check.array("law.penalties", law.penalties, np.float64, 2)
    check.array("law.pressure", law.pressure, np.float64, n)
    check.array("law.traction", law.traction, np.float64, n, 2)
    check.array("law.bears", law.bears, np.int32, n)
    check.array("law.free", law.free, np.float64, n, 2, 2)
    check.array("law.held", law.held, np.int32, n)
    check.flag("law.summed", law.summed)
    check.flag("law.forgiving", law.forgiving)
    check.real("law.slip_margin", law.slip_margin, lambda value: 0 <= value <= 1, "a number from 0 to 1")


def _check_response(response: Response, slave: SlaveArrays) -> None:
    check.kind("response", response, Response)
    n = slave.test.count
    check.array("response.state", response.state, np.int32, n)
    for name, value, shape in (
        ("pressure", response.pressure, (n,)),
        ("traction", response.traction, (n, 2)),
        ("pressure_slope", response.pressure_slope, (n,)),
        ("traction_slope", response.traction_slope, (n, 6, 2)),
        ("field_slip", response.field_slip, (len(slave.area), 2)),
    ):
        check.array(f"response.{name}", value, np.float64, *shape)


def _check_pattern(name: str, pattern: Pattern, rows: int, columns: int) -> None:
    """Refuse a pattern with another number of rows, or columns beyond theirs."""
    check.kind(name, pattern, Pattern)
    check.array(f"{name}.start", pattern.start, np.int32, rows + 1)
    check.below(f"{name}.column", pattern.highest, columns, "column")


def _check_rows(pattern: Pattern, rows: FloatArray, slave_points: int, control_points: int) -> None:
    _check_pattern("row_pattern", pattern, slave_points, control_points)
    kinds = check.array("rows", rows, np.float64, len(pattern.column), None, 3).shape[1]
    if kinds not in ROW_KINDS.values():
        raise InputError(f"has {kinds} kinds; allowed: {', '.join(map(str, ROW_KINDS.values()))}", "rows")


def add_body(
    patch: PatchArrays,
    gauss: tuple[int, int, int],
    material: MaterialArrays,
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
    check.kind("patch", patch, PatchArrays)
    n = len(check.finite("reference", check.array("reference", reference, np.float64, None, 3)))
    check.finite("positions", check.array("positions", positions, np.float64, n, 3))
    check.array("forces", forces, np.float64, n, 3)
    check.below("patch.point", patch.highest, n, "control point")
    rule = check.gauss("gauss", gauss, 3)
    of_tangent, values = _NO_PATTERN, _NO_BLOCKS
    if pattern is not None and tangent is not None:
        _check_pattern("pattern", pattern, n, n)
        of_tangent, values = _pattern("pattern", pattern), check.array("tangent", tangent, np.float64, len(pattern.column), 3, 3)
    jacobian, status, place = _kernel.add_body(
        _patch(patch), rule, _DESCRIPTORS.handle("material", material, MaterialArrays), positions.T, reference.T, forces.T,
        int(of_tangent != _NO_PATTERN), of_tangent, values.T,
    )  # fmt: skip
    if status:
        _raise(status, place - 1, jacobian)
    return float(jacobian)


def material_stress(material: MaterialArrays, gradient: FloatArray) -> FloatArray:
    """First Piola stresses, force per reference area, at displacement gradients F - 1, both of shape (points, 3, 3).

    Raises
    ------
    FoldedElementError
        det F <= 0, with the number of the first such gradient.
    """
    check.finite("gradient", check.array("gradient", gradient, np.float64, None, 3, 3))
    handle = _DESCRIPTORS.handle("material", material, MaterialArrays)
    stress, status, place = _kernel.material_stress(handle, np.asfortranarray(gradient.transpose(1, 2, 0)))
    if status:
        _raise(status, place - 1)
    return np.ascontiguousarray(stress.transpose(2, 0, 1))


def surface_functions(patch: PatchArrays, axis: int, side: int, xi: FloatArray) -> tuple[IntArray, FloatArray]:
    """Functions of a face (axis 1..3, side 0 or 1) at coordinates of shape (points, 2).

    Returns
    -------
    nodes : ndarray of int32, shape (points, local)
        Control points within the face.
    functions : ndarray, shape (points, 10, local)
        Values and partial derivatives: 1, u, v, uu, uv, vv, uuu, uuv, uvv, vvv.
    """
    check.kind("patch", patch, PatchArrays)
    check.face(axis, side)
    first, second, *_ = patch.face(axis)
    check.finite("xi", check.array("xi", xi, np.float64, None, 2))
    nodes, functions, status = _kernel.surface_functions(_patch(patch), axis, side, xi.T, first * second)
    if status:
        _raise(status, -1)
    return np.ascontiguousarray(nodes.T), np.ascontiguousarray(functions.T)


def slave_tables(
    patch: PatchArrays, axis: int, side: int, gauss: tuple[int, int], reference: FloatArray
) -> tuple[IntArray, FloatArray, FloatArray, FloatArray]:
    """Functions, their derivatives and reference areas at the quadrature points of a face.

    Returns
    -------
    nodes : ndarray of int32, shape (elements, local)
        Control points within the face.
    values : ndarray, shape (points, local)
    slopes : ndarray, shape (points, 2, local)
        Derivatives by the coordinates of the face.
    area : ndarray, shape (points,)
    """
    check.kind("patch", patch, PatchArrays)
    check.face(axis, side)
    first, second, *by_direction = patch.face(axis)
    check.finite("reference", check.array("reference", reference, np.float64, None, 3))
    check.below("patch.point", patch.highest, len(reference), "control point")
    rule, elements = check.gauss("gauss", gauss, 2), math.prod(by_direction)
    points = elements * int(rule[0]) * int(rule[1])
    nodes, values, slopes, area, status = _kernel.slave_tables(
        _patch(patch), axis, side, rule, reference.T, first * second, elements, points
    )
    if status:
        _raise(status, -1)
    return np.ascontiguousarray(nodes.T), np.ascontiguousarray(values.T), np.ascontiguousarray(slopes.T), area


def project_points(slave: SlaveArrays, master: MasterArrays, positions: FloatArray, origin: FloatArray, had: IntArray) -> Projections:
    """Project every slave quadrature point, from `origin` where `had` is 1, from a coarse search elsewhere.

    `origin` is also where the slip increment is counted from.

    Raises
    ------
    LostProjectionError
        With the number of the quadrature point.
    """
    _check_bodies(positions, slave, master)
    q = len(slave.area)
    check.finite("origin", check.array("origin", origin, np.float64, q, 2))
    check.array("had", had, np.int32, q)
    xi = origin.copy()
    element, fixed, found, doubt, slip, slips, status, place = _kernel.project_points(
        _slave(slave), _master(master), positions.T, had, origin.T, had, xi.T
    )
    if status:
        _raise(status, place - 1)
    return Projections(xi, element.T, fixed.T, found, doubt, origin, slip.T, slips)


def control_quantities(slave: SlaveArrays, master: MasterArrays, positions: FloatArray, projections: Projections) -> Control:
    """Integrate the control quantities of every constraint."""
    _check_bodies(positions, slave, master)
    _check_projections(projections, slave, master)
    weight, square, gap, slip, metric, point_metric, status = _kernel.control_quantities(
        _slave(slave), _master(master), positions.T, projections.xi.T, projections.element.T, projections.fixed.T, projections.found,
        projections.slip.T, slave.test.count,
    )  # fmt: skip
    if status:
        _raise(status, -1)
    return Control(weight, square, gap, slip.T, metric.T, point_metric.T)


def find_climbs(slave: SlaveArrays, master: MasterArrays, positions: FloatArray, projections: Projections) -> FloatArray:
    """How far the foot of every slave quadrature point has climbed along its normal since `origin` (theory 3.31), shape (points,)."""
    _check_bodies(positions, slave, master)
    _check_projections(projections, slave, master)
    climbs, status = _kernel.find_climbs(_master(master), positions.T, projections.xi.T, projections.origin.T, projections.slips)
    if status:
        _raise(status, -1)
    return np.asarray(climbs)


def augmented_multipliers(slave: SlaveArrays, control: Control, law: Law) -> Response:
    """Control pressures, tractions and states of the law, with their slopes.

    Raises
    ------
    KernelError
        No law of friction has that number and so many parameters.
    """
    _check_control(control, slave)
    _check_law(law, slave)
    pressure, traction, state, pressure_slope, traction_slope, field_slip, status = _kernel.augmented_multipliers(
        _slave(slave), _friction("law.friction", law.friction), control.weight, control.square, control.gap, control.slip.T,
        control.metric.T, control.point_metric.T, int(law.summed), law.penalties, law.pressure, law.traction.T, law.slip_margin,
        int(law.forgiving), law.held, law.bears, law.free.T,
    )  # fmt: skip
    if status:
        _raise(status, -1)
    return Response(pressure, traction.T, state, pressure_slope, traction_slope.T, field_slip.T)


def friction_radius(friction: FrictionArrays, pressure: FloatArray) -> FloatArray:
    """Largest norms of control tractions under control pressures, both of shape (n,), force per area; 0 where open or without friction.

    Raises
    ------
    KernelError
        No law of friction has that number and so many parameters.
    """
    check.array("pressure", pressure, np.float64, None)
    radius, status = _kernel.friction_radius(_friction("friction", friction), pressure)
    if status:
        _raise(status, -1)
    return np.asarray(radius)


def contact_forces(
    slave: SlaveArrays,
    master: MasterArrays,
    positions: FloatArray,
    projections: Projections,
    response: Response,
    forces: FloatArray,
) -> None:
    """Add the contact forces on slave and master control points."""
    _check_bodies(positions, slave, master)
    _check_projections(projections, slave, master)
    _check_response(response, slave)
    check.array("forces", forces, np.float64, len(positions), 3)
    status = _kernel.contact_forces(
        _slave(slave), _master(master), positions.T, projections.xi.T, projections.element.T, projections.fixed.T, projections.found,
        response.pressure, response.traction.T, response.state, forces.T,
    )  # fmt: skip
    if status:
        _raise(status, -1)


def contact_blocks(
    slave: SlaveArrays,
    master: MasterArrays,
    positions: FloatArray,
    projections: Projections,
    with_friction: bool,
    response: Response,
    row_pattern: Pattern,
    rows: FloatArray,
    pattern: Pattern,
    tangent: FloatArray,
) -> None:
    """Add constraint rows, shape (blocks, kinds, 3), and the geometric tangent, shape (blocks, 3, 3).

    Raises
    ------
    KernelError
        A pattern lacks a block.
    """
    _check_bodies(positions, slave, master)
    _check_projections(projections, slave, master)
    _check_response(response, slave)
    _check_rows(row_pattern, rows, slave.test.count, len(positions))
    _check_pattern("pattern", pattern, len(positions), len(positions))
    check.array("tangent", tangent, np.float64, len(pattern.column), 3, 3)
    status, place = _kernel.contact_blocks(
        _slave(slave), _master(master), positions.T, projections.xi.T, projections.element.T, projections.fixed.T, projections.found,
        projections.origin.T, projections.slips, check.flag("with_friction", with_friction), response.pressure, response.traction.T,
        response.state, response.field_slip.T, _pattern("row_pattern", row_pattern), rows.T, _pattern("pattern", pattern), tangent.T,
    )  # fmt: skip
    if status:
        _raise(status, place - 1)


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
    """Derivatives by the positions of p, t_1, t_2, shape (blocks of `wide`, 3, 3), and of the trial tractions, (blocks, 2, 3).

    Raises
    ------
    KernelError
        A pattern lacks a block.
    """
    _check_control(control, slave)
    _check_law(law, slave)
    check.kind("row_pattern", row_pattern, Pattern)
    check.kind("wide", wide, Pattern)
    points, columns = slave.test.count, max(row_pattern.highest, wide.highest) + 1
    _check_response(response, slave)
    _check_rows(row_pattern, rows, points, columns)
    if bool(law.summed) != (rows.shape[1] == ROW_KINDS["paper"]):
        raise InputError(f"has {rows.shape[1]} kinds; allowed: {ROW_KINDS['paper']} with the law's slip sum, others without it", "rows")
    _check_pattern("neighbours", neighbours, points, points)
    _check_pattern("wide", wide, points, columns)
    changes, trial, status, place = _kernel.multiplier_rows(
        _slave(slave), control.weight, control.square, control.slip.T, control.metric.T, control.point_metric.T,
        law.penalties, response.state, response.pressure_slope, response.traction_slope.T, _pattern("row_pattern", row_pattern), rows.T,
        _pattern("neighbours", neighbours), _pattern("wide", wide), len(wide.column),
    )  # fmt: skip
    if status:
        _raise(status, place - 1)
    return changes.T, trial.T


def condense_multipliers(
    state: IntArray, row_pattern: Pattern, rows: FloatArray, wide: Pattern, changes: FloatArray, pattern: Pattern, tangent: FloatArray
) -> None:
    """Add the product of constraint rows and derivatives of the multipliers to a tangent.

    Raises
    ------
    KernelError
        A pattern lacks a block.
    """
    check.kind("pattern", pattern, Pattern)
    points, columns = len(check.array("state", state, np.int32, None)), len(pattern.start) - 1
    _check_rows(row_pattern, rows, points, columns)
    _check_pattern("wide", wide, points, columns)
    check.array("changes", changes, np.float64, len(wide.column), 3, 3)
    _check_pattern("pattern", pattern, columns, columns)
    check.array("tangent", tangent, np.float64, len(pattern.column), 3, 3)
    status, place = _kernel.condense_multipliers(
        state, _pattern("row_pattern", row_pattern), rows.T, _pattern("wide", wide), changes.T, _pattern("pattern", pattern), tangent.T
    )
    if status:
        _raise(status, place - 1)


def find_places(
    pattern: Pattern, row_of: IntArray, column_of: IntArray, transposed: bool, system_start: LongArray, system_column: LongArray
) -> LongArray:
    """Where each entry of a blocked source goes in a compressed system (from 1; 0: dropped), shape (blocks, 3, 3).

    Raises
    ------
    KernelError
        The system lacks an entry of the source.
    """
    check.kind("pattern", pattern, Pattern)
    rows, columns = 3 * (len(pattern.start) - 1), 3 * (pattern.highest + 1)
    unknowns = len(check.array("system_start", system_start, np.int64, None)) - 1
    check.array("system_column", system_column, np.int64, None)
    check.compressed("system_start", system_start, len(system_column))
    check.within("system_column", system_column, 0, unknowns - 1)
    check.within("row_of", check.array("row_of", row_of, np.int32, rows), -1, unknowns - 1)
    check.within("column_of", check.array("column_of", column_of, np.int32, None), -1, unknowns - 1)
    check.below("pattern.column", columns - 1, len(column_of), "unknown")
    places, status = _kernel.find_places(
        _pattern("pattern", pattern), len(pattern.column), row_of, column_of, check.flag("transposed", transposed), system_start,
        system_column,
    )  # fmt: skip
    if status == Status.PATTERN:
        raise KernelError("the pattern of the linear system lacks an entry of one of its sources")
    if status:
        _raise(status, -1)
    return places.T


def add_values(places: LongArray, source: FloatArray, values: FloatArray) -> None:
    """values[places - 1] += source, where places > 0."""
    check.array("places", places, np.int64, None, 3, 3)
    check.array("source", source, np.float64, len(places), 3, 3)
    check.array("values", values, np.float64, None)
    check.within("places", places, 0, len(values))
    _kernel.add_values(places.reshape(-1), source.reshape(-1), values)
