"""What a recommended scene warns of when it is run, beside what is told of it: in a terminal, on its page and in its numbers."""

from __future__ import annotations

import html
import json
import re
import tempfile
from contextlib import chdir
from pathlib import Path

from forked import program
from output.heard import Hearing

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: A block that locks, and does not come to the wall beside it.
SCENE = """
format = 1
name = "block"
materials.m = { young = 1, poisson = 0.49999 }
bodies.block.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }
bodies.block.mesh = { order = 2, elements = 1 }
contacts.wall = { slave = "block.u1", plane = { point = [2, 0, 0], normal = [-1, 0, 0] }, friction = 0 }
supports.base = { face = "block.w0", components = ["z"] }
supports.top.face = "block.w1"
supports.side = { face = "block.u0", components = ["x"] }
supports.back = { face = "block.v0", components = ["y"] }
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.01] }]
"""


@case(
    claim="What the recommended scene warns of when it is run stands beside it in the terminal, on the page and in the numbers.",
    tier="gate",
    bounds={
        "untold": Bound(0.0, 0.0, "definition: warnings that one of these does not tell, or that the run does not give"),
        "warnings": Bound(at_least=2, reason="definition: before the first load step and behind the last one, or nothing is compared"),
    },
)
def warned() -> dict[str, float]:
    """How many, of a scene that warns before its first load step and at its end; `trade` tells by the same procedures."""
    with tempfile.TemporaryDirectory() as name, chdir(name):
        folder = Path(name)
        Path("block.toml").write_text(SCENE, encoding="utf-8")
        words = ("--want", "force.top.z:end", "--within", "90%", "--budget", "0.1", "--out", "out")
        _, said = program("advise", "block.toml", *words, folder=folder)
        (file,) = Path("out").glob("within-*.toml")
        heard = Hearing()
        list(Simulation(Scene.load(file).problem(), heard).run())
        warnings = {event[1] for event in heard.told if event[0] == "warned"}
        (answer,) = json.loads(Path("out/report.json").read_text(encoding="utf-8"))["answers"]
        page = html.unescape(Path("out/report.html").read_text(encoding="utf-8"))
    told = re.findall("^  warning: (.*)$", said, re.MULTILINE), answer["warnings"], re.findall("Its run warns: (.*?)</p>", page)
    return {"untold": float(sum(len(warnings ^ set(there)) for there in told)), "warnings": float(len(warnings))}
