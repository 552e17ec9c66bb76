"""A run as a page to look at: one HTML file with all surfaces as rational Bezier nets, which the browser draws as finely as it likes."""

from __future__ import annotations

import base64
import json
import os
import zlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from importlib.resources import files
from pathlib import Path
from typing import Any

import jinja2
import numpy as np
from matplotlib.colors import Colormap, to_rgb
from numpy.typing import NDArray

from isomortar._arguments import place
from isomortar.errors import InputError, ResultsError
from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Face, Problem, RigidPlane, unit
from isomortar.results import style
from isomortar.results.bezier import at_parts, functions_at, rational
from isomortar.results.bodies import plane_corners, towards
from isomortar.results.fields import contact_surfaces
from isomortar.results.files import place_for, write_whole
from isomortar.results.paraview import states
from isomortar.results.ranges import Dimension, narrowest
from isomortar.results.reader import Results
from isomortar.results.vtu import BezierGrid
from isomortar.solve.record import StepResult

#: Fields of bodies and of slave faces that a page shows: column, unit, what it measures; None: contact stress, without which the material
#: is bare.
BODY_FIELDS = (
    ("von Mises stress", "force / deformed area", Dimension.STRESS),
    ("J", "volume / volume at rest", Dimension.RATIO),
)
CONTACT_FIELDS = (
    ("pressure", "force / area at rest", None),
    ("traction", "force / area at rest", None),
    ("gap", "length; positive is penetration", Dimension.LENGTH),
)
#: Colours by status: open, stick, slip.
STATES = (("open", "#FFFFFF"), ("stick", style.BLUE), ("slip", style.ORANGE))
#: Parts along a surface at whose ends it is drawn, and the ranges of colours are looked for; fewest and most along one of its elements.
PARTS, PARTS_OF_ELEMENT = 72, (3, 24)


@dataclass
class Surface:
    """A face of a body, or the slave face of a contact, as Bezier nets.

    `columns`: names of fields by net point, x, y, z first; `rows`: their values by load step, shape (columns, points) each. `marks`:
    by load step places of the constraints and their status, shape (4, constraints). `acting`: by load step of the slave face of a contact
    1 where its master is opposite, else 0, at equal parts of its elements, shape (places,), and by column the largest size that acts, shape
    (columns,). `contact`: number of the contact whose slave face it is, or of none, a face of a body; `slave_of`: of those in which that is
    the slave.
    """

    name: str
    orders: tuple[int, ...]
    elements: tuple[int, ...]
    colour: str
    contact: int | None
    slave_of: tuple[int, ...]
    columns: tuple[str, ...]
    weights: FloatArray
    rows: list[FloatArray] = field(default_factory=list)
    marks: list[FloatArray] = field(default_factory=list)
    acting: list[tuple[FloatArray, FloatArray]] = field(default_factory=list)

    @property
    def parts(self) -> int:
        """Equal parts that each element is cut into."""
        return parts_of(self.elements)

    def sampled(self, row: FloatArray, parts: int) -> FloatArray:
        """Columns of a load step at equal parts of each element, shape (places, columns), first direction fastest."""
        matrices = [at_parts(order, elements, parts) for order, elements in zip(self.orders, self.elements, strict=True)]
        return rational(matrices, self.weights, row.T)[0]

    def values(self, column: str) -> FloatArray:
        """Values of a field of all load steps that are known, and of contacts act, at equal parts of elements (theory 8.7)."""
        number = self.columns.index(column)
        rows = [self.sampled(row[[number]], self.parts)[:, 0] for row in self.rows]
        if self.contact is not None:
            acting = zip(rows, self.acting, strict=True)
            rows = [np.clip(values, -largest[number], largest[number])[here > 0.0] for values, (here, largest) in acting]
        together = np.concatenate(rows)
        return together[np.isfinite(together)]


def parts_of(elements: Sequence[int]) -> int:
    """Equal parts that each element of a surface is cut into."""
    return int(np.clip(round(PARTS / max(elements)), *PARTS_OF_ELEMENT))


def view(results_path: str | os.PathLike[str], output: str | os.PathLike[str]) -> Path:
    """Write a page that shows the bodies, at rest and at every kept state, in colours by a field; it needs no network, and turns and zooms.

    Parameters
    ----------
    results_path : path-like
    output : path-like
        The page, a .html file; its folder is made if it does not exist.

    Returns
    -------
    Path
        The page's.

    Raises
    ------
    InputError
        The page is to have another name than one that ends in .html.
    ResultsError
        The results file is missing, damaged, or holds no state; or there is a results file in the page's place, or it cannot be written.
    """
    path = place("output", output)
    if path.suffix != ".html":
        raise InputError(f"is {path.name!r}; allowed: a name that ends in .html", "output")
    with Results(results_path) as results:
        if not len(results.kept_states):
            raise ResultsError(f"{results.path} holds no load step yet: nothing to look at")
        place_for(path)
        text = _page(results)
    write_whole(path, text)
    return path


