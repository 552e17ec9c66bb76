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
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.model.numbering import Numbering
from isomortar.results import ResultsWriter
from isomortar.results.bezier import bernstein, bezier_matrix, fitted, functions_at, inner_places, rational, sampling_matrix
from isomortar.results.fields import body_points, contact_surfaces
from isomortar.results.paraview import export
from isomortar.results.stress import deformation_gradient, first_piola_stress
from isomortar.results.vectors import contact_vectors
from isomortar.results.vtu import _places
from isomortar.scene import Scene
from isomortar.solve.record import StepResult
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
    there = [(e.get("timestep"), (collection.parent / str(e.get("file"))).is_file()) for e in entries]
    assert there == [("0.0", True)] * 2 + [("1.0", True)] * 2


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
        field = surface.field(matrices, surface.pressure[:, None])
        grid = field.reshape(matrices[1].shape[0], matrices[0].shape[0])
        expected += list(grid[1::2, 1::2].ravel())
    assert seen == pytest.approx(expected, abs=1e-13)


@pytest.mark.parametrize("orders", [(1, 1, 1), (2, 3, 4), (3, 1, 2), (1, 4, 3)])
def test_places_are_counted_as_vtk_does(orders: tuple[int, int, int]) -> None:
    cell = vtkBezierHexahedron()
    counted = [cell.PointIndexFromIJK(i, j, k, [*orders, 0]) for i, j, k in _places(*orders)]
    assert counted == list(range(int(np.prod(np.add(orders, 1)))))


#: Fields of bodies that no functions give.
SOLID = ("stress", "von Mises stress", "J")


def functions_of(direction: Direction, place: float) -> np.ndarray:
    """All functions of a direction at a place, by SciPy alone."""
    return np.array([reference_value(direction, unit, place) for unit in np.eye(direction.count)])


def field_at(directions: tuple[Direction, ...], weights: np.ndarray, values: np.ndarray, places: list[float]) -> np.ndarray:
    """A rational field: the sum over all control points, first direction fastest."""
    product = np.ones(1)
    for direction, place in zip(directions, places, strict=True):
        product = np.outer(functions_of(direction, place), product).ravel()
    return (product * weights) @ values / (product @ weights)


def seen(grid: Any, number: int, local: np.ndarray) -> dict[str, np.ndarray]:
    """What VTK interpolates in a cell at its own coordinates: the place and all point data."""
    cell = grid.GetCell(number)
    point, weights = [0.0] * 3, [0.0] * cell.GetNumberOfPoints()
    cell.EvaluateLocation(mutable(0), list(local), point, weights)
    data = grid.GetPointData()
    arrays = {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}
    ids = [cell.GetPointId(i) for i in range(cell.GetNumberOfPoints())]
    return {"place": np.array(point)} | {name: np.asarray(weights) @ values[ids] for name, values in arrays.items() if name != "weights"}


def expected_patches(
    made: Problem, step: StepResult, before: StepResult | None
) -> dict[str, list[tuple[tuple[Direction, ...], np.ndarray, dict[str, np.ndarray]]]]:
    """Directions, weights and control values of every body and slave face, put together by hand."""
    points = body_points(made, step.state.positions)
    bodies, faces = [], []
    for body in made.bodies:
        place = points[body.name]
        bodies.append((body.patch.directions, body.patch.weights, {"place": place, "displacement": place - body.patch.control_points}))
    tyre = made.bodies[0].patch
    outer = tyre.face_points("v1")
    twice = np.concatenate([np.arange(16).reshape(8, 2), [[0, 1]]])  # along u the last control points are the first ones; w runs first
    vectors = contact_vectors(made, step, before)
    for state, measured, of_contact in zip(step.state.contacts, step.contacts, vectors, strict=True):
        control = {"place": points["tyre"][outer], "displacement": points["tyre"][outer] - tyre.control_points[outer]}
        control |= {"pressure": state.pressure[twice.ravel()], "traction": measured.traction_norm[twice.ravel()]}
        control |= {"gap": measured.gap[twice.ravel()], "status": measured.status[twice.ravel()].astype(float)}
        control |= {"traction vector": of_contact.traction, "slip vector": of_contact.slip} if step.step else _no_vectors(outer)
        faces.append((tyre.face_directions("v1"), tyre.weights[outer], control))
    return {"bodies": bodies, "contacts": faces}


def _no_vectors(points: np.ndarray) -> dict[str, np.ndarray]:
    return {name: np.zeros((len(points), 3)) for name in ("traction vector", "slip vector")}


def rest(made: Problem, step: StepResult) -> StepResult:
    """Before the first load step: nothing has moved, nothing presses."""
    contacts = [dataclasses.replace(s, pressure=np.zeros_like(s.pressure)) for s in step.state.contacts]
    state = dataclasses.replace(step.state, positions=Numbering(made).reference, contacts=tuple(contacts))
    measured = [dataclasses.replace(c, traction_norm=np.zeros_like(c.traction_norm), status=np.zeros_like(c.status)) for c in step.contacts]
    return dataclasses.replace(step, step=0, state=state, contacts=tuple(measured))


