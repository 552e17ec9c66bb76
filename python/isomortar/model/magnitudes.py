"""Loads, and limits of contact, of sizes that no body could bear and no number of a computation could hold."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from isomortar.errors import InputError
from isomortar.model.entities import Body, Contact, Load, Problem, Support

#: Loads over what a body's modulus makes of its size: beyond this forces of elements have no digits left beside them.
MOST_LOAD = 1e10
#: Limits of contact that stand for none; with more, products of them overflow. A coefficient of friction may be as much.
NONE = 1e100
#: What a factor may be.
OF_FACTOR = " over what it multiplies"


def check_magnitudes(problem: Problem) -> None:
    """Refuse loads beyond what any body could bear, and limits of contact whose products overflow.

    Raises
    ------
    InputError
        Naming the field, and what is allowed.
    """
    for load in problem.loads:
        _check_load(problem, load)
    for support in problem.supports:
        _check_support(problem, support)
    for contact in problem.contacts:
        _check_contact(contact)


def _check_load(problem: Problem, load: Load) -> None:
    body = problem.body(load.body)
    stiffness = body.material.young
    most = MOST_LOAD * (stiffness / body.size if load.kind == "weight" else stiffness)
    size = float(np.max(np.abs(load.value)))
    words = " over its size" if load.kind == "weight" else ""
    _refuse_above(most, size, f"loads.{load.name}.{load.kind}", body, words)
    for stage, factor in zip(problem.stages, load.factors or (), strict=bool(load.factors)):
        _refuse_above(most / size if size else np.inf, abs(factor), f"stages.{stage.name}.loads.{load.name}", body, OF_FACTOR)


def _check_support(problem: Problem, support: Support) -> None:
    body = _pressed(problem, support)
    if body is None:
        return
    force = max((abs(size) for size in support.force if size is not None), default=0.0)
    for name, size, power in (("force", force, 2), ("moment", abs(support.moment or 0.0), 3)):
        most = MOST_LOAD * body.material.young * body.size**power
        words = f" times the {'square' if power == 2 else 'cube'} of its size"
        _refuse_above(most, size, f"supports.{support.name}.{name}", body, words)
        for stage, factor in zip(problem.stages, support.factors, strict=bool(support.factors)):
            path = f"stages.{stage.name}.loads.{support.name}"
            _refuse_above(most / size if size else np.inf, abs(factor), path, body, OF_FACTOR)


def _pressed(problem: Problem, support: Support) -> Body | None:
    """The body of a support; of a rigid one the softest that deforms, which is to bear it."""
    body = problem.body(support.place.body)
    return min(problem.deformable, key=lambda other: other.modulus, default=None) if body.rigid else body


def _refuse_above(most: float, size: float, field: str, body: Body, words: str) -> None:
    if size > most:
        raise InputError(
            f"is {size:.3g} large; allowed: up to {most:.3g}, {MOST_LOAD:g} times the modulus of body {body.name!r}{words}; "
            "look at the units of loads, lengths and moduli",
            field,
        )


def _check_contact(contact: Contact) -> None:
    limits: Iterator[tuple[str, float | None]] = (
        (name, getattr(contact, name)) for name in ("cohesion", "traction_max", "elastic_slip", "reference_area")
    )
    for name, size in limits:
        if size is not None and size > NONE:
            raise InputError(f"is {size:g}; allowed: up to {NONE:g}", f"contacts.{contact.name}.{name}")
