"""Planted faults: how they are read, drawn, remembered and counted; and a campaign with a real kernel."""

import json
import math
import re
import tomllib
from pathlib import Path

import pytest
from sanitizers import tools
from typer.testing import CliRunner

from isomortar.cli.commands import app
from isomortar.errors import InputError
from isomortar.harness.collection import collect
from isomortar.harness.journal import Journal
from isomortar.harness.measurement import Measurement
from isomortar.harness.mutants import build, report
from isomortar.harness.mutants.bench import Bench, freeze
from isomortar.harness.mutants.campaign import Attacked, Campaign, Tally
from isomortar.harness.mutants.faults import fault_at, read_planted
from isomortar.harness.mutants.gate import Finding
from isomortar.harness.mutants.generate import draw
from isomortar.harness.mutants.layers import LAYERS
from isomortar.harness.mutants.meaning import meaning
from isomortar.harness.mutants.score import Classification, Score, Share, read_classified

ROOT = Path(__file__).parents[2]
TEXT = "!> Doubles - it.\nfunction twice(x)\n  real :: x, twice\n  twice = 2 * x - 1\n  twice = 2 * x - 1\nend function\n"
SOURCES = {"solid/twice.f90": TEXT}


def planted(folder: Path, **changes: str) -> Path:
    entry = {"name": "n", "file": "solid/twice.f90", "old": "real :: x, twice", "new": "integer :: x, twice", "why": "w"} | changes
    path = folder / "planted.toml"
    path.write_text("[[fault]]\n" + "".join(f"{k} = {json.dumps(v)}\n" for k, v in entry.items()))
    return path


def attacked(number: int, killer: str | None = None, name: str = "") -> Attacked:
    return Attacked(fault_at("solid/a.f90", TEXT, number, TEXT[number], "?", name), Finding(killer, "red", ()), True)


def score(*faults: Attacked, classified: dict[str, Classification] | None = None) -> Score:
    return Score(Tally(faults, {}, (), {"solid/a": 1.0}), classified or {}, 0.9)


@pytest.mark.parametrize("layer", LAYERS.values(), ids=LAYERS)
def test_the_faults_planted_by_hand_fit_the_sources(layer):
    found = read_planted(ROOT / "verification/planted_faults.toml", layer.read(ROOT), layer.suffix)
    assert len(found) >= 10
    assert len({fault.key for fault in found}) == len(found)


def test_survivors_that_are_classified_stand_in_the_sources():
    sources = {file: text for layer in LAYERS.values() for file, text in layer.read(ROOT).items()}
    entries = tomllib.loads((ROOT / "verification/surviving_mutants.toml").read_text())["survivor"]
    gone = [entry["key"] for entry in entries if entry["old"] not in sources[entry["place"].partition(":")[0]]]
    assert not gone


@pytest.mark.parametrize("layer", LAYERS.values(), ids=LAYERS)
def test_files_without_faults_exist_and_no_folder_of_the_kernel_is_forgotten(layer):
    folder = ROOT / layer.folder
    assert all((folder / file).is_file() for file in layer.left_out)
    if layer.name == "kernel":
        assert set(layer.parts) == {path.name for path in folder.iterdir() if path.is_dir()}


def test_what_the_build_reads_is_copied_with_the_sources_of_the_kernel():
    builds = (ROOT / file for file in ("meson.build", "fortran/meson.build"))
    named = {Path(name).name for file in builds for name in re.findall(r"'\S*tools/(\S+?)'", file.read_text())}
    assert named
    for copied in (build._PARTS, tools._PARTS):
        assert named <= {Path(part).name for part in copied}


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"old": "twice = 2 * x - 1"}, "stands 2 times"),
        ({"old": "nothing"}, "stands 0 times"),
        ({"file": "base/kinds.f90"}, "no source"),
        ({"file": "solid/twice.c"}, "no source"),
        ({"extra": "x"}, "needs name"),
    ],
)
def test_a_planted_fault_that_does_not_fit_is_an_error(tmp_path, changes, words):
    with pytest.raises(InputError, match=words):
        read_planted(planted(tmp_path, **changes), SOURCES, ".f90")


def test_a_list_without_faults_is_an_error(tmp_path):
    (tmp_path / "planted.toml").write_text("fault = []\n")
    with pytest.raises(InputError, match="holds no"):
        read_planted(tmp_path / "planted.toml", SOURCES, ".f90")


def test_a_planted_fault_is_applied_where_it_stands(tmp_path):
    (fault,) = read_planted(planted(tmp_path), SOURCES, ".f90")
    assert fault.applied(TEXT) == TEXT.replace("real :: x", "integer :: x")
    assert fault.place == "solid/twice.f90:3"


