"""Instructions of a scene without contact beside those of a plain program for solids: unlike times they are the same on a busy machine."""

from __future__ import annotations

import re
import shutil
import sys
import tempfile
from pathlib import Path

from required.solid_alone import BENT, Plain
from speed.instructions import CORE

from isomortar.harness import Bound, case, skip
from isomortar.march.simulation import Simulation
from isomortar.program.process import output_of
from isomortar.scene import Scene

#: Elements of the block, enough for what both do to be most of it.
ELEMENTS = "bodies.block.mesh.elements=[8,8,4]"


def run(program: str, times: int) -> None:
    """Bend the block so many times by one of the two programs, `ours` or `plain`."""
    problem = Scene.from_toml(BENT, overrides=[ELEMENTS]).problem()
    for _ in range(times):
        if program == "ours":
            list(Simulation(problem).run())
        else:
            Plain(problem).run()


def count(program: str, times: int) -> float:
    """Instructions of a process that does so, the libraries' and Python's included."""
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "log"
        options = ["--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null", f"--log-file={log}"]
        code = f"from required import solid_instructions; solid_instructions.run({program!r}, {times})"
        output_of(["valgrind", *options, sys.executable, "-c", code], folder=Path(__file__).parents[1], environment=CORE)
        said = re.search(r"I +refs: +([\d,]+)", log.read_text())
    assert said, "cachegrind tells the instructions"
    return float(said.group(1).replace(",", ""))


@case(
    claim="A scene without contact takes as many instructions as a plain program for solids, Python's included, to a fiftieth.",
    tier="nightly",
    bounds={"ratio": Bound(at_most=1.02, at_least=0.9, reason="definition: what a scene does not require it does not pay for")},
)
def solid_instructions() -> dict[str, float]:
    """Two processes of each, of which one does the work once more; so that what starting takes does not count."""
    if shutil.which("valgrind") is None:
        skip("valgrind, which counts, is not installed: apt-get install valgrind")
    ours, plain = (count(program, 2) - count(program, 1) for program in ("ours", "plain"))
    return {"ratio": ours / plain}
