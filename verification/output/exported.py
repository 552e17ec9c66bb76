"""What ParaView is given: Bezier cells, evaluated here as VTK does, against the bodies' own functions as SciPy has them."""

from __future__ import annotations

import base64
import functools
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
from output.records import load_steps, recorded
from rational_functions import shares
from scipy.interpolate import BPoly

from isomortar import _bindings
from isomortar.geometry.patch import Direction, FloatArray
from isomortar.harness import Bound, case
from isomortar.model.entities import Body, Problem
from isomortar.model.numbering import Numbering
from isomortar.results.paraview import export
from isomortar.results.stress import deformation_gradient
from isomortar.results.vectors import contact_vectors
from isomortar.scene import Scene
from isomortar.solve.record import StepResult

#: No body has two directions alike; one has weights, one is of a single element of orders above two, one of small strains.
SCENE = """
format = 1
materials.hard = { young = 3, poisson = 0.2 }
materials.small = { young = 2, poisson = 0.25, law = "linear-elastic" }
[bodies.block]
geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 0.5, 0.8] }
mesh = { order = [3, 2, 1], elements = [1, 2, 2] }
material = "hard"
[bodies.base]
geometry = { kind = "box", lower = [-0.5, -0.6, -0.4], upper = [1.6, 1.7, 0] }
mesh = { family = "L", order = [1, 2, 3], elements = [2, 1, 2] }
material = "small"
[bodies.wheel]
geometry = { kind = "ring", centre = [0.5, 4, 0], inner = 0.2, outer = 0.4, width = 0.3 }
mesh = { order = [3, 1, 2], elements = [4, 1, 1] }
material = "hard"
[bodies.cap]
geometry = { kind = "cap", centre = [4, 0], radius = 1, half_width = 0.5, bottom = 0, top = 1 }
mesh = { order = [3, 5, 4], elements = [1, 1, 1] }
material = "hard"
[contacts]
under = { slave = "block.w0", master = "base.w1", friction = 0.3, subcells = 0 }
over = { slave = "block.u1", plane = { point = [2, 0, 0], normal = [-1, 0, 0] }, friction = 0 }
[supports]
ground.face = "base.w0"
top.face = "block.w1"
rim.face = "wheel.v0"
lid.face = "cap.w1"
[[stages]]
name = "press"
steps = 2
motions.top.translate = [0.01, 0, -0.01]
"""
#: An affine motion, under which strains and stresses are the same everywhere.
GRADIENT = np.array([[1.1, 0.05, -0.02], [0.03, 0.95, 0.04], [-0.06, 0.01, 1.05]])
SHIFT = np.array([0.3, -0.2, 0.5])
#: Places within each cell.
PLACES = np.random.default_rng(6).uniform(0.05, 0.95, (4, 3))
_ROUND_OFF = "round-off: sums of products of polynomials of orders up to five"


@dataclass(frozen=True)
class Cells:
    """A file's cells: numbers of their points in the order of their net, orders and number of body or contact; arrays of the points."""

    nets: list[np.ndarray]
    numbers: np.ndarray
    arrays: dict[str, FloatArray]

    def at(self, cell: int, places: FloatArray) -> dict[str, FloatArray]:
        """All arrays at places in the unit square or cube of a cell, with rational weights, shape (places, components)."""
        net = self.nets[cell]
        functions = [BPoly(np.eye(n)[:, None], [0.0, 1.0])(places[:, k]) for k, n in enumerate(net.shape)]
        shares = functools.reduce(lambda a, b: np.einsum("qi,qj->qij", a, b).reshape(len(places), -1), functions)
        shares = shares * self.arrays["weights"][net.ravel(), 0]
        shares /= shares.sum(axis=1, keepdims=True)
        return {name: shares @ values[net.ravel()] for name, values in self.arrays.items()}


