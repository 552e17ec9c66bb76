"""What supports leave a body of its rigid motions."""

from __future__ import annotations

import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Body, Problem, Support, unit


def rigid_rank(problem: Problem, piece: tuple[Body, ...], stage: int = 0) -> int:
    """How many of the six rigid motions of a body, with what is glued to it, its supports prevent in a stage."""
    names = {body.name for body in piece}
    holding = [support for support in problem.supports if support.place.body in names and support.holds(stage)]
    if piece[0].rigid:
        return 6 - sum(len(support.pressed) + (support.moment is not None) for support in holding)
    together = np.concatenate([body.patch.control_points for body in piece])
    centre, size = together.mean(axis=0), np.ptp(together, axis=0).max()
    rows = []
    for support in holding:
        patch = problem.body(support.place.body).patch
        arms = patch.control_points[patch.common_points(support.place.meeting)] - centre
        rows.append(_prevented(support, arms / size, (np.asarray(support.centre) - centre) / size))
    return int(np.linalg.matrix_rank(np.vstack(rows), tol=1e-9)) if rows else 0


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
