"""The command line and the public Python interface, on scenes of a second or less."""

from __future__ import annotations

import io
import json
import re
import signal
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

import isomortar
from isomortar import cli
from isomortar.cli.progress import LiveProgress
from isomortar.model import constants
from isomortar.results.writer import ResultsWriter
from isomortar.solve.record import IterationRecord, StepResult

SMALL = ("bodies.block.mesh.elements=[3,3,2]", "stages.press.steps=3")
README = Path(__file__).parents[2] / "README.md"

Invoke = Callable[..., tuple[int, str, str]]


@pytest.fixture
def invoke(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Invoke:
    """Runs a command line in an empty folder; exit code, stdout, stderr."""
    monkeypatch.chdir(tmp_path)

    def invoke(*words: str) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["isomortar", *words])
        with pytest.raises(SystemExit) as ended:
            cli.main()
        printed = capsys.readouterr()
        return int(ended.value.code or 0), printed.out, printed.err

    return invoke


def settings(values: Sequence[str]) -> list[str]:
    return [word for value in values for word in ("--set", value)]


def last(path: str | Path) -> StepResult:
    with isomortar.Results(path) as results:
        step = results.last_step()
    assert step is not None
    return step


def assert_same(one: StepResult, other: StepResult) -> None:
    """Equal to round-off."""
    assert one.step == other.step
    scale = np.linalg.norm(other.reactions[0].force)
    assert np.linalg.norm(one.reactions[0].force - other.reactions[0].force) < 1e-11 * scale > 0.0
    np.testing.assert_allclose(one.state.positions, other.state.positions, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(one.state.contacts[0].pressure, other.state.contacts[0].pressure, rtol=0.0, atol=1e-11 * scale)


#: A block pressed down, and contacts of its faces.
SQUEEZED = """
format = 1
bodies.block = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh = { order = [2, 2, 2], elements = [2, 2, 2] } }
supports = { top.face = "block.w1", base = { face = "block.v0", components = ["y"] } }
"""
PLANES = [("w0", "point = [0, 0, 0]"), ("u0", "point = [0, 0, 0], normal = [1, 0, 0]")]
SQUEEZING = 'stages = [{ name = "press", steps = 2, motions.top.translate = [0, 0, -0.1] }]\n'


def test_scene_to_curves_and_pictures(invoke: Invoke) -> None:
    code, out, err = invoke("run", "press", *settings(SMALL))
    assert (code, out) == (0, "results/press.h5\n")
    assert "step 3/3" in err
    assert "active" in err
    code, out, _ = invoke("plot", "results/press.h5")
    paths = [Path(line) for line in out.splitlines()]
    assert code == 0
    assert {path.parent for path in paths} == {Path("results/press-plots")}
    assert {"reactions-top.png", "pressure-floor.png", "bodies-floor.png"} <= {path.name for path in paths}
    assert all(path.stat().st_size > 1000 for path in paths)
    code, out, _ = invoke("export", "results/press.h5")
    assert (code, out) == (0, "results/press-paraview/press.pvd\n")
    assert Path(out.strip()).is_file()


@pytest.mark.parametrize("contacts", [0, 1, 2])
def test_runs_end_well_with_any_number_of_contacts(invoke: Invoke, contacts: int) -> None:
    lines = [
        f'contacts.c{k} = {{ slave = "block.{face}", plane = {{ {plane} }}, friction = 0 }}\n' for k, (face, plane) in enumerate(PLANES)
    ]
    Path("scene.toml").write_text(SQUEEZED + "".join(lines[:contacts]) + SQUEEZING)
    code, _, err = invoke("run", "scene.toml")
    assert code == 0, err
    assert "2 load steps done, 0 warnings" in err
    for command in ("plot", "export"):
        code, _, err = invoke(command, "results/scene.h5")
        assert code == 0, err
    code, _, err = invoke("run", "scene.toml", "--resume")
    assert (code, "all 2 load steps are there already" in err) == (0, True), err


def test_set_changes_the_scene(invoke: Invoke) -> None:
    for name, friction in (("rough", "0.9"), ("smooth", "0")):
        assert invoke("run", "press", *settings([*SMALL, f"contacts.floor.friction={friction}"]), "--output", f"{name}.h5")[0] == 0
    assert last("smooth.h5").contacts[0].slip == 0 == last("smooth.h5").contacts[0].traction_norm.max()
    assert last("rough.h5").contacts[0].traction_norm.max() > 0.0


def test_costs_are_told_on_demand(invoke: Invoke) -> None:
    """Of all load steps of the results, those computed before included."""
    code, out, err = invoke("run", "press", *settings(SMALL), "--quiet", "--cost")
    assert (code, out) == (0, "results/press.h5\n")
    with isomortar.Results("results/press.h5") as results:
        points, seconds = int(results.counters()["contact points"].sum()), results.timings()["total"].sum()
    words = [line.split("  ") for line in err.splitlines()]
    assert ["contact points", f"{points:,}".replace(",", " ")] in [[w.strip() for w in line if w.strip()][:2] for line in words]
    assert f"total             {seconds:.3f}" in err
    assert "cold projections" not in err
    again = invoke("run", "press", *settings(SMALL), "--quiet", "--resume", "--cost")[2]
    assert again[again.index("phase") :] == err[err.index("phase") :]


def test_existing_results_are_kept_resumed_or_overwritten(invoke: Invoke) -> None:
    small = settings(SMALL)
    code, out, err = invoke("run", "press", *small, "--quiet")
    assert (code, out) == (0, "results/press.h5\n")
    assert "step 1" not in err
    before = Path("results/press.h5").read_bytes()
    code, out, err = invoke("run", "press", *small)
    assert (code, out) == (2, "")
    assert all(word in err for word in ("results/press.h5", "--resume", "--overwrite", "--output"))
    code, _, err = invoke("run", "press", *small, "--resume")
    assert code == 0
    assert "all 3 load steps are there already" in err
    code, _, err = invoke("run", "press", *small, "--set", "contacts.floor.friction=0.1", "--resume")
    assert code == 1
    assert "contacts.floor.friction: 0.3 in the file, 0.1 in the scene" in err
    assert Path("results/press.h5").read_bytes() == before
    assert invoke("run", "press", *small, "--resume", "--overwrite")[0] == 2
    assert invoke("run", "press", *settings(SMALL[:1]), "--set", "stages.press.steps=1", "--overwrite")[0] == 0
    assert last("results/press.h5").step == 1


class Interrupts(isomortar.Observer):
    """Presses Ctrl-C in the middle of a load step."""

    def __init__(self, step: int) -> None:
        self.step = step

    def iteration(self, step: int, time: float, augmentation: int, record: object) -> None:
        if step == self.step and getattr(record, "iteration", 0) == 2:
            raise KeyboardInterrupt


def test_interrupted_run_resumes_to_the_same_numbers(tmp_path: Path) -> None:
    scene = isomortar.Scene.load("press", SMALL)
    isomortar.run(scene, tmp_path / "whole.h5").close()
    for step in (1, 3):
        with pytest.raises(KeyboardInterrupt):
            isomortar.run(scene, tmp_path / "parts.h5", Interrupts(step), resume=True)
        with isomortar.Results(tmp_path / "parts.h5") as results:
            assert len(results.steps) == step - 1
    with isomortar.run(scene, tmp_path / "parts.h5", resume=True) as results:
        assert list(results.steps) == [1, 2, 3]
    assert_same(last(tmp_path / "parts.h5"), last(tmp_path / "whole.h5"))


def test_a_scene_file_that_was_renamed_moved_or_commented_on_is_resumed(invoke: Invoke) -> None:
    text = isomortar.Scene.load("press").to_toml().replace('name = "press"\ntitle', "title")
    Path("one.toml").write_text(text)
    small = settings(SMALL)
    assert invoke("run", "one.toml", *small, "--output", "one.h5")[0] == 0
    Path("elsewhere").mkdir()
    Path("elsewhere/two.toml").write_text(f"# said later\n{text}")
    code, _, err = invoke("run", "elsewhere/two.toml", *small, "--output", "one.h5", "--resume")
    assert (code, "all 3 load steps are there already" in err) == (0, True)


def test_ctrl_c_says_how_to_go_on(tmp_path: Path) -> None:
    # A shell starts background jobs with SIGINT ignored, and children inherit that.
    heard = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); from isomortar.cli import main; main()"
    command = [sys.executable, "-c", heard, "run", "iron", "--output", "iron.h5"]
    with subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        assert any(line.startswith("step  1/50") for line in process.stderr)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert out == ""
    assert "iron.h5" in err
    assert "--resume" in err
    assert "Traceback" not in err
    isomortar.Results(tmp_path / "iron.h5").close()


