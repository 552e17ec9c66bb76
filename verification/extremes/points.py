"""Points of the sweeps: how each ended now and with an earlier program, and the intervals in which the program is right."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from itertools import groupby
from pathlib import Path
from typing import Any

from extremes.endings import Ending

from isomortar.errors import InputError
from isomortar.harness.cases import Bound, Case, Cell, Words
from isomortar.harness.measurement import Measurement, restored
from isomortar.harness.runner import Result
from isomortar.results.files import write_whole


@dataclass(frozen=True)
class Point:
    """How one point ended: digits in common with what is right, and what was said."""

    ending: Ending
    digits: float
    words: str


@dataclass(frozen=True)
class Sweep:
    """A case whose cells are points: settings of each with how it ended now and before (None: not measured)."""

    case: Case
    settings: list[dict[str, Any]]
    now: list[Point]
    before: list[Point | None]

    def label(self, number: int) -> str:
        """A point by its settings, as people read them."""
        settings = self.settings[number]
        return ", ".join(f"{name} {value:.13g}" if isinstance(value, float) else f"{name} {value}" for name, value in settings.items())

    def claimed(self, number: int) -> Ending:
        """The worst ending that a point may have."""
        bound = self.case.bounds_of(self.settings[number])["ending"]
        assert isinstance(bound, Bound)
        return Ending(int(bound.at_least or 0))


@dataclass(frozen=True)
class Earlier:
    """Points measured with an earlier program, by the name of their cell, and its commit."""

    commit: str
    points: Mapping[str, Point]


def is_point(cell: Cell) -> bool:
    """Whether a cell is a point of a sweep."""
    return "ending" in cell.case.bounds_of(cell.settings)


def point_of(measurement: Measurement) -> Point:
    """A point from the measurement of its cell; what ended in another way than by a measurement is wrong."""
    numbers = measurement.numbers
    words = restored(numbers.get("words"), Words)
    ending, kept = numbers.get("ending"), numbers.get("digits")
    if measurement.ending != "measured" or words is None or not isinstance(ending, float) or not isinstance(kept, float):
        return Point(Ending.WRONG, 0.0, measurement.reason)
    return Point(Ending(int(ending)), kept, words.text)


def sweeps(results: Sequence[Result], earlier: Earlier) -> list[Sweep]:
    """The sweeps among the results of a run, by name."""
    points = sorted((result for result in results if is_point(result.cell)), key=lambda result: result.cell.case.name)
    return [_sweep(list(group), earlier) for _, group in groupby(points, key=lambda result: result.cell.case.name)]


def _sweep(results: list[Result], earlier: Earlier) -> Sweep:
    cells = [result.cell for result in results]
    now = [point_of(result.measurement) for result in results]
    return Sweep(cells[0].case, [cell.settings for cell in cells], now, [earlier.points.get(cell.name) for cell in cells])


def counts(points: Sequence[Point | None]) -> Counter[Ending]:
    """How many points ended in each way."""
    return Counter(point.ending for point in points if point is not None)


def right_in(values: Sequence[Any], points: Sequence[Point | None]) -> str:
    """The values of a sweep at which the program is right: intervals of neighbours where they are numbers, else a list."""
    right = [point is not None and point.ending is Ending.RIGHT for point in points]
    if all(isinstance(value, str) for value in values):
        return ", ".join(value for value, is_right in zip(values, right, strict=True) if is_right) or "none"
    runs = [[value for value, _ in group] for is_right, group in groupby(zip(values, right, strict=True), key=lambda p: p[1]) if is_right]
    return "; ".join(f"{run[0]:.13g}" if len(run) == 1 else f"{run[0]:.13g} to {run[-1]:.13g}" for run in runs) or "none"


def read(path: Path) -> Earlier:
    """What `write` wrote; nothing where there is no file.

    Raises
    ------
    InputError
        The file is something else.
    """
    if not path.exists():
        return Earlier("", {})
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
        points = {
            name: Point(Ending[point["ending"].upper()], float(point["digits"]), point["words"]) for name, point in data["points"].items()
        }
        return Earlier(data["commit"], points)
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise InputError(f"is no file of points that an earlier program gave: {error!r}", str(path)) from error


def write(path: Path, earlier: Earlier) -> None:
    """Keep the points of a program, one a line, as data of later pages."""
    lines = [f"  {json.dumps(name)}: {json.dumps(_plain(point), ensure_ascii=False)}" for name, point in sorted(earlier.points.items())]
    write_whole(path, f'{{"commit": {json.dumps(earlier.commit)}, "points": {{\n' + ",\n".join(lines) + "\n}}\n")


def _plain(point: Point) -> dict[str, Any]:
    return asdict(point) | {"ending": point.ending.name.lower(), "digits": round(point.digits, 2)}
