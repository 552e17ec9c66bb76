"""What is said of thin bodies of order 1: how many times too stiff they are in bending, against beams that are bent."""

from __future__ import annotations

import re

from isomortar.harness import Bound, case
from isomortar.march.outlook import outlook
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

SCENE = """
format = 1
materials.m = { young = 1, poisson = POISSON, law = "linear-elastic" }
bodies.sheet = { geometry = { kind = "box", lower = [0, 0, 0], upper = [8, 1, THICK] }, mesh = { order = ORDER, elements = [8, 1, 1] } }
supports.wall.face = "sheet.u0"
stages = [{ name = "bend", steps = 1 }]
"""
LOAD = 'loads.weight = { face = "sheet.w1", pressure = 1e-9 }\n'
SAID = re.compile(r"body 'sheet' is (\S+) thick along w, and .* about (\S+) times too stiff in bending")
_GLUED = (
    'bodies.more = { geometry = { kind = "box", lower = [0, 0, 0.3], upper = [8, 1, 1.5] }, mesh = { order = 1, elements = [8, 1, 1] } }\n'
    'glue = [["sheet.w1", "more.w0"]]\n'
)
#: Scenes that bend, or have nothing to bend: what is replaced in that of order 1, and by what.
SOUND = {
    "of order 2": ("order = 1", "order = 2"),
    "of order 2 along one side": ("order = 1", "order = [2, 1, 1]"),
    "short elements": ("elements = [8, 1, 1]", "elements = [40, 1, 1]"),
    "thick": ("0.3]", "2]"),
    "held along its sheet": ("supports.wall.face", 'supports.below.face = "sheet.w0"\nsupports.wall.face'),
    "rigid": ("mesh = {", "rigid = true, mesh = {"),
    "glued to what is thick": ("supports.wall.face", _GLUED + "supports.wall.face"),
}


def scene(thickness: float, poisson: float, order: int) -> str:
    """The sheet, held at one end."""
    return SCENE.replace("THICK", str(thickness)).replace("POISSON", str(poisson)).replace("ORDER", str(order))


def told(text: str) -> list[tuple[float, float]]:
    """Thickness and number of times that are told."""
    warnings = outlook(Scene.from_toml(text).problem()).warnings
    return [(float(found[1]), float(found[2])) for warning in warnings if (found := SAID.search(warning))]


def bent(text: str) -> float:
    """How far the end goes down."""
    (result,) = Simulation(Scene.from_toml(text + LOAD).problem()).run()
    return float(-result.state.positions[:, 2].min())


@case(
    claim="Thin bodies of order 1 are told to be as many times too stiff in bending as they are, beside those of order 4, but for a tenth.",
    tier="gate",
    grid={"thickness": (0.2, 0.35, 0.5), "poisson": (0.0, 0.3)},
    bounds={
        "off": Bound(at_most=0.1, reason="theory: of a beam, without its width and its sheared ends; two digits are told"),
        "thickness": Bound(at_most=1e-9, reason="round-off: of three digits, off what is given"),
        "finer": Bound(0.0, 0.0, "definition: warnings of the same on order 4"),
    },
)
def bending(thickness: float, poisson: float) -> dict[str, float]:
    """The number of times that is told over the one that a beam of eight elements shows."""
    one, four = scene(thickness, poisson, 1), scene(thickness, poisson, 4)
    ((thick, times),) = told(one)
    return {"off": abs(times * bent(one) / bent(four) - 1.0), "thickness": abs(thick - thickness), "finer": float(len(told(four)))}


@case(
    claim="Bodies that bend as they should, or cannot bend, are not told to be too stiff.",
    tier="gate",
    bounds={
        "doubted": Bound(0.0, 0.0, "definition: scenes of which it is said"),
        "said": Bound(1.0, 1.0, "definition: of the thin one it is"),
    },
)
def not_bent() -> dict[str, float]:
    """How many of seven, and of the one beside them."""
    thin = scene(0.3, 0.3, 1)
    assert all(old in thin for old, _ in SOUND.values())
    doubted = [name for name, (old, new) in SOUND.items() if told(thin.replace(old, new))]
    return {"doubted": float(len(doubted)), "said": float(len(told(thin)))}
