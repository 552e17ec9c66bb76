"""Measure what a higher order at the face in contact alone gains, into docs/trade.md: ``python tools/document_contact_order.py``.

A minute or two: the scenes with shorter load histories, mesh by mesh, and an over-refined run of each that errors count from.
"""

from __future__ import annotations

from pathlib import Path
from time import process_time

import numpy as np
from pages import Page

from isomortar import Scene, Simulation
from isomortar.geometry.patch import FloatArray

PAGE = Path(__file__).parent.parent / "docs" / "trade.md"
_BEGIN, _END = "<!-- table: python tools/document_contact_order.py -->\n", "<!-- end of the table -->\n"
#: Load histories shorter than the scenes' own, elements of the master over those of the slave, force or moment with its component.
SCENES = {
    "iron-round": (
        ["stages.0.steps=3", "stages.1.steps=8", "stages.1.motions.top.translate=[0.4,0,0]"], (2, 1), ("force", 0),
    ),
    "twist": (
        ["stages.0.steps=6", "stages.0.motions.top.translate=[0,0,-0.25]", "stages.1.steps=9", "stages.1.motions.top.rotate=45.0"],
        (5 / 3, 5 / 3), ("moment", 2),
    ),
}  # fmt: skip
#: Order, that in contact (0: the same) and elements along the slave of each run; the over-refined one comes last.
MESHES = {
    "iron-round": [(2, 0, 6), (2, 0, 8), (2, 0, 10), (2, 0, 12), (3, 0, 6), (2, 3, 4), (2, 3, 5), (2, 3, 6), (3, 0, 12)],
    "twist": [(2, 0, 6), (2, 0, 8), (3, 0, 6), (2, 3, 4), (2, 3, 6), (2, 0, 12)],
}


def run(name: str, order: int, in_contact: int, elements: int) -> tuple[FloatArray, int, float]:
    """Curve of the last stage, unknowns and CPU seconds of a scene with a mesh."""
    history, (along, across), (quantity, component) = SCENES[name]
    counts = {"slave": [elements, elements, 3], "master": [round(along * elements), round(across * elements), 3]}
    overrides = [f"bodies.{body}.mesh={{order=[{order},{order},2],elements={count}}}" for body, count in counts.items()]
    overrides += [f"bodies.{body}.mesh.contact_order={in_contact}" for body in counts if in_contact]
    begun = process_time()
    problem = Scene.load(name, [*history, *overrides]).problem()
    simulation = Simulation(problem)
    curve = np.array([getattr(step.reactions[0], quantity)[component] for step in simulation.run()])
    return curve[-problem.stages[-1].steps :], len(simulation.equilibrium.supports.free), process_time() - begun


def tables() -> str:
    """A row for each run."""
    rows = ["| scene | order | elements | unknowns | error | CPU s |", "| --- | --- | --- | --- | --- | --- |"]
    for name, meshes in MESHES.items():
        *tried, (truth, _, _) = [run(name, *mesh) for mesh in meshes]
        for (order, in_contact, elements), (curve, unknowns, seconds) in zip(meshes, tried, strict=False):
            error = np.linalg.norm(curve - truth) / np.linalg.norm(truth)
            orders = f"{order}, contact {in_contact}" if in_contact else f"{order}"
            rows.append(f"| {name} | {orders} | {elements} | {unknowns} | {100.0 * error:.2g} % | {seconds:.2g} |")
    return "\n".join(rows)


page = Page(PAGE, _BEGIN, _END, tables)

if __name__ == "__main__":
    page.write()
