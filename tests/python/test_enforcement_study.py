"""The study of enforcement: its scenes by every way, what is stated of runs that are made up, and the page."""

from __future__ import annotations

import html
import json
from datetime import datetime
from pathlib import Path

import numpy as np
import pytest
from enforcement import exact, known, page
from enforcement.contact import IN_CELLS, METHODS
from enforcement.found import Evidence, Found, Known
from enforcement.patches import ROWS as METHOD_ROWS
from enforcement.plan import BY_ORDER, MORTAR, REFERENCE, SETUPS, WAYS, Planned, planned
from enforcement.recommend import NOT_MEASURED, advice, best
from enforcement.statements import STATEMENTS
from enforcement.study import study
from patch_tests.contact import ORDERS

from isomortar import model
from isomortar.errors import InputError
from isomortar.harness.cases import Cell, Words
from isomortar.harness.compare import judge
from isomortar.harness.measurement import Measurement, stored
from isomortar.harness.runner import Result
from isomortar.harness.statement import Judgement

PRESS, TWIST, _, _, LINEAR_BLOCK, _ = SETUPS
#: How far the curve of each way is off the reference, as a share of it.
OFF = dict.fromkeys(WAYS, 0.02) | {REFERENCE: 0.0, MORTAR: 0.02, "mortar, swapped": 0.05, "knots": 0.03, "knots, averaged": 0.03}


def made_up(steps: int = 20, peak: float = 1.0) -> list[Found]:
    """Runs of the twist; `steps` and the largest pressure of kts as given."""
    runs = []
    for entry in planned((TWIST,)):
        kts = entry.way == "kts"
        count = steps if kts else 20
        moment = np.zeros((count, 2, 3))
        moment[:, 0, 2] = (1.0 + OFF[entry.way]) * np.arange(count)
        pressure = np.tile([0.0, peak if kts else 1.0], (count, 1))
        numbers = {
            "missing": 20 - count, "force": moment, "moment": moment, "pressure": pressure, "words": Words(""), "solves": 1, "cuts": 0,
            "cpu_seconds": 1.0, "constraints": 3 if entry.way.startswith("knots") else 4, "control_points": 4,
        }  # fmt: skip
        measurement = Measurement("measured", {name: stored(value) for name, value in numbers.items()})
        runs.append(Found(Result(entry.run.case, measurement, (), True), entry))  # type: ignore[arg-type]
    return runs


def counted(**others: float) -> list[Result]:
    """Cells of what is exact: every number is `others`', else 0."""
    results = []
    for cell in exact.cells():
        numbers = {name: others.get(name, 0.0) for name in cell.case.bounds_of(cell.settings)}
        measurement = Measurement("measured", {name: stored(value) for name, value in numbers.items()}, cpu_seconds=1.0)
        results.append(Result(cell, measurement, tuple(judge(cell, measurement, lambda _: None)), True))  # type: ignore[arg-type]
    return results


def tractions(off: float = 0.05, kts: float = 0.7) -> list[Known]:
    """Runs whose tractions are known, so far off theory."""
    runs = []
    for cell in known.cells():
        share = kts if cell.settings["way"] == "kts" else off
        x = 0.01 * np.linspace(-1.0, 1.0, 5)
        numbers = {
            "missing": 0, "words": Words(""), "off": share, "peak": 1.0, "roughness": 2.0, "places": x, "values": x, "exact": x,
            "solves": 1, "cuts": 0, "cpu_seconds": 1.0,
        }  # fmt: skip
        measurement = Measurement("measured", {name: stored(value) for name, value in numbers.items()})
        runs.append(Known(Result(cell, measurement, (), True)))
    return runs


def judged(runs: list[Found], beside: list[Known]) -> list[Judgement]:
    """All statements."""
    return [
        statement.judged([Evidence(runs, method, known=beside, table=ROWS) for method in statement.methods]) for statement in STATEMENTS
    ]


#: Of what is exact, where every number is 0, but for inf-sup constants.
ROWS = exact.table(counted(**{"inf-sup": 1.0}))


def verdicts(runs: list[Found], beside: list[Known]) -> dict[str, dict[str, str]]:
    """By statement and way."""
    return {j.statement.section: {verdict.method: verdict.state for verdict in j.verdicts} for j in judged(runs, beside)}


def test_every_way_of_every_scene_can_be_built() -> None:
    for setup in (*SETUPS, *BY_ORDER):
        for way in (REFERENCE, *setup.ways):
            contact, *others = setup.load(way).problem().contacts
            assert [(other.slave, other.master) for other in others] == [(contact.master, contact.slave)] * way.endswith("two passes")
            assert contact.enforcement == ("mortar" if way == REFERENCE else way.partition(",")[0])
            assert contact.averaged == way.endswith("averaged")


