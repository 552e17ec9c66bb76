"""Feet that do not follow their points, or cannot slip: they stop what carries pressure, and nothing else."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from isomortar.errors import LostProjectionError
from isomortar.geometry.patch import Direction, Patch
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.timing import Ledger

#: The lower face of a block holds the axis of a ring: from its middle row of points the inside of the ring is equally far all round.
ON_THE_AXIS = """
format = 1
bodies.ring.geometry = {{ kind = "ring", centre = [{x}, 0, 0], inner = 0.3, outer = 0.5, width = 0.4 }}
bodies.ring.mesh.elements = [8, 1, 1]
bodies.block.geometry = {{ kind = "box", lower = [{low}, -0.1, 0.0], upper = [{high}, 0.1, 0.15] }}
contacts.inside = {{ slave = "block.w0", master = "ring.v0", projection = "closest", quadrature = 3, friction = {friction} }}
supports.outside.face = "ring.v1"
supports.top.face = "block.w1"
stages = [{{ name = "down", steps = 2, motions.top.translate = [0, 0, -0.02] }}]
"""


def on_the_axis(x: float = 0.0, friction: float = 0.0) -> Problem:
    """The block in the ring, both moved along x."""
    return Scene.from_toml(ON_THE_AXIS.format(x=x, low=x - 0.1, high=x + 0.1, friction=friction)).problem()


def loaded(problem: Problem) -> None:
    """Contact forces with every slave control point under pressure, where the reference configuration projects."""
    equilibrium = Equilibrium(problem, Ledger())
    pair, state = equilibrium.pairs[0], equilibrium.initial_state()
    n = len(pair.pair.slave.point)
    kinematics = pair.kinematics(state.positions, state.contacts[0])
    response = pair.respond(kinematics, pair.law(np.array([1e-9, 1e-9]), np.ones(n), np.zeros((n, 2))))
    forces = np.zeros_like(state.positions)
    pair.add_forces(state.positions, kinematics, response, forces)
    assert 0.0 < np.abs(forces).max() < 10.0


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_open_points_may_be_as_near_to_many_places_as_to_one(friction: float) -> None:
    results = list(Simulation(on_the_axis(friction=friction)).run())
    assert [result.contacts[0].active for result in results] == [0, 0]
    assert [result.contacts[0].excluded for result in results] == [0, 0]
    assert all(-0.31 < gap < -0.19 for result in results for gap in result.contacts[0].gap)


def test_slips_do_not_count_from_a_foot_that_does_not_follow() -> None:
    state = Equilibrium(on_the_axis(friction=0.3), Ledger()).initial_state().contacts[0]
    assert state.projected.tolist() == [1, 0, 1] * 3


@pytest.mark.parametrize("x", [0.0, 1000.0])
def test_a_loaded_point_without_a_direction_is_named(x: float) -> None:
    with pytest.raises(LostProjectionError) as error:
        loaded(on_the_axis(x))
    assert error.value.place == 1
    for said in ("'inside'", f"quadrature point 1 at ({x:.4g}, ", "gap of -0.3,", "as near as the nearest", "less hollow"):
        assert said in str(error.value)


def cone(friction: float) -> Problem:
    """A block over the pole of a cap, a quadratic body of four elements round an axis."""
    text = """
