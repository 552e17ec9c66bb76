"""What a results file gives back: every number of every load step, whatever it is, by each way to it that a reader has."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.results.reader import ContactHistory, Results
from isomortar.results.table import columns
from isomortar.results.writer import ResultsWriter
from isomortar.scene import Scene
from isomortar.solve.record import AugmentationRecord, ContactRates, IterationRecord, Rates, StepResult

#: Two of whatever a scene has several of, and no two of the same size.
SCENE = """
format = 1
[bodies.block]
geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 0.8, 0.5] }
mesh = { order = [2, 1, 1], elements = [2, 1, 1] }
[bodies.base]
geometry = { kind = "box", lower = [-0.5, -0.6, -0.4], upper = [1.6, 1.7, 0.001] }
mesh = { family = "L", order = [1, 2, 1], elements = [2, 1, 1] }
[bodies.wheel]
geometry = { kind = "ring", centre = [0.5, 4, 0], inner = 0.2, outer = 0.4, width = 0.3 }
mesh = { order = [2, 1, 1], elements = [4, 1, 1] }
[contacts]
under = { slave = "block.w0", master = "base.w1", friction = 0.3 }
over = { slave = "block.u1", plane = { point = [2, 0, 0], normal = [-1, 0, 0] }, friction = 0 }
[supports]
ground.face = "base.w0"
rim.face = "wheel.w0"
push = { face = "wheel.w1", force = { x = 0.001 } }
top.face = "block.w1"
[loads]
press = { face = "block.v0", pressure = 0.02 }
weight = { body = "block", weight = [0, 0.1, -0.3] }
[[stages]]
name = "press"
steps = 2
motions.ground = { translate = [0, 0, 0.02] }
[[stages]]
name = "turn"
steps = 3
motions.ground = { translate = [0.03, 0.01, 0], rotate = 5 }
"""
#: Notes of iterations, of which some have none and others several.
NOTES = ("status changed at 3 control points", "line search 0.5", "größer ≤ ö")
#: Load steps after which the file is written on by a run that is resumed.
RESUMED = 2


def scrambled(value: Any, random: np.random.Generator) -> Any:
    """The same things with other numbers, by chance: what is taken for something else differs from it."""
    if is_dataclass(value):
        return replace(value, **{f.name: scrambled(getattr(value, f.name), random) for f in fields(value)})  # type: ignore[type-var]
    if isinstance(value, tuple):
        return tuple(scrambled(entry, random) for entry in value)
    if isinstance(value, np.ndarray):
        return np.asarray(1000.0 * random.normal(size=value.shape), dtype=value.dtype)
    if isinstance(value, (int, float)):
        return type(value)(1000.0 * random.normal())
    return value


def load_steps(problem: Problem) -> list[StepResult]:
    """One result for each load step of a problem: of the sizes that a computed one has, all numbers by chance."""
    simulation = Simulation(problem)
    computed = next(iter(simulation.run()))
    return [_load_step(problem, computed, simulation.equilibrium.numbering.reference, number) for number in _numbers(problem)]


def over_master(step: StepResult) -> StepResult:
    """The load step with all slave points over their master, where fields of contacts are shown as they are (theory 8.7)."""
    contacts = tuple(replace(state, projected=np.ones_like(state.projected)) for state in step.state.contacts)
    return replace(step, state=replace(step.state, contacts=contacts))


def _numbers(problem: Problem) -> range:
    return range(1, problem.total_steps + 1)


def _load_step(problem: Problem, computed: StepResult, at_rest: np.ndarray, number: int) -> StepResult:
    """Load step `number`; what is zero without friction is that, and each second one has no rates and other names of what it counts."""
    random = np.random.default_rng(number)
    made: StepResult = scrambled(computed, random)
    contacts = tuple(_rubs(state, contact.friction_law.acts) for state, contact in zip(made.state.contacts, problem.contacts, strict=True))
    results = tuple(_rubs(result, contact.friction_law.acts) for result, contact in zip(made.contacts, problem.contacts, strict=True))
    rates = None
    if number % 2:
        speeds = (ContactRates(0.5 * state.pressure, 0.5 * state.traction) for state in contacts)
        rates = Rates(random.normal(), random.normal(size=at_rest.shape), tuple(speeds))
    starts = np.cumsum([0, *(stage.steps for stage in problem.stages)])
    return replace(
        made,
        step=number,
        stage=problem.stages[int(np.searchsorted(starts, number)) - 1].name,
        time=float(number),
        state=replace(made.state, positions=at_rest + 0.01 * random.normal(size=at_rest.shape), contacts=contacts, rates=rates),
        contacts=results,
        augmentations=tuple(_augmentation(random, count) for count in random.integers(4, size=1 + number % 3)),
        newton_order=float("nan") if number == RESUMED else random.normal(),
        timings={name: random.random() for name in ("solid", "contact", *(["other"] if number % 2 else []))},
        counters={name: int(random.integers(100)) for name in ("solves", *(["analyses"] if number % 2 else []))},
        orderings={3: "metis"} | ({5: "amd"} if number > 1 else {}),  # type: ignore[arg-type]
    )


def _rubs(values: Any, acts: bool) -> Any:
    """What a contact has, without friction where none acts."""
    zero = {name: np.zeros_like(getattr(values, name)) for name in ("traction", "traction_norm") if hasattr(values, name)}
    return values if acts else replace(values, **zero)


def _augmentation(random: np.random.Generator, count: int) -> AugmentationRecord:
    record: IterationRecord = IterationRecord(0, 0.0, 0, 0, 0)
    notes = [NOTES[: random.integers(len(NOTES) + 1)] for _ in range(count)]
    iterations = tuple(replace(scrambled(record, random), notes=said) for said in notes)
    return replace(scrambled(AugmentationRecord(0, 0.0, 0.0, 0.0, 0.0, ()), random), iterations=iterations)


def unlike(one: Any, other: Any) -> int:
    """How many numbers, texts and sizes differ, to the bit."""
    if type(one) is not type(other):
        return 1
    if is_dataclass(one):
        return sum(unlike(getattr(one, f.name), getattr(other, f.name)) for f in fields(one))
    if isinstance(one, dict):
        return len(one.keys() ^ other.keys()) + sum(unlike(one[name], other[name]) for name in one.keys() & other.keys())
    if isinstance(one, (tuple, list)):
        return abs(len(one) - len(other)) + sum(map(unlike, one, other))
    if isinstance(one, np.ndarray):
        if one.shape != other.shape or one.dtype != other.dtype:
            return 1
        return int(np.count_nonzero(one.view(np.uint8) != other.view(np.uint8)))
    return int(one != other and not (one != one and other != other))


def recorded(path: Path, problem: Problem, steps: list[StepResult], states: str) -> None:
    """Write load steps, some of them by a run that goes on from the file."""
    for part in (steps[:RESUMED], steps[RESUMED:]):
        writer = ResultsWriter(path, problem, SCENE, "0", states=states, resume=path.exists())  # type: ignore[arg-type]
        for step in part:
            writer.recorded(step)


def curves(problem: Problem, steps: list[StepResult]) -> Iterator[tuple[dict[str, str], str, np.ndarray]]:
    """What there is over the load steps: whose, its name, and its values, from the load steps themselves."""
    names = ("step", "time", "newton_order", "substeps", "cuts", "next_increment")
    yield from (({}, name, np.array([getattr(step, name) for step in steps])) for name in names)
    groups: tuple[tuple[str, tuple[Any, ...], str], ...] = (
        ("support", problem.supports, "reactions"),
        ("contact", problem.contacts, "contacts"),
        ("load", problem.loads, "loads"),
    )
    for kind, entries, part in groups:
        for number, entry in enumerate(entries):
            told = [getattr(step, part)[number] for step in steps]
            for f in fields(told[0]):
                values = np.array([getattr(result, f.name) for result in told])
                if f.name not in ("traction_norm", "status", "gap"):  # these stand with the states
                    yield {kind: entry.name}, f.name, values


def wrong_curves(results: Results, problem: Problem, steps: list[StepResult]) -> int:
    """Curves, their components and columns of the table that are not what the load steps say, or that are not there."""
    wrong, table, letters = 0, columns(results), ("x", "y", "z")
    for whose, name, values in curves(problem, steps):
        wrong += unlike(np.asarray(results.curve(name, **whose)), values) > 0  # type: ignore[arg-type]
        stem = ".".join([name, *(["load"] if "load" in whose else []), *whose.values()])
        if values.ndim == 1:
            wrong += name != "step" and unlike(np.asarray(table.get(stem)), values) > 0
            continue
        parts = letters if values.shape[1] == 3 else ("smallest", "largest")
        for part, column in zip(parts, values.T.copy(), strict=True):
            wrong += unlike(np.array(table.get(f"{stem}.{part}")), column) > 0
            if part in letters:
                wrong += unlike(results.curve(name, component=part, **whose).copy(), column) > 0  # type: ignore[arg-type]
    return wrong + (results.stages != [step.stage for step in steps])


def wrong_histories(results: Results, problem: Problem, steps: list[StepResult]) -> int:
    """Values of constraints over kept states that are not those of the load steps; and of phases and counts."""
    wrong = 0
    for number, contact in enumerate(problem.contacts):
        history = results.contact(contact.name)
        for f in fields(ContactHistory)[2:]:
            told = [getattr(step.state.contacts[number], f.name, getattr(step.contacts[number], f.name, None)) for step in steps]
            wrong += unlike(getattr(history, f.name), np.array(told)) > 0
        wrong += list(history.steps) != [step.step for step in steps] or history.contact != contact
    return wrong


@case(
    claim="A results file gives back the problem and every number of its load steps to the bit, alone, as curves and as a table.",
    tier="gate",
    grid={"states": ("every", "last")},
    bounds={
        "steps": Bound(at_most=0.0, reason="definition: numbers of load steps whose states are kept that differ"),
        "problem": Bound(at_most=0.0, reason="definition: numbers and words of the problem that differ"),
        "curves": Bound(at_most=0.0, reason="definition: curves, components and columns that differ from what load steps say"),
        "histories": Bound(at_most=0.0, reason="definition: values of constraints over the kept states, times and counts that differ"),
        "kept": Bound(at_least=1.0, reason="definition: how many states there are to look at"),
    },
)
def given_back(states: str) -> dict[str, float]:
    """How much differs, of load steps whose numbers are all by chance."""
    problem = Scene.from_toml(SCENE).problem()
    steps = load_steps(problem)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "run.h5"
        recorded(path, problem, steps, states)
        with Results(path) as results:
            kept = steps if states == "every" else steps[-1:]
            phases = {name: np.array([step.timings.get(name, np.nan) for step in steps]) for name in ("contact", "other", "solid")}
            counts = {name: np.array([step.counters.get(name, -1) for step in steps]) for name in ("analyses", "solves")}
            return {
                "steps": float(sum(unlike(results.step(step.step), step) for step in kept) + unlike(results.last_step(), steps[-1])),
                "problem": float(unlike(results.problem, problem) + (results.scene_text != SCENE)),
                "curves": float(wrong_curves(results, problem, steps)),
                "histories": float(
                    wrong_histories(results, problem, kept) + unlike(results.timings(), phases) + unlike(results.counters(), counts)
                ),
                "kept": float(np.count_nonzero(results.kept_states == [step.step for step in kept])),
            }
