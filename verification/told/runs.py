"""What is said in the course of a run, of scenes that go wrong on the way and of such that do not."""

from __future__ import annotations

from told.wrong.runs import PLATE, RUNS

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.record import Observer

#: What is said of a scene before it runs.
BEFORE = ("in each load step", "at the start", "nothing will happen", "the same state again", "feels no contact")
#: Those that take many load steps, or elements: their tests run them.
LONG = {"slid off", "slid off in one load step", "rolling", "quadratic Lagrange elements pressed within"}
#: A thin plate whose tip is moved by next to nothing, or further: its forces are round-off, or are not.
_THIN = PLATE.replace("THICKNESS", "1e-4").replace("TIP", '[supports.tip]\nface = "b.u1"\ncomponents = ["z"]')
PLATES = {
    "lost": (_THIN.replace("MOTION", "motions.tip.translate = [0, 0, 1e-7]"), ["load step 1: its forces are lost in round-off"]),
    "turned": (
        PLATE.replace("THICKNESS", "1e-1")
        .replace("TIP", "")
        .replace("MOTION", "motions.root = { translate = [0.3, 0.2, 0.1], rotate = 30 }"),
        [],
    ),
    "not lost": (_THIN.replace("MOTION", "motions.tip.translate = [0, 0, 1e-2]"), []),
}


class Heard(Observer):
    """Keeps what it is warned of."""

    def __init__(self) -> None:
        self.said: list[str] = []

    def warned(self, message: str) -> None:
        """Of a run, not of its scene."""
        if not any(words in message for words in BEFORE):
            self.said.append(message)


def wrong(text: str, words: list[str]) -> bool:
    """Whether something else is said than one sentence with each of the words, in their order."""
    heard = Heard()
    list(Simulation(Scene.from_toml(text).problem(), heard).run())
    return len(heard.said) != len(words) or any(word not in said for word, said in zip(words, heard.said, strict=False))


@case(
    claim="Contact that pulls, opens for good, or goes past its master, small strains that are large, and forces that are round-off are "
    "told of in the load step in which they come up, once; nothing is said of sound runs.",
    tier="gate",
    grid={"run": (*(name for name in RUNS if name not in LONG), *PLATES)},
    bounds={"wrong": Bound(0.0, 0.0, "definition: runs of which something else is said, or in other words")},
)
def runs(run: str) -> dict[str, float]:
    """Whether it is."""
    return {"wrong": float(wrong(*(RUNS | PLATES)[run]))}
