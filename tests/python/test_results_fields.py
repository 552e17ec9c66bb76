"""Fields: Bezier conversion against independent evaluation, exported cells as VTK itself reads and evaluates them."""

from __future__ import annotations

import dataclasses
from itertools import pairwise
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import BSpline, lagrange
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import mutable
from vtkmodules.vtkCommonDataModel import vtkBezierHexahedron
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

from isomortar.geometry.patch import Direction
from isomortar.model.numbering import Numbering
from isomortar.results import ResultsWriter
from isomortar.results.bezier import bernstein, bezier_matrix, sampling_matrix
from isomortar.results.fields import body_points, contact_surfaces
from isomortar.results.paraview import export
from isomortar.results.vtu import _places
from results_samples import INNER, OUTER, WIDTH, problem, step_result


@st.composite
def directions(draw: st.DrawFn) -> Direction:
    """A direction of either family with uneven elements and inner knots of any multiplicity."""
    steps = draw(st.lists(st.floats(0.01, 1.0), min_size=1, max_size=4))
    ends = np.cumsum([0.0, *steps]) - 0.5
    if draw(st.booleans()):
        return Direction("L", draw(st.integers(1, 4)), ends)
    order = draw(st.integers(1, 10))
    inner = [draw(st.integers(1, order)) for _ in ends[1:-1]]
    return Direction("N", order, np.repeat(ends, [order + 1, *inner, order + 1]))


def reference_value(direction: Direction, coefficients: np.ndarray, place: float) -> float:
    """The function of a direction by de Boor's algorithm, or by Lagrange's formula on the element."""
    if direction.family == "N":
        return float(BSpline(direction.knots, coefficients, direction.order)(place))
    element = min(int(np.searchsorted(direction.knots, place, side="right")) - 1, direction.elements - 1)
    p = direction.order
    nodes = np.linspace(*direction.knots[element : element + 2], p + 1)
    return float(lagrange(nodes - nodes[0], coefficients[p * element : p * element + p + 1])(place - nodes[0]))


@given(directions(), st.integers(0, 2**32 - 1))
def test_sampling_is_the_function_itself(direction: Direction, seed: int) -> None:
    coefficients = np.random.default_rng(seed).normal(size=direction.count)
    samples = sampling_matrix(direction, 3) @ coefficients
    ends = direction.boundaries
    places = [*np.concatenate([np.linspace(a, b, 4)[:-1] for a, b in pairwise(ends)]), ends[-1]]
    expected = [reference_value(direction, coefficients, x) for x in places]
    assert samples == pytest.approx(expected, abs=1e-11)


def test_bezier_points_lie_at_the_ends_of_elements() -> None:
    direction = Direction("N", 3, [0, 0, 0, 0, 1, 1, 2.5, 4, 4, 4, 4])
    coefficients = np.arange(direction.count) ** 1.5
    bezier = bezier_matrix(direction) @ coefficients
    assert bezier[::3] == pytest.approx(BSpline(direction.knots, coefficients, 3)([0, 1, 2.5, 4]), abs=1e-13)
    assert bernstein(3, np.array([0.2])).sum() == pytest.approx(1)


def test_contact_values_sit_at_their_control_points() -> None:
    """The ring's slave face meets its seam twice; values there are the same, and every value is where its point is."""
    made, result = problem(), step_result(1)
    numbering = Numbering(made)
    slave_points = list(dict.fromkeys(numbering.points["tyre"][made.bodies[0].patch.face_points("v1")]))  # first occurrence
    heights = result.state.positions[slave_points, 2]
    state = dataclasses.replace(result.state, contacts=tuple(dataclasses.replace(c, pressure=heights) for c in result.state.contacts))
    for surface in contact_surfaces(made, dataclasses.replace(result, state=state)):
        assert len(surface.points) == 18
        assert np.array_equal(surface.pressure, surface.points[:, 2])


def test_reference_positions_give_the_patches_back() -> None:
    made = problem()
    points = body_points(made, Numbering(made).reference)
    for body in made.bodies:
        assert points[body.name] == pytest.approx(body.patch.control_points, abs=1e-15)


def at_rest(path: Path) -> Path:
    """Results file with one step: bodies in their reference configuration, made-up contact values."""
    made, result = problem(), step_result(1)
    state = dataclasses.replace(result.state, positions=Numbering(made).reference)
    writer = ResultsWriter(path, made, "", "0")
    writer.recorded(dataclasses.replace(result, state=state))
    return path


