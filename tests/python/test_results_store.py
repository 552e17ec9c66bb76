"""Results files: what is written is read back bit for bit; damage and misuse are told clearly; a kill loses nothing recorded."""

from __future__ import annotations

import dataclasses
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest

from isomortar.errors import ResultsError
from isomortar.model.entities import Motion
from isomortar.results import layout
from isomortar.results.files import sealed
from isomortar.results.reader import Results
from isomortar.results.writer import ResultsWriter
from isomortar.solve.record import ContactRates, Rates, StepResult
from results_samples import problem, step_result

SCENE = "[scene]\nname = 'rolling'  # größer ≤ ö\n"


def write(path: Path, steps: range, **options: object) -> None:
    writer = ResultsWriter(path, problem(), SCENE, "0.1", **options)
    for number in steps:
        writer.recorded(step_result(number))


def same(a: object, b: object) -> bool:
    """Equality of nested plain data down to the last bit, type and shape of arrays included."""
    if dataclasses.is_dataclass(a):
        return type(a) is type(b) and all(same(getattr(a, f.name), getattr(b, f.name)) for f in dataclasses.fields(a))
    if isinstance(a, tuple):
        return isinstance(b, tuple) and len(a) == len(b) and all(map(same, a, b))
    if isinstance(a, np.ndarray):
        return isinstance(b, np.ndarray) and a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()
    if isinstance(a, dict):
        return isinstance(b, dict) and a.keys() == b.keys() and all(same(a[k], b[k]) for k in a)
    return a == b or (a != a and b != b)


def test_steps_come_back_bit_for_bit(tmp_path: Path) -> None:
    path = tmp_path / "sub" / "run.h5"
    write(path, range(1, 6))
    with Results(path) as results:
        assert list(results.steps) == list(results.kept_states) == [1, 2, 3, 4, 5]
        for number in range(1, 6):
            assert same(results.step(number), step_result(number))
        assert same(results.last_step(), step_result(5))


@pytest.mark.parametrize("harm", [Path.unlink, lambda path: path.write_bytes(b"not it")], ids=["removed", "written over"])
def test_what_becomes_of_the_file_meanwhile_the_next_step_mends(tmp_path: Path, harm: Callable[[Path], object]) -> None:
    """All of it is held until the run ends."""
    path = tmp_path / "run.h5"
    writer = ResultsWriter(path, problem(), SCENE, "0.1")
    writer.recorded(step_result(1))
    harm(path)
    writer.recorded(step_result(2))
    with Results(path) as results:
        assert [same(results.step(number), step_result(number)) for number in (1, 2)] == [True, True]


def test_a_changed_bit_is_seen_by_the_comparison() -> None:
    a, b = step_result(1), step_result(1)
    assert same(a, b)
    b.state.positions[3, 1] = np.nextafter(b.state.positions[3, 1], 1)
    assert not same(a, b)


def test_the_problem_comes_back(tmp_path: Path) -> None:
    path = tmp_path / "run.h5"
    write(path, range(0))
    with Results(path) as results:
        assert same(results.problem, problem())
        assert results.scene_text == SCENE
        assert results.version == "0.1"
        assert results.last_step() is None
        assert len(results.steps) == 0
        assert results.curve("force", support="rim").shape == (0, 3)
        with pytest.raises(ResultsError, match="no load step yet"):
            results.contact("tread")


def test_counts_of_nothing_are_counts(tmp_path: Path) -> None:
    """What was counted and did not come is read again as such; what was not counted is not there."""
    writer = ResultsWriter(tmp_path / "run.h5", problem(), SCENE, "0.1")
    for number, counters in ((1, {"analyses": 0, "solves": 2}), (2, {"solves": 0})):
        writer.recorded(dataclasses.replace(step_result(number), counters=counters))
    with Results(tmp_path / "run.h5") as results:
        assert [results.step(number).counters for number in (1, 2)] == [{"analyses": 0, "solves": 2}, {"solves": 0}]


