"""Scenes that once came out wrong without a word, each with what is right and how that is known."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from extreme_scenes import Data, changed, column_pressure, confined_pressure, loaded, press_of, ran, worst
from extremes.endings import digits, endings, judge
from extremes.trials import Trial

from isomortar.harness import case
from isomortar.scene.geometry_file import patch_table
from isomortar.scene.schema import BodyTable

_TIGHT = {"solver.newton_tolerance": 1e-12, "solver.complementarity_tolerance": 1e-11}
_COLUMN = np.array([column_pressure(0.9), column_pressure(0.8)])
#: A turn by a quarter about the axis of the ring, y, through its centre.
_QUARTER = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])


def channel(done: Trial) -> float:
    """The slave, started beside the wall that it ends in: without friction the way there does not count."""
    near = changed(
        loaded("channel"),
        {
            "bodies.slave.geometry.lower": [0.02, -0.1, 0.4],
            "bodies.slave.geometry.upper": [0.2, 0.1, 0.6],
            "stages.0.motions.push.translate": [0.15, 0, 0],
            "stages.0.steps": 4,
        },
    )
    return digits(done.force("push")[-1], ran(near).force("push")[-1])


def seam(done: Trial) -> float:
    """The same mesh, its seam turned away by a quarter."""
    data = loaded("seam")
    wheel = data["bodies"]["wheel"]
    table = BodyTable.model_validate(wheel)
    assert table.geometry is not None
    patch = patch_table(table.geometry.patch())
    centre = np.array([0.0, 0.0, -0.5])
    patch["control_points"] = ((np.array(patch["control_points"]) - centre) @ _QUARTER.T + centre).tolist()
    data["bodies"]["wheel"] = {"patch": patch, "mesh": wheel["mesh"], "closed": table.geometry.closed}
    return digits(done.force("hub"), ran(data).force("hub"))


def pole(done: Trial) -> float:
    """Quadrature of an even number of points, none of which lies over the pole, to the two digits that they have in common."""
    return digits(done.force("top"), ran(changed(loaded("pole"), {"contacts.f.quadrature": 6})).force("top"))


def reactions(done: Trial) -> float:
    """What holds x or y alone carries nothing along z; the top carries the closed form of a column."""
    found = np.stack([done.force(support)[:, 2] for support in ("top", "x", "y")], axis=1)
    return digits(found, np.stack([-_COLUMN, 0 * _COLUMN, 0 * _COLUMN], axis=1))


def bystander(done: Trial) -> float:
    """The same without the block that touches nothing."""
    alone = loaded("bystander")
    del alone["bodies"]["anvil"], alone["materials"]["steel"], alone["supports"]["anvilbase"], alone["supports"]["anviltop"]
    del alone["stages"][0]["motions"]["anviltop"]
    return digits(done.force("top"), ran(alone).force("top"))


def _beam(thickness: float, deflection: float) -> Callable[[Trial], float]:
    return lambda done: digits([done.force("tip")[-1, 2]], [3.0 * 10.0 * thickness**3 / 12.0 * deflection])


def thin(done: Trial) -> float:
    """Scaling law: forces of plates that are deflected by their thickness go with its fourth power; one thirty times as thick.

    It is no beam then, on this mesh: `bending`.
    """
    thick = changed(loaded("thin"), {"bodies.b.geometry.upper": [1, 1, 0.01], "stages.0.motions.tip.translate": [0, 0, 0.01]})
    return digits(done.force("tip")[-1, 2:] / 3e-4**4, ran(thick).force("tip")[-1, 2:] / 0.01**4)


def uniform(done: Trial) -> float:
    """Patch test: the closed form of a column, in the force and at every point of the pressure."""
    pressure = done.held["curves/contacts/f/pressure_field"]
    return worst(digits(press_of(done), _COLUMN), digits(pressure, np.stack([_COLUMN, _COLUMN], axis=1)))


def graded(done: Trial) -> float:
    """The same; of the pressure at a knot span of 1e-6 as many digits are lost as in `knot_spans`."""
    return worst(digits(press_of(done), _COLUMN), 3.0 + uniform(done))


def prescribed(done: Trial) -> float:
    """Every point is prescribed: the closed form of a column that can not widen."""
    return digits(press_of(done), [confined_pressure(0.1)])


def _nothing(_: Trial) -> float:
    """There is no right result: the run has to be refused or to stop."""
    return 0.0


def _other_method(name: str) -> Callable[[Trial], float]:
    """Augmentations to the end, which share no iteration with the monolithic loop."""

    def found(done: Trial) -> float:
        changes = {"solver.method": "uzawa", "solver.augmentation_tolerance": 1e-9, **_TIGHT}
        return digits(done.force("top"), ran(changed(loaded(name), changes)).force("top"))

    return found


#: By scene: digits of its run, digits needed, and causes that may be named instead of a result.
RIGHT: dict[str, tuple[Callable[[Trial], float], float, tuple[str, ...]]] = {
    "channel": (channel, 6.0, ("master", "penetrat", "projection")),
    "seam": (seam, 6.0, ()),
    "pole": (pole, 2.0, ("pole", "degenerate", "collapsed")),
    "reactions": (reactions, 8.0, ()),
    "bystander": (bystander, 8.0, ()),
    "thin": (thin, 1.5, ()),  # the last bits of its positions make up to 2 % of its force, as it says, and of the other's nothing
    "thin4": (_beam(1e-4, 1e-7), 2.0, ("round-off",)),
    "graded": (graded, 6.0, ()),
    "weights": (uniform, 2.0, ("weights", "quadrature")),
    "weights100": (uniform, 2.0, ("weights", "quadrature")),
    "quarter": (_other_method("quarter"), 6.0, ()),
    "corner": (_nothing, 1.0, ("left the master", "few", "master's edge")),
    "norows": (prescribed, 8.0, ()),
    "coarse-press": (_other_method("coarse-press"), 6.0, ()),
    "coarse-bowl": (_other_method("coarse-bowl"), 6.0, ()),
}
#: Scenes that have to be right, not refused.
HAVE_TO_BE_RIGHT = ("thin", "channel", "seam", "reactions", "bystander", "graded", "quarter", "norows", "coarse-press", "coarse-bowl")


@case(
    claim="Scenes that once came out wrong are right, or the program says what is the matter.",
    tier="nightly",
    grid={"scene": tuple(RIGHT)},
    bounds=lambda scene: endings(scene in HAVE_TO_BE_RIGHT),
)
def known_scene(scene: str) -> dict[str, Any]:
    """Each against a symmetry, a closed form, an independent way to the same state, or the other method."""
    found, needed, causes = RIGHT[scene]
    return judge(ran(loaded(scene)), found, needed, causes)


def _floor(data: Data, **plane: Any) -> Data:
    return changed(data, {f"contacts.floor.plane.{name}": value for name, value in plane.items()})


def _doubtful() -> dict[str, tuple[Data, str]]:
    """Scenes that cannot be meant, or hardly, with a word for what is the matter."""
    press, bowl = loaded("coarse-press"), loaded("coarse-bowl")
    apart = changed(press, {"stages": [{"name": "lift", "steps": 2, "motions": {"top": {"translate": [0, 0, 0.2]}}}]})
    overlapping = {"contacts.floor.plane.point": [0, 0, 0.3]}
    beside = changed(bowl, {"bodies.slave.geometry.centre": [5.0, 0.02]})
    flat = changed(loaded("quarter"), {"bodies.b.geometry.upper": [0.5, 0.5, 0.0]})
    return {
        "plane's normal flipped": (_floor(press, normal=[0, 0, -1]), "normal|overlap|penetrat|behind"),
        "overlap at the start": (changed(press, overlapping), "overlap|penetrat"),
        "contact never closes": (apart, "was open"),
        "slave beside its master": (beside, "no projection|beside|outside|no point|opposite"),
        "tolerance of ten": (changed(press, {"solver.newton_tolerance": 10.0}), "newton_tolerance"),
        "modulus next to nothing": (press | {"materials": {"m": {"young": 1e-300, "poisson": 0.3}}}, "[Yy]oung"),
        "slave face of no area": (flat, "area|flat|volume|folded|upper"),
        "friction of 1e156": (changed(press, {"contacts.floor.friction": 1e156}), "friction"),
    }


DOUBTFUL = _doubtful()


@case(
    claim="What cannot be meant is refused, and what is doubtful is warned of.",
    tier="nightly",
    grid={"scene": tuple(DOUBTFUL)},
    bounds=endings(right=False),
)
def doubtful_scene(scene: str) -> dict[str, Any]:
    """No result counts as right here: something has to be said."""
    data, cause = DOUBTFUL[scene]
    return judge(ran(data), _nothing, needed=1.0, causes=[cause])
