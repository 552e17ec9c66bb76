"""Figures: all are drawn; what lies in front hides what lies behind; the map puts control points where they belong."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, QuadMesh
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

from isomortar.driver import run
from isomortar.errors import InputError, ResultsError
from isomortar.geometry.patch import FACES, Direction
from isomortar.model.entities import Problem
from isomortar.model.numbering import Numbering
from isomortar.results import Results, ResultsWriter, bodies, maps, style
from isomortar.results.bodies import draw_bodies
from isomortar.results.coloured import _painted, draw_coloured, stress
from isomortar.results.curves import draw_curve, draw_reactions
from isomortar.results.face_field import face_field
from isomortar.results.fields import body_points, contact_surfaces
from isomortar.results.laid import laid
from isomortar.results.maps import draw_map
from isomortar.results.pictures import plot
from isomortar.results.rendering import Camera, Canvas
from isomortar.results.stress import cauchy_stress, deformation_gradient, von_mises
from isomortar.scene import Scene
from isomortar.scene.schema import CurveTable
from isomortar.solve.record import StepResult
from results_samples import over_master, problem, step_result, without_contact


@dataclass(frozen=True)
class Curve:
    name: str = "drag"
    support: str = "rim"
    quantity: str = "force"
    component: str = "norm"


def quiet(number: int) -> StepResult:
    """A step with little deformation, so that the bodies look like bodies, and with slaves that are all over their masters."""
    made, result = problem(), over_master(step_result(number))
    rest = Numbering(made).reference
    return replace(result, state=replace(result.state, positions=rest + 0.1 * (result.state.positions - rest)))


def mapped(made: Problem, step: StepResult, field: str = "pressure") -> Axes:
    """The map of the first contact."""
    return draw_map(made, step, face_field(made, step, 0, field)).axes[0]


def mesh(axes: Axes) -> QuadMesh:
    """The colours of a map."""
    return next(drawn for drawn in axes.collections if isinstance(drawn, QuadMesh))


@pytest.fixture
def results_path(tmp_path: Path) -> Path:
    path = tmp_path / "run.h5"
    writer = ResultsWriter(path, problem(), "", "0")
    for number in range(1, 6):
        writer.recorded(quiet(number))
    return path


def test_plot_draws_every_support_that_moves_and_every_contact(results_path: Path, tmp_path: Path) -> None:
    paths = plot(results_path, tmp_path / "figures", [Curve()])
    names = {path.name for path in paths}
    assert {"reactions-rim.png", "reactions-rim.pdf", "curve-drag.png", "bodies-tread.png", "pressure-ground.pdf"} <= names
    assert not any("bed" in name for name in names)
    assert all(path.stat().st_size > 5000 for path in paths)


def test_what_is_drawn_may_be_chosen(results_path: Path, tmp_path: Path) -> None:
    """Kinds, types of files, and the load step."""
    names = {path.name for path in plot(results_path, tmp_path / "some", [Curve()], step=3, only=["bodies", "maps"], formats=["svg"])}
    assert names == {"bodies-tread.png", "bodies-ground.png", "pressure-tread.svg", "pressure-ground.svg"}
    assert "load step 3 (press)" in (tmp_path / "some" / "pressure-tread.svg").read_text()
    assert {path.suffix for path in plot(results_path, tmp_path / "curves", only=["curves"])} == {".png", ".pdf"}
    with pytest.raises(InputError, match=r"only: is 'forces'; allowed: curves, bodies, maps"):
        plot(results_path, tmp_path, only=["forces"])
    with pytest.raises(InputError, match=r"format: is 'jpg'; allowed: png, pdf, svg"):
        plot(results_path, tmp_path, formats=["png", "jpg"])
    with pytest.raises(ResultsError, match="load step 9 is not in"):
        plot(results_path, tmp_path, step=9)


def test_one_thing_that_is_drawn_may_stand_without_a_list(results_path: Path, tmp_path: Path) -> None:
    one, same = (
        plot(results_path, tmp_path / name, fields=f, only=o, formats=t)
        for name, f, o, t in [("a", "gap", "maps", "svg"), ("b", ["gap"], ["maps"], ["svg"])]
    )
    assert [path.name for path in one] == [path.name for path in same]
    assert all(path.suffix == ".svg" for path in one)


def test_curves_need_no_state(tmp_path: Path) -> None:
    """They are of all load steps, whichever one bodies and maps would be of, and whatever was kept of it."""
    writer = ResultsWriter(tmp_path / "run.h5", problem(), "", "0", states="last")
    for number in (1, 2):
        writer.recorded(quiet(number))
    (drawn,) = plot(tmp_path / "run.h5", tmp_path, step=1, only=["curves"], formats=["png"])
    assert drawn.name == "reactions-rim.png"
    with pytest.raises(ResultsError, match="kept no state of load step 1"):
        plot(tmp_path / "run.h5", tmp_path, step=1, only=["curves", "maps"])


@pytest.mark.filterwarnings("error")
def test_a_curve_may_have_any_label(results_path: Path, tmp_path: Path) -> None:
    """Files are called after it as far as they can be."""
    labels = ["a/b", "..", "\0", "力", "n" * 300, "push x, [N]"]
    curves = [CurveTable(name=label, support="rim") for label in labels]
    paths = plot(results_path, tmp_path / "drawn", curves, only=["curves"], formats=["png"])
    assert all(path.is_file() and path.parent == tmp_path / "drawn" for path in paths)
    drawn = [path.name for path in paths if path.name.startswith("curve-")]
    assert drawn == ["curve-a_b.png", "curve-...png", "curve-_.png", "curve-力.png", f"curve-{'n' * 94}.png", "curve-push x, _N_.png"]


def test_fields_may_be_chosen(results_path: Path, tmp_path: Path) -> None:
    """Those of contacts are drawn as maps, those of bodies on bodies; what is not there is refused."""
    wanted = {"fields": ["traction", "slip", "gap", "stress", "J", "displacement"], "formats": ["png"]}
    names = {path.name for path in plot(results_path, tmp_path / "all", only=["bodies", "maps"], **wanted)}
    assert names == {
        *(f"{field}-{contact}.png" for field in ("traction", "slip", "gap") for contact in ("tread", "ground")),
        *(f"bodies-{field}.png" for field in ("stress", "J", "displacement")),
    }
    with pytest.raises(InputError, match="field: is 'strain'; allowed: pressure, traction, slip, gap, stress, J, displacement"):
        plot(results_path, tmp_path, fields=["strain"])
    with pytest.raises(ResultsError, match="of which stress or maps could be drawn"):
        plot(results_path, tmp_path, fields=["stress"], only=["maps"])


def test_of_rigid_bodies_alone_curves_are_drawn(tmp_path: Path) -> None:
    """Fields of bodies are those of bodies that deform: colours of none have no range."""
    text = """
