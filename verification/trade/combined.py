"""Settings of several dials at once: the scene that a laboratory makes of them, what it says to take, and where a variant is offered."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import combinations
from pathlib import Path

import numpy as np
from trade.turned import SCENE

from isomortar.errors import InputError
from isomortar.harness import Bound, case
from isomortar.results.comparison import differences
from isomortar.scene import Scene
from isomortar.trade.advice import VARIANTS
from isomortar.trade.knobs import KNOBS, Dial, Knob, changed, dials_of
from isomortar.trade.laboratory import Choice, Laboratory

#: The scene, what is changed, and variants that are offered of it then, by how their names begin.
_BOTH = SCENE.replace("[supports]", 'back = { slave = "base.w1", master = "block.w0", friction = 0 }\n[supports]')
_NAMED = SCENE.replace("[bodies.base]", '[materials.stiff]\nyoung = 1000\n[bodies.base]\nmaterial = "stiff"')
OFFERED: tuple[tuple[str, tuple[str, ...], set[str]], ...] = (
    (SCENE, (), {"base rigid", "friction of between", "order of base across"}),
    (_NAMED, (), {"base rigid", "friction of between", "order of base across"}),
    (_NAMED, ("bodies.base.mesh.quadrature=[2, 2, 3]",), {"base rigid", "friction of between", "order of base across"}),
    (SCENE, ("bodies.base.rigid=true",), {"friction of between"}),
    (_BOTH, (), {"friction of between", "order of base across"}),
    (SCENE, ("contacts.between.friction=0",), {"base rigid", "order of base across"}),
    (
        SCENE,
        ("contacts.between.friction=0", "contacts.between.cohesion=0.1"),
        {"base rigid", "friction of between", "order of base across"},
    ),
    (SCENE, ("bodies.base.mesh.order=[1,1,1]",), {"base rigid", "friction of between"}),
)
#: Dials that are combined, by how their names begin: what one of them states of a mesh the next one may have changed.
DIALS = "(order|elements) of base"
#: Words that variants are called by.
WORDS = ("rigid", "friction of", "across")


def laboratory(dials: tuple[Dial, ...]) -> Laboratory:
    """One that runs nothing."""
    return Laboratory(Scene.from_toml(SCENE), dials, Path(), None, lambda _: None)  # type: ignore[arg-type]


def all_of(scene: Scene, knobs: Sequence[Knob]) -> list[Dial]:
    """All dials of some knobs, with settings that the scene may not take as well."""
    return [dial for knob in knobs for dial in knob.dials(scene, knob.spoils)]


def choices(dials: tuple[Dial, ...]) -> list[Choice]:
    """Of each two dials a setting of either that is not the scene's own: the first, and the last, one."""
    own = [dial.own for dial in dials]
    found = []
    for one, other in combinations(range(len(dials)), 2):
        first = next(n for n in range(len(dials[one].settings)) if n != own[one])
        last = next(n for n in reversed(range(len(dials[other].settings))) if n != own[other])
        found.append(tuple(first if k == one else last if k == other else n for k, n in enumerate(own)))
    return found


@case(
    claim="Of settings of two dials that go together the scene that is run is the one that the overrides give which are told; it is told "
    "which dials are not at the scene's own settings.",
    tier="gate",
    bounds={
        "others": Bound(0.0, 0.0, "definition: differences between both scenes, and settings that only one of them takes"),
        "alike": Bound(0.0, 0.0, "definition: scenes that are as they were"),
        "names": Bound(0.0, 0.0, "definition: dials that are not told, or should not be"),
        "tried": Bound(at_least=5.0, reason="definition: or nothing is compared"),
    },
)
def together() -> dict[str, float]:
    """How many."""
    dials = tuple(dial for dial in all_of(Scene.from_toml(SCENE), KNOBS) if re.match(DIALS, dial.name))
    lab, own = laboratory(dials), Scene.from_toml(SCENE).problem()
    found = dict.fromkeys(("others", "alike", "names", "tried"), 0)
    found["names"] += (
        lab.name(lab.own) != "as it is" or lab.overrides(lab.own) != [] or bool(differences(own, lab.scene(lab.own).problem()))
    )
    for choice in choices(dials):
        try:
            problem = lab.scene(choice).problem()
        except InputError:
            continue
        found["tried"] += 1
        found["others"] += len(differences(problem, Scene.from_toml(SCENE, overrides=lab.overrides(choice)).problem()))
        found["alike"] += not differences(own, problem)
        turned = {dial.name: dial.settings[n].label for dial, n in zip(dials, choice, strict=True) if n != dial.own}
        found["names"] += lab.changes(choice) != [f"{name}: {label}" for name, label in turned.items()]
    return {name: float(count) for name, count in found.items()}