def _page(results: Results) -> str:
    problem, steps = results.problem, []
    surfaces: list[Surface] = []
    for _, number, grids in states(results):
        last = results.step(max(number, int(results.kept_states[0])))
        found = [*of_bodies(problem, grids["bodies"]), *_of_contacts(problem, grids.get("contacts", []), last, number == 0)]
        surfaces = surfaces or found
        for surface, now in zip(surfaces, found, strict=True) if surfaces is not found else ():
            surface.rows += now.rows
            surface.marks += now.marks
            surface.acting += now.acting
        steps.append({"step": number, "stage": last.stage if number else "at rest"})
    ends = np.array([end(row[:3], axis=1) for surface in surfaces for row in surface.rows for end in (np.min, np.max)])
    low, high = ends.min(axis=0), ends.max(axis=0)
    sides = [towards(face) for face in contact_surfaces(problem, results.step(int(results.kept_states[-1])))]
    data = {
        "name": problem.name,
        "title": f"{int(results.kept_states[-1])} load steps",
        "warnings": results.warnings,
        "steps": steps,
        "fields": [*_fields(problem, surfaces)],
        "surfaces": [_described(surface) for surface in surfaces],
        "planes": [*_planes(problem, surfaces, 0.5 * (low + high))],
        "sides": [{"azimuth": camera.azimuth, "elevation": camera.elevation} for camera in sides],
        "planeColour": to_rgb(style.PLANE),
        "states": [{"name": name, "colour": to_rgb(colour)} for name, colour in STATES],
        "colours": {"pressure": _colours(style.pressure_colours()), "field": _colours(style.field_colours())},
        "centre": (0.5 * (low + high)).tolist(),
        "radius": 0.5 * float(np.linalg.norm(high - low)),
    }
    folder = files("isomortar.results") / "viewer"
    template = jinja2.Environment(undefined=jinja2.StrictUndefined, autoescape=False).from_string((folder / "page.html").read_text())
    return template.render(
        page=data,
        style=(folder / "page.css").read_text(),
        script=(folder / "bezier.js").read_text() + (folder / "page.js").read_text(),
        data=json.dumps(data).replace("<", "\\u003c"),
        numbers=base64.b64encode(zlib.compress(_numbers(surfaces, 0.5 * (low + high)).tobytes(), 9)).decode(),
    )


def of_bodies(problem: Problem, grids: Sequence[BezierGrid]) -> Iterator[Surface]:
    """The outer faces of all bodies in one state: sides of their Bezier nets."""
    glued = {face for joint in problem.glue for face in joint}
    slaves = {face for contact in problem.contacts for face in contact.slave.faces}
    names = tuple(name for name, *_ in BODY_FIELDS)
    for body, grid in zip(problem.bodies, grids, strict=True):
        u, v, w = (d.order * d.elements + 1 for d in body.patch.directions)
        numbers = np.arange(u * v * w).reshape(u, v, w, order="F")
        columns = np.concatenate([grid.points.T, *(grid.fields[name].T for name in names)])
        for name in body.outer:
            if Face(body.name, name) in glued:
                continue
            layer = np.take(numbers, 0 if name[1] == "0" else -1, axis="uvw".index(name[0]))
            of_face = (layer.T if name[0] == "v" else layer).ravel(order="F")  # coordinates of a face are in cyclic order
            directions = body.patch.face_directions(name)
            yield Surface(
                body.name,
                tuple(d.order for d in directions),
                tuple(d.elements for d in directions),
                style.SLAVE if any(face.body == body.name for face in slaves) else style.MASTER,
                None,
                tuple(k for k, contact in enumerate(problem.contacts) if Face(body.name, name) in contact.slave.faces),
                ("x", "y", "z", *names),
                grid.weights[of_face],
                [columns[:, of_face]],
                [np.zeros((4, 0))],
            )


