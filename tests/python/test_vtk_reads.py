"""ParaView's files of real runs, read and evaluated by VTK: volumes, positions and all fields are those that the program evaluates.

`python tests/python/test_vtk_reads.py` prints how far they are apart.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pytest

import isomortar
from isomortar.geometry.patch import Direction, FloatArray
from isomortar.model.entities import Body
from isomortar.results.bezier import bernstein, bezier_matrix, fitted, functions_at, inner_places, rational, rational_gradient
from isomortar.results.fields import ContactSurface, body_points, contact_surfaces
from isomortar.results.not_negative import not_negative
from isomortar.results.ranges import ROUND_OFF
from isomortar.results.stress import cauchy_stress, deformation_gradient, von_mises
from isomortar.results.vectors import ContactVectors, contact_vectors

pytest.importorskip("vtkmodules")
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import mutable
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

#: Largest share of a field's largest value that VTK and the program may be apart by.
APART = 1e-10
#: Gauss points a direction for the volume of cells of rational functions, and of polynomials of orders up to 4.
POINTS = {"N": 14, "L": 7}
#: Places of a cell, in its own coordinates, where fields are compared.
PLACES = np.random.default_rng(4).uniform(0.0, 1.0, (5, 3))

SCENES = {
    "ring": (
        [8, 1, 1],
        """
format = 1
[bodies.ring]
geometry = { kind = "ring", centre = [0, 0, 0.5], inner = 0.25, outer = 0.5, width = 0.25 }
MESH
[contacts.road]
slave = "ring.v1"
plane = { point = [0, 0, 0] }
[supports.rim]
face = "ring.v0"
[[stages]]
name = "press"
steps = 2
motions.rim.translate = [0.01, 0, -0.05]
""",
    ),
    "octant with a pole in contact": (
        [2, 2, 2],
        """
format = 1
[bodies.ball]
geometry = { kind = "sphere", outer = 1.0, latitudes = [-90, 0], angles = [0, 90] }
MESH
[contacts.floor]
slave = "ball.v1"
plane = { point = [0, 0, -1] }
friction = 0
[supports]
equator = { face = "ball.w1", components = ["z"] }
x = { face = "ball.u1", components = ["x"] }
y = { face = "ball.u0", components = ["y"] }
[[stages]]
name = "press"
steps = 2
motions.equator.translate = [0, 0, -0.2]
""",
    ),
    "two bodies that slide": (
        [2, 2, 1],
        """
format = 1
[bodies.slave]
geometry = { kind = "bowl", half_width = 0.375, bottom = 0.0, rise = 0.1, top = 0.5 }
MESH
[bodies.master]
geometry = { kind = "box", lower = [-0.75, -0.75, -0.5], upper = [0.75, 0.75, 0.0] }
MESH
[contacts.interface]
slave = "slave.w0"
master = "master.w1"
friction = 0.3
[supports]
top.face = "slave.w1"
base.face = "master.w0"
[[stages]]
name = "press"
steps = 2
motions.top.translate = [0.02, 0, -0.1]
""",
    ),
    "block between a rigid ball and a plane": (
        [2, 2, 1],
        """