def test_live_progress_shows_where_the_run_is() -> None:
    text = io.StringIO()
    console = Console(file=text, width=80)
    problem = isomortar.Scene.load("iron").problem()
    progress = LiveProgress(problem, console.print)
    progress.started(50, 12)
    progress.iteration(12, 11.5, 2, IterationRecord(3, 1.5e-7, 9, 4, 5))
    console.print(progress)
    shown = text.getvalue()
    for part in ("11/50", "elapsed 0:00", "drag: step 12/50", "load time 11.5", "augmentation 2", "iteration 3", "1.5e-07"):
        assert part in shown
    assert "active 9  stick 4  slip 5" in shown


STAMP = re.compile(r"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d\.\d{3} ")


def test_every_iteration_is_told_and_kept_on_demand(invoke: Invoke, monkeypatch: pytest.MonkeyPatch) -> None:
    """What --verbose tells is what --log keeps, and what the results file holds."""
    monkeypatch.setattr(constants, "DENSE_SHARE", 0.0)  # general systems, which have an ordering to tell
    _, _, told = invoke("run", "press", *settings(SMALL), "--verbose", "--log", "logs/press.log")
    kept = Path("logs/press.log").read_text().splitlines()
    assert all(STAMP.match(line) for line in kept)
    first, *lines = (STAMP.sub("", line, count=1) for line in kept)
    assert first.startswith(f"isomortar {isomortar.__version__}: ")
    assert "--log logs/press.log" in first
    assert lines == told.splitlines()
    with isomortar.Results("results/press.h5") as results:
        for step in map(results.step, results.steps):
            log = step.augmentations[0].iterations
            expected = [f"iteration {i.iteration}, residual {i.residual:.1e}; active {i.active} (stick {i.stick}, slip" for i in log]
            found = [line for line in lines if f"  step {step.step}, load time {step.step}: iteration" in line]
            assert len(found) == len(expected)
            assert all(words in line for words, line in zip(expected, found, strict=True))
    effort = [line for line in lines if "increments 1, cuts 0, next increment 1 step" in line]
    assert len(effort) == 3
    assert all(word in effort[-1] for word in ("ordered by", "solid ", "total "))


