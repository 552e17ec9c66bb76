"""What is said of scenes that are refused, or doubted before a run, word by word: `sentences.toml` has the sentence of each."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterator
from pathlib import Path

from told.wrong import choices, contacts, doubts, forces, halves, joints, keys, loads, plates, raised, rigid, sides

from isomortar.errors import IsomortarError
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.told.before import doubts as told_of

SENTENCES = Path(__file__).parent / "sentences.toml"

#: Name and sentence of each scene of a kind.
Told = Iterator[tuple[str, str]]


def refused(text: str, *overrides: str) -> str:
    """What is said of a scene that is wrong; nothing, if it is taken."""
    try:
        Scene.from_toml(text, overrides=overrides).problem()
    except IsomortarError as error:
        return str(error)
    return ""


def doubted(text: str) -> str:
    """All that is said of a scene that is doubtful."""
    problem = Scene.from_toml(text).problem()
    return "\n".join(told_of.doubts(problem, Simulation(problem).state))


def bad_scenes() -> Told:
    """Refused for one wrong key."""
    yield from ((name, refused(keys.GOOD.replace(old, new, 1))) for name, (old, new, *_) in keys.CASES.items())


def bad_contacts() -> Told:
    """Refused for what cannot be meant."""
    yield from ((name, refused(text.replace(old, new))) for name, (text, old, new, *_) in contacts.WRONG.items())


def bad_joints() -> Told:
    """Refused for faces that cannot be glued."""
    yield from ((name, refused(text)) for name, (text, *_) in joints.WRONG.items())


def bad_rigid_bodies() -> Told:
    """Refused for rigid bodies that cannot be."""
    yield from ((name, refused(rigid.GOOD.replace(old, new))) for name, (old, new, *_) in rigid.WRONG.items())


def bad_loads() -> Told:
    """Refused for loads that cannot be meant."""
    yield from ((name, refused(loads.GOOD.replace(old, new))) for name, (old, new, *_) in loads.WRONG.items())
    yield from ((name, refused(loads.HALVED.replace("LOAD", load))) for name, (load, *_) in loads.UNEVEN.items())


def bad_forces() -> Told:
    """Refused for forces that supports cannot exert."""
    yield from ((name, refused(forces.GOOD.replace(old, new))) for name, (old, new, *_) in forces.WRONG.items())
    yield "through the plane", refused(forces.HALVED.replace("FORCE", "force.y = 0") + "symmetry = { y = 0.0 }")


def bad_plates() -> Told:
    """Refused for moments that supports cannot exert, and stages in which they cannot hold."""
    yield from ((name, refused(plates.GOOD.replace(old, new))) for name, (old, new, *_) in plates.WRONG.items())
    yield from ((name, refused(text)) for name, (text, *_) in plates.ELSEWHERE.items())


def bad_raised_faces() -> Told:
    """Refused for orders that a face in contact cannot have."""
    yield from ((name, refused(raised.wrong(name))) for name in raised.WRONG)


def bad_sides() -> Told:
    """Refused for faces that make no side of a contact."""
    yield from ((name, refused(sides.GOOD.replace(old, new))) for name, (old, new, *_) in sides.WRONG.items())


def bad_halves() -> Told:
    """Refused for what is not symmetric."""
    yield from ((name, refused(text, f"symmetry={{ {planes} }}")) for name, (text, planes, *_) in halves.REFUSED.items())


def bad_choices() -> Told:
    """Refused for what cannot be chosen together."""
    yield from ((name, refused(text, *overrides)) for name, (text, overrides) in choices.REFUSED.items())


def doubtful() -> Told:
    """Warnings on scenes that run."""
    yield from ((name, doubted(text.replace(old, new))) for name, (text, old, new, *_) in doubts.DOUBTFUL.items())


KINDS: dict[str, Callable[[], Told]] = {
    kind.__name__: kind
    for kind in (
        bad_scenes,
        bad_contacts,
        bad_joints,
        bad_rigid_bodies,
        bad_loads,
        bad_forces,
        bad_plates,
        bad_raised_faces,
        bad_sides,
        bad_halves,
        bad_choices,
        doubtful,
    )
}


@case(
    claim="Each scene that is wrong is refused, and each that is doubtful is warned of, by the one sentence that people read of it.",
    tier="gate",
    grid={"kind": tuple(KINDS)},
    bounds={
        "others": Bound(0.0, 0.0, "definition: scenes of which something else is said, or nothing, or more"),
        "scenes": Bound(at_least=7.0, reason="definition: or nothing is tried"),
    },
    files=[SENTENCES],
)
def word_by_word(kind: str) -> dict[str, float]:
    """Of how many scenes."""
    expected = tomllib.loads(SENTENCES.read_text(encoding="utf-8"))[kind]
    told = dict(KINDS[kind]())
    others = [name for name in told.keys() | expected.keys() if told.get(name) != expected.get(name)]
    return {"others": float(len(others)), "scenes": float(len(told))}
