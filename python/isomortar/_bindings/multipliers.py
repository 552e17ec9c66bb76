"""What the law of contact makes of gaps and slips: multipliers, and their derivatives."""

from __future__ import annotations

import numpy as np

from isomortar import _arguments as check
from isomortar._arguments import FloatArray, IntArray
from isomortar._arrays import Control, FrictionArrays, Law, Pattern, Response, SlaveArrays
from isomortar._bindings import handles
from isomortar._bindings.checks import check_control, check_law, check_pattern, check_response, check_rows
from isomortar._bindings.statuses import raise_status
from isomortar._codes import ROW_KINDS
from isomortar._compiled import kernel as _kernel
from isomortar.errors import InputError


def augmented_multipliers(slave: SlaveArrays, control: Control, law: Law) -> Response:
    """Control pressures, tractions and states of the law, with their slopes.

    Raises
    ------
    KernelError
        No law of friction has that number and so many parameters.
    """
    check_control(control, slave)
    check_law(law, slave)
    pressure, traction, state, pressure_slope, traction_slope, field_slip, status = _kernel.augmented_multipliers(
        handles.slave(slave), handles.friction("law.friction", law.friction), control.weight, control.square, control.gap, control.slip.T,
        control.metric.T, control.point_metric.T, int(law.summed), law.factors, law.pressure, law.base.T, law.slip_margin,
        int(law.forgiving), law.held, law.bears, law.free.T, int(law.elastic), law.smoothing,
    )  # fmt: skip
    if status:
        raise_status(status, -1)
    return Response(pressure, traction.T, state, pressure_slope, traction_slope.T, field_slip.T)


def friction_radius(friction: FrictionArrays, pressure: FloatArray) -> FloatArray:
    """Largest norms of control tractions under control pressures, both of shape (n,), force per area; 0 where open or without friction.

    Raises
    ------
    KernelError
        No law of friction has that number and so many parameters.
    """
    check.array("pressure", pressure, np.float64, None)
    radius, status = _kernel.friction_radius(handles.friction("friction", friction), pressure)
    if status:
        raise_status(status, -1)
    return np.asarray(radius)


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
    check_control(control, slave)
    check_law(law, slave)
    check.kind("row_pattern", row_pattern, Pattern)
    check.kind("wide", wide, Pattern)
    points, columns = slave.test.count, max(row_pattern.highest, wide.highest) + 1
    check_response(response, slave)
    check_rows(row_pattern, rows, points, columns)
    if bool(law.summed) != (rows.shape[1] == ROW_KINDS["paper"]):
        raise InputError(f"has {rows.shape[1]} kinds; allowed: {ROW_KINDS['paper']} with the law's slip sum, others without it", "rows")
    check_pattern("neighbours", neighbours, points, points)
    check_pattern("wide", wide, points, columns)
    changes, trial, status, place = _kernel.multiplier_rows(
        handles.slave(slave), control.weight, control.square, control.slip.T, control.metric.T, control.point_metric.T,
        law.factors, response.state, response.pressure_slope, response.traction_slope.T,
        handles.pattern("row_pattern", row_pattern), rows.T,
        handles.pattern("neighbours", neighbours), handles.pattern("wide", wide), len(wide.column),
    )  # fmt: skip
    if status:
        raise_status(status, place - 1)
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
    check_rows(row_pattern, rows, points, columns)
    check_pattern("wide", wide, points, columns)
    check.array("changes", changes, np.float64, len(wide.column), 3, 3)
    check_pattern("pattern", pattern, columns, columns)
    check.array("tangent", tangent, np.float64, len(pattern.column), 3, 3)
    status, place = _kernel.condense_multipliers(
        state,
        handles.pattern("row_pattern", row_pattern),
        rows.T,
        handles.pattern("wide", wide),
        changes.T,
        handles.pattern("pattern", pattern),
        tangent.T,
    )
    if status:
        raise_status(status, place - 1)
