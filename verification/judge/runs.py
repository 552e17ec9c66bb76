"""A run of cases, from the folder to the report: what is measured, what is kept, what the report and the exit code say of it."""

from __future__ import annotations

import json
import sys
import tempfile
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any
from unittest import mock
from xml.etree import ElementTree

import numpy as np
from forked import program
from judge.ways import BOUNDS, WAYS, told

from isomortar.errors import InputError
from isomortar.harness import case, history, report, runner, store
from isomortar.harness.cases import Case, Cell
from isomortar.harness.collection import collect
from isomortar.harness.journal import Journal
from isomortar.harness.measurement import Measurement, measure
from isomortar.harness.references import finder, write_reference
from isomortar.harness.worker import task_of

#: Cases that end in all ways; those of higher tiers do not end well.
FAMILY = "of_the_judge"
CASES = """
from isomortar.errors import ConvergenceError
from isomortar.harness import Bound, Matches, Shown, case, skip

SMALL = {"error": Bound(at_most=1.0, reason="theory: so")}

@case(claim="Is right.", bounds={**SMALL, "seen": Shown("to see")}, grid={"k": [1, 2]})
def right(k):
    return {"error": 0.25 * k, "seen": [1.0, k]}

@case(claim="Is kept.", bounds={"value": Matches("kept", "reference: as it was")})
def same():
    return {"value": [1.0, 2.0]}

@case(claim="Has none.", bounds={"value": Matches("none", "reference: as it was"), **SMALL})
def alone():
    return {"value": 1.0, "error": 0.0}

@case(claim="Is wrong.", bounds={**SMALL, "other": SMALL["error"]})
def wrong():
    return {"error": 0.5, "other": 1.5}

@case(claim="Is nothing.", bounds={**SMALL, "other": SMALL["error"]})
def absent():
    return {"error": 0.5}

@case(claim="Has no end.", bounds=SMALL)
def unsolved():
    raise ConvergenceError("no end")

@case(claim="Breaks.", bounds=SMALL)
def broken():
    raise ValueError("broken")

@case(claim="Finds no memory.", bounds=SMALL)
def full():
    raise MemoryError

@case(claim="Skips.", bounds=SMALL)
def skipping():
    skip("no library")

@case(claim="Comes at night.", bounds=SMALL, tier="nightly")
def late():
    return {"error": 2.0}

@case(claim="Comes at night or in a week.", bounds=SMALL, tier=lambda k: ("gate", "nightly", "weekly")[k], grid={"k": [0, 1, 2]})
def later(k):
    return {"error": 0.0}
"""
#: States of the cells of the gate.
STATES = {
    "right[k=1]": "passed", "right[k=2]": "passed", "same": "passed", "alone": "missing reference", "wrong": "failed",
    "absent": "not measured", "unsolved": "failed", "broken": "crashed", "full": "failed", "skipping": "skipped", "later[k=0]": "passed",
}  # fmt: skip
#: Those that would end like this again.
LASTING = {"right[k=1]", "right[k=2]", "same", "alone", "wrong", "absent", "unsolved", "later[k=0]"}


class Here:
    """Measures in this process, and notes what it was asked for."""

    def __init__(self, sources: Callable[[Case], str] = store.sources_hash) -> None:
        self.asked: list[str] = []
        self._sources = sources

    def submit(self, task: dict[str, Any]) -> Future[Measurement]:
        """As a measuring process does."""
        found = next(c for c in collect(Path(task["path"]).parents[1]) if c.name == task["case"])
        cell = Cell(found, task["settings"])
        self.asked.append(short(cell))
        future: Future[Measurement] = Future()
        future.set_result(replace(measure(cell), sources=self._sources(found)))
        return future


def short(cell: Cell) -> str:
    """Its name without the family."""
    return cell.name.partition("/")[2]


@contextmanager
def folder_of_cases() -> Iterator[Path]:
    """A folder with the cases and their reference, whose modules are forgotten at the end."""
    with tempfile.TemporaryDirectory() as name:
        root = Path(name).resolve() / "cases"
        (root / FAMILY).mkdir(parents=True)
        (root / FAMILY / "some.py").write_text(CASES)
        record = dict.fromkeys(("title", "origin", "made", "uncertainty"), "as it was") | {"class": "other code"}
        write_reference(root.parent / "references/kept", {"value": (np.array([1.0, 2.0]), 1e-9)}, record)
        try:
            yield root
        finally:
            sys.path[:] = [path for path in sys.path if Path(path) != root]
            for module in [module for module in sys.modules if module.partition(".")[0] == FAMILY]:
                del sys.modules[module]


