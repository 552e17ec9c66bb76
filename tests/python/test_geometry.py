"""Primitives are exact, k-refinement leaves them unchanged, Lagrange nodes lie on them, files bring them back."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import splinepy
from hypothesis import given, settings
from hypothesis import strategies as st

from isomortar.errors import InputError
from isomortar.geometry.files import read_spline
from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.geometry.primitives import bowl, box, cap, ring, sphere, torus, wedge
from isomortar.geometry.quadrature import contact_points, volume_points
from isomortar.geometry.refinement import cut, mesh
from isomortar.scene.geometry_file import read_geometry, write_geometry

BOX = box((-1.0, 0.5, 2.0), (3.0, 1.0, 2.25))
BOWL = bowl((0.6, -0.2), 0.375, 0.04, 0.25, 0.79)
RING = ring((0.1, 0.2, 0.5), 0.25, 0.5, 0.3)
PRIMITIVES = {
    "box": BOX,
    "bowl": BOWL,
    "cap": cap((0.6, -0.2), 1.5, 0.9, 0.04, 2.0),
    "wedge": wedge((-1.0, 1.0), (0.2, 0.2), (0.0, 2.0), (0.5, 1.5)),
    "ring": RING,
    "half-pipe": ring((0.1, 0.2, 0.5), 0.25, 0.5, 0.3, (-100.0, 80.0), "x"),
    "cylinder": ring((0.1, 0.2, 0.5), 0.0, 0.5, 0.3, (20.0, 220.0), "z"),
    "octant": sphere((0.0, 0.0, 1.0), 0.0, 1.0, (0.0, 90.0), (0.0, 90.0)),
    "hemisphere": sphere((0.3, 0.0, 1.0), 0.6, 1.0, (-90.0, 90.0), (-180.0, 0.0), "x"),
    "torus": torus((0.3, 0.1, 0.2), 2.0, 0.1, 0.5, (-170.0, 20.0), (10.0, 300.0), "y"),
}


def as_spline(patch: Patch) -> splinepy.NURBS:
    return splinepy.NURBS([d.order for d in patch.directions], [d.knots for d in patch.directions], patch.control_points, patch.weights)


def evaluate(patch: Patch, count: int = 9) -> FloatArray:
    """Points at a grid of parameters that hits no knot but the ends."""
    axes = [np.append(d.boundaries[0], np.sort(np.random.default_rng(7).uniform(*d.boundaries[[0, -1]], count))) for d in patch.directions]
    return as_spline(patch).evaluate(np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3))


def volume(patch: Patch) -> float:
    """By 12 Gauss points an element and direction, with the Jacobian of splinepy."""
    points, weights = np.polynomial.legendre.leggauss(12)
    places, factors = [], []
    for direction in patch.directions:
        half = np.diff(direction.boundaries) / 2
        places.append(((direction.boundaries[:-1] + half)[:, None] + half[:, None] * points).ravel())
        factors.append((half[:, None] * weights).ravel())
    queries = np.stack(np.meshgrid(*places, indexing="ij"), axis=-1).reshape(-1, 3)
    determinants = np.linalg.det(as_spline(patch).jacobian(queries))
    assert determinants.min() > 0, "patches are right-handed"
    return float(determinants @ np.einsum("i,j,k->ijk", *factors).ravel())


def test_box_fills_its_corners() -> None:
    assert volume(BOX) == pytest.approx(4.0 * 0.5 * 0.25, rel=1e-14)
    assert np.array_equal([BOX.control_points.min(axis=0), BOX.control_points.max(axis=0)], [[-1.0, 0.5, 2.0], [3.0, 1.0, 2.25]])


def test_bowl_has_a_paraboloid_below_and_a_flat_top() -> None:
    spline = as_spline(BOWL)
    u, v = np.meshgrid(np.linspace(0, 1, 7), np.linspace(0, 1, 7))
    below = spline.evaluate(np.stack([u, v, 0 * u], axis=-1).reshape(-1, 3))
    expected = 0.04 + 0.25 * ((below[:, 0] - 0.6) ** 2 + (below[:, 1] + 0.2) ** 2) / 0.375**2
    np.testing.assert_allclose(below[:, 2], expected, rtol=0, atol=1e-15)
    assert np.ptp(below[:, :2], axis=0) == pytest.approx([0.75, 0.75], rel=1e-15)
    above = spline.evaluate(np.stack([u, v, 0 * u + 1], axis=-1).reshape(-1, 3))
    np.testing.assert_allclose(above[:, 2], 0.79, rtol=1e-15)


def test_ring_is_exactly_round() -> None:
    assert volume(RING) == pytest.approx(np.pi * (0.5**2 - 0.25**2) * 0.3, rel=1e-13)
    angles = np.linspace(0, 4, 41)
    for v, radius in ((0.0, 0.25), (1.0, 0.5)):
        points = as_spline(RING).evaluate([[angle, v, 0.3] for angle in angles]) - [0.1, 0.2, 0.5]
        np.testing.assert_allclose(np.hypot(points[:, 0], points[:, 2]), radius, rtol=1e-15 * 4)
    quarters = as_spline(RING).evaluate([[joint, 1.0, 0.5] for joint in range(5)]) - [0.1, 0.2, 0.5]
    np.testing.assert_allclose(quarters, np.array([[0, 0, 1], [1, 0, 0], [0, 0, -1], [-1, 0, 0], [0, 0, 1]]) * 0.5, atol=1e-16 * 4)


def test_a_cap_has_a_sphere_below_and_a_flat_top() -> None:
    spline = as_spline(PRIMITIVES["cap"])
    u, v = np.meshgrid(np.linspace(0, 1, 7), np.linspace(0, 1, 7))
    below, above = (spline.evaluate(np.stack([u, v, 0 * u + w], axis=-1).reshape(-1, 3)) - [0.6, -0.2, 1.54] for w in (0.0, 1.0))
    np.testing.assert_allclose(np.linalg.norm(below, axis=1), 1.5, rtol=1e-15 * 8)
    np.testing.assert_allclose(above, np.column_stack([below[:, :2], np.full(49, 0.46)]), rtol=0, atol=1e-15 * 4)
    middles = spline.evaluate([[0.0, 0.5, 0.0], [1.0, 0.5, 0.0], [0.5, 0.0, 0.0], [0.5, 1.0, 0.0]]) - [0.6, -0.2, 0.0]
    np.testing.assert_allclose(middles[:, :2], [[-0.9, 0.0], [0.9, 0.0], [0.0, -0.9], [0.0, 0.9]], atol=1e-15 * 4)
    with pytest.raises(InputError, match=r"below 0\.943 radius"):
        cap((0.0, 0.0), 1.0, 0.95, 0.0, 3.0)


def test_a_wedge_has_slopes_and_an_edge() -> None:
    patch = PRIMITIVES["wedge"]
    assert volume(patch) == pytest.approx(0.5 * 2.0 * 2.0 * 1.0, rel=1e-14)
    edge = patch.control_points[patch.face_points("w1")]
    np.testing.assert_array_equal(edge, [[0.2, 0.0, 1.5], [0.2, 0.0, 1.5], [0.2, 2.0, 1.5], [0.2, 2.0, 1.5]])


@pytest.mark.parametrize("axis", ["x", "y", "z"])
@pytest.mark.parametrize("angles", [(0.0, 90.0), (-30.0, 60.0), (-180.0, 0.0), (17.0, 150.0), (90.0, 271.0), (-200.0, 160.0)])
def test_bodies_turned_about_an_axis_go_round_it_by_the_right_hand_rule(angles: tuple[float, float], axis: str) -> None:
    up = "xyz".index(axis)
    centre = np.array([0.1, 0.2, 0.3])
    patch = sphere((0.1, 0.2, 0.3), 0.4, 0.9, (-50.0, 70.0), angles, axis)  # type: ignore[arg-type]
    part = np.radians(angles[1] - angles[0]) * (np.sin(np.radians(70.0)) + np.sin(np.radians(50.0))) * (0.9**3 - 0.4**3) / 3.0
    assert volume(patch) == pytest.approx(part, rel=1e-13)
    ends = [d.boundaries[[0, -1]] for d in patch.directions]
    grid = np.stack(np.meshgrid(*(np.linspace(*end, 9) for end in ends), indexing="ij"), axis=-1)
    points = np.roll(as_spline(patch).evaluate(grid.reshape(-1, 3)) - centre, 2 - up, axis=1).reshape(9, 9, 9, 3)
    np.testing.assert_allclose(np.linalg.norm(points[:, 0], axis=-1), 0.4, rtol=1e-14)
    np.testing.assert_allclose(np.linalg.norm(points[:, -1], axis=-1), 0.9, rtol=1e-14)
    for end, angle in ((0, angles[0]), (-1, angles[1])):
        across = [-np.sin(np.radians(angle)), np.cos(np.radians(angle)), 0.0]
        np.testing.assert_allclose(points[end] @ across, 0.0, atol=1e-14)
        assert np.all(points[end, :, 4] @ [np.cos(np.radians(angle)), np.sin(np.radians(angle)), 0.0] > 0.0)
    for end, latitude in ((0, 70.0), (-1, -50.0)):
        np.testing.assert_allclose(points[:, -1, end, 2], 0.9 * np.sin(np.radians(latitude)), atol=1e-14)


def test_arcs_up_to_half_a_circle_are_smooth() -> None:
    for name, direction, smooth in (("hemisphere", 0, True), ("hemisphere", 2, True), ("cylinder", 0, False), ("ring", 0, False)):
        assert PRIMITIVES[name].directions[direction].kinks != smooth
    coarse = PRIMITIVES["hemisphere"]
    at = np.array([[1.0 - 1e-9, 1.0, 0.3], [1.0 + 1e-9, 1.0, 0.3]])
    slopes = as_spline(coarse).jacobian(at)[:, :, 0]
    np.testing.assert_allclose(slopes[0], slopes[1], atol=1e-7)


def test_axes_are_hit_exactly() -> None:
    """What lies on planes of symmetry lies there to the last bit: poles are one point, and halves of the same are the same."""
    patch = sphere((0.0, 0.0, 0.0), 0.0, 1.0, (0.0, 90.0), (0.0, 90.0))
    for face, component in (("u0", 1), ("u1", 0), ("w1", 2)):
        assert np.all(patch.control_points[patch.face_points(face), component] == 0.0)
    assert np.ptp(patch.control_points[patch.face_points("v0")], axis=0).max() == 0.0
    again = ring((0.0, 0.0, 0.0), 0.25, 0.5, 1.0, (360.0, 720.0))
    assert np.array_equal(again.control_points, ring((0.0, 0.0, 0.0), 0.25, 0.5, 1.0).control_points)


@pytest.mark.parametrize("ratio", [0.1, 0.5, 1.0, 7.0])
def test_graded_elements_are_a_geometric_progression(ratio: float) -> None:
    lengths = np.diff(cut(BOX.directions[0], 6, ratio))
    np.testing.assert_allclose(lengths[1:] / lengths[:-1], ratio**0.2, rtol=1e-13)
    assert lengths[-1] / lengths[0] == pytest.approx(ratio, rel=1e-13)
    assert cut(BOX.directions[0], 1, ratio).tolist() == [0.0, 1.0]
    spans = np.diff(cut(RING.directions[0], 12, ratio)).reshape(4, 3)  # four knot spans: their knots stay
    np.testing.assert_allclose(spans.sum(axis=1), 1.0, rtol=1e-14)
    np.testing.assert_allclose(spans[:, 1:] / spans[:, :-1], ratio ** (1 / 11), rtol=1e-13)


@settings(max_examples=40, deadline=None)
@given(
    name=st.sampled_from(sorted(PRIMITIVES)),
    raises=st.tuples(*[st.integers(0, 4)] * 3),
    parts=st.tuples(*[st.integers(1, 4)] * 3),
    grading=st.tuples(*[st.floats(0.2, 5.0)] * 3),
)
def test_k_refinement_leaves_the_geometry_unchanged(
    name: str, raises: tuple[int, ...], parts: tuple[int, ...], grading: tuple[float, ...]
) -> None:
    coarse = PRIMITIVES[name]
    orders = [d.order + more for d, more in zip(coarse.directions, raises, strict=True)]
    elements = [d.elements * n for d, n in zip(coarse.directions, parts, strict=True)]
    fine = mesh(coarse, "NNN", orders, elements, grading)
    assert [d.order for d in fine.directions] == orders
    assert [d.elements for d in fine.directions] == elements
    np.testing.assert_allclose(evaluate(fine), evaluate(coarse), rtol=0, atol=1e-13 * np.abs(coarse.control_points).max())


def test_new_knots_are_single_and_joints_keep_their_continuity() -> None:
    fine = mesh(RING, "NNN", (4, 2, 1), (8, 2, 1))
    _, multiplicity = np.unique(fine.directions[0].knots, return_counts=True)
    assert multiplicity.tolist() == [5, 1, 4, 1, 4, 1, 4, 1, 5]  # order elevation before knot insertion: C3 at new knots


def test_lagrange_nodes_are_points_of_the_body_at_equal_parameters() -> None:
    coarse, elements, orders = RING, (8, 2, 1), (3, 2, 1)
    fine = mesh(coarse, "LLL", orders, elements)
    parameters = [
        np.linspace(d.boundaries[0], d.boundaries[-1], n * p + 1) for d, n, p in zip(coarse.directions, elements, orders, strict=True)
    ]
    grid = np.stack(np.meshgrid(*parameters, indexing="ij"), axis=-1).reshape(-1, 3, order="F")
    np.testing.assert_allclose(fine.control_points, as_spline(coarse).evaluate(grid), rtol=0, atol=1e-15)
    assert np.all(fine.weights == 1.0)


@pytest.mark.parametrize("families", ["NLL", "NNL", "LNN", "NLN"])
def test_mixed_families_interpolate_only_where_they_say_lagrange(families: str) -> None:
    """The ring is linear in v and w, so Lagrange there changes nothing; Lagrange along u puts nodes on it."""
    fine = mesh(RING, families, (2, 1, 1), (8, 2, 2))
    reference = mesh(RING, ("L" if families[0] == "L" else "N") + "NN", (2, 1, 1), (8, 2, 2))
    np.testing.assert_allclose(fine.control_points, reference.control_points, rtol=0, atol=1e-15)
    np.testing.assert_allclose(fine.weights, reference.weights, rtol=1e-15)
    assert [d.family for d in fine.directions] == list(families)


@pytest.mark.parametrize(
    ("families", "orders", "elements", "field", "allowed"),
    [
        ("NNN", (1, 1, 1), (4, 1, 1), "order", "2 to 10"),
        ("NNN", (11, 1, 1), (4, 1, 1), "order", "2 to 10"),
        ("NLN", (2, 5, 1), (4, 1, 1), "order", "1 to 4"),
        ("NNN", (2, 1, 1), (6, 1, 1), "elements", "multiples of 4"),
    ],
)
def test_impossible_meshes_are_refused(families: str, orders: tuple[int, ...], elements: tuple[int, ...], field: str, allowed: str) -> None:
    with pytest.raises(InputError, match=allowed) as error:
        mesh(RING, families, orders, elements)
    assert error.value.field == field


@pytest.mark.parametrize("suffix", ["json", "xml", "itd", "mesh"])
def test_files_of_splinepy_bring_the_volume_back(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"ring.{suffix}"
    spline = as_spline(RING)
    splinepy.io.export(str(path), spline if suffix == "mesh" else [spline])
    patch = read_spline(path)
    places = 1e-9 if suffix == "mesh" else 1e-14  # MFEM's writer keeps ten digits
    np.testing.assert_allclose(evaluate(patch), evaluate(RING), rtol=0, atol=places)


def test_geometry_file_keeps_every_bit(tmp_path: Path) -> None:
    random = np.random.default_rng(3)
    u, v = Direction("N", 2, np.array([0, 0, 0, 1 / 3, 1, 1, 1])), Direction("L", 3, np.array([0.0, 0.1, 1.0]))
    patch = Patch((u, v, Direction("L", 1, np.array([-1.0, 2.0]))), random.normal(size=(56, 3)) * 1e-7, random.uniform(1e-3, 1e3, 56))
    write_geometry(tmp_path / "odd.toml", patch)
    again = read_geometry(tmp_path / "odd.toml")
    assert np.array_equal(again.control_points, patch.control_points)
    assert np.array_equal(again.weights, patch.weights)
    for one, other in zip(again.directions, patch.directions, strict=True):
        assert (one.family, one.order, one.knots.tolist()) == (other.family, other.order, other.knots.tolist())


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("a.step", "", r"\.json, \.xml"),
        ("none.json", None, "there is no file"),
        ("broken.json", "{", "splinepy cannot read broken.json"),
        ("broken.xml", "<xml", "splinepy cannot read broken.xml"),
    ],
)
def test_unreadable_geometry_files(tmp_path: Path, name: str, content: str | None, said: str) -> None:
    if content is not None:
        (tmp_path / name).write_text(content)
    with pytest.raises(InputError, match=said):
        read_spline(tmp_path / name)


def test_surfaces_are_no_bodies(tmp_path: Path) -> None:
    surface = splinepy.BSpline([1, 1], [[0, 0, 1, 1]] * 2, [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]])
    splinepy.io.export(str(tmp_path / "surface.json"), [surface])
    with pytest.raises(InputError, match="1 splines, 0 of them volumes; allowed: one volume"):
        read_spline(tmp_path / "surface.json")


def test_default_gauss_points_are_those_of_table_1() -> None:
    table = {
        "N": ((2, 4), (4, 6), (6, 6), (6, 6), (7, 7), (8, 8), (9, 9)),
        "L": ((2, 4), (4, 4), (4, 9), (6, 12)),
    }
    for family, row in table.items():
        for order, (volume_count, contact_count) in enumerate(row, start=1):
            knots = np.repeat([0.0, 1.0], order + 1) if family == "N" else np.array([0.0, 1.0])
            direction = Direction(family, order, knots)
            assert (volume_points(direction), contact_points(direction)) == (volume_count, contact_count)


@pytest.mark.parametrize(("family", "highest"), [("N", 10), ("L", 4)])
def test_orders_that_there_are(family: str, highest: int) -> None:
    for order in (-1, 0, highest + 1):
        with pytest.raises(InputError, match=f"order is {order}; allowed for {family}: 1 to {highest}"):
            Direction(family, order, np.repeat([0.0, 1.0], max(order, 0) + 1) if family == "N" else np.array([0.0, 1.0]))


@pytest.mark.parametrize("boundaries", [[], [0.0], [0.0, 0.0], [0.0, 1.0, 0.5], [0.0, float("nan")]])
def test_elements_of_a_lagrange_direction_need_two_ends_in_order(boundaries: list[float]) -> None:
    with pytest.raises(InputError, match=r"knots: (element boundaries|must be one list of finite numbers)"):
        Direction("L", 2, np.array(boundaries))