def test_like_lines_have_keys_of_their_own_that_lines_above_do_not_change():
    line = "  twice = 2 * x - 1"
    first, second = TEXT.index(line), TEXT.rindex(line)
    keys = [fault_at("a", TEXT, at, line, "new").key for at in (first, second)]
    assert len(set(keys)) == 2
    assert fault_at("a", "! above\n" + TEXT, first + 8, line, "new").key == keys[0]


def test_drawn_faults_are_changes_of_statements_in_the_order_of_the_seed():
    kernel = LAYERS["kernel"]
    drawn = draw(kernel, SOURCES, 1)
    assert [f.key for f in drawn] == [f.key for f in draw(kernel, SOURCES, 1)]
    assert [f.key for f in drawn] != [f.key for f in draw(kernel, SOURCES, 2)]
    assert {f.line for f in drawn} <= {2, 4, 5}
    assert any(f.new == "  twice = 2 * x + 1" and f.applied(TEXT).splitlines()[3] == f.new for f in drawn)
    assert all(f.applied(TEXT) != TEXT for f in drawn)


def test_a_folder_without_sources_is_an_error(tmp_path):
    with pytest.raises(InputError, match="checkout"):
        LAYERS["kernel"].read(tmp_path)


def test_a_campaign_may_keep_to_files_and_folders():
    python = LAYERS["python"]
    sources = python.read(ROOT)
    inside = python.within(sources, ["model/enforcement", "model/glue.py"])
    assert inside.keys() == {file for file in sources if file.startswith("model/enforcement/") or file == "model/glue.py"}
    assert python.within(sources, []) == sources
    with pytest.raises(InputError, match=r"'model/enforce'.*an example: accuracy/"):
        python.within(sources, ["model", "model/enforce"])


@pytest.mark.parametrize("torn", ['{"key": "b", "val', '{"key": "\u00e4'.encode()[:-1], '"'])
def test_a_journal_that_was_cut_short_goes_on(tmp_path, torn):
    path = tmp_path / "journal.jsonl"
    Journal(path).put("a", {"value": 1})
    with path.open("ab") as file:
        file.write(torn if isinstance(torn, bytes) else torn.encode())
    journal = Journal(path)
    assert journal.get("a") == {"key": "a", "value": 1}
    assert journal.get("b") is None
    journal.put("c", {"value": 3})
    assert Journal(path).get("c") == {"key": "c", "value": 3}


def test_wilson_interval():
    low, high = Share(270, 300).interval
    assert low == pytest.approx(0.8608, abs=1e-4)
    assert high == pytest.approx(0.9291, abs=1e-4)
    assert Share(0, 0).interval == (0.0, 1.0)


def test_the_score_fails_closed():
    nine = [attacked(i, "solid/a") for i in range(9)]
    hand = attacked(20, "solid/a", "hand")
    assert score(hand, *nine, attacked(9)).passes
    assert not score(hand, *nine[:8], attacked(9)).passes
    assert not score(attacked(20, None, "hand"), *nine).passes
    assert not score().passes


def test_equivalent_survivors_are_counted_apart():
    one = attacked(1)
    counted = score(attacked(0, "solid/a"), one, classified={one.fault.key: Classification("equivalent", "why")})
    assert (counted.caught.part, counted.caught.whole) == (1, 2)
    assert (counted.caught_of_real.part, counted.caught_of_real.whole) == (1, 1)
    assert counted.passes
    assert not score(attacked(0, "solid/a"), one, classified={one.fault.key: Classification("precision only", "why")}).passes


def test_shares_are_told_by_folder():
    one = attacked(1)
    counted = score(attacked(0, "solid/a"), one, classified={one.fault.key: Classification("equivalent", "why")})
    ((folder, (found, real)),) = counted.caught_by_folder.items()
    assert (folder, found.part, found.whole, real.part, real.whole) == ("solid", 1, 2, 1, 1)


@pytest.mark.parametrize(
    ("entry", "words"), [('key="k"\nclass="fine"\nreason="r"', "allowed"), ('key="k"\nclass="equivalent"\nreason=" "', "needs")]
)
def test_a_classification_needs_a_class_and_a_reason(tmp_path, entry, words):
    path = tmp_path / "survivors.toml"
    path.write_text(f"[[survivor]]\n{entry}\n")
    with pytest.raises(InputError, match=words):
        read_classified(path)


