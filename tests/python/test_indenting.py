"""Bodies whose elements are cut where a contact presses: where that is, where they are cut, and that they stay what they are."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from told.long_elements import CAP

from isomortar._bindings import surface_functions
from isomortar.geometry.splines import Spline
from isomortar.march.simulation import Simulation
from isomortar.model.contrasts import element_lengths
from isomortar.model.entities import Face
from isomortar.model.sheet import Sheet
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.feet import slave_points
from isomortar.solve.timing import Ledger
from isomortar.told.during import long_elements
from isomortar.told.during.extent import extent
from isomortar.told.during.indenting import GROWS, PARTS, coordinates_of_slave, cut_under, cuts, further

#: Slaves whose functions are rational, go all round, are Lagrange elements, and are integrated in parts.
SLAVES = {
    "rational, closed": ("tire", []),
    "plain": ("press", []),
    "arc": ("iron", []),
    "Lagrange": ("press", ["bodies.block.mesh={family='L',order=2,elements=3}"]),
    "in parts": ("twist", ["contacts.interface.subcells=1"]),
    "at points": ("press", ["contacts.floor.enforcement='greville'"]),
}


@pytest.mark.parametrize("name", SLAVES)
def test_coordinates_of_a_slaves_points_are_where_its_face_has_them(name: str) -> None:
    scene, settings = SLAVES[name]
    equilibrium = Equilibrium(Scene.load(scene, settings).problem(), Ledger())
    pair, numbering = equilibrium.pairs[0].pair, equilibrium.numbering
    sheet = Sheet.of(equilibrium.problem, pair.contact.slave)
    nodes, functions = surface_functions(*sheet.arrays(numbering), coordinates_of_slave(pair, equilibrium))
    points = sheet.points(numbering)[sheet.patch.face_points(sheet.face)]
    found = np.einsum("qa,qai->qi", functions[:, 0], numbering.reference[points[nodes]])
    assert np.abs(found - slave_points(pair, numbering.reference)).max() < 1e-14 * np.ptp(numbering.reference)


@pytest.mark.parametrize("closed", [False, True])
@pytest.mark.parametrize("width", [0.01, 0.3, 2.0])
def test_elements_are_cut_until_they_are_short_where_contact_is_and_no_further(width: float, closed: bool) -> None:
    bounds, ends = np.array([0.0, 0.1, 0.5, 1.0]), np.array([0.0, 1.0, 3.0, 4.0])
    middle = 0.05 if closed else 1.7
    where = (middle - 0.5 * width, middle + 0.5 * width)
    found = cuts(bounds, ends, where, width, closed)
    assert np.all(np.diff(found) > 0.0)
    for low, high in zip(*(np.sort(np.concatenate([bounds, found]))[part] for part in (slice(-1), slice(1, None))), strict=True):
        start, end = np.interp([low, high], bounds, ends)
        turns = (-4.0, 0.0, 4.0) if closed else (0.0,)
        away = min(max(0.0, where[0] + turn - end, start - where[1] - turn) for turn in turns)
        assert end - start <= width / PARTS + GROWS * away
    assert len(found) < 60
    assert len(cuts(bounds, ends, where, 100.0, closed)) == 0


def test_what_presses_in_a_point_ends() -> None:
    problem = Scene.load("press").problem()
    cut = cut_under(problem, problem.body("block"), Face("block", "w0"), np.array([[0.4, 0.4]]), np.ones(1))
    assert len(cut.patch.weights) < 20000


def test_a_body_that_is_cut_has_the_shape_that_it_had() -> None:
    problem = Scene.load("tire").problem()
    contact = problem.contacts[0].slave
    body, at = problem.body(contact.body), np.random.default_rng(4).random((50, 2)) * 0.02
    cut = cut_under(problem, body, Face(contact.body, contact.face), at, np.ones(len(at)))
    places = np.random.default_rng(5).random((40, 3))
    was, now = (Spline(of.directions, of.control_points, of.weights).evaluate(places) for of in (body.patch, cut.patch))
    assert np.abs(was - now).max() < 1e-13 * body.size
    axis = "uvw".index(contact.face[0])
    assert element_lengths(cut.patch)[axis].min() < 0.7 * element_lengths(body.patch)[axis].min()


def test_half_of_a_contact_is_as_wide_as_the_whole() -> None:
    random, bounds, ends = np.random.default_rng(3), np.linspace(0.0, 1.0, 5), np.arange(5.0)
    places, forces = 0.5 * random.random(30), random.random(30)
    whole = extent(np.append(places, 1.0 - places), np.tile(forces / forces.sum(), 2) / 2.0, bounds, ends, False)
    half = extent(2.0 * places, forces / forces.sum(), bounds, 0.5 * ends, False, -1)
    assert whole == pytest.approx((2.0, half[1]), rel=1e-14)
    assert half[0] == 2.0


@pytest.mark.parametrize(("way", "looks"), [(2e-4, 1), (0.02, 3)])
def test_what_short_elements_would_do_is_computed_anew_where_contact_has_changed(
    way: float, looks: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    looked: list[int] = []

    def counted(*given: Any) -> np.ndarray:
        looked.append(given[2])
        return further(*given)

    monkeypatch.setattr(long_elements, "further", counted)
    stages = "".join(f'[[stages]]\nname="{k}"\nsteps=1\nmotions.hand.translate=[0,0,{-0.05 if k == 0 else -way}]\n' for k in range(3))
    text = CAP[: CAP.index("stages =")].replace("YOUNG", "10").replace("ORDER", "2").replace("MANY, MANY", "5, 5") + stages
    list(Simulation(Scene.from_toml(text).problem()).run())
    assert len(looked) == looks
