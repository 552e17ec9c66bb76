"""The figures of the page, each as the figure of the paper that it stands for."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass

import numpy as np
from paper.figures import Line, Panel, Picture, bodies, closeups, curves, surfaces
from paper.figures.flat import Quantity
from paper.measures import deviation
from paper.outcome import Outcome, Outcomes
from paper.sections import METHODS, Method, Section

from isomortar.geometry.patch import FloatArray

#: Deviation of curves from each other that is seen in a plot.
VISIBLE = 0.01
#: Heights of L4 in the paper's Fig. 2, over those of the others.
_HEIGHT_OF_L4 = 0.4
NAMES: dict[Method, str] = {"monolithic": "monolithic", "paper": "the paper's method"}


@dataclass(frozen=True)
class Plate:
    """A picture with the name of its file, what it stands for, and what it shows."""

    name: str
    title: str
    caption: str
    picture: Picture


def plates(section: Section, outcomes: Outcomes) -> Iterator[Plate]:
    """The figures of a section. Runs that failed are drawn up to where they came; what never began is left out."""
    return _PLATES[section.scene](_Studio(section, outcomes))


def gap_between_methods(outcomes: Outcomes, outcome: Outcome) -> float | None:
    """Deviation of a monolithic run from that by the paper's method; None where one of them did not come to its end."""
    other = outcomes.named(outcome.section, outcome.variant.name, "paper")
    if outcome.method == "paper" or other is None or outcome.failure or other.failure:
        return None
    return deviation(outcome, other)


class _Studio:
    """Draws runs of a section by name."""

    def __init__(self, section: Section, outcomes: Outcomes) -> None:
        self.section, self._outcomes = section, outcomes

    def first(self, *names: str) -> Outcome | None:
        """The first of these runs that the section has and that converged somewhere."""
        return next(iter(self._begun(names, "monolithic")), None)

    def bodies(self, title: str, name: str, outcome: Outcome | None, field: bodies.Field | None) -> Iterator[Plate]:
        """Deformed bodies at the section's instances."""
        steps = self._instances(outcome)
        if outcome and steps:
            with outcome.results() as results:
                yield Plate(name, title, _words(outcome), bodies.draw(results, steps, field))

    def history(self, title: str, name: str, outcome: Outcome | None, quantity: Quantity, last: bool = False) -> Iterator[Plate]:
        """A field over the contact patch at the section's instances, or the last of them."""
        steps = self._instances(outcome)[-1 if last else 0 :]
        if outcome and steps:
            with outcome.results() as results:
                panels = [Panel(f"load step {step}", results, step) for step in steps]
                yield Plate(name, title, _words(outcome), surfaces.draw(panels, quantity))

    def fields(self, title: str, name: str, runs: Sequence[str], quantity: Quantity, share: float = 1.0) -> Iterator[Plate]:
        """A field over the contact patch of several runs, at a share of the last stage."""
        yield from self._panels(title, name, runs, share, lambda panels: surfaces.draw(panels, quantity))

    def close(self, title: str, name: str, runs: Sequence[str], share: float) -> Iterator[Plate]:
        """The contact zone of several runs from near by, at a share of the last stage."""
        yield from self._panels(title, name, runs, share, closeups.draw)

    def _panels(
        self, title: str, name: str, runs: Sequence[str], share: float, draw: Callable[[Sequence[Panel]], Picture]
    ) -> Iterator[Plate]:
        with ExitStack() as opened:
            panels = []
            for outcome in self._begun(runs, "monolithic"):
                step = _step_at(outcome, share)
                if step is not None:
                    scale = _HEIGHT_OF_L4 if outcome.variant.kind == "L4" else 1.0
                    panels.append(Panel(_label(outcome), opened.enter_context(outcome.results()), step, scale))
            if panels:
                yield Plate(name, title, f"{NAMES['monolithic']}, load step {panels[0].step}", draw(panels))

    def curves(self, title: str, name: str, runs: Sequence[str], methods: Sequence[Method] = METHODS) -> Iterator[Plate]:
        """Curves of several runs; by the paper's method a second time where one of them differs visibly."""
        for method in methods:
            begun = self._begun(runs, method)
            if len(begun) > 1 and (method == methods[0] or self._differ(runs)):
                picture = curves.draw([self._line(o) for o in begun], title, self.section.quantity.label)
                yield Plate(f"{name}-{method}", title, NAMES[method], picture)

    def _differ(self, names: Sequence[str]) -> bool:
        return any((gap_between_methods(self._outcomes, o) or 0.0) > VISIBLE for o in self._begun(names, "monolithic"))

    def _begun(self, names: Sequence[str], method: Method) -> list[Outcome]:
        """Runs of which something converged; the reference is meant by its own name too."""
        found = [self._outcomes.named(self.section, name, method) for name in names]
        return [o for o in found if o and o.numbers]

    def _instances(self, outcome: Outcome | None) -> list[int]:
        return [step for step in self.section.instances if step <= outcome.steps] if outcome else []

    def _line(self, outcome: Outcome) -> Line:
        return Line(
            _label(outcome), self._times(outcome), outcome.curve, outcome.variant.kind, outcome.variant.name == self.section.reference
        )

    def _times(self, outcome: Outcome) -> FloatArray:
        """Load times as of the section's first run, whatever the size of the load steps."""
        ends = np.cumsum([0, *(stage.steps for stage in self.section.load(self.section.variants[0], outcome.method).tables.stages)])
        stage = outcome.array("stage").astype(int)
        return ends[stage] + outcome.array("share") * np.diff(ends)[stage]