format = 1
name = "die"
bodies.die = { rigid = true, geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] } }
supports.die = { face = "die.w0" }
stages = [{ name = "go", steps = 1, motions.die.translate = [0, 0, 0.1] }]
"""
    run(Scene.from_toml(text), tmp_path / "die.h5").close()
    assert [path.name for path in plot(tmp_path / "die.h5", tmp_path, formats=["svg"])] == ["reactions-die.svg"]


def test_slips_of_a_step_whose_beginning_nobody_kept_are_refused(tmp_path: Path) -> None:
    writer = ResultsWriter(tmp_path / "last.h5", problem(), "", "0", states="last")
    for number in (1, 2):
        writer.recorded(quiet(number))
    with pytest.raises(ResultsError, match="slips of load step 2 begin at load step 1, of which no state was kept"):
        plot(tmp_path / "last.h5", tmp_path, fields=["slip"])


def test_without_contact_bodies_are_drawn(tmp_path: Path) -> None:
    alone, step = without_contact(problem(), quiet(1))
    ResultsWriter(tmp_path / "alone.h5", alone, "", "0").recorded(step)
    assert "bodies-stress.png" in {path.name for path in plot(tmp_path / "alone.h5", tmp_path)}


def test_a_ball_whose_middle_is_one_point_is_drawn(tmp_path: Path) -> None:
    text = """format = 1
    bodies.ball.geometry = { kind = "sphere", outer = 1, latitudes = [0, 90], angles = [0, 90] }
    supports.wall.face = "ball.u0"
    loads.own = { body = "ball", weight = [0, 0, -0.1] }
    stages = [{ name = "hang", steps = 1 }]"""
    with run(Scene.from_toml(text), tmp_path / "ball.h5") as results:
        assert results.last_step() is not None
    (path,) = plot(tmp_path / "ball.h5", tmp_path, only=["bodies"])
    assert path.stat().st_size > 5000


@pytest.mark.parametrize("face", FACES)
def test_their_colours_are_those_of_the_stress_there(face: str) -> None:
    """Of each small quadrilateral that in its middle, in the order of the face's own directions."""
    made, step = problem(), quiet(1)
    body = made.body("road")
    points, told = body_points(made, step.state.positions)["road"], []

    class Seen:
        def to_rgba(self, stress: np.ndarray) -> np.ndarray:
            told.append(stress)
            return np.zeros((*stress.shape, 4))

    parts = (2, 3)
    cells, _ = _painted(body, points, stress, Seen(), face, parts)
    first, second = body.patch.face_directions(face)
    assert cells.shape == (parts[1] * second.elements, parts[0] * first.elements, 3)
    for row, column in ((0, 0), (1, -1), (-1, 1)):
        places = {"uvw".index(face[0]): body.patch.directions["uvw".index(face[0])].boundaries[-int(face[1])]}
        for direction, count, number in ((first, parts[0], column), (second, parts[1], row)):
            edges = np.concatenate([np.linspace(*ends, count, endpoint=False) for ends in pairwise(direction.boundaries)])
            half = np.diff(direction.boundaries).repeat(count) / count / 2
            places[next(i for i, d in enumerate(body.patch.directions) if d is direction)] = (edges + half)[number]
        deformation = deformation_gradient(body, points, [np.array([places[i]]) for i in range(3)])
        assert told[0][row, column] == pytest.approx(von_mises(cauchy_stress(body.material, deformation))[0], rel=1e-4)


