"""Increments in which bodies fall into themselves, or plates turn far: cut while shorter ones may show more, and told of once else.

So is what shrinks by more than its law resists.
"""

from __future__ import annotations

from types import SimpleNamespace
from unittest.mock import patch

import numpy as np
from supports.turning import bar, plates_turned

from isomortar.errors import ConvergenceError
from isomortar.harness import Bound, case
from isomortar.model.constants import FALLEN, LOOKED_BETWEEN, SHORT_OF_SNAPPING
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.timing import Ledger
from isomortar.told.during.inside_out import InsideOut
from isomortar.told.during.shrunk import LEAST_VOLUMES, Shrunk
from isomortar.told.during.snapping import Snapping

#: Two blocks, one of which is pressed evenly.
SCENE = """
format = 1
materials.m.law = "LAW"
bodies.still.geometry = { kind = "box", lower = [2, 0, 0], upper = [3, 1, 1] }
bodies.pressed = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, material = "m", mesh.elements = [1, 2, 1] }
bodies.still.material = "m"
supports = { still.face = "still.w0", foot.face = "pressed.w0" }
stages = [{ name = "press", steps = 2 }]
solver.max_cuts = CUTS
"""
NEO_HOOKE, HOOKE = "neo-hookean", "linear-elastic"
#: A share of the longest increment that may be cut, and one that may not.
LONG, SHORT = 1.01 * SHORT_OF_SNAPPING, SHORT_OF_SNAPPING
CUT, AT_ONCE, TURNED, NOTHING = "in one increment", "at once", "turned inside out", ""
#: J before and after an increment, its share of the longest one, how many cuts are allowed, the law, and what is made of it.
INCREMENTS: tuple[tuple[float, float, float, int, str, str], ...] = (
    (0.9, 0.99 * FALLEN * 0.9, LONG, 10, NEO_HOOKE, CUT),
    (0.9, 1.01 * FALLEN * 0.9, LONG, 10, NEO_HOOKE, NOTHING),
    (1.01 * FALLEN, 0.2 * FALLEN, LONG, 10, NEO_HOOKE, CUT),
    (0.99 * FALLEN, 0.2 * FALLEN, LONG, 10, NEO_HOOKE, NOTHING),  # it was low before
    (5.0, 0.99 * LOOKED_BETWEEN, LONG, 10, NEO_HOOKE, CUT),
    (5.0, 1.01 * LOOKED_BETWEEN, LONG, 10, NEO_HOOKE, NOTHING),
    (0.9, 0.1, LONG, 10, HOOKE, NOTHING),  # whose law knows no J
    (0.9, 0.1, SHORT, 10, NEO_HOOKE, AT_ONCE),
    (0.9, 0.1, 1.0, 0, NEO_HOOKE, AT_ONCE),
    (0.9, 0.1, 1.0, 1, NEO_HOOKE, CUT),
    (0.9, 0.1, 0.5, 1, NEO_HOOKE, AT_ONCE),
    (0.9, -0.1, LONG, 10, NEO_HOOKE, CUT),
    (0.9, -0.1, SHORT, 10, NEO_HOOKE, TURNED),
    (0.1, -0.1, LONG, 10, NEO_HOOKE, TURNED),
    (0.1, 0.05, LONG, 10, NEO_HOOKE, NOTHING),
)
#: Increments, too short to be cut, and how many of either kind have been told after each; the first of a kind is the one that is told.
HISTORY = ((0.9, 0.8, 0, 0), (0.9, 0.1, 1, 0), (0.8, 0.05, 1, 0), (0.05, -0.1, 1, 1), (-0.1, -0.2, 1, 1), (0.9, -0.3, 1, 1))


def blocks(cuts: int, law: str) -> Equilibrium:
    """The blocks."""
    return Equilibrium(Scene.from_toml(SCENE.replace("CUTS", str(cuts)).replace("LAW", law)).problem(), Ledger())


def squeezed(equilibrium: Equilibrium, jacobian: float) -> np.ndarray:
    """Positions in which one of the blocks has some J all over."""
    points, positions = equilibrium.numbering.points["pressed"], equilibrium.numbering.reference.copy()
    positions[np.unique(points), 2] *= jacobian
    return positions


