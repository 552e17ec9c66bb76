"""Bodies that no support holds: taken where they touch what is held, on either side of a contact, and refused by name where they do not."""

from __future__ import annotations

from told.too_steep import said
from told.wrong.contacts import PAIR
from transforms import scaled

from isomortar.errors import InputError
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.told.after.averages_apart import averages_apart
from isomortar.told.before.not_held import not_held_against

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


#: A roller between a floor and a plate, which both of them touch along a line.
ROLLER = """
format = 1
materials.m = { young = 40, poisson = 0.3 }
bodies.roller = { geometry = { kind = "ring", outer = 0.5, inner = 0.3, width = 0.4 }, mesh.elements = [COUNT, 1, 1] }
bodies.plate = { rigid = true, geometry = { kind = "box", lower = [-1.2, -1.2, 0.5], upper = [1.2, 1.2, 0.7] } }
contacts.floor = { slave = "roller.v1", friction = 0.3, plane.point = [0, 0, -0.5] }
contacts.plate = { slave = "roller.v1", friction = 0.3, master = "plate.w0" }
supports = { plate.face = "plate.w1", hold = { edge = "roller.v0.w0", components = ["y"] } }
stages = [{ name = "press", steps = 1, motions.plate.translate = [0, 0, -0.05] }]
solver.max_cuts = 2
"""


@case(
    claim="A roller that a plate presses on a floor, of elements too long for their averages to touch, is told to be refined there, and "
    "runs on finer ones.",
    tier="gate",
    bounds={
        "told": Bound(2.0, 2.0, "definition: the contacts of the coarse one that are told to be refined"),
        "runs": Bound(1.0, 1.0, "definition: the same of finer elements"),
    },
)
def too_coarse() -> dict[str, float]:
    """How many."""
    coarse, fine = (said(ROLLER.replace("COUNT", count)) for count in ("4", "16"))
    return {"told": float(coarse.count("Refine roller.v1 where it touches")), "runs": float(fine == "")}


#: How far the roller is above the floor, what else is changed, and whether the floor's averages are told to be apart: points are at it up
#: to a tenth of that, 0.0625.
ABOVE: tuple[tuple[float, tuple[str, ...], bool], ...] = (
    (0.0, (), True),
    (0.006, (), True),
    (0.008, (), False),
    (0.0, ("contacts.floor.enforcement=knots",), False),  # whose constraints are points
    (0.0, ("supports.hold.components=['x','y','z']",), False),
    (0.0, ("supports.hold={face='roller.w0'}",), False),
)


@case(
    claim="Averages are told to be apart where points are at the master, beside how far apart they are, of bodies that can move freely; "
    "not of constraints at points.",
    tier="gate",
    grid={"unit": (1.0, 2.0**-10, 2.0**10)},
    bounds={"wrong": Bound(0.0, 0.0, "definition: rollers of which something else is told, in that unit of length")},
)
def points_at_master(unit: float) -> dict[str, float]:
    """How many of six."""
    wrong = 0
    for above, changes, is_told in ABOVE:
        text = ROLLER.replace("COUNT", "4").replace("[0, 0, -0.5]", f"[0, 0, {-0.5 - above}]")
        simulation = Simulation(scaled(Scene.from_toml(text, overrides=changes).problem(), unit, 1.0))
        told = [sentence for sentence in averages_apart(simulation.equilibrium, simulation.state) if "contact 'floor'" in sentence]
        wrong += len(told) != is_told
    return {"wrong": float(wrong)}


BASE_SUPPORT, BLOCK_BELOW = '[supports.base]\nface = "lower.w0"', 'kind = "box", lower = [-1, -1, -1], upper = [1, 1, 0]'
UNHELD = PAIR.replace(BASE_SUPPORT, "")
#: The same on the inner face of a part of a pipe, whose normals are up to 30 degrees from the middle one, and on half of a pipe.
HOLLOW = UNHELD.replace(BLOCK_BELOW, 'kind = "ring", inner = 1, outer = 2, width = 2, axis = "y", angles = [60, 120]').replace(
    "lower.w1", "lower.v0"
)
#: A pair whose lower body the upper one is pushed on, and whether that is told to be held by nothing against it.
PUSHED = (
    (PAIR, False),
    (UNHELD, True),
    (UNHELD.replace("[supports.top]", "friction = 2\n[supports.top]"), True),
    (UNHELD.replace("[supports.top]", "cohesion = 1\n[supports.top]"), False),
    (UNHELD.replace("[supports.top]", '[supports.base]\nface = "lower.w0"\ncomponents = ["x", "y"]\n[supports.top]'), True),
    (UNHELD.replace("[supports.top]", '[supports.base]\nedge = "lower.u0.w0"\ncomponents = ["z"]\n[supports.top]'), False),
    (UNHELD.replace("[supports.top]", '[supports.base]\nface = "lower.w0"\ncomponents = ["x"]\nforce.z = 1\n[supports.top]'), False),
    (UNHELD.replace("[supports.top]", '[loads.up]\nbody = "lower"\nweight = [0, 0, 1]\n[supports.top]'), False),
    (UNHELD.replace("[supports.top]", '[contacts.under]\nslave = "lower.w0"\nplane.point = [0, 0, -1]\n[supports.top]'), False),
    (UNHELD.replace("[bodies.lower]", "[bodies.lower]\nrigid = true"), False),
    (HOLLOW.replace("[supports.top]", "friction = 1.5\n[supports.top]"), True),
    (HOLLOW.replace("[supports.top]", "friction = 2\n[supports.top]"), False),
    (HOLLOW.replace("[60, 120]", "[0, 180]"), False),
)


@case(
    claim="Bodies that all of their contacts push one way are told that nothing holds them against it, and no others: those held, loaded, "
    "between two contacts, round what pushes them, or kept by friction or cohesion.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: scenes of which that is told and should not be, or the other way round")},
)
def pushed_one_way() -> dict[str, float]:
    """How many of thirteen."""
    told = [any("pushes it one way" in said for said in not_held_against(Scene.from_toml(text).whole())) for text, _ in PUSHED]
    return {"wrong": float(sum(found != is_so for found, (_, is_so) in zip(told, PUSHED, strict=True)))}
