"""Checks that arguments of a call fit together: each raises an error that names the argument."""

from __future__ import annotations

import numpy as np

from isomortar import _arguments as check
from isomortar._arguments import FloatArray, LongArray
from isomortar._arrays import (
    Control,
    FaceArrays,
    FrictionArrays,
    Law,
    MasterArrays,
    Pattern,
    PlaneArrays,
    Projections,
    Response,
    SlaveArrays,
)
from isomortar._codes import ROW_KINDS, WORK
from isomortar.errors import InputError


def check_bodies(positions: FloatArray, slave: SlaveArrays, master: MasterArrays) -> None:
    """Refuse positions, and sides of a contact that name control points which have none."""
    check.kind("slave", slave, SlaveArrays)
    check.kind("master", master, PlaneArrays, FaceArrays)
    check.finite("positions", check.array("positions", positions, np.float64, None, 3))
    check.below("slave.point", slave.highest, len(positions), "control point")
    check.below("master.point", master.highest, len(positions), "control point")


def check_projections(projections: Projections, slave: SlaveArrays, master: MasterArrays) -> None:
    """Refuse feet of another slave, or on elements that the master does not have."""
    check.kind("projections", projections, Projections)
    check.array("projections.found", projections.found, np.int32, len(slave.area))
    low, first, second = projections.range
    if master.elements is not None and not (low >= 0 and first < master.elements[0] and second < master.elements[1]):
        raise InputError(f"names elements {low} to {first}, {second}; the master has {master.elements}", "projections.element")


def check_control(control: Control, slave: SlaveArrays) -> None:
    """Refuse control quantities of another slave."""
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


def check_law(law: Law, slave: SlaveArrays) -> None:
    """Refuse a law with multipliers of another slave, or numbers that it does not know."""
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
    least = 0.0
    if law.stretch is not None:
        check.array("law.stretch", law.stretch, np.float64, n, 2)
        least = float(np.finfo(np.float64).tiny)
    check.real("law.elastic_slip", law.elastic_slip, lambda value: value >= least, "a number above 0; 0 where nothing is stretched")
    check.real("law.smoothing", law.smoothing, lambda value: value >= 0, "a number from 0")
    check.real("law.slip_margin", law.slip_margin, lambda value: 0 <= value <= 1, "a number from 0 to 1")


def check_response(response: Response, slave: SlaveArrays) -> None:
    """Refuse a response of another slave."""
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


def check_pattern(name: str, pattern: Pattern, rows: int, columns: int) -> None:
    """Refuse a pattern with another number of rows, or columns beyond theirs."""
    check.kind(name, pattern, Pattern)
    check.array(f"{name}.start", pattern.start, np.int32, rows + 1)
    check.below(f"{name}.column", pattern.highest, columns, "column")


def check_rows(pattern: Pattern, rows: FloatArray, constraints: int, control_points: int) -> None:
    """Refuse constraint rows of another number, or of a number of kinds that there is not."""
    check_pattern("row_pattern", pattern, constraints, control_points)
    kinds = check.array("rows", rows, np.float64, len(pattern.column), None, 3).shape[1]
    if kinds not in ROW_KINDS.values():
        raise InputError(f"has {kinds} kinds; allowed: {', '.join(map(str, ROW_KINDS.values()))}", "rows")


def check_counts(counts: LongArray | None) -> LongArray:
    """Counts for the kernel to add to (`WORK`): those given; where nobody asks, some of nobody's."""
    return np.zeros(len(WORK), dtype=np.int64) if counts is None else check.array("counts", counts, np.int64, len(WORK))
