"""What a results file does not take for what it is not: damaged blocks, a load step twice, tables in another order."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from output.records import SCENE, load_steps, recorded

from isomortar.errors import ResultsError
from isomortar.harness import Bound, case
from isomortar.model.entities import Problem
from isomortar.results.comparison import differences
from isomortar.results.reader import Results
from isomortar.results.writer import ResultsWriter
from isomortar.scene import Scene

#: What a problem has several of.
TABLES = ("bodies", "contacts", "supports", "loads", "stages")


def blocks(path: Path) -> Iterator[tuple[str, int]]:
    """The middle of the first block of each dataset of numbers, as a place in a file: texts lie elsewhere in it."""
    found: list[tuple[str, int]] = []

    def look(name: str, data: Any) -> None:
        if isinstance(data, h5py.Dataset) and data.dtype != object and data.chunks and data.id.get_num_chunks():
            chunk = data.id.get_chunk_info(0)
            found.append((name, chunk.byte_offset + chunk.size // 2))

    with h5py.File(path) as file:
        file.visititems(look)
    yield from found


@case(
    claim="A bit that is wrong in any array of numbers of a results file is noticed when that is read: every block has a checksum.",
    tier="gate",
    bounds={
        "unguarded": Bound(0.0, 0.0, "definition: datasets with a block that is changed and is read without a word"),
        "tried": Bound(at_least=40.0, reason="definition: or nothing is tried"),
    },
)
def wrong_bits() -> dict[str, float]:
    """How many datasets, of how many."""
    problem = Scene.from_toml(SCENE).problem()
    unguarded = 0
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "sound.h5"
        recorded(path, problem, load_steps(problem), "every")
        sound, places = path.read_bytes(), list(blocks(path))
        for name, place in places:
            path.write_bytes(sound[:place] + bytes([sound[place] ^ 1]) + sound[place + 1 :])
            with h5py.File(path) as file:
                try:
                    file[name][()]
                    unguarded += 1
                except OSError:
                    pass
    return {"unguarded": float(unguarded), "tried": float(len(places))}


@case(
    claim="A file that holds a load step refuses the same one and those before it, and stays as it is; where nothing else is said it keeps "
    "the state of each step.",
    tier="gate",
    bounds={
        "taken": Bound(0.0, 0.0, "definition: load steps that are there and are written again"),
        "changed": Bound(0.0, 0.0, "definition: files that are not as they were"),
        "lost": Bound(0.0, 0.0, "definition: states of load steps that are not there"),
    },
)
def twice() -> dict[str, float]:
    """How many of each."""
    problem = Scene.from_toml(SCENE).problem()
    steps, taken, changed = load_steps(problem), 0, 0
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "results.h5"
        writer = ResultsWriter(path, problem, SCENE, "0")
        for number, step in enumerate(steps):
            writer.recorded(step)
            before = path.read_bytes()
            for other in steps[: number + 1]:
                try:
                    writer.recorded(other)
                    taken += 1
                except ResultsError:
                    pass
            changed += path.read_bytes() != before
        with Results(path) as results:
            lost = sum(not np.array_equal(results.step(step.step).state.positions, step.state.positions) for step in steps)
            lost += str(len(steps)) not in repr(results) or f"{len(steps)}/{problem.total_steps}" not in repr(results)
    return {"taken": float(taken), "changed": float(changed), "lost": float(lost)}


@case(
    claim="Two scenes whose bodies, contacts, supports, loads or stages come in another order are not the same scene: what is numbered by "
    "their order would be another's.",
    tier="gate",
    bounds={
        "alike": Bound(0.0, 0.0, "definition: orders that are taken for the same"),
        "unlike": Bound(0.0, 0.0, "definition: differences of a problem from itself, or from one of another name"),
    },
)
def orders() -> dict[str, float]:
    """How many of both, for two neighbours of each table exchanged, and for the last one left out."""
    problem: Problem = Scene.from_toml(SCENE).problem()
    alike = 0
    for table in TABLES:
        entries = getattr(problem, table)
        for number in range(len(entries) - 1):
            turned = (*entries[:number], entries[number + 1], entries[number], *entries[number + 2 :])
            alike += not differences(problem, replace(problem, **{table: turned}))  # type: ignore[arg-type]
        alike += not differences(problem, replace(problem, **{table: entries[:-1]}))
    unlike = len(differences(problem, problem)) + len(differences(problem, replace(problem, name="another")))
    return {"alike": float(alike), "unlike": float(unlike)}
