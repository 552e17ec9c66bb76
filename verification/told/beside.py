"""What is said of slave points beside the master, before a run and in it, counted from where the points are."""

from __future__ import annotations

import re

import numpy as np

from isomortar.errors import ConvergenceError
from isomortar.harness import Bound, case
from isomortar.march.outlook import outlook
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.record import Observer
from isomortar.told.after.causes import causes
from isomortar.told.after.over_edges import BESIDE

#: A block that begins beyond the edge x = 0 of its master by as much as START, and goes on.
SCENE = """
format = 1
bodies.slave.geometry = {{ kind = "box", lower = [{low}, -0.4, -0.001], upper = [{high}, 0.4, 0.4] }}
bodies.slave.mesh = {{ order = [2, 1, 1], elements = [8, 2, 1] }}
bodies.master.geometry = {{ kind = "box", lower = [-3, -1, -0.5], upper = [0, 1, 0] }}
bodies.master.mesh = {{ order = [1, 1, 1], elements = [3, 1, 1] }}
bodies.master.rigid = true
materials.cork.poisson = 0
contacts.between = {{ slave = "slave.w0", master = "master.w1", friction = 0, quadrature = [3, 2] }}
supports = {{ top.face = "slave.w1", floor.face = "master.w0" }}
stages = [{{ name = "press", steps = 1, motions.top.translate = [0, 0, 0] }},
    {{ name = "drag", steps = 1, motions.top.translate = [{way}, 0, 0] }}]
"""
LENGTH, ELEMENTS = 0.8, 8
#: A bowl in place of the block, which touches in its middle: it goes an element to the side, or so far that a part of what bears is beyond.
BOWL = SCENE
for _old, _new in (
    ('"box", lower = [{low}, -0.4, -0.001], upper = [{high}, 0.4, 0.4]', '"bowl", centre = [{low}, 0], SIZES'),
    ("SIZES", "half_width = 0.4, bottom = -0.01, rise = 0.1, top = 0.4"),
    ("order = [2, 1, 1], elements = [8, 2, 1]", "order = 2, elements = [8, 8, 1]"),
    (", quadrature = [3, 2]", ""),
):
    BOWL = BOWL.replace(_old, _new)
LEFT = re.compile(r"load step 2: (\d+) slave quadrature points have left the master.*; what they carried, about (\S+) % of the contact's")


class Heard(Observer):
    """Keeps what it is warned of."""

    def __init__(self) -> None:
        self.said: list[str] = []

    def warned(self, message: str) -> None:
        """Keep it."""
        self.said.append(message)


def beyond(low: float) -> int:
    """How many quadrature points of a block that begins at `low` are beyond the master's edge."""
    within = 0.5 * (1.0 + np.polynomial.legendre.leggauss(3)[0])
    places = low + LENGTH / ELEMENTS * (np.arange(ELEMENTS)[:, None] + within).ravel()
    return int(np.count_nonzero(places > 0.0)) * 2 * 2


@case(
    claim="Before a run and in it as many points are said to be beside the master as are beyond its edge, and of a load step those "
    "alone that were not before.",
    tier="gate",
    grid={"start": (-0.75, -0.53)},
    bounds={
        "points": Bound(0.0, 0.0, "definition: quadrature points that are not told of, or too many"),
        "beside": Bound(0.0, 0.0, "definition: of those beside the master before the run"),
        "left": Bound(0.0, 0.0, "definition: of those that have left it within the load step"),
        "share": Bound(at_least=0.7, at_most=1.5, reason="theory: of an even pressure; where elements are cut by the edge it is not"),
        "apart": Bound(at_most=1e-12, reason="round-off: the block begins a thousandth deep in its master"),
    },
)
def told_of_points(start: float) -> dict[str, float]:
    """By how many what is said is off; by how much the distance is that is told."""
    way = 0.21
    problem = Scene.from_toml(SCENE.format(low=start, high=start + LENGTH, way=way)).problem()
    (contact,) = outlook(problem).contacts
    heard = Heard()
    list(Simulation(problem, heard).run())
    ((left, share),) = [(int(found[1]), float(found[2])) for said in heard.said if (found := LEFT.search(said))]
    gone = beyond(start + way) - beyond(start)
    return {
        "points": float(contact.quadrature_points - ELEMENTS * 3 * 2 * 2),
        "beside": float(contact.excluded - beyond(start)),
        "left": float(left - gone),
        "share": 0.01 * share * (contact.quadrature_points - beyond(start)) / gone,
        "apart": abs(contact.apart + 0.001),
    }


