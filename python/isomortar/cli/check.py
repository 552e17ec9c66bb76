"""``isomortar check``: a scene before it is computed, a line for each of its parts."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict
from typing import TYPE_CHECKING, Annotated

import typer

import isomortar
from isomortar.cli.options import Overrides, SceneArgument
from isomortar.cli.words import many

if TYPE_CHECKING:
    from isomortar.march.outlook import BodyOutlook, ContactOutlook, LoadOutlook, Outlook, SupportOutlook
    from isomortar.model.entities import Problem


def check(
    scene: SceneArgument,
    overrides: Overrides = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print all of it as JSON.")] = False,
) -> None:
    """Look at a scene without computing it: its size, how its contacts stand, what supports do, and what is doubtful.

    What `isomortar run` would refuse ends with the same sentence and exit code 2; what it would warn of before the first load step is told.

    For example:

    - `isomortar check iron`
    - `isomortar check my_scene.toml --set bodies.wheel.mesh.elements=[24,4,4]`
    - `isomortar check press --json`
    """
    show(isomortar.Scene.load(scene, overrides or ()).problem(), as_json)


def show(problem: Problem, as_json: bool = False) -> None:
    """Print what a problem looks like before it is computed."""
    from isomortar.march.outlook import outlook

    found = outlook(problem)
    if as_json:
        print(json.dumps(asdict(found), indent=2))
        return
    for line in lines(found):
        print(line)


def lines(found: Outlook) -> Iterator[str]:
    """The words for it."""
    yield (
        f"{found.name}: {many(found.unknowns, 'unknown')}, {many(found.load_steps, 'load step')}, "
        f"about {found.memory / 1e9:.2g} GB of memory (within a factor of two)"
    )
    yield from map(_body, found.bodies)
    yield from map(_contact, found.contacts)
    yield from map(_support, found.supports)
    yield from map(_load, found.loads)
    yield from (f"warning: {warning}" for warning in found.warnings)
    yield f"{many(len(found.warnings), 'warning')}, nothing computed"


def _body(body: BodyOutlook) -> str:
    kinds = " x ".join(f"{family}{order}" for family, order in zip(body.family, body.order, strict=True))
    weights = "" if body.weights[0] == body.weights[1] else f", weights {body.weights[0]:.3g} to {body.weights[1]:.3g}"
    free = f"; supports leave {many(body.left_free, 'rigid motion')} to contacts" if body.left_free else ""
    moduli = "" if body.young is None else f" of Young's modulus {body.young:.6g} and Poisson's ratio {body.poisson:.6g}"
    return (
        f"body {body.name}: {body.law}{moduli}, {_by(body.size)} in size; {_by(body.elements)} elements of {kinds}, {body.shortest:.3g} to "
        f"{body.longest:.3g} long, {many(body.control_points, 'control point')}{weights}{free}"
    )


def _contact(contact: ContactOutlook) -> str:
    about = f"about {abs(contact.apart):.2g}"
    stands = "touch" if contact.apart == 0.0 else f"overlap by {about}" if contact.apart < 0.0 else f"are {about} apart"
    beside = f", {contact.excluded} of them beside the master" if contact.excluded else ""
    return (
        f"contact {contact.name}: slave {contact.slave}, master {contact.master}; {contact.projection}, {contact.enforcement}, "
        f"{many(contact.quadrature_points, 'quadrature point')}{beside}; at the start they {stands}"
    )


def _support(support: SupportOutlook) -> str:
    ways = [f"goes {support.way:.3g}"] * (support.way > 0.0) + [f"turns by {support.degrees:.3g} degrees"] * (support.degrees > 0.0)
    ways += [f"presses {axis} by {force:.3g}" for axis, force in zip("xyz", support.force, strict=False) if force is not None]
    ways += [f"turns by a moment of {support.moment:.3g}"] if support.moment is not None else []
    prescribed = ", ".join(support.components) or "nothing"
    where = f"; in {', '.join(support.stages)} alone" if support.stages else ""
    return f"support {support.name}: prescribes {prescribed} of {support.face}; {' and '.join(ways) or 'stands still'}{where}"


def _load(load: LoadOutlook) -> str:
    return f"load {load.name}: {load.kind} {', '.join(f'{value:.3g}' for value in load.value)} on {load.on}"


def _by(numbers: tuple[float, ...]) -> str:
    return " x ".join(f"{number:.4g}" for number in numbers)
