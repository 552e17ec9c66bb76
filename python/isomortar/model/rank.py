"""What supports leave a body of its rigid motions."""

from __future__ import annotations

import numpy as np

from isomortar.model.entities import Body, Problem


def rigid_rank(problem: Problem, piece: tuple[Body, ...]) -> int:
    """How many of the six rigid motions of a body, with what is glued to it, its supports prevent."""
    rows = []
    together = np.concatenate([body.patch.control_points for body in piece])
    centre, size = together.mean(axis=0), np.ptp(together, axis=0).max()
    for support in (s for s in problem.supports if s.place.body in {body.name for body in piece}):
        patch = problem.body(support.place.body).patch
        arms = (patch.control_points[patch.common_points(support.place.meeting)] - centre) / size
        for component in support.components:
            direction = np.zeros_like(arms)
            direction[:, component] = 1.0
            rows.append(np.hstack([direction, np.cross(arms, direction)]))
        for component in support.pressed:  # a plate goes along it as a whole
            direction = np.zeros_like(arms)
            direction[:, component] = 1.0
            rows.append(np.hstack([0.0 * direction, np.cross(arms - arms[0], direction)]))
    return int(np.linalg.matrix_rank(np.vstack(rows), tol=1e-9)) if rows else 0
