"""Write what ``isomortar report enforcement`` found into docs/enforcement.md: ``python tools/document_enforcement.py``."""

from __future__ import annotations

import argparse
import json
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parent.parent
PAGE = ROOT / "docs" / "enforcement.md"
_BEGIN, _END = "<!-- found: isomortar report enforcement; python tools/document_enforcement.py -->\n", "<!-- end of what was found -->\n"

Row = Mapping[str, Any]


def found(report: Mapping[str, Any]) -> str:
    """What a ``report.json`` says, without what depends on the machine: advice by solves, not by seconds."""
    parts = [
        f"Of {report['started'][:10]}; program `{report['program'][:12]}`.",
        "## What to take for what",
        table(("purpose", "by these numbers"), ((a["purpose"], a["text"]) for a in report["advice"] if "CPU" not in a["measure"])),
        "## Statements",
        table(("statement", "verdict", "by way"), ((s["text"], s["verdict"], verdicts(s)) for s in report["statements"])),
        "## What is exact",
        exact(report["exact"]),
        "## What is no option",
        table(
            ("form", "why not", "measured", "instead"),
            ((r["form"], r["why"], number(r["own"]), number(r["instead"])) for r in report["refused"]),
        ),
        "## Tractions of two cylinders",
        by_kind(report["known_by_kind"], "roughness"),
        "## Curves by order",
        by_kind(report["by_kind"], "solves"),
        "## Curves of scenes",
        scenes(report["scenes"]),
        "## What a method adds",
        table(("file", "lines"), ((f"`{s['file']}`", s["lines"]) for s in report["sizes"])),
    ]
    return "\n\n".join(parts)


def table(heads: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Markdown."""
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join("| " + " | ".join(str(entry).replace("|", "\\|") for entry in line) + " |" for line in lines)


def number(value: float | None, percent: bool = False) -> str:
    """As people read it; a dash where there is none."""
    if value is None or not math.isfinite(value):
        return "-"
    return f"{100 * value:.3g}" if percent else f"{value:.3g}"


def verdicts(statement: Row) -> str:
    """By way: the verdict, and the values that it goes by."""
    ways = statement["by_method"].items()
    return "; ".join(f"{way}: {of['verdict']} ({', '.join(f'{k} {number(v)}' for k, v in of['values'].items())})" for way, of in ways)


def exact(rows: Sequence[Row]) -> str:
    """All numbers by method and order."""
    names = [name for name in rows[0] if name not in ("method", "order")]
    return table(("method", "order", *names), ([row["method"], row["order"], *(number(row[name]) for name in names)] for row in rows))


def by_kind(rows: Sequence[Row], beside: str) -> str:
    """By scene and way: how far off in per cent, and another number, of every kind of discretisation."""
    lines = [
        (row["scene"], row["kind"], row["way"], number(row["off"], True), number(row[beside])) for row in rows if row["way"] != "reference"
    ]
    return table(("scene", "kind", "way", "off, %", beside), lines)


def scenes(groups: Sequence[Sequence[Row]]) -> str:
    """By scene and way: how far off the reference and the mortar method on the same mesh, and what it took."""
    heads = ("scene", "way", "ending", "off, %", "off mortar, %", "roughness", "largest pressure", "solves", "cuts")
    names = ("roughness", "peak", "solves", "cuts")
    rows = [row for group in groups for row in group]
    lines = (
        [r["scene"], r["way"], r["ending"], number(r["off"], True), number(r["off_mortar"], True), *(number(r[name]) for name in names)]
        for r in rows
    )
    return table(heads, lines)


def page(text: str, report: Mapping[str, Any]) -> str:
    """The page with what was found as it is now.

    Raises
    ------
    ValueError
        It has no place for it.
    """
    made, places = re.subn(f"(?s){re.escape(_BEGIN)}.*{re.escape(_END)}", lambda _: f"{_BEGIN}\n{found(report)}\n\n{_END}", text)
    if places != 1:
        raise ValueError(f"{PAGE.name} has {places} places for what was found; allowed: one, between {_BEGIN.strip()} and {_END.strip()}")
    return made


if __name__ == "__main__":
    options = argparse.ArgumentParser(description="Write what the study of enforcement found into docs/enforcement.md.")
    options.add_argument("report", nargs="?", type=Path, default=ROOT / "results" / "enforcement" / "report.json")
    PAGE.write_text(page(PAGE.read_text(), json.loads(options.parse_args().report.read_text())))
