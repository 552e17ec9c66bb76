"""Supports by force: what cannot be meant is refused; results hold what it exerts and how far it went, to the last bit when resumed."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path

import h5py
import numpy as np
import pytest
from told.wrong.forces import GOOD, HALVED, WRONG

from isomortar import run
from isomortar.cli.check import lines
from isomortar.errors import InputError
from isomortar.march.outlook import outlook
from isomortar.march.simulation import Simulation
from isomortar.model.numbering import Numbering
from isomortar.model.rank import rigid_rank
from isomortar.model.supports import Supports
from isomortar.program.getfem import GetFEM
from isomortar.results.files import read, sealed
from isomortar.results.reader import Results
from isomortar.scene import Scene
from stopped_runs import Stopped


@pytest.mark.parametrize(("old", "new", "field", "text"), WRONG.values(), ids=list(WRONG))
def test_what_cannot_be_meant_is_refused(old: str, new: str, field: str, text: str) -> None:
    assert GOOD.count(old) == 1
    with pytest.raises(InputError) as raised:
        Scene.from_toml(GOOD.replace(old, new)).problem()
    assert raised.value.field == field
    assert text in str(raised.value)


def test_a_force_through_a_plane_of_symmetry_is_refused() -> None:
    text = HALVED.replace("FORCE", "force.y = 0") + "symmetry = { y = 0.0 }\n"
    with pytest.raises(InputError, match="has a component along y, through the plane y = 0"):
        Scene.from_toml(text).problem()


def test_a_force_is_that_of_the_whole() -> None:
    text = HALVED.replace("FORCE", "force = { x = 0.1, z = 0.2 }")
    whole, half = (list(Simulation(Scene.from_toml(text + more).problem()).run())[-1] for more in ("", "symmetry = { y = 0.0 }\n"))
    for one, other in zip(whole.reactions, half.reactions[:2], strict=True):
        np.testing.assert_allclose(one.force, other.force, atol=1e-9)
        np.testing.assert_allclose(one.moment, other.moment, atol=1e-9)
        np.testing.assert_allclose(one.displacement, other.displacement, atol=1e-9)


def test_other_programs_are_not_told_of_forces() -> None:
    with pytest.raises(InputError, match="is not told of forces of supports"):
        GetFEM().run(Scene.from_toml(HALVED.replace("FORCE", "force.z = 1").replace("order = 2", "order = 1")).problem())


def test_a_plate_is_one_unknown() -> None:
    problem = Scene.from_toml(GOOD).problem()
    supports = Supports(problem, Numbering(problem))
    (plate,) = supports.plates
    assert len(np.unique(supports.equation[plate.unknowns(2)])) == 1
    assert len(supports.free) == supports.equation.max() + 1
    forces, here = np.random.default_rng(0).standard_normal((len(supports.held), 3)), supports.place(0.0)
    solution = np.random.default_rng(1).standard_normal(len(supports.free))
    work = float(np.sum(forces * supports.spread(solution, here)))
    np.testing.assert_allclose(
        supports.gathered(forces, here).ravel()[supports.free] @ solution, work, rtol=1e-13
    )  # virtual work is the same
    left = supports.unbalanced(forces, here, 1.0) - supports.gathered(forces, here)
    np.testing.assert_allclose(left.sum(axis=0), [0.0, 0.0, 0.15], atol=1e-14)
    assert rigid_rank(problem, (problem.body("pad"),)) == 5  # it may go along z, and not tilt


@pytest.mark.parametrize("method", ["monolithic", "uzawa"])
@pytest.mark.parametrize("wall", [1.01, 3.0], ids=["nearer", "farther"])
def test_a_wall_that_a_pad_slides_past_is_not_what_its_weight_closes(method: str, wall: float) -> None:
    """The pad falls by 0.03 onto the die: that a wall at its side is nearer, or a second contact far away, changes no bit."""
    side = f'[contacts.side]\nslave = "pad.u1"\nplane = {{ point = [{wall}, 0, 0], normal = [-1, 0, 0] }}\n[supports.top]'
    found = []
    for text in (GOOD, GOOD.replace("[supports.top]", side)):
        tight = [f'solver.method="{method}"', "solver.newton_tolerance=1e-13"]
        problem = Scene.from_toml(text.replace("steps = 2", "steps = 1"), overrides=tight).problem()
        found.append(next(iter(Simulation(problem).run())))
    assert np.any(found[0].state.contacts[0].pressure > 0.0)
    np.testing.assert_allclose(found[1].state.positions, found[0].state.positions, rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("method", ["monolithic", "uzawa"])
@pytest.mark.parametrize("wall", [1.01, 3.0], ids=["near", "far"])
def test_a_pad_that_rests_by_its_weight_alone_is_not_drawn_to_a_wall(method: str, wall: float) -> None:
    """Nothing but friction holds it across its weight, so that it could go anywhere; its weight takes it down."""
    free = GOOD.replace('[supports.top]\nface = "pad.w1"\nforce.z = -0.3', '[loads.heavy]\nbody = "pad"\nweight = [0, 0, -0.3]')
    for what, by in (("motions.top.translate = [0.05, 0, 0]\nloads.top = 1.5", ""), ("steps = 2", "steps = 1"), ("0.03]", "0]")):
        free = free.replace(what, by)
    side = f'[contacts.side]\nslave = "pad.u1"\nplane = {{ point = [{wall}, 0, 0], normal = [-1, 0, 0] }}\n[loads.heavy]'
    found = []
    for text in (free, free.replace("[loads.heavy]", side)):
        problem = Scene.from_toml(text, overrides=[f'solver.method="{method}"']).problem()
        found.append(next(iter(Simulation(problem).run())))
    assert np.any(found[0].state.contacts[0].pressure > 0.0)
    np.testing.assert_allclose(found[1].state.positions, found[0].state.positions, rtol=0.0, atol=1e-12)


def test_results_hold_forces_and_ways_to_the_last_bit(tmp_path: Path) -> None:
    scene = Scene.from_toml(GOOD)
    run(scene, tmp_path / "whole.h5")
    with pytest.raises(KeyboardInterrupt):
        run(scene, tmp_path / "parts.h5", observer=Stopped(3))
    run(scene, tmp_path / "parts.h5", resume=True)
    with Results(tmp_path / "whole.h5") as one, Results(tmp_path / "parts.h5") as other:
        for quantity in ("force", "displacement"):
            np.testing.assert_array_equal(one.curve(quantity, support="top"), other.curve(quantity, support="top"))
        np.testing.assert_array_equal(one.step(4).state.positions, other.step(4).state.positions)
        np.testing.assert_allclose(one.curve("force", support="top", component="z"), [-0.15, -0.3, -0.375, -0.45], rtol=1e-8)
        ways = one.curve("displacement", support="top")
        np.testing.assert_allclose(ways[:, 0], [0.0, 0.0, 0.025, 0.05], atol=1e-15)
        assert np.all(np.diff(ways[:, 2]) < 0.0)
        np.testing.assert_array_equal(one.problem.supports[0].force, (None, None, -0.3))


def test_in_files_from_before_ways_are_those_of_motions(tmp_path: Path) -> None:
    scene = Scene.from_toml(HALVED.replace("FORCE", "components = ['z']"))
    run(scene, tmp_path / "now.h5")
    (tmp_path / "before.h5").write_bytes(read(tmp_path / "now.h5"))
    with h5py.File(tmp_path / "before.h5", "a") as file:
        del file["curves/supports/end/displacement"]
    content = (tmp_path / "before.h5").read_bytes()
    (tmp_path / "before.h5").write_bytes(sealed(content))
    with Results(tmp_path / "before.h5") as before:
        assert not before.curve("displacement", support="end").any()
        assert not before.step(1).reactions[1].displacement.any()


def test_a_look_at_a_scene_tells_of_forces() -> None:
    said = list(lines(outlook(Scene.from_toml(GOOD).problem())))
    assert "support top: prescribes x, y of pad.w1; goes 0.05 and presses z by -0.3" in said


def test_default_curves_show_how_far_a_force_goes() -> None:
    names = [curve.name for curve in Scene.from_toml(GOOD).curves()]
    assert "top displacement z" in names
    assert not [name for name in names if name.startswith("die")]


#: A rigid ring that a force presses into a block, and then no longer does.
LET_GO = """
format = 1
materials.soft.young = 100
bodies.ring = { geometry = { kind = "ring", centre = [0.5, 0, 0.5], outer = 0.5, inner = 0.3, width = 1 }, rigid = true }
bodies.base = { geometry = { kind = "box", lower = [0, 0, -0.6], upper = [1, 1, 0] }, mesh.elements = [3, 1, 1] }
contacts.sole = { slave = "base.w1", master = "ring.v1", friction = 0.5 }
supports = { base.face = "base.w0", hand = { face = "ring.v0", components = ["x", "y"], force.z = -1 } }
solver.max_cuts = 5
stages = [{ name = "press", steps = 1 }, { name = "back", steps = 1, loads.hand = 0 }, { name = "again", steps = 1, loads.hand = 1 }]
"""


@pytest.mark.parametrize("method", ["monolithic", "uzawa"])
def test_a_rigid_body_that_its_force_lets_go_stays_where_nothing_acts_on_it_and_is_pressed_again(method: str) -> None:
    """What it pressed comes back in more than one iteration, in which nothing holds it any longer."""
    pressed, back, again = Simulation(Scene.from_toml(LET_GO, overrides=[f"solver.method={method}"]).problem()).run()
    assert back.contacts[0].active == 0
    assert not np.any(back.contacts[0].force_master)
    assert again.reactions[1].displacement[2] == pytest.approx(pressed.reactions[1].displacement[2], rel=1e-3)


BLOCK = """
format = 1
bodies.block.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }
supports = { base.face = "block.w0", top = { face = "block.w1", force = { FORCE } } }
stages = [{ name = "rest", steps = 1 }, { name = "go", steps = 1, motions.top.translate = WAY }]
"""
AXES = [axes for count in range(1, 4) for axes in combinations("xyz", count)]


@pytest.mark.parametrize("pressed", AXES)
def test_motions_are_refused_along_what_a_force_does_and_nothing_else_is_named(pressed: tuple[str, ...]) -> None:
    for moved in AXES:
        force = ", ".join(f"{axis} = -0.1" for axis in pressed)
        text = BLOCK.replace("FORCE", force).replace("WAY", str([0.1 * (axis in moved) for axis in "xyz"]))
        both = ", ".join(axis for axis in "xyz" if axis in moved and axis in pressed)
        if not both:
            assert Scene.from_toml(text).problem().supports[1].name == "top"
            continue
        with pytest.raises(InputError, match=f"moves support 'top' along {both}, where supports.top.force does") as refused:
            Scene.from_toml(text).problem()
        assert refused.value.field == "stages.go.motions.top.translate"
