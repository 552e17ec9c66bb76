"""Weights that are all the same, whatever they are, are none: bit for bit."""

from __future__ import annotations

import numpy as np
from solid.material import MATERIAL, curved

from isomortar import _bindings
from isomortar.geometry.patch import FloatArray, Patch
from isomortar.harness import Bound, case
from isomortar.model.entities import Body, Problem
from isomortar.model.numbering import Numbering, patch_arrays
from isomortar.model.solid import Solid

#: Orders and numbers of elements by direction, and Gauss points of an element.
ORDERS, ELEMENTS, GAUSS = (1, 2, 3), (2, 3, 2), (3, 4, 4)


def of_body(patch: Patch, often: bool) -> dict[str, FloatArray]:
    """Forces, tangent, and volumes of control points of a body that is bent; `often`: what is at Gauss points is kept."""
    problem = Problem("one weight", (Body("body", patch, MATERIAL, GAUSS),), (), (), ())
    numbering = Numbering(problem)
    random, places = np.random.default_rng(3), numbering.reference
    stretch, bend = np.eye(3) + 0.1 * random.standard_normal((3, 3)), 0.01 * random.uniform(-1, 1, places.shape)
    positions = np.ascontiguousarray(places @ stretch.T + bend)
    forces, tangent = Solid(problem, numbering).forces_and_tangent(positions)
    arrays, alone = numbering.body_arrays(problem.bodies[0], often), np.zeros_like(places)
    least = _bindings.add_body(arrays, MATERIAL.arrays, positions, alone)
    return {"forces": np.stack([forces, alone]), "tangents": tangent, "volumes": np.append(_bindings.control_volumes(arrays), least)}


def of_faces(patch: Patch) -> dict[str, FloatArray]:
    """Functions of all six faces, to their third derivatives at random places, and at quadrature points with the areas of these."""
    arrays = patch_arrays(patch, np.arange(len(patch.weights), dtype=np.int32))
    anywhere, at_points = list[FloatArray](), list[FloatArray]()
    xi = np.random.default_rng(4).uniform(0.0, 1.0, (20, 2))
    for axis, side in np.ndindex(3, 2):
        directions = patch.face_directions(f"{'uvw'[axis]}{side}")
        low, high = np.array([d.boundaries[[0, -1]] for d in directions]).T
        anywhere.append(_bindings.surface_functions(arrays, axis + 1, side, low + (high - low) * xi)[1].ravel())
        at_points.extend(table.ravel() for table in _bindings.slave_tables(arrays, axis + 1, side, (3, 4), patch.control_points)[1:])
    return {"functions": np.concatenate(anywhere), "tables": np.concatenate(at_points)}


@case(
    claim="A body and its faces whose weights are all the same have the very bits of those without weights: forces, tangents, volumes, "
    "functions and areas.",
    tier="gate",
    grid={"weight": [0.1, 3.0], "often": [False, True]},
    bounds=dict.fromkeys(
        ("forces", "tangents", "volumes", "functions", "tables"), Bound(0.0, 0.0, "definition: a weight that all have is in no quotient")
    ),
)
def one_weight(weight: float, often: bool) -> dict[str, float]:
    """How many numbers have other bits than with weights of one."""
    patch = curved("N", ORDERS, ELEMENTS)
    ones, same = (Patch(patch.directions, patch.control_points, np.full(len(patch.weights), one)) for one in (1.0, weight))
    plain, weighted = (of_body(one, often) | of_faces(one) for one in (ones, same))
    return {name: float(np.count_nonzero(weighted[name] != values)) for name, values in plain.items()}


#: By how much weights differ along a direction in what others are compared with.
MUCH = 0.005


@case(
    claim="Weights that differ along one direction count in proportion, however little it is: in forces, tangents, volumes, functions "
    "and areas.",
    grid={"axis": [0, 1, 2], "little": [1e-3, 1e-7]},
    bounds=dict.fromkeys(
        ("forces", "tangents", "volumes", "functions", "tables"),
        Bound(at_most=0.1, reason="discretisation: differences over others, some of which are five times as large"),
    ),
)
def little_weight(axis: int, little: float) -> dict[str, float]:
    """Changes over what weights differ by, apart from those of weights that differ by more: norm of the difference, over that of these."""
    patch = curved("N", ORDERS, ELEMENTS)
    row = np.unravel_index(np.arange(len(patch.weights)), patch.shape, order="F")[axis]
    share = np.random.default_rng(5).uniform(0.0, 1.0, patch.shape[axis])[row]
    none, few, more = (
        of_body(one, False) | of_faces(one)
        for one in (Patch(patch.directions, patch.control_points, 1.0 + apart * share) for apart in (0.0, little, MUCH))
    )
    slopes = {name: ((few[name] - none[name]) / little, (more[name] - none[name]) / MUCH) for name in none}
    return {name: float(np.linalg.norm(one - other) / np.linalg.norm(other)) for name, (one, other) in slopes.items()}
