"""How commands end: exit codes and sentences, of what can be done, of what cannot, and of what a run may meet."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from contextlib import chdir
from pathlib import Path
from typing import Any
from unittest import mock

from forked import program

from isomortar import driver
from isomortar.errors import ConvergenceError, InputError
from isomortar.harness import Bound, case
from isomortar.scene import Scene

SCENE = """
format = 1
name = "bar"
bodies.bar = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh = { order = 1, elements = 1 } }
supports = { left.face = "bar.u0", right.face = "bar.u1" }
stages = [{ name = "pull", steps = 2, motions.right.translate = [0.03, 0, 0] }]
"""
#: The same above a floor that it never comes to.
APART = f"{SCENE}contacts.floor = {{ slave = 'bar.w0', plane.point = [0, 0, -1] }}\n"
_SINGLE = ("--set", "solver.max_cuts=0", "--set", "stages.pull.steps=1", "--set", "stages.pull.motions.right.translate=[-1.5,0,0]")
#: Words of commands, one after the other in a folder; the exit code, and what is said.
ONE_BY_ONE: tuple[tuple[tuple[str, ...], int, str], ...] = (
    (("--version",), 0, "isomortar"),
    (("check", "bar.toml"), 0, "nothing computed"),
    (("check", "none.toml"), 2, "no scene file"),
    (("info", "bar.h5"), 1, "does not exist"),
    (("run", "bar.toml", "--output", "bad.h5", *_SINGLE), 1, "stopped with 0 of 1 load step done"),
    (("run", "bar.toml", "--output", "bar.h5"), 0, "2 load steps done, 0 warnings"),
    (("run", "bar.toml", "--output", "bar.h5"), 2, "exists already"),
    (("run", "bar.toml", "--output", "bar.h5", "--resume"), 0, "all 2 load steps are there already"),
    (("run", "bar.toml", "--output", "bar.h5", "--resume", "--overwrite"), 2, "exclude each other"),
    (("run", "bar.toml", "--output", "bar.h5", "--resume", "--set", "supports.left.axis=[1,0,0]"), 1, "belongs to another scene"),
    (("run", "bar.toml", "--output", "bar.toml", "--overwrite"), 1, "no results file"),
    (("run", "bar.toml", "--output", "bar.h5", "--resume", "--steps", "1"), 0, "2 of 3 load steps are there, going on"),
    (("info", "bar.h5"), 0, "3 of 3 load steps"),
    (("run", "bar.toml", "--output", "link.h5", "--overwrite"), 1, "symbolic link"),
    *((("run", "bar.toml", "--output", "new.h5", "--log", log), 2, "scene file of this run") for log in ("bar.toml", "link.toml")),
    (("run", "bar.toml", "--output", "new.h5", "--log", "new.h5"), 2, "results file of this run"),
    (("info", "bar.toml"), 1, "is a scene file, and no results"),
    (("export", "none.h5"), 1, "does not exist"),
    (("view", "none.h5"), 1, "does not exist"),
    (("film", "bar.h5"), 1, "has no contact"),
    (("check-tangent", "bar.toml"), 0, "passes"),
    (("check-tangent", "bar.toml", "--step", "3"), 2, "does not exist"),
    (("check-tangent", "apart.toml"), 1, "NOT MEASURED"),
    (("verify", "--cases", "none"), 2, "no folder none"),
    (("bless", "a/b", "--reason", "so", "--class", "exact"), 2, "class"),
)
#: What may end a run, the exit code, and what is said of it.
MET: tuple[tuple[BaseException, int, str], ...] = (
    (InputError("is wrong", "bodies.bar"), 2, "bodies.bar"),
    (ConvergenceError("no end"), 1, "no end"),
    (MemoryError(), 1, "memory ran out"),
    (OSError(28, "No space left on device", "bar.h5"), 1, "No space left on device: bar.h5"),
    (ImportError("no module"), 1, "the installation is not complete: no module"),
    (ZeroDivisionError("by zero"), 3, "ZeroDivisionError: by zero"),
    (KeyboardInterrupt(), 130, "to go on"),
)

#: Words of commands that are interrupted as they read their scene.
INTERRUPTED: tuple[tuple[str, ...], ...] = (
    ("check", "bar.toml"),
    ("run", "bar.toml"),
    ("check-tangent", "bar.toml"),
    ("trade", "bar.toml", "--want", "force.right.x", "--within", "1%"),
    ("advise", "bar.toml", "--want", "force.right.x", "--within", "1%"),
    ("report", "orders", "bar.toml"),
)


def raising(error: BaseException) -> Callable[..., Any]:
    """In the place of what computes: two load steps are said to be there, then it ends."""

    def compute(*given: Any) -> None:
        observer = given[3]
        observer.started(3, 3)
        raise error

    return compute


@case(
    claim="Commands end with 0 where what was asked for is done, with 1 where it is not, with 2 where it cannot be meant, 3 where the "
    "program is at fault and 130 where they are interrupted; they say why, and what is left of a run that is stopped.",
    tier="gate",
    bounds={
        "codes": Bound(0.0, 0.0, "definition: exit codes that are others than those that the manual says"),
        "words": Bound(0.0, 0.0, "definition: sentences without what they are about"),
    },
)
def exit_codes() -> dict[str, float]:
    """How many are wrong."""
    codes = words = 0
    with tempfile.TemporaryDirectory() as name, chdir(name):
        folder = Path(name)
        (folder / "bar.toml").write_text(SCENE)
        (folder / "apart.toml").write_text(APART)
        (folder / "link.h5").symlink_to("bar.h5")
        (folder / "link.toml").symlink_to("bar.toml")
        for asked, code, part in ONE_BY_ONE:
            found, said = program(*asked, folder=folder)
            codes += found != code
            words += part not in said
        for error, code, part in MET:
            with mock.patch.object(driver, "compute", raising(error)):
                found, said = program("run", "bar.toml", "--output", "other.h5", folder=folder)
            codes += found != code
            advised = "repeat the command with --resume" in said
            words += part not in said or "stopped with 2 of 2" not in said or advised != isinstance(error, KeyboardInterrupt)
        for asked in INTERRUPTED:
            with mock.patch.object(Scene, "load", side_effect=KeyboardInterrupt):
                found, said = program(*asked, folder=folder)
            codes += found != 130
            words += not said.endswith("isomortar: interrupted\n")
    return {"codes": float(codes), "words": float(words)}
