"""What is said where slave points go through a master that is thin, and whether what is advised gets past it."""

from __future__ import annotations

from isomortar.errors import ConvergenceError
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: A bowl that is pressed onto a plate which is held at two ends: its slave is too coarse to feel the narrow contact.
BOWL = """
format = 1
bodies.bowl.geometry = { kind = "bowl", half_width = 0.3, bottom = 0, rise = 0.04, top = 0.4 }
bodies.bowl.mesh = { order = [2, 2, 1], elements = [4, 4, 1] }
bodies.plate.geometry = { kind = "box", lower = [-1, -0.5, -0.002], upper = [1, 0.5, 0] }
bodies.plate.mesh = { order = [3, 2, 2], elements = [2, 2, 1] }
contacts.c = { slave = "bowl.w0", master = "plate.w1", friction = 0 }
supports = { top.face = "bowl.w1", left.face = "plate.u0", right.face = "plate.u1" }
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.005] }]
"""
#: A film that is pushed onto a block, both between smooth walls, by fifty times its thickness.
FILM = """
format = 1
bodies.film.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1e-4] }
bodies.film.mesh.elements = [2, 2, 1]
bodies.block.geometry = { kind = "box", lower = [0, 0, -1], upper = [1, 1, 0] }
bodies.block.mesh = { order = [2, 2, 1], elements = [3, 3, 1] }
contacts.c = { slave = "block.w1", master = "film.w0", friction = 0 }
supports.top.face = "film.w1"
supports.base.face = "block.w0"
supports.x = { face = "block.u0", components = ["x"] }
supports.y = { face = "block.v0", components = ["y"] }
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.005] }]
solver.max_cuts = 5
"""
#: The two with what is said of them, and the override that is advised.
SCENES = {
    "too coarse a slave": (BOWL, "between its constraints, which do not feel them", "bodies.bowl.mesh.elements=[12, 12, 1]"),
    "too long an increment": (FILM, "or let increments be halved more often than solver.max_cuts = 5", "solver.max_cuts=7"),
}


def ended(text: str, *changes: str) -> str:
    """What is said where a run is given up; empty, where it comes to its end."""
    try:
        list(Simulation(Scene.from_toml(text, overrides=changes).problem()).run())
    except ConvergenceError as error:
        return str(error)
    return ""


@case(
    claim="Where slave points go through a thin master it is said how thick that is, and whether its slave is too coarse to feel them or "
    "increments are too long for it; what is advised brings the run to its end.",
    tier="gate",
    grid={"scene": tuple(SCENES)},
    bounds={
        "said": Bound(1.0, 1.0, "definition: sentences with the words of the one cause, and not of the other"),
        "given up": Bound(0.0, 0.0, "definition: runs that what is advised does not bring to their end"),
    },
)
def thin_masters(scene: str) -> dict[str, float]:
    """Of one scene."""
    text, words, change = SCENES[scene]
    said = ended(text)
    (other,) = (others for name, (_, others, _) in SCENES.items() if name != scene)
    return {"said": float(said.count(words) - said.count(other[:20])), "given up": float(bool(ended(text, change)))}
