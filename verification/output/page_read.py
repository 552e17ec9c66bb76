"""What a page to look at holds, taken apart again: its load steps, fields with their ranges, nets of contact faces, marks and planes."""

from __future__ import annotations

import base64
import json
import re
import tempfile
import zlib
from pathlib import Path
from typing import Any

import numpy as np
from output.drawn import centres
from output.records import SCENE, load_steps, over_master, recorded
from rational_functions import shares

from isomortar import view
from isomortar.geometry.patch import Direction, FloatArray
from isomortar.harness import Bound, case
from isomortar.model.entities import Problem, RigidPlane
from isomortar.model.numbering import Numbering
from isomortar.scene import Scene
from isomortar.solve.record import StepResult

#: Fields of a contact, and those of bodies.
OF_CONTACT, OF_BODIES = ("pressure", "traction", "gap", "status"), ("displacement", "von Mises stress", "J")
#: Single precision.
_SINGLE = "round-off: numbers of a page have 24 bits"


def taken_apart(page: Path) -> tuple[dict[str, Any], list[tuple[list[FloatArray], list[FloatArray]]]]:
    """What a page says, and of each of its surfaces columns and marks by load step."""
    text = page.read_text(encoding="utf-8")
    said, packed = (re.search(rf'id="{name}">(.*?)</script>', text, re.DOTALL) for name in ("page", "numbers"))
    assert said
    assert packed
    data = json.loads(said[1])
    numbers = np.frombuffer(zlib.decompress(base64.b64decode(packed[1])), "<f4").astype(float)
    surfaces, at = [], 0
    for surface in data["surfaces"]:
        points = int(np.prod([p * n + 1 for p, n in zip(surface["orders"], surface["elements"], strict=True)]))
        at += points
        blocks = []
        for rows, count in ((len(surface["columns"]), points), (4, surface["marks"])):
            for _ in data["steps"]:
                block = numbers[at : at + rows * count].reshape(rows, count)
                block[:3] += np.array(data["centre"])[:, None]
                blocks.append(block)
                at += rows * count
        if surface["contact"] is not None:  # where the master is opposite, and the largest values, of each load step
            at += len(data["steps"]) * (int(np.prod([surface["parts"] * n + 1 for n in surface["elements"]])) + len(surface["columns"]))
        half = len(data["steps"])
        surfaces.append((blocks[:half], blocks[half:]))
    assert at == len(numbers)
    return data, surfaces


def slave(problem: Problem, number: int) -> tuple[tuple[Direction, Direction], FloatArray, np.ndarray]:
    """Directions and weights of a contact's slave face, and its control points within the body."""
    face = problem.contacts[number].slave
    patch = problem.body(face.body).patch
    points = patch.face_points(face.face)
    return patch.face_directions(face.face), patch.weights[points], points


def on_grid(parameters: list[FloatArray]) -> FloatArray:
    """Parameters on a face, the first running fastest."""
    return np.stack(np.meshgrid(*parameters), axis=-1).reshape(-1, 2)


def parts_of(direction: Direction, parts: int) -> FloatArray:
    """Equal parts of elements."""
    return np.interp(np.arange(parts * direction.elements + 1) / parts, np.arange(direction.elements + 1), direction.boundaries)


def at_corners(surface: dict[str, Any], block: FloatArray) -> FloatArray:
    """Columns at the corners of elements, where nets go through their surface, shape (columns, corners)."""
    (p, q), (m, n) = surface["orders"], surface["elements"]
    return block.reshape(len(block), q * n + 1, p * m + 1)[:, ::q, ::p].reshape(len(block), -1)


def quantities(step: StepResult, number: int) -> dict[str, FloatArray]:
    """Control values of what is shown of a contact."""
    state, found = step.state.contacts[number], step.contacts[number]
    return {"pressure": state.pressure, "traction": found.traction_norm, "gap": found.gap}