def test_a_log_goes_on_and_has_what_ended_a_run(invoke: Invoke) -> None:
    uzawa = settings([*SMALL, "solver.method=uzawa", "solver.max_augmentations=1", "solver.max_cuts=1"])
    code, _, told = invoke("run", "press", *uzawa, "--quiet", "--log", "press.log")
    assert code == 1
    assert "iteration" not in told
    assert "isomortar: load step 1" in told
    assert "stopped with 0 of 3 load steps done\n" in told
    kept = Path("press.log").read_text()
    assert "augmentation 1 changed pressures by" in kept
    assert "load increment to 1 failed, cut to 1/2 step" in kept
    assert "ConvergenceError: load step 1" in kept
    assert invoke("run", "press", *settings(SMALL), "--quiet", "--log", "press.log")[:2] == (0, "results/press.h5\n")
    assert Path("press.log").read_text().startswith(kept)
    assert "3 load steps done, 1 warning" in Path("press.log").read_text().splitlines()[-1]


def test_a_log_does_not_go_into_results(invoke: Invoke) -> None:
    assert invoke("run", "press", *settings(SMALL), "--quiet")[0] == 0
    before = Path("results/press.h5").read_bytes()
    code, _, err = invoke("run", "press", *settings(SMALL), "--log", "results/press.h5", "--output", "other.h5")
    assert (code, "log: results/press.h5 is a results file: name another one" in err) == (2, True)
    assert Path("results/press.h5").read_bytes() == before


