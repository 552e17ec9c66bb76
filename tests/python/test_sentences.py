"""What the program says, word by word: refusals, warnings, causes, what a results file says of itself. `sentences.toml` is to be read."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path

import h5py
import numpy as np
import pytest
from told.astray import STRETCHING, TURNING
from told.astray import run as astray
from told.behind import DOWN
from told.behind import SCENE as FLOOR
from told.bending import STIFF, thin
from told.between_points import CROSSED, ORDER_3, crossed
from told.beyond_edges import STRIP as BEYOND_EDGES
from told.beyond_edges import punch
from told.dents import scene as at_points
from told.given_up import all_told, without_digits
from told.held_inside import ON_EDGE as HELD_INSIDE
from told.in_itself import STRIP, wound
from told.long_elements import CAP
from told.mirrored import of_half
from told.narrow import BALL, BALLS, STRIPS, depth, strip
from told.on_areas import BALL as BY_AREA
from told.other_faces import INTO_A_WALL
from told.passing import SCENE as BENT
from told.pivoting import FLAT as TURNED
from told.rolling import RING as ROLLED
from told.unstable import LYING
from told.unstable import column as slender
from told.weights import column
from told.word_by_word import KINDS as OF_SCENES
from told.word_by_word import SENTENCES
from told.wrong.contacts import PRESS
from told.wrong.runs import PLATE, RUNS
from told.wrong.singular import CORNER

from isomortar.errors import IsomortarError
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Face
from isomortar.model.numbering import Numbering
from isomortar.model.pairs import Pair
from isomortar.model.plates import rotation
from isomortar.results.reader import Results
from isomortar.results.writer import ResultsWriter
from isomortar.scene import Scene
from isomortar.told.before import doubts
from isomortar.told.during import leaving, pulling
from isomortar.told.during.advice import StepAdvice
from isomortar.told.during.in_itself import InItself
from isomortar.told.during.inside_out import InsideOut
from isomortar.told.during.leaving import Leaving
from isomortar.told.during.snapping import Snapping
from results_samples import problem, step_result
from test_advice import Warned, _of_weights, rational, warnings
from test_causes import scene
from test_singular import STICKING, Heard

HEARD: dict[str, dict[str, str]] = tomllib.loads(SENTENCES.read_text(encoding="utf-8"))

#: Name and sentence of each case of a kind.
Told = Iterator[tuple[str, str]]


def refusal(action: Callable[[], object]) -> str:
    """What an error says."""
    with pytest.raises(IsomortarError) as raised:
        action()
    return str(raised.value)


def bad_words(_: pytest.MonkeyPatch) -> Told:
    """Refused on the command line, or as a whole."""
    for name, override in {
        "no value": "bodies.slave.mesh",
        "no body": "bodies.slav.mesh.order=3",
        "no stage": "stages.darg.steps=3",
        "no number": "stages.2.steps=3",
        "a single value": "name.first=3",
        "no load": "loads.wnd.pressure=0.1",
        "no table": "contacts.interface=3",
        "no plane": "contacts.interface.plane=[0, 0, 1]",
        "no force": "supports.top.force=-10",
        "no mesh": "bodies.slave.mesh=[4, 4, 2]",
        "no geometry": "bodies.slave.geometry=box",
        "no material": "bodies.slave.material={ young = 3 }",
        "no face": "supports.top.face=['slave.w1']",
        "no slave": "contacts.interface.slave=3",
        "no motion": "stages.press.motions.top=[0, 0, -0.1]",
        "no list": "supports.top.components=x",
        "a truth value": "solver.max_cuts=true",
        "a date": "title=2026-11-27",
        "a text for a number": 'contacts.interface.subcells="1"',
        "half a pair": 'glue=[["slave.u0"]]',
        "a long number": f"solver.max_cuts={'9' * 5000}",
        "nested without end": f"solver.max_cuts={'[' * 5000}",
    }.items():
        yield name, re.sub(r"9{99,}|\[{99,}", "#", refusal(partial(Scene.load, "iron", [override])))
    twice = 'record.curves=[{ name = "push", support = "top" }, { name = "push", support = "base" }]'
    yield "a curve twice", refusal(lambda: Scene.load("iron", [twice]).problem())
    yield "no path", refusal(lambda: Scene.load("iron", {"solver max_cuts": 3}))
    yield "no value by path", refusal(lambda: Scene.load("iron", {"solver.max_cuts": None}))
    yield "no scene", refusal(lambda: Scene.load("irn"))
    yield "seam", refusal(lambda: Scene.load("tire", ["contacts.road.slave=tire.u0"]).problem())


def of_weights_and_memory(patch: pytest.MonkeyPatch) -> Told:
    """Warnings on weights that differ too much, and on too little memory."""
    (yield "weights", *_of_weights(rational(8.0)))
    yield "weights, refused", refusal(partial(_of_weights, rational(30.0)))
    yield "weights without a cure", refusal(partial(_of_weights, rational(1e6)))
    yield "weights of a slave", next(said for said in Simulation(column(5.0, "plane")).doubts() if "quadrature points" in said)
    patch.setattr(doubts, "memory_of_machine", lambda: 1e6)
    (yield "memory", *warnings(PRESS))


def along_the_way(_: pytest.MonkeyPatch) -> Told:
    """Warnings before, at and after load steps."""
    yield "stiff and fine slave", _before_the_first_step(scene(HARD=150, SLAVE=4))
    yield "few points", _before_the_first_step(scene(SLAVE=1, MASTER=8), 1)
    yield (
        "few constraints",
        next(said for said in Simulation(at_points("column", "greville", (2, 2), 9).problem()).doubts() if "points" in said),
    )
    result = step_result(2)
    nothing = [replace(state, pressure=np.zeros(16), projected=np.ones(96, dtype=np.int32)) for state in result.state.contacts]
    calm = [replace(state, pressure=np.full(16, 0.5)) for state in nothing]
    wild = [calm[0], replace(calm[1], pressure=np.full(16, 0.8))]
    advice = StepAdvice(problem(), 0, calm)
    measured = tuple(replace(c, active=9, pressure_field=np.array([0.0, 0.5]), excluded=0, spurious_work=0.0) for c in result.contacts)
    assert list(advice.after_step(1, measured, calm)) == []
    left = (replace(measured[0], excluded=7), measured[1])
    pairs = [Pair(contact, problem(), Numbering(problem())) for contact in problem().contacts]
    over = [replace(calm[0], projected=(np.arange(96) >= 7).astype(np.int32)), calm[1]]
    (yield "left the master", *Leaving(pairs, calm).after_step(2, left, over))
    (yield "oscillates", *advice.after_step(2, left, wild))
    assert list(advice.after_step(3, left, wild)) == list(advice.at_the_end({})) == []
    half = [replace(state, projected=(np.arange(96) < 48).astype(np.int32)) for state in calm]
    beyond = (measured[0], replace(measured[1], excluded=48))
    (yield "large beside the master", *StepAdvice(problem(), 0, half).after_step(2, beyond, wild))
    gone = (replace(measured[0], active=0, excluded=96), measured[1])
    (yield "beside", *advice.after_step(4, gone, calm))
    tread, ground = problem().contacts
    averaged = replace(problem(), contacts=(replace(tread, master=Face("tyre", "v0"), projection="averaged"), ground))
    yield "left or far", leaving._sentence(Pair(averaged.contacts[0], averaged, Numbering(averaged)), 96, 1.0, 2)
    (yield "beside or far", *StepAdvice(averaged, 0, calm).after_step(2, gone, calm))
    assert list(advice.after_step(5, gone, calm)) == []
    (yield "opened", *advice.at_the_end({}))
    advice = StepAdvice(problem(), 0, calm)
    works = [(1.0, 0.1), (1.0, -0.07), (1.0, -0.2)]
    for step, (friction, spurious) in enumerate(works, 1):
        working = (measured[0], replace(measured[1], friction_work=friction, spurious_work=spurious))
        assert list(advice.after_step(step, working, calm)) == []
        if step == 2:
            assert list(advice.at_the_end({})) == []
    (yield "spurious work", *advice.at_the_end({}))
    (yield "pushed in", *warnings(CORNER))
    heard, motion = Heard(), "[0.0, 0.0, -0.05]"
    list(
        Simulation(
            Scene.from_toml(
                STICKING.replace("MOTION", motion), overrides=["contacts.wall.friction=0.9", "contacts.floor.friction=0.9"]
            ).problem(),
            heard,
        ).run()
    )
    (yield "sticks to both", *(re.sub(r"\d+ slave", "# slave", said) for said in heard.said))  # how many is left open, too
    yield "pulls", pulling._sentence(problem().contacts[0], 3, rolled=False)
    yield "pulls, plane", pulling._sentence(problem().contacts[1], 3, rolled=False)
    yield "pulls, rolled", pulling._sentence(problem().contacts[0], 3, rolled=True)
    text = PRESS.replace('face = "block.w1"', 'face = "block.w1"\nmoment = 0\naxis = [0, 1, 0]').replace(", rotate = 0", "")
    tilting = Simulation(Scene.from_toml(text).problem()).equilibrium
    snapping, here = Snapping(tilting), tilting.numbering.reference
    turned = here @ rotation(np.array([0.0, 1.0, 0.0]), 1.0).T
    yield "cut, as it snaps", refusal(partial(snapping.look, here, turned, 0.5))
    assert list(snapping.after_step(2)) == []
    snapping.look(here, turned, 0.125)
    (yield "snaps", *snapping.after_step(3))
    assert list(snapping.after_step(4)) == []
    inside_out, flat = InsideOut(tilting), here * [1.0, 1.0, 0.2]
    yield "cut, as it falls into itself", refusal(partial(inside_out.look, here, flat, 0.5))
    assert list(inside_out.after_step(2)) == []
    inside_out.look(here, flat, 0.125)
    (yield "falls into itself", *inside_out.after_step(3))
    inside_out.look(here, flat, 0.125)
    assert list(inside_out.after_step(4)) == []
    inside_out, corner = InsideOut(tilting), here * [1.0, 1.0, 0.45]
    corner[(corner @ [1.0, 1.0, 5.0]).argmin()] += 0.3
    inside_out.look(here * [1.0, 1.0, 0.45], corner, 0.125)
    (yield "inside out", *inside_out.after_step(3))
    (yield "never closed", *[list(StepAdvice(problem(), 0, nothing).at_the_end({}))[1]])
    (yield "never closed, though inside", *[list(StepAdvice(problem(), 0, nothing).at_the_end({"ground": 0.05}))[1]])
    text = PLATE.replace("THICKNESS", "1e-4").replace("TIP", '[supports.tip]\nface = "b.u1"\ncomponents = ["z"]')
    observer = Warned()
    list(Simulation(Scene.from_toml(text.replace("MOTION", "motions.tip.translate = [0, 0, 1e-7]")).problem(), observer).run())
    yield "lost in round-off", without_digits(observer.said[0])
    observer = Warned()
    list(Simulation(Scene.from_toml(RUNS["small strains, turned"][0]).problem(), observer).run())
    yield "small strains", observer.said[0]
    observer = Warned()
    list(Simulation(Scene.from_toml(RUNS["shrunk"][0]).problem(), observer).run())
    yield "shrunk", observer.said[0]
    observer = Warned()
    list(Simulation(Scene.from_toml(BENT.replace("LEVEL", "0")).problem(), observer).run())
    yield "in each other", observer.said[-1]
    flat = Scene.from_toml(STRIP).problem()
    yield "in itself", next(InItself(flat).after_stage([wound(flat.body("strip"), 370.0, 0.5)], "one"))
    observer = Warned()
    list(Simulation(Scene.from_toml(FLOOR, overrides=[DOWN]).problem(), observer).run())
    yield "behind", observer.said[-1]
    observer = Warned()
    list(Simulation(Scene.from_toml(INTO_A_WALL).problem(), observer).run())
    yield "in each other by other faces", next(said for said in observer.said if "is in body" in said)
    near = "stages.s.motions.top.translate=[0, 0.2, 0]"  # in one increment on all machines
    yield "turning coordinates", next(said for said in astray(TURNING, (near,))[0] if "degrees" in said)
    yield "stretching coordinates", next(said for said in astray(STRETCHING)[0] if "degrees" not in said)
    observer = Warned()
    list(Simulation(Scene.from_toml(punch(BEYOND_EDGES, 0.2)).problem(), observer).run())
    yield "beyond edges", observer.said[0]
    observer = Warned()
    list(Simulation(Scene.from_toml(CAP.replace("ORDER", "2").replace("MANY", "3").replace("YOUNG", "10")).problem(), observer).run())
    yield "long masters", observer.said[0]
    observer = Warned()
    list(Simulation(Scene.from_toml(thin(*STIFF["half a ring"])).problem(), observer).run())
    yield "bends", observer.said[0]
    observer = Warned()
    list(Simulation(Scene.from_toml(slender("sliding", 1.08, "monolithic")).problem(), observer).run())
    at = re.compile(r"(control point) \d+, along \(.*?\)")  # the way has a sign or its opposite
    yield "unstable", next(at.sub(r"\1 #, along (#)", said) for said in observer.said if "not stable" in said)
    observer = Warned()
    list(Simulation(Scene.from_toml(LYING.replace("FRICTION", "0")).problem(), observer).run())
    yield "goes off", next(at.sub(r"\1 #, along (#)", said) for said in observer.said if "not stable" in said)
    observer = Warned()
    list(Simulation(Scene.from_toml(of_half("free", 1.08, "x = 0")).problem(), observer).run())
    yield "mirrored", next(said for said in observer.said if "the whole is not stable" in said)
    for name, (text, changes) in {
        "narrow": strip(*STRIPS["N2 beside it"]),
        "one row": (BALLS["one row"][0], (depth(0.05),)),
        "two rows of dual constraints": (BALL, (depth(0.025), 'contacts.c.enforcement="dual"')),
        "one row of constraints": (BALLS["constraints at knots"][0], (*BALLS["constraints at knots"][1], depth(0.025))),
        "turns within an element": (TURNED, ()),
        "rolls": (ROLLED, ()),
        "by area": (BY_AREA, ()),
        "held inside": (HELD_INSIDE, ()),
        "between points": (CROSSED, crossed("greville", 12, 13)),
        "blind between points": (BALL, (depth(0.03), 'contacts.c.enforcement="greville"', *ORDER_3)),
    }.items():
        observer = Warned()
        list(Simulation(Scene.from_toml(text, overrides=changes).problem(), observer).run())
        yield name, observer.said[-1]


def _before_the_first_step(simulation: Simulation, number: int = 0) -> str:
    observer = Warned()
    next(Simulation(simulation.problem, observer).run())
    return observer.said[number]


def of_results(_: pytest.MonkeyPatch) -> Told:
    """Refused by a results file; beside it stands what it is not."""
    writer = ResultsWriter("run.h5", problem(), "", "0")
    writer.recorded(step_result(1))
    yield "recorded twice", refusal(lambda: writer.recorded(step_result(1)))
    yield "there already", refusal(lambda: ResultsWriter("run.h5", problem(), "", "0"))
    other = replace(problem(), name="other", stages=problem().stages[:1])
    yield "another scene", refusal(lambda: ResultsWriter("run.h5", other, "", "0", resume=True))
    turning = replace(problem(), stages=(problem().stages[0], replace(problem().stages[1], name="turn")))
    yield "another name", refusal(lambda: ResultsWriter("run.h5", turning, "", "0", resume=True))
    tyre, road = problem().bodies
    wider = replace(road, patch=replace(road.patch, control_points=2.0 * road.patch.control_points))
    contacts = (problem().contacts[0], replace(problem().contacts[1], friction=0.0))
    yield "another number", refusal(lambda: ResultsWriter("run.h5", replace(problem(), contacts=contacts), "", "0", resume=True))
    yield "another shape", refusal(lambda: ResultsWriter("run.h5", replace(problem(), bodies=(tyre, wider)), "", "0", resume=True))
    ResultsWriter("longer.h5", problem(), "", "0")
    shorter = [replace(support, motions=support.motions[:1]) for support in problem().supports]
    short = replace(other, supports=tuple(shorter))
    yield "shorter scene", refusal(lambda: ResultsWriter("longer.h5", short, "", "0", resume=True))
    yield "none there", refusal(lambda: Results("none.h5"))
    Path("runs").mkdir()
    yield "a folder", refusal(lambda: Results("runs"))
    yield "a device", refusal(lambda: Results("/dev/null"))
    with Results("run.h5") as results:
        yield "no step", refusal(lambda: results.step(3))
        yield "no curve", refusal(lambda: results.curve("weight"))
        yield "no curve: of what", refusal(lambda: results.curve("force"))
        yield "no support", refusal(lambda: results.curve("force", support="roof"))
        yield "no component", refusal(lambda: results.curve("time", component="x"))
    whole = Path("run.h5").read_bytes()
    Path("cut.h5").write_bytes(whole[:-1])
    yield "damaged", refusal(lambda: Results("cut.h5"))
    Path("text.h5").write_text("curves")
    yield "something else", refusal(lambda: Results("text.h5"))


def in_results(_: pytest.MonkeyPatch) -> Told:
    """Unit and description of every dataset, once for all bodies, supports, contacts and directions."""
    ResultsWriter("described.h5", problem(), "", "0").recorded(step_result(1))
    found: dict[str, str] = {}

    def look(name: str, entry: h5py.Dataset | h5py.Group) -> None:
        if isinstance(entry, h5py.Dataset):
            found.setdefault("/".join(_general(part) for part in name.split("/")), f"{entry.attrs['description']} [{entry.attrs['unit']}]")

    with h5py.File("described.h5") as file:
        file.visititems(look)
    yield from found.items()


def _general(part: str) -> str:
    names = {"rim": "SUPPORT", "bed": "SUPPORT", "tread": "CONTACT", "ground": "CONTACT"}
    return "NUMBER" if part.isdigit() else names.get(part, part)


KINDS = (
    bad_words,
    of_weights_and_memory,
    along_the_way,
    of_results,
    in_results,
)


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_every_word(kind: Callable[[pytest.MonkeyPatch], Told], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert dict(kind(monkeypatch)) == HEARD[kind.__name__]


@pytest.mark.parametrize("kind", OF_SCENES)
def test_every_word_of_scenes(kind: str) -> None:
    assert dict(OF_SCENES[kind]()) == HEARD[kind]


def test_every_word_of_load_steps_that_are_given_up() -> None:
    assert all_told() == HEARD["given_up"]
