"""Pages of runs: what they hold against the program's own evaluation, by the page's own functions too, and in a browser."""

from __future__ import annotations

import base64
import itertools
import json
import re
import shutil
import subprocess
import zlib
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

import isomortar
from isomortar.errors import ResultsError
from isomortar.model.entities import Problem
from isomortar.model.numbering import Numbering
from isomortar.results import ResultsWriter
from isomortar.results.bezier import functions_at, rational
from isomortar.results.fields import body_points, contact_surfaces
from isomortar.solve.record import StepResult
from results_samples import problem
from test_results_pictures import quiet

#: Of an element, where fields are looked at.
AT = (0.3, 0.85)
#: 32-bit floats, after a sum of some terms.
CLOSE = 2e-6
VIEWER = Path(isomortar.__file__).parent / "results" / "viewer"


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("view")
    writer = ResultsWriter(folder / "run.h5", problem(), "", "0")
    for number in range(1, 4):
        writer.recorded(quiet(number))
    return isomortar.view(folder / "run.h5", folder / "run.html")


def said(path: Path) -> tuple[dict[str, Any], NDArray[np.float32]]:
    """What a page says of its surfaces, and its numbers."""
    text = path.read_text()
    data, numbers = (re.search(rf'<script type="[a-z/]+" id="{name}">(.*?)</script>', text, re.S) for name in ("page", "numbers"))
    assert data is not None
    assert numbers is not None
    return json.loads(data[1]), np.frombuffer(zlib.decompress(base64.b64decode(numbers[1])), "<f4")


def nets(path: Path) -> list[dict[str, Any]]:
    """Surfaces with their weights, by load step their columns, and their marks."""
    data, numbers = said(path)
    begin, found = 0, []
    for surface in data["surfaces"]:
        shape = [p * n + 1 for p, n in zip(surface["orders"], surface["elements"], strict=True)]
        count, rows = shape[0] * shape[1], len(surface["columns"])
        steps, drawn = len(data["steps"]), [n * surface["parts"] + 1 for n in surface["elements"]]
        parts = [count, *[rows * count] * steps, *[4 * surface["marks"]] * steps]
        parts += [drawn[0] * drawn[1], rows] * steps if surface["contact"] is not None else []
        weights, *blocks = np.split(numbers[begin : begin + sum(parts)].astype(float), np.cumsum(parts)[:-1])
        begin += sum(parts)
        states = [block.reshape(rows, count) for block in blocks[:steps]]
        acting = [block.reshape(drawn[::-1]) for block in blocks[2 * steps :: 2]]
        found.append(
            surface | {"shape": shape, "weights": weights, "states": states, "marked": blocks[steps : 2 * steps], "acting": acting}
        )
    assert begin == len(numbers)
    return found


def at(
    surface: dict[str, Any], values: NDArray[np.float64], element: tuple[int, int], places: tuple[float, float] = AT
) -> NDArray[np.float64]:
    """Columns within an element, by de Casteljau's halving of lines, weights and all."""
    p, q = surface["orders"]
    grid = np.vstack([values * surface["weights"], surface["weights"]]).reshape(-1, surface["shape"][1], surface["shape"][0])
    net = grid[:, q * element[1] : q * (element[1] + 1) + 1, p * element[0] : p * (element[0] + 1) + 1]
    for axis, s in ((2, places[0]), (1, places[1])):
        while net.shape[axis] > 1:
            first, second = (np.take(net, range(k, net.shape[axis] - 1 + k), axis=axis) for k in (0, 1))
            net = (1.0 - s) * first + s * second
    return net[:-1, 0, 0] / net[-1, 0, 0]


def parameters(directions: Any, element: tuple[int, int]) -> list[NDArray[np.float64]]:
    ends = [d.boundaries for d in directions]
    return [np.array([e[k] + s * (e[k + 1] - e[k])]) for e, k, s in zip(ends, element, AT, strict=True)]