format = 1
bodies.cap.geometry = { kind = "box", lower = [-1, -1, 0], upper = [1, 1, 1] }
bodies.block.geometry = { kind = "box", lower = [-0.3, -0.3, 1.0], upper = [0.3, 0.3, 1.5] }
contacts.top = { slave = "block.w0", master = "cap.v1", quadrature = 4 }
supports.inside.face = "cap.v0"
supports.top.face = "block.w1"
stages = [{ name = "down", steps = 1, motions.top.translate = [0, 0, -0.02] }]
"""
    problem = Scene.from_toml(text).problem()
    arc, line = Direction("N", 2, np.array([0.0, 0, 0, 1, 1, 1])), Direction("N", 1, np.array([0.0, 0, 1, 1]))
    square = np.array([[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]], dtype=float)
    round_it = Direction("N", 2, np.array([0.0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4]))
    points = [[r * x * s, r * y * s, r * z] for x, y in square for r in (0.5, 1.0) for s, z in ((1, 0), (1, 1), (0, 1))]
    weights = [a * b for a in [1, np.sqrt(0.5)] * 4 + [1] for _ in (0.5, 1.0) for b in (1, np.sqrt(0.5), 1)]
    patch = Patch((arc, line, round_it), np.array(points, dtype=float), np.array(weights))
    cap = replace(problem.body("cap"), patch=patch, closed="w", quadrature=(4, 2, 4))
    return replace(problem, bodies=(cap, problem.body("block")), contacts=(replace(problem.contacts[0], friction=friction),))


def test_a_pole_is_one_control_point() -> None:
    numbers = Equilibrium(cone(0.0), Ledger()).numbering.points["cap"].reshape(9, 2, 3)
    assert all(len(set(numbers[:, v, 2])) == 1 for v in (0, 1))
    assert len(set(numbers.ravel())) == 2 * (2 * 8 + 1)


def test_friction_beside_a_pole_is_refused_by_name() -> None:
    loaded(cone(0.0))
    with pytest.raises(LostProjectionError, match=r"ends at a pole.*Take more elements of the master towards it.*set friction = 0"):
        loaded(cone(0.3))


def test_a_body_that_passes_through_is_named_with_its_place() -> None:
    problem = cone(0.0)
    equilibrium = Equilibrium(problem, Ledger())
    pair, state = equilibrium.pairs[0], equilibrium.initial_state()
    below = state.positions.copy()
    below[equilibrium.numbering.points["block"], 2] -= 0.8
    with pytest.raises(LostProjectionError, match=r"contact 'top': slave quadrature point 0 has passed.*, at \(-0.25.*, -0.25.*, 0.2\)"):
        pair.kinematics(below, state.contacts[0])


def ridge(friction: float, height: float) -> Problem:
    """A block's lower face above a ridge between hollow quadratic elements: its middle points have their feet on the ridge.

    At a height of 0.41 they are at the centre of curvature of the elements beside it.
    """
    text = """
format = 1
bodies.hills.geometry = { kind = "box", lower = [-1, -1, -1], upper = [1, 1, 0] }
bodies.hills.mesh = { family = "L", order = 2, elements = [2, 2, 1] }
bodies.block.geometry = { kind = "box", lower = [-0.1, -0.9, 0.0], upper = [0.1, -0.1, 0.4] }
contacts.top = { slave = "block.w0", master = "hills.w1", projection = "closest", quadrature = 3, friction = FRICTION }
supports.under.face = "hills.w0"
supports.top.face = "block.w1"
stages = [{ name = "down", steps = 1, motions.top.translate = [0, 0, -0.02] }]
"""
    problem = Scene.from_toml(text.replace("FRICTION", str(friction))).problem()
    hills, block = problem.body("hills"), problem.body("block")
    points, above = hills.patch.control_points.copy(), block.patch.control_points + np.array([0.0, 0.0, height])
    top = hills.patch.face_points("w1")
    points[top, 2] = -0.8 * np.abs(points[top, 0]) + 2.0 * points[top, 0] ** 2
    bodies = (
        replace(hills, patch=replace(hills.patch, control_points=points)),
        replace(block, patch=replace(block.patch, control_points=above)),
    )
    return replace(problem, bodies=bodies)


@pytest.mark.parametrize("height", [0.3, 0.41, 0.45])
def test_without_friction_a_line_needs_its_own_curvature_alone(height: float) -> None:
    loaded(ridge(0.0, height))


@pytest.mark.parametrize("height", [0.41, 0.45])
def test_friction_on_a_line_beyond_the_centre_of_curvature_beside_it_is_refused(height: float) -> None:
    loaded(ridge(0.3, 0.3))
    with pytest.raises(LostProjectionError, match=r"on a C0 line of the master.*slips have no measure"):
        loaded(ridge(0.3, height))
