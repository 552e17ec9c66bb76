"""Scenes that are their own mirror images: a half or a quarter is computed, and forces are the whole's."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from told.wrong.halves import BESIDE, PLANE, PUSH, REFUSED, TURN

from isomortar.errors import InputError
from isomortar.geometry.halves import upper_half
from isomortar.geometry.patch import Direction, Patch
from isomortar.geometry.primitives import bowl, box, ring
from isomortar.geometry.refinement import mesh
from isomortar.geometry.splines import Spline
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Face
from isomortar.model.origin import about
from isomortar.model.symmetry import _faces_in_use
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.record import StepResult
from isomortar.solve.timing import Ledger


def at(patch: Patch, parameters: np.ndarray) -> np.ndarray:
    return Spline(patch.directions, patch.control_points, patch.weights).evaluate(parameters)


def run(text: str, *overrides: str) -> list[StepResult]:
    return list(Simulation(Scene.from_toml(text, overrides=overrides).problem()).run())


SHAPES = {
    "box": (box((0.0, 1.0, 0.0), (1.0, 4.0, 1.0)), 1, 2.5, (3, 2, 1), (2, 4, 1)),
    "bowl": (bowl((0.5, -1.0), 0.4, 0.0, 0.2, 0.7), 0, 0.5, (2, 3, 2), (6, 3, 2)),
    "ring": (ring((0.0, 0.0, 0.0), 1.0, 2.0, 0.8), 1, None, (2, 2, 4), (4, 2, 2)),
}


@pytest.mark.parametrize("shape", list(SHAPES))
def test_a_half_is_the_same_geometry(shape: str) -> None:
    coarse, axis, place, orders, elements = SHAPES[shape]
    whole = mesh(coarse, ("N",) * 3, orders, elements)
    if place is None:
        place = float(whole.control_points[:, axis].mean())
    half, face = upper_half(whole, axis, place)
    across = "uvw".index(face[0])
    assert half.directions[across].elements == elements[across] // 2
    assert np.all(half.control_points[half.face_points(face), axis] == place)
    ends = half.directions[across].knots[[0, -1]]
    parameters = np.random.default_rng(2).uniform(size=(50, 3))
    for k, direction in enumerate(whole.directions):
        low, high = ends if k == across else direction.knots[[0, -1]]
        parameters[:, k] = low + (high - low) * parameters[:, k]
    points = at(half, parameters)
    np.testing.assert_allclose(points, at(whole, parameters), rtol=0.0, atol=1e-14)
    assert points[:, axis].min() >= place


def test_weights_of_one_stay_exactly_one() -> None:
    half, _ = upper_half(mesh(box((0.0,) * 3, (1.0,) * 3), ("N",) * 3, (3, 3, 3), (6, 2, 2)), 0, 0.5)
    assert np.all(half.weights == 1.0)


def test_a_direction_that_runs_the_other_way_keeps_its_lower_half() -> None:
    one = Direction("N", 1, np.array([0.0, 0.0, 1.0, 2.0, 2.0]))
    two = Direction("N", 1, np.array([0.0, 0.0, 1.0, 1.0]))
    grid = np.stack(np.meshgrid([1.0, 0.0, -1.0], [0.0, 1.0], [0.0, 1.0], indexing="ij"), axis=-1)
    half, face = upper_half(Patch((one, two, two), grid.reshape(-1, 3, order="F"), np.ones(12)), 0, 0.0)
    assert face == "u1"
    assert set(half.control_points[:, 0]) == {0.0, 1.0}


@pytest.mark.parametrize("family", ["N", "L"])
@pytest.mark.parametrize("planes", ["x = 0.0", "y = 2.4", "x = 0.0, y = 2.4"])
def test_forces_and_moments_are_those_of_the_whole(family: str, planes: str) -> None:
    """To round-off where functions have a kink at the plane in the whole too: Lagrange's, or NURBS of order one."""
    text = PLANE + (PUSH if planes == "y = 2.4" else "")
    mesh_ = ["bodies.block.mesh.family='N'", "bodies.block.mesh.order=1"] if family == "N" else []
    whole, part = run(text, *mesh_), run(text, *mesh_, f"symmetry={{ {planes} }}")
    for expected, found in zip(whole, part, strict=True):
        size = np.linalg.norm(expected.reactions[0].force)
        np.testing.assert_allclose(found.reactions[0].force, expected.reactions[0].force, rtol=0.0, atol=1e-9 * size)
        np.testing.assert_allclose(found.reactions[0].moment, expected.reactions[0].moment, rtol=0.0, atol=1e-9 * size)
        mine, theirs = found.contacts[0], expected.contacts[0]
        for name in ("force_slave", "force_master", "moment_slave", "moment_master", "friction_work"):
            np.testing.assert_allclose(getattr(mine, name), getattr(theirs, name), rtol=0.0, atol=1e-8 * size, err_msg=name)
        for held in found.reactions[1:]:
            np.testing.assert_array_equal(held.force, 0.0)  # what halves exert on each other is no support's
            np.testing.assert_array_equal(held.moment, 0.0)


