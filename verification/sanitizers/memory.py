"""The kernel under tools that watch each access to memory."""

from __future__ import annotations

import importlib.util
import json
import shutil
import tempfile
from pathlib import Path

from sanitizers import tools, work

import isomortar
from isomortar.harness import Bound, case, skip

#: A fault that every tool must see, or its silence is worth nothing: one column too many is read.
FILE, SOUND, FAULT = (
    "fortran/solid/assembly.f90",
    "do k = 1, many\n      do a = 1, size(batch%nodes, 1)\n        residual",
    "do k = 1, size(batch%nodes, 2) + 1\n      do a = 1, size(batch%nodes, 1)\n        residual",
)


@case(
    claim="The kernel touches no memory but its own, uses no value that was never set, and does nothing that its language leaves "
    "undefined: its tests, fuzzed calls and two short scenes under gfortran's checks, the sanitizers of addresses and undefined "
    "behaviour, and valgrind.",
    tier="nightly",
    grid={"tool": tuple(tools.TOOLS)},
    bounds={
        "reports": Bound(at_most=0.0, reason="definition: none"),
        "reports of a planted fault": Bound(at_least=1.0, at_most=1e9, reason="definition: a tool that sees nothing says nothing"),
        "tests": Bound(at_least=100.0, at_most=1e9, reason="definition: the kernel's tests have run"),
        "calls": Bound(at_least=float(work.CALLS), at_most=float(work.CALLS), reason="definition: as many as there are"),
        "steps": Bound(at_least=2.0 * work.STEPS, at_most=2.0 * work.STEPS, reason="definition: both scenes have run"),
    },
)
def memory(tool: str) -> dict[str, float]:
    """Build for the tool, run the work, plant a fault and run a scene once more."""
    lacking = tools.is_missing(tool)
    if lacking:
        skip(f"{lacking} is not installed")
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        package, counts, chosen = folder / "package", folder / "counts.json", tools.TOOLS[tool]
        shutil.copytree(Path(isomortar.__file__).parent, package / "isomortar", ignore=shutil.ignore_patterns("__pycache__", "*.so"))
        twin = importlib.util.find_spec("isomortar._extended")
        assert twin is not None, "the tests compare with the twin"
        shutil.copy2(str(twin.origin), package / "isomortar")
        sources = tools.sources(folder / "sources")
        program = Path(work.__file__)
        words = [str(program.parent.parent), str(tools.PROJECT / "tests/python"), str(counts)]
        reports, _ = tools.watched(chosen, tools.build(chosen, sources), package, program, [*words, "all"])
        if reports:
            raise AssertionError(f"{len(reports)} reports:\n" + "\n".join(sorted(set(reports))[:20]))
        done = {name: float(number) for name, number in json.loads(counts.read_text()).items()}
        file = sources / FILE
        text = file.read_text()
        assert text.count(SOUND) == 1, "the fault is planted in one place"
        file.write_text(text.replace(SOUND, FAULT))
        planted, _ = tools.watched(chosen, tools.build(chosen, sources), package, program, words)
    return {"reports": float(len(reports)), "reports of a planted fault": float(len(planted)), **done}