def test_a_plane_is_no_slave_nodes_have_no_demko_abscissae_and_slaves_are_swapped() -> None:
    assert PRESS.ways == (MORTAR, "mortar, elastic slip", "mortar, smooth", "dual", "greville", "demko", "knots", "kts")
    assert set(WAYS) - set(LINEAR_BLOCK.ways) == {"demko", "demko, averaged", "kts, averaged"}
    assert [setup.name for setup in SETUPS if setup.kinks] == [LINEAR_BLOCK.name]
    (contact,), (swapped,) = (TWIST.load(way).problem().contacts for way in (MORTAR, "mortar, swapped"))
    assert (contact.slave, contact.master) == (swapped.master, swapped.slave)


def test_curves_are_judged_beside_the_mortar_method() -> None:
    found = verdicts(made_up(peak=3.0), tractions())
    assert found["ending"] == dict.fromkeys(WAYS, "holds")
    assert found["as theory"] == dict.fromkeys(
        [way for way in known.WAYS if way not in ("kts", "mortar, elastic slip", "mortar, smooth")], "holds"
    )
    assert found["as good"]["greville"] == "holds"
    assert found["as good"]["mortar, swapped"] == "does not hold"
    assert found["too few"] == dict.fromkeys(("knots", "knots, averaged"), "holds")
    assert found["too many"] == {"kts": "holds", "kts, averaged": "does not hold"}
    assert found["rank, too few"] == {"knots": "does not hold"}  # of made-up constraints, which are as many as they should be
    assert found["dual, smooth"] == {"dual": "does not hold"}
    assert found["smooth laws"] == dict.fromkeys(("mortar, elastic slip", "mortar, smooth"), "holds")


def test_a_run_that_stops_is_a_failure_and_its_pressure_counts() -> None:
    found = verdicts(made_up(steps=7, peak=1.5), tractions())
    assert found["ending"]["kts"] == "does not hold"
    assert found["too many"]["kts"] == "does not hold"


def test_the_page_has_every_run(tmp_path: Path) -> None:
    runs = made_up(steps=7)
    beside = tractions(off=0.0543)
    path = page.write(tmp_path, counted(condition=7.25), beside, runs, judged(runs, beside), datetime(2026, 1, 1)).page
    text, data = path.read_text(encoding="utf-8"), json.loads(path.with_suffix(".json").read_text(encoding="utf-8"))
    assert all(way in text for way in WAYS)
    assert [row["way"] for row in data["scenes"][0]] == [REFERENCE, *WAYS]
    assert "twist by kts (not converged)" in text
    assert "<td>7.2</td>" in text
    assert "<td>5.43</td>" in text
    assert all(entry["text"] in html.unescape(text) for entry in data["advice"])
    assert [row["way"] for row in data["known"][1]] == list(known.WAYS)
    assert {row["condition"] for row in data["exact"]} == {7.25}
    assert f"{next(exact.cells()).name} by mortar" not in text


def test_what_is_exact_is_told_by_method_and_order() -> None:
    cells = counted()
    rows = exact.table(cells)
    assert [(row["method"], row["order"]) for row in rows[:6]] == [*(("mortar", k) for k in ORDERS), (IN_CELLS, 1)]
    assert len(rows) == len(METHOD_ROWS) * len(ORDERS)
    failing = {exact.Exact(result).method for result in cells if exact.Exact(result).ending == "out of bounds"}
    more_than_nothing = {"kts", "knots", "greville", "demko", "mixed", "slave", "master", "one field", "two"}
    assert failing == more_than_nothing  # is claimed of them


def test_what_is_no_option_is_told_with_its_number(tmp_path: Path) -> None:
    cells = counted(work=0.125)
    first, second, *others = exact.refused(cells)
    assert (first["own"], first["instead"], second["own"]) == (0.125, 0.125, 0.0)
    runs, beside = made_up(), tractions()
    path = page.write(tmp_path, cells, beside, runs, judged(runs, beside), datetime(2026, 1, 1)).page
    text = html.unescape(path.read_text(encoding="utf-8"))
    assert all(entry.form in text and entry.why in text for entry in exact.REFUSED)
    assert json.loads(path.with_suffix(".json").read_text(encoding="utf-8"))["refused"] == [first, second, *others]


def test_a_cell_without_numbers_leaves_its_row() -> None:
    (first, *others) = counted(pressure=0.5)
    lost = Result(first.cell, Measurement("timed out"), (), True)
    row = exact.table([lost, *others])[0]
    assert np.isnan(row["matching"])
    assert row["other"] == 0.5
    assert exact.Exact(lost).ending == "timed out"


def test_scenes_that_there_are_not_are_refused() -> None:
    assert len(study(["twist"]).runs) == len(list(exact.cells())) + 1 + len(WAYS)
    with pytest.raises(InputError, match="hertz, mindlin, press, twist, iron, tire, block L1, block N2, press L1"):
        study(["iorn"])


def test_plans_have_names_of_their_own() -> None:
    names = [Planned(setup, way).run.name for setup in (*SETUPS, *BY_ORDER) for way in (REFERENCE, *setup.ways)]
    assert len(set(names)) == len(names)