format = 1
[bodies.block]
geometry = { kind = "box", lower = [-0.5, -0.5, 0.0], upper = [0.5, 0.5, 0.5] }
MESH
[bodies.die]
geometry = { kind = "cap", radius = 2.0, half_width = 0.4, bottom = 0.5, top = 0.8 }
rigid = true
[contacts.die]
slave = "block.w1"
master = "die.w0"
friction = 0.1
[contacts.floor]
slave = "block.w0"
plane = { point = [0, 0, 0] }
[supports]
die.face = "die.w1"
side.face = "block.u0"
[[stages]]
name = "press"
steps = 2
motions.die.translate = [0, 0, -0.05]
""",
    ),
}


#: A rational field of two or three directions: directions, weights, values by control point.
Net = tuple[tuple[Direction, ...], FloatArray, FloatArray]
#: By kind of grid the cells of VTK's, a patch each with its fields.
Cells = dict[str, FloatArray]


class Grid:
    """A .vtu file as VTK reads it; fields of a cell by VTK's own interpolation."""

    def __init__(self, path: Path) -> None:
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(path))
        reader.Update()
        self._grid = reader.GetOutput()
        data = self._grid.GetPointData()
        self._fields = {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}
        self.numbers = vtk_to_numpy(self._grid.GetCellData().GetArray("number"))

    def at(self, cell: int, places: FloatArray) -> Cells:
        """Places in space and all point data at places of a cell, shape (m, 3); a surface takes the first two coordinates."""
        shape, point = self._grid.GetCell(cell), [0.0, 0.0, 0.0]
        weights = [0.0] * shape.GetNumberOfPoints()
        rows, found = [], []
        for place in places:
            local = list(place) if shape.GetCellDimension() == 3 else [*place[:2], 0.0]
            shape.EvaluateLocation(mutable(0), local, point, weights)
            found.append(list(point))
            rows.append(list(weights))
        ids = [shape.GetPointId(i) for i in range(len(weights))]
        values = {name: np.array(rows) @ field[ids].reshape(len(ids), -1) for name, field in self._fields.items() if name != "weights"}
        return {"place": np.array(found), **values}

    def size(self, cell: int, count: int) -> float:
        """Volume of a cell or area: VTK's map at Gauss points, differentiated as the polynomial that goes through them there."""
        dimension = self._grid.GetCell(cell).GetCellDimension()
        points, weights = gauss(count)
        at = np.zeros((count**dimension, 3))
        at[:, :dimension] = np.stack(np.meshgrid(*[points] * dimension, indexing="ij"), axis=-1).reshape(-1, dimension)
        mapped = self.at(cell, at)["place"].reshape(*[count] * dimension, 3)
        slope = differentiation(points)
        columns = [np.moveaxis(np.tensordot(slope, mapped, axes=(1, axis)), 0, axis) for axis in range(dimension)]
        sizes = np.linalg.det(np.stack(columns, axis=-1)) if dimension == 3 else np.linalg.norm(np.cross(*columns), axis=-1)
        for _ in range(dimension):
            sizes = sizes @ weights
        return float(sizes)


def gauss(count: int) -> tuple[FloatArray, FloatArray]:
    """Points and weights on [0, 1]."""
    points, weights = np.polynomial.legendre.leggauss(count)
    return 0.5 + 0.5 * points, 0.5 * weights


def differentiation(points: FloatArray) -> FloatArray:
    """Matrix from values at points to the derivatives there of the polynomial that goes through them."""
    apart = points[:, None] - points + np.eye(len(points))
    factor = apart.prod(axis=1)
    matrix = factor[:, None] / factor / apart
    np.fill_diagonal(matrix, 0.0)
    return matrix - np.diag(matrix.sum(axis=1))


def elements(directions: tuple[Direction, ...]) -> Iterator[list[tuple[float, float]]]:
    """Ends of every element by direction, the first direction fastest."""
    for reverse in np.ndindex(*[d.elements for d in reversed(directions)]):
        yield [(d.boundaries[e], d.boundaries[e + 1]) for d, e in zip(directions, reverse[::-1], strict=True)]


def size(net: Net, ends: list[tuple[float, float]], count: int) -> float:
    """Volume of an element, or area, as the program's functions have it."""
    directions, weights, control = net
    points, quadrature = gauss(count)
    functions = [functions_at(d, a + points * (b - a)) for d, (a, b) in zip(directions, ends, strict=True)]
    _, slopes = rational_gradient(functions, weights, control)
    scaled = slopes * np.array([b - a for a, b in ends])
    sizes = np.linalg.det(scaled) if len(ends) == 3 else np.linalg.norm(np.cross(scaled[..., 0], scaled[..., 1]), axis=-1)
    product = np.ones(1)
    for _ in ends:
        product = np.outer(quadrature, product).ravel()
    return float(sizes @ product)