def place_in_cell(i: int, j: int, k: int, p: int, q: int, r: int) -> int:
    """Where VTK has a point of a hexahedron's net (vtkHigherOrderHexahedron::PointIndexFromIJK)."""
    at = [i in (0, p), j in (0, q), k in (0, r)]
    corner = (2 if j else 1) if i else (3 if j else 0)
    if sum(at) == 3:
        return corner + (4 if k else 0)
    if sum(at) == 2:
        ring = 2 * (p - 1 + q - 1) * (k > 0)
        if not at[0]:
            return 8 + i - 1 + (p - 1 + q - 1 if j else 0) + ring
        if not at[1]:
            return 8 + j - 1 + (p - 1 if i else 2 * (p - 1) + q - 1) + ring
        return 8 + 4 * (p - 1 + q - 1) + k - 1 + (r - 1) * corner
    before = 8 + 4 * (p - 1 + q - 1 + r - 1)
    if at[0]:
        return before + j - 1 + (q - 1) * (k - 1 + (r - 1) * (i > 0))
    before += 2 * (q - 1) * (r - 1)
    if at[1]:
        return before + i - 1 + (p - 1) * (k - 1 + (r - 1) * (j > 0))
    before += 2 * (r - 1) * (p - 1)
    if at[2]:
        return before + i - 1 + (p - 1) * (j - 1 + (q - 1) * (k > 0))
    return before + 2 * (p - 1) * (q - 1) + i - 1 + (p - 1) * (j - 1 + (q - 1) * (k - 1))


def place_in_quadrilateral(i: int, j: int, p: int, q: int) -> int:
    """The same of a quadrilateral."""
    if i in (0, p) and j in (0, q):
        return (2 if j else 1) if i else (3 if j else 0)
    if j in (0, q):
        return 4 + i - 1 + (p - 1 + q - 1 if j else 0)
    if i in (0, p):
        return 4 + j - 1 + (p - 1 if i else 2 * (p - 1) + q - 1)
    return 4 + 2 * (p - 1 + q - 1) + i - 1 + (p - 1) * (j - 1)


def read(path: Path) -> Cells:
    """A file of cells."""
    kinds = {"Float64": np.float64, "Int64": np.int64, "UInt8": np.uint8}
    found = {}
    for element in ElementTree.parse(path).iter("DataArray"):
        content = np.frombuffer(base64.b64decode(element.text or "")[8:], kinds[element.attrib["type"]])
        found[element.attrib["Name"]] = content.reshape(-1, int(element.attrib["NumberOfComponents"]))
    nets, end = [], np.append(0, found["offsets"][:, 0])
    for cell, ((p, q, r), kind) in enumerate(zip(found["orders"], found["types"][:, 0], strict=True)):
        points = found["connectivity"][end[cell] : end[cell + 1], 0]
        if kind == 79:
            order = [[[place_in_cell(i, j, k, p, q, r) for k in range(r + 1)] for j in range(q + 1)] for i in range(p + 1)]
        else:
            order = [[place_in_quadrilateral(i, j, p, q) for j in range(q + 1)] for i in range(p + 1)]  # type: ignore[misc]
        nets.append(points[np.array(order)])
    count = len(found["points"])
    named = {name: values for name, values in found.items() if len(values) == count and values.dtype == np.float64}
    return Cells(nets, found["number"][:, 0], named)


