"""What is said in the course of a run of a scene, and of the same scene with all of it once more beside it: each sentence twice."""

from __future__ import annotations

import tomllib
from collections import Counter
from dataclasses import replace

import numpy as np
from told.alike import words
from told.other_units import of_a_run, others
from told.runs import LONG, PLATES
from told.word_by_word import SENTENCES
from told.wrong.doubts import DOUBTFUL
from told.wrong.runs import RUNS
from transforms import moved

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Contact, Face, Faces, Problem, RigidPlane
from isomortar.scene import Scene
from isomortar.told.before.doubts import doubts

#: How far the other one is away, in sizes of the largest body: far from the origin positions have fewer digits.
APART = 3.0
#: What the names of the other one end with: no letter, which `words` would see.
MARK = "2"
#: Doubts about a scene as a whole, its settings, or what cuts it through: of two there is no half, and none of them alone does nothing.
OF_THE_WHOLE = {
    *("nothing moves", "all rigid", "idle stage", "loose", "setting of the first method", "setting of the other method"),
    *("half a ring", "other unit of moduli"),
}
#: Of scenes of two bodies, which take longer, those of what holds them twice, and of what nothing holds.
OF_TWO_BODIES = {"held twice", "not held against"}


def doubled(problem: Problem) -> Problem:
    """The problem with all of it once more, under other names, where it is along its planes and far away."""
    normals = [contact.master.normal for contact in problem.contacts if isinstance(contact.master, RigidPlane)]
    along = int(np.argmin(np.abs(np.reshape(normals, (-1, 3))).sum(axis=0)))
    size = float(np.max([body.size for body in problem.bodies]))
    other = moved(problem, APART * size * np.eye(3)[along])
    return replace(
        problem,
        bodies=(*problem.bodies, *(replace(body, name=body.name + MARK) for body in other.bodies)),
        contacts=(*problem.contacts, *map(_contact, other.contacts)),
        supports=(*problem.supports, *(replace(s, name=s.name + MARK, place=_side(s.place)) for s in other.supports)),
        loads=(*problem.loads, *(replace(load, name=load.name + MARK, body=load.body + MARK) for load in other.loads)),
        glue=(*problem.glue, *((_side(one), _side(two)) for one, two in other.glue)),
    )


def _contact(contact: Contact) -> Contact:
    master = contact.master if isinstance(contact.master, RigidPlane) else _side(contact.master)
    return replace(contact, name=contact.name + MARK, slave=_side(contact.slave), master=master)


def _side(place: Face) -> Face:
    if isinstance(place, Faces):
        return replace(place, body=place.body + MARK, beside=tuple(map(_side, place.beside)))
    return replace(place, body=place.body + MARK)


@case(
    claim="What is said of a body or a contact in the course of a run is said of each of which it is true, however many there are.",
    tier="gate",
    grid={"run": (*(name for name in RUNS if name not in LONG), *PLATES)},
    bounds={"others": Bound(0.0, 0.0, "definition: sentences that are not there twice, once for each half of the scene")},
)
def each(run: str) -> dict[str, float]:
    """How many."""
    problem = Scene.from_toml((RUNS | PLATES)[run][0]).problem()
    once = of_a_run(problem)
    return {"others": others(Counter({said: 2 * count for said, count in once.items()}), of_a_run(doubled(problem)))}


@case(
    claim="What is doubtful of a body, a contact, a support or a load before a run is told of each of which it is true, as often.",
    tier="gate",
    bounds={
        "others": Bound(0.0, 0.0, "definition: scenes whose sentence is not there twice, once for each half, or beside which another is"),
        "scenes": Bound(at_least=40.0, reason="definition: or next to nothing is tried"),
    },
    files=[SENTENCES],
)
def each_doubt() -> dict[str, float]:
    """How many."""
    expected, tried, off = tomllib.loads(SENTENCES.read_text(encoding="utf-8"))["doubtful"], 0, 0
    for name, (text, old, new, *_) in DOUBTFUL.items():
        problem = Scene.from_toml(text.replace(old, new)).problem()
        if name in OF_THE_WHOLE or (len(problem.bodies) > 1 and name not in OF_TWO_BODIES):
            continue
        both = doubled(problem)
        said = Counter(map(words, doubts(both, Simulation(both).state)))
        tried, off = tried + 1, off + (said != Counter({words(sentence): 2 for sentence in expected[name].split("\n")}))
    return {"others": float(off), "scenes": float(tried)}