def test_vtk_sees_every_field_of_every_step_at_any_place(tmp_path: Path) -> None:
    """In each cell VTK's interpolation of place, displacement, pressure and traction is the sum over the control points of its patch."""
    made, random = problem(), np.random.default_rng(3)
    writer = ResultsWriter(tmp_path / "run.h5", made, "", "0")
    steps = [step_result(number) for number in (1, 2)]
    for step in steps:
        writer.recorded(step)
    collection = export(tmp_path / "run.h5", tmp_path)
    entries = ElementTree.parse(collection).getroot().findall(".//DataSet")
    told = [(float(str(e.get("timestep"))), e.get("name"), e.get("part"), e.get("file")) for e in entries]
    kinds = ("bodies", "contacts")
    times = [(0.0, 0), *((s.time, s.step) for s in steps)]
    assert told == [(time, kind, str(i), f"run/{kind}-{number:04d}.vtu") for time, number in times for i, kind in enumerate(kinds)]
    for step, before in [(rest(made, steps[0]), None), (steps[0], None), (steps[1], steps[0])]:
        for kind, patches in expected_patches(made, step, before).items():
            grid = read(tmp_path / "run" / f"{kind}-{step.step:04d}.vtu")
            numbers = vtk_to_numpy(grid.GetCellData().GetArray("number"))
            assert numbers.tolist() == [i for i, (lines, *_) in enumerate(patches) for _ in range(np.prod([d.elements for d in lines]))]
            cell = 0
            for directions, weights, fields in patches:
                for reverse in np.ndindex(*[d.elements for d in reversed(directions)]):
                    local = np.zeros(3)
                    local[: len(directions)] = random.uniform(0.05, 0.95, len(directions))
                    ends = [d.boundaries[e : e + 2] for d, e in zip(directions, reverse[::-1], strict=True)]
                    places = [float(begin + x * (end - begin)) for (begin, end), x in zip(ends, local, strict=False)]
                    found = seen(grid, cell, local)
                    assert set(found) == {*fields, *(SOLID if kind == "bodies" else ())}
                    for name, values in fields.items():
                        if name == "gap" and step.step == 0:
                            assert np.isnan(found[name])
                            continue
                        assert found[name] == pytest.approx(field_at(directions, weights, values, places), abs=1e-12), (kind, cell, name)
                    cell += 1


def test_files_say_how_their_numbers_stand(tmp_path: Path) -> None:
    export(at_rest(tmp_path / "run.h5"), tmp_path)
    paths = sorted((tmp_path / "run").glob("*.vtu"))
    assert paths
    for path in paths:
        root = ElementTree.parse(path).getroot()
        assert root.attrib == {"type": "UnstructuredGrid", "version": "2.2", "byte_order": "LittleEndian", "header_type": "UInt64"}


BENT = """
format = 1
bodies.block.geometry = {{ kind = "bowl", half_width = 0.5, bottom = 0.0, rise = 0.2, top = 0.6 }}
bodies.block.mesh = {{ family = "{family}", order = [{order}, {order}, {order}], elements = [{elements}, {elements}, {elements}] }}
supports.left.face = "block.u0"
stages = [{{ name = "rest", steps = 1 }}]
"""


@pytest.mark.parametrize(("family", "order", "near"), [("N", 2, 0.001), ("L", 2, 0.01), ("N", 3, 0.001)])
def test_vtk_sees_stresses_as_the_program_evaluates_them(tmp_path: Path, family: str, order: int, near: float) -> None:
    """In the middle of elements of a body that is bent smoothly; twice as near and more on elements half as large."""
    apart = []
    for elements in (2, 4):
        path = tmp_path / f"{elements}.h5"
        made = Scene.from_toml(BENT.format(family=family, order=order, elements=elements)).problem()
        (step,), (body,) = list(Simulation(made).run()), made.bodies
        x, y, z = body.patch.control_points.T
        positions = np.column_stack([x + 0.1 * np.sin(2 * z), y + 0.05 * x * z, 0.8 * z + 0.1 * np.cos(2 * x)])
        ResultsWriter(path, made, "", "0").recorded(dataclasses.replace(step, state=dataclasses.replace(step.state, positions=positions)))
        export(path, tmp_path)
        grid = read(tmp_path / f"{elements}" / "bodies-0001.vtu")
        middles = [(d.boundaries[:-1] + d.boundaries[1:]) / 2 for d in body.patch.directions]
        deformation = deformation_gradient(body, positions, middles)
        size = np.linalg.det(deformation)
        stress = np.einsum("nij,nkj,n->nik", first_piola_stress(body.material, deformation), deformation, 1.0 / size)
        deviator = stress - np.trace(stress, axis1=1, axis2=2)[:, None, None] / 3.0 * np.eye(3)
        expected = {
            "stress": stress[:, [0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]],
            "von Mises stress": np.sqrt(1.5 * (deviator**2).sum(axis=(1, 2))),
            "J": size,
        }
        found = [seen(grid, number, np.full(3, 0.5)) for number in range(len(deformation))]
        shares = [np.abs(np.array([f[name] for f in found]) - v).max() / np.abs(v).max() for name, v in expected.items()]
        apart.append(max(shares))
    assert apart[0] < near
    assert apart[1] < 0.5 * apart[0]


def test_fitted_fields_are_exact_where_functions_have_them() -> None:
    """A product of polynomials of the patch's orders over its weight is met at every Bezier point."""
    tyre = problem().bodies[0].patch
    random = np.random.default_rng(8)
    control = random.standard_normal((len(tyre.weights), 2))
    places = [inner_places(d) for d in tyre.directions]
    values, _ = rational([functions_at(d, p)[0] for d, p in zip(tyre.directions, places, strict=True)], tyre.weights, control)
    exact, _ = rational([bezier_matrix(d) for d in tyre.directions], tyre.weights, control)
    assert fitted(tyre.directions, tyre.weights, values) == pytest.approx(exact, abs=1e-12)
