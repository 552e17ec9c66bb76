"""How a scene is written in another discretisation: ``N3`` or ``L2`` for one of its bodies, with more or fewer elements.

``N^p`` raises the order of the swept directions of the body to p and leaves the others; N1 of a curved body interpolates it there, which
gives the same linear functions. ``L^p`` makes all directions Lagrange, the others
linear, with elements fewer by p: as many control points along a swept direction as N1.
"""

from __future__ import annotations

import re
from pathlib import Path

from isomortar._frozen import frozen
from isomortar.errors import InputError
from isomortar.geometry.patch import MAX_ORDER, Family, Patch
from isomortar.model.entities import Face
from isomortar.scene.build import coarse_patch
from isomortar.scene.scene import Scene

Elements = tuple[int, int, int]


@frozen
class Sweep:
    """What is varied of a scene: a body and its swept directions (``"uv"``), the contact pair that shows it, the kind of the reference."""

    body: str
    directions: str
    contact: str
    reference: str = "N2"


#: The bundled scenes as the paper varies them, with the references of its figures.
_BUNDLED = {
    "block": Sweep("master", "uv", "interface"),
    "press": Sweep("block", "uv", "floor"),
    "twist": Sweep("master", "uv", "interface", "N4"),
    "twist-sharp": Sweep("master", "uv", "interface", "N4"),
    "iron": Sweep("master", "u", "interface", "N5"),
    "reversal": Sweep("master", "uv", "interface", "N4"),
    "tire": Sweep("tire", "u", "road"),
}


@frozen
class Discretisation:
    """A kind, ``N1`` to ``N10`` or ``L1`` to ``L4``, and the body's elements by direction."""

    kind: str
    elements: Elements

    @property
    def label(self) -> str:
        """As ``N3 12x12x6``."""
        return f"{self.kind} {'x'.join(map(str, self.elements))}"


def parse_kind(kind: str) -> tuple[Family, int]:
    """Family and order of a kind.

    Raises
    ------
    InputError
        Neither N nor L, or an order that the kernel does not have.
    """
    if re.fullmatch(r"[NL]\d+", kind):
        family: Family = "N" if kind[0] == "N" else "L"
        if 1 <= int(kind[1:]) <= MAX_ORDER[family]:
            return family, int(kind[1:])
    raise InputError(f"is {kind!r}; allowed: N1 to N{MAX_ORDER['N']} and L1 to L{MAX_ORDER['L']}", "orders")


def sweep_of(scene: Scene, body: str | None = None) -> Sweep:
    """What to vary of a scene: bundled scenes as in the paper, others the slave body of the first contact along its contact face.

    Parameters
    ----------
    scene : Scene
    body : str, optional
        Another body, along its face in the first contact that it takes part in.

    Raises
    ------
    InputError
        The scene has no contact, or the body takes part in none.
    """
    problem = scene.problem()
    known = _BUNDLED.get(scene.name)
    if known and body in (None, known.body) and known.body in scene.tables.bodies and known.contact in scene.tables.contacts:
        return known
    for contact in problem.contacts:
        for face in (contact.slave, contact.master):
            if isinstance(face, Face) and body in (None, face.body):
                directions = "uvw".replace(face.face[0], "")
                return Sweep(face.body, directions, contact.name, f"N{max(2, lowest_order(scene, face.body, directions))}")
    touching = sorted({f.body for c in problem.contacts for f in (c.slave, c.master) if isinstance(f, Face)})
    raise InputError(f"is {body!r}; bodies in contact here: {', '.join(touching) or 'none'}", "body")


def discretisation(scene: Scene, sweep: Sweep, kind: str, factor: float = 1.0) -> Discretisation:
    """The discretisation of a kind with `factor` times the scene's elements along the swept directions.

    Numbers of elements are rounded to what the geometry can have: multiples of its knot spans.
    """
    family, order = parse_kind(kind)
    own = scene.whole().body(sweep.body).patch.directions
    spans = coarse_geometry(scene, sweep.body).directions
    wanted = factor / (order if family == "L" else 1)
    counts = [
        _multiple(wanted * d.elements * (d.order if d.family == "L" else 1), s.elements) if axis in sweep.directions else d.elements
        for axis, d, s in zip("uvw", own, spans, strict=True)
    ]
    return Discretisation(kind, (counts[0], counts[1], counts[2]))


def refined(scene: Scene, sweep: Sweep, chosen: Discretisation, factor: float) -> Discretisation:
    """A discretisation with `factor` times the elements along the swept directions."""
    spans = coarse_geometry(scene, sweep.body).directions
    counts = [
        _multiple(factor * n, s.elements) if axis in sweep.directions else n
        for axis, n, s in zip("uvw", chosen.elements, spans, strict=True)
    ]
    return Discretisation(chosen.kind, (counts[0], counts[1], counts[2]))


def overrides(scene: Scene, sweep: Sweep, chosen: Discretisation) -> list[str]:
    """The overrides that give the scene a discretisation (`isomortar.scene.source.apply_overrides`)."""
    family, order = parse_kind(chosen.kind)
    own = scene.whole().body(sweep.body).patch.directions
    geometry = coarse_geometry(scene, sweep.body).directions
    families, orders = [], []
    for axis, direction, exact in zip("uvw", own, geometry, strict=True):
        swept = axis in sweep.directions
        if family == "L":
            families.append("L")
            orders.append(order if swept else 1)
        elif swept:
            families.append("L" if order == 1 < exact.order else "N")
            orders.append(order)
        else:
            families.append(direction.family)
            orders.append(direction.order)
    mesh = f"bodies.{sweep.body}.mesh"
    names = ",".join(f'"{name}"' for name in families)
    return [f"{mesh}.family=[{names}]", f"{mesh}.order={orders}", f"{mesh}.elements={list(chosen.elements)}"]


def mesh_overrides(scene: Scene, kind: str, factor: float = 1.0) -> list[str]:
    """The overrides that give a scene a kind of discretisation with `factor` times its elements."""
    sweep = sweep_of(scene)
    return overrides(scene, sweep, discretisation(scene, sweep, kind, factor))


def lowest_order(scene: Scene, body: str, directions: str) -> int:
    """The lowest order above 1 that ``N^p`` can have: that of the exact geometry along the swept directions."""
    return max(d.order for axis, d in zip("uvw", coarse_geometry(scene, body).directions, strict=True) if axis in directions)


def coarse_geometry(scene: Scene, body: str) -> Patch:
    """Exact geometry of a body, before any discretisation."""
    whole = Scene.from_toml(scene.to_toml())
    return coarse_patch(body, whole.tables.bodies[body], Path())


def _multiple(count: float, spans: int) -> int:
    """The multiple of the geometry's spans next to a number of elements, at least one."""
    return spans * max(1, int(count / spans + 0.5))