def test_a_log_does_not_go_into_the_scene_or_where_results_will_be(invoke: Invoke) -> None:
    scene = isomortar.Scene.load("press", SMALL).to_toml()
    Path("mine.toml").write_text(scene)
    for log, what in (("mine.toml", "scene file"), ("./mine.toml", "scene file"), ("mine.h5", "results file")):
        code, _, err = invoke("run", "mine.toml", "--log", log, "--output", "mine.h5")
        assert (code, f"log: {Path(log)} is the {what} of this run: name another one" in err) == (2, True)
    assert Path("mine.toml").read_text() == scene
    assert not Path("mine.h5").exists()


def test_a_log_that_cannot_be_written_is_named(invoke: Invoke) -> None:
    code, _, err = invoke("run", "press", *settings(SMALL), "--quiet", "--log", "/dev/full")
    assert (code, "isomortar: /dev/full cannot be written: No space left on device" in err) == (1, True)


def test_loud_and_quiet_at_once_is_refused(invoke: Invoke) -> None:
    code, _, err = invoke("run", "press", "--quiet", "--verbose")
    assert (code, "--log" in err) == (2, True)


def test_a_dry_run_says_what_check_says_and_leaves_nothing(invoke: Invoke) -> None:
    assert invoke("run", "twist", "--dry-run") == invoke("check", "twist")
    assert not list(Path().iterdir())


def test_step_that_cannot_be_cut_ends_with_what_was_done(invoke: Invoke) -> None:
    # Three small steps converge; the last one crushes the block.
    crush = "[[stages]]\nname = 'crush'\nsteps = 1\nmotions.top.translate = [0, 0, -9]\n"
    Path("crush.toml").write_text(isomortar.Scene.load("press", SMALL).to_toml() + crush)
    code, out, err = invoke("run", "crush.toml", "--set", "solver.max_cuts=1", "--output", "crush.h5")
    assert (code, out) == (1, "")
    assert "load step 4 (stage 'crush') does not converge" in err
    assert "stopped with 3 of 4 load steps done; they are in crush.h5" in err
    assert last("crush.h5").step == 3


@pytest.mark.parametrize(
    ("words", "field", "reason"),
    [
        (["contacts.floor.friction=-1"], "contacts.floor.friction", "greater than or equal to 0"),
        (["solver.max_cut=1"], "solver.max_cut", "unknown key"),
        (["contacts.floor.slave=block.w9"], "contacts.floor.slave", "w9"),
        (["bodies.block.mesh.order=[0,2,2]"], "bodies.block.mesh.order", "0"),
        (["stages.press.motions.roof.translate=[0,0,-1]"], "stages.press.motions.roof", "top"),
    ],
)
def test_bad_scene_names_the_field(invoke: Invoke, words: list[str], field: str, reason: str) -> None:
    code, out, err = invoke("run", "press", *settings(words))
    assert (code, out) == (2, "")
    assert field in err
    assert reason in err
    assert "Traceback" not in err
    assert not Path("results").exists()


def test_folded_element_leaves_old_results(invoke: Invoke) -> None:
    assert invoke("run", "press", *settings(SMALL))[0] == 0
    before = Path("results/press.h5").read_bytes()
    code, _, err = invoke("run", "press", *settings(SMALL), "--set", "bodies.block.geometry.top=-0.5", "--overwrite")
    assert code == 2
    assert "block" in err
    assert Path("results/press.h5").read_bytes() == before


def test_tangent_is_checked_part_by_part(invoke: Invoke) -> None:
    code, out, _ = invoke("check-tangent", "press", *settings(SMALL), "--step", "2")
    assert code == 0
    assert "load step 2" in out
    assert all(re.search(rf"{part}.*passes", out) for part in ("solid", "stick", "whole", "symmetry"))
    code, _, err = invoke("check-tangent", "press", *settings(SMALL), "--step", "4")
    assert code == 2
    assert "step 4" in err


def test_unknown_scene_and_results(invoke: Invoke) -> None:
    code, _, err = invoke("run", "presss")
    assert code == 2
    assert "press, block, iron" in err
    code, _, err = invoke("plot", "nothing.h5")
    assert code == 1
    assert "nothing.h5 does not exist" in err
    assert invoke("fly")[0] == 2


def test_output_must_be_writable(invoke: Invoke) -> None:
    code, _, err = invoke("run", "press", "--output", ".")
    assert code == 2
    assert "directory" in err
    Path("file").touch()
    code, _, err = invoke("run", "press", *settings(SMALL), "--output", "file/results.h5")
    assert code == 1
    assert "file/results.h5 cannot be written" in err
    assert invoke("run", "press", *settings(SMALL))[0] == 0
    code, _, err = invoke("plot", "results/press.h5", "--output", "file/plots")
    assert code == 1
    assert "file/plots" in err