def elements(directions: Sequence[Direction]) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Lower ends and sizes of the elements, the first direction fastest."""
    for numbers in np.ndindex(*(d.elements for d in reversed(directions))):
        low = np.array([d.boundaries[e] for d, e in zip(directions, reversed(numbers), strict=True)])
        yield low, np.array([np.diff(d.boundaries)[e] for d, e in zip(directions, reversed(numbers), strict=True)])


def gradient(body: Body, points: FloatArray, places: FloatArray) -> FloatArray:
    """dx/dX by central differences of fourth order of the parameters, shape (places, 3, 3)."""
    changes = []
    for axis, d in enumerate(body.patch.directions):
        step = 1e-3 * np.diff(d.boundaries).min() * np.eye(3)[axis]
        at = [shares(body.patch.directions, body.patch.weights, places + n * step) for n in (-2, -1, 1, 2)]
        slope = (at[0] - 8 * at[1] + 8 * at[2] - at[3]) / (12 * step[axis])
        changes.append(np.stack([slope @ points, slope @ body.patch.control_points]))
    now, then = np.moveaxis(np.array(changes), (0, 1, 2, 3), (3, 0, 1, 2))
    return now @ np.linalg.inv(then)


def stressed(body: Body, deformation: FloatArray) -> FloatArray:
    """Cauchy stress xx, yy, zz, xy, yz, xz, its equivalent, and J, shape (places, 8)."""
    first = _bindings.material_stress(body.material.arrays, np.ascontiguousarray(deformation - np.eye(3)))
    ratio = np.linalg.det(deformation)
    true = first if body.material.law == "linear-elastic" else np.einsum("qij,qkj,q->qik", first, deformation, 1.0 / ratio)
    xx, yy, zz, xy, yz, xz = (true[:, i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)))
    mises = np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3.0 * (xy**2 + yz**2 + xz**2))
    return np.column_stack([xx, yy, zz, xy, yz, xz, mises, ratio])


def moved(problem: Problem, motion: str) -> list[StepResult]:
    """Load steps whose positions are those of an affine motion, or by chance."""
    steps, at_rest = load_steps(problem), Numbering(problem).reference
    if motion == "by chance":
        return steps
    return [replace(step, state=replace(step.state, positions=at_rest @ GRADIENT.T + step.step * SHIFT)) for step in steps]


def chebyshev(body: Body) -> FloatArray:
    """Places in the only element of a body through whose values its stresses go, shape (places, 3)."""
    lines = [0.5 - 0.5 * np.cos(np.pi * (np.arange(d.order + 1) + 0.5) / (d.order + 1)) for d in body.patch.directions]
    return np.stack(np.meshgrid(*lines), axis=-1).reshape(-1, 3)


def errors_of_bodies(problem: Problem, positions: FloatArray, cells: Cells, motion: str) -> dict[str, float]:
    """Largest errors of places and displacements, of F, which at a line is that of the element that begins, and of stresses where exact."""
    worst, cell, numbering = {"places": 0.0, "displacement": 0.0, "gradient": 0.0, "stress": 0.0}, 0, Numbering(problem)
    for number, body in enumerate(problem.bodies):
        points, alone = numbering.of_patch(body.name, positions), body.name == "cap"
        for low, size in elements(body.patch.directions):
            found, rational = cells.at(cell, PLACES), shares(body.patch.directions, body.patch.weights, low + PLACES * size)
            errors = {
                "places": np.abs(found["points"] - rational @ points).max() + abs(cells.numbers[cell] - number),
                "displacement": np.abs(found["displacement"] - rational @ (points - body.patch.control_points)).max(),
            }
            if motion == "affine" or alone:
                places = chebyshev(body) if alone else PLACES
                there = cells.at(cell, places)
                deformation = gradient(body, points, low + places * size)
                told = np.column_stack([there[name] for name in ("stress", "von Mises stress", "J")])
                errors["stress"] = np.abs(told - stressed(body, deformation)).max()
            if motion == "by chance":
                inside, begins, beside = (
                    deformation_gradient(body, points, list((low + part * size)[:, None])) for part in (0.3, 0.0, 1e-9)
                )
                errors["gradient"] = np.maximum(
                    np.abs(inside - gradient(body, points, low[None] + 0.3 * size)), np.abs(begins - beside)
                ).max()
            worst = {name: float(np.maximum(error, errors.get(name, 0.0))) for name, error in worst.items()}
            cell += 1
    return worst


def error_of_contacts(problem: Problem, step: StepResult, before: StepResult | None, cells: Cells) -> float:
    """Largest error of places and fields on the slave faces, relative to each field's largest control value."""
    worst, cell, numbering = 0.0, 0, Numbering(problem)
    vectors = contact_vectors(problem, step, before)
    for number, (contact, state, result) in enumerate(zip(problem.contacts, step.state.contacts, step.contacts, strict=True)):
        patch, face = problem.body(contact.slave.body).patch, contact.slave.face
        directions, points = patch.face_directions(face), patch.face_points(face)
        there = numbering.points[contact.slave.body][points]
        fields: dict[str, Any] = {
            "points": step.state.positions[there],
            "displacement": (step.state.positions - numbering.reference)[there],
            "pressure": state.pressure[:, None],
            "traction": result.traction_norm[:, None],
            "gap": result.gap[:, None],
            "status": 1.0 * result.status[:, None],
            "traction vector": vectors[number].traction,
            "slip vector": vectors[number].slip,
        }
        for low, size in elements(directions):
            found = cells.at(cell, PLACES[:, :2])
            rational = shares(directions, patch.weights[points], low + PLACES[:, :2] * size)
            for name, values in fields.items():
                off, exact = found[name] - rational @ values, np.isfinite(found[name])
                worst = np.maximum(worst, np.abs(off[exact]).max(initial=0.0) / np.maximum(np.nanmax(np.abs(values), initial=0.0), 1.0))
                worst = np.maximum(worst, np.any(exact != np.isfinite(rational @ values)))
            worst = np.maximum(worst, abs(cells.numbers[cell] - number))
            cell += 1
    return float(np.maximum(worst, abs(cell - len(cells.nets))))


