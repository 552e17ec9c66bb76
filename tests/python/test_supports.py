"""Supports: turns against SciPy's rotations, what they have moved, and what they hold of a contact face."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from isomortar.errors import InputError
from isomortar.model.entities import Motion, Problem, RigidPlane, unit
from isomortar.model.held import Held, held_by
from isomortar.model.numbering import Numbering
from isomortar.model.pairs import Pair
from isomortar.model.plates import rotation
from isomortar.model.supports import Supports
from isomortar.scene import Scene

coordinates = st.floats(-1.0, 1.0)


@given(st.tuples(coordinates, coordinates, coordinates).filter(lambda v: np.linalg.norm(v) > 1e-3), st.floats(-20.0, 20.0))
@example((-0.97, 0.59, -0.1), 20.0)
def test_turn_is_that_of_scipy(axis, angle):
    """SciPy is given the angle as the length of a vector, which rounds it: its last digits grow with it, ours do not."""
    expected = Rotation.from_rotvec(angle * unit(axis)).as_matrix()
    length = 2.5 * abs(angle)  # half a unit in the last place for the products, one each for the axis's length and for the vector's
    np.testing.assert_allclose(rotation(unit(axis), angle), expected, rtol=0.0, atol=(8.0 + length) * np.finfo(float).eps)


def test_small_turns_keep_their_digits():
    # about a skew axis the product of its components comes with 1 - cos, 5e-19 here, of which a difference from one keeps nothing
    turned = rotation(unit((1.0, 1.0, 0.0)), 1e-9)
    np.testing.assert_allclose(turned[0, 1], 0.25e-18, rtol=1e-12)


def test_a_support_is_on_a_face_an_edge_or_a_corner() -> None:
    """Whichever face is named first; of a rigid body it carries the whole."""
    block = """
