"""The command line and the public Python interface, on scenes of a second or less."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import isomortar
from command_lines import SMALL, Invoke, last, settings
from isomortar.solve.record import StepResult

README = Path(__file__).parents[2] / "README.md"


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
    assert "folder file cannot be made: file is a file, and no folder" in err
    assert invoke("run", "press", *settings(SMALL))[0] == 0
    code, _, err = invoke("plot", "results/press.h5", "--output", "file/plots")
    assert code == 1
    assert "file/plots" in err


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
