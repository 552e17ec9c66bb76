"""A tangent without an inverse: the error says what is left free, and it is the true cause."""

from __future__ import annotations

import numpy as np
import pytest
from told.wrong.singular import BLOCK, CORNER, error, explained

from isomortar.errors import ConvergenceError
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.record import Observer, State, StepResult
from isomortar.solve.singular import explain
from isomortar.solve.timing import Ledger


class Heard(Observer):
    """Keeps warnings, and why increments were cut."""

    def __init__(self) -> None:
        self.said: list[str] = []
        self.reasons: list[str] = []

    def warned(self, message: str) -> None:
        self.said.append(message)

    def cut(self, step: int, time: float, increment: float, reason: str) -> None:
        self.reasons.append(reason)


def test_body_that_slides_is_said_to_move() -> None:
    assert "body 'block' can move along (1, 0, 0) freely" in error(BLOCK + 'supports.top = { face = "block.w1", components = ["y", "z"] }')


def test_body_that_turns_is_said_to_turn() -> None:
    assert "body 'block' can turn about an axis along (" in error(BLOCK + 'supports.top = { face = "block.w1", components = ["z"] }')


def test_held_body_is_not_said_to_move() -> None:
    said = explained([4], [])
    assert "body 'block' is held, but" in said
    assert "freely" not in said


def test_a_body_of_which_all_is_held_and_pushed_into_its_master_says_so() -> None:
    """There are multipliers then, and no unknowns of bodies."""
    motions = "stages.press.motions={top={translate=[0, 0, -0.02]}, sole={translate=[0, 0, -0.02]}}"
    said = error(BLOCK + 'supports.top = { face = "block.w1" }\nsupports.sole = { face = "block.w0" }', motions)
    assert "supports hold all control points, also where they put them into a master" in said


def test_repeated_conditions_name_their_contact() -> None:
    said = explained([], [3, 5])
    assert "contact 'base': the conditions of 2 constraints, the first of them 3, repeat each other" in said


def test_conditions_whose_points_have_left_the_master_say_so() -> None:
    said = explained([], [3, 5], found=0)
    assert "contact 'base': the conditions of 2 constraints, the first of them 3, rest on 0 of the" in said


def test_no_direction_says_nothing() -> None:
    null = np.full(3, np.nan)
    equilibrium = Equilibrium(Scene.from_toml(BLOCK + 'supports.top.face = "block.w1"').problem(), Ledger())
    said = str(explain(0.0, null, equilibrium.supports, equilibrium.numbering.reference, equilibrium.numbering, []))
    assert "nothing can be said" in said


@pytest.mark.parametrize(
    ("overrides", "both"),
    [
        (["contacts.wall.slave='block.w0'", "contacts.wall.plane={ point = [1, 0, 0] }"], ("floor", "wall")),  # the same plane twice
    ],
)
def test_conditions_of_two_contacts_on_the_same_control_points(overrides: list[str], both: tuple[str, str]) -> None:
    said = error(CORNER, *overrides)
    assert all(f"contact '{name}'" in said for name in both), said
    assert "constrain control points that contact" in said


@pytest.mark.parametrize("friction", [0.2, 2.0])
@pytest.mark.parametrize("elements", [[2, 2, 2], [3, 3, 2]])
def test_a_corner_whose_support_pushes_its_edge_into_the_wall_says_so(elements: list[int], friction: float) -> None:
    """Too few control points are free to keep the wall's face where its held edge does not let it be."""
    scene = Scene.from_toml(CORNER, overrides=[f"bodies.block.mesh.elements={elements}", f"contacts.wall.friction={friction}"]).problem()
    heard = Heard()
    try:
        list(Simulation(scene, heard).run())
    except ConvergenceError as stopped:
        heard.reasons.append(str(stopped))
    assert any("behind the plane, by 0.05 at the end of stage 'press', and those cannot give way" in told for told in heard.said)
    assert not any("constrain control points that contact" in reason for reason in heard.reasons), heard.reasons


STICKING = CORNER.replace("[-0.05, 0, -0.05]", "MOTION").replace("max_cuts = 1", "max_cuts = 4")


def pressed(
    motion: list[float], overrides: list[str], monkeypatch: pytest.MonkeyPatch
) -> tuple[Simulation, Heard, list[State], StepResult]:
    """The one load step of a corner, and where its increments began."""
    observer = Heard()
    simulation = Simulation(Scene.from_toml(STICKING.replace("MOTION", str(motion)), overrides=overrides).problem(), observer)
    starts, advance = [], simulation._method.advance
    monkeypatch.setattr(simulation._method, "advance", lambda start, *others: starts.append(start) or advance(start, *others))
    (result,) = simulation.run()
    return simulation, observer, starts, result


