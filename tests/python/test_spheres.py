"""Bodies of the Hertz cases: exact spheres and cylinders, right-handed elements, the same body above and below."""

from __future__ import annotations

import runpy
from pathlib import Path

import numpy as np
import pytest

from isomortar.geometry.patch import Patch
from isomortar.results.bezier import rational, sampling_matrix

spheres = runpy.run_path(str(Path(__file__).parents[2] / "verification/spheres.py"))
CAP = spheres["Cap"](radius=2.0, width=1.5, height=1.2, fine=0.4, elements=4, growing=3)
SHAPES = {
    "revolved": lambda kind, below: CAP.revolved(kind, below),
    "block": lambda kind, below: CAP.block(kind, below),
    "half block": lambda kind, below: CAP.block(kind, below, half=True),
    "cylinder": lambda kind, below: CAP.cylinder(kind, 0.7, below),
}


def samples(patch: Patch) -> np.ndarray:
    """Points of the body on a grid, shape (n_w, n_v, n_u, 3)."""
    matrices = [sampling_matrix(line, 3) for line in patch.directions]
    points, _ = rational(matrices, patch.weights, patch.control_points)
    return points.reshape(*(len(m) for m in reversed(matrices)), 3)


def distances(shape: str, points: np.ndarray) -> np.ndarray:
    """Distances from the centre of the sphere, or the axis of the cylinder."""
    away = points - np.array([0.0, 0.0, np.sign(points[..., 2].sum()) * CAP.radius])
    return np.linalg.norm(away[..., [0, 2]] if shape == "cylinder" else away, axis=-1)


@pytest.mark.parametrize("below", [False, True])
@pytest.mark.parametrize("kind", ["N2", "N3", "N5"])
@pytest.mark.parametrize("shape", list(SHAPES))
def test_nurbs_hold_the_round_face(shape: str, kind: str, below: bool) -> None:
    points = samples(SHAPES[shape](kind, below))
    assert np.abs(distances(shape, points[-1 if below else 0]) - CAP.radius).max() < 1e-12
    assert np.abs(np.abs(points[0 if below else -1][..., 2]) - CAP.height).max() < 1e-12


@pytest.mark.parametrize("kind", ["N1", "L1", "L2", "L3"])
@pytest.mark.parametrize("shape", list(SHAPES))
def test_others_have_nodes_on_the_round_face(shape: str, kind: str) -> None:
    patch = SHAPES[shape](kind, False)
    face = patch.control_points[patch.face_points("w0")]
    if shape == "revolved":  # its middle control points are off the arc
        face = face[np.arange(len(face)) // patch.shape[0] != 1]
    assert np.abs(distances(shape, face) - CAP.radius).max() < 1e-12


@pytest.mark.parametrize("below", [False, True])
@pytest.mark.parametrize("kind", ["N1", "N3", "L2"])
@pytest.mark.parametrize("shape", list(SHAPES))
def test_elements_are_right_handed(shape: str, kind: str, below: bool) -> None:
    points = samples(SHAPES[shape](kind, below))
    corner = points[:-1, :-1, :-1]
    edges = [points[:-1, :-1, 1:] - corner, points[:-1, 1:, :-1] - corner, points[1:, :-1, :-1] - corner]
    volumes = np.linalg.det(np.stack(edges, axis=-1))
    inner = volumes[:, :, 1:] if shape == "revolved" else volumes  # there the corner lies on the axis
    assert inner.min() > 0


def test_elements_are_graded() -> None:
    lengths = np.diff(spheres["graded"](10.0, 1.0, 4, 5))
    assert np.allclose(lengths[:4], 0.25)
    assert np.allclose(lengths[4:] / lengths[3:-1], lengths[5] / lengths[4])
    assert np.isclose(lengths.sum(), 10.0)