def test_curves(tmp_path: Path) -> None:
    path = tmp_path / "run.h5"
    write(path, range(1, 4))
    steps = [step_result(k) for k in range(1, 4)]
    with Results(path) as results:
        assert np.array_equal(results.curve("force", support="bed", component="z"), [s.reactions[1].force[2] for s in steps])
        assert np.array_equal(results.curve("moment_master", contact="ground"), [s.contacts[1].moment_master for s in steps])
        assert np.array_equal(results.curve("active", contact="tread"), [s.contacts[0].active for s in steps])
        assert np.array_equal(results.curve("time"), [1, 2, 3])
        assert results.stages == ["press"] * 3
        assert np.array_equal(results.contact("ground").pressure, [s.state.contacts[1].pressure for s in steps])
        assert np.array_equal(results.timings()["other"], [np.nan, 0.25, 0.25], equal_nan=True)
        assert np.array_equal(results.counters()["analyses"], [3, -1, -1])
        for bad, words in [
            ({"quantity": "stress", "support": "rim"}, "force, moment, centre"),
            ({"quantity": "force", "support": "roof"}, "rim, bed"),
            ({"quantity": "active", "contact": "tread", "component": "x"}, "no components"),
        ]:
            with pytest.raises(ResultsError, match=words):
                results.curve(**bad)
        with pytest.raises(ResultsError, match="steps 1 to 3"):
            results.step(4)


@pytest.mark.parametrize("states", ["every", "last"])
def test_every_row_of_every_curve_is_that_of_its_step(tmp_path: Path, states: str) -> None:
    """Also where the run was resumed: all that steps are said to hold, of each support and contact by its name."""
    path = tmp_path / "run.h5"
    write(path, range(1, 4), states=states)
    write(path, range(4, 6), states=states, resume=True)
    steps = [step_result(k) for k in range(1, 6)]
    with Results(path) as results:
        for quantity in layout.STEP.keys() - {"stage"}:
            assert np.array_equal(results.curve(quantity), [getattr(s, quantity) for s in steps], equal_nan=True), quantity
        assert results.stages == [s.stage for s in steps]
        for i, support in enumerate(results.problem.supports):
            for quantity in layout.REACTION:
                expected = np.array([getattr(s.reactions[i], quantity) for s in steps])
                assert np.array_equal(results.curve(quantity, support=support.name), expected), (support.name, quantity)
                for axis, letter in enumerate("xyz") if expected.ndim == 2 else ():
                    assert np.array_equal(results.curve(quantity, support=support.name, component=letter), expected[:, axis])
        kept = [s for s in steps if s.step in results.kept_states]
        assert [s.step for s in kept] == ([1, 2, 3, 4, 5] if states == "every" else [5])
        for i, contact in enumerate(results.problem.contacts):
            for quantity in layout.CONTACT:
                expected = np.array([getattr(s.contacts[i], quantity) for s in steps])
                assert np.array_equal(results.curve(quantity, contact=contact.name), expected), (contact.name, quantity)
            history = results.contact(contact.name)
            for quantity in ("pressure", "traction"):
                assert np.array_equal(getattr(history, quantity), [getattr(s.state.contacts[i], quantity) for s in kept])
            for quantity in layout.CONTACT_VALUES:
                assert np.array_equal(getattr(history, quantity), [getattr(s.contacts[i], quantity) for s in kept])
            assert np.array_equal(history.steps, [s.step for s in kept])
            assert history.contact == contact
        for name, values in results.timings().items():
            assert np.array_equal(values, [s.timings.get(name, np.nan) for s in steps], equal_nan=True)
        for name, counts in results.counters().items():
            assert np.array_equal(counts, [s.counters.get(name, -1) for s in steps])
        assert np.array_equal(results.augmentations(), [len(s.augmentations) for s in steps])


