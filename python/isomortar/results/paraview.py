"""Fields for ParaView: the bodies as Bezier hexahedra of the true orders and weights, slave faces as Bezier quadrilaterals.

VTK evaluates these cells exactly (ParaView 5.10 and later; "Nonlinear Subdivision Level" says how smoothly they are drawn).
XML files (.vtu) with one collection (.pvd) over the load steps, and not VTK's HDF5 format: that can tell which array holds the
weights only since its version 2.6, which most installed programs do not read.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from isomortar import _arguments
from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Body, Problem
from isomortar.model.numbering import Numbering
from isomortar.results.bezier import fitted, inner_places
from isomortar.results.fields import ContactSurface, body_points, contact_surfaces
from isomortar.results.files import make_folder, writing
from isomortar.results.not_negative import not_negative
from isomortar.results.ranges import ROUND_OFF
from isomortar.results.reader import Results
from isomortar.results.stress import cauchy_stress, deformation_gradient, von_mises
from isomortar.results.vectors import ContactVectors, contact_vectors
from isomortar.results.vtu import BezierGrid, bezier_grid, write_vtu

#: Places of xx, yy, zz, xy, yz, xz in a tensor's nine components: the order in which VTK has those of symmetric ones.
_SYMMETRIC = [0, 4, 8, 1, 5, 2]
#: Places along each direction of an element at which it is looked whether the master is opposite.
_SAMPLES = 8


def export(results_path: str | os.PathLike[str], outdir: str | os.PathLike[str]) -> Path:
    """Write the bodies and slave faces at rest and at every kept state for ParaView.

    Point data of bodies: displacement; Cauchy stress (xx, yy, zz, xy, yz, xz; force per deformed area), its equivalent by von Mises and
    J = det F, fitted element by element, the equivalent nowhere below zero. Of slave faces: displacement, contact pressure, magnitude of
    the contact traction, that traction as a vector (friction on the slave), slip of the slave on its master within the load step as a
    vector (NaN where the state before it was not kept), control gaps (positive is penetration) and status (0 open, 1 stick, 2 slip).
    Pressure and traction are force per area in the reference configuration.
    Cell data: number of the body or contact pair, from 0 in the order of the scene; of slave faces the share of each element that has the
    master opposite (``over master``): beside it pressure and traction act on nothing, however large they are.

    Returns
    -------
    Path
        The collection (.pvd) to open. Its data lie in a folder of the same name beside it.

    Raises
    ------
    ResultsError
        The results file is missing or damaged; or a file cannot be written.
    """
    beside = _arguments.place("outdir", outdir)
    with Results(results_path) as results:
        collection = beside / f"{results.path.stem}.pvd"
        folder = collection.with_suffix("")
        make_folder(folder)
        root = ElementTree.Element("VTKFile", type="Collection", version="1.0", byte_order="LittleEndian")
        entries = ElementTree.SubElement(root, "Collection")
        for time, number, parts in states(results):
            for part, (name, grids) in enumerate(parts.items()):
                path = folder / f"{name}-{number:04d}.vtu"
                with writing(path) as fresh:
                    write_vtu(fresh, grids)
                place = path.relative_to(collection.parent).as_posix()
                ElementTree.SubElement(entries, "DataSet", timestep=repr(time), part=str(part), name=name, file=place)
        with writing(collection) as fresh:
            ElementTree.ElementTree(root).write(fresh, encoding="utf-8", xml_declaration=True)
    return collection


def states(results: Results) -> Iterator[tuple[float, int, dict[str, list[BezierGrid]]]]:
    """Load time, number and grids of the rest, which is number 0, and of every kept state."""
    problem = results.problem
    for number in results.kept_states:
        step = results.step(int(number))
        surfaces = contact_surfaces(problem, step)
        if number == results.kept_states[0]:
            still = [ContactVectors(*np.zeros((2, *surface.points.shape))) for surface in surfaces]
            yield 0.0, 0, _grids(problem, Numbering(problem).reference, [_at_rest(surface) for surface in surfaces], still)
        before = results.step(int(number) - 1) if number - 1 in results.kept_states else None
        yield step.time, step.step, _grids(problem, step.state.positions, surfaces, contact_vectors(problem, step, before))


def _at_rest(surface: ContactSurface) -> ContactSurface:
    """A slave face before anything has moved: open, its gaps not told (NaN)."""
    nothing, untold = np.zeros_like(surface.pressure), np.full_like(surface.gap, np.nan)
    open_, everywhere = np.zeros_like(surface.status), replace(surface.footing, found=np.ones_like(surface.footing.found))
    return replace(
        surface,
        points=surface.reference_points,
        pressure=nothing,
        traction=nothing,
        gap=untold,
        status=open_,
        footing=everywhere,
    )


def _grids(
    problem: Problem, positions: FloatArray, surfaces: list[ContactSurface], vectors: list[ContactVectors]
) -> dict[str, list[BezierGrid]]:
    points = body_points(problem, positions)
    bodies = [body_grid(number, body, points[body.name]) for number, body in enumerate(problem.bodies)]
    contacts = [_contact(i, *of_contact) for i, of_contact in enumerate(zip(surfaces, vectors, strict=True))]
    return {"bodies": bodies} | ({"contacts": contacts} if contacts else {})


def body_grid(number: int, body: Body, points: FloatArray) -> BezierGrid:
    """A body with its control points at given places, shape (n, 3), and what it is under there."""
    directions, weights = body.patch.directions, body.patch.weights
    deformation = deformation_gradient(body, points, [inner_places(direction) for direction in directions])
    stress = np.zeros_like(deformation) if body.rigid else cauchy_stress(body.material, deformation)
    values = {"stress": stress.reshape(-1, 9)[:, _SYMMETRIC], "von Mises stress": von_mises(stress), "J": np.linalg.det(deformation)}
    fields = {name: fitted(directions, weights, value.reshape(len(deformation), -1)) for name, value in values.items()}
    grid = bezier_grid(directions, weights, points, {"displacement": points - body.patch.control_points}, number, fields)
    mises = grid.fields["von Mises stress"]
    mises[:, 0] = not_negative(directions, grid.weights, mises[:, 0], 0.0 if body.rigid else ROUND_OFF * body.material.young)
    return grid


def _contact(number: int, surface: ContactSurface, vectors: ContactVectors) -> BezierGrid:
    fields = {
        "displacement": surface.points - surface.reference_points,
        "pressure": surface.pressure[:, None],
        "traction": surface.traction[:, None],
        "traction vector": vectors.traction,
        "slip vector": vectors.slip,
        "gap": surface.gap[:, None],
        "status": surface.status[:, None].astype(np.float64),
    }
    grid = bezier_grid(surface.directions, surface.weights, surface.points, fields, number)
    return replace(grid, of_cells={"over master": _over_master(surface)})


def _over_master(surface: ContactSurface) -> FloatArray:
    """Share of each element of a slave face that has the master opposite, shape (elements,), first direction fastest."""
    first, second = surface.directions
    middles = [direction.subdivided(2 * _SAMPLES)[1::2] for direction in (first, second)]
    acting = surface.over_master(middles).reshape(second.elements, _SAMPLES, first.elements, _SAMPLES)
    return np.asarray(acting.mean(axis=(1, 3)).ravel())