@case(
    claim="A page to look at has, of each contact and load step, the slave face where it is and pressure, friction and gap there, marks of "
    "control points by their states, the ranges of all fields, and the planes that there are.",
    tier="gate",
    bounds={
        "fields": Bound(at_most=1e-6, reason=f"{_SINGLE}; of the largest value"),
        "marks": Bound(at_most=1e-6, reason=f"{_SINGLE}; of the size of the scene"),
        "ranges": Bound(at_most=1e-12, reason="round-off: values at the parts of elements that are drawn, over the largest"),
        "words": Bound(0.0, 0.0, "definition: load steps, stages, fields, faces and planes that are others, or told of another one"),
    },
)
def page_read() -> dict[str, float]:
    """Largest errors; how many words are wrong."""
    problem = Scene.from_toml(SCENE).problem()
    steps, worst = [over_master(step) for step in load_steps(problem)], {"fields": 0.0, "marks": 0.0, "ranges": 0.0}
    with tempfile.TemporaryDirectory() as folder:
        run, page = Path(folder) / "run.h5", Path(folder) / "run.html"
        recorded(run, problem, steps, "every")
        view(run, page)
        data, surfaces = taken_apart(page)
    names = [contact.name for contact in problem.contacts]
    moments = [(0, "at rest"), *((step.step, step.stage) for step in steps)]
    wrong = int([(step["step"], step["stage"]) for step in data["steps"]] != moments)
    fields = {field["label"]: field for field in data["fields"]}
    wrong += list(fields) != [*(f"{field} of {name}" for name in names for field in OF_CONTACT), *OF_BODIES]
    outer = [
        tuple(k for k, c in enumerate(problem.contacts) if (c.slave.body, c.slave.face) == (b.name, f))
        for b in problem.bodies
        for f in b.outer
    ]
    wrong += [tuple(of["slaveOf"]) for of in data["surfaces"] if of["contact"] is None] != outer
    planes = [contact.master.normal for contact in problem.contacts if isinstance(contact.master, RigidPlane)]
    wrong += not np.allclose([plane["normal"] for plane in data["planes"]], planes) or len(data["sides"]) != len(names)
    for described, (rows, marks) in zip(data["surfaces"], surfaces, strict=True):
        if described["contact"] is not None:
            wrong += described["name"] != names[described["contact"]]
            _compare(problem, steps, described, rows[1:], marks[1:], fields, worst)
    at_rest = [marks[0][3] for described, (_, marks) in zip(data["surfaces"], surfaces, strict=True) if described["contact"] is not None]
    wrong += len(at_rest) != len(names) or any(states.any() for states in at_rest)
    bodies = [rows for described, (rows, _) in zip(data["surfaces"], surfaces, strict=True) if described["contact"] is None]
    way = np.max([np.linalg.norm(row[:3] - rows[0][:3], axis=0).max() for rows in bodies for row in rows])
    low, high = fields["displacement"]["range"]
    worst["fields"] = float(np.max([worst["fields"], abs(high / way - 1.0), abs(low)]))
    return {**worst, "words": float(wrong)}


def _compare(
    problem: Problem,
    steps: list[StepResult],
    described: dict[str, Any],
    rows: list[FloatArray],
    marks: list[FloatArray],
    fields: dict[str, Any],
    worst: dict[str, float],
) -> None:
    """Note the largest errors of a contact's surface."""
    number, columns = described["contact"], described["columns"]
    directions, weights, points = slave(problem, number)
    corners, drawn = (shares(directions, weights, on_grid([parts_of(d, n) for d in directions])) for n in (1, described["parts"]))
    belongs = shares(directions, weights, on_grid([centres(d) for d in directions]))
    ends: dict[str, list[float]] = {name: [] for name in OF_CONTACT[:3]}
    for step, row, mark in zip(steps, rows, marks, strict=True):
        places = Numbering(problem).of_patch(problem.contacts[number].slave.body, step.state.positions)[points]
        found = at_corners(described, row)
        worst["marks"] = float(np.maximum(worst["marks"], np.abs(mark[:3].T - belongs @ places).max()))
        worst["marks"] = float(np.maximum(worst["marks"], np.abs(mark[3] - step.contacts[number].status).max() / 1e4))
        worst["fields"] = float(np.maximum(worst["fields"], np.abs(found[:3].T - corners @ places).max()))
        for name, values in quantities(step, number).items():
            exact = corners @ values
            off = np.abs(found[columns.index(name)] - exact).max() / np.maximum(np.abs(exact).max(), 1e-300)
            worst["fields"] = float(np.maximum(worst["fields"], off))
            ends[name] += [float((drawn @ values).min()), float((drawn @ values).max())]
    for name, told in ends.items():
        low, high = fields[f"{name} of {problem.contacts[number].name}"]["range"]
        exact_low = 0.0 if name != "gap" else float(np.min(told))
        off = np.maximum(abs(low - exact_low), abs(high - np.max(told))) / np.maximum(np.abs(told).max(), 1e-300)
        worst["ranges"] = float(np.maximum(worst["ranges"], off))