def test_the_report_shows_survivors_and_asks_for_their_class(tmp_path):
    known, open_one = attacked(1), attacked(2)
    counted = score(
        attacked(0, "solid/a"), known, open_one, classified={known.fault.key: Classification("not caught", "no cell looks there")}
    )
    report.write(tmp_path / "report.html", counted, {"sample": 3})
    page, data = (tmp_path / "report.html").read_text(), json.loads((tmp_path / "report.json").read_text())
    assert "no cell looks there" in page
    assert f'key = "{open_one.fault.key}"' in report.unclassified(counted)
    assert f'key = "{known.fault.key}"' not in report.unclassified(counted)
    assert [fault["class"] for fault in data["faults"]] == [None, "not caught", "not classified"]
    assert not data["passes"]


def test_what_is_not_executed_has_no_meaning():
    text = '''"""One."""\nx: int = 1\ndef f(a: int, /, b: int = 2) -> int:\n    """Two."""\n    return a + b  # three\n'''
    for same in (("One", "1"), ("Two", "2"), ("three", "3"), ("a: int", "a: str"), ("-> int", "-> str"), ("x: int", "x: str")):
        assert meaning(text.replace(*same)) == meaning(text)
    assert meaning(text.replace('"""Two."""', "pass")) == meaning(text)
    for other in (("a + b", "a - b"), ("= 1", "= 2"), ("b: int = 2", "b: int = 3")):
        assert meaning(text.replace(*other)) != meaning(text)


LAID_CASE = """
from isomortar.geometry import quadrature
from isomortar.harness import Bound, case

@case(claim="What a file holds.", bounds={"held": Bound(at_most=1.0, reason="definition: so")})
def held():
    return {"held": getattr(quadrature, "HELD", 0.0)}
"""


def test_cells_read_nothing_beside_the_cases_which_a_campaign_copies_alone():
    """What keeps fronts, builds with sanitizers and runs other programs is no cell that a campaign asks."""
    assert _looking_beside() == ["keep_front.py", "performance/peers/programs.py", "sanitizers/tools.py"]


def _looking_beside() -> list[str]:
    """Modules of cases that go further up than to the folder of all."""
    cases = ROOT / "verification"
    names = {path: path.relative_to(cases) for path in sorted(cases.rglob("*.py"))}
    ups = {path: re.findall(r"__file__\)[.\w()]*\.parents\[(\d)\]", path.read_text(encoding="utf-8")) for path in names}
    return [str(name) for path, name in names.items() if any(int(up) >= len(name.parts) for up in ups[path])]


def test_one_fault_after_the_other_is_laid_over_the_package_and_taken_away(tmp_path):
    family = tmp_path / "cases" / "mutants_laid"
    family.mkdir(parents=True)
    (family / "mutants_laid_cases.py").write_text(LAID_CASE)
    (cell,) = [cell for case in collect(family.parent) for cell in case.cells]
    package, cases = freeze(family.parent, tmp_path / "frozen")
    sound, programs = tmp_path / "sound", [tmp_path / "one", tmp_path / "two"]
    sound.mkdir()
    for program, angle in zip(programs, ("0.50", "0.25"), strict=True):
        (program / "geometry").mkdir(parents=True)
        (program / "geometry/quadrature.py").write_text(f"HELD = {angle}\n")
    with Bench(package, cases, tmp_path / "bench") as bench:
        found = [bench.measure(program, cell, 60.0).numbers for program in (sound, *programs, sound)]
    assert [value["held"] for value in found] == [0.0, 0.5, 0.25, 0.0]


KERNEL_CASE = """
import numpy as np
from isomortar._compiled import kernel
from isomortar.harness import Bound, case

@case(claim="A line of order one.", bounds={"error": Bound(at_most=1e-15, reason="round-off: a sum")})
def precision():
    digits, spacing = kernel.working_precision()
    return {"error": abs(spacing - np.finfo(float).eps)}

@case(claim="A stale handle is refused.", bounds={"status": Bound(at_least=6, at_most=6, reason="definition: stale")})
def stale():
    return {"status": kernel.sparse_release(12345)}
"""
STALE = """
[[fault]]
name = "stale handles are released"
file = "sparse/handles.f90"
old = "    slot = slot_of(handle)\\n    status = status_stale_handle\\n    if (slot == slots) return\\n    call forget"
new = "    slot = slot_of(handle)\\n    status = status_ok\\n    if (slot == slots) return\\n    call forget"
why = "a handle that is none"

[[fault]]
name = "another dense limit"
file = "sparse/lu.f90"
old = "dense_limit = 1.0e3_c_double"
new = "dense_limit = 1.0e2_c_double"
why = "no case of this folder sees it"
"""


