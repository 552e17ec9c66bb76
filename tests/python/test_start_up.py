"""What a command does not use it does not load: whoever waits for a small scene waits for its imports most of all."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from typer.main import get_command
from typer.testing import CliRunner

from isomortar.cli.commands import app, asked
from isomortar.scene import scene
from isomortar.scene.build import build

#: Runs a command, and writes the names of all modules that are loaded at its end.
COMMAND = """
import sys
from pathlib import Path
from isomortar.cli import main
names, *sys.argv[1:] = sys.argv[1:]
try:
    main()
finally:
    Path(names).write_text("\\n".join(sys.modules))
"""
#: For pictures, pages, verification, other programs and clusters.
ASIDE = {"matplotlib", "jinja2", "vtk", "distributed", "isomortar.harness", "isomortar.program", "isomortar._twin", "isomortar._extended"}
#: For geometry files: the package around the compiled splines.
AROUND = {"splinepy", "gustaf", "scipy.sparse.linalg"}
#: Parts of SciPy that some method of enforcement, or some other solver, needs.
SPECIAL = {"scipy.interpolate", "scipy.optimize", "scipy.special", "scipy.stats", "scipy.integrate"}
PRESS = ("press", "--set", "stages.press.steps=1", "--set", "bodies.block.mesh.elements=[1,1,1]")
BLOCK = (
    "block",
    *("--set", "bodies.slave.mesh.elements=[2,2,1]", "--set", "bodies.master.mesh.elements=[3,3,2]"),
    *("--set", 'stages=[{name="press", steps=1, motions.top.translate=[0,0,-0.02]}]'),
)
DEMKO = ("--set", 'contacts.floor.enforcement="demko"')


def loaded(folder: Path, *arguments: str) -> set[str]:
    """Names of the modules that a command has loaded in a process of its own, those that they stand in included."""
    unseen = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    subprocess.run([sys.executable, "-c", COMMAND, "names", *arguments], check=True, cwd=folder, **unseen)
    return set((folder / "names").read_text().splitlines())


def test_the_package_alone_loads_nothing() -> None:
    code = "import isomortar, sys; print(*sys.modules)"
    names = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout.split()
    assert "isomortar" in names
    assert not {"numpy", "scipy", "pydantic", "isomortar.scene"} & set(names)


def test_the_version_needs_nothing_of_what_computes(tmp_path: Path) -> None:
    assert not {"numpy", "pydantic", "rich", "h5py", "splinepy", "isomortar.scene"} & loaded(tmp_path, "--version")


@pytest.mark.parametrize(
    ("words", "not_needed"),
    [
        (PRESS, {*SPECIAL, "scipy.spatial", "scipy.linalg", "isomortar.told.after"}),
        (BLOCK, {*SPECIAL, "scipy.spatial", "scipy.linalg", "isomortar.told.after"}),
    ],
    ids=["plane", "bodies"],
)
def test_a_run_loads_what_it_needs(tmp_path: Path, words: tuple[str, ...], not_needed: set[str]) -> None:
    names = loaded(tmp_path, "run", *words, "--output", "scene.h5")
    assert {"numpy", "h5py", "splinepy.splinepy_core"} <= names
    assert len({name for name in names if name.startswith("isomortar._kernel")}) == 1
    assert not (ASIDE | AROUND | not_needed) & names


def test_what_is_loaded_is_not_looked_through_for_garbage(tmp_path: Path) -> None:
    """But what comes after it is."""
    look = COMMAND.replace('"\\n".join(sys.modules)', 'f"{gc.isenabled()} {gc.get_freeze_count()}"').replace("import sys", "import gc, sys")
    subprocess.run([sys.executable, "-c", look, "found", "run", *PRESS, "--output", "scene.h5"], check=True, cwd=tmp_path)
    enabled, frozen = (tmp_path / "found").read_text().split()
    assert enabled == "True"
    assert int(frozen) > 50_000


def test_a_command_that_is_asked_for_is_set_up_alone() -> None:
    """It has the name that the whole list has; where the first word names none, an option or a mistake, all of them are there."""
    every = get_command(app).commands  # type: ignore[attr-defined]
    alone = {name: list(get_command(asked([name, "--help"])).commands) for name in every}  # type: ignore[attr-defined]
    assert len(every) > 15
    assert alone == {name: [name] if name != "report" else list(every) for name in every}
    for words in ([], ["--help"], ["rum"], ["report", "orders"]):
        assert asked(words) is app


@pytest.mark.parametrize("more", [(), ("--quiet",), ("--verbose",)])
def test_what_draws_is_loaded_for_a_terminal_alone(tmp_path: Path, more: tuple[str, ...]) -> None:
    assert "rich" not in loaded(tmp_path, "run", *PRESS, *more, "--output", "scene.h5")


def test_a_run_builds_its_problem_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    built = []
    monkeypatch.setattr(scene, "build", lambda *arguments: built.append(arguments) or build(*arguments))
    result = CliRunner().invoke(app, ["run", *PRESS, "--quiet", "--output", str(tmp_path / "scene.h5")])
    assert (result.exit_code, len(built)) == (0, 1)


def test_scenes_are_listed_without_what_writes(tmp_path: Path) -> None:
    assert not {"h5py", "isomortar.march.simulation"} & loaded(tmp_path, "scenes")


def test_splines_are_loaded_once_where_files_are_read_as_well(tmp_path: Path) -> None:
    """With its types registered twice, the compiled module would not load."""
    code = """
from isomortar.geometry.primitives import ring
from isomortar.geometry.refinement import mesh
one = mesh(ring((0, 0, 0), 1, 2, 1), "NNN", (3, 2, 2), (8, 1, 1))
import sys
assert "splinepy" not in sys.modules
import splinepy
splinepy.io.export("ring.json", [splinepy.NURBS([3, 2, 2], [d.knots for d in one.directions], one.control_points, one.weights)])
from pathlib import Path
from isomortar.geometry.files import read_spline
two = mesh(read_spline(Path("ring.json")), "NNN", (3, 2, 2), (8, 1, 1))
assert splinepy.splinepy_core is sys.modules["splinepy.splinepy_core"]
assert abs(one.control_points - two.control_points).max() < 1e-14
"""
    subprocess.run([sys.executable, "-c", code], check=True, cwd=tmp_path)


def test_what_a_method_needs_comes_with_it(tmp_path: Path) -> None:
    assert "scipy.interpolate" in loaded(tmp_path, "run", *PRESS, *DEMKO, "--output", "scene.h5")
