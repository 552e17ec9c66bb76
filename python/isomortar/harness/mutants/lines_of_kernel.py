"""Which lines of the kernel a cell runs, as gcov has them.

As a program (``python -m isomortar.harness.mutants.lines_of_kernel FOLDER``) a measuring process whose measurements also say which lines
of the Fortran sources were run, by it and by processes that have ended, with kernels in a folder that are built to count them.
"""

from __future__ import annotations

import ctypes
import json
import os
import re
import sys
from collections.abc import Iterable, Set
from itertools import pairwise
from pathlib import Path

from isomortar.harness.mutants.reach import with_lines
from isomortar.harness.worker import serve
from isomortar.program.process import output_of

#: Gives kernels the names under which their counts are written and forgotten: those of the compiler are hidden in them.
COUNTS = """
void __gcov_dump(void);
void __gcov_reset(void);
void lines_written(void) { __gcov_dump(); }
void lines_forgotten(void) { __gcov_reset(); }
"""
_CONTINUED = re.compile(r"&\s*(![^'\"]*)?$")
_BEGIN = re.compile(r"\s*(?!end\b|!)[\w ()]*\b(subroutine|function)\s+\w+")
_END = re.compile(r"\s*end (subroutine|function)\b")
#: In paths of gcov: from the folder of a build to the sources.
_SOURCES = "../fortran/"


def places(text: str, lines: Iterable[int]) -> list[Set[int]]:
    """Lines of the statements that some lines of a source are of, and of the procedures around them (see `reach`).

    None of them where one is outside of procedures: what is declared there anybody may use.
    """
    rows = text.split("\n")
    starts = [1, *(i + 2 for i, row in enumerate(rows) if not _CONTINUED.search(row))]
    statements = [range(*bounds) for bounds in pairwise(starts)]
    procedures = _procedures(rows)
    around = [next((p for p in procedures if line in p), None) for line in lines]
    if None in around:
        return []
    return [
        {one for line in lines for statement in statements if line in statement for one in statement},
        {one for procedure in around if procedure for one in procedure},
    ]


def _procedures(rows: list[str]) -> list[range]:
    """Lines of the procedures of a source, inner ones first."""
    found: list[range] = []
    begun: list[int] = []
    for number, row in enumerate(rows, 1):
        if _END.match(row):
            found.append(range(begun.pop(), number + 1))
        elif _BEGIN.match(row):
            begun.append(number)
    return found


class _Counts:
    """What kernels in a folder count, below a folder beside them; so do other processes that a cell starts."""

    def __init__(self, package: Path) -> None:
        self._folder = package.parent / "lines"
        os.environ["GCOV_PREFIX"] = str(self._folder)
        libraries = [ctypes.CDLL(str(path)) for path in sorted(package.glob("_*.so"))]
        self._kernels = [library for library in libraries if hasattr(library, "lines_written")]

    def begin(self) -> None:
        """Forget what was run."""
        for kernel in self._kernels:
            kernel.lines_forgotten()
        for counts in self._folder.rglob("*.gcda"):
            counts.unlink()

    def end(self) -> dict[str, set[int]]:
        """The lines that were run since `begin`, by file below the folder of the sources."""
        for kernel in self._kernels:
            kernel.lines_written()
        counts = list(self._folder.rglob("*.gcda"))
        for path in counts:
            notes = path.with_suffix(".gcno").relative_to(self._folder)
            if not (self._folder / notes).exists():
                (self._folder / notes).symlink_to("/" / notes)  # gcov looks for what the compiler wrote beside the counts
        found: dict[str, set[int]] = {}
        for report in output_of(["gcov", "--json-format", "--stdout", *map(str, counts)]).splitlines():
            for file in json.loads(report)["files"]:
                if file["file"].startswith(_SOURCES):
                    run = {line["line_number"] for line in file["lines"] if line["count"]}
                    found.setdefault(file["file"].removeprefix(_SOURCES), set()).update(run)
        return {file: run for file, run in found.items() if run}


if __name__ == "__main__":
    counts = _Counts(Path(sys.argv[1]).resolve())
    serve(lambda cell: with_lines(cell, counts.begin, counts.end))
