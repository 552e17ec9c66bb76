"""Where a slave is on its master: feet, gaps and slips."""

from __future__ import annotations

import numpy as np

from isomortar import _arguments as check
from isomortar._arguments import FloatArray, IntArray, LongArray
from isomortar._arrays import Control, MasterArrays, Projections, SlaveArrays
from isomortar._bindings import handles
from isomortar._bindings.checks import check_bodies, check_counts, check_projections
from isomortar._bindings.statuses import raise_status
from isomortar._compiled import kernel as _kernel


def project_points(
    slave: SlaveArrays,
    master: MasterArrays,
    positions: FloatArray,
    origin: FloatArray,
    had: IntArray,
    with_friction: bool = True,
    counts: LongArray | None = None,
    near: Projections | None = None,
) -> Projections:
    """Project every slave quadrature point: from its foot in `near`, else from `origin` where `had` is 1, else from a coarse search.

    `origin` is also where the slip increment is counted from, zero where it is not wanted. What is done is added to `counts`, shape (8,),
    one number each of `_codes.WORK`.

    Raises
    ------
    LostProjectionError
        With the number of the quadrature point.
    """
    check_bodies(positions, slave, master)
    q = len(slave.area)
    check.finite("origin", check.array("origin", origin, np.float64, q, 2))
    check.array("had", had, np.int32, q)
    xi, started, counts = origin.copy(), had, check_counts(counts)
    if near is not None:
        check_projections(near, slave, master)
        xi, started = np.where(near.found[:, None] != 0, near.xi, origin), np.maximum(near.found, had)
    element, fixed, found, doubt, slip, slips, status, place = _kernel.project_points(
        handles.slave(slave), handles.master(master), positions.T, started, origin.T, had,
        check.flag("with_friction", with_friction), counts, xi.T,
    )  # fmt: skip
    if status:
        raise_status(status, place - 1)
    return Projections(xi, element.T, fixed.T, found, doubt, origin, slip.T, slips)


def control_quantities(
    slave: SlaveArrays,
    master: MasterArrays,
    positions: FloatArray,
    projections: Projections,
    with_friction: bool = True,
    counts: LongArray | None = None,
) -> Control:
    """Integrate the control quantities of every constraint; slips and metric are zero where these are not wanted."""
    check_bodies(positions, slave, master)
    check_projections(projections, slave, master)
    weight, square, gap, slip, metric, point_metric, status = _kernel.control_quantities(
        handles.slave(slave), handles.master(master), positions.T, projections.xi.T, projections.element.T, projections.fixed.T,
        projections.found, projections.slip.T, slave.test.count, check.flag("with_friction", with_friction), check_counts(counts),
    )  # fmt: skip
    if status:
        raise_status(status, -1)
    return Control(weight, square, gap, slip.T, metric.T, point_metric.T)


def find_climbs(
    slave: SlaveArrays, master: MasterArrays, positions: FloatArray, projections: Projections, counts: LongArray | None = None
) -> FloatArray:
    """How far the foot of every slave quadrature point has climbed along its normal since `origin` (theory 3.31), shape (points,)."""
    check_bodies(positions, slave, master)
    check_projections(projections, slave, master)
    climbs, status = _kernel.find_climbs(
        handles.master(master), positions.T, projections.xi.T, projections.origin.T, projections.slips, check_counts(counts)
    )
    if status:
        raise_status(status, -1)
    return np.asarray(climbs)