def test_a_turn_about_the_normal_of_the_plane_is_symmetric() -> None:
    text = PLANE.replace("centre", "axis = [0, 2, 0]\ncentre") + TURN
    bounded = ["stages.turn.motions.top.rotate=4.0", "contacts.floor.friction=0.0"]
    whole, part = run(text, *bounded), run(text, *bounded, "symmetry={ y = 2.4 }")
    np.testing.assert_allclose(part[-1].reactions[0].moment, whole[-1].reactions[0].moment, rtol=0.0, atol=1e-9)
    assert abs(whole[-1].reactions[0].moment[1]) > 1e-3


def test_smooth_functions_have_a_kink_at_the_plane_alone() -> None:
    """The half is as near to the truth as the whole: they differ by what the mesh leaves open."""
    rough = ["bodies.block.mesh.family='N'", "bodies.block.mesh.order=2"]
    whole, part = run(PLANE, *rough), run(PLANE, *rough, "symmetry={ x = 0.0 }")
    apart = part[-1].reactions[0].force[2] / whole[-1].reactions[0].force[2] - 1.0
    assert 0.0 < abs(apart) < 5e-3


@pytest.mark.parametrize("name", list(REFUSED))
def test_what_is_not_symmetric_is_refused(name: str) -> None:
    text, planes, field, words = REFUSED[name]
    with pytest.raises(InputError) as refused:
        Scene.from_toml(text, overrides=[f"symmetry={{ {planes} }}"]).problem()
    assert (refused.value.field or "").startswith(field)
    assert words in str(refused.value)


def test_a_closed_direction_and_a_row_of_another_order_are_not_cut() -> None:
    tyre = PLANE.replace(
        'kind = "box", lower = [-0.5, 2.0, 0.0], upper = [0.5, 2.8, 0.5]', 'kind = "ring", inner = 1.0, outer = 2.0, width = 1.0'
    )
    tyre = tyre.replace('family = "L", order = [2, 2, 1], elements = [4, 4, 2]', "elements = [8, 1, 2]")
    tyre = tyre.replace('"block.w0"', '"block.v1"').replace('face = "block.w1"', 'face = "block.v0"')
    with pytest.raises(InputError, match=r"bodies.block: is closed in u, the direction that the plane x = 0 halves"):
        Scene.from_toml(tyre, overrides=["symmetry={ x = 0.0 }", "contacts.floor.plane.point=[0,0,-2]"]).problem()
    raised = ["bodies.block.mesh={ order = 2, contact_order = 3, elements = [4, 4, 2] }", "symmetry={ x = 0.0 }"]
    with pytest.raises(InputError, match=r"bodies.block.mesh.contact_order: is halved by symmetry"):
        Scene.from_toml(PLANE, overrides=raised).problem()


def test_results_keep_it(tmp_path: Path) -> None:
    import isomortar

    scene = Scene.from_toml(PLANE, overrides=["symmetry={ x = 0.0, y = 2.4 }"])
    with isomortar.run(scene, tmp_path / "quarter.h5") as results:
        force = results.curve("force", support="top", component="z")
        assert results.problem.symmetry == scene.problem().symmetry
    isomortar.run(scene, tmp_path / "quarter.h5", resume=True).close()  # it is the same scene, and whole
    np.testing.assert_allclose(force, [step.reactions[0].force[2] for step in run(PLANE)], rtol=1e-9)


def test_a_body_that_symmetry_alone_holds_is_free() -> None:
    text = PLANE.replace("[contacts.floor]", BESIDE + "[contacts.floor]").replace("plane = {}", 'master = "lower.w1"')
    for planes in ("{}", "{ x = 0.0 }"):
        with pytest.raises(InputError, match="'lower' is free: it has no support"):
            Scene.from_toml(text, overrides=[f"symmetry={planes}"]).problem()


ABOVE_ANOTHER = PLANE.replace("plane = {}", 'master = "lower.w1"\nprojection = "averaged"') + BESIDE
UNDER = '[supports.under]\nface = "lower.w0"\n'
ASIDE = '[supports.side]\nface = "lower.u1"\ncomponents = ["x"]\n'