def test_where_nothing_presses_the_material_is_bare() -> None:
    """On the map and on the body: nothing of the colours of pressures where there is none, and all of them where there is some."""
    made, step = problem(), quiet(3)
    contact = step.state.contacts[0]
    open_face = replace(contact, pressure=np.zeros_like(contact.pressure))
    without = replace(step, state=replace(step.state, contacts=(open_face, step.state.contacts[1])))
    bare = np.array(to_rgb(style.SLAVE))
    drawn = mesh(mapped(made, without))
    assert drawn.get_array().mask.all()
    assert drawn.cmap.get_bad()[:3] == pytest.approx(bare)
    pressed = mesh(mapped(made, step)).get_array()
    assert np.ma.getmaskarray(pressed).sum() == (np.abs(pressed.data) < 2e-3 * pressed.data.max()).sum() < pressed.size


def test_nothing_to_draw_is_told(tmp_path: Path) -> None:
    ResultsWriter(tmp_path / "run.h5", problem(), "", "0")
    with pytest.raises(ResultsError, match="no load step"):
        plot(tmp_path / "run.h5", tmp_path)


def test_curves_show_the_recorded_numbers(results_path: Path) -> None:
    with Results(results_path) as results:
        force, moment = draw_reactions(results, "rim").axes
        assert np.array_equal(force.lines[2].get_xdata(), [0, *results.curve("time")])
        assert np.array_equal(force.lines[2].get_ydata(), [0, *results.curve("force", support="rim", component="z")])
        assert np.array_equal(moment.lines[0].get_ydata(), [0, *results.curve("moment", support="rim", component="x")])
        norm = [0, *np.linalg.norm(results.curve("force", support="rim"), axis=1)]
        assert draw_curve(results, Curve()).axes[0].lines[0].get_ydata() == pytest.approx(norm)
        shown = draw_curve(results, Curve(quantity="moment", component="y")).axes[0].lines[0].get_ydata()
        assert np.array_equal(shown, [0, *results.curve("moment", support="rim", component="y")])


def test_the_map_shows_each_state_at_its_control_points() -> None:
    made = problem()
    step = step_result(1)
    status = np.zeros(16, np.int32)
    status[[5, 6]] = 1, 2  # the face runs along w first: points (w, u) = (1, 2) and (0, 3)
    first = replace(step.contacts[0], status=status)
    axes = mapped(made, replace(step, contacts=(first, step.contacts[1])))
    shown = {line.get_label(): np.column_stack(line.get_data()) for line in axes.lines}
    assert len(shown["open"]) == 18 - 2
    quarter = 0.25 * np.pi  # of the ring's circumference, which runs to the right
    assert shown["stick"] == pytest.approx(np.array([[quarter, 0.3]]), rel=1e-4)
    assert shown["slip"] == pytest.approx(np.array([[1.5 * quarter, 0.0]]), rel=1e-4)


