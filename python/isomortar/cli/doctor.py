"""``isomortar doctor``: is this installation sound? What it consists of, and a small scene that is known to come out right."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import typer

import isomortar
from isomortar._frozen import frozen
from isomortar.cli.endings import FAILED

if TYPE_CHECKING:
    from isomortar.scene import Scene

#: The scene that is run: two bodies, friction, contact that sticks and slips; its load steps, and where its tangent is measured.
SCENE = (
    "twist",
    ("bodies.slave.mesh.elements=[2,2,2]", "bodies.master.mesh.elements=[4,4,2]", "stages.press.steps=2", "stages.twist.steps=4"),
)
STEP = 4
#: What the sum of all forces on supports may be of the largest: Newton's tolerance, many times over.
BALANCE = 1e-7


@frozen
class Examined:
    """Something that was looked at: whether it is right, and words for it."""

    right: bool
    words: str


def doctor() -> None:
    """Say what this installation consists of, and try it in some seconds; exit code 1 where something is wrong.

    For example: `isomortar doctor`
    """
    from isomortar.harness.store import identity

    for line in installed(identity()):
        print(line)
    scene = isomortar.Scene.load(*SCENE)
    wrong = 0
    for one in examined(scene):
        print(f"{'right' if one.right else 'WRONG'}  {one.words}")
        wrong += not one.right
    print(f"{wrong} of these are wrong: install again, with the versions that pyproject.toml allows" if wrong else "all is well")
    raise typer.Exit(FAILED if wrong else 0)


def installed(identity: dict[str, object]) -> Iterator[str]:
    """What it consists of, a line each."""
    from isomortar._compiled import kernel
    from isomortar.model.memory import memory_of_machine

    libraries = identity["libraries"]
    assert isinstance(libraries, dict)
    yield f"isomortar {isomortar.__version__} in {Path(isomortar.__file__).parent}"
    yield f"kernel {str(identity['kernel'])[:12]}, made by {identity['compiler']}, taken as {kernel.__name__}"
    yield "with " + ", ".join(f"{name} {version}" for name, version in libraries.items())
    yield f"on {len(os.sched_getaffinity(0))} cores, {memory_of_machine() / 1e9:.3g} GB of memory to take"


def examined(scene: Scene) -> Iterator[Examined]:
    """What is looked at: that forces read back from a results file balance, and that the tangent is the derivative."""
    from tempfile import TemporaryDirectory

    import numpy as np

    from isomortar.driver import run
    from isomortar.harness.tangents import check_tangent

    with TemporaryDirectory() as folder:
        path = Path(folder) / "doctor.h5"
        run(scene, path, isomortar.Observer()).close()
        with isomortar.Results(path) as results:
            steps = [results.step(int(number)) for number in results.steps]
    forces = np.array([[reaction.force for reaction in step.reactions] for step in steps])
    left = float(np.max(np.linalg.norm(forces.sum(axis=1), axis=1) / np.linalg.norm(forces, axis=2).max(axis=1)))
    yield Examined(
        len(steps) == 6 and left < BALANCE, f"{len(steps)} load steps of {scene.name} run and read back; forces balance to {left:.0e}"
    )
    report = check_tangent(scene.problem(), STEP)
    worst = max(report.rows, key=lambda row: row.error / row.bound)
    yield Examined(report.passes, f"the tangent is the derivative to {worst.error:.0e} in {worst.part} (bound {worst.bound:.0e})")
