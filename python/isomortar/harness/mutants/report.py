"""The report of a campaign: one HTML page that needs nothing else, the same as JSON, and entries for survivors nobody classified."""

from __future__ import annotations

import json
from dataclasses import asdict
from datetime import datetime
from pathlib import Path
from typing import Any

from isomortar.harness.mutants.campaign import Attacked
from isomortar.harness.mutants.score import CLASSES, Score
from isomortar.harness.report import template
from isomortar.results.files import write_whole


def write(path: Path, score: Score, settings: dict[str, Any]) -> None:
    """Write the page, and beside it the same as ``.json``. `settings` are those of the campaign, shown as they are."""
    when = datetime.now().astimezone().isoformat(timespec="minutes")
    page = template("mutants/report.html")
    entries = unclassified(score)
    write_whole(path, page.render(score=score, settings=settings, when=when, classes=CLASSES, entries=entries))
    write_whole(path.with_suffix(".json"), json.dumps(_as_data(score, settings, when), indent=1))


def unclassified(score: Score) -> str:
    """Entries for ``surviving_mutants.toml``, with class and reason left open."""
    open_ones = [a for a in score.survivors if a.fault.key not in score.classified]
    return "\n".join(_entry(a) for a in open_ones)


def _entry(attacked: Attacked) -> str:
    fault = attacked.fault
    texts = {"key": fault.key, "place": fault.place, "old": fault.old.strip(), "new": fault.new.strip(), "class": "", "reason": ""}
    return "[[survivor]]\n" + "".join(f"{name} = {json.dumps(text)}\n" for name, text in texts.items())


def _as_data(score: Score, settings: dict[str, Any], when: str) -> dict[str, Any]:
    shares = {"planted": score.caught_planted, "sample": score.caught, "sample without equivalent": score.caught_of_real}
    return {
        "when": when,
        "settings": settings,
        "passes": score.passes,
        "least share": score.least_share,
        "shares": {name: {**asdict(share), "interval": share.interval} for name, share in shares.items()},
        "folders": {folder: [asdict(share) for share in shares] for folder, shares in score.caught_by_folder.items()},
        "dropped": score.tally.dropped,
        "unused cells": score.tally.unused,
        "seconds of the gate": sum(score.tally.seconds.values()),
        "catches": score.catches,
        "faults": [
            {
                **asdict(a.fault),
                "killer": a.finding.killer,
                "found": a.finding.found,
                "cells passed": len(a.finding.passed),
                "whole gate": a.whole,
                "class": None if a.finding.killer else score.kind(a),
            }
            for a in score.tally.attacked
        ],
    }
