"""Beside its master a slave has no pressure, however large the coefficients are that hold it: pictures, pages, exports, trade."""

from __future__ import annotations

import base64
import json
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.collections import QuadMesh
from scipy import spatial

import isomortar
from isomortar.accuracy.sampling import face_grid
from isomortar.model.entities import Problem
from isomortar.results import ResultsWriter
from isomortar.results.bezier import functions_at
from isomortar.results.bodies import common_scale
from isomortar.results.face_field import face_field
from isomortar.results.fields import ContactSurface, contact_surfaces
from isomortar.results.maps import draw_map
from isomortar.solve.record import StepResult
from isomortar.trade import run as traded
from results_samples import over_master, problem, ring
from test_results_pictures import quiet
from test_view import VIEWER, nets, said

#: Share of the ring that is over its master: two of its four elements.
HALF = 0.5
#: Pressures there, and those of functions that are wholly beside it.
HERE, BESIDE = 2.0, 1000.0
#: Along the ring's axis, and round it, where the face has its elements.
ROUND = np.linspace(0.05, 3.95, 40)
PARAMETERS = [np.linspace(0.0, 1.0, 5), ROUND]


def half() -> StepResult:
    """A load step in which a ring presses with its second half, which is beside its master, much harder than with the other."""
    step = over_master(quiet(1), HALF)
    pressure = np.where(np.arange(16) // 2 > 4, BESIDE, HERE)  # of eight pairs round the ring the last three are of its second half alone
    contacts = tuple(replace(c, pressure=pressure) for c in step.state.contacts)
    measured = tuple(replace(c, traction_norm=pressure, gap=-pressure, status=np.full(16, 2, np.int32)) for c in step.contacts)
    return replace(step, state=replace(step.state, contacts=contacts), contacts=measured)


def sampled(made: Problem) -> ContactSurface:
    return contact_surfaces(made, half())[0]


def test_a_place_is_over_the_master_where_the_nearest_quadrature_point_has_a_foot() -> None:
    over = sampled(problem()).over_master(PARAMETERS)
    np.testing.assert_array_equal(over, np.tile(ROUND[:, None] < 2.0, (1, 5)))


def test_the_nearest_points_are_looked_for_in_one_tree(monkeypatch: pytest.MonkeyPatch) -> None:
    """However often it is asked: pictures, pages and exports ask for each field."""
    grown: list[int] = []
    tree = spatial.cKDTree
    monkeypatch.setattr(spatial, "cKDTree", lambda points: grown.append(len(points)) or tree(points))
    surface = sampled(problem())
    for _ in range(3):
        surface.over_master(PARAMETERS)
        surface.fields(tuple(functions_at(d, x)[0] for d, x in zip(surface.directions, PARAMETERS, strict=True)))
    assert len(grown) == 1


def test_where_all_points_have_a_foot_all_places_are_over_the_master() -> None:
    assert contact_surfaces(problem(), quiet(1))[0].over_master(PARAMETERS).all()


def test_points_with_constraints_of_their_own_need_no_footing() -> None:
    """What is beside the master has no pressure there anyway; means over control points reach as far as these do."""
    made = problem()
    made = replace(made, contacts=tuple(replace(contact, enforcement="greville") for contact in made.contacts))
    count = 16 + 8 * 2  # a ring of C0 lines, seen from both sides
    step = half()
    contacts = tuple(replace(c, projected=np.zeros(count, np.int32)) for c in step.state.contacts)
    surface = contact_surfaces(made, replace(step, state=replace(step.state, contacts=contacts)))[0]
    assert surface.over_master(PARAMETERS).all()


def test_the_scale_of_pictures_is_that_of_pressures_that_act() -> None:
    made = problem()
    assert common_scale(made, [half()], 0).face.peak == pytest.approx(HERE)


@pytest.mark.parametrize("field", ["pressure", "traction", "gap"])
def test_maps_are_bare_beside_the_master(field: str) -> None:
    made = problem()
    shown = face_field(made, half(), 0, "pressure")
    shown = replace(shown, name=field, values=-shown.values if field == "gap" else shown.values)
    drawn = next(of for of in draw_map(made, half(), shown).axes[0].collections if isinstance(of, QuadMesh))
    values = drawn.get_array()
    assert drawn.get_clim()[1] == pytest.approx(HERE)
    bare = np.ma.getmaskarray(values).reshape(values.shape)[:, 2]
    assert bare[len(bare) // 2 + 2 : -1].all()  # the ring ends where it begins
    assert not bare[: len(bare) // 2 - 2].any()


def test_a_page_shows_nothing_beside_the_master(tmp_path: Path) -> None:
    made = problem()
    ResultsWriter(tmp_path / "run.h5", made, "", "0").recorded(half())
    page = isomortar.view(tmp_path / "run.h5", tmp_path / "run.html")
    ranges = {field["label"]: field["range"] for field in said(page)[0]["fields"]}
    assert ranges["pressure of tread"] == pytest.approx([0.0, HERE])
    assert ranges["gap of tread"] == pytest.approx([-HERE, -HERE])
    surface = next(surface for surface in nets(page) if surface["contact"] == 0)
    rest, pressed = surface["acting"]
    assert rest.all()
    parts = surface["parts"]
    assert pressed[1 : 2 * parts].all()  # both ends of the ring are where it begins
    assert not pressed[2 * parts + 1 : 4 * parts].any()


NODE = """
const fs = require("fs"), vm = require("vm");
vm.runInThisContext(fs.readFileSync(process.argv[1], "utf8").replace('"use strict";', ""));
const valuesOf = eval("(" + fs.readFileSync(process.argv[2], "utf8").match(/function valuesOf[^]*?\\n}/)[0] + ")");
const text = fs.readFileSync(process.argv[3], "utf8");
const part = (name) => text.match(new RegExp(`id="${name}">([^]*?)</script>`))[1];
const page = JSON.parse(part("page"));
let shown = null;
inflated(part("numbers")).then((numbers) => {
  distribute(page, numbers);
  const surface = page.surfaces.find((s) => s.contact === 0);
  const all = ["pressure", "traction", "gap"].map((column) => {
    shown = { field: { column }, step: 1 };
    return Array.from(valuesOf(surface, null, surface.parts));
  });
  console.log(JSON.stringify(all));
});
"""


@pytest.mark.skipif(shutil.which("node") is None, reason="runs the page's functions where there is something that does")
def test_the_page_leaves_out_what_is_beside_the_master(tmp_path: Path) -> None:
    """Not a number comes as null; a field is no larger than at the quadrature points."""
    made = problem()
    ResultsWriter(tmp_path / "run.h5", made, "", "0").recorded(half())
    page = isomortar.view(tmp_path / "run.h5", tmp_path / "run.html")
    scripts = [str(VIEWER / name) for name in ("bezier.js", "page.js")]
    done = subprocess.run(["node", "-e", NODE, *scripts, str(page)], capture_output=True, text=True, check=True)
    surface = next(surface for surface in nets(page) if surface["contact"] == 0)
    here = surface["acting"][1].ravel() > 0
    for values, size in zip(json.loads(done.stdout), (HERE, HERE, -HERE), strict=True):
        found = np.array(values, dtype=float)
        np.testing.assert_array_equal(np.isnan(found), ~here)
        np.testing.assert_allclose(found[here][surface["parts"] : -surface["parts"]], size, rtol=1e-6)


def test_an_export_tells_which_elements_are_over_the_master(tmp_path: Path) -> None:
    made = problem()
    ResultsWriter(tmp_path / "run.h5", made, "", "0").recorded(half())
    isomortar.export(tmp_path / "run.h5", tmp_path)
    for number, shares in ((0, [1.0] * 8), (1, [1.0, 1.0, 0.0, 0.0] * 2)):
        root = ElementTree.parse(tmp_path / "run" / f"contacts-{number:04d}.vtu").getroot()
        (found,) = (array for array in root.iter("DataArray") if array.get("Name") == "over master")
        np.testing.assert_array_equal(_numbers(found), shares)


def _numbers(array: ElementTree.Element) -> np.ndarray:
    return np.frombuffer(base64.b64decode(str(array.text))[8:])


def test_trade_counts_the_area_that_presses() -> None:
    made = problem()
    grid = face_grid(ring(), "v1", 400)
    pressures, tractions = traded._fields(made, half(), [grid, grid])
    for values in (*pressures, *tractions):
        assert float(values.max()) == pytest.approx(HERE)
        assert float(grid.weights @ (values > 0)) == pytest.approx(HALF * float(grid.weights.sum()))
