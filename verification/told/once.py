"""What is said in the course of a run that goes on after it: once, however long what it is about lasts."""

from __future__ import annotations

from dataclasses import replace

from told.astray import TURNING
from told.other_units import of_a_run
from told.pivoting import FLAT
from told.rolling import RING
from told.runs import LONG, PLATES
from told.wrong.runs import RUNS

from isomortar.harness import Bound, case
from isomortar.model.entities import Motion, Problem, Stage
from isomortar.scene import Scene

#: Runs of which something is said; of friction that is led astray a second time on the way back.
TOLD = {name: text for name, (text, words) in (RUNS | PLATES).items() if words and name not in LONG}
TOLD["astray"] = TURNING.replace("[0, 0.4, 0] }]", '[0, 0.4, 0] }, { name = "b", steps = 1, motions.top.translate = [0, -0.4, 0] }]')
TOLD["rolling"] = RING
#: A square that turns within an element, and turns on.
TOLD["pivoting"] = FLAT.replace('"turn"\nsteps = 1', '"turn"\nsteps = 2')


def resting(problem: Problem) -> Problem:
    """The problem with a stage more, in which nothing changes: supports stay where they are, and loads as they are."""
    supports = (replace(s, motions=(*s.motions, Motion()), factors=(*s.factors, *s.factors[-1:])) for s in problem.supports)
    loads = (replace(load, factors=(*load.factors, *load.factors[-1:])) for load in problem.loads)
    return replace(problem, stages=(*problem.stages, Stage("rest", 2)), supports=tuple(supports), loads=tuple(loads))


@case(
    claim="What is said at the end of a load step is said once, also where it stays true in those that follow.",
    tier="gate",
    grid={"run": tuple(TOLD)},
    bounds={
        "again": Bound(0.0, 0.0, "definition: sentences beyond the first of each"),
        "said": Bound(at_least=1.0, reason="definition: or nothing is said at all"),
    },
)
def once(run: str) -> dict[str, float]:
    """How many."""
    said = of_a_run(resting(Scene.from_toml(TOLD[run]).problem()))
    return {"again": float(said.total() - len(said)), "said": float(said.total())}
