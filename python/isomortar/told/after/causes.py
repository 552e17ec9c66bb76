"""What is likely to be behind a load step that is given up: bodies pressed flat, numbers too far apart, penalties too large."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations

import numpy as np

from isomortar.errors import PathError, SingularSystemError
from isomortar.model import constants
from isomortar.model.contrasts import element_lengths
from isomortar.model.entities import Body, Contact, Problem
from isomortar.model.ratios import times
from isomortar.model.settings import SolverSettings
from isomortar.model.sheet import Sheet
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.record import State
from isomortar.told.after.averages_apart import averages_apart
from isomortar.told.after.on_the_way import on_the_way
from isomortar.told.after.other_ways import other_ways
from isomortar.told.after.over_edges import BESIDE, at_an_edge, over_the_edge
from isomortar.told.after.overcome import overcome
from isomortar.told.after.passed_through import passed_through
from isomortar.told.after.shared_edges import shared_edges
from isomortar.told.after.sliding import sliding
from isomortar.told.after.tipping import giving_way, tipping
from isomortar.told.before.pairing import few_points

#: Volume ratios below this one are those of elements about to fold.
FLAT = 0.1
#: Lengths of elements further apart cost more than ten digits of the tangent, which goes with their squares; moduli go as they are.
LENGTHS, MODULI = 1e5, 1e10
#: Bending of a thin body goes with the fourth power: at this ratio a tangent without digits is its.
LENGTHS_BENT = 1e3
#: Bulk over shear modulus above which elements of any usual order lock, and Newton's method is led astray.
INCOMPRESSIBLE = 1e4
#: Penalties of augmentations above this one make contact so stiff that Newton's method goes to and fro.
PENALTY = 1e3
#: Below this one augmentations are too many: of 100 a press took all at 1e-3, and came to its end at 0.1.
SMALL_PENALTY = 0.1
#: By the setting that ends them, how an error says that iterations did.
ENDED = {"max_iterations": "Newton's method stopped", "max_augmentations": "augmentations left"}
#: What it says where it advises something by itself.
ADVICE = "take "
#: How an error says that its tolerances ask for more digits than round-off leaves; a cure follows.
TOO_TIGHT = "which is next to round-off: "
#: Elastic slips below this share of the slave make friction so stiff that Newton's method goes to and fro: a press failed at 2e-4.
SHORT_SLIP = 1e-3


def causes(equilibrium: Equilibrium, state: State, error: Exception, longer: Sequence[str] = ()) -> Sequence[str]:
    """Sentences, without a capital, on what a person should look at; where there is nothing, on other ways.

    Parameters
    ----------
    equilibrium : Equilibrium
    state : State
        Where the last load increment ended that converged.
    error : Exception
        Why the next one did not.
    longer : sequence of str
        Why longer ones did not, which were cut.
    """
    found, words = list(_causes(equilibrium, state, error, longer)), str(error)
    bare = any(ended in words for ended in ENDED.values()) and ADVICE not in words.lower()
    if not found and bare and BESIDE not in words:
        found = [sentence for pair in equilibrium.pairs for sentence in at_an_edge(equilibrium, pair, state.positions)]
    return found if found or not bare else list(other_ways(equilibrium.problem, state, error))


def _causes(equilibrium: Equilibrium, state: State, error: Exception, longer: Sequence[str]) -> Iterator[str]:
    """What there is."""
    problem, positions = equilibrium.problem, state.positions
    if isinstance(error, PathError):
        yield _path(error.error, problem.settings.max_cuts)
        return
    yield from _too_tight(longer, str(error))
    told = set[int]()
    for judge in (sliding, overcome, tipping, giving_way):
        found = [(pieces, sentence) for pieces, sentence in judge(equilibrium, state) if told.isdisjoint(pieces)]
        yield from (sentence for _, sentence in found)
        told.update(*(pieces for pieces, _ in found))
    if not told and not isinstance(error, SingularSystemError):  # that tells by itself what repeats, and what nothing holds
        yield from shared_edges(equilibrium, state)
        yield from (sentence for _, sentence in on_the_way(equilibrium, state))
        yield from passed_through(equilibrium, state, error)
        yield from _few(problem.settings, str(error))
    if not told and isinstance(error, SingularSystemError):
        yield from averages_apart(equilibrium, state)
    yield from _flat(problem.deformable, equilibrium.solid.smallest_jacobians(positions))
    for body in problem.deformable:
        yield from _lengths(body, LENGTHS_BENT if isinstance(error, SingularSystemError) else LENGTHS)
        yield from _incompressible(body)
    yield from _moduli(problem)
    yield from _penalties(problem)
    for contact in problem.contacts:
        yield from few_points(problem, contact)
        yield from _short_slip(problem, contact)
    if BESIDE not in str(error):
        for pair in equilibrium.pairs:
            yield from over_the_edge(equilibrium, pair, positions)


def _path(error: float, cuts: int) -> str:
    """What lets an increment that converged be as long as it is, or makes it shorter."""
    ways = []
    if error <= 1.0:  # which no error that is infinite or not a number is
        unit = 10.0 ** np.floor(np.log10(error))
        ways.append(f"take solver.path_tolerance = {np.ceil(error / unit) * unit:g} or more")
    ways += [f"let increments be halved more often than solver.max_cuts = {cuts}"] if cuts < constants.MOST_CUTS else []
    return f"balance and contact were met, and the shortest increment is too long for that: {', '.join([*ways, 'or take more load steps'])}"


def _flat(bodies: Sequence[Body], jacobians: Sequence[float]) -> Iterator[str]:
    for body, jacobian in zip(bodies, jacobians, strict=True):
        if jacobian < FLAT:
            yield f"body {body.name!r} is pressed flat by then, down to J = {jacobian:.1e} of its volume: end the motion earlier"


def _lengths(body: Body, ratio: float) -> Iterator[str]:
    lengths = np.concatenate(element_lengths(body.patch))
    if lengths.max() > ratio * lengths.min():
        yield (
            f"elements of body {body.name!r} are {lengths.min():.1e} thin and up to {lengths.max():.1e} long, too different for double "
            "precision: make the body thicker, or its shortest knot spans longer"
        )


def _incompressible(body: Body) -> Iterator[str]:
    ratio = body.material.bulk / body.material.shear
    if ratio > INCOMPRESSIBLE:
        yield (
            f"with Poisson's ratio {body.material.poisson:.15g} body {body.name!r} resists compression {times(ratio)} times as much as "
            "shear: its elements lock. Take a lower one"
        )


def _moduli(problem: Problem) -> Iterator[str]:
    for one, other in combinations(problem.deformable, 2):
        softer, stiffer = sorted((one, other), key=lambda body: body.modulus)
        ratio = stiffer.modulus / softer.modulus
        if ratio > MODULI:
            yield (
                f"body {stiffer.name!r} is {times(ratio)} times as stiff as {softer.name!r}, too different for double precision: take it "
                f"less stiff, or rigid: bodies.{stiffer.name}.rigid = true"
            )


def _few(settings: SolverSettings, error: str) -> Iterator[str]:
    """Iterations that ended a load step, and are fewer than usual."""
    for name, words in ENDED.items():
        given, usual = getattr(settings, name), getattr(SolverSettings(), name)
        if words in error and given < usual:
            yield f"load steps may need more than solver.{name} = {given}: take {usual}, the default"


def _too_tight(longer: Sequence[str], error: str) -> Iterator[str]:
    """Tolerances that longer increments missed by round-off alone: shorter ones have more of it, as a share of less."""
    cures = [words.partition(TOO_TIGHT)[2] for words in longer if TOO_TIGHT in words]
    if cures and TOO_TIGHT not in error:
        yield f"longer increments ended next to round-off: {cures[-1]}"


def _penalties(problem: Problem) -> Iterator[str]:
    settings = problem.settings
    largest = max(settings.penalty_normal, settings.penalty_tangential)
    if settings.method == "uzawa" and largest > PENALTY:
        yield (
            f"a penalty of {largest:g}, times the stiffness of the pair, makes contact so stiff that Newton's method goes to and fro: take "
            "solver.penalty_normal and penalty_tangential of 10 to 1000"
        )
    if settings.method == "uzawa" and settings.penalty_normal < SMALL_PENALTY:
        yield (
            f"a penalty of {settings.penalty_normal:g}, times the stiffness of the pair, closes next to nothing of a gap with each "
            "augmentation: take solver.penalty_normal of 10 to 1000"
        )


def _short_slip(problem: Problem, contact: Contact) -> Iterator[str]:
    size = Sheet.of(problem, contact.slave).size
    if 0.0 < contact.elastic_slip < SHORT_SLIP * size:
        yield (
            f"contact {contact.name!r}: an elastic slip of {contact.elastic_slip:g}, where the slave is {size:.3g} large, makes friction "
            "so stiff that Newton's method goes to and fro: take a longer one, or 0, Coulomb's law"
        )
