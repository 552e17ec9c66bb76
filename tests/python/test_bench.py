"""Benchmarks: what a declaration must hold, the run in processes of their own, limits, slopes, page and history. Nothing here is timed."""

from __future__ import annotations

import json
import math
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from datetime import datetime
from pathlib import Path

import pytest

from isomortar import cli
from isomortar.errors import InputError
from isomortar.harness.bench import ASIDE, Plot, Row, benchmark, cpu_seconds, history
from isomortar.harness.bench.collection import collect, select
from isomortar.harness.bench.declaration import Benchmark
from isomortar.harness.bench.page import slope
from isomortar.harness.bench.processes import Answer, Cost, measure, run
from isomortar.harness.bench.standings import standings

COLUMNS = {"kind": "", "unknowns": "", "time": "ms"}

FILE = '''
import os
from isomortar.harness.bench import Plot, benchmark

@benchmark(
    question="Does it run?",
    columns={"kind": "", "unknowns": "", "time": "ms"},
    plots=(Plot("unknowns", "time", "kind"),),
    limits={"time": (50.0, "as <fast> as that")},
)
def steady(quick):
    """Nothing is measured."""
    print("this is not a row")
    for kind in ("N2", "N3"):
        for unknowns in (10, 100):
            yield {"kind": kind, "unknowns": unknowns, "time": float(unknowns)}
    yield {"kind": os.environ["OPENBLAS_NUM_THREADS"], "note": "apt-get install other"}

@benchmark(question="Does it crash?", columns={"n": ""})
def crashing(quick):
    yield {"n": 1}
    os.write(2, b"the last words")
    os._exit(3)
'''


def declared(rows: list[Row], **other: object) -> Benchmark:
    def function(_: bool) -> Iterator[Row]:
        yield from rows

    return benchmark(question="What?", columns=COLUMNS, **other)(function)  # type: ignore[arg-type]


@pytest.fixture
def cases(tmp_path: Path) -> Iterator[Path]:
    """A folder of benchmarks, its modules forgotten afterwards: those of the project have the same package name."""
    (tmp_path / "performance").mkdir()
    (tmp_path / "performance" / "some.py").write_text(FILE)
    path, known = list(sys.path), {name for name in sys.modules if name.startswith("performance")}
    hidden = {name: sys.modules.pop(name) for name in known}
    yield tmp_path
    sys.path[:] = path
    for name in [name for name in sys.modules if name.startswith("performance")]:
        del sys.modules[name]
    sys.modules.update(hidden)


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"question": "No question."}, "question"),
        ({"columns": {}}, "column"),
        ({"columns": {"note": ""}}, "note"),
        ({"plots": (Plot("unknowns", "speed"),)}, "speed"),
        ({"plots": (Plot("unknowns", "time", "order"),)}, "order"),
        ({"limits": {"speed": (1.0, "")}}, "speed"),
    ],
)
def test_a_wrong_declaration_is_refused(wrong: dict[str, object], said: str) -> None:
    with pytest.raises(InputError, match=said):
        benchmark(**{"question": "What?", "columns": COLUMNS, **wrong})(lambda _: iter(()))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "row", [{"kind": "N2", "unknowns": 3}, {"kind": "N2", "unknowns": 3, "time": 1.0, "speed": 2.0}, {"note": "x", "y": 1}]
)
def test_a_row_must_fit_its_columns(row: Row) -> None:
    found: list[Row] = []
    cost = measure(declared([{"kind": "N2", "unknowns": 1, "time": 1.0}, row]), True, found.append)
    assert len(found) == 1
    assert "the columns are kind, unknowns, time" in cost.message


def test_a_process_of_its_own_gives_the_rows(cases: Path) -> None:
    crashing, steady = collect(cases)
    told: list[Row] = []
    answer = run(steady, True, told.append)
    assert answer.rows == tuple(told)
    assert len(told) == 5
    assert told[-1] == {"kind": "1", "note": "apt-get install other"}
    assert not answer.failed
    assert answer.cost.peak_memory > 1e6
    crashed = run(crashing, True, told.append)
    assert crashed.rows == ({"n": 1},)
    assert "the last words" in crashed.cost.message
    assert "status 3" in crashed.cost.message


def test_names_select(cases: Path) -> None:
    both = collect(cases)
    assert [one.name for one in select(both, ["steady"])] == ["steady"]
    assert select(both, []) == both
    with pytest.raises(InputError, match="crashing, steady"):
        select(both, ["stedy"])
    with pytest.raises(InputError, match="no benchmarks"):
        collect(cases / "performance")


def test_limits_are_met_missed_or_not_measured() -> None:
    def states(*times: float | str | None) -> list[tuple[str, float]]:
        rows = [{"kind": "N2", "unknowns": k, **({"note": "no"} if time is None else {"time": time})} for k, time in enumerate(times)]
        answer = Answer(declared([], limits={"time": (2.0, "why")}), tuple(rows), Cost())  # type: ignore[arg-type]
        return [(standing.state, standing.worst) for standing in standings(answer)]

    assert states(1.0, 2.0) == [("met", 2.0)]
    assert states(1.0, 2.5, None) == [("missed", 2.5)]
    assert states(ASIDE, 1.0) == [("met", 1.0)]  # the program itself, beside the other
    assert states(ASIDE, 1.0, None) == [("not compared", 1.0)]  # one of two others is not installed
    assert states(ASIDE, None)[0][0] == states(None)[0][0] == "not compared"
    assert states(ASIDE, 3.0, None) == [("missed", 3.0)]
    assert states(3.0, math.nan) == [("missed", 3.0)]
    assert states(3.0, -0.1) == [("missed", 3.0)]
    assert states(1.0, -0.1) == states(1.0, -math.inf) == [("not measured", 1.0)]  # no cost, share or error is below zero
    assert states(1.0, math.nan)[0][0] == states()[0][0] == states(ASIDE)[0][0] == "not measured"