def test_work_that_an_older_file_does_not_hold_is_not_a_number(tmp_path: Path) -> None:
    """Such a file is read, and resumed: from there on it holds the work."""
    path = tmp_path / "run.h5"
    write(path, range(1, 4))
    with h5py.File(path, "a") as file:
        for contact in file["curves/contacts"].values():
            del contact["friction_work"], contact["spurious_work"]
    path.write_bytes(sealed(path.read_bytes()))
    with Results(path) as results:
        assert np.isnan(results.curve("spurious_work", contact="tread")).tolist() == [True] * 3
        last = results.last_step()
        assert last is not None
        assert np.isnan(last.contacts[0].friction_work)
        assert last.contacts[0].active == step_result(3).contacts[0].active
    write(path, range(4, 6), resume=True)
    with Results(path) as results:
        expected = [step_result(k).contacts[1].spurious_work for k in (4, 5)]
        assert np.array_equal(results.curve("spurious_work", contact="ground"), [np.nan] * 3 + expected, equal_nan=True)


def with_rates(number: int) -> StepResult:
    """A load step with rates, of which those of tractions are zero where there is no friction."""
    result = step_result(number)
    random = np.random.default_rng(number)
    pairs = zip(problem().contacts, result.state.contacts, strict=True)
    contacts = tuple(
        ContactRates(random.normal(size=state.pressure.shape), random.normal(size=state.traction.shape) * contact.friction_law.acts)
        for contact, state in pairs
    )
    rates = Rates(float(number), random.normal(size=result.state.positions.shape), contacts)
    return dataclasses.replace(result, state=dataclasses.replace(result.state, rates=rates))


@pytest.mark.parametrize("states", ["every", "last"])
def test_rates_come_back_with_their_states(tmp_path: Path, states: str) -> None:
    """And none where there were none."""
    path = tmp_path / "run.h5"
    writer = ResultsWriter(path, problem(), SCENE, "0.1", states=states)
    given = [with_rates(number) if number in (2, 3, 5) else step_result(number) for number in range(1, 6)]
    for number, result in enumerate(given, 1):
        writer.recorded(result)
        with Results(path) as results:
            assert same(results.last_step(), result)
            assert states == "last" or all(same(results.step(k), given[k - 1]) for k in range(1, number + 1))


def test_a_file_from_before_there_were_rates_is_resumed(tmp_path: Path) -> None:
    path = tmp_path / "run.h5"
    write(path, range(1, 3))
    with h5py.File(path, "a") as file:
        del file["rates"]
    path.write_bytes(sealed(path.read_bytes()))
    ResultsWriter(path, problem(), SCENE, "0.1", resume=True).recorded(step_result(3))
    ResultsWriter(path, problem(), SCENE, "0.1", resume=True).recorded(with_rates(4))
    with Results(path) as results:
        assert [same(results.step(k), step_result(k)) for k in (1, 2, 3)] == [True] * 3
        assert same(results.step(4), with_rates(4))


def test_every_dataset_has_unit_and_description(tmp_path: Path) -> None:
    path = tmp_path / "run.h5"
    write(path, range(1, 3))
    ResultsWriter(path, problem(), SCENE, "0.1", resume=True).recorded(with_rates(3))
    bare = []

    def look(name: str, entry: h5py.Dataset | h5py.Group) -> None:
        if isinstance(entry, h5py.Dataset) and not (entry.attrs.get("unit") and entry.attrs.get("description")):
            bare.append(name)

    with h5py.File(path) as file:
        file.visititems(look)
    assert bare == []


def test_only_the_last_state_is_kept_on_demand(tmp_path: Path) -> None:
    path = tmp_path / "run.h5"
    write(path, range(1, 6), states="last")
    with Results(path) as results:
        assert list(results.steps) == [1, 2, 3, 4, 5]
        assert list(results.kept_states) == [5]
        assert same(results.last_step(), step_result(5))
        assert len(results.curve("force", support="rim")) == 5
        with pytest.raises(ResultsError, match="kept no state"):
            results.step(2)


