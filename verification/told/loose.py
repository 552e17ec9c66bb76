"""Bodies that no support holds: taken where they touch what is held, on either side of a contact, and refused by name where they do not."""

from __future__ import annotations

from isomortar.errors import InputError
from isomortar.harness import Bound, case
from isomortar.scene import Scene

#: A block on one that is held, another one on that, and one that is glued to that.
SCENE = """
format = 1
bodies.base.geometry = {{ kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }}
bodies.mid.geometry = {{ kind = "box", lower = [0, 0, {low}], upper = [1, 1, 2] }}
bodies.top.geometry = {{ kind = "box", lower = [0, 0, 2], upper = [1, 1, 3] }}
bodies.cap.geometry = {{ kind = "box", lower = [0, 0, 3], upper = [1, 1, 4] }}
glue = [["top.w1", "cap.w0"]]
contacts = {{ first = {{ {first} }}, second = {{ {second} }} }}
supports = {supports}
stages = [{{ name = "one", steps = 1 }}]
"""
UP, DOWN = ('slave = "mid.w0", master = "base.w1"', 'slave = "base.w1", master = "mid.w0"')
MORE, LESS = ('slave = "top.w0", master = "mid.w1"', 'slave = "mid.w1", master = "top.w0"')
BASE, CAP = '{ held.face = "base.w0" }', '{ held.face = "cap.w1" }'
#: Where the second block begins, contacts, supports, and the body that is named where that is refused.
TRIED = (
    *((1, first, second, held, "") for first in (UP, DOWN) for second in (MORE, LESS) for held in (BASE, CAP)),
    *((1.25, first, second, BASE, "mid") for first in (UP, DOWN) for second in (MORE, LESS)),
    *((1.25, first, second, CAP, "base") for first in (UP, DOWN) for second in (MORE, LESS)),
)


def named(low: float, first: str, second: str, supports: str) -> str:
    """The body for which the scene is refused; empty: it is not."""
    text = SCENE.format(low=low, first=first, second=second, supports=supports)
    try:
        Scene.from_toml(text).problem()
    except InputError as error:
        return str(error).partition("bodies.")[2].partition(":")[0] or str(error)
    return ""


@case(
    claim="A body without a support is taken where it touches what is held, or what touches that, as slave or master; else refused.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: scenes that are refused for another body, or for none, or should not be")},
)
def held_by_touch() -> dict[str, float]:
    """How many."""
    return {"wrong": float(sum(named(*given) != name for *given, name in TRIED))}  # type: ignore[arg-type]
