"""What is said of a scene at a first look and in a run of it, in very small and very large units: the same sentences."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable

from told.alike import words
from told.given_up import ALONE, COHESIVE, ELSEWHERE, TAKEN_AWAY
from told.loose import ROLLER
from told.runs import LONG, PLATES, Heard
from told.shared import CORNERED
from told.tipping import ABOVE, HEAD, LIFTED, LOWER, whole
from told.tipping import SCENES as TIPPING
from told.wrong.doubts import DOUBTFUL
from told.wrong.plates import ROLLS
from told.wrong.runs import RUNS
from told.wrong.singular import CORNER
from transforms import scaled

from isomortar.errors import ConvergenceError
from isomortar.harness import Bound, case
from isomortar.march.outlook import outlook
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.scene import Scene

#: Doubts about a number in metres and seconds.
OF_ONE_UNIT = {"acceleration"}
#: Units of length and stress, powers of two: not a bit of a result changes. What is compared with a number of some unit lies between
#: the two and is said in one alone.
UNITS = ((2.0**-30, 2.0**40), (2.0**30, 2.0**-40))
_SAID = Bound(0.0, 0.0, "definition: sentences on a scene in one of two units, and not in the other")


def others(one: Counter[tuple[str, ...]], two: Counter[tuple[str, ...]]) -> float:
    """How many sentences are in one alone."""
    return float(((one - two) + (two - one)).total())


def in_units(problem: Problem, said_of: Callable[[Problem], Counter[tuple[str, ...]]]) -> float:
    """How many sentences are said of a problem in one of both units alone."""
    small, large = (said_of(scaled(problem, *units)) for units in UNITS)
    return others(small, large)


def doubts(problem: Problem) -> Counter[tuple[str, ...]]:
    """The words of what is doubtful at a first look."""
    return Counter(words(sentence) for sentence in outlook(problem).warnings)


def of_a_run(problem: Problem) -> Counter[tuple[str, ...]]:
    """The words of what is said in a run."""
    heard = Heard()
    list(Simulation(problem, heard).run())
    return Counter(words(said) for said in heard.said)


@case(
    claim="What is doubtful of a scene does not depend on its units, whatever the doubt is.",
    tier="gate",
    bounds={"others": _SAID},
)
def doubtful_in_units() -> dict[str, float]:
    """How many, over all scenes of which something is doubtful."""
    scenes = (scene for name, scene in DOUBTFUL.items() if name not in OF_ONE_UNIT)
    return {"others": sum(in_units(Scene.from_toml(text.replace(old, new)).problem(), doubts) for text, old, new, *_ in scenes)}


@case(
    claim="What is said in the course of a run does not depend on the units of its scene.",
    tier="gate",
    grid={"run": (*(name for name in RUNS if name not in LONG), *PLATES)},
    bounds={"others": _SAID},
)
def runs_in_units(run: str) -> dict[str, float]:
    """How many."""
    return {"others": in_units(Scene.from_toml((RUNS | PLATES)[run][0]).problem(), of_a_run)}


#: Load steps that are given up: bodies that tip, lift, or slide, move freely, or go to and fro, and averages that are apart.
GIVEN_UP = {name: whole(name) for name in TIPPING}
GIVEN_UP |= {"averages": ROLLER.replace("COUNT", "4"), "edges": CORNERED, "away": TAKEN_AWAY, "on its way": ELSEWHERE, "rolls away": ROLLS}
GIVEN_UP |= {f"{place} to go": HEAD + LOWER + LIFTED + ABOVE.replace("PLACE", place) for place in ("1.5", "9")}
GIVEN_UP |= {"cohesion": COHESIVE, "corner": CORNER, "alone": ALONE}


def why(problem: Problem) -> Counter[tuple[str, ...]]:
    """The words of why a run of it is given up; nothing, where it is not."""
    try:
        list(Simulation(problem).run())
    except ConvergenceError as error:
        return Counter([words(str(error))])
    return Counter()


@case(
    claim="What is said of a load step that is given up does not depend on the units of its scene.",
    tier="gate",
    grid={"scene": tuple(GIVEN_UP)},
    bounds={"others": _SAID},
)
def given_up_in_units(scene: str) -> dict[str, float]:
    """How many."""
    return {"others": in_units(Scene.from_toml(GIVEN_UP[scene], overrides=["solver.max_cuts=1"]).problem(), why)}