@case(
    claim="A variant is offered where it means something, and only there: masters that deform and are no slaves, whatever they are given "
    "that rigid ones have not, friction that is there, orders above one across a contact, of bodies that deform.",
    tier="gate",
    bounds={
        "offered": Bound(0.0, 0.0, "definition: variants that are missing, or too many"),
        "otherwise": Bound(0.0, 0.0, "definition: masters that are not rigid where they should be, or are another body then"),
    },
)
def variants() -> dict[str, float]:
    """How many are wrong, of a scene with some changes."""
    offered = otherwise = 0
    for text, overrides, expected in OFFERED:
        scene = Scene.from_toml(text, overrides=overrides)
        dials = [dial for dial in dials_of(scene, knobs=VARIANTS) if any(word in dial.name for word in WORDS)]
        offered += len({dial.name for dial in dials} ^ expected)
        for rigid in (changed(scene, [dial.settings[0]]) for dial in dials if dial.name == "base rigid"):
            own, body = (of.problem().body("base") for of in (scene, rigid))
            otherwise += not body.rigid or not np.array_equal(own.patch.control_points, body.patch.control_points)
    return {"offered": float(offered), "otherwise": float(otherwise)}


#: What is changed of the scene, and dials of it that are not offered then.
LACKING: tuple[tuple[tuple[str, ...], set[str]], ...] = (
    (("bodies.base.rigid=true",), {"quadrature of base"}),
    (("bodies.base.mesh.contact_order=3",), {"order at the contact of base"}),
)
#: Points of either contact, of one of them in subcells; those that follow from orders, and from the finer elements of a master.
POINTS = (
    ("contacts.between.quadrature=[5,6]", "contacts.between.subcells=2", "contacts.side.quadrature=[7,8]"),
    (),
    ("bodies.base.mesh.elements=[12,12,2]",),
)


@case(
    claim="Dials turn what a scene has: no points of rigid bodies, no order at a contact that has one of its own; and of each contact the "
    "points that it has, in the subcells that it has.",
    tier="gate",
    bounds={
        "wrong": Bound(0.0, 0.0, "definition: dials that are missing, or too many; contacts with other points than their own and two more")
    },
)
def of_what_there_is() -> dict[str, float]:
    """How many."""
    every, wrong = {dial.name for dial in all_of(Scene.from_toml(SCENE), KNOBS)}, 0
    for changes, lacking in LACKING:
        wrong += len({dial.name for dial in all_of(Scene.from_toml(SCENE, overrides=changes), KNOBS)} ^ (every - lacking))
    for changes in POINTS:
        scene = Scene.from_toml(SCENE, overrides=changes)
        for k, own in enumerate(scene.whole().contacts):
            (dial,) = (dial for dial in all_of(scene, KNOBS) if dial.name == f"quadrature of {own.name}")
            (more,) = (setting for setting in dial.settings if setting.label == "+2")
            found = changed(scene, [more]).whole().contacts[k]
            wrong += (found.quadrature, found.subcells) != (tuple(n + 2 for n in own.quadrature), own.subcells)
    return {"wrong": float(wrong)}