@case(
    claim="Cells for ParaView are the bodies and slave faces at rest and after each load step, with their fields, in VTK's order.",
    tier="gate",
    grid={"motion": ("affine", "by chance")},
    bounds={
        "places": Bound(at_most=1e-13, reason=_ROUND_OFF),
        "displacement": Bound(at_most=1e-13, reason=_ROUND_OFF),
        "gradient": Bound(at_most=1e-7, reason="round-off: the next place is a billionth of an element away"),
        "stress": Bound(at_most=1e-9, reason="round-off: differences of fourth order over a thousandth of an element"),
        "contacts": Bound(at_most=1e-12, reason=_ROUND_OFF),
        "at rest": Bound(at_most=1e-12, reason="definition: nothing has moved, nothing is pressed; round-off"),
        "entries": Bound(at_most=0.0, reason="definition: entries of the collection that name another time or no file"),
    },
)
def cells(motion: str) -> dict[str, float]:
    """Largest errors of what the files hold."""
    problem = Scene.from_toml(SCENE).problem()
    steps = moved(problem, motion)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        recorded(folder / "run.h5", problem, steps, "every")
        collection = export(folder / "run.h5", folder / "out")
        entries = [
            (float(e.attrib["timestep"]), collection.parent / e.attrib["file"]) for e in ElementTree.parse(collection).iter("DataSet")
        ]
        expected = [(float(time), f"{kind}-{time:04d}.vtu") for time in range(len(steps) + 1) for kind in ("bodies", "contacts")]
        wrong = sum((time, file.name) != entry for (time, file), entry in zip(entries, expected, strict=True))
        files = [read(file) for _, file in entries]
    reference = Numbering(problem).reference
    rest = errors_of_bodies(problem, reference, files[0], "affine")
    zero = [np.abs(files[1].arrays[field]).max() for field in ("displacement", "pressure", "traction", "status", "slip vector")]
    pairs = list(zip([None, *steps], steps, strict=False))
    bodies = [errors_of_bodies(problem, step.state.positions, files[2 * step.step], motion) for step in steps]
    return {
        **{field: float(np.max([errors[field] for errors in bodies])) for field in bodies[0]},
        "contacts": float(np.max([error_of_contacts(problem, step, before, files[2 * step.step + 1]) for before, step in pairs])),
        "at rest": float(np.max([*zero, rest["places"], rest["displacement"], 1e-4 * rest["stress"]])),
        "entries": float(wrong),
    }
