"""Contact forces, constraint rows and the geometric tangent."""

from __future__ import annotations

import numpy as np

from isomortar import _arguments as check
from isomortar._arguments import FloatArray, LongArray
from isomortar._arrays import MasterArrays, Pattern, Projections, Response, SlaveArrays
from isomortar._bindings import handles
from isomortar._bindings.checks import check_bodies, check_counts, check_pattern, check_projections, check_response, check_rows
from isomortar._bindings.statuses import raise_status
from isomortar._compiled import kernel as _kernel


def contact_forces(
    slave: SlaveArrays,
    master: MasterArrays,
    positions: FloatArray,
    projections: Projections,
    response: Response,
    forces: FloatArray,
    with_friction: bool = True,
    counts: LongArray | None = None,
) -> None:
    """Add the contact forces on slave and master control points, those of tractions where these may act."""
    check_bodies(positions, slave, master)
    check_projections(projections, slave, master)
    check_response(response, slave)
    check.array("forces", forces, np.float64, len(positions), 3)
    status = _kernel.contact_forces(
        handles.slave(slave), handles.master(master), positions.T, projections.xi.T, projections.element.T, projections.fixed.T,
        projections.found, check.flag("with_friction", with_friction), response.pressure, response.traction.T, response.state,
        check_counts(counts), forces.T,
    )  # fmt: skip
    if status:
        raise_status(status, -1)


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
    counts: LongArray | None = None,
) -> None:
    """Add constraint rows, shape (blocks, kinds, 3), and the geometric tangent, shape (blocks, 3, 3).

    Raises
    ------
    KernelError
        A pattern lacks a block.
    """
    check_bodies(positions, slave, master)
    check_projections(projections, slave, master)
    check_response(response, slave)
    check_rows(row_pattern, rows, slave.test.count, len(positions))
    check_pattern("pattern", pattern, len(positions), len(positions))
    check.array("tangent", tangent, np.float64, len(pattern.column), 3, 3)
    status, place = _kernel.contact_blocks(
        handles.slave(slave), handles.master(master), positions.T, projections.xi.T, projections.element.T, projections.fixed.T,
        projections.found, projections.origin.T, projections.slips, check.flag("with_friction", with_friction), response.pressure,
        response.traction.T, response.state, response.field_slip.T, handles.pattern("row_pattern", row_pattern), rows.T,
        handles.pattern("pattern", pattern), tangent.T, check_counts(counts),
    )  # fmt: skip
    if status:
        raise_status(status, place - 1)