def test_places_of_control_points() -> None:
    assert Direction("N", 2, [0, 0, 0, 1, 3, 3, 3]).greville == pytest.approx([0, 0.5, 2, 3])
    assert Direction("L", 2, [0, 1, 3]).greville == pytest.approx([0, 0.5, 1, 2, 3])


def test_bodies_are_drawn_with_the_pressure_in_colour() -> None:
    figure = draw_bodies(problem(), quiet(3), 0)
    assert [axes.get_title(loc="left") for axes in figure.axes[:2]] == ["rolling, load step 3 (press)", "tyre from the master's side"]


@pytest.mark.parametrize(("least", "end"), [(-0.5, "min"), (0.0, "neither")])
def test_a_bar_of_pressures_has_a_pointed_end_below_where_a_face_pulls(least: float, end: str) -> None:
    made, step = problem(), quiet(3)
    pressure = np.ones_like(step.state.contacts[0].pressure)
    pressure[0] = least
    contacts = (replace(step.state.contacts[0], pressure=pressure), *step.state.contacts[1:])
    picture = draw_bodies(made, replace(step, state=replace(step.state, contacts=contacts)), 0)
    assert [bar.extend for axes in picture.axes if (bar := getattr(axes, "_colorbar", None))] == [end]


def parts(axes: Axes) -> int:
    """Quadrilaterals that are drawn."""
    return sum(len(collection.get_facecolors()) for collection in axes.collections)


def test_both_pictures_of_bodies_show_the_contact_face(monkeypatch: pytest.MonkeyPatch) -> None:
    """Less is drawn in either where contact faces have next to no quadrilaterals."""
    shown = [parts(axes) for axes in draw_bodies(problem(), quiet(3), 0).axes[:2]]
    monkeypatch.setattr(bodies, "_FINENESS_OF_CONTACT", (1, 1))
    left = [parts(axes) for axes in draw_bodies(problem(), quiet(3), 0).axes[:2]]
    assert np.all(np.subtract(shown, left) > 1000)


def test_a_round_face_is_laid_flat_in_lengths_its_knot_lines_too() -> None:
    """The longer side runs to the right, and what is drawn is named and as long as it is."""
    made, step = problem(), step_result(1)
    axes = mapped(made, step)
    assert (axes.get_xlabel(), axes.get_ylabel(), axes.get_aspect()) == ("distance along u", "distance along w", 1.0)
    (drawn,) = (drawn for drawn in axes.collections if isinstance(drawn, LineCollection))
    ends = np.array([[line[0], line[-1]] for line in drawn.get_segments()])
    level = ends[:, 0, 1] == ends[:, 1, 1]
    upright = ends[~level]
    assert upright[:, 0, 0] == pytest.approx(np.arange(5) * np.pi / 4, rel=1e-4)
    assert upright[:, :, 1] == pytest.approx(np.tile([0.0, 0.3], (5, 1)))
    assert ends[level] == pytest.approx(np.array([[[0.0, y], [np.pi, y]] for y in (0.0, 0.3)]), rel=1e-4)


def test_places_of_a_round_face_laid_flat_move_as_their_derivatives_tell() -> None:
    """Along the longer side and the shorter one, which are as far apart as a half of a circle and a width."""
    surface = contact_surfaces(problem(), quiet(1))[0]
    flat, step = laid(surface), 0.01
    middles = [0.5 * (d.boundaries[:-1] + d.boundaries[1:]) for d in surface.directions]
    gradient = flat.at(middles)[1]
    for axis in (0, 1):
        there, here = (flat.at([x + sign * step * (k == axis) for k, x in enumerate(middles)])[0] for sign in (1, -1))
        assert gradient[..., axis] == pytest.approx((there - here) / (2 * step), rel=1e-3, abs=1e-12)


def test_a_flat_face_is_drawn_where_it_lies() -> None:
    surface = contact_surfaces(problem(), quiet(1))[0]
    road = problem().body("road").patch
    points = road.face_points("w1")
    flat = laid(
        replace(
            surface,
            directions=road.face_directions("w1"),
            weights=road.weights[points],
            reference_points=road.control_points[points],
        )
    )
    assert flat.labels == ("x", "y")
    places, _ = flat.at([direction.boundaries for direction in road.face_directions("w1")])
    assert places[..., 0] == pytest.approx(np.tile([-1.0, 0.5, 2.0], (2, 1)))
    assert places[..., 1] == pytest.approx(np.array([[-0.3] * 3, [0.7] * 3]))


