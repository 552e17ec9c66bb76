"""A load step that is given up names what is behind it, and names nothing in a sound scene."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from told.wrong.causes import SCENE, SOUND, said, scene

from isomortar.errors import ConvergenceError, InputError, SingularSystemError
from isomortar.geometry.patch import Direction, Patch
from isomortar.geometry.primitives import box, ring
from isomortar.geometry.refinement import mesh
from isomortar.march.simulation import Simulation
from isomortar.model.contrasts import element_lengths
from isomortar.scene import Scene
from isomortar.told.before.doubts import doubts
from isomortar.told.before.pairing import few_points

#: A block pressed onto a larger one, and slid off over its edge.
OVER_THE_EDGE = """
format = 1
bodies.upper.geometry = { kind = "box", lower = [-0.4, -0.4, 0.0], upper = [0.4, 0.4, 0.6] }
bodies.lower = { geometry = { kind = "box", lower = [-1, -1, -1], upper = [1, 1, 0] }, mesh = { elements = [2, 2, 1] } }
contacts.pair = { slave = "upper.w0", master = "lower.w1", friction = FRICTION }
supports = { top.face = "upper.w1", base.face = "lower.w0" }
solver.max_cuts = 5
stages = [
    { name = "press", steps = 2, motions.top.translate = [0, 0, DOWN] },
    { name = "slide", steps = 10, motions.top.translate = [2.0, 0, 0] },
]
[bodies.upper.mesh]
order = [ORDER, ORDER, 1]
elements = [ELEMENTS, ELEMENTS, 2]
"""


@pytest.mark.parametrize(
    ("friction", "down", "order", "comes_past"),
    [(0.0, -0.05, 2, True), (0.3, -0.15, 2, True), (0.3, -0.15, 1, True), (0.0, -0.15, 1, False)],
)
def test_a_slave_that_slides_over_an_edge_comes_past_it_or_says_so_and_how(
    friction: float, down: float, order: int, comes_past: bool
) -> None:
    """Where coarse elements lie across the edge few points bear, fewer than they have conditions; the cure that is named cures."""

    def run(elements: int) -> str:
        text = OVER_THE_EDGE.replace("FRICTION", str(friction)).replace("DOWN", str(down))
        problem = Scene.from_toml(text.replace("ORDER", str(order)).replace("ELEMENTS", str(elements))).problem()
        try:
            return f"load step {len(list(Simulation(problem).run()))}"
        except ConvergenceError as error:
            return str(error)

    coarse = run(2)
    assert coarse == "load step 12" if comes_past else ("goes over an edge" in coarse and "Refine the slave" in coarse)
    assert run(4) == "load step 12"


#: A block that lies on something by its weight, and is pushed by other loads; it bears 0.6, and can bear 0.18 along its face.
PUSHED = """
format = 1
materials.soft.young = 100
bodies.block = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 0.3] }, mesh.elements = [2, 2, 1] }
contacts.floor = { slave = "block.w0", friction = 0.3, GROUND }
loads.own = { body = "block", weight = [0, 0, -2] }
supports.hand = { face = "block.w1", centre = [0.5, 0.5, 0.3], stages = ["push"], force = { PUSH }
solver = { max_cuts = 6, max_iterations = 12 }
stages = [{ name = "lie", steps = 1 }, { name = "push", steps = 4 }]
"""
ON = {
    "plane": "plane = {}",
    "body": """master = "table.w1" }