def test_tractions_are_judged_by_what_elements_can_hold() -> None:
    runs = made_up()
    sections = {(j.statement.section, v.method): (v.state, v.values) for j in judged(runs, tractions(off=0.2, kts=0.2)) for v in j.verdicts}
    state, values = sections["as theory", "greville"]
    assert state == "does not hold"
    assert values == {"hertz": pytest.approx(0.2 / 0.15), "mindlin": pytest.approx(0.2 / 0.3)}


@pytest.mark.parametrize("cell", list(known.cells()), ids=lambda cell: cell.name)
def test_known_tractions_can_be_had_by_every_way(cell: Cell) -> None:
    scene, way, kind = (cell.settings[name] for name in ("scene", "way", "kind"))
    given = known.problem(scene, way, kind)
    (contact,) = given.contacts
    changed = ", averaged" * contact.averaged + ", subcells" * bool(contact.subcells)
    assert way == contact.enforcement + changed + ", elastic slip" * bool(contact.elastic_slip) + ", smooth" * bool(contact.smoothing)
    across = [body.patch.directions[0] for body in given.bodies]
    assert {f"{direction.family}{direction.order}" for direction in across} == {kind}


def test_what_is_exact_is_nothing_off() -> None:
    x = 0.01 * np.linspace(-1.2, 1.2, 25)
    exact_values = np.sqrt(np.maximum(0.0, 1.0 - (x / 0.01) ** 2))
    found = known.compared(known.Line(x, exact_values, np.ones(25)), exact_values, exact_values, np.abs(x) < 0.008)
    assert (found["off"], found["peak"], found["roughness"]) == (0.0, 1.0, 1.0)
    twice = known.compared(known.Line(x, 2.0 * exact_values, np.ones(25)), exact_values, exact_values, np.abs(x) < 0.008)
    assert (twice["off"], twice["peak"], twice["roughness"]) == pytest.approx((1.0, 2.0, 4.0))


def test_the_way_that_is_nowhere_far_from_the_best_is_recommended() -> None:
    values = {"mortar": {"a": 0.02, "b": 0.03}, "greville": {"a": 0.01, "b": 0.09}, "kts": {"a": 0.005, "b": np.nan}, "half": {"b": 0.06}}
    found = best("Resultants", "distance", values, percent=True)
    assert dict(found.ratios) == pytest.approx({"half": 2.0, "greville": 3.0, "mortar": 4.0})
    assert found.text == (
        "Take half: of b it is at most 2 times the best (b: 6 %, 3 % at best), b 6 %. "
        "The others at most: greville 3 (b), mortar 4 (a) times the best. No candidates, as numbers are missing: kts (b)."
    )


def test_the_best_everywhere_is_said_to_be_so_and_nothing_is_recommended_without_numbers() -> None:
    assert best("Speed", "seconds", {"mortar": {"a": 1.5}}, unit=" s").text == "Take mortar: of a it is the best everywhere, a 1.5 s."
    assert best("Speed", "seconds", {"mortar": {"a": np.nan}}).text == NOT_MEASURED
    unknown = [row | dict.fromkeys(row.keys() - {"method", "order"}, np.nan) for row in ROWS]
    assert [entry.text for entry in advice([], [], unknown)] == [NOT_MEASURED] * 13


def test_what_fails_the_patch_test_on_matching_meshes_is_not_recommended() -> None:
    rows = [row | {"matching": 0.1 * row["order"] * (row["method"] == "knots")} for row in ROWS]
    found = {entry.purpose: entry for entry in advice(made_up(), tractions(), rows)}["Resultants of splines"]
    assert "knots" not in found.ratios
    assert "as they fail the patch test on meshes that match: knots (50 %), knots, averaged (50 %)." in found.text


def test_advice_follows_the_runs() -> None:
    found = {entry.purpose: entry for entry in advice(made_up(steps=7), tractions(), ROWS)}
    resultants, speed = found["Resultants of splines"], found["Speed of splines"]
    assert "kts (twist)" in resultants.text
    assert resultants.ratios["mortar, swapped"] == pytest.approx(0.05 / 0.02)
    assert set(speed.ratios) == set(WAYS) - {"kts"}
    assert found["Resultants of a master with kinks"].text == NOT_MEASURED
    assert found["Pressures and tractions"].ratios["kts"] == pytest.approx(14.0)
    assert "kts for too many constraints (0; largest pressure 1 times Hertz's)" in found["Teaching, the paper's comparison"].text


def test_every_file_of_a_method_is_counted_and_no_lines_stand_twice() -> None:
    counted_files = {row["file"]: row["lines"] for row in exact.sizes()}
    assert {f"{method}.py" for method in METHODS} <= set(counted_files)
    folder = Path(model.__file__).parent / "enforcement"
    seen: dict[tuple[str, ...], str] = {}
    for path in sorted(folder.glob("*.py")):
        lines = [line.strip() for line in path.read_text(encoding="utf-8").splitlines()]
        code = [line for line in lines if line and not line.startswith(("import ", "from ", '"""', "@"))]
        assert sum(map(bool, lines)) == counted_files[path.name]
        for k in range(len(code) - 3):
            assert seen.setdefault(tuple(code[k : k + 4]), path.name) == path.name
