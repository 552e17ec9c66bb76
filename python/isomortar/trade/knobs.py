"""The knobs of a scene as data: what is varied, from cheap to dear, and what it can spoil. A new one is one entry of `KNOBS`."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Literal

from isomortar._distributed import is_built
from isomortar._frozen import frozen
from isomortar.accuracy.discretisations import coarse_geometry, lowest_order
from isomortar.errors import InputError
from isomortar.geometry.patch import MAX_ORDER, Direction
from isomortar.geometry.quadrature import volume_points
from isomortar.model.entities import Body, Contact, Face, Projection, RigidPlane
from isomortar.model.glue import shared_directions
from isomortar.scene.scene import Scene
from isomortar.trade.want import Want

#: Numbers of elements over the scene's own, and of load steps: these double, so that runs have load steps in common to be compared at.
MESHES, STEPS = (1 / 3, 1 / 2, 2 / 3, 1.0, 4 / 3, 5 / 3, 2.0, 2.5, 3.0), (1 / 8, 1 / 4, 1 / 2, 1.0, 2.0, 4.0)
#: Tolerances of Newton's method over the scene's own; those of the contact conditions go along. The loosest of each method that are tried.
TOLERANCES = (1e5, 1e3, 1.0, 1e-2)
LOOSEST = {
    "monolithic": {"newton_tolerance": 1e-3, "complementarity_tolerance": 1e-3},
    "uzawa": {"newton_tolerance": 1e-3, "augmentation_tolerance": 0.1},
}
#: Elastic slip over the size of the slave body.
SLIPS = (1e-2, 1e-3)
#: Pressure times distance of smooth contact over Young's modulus times the size of the slave body.
SMOOTHINGS = (1e-5, 1e-7)
#: What blocks of low rank may leave out of factors by the engine mumps.
COMPRESSIONS = (1e-3, 1e-6, 1e-9, 0.0)
#: Orders that a search goes through.
HIGHEST = 5

#: Changes (`isomortar.scene.source.apply_overrides`) of a scene that may have been changed by other knobs.
Changes = Callable[[Scene], Sequence[str]]


@frozen
class Setting:
    """One value of a dial, and the overrides that give it to a scene; none for the scene's own."""

    label: str
    overrides: Changes | None = None


@frozen
class Dial:
    """A knob at one place of a scene.

    Parameters
    ----------
    name : str
        For people: ``elements of block along u``.
    settings : tuple of Setting
        From cheap to dear; of choices in any order.
    own : int
        Which of them is the scene's own.
    spoils : str
        What it can spoil.
    refines : bool
        Whether dearer settings come nearer to the truth; else they are choices, of which none is.
    part : {"", "order", "elements"}
        Of the discretisation: what over-refined runs differ in.
    """

    name: str
    settings: tuple[Setting, ...]
    own: int
    spoils: str
    refines: bool = True
    part: Literal["", "order", "elements"] = ""


@frozen
class Knob:
    """What can be varied of scenes: its name, what it can spoil, and its dials in a scene."""

    name: str
    spoils: str
    dials: Callable[[Scene, str], Iterator[Dial]]


def dials_of(scene: Scene, wants: Sequence[Want] = (), knobs: Sequence[Knob] | None = None) -> tuple[Dial, ...]:
    """All dials of a scene that have more than one setting which the scene can have and which shows what is wanted.

    Parameters
    ----------
    scene : Scene
    wants : sequence of Want
    knobs : sequence of Knob, optional
        Default: `KNOBS`.
    """
    found = [dial for knob in (KNOBS if knobs is None else knobs) for dial in knob.dials(scene, knob.spoils)]
    possible = [_possible(scene, dial, wants) for dial in found]
    return tuple(dial for dial in possible if len(dial.settings) > 1)


def changed(scene: Scene, settings: Sequence[Setting]) -> Scene:
    """The scene with some settings, applied in their order."""
    for setting in settings:
        if setting.overrides:
            scene = Scene.from_toml(scene.to_toml(), overrides=setting.overrides(scene))
    return scene


def _possible(scene: Scene, dial: Dial, wants: Sequence[Want]) -> Dial:
    """The dial without settings that the scene can not have (glued bodies share a mesh, say), or that do not show what is wanted."""
    kept = []
    for number, setting in enumerate(dial.settings):
        try:
            problem = changed(scene, [setting]).problem()
        except InputError:
            continue
        if all(want.shown(problem) for want in wants):
            kept.append(number)
    return replace(dial, settings=tuple(dial.settings[n] for n in kept), own=kept.index(dial.own))