def value(net: Net, ends: list[tuple[float, float]], local: FloatArray) -> FloatArray:
    """A rational field at a place of an element."""
    directions, weights, control = net
    at = [functions_at(d, np.array([a + x * (b - a)]))[0] for d, (a, b), x in zip(directions, ends, local, strict=False)]
    return rational(at, weights, control)[0][0]


def fitted_value(net: Net, bezier: FloatArray, number: int, local: FloatArray) -> FloatArray:
    """A field by Bezier points of a patch at a place of an element, by Bernstein polynomials."""
    directions, weights, _ = net
    _, all_weights = rational([bezier_matrix(d) for d in directions], weights, weights[:, None])
    element = np.unravel_index(number, [d.elements for d in reversed(directions)])[::-1]
    rows = [d.order * e + np.arange(d.order + 1) for d, e in zip(directions, element, strict=True)]
    counts = [d.order * d.elements + 1 for d in directions]
    points = (rows[0] + counts[0] * (rows[1][:, None] + counts[1] * rows[2][:, None, None])).ravel()
    shares = np.ones(1)
    for d, x in zip(directions, local, strict=True):
        shares = np.outer(bernstein(d.order, np.array([x]))[0], shares).ravel()
    shares = shares * all_weights[points]
    return shares @ bezier[points] / shares.sum()


def solid_fields(body: Body, points: FloatArray, parameters: list[FloatArray]) -> Cells:
    """Stress as VTK has it, equivalent stress and J at a grid of parameters."""
    deformation = deformation_gradient(body, points, parameters)
    stress = np.zeros_like(deformation) if body.rigid else cauchy_stress(body.material, deformation)
    flat = stress[:, [0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]]
    return {"stress": flat, "von Mises stress": von_mises(stress)[:, None], "J": np.linalg.det(deformation)[:, None]}


def surface_fields(surface: ContactSurface, vectors: ContactVectors) -> Cells:
    """Control values of a slave face."""
    scalars = {"pressure": surface.pressure, "traction": surface.traction, "gap": surface.gap, "status": surface.status.astype(float)}
    moved = {"place": surface.points, "displacement": surface.points - surface.reference_points}
    return moved | {"traction vector": vectors.traction, "slip vector": vectors.slip} | {n: v[:, None] for n, v in scalars.items()}


class Apart:
    """Largest distances between what VTK has and the program, as shares of the largest value of each field."""

    def __init__(self) -> None:
        self._pairs = defaultdict[str, list[tuple[Any, Any]]](list)

    def add(self, name: str, seen: Any, expected: Any) -> None:
        self._pairs[name].append((np.asarray(seen), np.asarray(expected)))

    def shares(self) -> dict[str, float]:
        shares = {}
        for name, pairs in self._pairs.items():
            largest = np.max([np.abs(expected).max() for _, expected in pairs])
            shares[name] = float(np.max([np.abs(seen - expected).max() for seen, expected in pairs]) / (largest or 1.0))
        return shares