@case(
    claim="Points that leave the master are told of where they carried something, and not where they were open.",
    tier="gate",
    bounds={
        "open": Bound(0.0, 0.0, "definition: sentences on a bowl whose rim leaves"),
        "bore": Bound(1.0, 1.0, "definition: sentences on one whose middle leaves, of the same mesh"),
    },
)
def open_points() -> dict[str, float]:
    """How often it is said."""
    said = {}
    for name, way in (("open", 0.1), ("bore", 0.4)):
        heard = Heard()
        *_, last = Simulation(Scene.from_toml(BOWL.format(low=-0.45, way=way)).problem(), heard).run()
        assert last.contacts[0].excluded > 0
        assert last.contacts[0].active > 0
        said[name] = float(sum("have left the master" in sentence for sentence in heard.said))
    return said


#: Where the block begins, and whether it is then over the edge: with whole elements beside its master it is not, with all of them it is.
STARTS = (
    (-0.85, False),
    (-0.8, False),
    (-0.78, True),
    (-0.7, False),
    (-0.65, True),
    (-0.1, False),
    (-0.01, True),
    (0.05, True),
    (0.0, True),
)
OVER = re.compile(
    r"contact 'between': the slave goes over an edge of its master; (\d+) of its (\d+) quadrature points are beside the master"
)
ABOUT = re.compile(r"in this load step, by which (\d+) of its (\d+) quadrature points come to be beside the master")
#: How Newton's method ends where nothing is said of what is behind it.
STOPPED = "Newton's method stopped at 1"
#: By the load time at the end of the increment that fails: how far the supports go in that load step.
WAYS = {1.0: 0.0, 1.25: 0.1, 2.0: 0.1}


def given_up_at(start: float, time: float) -> Simulation:
    """The block that begins at a place, as it is when a load increment that ends at a load time is given up."""
    simulation = Simulation(Scene.from_toml(SCENE.format(low=start, high=start + LENGTH, way=0.1)).problem())
    simulation.equilibrium.time = time
    return simulation


@case(
    claim="Of a load step that is given up it is said that the slave goes over an edge where a part of an element, or all of the slave, is "
    "beside its master, with the numbers of points that are; where none is, that it is about to, where the way of its supports in that "
    "load step brings more points there, with the numbers of these; and nothing of it where that was said before.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: places of the block, and load times, of which something else is said")},
)
def over_an_edge() -> dict[str, float]:
    """How many of nine, at three load times each."""
    wrong, points = 0, ELEMENTS * 3 * 2 * 2
    for start, over in STARTS:
        for time, way in WAYS.items():
            simulation = given_up_at(start, time)
            errors = [ConvergenceError(STOPPED + where) for where in ("", BESIDE)]
            said, again = ("\n".join(causes(simulation.equilibrium, simulation.state, error)) for error in errors)
            there, ahead = beyond(start), beyond(start + way)
            told, about = ([(int(beside), int(of)) for beside, of in words.findall(said)] for words in (OVER, ABOUT))
            wrong += told != [(there, points)] * over
            wrong += about != [(ahead, points)] * (not over and ahead > there)
            wrong += "over an edge" in again or "goes over it" in again
    return {"wrong": float(wrong)}