@pytest.mark.parametrize("states", ["every", "last"])
def test_resume_appends(tmp_path: Path, states: str) -> None:
    path = tmp_path / "run.h5"
    write(path, range(1, 3), states=states)
    write(path, range(3, 5), states=states, resume=True)
    with Results(path) as results:
        assert list(results.steps) == [1, 2, 3, 4]
        assert same(results.last_step(), step_result(4))
        if states == "every":
            assert same(results.step(1), step_result(1))


def test_resume_refuses_another_scene_and_names_the_difference(tmp_path: Path) -> None:
    path = tmp_path / "run.h5"
    write(path, range(1, 3))
    before = path.read_bytes()
    given = problem()
    rim = dataclasses.replace(given.supports[0], motions=(Motion((0, 0, -0.2)), given.supports[0].motions[1]))
    softer = dataclasses.replace(given.bodies[0], material=dataclasses.replace(given.bodies[0].material, young=0.25))
    other = dataclasses.replace(given, supports=(rim, given.supports[1]), bodies=(softer, given.bodies[1]))
    with pytest.raises(ResultsError) as raised:
        ResultsWriter(path, other, SCENE, "0.1", resume=True)
    assert "bodies.tyre.material.young: 0.3333333333333333 in the file, 0.25 in the scene" in str(raised.value)
    assert "supports.rim.motions.0.translate" in str(raised.value)
    assert path.read_bytes() == before


def test_resume_asks_for_what_is_computed_not_for_names_of_files(tmp_path: Path) -> None:
    """Numbers in a results file stand in the order of the scene: that is a part of what must agree, the scene's own name is not."""
    path, given = tmp_path / "run.h5", problem()
    write(path, range(1, 3))
    ResultsWriter(path, dataclasses.replace(given, name="renamed"), SCENE, "0.1", resume=True).recorded(step_result(3))
    for kind in ("bodies", "contacts", "supports", "stages"):
        names = [entry.name for entry in getattr(given, kind)]
        with pytest.raises(ResultsError, match=re.escape(f"{kind}: {names} in the file, {names[::-1]} in the scene")):
            ResultsWriter(path, dataclasses.replace(given, **{kind: getattr(given, kind)[::-1]}), SCENE, "0.1", resume=True)


def test_an_existing_file_is_not_overwritten(tmp_path: Path) -> None:
    path = tmp_path / "run.h5"
    write(path, range(1, 3))
    with pytest.raises(ResultsError, match="exists already"):
        write(path, range(1, 3))


def test_a_step_cannot_be_recorded_twice(tmp_path: Path) -> None:
    path = tmp_path / "run.h5"
    write(path, range(1, 3))
    with pytest.raises(ResultsError, match="load step 2 already"):
        write(path, range(2, 3), resume=True)
    with Results(path) as results:
        assert list(results.steps) == [1, 2]
    assert list(tmp_path.iterdir()) == [path]