def of_face(made: Problem, step: StepResult, body: str, face: str, element: tuple[int, int]) -> NDArray[np.float64]:
    """Place of a point of a body's face, by functions at its parameters."""
    patch, points = made.body(body).patch, body_points(made, step.state.positions)[body]
    axis = "uvw".index(face[0])
    where = [patch.directions[axis].boundaries[[0, -1]][int(face[1])]]
    whole = [np.array(where)] * 3
    whole[(axis + 1) % 3], whole[(axis + 2) % 3] = parameters(patch.face_directions(face), element)
    matrices = [functions_at(d, x)[0] for d, x in zip(patch.directions, whole, strict=True)]
    return rational(matrices, patch.weights, points)[0][0]


FACES = [("tyre", face) for face in ("v0", "v1", "w0", "w1")] + [("road", face) for face in ("u0", "u1", "v0", "v1", "w0", "w1")]


def test_bodies_are_where_they_are_and_faces_are_those_that_are_seen(page: Path) -> None:
    made, surfaces = problem(), [surface for surface in nets(page) if surface["contact"] is None]
    centre = np.array(said(page)[0]["centre"])
    assert [surface["name"] for surface in surfaces] == [name for name, _ in FACES], "the ends of a ring are inside it"
    for number, (surface, (body, face)) in enumerate(zip(surfaces, FACES, strict=True)):
        element = (surface["elements"][0] - 1, 0)
        for step in (1, 3):
            place = of_face(made, quiet(step), body, face, element)
            np.testing.assert_allclose(at(surface, surface["states"][step], element)[:3] + centre, place, atol=CLOSE, err_msg=str(number))
        assert surface["slaveOf"] == ([0, 1] if (body, face) == ("tyre", "v1") else [])


def test_contacts_have_their_fields(page: Path) -> None:
    surfaces = [surface for surface in nets(page) if surface["contact"] is not None]
    for step in (1, 2, 3):
        for surface, shown in zip(surfaces, contact_surfaces(problem(), quiet(step)), strict=True):
            first, second = (functions_at(d, x)[0] for d, x in zip(shown.directions, parameters(shown.directions, (0, 2)), strict=True))
            values = shown.field((first, second), np.column_stack([shown.pressure, shown.traction, shown.gap]))[0]
            assert surface["columns"][3:] == ["pressure", "traction", "gap"]
            np.testing.assert_allclose(at(surface, surface["states"][step], (0, 2))[3:], values, atol=CLOSE * np.abs(shown.gap).max())
            np.testing.assert_array_equal(surface["marked"][step].reshape(4, -1)[3], shown.status)
    assert np.isnan(surfaces[0]["states"][0][5]).all(), "at rest gaps are not told"
    assert not surfaces[0]["states"][0][3].any()


def test_a_body_that_is_stretched_has_its_volume_on_the_page(tmp_path: Path) -> None:
    """By 1.1, 0.9 and 1.05 along x, y and z: J is the product, everywhere."""
    made, step = problem(), quiet(1)
    moved = Numbering(made).reference * [1.1, 0.9, 1.05]
    ResultsWriter(tmp_path / "run.h5", made, "", "0").recorded(replace(step, state=replace(step.state, positions=moved)))
    for surface in nets(isomortar.view(tmp_path / "run.h5", tmp_path / "run.html")):
        if surface["contact"] is None:
            volumes = [state[surface["columns"].index("J")] for state in surface["states"]]
            np.testing.assert_allclose(volumes[0], 1.0, rtol=CLOSE)
            np.testing.assert_allclose(volumes[1], 1.1 * 0.9 * 1.05, rtol=CLOSE)