def _press(studio: _Studio) -> Iterator[Plate]:
    shown = ("reference", "N2", "N3", "N4", "L1-fine", "L1", "L2", "L3", "L4")
    yield from studio.bodies("Fig. 1: the pressed block", "fig-1-bodies", studio.first("reference"), "stress")
    yield from studio.fields("Fig. 1: gap in the contact zone", "fig-1-gap", ("reference",), "gap")
    yield from studio.fields("Fig. 2: contact pressure", "fig-2-pressure", shown, "pressure")
    yield from studio.fields("Fig. 3: tangential traction", "fig-3-traction", shown, "traction")
    yield from studio.curves("Pressing force", "press-force", shown)


def _twist(studio: _Studio) -> Iterator[Plate]:
    fine = studio.first("fine", "reference")
    yield from studio.bodies("Fig. 4: pressed and twisted", "fig-4-bodies", fine, "stress")
    yield from studio.history("Fig. 5: tangential traction", "fig-5-traction", fine, "traction")
    yield from studio.history("Fig. 5: contact pressure at the end", "fig-5-pressure", fine, "pressure", last=True)
    yield from studio.curves("Fig. 6: orders", "fig-6-orders", (*studio.section.series["N"], "reference"))
    yield from studio.curves("Fig. 6: the same number of control points", "fig-6-coarse", ("N2", "coarse", "reference"))
    yield from studio.curves("Fig. 6: the fine N2 against N5", "fig-6-fine", ("fine", "N5", "reference"))
    variants = ("N2", "ten-points", "more-steps", "tolerance")
    yield from studio.curves("Fig. 6: numerical parameters of N2", "fig-6-parameters", variants, ("paper",))
    yield from studio.curves("Penalties and tolerances of N2", "twist-penalties", ("N2", "tight", "soft", "soft-tolerance"), ("paper",))
    yield from _lagrange(studio)


def _lagrange(studio: _Studio) -> Iterator[Plate]:
    scene, series = studio.section.scene, studio.section.series
    yield from studio.curves("Lagrange elements as master and as slave", f"{scene}-lagrange", (*series["Lagrange"], "reference"))
    masters = ("L1", "L2", *series["averaged"], "reference")
    yield from studio.curves("Lagrange masters by closest points and along averaged normals", f"{scene}-averaged", masters, ("monolithic",))


def _iron(studio: _Studio) -> Iterator[Plate]:
    fine = studio.first("B", "A", "N2")
    yield from studio.bodies("Fig. 7: pressed and dragged", "fig-7-bodies", fine, "stretch")
    yield from studio.history("Fig. 8: contact pressure", "fig-8-pressure", fine, "pressure")
    yield from studio.history("Fig. 8: traction along the drag", "fig-8-traction-1", fine, "traction")
    yield from studio.history("Fig. 8: traction across the drag", "fig-8-traction-2", fine, "traction_2")
    yield from studio.curves("Fig. 9: orders", "fig-9-orders", studio.section.series["N"])
    yield from studio.curves(
        "Fig. 9: N5 against finer N2 (A, B) and lower pressures (C, D)", "fig-9-smoothness", ("A", "B", "C", "D", "reference")
    )
    yield from _lagrange(studio)


def _tire(studio: _Studio) -> Iterator[Plate]:
    orders, matched = studio.section.series["L"], studio.section.series["matched"]
    yield from studio.bodies("Fig. 10: the rolling tire", "fig-10-bodies", studio.first("N2"), "stress")
    yield from studio.close("Fig. 11: the contact zone midway", "fig-11-zone", ("N2", *orders), 0.5)
    yield from studio.fields("Contact pressure midway", "tire-pressure", ("N2", "N3", *orders), "pressure", 0.5)
    yield from studio.curves("Rolling torque of NURBS", "tire-nurbs", studio.section.series["N"])
    yield from studio.curves("Fig. 12: the same number of nodes", "fig-12-nodes", (*orders, "reference"))
    yield from studio.curves("Fig. 12: control points of the next order of NURBS", "fig-12-matched", (*matched, "reference"))
    variants = ("L2", "L2-tolerance", "L2-points")
    yield from studio.curves("Numerical parameters of L2", "tire-parameters", variants, ("paper",))


_PLATES: dict[str, Callable[[_Studio], Iterator[Plate]]] = {"press": _press, "twist": _twist, "iron": _iron, "tire": _tire}


def _label(outcome: Outcome) -> str:
    name = f"{outcome.variant.name} (reference)" if outcome.variant.name == outcome.section.reference else outcome.variant.name
    return f"{name}, to step {outcome.steps}" if outcome.failure else name


def _words(outcome: Outcome) -> str:
    return f"{_label(outcome)}: {outcome.variant.title}; {NAMES[outcome.method]}"


def _step_at(outcome: Outcome, share: float) -> int | None:
    """The recorded load step of the last stage nearest to a share of it; None where the run did not come there."""
    stages = outcome.section.load(outcome.variant, outcome.method).tables.stages
    step = sum(stage.steps for stage in stages[:-1]) + round(share * stages[-1].steps)
    return step if step <= outcome.steps else None
