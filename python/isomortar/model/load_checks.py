"""Can a load be meant? What cannot is refused before any work, with the key to change."""

from __future__ import annotations

from isomortar.errors import InputError
from isomortar.model.contact_checks import LEAST
from isomortar.model.entities import Load, Problem
from isomortar.model.loads import control_areas


def check_loads(problem: Problem) -> None:
    """Refuse loads that cannot be meant.

    Raises
    ------
    InputError
        A load on a rigid body, on a face without an area, inside glued bodies, or that supports on its face bear; a pressure on a face
        whose control points are no unknowns.
    """
    for load in problem.loads:
        if problem.body(load.body).rigid:
            raise InputError(
                f"is on body {load.body!r}, which is rigid and goes where its support takes it; remove the load, or rigid",
                f"loads.{load.name}.{'body' if load.face is None else 'face'}",
            )
        if load.face is not None:
            _check_supports(problem, load)
            _check_face(problem, load)


def _check_face(problem: Problem, load: Load) -> None:
    body, field = problem.body(load.body), f"loads.{load.name}.face"
    for joint in problem.glue:
        if load.place in joint:
            mate = joint[1 - joint.index(load.place)]
            raise InputError(f"is {load.place.words}, which is glued to {mate.words}: it lies inside; name an outer face", field)
    area = float(control_areas(body.patch, load.place.face).sum())
    if not area > LEAST * body.size**2:
        raise InputError(f"is {load.place.words}, a face of area {area:.3g}: its control points fall onto a line or a point", field)
    if load.kind == "pressure" and body.raised and body.raised.face != load.face:
        raise InputError(
            f"is {load.place.words}, and functions of {load.body!r} are of another order at {body.raised.face}; allowed with "
            "contact_order: a pressure there, or a traction",
            field,
        )


def _check_supports(problem: Problem, load: Load) -> None:
    """Supports on the whole of a loaded face bear the load: the body would know nothing of it."""
    for support in problem.supports:
        if support.place != load.place or support.stages is not None:
            continue
        if load.kind == "pressure":
            if len(support.carried) == 3:
                raise InputError(
                    f"is {load.place.words}, where support {support.name!r} prescribes all components or their forces: the pressure would "
                    "do nothing to the body; remove one of them",
                    f"loads.{load.name}.face",
                )
            continue
        both = [k for k in support.carried if load.value[k]]
        if both:
            words = ", ".join("xyz"[k] for k in both)
            raise InputError(
                f"acts along {words} on {load.place.words}, where support {support.name!r} prescribes {words} or the force there: it would "
                "do nothing to the body; take that component from one of them",
                f"loads.{load.name}.traction",
            )
