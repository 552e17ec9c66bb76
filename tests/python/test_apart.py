"""When a contact is out of reach: where nothing that the search finds can bear, and only there."""

from __future__ import annotations

import numpy as np
import pytest

from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.feet import gaps
from isomortar.solve.timing import Ledger

#: A slave of size 0.6 and a master that is 0.5 deep, whose faces meet at z = 0.
SCENE = """
format = 1
bodies.slave.geometry = { kind = "box", lower = [-0.3, -0.3, 0], upper = [0.3, 0.3, 0.4] }
bodies.slave.mesh = { order = [2, 2, 1], elements = [2, 2, 1] }
bodies.master.geometry = { kind = "box", lower = [-1, -1, -0.5], upper = [1, 1, 0] }
bodies.master.mesh = { order = [2, 2, 1], elements = [3, 3, 1] }
contacts.c = { slave = "slave.w0", master = "master.w1", projection = "closest" }
supports.top.face = "slave.w1"
supports.base.face = "master.w0"
stages = [{ name = "down", steps = 1, motions.top.translate = [0, 0, -0.01] }]
"""
FACE, PLANE = 'master = "master.w1", projection = "closest"', "plane = { point = [0, 0, 0], normal = [0, 0, 2] }"


class Placed:
    """The bodies, one of them moved."""

    def __init__(self, *settings: str, onto: str = FACE) -> None:
        self.equilibrium = Equilibrium(Scene.from_toml(SCENE.replace(FACE, onto), overrides=settings).problem(), Ledger())
        self.pair = self.equilibrium.pairs[0]
        self.separation = self.pair._separation

    def at(self, *move: float, turn: np.ndarray | None = None) -> np.ndarray:
        """Positions with the slave turned, and moved."""
        positions = self.equilibrium.numbering.reference.copy()
        own = np.unique(self.equilibrium.numbering.points["slave"])
        positions[own] = positions[own] @ (np.eye(3) if turn is None else turn).T + move
        return positions

    def holds(self, start: tuple[float, ...], now: tuple[float, ...], acts: bool = False) -> bool:
        self.separation.begin(self.at(*start), acts)
        return self.separation.holds(self.at(*now))


@pytest.mark.parametrize(
    ("start", "now", "apart"),
    [
        ((0, 0, 0.6), (0, 0, 0.6), True),
        ((0, 0, 0.6), (0, 0, 0.4), False),  # nearer than the master is deep
        ((0, 0, 0.4), (0, 0, 0.6), False),
        ((0, 0, -0.3), (0, 0, -0.3), False),  # within the master's body
        ((0, 0, -0.6), (0, 0, -0.6), True),  # behind it
        ((0, 0, 0.6), (0, 0, -0.6), False),  # through it
        ((2.0, 0, 0), (2.0, 0, 0), True),  # beside it
        ((1.5, 0, 0), (1.5, 0, 0), False),
        ((2.0, 0, 0), (0, 0, 0.6), False),  # round its edge
        ((1.7, 0, 0.45), (1.7, 0, 0.45), True),  # across a corner: the distance of boxes is that of their corners
    ],
)
def test_what_is_farther_than_the_master_is_deep_on_one_side_is_out_of_reach(
    start: tuple[float, ...], now: tuple[float, ...], apart: bool
) -> None:
    assert Placed().holds(start, now) == apart


@pytest.mark.parametrize(("height", "apart"), [(0.001, True), (0.0, False), (-0.001, False), (-5.0, False)])
def test_what_is_in_front_of_a_plane_is_out_of_its_reach(height: float, apart: bool) -> None:
    assert Placed(onto=PLANE).holds((0, 0, -1.0), (0, 0, height)) == apart


@pytest.mark.parametrize(("height", "apart"), [(2.8, False), (2.9, True)])
def test_a_master_of_other_weights_across_is_no_deeper_than_its_diagonal(height: float, apart: bool) -> None:
    placed = Placed()
    placed.separation._same = False
    assert placed.holds((0, 0, height), (0, 0, height)) == apart  # the diagonal is 2.87


def test_what_bore_at_the_start_is_looked_at() -> None:
    placed = Placed()
    assert placed.holds((0, 0, 9.0), (0, 0, 9.0))
    assert not placed.holds((0, 0, 9.0), (0, 0, 9.0), acts=True)


def test_before_a_load_increment_all_is_looked_at() -> None:
    placed = Placed()
    assert not placed.separation.holds(placed.at(0, 0, 9.0))


@pytest.mark.parametrize(
    "settings",
    [
        ('contacts.c.enforcement="dual"',),
        ('bodies.slave.mesh.family="L"',),
        ('contacts.c.enforcement="knots"', 'solver.method="uzawa"'),
    ],
)
def test_weights_below_zero_and_feet_beyond_edges_are_looked_at(settings: tuple[str, ...]) -> None:
    assert not Placed(*settings).holds((0, 0, 9.0), (0, 0, 9.0))


def test_positions_that_are_no_numbers_are_looked_at() -> None:
    placed = Placed()
    placed.separation.begin(placed.at(0, 0, 9.0), False)
    for body in ("slave", "master"):
        positions = placed.at(0, 0, 9.0)
        positions[np.unique(placed.equilibrium.numbering.points[body])[0], 2] = np.nan
        positions[np.unique(placed.equilibrium.numbering.points[body])[-1], 2] = np.nan
        assert not placed.separation.holds(positions)


@pytest.mark.parametrize(("family", "size"), [("N", 3.0), ("L", 7.0)])
def test_nothing_that_is_out_of_reach_is_inside_the_master(family: str, size: float) -> None:
    """Slaves and control points of masters at random places: some out of reach, some not, and those that are have no gap above zero."""
    placed = Placed(f'bodies.master.mesh.family="{family}"')
    random, start = np.random.default_rng(5), placed.equilibrium.initial_state().contacts[0]
    apart = 0
    for _ in range(200):
        turn, _ = np.linalg.qr(random.standard_normal((3, 3)))
        positions = placed.at(*random.uniform(-size, size, 3), turn=turn * np.sign(np.linalg.det(turn)))
        positions += random.uniform(-0.05, 0.05, positions.shape)
        placed.separation.begin(positions, False)
        if not placed.separation.holds(positions):
            continue
        apart += 1
        nowhere = type(start)(start.pressure, start.traction, np.zeros_like(start.projection), np.zeros_like(start.projected))
        kinematics = placed.pair.kinematics(positions, nowhere)
        assert not np.any(gaps(placed.pair.pair, positions, kinematics.projections) > 0.0)
        assert not np.any(kinematics.control.gap > 0.0)
    assert 20 < apart < 180