@pytest.mark.parametrize(
    ("elements", "friction", "motion"),
    [
        ([3, 3, 2], 0.2, [0.0, 0.0, -0.05]),  # the wall's edge that the support holds bears too
        ([3, 3, 2], 0.2, [0.0, 0.03, -0.05]),
        ([2, 2, 2], 0.2, [0.0, 0.0, -0.05]),
        ([2, 2, 2], 0.2, [0.0, 0.03, -0.05]),
        ([2, 2, 2], 0.5, [0.0, 0.0, -0.05]),
        ([2, 2, 2], 0.9, [0.0, 0.03, -0.05]),
        ([3, 3, 2], 0.5, [0.0, 0.0, -0.05]),
        ([3, 3, 2], 0.9, [0.0, 0.0, -0.05]),
        ([3, 3, 2], 0.9, [0.0, 0.03, -0.05]),
        ([2, 2, 2], 0.9, [0.0, 0.0, -0.05]),
        ([2, 2, 2], 0.5, [0.0, 0.03, -0.05]),
    ],
)
def test_a_corner_that_sticks_to_two_planes(
    elements: list[int], friction: float, motion: list[float], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Six conditions for three components at the edge: all of them hold, forces are in balance, and what is left open is told.

    On the way control points toggle: whether a load step is cut is a matter of round-off, and of the processor. Of 900 paths at a friction
    of 0.9, whose motions differ in the thirteenth digit, three came to an end: here a second one may be tried.
    """
    overrides = [f"contacts.{name}.friction={friction}" for name in ("floor", "wall")] + [f"bodies.block.mesh.elements={elements}"]
    try:
        simulation, observer, starts, result = pressed(motion, overrides, monkeypatch)
    except ConvergenceError:
        simulation, observer, starts, result = pressed([along * (1.0 + 1e-12) for along in motion], overrides, monkeypatch)
    for pair, before, found, state in zip(
        simulation.equilibrium.pairs, starts[-1].contacts, result.contacts, result.state.contacts, strict=True
    ):
        control = pair.kinematics(result.state.positions, before).control
        sticks, active = found.status == 1, found.status > 0
        assert np.abs(control.gap[active] / control.weight[active]).max() <= 1e-9
        assert np.abs(control.slip[sticks] / control.weight[sticks, None]).max(initial=0.0) <= 1e-9
        cone = friction * state.pressure + 1e-8 * np.linalg.norm(state.pressure)  # solver.complementarity_tolerance
        assert np.all(found.traction_norm <= cone)
        assert np.all(state.pressure >= 0.0)
    total = sum(found.force_slave for found in result.contacts)
    assert np.abs(total + result.reactions[0].force).max() <= 1e-8
    floor, wall = (found.status[pair.shared] for pair, found in zip(simulation.equilibrium.pairs, result.contacts, strict=True))
    stuck = np.count_nonzero((floor > 0) & (wall > 0) & ((floor == 1) | (wall == 1)))
    shared = [told for told in observer.said if "at the edge between them" in told]  # others speak of coefficients that this leaves open
    assert [f"{stuck} slave control points" in told for told in shared] == [True] * bool(stuck)


def test_a_corner_without_friction_is_no_such_thing() -> None:
    scene = Scene.from_toml(CORNER, overrides=["contacts.floor.friction=0.0", "contacts.wall.friction=0.0"])
    assert len(list(Simulation(scene.problem()).run())) == 1


FROM_BESIDE = """
format = 1
bodies.slave = { geometry = { kind = "box", lower = [1.2, -0.25, -0.1], upper = [1.7, 0.25, 0.4] }, mesh.elements = [3, 3, 2] }
bodies.master = { geometry = { kind = "box", lower = [-0.5, -0.5, -0.5], upper = [1, 0.5, 0] }, mesh.elements = [4, 4, 2] }
contacts.interface = { slave = "slave.w0", master = "master.w1", friction = 0.3 }
solver = { max_cuts = 1, measures = ["halving"] }
supports = { top.face = "slave.w1", base.face = "master.w0" }
stages = [{ name = "onto", steps = 4, motions.top.translate = [-0.9, 0, 0] }]
"""


def test_a_slave_that_comes_onto_its_master_from_beside() -> None:
    """A row of quadrature points is over the edge, a tenth deep: far more conditions than points."""
    said = error(FROM_BESIDE)
    assert "the slave goes over an edge of its master; 324 of its 324 quadrature points are beside the master" in said