format = 1
bodies.block = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh = { order = 2, elements = [2, 3, 1] } }
supports.foot.face = "block.w0"
supports.side.PLACE
stages = [{ name = "one", steps = 1 }]
"""
    for place, where in {
        'face = "block.u1"': (1.0, None, None),
        'edge = "block.u1.w1"': (1.0, None, 1.0),
        'edge = "block.v0.u1"': (1.0, 0.0, None),
        'corner = "block.w1.u0.v1"': (0.0, 1.0, 1.0),
    }.items():
        problem = Scene.from_toml(block.replace("PLACE", place)).problem()
        numbering = Numbering(problem)
        there = [numbering.reference[:, k] == x for k, x in enumerate(where) if x is not None]
        assert np.array_equal(Supports(problem, numbering).points[1], np.flatnonzero(np.all(there, axis=0)))
        assert problem.supports[1].place.words == place.split('"')[1]
    rigid = Scene.from_toml(
        block.replace('supports.foot.face = "block.w0"\n', "").replace("PLACE", place), overrides=["bodies.block.rigid=true"]
    )
    assert len(Supports(rigid.problem(), Numbering(rigid.problem())).points[0]) == len(numbering.reference)


def test_an_edge_beside_a_plane_of_symmetry_is_refused() -> None:
    text = CUBE.replace('side.face = "cube.u0"', 'side = { edge = "cube.v0.w1", components = ["z"] }').replace(
        "order = [1, 1, 1]", "elements = 2"
    )
    assert len(Scene.from_toml(text, overrides=["symmetry={ x = 0.5 }"]).problem().supports) == 3
    with pytest.raises(InputError, match=r"supports\.side\.edge: is 'cube\.v0', a face beside the plane y = 0\.5"):
        Scene.from_toml(text, overrides=["symmetry={ y = 0.5 }"]).problem()


#: A cube of eight control points; "side" holds four of them, two of these on the contact face.
CUBE = """
format = 1
bodies.cube = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh = { order = [1, 1, 1] } }
contacts.base = { slave = "cube.w0", plane = { point = [0, 0, 0] }, friction = 0.5 }
supports.top.face = "cube.w1"
supports.side.face = "cube.u0"
stages = [{ name = "one", steps = 2 }, { name = "two", steps = 3 }]
"""


def cube(components: tuple[int, ...], *motions: Motion) -> Problem:
    """The cube whose side is held in some components, and moved."""
    problem = Scene.from_toml(CUBE).problem()
    sides = [replace(s, components=components, motions=motions or s.motions) for s in problem.supports if s.name == "side"]
    return replace(problem, supports=tuple(sides))


def held(problem: Problem, time: float) -> tuple[Held, np.ndarray]:
    """What the side holds of the contact face, and which of its control points the side has."""
    numbering = Numbering(problem)
    supports, pair = Supports(problem, numbering), Pair(problem.contacts[0], problem, numbering)
    return held_by(supports, pair, numbering.reference, time), np.isin(pair.slave.point, supports.points[0])


@given(
    st.tuples(coordinates, coordinates, coordinates).filter(lambda v: np.linalg.norm(v) > 1e-2),
    st.sets(st.sampled_from((0, 1, 2)), min_size=1),
    st.sampled_from((0.0, 1.0)),
)
def test_what_is_left_of_the_multipliers_moves_what_is_free(normal, components, axis_parallel):
    # the forces that the multipliers of a point exert on its free components: none may vanish, and as many are left as there are components
    normal = np.eye(3)[np.argmax(np.abs(normal))] if axis_parallel else unit(normal)
    tangent = unit(tuple(np.cross(normal, [0.36, -0.48, 0.8])))
    problem = cube(tuple(sorted(components)))
    plane = RigidPlane((0.0, 0.0, 0.0), tuple(normal), tuple(tangent))
    problem = replace(problem, contacts=(replace(problem.contacts[0], master=plane),))
    found, on_side = held(problem, 1.0)
    free = [c for c in range(3) if c not in components]
    across = np.column_stack([tangent, np.cross(normal, tangent)])
    for bears, kept, mine in zip(found.bears, found.free, on_side, strict=True):
        forces = np.column_stack([normal, across @ kept]) * bears
        np.testing.assert_allclose(kept @ kept, kept, atol=1e-12)
        if not mine:
            assert np.linalg.matrix_rank(forces, tol=1e-9) == 3
        elif bears:
            assert np.linalg.matrix_rank(forces, tol=1e-9) == len(free) == np.linalg.matrix_rank(forces[free], tol=1e-9)
        else:
            assert np.linalg.norm(normal[free]) < 1e-5


@pytest.mark.parametrize(("motion", "components"), [(Motion((0.1, 0.0, 0.0)), {0}), (Motion(rotate=3.0), {0, 1}), (Motion(), set())])
def test_a_component_has_moved_once_its_stage_has_begun(motion, components):
    problem = cube((0, 1, 2), Motion(), motion)
    supports = Supports(problem, Numbering(problem))
    assert not supports.moved(2.0).any()
    moved = supports.moved(2.5)
    assert set(np.flatnonzero(moved.any(axis=0))) == components
    assert np.count_nonzero(moved) == 4 * len(components)


def test_a_side_that_pushes_along_the_plane_leaves_friction():
    still, on_side = held(cube((0,), Motion(), Motion((0.3, 0.0, 0.0))), 2.0)
    np.testing.assert_array_equal(still.free[on_side], np.tile(np.diag([0.0, 1.0]), (2, 1, 1)))
    np.testing.assert_array_equal(still.pushed, 0.0)
    pushing, _ = held(cube((0,), Motion(), Motion((0.3, 0.0, 0.0))), 3.0)
    np.testing.assert_array_equal(pushing.free, np.tile(np.eye(2), (4, 1, 1)))
    np.testing.assert_array_equal(pushing.pushed[on_side], [[1.0, 0.0], [1.0, 0.0]])


@pytest.mark.parametrize(
    ("motion", "moves"),
    [(Motion(), False), (Motion((0.0, 0.0, -0.1)), True), (Motion(rotate=30.0), True), (Motion((0.1, 0.0, 0.0), -30.0), True)],
)
def test_a_motion_is_a_translation_or_a_turn(motion: Motion, moves: bool) -> None:
    assert motion.moves is moves
