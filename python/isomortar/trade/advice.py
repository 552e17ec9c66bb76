"""What a scene could do without: cheaper variants of it, each with what it loses against the scene as it is."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from isomortar.model.entities import RigidPlane
from isomortar.scene.scene import Scene
from isomortar.scene.source import parse
from isomortar.scene.toml_text import in_a_line
from isomortar.trade.knobs import KNOBS, Changes, Dial, Knob, Setting, contact_places, dials_of, directions, given, stated
from isomortar.trade.search import Recommendation, Search
from isomortar.trade.want import Want


class CheaperSearch(Search):
    """The cheapest variant of a scene within a loss of what is wanted; the scene as it is is the truth."""

    def find_truth(self, targets: Sequence[float], share: float = 1.0) -> None:  # noqa: ARG002
        """The scene as it is."""
        self.truth, self.rivals = self.own, (self.own,)

    def answer(self, target: float) -> Recommendation:
        """The cheapest variant that loses no more than a target."""
        found = super().answer(target)
        if found.best and found.best.choice == self.own.choice:
            return Recommendation(target, None, math.nan, "no variant that was tried loses so little for less")
        return found

    def _orders(self) -> Iterator[tuple[int, dict[int, int]]]:
        """Not asked for: what order elevation pays is the trade's to tell."""
        return iter(())


def cheaper_dials(scene: Scene, wants: Sequence[Want] = ()) -> tuple[Dial, ...]:
    """Dials of what a scene may do without; of those that refine, settings up to the scene's own."""
    found = dials_of(scene, wants, (*VARIANTS, *KNOBS))
    cut = [replace(dial, settings=dial.settings[: dial.own + 1]) if dial.refines else dial for dial in found]
    return tuple(dial for dial in cut if len(dial.settings) > 1)


def _rigid(scene: Scene, spoils: str) -> Iterator[Dial]:
    """Masters that do not deform."""
    problem = scene.whole()
    slaves = {face.body for contact in problem.contacts for face in contact.slave.faces}
    masters = [face.body for contact in problem.contacts if not isinstance(contact.master, RigidPlane) for face in contact.master.faces]
    for name in dict.fromkeys(masters):
        if name not in slaves and not problem.body(name).rigid:
            yield Dial(f"{name} rigid", (Setting("yes", _made_rigid(name)), Setting("no")), 1, spoils, refines=False)


def _made_rigid(name: str) -> Changes:
    """A body given anew where it has what a rigid one has not: an override takes nothing away."""

    def changes(scene: Scene) -> list[str]:
        body = scene.tables.bodies[name]
        if body.material is None and body.mesh.quadrature is None:
            return [f"bodies.{name}.rigid=true"]
        table = parse(scene.to_toml(), name)["bodies"][name] | {"rigid": True}
        table.pop("material", None)
        table.get("mesh", {}).pop("quadrature", None)
        return [f"bodies.{name}={in_a_line(table)}"]

    return changes


def _frictionless(scene: Scene, spoils: str) -> Iterator[Dial]:
    """Contacts without friction."""
    for name, contact in scene.tables.contacts.items():
        if contact.friction > 0.0 or contact.cohesion > 0.0:
            keys = [f"contacts.{name}.{key}=0.0" for key in ("friction", "cohesion")]
            yield Dial(f"friction of {name}", (Setting("none", given(keys)), Setting("as it is")), 1, spoils, refines=False)


def _orders_across(scene: Scene, spoils: str) -> Iterator[Dial]:
    """Lower orders of bodies away from faces in contact, their own and those of bodies that they are glued to."""
    along = set().union(*contact_places(scene))
    for body in scene.whole().deformable:
        across = [axis for axis in "uvw" if (body.name, axis) not in along]
        highest = max((d.order for axis, d in directions(body) if axis in across), default=1)
        if highest > 1:
            settings = tuple(Setting(str(p), None if p == highest else _across(body.name, across, p)) for p in range(1, highest + 1))
            yield Dial(f"order of {body.name} across", settings, highest - 1, spoils)


def _across(name: str, axes: list[str], order: int) -> Changes:
    def changes(scene: Scene) -> list[str]:
        body = scene.whole().body(name)
        orders = [min(order, d.order) if axis in axes else d.order for axis, d in directions(body)]
        return [f"bodies.{name}.mesh.order={orders}", *stated(body, ("family", "elements"))]

    return changes


def _symmetries(scene: Scene, spoils: str) -> Iterator[Dial]:
    """One side of each plane through the middle of all bodies in which the scene is its own mirror image."""
    points = np.concatenate([body.patch.control_points for body in scene.whole().bodies])
    middle = points.min(axis=0) + 0.5 * np.ptp(points, axis=0)
    for axis, place in zip("xyz", middle, strict=True):
        if axis not in scene.tables.symmetry:
            name = f"the scene beyond {axis} = {place:g}"
            yield Dial(name, (Setting("its mirror image", _mirrored(axis, float(place))), Setting("as it is")), 1, spoils, refines=False)


def _mirrored(axis: str, place: float) -> Changes:
    def changes(scene: Scene) -> list[str]:
        planes = [f"{key} = {value!r}" for key, value in (*scene.tables.symmetry.items(), (axis, place))]
        return [f"symmetry={{ {', '.join(planes)} }}"]

    return changes


#: What a model may leave out; how it is computed are the knobs of the trade.
VARIANTS: tuple[Knob, ...] = (
    Knob("rigid", "all that the master gives way", _rigid),
    Knob("friction", "drag and torque, and what sticks", _frictionless),
    Knob("symmetry", "what has no kink at the plane: functions are only continuous there", _symmetries),
    Knob("order across", "what bends or varies in depth", _orders_across),
)