def test_ranges_are_those_of_all_load_steps(page: Path) -> None:
    """At the places where surfaces are drawn; pressures begin at zero."""
    found: dict[tuple[str, int | None], list[float]] = {}
    for surface in nets(page):
        places = [k / surface["parts"] for k in range(surface["parts"] + 1)]
        elements = itertools.product(*map(range, surface["elements"]))
        for element, s, t, state in itertools.product(elements, places, places, surface["states"]):
            for name, value in zip(surface["columns"], at(surface, state, element, (s, t)), strict=True):
                found.setdefault((name, surface["contact"]), []).append(value)
    fields = said(page)[0]["fields"]
    assert [field["label"] for field in fields][:4] == ["pressure of tread", "traction of tread", "gap of tread", "status of tread"]
    assert [field["label"] for field in fields][8:] == ["displacement", "von Mises stress", "J"]
    for field in fields:
        if (values := found.get((field["column"], field["contact"]))) is not None:
            low = 0.0 if field["bare"] else np.nanmin(values)
            single = 1e-7 * np.nanmax(np.abs(values))  # digits that a page has
            np.testing.assert_allclose(field["range"], [low, np.nanmax(values)], rtol=1e-4, atol=single, err_msg=field["label"])


NODE = """
const fs = require("fs"), vm = require("vm");
vm.runInThisContext(fs.readFileSync(process.argv[1], "utf8").replace('"use strict";', ""));
const text = fs.readFileSync(process.argv[2], "utf8");
const part = (name) => text.match(new RegExp(`id="${name}">([^]*?)</script>`))[1];
const page = JSON.parse(part("page"));
inflated(part("numbers")).then((numbers) => {
  distribute(page, numbers);
  const all = page.surfaces.map((s) => s.states.map((state) => sampled(s, state, s.columns, 20).map((values) => Array.from(values))));
  console.log(JSON.stringify(all, (_, value) => (typeof value === "number" && !Number.isFinite(value) ? null : value)));
});
"""


@pytest.mark.skipif(shutil.which("node") is None, reason="runs the page's functions where there is something that does")
def test_the_page_evaluates_them_as_the_program_does(page: Path) -> None:
    """At the place (0.3, 0.85) of each first element, which is one of 20 equal parts."""
    done = subprocess.run(["node", "-e", NODE, str(VIEWER / "bezier.js"), str(page)], capture_output=True, text=True, check=True)
    for surface, states in zip(nets(page), json.loads(done.stdout), strict=True):
        row = 20 * surface["elements"][0] + 1
        for state, columns in zip(surface["states"], states, strict=True):
            values = np.array([column[17 * row + 6] for column in columns], dtype=float)
            right = at(surface, state, (0, 0))
            np.testing.assert_allclose(values, right, atol=CLOSE * np.abs(right[np.isfinite(right)]).max())


def test_a_page_needs_nothing_else(page: Path) -> None:
    text = page.read_text()
    assert not re.findall(r"(?:src|href)\s*=|url\(|@import|fetch\(|https?://", text)


@pytest.mark.skipif(shutil.which("chromium") is None, reason="opens the page where there is a browser")
@pytest.mark.parametrize("size", ["1280,800", "400,800"])
def test_a_browser_shows_it(page: Path, size: str, tmp_path: Path) -> None:
    """Its graphics come up, and the bodies are drawn in more colours than a bare page has."""
    arguments = ["--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--virtual-time-budget=8000"]
    picture = tmp_path / "page.png"
    subprocess.run(
        ["chromium", *arguments, f"--user-data-dir={tmp_path}", f"--window-size={size}", f"--screenshot={picture}", page.as_uri()],
        capture_output=True,
        check=True,
        timeout=120,
    )
    with Image.open(picture) as image:
        colours = image.convert("RGB").getcolors(1 << 24)
    assert colours is not None
    assert len(colours) > 500


def test_a_run_without_a_load_step_has_no_page(tmp_path: Path) -> None:
    ResultsWriter(tmp_path / "run.h5", problem(), "", "0")
    with pytest.raises(ResultsError, match="holds no load step yet: nothing to look at"):
        isomortar.view(tmp_path / "run.h5", tmp_path / "run.html")
    assert not (tmp_path / "run.html").exists()