def figures(name: str, family: str, order: int, folder: Path, single: bool = False) -> dict[str, float]:
    """A scene computed, exported, and read: how far VTK and the program are apart, by field; `stress between`, how far stress is fitted.

    `single`: of one element a body, whose stress VTK has through the program's values.
    """
    counts, text = SCENES[name]
    orders = [order, 1, 1] if name == "ring" and family == "N" and order == 2 else [order] * 3
    mesh = f'mesh = {{ family = "{family}", order = {orders}, elements = {[1, 1, 1] if single else counts} }}'
    scene = isomortar.Scene.from_toml(text.replace("MESH", mesh))
    with isomortar.run(scene, folder / "run.h5", overwrite=True) as results:
        problem, last, before = results.problem, results.step(2), results.step(1)
    assert all(contact.active for contact in last.contacts), "nothing presses, nothing is seen"
    isomortar.export(folder / "run.h5", folder)
    apart, points = Apart(), body_points(problem, last.state.positions)

    grid, first = Grid(folder / "run" / "bodies-0002.vtu"), 0
    for body in problem.bodies:
        net = body.patch.directions, body.patch.weights, points[body.name]
        still = (*net[:2], points[body.name] - body.patch.control_points)
        exact = solid_fields(body, points[body.name], [inner_places(d) for d in net[0]])
        bezier = {field: fitted(*net[:2], values) for field, values in exact.items()}
        _, weights = rational([bezier_matrix(d) for d in net[0]], net[1], net[1][:, None])
        mises = bezier["von Mises stress"]
        mises[:, 0] = not_negative(net[0], weights, mises[:, 0], 0.0 if body.rigid else ROUND_OFF * body.material.young)
        for number, ends in enumerate(elements(net[0])):
            cell = first + number
            count = POINTS[net[0][0].family]
            apart.add("volume", grid.size(cell, count), size(net, ends, count))
            seen = grid.at(cell, PLACES)
            for k, local in enumerate(PLACES):
                apart.add("place", seen["place"][k], value(net, ends, local))
                apart.add("displacement", seen["displacement"][k], value(still, ends, local))
                own = solid_fields(body, points[body.name], [np.array([a + x * (b - a)]) for (a, b), x in zip(ends, local, strict=True)])
                for field, values in bezier.items():
                    apart.add(field, seen[field][k], fitted_value(net, values, number, local))
                    apart.add(f"{field} between", seen[field][k], own[field][0])
            if single and not body.rigid:
                inner = np.stack(np.meshgrid(*[inner_places(d) for d in net[0]], indexing="ij"), axis=-1).reshape(-1, 3, order="F")
                for field, values in exact.items():
                    apart.add(f"{field} at its places", grid.at(cell, inner)[field], values)
        first += number + 1

    grid, cell = Grid(folder / "run" / "contacts-0002.vtu"), 0
    for surface, vectors in zip(contact_surfaces(problem, last), contact_vectors(problem, last, before), strict=True):
        for ends in elements(surface.directions):
            face, count = (surface.directions, surface.weights, surface.points), POINTS[surface.directions[0].family]
            apart.add("area", grid.size(cell, count), size(face, ends, count))
            seen = grid.at(cell, PLACES)
            for field, values in surface_fields(surface, vectors).items():
                for k, local in enumerate(PLACES):
                    expected = value((surface.directions, surface.weights, values), ends, local)
                    apart.add(field if field not in ("place", "displacement") else f"{field} of faces", seen[field][k], expected)
            cell += 1
    return apart.shares()


KINDS = [("N", 2), ("N", 3), ("N", 4), ("L", 1), ("L", 2), ("L", 3), ("L", 4)]


@pytest.mark.parametrize(("name", "family", "order"), [(name, *kind) for i, name in enumerate(SCENES) for kind in KINDS[i % 2 :: 2]])
def test_vtk_has_what_the_program_has(tmp_path: Path, name: str, family: str, order: int) -> None:
    found = figures(name, family, order, tmp_path)
    assert {"volume", "area", "place", "displacement", "stress", "J", "pressure", "gap", "status"} <= set(found)
    assert {field: share for field, share in found.items() if not field.endswith("between") and not share < APART} == {}


def test_stress_of_a_single_element_goes_through_the_program_s_values(tmp_path: Path) -> None:
    found = figures("two bodies that slide", "N", 3, tmp_path, single=True)
    assert {field for field, share in found.items() if field.endswith("at its places") and share < APART} == {
        f"{field} at its places" for field in ("stress", "von Mises stress", "J")
    }


def main() -> None:
    """Print a row a scene and kind of mesh."""
    for name in SCENES:
        for family, order in KINDS:
            with TemporaryDirectory() as folder:
                found = figures(name, family, order, Path(folder))
            exact = [(share, field) for field, share in found.items() if not field.endswith("between")]
            between = ", ".join(f"{field} {share:.1e}" for field, share in found.items() if field.endswith("between"))
            shares = ", ".join(
                f"{field} {found[field]:.0e}" for field in ("volume", "area", "place", "stress", "J", "pressure", "gap", "traction vector")
            )
            print(f"{name}, {family}{order}: at most {max(exact)[0]:.1e} ({max(exact)[1]}); {shares}; fitted: {between}", flush=True)


if __name__ == "__main__":
    main()