@pytest.mark.parametrize(
    ("active", "low", "high"),
    [([], 0.0, 10.0), ([4.2, 5.0], 3.0, 7.0), ([4.0, 5.5], 2.0, 8.0), ([0.0, 10.0], 0.0, 10.0), ([0.5], 0.0, 3.0), ([9.5], 8.0, 10.0)],
)
def test_a_map_looks_at_the_contact_and_two_elements_round_it(active: list[float], low: float, high: float) -> None:
    ten = Direction("N", 1, [0.0, *range(11), 10.0])
    assert list(maps._within(ten, np.array(active))[[0, -1]]) == [low, high]


def test_a_map_looks_at_contact_along_both_of_its_coordinates() -> None:
    made, step = problem(), step_result(1)
    surface = contact_surfaces(made, step)[0]
    along, round_it = np.meshgrid(*(direction.greville for direction in surface.directions))
    first, second = (maps._within(d, x.ravel()[surface.status > 0]) for d, x in zip(surface.directions, (along, round_it), strict=True))
    axes = mapped(made, step)
    for limits, ends in ((axes.get_xlim(), second[[0, -1]] * np.pi / 4), (axes.get_ylim(), first[[0, -1]] * 0.3)):
        margin = 0.03 * np.ptp(ends)
        assert limits == pytest.approx((ends[0] - margin, ends[1] + margin), rel=1e-3)


@pytest.mark.parametrize("ends", [(0, 2), (0, 0), (3, 3), (-1, -1)])
def test_a_map_looks_at_every_control_point_in_contact(ends: tuple[int, int]) -> None:
    """The first one and the last one, of two and of one alone, along the face's first coordinate."""
    surface = contact_surfaces(problem(), step_result(1))[0]
    ten = Direction("N", 1, [0.0, *range(11), 10.0])
    status = np.zeros((surface.directions[1].count, ten.count), dtype=np.int32)
    status[0, list(ends)] = 1
    first, _ = maps._seen(replace(surface, directions=(ten, surface.directions[1]), status=status.ravel()))
    assert list(first[[0, -1]]) == list(maps._within(ten, ten.greville[list(ends)])[[0, -1]])
    assert np.ptp(first) < 10.0


def test_a_face_is_as_long_as_its_control_net() -> None:
    """Of the block's flat faces along its coordinates: v and w, w and u, u and v."""
    road = problem().body("road").patch
    surface = contact_surfaces(problem(), quiet(1))[0]
    for face, lengths in {"u0": (1.0, 0.5), "v1": (0.5, 3.0), "w1": (3.0, 1.0)}.items():
        points = road.face_points(face)
        here = replace(surface, directions=road.face_directions(face), reference_points=road.control_points[points])
        assert here.lengths == pytest.approx(lengths), face


def test_gaps_have_colours_of_both_signs_and_nothing_bare() -> None:
    made, step = problem(), over_master(step_result(1))
    drawn = mesh(mapped(made, step, "gap"))
    low, high = drawn.get_clim()
    assert low == -high < 0.0
    assert not np.ma.getmaskarray(drawn.get_array()).any()


def test_bodies_are_drawn_in_colours_by_each_of_their_fields() -> None:
    """From zero on, or between the least and the largest value inside; rigid bodies have none."""
    made, step = problem(), quiet(1)
    for name, label in (
        ("stress", "von Mises stress (force / deformed area)"),
        ("J", "J (volume / volume at rest)"),
        ("displacement", "length"),
    ):
        figure = draw_coloured(made, step, name)
        assert label in figure.axes[1].get_ylabel()
        low, high = figure.axes[1].get_ylim()
        assert (low == 0.0) == (name != "J")
        assert low < high


def square(height: float, size: float) -> np.ndarray:
    """A level square about the z-axis as a grid of points, a1 x a2 upwards."""
    x = np.linspace(-size, size, 9)
    return np.stack([*np.meshgrid(x, x), np.full((9, 9), height)], axis=-1)


def colour_at_centre(canvas: Canvas) -> np.ndarray:
    figure = Figure(figsize=(1, 1), dpi=100)
    canvas.paint(figure.add_axes((0, 0, 1, 1)))
    agg = FigureCanvasAgg(figure)
    agg.draw()
    return np.asarray(agg.buffer_rgba())[50, 50, :3]


