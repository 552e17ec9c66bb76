"""Faces of patches: functions, and the tables of a slave."""

from __future__ import annotations

import math

import numpy as np

from isomortar import _arguments as check
from isomortar._arguments import FloatArray, IntArray
from isomortar._arrays import PatchArrays
from isomortar._bindings import handles
from isomortar._bindings.statuses import raise_status
from isomortar._compiled import kernel as _kernel


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
    nodes, functions, status = _kernel.surface_functions(handles.patch(patch), axis, side, xi.T, first * second)
    if status:
        raise_status(status, -1)
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
        handles.patch(patch), axis, side, rule, reference.T, first * second, elements, points
    )
    if status:
        raise_status(status, -1)
    return np.ascontiguousarray(nodes.T), np.ascontiguousarray(values.T), np.ascontiguousarray(slopes.T), area
