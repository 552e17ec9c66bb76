"""Fuzzed scenes through the command line: an end that is right, a refusal, a stop with its cause, and nothing else."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from forked import program
from fuzz.child import Ending, Wrong, ending_of, tally, tried
from fuzz.mutation import mutated
from fuzz.twins import Twin, twin_of

from isomortar import Results
from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case
from isomortar.model.entities import Contact, Face, Problem, RigidPlane
from isomortar.model.glue import pieces
from isomortar.results import layout
from isomortar.scene.toml_text import dump

#: Share by which forces, and contact conditions, may be off beyond the scene's own tolerances; and what that is of a tolerance.
ROUND_OFF, OF_TOLERANCE = 1e-9, 1e2
#: The loosest tolerance at which anything can be said of the numbers.
LOOSEST = 1e-4


def judged(text: bytes, number: int, folder: Path) -> Ending:
    """Run a scene, look at what it left, and at a run of its twin."""
    ending = _run(text, folder, "scene")
    if ending.kind != "right":
        return ending
    with Results(folder / "scene.h5") as results:
        _look(results)
        twin = twin_of(tomllib.loads(text.decode()), number)
        if twin is not None and _tolerance(results) <= LOOSEST and not _leaves(results):
            other = _run(dump(twin.data).encode(), folder, "twin")
            if other.kind != "right" and twin.own_iterations:  # one way gets on where the other does not, or is not offered
                return ending
            if other.kind != "right":
                raise Wrong(f"runs, but not {twin.differs}: {other.said}")
            with Results(folder / "twin.h5") as twins:
                if not _leaves(twins):
                    _compare(results, twins, twin)
    return ending


def _leaves(results: Results) -> bool:
    """Whether slave points are beside their master: what they carried is gone in a jump, and where that ends is not unique."""
    return any(np.any(results.curve("excluded", contact=contact.name) > 0) for contact in results.problem.contacts)


def _run(text: bytes, folder: Path, name: str) -> Ending:
    scene, output = folder / f"{name}.toml", folder / f"{name}.h5"
    scene.write_bytes(text)
    return ending_of(*program("run", str(scene), "--quiet", "--output", str(output), folder=folder))


def _tolerance(results: Results) -> float:
    settings = results.problem.settings
    own = settings.complementarity_tolerance if settings.method == "monolithic" else settings.augmentation_tolerance
    return max(own, settings.newton_tolerance)


def _look(results: Results) -> None:
    """What holds for every scene: numbers, balance of forces, contact conditions."""
    problem = results.problem
    if results.steps.tolist() != list(range(1, problem.total_steps + 1)):
        raise Wrong(f"exit code 0 with load steps {results.steps}")
    forces = [results.curve("force", support=s.name) for s in problem.supports]
    forces += [results.curve("force", load=load.name) for load in problem.loads]
    for contact in problem.contacts:
        values = {name: results.curve(name, contact=contact.name) for name in layout.CONTACT}
        for name, value in values.items():
            _finite(f"{contact.name}.{name}", value)
        if isinstance(contact.master, RigidPlane):
            forces.append(values["force_slave"])
        elif not _close(values["force_slave"], -values["force_master"], ROUND_OFF, _nothing(results)):
            raise Wrong(f"forces on both sides of {contact.name} differ: {values['force_slave'][-1]}, {values['force_master'][-1]}")
        forces += [
            -values[f"force_{side}"] for side, place in (("slave", contact.slave), ("master", contact.master)) if _stands(problem, place)
        ]
        _look_at_contact(results, contact)
    for force in forces:
        _finite("a force", force)
    whole = np.abs(forces).sum(axis=(0, 2))
    left = np.abs(np.sum(forces, axis=0)).max(axis=1)
    allowed = ROUND_OFF + OF_TOLERANCE * results.problem.settings.newton_tolerance
    if not np.all(left <= allowed * whole + _nothing(results)):
        raise Wrong(f"supports and planes leave {left.max():.3e} of {whole.max():.3e}")
    for number in results.kept_states:
        _finite("positions", results.step(int(number)).state.positions)


def _stands(problem: Problem, place: Face | RigidPlane) -> bool:
    """Whether it is of a rigid body that no support bears, nor what is glued to it."""
    if isinstance(place, RigidPlane) or not problem.body(place.body).rigid:
        return False
    (whole,) = ({body.name for body in piece} for piece in pieces(problem) if problem.body(place.body) in piece)
    return not any(support.place.body in whole for support in problem.supports)


def _look_at_contact(results: Results, contact: Contact) -> None:
    name = contact.name
    history = results.contact(name)
    for part in ("pressure", "traction", "gap", "traction_norm"):
        _finite(f"{name}.{part}", getattr(history, part))
    allowed = ROUND_OFF + OF_TOLERANCE * _tolerance(results)
    most = np.inf if contact.traction_max is None else contact.traction_max
    borne = np.where(history.pressure > 0, np.minimum(contact.cohesion + contact.friction * history.pressure, most), 0.0)
    size = float(np.max([np.ptp(body.patch.control_points, axis=0).max() for body in results.problem.bodies]))
    nothing = allowed * max(history.pressure.max(), history.traction_norm.max()) + _nothing(results) / size**2
    if not np.all(history.pressure >= -nothing):
        raise Wrong(f"negative pressure in {name}: {history.pressure.min():g}")
    if not np.all(history.traction_norm <= borne * (1 + allowed) + nothing):
        raise Wrong(f"tractions in {name} are larger than friction bears")
    if results.problem.settings.method == "monolithic" and not np.all(history.gap <= allowed * size):
        raise Wrong(f"{name} penetrates by {history.gap.max():g}, of bodies of size {size:g}")


def _finite(name: str, values: Any) -> None:
    if not np.isfinite(values).all():
        raise Wrong(f"exit code 0, and {name} is not finite")


def _nothing(results: Results) -> float:
    """A force that is round-off of the stiffest body: of the last bits of its positions, far away as well, in its thinnest direction."""
    farthest = np.max([np.abs(results.step(int(number)).state.positions).max() for number in results.kept_states])
    forces = []
    for body in results.problem.deformable:
        extents = np.ptp(body.patch.control_points, axis=0)
        size, thin = float(extents.max()), float(extents.min())
        forces.append(1e-13 * body.material.young * size**2 * max(1.0, 0.1 * farthest / thin))
    return float(np.max(forces, initial=0.0))


def _close(one: FloatArray, other: FloatArray, share: float, nothing: float = 0.0) -> bool:
    return bool(np.all(np.abs(one - other) <= share * max(np.abs(one).max(initial=0.0), np.abs(other).max(initial=0.0)) + nothing))


def _compare(results: Results, other: Results, twin: Twin) -> None:
    """Forces of both; with friction other increments are another path, and round-off may be what an increment is cut for.

    How the rest of a cut load step is divided depends on its iterations, and a twin with iterations of its own has others; a support that
    bears next to nothing is off by a share of what the others bear.
    """
    rubs = any(contact.friction or contact.cohesion for contact in results.problem.contacts)
    substeps = results.curve("substeps")
    if rubs and not (np.array_equal(substeps, other.curve("substeps")) and (not twin.own_iterations or np.all(substeps == 1))):
        return
    share = 1e-7 + OF_TOLERANCE * max(_tolerance(results), _tolerance(other))
    forces = {support.name: results.curve("force", support=support.name) for support in results.problem.supports}
    left = share * max((np.abs(force).max() for force in forces.values()), default=0.0) if twin.own_iterations else 0.0
    for name, one in forces.items():
        same = other.curve("force", support=name) / (twin.modulus * twin.length**2)
        if not _close(one, same, share, 100 * _nothing(results) + left):
            raise Wrong(f"force of {name} is {one[-1]}, but {same[-1]} {twin.differs}")


def endings(first: int, count: int) -> Iterator[tuple[int, Ending]]:
    """How the scenes of some numbers end."""
    for number in range(first, first + count):
        yield number, tried(lambda folder, number=number: judged(mutated(number), number, folder))  # type: ignore[misc]


@case(
    claim="Fuzzed scenes end right, refused, or stopped with a sentence: no traceback, signal, hang, no numbers that are none, forces in "
    "balance, contact conditions met, the same in other units, with tables in another order, with factors never kept, by the other method.",
    tier=lambda count: "gate" if count < 100 else "nightly",
    grid={"count": (12, 400)},
    bounds={
        "right": Bound(at_least=0.15, at_most=1.0, reason="definition: enough of the scenes run to be looked at"),
        "refused": Bound(at_least=0.15, at_most=1.0, reason="definition: enough of the scenes make no sense"),
        "stopped": Bound(at_most=0.5, reason="definition: not all of them at their limits"),
    },
)
def scenes(count: int) -> dict[str, float]:
    """Shares of the endings; one that is wrong is an error that names its number."""
    return tally(endings(0, count), "python verification/fuzz_at_length.py scenes")