supports.table.face = "table.w0"
bodies.table = { geometry = { kind = "box", lower = [-1, -1, -0.5], upper = [2, 2, 0] }, mesh.elements = [2, 2, 1]""",
}
PUSHES = {"along": ("x = SIZE, y = 0, z = 0 }", 0.17, 0.24), "round": ("x = 0, y = 0, z = 0 }, moment = SIZE", 0.03, 0.1)}


def pushed(push: str, ground: str, size: float) -> Simulation:
    text = PUSHED.replace("GROUND", ON[ground]).replace("PUSH", PUSHES[push][0].replace("SIZE", str(size)))
    return Simulation(Scene.from_toml(text).problem())


@pytest.mark.parametrize("push", PUSHES)
@pytest.mark.parametrize("ground", ON)
def test_a_body_that_its_weight_holds_rests_as_long_as_friction_bears_its_loads_and_slides_beyond(ground: str, push: str) -> None:
    _, least, most = PUSHES[push]
    (*_, last) = pushed(push, ground, least).run()
    np.testing.assert_allclose(last.contacts[0].force_slave, -last.reactions[-1].force - last.loads[0].force, atol=1e-9)
    with pytest.raises(ConvergenceError, match="nothing else keeps body 'block' from going along with its loads: beyond that it slides"):
        list(pushed(push, ground, most).run())


def test_what_a_support_drags_does_not_slide_by_its_loads() -> None:
    """All of its friction is used up, along what the support prescribes."""
    text = """
format = 1
bodies.block = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 0.3] }, mesh.elements = [3, 3, 1] }
contacts.floor = { slave = "block.w0", friction = 0.3, plane = {} }
supports.top = { face = "block.w1", force.z = -1 }
stages = [{ name = "press", steps = 1 }, { name = "drag", steps = 4, motions.top.translate = [0.5, 0, 0] }]
"""
    simulation = Simulation(Scene.from_toml(text).problem())
    (*_, last) = simulation.run()
    assert np.hypot(*last.reactions[0].force[:2]) == pytest.approx(0.3)
    assert said(simulation) == []


def test_a_sound_scene_gives_no_cause() -> None:
    assert said(scene(SLIP=2e-3)) == said(scene()) == said(scene(), SingularSystemError("")) == []


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"TOP": 1.000001}, "elements of body 'upper' are 1.0e-06 thin and up to 5.0e-01 long"),
        ({"POISSON": 0.499999}, "Poisson's ratio 0.499999 body 'lower' resists compression 500 000 times"),
        ({"HARD": 1e12}, "body 'upper' is 1e+11 times as stiff as 'lower'"),
        ({"METHOD": "uzawa", "PENALTY": 1e4}, "a penalty of 10000,"),
        ({"SLAVE": 1, "MASTER": 8}, "contacts.c.quadrature = [16, 16]"),
        ({"SLIP": 1e-4}, "an elastic slip of 0.0001, where the slave is 1 large"),
        ({"SLIP": 1e-4, "WIDE": 3}, "an elastic slip of 0.0001, where the slave is 1 large"),
    ],
)
def test_each_cause_is_named_alone(changes: dict[str, Any], words: str) -> None:
    found = said(scene(**changes))
    assert len(found) == 1
    assert words in found[0]


def test_thin_bodies_bend_to_a_singular_tangent_sooner() -> None:
    thin = scene(TOP=1.0004)
    assert said(thin) == []
    assert "4.0e-04 thin" in said(thin, SingularSystemError(""))[0]


def test_penalties_of_the_monolithic_method_are_no_cause() -> None:
    assert said(scene(PENALTY=1e4)) == []


def test_bodies_pressed_flat_are_named_with_what_is_left_of_them() -> None:
    simulation = scene()
    positions = simulation.state.positions.copy()
    lower = np.unique(simulation.equilibrium.numbering.points["lower"])
    positions[lower, 2] *= 0.05
    simulation.state = replace(simulation.state, positions=positions)
    assert simulation.equilibrium.solid.smallest_jacobians(positions) == pytest.approx([1.0, 0.05])
    found = said(simulation)
    assert len(found) == 1
    assert "body 'lower' is pressed flat by then, down to J = 5.0e-02" in found[0]


def test_the_message_of_a_step_that_is_given_up_ends_with_the_causes() -> None:
    simulation = scene(POISSON=0.499999)
    with pytest.raises(ConvergenceError, match=r"step: no luck\. With Poisson's ratio 0\.499999 body 'lower'"):
        simulation._cut(1, simulation.state, 1.0, 0.5**8, 1.0, ConvergenceError("no luck"), [])


#: Six points a cell are more than the elements of the master.
IN_CELLS = {"SLAVE": 1, "MASTER": 8, "POINTS": "6\nsubcells = 1"}


def test_few_points_are_warned_of_under_a_stiffer_slave_only() -> None:
    for changes, count in (
        ({}, 0),
        ({"HARD": 1}, 0),
        ({"SLAVE": 1, "MASTER": 8, "HARD": 1}, 0),
        ({"SLAVE": 1, "MASTER": 8}, 1),
        (IN_CELLS, 0),
    ):
        problem = scene(**changes).problem
        assert len(list(few_points(problem, problem.contacts[0]))) == count


@pytest.mark.parametrize(("slave", "master"), [(1, 8), (3, 20), (3, 22)])
def test_points_that_are_advised_are_two_in_each_element_of_the_master_and_no_more(slave: int, master: int) -> None:
    problem = scene(SLAVE=slave, MASTER=master).problem
    (said,) = few_points(problem, problem.contacts[0])
    needed = -(-2 * master // slave)
    assert said.endswith(f"quadrature = [{needed}, {needed}]")


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_elements_are_as_long_as_their_spans_of_a_straight_box(axis: int) -> None:
    knots = np.array([0.0, 0.0, 0.0, 0.0, 0.1, 0.5, 0.5, 2.0, 2.0, 2.0, 2.0])
    line = np.array([knots[i + 1 : i + 4].mean() for i in range(7)])
    directions = [Direction("N", 1, np.array([0.0, 0.0, 3.0, 3.0]))] * 3
    directions[axis] = Direction("N", 3, knots)
    lines = [np.array([0.0, 3.0])] * 3
    lines[axis] = line
    grid = np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape((-1, 3), order="F")
    lengths = element_lengths(Patch((directions[0], directions[1], directions[2]), grid, np.ones(28)))
    for k in range(3):
        np.testing.assert_allclose(lengths[k], [0.1, 0.4, 1.5] if k == axis else [3.0], rtol=1e-14)


def test_lagrange_elements_and_poles_have_their_lengths() -> None:
    lagrange = mesh(box((0, 0, 0), (1, 2, 3)), ("L", "L", "L"), (2, 3, 1), (2, 1, 4))
    for found, wanted in zip(element_lengths(lagrange), ([0.5, 0.5], [2.0], [0.75] * 4), strict=True):
        np.testing.assert_allclose(found, wanted, rtol=1e-14)
    points = box((0, 0, 0), (1, 1, 1)).control_points.copy()
    points[4:6] = [0.5, 0.0, 1.0]  # an edge along u
    assert [length.min() for length in element_lengths(Patch(box((0, 0, 0), (1, 1, 1)).directions, points, np.ones(8)))] >= [1.0] * 3


def test_short_spans_are_warned_of_and_by_direction() -> None:
    def warned(span: float) -> list[str]:
        simulation = scene()
        body = simulation.problem.bodies[1]
        knots = np.array([0.0, 0.0, 0.0, span, 0.5, 1.0, 1.0, 1.0])
        line = np.array([knots[i + 1 : i + 3].mean() for i in range(5)])
        grid = np.stack(np.meshgrid(line, [0.0, 1.0], [0.0, 1.0], indexing="ij"), axis=-1).reshape((-1, 3), order="F")
        linear = Direction("N", 1, np.array([0.0, 0.0, 1.0, 1.0]))
        patch = Patch((Direction("N", 2, knots), linear, linear), grid, np.ones(20))
        bodies = (simulation.problem.bodies[0], replace(body, patch=patch, quadrature=(3, 2, 2)))
        problem = replace(simulation.problem, bodies=bodies)
        return [text for text in doubts(problem, Simulation(problem).state) if "elements along" in text]

    assert warned(1e-6) == []
    (text,) = warned(1e-9)
    assert "'lower': its elements along u are 1.0e-09 to 5.0e-01 long" in text


@pytest.mark.parametrize("factor", [2.0**-1000, 2.0**-70, 2.0**66, 2.0**1000])
def test_knots_and_weights_in_any_unit_give_the_same_patch(factor: float) -> None:
    usual = mesh(ring((0.0, 0.0, 0.0), 0.5, 1.0, 1.0), ("N", "N", "N"), (3, 2, 1), (8, 2, 1))
    directions = [Direction(d.family, d.order, factor * d.knots) for d in usual.directions]
    other = Patch((directions[0], directions[1], directions[2]), usual.control_points, factor * usual.weights)
    for mine, theirs in [
        *((d.knots, e.knots) for d, e in zip(other.directions, usual.directions, strict=True)),
        (other.weights, usual.weights),
    ]:
        ratios = mine[theirs != 0.0] / theirs[theirs != 0.0]
        assert np.all(ratios == ratios[0])
        assert np.log2(ratios[0]) == int(np.log2(ratios[0]))
        assert 0.25 <= np.abs(mine).max() <= 4.0


def test_coordinates_without_digits_are_refused() -> None:
    with pytest.raises(InputError, match="so far from the origin coordinates hold no smaller differences"):
        box((1e16, 0.0, 0.0), (1e16, 1.0, 1.0))
    with pytest.raises(InputError, match=r"larger than that of lower = \[0.0, 0.0, 0.0\]$"):
        box((0.0, 0.0, 0.0), (1.0, 1.0, 0.0))
    far = SCENE.replace("lower = [0, 0, 0], upper = [WIDE,", "lower = [11e12, 0, 0], upper = [11000000000001,")
    for name, value in SOUND.items():
        far = far.replace(name, str(value))
    scene = Scene.from_toml(far)
    with pytest.raises(InputError, match=r"bodies.lower: body 'lower' stands 1.1e\+13 from the origin"):
        scene.problem()


def test_a_path_tolerance_that_no_increment_meets_names_one_that_is_met() -> None:
    def first_step(tolerance: str) -> str:
        scene = Scene.load("press", [f"solver.path_tolerance={tolerance}", "solver.max_cuts=3"])
        try:
            next(iter(Simulation(scene.problem()).run()))
        except ConvergenceError as error:
            return str(error)
        return ""

    words = r"error of the multipliers is (\S+), above solver.path_tolerance = 0.001. .* take solver.path_tolerance = (\S+) or more, let"
    told = re.search(words, first_step("1e-3"))
    assert told
    assert float(told[1]) <= float(told[2]) < 2.0 * float(told[1])
    assert first_step(told[2]) == ""
