"""A small problem and made-up results of it, for the tests of `isomortar.results`: no solver needed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.model.entities import Body, Contact, Face, Material, Motion, Problem, RigidPlane, Stage, Support
from isomortar.solve.record import (
    AugmentationRecord,
    ContactResult,
    ContactState,
    IterationRecord,
    Reaction,
    State,
    StepResult,
)

INNER, OUTER, WIDTH = 0.25, 0.5, 0.3


def ring() -> Patch:
    """An exact ring of four rational quarter arcs; u runs round the y-axis, v outwards, w along the axis."""
    u = Direction("N", 2, [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4])
    line = Direction("N", 1, [0, 0, 1, 1])
    angles = np.arange(9) * np.pi / 4
    reach = np.where(np.arange(9) % 2, np.sqrt(2.0), 1.0)
    circle = np.stack([reach * np.sin(angles), 0 * angles, 0.5 + 0 * angles + reach * np.cos(angles) - 0.5], axis=1)
    rows = [r * circle + [0, y, 0.5] for y in (0.0, WIDTH) for r in (INNER, OUTER)]
    return Patch((u, line, line), np.concatenate(rows), np.tile(1 / reach, 4))


def box(size: tuple[float, float, float] = (3.0, 1.0, 0.5)) -> Patch:
    """A block below z = 0 of Lagrange elements of order 2 and 3 and a B-spline direction."""
    directions = Direction("L", 2, [0, 1, 2]), Direction("L", 3, [0, 0.5]), Direction("N", 2, [0, 0, 0, 0.3, 1, 1, 1])
    x = np.linspace(-1, size[0] - 1, 5)
    y = np.linspace(-0.3, size[1] - 0.3, 4)
    z = np.array([-1.0, -0.85, -0.35, 0.0]) * size[2]  # Greville points: the map is linear
    grid = np.stack(np.meshgrid(x, y, z, indexing="ij"), axis=-1).reshape(-1, 3, order="F")
    return Patch(directions, grid, np.ones(len(grid)))


def problem() -> Problem:
    """A ring on a block, and the same ring on a rigid plane, with a support each."""
    material = Material(young=1 / 3, poisson=0.1 + 0.2)
    return Problem(
        name="rolling",
        bodies=(Body("tyre", ring(), material, (3, 2, 2), closed="u"), Body("road", box(), Material(), (3, 4, 3))),
        contacts=(
            Contact("tread", Face("tyre", "v1"), Face("road", "w1"), 0.1, (6, 4)),
            Contact("ground", Face("tyre", "v1"), RigidPlane((0, 0, -1), (0, 0, 1), (1, 0, 0)), 0.3, (6, 4), reference_area=1.0),
        ),
        supports=(
            Support("rim", Face("tyre", "v0"), (Motion((0, 0, -0.1)), Motion((0.24, 0, 0), 30.0)), centre=(0, 0, 0.5), axis=(0, 1, 0)),
            Support("bed", Face("road", "w0"), (Motion(), Motion())),
        ),
        stages=(Stage("press", 3), Stage("roll", 4)),
    )


def _reaction(random: np.random.Generator, rotation: float) -> Reaction:
    force, moment, centre = (random.normal(size=3) for _ in range(3))
    return Reaction(force, moment, centre, 2.0 * force, rotation)


def step_result(number: int) -> StepResult:
    """Load step `number` of the problem: random numbers, the same ones every time."""
    random = np.random.default_rng(number)
    augmentations = tuple(_augmentation(random, k) for k in range(1, 2 + number % 3))
    return StepResult(
        step=number,
        stage="press" if number <= 3 else "roll",
        time=float(number),
        state=State(_positions(random), tuple(_contact_state(random) for _ in range(2))),
        reactions=tuple(_reaction(random, turned) for turned in (0.5 * number, 0.0)),
        contacts=tuple(_contact_result(random) for _ in range(2)),
        augmentations=augmentations,
        newton_order=float("nan") if number == 2 else random.normal(),
        substeps=number,
        cuts=number % 2,
        next_increment=random.random(),
        timings={"solid": random.random(), "contact": random.random()} | ({"other": 0.25} if number > 1 else {}),
        counters={"solves": number} | ({"analyses": 3} if number == 1 else {}),
        orderings={5: "amd"} | ({1: "metis"} if number > 1 else {}),
    )


def _positions(random: np.random.Generator) -> FloatArray:
    tyre = ring().control_points.reshape(4, 9, 3)[:, :8].reshape(-1, 3)  # the ring's last row is its first
    rest = np.concatenate([tyre, box().control_points])
    return rest + 0.01 * random.normal(size=rest.shape)


def _contact_state(random: np.random.Generator) -> ContactState:
    return ContactState(
        pressure=np.maximum(random.normal(size=16), 0),
        traction=random.normal(size=(16, 2)),
        projection=random.normal(size=(96, 2)),
        projected=random.integers(0, 2, 96, dtype=np.int32),
    )


def over_master(result: StepResult, share: float = 1.0) -> StepResult:
    """A load step in which that share of the slave quadrature points has a foot, the first ones, round the ring."""
    found = (np.arange(96) < 96 * share).astype(np.int32)
    return replace(result, state=replace(result.state, contacts=tuple(replace(c, projected=found) for c in result.state.contacts)))


def _contact_result(random: np.random.Generator) -> ContactResult:
    forces = random.normal(size=(4, 3))
    return ContactResult(
        *forces,
        active=int(random.integers(16)),
        slip=3,
        traction_norm=random.random(16),
        status=random.integers(0, 3, 16, dtype=np.int32),
        gap=random.normal(size=16),
        pressure_field=np.sort(random.normal(size=2)),
        excluded=0,
        friction_work=random.random(),
        spurious_work=random.normal(),
    )


def _augmentation(random: np.random.Generator, number: int) -> AugmentationRecord:
    notes = ((), ("status changed at 3 control points",), ("line search 0.5", "status cycling at control point 7"))
    iterations = tuple(IterationRecord(i, random.random(), 3, 2, 1, notes[i % 3]) for i in range(number % 3))
    return AugmentationRecord(number, 100.0, 10.0, random.random(), random.random(), iterations)


def without_contact(made: Problem, result: StepResult) -> tuple[Problem, StepResult]:
    """The same bodies and load step, with nothing that touches."""
    return replace(made, contacts=()), replace(result, contacts=(), state=replace(result.state, contacts=()))
