"""The page of the paper's sections: one HTML file that needs nothing else, all its numbers as JSON, and its figures as files."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from datetime import datetime
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from paper.outcome import Outcome, Outcomes
from paper.plates import NAMES, Plate, gap_between_methods, plates
from paper.sections import METHODS, Section
from paper.settled import Settled

from isomortar.harness.report import percent, plain, template
from isomortar.harness.statement import STATEMENT_STATES, Judgement
from isomortar.harness.store import identity
from isomortar.results.files import write_whole


@dataclass(frozen=True)
class Report:
    """All that the page shows.

    `left_out` counts the statements that these sections have not the runs for; `settled` has over-refined curves by scene.
    """

    outcomes: Outcomes
    judgements: tuple[Judgement, ...]
    left_out: int
    quick: bool
    started: datetime
    settled: Mapping[str, Settled]

    @property
    def counts(self) -> dict[str, int]:
        """Statements by verdict."""
        found = Counter(judgement.state for judgement in self.judgements)
        return {state: found[state] for state in reversed(STATEMENT_STATES)}

    @property
    def failed(self) -> list[Outcome]:
        """Runs that did not come to their end."""
        return [o for o in self.outcomes.entries if o.failure]

    def off(self, outcome: Outcome) -> float | None:
        """Distance of a run from the section's over-refined curve; None where there is none."""
        settled = self.settled.get(outcome.section.scene)
        return settled.distance(outcome) if settled else None

    @property
    def complete(self) -> bool:
        """Whether all runs came to their end (Lagrange elements: or to where they do not converge) and all statements were measured."""
        return all(o.variant.lagrange and not o.lost for o in self.failed) and not self.counts["not measured"]


def write(folder: Path, report: Report, jobs: int) -> Path:
    """Write ``paper.html``, ``paper.json`` and ``figures/``, `jobs` sections at the same time; returns the path of the page."""
    path = folder / "paper.html"
    (folder / "figures").mkdir(parents=True, exist_ok=True)
    sections = report.outcomes.sections
    with ProcessPoolExecutor(jobs, get_context("spawn")) as pool:  # pictures take minutes
        drawn = pool.map(partial(_drawn, folder / "figures", report.outcomes), sections)
        write_whole(path, page(report, {section.scene: found for section, found in zip(sections, drawn, strict=True)}))
    write_whole(path.with_suffix(".json"), json.dumps(plain(as_data(report)), indent=1))
    return path


def as_data(report: Report) -> dict[str, Any]:
    """All numbers of the page as plain data."""
    return {
        "started": report.started.isoformat(timespec="seconds"),
        "quick": report.quick,
        **identity(),
        "verdicts": report.counts,
        "statements": [judgement.as_data() for judgement in report.judgements],
        "runs": [_run(report, outcome) for outcome in report.outcomes.entries],
    }


def _drawn(folder: Path, outcomes: Outcomes, section: Section) -> list[dict[str, str]]:
    """The figures of a section, whose files are written."""
    return [_saved(folder, plate) for plate in plates(section, outcomes)]


def _saved(folder: Path, plate: Plate) -> dict[str, str]:
    """What the page shows of a figure whose file is written; the figure itself is large and not kept. Plots have their title in them."""
    plate.picture.save(folder / plate.name)
    return {"title": "" if plate.picture.vector else plate.title, "caption": plate.caption, "html": plate.picture.html}


def page(report: Report, drawn: Mapping[str, Sequence[Mapping[str, str]]]) -> str:
    """The HTML page, with the figures by section."""
    return template("page.html", Path(__file__)).render(
        report=report,
        sections=[
            (section, _rows(report, section), drawn[section.scene], _seconds(report.outcomes.of(section)))
            for section in report.outcomes.sections
        ],
        names=NAMES,
        total=_seconds(report.outcomes.entries),
        percent=percent,
    )


def _rows(report: Report, section: Section) -> list[list[tuple[Outcome, float | None, float | None]]]:
    """Runs of a section with their outcomes by method, how far these are from each other, and from the over-refined curve."""
    outcomes = report.outcomes
    found = [[outcomes.named(section, variant.name, method) for method in METHODS] for variant in section.variants]
    return [[(o, gap_between_methods(outcomes, o), report.off(o)) for o in row if o] for row in found]


def _seconds(outcomes: Sequence[Outcome]) -> float:
    return float(sum(o.numbers["seconds"] for o in outcomes if o.numbers))


def _run(report: Report, outcome: Outcome) -> dict[str, Any]:
    return {
        "key": outcome.key,
        "method": outcome.method,
        "title": outcome.variant.title,
        "command": outcome.section.command(outcome.variant, outcome.method),
        "failure": outcome.failure or None,
        "lost": outcome.lost,
        "load_steps": [outcome.steps, outcome.total_steps],
        "from_the_papers_method": gap_between_methods(report.outcomes, outcome),
        "from_the_over_refined_curve": report.off(outcome),
        **outcome.numbers,
    }
