"""Figures of the paper's kinds: the fields that they show, and that nothing is clipped or covers something else."""

from __future__ import annotations

import base64
from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations
from pathlib import Path
from typing import Any
from unittest.mock import patch
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.text import Text
from paper.figures import Line, Panel, bodies, closeups, curves, flat, surfaces
from paper.figures.sheet import Mark, Sheet
from paper.figures.zones import corners_of, zones
from scipy.interpolate import BSpline

from isomortar.errors import InputError
from isomortar.geometry.patch import Direction
from isomortar.model.numbering import Numbering
from isomortar.results import Results, ResultsWriter
from isomortar.results import bodies as faces
from isomortar.results.bezier import functions_at, sampling_matrix
from isomortar.results.gaps import gaps
from isomortar.solve.record import StepResult
from results_samples import problem, step_result


@given(st.integers(1, 5), st.integers(0, 2**32 - 1))
def test_functions_and_their_derivatives_anywhere(order: int, seed: int) -> None:
    random = np.random.default_rng(seed)
    direction = Direction("N", order, np.repeat([0.0, 0.3, 1.1, 2.0], [order + 1, 1, order, order + 1]))
    coefficients, places = random.normal(size=direction.count), random.uniform(0, 2, 20)
    spline = BSpline(direction.knots, coefficients, order)
    values, slopes = functions_at(direction, places)
    assert values @ coefficients == pytest.approx(spline(places), abs=1e-10)
    assert slopes @ coefficients == pytest.approx(spline(places, nu=1), abs=1e-9)


def test_functions_agree_with_samples() -> None:
    direction = Direction("L", 3, [0.0, 1.0, 1.5])
    assert functions_at(direction, direction.subdivided(4))[0] == pytest.approx(sampling_matrix(direction, 4), abs=1e-13)


def test_gaps_to_a_plane_and_to_a_face() -> None:
    made = problem()
    rest = Numbering(made).reference
    road, ground = made.contacts
    heights = np.array([0.3, -0.02, 0.0])
    assert gaps(made, ground, rest, np.array([[5.0, 5.0, z] for z in heights])) == pytest.approx(-1.0 - heights, abs=1e-13)
    assert gaps(made, road, rest, np.array([[0.4, 0.1, z] for z in heights])) == pytest.approx(-heights, abs=1e-12)
    assert np.isnan(gaps(made, road, rest, np.array([[5.0, 0.1, 0.1]]))).all()


def area(corners: np.ndarray) -> float:
    x, y = corners.T
    return float(0.5 * (x * np.roll(y, -1) - y * np.roll(x, -1)).sum())


@given(st.lists(st.floats(-1, 1), min_size=12, max_size=12))
def test_zones_cover_the_grid_once(values: list[float]) -> None:
    field = np.array(values).reshape(3, 4)
    grid = np.stack(np.meshgrid(np.arange(4.0), np.arange(3.0)), axis=-1)
    found = zones(grid, field)
    parts = [area(part) for pair in found.parts for part in pair]
    assert found.positive.sum() + found.negative.sum() + sum(parts) == pytest.approx(6.0)
    assert all(part >= -1e-12 for part in parts)


def test_zones_are_cut_where_the_field_is_zero() -> None:
    grid = np.stack(np.meshgrid([0.0, 1.0, 2.0], [0.0, 1.0]), axis=-1)
    found = zones(grid, np.array([[-3.0, -1.0, 3.0], [-3.0, -1.0, 3.0]]))
    assert found.negative.tolist() == [[True, False]]
    assert [list(found.cut[0]), list(found.cut[1])] == [[0, 0], [1, 1]]
    assert (found.parts[:, 0, :, 0].min(), found.parts[:, 1, :, 0].max()) == (1.25, 1.25)
    assert corners_of(found.negative).tolist() == [[True, True, False]] * 2


def quiet(number: int) -> StepResult:
    """A step with little deformation, so that the bodies look like bodies and no element is folded."""
    made, result = problem(), step_result(number)
    rest = Numbering(made).reference
    return replace(result, state=replace(result.state, positions=rest + 0.05 * (result.state.positions - rest)))


@pytest.fixture
def results(tmp_path: Path) -> Iterator[Results]:
    path = tmp_path / "run.h5"
    writer = ResultsWriter(path, problem(), "", "0")
    for number in range(1, 4):
        writer.recorded(quiet(number))
    with Results(path) as opened:
        yield opened


@pytest.fixture
def coarse(monkeypatch: pytest.MonkeyPatch) -> None:
    """Few small quadrilaterals: the same figures in less time."""
    for module in (faces, bodies):
        monkeypatch.setattr(module, "FINENESS", (12, 2))
    monkeypatch.setattr(faces, "_FINENESS_OF_CONTACT", (12, 2))
    monkeypatch.setattr(flat, "_SAMPLES", 20)


