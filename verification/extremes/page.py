"""The page "where it can be trusted": every sweep, where the program is right, before and now, and what it says elsewhere."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from extremes import points
from extremes.endings import Ending
from extremes.pictures import COLOURS, picture
from extremes.points import Earlier, Point, Sweep

from isomortar.harness.report import template
from isomortar.harness.runner import Result
from isomortar.harness.store import write_whole

#: Where a family keeps the points of an earlier program, beside its cases.
BEFORE = "before.json"


def write(path: Path, results: Sequence[Result]) -> bool:
    """Write the page of the family's sweeps, given its results; false where none of them is of a sweep."""
    found = [result for result in results if points.is_point(result.cell)]
    if not found:
        return False
    earlier = points.read(found[0].cell.case.path.with_name(BEFORE))
    write_whole(path, page(points.sweeps(found, earlier), [result for result in results if result not in found], earlier))
    return True


def page(sweeps: Sequence[Sweep], others: Sequence[Result], earlier: Earlier) -> str:
    """The HTML page of sweeps, and of the `others`, cases of the family that are none."""
    now = [point for sweep in sweeps for point in sweep.now]
    before = [point for sweep in sweeps for point in sweep.before]
    changes = Counter((was.ending, now_.ending) for was, now_ in zip(before, now, strict=True) if was is not None)
    return template("page.html", Path(__file__)).render(
        endings=sorted(Ending, reverse=True),
        colours=COLOURS,
        now=points.counts(now),
        before=points.counts(before),
        total=len(now),
        wrong=points.counts(now)[Ending.WRONG],
        removed=sum(count for (was, is_), count in changes.items() if was is Ending.WRONG and is_ is not Ending.WRONG),
        worse=[name for sweep in sweeps for name in _worse(sweep)],
        sweeps=[_section(sweep) for sweep in sweeps],
        others=others,
        commit=earlier.commit[:12],
    )


def _worse(sweep: Sweep) -> list[str]:
    """Points that were right before and are not now."""
    return [
        f"{sweep.case.name}: {_label(settings)}"
        for settings, was, now in zip(sweep.settings, sweep.before, sweep.now, strict=True)
        if was is not None and was.ending is Ending.RIGHT and now.ending is not Ending.RIGHT
    ]


def _section(sweep: Sweep) -> dict[str, Any]:
    about = (sweep.case.function.__doc__ or "").strip().split("\n\n")[0]
    return {
        "case": sweep.case,
        "about": about,
        "picture": picture(sweep),
        "right_before": _right(sweep, sweep.before),
        "right_now": _right(sweep, sweep.now),
        "before": points.counts(sweep.before),
        "now": points.counts(sweep.now),
        "said": _said(sweep),
    }


def _right(sweep: Sweep, found: Sequence[Point | None]) -> str:
    """Where a sweep is right: an interval, or for a pair how many of its points."""
    if not any(found):
        return "not measured"
    if len(sweep.case.grid) == 1:
        (name,) = sweep.case.grid
        return points.right_in([settings[name] for settings in sweep.settings], found)
    return f"{points.counts(found)[Ending.RIGHT]} of {len(found)} pairs"


def _said(sweep: Sweep) -> list[tuple[Ending, str, list[str]]]:
    """What was said, each once, with the points at which it was; the worst first. Numbers in it are those of the first point."""
    said: dict[tuple[Ending, str], list[str]] = {}
    for settings, point in zip(sweep.settings, sweep.now, strict=True):
        if point.ending is not Ending.RIGHT:
            said.setdefault((point.ending, point.words), []).append(_label(settings))
    return [(ending, words, where) for (ending, words), where in sorted(said.items(), key=lambda item: item[0][0])]


def _label(settings: dict[str, Any]) -> str:
    return ", ".join(f"{name} {value:.13g}" if isinstance(value, float) else f"{name} {value}" for name, value in settings.items())
