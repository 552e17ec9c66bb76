"""Fields for ParaView: the bodies as Bezier hexahedra of the true orders and weights, slave faces as Bezier quadrilaterals.

VTK evaluates these cells exactly (ParaView 5.10 and later; "Nonlinear Subdivision Level" says how smoothly they are drawn).
XML files (.vtu) with one collection (.pvd) over the load steps, and not VTK's HDF5 format: that can tell which array holds the
weights only since its version 2.6, which most installed programs do not read.
"""

from __future__ import annotations

import os
from pathlib import Path
from xml.etree import ElementTree

from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Problem
from isomortar.results.fields import ContactSurface, body_points, contact_surfaces
from isomortar.results.files import make_folder, writing
from isomortar.results.reader import Results
from isomortar.results.vtu import BezierGrid, bezier_grid, write_vtu


def export(results_path: str | os.PathLike[str], outdir: str | os.PathLike[str]) -> Path:
    """Write every kept state for ParaView.

    Point data: displacement; on the slave faces also contact pressure and magnitude of the contact traction.
    Cell data: number of the body or contact pair, from 0 in the order of the scene.

    Returns
    -------
    Path
        The collection (.pvd) to open. Its data lie in a folder of the same name beside it.

    Raises
    ------
    ResultsError
        The results file is missing or damaged; or a file cannot be written.
    """
    with Results(results_path) as results:
        collection = Path(outdir) / f"{Path(results_path).stem}.pvd"
        folder = collection.with_suffix("")
        make_folder(folder)
        root = ElementTree.Element("VTKFile", type="Collection", version="1.0", byte_order="LittleEndian")
        entries = ElementTree.SubElement(root, "Collection")
        for number in results.kept_states:
            step = results.step(int(number))
            parts = {"bodies": _bodies(results.problem, step.state.positions)}
            if results.problem.contacts:
                parts["contacts"] = [_contact(i, s) for i, s in enumerate(contact_surfaces(results.problem, step))]
            for part, (name, grids) in enumerate(parts.items()):
                path = folder / f"{name}-{number:04d}.vtu"
                with writing(path):
                    write_vtu(path, grids)
                place = path.relative_to(collection.parent).as_posix()
                ElementTree.SubElement(entries, "DataSet", timestep=repr(step.time), part=str(part), name=name, file=place)
        with writing(collection):
            ElementTree.ElementTree(root).write(collection, encoding="utf-8", xml_declaration=True)
    return collection


def _bodies(problem: Problem, positions: FloatArray) -> list[BezierGrid]:
    points = body_points(problem, positions)
    return [
        bezier_grid(
            body.patch.directions,
            body.patch.weights,
            points[body.name],
            {"displacement": points[body.name] - body.patch.control_points},
            number,
        )
        for number, body in enumerate(problem.bodies)
    ]


def _contact(number: int, surface: ContactSurface) -> BezierGrid:
    fields = {
        "displacement": surface.points - surface.reference_points,
        "pressure": surface.pressure[:, None],
        "traction": surface.traction[:, None],
    }
    return bezier_grid(surface.directions, surface.weights, surface.points, fields, number)