def _orders(scene: Scene, spoils: str) -> Iterator[Dial]:
    """Order of each body along its faces in contact, and of what is glued to it along these."""
    for places in contact_places(scene):
        names = [body.name for body in scene.whole().bodies if any(body.name == name for name, _ in places)]
        along = [(axis, d) for name in names for axis, d in directions(scene.whole().body(name)) if (name, axis) in places]
        own, families = max(d.order for _, d in along), {d.family for _, d in along}
        lowest = [lowest_order(scene, name, "".join(axis for of, axis in places if of == name)) for name in names]
        highest = min(HIGHEST, *(MAX_ORDER[family] for family in families))
        orders = sorted({own, *range(max(2, *lowest), highest + 1)})
        settings = [Setting(str(order), None if order == own else _order(names, places, order)) for order in orders]
        yield Dial(f"order of {' and '.join(names)}", tuple(settings), orders.index(own), spoils, part="order")


def contact_places(scene: Scene) -> list[set[tuple[str, str]]]:
    """Directions along the faces in contact of each body, with those that have to share their mesh: bodies and letters."""
    found: list[set[tuple[str, str]]] = []
    shared = shared_directions(scene.whole())
    for name, letters in faces_in_contact(scene).items():
        own = {place for group in shared for place in group if any((name, letter) in group for letter in letters)}
        found = [*(places for places in found if not places & own), own.union(*(places for places in found if places & own))]
    return found


def _order(names: Sequence[str], places: set[tuple[str, str]], order: int) -> Changes:
    def overrides(scene: Scene) -> list[str]:
        found = []
        for body in (scene.whole().body(name) for name in names):
            orders = [order if (body.name, axis) in places else d.order for axis, d in directions(body)]
            found += [f"bodies.{body.name}.mesh.order={orders}", *stated(body, ("family", "elements"))]
        return found

    return overrides


def _contact_orders(scene: Scene, spoils: str) -> Iterator[Dial]:
    """Order at the face in contact of each body, above that of the rest."""
    for name, letters in faces_in_contact(scene).items():
        if not scene.whole().body(name).raised:
            settings = (Setting("as below"), Setting("one higher", _contact_order(name, letters)))
            yield Dial(f"order at the contact of {name}", settings, 0, spoils, refines=False)


def _contact_order(name: str, letters: str) -> Changes:
    def overrides(scene: Scene) -> list[str]:
        body = scene.whole().body(name)
        higher = 1 + max(order for axis, order in zip("uvw", body.orders, strict=True) if axis in letters)
        return [f"bodies.{name}.mesh.contact_order={higher}", *stated(body, ("family", "order", "elements"))]

    return overrides


def _elements(scene: Scene, spoils: str) -> Iterator[Dial]:
    """Elements of each body by direction; of bodies that are glued those that have to be as many."""
    for places in shared_directions(scene.whole()):
        own = scene.whole().body(places[0][0]).patch.directions["uvw".index(places[0][1])].elements
        span = math.lcm(*(coarse_geometry(scene, name).directions["uvw".index(axis)].elements for name, axis in places))
        counts = sorted({own, *(span * max(1, round(own * factor / span)) for factor in MESHES)})
        settings = [Setting(str(count), None if count == own else _element(places, count)) for count in counts]
        name = " and ".join(f"{name} along {axis}" for name, axis in places)
        yield Dial(f"elements of {name}", tuple(settings), counts.index(own), spoils, part="elements")


def _element(places: Sequence[tuple[str, str]], count: int) -> Changes:
    def overrides(scene: Scene) -> list[str]:
        found = []
        for body in (scene.whole().body(name) for name in dict.fromkeys(name for name, _ in places)):
            counts = [count if (body.name, axis) in places else d.elements for axis, d in directions(body)]
            found += [f"bodies.{body.name}.mesh.elements={counts}", *stated(body, ("family", "order"))]
        return found

    return overrides


def _volume_points(scene: Scene, spoils: str) -> Iterator[Dial]:
    """Quadrature points of each body's elements, fewer or more than its own."""
    for body in scene.whole().bodies:
        if body.rigid:  # nothing is integrated
            continue
        yield Dial(f"quadrature of {body.name}", _more_or_fewer(body.name, -1, 0, 1), 1, spoils)


