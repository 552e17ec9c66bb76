"""All that is verified and measured at night, on one page and with one exit code: ``python tools/run_nightly.py [FOLDER]``.

The folder, results/nightly by default, gets `index.html` with a row for each part (its command, how it ended, how long it took, the end of
what it printed where that was not well, its own page), the whole of what each printed in `NAME.log`, and a line of `history.jsonl` for each
night. The exit code is 1 if any part ended with another one than 0; none keeps the others from being run. A part that was killed goes on
from what it had measured when the same is begun again.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from datetime import datetime
from pathlib import Path

from isomortar.harness.journal import Journal
from isomortar.harness.report import template

ROOT = Path(__file__).parent.parent
#: Nights that the page looks back on.
NIGHTS = 30
#: Lines that the page shows of what a part printed.
SHOWN = 15


@dataclass(frozen=True)
class Part:
    """A command of isomortar, or of another program, and the page that it leaves, if any."""

    name: str
    arguments: tuple[str, ...]
    page: Path | None
    program: str = "isomortar"

    @property
    def command(self) -> str:
        """As a person would type it."""
        return " ".join((self.program, *self.arguments))


@dataclass(frozen=True)
class Ending:
    """How a part ended, and after how long."""

    name: str
    code: int
    minutes: float


PARTS = (
    Part("verification", ("verify", "--tier", "nightly"), Path("results/verification/report.html")),
    Part("extremes", ("report", "extremes", "--tier", "nightly"), Path("results/verification/extremes.html")),
    Part("published", ("report", "published"), Path("results/verification/published.html")),
    *(Part(f"orders-{s}", ("report", "orders", s), Path(f"results/orders-{s}/report.html")) for s in ("press", "twist", "iron", "tire")),
    Part("tests", ("-q", "-m", "nightly", "tests"), None, "pytest"),
    Part("benchmarks", ("bench",), Path("results/bench/bench.html")),
)


def run(part: Part, folder: Path) -> Ending:
    """Run one part; what it prints goes to its log."""
    start = time.monotonic()
    with (folder / f"{part.name}.log").open("w", encoding="utf-8") as log:
        command = [sys.executable, "-m", part.program, *part.arguments]
        ended = subprocess.run(command, cwd=ROOT, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT)
    return Ending(part.name, ended.returncode, (time.monotonic() - start) / 60.0)


def night(parts: Sequence[Part], folder: Path) -> int:
    """Run all parts and write the page after each of them; returns the exit code."""
    folder.mkdir(parents=True, exist_ok=True)
    history, begun, endings = Journal(folder / "history.jsonl"), datetime.now().astimezone(), []
    for part in parts:
        print(f"==> {part.command}", flush=True)
        endings.append(run(part, folder))
        print(f"    exit code {endings[-1].code} after {endings[-1].minutes:.1f} minutes", flush=True)
        write(folder, parts, endings, begun, history)
    history.add({"when": begun.isoformat(timespec="seconds"), "commit": commit(), "endings": [asdict(ending) for ending in endings]})
    print(folder / "index.html")
    return int(any(ending.code for ending in endings))


def write(folder: Path, parts: Sequence[Part], endings: Sequence[Ending], begun: datetime, history: Journal) -> None:
    """The page of the parts that have ended, and of the nights before."""
    rows = []
    for part, ending in zip(parts, endings, strict=False):
        lines = (folder / f"{part.name}.log").read_text(encoding="utf-8", errors="replace").splitlines()
        page = os.path.relpath(ROOT / part.page, folder) if part.page and (ROOT / part.page).exists() else ""
        rows.append({"part": part, "ending": ending, "page": page, "end": "\n".join(lines[-SHOWN:]) if ending.code else ""})
    text = template("nightly.html", Path(__file__)).render(
        rows=rows,
        waiting=[part.name for part in parts[len(endings) :]],
        failed=[ending.name for ending in endings if ending.code],
        begun=begun,
        commit=commit(),
        nights=history.entries[: -NIGHTS - 1 : -1],
        names=[part.name for part in parts],
    )
    (folder / "index.html").write_text(text, encoding="utf-8")


def commit() -> str:
    """What is checked out, in short; empty where git does not tell."""
    told = subprocess.run(["git", "-C", str(ROOT), "describe", "--always", "--dirty"], capture_output=True, text=True, check=False)
    return told.stdout.strip()


if __name__ == "__main__":
    sys.exit(night(PARTS, Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "results" / "nightly").resolve()))
