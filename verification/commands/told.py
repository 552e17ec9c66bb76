"""What commands say of a scene, a run and a results file, against the numbers that they say it of."""

from __future__ import annotations

import tempfile
from contextlib import redirect_stdout
from dataclasses import asdict, replace
from functools import cache
from io import StringIO
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest import mock

import numpy as np
import typer
from output.records import SCENE, load_steps, recorded

from isomortar.cli import progress as progress_module
from isomortar.cli import trade
from isomortar.cli.check import lines as lines_of_outlook
from isomortar.cli.cost import totals
from isomortar.cli.info import information
from isomortar.cli.info import lines as lines_of_file
from isomortar.cli.progress import Detail, Progress, _minutes
from isomortar.errors import ConvergenceError, InputError
from isomortar.harness import Bound, case, runner
from isomortar.march.outlook import BodyOutlook, ContactOutlook, LoadOutlook, Outlook, SupportOutlook
from isomortar.model.entities import Problem
from isomortar.results.reader import Results
from isomortar.scene import Scene
from isomortar.solve.record import AugmentationRecord, IterationRecord, StepResult
from isomortar.trade import page

WRONG = Bound(0.0, 0.0, "definition: what is said of numbers that are known")
#: Counters and seconds of the load steps: of the first, and what each of the others has more.
COUNTS = {"solves": (2, 3), "factor non-zeros": (900, -70), "history bytes": (16, 8)}


def counted(problem: Problem) -> list[StepResult]:
    """Load steps with counters, cuts and seconds that are known."""
    return [
        replace(
            step,
            cuts=k,
            timings={"solid": 0.5, "total": 1.0 + k},
            counters={name: first + k * more for name, (first, more) in COUNTS.items()},
        )
        for k, step in enumerate(load_steps(problem))
    ]


@case(
    claim="What is said of a results file is what its load steps hold: how far it came, how contacts, supports and loads stand after the "
    "last one, and what all of them cost.",
    tier="gate",
    grid={"states": ("every", "last")},
    bounds={"wrong": WRONG},
)
def of_a_file(states: str) -> dict[str, float]:
    """How much is told otherwise, of a run that is not at its end and of one that is."""
    problem, wrong = Scene.from_toml(SCENE).problem(), 0
    steps = counted(problem)
    with tempfile.TemporaryDirectory() as folder:
        for count in (4, 5):
            path = Path(folder) / f"{count}.h5"
            recorded(path, problem, steps[:count], states)
            with Results(path) as results:
                found, spent = information(results), totals(results)
            last = steps[count - 1]
            kept = count if states == "every" else 1
            expected = {
                "contacts": [
                    {
                        "name": contact.name, "constraints": len(end.gap), "active": end.active, "slip": end.slip,
                        "pressure": tuple(end.pressure_field), "penetration": np.sort(end.gap)[-1],
                    }
                    for contact, end in zip(problem.contacts, last.contacts, strict=True)
                ],
                "supports": [
                    {
                        "name": support.name, "force": tuple(end.force), "moment": tuple(end.moment),
                        "displacement": tuple(end.displacement), "rotation": end.rotation,
                    }
                    for support, end in zip(problem.supports, last.reactions, strict=True)
                ],
                "loads": [
                    {"name": load.name, "force": tuple(end.force), "moment": tuple(end.moment)}
                    for load, end in zip(problem.loads, last.loads, strict=True)
                ],
                "load_steps": 5, "recorded": count, "kept_states": kept, "cuts": sum(range(count)), "name": "scene", "version": "0",
                "stages": {"press": (2, 2), "turn": (count - 2, 3)}, "symmetry": [], "cpu_seconds": count + sum(range(count)),
            }  # fmt: skip
            given = {name: list(value) if isinstance(value, tuple) else value for name, value in asdict(found).items()}
            wrong += sum(given[name] != value for name, value in expected.items())
            told = list(lines_of_file(found, path))
            wrong += ("not at its end" in told[-1]) != (count < 5) or f"{count} of 5 load steps" not in told[1]
            wrong += len(told) != 2 + len(problem.contacts) + len(problem.supports) + len(problem.loads) + (count < 5)
            solves, _, held = ([first + k * more for k in range(count)] for first, more in COUNTS.values())
            wrong += spent != {"solves": sum(solves), "factor non-zeros": 900, "history bytes": sum(held[-kept:])}
    return {"wrong": float(wrong)}


