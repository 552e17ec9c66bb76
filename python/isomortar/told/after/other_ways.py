"""What mostly lets a load step converge that is given up while nothing else is told: averages, friction or pressures without a corner."""

from __future__ import annotations

from collections.abc import Iterator

from isomortar.model.entities import Contact, Problem
from isomortar.model.sheet import Sheet
from isomortar.solve.record import State

#: What is advised, as a share of the slave's size, and of that times the modulus of the softest body: of nine scenes that friction ended
#: five came to their end by elastic slip, seven by smooth pressures, and all by one of these.
SLIP, SMOOTHING = 2e-3, 1e-5
#: The same where there is no friction: of seven scenes, receding layers and beams on each other, all came to their end by it.
CLOSING = 1e-7
#: How an error says that constraints close and open.
CHANGE = "change their states"


def other_ways(problem: Problem, state: State, error: Exception) -> Iterator[str]:
    """Sentences, without a capital, on those that bear, if any do: on contacts that are not of averages, else on what is to be smooth.

    Of 16 scenes that constraints at points, or dual ones, ended so 13 came to their end by averages.

    Parameters
    ----------
    problem : Problem
    state : State
        Where the last load increment ended that converged.
    error : Exception
        Why the next one did not.
    """
    bear = [contact for contact, begun in zip(problem.contacts, state.contacts, strict=True) if begun.pressure.any()]
    others = [contact for contact in bear or problem.contacts if contact.enforcement != "mortar"]
    for contact in others:
        yield (
            f"contact {contact.name!r}: load steps that are given up by constraints of this kind, {contact.enforcement!r}, mostly come to "
            f'their end by averages: take contacts.{contact.name}.enforcement = "mortar"'
        )
    close = CHANGE in str(error)
    for contact in (bear or problem.contacts * close) if not others else ():
        size = Sheet.of(problem, contact.slave).size
        modulus = min(body.modulus for body in problem.deformable if body.name in contact.bodies)
        if _sticks_or_slips(contact):
            pressed = f", or contacts.{contact.name}.smoothing = {SMOOTHING * size * modulus:.1g}, by which pressures are"
            yield (
                f"contact {contact.name!r}: friction sticks or slips, and Newton's method may find no way from one to the other: take "
                f"contacts.{contact.name}.elastic_slip = {SLIP * size:.1g}, by which it is smooth{'' if contact.cohesion else pressed}"
            )
        elif close and contact.smoothing == contact.cohesion == 0.0:
            yield (
                f"contact {contact.name!r}: constraints close and open, and Newton's method may find no way from one to the other: take "
                f"contacts.{contact.name}.smoothing = {CLOSING * size * modulus:.1g}, by which pressures are smooth, and from there on "
                "less until forces stay"
            )


def _sticks_or_slips(contact: Contact) -> bool:
    return (contact.friction > 0.0 or contact.cohesion > 0.0) and contact.elastic_slip == 0.0
