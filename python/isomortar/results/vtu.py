"""Bezier cells as VTK counts them, and the XML file (.vtu) that holds them."""

from __future__ import annotations

import base64
from collections.abc import Mapping
from dataclasses import field
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from isomortar._frozen import frozen
from isomortar.geometry.patch import Direction, FloatArray
from isomortar.results.bezier import bezier_matrix, rational

_QUADRILATERAL, _HEXAHEDRON = 77, 79
_TYPES = {"float64": "Float64", "int64": "Int64", "uint8": "UInt8"}


@frozen
class BezierGrid:
    """Bezier cells of one patch: points with rational weights and fields; cells with their points in VTK's order.

    `orders`: of the cells along the three directions (a surface has 0 in the third). `number`: of the body or contact pair. `of_cells`:
    further fields, a value a cell.
    """

    points: FloatArray
    weights: FloatArray
    fields: dict[str, FloatArray]
    cells: NDArray[np.int64]
    orders: tuple[int, int, int]
    number: int
    of_cells: dict[str, FloatArray] = field(default_factory=dict)


def bezier_grid(
    directions: tuple[Direction, ...],
    weights: FloatArray,
    points: FloatArray,
    fields: dict[str, FloatArray],
    number: int,
    fitted: Mapping[str, FloatArray] | None = None,
) -> BezierGrid:
    """A patch of two or three directions as Bezier cells.

    Parameters
    ----------
    directions : tuple of Direction
    weights : ndarray, shape (n,)
    points : ndarray, shape (n, 3)
    fields : dict of ndarray, shape (n, k)
        By control point.
    number : int
    fitted : mapping of str to ndarray, shape (b, k)
        Further fields, by Bezier point (`isomortar.results.bezier.fitted`).
    """
    values, bezier_weights = rational([bezier_matrix(d) for d in directions], weights, np.column_stack([points, *fields.values()]))
    ends = np.cumsum([3, *(field.shape[1] for field in fields.values())])
    parts = {name: values[:, begin:end] for name, begin, end in zip(fields, ends[:-1], ends[1:], strict=True)}
    parts |= fitted or {}
    orders = [d.order for d in directions] + [0] * (3 - len(directions))
    elements = [d.elements for d in directions] + [1] * (3 - len(directions))
    return BezierGrid(values[:, :3], bezier_weights, parts, _cells(orders, elements), (orders[0], orders[1], orders[2]), number)


def write_vtu(path: Path, grids: list[BezierGrid]) -> None:
    """Write the grids into one file. They have the same fields."""
    root = ElementTree.Element("VTKFile", type="UnstructuredGrid", version="2.2", byte_order="LittleEndian", header_type="UInt64")
    counts = [len(grid.points) for grid in grids]
    starts = np.cumsum([0, *counts[:-1]])
    sizes = np.concatenate([np.full(len(grid.cells), grid.cells.shape[1]) for grid in grids])
    piece = ElementTree.SubElement(
        ElementTree.SubElement(root, "UnstructuredGrid"), "Piece", NumberOfPoints=str(sum(counts)), NumberOfCells=str(len(sizes))
    )
    point_data = ElementTree.SubElement(piece, "PointData", RationalWeights="weights")
    _array(point_data, "weights", np.concatenate([grid.weights for grid in grids]))
    for name in grids[0].fields:
        _array(point_data, name, np.concatenate([grid.fields[name] for grid in grids]))
    cell_data = ElementTree.SubElement(piece, "CellData", HigherOrderDegrees="orders")
    _array(cell_data, "orders", np.concatenate([np.tile(np.asarray(grid.orders, np.int64), (len(grid.cells), 1)) for grid in grids]))
    _array(cell_data, "number", np.concatenate([np.full(len(grid.cells), grid.number) for grid in grids]))
    for name in grids[0].of_cells:
        _array(cell_data, name, np.concatenate([grid.of_cells[name] for grid in grids]))
    _array(ElementTree.SubElement(piece, "Points"), "points", np.concatenate([grid.points for grid in grids]))
    cells = ElementTree.SubElement(piece, "Cells")
    _array(cells, "connectivity", np.concatenate([(grid.cells + start).ravel() for grid, start in zip(grids, starts, strict=True)]))
    _array(cells, "offsets", np.cumsum(sizes))
    kinds = [_HEXAHEDRON if grid.orders[2] else _QUADRILATERAL for grid in grids]
    _array(cells, "types", np.repeat(np.asarray(kinds, np.uint8), [len(grid.cells) for grid in grids]))
    ElementTree.ElementTree(root).write(path, encoding="utf-8", xml_declaration=True)


def _array(parent: ElementTree.Element, name: str, values: NDArray[np.generic]) -> None:
    """Add an array, as its length in bytes and its bytes, both in base 64."""
    components = values.shape[1] if values.ndim == 2 else 1
    element = ElementTree.SubElement(
        parent, "DataArray", type=_TYPES[str(values.dtype)], Name=name, NumberOfComponents=str(components), format="binary"
    )
    content = np.ascontiguousarray(values).tobytes()
    element.text = base64.b64encode(np.uint64(len(content)).tobytes() + content).decode()


def _cells(orders: list[int], elements: list[int]) -> NDArray[np.int64]:
    """Bezier points of each element in VTK's order, shape (elements, points); first direction fastest among both."""
    local = np.array(_places(*orders))
    first = np.stack(np.meshgrid(*(np.arange(n) for n in elements), indexing="ij"), axis=-1).reshape(-1, 3, order="F") * orders
    net = [order * n + 1 for order, n in zip(orders, elements, strict=True)]
    place = first[:, None, :] + local
    return place[..., 0] + net[0] * (place[..., 1] + net[1] * place[..., 2])


def _places(p: int, q: int, r: int) -> list[tuple[int, int, int]]:
    """Places (i, j, k) of the Bezier points of a cell in VTK's order: corners, edges, faces, inside; r = 0: a quadrilateral."""
    corners = [(0, 0), (p, 0), (p, q), (0, q)]
    x, y, z = range(1, p), range(1, q), range(1, r)
    edges = [(i, 0) for i in x] + [(p, j) for j in y] + [(i, q) for i in x] + [(0, j) for j in y]
    inner = [(i, j) for j in y for i in x]
    if r == 0:
        return [(i, j, 0) for i, j in corners + edges + inner]
    ends = (0, r)
    return (
        [(i, j, k) for k in ends for i, j in corners]
        + [(i, j, k) for k in ends for i, j in edges]
        + [(i, j, k) for i, j in corners for k in z]
        + [(i, j, k) for i in (0, p) for k in z for j in y]
        + [(i, j, k) for j in (0, q) for k in z for i in x]
        + [(i, j, k) for k in ends for i, j in inner]
        + [(i, j, k) for k in z for i, j in inner]
    )