@pytest.mark.parametrize(
    ("rows", "message"),
    [([{"kind": "N2", "unknowns": 1, "time": 1.0}], "it broke off"), ([{"kind": "N2", "unknowns": 1, "note": "no"}], "x"), ([], "")],
)
def test_a_benchmark_that_did_not_come_to_its_end_or_measured_nothing_meets_nothing(rows: list[Row], message: str) -> None:
    answer = Answer(declared([], limits={"time": (2.0, "why")}), tuple(rows), Cost(message=message))  # type: ignore[arg-type]
    assert answer.failed
    assert [standing.state for standing in standings(answer)] == ["not measured"]


def test_slope_is_the_power() -> None:
    assert slope([1, 2, 5], [3.0, 12.0, 75.0]) == pytest.approx(2.0)
    assert math.isnan(slope([4, 4], [1.0, 2.0]))
    assert math.isnan(slope([4], [1.0]))
    assert slope([1, 2, 5], [3.0, 0.0, 75.0]) == pytest.approx(2.0)


def test_cpu_seconds_repeats_short_work_and_drops_the_first_compilation() -> None:
    calls: list[int] = []
    middle, least = cpu_seconds(lambda: calls.append(1), 5)
    assert len(calls) == 5
    assert 0.0 <= least <= middle


def test_rows_are_known_by_what_comes_before_their_first_number() -> None:
    assert history.label({"kind": "N2", "unknowns": 3, "time": 1.5, "more": 4}) == "N2, 3"
    assert history.label({"kind": "N2", "note": "no"}) == "N2"


def bench(*words: str, monkeypatch: pytest.MonkeyPatch) -> int:
    monkeypatch.setattr(sys, "argv", ["isomortar", "bench", *words])
    with pytest.raises(SystemExit) as ended:
        cli.main()
    return int(ended.value.code or 0)


def test_command_writes_page_numbers_and_history(cases: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    out = cases / "out"
    words = ("--cases", str(cases), "--out", str(out))
    assert bench("steady", *words, monkeypatch=monkeypatch) == bench("steady", *words, monkeypatch=monkeypatch) == 0
    printed = capsys.readouterr()
    assert "time missed: 100 (N3, 100), at most 50" in printed.out
    assert "kind N3  unknowns 10  time 10" in printed.err
    data = json.loads((out / "bench.json").read_text())
    assert [one["dgemm"] > 0.1 for one in data["limits"]] == [True, True]
    assert data["benchmarks"][0]["limits"][0]["state"] == "missed"
    page = (out / "bench.html").read_text()
    assert "as &lt;fast&gt; as that" in page
    assert "N2: slope 1.00" in page
    assert 'class="spark"' in page
    assert page.count(">missed</span>") == 4
    assert len((out / "history.jsonl").read_text().splitlines()) == 2

    assert bench("--quick", *words, monkeypatch=monkeypatch) == 1
    page = (out / "bench.html").read_text()
    assert "crashing did not come to the end" in page
    assert "the last words" in page
    assert len((out / "history.jsonl").read_text().splitlines()) == 2
    assert bench("stedy", *words, monkeypatch=monkeypatch) == 2


def test_history_survives_a_line_that_was_cut_short(tmp_path: Path) -> None:
    path = tmp_path / "history.jsonl"
    path.write_text('{"benchmark": "a", "rows": {"N2": {"time": 1.0}}}\n{"benchmark": "b", "rows": {}}\n{"benchm')
    assert history.read(path, "a").values("N2", "time") == [1.0]
    assert history.read(tmp_path / "none", "a").runs == ()
    path.write_text(path.read_text() + "\n")
    whole = len(path.read_text().splitlines())
    path.write_text(path.read_text()[:-1])
    ran = Answer(declared([]), ({"kind": "N2", "time": 2.0},), Cost())
    history.append(path, ran, datetime.now().astimezone())
    assert len(path.read_text().splitlines()) == whole + 1
    assert history.read(path, ran.benchmark.name).values("N2", "time") == [2.0]
    for number in range(history._SHOWN):
        history.append(path, Answer(declared([]), ({"kind": "N3", "time": float(number)},), Cost()), datetime.now().astimezone())
    assert history.read(path, ran.benchmark.name).values("N3", "time") == list(range(history._SHOWN))
    assert all(map(math.isnan, history.read(path, ran.benchmark.name).values("N2", "time")))


SLEEPING = """
import os, time
from isomortar.harness.bench import benchmark

@benchmark(question="Does it sleep?", columns={"process": ""})
def sleeping(quick):
    yield {"process": os.getpid()}
    time.sleep(600.0)
"""


def test_ctrl_c_ends_a_benchmark_with_the_process_that_it_runs_in(cases: Path) -> None:
    (cases / "performance" / "slow.py").write_text(SLEEPING)
    heard = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); from isomortar.cli import main; main()"
    words = ["bench", "sleeping", "--quick", "--cases", str(cases), "--out", str(cases / "out")]
    with subprocess.Popen([sys.executable, "-c", heard, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        (measuring,) = next(found for line in process.stderr if (found := re.findall(r"process (\d+)", line)))
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "Traceback" not in said
    assert not Path("/proc", measuring).exists()