def run(root: Path, here: Here, fresh: bool = False) -> list[runner.Result]:
    """The gate of the folder."""
    kept, lookup = store.Store(root.parent / "store"), finder(root.parent / "references")
    return runner.run(runner.start(runner.select(collect(root), "gate"), kept, here.submit, fresh), lookup, kept)


@case(
    claim="A run measures all cells of its tier once, again only what does not last, was damaged or is asked for afresh, and takes no "
    "numbers of other sources.",
    tier="gate",
    grid={"way": WAYS},
    bounds=BOUNDS,
)
def measured_once(way: str) -> dict[str, float]:
    """How much is measured or judged otherwise."""
    wrong = []
    with folder_of_cases() as root:
        for what, fresh, asked in (("first", False, set(STATES)), ("second", False, set(STATES) - LASTING), ("fresh", True, set(STATES))):
            here = Here()
            results = run(root, here, fresh)
            wrong += [f"{what}: {here.asked}"] * (sorted(here.asked) != sorted(asked))
            wrong += [f"{what}: {short(r.cell)} {r.state}" for r in results if r.state != STATES[short(r.cell)]]
            wrong += [f"{what}: {short(r.cell)}" for r in results if r.fresh != (short(r.cell) in asked)]
        kept = sorted((root.parent / "store" / FAMILY).glob("right-*.json"))
        for path, old, new in zip(kept, ("0.25", "0.5"), ("0.26", "0.51"), strict=True):
            text = path.read_text() if old in path.read_text() else kept[1 - kept.index(path)].read_text()
            path.write_text(text.replace(f'"error": {old}', f'"error": {new}'))
        here = Here()
        run(root, here)
        wrong += [f"damaged: {here.asked}"] * (not {"right[k=1]", "right[k=2]"} <= set(here.asked))
        others = run(root, Here(lambda _: "others"), True)
        wrong += [f"other sources: {short(r.cell)} {r.measurement.ending}" for r in others if r.measurement.ending != "trouble"]
    return told(wrong, way)


@case(
    claim="A tier holds those before it; a family, a case and a cell are found by their names; what is not there is refused.",
    tier="gate",
    grid={"way": WAYS},
    bounds=BOUNDS,
)
def selected(way: str) -> dict[str, float]:
    """How many selections are others."""
    nights, wrong = {"late", "later[k=1]"}, []
    with folder_of_cases() as root:
        cases = collect(root)
        for tier, cells in (("gate", set(STATES)), ("nightly", {*STATES, *nights}), ("weekly", {*STATES, *nights, "later[k=2]"})):
            found = [short(cell) for cell in runner.select(cases, tier)]  # type: ignore[arg-type]
            wrong += [f"{tier}: {found}"] * (sorted(found) != sorted(cells))
        seconds = [task_of(cell)["seconds"] for cell in runner.select(cases, "weekly", FAMILY, f"{FAMILY}/later")]
        wrong += [f"seconds: {seconds}"] * (seconds != [120.0, 1800.0, 14400.0])
        for name, cells in (("right", {"right[k=1]", "right[k=2]"}), ("right[k=2]", {"right[k=2]"}), ("wrong", {"wrong"})):
            found = [short(cell) for cell in runner.select(cases, "gate", FAMILY, f"{FAMILY}/{name}")]
            wrong += [f"{name}: {found}"] * (sorted(found) != sorted(cells))
        asked = (("gate", "other", None), ("gate", None, f"{FAMILY}/other"), ("gate", None, f"{FAMILY}/late"), ("gate", FAMILY, "right"))
        wrong += [f"{words}" for words in asked if not refused(lambda words=words: runner.select(cases, *words))]  # type: ignore[misc]
        twice = CASES.replace("def full", "def broken")
        for text in (twice, CASES.replace('grid={"k": [1, 2]}', 'grid={"k": [1, 1]}'), CASES.replace('seen": Shown', 'seen": str')):
            (root / FAMILY / "others.py").write_text(text)
            wrong += ["defined twice"] * (not refused(lambda: collect(root)))
            sys.modules.pop(f"{FAMILY}.others", None)
        (root / FAMILY / "others.py").write_text(CASES)
        wrong += ["named twice"] * (not refused(lambda: collect(root)))
    return told(wrong, way)


def refused(action: Callable[[], object]) -> bool:
    """Whether it is an error of what is given."""
    try:
        action()
    except InputError:
        return True
    return False


