"""What a trade takes for the result of a run: curves, ends, peaks, roughness and fields against integrals and differences written out."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
from output.records import SCENE as PUSHED

from isomortar.errors import InputError
from isomortar.harness import Bound, case
from isomortar.model.entities import Problem
from isomortar.scene import Scene
from isomortar.trade.laboratory import Tried
from isomortar.trade.model import Yardstick
from isomortar.trade.want import wanted, wishes

#: Two stages, of which the first has as few load steps as `first`; a contact of one face, and one of two.
SCENE = """
format = 1
bodies.block.geometry = {{ kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }}
bodies.block.mesh = {{ order = [1, 1, 1], elements = [1, 1, 1] }}
contacts.floor = {{ slave = "block.w0", plane = {{ point = [0, 0, -1], normal = [0, 0, 1] }}, friction = 0.3 }}
contacts.corner = {{ slave = ["block.u0", "block.v0"], plane = {{ point = [-1, -1, 0], normal = [1, 1, 0] }}, friction = 0 }}
supports.rim = {{ face = "block.v1", components = ["y"] }}
supports.top.face = "block.w1"
[[stages]]
name = "press"
steps = {first}
motions.top.translate = [0, 0, -0.1]
[[stages]]
name = "drag"
steps = 6
motions.top.translate = [0.1, 0, 0]
"""
#: Quadrature points of the contacts.
COUNTS = (5, 8)
#: Parts of an interval for integrals of products of functions that are linear there.
PARTS = 40


def problem_of(first: int) -> Problem:
    """The problem with so many load steps in its first stage."""
    return Scene.from_toml(SCENE.format(first=first)).problem()


def run_of(seed: int, steps: tuple[int, int]) -> dict[str, Any]:
    """What a run returns, all numbers by chance."""
    random = np.random.default_rng(seed)
    time = np.concatenate([k + np.arange(1, n + 1) / n for k, n in enumerate(steps)])
    numbers: dict[str, Any] = {name: random.normal(size=(2, len(time), 3)) for name in ("force", "moment", "displacement")}
    fields = {name: random.normal(size=sum(COUNTS)) for name in ("pressure", "traction")}
    return numbers | fields | {
        "time": time,
        "area": random.random((2, len(time))),
        "cells": np.random.default_rng(0).random(sum(COUNTS)),
        "gap": random.random(2),
        "counts": list(COUNTS),
        "images": 1,
    }  # fmt: skip


def curve(run: dict[str, Any], name: str, component: str) -> np.ndarray:
    """A curve of the support `top`, which is the second, at rest first."""
    vectors = run[name][1]
    heights = np.sqrt((vectors**2).sum(axis=1)) if component == "norm" else vectors[:, "xyz".index(component)]
    return np.append(0.0, heights)


def between(run: dict[str, Any], truth: dict[str, Any], heights: np.ndarray, right: np.ndarray, first: float, last: float) -> float:
    """Error of a curve in a stage: L2 norm of its difference from the truth, linear between its load steps, over that of the truth."""
    times, of_truth = np.append(0.0, run["time"]), np.append(0.0, truth["time"])
    edges = np.union1d(times, of_truth)
    edges = edges[(edges >= first) & (edges <= last)]
    t = np.unique(np.concatenate([np.linspace(a, b, PARTS + 1) for a, b in pairwise(edges)]))
    whole = np.interp(t, of_truth, right)
    off = np.interp(t, times, heights - np.interp(times, of_truth, right))
    return math.sqrt(np.trapezoid(off**2, t) / np.trapezoid(whole**2, t))


def bent(heights: np.ndarray, steps: tuple[int, int]) -> float:
    """Mean square of the second derivative that three neighbours of a stage have, stage by stage, times the time between them."""
    ends = np.cumsum((0, *steps))
    parts = [heights[1:][a:b] for a, b in pairwise(ends)]
    return sum(float(np.mean(np.diff(part, n=2) ** 2)) * n**4 for part, n in zip(parts, steps, strict=True))


@case(
    claim="How far a run is from the truth in a curve, in its end, its peak and its roughness, in a field, in where contact ends and in "
    "what penetrates is what integrals, differences and sums over cells give.",
    tier="gate",
    bounds={
        "curve": Bound(at_most=2e-3, reason="quadrature: 200 points a stage"),
        "number": Bound(at_most=1e-12, reason="round-off: of sums of a few numbers"),
        "field": Bound(at_most=1e-12, reason="round-off: of sums of a few numbers"),
    },
)
def errors() -> dict[str, float]:
    """Largest relative differences."""
    problem, fine, coarse = problem_of(4), (12, 18), (4, 6)
    truth, run = run_of(1, fine), run_of(2, coarse)

    def error(text: str) -> float:
        tried = [Tried((), "", numbers, "", 0.0, 0.0) for numbers in (truth, run)]
        return Yardstick(wanted(text, problem), tried[0], tried[0]).error(tried[1])

    worst = np.zeros(3)

    def note(kind: int, found: float, exact: float) -> None:
        worst[kind] = np.maximum(worst[kind], abs(found / exact - 1.0))

    for name in ("force", "moment", "displacement"):
        for component in ("x", "y", "z", "norm"):
            text = f"{name}.top" if component == "norm" else f"{name}.top.{component}"
            ours, right = curve(run, name, component), curve(truth, name, component)
            for stage, (first, last) in {"": (0.0, 2.0), "@press": (0.0, 1.0), "@drag": (1.0, 2.0)}.items():
                note(0, error(text + stage), between(run, truth, ours, right, first, last))
            halves = [np.abs(ours[:5]).max(), np.abs(ours[4:]).max()], [np.abs(right[:13]).max(), np.abs(right[12:]).max()]
            for k, stage in enumerate(("press", "drag")):
                note(1, error(f"{text}@{stage}:peak"), abs(halves[0][k] / halves[1][k] - 1.0))
            note(1, error(f"{text}@press:end"), abs(ours[4] / right[12] - 1.0))
            note(1, error(f"{text}:end"), abs(ours[-1] / right[-1] - 1.0))
            note(1, error(f"{text}:roughness"), abs(bent(ours, coarse) / bent(right, fine) - 1.0))
    note(1, error("area.floor:end"), abs(run["area"][0][-1] / truth["area"][0][-1] - 1.0))
    note(1, error("gap.floor"), abs(run["gap"][0] - truth["gap"][0]))
    cells = truth["cells"][: COUNTS[0]]
    for name in ("pressure", "traction"):
        ours, right = run[name][: COUNTS[0]], truth[name][: COUNTS[0]]
        note(2, error(f"{name}.floor"), math.sqrt((cells * (ours - right) ** 2).sum() / (cells * right**2).sum()))
    pressed = [numbers["pressure"][: COUNTS[0]] > 0.0 for numbers in (run, truth)]
    note(2, error("edge.floor"), cells[pressed[0] != pressed[1]].sum() / cells[pressed[1]].sum())
    return dict(zip(("curve", "number", "field"), map(float, worst), strict=True))


@case(
    claim="What is offered of a scene can be measured of it, and what can not is refused: components of areas, roughness of stages without "
    "a second difference, fields of slaves of several faces.",
    tier="gate",
    grid={"steps": (1, 2, 3, 4)},
    bounds={
        "offered": Bound(0.0, 0.0, "definition: wishes that are refused"),
        "taken": Bound(0.0, 0.0, "definition: what can not be measured and is not refused"),
        "rough": Bound(0.0, 0.0, "definition: wishes for roughness where a stage has fewer than three load steps, or none where all have"),
    },
)
def offered(steps: int) -> dict[str, float]:
    """How many of each."""
    problem = problem_of(steps)

    def refused(text: str) -> bool:
        try:
            wanted(text, problem)
        except InputError:
            return True
        return False

    wrong = ["area.floor.x", "area.floor:roughness", "force.rim.w", "force.side", "pressure.wall"]
    wrong += ["edge.floor:end", "force.top@turn", "x.top"]
    wrong += [f"{name}.corner" for name in ("pressure", "traction", "edge", "gap", "area")]
    wrong += [f"force.top{stage}:roughness" for stage in ("", "@press")] if steps < 3 else []
    wishing = wishes(problem)
    rough = any(text.endswith(":roughness") for text in wishing)
    return {
        "offered": float(sum(map(refused, wishing))),
        "taken": float(sum(not refused(text) for text in wrong)),
        "rough": float(rough != (steps >= 3)),
    }


@case(
    claim="All that is offered of a scene has an error of every run of it: a number, or, of the roughness of a run with fewer than three "
    "load steps in a stage, none.",
    tier="gate",
    grid={"steps": (1, 2, 3)},
    bounds={"wrong": Bound(0.0, 0.0, "definition: wishes that have a number and should not, or should and have none")},
)
def of_short_runs(steps: int) -> dict[str, float]:
    """How many, of a run with so many load steps in its first stage."""
    problem = problem_of(4)
    truth, run = (Tried((), "", numbers, "", 0.0, 0.0) for numbers in (run_of(1, (12, 18)), run_of(2, (steps, 6))))
    none = {text for text in wishes(problem) if not math.isfinite(Yardstick(wanted(text, problem), truth, truth).error(run))}
    rough = {text for text in wishes(problem) if text.endswith(":roughness")}
    return {"wrong": float(len(none ^ (rough if steps < 3 else set())))}


#: Load steps of a stage that show a curve.
FEWEST = 5


@case(
    claim="Curves are shown by runs that have in each stage as many load steps as the scene, or five; their ends and peaks by any.",
    tier="gate",
    bounds={
        "wrong": Bound(0.0, 0.0, "definition: numbers of load steps that are taken and should not be, or left out and should be taken")
    },
)
def shown_by() -> dict[str, float]:
    """How many, of scenes with one to eight load steps in their first stage, and of runs with as many."""
    wrong, counts = 0, range(1, 9)
    for own in counts:
        for few in counts:
            problem, run = problem_of(own), problem_of(few)
            enough = few >= own or few >= FEWEST
            wrong += wanted("force.top", problem).shown(run) != enough or wanted("moment.top@press", problem).shown(run) != enough
            wrong += not wanted("force.top@drag", problem).shown(run)
            wrong += not all(wanted(f"force.top:{part}", problem).shown(run) for part in ("end", "peak"))
    return {"wrong": float(wrong)}


@case(
    claim="What is offered is what users look at: force and moment of supports that move, how far a force moves one, area and fields of "
    "contacts of one face; roughness where all stages have load steps enough.",
    tier="gate",
    bounds={"others": Bound(0.0, 0.0, "definition: wishes that are missing, or too many")},
)
def what_users_look_at() -> dict[str, float]:
    """How many, of the scene as it is and with a support that a force moves."""
    of_floor = {f"{quantity}.floor" for quantity in ("area", "pressure", "traction", "edge", "gap")}
    of_top = {f"{quantity}.top" for quantity in ("force", "moment")}
    rough = {f"{name}:roughness" for name in of_top}
    others = set(wishes(problem_of(4))) ^ (of_floor | of_top | rough)
    others |= set(wishes(problem_of(2))) ^ (of_floor | of_top)
    pushed = {"force.ground", "moment.ground", "displacement.push"}
    pushed |= {f"{quantity}.{name}" for quantity in ("area", "pressure", "traction", "edge", "gap") for name in ("under", "over")}
    others |= set(wishes(Scene.from_toml(PUSHED).problem())) ^ pushed
    return {"others": float(len(others))}