#: An outlook with all that may be said of one, and its lines.
OUTLOOK = Outlook(
    "press", 30, 1, 2.5e9,
    (
        BodyOutlook("block", "neo-hookean", 210.0, 0.3, (1.0, 2.0, 0.5), ("N", "N", "L"), (2, 3, 1), (4, 5, 6), 0.1, 0.5, (1.0, 1.0), 8, 0),
        BodyOutlook("wheel", "rigid", None, None, (1.0, 1.0, 1.0), ("N", "N", "N"), (2, 2, 2), (4, 1, 1), 0.25, 1.0, (0.5, 1.0), 1, 2),
    ),
    (
        ContactOutlook("a", "block.w0", "base.w1", "closest", "mortar", 64, 0, -0.25),
        ContactOutlook("b", "block.u1", "plane", "averaged", "dual", 1, 3, 0.125),
        ContactOutlook("c", "block.u0", "base.w1", "closest", "kts", 2, 0, 0.0),
    ),
    (
        SupportOutlook("top", "block.w1", "xyz", 0.25, 30.0, (None, None, None), None, ()),
        SupportOutlook("base", "base.w0", "", 0.0, 0.0, (1.5, None, -2.0), 0.75, ("press", "turn")),
        SupportOutlook("still", "base.u0", "xy", 0.0, 0.0, (), None, ()),
    ),
    (LoadOutlook("weight", "weight", "block", (0.0, 0.5, -1.0)),),
    ("one thing",),
)  # fmt: skip
LINES = (
    "press: 30 unknowns, 1 load step, about 2.5 GB of memory (within a factor of two)",
    "body block: neo-hookean of Young's modulus 210 and Poisson's ratio 0.3, 1 x 2 x 0.5 in size; 4 x 5 x 6 elements of N2 x N3 x L1, "
    "0.1 to 0.5 long, 8 control points",
    "body wheel: rigid, 1 x 1 x 1 in size; 4 x 1 x 1 elements of N2 x N2 x N2, 0.25 to 1 long, 1 control point, weights 0.5 to 1; "
    "supports leave 2 rigid motions to contacts",
    "contact a: slave block.w0, master base.w1; closest, mortar, 64 quadrature points; at the start they overlap by about 0.25",
    "contact b: slave block.u1, master plane; averaged, dual, 1 quadrature point, 3 of them beside the master; at the start they are "
    "about 0.12 apart",
    "contact c: slave block.u0, master base.w1; closest, kts, 2 quadrature points; at the start they touch",
    "support top: prescribes x, y, z of block.w1; goes 0.25 and turns by 30 degrees",
    "support base: prescribes nothing of base.w0; presses x by 1.5 and presses z by -2 and turns by a moment of 0.75; in press, turn alone",
    "support still: prescribes x, y of base.u0; stands still",
    "load weight: weight 0, 0.5, -1 on block",
    "warning: one thing",
    "1 warning, nothing computed",
)


@case(
    claim="What is said of a scene before it runs is what its outlook holds, signs and units included.",
    tier="gate",
    bounds={"wrong": WRONG},
)
def of_a_scene() -> dict[str, float]:
    """How many lines are others."""
    told = list(lines_of_outlook(OUTLOOK))
    return {"wrong": float(abs(len(told) - len(LINES)) + sum(one != other for one, other in zip(told, LINES, strict=False)))}


@cache
def started() -> tuple[Problem, list[StepResult]]:
    """A problem with a contact along averaged normals, and its load steps."""
    problem = Scene.from_toml(SCENE).problem()
    first, *rest = problem.contacts
    return replace(problem, contacts=(replace(first, projection="averaged"), *rest)), load_steps(problem)


class Watched:
    """A progress of five load steps with a contact along averaged normals, what it tells, and what its log keeps."""

    def __init__(self, detail: Detail = Detail.STEPS) -> None:
        self.problem, self.steps = started()
        self.told: list[str] = []
        self.log: list[str] = []
        self.progress = Progress(self.problem, self.told.append, detail, self.log.append)


def told_of_events() -> list[tuple[str, list[str]]]:
    """What is told of a run with a cut, warnings and spurious work, and what should be."""
    watched, iteration = Watched(), IterationRecord(3, 1e-9, 7, 4, 3)
    steps = [
        replace(
            step,
            augmentations=(AugmentationRecord(1, 1.0, 1.0, 0.0, 0.0, (iteration, iteration)),),
            substeps=1 + k,
            contacts=tuple(replace(end, friction_work=2.0 + k, spurious_work=0.25) for end in step.contacts),
        )
        for k, step in enumerate(watched.steps[:2])
    ]
    watched.progress.started(5, 1)
    watched.progress.warned("it pulls")
    watched.progress.recorded(steps[0])
    watched.progress.cut(2, 1.25, 0.25, "it does not converge")
    watched.progress.cut(2, 1.125, 0.125, "it does not converge")
    watched.progress.cut(2, 1.0625, 0.0625, "it is lost")
    watched.progress.warned("it pulls")
    watched.progress.recorded(steps[1])
    watched.progress.finished()
    return [
        (line, [expected])
        for line, expected in zip(
            [*watched.told, *[""] * (10 - len(watched.told))],
            (
                "scene: 5 load steps",
                "warning: it pulls",
                "step 1/5  press: 2 iterations, residual 1.0e-09; active 7 (stick 4, slip 3); elapsed 0:00",
                "step 2: load increment to 1.25 failed, cut to 1/4 step: it does not converge",
                "step 2: load increment to 1.125 failed, cut to 1/8 step: for the same reason",
                "step 2: load increment to 1.0625 failed, cut to 1/16 step: it is lost",
                "step 2/5  press: 2 iterations, 2 increments, residual 1.0e-09; active 7 (stick 4, slip 3); elapsed 0:00",
                "contact 'under': spurious work is 10.00% of the friction work",
                "5 load steps done, 1 warning: read it",
                "",
            ),
            strict=True,
        )
    ]


