"""What supports leave a body of its rigid motions."""

from __future__ import annotations

import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Body, Problem, Support, unit


def rigid_rank(problem: Problem, piece: tuple[Body, ...], stage: int = 0) -> int:
    """How many of the six rigid motions of a body, with what is glued to it, its supports prevent in a stage."""
    return 6 - len(motions_left(problem, piece, stage))


def motions_left(problem: Problem, piece: tuple[Body, ...], stage: int = 0) -> FloatArray:
    """Rigid motions that the supports leave a body, with what is glued to it, in a stage: those `moved` takes, shape (motions, 6)."""
    names = {body.name for body in piece}
    holding = [support for support in problem.supports if support.place.body in names and support.holds(stage)]
    centre, size = extent(piece)
    centres = [(np.asarray(support.centre) - centre) / size for support in holding]
    if piece[0].rigid:
        pressed = [np.eye(6)[k] for support in holding for k in support.pressed]
        turned = [(unit(s.axis), c) for s, c in zip(holding, centres, strict=True) if s.moment is not None]
        return np.array([*pressed, *(np.concatenate([np.cross(c, axis), axis]) for axis, c in turned)]).reshape(-1, 6)
    rows = [np.zeros((6, 6))]  # six at least, so that all motions are told
    for support, c in zip(holding, centres, strict=True):
        patch = problem.body(support.place.body).patch
        arms = patch.control_points[patch.common_points(support.place.meeting)] - centre
        rows.append(_prevented(support, arms / size, c))
    *_, values, motions = np.linalg.svd(np.vstack(rows), full_matrices=False)
    return np.asarray(motions[np.count_nonzero(values > 1e-9) :])


def moved(piece: tuple[Body, ...], motion: FloatArray, points: FloatArray) -> FloatArray:
    """Displacements of points, shape (n, 3), by a rigid motion of a body: along the axes, and about them through its middle by its size."""
    centre, size = extent(piece)
    return motion[:3] + np.cross(motion[3:], (points - centre) / size)


def extent(piece: tuple[Body, ...]) -> tuple[FloatArray, float]:
    """The middle of a body's control points, and how far they reach along an axis."""
    together = np.concatenate([body.patch.control_points for body in piece])
    return together.mean(axis=0), float(np.ptp(together, axis=0).max())


def _prevented(support: Support, arms: FloatArray, centre: FloatArray) -> FloatArray:
    """What rigid motions do to a support's face beyond what it goes along with as a plate, shape (rows, 6)."""
    carried = list(support.carried)
    motions = np.stack([*np.broadcast_to(np.eye(3)[:, None], (3, *arms.shape)), *np.cross(np.eye(3)[:, None], arms)])
    rows = motions[:, :, carried].reshape(6, -1).T
    free = [motions[k] for k in support.pressed]
    free += [np.cross(unit(support.axis), arms - centre)] if support.moment is not None else []
    if not free:
        return rows
    basis = np.linalg.qr(np.stack(free)[:, :, carried].reshape(len(free), -1).T)[0]
    return np.asarray(rows - basis @ (basis.T @ rows))