def check_layout(figure: Figure) -> None:
    """No text leaves the figure, none covers another or a colour bar."""
    found: list[tuple[Text, Any]] = []
    draw = Text.draw

    def drawn(text: Text, renderer: Any, *others: Any, **named: Any) -> None:
        draw(text, renderer, *others, **named)
        if text.get_visible() and text.get_text().strip():
            found.append((text, text.get_window_extent(renderer)))

    with patch.object(Text, "draw", drawn):  # only what is drawn: hidden axes have texts as well
        FigureCanvasAgg(figure).draw()
    page = figure.bbox
    for text, at in found:
        inside = at.x0 >= -1 and at.y0 >= -1 and at.x1 <= page.x1 + 1 and at.y1 <= page.y1 + 1
        assert inside, f"{text.get_text()!r} is clipped: {at.extents} of {page.extents}"
        for axes in figure.axes:
            covers = axes.get_label() == "<colorbar>" and text.axes is not axes and at.overlaps(axes.bbox)
            assert not covers, f"{text.get_text()!r} covers the colour bar"
    for (one, first), (other, second) in combinations(found, 2):
        assert not first.padded(-1).overlaps(second.padded(-1)), f"{one.get_text()!r} covers {other.get_text()!r}"


def test_the_check_of_layouts_sees_faults() -> None:
    figure = Figure(figsize=(2, 1))
    figure.text(0.1, 0.5, "one")
    check_layout(figure)
    figure.text(0.15, 0.5, "two")
    with pytest.raises(AssertionError, match="'one' covers 'two'"):
        check_layout(figure)
    figure = Figure(figsize=(2, 1))
    figure.text(0.9, 0.5, "much too long")
    with pytest.raises(AssertionError, match="clipped"):
        check_layout(figure)


@pytest.mark.usefixtures("coarse")
@pytest.mark.parametrize("quantity", ["pressure", "traction", "traction_2", "gap"])
def test_surfaces(results: Results, tmp_path: Path, quantity: surfaces.Quantity) -> None:
    panels = [Panel("N2", results, 1), Panel("L4", results, 2, 0.4), Panel("N3", results, 3)]
    picture = surfaces.draw(panels, quantity)
    check_layout(picture.figure)
    titles = [axes.get_title(loc="left") for axes in picture.figure.axes]
    assert titles[:3] == ["N2", "L4 (heights times 0.4)", "N3"]
    path = picture.save(tmp_path / "fig-2.a")
    assert path.name == "fig-2.a.png"
    assert path.read_bytes().startswith(b"\x89PNG")
    assert base64.b64decode(picture.html.split("base64,")[1].rstrip('">')).startswith(b"\x89PNG")


def test_a_field_is_drawn_over_its_control_points(results: Results) -> None:
    """The pressure at samples on the ends of the ring's face, where functions interpolate; tractions over the friction coefficient."""
    panel = Panel("N2", results, 1)
    (patch,), region = flat.lay_flat([panel], "pressure")
    state = results.step(1).state.contacts[0]
    first = patch.values[patch.samples[1].searchsorted(region[0, 1]), 0]
    assert first == pytest.approx(state.pressure[0])  # the face runs along w first: its corner is the first control point
    assert (patch.zone < 0).any() == (patch.values < -1e-6 * np.abs(patch.values).max()).any()
    (along,), _ = flat.lay_flat([panel], "traction")
    (across,), _ = flat.lay_flat([panel], "traction_2")
    active = results.step(1).contacts[0].status > 0
    assert set(along.control_values) == set(np.append(state.traction[:, 0] / 0.1, [])[active])
    assert set(across.control_values) == set((state.traction[:, 1] / 0.1)[active])


def test_samples_of_a_region_begin_and_end_with_it() -> None:
    axis = flat._Axis(Direction("N", 2, [0, 0, 0, 1, 2, 3, 3, 3]), 6.0)
    places, lines = axis.samples(-1.0, 2.0)
    assert (places[0], places[-1]) == (-1.0, 2.0)
    assert (np.diff(places) > 0).all()
    assert places[lines] == pytest.approx([-1.0, 1.0])  # boundaries lie at -3, -1, 1, 3
    assert axis.parameters(axis.lengths(np.array([0.0, 0.7, 3.0]))) == pytest.approx([0.0, 0.7, 3.0])


def test_tractions_without_friction_mean_nothing(tmp_path: Path) -> None:
    made = problem()
    frictionless = replace(made, contacts=tuple(replace(contact, friction=0.0) for contact in made.contacts))
    ResultsWriter(tmp_path / "run.h5", frictionless, "", "0").recorded(quiet(1))
    with Results(tmp_path / "run.h5") as opened, pytest.raises(InputError, match="no friction"):
        surfaces.draw([Panel("N2", opened, 1)], "traction")


@pytest.mark.usefixtures("coarse")
@pytest.mark.parametrize(("field", "label"), [("stress", "stress"), ("stretch", "F_{33}"), (None, None)])
def test_bodies(results: Results, field: bodies.Field | None, label: str | None) -> None:
    picture = bodies.draw(results, [1, 3], field)
    check_layout(picture.figure)
    labels = [axes.get_ylabel() for axes in picture.figure.axes[2:]]
    assert len(labels) == (label is not None)
    assert all(str(label) in text for text in labels)
    with pytest.raises(InputError, match="steps"):
        bodies.draw(results, [], field)