def look(watch: InsideOut, equilibrium: Equilibrium, before: float, after: float, share: float) -> None:
    """Look at an increment between two J; where the second one is below zero it is not at Gauss points, which would not bear that."""
    at_points = [1.0, np.maximum(after, 0.01)]
    with patch.object(equilibrium.solid, "smallest_jacobians", return_value=at_points):
        watch.look(squeezed(equilibrium, before), squeezed(equilibrium, after), share)


def of_increment(before: float, after: float, share: float, cuts: int, law: str) -> str:
    """What is made of an increment."""
    equilibrium = blocks(cuts, law)
    watch = InsideOut(equilibrium)
    try:
        look(watch, equilibrium, before, after, share)
    except ConvergenceError as error:
        return str(error)
    return "; ".join(watch.after_step(3))


@case(
    claim="Where a body falls into itself an increment is cut, unless it is short, or no cut is left: then it is told, as it is where "
    "the body is inside out; by limits of J before and after, and not of bodies whose law knows no J.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: increments of which something else is made, and sentences that come again, or never")},
)
def falling() -> dict[str, float]:
    """Of how many."""
    wrong = 0
    for before, after, share, cuts, law, expected in INCREMENTS:
        said = of_increment(before, after, share, cuts, law)
        wrong += not (expected in said and "body 'pressed'" in said if expected else not said)
    equilibrium = blocks(10, NEO_HOOKE)
    watch, heard = InsideOut(equilibrium), list[str]()
    for step, (before, after, falls, turned) in enumerate(HISTORY, start=1):
        look(watch, equilibrium, before, after, SHORT)
        heard += watch.after_step(step)
        wrong += [sum(words in said for said in heard) for words in (AT_ONCE, TURNED)] != [falls, turned]
    twice = InsideOut(equilibrium)  # within a load step
    for before, after, *_ in HISTORY[1:]:
        look(twice, equilibrium, before, after, SHORT)
    for told in ("; ".join(heard), "; ".join(twice.after_step(2))):
        wrong += sum(words not in told for words in ("load step 2: its least J falls from 0.9 to 0.1", "J = -0.1,"))
    return {"wrong": float(wrong)}


@case(
    claim="A plate that a moment turns far in an increment is told of, once, by how far it turns, where that is too short to be "
    "cut; longer ones are cut.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: increments of which something else is made")},
)
def turning_far() -> dict[str, float]:
    """Of four by turns in degrees and shares of the longest increment."""
    equilibrium = bar("askew")
    watch, wrong = Snapping(equilibrium), 0
    start, near, far, on = (
        plates_turned(equilibrium.supports, equilibrium.numbering, np.radians([0.0, way])) for way in (0.0, 10.0, 70.0, 150.0)
    )
    for after, share, cut, words in ((near, SHORT, False, ""), (far, LONG, True, ""), (far, SHORT, False, "by 70 degrees at once")):
        try:
            watch.look(start, after, share)
            wrong += cut
        except ConvergenceError:
            wrong += not cut
        said = "; ".join(watch.after_step(2))
        wrong += words not in said or ("support 'other', load step 2" in said) != bool(words)
    watch.look(far, on, SHORT)
    return {"wrong": float(wrong + len(list(watch.after_step(3))))}


@case(
    claim="A body that is pressed to less of its volume than its law resists is told of, once, and beside it one that is not; of laws that "
    "resist the more nothing is said.",
    tier="gate",
    grid={"law": (NEO_HOOKE, HOOKE, *LEAST_VOLUMES)},
    bounds={"wrong": Bound(0.0, 0.0, "definition: load steps after which something else is said")},
)
def shrinking(law: str) -> dict[str, float]:
    """Of four, in which a block is pressed to more of its volume than that, to less, to less still, and to more again."""
    equilibrium = blocks(0, law)
    watch, least, heard = Shrunk(equilibrium), LEAST_VOLUMES.get(law, 0.5), []
    for step, share in enumerate((1.01, 0.99, 0.5, 1.01), start=1):
        heard.append("; ".join(watch.after_step(SimpleNamespace(positions=squeezed(equilibrium, share * least)), step)))  # type: ignore[arg-type]
    told = [bool(said) for said in heard] == [False, law in LEAST_VOLUMES, False, False]
    return {"wrong": float(not told or heard[1].count("body 'pressed', load step 2: it is pressed to") != (law in LEAST_VOLUMES))}
