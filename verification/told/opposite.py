"""What is said of a slave that is opposite its master, however far, and of one that is beside it."""

from __future__ import annotations

from told.runs import Heard

from isomortar.errors import ConvergenceError
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.told.after.causes import causes

#: A block that comes down onto another one, or beside it.
SCENE = """
format = 1
bodies.upper.geometry = {{ kind = "box", lower = [{aside}, 0, {gap}], upper = [{end}, 1, {top}] }}
bodies.lower.geometry = {{ kind = "box", lower = [0, 0, -1], upper = [1, 1, 0] }}
bodies.upper.mesh = {{ order = {order}, elements = 2 }}
bodies.lower.mesh = {{ order = {order}, elements = 2 }}
contacts.pair = {{ slave = "upper.w0", master = "lower.w1", projection = "{projection}" }}
supports = {{ hand.face = "upper.w1", base.face = "lower.w0" }}
stages = [{{ name = "press", steps = 2, motions.hand.translate = [0, 0, -0.2] }}]
"""
BESIDE, APART, OVER, BETWEEN = "is wholly beside its master", "apart at the start", "goes over an edge", "which is between them"
#: How far apart they are: within the way of the motion, twice that and more, and beyond the reach of averaged normals.
GAPS = (0.1, 0.6, 1.0, 3.0, 20.0)


@case(
    claim="A face opposite its master is said to be apart from it where it cannot close, by either projection, and never to be beside "
    "it, nor, where a load step is given up, to go over its edge; one beside it is said to be that.",
    tier="gate",
    grid={"projection": ("closest", "averaged"), "order": (1, 2)},
    bounds={"wrong": Bound(0.0, 0.0, "definition: sentences that are untrue or missing, of five distances, opposite and beside")},
)
def opposite(projection: str, order: int) -> dict[str, float]:
    """How many sentences are wrong."""
    wrong = 0
    for gap in GAPS:
        for aside in (0.0, 5.0):
            text = SCENE.format(aside=aside, end=aside + 1.0, gap=gap, top=gap + 1.0, order=order, projection=projection)
            simulation = Simulation(Scene.from_toml(text).problem())
            said, likely = " ".join(simulation.doubts()), " ".join(causes(simulation.equilibrium, simulation.state, ConvergenceError("")))
            wrong += (BESIDE in said) != (aside > 0.0)
            wrong += (OVER in likely) != (aside > 0.0)
            wrong += (APART in said) != (aside == 0.0 and gap > 0.4)
    return {"wrong": float(wrong)}


@case(
    claim="A slave whose points are all beside a small master opposite it is said to have it between them where it can close, and to be "
    "apart from it where it can not.",
    tier="gate",
    grid={"projection": ("closest", "averaged")},
    bounds={"wrong": Bound(0.0, 0.0, "definition: sentences that are untrue or missing, of five distances")},
)
def between_the_points(projection: str) -> dict[str, float]:
    """How many sentences are wrong."""
    wrong = 0
    for gap in GAPS:
        text = SCENE.format(aside=0.12, end=0.18, gap=gap, top=gap + 1.0, order=2, projection=projection)
        text = text.replace("0.12, 0,", "0.12, 0.12,").replace("0.18, 1,", "0.18, 0.18,")
        text = text.replace('slave = "upper.w0", master = "lower.w1"', 'slave = "lower.w1", quadrature = [3, 3], master = "upper.w0"')
        said = " ".join(Simulation(Scene.from_toml(text).problem()).doubts())
        wrong += (BESIDE in said) + ((BETWEEN in said) != (gap < 0.4)) + ((APART in said) != (gap > 0.4))
    return {"wrong": float(wrong)}


@case(
    claim="A slave that is pulled straight off its master, farther than averaged normals reach, is not said to be beside it and no more.",
    tier="gate",
    grid={"projection": ("closest", "averaged")},
    bounds={"wrong": Bound(0.0, 0.0, "definition: sentences that it is beside its master, without that it may be beyond their reach")},
)
def pulled_off(projection: str) -> dict[str, float]:
    """How many."""
    text = SCENE.format(aside=0.0, end=1.0, gap=-0.02, top=0.98, order=2, projection=projection).replace("-0.2]", "5]")
    heard = Heard()
    list(Simulation(Scene.from_toml(text).problem(), heard).run())
    beside = [said for said in heard.said if BESIDE in said]
    return {"wrong": float(sum("beyond the reach" not in said for said in beside) + (len(beside) != (projection == "averaged")))}