def _more_or_fewer(name: str, *changes: int) -> tuple[Setting, ...]:
    def overrides(change: int) -> Changes:
        def of(scene: Scene) -> list[str]:
            given = scene.tables.bodies[name].mesh.quadrature
            if scene.whole().body(name).rigid:  # made so by another knob: nothing is integrated
                return []
            own = given or [volume_points(d) for _, d in directions(scene.whole().body(name))]
            return [f"bodies.{name}.mesh.quadrature={[max(1, n + change) for n in own]}"]

        return of

    return tuple(Setting(f"{change:+d}" if change else "own", overrides(change) if change else None) for change in changes)


def _contact_points(scene: Scene, spoils: str) -> Iterator[Dial]:
    """Quadrature points of each contact's elements, fewer or more than its own."""
    for contact in scene.whole().contacts:
        settings = [Setting(f"{more:+d}" if more else "own", _points(contact.name, more) if more else None) for more in (-1, 0, 2, 4)]
        yield Dial(f"quadrature of {contact.name}", tuple(settings), 1, spoils)


def _points(name: str, change: int) -> Changes:
    def overrides(scene: Scene) -> list[str]:
        contact = _contact(scene, name)
        cells = [f"contacts.{name}.subcells={contact.subcells}"] if contact.subcells else []
        return [f"contacts.{name}.quadrature={[max(1, n + change) for n in contact.quadrature]}", *cells]

    return overrides


def _cells(scene: Scene, spoils: str) -> Iterator[Dial]:
    """Contact elements cut along the master's knot lines."""
    for contact in scene.whole().contacts:
        if isinstance(contact.master, Face):
            values = sorted({0, 1, 2, contact.subcells})
            key, name = f"contacts.{contact.name}.subcells", f"subcells of {contact.name}"
            yield _values(key, name, values, spoils, contact.subcells, refines=True)


def _load_steps(scene: Scene, spoils: str) -> Iterator[Dial]:
    """Load steps of each stage."""
    for number, stage in enumerate(scene.whole().stages):
        counts = sorted({max(1, round(stage.steps * factor)) for factor in STEPS})
        yield _values(f"stages.{number}.steps", f"load steps of {stage.name}", counts, spoils, stage.steps, refines=True)


def _tolerances(scene: Scene, spoils: str) -> Iterator[Dial]:
    """How far a load step is iterated; tolerances that are as loose as may be are there once."""
    solver = scene.whole().settings
    loosest = LOOSEST[solver.method]
    tried = [{key: min(most, factor * getattr(solver, key)) for key, most in loosest.items()} for factor in TOLERANCES]
    own = tried[TOLERANCES.index(1.0)]
    tried = [values for number, values in enumerate(tried) if values not in tried[:number]]

    def setting(values: dict[str, float]) -> Setting:
        keys = [f"solver.{key}={value:g}" for key, value in values.items()]
        return Setting(f"{values['newton_tolerance']:.0e}", None if values == own else given(keys))

    yield Dial("tolerance", tuple(map(setting, tried)), tried.index(own), spoils)


def _methods(scene: Scene, spoils: str) -> Iterator[Dial]:
    """Multipliers as unknowns, or augmentations."""
    yield _values("solver.method", "method", ["monolithic", "uzawa"], spoils, scene.whole().settings.method)


def _slip_sums(scene: Scene, spoils: str) -> Iterator[Dial]:
    """Trial tractions by control point or summed."""
    if any(contact.friction_law.parameters.size for contact in scene.whole().contacts):
        yield _values("solver.slip_sum", "slip sum", ["local", "paper"], spoils, scene.whole().settings.slip_sum)


def _enforcements(scene: Scene, spoils: str) -> Iterator[Dial]:
    """What is constrained."""
    for contact in scene.whole().contacts:
        ways = list(dict.fromkeys([contact.enforcement, "mortar", "dual", "greville"]))
        yield _values(f"contacts.{contact.name}.enforcement", f"enforcement of {contact.name}", ways, spoils, contact.enforcement)


def _projections(scene: Scene, spoils: str) -> Iterator[Dial]:
    """How slave points find theirs."""
    ways: list[Projection] = ["closest", "averaged"]
    for contact in scene.whole().contacts:
        if not isinstance(contact.master, RigidPlane):
            yield _values(f"contacts.{contact.name}.projection", f"projection of {contact.name}", ways, spoils, contact.projection)


