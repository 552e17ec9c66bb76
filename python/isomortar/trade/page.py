"""The page of a trade, its numbers as JSON, and the scene files that it recommends."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from datetime import datetime
from pathlib import Path
from typing import Any

from isomortar.harness.report import percent, plain, template
from isomortar.harness.store import identity
from isomortar.results.files import write_whole
from isomortar.scene.scene import Scene
from isomortar.scene.source import as_options
from isomortar.solve.timing import PHASES
from isomortar.trade import figures
from isomortar.trade.advice import CheaperSearch
from isomortar.trade.laboratory import Tried
from isomortar.trade.model import Yardstick
from isomortar.trade.search import Recommendation, Search
from isomortar.trade.want import wanted, wishes

#: What a recommendation ends with where the budget was spent before the forecasts of the search named nothing cheaper any more.
_CUT = "; the budget ended the search, and something cheaper may do (--budget)"


def sentence(search: Search, answer: Recommendation) -> str:
    """The answer in words, with its numbers."""
    if answer.best is None:
        return f"Within {percent(answer.target)}: nothing is recommended; {answer.why}."
    if isinstance(search, CheaperSearch):
        times = search.own.cost / answer.best.cost
        saved = f", {times:.2g} times less than as it is" if times > 1 else "; run afresh it saves nothing: keep the scene as it is"
        return f"{answer.best.name}: loses {percent(answer.error)} for {_seconds(answer.best.cost)}{saved}{_CUT if answer.cut else ''}."
    parts = [f"{answer.best.name}: {percent(answer.error)} ± {percent(search.uncertainty)} for {_seconds(answer.best.cost)}"]
    if answer.best.choice != search.own.choice:
        parts.append(f"the scene as it is: {percent(search.error(search.own))} for {_seconds(search.own.cost)}")
    if answer.binding:
        parts.append(f"the binding knob is {answer.binding}")
    others = [(order, outcome) for order, outcome in answer.by_order.items() if order != search.order(answer.best.choice)]
    rest = [f"order {order} " + (f"needs {_seconds(o.cost)}" if o else "was not found to do") for order, o in others]
    return "; ".join([*parts, *rest]) + f"{_CUT if answer.cut else ''}."


def spoken(search: Search, answer: Recommendation) -> str:
    """The answer as a terminal shows it, with what the recommended scene warns of."""
    return "\n".join([sentence(search, answer), *(f"  warning: {warning}" for warning in _warnings(answer))])


def _warnings(answer: Recommendation) -> list[str]:
    """What the recommended scene warns of when it is run."""
    return answer.best.warnings if answer.best else []


def write(folder: Path, scene: Scene, search: Search, answers: Sequence[Recommendation], started: datetime) -> Path:
    """Write ``report.html``, ``report.json`` and a scene file a recommendation; returns the path of the page."""
    files = {answer.target: _recommended(folder, search, answer) for answer in answers}
    path = folder / "report.html"
    write_whole(path, _page(scene, search, answers, files, started))
    write_whole(path.with_suffix(".json"), json.dumps(plain(_data(scene, search, answers, started)), indent=1))
    return path


def _recommended(folder: Path, search: Search, answer: Recommendation) -> Path | None:
    if answer.best is None:
        return None
    path = folder / f"within-{100 * answer.target:g}-percent.toml"
    write_whole(path, search.laboratory.scene(answer.best.choice).to_toml())
    return path


def _page(scene: Scene, search: Search, answers: Sequence[Recommendation], files: dict[float, Path | None], started: datetime) -> str:
    assert search.truth
    assert search.rival
    shown = [("as it is", search.own), *((f"within {percent(a.target)}", a.best) for a in answers if a.best)]
    return template("page.html", Path(__file__)).render(
        scene=scene,
        advised=isinstance(search, CheaperSearch),
        started=started,
        wants=search.wants,
        own=search.own,
        own_error=search.error(search.own),
        truth=search.truth,
        rival=search.rival,
        uncertainty=search.uncertainty,
        complete=all(answer.best for answer in answers),
        spent=search.laboratory.spent,
        answers=[
            {
                "target": a.target,
                "best": a.best,
                "sentence": sentence(search, a),
                "warnings": _warnings(a),
                "file": files[a.target],
                "overrides": as_options(search.laboratory.overrides(a.best.choice)) if a.best else "",
            }
            for a in answers
        ],
        precision=figures.precision(search, answers),
        screening=figures.screening(search),
        curves=[(y.want.text, figures.curves(search, y, answers)) for y in search.yardsticks],
        dials=search.dials,
        columns=[name for name, _ in shown],
        errors=_errors(scene, search, [outcome for _, outcome in shown]),
        phases=PHASES,
        runs=[_row(search, outcome) for outcome in search.laboratory.outcomes.values()],
        percent=percent,
    )


def _errors(scene: Scene, search: Search, shown: Sequence[Tried]) -> list[dict[str, Any]]:
    """Errors of all that users look at, of some runs; what is nothing in the truth is left out."""
    assert search.truth
    problem = scene.problem()
    yardsticks = [Yardstick(wanted(text, problem), search.truth, *search.rivals) for text in wishes(problem)]
    return [
        {"text": y.want.text, "uncertainty": y.uncertainty, "shown": [y.error(outcome) for outcome in shown]}
        for y in yardsticks
        if y.size > 0.0
    ]


def _row(search: Search, outcome: Tried) -> dict[str, Any]:
    row = {"name": outcome.name, "failure": outcome.failure, "cost": outcome.cost, "memory": outcome.memory}
    if outcome.failure:
        return row
    counts = {name: outcome.numbers[name] for name in ("unknowns", "solves", "cuts")}
    return row | counts | {"error": search.error(outcome), "parts": outcome.numbers["phases"]}


def _data(scene: Scene, search: Search, answers: Sequence[Recommendation], started: datetime) -> dict[str, Any]:
    """All numbers as plain data."""
    runs = [_row(search, outcome) for outcome in search.laboratory.outcomes.values()]
    return {
        "scene": scene.name,
        "started": started.isoformat(timespec="seconds"),
        **identity(),
        "wanted": [want.text for want in search.wants],
        "uncertainty": search.uncertainty,
        "truth": search.truth.numbers if search.truth else {},
        "front": [
            {"name": o.name, "error": search.error(o), "cpu_seconds": o.cost}
            for o in figures.pareto(search, [o for o in search.laboratory.outcomes.values() if o not in (search.truth, *search.rivals)])
        ],
        "answers": [
            {
                "target": a.target,
                "sentence": sentence(search, a),
                "warnings": _warnings(a),
                "error": a.error,
                "cpu_seconds": a.best.cost if a.best else math.nan,
                "overrides": search.laboratory.overrides(a.best.choice) if a.best else [],
                "binding": a.binding,
                "by_order": {order: outcome.cost if outcome else math.nan for order, outcome in a.by_order.items()},
            }
            for a in answers
        ],
        "runs": runs,
    }


def _seconds(value: float) -> str:
    return f"{value:.2g} s" if value < 100 else f"{value:.0f} s"