@pytest.mark.parametrize(
    ("more", "overrides", "mirror"),
    [
        (UNDER, [], [[0, 0], [0, 0]]),
        (UNDER, ["symmetry={x=0.0}"], [[1, 0], [0, 0]]),
        (UNDER, ["symmetry={x=0.0, y=2.4}"], [[1, 0], [2, 0]]),
        ("", ["symmetry={y=2.4}", "bodies.lower.rigid=true"], [[0, 0], [2, 0]]),
        (UNDER + ASIDE, [], [[0, 0], [0, 0]]),  # beyond is another body, or nothing
    ],
)
@pytest.mark.parametrize("far", [0.0, 64.0])
def test_masters_know_the_edges_that_have_mirror_images(more: str, overrides: list[str], mirror: list[list[int]], far: float) -> None:
    problem = Scene.from_toml(ABOVE_ANOTHER + more, overrides=overrides).problem()
    problem = about(problem, np.array([0.0, -far, 0.0]))
    equilibrium = Equilibrium(problem, Ledger())
    assert np.any(equilibrium.origin) == (far > 0.0)
    assert equilibrium.pairs[0].pair.master.mirror.tolist() == mirror


BOWL = """
format = 1
[bodies.bowl]
geometry = { kind = "bowl", half_width = 0.4, bottom = 0.0, rise = 0.1, top = 0.5 }
mesh = { order = [2, 2, 1], elements = [4, 4, 1] }
[bodies.base]
geometry = { kind = "box", lower = [-0.8, -0.6, -0.5], upper = [0.8, 0.6, 0.0] }
mesh = { order = [2, 2, 1], elements = [3, 4, 1] }
[contacts.between]
slave = "bowl.w0"
master = "base.w1"
friction = 0.3
[supports]
top.face = "bowl.w1"
under.face = "base.w0"
[[stages]]
name = "press"
steps = 1
motions.top.translate = [0, 0, -0.06]
"""


@pytest.mark.parametrize(("slip_sum", "projection"), [("local", "closest"), ("paper", "closest"), ("local", "averaged")])
def test_tangents_are_exact_beside_the_plane(slip_sum: str, projection: str) -> None:
    """Tractions of a half, by central differences along a random direction that leaves the plane where it is."""
    overrides = ["symmetry={y=0.0}", f'solver.slip_sum="{slip_sum}"', f'contacts.between.projection="{projection}"']
    equilibrium = Equilibrium(Scene.from_toml(BOWL, overrides=overrides).problem(), Ledger())
    state, (pair,) = equilibrium.initial_state(), equilibrium.pairs
    equilibrium.begin(state, 0.5)
    random = np.random.default_rng(3)
    positions, direction = state.positions.copy(), random.standard_normal(state.positions.shape)
    moved = equilibrium.numbering.points["bowl"]
    positions[moved] += [0.02, 0.0, -0.06]
    positions[:, [0, 2]] += 0.003 * random.standard_normal((len(positions), 2))
    direction[equilibrium.numbering.reference[:, 1] == 0.0, 1] = 0.0
    n = pair.pair.slave.test.count
    law = pair.law(np.array([20.0, 0.1]), np.zeros(n), np.zeros((n, 2)))  # all that is active sticks

    def tractions(length: float) -> np.ndarray:
        return pair.respond(pair.kinematics(positions + length * direction, state.contacts[0]), law).traction

    kinematics = pair.kinematics(positions, state.contacts[0])
    response = pair.respond(kinematics, law)
    blocks = pair.blocks(positions, kinematics, law, response)
    wide = blocks.patterns.wide
    row = np.repeat(np.arange(n), np.diff(wide.start))
    changes = np.zeros((n, 2))
    np.add.at(changes, row, np.einsum("kac,kc->ka", blocks.changes[:, 1:], direction[wide.column]))
    at_plane = np.any(pair.held.free != np.eye(2), axis=(1, 2)) & (response.state > 0)
    assert at_plane.any()
    expected = (tractions(1e-6) - tractions(-1e-6)) / 2e-6
    np.testing.assert_allclose(changes, expected, rtol=0, atol=1e-7 * np.abs(expected).max())
    assert np.abs(expected[at_plane]).max() > 0.01 * np.abs(expected).max()


def test_faces_in_use_are_named_by_their_keys() -> None:
    """Of slaves, masters, supports and glue."""
    problem = replace(Scene.from_toml(ABOVE_ANOTHER + UNDER).problem(), glue=((Face("block", "u1"), Face("lower", "u0")),))
    keys = [(key, face.words) for key, face in _faces_in_use(problem)]
    supports = [("supports.top.face", "block.w1"), ("supports.under.face", "lower.w0")]
    contact = [("contacts.floor.slave", "block.w0"), ("contacts.floor.master", "lower.w1")]
    assert keys == [*supports, *contact, ("glue.0", "block.u1"), ("glue.0", "lower.u0")]