def _elastic_slips(scene: Scene, spoils: str) -> Iterator[Dial]:
    """A length of elastic slip in place of sticking."""
    for contact in scene.whole().contacts:
        if contact.friction_law.parameters.size:
            size = scene.whole().body(contact.slave.body).size
            lengths = sorted({contact.elastic_slip, *(float(f"{share * size:.1g}") for share in SLIPS)}, reverse=True)
            yield _values(f"contacts.{contact.name}.elastic_slip", f"elastic slip of {contact.name}", lengths, spoils, contact.elastic_slip)


def _smoothings(scene: Scene, spoils: str) -> Iterator[Dial]:
    """Pressure times distance of smooth contact, in place of contact or none."""
    for contact in scene.whole().contacts:
        body = scene.whole().body(contact.slave.body)
        if not body.rigid:
            products = {float(f"{share * body.material.young * body.size:.1g}") for share in SMOOTHINGS}
            values = sorted({contact.smoothing, *products}, reverse=True)
            yield _values(f"contacts.{contact.name}.smoothing", f"smoothing of {contact.name}", values, spoils, contact.smoothing)


def _compressions(scene: Scene, spoils: str) -> Iterator[Dial]:
    """What blocks of low rank may leave out of the bodies' factors."""
    solver = scene.whole().settings
    if solver.engine == "mumps" and is_built():
        bounds = sorted({solver.compression, *COMPRESSIONS}, key=lambda bound: -bound)
        yield _values("solver.compression", "compression", bounds, spoils, solver.compression, refines=True)


def _values(key: str, name: str, values: Sequence[object], spoils: str, own: object, refines: bool = False) -> Dial:
    """The values of one key of a scene file."""
    settings = tuple(Setting(str(value), None if value == own else given([f"{key}={value}"])) for value in values)
    return Dial(name, settings, list(values).index(own), spoils, refines)


def faces_in_contact(scene: Scene) -> dict[str, str]:
    """Directions along the faces in contact, by body."""
    letters: dict[str, set[str]] = {}
    for contact in scene.whole().contacts:
        for side in (contact.slave, contact.master):
            if isinstance(side, Face):
                for face in side.faces:
                    letters.setdefault(face.body, set()).update("uvw".replace(face.face[0], ""))
    return {name: "".join(sorted(found)) for name, found in letters.items()}


def _contact(scene: Scene, name: str) -> Contact:
    return next(contact for contact in scene.whole().contacts if contact.name == name)


def given(overrides: Sequence[str]) -> Changes:
    """Overrides that are the same whatever other knobs have changed."""
    return lambda _: overrides


def directions(body: Body) -> list[tuple[str, Direction]]:
    """Its directions by letter."""
    return list(zip("uvw", body.patch.directions, strict=True))


def stated(body: Body, keys: Sequence[str]) -> list[str]:
    """A body's mesh as it is, stated: defaults of some keys follow from others that are given."""
    values = {
        "family": [d.family for d in body.patch.directions],
        "order": list(body.orders),
        "elements": [d.elements for d in body.patch.directions],
    }
    return [f"bodies.{body.name}.mesh.{key}={values[key]}".replace("'", '"') for key in keys]


#: Every knob, in the order in which settings are applied.
KNOBS: tuple[Knob, ...] = (
    Knob("order", "everything that is smooth", _orders),
    Knob("contact order", "the curves, by what is between the contact's control points", _contact_orders),
    Knob("elements", "everything; along a face the contact's edge first", _elements),
    Knob("volume quadrature", "the bodies' stiffness", _volume_points),
    Knob("contact quadrature", "the transfer of pressure between meshes that do not match", _contact_points),
    Knob("subcells", "the transfer of pressure between meshes that do not match", _cells),
    Knob("load steps", "what depends on the path: friction, and the shape of curves", _load_steps),
    Knob("tolerance", "the last digits", _tolerances),
    Knob("method", "contact conditions, to the tolerance of augmentations", _methods),
    Knob("slip sum", "tractions between sticking and slipping", _slip_sums),
    Knob("enforcement", "pressures and tractions", _enforcements),
    Knob("projection", "gaps where the master is curved", _projections),
    Knob("elastic slip", "tractions where contact sticks", _elastic_slips),
    Knob("smoothing", "gaps, and pressures at the contact's edge", _smoothings),
    Knob("compression", "nothing: what factors leave out is refined, or the run ends", _compressions),
)