@pytest.mark.parametrize("upper_first", [True, False])
def test_what_lies_in_front_hides_what_lies_behind(upper_first: bool) -> None:
    nowhere = (np.array([], int), np.array([], int))
    red, blue = np.broadcast_to([1.0, 0, 0], (8, 8, 3)), np.broadcast_to([0, 0, 1.0], (8, 8, 3))
    canvas = Canvas(Camera(azimuth=-90.0, elevation=80.0))
    layers = [(square(0.1, 0.5), red), (square(0.0, 1.0), blue)]
    for points, colours in layers if upper_first else layers[::-1]:
        canvas.add_surface(points, colours, 1, nowhere, shading=0.0)
    canvas.add_floor(square(1.0, 2.0)[[0, 0, -1, -1], [0, -1, -1, 0]], np.zeros(3))
    assert list(colour_at_centre(canvas)) == [255, 0, 0]


def test_a_surface_seen_from_its_inner_side_is_left_out() -> None:
    nowhere = (np.array([], int), np.array([], int))
    canvas = Canvas(Camera(azimuth=-90.0, elevation=80.0))
    canvas.add_surface(square(0.1, 0.5), np.zeros((8, 8, 3)), -1, nowhere)
    canvas.add_surface(square(0.0, 1.0), np.ones((8, 8, 3)), 1, nowhere, shading=0.0)
    assert list(colour_at_centre(canvas)) == [255, 255, 255]


def test_reactions_are_drawn_by_component_and_stages_named_above(results_path: Path) -> None:
    with Results(results_path) as results:
        figure = draw_reactions(results, "rim")
        for axes, quantity in zip(figure.axes, ("force", "moment"), strict=True):
            lines = {line.get_label(): np.asarray(line.get_ydata()) for line in axes.lines}
            for number, name in enumerate("xyz"):
                np.testing.assert_array_equal(lines[name], [0, *results.curve(quantity, support="rim")[:, number]])
            assert [name for name in lines if not name.startswith("_")] == ["x", "y", "z"]
        stages = list(dict.fromkeys(results.stages))
        assert [text.get_text() for text in figure.axes[0].texts] == stages
        assert not figure.axes[1].texts


def test_faces_are_drawn_in_equal_parts_of_elements() -> None:
    directions = Direction("L", 1, np.arange(5.0)), Direction("L", 1, np.arange(21.0))
    assert bodies.face_parts(directions, (40, 3)) == (10, 3)
    figure = draw_bodies(problem(), quiet(1), 0)
    assert [axes.get_xlabel() or axes.get_ylabel() for axes in figure.axes if "pressure" in axes.get_xlabel() + axes.get_ylabel()] == [
        "contact pressure (force / area at rest)"
    ]


#: A block that is long, and a support whose name is.
LONG = """
format = 1
bodies.block = { geometry = { kind = "box", lower = [0, 0, 0], upper = [10, 0.5, 0.5] }, mesh.elements = [4, 1, 1] }
contacts.floor = { slave = "block.w0", plane = {}, friction = 0.2 }
supports.what_presses_it_down_and_drags_it.face = "block.w1"
stages = [{ name = "press", steps = 2, motions.what_presses_it_down_and_drags_it.translate = [0.01, 0, -0.02] }]
"""


def box(artist: Artist, figure: Figure) -> Bbox:
    """Where something is drawn, in dots."""
    return artist.get_window_extent(figure.canvas.get_renderer())


def test_what_is_long_is_drawn_beside_each_other(tmp_path: Path) -> None:
    """Titles leave legends free, and labels of colour bars go about as far as these."""
    with run(Scene.from_toml(LONG), tmp_path / "run.h5") as results, style.style():
        curves = draw_reactions(results, "what_presses_it_down_and_drags_it")
        face = draw_map(results.problem, results.step(2), face_field(results.problem, results.step(2), 0))
    for figure in (curves, face):
        FigureCanvasAgg(figure).draw()
        legends = [*figure.legends, *(axes.get_legend() for axes in figure.axes if axes.get_legend())]
        titles = [axes.title if axes.title.get_text() else axes._left_title for axes in figure.axes]
        assert not any(box(legend, figure).overlaps(box(title, figure)) for legend in legends for title in titles if title.get_text())
    (bar,) = face.axes[1:] or face.axes[0].child_axes
    label = bar.xaxis.label if bar.xaxis.label.get_text() else bar.yaxis.label
    sides = (box(part, face) for part in (label, bar))
    assert np.divide(*(max(side.width, side.height) for side in sides)) < 1.5
