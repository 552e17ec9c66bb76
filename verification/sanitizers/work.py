"""What is done under a watching tool, as a program: ``work.py VERIFICATION TESTS COUNTS [all]``.

A short scene; with ``all`` a second one, the kernel's tests and fuzzed calls as well. What was done is written to COUNTS.
"""

from __future__ import annotations

import json
import sys
from itertools import islice
from pathlib import Path

from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: Short scenes with all of contact: a press with augmentations, a twist of two bodies with friction; and how many load steps of them.
SCENES = (
    ("press", ("bodies.block.mesh.elements=[3,3,2]", "solver.method='uzawa'", "solver.slip_sum='paper'", "stages.press.steps=2")),
    (
        "twist",
        (
            "bodies.slave.mesh.elements=[2,2,2]",
            "bodies.master.mesh.order=[3,3,2]",
            "bodies.master.mesh.elements=[3,3,2]",
            "stages.press.steps=4",
        ),
    ),
)
STEPS = 2
#: Tests that call the kernel itself.
TESTS = ("test_kernel_nurbs.py", "test_kernel_projection.py", "test_kernel_solid.py", "test_sparse.py")
#: Fuzzed calls of the kernel.
CALLS = 300


class Counter:
    """A plugin of pytest that counts what passed."""

    def __init__(self) -> None:
        self.passed = 0

    def pytest_runtest_logreport(self, report: object) -> None:
        """Called at the end of each part of a test."""
        self.passed += getattr(report, "when", "") == "call" and getattr(report, "passed", False)


def steps(scenes: int) -> int:
    """Load steps of the first of the short scenes, as many as are asked for."""
    return sum(len(list(islice(Simulation(Scene.load(name, settings).problem()).run(), STEPS))) for name, settings in SCENES[:scenes])


def tests(folder: Path) -> int:
    """Tests that passed; those that bound memory are none for a tool that takes its own."""
    import pytest

    counter = Counter()
    code = pytest.main(["-q", "-p", "no:cacheprovider", "-k", "not memory", *(str(folder / name) for name in TESTS)], plugins=[counter])
    if code:
        raise SystemExit(f"tests failed under the tool: {code}")
    return counter.passed


def calls() -> int:
    """Fuzzed calls, in this process: a fault is the tool's to see.

    Their sound arguments are given back: numpy hands small blocks on, and what is kept to the end in one that a routine of the kernel had
    first is a leak of the kernel's to a tool.
    """
    from fuzz.calls import called, sound

    for number in range(CALLS):
        called(number, Path())
    sound.cache_clear()
    return CALLS


def main() -> None:
    """Do the work and write down how much it was."""
    cases, folder, counts, *more = sys.argv[1:]
    done = {"steps": steps(len(SCENES) if more == ["all"] else 1)}
    if more == ["all"]:
        sys.path.insert(0, cases)
        done |= {"calls": calls(), "tests": tests(Path(folder))}
    Path(counts).write_text(json.dumps(done))


if __name__ == "__main__":
    main()
