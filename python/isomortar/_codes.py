"""The kernel's numbers, by name: statuses, states of control points, kinds of constraint rows, counts.

They are given in Fortran; a test compares these with the sources.
"""

from __future__ import annotations

from enum import IntEnum


class Status(IntEnum):
    """How a call of the kernel ended (isomortar_base_status)."""

    OK = 0
    FOLDED = 1
    FOLDED_INITIALLY = 2
    LOST_PROJECTION = 3
    DEGENERATE_SURFACE = 4
    SINGULAR = 5
    STALE_HANDLE = 6
    OUT_OF_MEMORY = 7
    LIBRARY = 8
    PATTERN = 9
    NOT_FINITE = 10
    PASSED_THROUGH = 11
    NO_SLIP = 12
    NO_SUCH_LAW = 13


class PointState(IntEnum):
    """State of a constraint of a contact (isomortar_contact_friction_return_map)."""

    OPEN = 0
    STICK = 1
    SLIP = 2


class FirstRow(IntEnum):
    """First constraint row of each kind, from 1 (isomortar_contact_rows): <R dg>, <R slip>, <R dxi>, <R R da_ab>, <R da_ab zeta^b>."""

    PRESSURE_WORK = 1
    TRACTION_WORK = 2
    SLIP = 4
    METRIC = 6
    SLIP_SUM = 9


#: How many kinds of rows there are without friction, with it, and with the paper's slip sum; along averaged normals one more: <R dg> as it
#: is, not as pressures work on it (isomortar_contact_rows).
ROW_KINDS = {"frictionless": 1, "frictionless, averaged": 2, "local": 8, "local, averaged": 9, "paper": 10}

#: What the passes over contact points count, in the order of the kernel (isomortar_contact_work).
WORK = (
    "warm projections",
    "cold projections",
    "elements searched",
    "contact points",
    "evaluations to order 0",
    "evaluations to order 1",
    "evaluations to order 2",
    "evaluations to order 3",
)