@case(
    claim="The page, JUnit's file and the data of a run hold every cell with its state, and of those that do not pass a failure each; the "
    "history holds every run, whatever was cut short before.",
    tier="gate",
    grid={"way": WAYS},
    bounds=BOUNDS,
)
def reported(way: str) -> dict[str, float]:
    """How much is told otherwise."""
    wrong = []
    bad = {name for name, state in STATES.items() if state != "passed"}
    with folder_of_cases() as root:
        results, runs, page = run(root, Here()), root.parent / "history.jsonl", root.parent / "report.html"
        for _ in range(2):
            history.append(runs, results)
        with runs.open("a") as file:
            file.write('{"when": "cut sh')
        history.append(runs, results)
        entries = history.read(runs)
        states = {name.partition("/")[2]: of["state"] for name, of in entries[-1].cells.items()} if entries else {}
        wrong += [f"{len(entries)} runs, {states}"] * (len(entries) != 3 or states != STATES)
        wrong += ["values"] * (history.values_of(entries, f"{FAMILY}/wrong", "other") != [1.5] * 3)
        lost = history.values_of(entries, f"{FAMILY}/wrong", "none") + history.values_of(entries, f"{FAMILY}/none", "error")
        wrong += ["values that are not there"] * (not np.isnan(lost).all() or len(lost) != 6)
        others = {name: of | {"state": "skipped"} for name, of in entries[0].cells.items()}
        for before, news in (([others], len(STATES)), ([others, entries[0].cells], 0), ([entries[0].cells, others], len(STATES)), ([], 0)):
            runs_before = [history.Entry("", "", cells) for cells in (*before, entries[0].cells)]
            told_news = report._news(results, report.Context("gate", "", 1.0, datetime.now(UTC), runs_before))
            changed = sum(line.count("skipped →") for _, lines in told_news for line in lines)
            wrong += [f"news: {told_news}"] * (changed != (news and news - 1))  # one of them is skipped anyway
        report.write(page, results, report.Context("gate", "", 1.0, datetime.now(UTC), entries))
        data = json.loads(page.with_suffix(".json").read_text())
        told_states = {cell["name"].partition("/")[2]: cell["state"] for cell in data["cells"]}
        counts = {state: [*STATES.values()].count(state) for state in STATES.values()}
        wrong += [f"data: {told_states}, {data['states']}"] * (told_states != STATES or data["states"] != counts)
        wrong += [f"left out: {data['left_out']}"] * (sorted(data["left_out"]) != [f"{FAMILY}/later[k={k}]" for k in (1, 2)])
        suite = ElementTree.parse(page.with_suffix(".xml")).getroot()[0]
        failed = {item.get("name", "").partition("/")[2] for item in suite if item.find("failure") is not None}
        wrong += [f"JUnit: {failed}"] * (failed != bad or suite.get("failures") != str(len(bad)) or suite.get("tests") != str(len(STATES)))
        text = page.read_text()
        wrong += [f"page: {name}" for name in bad if f"{FAMILY}/{name}" not in text]
        for number, steps in enumerate(
            ([1.0] * 9 + [2.0] * 3, [1.0, 1.0, 1.0, 5.0, 1.0, 1.0], [1.0, 1.01] * 6, [1.0] * 4 + [np.nan, 3.0, 3.0])
        ):
            found = history.change_points(steps)
            wrong += [f"changes {number}: {found}"] * (found != ([9], [], [], [5])[number])
        journal = Journal(root.parent / "kept.jsonl")
        journal.put("one", {"value": 1})
        journal.put("one", {"value": 2})
        again = Journal(root.parent / "kept.jsonl")
        wrong += ["journal"] * (again.get("one") != {"key": "one", "value": 2} or again.get("two") is not None or len(again.entries) != 2)
    return told(wrong, way)


@contextmanager
def here_alone(_: int) -> Iterator[Callable[[dict[str, Any]], Future[Measurement]]]:
    """In the place of measuring processes."""
    yield Here().submit


@case(
    claim="The command ends with 0 where every cell passes, with 1 where one does not, whatever it ended by, and with 2 where it is asked "
    "for what there is not.",
    tier="gate",
    bounds=BOUNDS,
)
def exit_codes() -> dict[str, float]:
    """How many exit codes are wrong."""
    wrong = []
    asked = {"same": 0, "later": 0, "late": 2, "other": 2} | dict.fromkeys(
        ("alone", "wrong", "absent", "unsolved", "broken", "skipping"), 1
    )
    with folder_of_cases() as root, mock.patch.object(runner, "local_processes", here_alone):
        places = ("--cases", str(root), "--references", str(root.parent / "references"), "--results", str(root.parent / "results"))
        for name, code in asked.items():
            found, said = program("verify", "--case", f"{FAMILY}/{name}", *places, folder=root.parent)
            wrong += [f"{name}: {found}, {said[-200:]}"] * (found != code)
        for words, code in ((("--tier", "gate"), 1), (("--tier", "daily"), 2)):
            found, said = program("verify", *words, *places, folder=root.parent)
            wrong += [f"{words}: {found}, {said[-200:]}"] * (found != code)
    return told(wrong, WAYS[0])