def read(path: Path) -> Any:
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def integrate(grid: Any, cell: int, dimension: int) -> float:
    """Volume or area of a cell: Gauss quadrature of VTK's own map, differentiated by central differences."""
    places, weights = np.polynomial.legendre.leggauss(8)
    places, weights = 0.5 + 0.5 * places, 0.5 * weights
    shape = grid.GetCell(cell)
    total, h = 0.0, 1e-5
    for index in np.ndindex(*[8] * dimension):
        at = np.zeros(3)
        at[:dimension] = places[list(index)]
        columns = []
        for axis in range(dimension):
            step = h * np.eye(3)[axis]
            columns.append((evaluate(shape, at + step) - evaluate(shape, at - step)) / (2 * h))
        size = abs(np.linalg.det(columns)) if dimension == 3 else np.linalg.norm(np.cross(*columns))
        total += size * np.prod(weights[list(index)])
    return float(total)


def evaluate(cell: Any, place: np.ndarray) -> np.ndarray:
    point = [0.0, 0.0, 0.0]
    weights = [0.0] * cell.GetNumberOfPoints()
    cell.EvaluateLocation(mutable(0), list(place), point, weights)
    return np.array(point)


def test_vtk_sees_the_exact_ring(tmp_path: Path) -> None:
    collection = export(at_rest(tmp_path / "run.h5"), tmp_path / "out")
    bodies = read(tmp_path / "out" / "run" / "bodies-0001.vtu")
    numbers = vtk_to_numpy(bodies.GetCellData().GetArray("number"))
    volumes = np.array([integrate(bodies, cell, 3) for cell in range(bodies.GetNumberOfCells())])
    assert volumes[numbers == 0].sum() == pytest.approx(np.pi * (OUTER**2 - INNER**2) * WIDTH, rel=1e-8)
    assert volumes[numbers == 1].sum() == pytest.approx(3.0 * 1.0 * 0.5, rel=1e-8)
    contacts = read(tmp_path / "out" / "run" / "contacts-0001.vtu")
    areas = np.array([integrate(contacts, cell, 2) for cell in range(contacts.GetNumberOfCells())])
    assert areas.sum() == pytest.approx(2 * 2 * np.pi * OUTER * WIDTH, rel=1e-8)
    entries = ElementTree.parse(collection).getroot().findall(".//DataSet")
    assert [(e.get("timestep"), (collection.parent / str(e.get("file"))).is_file()) for e in entries] == [("1.0", True)] * 2


def test_vtk_sees_the_pressure_field(tmp_path: Path) -> None:
    """At the middle of each cell VTK's interpolation of the pressure is the rational sum R^I p^I."""
    path = at_rest(tmp_path / "run.h5")
    export(path, tmp_path)
    contacts = read(tmp_path / "run" / "contacts-0001.vtu")
    pressure = contacts.GetPointData().GetArray("pressure")
    seen = []
    for number in range(contacts.GetNumberOfCells()):
        cell = contacts.GetCell(number)
        point, weights = [0.0] * 3, [0.0] * cell.GetNumberOfPoints()
        cell.EvaluateLocation(mutable(0), [0.5, 0.5, 0.0], point, weights)
        seen.append(sum(w * pressure.GetValue(cell.GetPointId(i)) for i, w in enumerate(weights)))
    made = problem()
    expected = []
    for surface in contact_surfaces(made, step_result(1)):
        matrices = (sampling_matrix(surface.directions[0], 2), sampling_matrix(surface.directions[1], 2))
        _, field, _ = surface.fields(matrices)
        grid = field.reshape(matrices[1].shape[0], matrices[0].shape[0])
        expected += list(grid[1::2, 1::2].ravel())
    assert seen == pytest.approx(expected, abs=1e-13)


@pytest.mark.parametrize("orders", [(1, 1, 1), (2, 3, 4), (3, 1, 2), (1, 4, 3)])
def test_places_are_counted_as_vtk_does(orders: tuple[int, int, int]) -> None:
    cell = vtkBezierHexahedron()
    counted = [cell.PointIndexFromIJK(i, j, k, [*orders, 0]) for i, j, k in _places(*orders)]
    assert counted == list(range(int(np.prod(np.add(orders, 1)))))
