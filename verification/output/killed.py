"""What is in the place of a file when a command is killed while it writes that: the whole of it, or what was there before."""

from __future__ import annotations

import resource
import signal
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
from forked import forked

import isomortar
from isomortar.harness import Bound, case
from isomortar.scene import Scene

SCENE = """
format = 1
bodies.block = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 0.5] }, mesh.elements = [2, 2, 1] }
contacts.floor = { slave = "block.w0", plane = {}, friction = 0.3 }
supports.top.face = "block.w1"
stages = [{ name = "press", steps = 4, motions.top.translate = [0.1, 0, -0.1] }]
"""
#: What writes files from results, into a folder.
WAYS: dict[str, Callable[[Path, Path], object]] = {
    "export": isomortar.export,
    "plot": lambda results, folder: isomortar.plot(results, folder, only=["curves", "maps"], formats=["png"]),
    "film": lambda results, folder: isomortar.film(results, folder / "film.gif", every=4),
    "view": lambda results, folder: isomortar.view(results, folder / "page.html"),
}
#: Bytes of a file, as shares of those of all of them, at which the system kills who writes it.
MOMENTS = (0.3, 0.97)


def contents(folder: Path) -> dict[str, bytes]:
    """Files that have their names."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file() and path.name[0] != "."}


def killed(action: Callable[[], object], size: int) -> bool:
    """Whether the system kills a child that does something, at the first byte of a file beyond so many."""

    def act() -> bytes:
        signal.signal(signal.SIGXFSZ, signal.SIG_DFL)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
        action()
        return b"done"

    return forked(act, 60, 120.0, 1 << 33).status == -signal.SIGXFSZ


@case(
    claim="Who is killed while files are exported, drawn, filmed or written as a page leaves each of them whole, as it was, or not at all; "
    " the next one writes them all.",
    tier="gate",
    grid={"way": tuple(WAYS)},
    bounds={
        "parts": Bound(0.0, 0.0, "definition: files of which a part is there"),
        "lost": Bound(0.0, 0.0, "definition: files that were whole, and are not, or that the next one does not write"),
        "killed": Bound(at_least=2.0, reason="definition: or nothing is tried"),
    },
)
def killed_while_writing(way: str) -> dict[str, float]:
    """How many, in an empty folder and where all files are there."""
    parts = lost = kills = 0
    with tempfile.TemporaryDirectory() as name:
        results, whole = Path(name) / "run.h5", Path(name) / "whole"
        isomortar.run(Scene.from_toml(SCENE), results).close()
        WAYS[way](results, whole)
        wanted = contents(whole)
        for number, moment in enumerate(np.unique(np.quantile([len(content) for content in wanted.values()], MOMENTS))):
            folder = Path(name) / f"killed-{number}"
            kills += killed(lambda folder=folder: WAYS[way](results, folder), int(0.9 * moment))  # type: ignore[misc]
            parts += sum(wanted.get(file) != content for file, content in contents(folder).items())
            WAYS[way](results, folder)
            lost += contents(folder) != wanted
            kills += killed(lambda folder=folder: WAYS[way](results, folder), int(0.9 * moment))  # type: ignore[misc]
            lost += contents(folder) != wanted
    return {"parts": float(parts), "lost": float(lost), "killed": float(kills)}


@case(
    claim="Who is killed while a load step is written resumes to the numbers of a run that was not, to the last bit.",
    tier="gate",
    bounds={
        "apart": Bound(0.0, 0.0, "definition: kills after which load steps are lost, or come to other numbers"),
        "killed": Bound(at_least=3.0, reason="definition: or nothing is tried"),
    },
)
def killed_while_recording() -> dict[str, float]:
    """How many, by the size that the file has."""
    scene, kills, apart = Scene.from_toml(SCENE), 0, 0
    with tempfile.TemporaryDirectory() as name:
        whole = Path(name) / "whole.h5"
        isomortar.run(scene, whole).close()
        with isomortar.Results(whole) as results:
            forces, positions = results.curve("force", support="top"), results.step(4).state.positions
        for number, share in enumerate((0.5, 0.8, 0.95, 0.99)):
            path = Path(name) / f"killed-{number}.h5"
            size = int(share * whole.stat().st_size)
            kills += killed(lambda path=path: isomortar.run(scene, path, resume=True).close(), size)  # type: ignore[misc]
            isomortar.run(scene, path, resume=True).close()
            with isomortar.Results(path) as results:
                apart += not np.array_equal(results.curve("force", support="top"), forces)
                apart += not np.array_equal(results.step(4).state.positions, positions)
            apart += any(path.parent.glob(f".{path.name}*"))
    return {"apart": float(apart), "killed": float(kills)}