def _of_contacts(problem: Problem, grids: Sequence[BezierGrid], step: StepResult, at_rest: bool) -> Iterator[Surface]:
    """The slave faces in one state, with marks at the Greville abscissae of their functions."""
    names = tuple(name for name, *_ in CONTACT_FIELDS)
    for number, (grid, surface) in enumerate(zip(grids, contact_surfaces(problem, step), strict=True)):
        at_marks = tuple(functions_at(d, d.greville)[0] for d in surface.directions)
        places = surface.field((at_marks[0], at_marks[1]), surface.reference_points if at_rest else surface.points)
        elements = tuple(d.elements for d in surface.directions)
        acting = surface.over_master([d.subdivided(parts_of(elements)) for d in surface.directions]).ravel().astype(np.float64)
        largest = {"pressure": surface.footing.largest(surface.pressure), "traction": surface.footing.largest(surface.traction)}
        yield Surface(
            surface.contact.name,
            tuple(d.order for d in surface.directions),
            elements,
            style.SLAVE,
            number,
            (),
            ("x", "y", "z", *names),
            grid.weights,
            [np.concatenate([grid.points.T, *(grid.fields[name].T for name in names)])],
            [np.vstack([places.T, np.zeros(len(places)) if at_rest else surface.status])],
            [(np.ones_like(acting) if at_rest else acting, np.array([largest.get(name, np.inf) for name in ("x", "y", "z", *names)]))],
        )


def _fields(problem: Problem, surfaces: Sequence[Surface]) -> Iterator[dict[str, Any]]:
    """What can be in colours: of each contact its fields, then those of the bodies; with the range over all load steps."""
    for number, contact in enumerate(problem.contacts):
        of = f" of {contact.name}" if len(problem.contacts) > 1 else ""
        face = next(surface for surface in surfaces if surface.contact == number)
        for column, unit_of, dimension in CONTACT_FIELDS:
            low, high = _range(problem, [face], column, dimension)
            bare = dimension is None
            colours = "pressure" if bare else "field"
            yield _field(f"{column}{of}", column, unit_of, colours, number, (0.0 if bare else low, high), bare)
        yield _field(f"status{of}", "status", "", "field", number, (0.0, 2.0), False)
    bodies = [surface for surface in surfaces if surface.contact is None]
    way = max(float(np.linalg.norm(row[:3] - surface.rows[0][:3], axis=0).max()) for surface in bodies for row in surface.rows)
    yield _field("displacement", "displacement", "length", "field", None, (0.0, max(way, narrowest(problem, Dimension.LENGTH))), False)
    for column, unit_of, dimension in BODY_FIELDS:
        yield _field(column, column, unit_of, "field", None, _range(problem, bodies, column, dimension), False)


def _field(
    label: str, column: str, of_unit: str, colours: str, contact: int | None, ends: tuple[float, float], bare: bool
) -> dict[str, Any]:
    """`bare`: where there is nothing of it the material is seen."""
    return {"label": label, "column": column, "unit": of_unit, "colours": colours, "contact": contact, "range": ends, "bare": bare}


def _range(problem: Problem, surfaces: Sequence[Surface], column: str, dimension: Dimension | None) -> tuple[float, float]:
    """Least and largest value of a field over all load steps, at parts of elements, farther apart than round-off."""
    together = np.concatenate([surface.values(column) for surface in surfaces])
    low, high = (float(together.min()), float(together.max())) if len(together) else (0.0, 0.0)
    return low, max(high, low + (narrowest(problem, dimension) if dimension else 0.0))


def _planes(problem: Problem, surfaces: Sequence[Surface], centre: FloatArray) -> Iterator[dict[str, Any]]:
    """Rigid planes, as far as they are below the slave's ways."""
    for surface in surfaces:
        master = problem.contacts[surface.contact].master if surface.contact is not None else None
        if isinstance(master, RigidPlane):
            near = np.concatenate([row[:3].T for row in surface.rows])
            corners = plane_corners(master, near, 0.2 * float(np.ptp(near, axis=0).max()))
            yield {"normal": unit(master.normal).tolist(), "corners": (corners - centre).tolist()}


def _described(surface: Surface) -> dict[str, Any]:
    """What a page says of a surface, without its numbers."""
    return {
        "name": surface.name,
        "orders": surface.orders,
        "elements": surface.elements,
        "parts": surface.parts,
        "colour": to_rgb(surface.colour),
        "contact": surface.contact,
        "slaveOf": surface.slave_of,
        "columns": surface.columns,
        "marks": surface.marks[0].shape[1],
    }


def _numbers(surfaces: Sequence[Surface], centre: FloatArray) -> NDArray[np.float32]:
    """All numbers of all surfaces, as the page takes them apart again; places count from the centre, for the digits."""
    parts = []
    for surface in surfaces:
        parts.append(surface.weights)
        for values in (*surface.rows, *surface.marks):
            parts.append((values - np.pad(centre, (0, len(values) - 3))[:, None]).ravel())
        parts += [values for acting in surface.acting for values in acting]
    return np.concatenate(parts).astype("<f4")


def _colours(chosen: Colormap) -> list[list[int]]:
    """A colour map as 256 colours."""
    return np.rint(255.0 * chosen(np.linspace(0.0, 1.0, 256))[:, :3]).astype(int).tolist()