def test_listings(invoke: Invoke) -> None:
    code, out, _ = invoke("scenes")
    assert code == 0
    assert re.search(r"^iron +Ironing a deformable base$", out, re.MULTILINE)
    code, out, _ = invoke("schema")
    assert code == 0
    assert "bodies" in json.loads(out)["required"]
    assert invoke("--version")[1] == f"isomortar {isomortar.__version__}\n"


def test_a_scene_is_looked_at_before_it_is_computed(invoke: Invoke) -> None:
    """Its words, its numbers, what is doubtful of it, and what it would be refused for; no file is written."""
    code, out, err = invoke("check", "tire")
    assert (code, err) == (0, "")
    assert out.splitlines() == [
        "tire: 2160 unknowns, 100 load steps, about 0.037 GB of memory (within a factor of two)",
        "body tire: neo-hookean of Young's modulus 10 and Poisson's ratio 0.3, 1 x 0.25 x 1 in size; 32 x 4 x 4 elements of N2 x N1 x N1, "
        "0.0625 to 0.103 long, 925 control points, weights 0.854 to 1",
        "contact road: slave tire.v1, master a rigid plane; along the plane's normal, mortar, 3072 quadrature points; at the start they "
        "are about 0.001 apart",
        "support rim: prescribes x, y, z of tire.v0; goes 2.31 and turns by 270 degrees",
        "0 warnings, nothing computed",
    ]
    code, out, _ = invoke("check", "press", "--set", "contacts.floor.plane.point=[0,0,0.2]", "--json")
    found = json.loads(out)
    assert (code, found["unknowns"], found["contacts"][0]["apart"]) == (0, 4116, pytest.approx(-0.2, abs=1e-3))
    assert [warning.split(": ")[1][:23] for warning in found["warnings"]] == ["the bodies overlap by 0"]
    code, out, _ = invoke("check", "press", "--set", "contacts.floor.plane.point=[0,0,0.2]")
    assert out.splitlines()[-2].startswith("warning: contact 'floor': the bodies overlap by 0.2 at the start")
    assert out.splitlines()[-1] == "1 warning, nothing computed"
    code, out, err = invoke("check", "press", "--set", "materials.rubber.poisson=0.5")
    assert (code, out) == (2, "")
    assert err.startswith("isomortar: materials.rubber.poisson: is 0.5")
    assert not any(Path().iterdir())


def test_a_results_file_tells_what_it_holds(invoke: Invoke) -> None:
    """Half of a run and the whole of it; its numbers are those of the file."""
    short = [*settings(SMALL), "--set", "stages.press.steps=2"]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("isomortar.results.writer.ResultsWriter.recorded", _until(1))
        assert invoke("run", "press", *short, "--output", "half.h5")[0] == 3
    code, out, _ = invoke("info", "half.h5")
    assert code == 0
    assert out.splitlines()[1].startswith("1 of 2 load steps (press 1 of 2), 1 with their state; ")
    assert out.splitlines()[-1] == "not at its end: isomortar run SCENE --resume --output half.h5 goes on"
    assert invoke("run", "press", *short, "--output", "half.h5", "--resume")[0] == 0
    code, out, _ = invoke("info", "half.h5", "--json")
    found = json.loads(out)
    end = last("half.h5")
    assert (code, found["name"], found["recorded"], found["stages"]) == (0, "press", 2, {"press": [2, 2]})
    assert found["unknowns"] == json.loads(invoke("check", "press", *short, "--json")[1])["unknowns"]
    assert found["supports"] == [
        {
            "name": name,
            "force": list(reaction.force),
            "moment": list(reaction.moment),
            "displacement": list(reaction.displacement),
            "rotation": reaction.rotation,
        }
        for name, reaction in zip(("top",), end.reactions, strict=True)
    ]
    (contact,) = found["contacts"]
    assert (contact["name"], contact["active"], contact["slip"]) == ("floor", end.contacts[0].active, end.contacts[0].slip)
    assert contact["pressure"] == list(end.contacts[0].pressure_field)
    assert contact["penetration"] == max(end.contacts[0].gap)
    text = invoke("info", "half.h5")[1]
    assert f"contact floor: {contact['active']} of {contact['constraints']} constraints active" in text
    assert "not at its end" not in text
    assert invoke("info", "none.h5")[0] == 1


