"""What a study found, in a sentence: the cheapest way to a number, what other orders cost for it, and how to write it."""

from __future__ import annotations

from dataclasses import dataclass

from orders.analysis import Analysis, Point

from isomortar.accuracy.discretisations import overrides, parse_kind
from isomortar.harness.report import percent
from isomortar.scene.source import as_options

#: Errors that are asked for: of each measure the smallest that a run is within, for all that the reference knows.
TARGETS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5)
#: Cost ratio below which two kinds cost the same: CPU seconds of small runs scatter by as much.
SAME = 1.1


@dataclass(frozen=True)
class Finding:
    """Of a measure: the error that was asked for, the cheapest run of each kind that is within it, cheapest first, and the other kinds."""

    measure: str
    target: float
    within: tuple[Point, ...]
    beyond: tuple[str, ...]

    @property
    def sentence(self) -> str:
        """What it is, for a person."""
        best, *others = self.within
        elements = "x".join(map(str, best.discretisation.elements))
        words = [
            f"The {self.measure} within {percent(self.target)}: {best.discretisation.kind} on {elements} elements, {_seconds(best):.2g} s"
        ]
        if others:
            words.append(", ".join(f"{p.discretisation.kind} takes {_seconds(p) / _seconds(best):.2g} times that" for p in others))
        if self.beyond:
            words.append(f"{', '.join(self.beyond)} {'is' if len(self.beyond) == 1 else 'are'} not within it on the meshes tried")
        return "; ".join(words) + "."

    @property
    def elevation(self) -> str:
        """Whether a higher order of splines pays: the cheapest above the lowest that was tried, against that."""
        splines = {parse_kind(p.discretisation.kind)[1]: p for p in self.within if p.discretisation.kind[0] == "N"}
        if len(splines) < 2:
            return ""
        lowest = min(splines)
        higher = min((order for order in splines if order > lowest), key=lambda order: _seconds(splines[order]))
        share = _seconds(splines[lowest]) / _seconds(splines[higher])
        verdict = "pays" if share > SAME else "does not pay" if share < 1 / SAME else "costs the same"
        return f"Raising the order {verdict}: N{higher} takes {1 / share:.2g} times as long as N{lowest}."


def findings(analysis: Analysis) -> list[Finding]:
    """One for each measure of which some run is within a target, its error and what the reference may be off taken together."""
    found = []
    for measure in analysis.measures:
        for target in TARGETS:
            within = {kind: _cheapest(analysis, kind, [(measure, target)]) for kind in analysis.plan.kinds}
            there = sorted((point for point in within.values() if point), key=_seconds)
            if there:
                found.append(Finding(measure, target, tuple(there), tuple(kind for kind, point in within.items() if not point)))
                break
    return found


def recommended(analysis: Analysis, found: list[Finding]) -> list[str]:
    """Overrides of the cheapest run that is within all of the targets; none where no run is."""
    targets = [(finding.measure, finding.target) for finding in found]
    points = [point for kind in analysis.plan.kinds if (point := _cheapest(analysis, kind, targets))]
    if not (targets and points):
        return []
    return overrides(analysis.plan.scene, analysis.plan.sweep, min(points, key=_seconds).discretisation)


def summary(analysis: Analysis) -> list[str]:
    """What to say at the end: of the first measure, whether raising the order pays for it, what errors are of, and what is recommended."""
    found = findings(analysis)
    if not found:
        return [f"No run is known to be within {percent(TARGETS[-1])} of anything: nothing is recommended."]
    chosen = recommended(analysis, found)
    asked = ", ".join(f"{finding.measure} within {percent(finding.target)}" for finding in found)
    advice = f"Recommended for {asked}: {as_options(chosen)}" if chosen else f"No run has all of: {asked}."
    swept = f"{analysis.plan.sweep.body} along {' and '.join(analysis.plan.sweep.directions)}"
    alone = f"Errors are those of the mesh of {swept} alone; isomortar trade tells those of the whole scene."
    return [sentence for sentence in (found[0].sentence, found[0].elevation, alone, advice) if sentence]


def _cheapest(analysis: Analysis, kind: str, targets: list[tuple[str, float]]) -> Point | None:
    """The cheapest run of a kind that is within errors of measures, as are all on finer meshes: one that is by luck does not count."""
    found: list[Point] = []
    for point in reversed([p for p in analysis.sequence(kind) if p.errors]):
        if any(not point.errors[measure] + analysis.uncertainty[measure] <= target for measure, target in targets):
            break
        found.append(point)
    return min(found, key=_seconds, default=None)


def _seconds(point: Point) -> float:
    return float(point.numbers["cpu_seconds"])