def test_an_unwritable_place_is_told(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(ResultsError, match="file is a file, and no folder"):
        write(tmp_path / "file" / "run.h5", range(1))


def test_missing_and_foreign_files(tmp_path: Path) -> None:
    with pytest.raises(ResultsError, match="does not exist"):
        Results(tmp_path / "none.h5")
    (tmp_path / "text.h5").write_text("not HDF5")
    with pytest.raises(ResultsError, match="no results file of isomortar"):
        Results(tmp_path / "text.h5")
    h5py.File(tmp_path / "other.h5", "w").close()
    with pytest.raises(ResultsError, match="no results file of isomortar"):
        Results(tmp_path / "other.h5")
    newer = tmp_path / "newer.h5"
    write(newer, range(0))
    with h5py.File(newer, "a") as file:
        file.attrs["format_version"] = 99
    with pytest.raises(ResultsError, match="is damaged"):
        Results(newer)
    newer.write_bytes(sealed(newer.read_bytes()))
    with pytest.raises(ResultsError, match="format 99"):
        Results(newer)


def test_no_changed_byte_reaches_hdf5(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Cut the file short, lengthen it, change one bit or 64 bytes: each is told, and by the seal: HDF5 may hang on such files."""
    path, spoiled = tmp_path / "run.h5", tmp_path / "spoiled.h5"
    write(path, range(1, 4))
    whole = path.read_bytes()
    monkeypatch.setattr(h5py, "File", lambda *_: pytest.fail("HDF5 was let at a damaged file"))
    random = np.random.default_rng(0)
    for place in [0, 40, 511, 512, len(whole) - 1, *random.integers(0, len(whole), 150)]:
        flipped = bytes([whole[place] ^ 1 << int(random.integers(8))])
        for damaged in (
            whole[:place],
            whole[:place] + flipped + whole[place + 1 :],
            whole[:place] + random.bytes(64) + whole[place + 64 :],
            whole + whole[place : place + 1],
        ):
            spoiled.write_bytes(damaged)
            with pytest.raises(ResultsError, match=r"is damaged|no results file"):
                Results(spoiled)


CHILD = """
import sys
from isomortar.solve.record import ContactRates, Rates, StepResult
from results_samples import problem, step_result
from isomortar.results.reader import Results
from isomortar.results.writer import ResultsWriter
path = sys.argv[1]
writer = ResultsWriter(path, problem(), "scene", "0.1", resume=True)
with Results(path) as results:
    first = len(results.steps) + 1
for step in range(first, 10000):
    writer.recorded(step_result(step))
    print(step, flush=True)
"""


#: What can be asked of results, after their file is closed as before.
ASKED: dict[str, Callable[[Results], object]] = {
    **{name: lambda results, name=name: getattr(results, name) for name in dir(Results) if isinstance(getattr(Results, name), property)},
    **{name: lambda results, name=name: getattr(results, name)() for name in ("timings", "counters", "augmentations", "last_step")},
    **{name: lambda results, name=name: getattr(results, name) for name in ("scene_text", "problem", "steps", "stages", "warnings")},
    "curve": lambda results: results.curve("time"),
    "of a support": lambda results: results.curve("force", support="rim"),
    "contact": lambda results: results.contact("tread"),
    "step": lambda results: results.step(1),
    "to_dataframe": lambda results: results.to_dataframe(),
}


@pytest.mark.parametrize("name", ASKED)
def test_closed_results_are_said_to_be_closed(name: str, tmp_path: Path) -> None:
    """It was said that another version had written them, and to run the scene again."""
    write(tmp_path / "run.h5", range(1, 3))
    with Results(tmp_path / "run.h5") as results:
        pass
    with pytest.raises(ResultsError, match=r"run\.h5 is closed: read it before that"):
        ASKED[name](results)


def test_a_kill_at_any_moment_leaves_the_last_completed_step(tmp_path: Path) -> None:
    """SIGKILL at random moments of a run that does nothing but write; it resumes and is killed again, ten times."""
    path = tmp_path / "run.h5"
    random = np.random.default_rng()
    here = str(Path(__file__).parent)
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([here, *sys.path])}
    reached = 0
    for _ in range(10):
        child = subprocess.Popen([sys.executable, "-c", CHILD, str(path)], stdout=subprocess.PIPE, text=True, env=environment)
        assert child.stdout is not None
        first = child.stdout.readline()
        assert first == f"{reached + 1}\n"  # it resumes where the file ends
        told = [first, child.stdout.readline(), child.stdout.readline()]
        time.sleep(0.1 * random.random())
        child.send_signal(signal.SIGKILL)
        told += child.stdout
        child.wait()
        recorded = max(int(line) for line in told if line.endswith("\n"))
        with Results(path) as results:
            reached = len(results.steps)
            assert reached in (recorded, recorded + 1)  # killed between taking the name and telling
            assert same(results.last_step(), step_result(reached))
            assert same(results.step(1 + reached // 2), step_result(1 + reached // 2))
    assert reached >= 30
