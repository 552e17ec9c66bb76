"""Which way to take for which purpose: sentences that are made of the page's numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
from enforcement.exact import CURVED
from enforcement.found import Found, Known
from enforcement.known import KIND
from enforcement.patches import CURVED_ORDERS, ROWS
from enforcement.plan import MORTAR, REFERENCE

from isomortar.harness.report import stated
from isomortar.harness.runs import Computed

NOT_MEASURED = "not measured"
#: Error of the patch test on meshes that match up to which a method passes it: what fails there does not converge.
PASSED = 1e-6
#: Of the sentence about the paper's comparison.
ORDER = 2

#: By way and scene; NaN: not known.
Values = Mapping[str, Mapping[str, float]]


@dataclass(frozen=True)
class Advice:
    """What to take for a purpose.

    Parameters
    ----------
    purpose, measure, text : str
        What for, by which numbers, and what they say.
    ratios : dict of str to float
        By way: the largest ratio of its number to the best one of the same scene; the best ways first.
    """

    purpose: str
    measure: str
    text: str
    ratios: Mapping[str, float]


def advice(runs: Sequence[Found], known: Sequence[Known], table: Sequence[Mapping[str, Any]]) -> list[Advice]:
    """All purposes, of the curves of scenes, of known tractions, and of what is exact."""
    patches, curved = (
        {
            method: {f"order {row['order']}": row[key] for row in table if row["method"] == method and row["order"] >= least}
            for method in ROWS
        }
        for key, least in (("other", 1), (CURVED["closest"], CURVED_ORDERS[0]))
    )
    at_order = [run for run in known if run.kind == KIND]
    tractions = by_way(at_order, {id(run): run.number("off") for run in at_order})
    failing: dict[str, float] = {}
    for row in table:
        if row["matching"] > PASSED:
            failing[row["method"]] = max(row["matching"], failing.get(row["method"], 0.0))
    at_one = [run for run in runs if not run.planned.setup.order]
    smooth = [run for run in at_one if not run.planned.setup.kinks]
    kinked = [run for run in at_one if run.planned.setup.kinks]
    high = [run for run in runs if run.planned.setup.order > ORDER]
    return [
        *of_scenes(smooth, "of splines", failing),
        *of_scenes(kinked, "of a master with kinks", failing),
        *of_scenes(high, "of higher orders", failing),
        best("Pressures and tractions", "distance of the tractions from those of theory", tractions, percent=True),
        best("Flat interfaces, patch test", "error of the patch test on meshes that do not match", patches, percent=True),
        best("Curved interfaces, patch test", "error of the curved patch test on meshes that do not match", curved, percent=True),
        comparison(known, table),
    ]


def of_scenes(runs: Sequence[Found], which: str, failing: Mapping[str, float]) -> tuple[Advice, ...]:
    """For resultants, for speed and for few solves, of some of the scenes."""
    references = {run.name: run for run in runs if run.method == REFERENCE}
    others = [run for run in runs if run.method != REFERENCE]
    off = by_way(others, {id(run): run.off(references[run.name]) for run in others})
    solves = by_way(others, {id(run): run.number("solves") if run.ending == "measured" else np.nan for run in others})
    cost = by_way(others, {id(run): run.number("cpu_seconds") if run.ending == "measured" else np.nan for run in others})
    return (
        best(f"Resultants {which}", "distance of the curves from those of finer meshes", off, percent=True, failing=failing),
        best(f"Speed {which}", "CPU seconds of runs that come to their end", cost, unit=" s", failing=failing),
        best(f"Robustness {which}", "linear solves of runs that come to their end", solves, failing=failing),
    )


def by_way(runs: Sequence[Computed], values: Mapping[int, float]) -> dict[str, dict[str, float]]:
    """Values of runs, known by their identity, by way and scene."""
    found: dict[str, dict[str, float]] = {}
    for run in runs:
        found.setdefault(run.method, {})[run.name] = values[id(run)]
    return found


def best(
    purpose: str, measure: str, values: Values, percent: bool = False, unit: str = "", failing: Mapping[str, float] = MappingProxyType({})
) -> Advice:
    """The way that is nowhere far from the best one: its largest ratio to the best of a scene is the smallest.

    `failing`: largest errors of methods that fail the patch test on meshes that match. They, and a way that lacks a number of
    a scene that it has, are no candidates; what it has counts where the best of a scene is looked for.
    """
    lost = {way: [scene for scene, value in own.items() if not np.isfinite(value)] for way, own in values.items()}
    barred = {way: failing[way.partition(",")[0]] for way in values if way.partition(",")[0] in failing}
    whole = {way: own for way, own in values.items() if own and not lost[way] and way not in barred}
    if not whole:
        return Advice(purpose, measure, NOT_MEASURED, {})
    scenes = {scene for own in whole.values() for scene in own}
    least = {scene: float(np.nanmin([own.get(scene, np.nan) for own in values.values()])) for scene in scenes}
    worst = {way: sorted((_ratio(own[scene], least[scene]), scene) for scene in own)[-1] for way, own in whole.items()}
    ranked = sorted(worst, key=lambda way: worst[way][0])
    first = ranked[0]
    ratio, scene = worst[first]
    shown = stated(whole[first][scene], percent) + unit
    text = f"Take {first}: of {', '.join(whole[first])} "
    text += (
        "it is the best everywhere, "
        if ratio == 1.0
        else f"it is at most {ratio:.3g} times the best ({scene}: {shown}, {stated(least[scene], percent)}{unit} at best), "
    )
    text += "; ".join(f"{name} {stated(value, percent)}{unit}" for name, value in whole[first].items()) + "."
    if others := [f"{way} {worst[way][0]:.3g} ({worst[way][1]})" for way in ranked[1:]]:
        text += f" The others at most: {', '.join(others)} times the best."
    if barred:
        told = ", ".join(f"{way} ({stated(error, True)})" for way, error in barred.items())
        text += f" No candidates, as they fail the patch test on meshes that match: {told}."
    if missing := [f"{way} ({', '.join(lost[way])})" for way in values if lost[way] and way not in barred]:
        text += f" No candidates, as numbers are missing: {', '.join(missing)}."
    return Advice(purpose, measure, text, {way: worst[way][0] for way in ranked})


def _ratio(value: float, least: float) -> float:
    return value / least if least else 1.0 if value == least else np.inf


def comparison(known: Sequence[Known], table: Sequence[Mapping[str, Any]]) -> Advice:
    """What each of the ways that the paper names shows, at one order."""
    rows = {row["method"]: row for row in table if row["order"] == ORDER}
    peaks = {run.method: run.number("peak") for run in known if (run.name, run.kind) == ("hertz", KIND)}
    words = []
    for way, key, noun in (("kts", "too many", "too many constraints"), ("knots", "too few", "too few")):
        if all(np.isfinite((rows[way][key], peaks.get(way, np.nan)))):
            words.append(f"{way} for {noun} ({rows[way][key]:g}; largest pressure {peaks[way]:.3g} times Hertz's)")
    for way in ("greville", MORTAR):
        both = rows[way]["matching"], rows[way]["other"]
        if np.isfinite(both).all():
            words.append(f"{way} for the patch test on meshes that match ({stated(both[0], True)}) and do not ({stated(both[1], True)})")
    text = f"Show, at order {ORDER}: {'; '.join(words)}." if words else NOT_MEASURED
    return Advice("Teaching, the paper's comparison", "constraints too many and too few, largest pressure, patch test", text, {})