def test_a_results_file_tells_of_loads(invoke: Invoke) -> None:
    text = """format = 1
    bodies.block.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 2] }
    supports.bed.face = "block.w0"
    loads.own = { body = "block", weight = [0, 0, -0.25] }
    stages = [{ name = "settle", steps = 1 }]"""
    Path("own.toml").write_text(text)
    assert invoke("run", "own.toml", "--output", "own.h5", "--quiet")[0] == 0
    (line,) = [line for line in invoke("info", "own.h5")[1].splitlines() if line.startswith("load ")]
    assert line.startswith("load own: force (0, 0, -0.5), moment (-0.25, 0.25, 0)")
    (load,) = json.loads(invoke("info", "own.h5", "--json")[1])["loads"]
    assert (load["name"], load["force"]) == ("own", pytest.approx([0, 0, -0.5], abs=1e-15))


def _until(last: int) -> Callable[[ResultsWriter, StepResult], None]:
    """Recording of load steps up to one; the next one is a fault of the program."""
    recorded = ResultsWriter.recorded

    def until(writer: ResultsWriter, result: StepResult) -> None:
        assert result.step <= last
        recorded(writer, result)

    return until


def test_the_doctor_tells_what_is_there_and_whether_it_is_right(invoke: Invoke, monkeypatch: pytest.MonkeyPatch) -> None:
    code, out, _ = invoke("doctor")
    assert code == 0
    assert all(word in out for word in (f"isomortar {isomortar.__version__} in ", "numpy ", "libumfpack", "GCC: (", "all is well"))
    assert [line[:5] for line in out.splitlines()[4:-1]] == ["right"] * 2
    monkeypatch.setattr("isomortar.cli.doctor.BALANCE", 0.0)
    code, out, _ = invoke("doctor")
    assert code == 1
    assert "WRONG  6 load steps of twist run and read back" in out
    assert out.splitlines()[-1].startswith("1 of these are wrong")


@pytest.mark.parametrize("command", ["run", "check", "info", "doctor", "plot", "export", "check-tangent", "schema"])
def test_help_shows_an_example(invoke: Invoke, command: str) -> None:
    code, out, _ = invoke(command, "--help")
    assert code == 0
    assert f"isomortar {command}" in out.partition("example")[2]


def test_public_names_are_there_and_import_alone_is_light() -> None:
    assert all(hasattr(isomortar, name) for name in dir(isomortar))
    with pytest.raises(AttributeError, match="nothing"):
        _ = isomortar.nothing
    code = "import sys, isomortar.errors; sys.exit('numpy' in sys.modules or 'isomortar.solve' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


RUN_AND_LOOK = """
import sys
from isomortar.cli import main
try:
    main()
except SystemExit as end:
    assert not end.code, end
import numpy
print(sorted({"numpy.f2py", "numpy.testing", "unittest"} & set(sys.modules)))
print("f2py" in dir(numpy), "f2py" in numpy.__all__, numpy.random.default_rng(1).integers(1))
"""


def test_run_loads_nothing_of_numpy_that_it_does_not_use_and_leaves_it_whole(tmp_path: Path) -> None:
    settings = ["--set", "stages.press.steps=1", "--set", "stages.press.motions.top.translate=[0,0,-0.05]"]
    command = ["run", "press", "--quiet", "--output", str(tmp_path / "press.h5"), *settings]
    ended = subprocess.run([sys.executable, "-c", RUN_AND_LOOK, *command], check=True, capture_output=True, text=True)
    assert ended.stdout.splitlines()[1:] == ["[]", "True True 0"]


def test_first_example_of_the_readme(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    example = re.search(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)
    assert example is not None
    assert len(example[1].splitlines()) < 25
    monkeypatch.chdir(tmp_path)
    exec(compile(example[1], "README.md", "exec"), {})
    assert capsys.readouterr().out.count("\n") >= 3
    assert list(tmp_path.rglob("*.png"))