@pytest.mark.usefixtures("coarse")
def test_bodies_have_their_stress_where_it_is(results: Results) -> None:
    """F33 of a body stretched in one half only: the faces show it there, whatever the order of their coordinates."""
    body = results.problem.bodies[1]
    rest = body.patch.control_points
    blossom = np.repeat([0.0, 0.0, 0.0, 0.4], 20)  # the last layer along w moves up
    for face in ("u0", "u1", "v0", "v1", "w0", "w1"):
        values = bodies._face_values(body, rest + np.outer(blossom, [0, 0, 1]), face, "stretch")
        parts = faces.face_parts(body.patch.face_directions(face), (12, 2))
        first, second = body.patch.face_directions(face)
        assert values.shape == (parts[1] * second.elements, parts[0] * first.elements)
        if face[0] == "w":
            assert values == pytest.approx(np.ones_like(values) if face == "w0" else np.full_like(values, values[0, 0]))
            continue
        upwards = values if face[0] == "u" else values.T  # faces u run along (v, w), faces v along (w, u)
        assert (np.ptp(upwards, axis=1) < 1e-12).all()
        assert upwards[-1, 0] > 1.3 > 1.0 + 1e-12 > upwards[0, 0]


@pytest.mark.usefixtures("coarse")
def test_close_ups(results: Results, tmp_path: Path) -> None:
    picture = closeups.draw([Panel("N2", results, 1), Panel("L4", results, 2)])
    check_layout(picture.figure)
    made, result = problem(), quiet(1)
    nothing = tuple(replace(contact, status=np.zeros(16, np.int32)) for contact in result.contacts)
    ResultsWriter(tmp_path / "open.h5", made, "", "0").recorded(replace(result, contacts=nothing))
    with Results(tmp_path / "open.h5") as opened, pytest.raises(InputError, match="nothing is in contact"):
        closeups.draw([Panel("N2", opened, 1)])


def line(label: str, kind: str, size: float = 1.0, reference: bool = False) -> Line:
    times = np.arange(1.0, 51.0)
    return Line(label, times, np.minimum(times, 20) + size * np.sin(times), kind, reference)


def test_curves_show_the_numbers_and_how_far_they_are_off() -> None:
    given_lines = [
        line("N4, fine", "N4", 0.0, True),
        line("N2", "N2"),
        line("L2", "L2", 0.5),
        line("B", "N2", 0.7),
        line("far", "N3", 30.0),
    ]
    picture = curves.draw(given_lines, "Twist: moment", "moment")
    left, right = picture.figure.axes
    for shown, meant in zip(left.lines, given_lines, strict=True):
        assert np.array_equal(shown.get_ydata(), meant.values)
    differences = [shown.get_ydata() for shown in right.lines]
    assert np.asarray(differences[1]) == pytest.approx(100 * np.sin(np.arange(1.0, 51.0)) / 20)
    assert len(differences) == 4
    assert "far" in right.get_title(loc="right")
    check_layout(picture.figure)
    root = ElementTree.fromstring(picture.html)
    assert root.get("aria-label") == "Twist: moment"


def test_curves_are_told_apart_without_colour() -> None:
    given_lines = [line("N2", "N2"), line("L2", "L2"), line("A", "N2"), line("B", "N2"), line("N5", "N5")]
    (axes,) = curves.draw(given_lines, "Drag", "force").figure.axes
    looks = [(drawn.get_marker(), to_rgba(drawn.get_markerfacecolor()) == to_rgba("white"), drawn.get_linestyle()) for drawn in axes.lines]
    assert len({(marker, hollow) for marker, hollow, _ in looks}) == 5
    assert [hollow for _, hollow, _ in looks] == [False, True, False, False, False]
    assert [style != "-" for _, _, style in looks] == [False, True, False, False, False]


def test_curves_are_saved_as_vectors(tmp_path: Path) -> None:
    path = curves.draw([line("N2", "N2")], "Drag", "force").save(tmp_path / "fig-9")
    assert path.name == "fig-9.pdf"
    assert path.read_bytes().startswith(b"%PDF")


@pytest.mark.parametrize("count", [1, 2, 3, 4, 5, 9])
@pytest.mark.parametrize("across", [0.8, 1.4, 2.5, 5.0])
def test_panels_of_a_sheet_do_not_meet(count: int, across: float) -> None:
    sheet = Sheet([f"panel {k}" for k in range(count)], across, True, [Mark("meaning", "o", "black")])
    boxes = [axes.get_position() for axes in sheet.panels]
    width, height = sheet.figure.get_size_inches()
    assert all(box.width * width / (box.height * height) == pytest.approx(across) for box in boxes)
    assert all(box.x0 >= 0 and box.x1 <= 1 and box.y0 > 0 and box.y1 <= 1 for box in boxes)
    assert not any(one.overlaps(other) for one, other in combinations(boxes, 2))
