"""What a file takes for its own scene, gone on with: what its first load steps would have been is what they were."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from output.records import SCENE

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Material, Motion, Problem, Stage
from isomortar.model.supports import factor_at, moved_by, progress
from isomortar.results.comparison import is_longer
from isomortar.scene import Scene

#: Factors of what drives beside motions, at the ends of the stages.
FACTORS = (0.4, 1.3)


def base() -> Problem:
    """A scene whose supports move, and whose loads grow, in both stages."""
    problem = Scene.from_toml(SCENE).problem()
    return replace(problem, loads=tuple(replace(load, factors=FACTORS) for load in problem.loads))


def stretched(problem: Problem, steps: int, motion: float, factor: float) -> Problem:
    """Its last stage of other load steps: motions of so many times the size, factors whose rise is so many times as large."""
    *before, last = problem.stages
    supports = [
        replace(s, motions=(*s.motions[:-1], Motion(tuple(motion * way for way in s.motions[-1].translate), motion * s.motions[-1].rotate)))  # type: ignore[arg-type]
        for s in problem.supports
    ]
    loads = [replace(load, factors=(FACTORS[0], FACTORS[0] + factor * (FACTORS[1] - FACTORS[0]))) for load in problem.loads]
    return replace(problem, stages=(*before, replace(last, steps=steps)), supports=tuple(supports), loads=tuple(loads))


def extended(problem: Problem, steps: int) -> Problem:
    """The same with a stage more."""
    supports = tuple(replace(s, motions=(*s.motions, Motion((0.1, 0.0, 0.0), 3.0))) for s in problem.supports)
    loads = tuple(replace(load, factors=(*load.factors, 2.0)) for load in problem.loads)
    return replace(problem, stages=(*problem.stages, Stage("more", steps)), supports=supports, loads=loads)


def _other_material(problem: Problem) -> Problem:
    first, *rest = problem.bodies
    return replace(problem, bodies=(replace(first, material=Material(young=2.0)), *rest))


#: What is done to a scene of two stages, of 2 and 3 load steps.
CHANGES: dict[str, Callable[[Problem], Problem]] = {
    "longer": lambda p: stretched(p, 6, 2.0, 2.0),
    "longer by a third": lambda p: stretched(p, 4, 4 / 3, 4 / 3),
    "longer, and a stage more": lambda p: extended(stretched(p, 6, 2.0, 2.0), 2),
    "longer, motions a little faster": lambda p: stretched(p, 6, 2.0 * (1.0 + 1e-8), 2.0),
    "longer, loads a little more": lambda p: stretched(p, 6, 2.0, 2.0 * (1.0 + 1e-8)),
    "a stage more": lambda p: extended(p, 2),
    "slower": lambda p: stretched(p, 6, 1.0, 2.0),
    "loads slower": lambda p: stretched(p, 6, 2.0, 1.0),
    "shorter": lambda p: stretched(p, 2, 2 / 3, 2 / 3),
    "the same": lambda p: p,
    "faster": lambda p: stretched(p, 3, 2.0, 1.0),
    "another material": lambda p: extended(_other_material(p), 2),
    "another first stage": lambda p: extended(replace(p, stages=(replace(p.stages[0], steps=3), p.stages[1])), 2),
}


def apart(one: Problem, other: Problem, ends: int) -> float:
    """Most that motions and factors of two problems differ over the first so many load steps; infinite where other things do."""
    times = np.linspace(0.0, ends, 4 * ends + 1)
    differences = [0.0 if one.bodies[0].material == other.bodies[0].material else np.inf]
    for a, b in zip(one.supports, other.supports, strict=True):
        for time in times:
            (way, angle), (way_b, angle_b) = moved_by(a, progress(one.stages, time)), moved_by(b, progress(other.stages, time))
            differences.append(float(np.abs(way - way_b).max() + abs(angle - angle_b)))
    for load, load_b in zip(one.loads, other.loads, strict=True):
        differences += [abs(factor_at(one.stages, load.factors, time) - factor_at(other.stages, load_b.factors, time)) for time in times]
    return float(np.max(differences))


@case(
    claim="A file is gone on with where a scene does what it did in all its load steps, and more after them; else it is not.",
    tier="gate",
    grid={"change": list(CHANGES)},
    bounds={"wrong": Bound(at_most=0.0, reason="definition: what is said of the scene is what its motions and loads are")},
)
def goes_on(change: str) -> dict[str, float]:
    """Whether it is said to go on although it does other things, or no more, in the load steps that there are; or the other way."""
    stored = base()
    given = CHANGES[change](stored)
    same = given.total_steps > stored.total_steps and apart(stored, given, stored.total_steps) < 1e-12
    return {"wrong": float(is_longer(stored, given) != same)}


def of_one_stage(problem: Problem, steps: int, share: float) -> Problem:
    """Its first stage alone, of other load steps: motions and factors, which begin at rest and at zero, of so many times the size."""
    ways = [s.motions[0].translate for s in problem.supports]
    motions = [(Motion((share * x, share * y, share * z), 0.0),) for x, y, z in ways]
    supports = [
        replace(s, motions=of, factors=tuple(share * factor for factor in s.factors[:1]))
        for s, of in zip(problem.supports, motions, strict=True)
    ]
    loads = [replace(load, factors=(share * load.factors[0],)) for load in problem.loads]
    stage = replace(problem.stages[0], steps=steps)
    return replace(problem, stages=(stage,), supports=tuple(supports), loads=tuple(loads))


@case(
    claim="So is one of a single stage, whose motions and factors go from nothing to what they are at its end.",
    tier="gate",
    bounds={"wrong": Bound(at_most=0.0, reason="definition: what is said of the scene is what its motions and loads are")},
)
def goes_on_from_rest() -> dict[str, float]:
    """Of how many scenes it is said wrongly."""
    stored, wrong = of_one_stage(base(), 2, 1.0), 0
    for steps, share in ((4, 2.0), (3, 1.5), (4, 1.0), (4, 1.5), (3, 2.0), (2, 1.0), (1, 0.5)):
        given = of_one_stage(base(), steps, share)
        same = steps > 2 and apart(stored, given, 2) < 1e-12
        wrong += same != (steps > 2 and share == steps / 2) or is_longer(stored, given) != same
    return {"wrong": float(wrong)}


@case(
    claim="A scene with more load steps goes on at the rate of its last stage, from what it was.",
    tier="gate",
    grid={"counts": ("1", "7", "2, 5")},
    bounds={
        "before": Bound(at_most=1e-14, reason="definition: motions of supports in the load steps that there were; round-off"),
        "after": Bound(at_most=1e-12, reason="definition: motions beyond them, which are straight lines in load time; round-off"),
        "said": Bound(1.0, 1.0, "definition: it is taken for the same scene, gone on with"),
    },
)
def more_steps(counts: str) -> dict[str, float]:
    """Largest differences of motions, before and beyond the last load step of a scene, in lengths and degrees."""
    numbers = [int(count) for count in counts.split(",")]
    scene = Scene.from_toml(SCENE)
    problem, longer = scene.problem(), scene.with_more_steps(*numbers).problem()
    end, last = problem.total_steps, problem.stages[-1].steps
    beyond = 0.0
    for support, given in zip(problem.supports, longer.supports, strict=True):
        motion = support.motions[-1]
        way, angle = moved_by(support, progress(problem.stages, end))
        for time in np.linspace(end, end + sum(numbers), 9):
            share = (time - end) / last
            found, turned = moved_by(given, progress(longer.stages, time))
            off = np.abs(found - way - share * np.asarray(motion.translate)).max() + abs(turned - angle - share * motion.rotate)
            beyond = float(np.maximum(beyond, off))
    return {"before": apart(problem, longer, end), "after": beyond, "said": float(is_longer(problem, longer))}


@case(
    claim="Further stages of a scene are also those of supports that hold in its last stage, and of no others.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: supports and stages in which one holds, or does not, and should not, or should")},
)
def more_steps_of_held() -> dict[str, float]:
    """How many, of supports that hold throughout, first, last, and in between."""
    stages = "".join(f'[[stages]]\nname = "{name}"\nsteps = 2\n' for name in ("one", "two", "three"))
    held = {"always": None, "first": ["one"], "last": ["three"], "both": ["one", "three"], "middle": ["two"]}
    body = 'bodies.block.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }\nsupports.always.face = "block.w0"\n'
    given = "".join(f'supports.{name} = {{ face = "block.w1", stages = {on} }}\n' for name, on in held.items() if on)
    longer = Scene.from_toml(f"format = 1\n{body}{given}{stages}").with_more_steps(1, 2).problem()
    wrong = sum(
        support.holds(stage) != (held[support.name] is None or "three" in held[support.name])  # type: ignore[operator]
        for support in longer.supports
        for stage in (3, 4)
    )
    return {"wrong": float(wrong + abs(len(longer.stages) - 5))}


#: A block that a support has pressed aside, and lets go of in the last stage.
_LET_GO = """
format = 1
bodies.block = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh = { order = 2, elements = [1, 1, 1] } }
supports.base.face = "block.w0"
supports.hand = { face = "block.w1", stages = ["press"] }
stages = [{ name = "press", steps = 1, motions.hand.translate = [0.1, 0, 0] }, { name = "let-go", steps = STEPS }]
"""


@case(
    claim="A file is gone on with where a support is released in its last stage, and that gets no longer: what it bore fades by its end.",
    tier="gate",
    grid={"steps": (2, 4)},
    bounds={
        "wrong": Bound(0.0, 0.0, "definition: what is said of the scene is where its control points come in the load steps that there are"),
    },
)
def goes_on_as_it_fades(steps: int) -> dict[str, float]:
    """Whether a scene with another last stage and one after it is said to go on although it goes elsewhere, or the other way."""
    stored = Scene.from_toml(_LET_GO.replace("STEPS", "2")).problem()
    given = Scene.from_toml(_LET_GO.replace("STEPS", str(steps)).replace(" }]", ' }, { name = "after", steps = 1 }]')).problem()
    results = zip(Simulation(stored).run(), Simulation(given).run(), strict=False)
    off = float(np.max([np.abs(one.state.positions - other.state.positions).max() for one, other in results]))
    return {"wrong": float(is_longer(stored, given) != (off < 1e-6))}