def told_at_last() -> list[tuple[str, list[str]]]:
    """The last words of runs that are gone on with, stopped, or all there; and what they should hold."""
    said = []
    for first, error, words in (
        (1, ConvergenceError("no"), ["stopped with 0 of 5 load steps done"]),
        (3, ConvergenceError("no"), ["stopped with 2 of 5 load steps done; they are in run.h5"]),
        (1, KeyboardInterrupt(), ["stopped with 0 of 5 load steps done", "to go on, repeat the command with --resume"]),
        (0, KeyboardInterrupt(), ["stopped before the first load step"]),
        (6, None, ["scene: all 5 load steps are there already"]),
        (3, None, ["scene: 2 of 5 load steps are there, going on"]),
    ):
        watched = Watched()
        if first:
            watched.progress.started(5, first)
        if error:
            watched.progress.stopped(Path("run.h5"), error)
        said.append((watched.told[-1], words))
    return said


@case(
    claim="What is said of a run is what it is told of: load steps, cuts by their part of a step, warnings once, works of all load steps, "
    "and at the end what is left; quiet tells warnings alone, the log all.",
    tier="gate",
    bounds={"wrong": WRONG},
)
def of_a_run() -> dict[str, float]:
    """How many lines are others."""
    wrong = sum(any(word not in line for word in words) for line, words in (*told_of_events(), *told_at_last()))
    for detail, count in ((Detail.WARNINGS, 1), (Detail.EVENTS, 3), (Detail.STEPS, 4), (Detail.ITERATIONS, 7)):
        watched, iteration = Watched(detail), IterationRecord(1, 1e-3, 0, 0, 0, ("line search",))
        step = watched.steps[0]
        watched.progress.started(5, 1)
        watched.progress.iteration(1, 1.0, 1, iteration)
        watched.progress.augmented(1, 1.0, AugmentationRecord(1, 1.0, 1.0, 0.0, 0.0, (iteration,)))
        watched.progress.cut(1, 0.5, 0.5, "it is lost")
        watched.progress.warned("it pulls")
        watched.progress.recorded(replace(step, augmentations=(AugmentationRecord(1, 1.0, 1.0, 0.0, 0.0, (iteration,)),)))
        wrong += len(watched.told) != count or len(watched.log) != 7
    with mock.patch.object(progress_module, "monotonic", iter((100.0, 130.0, 160.0)).__next__):
        watched = Watched()
        watched.progress.started(5, 3)
        for step in watched.steps[2:4]:
            watched.progress.recorded(replace(step, augmentations=(AugmentationRecord(1, 1.0, 1.0, 0.0, 0.0, (iteration,)),)))
    wrong += [line.partition("; elapsed ")[2] for line in watched.told[1:]] != ["0:30, left about 1:00", "1:00, left about 0:30"]
    clocks = {0.0: "0:00", 7.4: "0:07", 59.6: "1:00", 754.0: "12:34", 3723.0: "1:02:03"}
    return {"wrong": float(wrong + sum(_minutes(seconds) != words for seconds, words in clocks.items()))}


#: Errors as people write them, and their shares; None: refused.
SHARES = {"1%": 0.01, "0.01": 0.01, "12.5 %": 0.125, " 1e-3 ": 1e-3, "1e-1%": 1e-3, "99%": 0.99} | dict.fromkeys(
    ("0", "1", "100%", "-1%", "1.2.3", "", "%", "nan", "1 percent", "0%")
)


def exit_of(best: tuple[bool, ...]) -> int:
    """The exit code of a trade with some answers."""
    answers = {0.5**k: SimpleNamespace(best=found) for k, found in enumerate(best, 1)}
    search = SimpleNamespace(screen=lambda: None, answers=lambda targets: [answers[target] for target in targets])
    stands: Any = mock.Mock(return_value=search)
    names: dict[str, Any] = {"write": lambda *_: "page.html", "spoken": lambda *_: "an answer"}
    with mock.patch.multiple(page, **names), mock.patch.object(runner, "local_processes", mock.MagicMock()), redirect_stdout(StringIO()):
        try:
            trade._conduct(stands, Scene.from_toml(SCENE), (), (), [f"{target}" for target in answers], 1.0, 1, Path())
        except typer.Exit as end:
            return end.exit_code
    return 0


@case(
    claim="Errors are read as shares or per cent, between none and all; a trade ends with 1 where one of its targets has no answer.",
    tier="gate",
    bounds={"wrong": WRONG},
)
def of_a_trade() -> dict[str, float]:
    """How many shares and exit codes are others."""
    wrong = 0
    for text, share in SHARES.items():
        try:
            found: float | None = trade._share(text)
        except InputError:
            found = None
        wrong += found is not share if share is None or found is None else abs(found / share - 1.0) > 1e-15
    for best, code in (((True,), 0), ((True, True), 0), ((False,), 1), ((True, False), 1), ((False, True), 1)):
        wrong += exit_of(best) != code
    return {"wrong": float(wrong)}
