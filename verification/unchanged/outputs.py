"""What users have of scenes comes out as it did: what commands say, curves, pictures, films, exports and pages, read back.

That is no proof of what they are, but what changes them anywhere is seen, and a failure says which line was what. Nothing of a machine
is in them: times are taken out or set, and of pictures it is what stands in them, before fonts lay it out.
"""

from __future__ import annotations

import io
import re
import shlex
import sys
import tempfile
from collections.abc import Callable, Iterable, Iterator
from contextlib import chdir, redirect_stderr, redirect_stdout
from pathlib import Path
from shutil import copytree
from unittest import mock

import h5py
import numpy as np
from rich.console import Console
from unchanged.drawn import watched
from unchanged.runs import FOLDER
from unchanged.written import film_lines, numbers, results_lines, view_lines, vtk_lines

from isomortar.cli import main, progress
from isomortar.cli.cost import costs
from isomortar.cli.tables import COLUMNS
from isomortar.harness import Matches, Words, case
from isomortar.results.files import SEAL_SIZE, seal
from isomortar.results.pictures import FIELDS
from isomortar.results.reader import Results
from isomortar.results.table import columns

#: A run that goes on with another mesh of the last body, and a contact that was not there: what is said of both.
_OTHER = "--set bodies.low.mesh.elements=[1,3,1] --set contacts.more.slave=a.w1 --set contacts.more.plane={}"
#: Scenes, and what is asked for of each besides what it is told. Of 18 that are quick these run through the most lines of what says, writes
#: and draws, by a greedy cover; each is asked for what it has and others have not, so that few pictures are drawn twice.
ASKED: dict[str, tuple[str, ...]] = {
    "patch": (
        "check scenes/patch.toml --json",
        "info run.h5 --json",
        f"plot run.h5 --format svg {' '.join(f'--field {field}' for field in FIELDS if field not in ('stress', 'J'))}",
        "film run.h5 --every 3 --rate 5",
        "view run.h5",
        "run scenes/patch.toml --output run.h5 --resume",
        "run scenes/patch.toml --output run.h5 --resume --set materials.m.young=21 --set contacts.floor.friction=0.2",
    ),
    "wheel": ("plot run.h5 --only curves --x 'rotation of hub'",),
    "glued-1": (
        "plot run.h5 --step 1 --field J --field gap --format pdf",
        "export run.h5",
        f"run scenes/glued-1.toml --output run.h5 --resume {_OTHER}",
    ),
    "loads-135": ("check scenes/loads-135.toml --json", "info run.h5 --json", "plot run.h5 --only curves --field stress"),
    "walls-93": ("plot run.h5 --only maps --format png", "view run.h5"),
    "faces-147": (
        "film run.h5",
        "plot run.h5 --field slip",
        "plot run.h5 --only curves --x strain",
        "plot run.h5 --step 3 --only bodies",
        "plot run.h5 --only curves --output run.h5/below",
        "view run.h5 --output seen.htm",
        "info none.h5",
    ),
}
_SAME = "round-off: the same numbers of the same program; words, and counts, are to be the same"
#: What only a machine tells: times, versions, memory that a process has; in words before it, which stay.
_OF_MACHINES = (
    (re.compile(r"[0-9.e+-]+( CPU seconds)"), r"?\1"),
    (re.compile(r"(CPU seconds: ).*"), r"\1?"),
    (re.compile(r"^\d{4}-\d\d-\d\d \d\d:\d\d:\d\d\.\d{3} "), "TIME "),
    (re.compile(r"isomortar \d[\w.+-]*"), "isomortar ?"),
    (re.compile(r"^(evaluations to order \d|elements searched|history bytes) +[\d ]+"), r"\1 ? "),
    (re.compile(r"(\"version\": )\".*\""), r"\1?"),
)


class Desk:
    """A folder with a scene and its results file, and what commands said there and left."""

    def __init__(self, scene: str) -> None:
        self.scene, self.said = scene, list[str]()

    def command(self, *words: str) -> None:
        """Run a command: its exit code and what it said, on both streams."""
        out, err, code = io.StringIO(), io.StringIO(), 0
        argv = ["isomortar", *words]
        with mock.patch.object(sys, "argv", argv), redirect_stdout(out), redirect_stderr(err):
            try:
                main()
            except SystemExit as end:
                code = int(end.code or 0)
        self.said.append(f"$ {' '.join(words)} : {code}")
        self.said += [
            f"  {stream}: {_plain(line)}" for stream, text in (("out", out), ("err", err)) for line in text.getvalue().splitlines()
        ]


def _plain(line: str) -> str:
    """A line without what only a machine tells."""
    for pattern, instead in _OF_MACHINES:
        line = pattern.sub(instead, line)
    return line


def _timed(path: Path) -> None:
    """Give each phase of each load step seconds of its own, whatever they were."""
    with h5py.File(path, "a") as file:
        for number, name in enumerate(sorted(file["timings"])):
            rows = file["timings"][name]
            rows[:] = 0.125 * (number + 1) + 0.5 * np.arange(len(rows))
        file.attrs["program_version"] = "0"
    content = path.read_bytes()[SEAL_SIZE:]
    path.write_bytes(seal(content) + content)


@case(
    claim="Of scenes drawn by lot all that users can have is as it was: what commands say, curves, pictures, films, exports and pages.",
    grid={"scene": tuple(ASKED)},
    bounds={name: Matches("outputs", _SAME, allowance=1e-6) for name in ("said", "file", "made")},
    files=tuple(FOLDER.rglob("*.toml")),
)
def outputs(scene: str) -> dict[str, Words]:
    """Each in lines."""
    with tempfile.TemporaryDirectory() as name, chdir(name):
        copytree(FOLDER, "scenes")
        desk = Desk(scene)
        path = Path("run.h5")
        with mock.patch.object(progress, "monotonic", return_value=0.0):
            desk.command("run", f"scenes/{scene}.toml", "--output", "run.h5", "--log", "run.log", "--quiet")
        _timed(path)
        desk.said += [f"  log: {_plain(line)}" for line in Path("run.log").read_text().splitlines()]
        desk.command("check", f"scenes/{scene}.toml")
        desk.command("info", "run.h5")
        made = [line for words in ASKED[scene] for line in _made(desk, *shlex.split(words))]
        with Results(path) as results:
            costing = Console(file=io.StringIO(), width=COLUMNS, record=True)
            costing.print(costs(results))
            desk.said += [_plain(line.rstrip()) for line in costing.export_text().splitlines()]
            table = [f"{name} {numbers(values)}" for name, values in columns(results).items() if values.dtype.kind in "if"]
        found = {"said": desk.said, "file": [*results_lines(path), *table], "made": made}
        return {name: Words("\n".join(lines)) for name, lines in found.items()}


def _made(desk: Desk, *words: str) -> Iterator[str]:
    """What a command makes: figures that are drawn meanwhile, and files that are there after it."""
    there = set(Path().rglob("*.*"))
    with watched() as drawn:
        desk.command(*words)
    yield from (f"{words[0]} {line}" for line in drawn)
    for path in sorted(set(Path().rglob("*.*")) - there):
        yield f"{words[0]} {path}"
        yield from (f"{path.stem} {line}" for line in (_READ[path.suffix](path) if path.suffix in _READ else ()))


#: What tells of files, by their type; of figures it was told when they were drawn.
_READ: dict[str, Callable[[Path], Iterable[str]]] = {
    ".vtu": vtk_lines,
    ".pvd": vtk_lines,
    ".html": lambda path: view_lines(path.read_text(encoding="utf-8")),
    ".gif": film_lines,
}