@pytest.mark.parametrize("ending", ["trouble", "refused", "crashed", "timed out"])
def test_that_the_machine_failed_is_not_kept_of_the_sound_program(tmp_path, monkeypatch, ending):
    family = tmp_path / "cases" / f"mutants_{ending[:6]}"
    family.mkdir(parents=True)
    (family / f"mutants_{ending[:6]}_cases.py").write_text(KERNEL_CASE)
    cells = [cell for case in collect(family.parent) for cell in case.cells]
    asked = []

    def measure(_, __, cell, ___):
        asked.append(cell.name)
        if cell.name.endswith("precision"):
            return Measurement("measured", {"error": 0.0})
        return Measurement(ending, {}, "no memory") if asked.count(cell.name) == 1 else Measurement("measured", {"status": 6.0})

    monkeypatch.setattr(Bench, "measure", measure)
    seen = []
    for _ in range(3):
        with Campaign(LAYERS["python"], ROOT, family.parent, cells, lambda *_: None, tmp_path / "work", 1, lambda *_: None) as campaign:
            seen.append(campaign.run([], [], 0, math.inf).unused)
    assert ["stale" in " ".join(unused) for unused in seen] == [True, False, False]
    assert sorted(name.partition("/")[2] for name in asked) == ["precision", "stale", "stale"]


def test_a_survivor_whose_patience_is_spent_meets_what_is_new(tmp_path, monkeypatch):
    cases, asked = tmp_path / "cases", []

    def family(name: str) -> None:
        (cases / f"mutants_{name}").mkdir(parents=True)
        (cases / f"mutants_{name}" / f"mutants_{name}_cases.py").write_text(LAID_CASE)

    def measure(_, program, cell, __):
        asked.append((program.name, cell.name))
        return Measurement("measured", {"held": 0.0}, cpu_seconds=1.0)

    def survivors() -> list[str]:
        """What the fault meets in one more campaign."""
        asked.clear()
        cells = [cell for case in collect(cases) for cell in case.cells]
        with Campaign(python, ROOT, cases, cells, lambda *_: None, tmp_path / "work", 1, lambda *_: None) as campaign:
            tally = campaign.run([], [fault], 1, 0.5)
        assert [attacked.finding.killer for attacked in tally.attacked] == [None]
        return [cell for program, cell in asked if program not in ("sound", "scouted")]

    monkeypatch.setattr(Bench, "measure", measure)
    python = LAYERS["python"]
    text = python.read(ROOT)["geometry/quadrature.py"]
    fault = fault_at("geometry/quadrature.py", text, text.index("return "), "return ", "return not ")
    family("one")
    family("two")
    assert len(survivors()) == 1, "half a second is patience for one cell"
    assert survivors() == []
    family("three")
    assert survivors() == ["mutants_three/held"]
    assert survivors() == []
    for journal in (tmp_path / "work" / f"{name}.jsonl" for name in ("verdicts", "sound")):  # as they were kept before that was known
        entries = [json.loads(line) for line in journal.read_text().splitlines()]
        older = [{key: value for key, value in entry.items() if key not in ("cells", "number")} for entry in entries]
        journal.write_text("".join(json.dumps(entry) + "\n" for entry in older))
    assert survivors() == []
    family("four")
    assert survivors() == ["mutants_four/held"]


@pytest.mark.nightly  # builds the kernel four times: a tenth of the whole gate
def test_a_campaign_with_a_real_kernel(tmp_path, monkeypatch):
    monkeypatch.chdir(ROOT)
    family = tmp_path / "cases" / "mutants_real"
    family.mkdir(parents=True)
    (family / "mutants_real_cases.py").write_text(KERNEL_CASE)
    (tmp_path / "cases" / "planted_faults.toml").write_text(STALE)
    command = ["mutants", "--sample", "0", "-j", "2", "--cases", str(tmp_path / "cases"), "--results", str(tmp_path / "results")]
    run = CliRunner().invoke(app, command)
    assert run.exit_code == 1, run.output
    data = json.loads((tmp_path / "results/kernel/report.json").read_text())
    fates = {fault["name"]: fault["killer"] for fault in data["faults"]}
    assert fates == {"stale handles are released": "mutants_real/stale", "another dense limit": None}
    before = (tmp_path / "results/kernel/verdicts.jsonl").read_text()
    CliRunner().invoke(app, command)
    assert (tmp_path / "results/kernel/verdicts.jsonl").read_text() == before, "what is known was measured again"
