"""Newton loops that go round in a circle: they end, and say so; those that creep on, or are near a solution, do not."""

from __future__ import annotations

import re

from extreme_scenes import SCENES
from told.wrong.singular import error

from isomortar.harness import Bound, case
from isomortar.solve.trail import Trail

#: What is left in a row of iterations, and whether that is a circle: of one iterate, of two; one that is left slowly, or grows; one of
#: round-off; one that has just begun; one of three.
MERITS: list[tuple[list[float], bool]] = [
    ([3.0, *[1.9959] * 5], True),
    ([5.0, 1.98, 2.41, 1.98, 2.4101, 1.98, 2.41], True),
    ([0.02 * 0.99**k for k in range(20)], False),
    ([2.0 * 1.003**k for k in range(20)], False),
    ([0.5, *[3e-9] * 10], False),
    ([3.0, *[1.9959] * 4], False),
    ([1.0, 1.5, 2.0] * 4, False),
]


def circles(merits: list[float], states: list[bytes]) -> bool:
    """What a trail of these says."""
    trail = Trail()
    trail.merits, trail.states = merits, states
    return trail.circles


def round_in_a_circle(steps: int) -> str:
    """What a run says that is given up with next to no elastic slip, its press in as many load steps, which may not be cut."""
    bowl = (SCENES / "coarse-bowl.toml").read_text(encoding="utf-8")
    return error(bowl, f"stages.press.steps={steps}", "contacts.interface.elastic_slip=1e-9", "solver.max_cuts=0")


@case(
    claim="The last iterates go round in a circle where what is left is that of one or two before, and so are states; not where it creeps "
    "on, is near a solution, or states change.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: rows of iterations of which the other is said")},
)
def seen() -> dict[str, float]:
    """Of twice as many as there are rows: with the same states, and with states that are other ones each time."""
    wrong = [circles(merits, [b""] * len(merits)) != expected for merits, expected in MERITS]
    changing = [circles(merits, [bytes([k]) for k in range(len(merits))]) for merits, _ in MERITS]
    return {"wrong": float(sum(wrong) + sum(changing))}


@case(
    claim="A Newton loop that friction of next to no elastic slip sends round in a circle ends with that said, in two thirds of the "
    "iterations that it may take.",
    tier="gate",
    grid={"steps": (2, 4, 6)},
    bounds={
        "iterations": Bound(at_most=20.0, reason="definition: two thirds of solver.max_iterations, which all were"),
        "silent": Bound(0.0, 0.0, "definition: whether it is not said"),
    },
)
def ended(steps: int) -> dict[str, float]:
    """Of the first load step that does not converge."""
    said = round_in_a_circle(steps)
    (iterations,) = re.findall(r"after (\d+) iterations", said)
    return {"iterations": float(iterations), "silent": float("iterations, going round in a circle" not in said)}
