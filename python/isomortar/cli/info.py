"""``isomortar info``: what a results file holds, and how its computation stands."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Annotated

import typer

import isomortar
from isomortar._frozen import frozen
from isomortar.cli.options import ResultsArgument
from isomortar.cli.words import many

if TYPE_CHECKING:
    from isomortar.solve.record import StepResult


@frozen
class ContactEnd:
    """A contact at the last recorded load step: constraints by state, smallest and largest pressure, deepest gap of a constraint."""

    name: str
    constraints: int
    active: int
    slip: int
    pressure: tuple[float, ...]
    penetration: float


@frozen
class SupportEnd:
    """A support at the last recorded load step: force on its body, moment about its moving centre, how far that has gone.

    `rotation`: by how many degrees it has turned about its axis.
    """

    name: str
    force: tuple[float, ...]
    moment: tuple[float, ...]
    displacement: tuple[float, ...]
    rotation: float


@frozen
class LoadEnd:
    """A load at the last recorded load step: force on its body, moment about the origin."""

    name: str
    force: tuple[float, ...]
    moment: tuple[float, ...]


@frozen
class Information:
    """What a results file holds; lists of contacts, supports and loads are empty as long as it has no load step.

    Parameters
    ----------
    name, version : str
        Of the scene, and of the program that wrote the file.
    unknowns, load_steps, recorded, kept_states, cuts : int
        Of the scene: unknowns and load steps; of the file: load steps, states from which a run could go on, cut increments.
    stages : dict of str to (int, int)
        Recorded load steps and all, by stage.
    cpu_seconds : float
        Of all recorded load steps.
    symmetry : tuple of str
        Planes of symmetry, above which the scene was computed.
    contacts : tuple of ContactEnd
    supports : tuple of SupportEnd
    loads : tuple of LoadEnd
    warnings : tuple of str
        What was told of the scene and its run.
    """

    name: str
    version: str
    unknowns: int
    load_steps: int
    recorded: int
    kept_states: int
    cuts: int
    stages: dict[str, tuple[int, int]]
    cpu_seconds: float
    symmetry: tuple[str, ...]
    contacts: tuple[ContactEnd, ...]
    supports: tuple[SupportEnd, ...]
    loads: tuple[LoadEnd, ...]
    warnings: tuple[str, ...]


def info(
    results: ResultsArgument,
    as_json: Annotated[bool, typer.Option("--json", help="Print all of it as JSON.")] = False,
) -> None:
    """Say what a results file holds, how far its computation came, how its contacts and supports stand, and what was doubtful.

    Contacts and supports are those of the last load step. Works while the computation is still running.

    For example:

    - `isomortar info results/iron.h5`
    - `isomortar info results/iron.h5 --json`
    """
    with isomortar.Results(results) as stored:
        found = information(stored)
    if as_json:
        print(json.dumps(asdict(found), indent=2))
        return
    for line in lines(found, results):
        print(line)


def information(results: isomortar.Results) -> Information:
    """What is in a results file that is open."""
    import numpy as np

    from isomortar.model.numbering import Numbering
    from isomortar.model.supports import Supports

    problem, stages, last = results.problem, results.stages, results.last_step()
    return Information(
        name=isomortar.Scene.from_toml(results.scene_text).name,
        version=results.version,
        unknowns=len(Supports(problem, Numbering(problem)).free),
        load_steps=problem.total_steps,
        recorded=len(results.steps),
        kept_states=len(results.kept_states),
        cuts=int(results.curve("cuts").sum()),
        stages={stage.name: (stages.count(stage.name), stage.steps) for stage in problem.stages},
        cpu_seconds=float(np.nansum(results.timings().get("total", np.zeros(0)))),
        symmetry=tuple(plane.words for plane in problem.symmetry),
        contacts=tuple(_contacts(results, last)) if last else (),
        supports=tuple(_supports(results, last)) if last else (),
        loads=tuple(_loads(results, last)) if last else (),
        warnings=results.warnings,
    )


def _contacts(results: isomortar.Results, last: StepResult) -> Iterator[ContactEnd]:
    for contact, end in zip(results.problem.contacts, last.contacts, strict=True):
        pressure = tuple(map(float, end.pressure_field))
        yield ContactEnd(contact.name, len(end.gap), end.active, end.slip, pressure, float(max(end.gap, default=0.0)))


def _supports(results: isomortar.Results, last: StepResult) -> Iterator[SupportEnd]:
    for support, reaction in zip(results.problem.supports, last.reactions, strict=True):
        force, turning, way = (tuple(map(float, v)) for v in (reaction.force, reaction.moment, reaction.displacement))
        yield SupportEnd(support.name, force, turning, way, float(reaction.rotation))


def _loads(results: isomortar.Results, last: StepResult) -> Iterator[LoadEnd]:
    for load, end in zip(results.problem.loads, last.loads, strict=True):
        yield LoadEnd(load.name, tuple(map(float, end.force)), tuple(map(float, end.moment)))


def lines(found: Information, path: Path) -> Iterator[str]:
    """The words for it."""
    yield f"{found.name}: {found.unknowns} unknowns, computed by isomortar {found.version}"
    parts = ", ".join(f"{name} {done} of {whole}" for name, (done, whole) in found.stages.items())
    yield (
        f"{found.recorded} of {many(found.load_steps, 'load step')} ({parts}), {found.kept_states} with their state; "
        f"{found.cpu_seconds:.3g} CPU seconds, {many(found.cuts, 'cut')} of increments"
    )
    if found.symmetry:
        yield (
            f"the part above {' and '.join(found.symmetry)} is computed, one of {2 ** len(found.symmetry)}: forces and moments are the "
            "whole's, unknowns and constraints the part's"
        )
    for contact in found.contacts:
        low, high = contact.pressure
        yield (
            f"contact {contact.name}: {contact.active} of {contact.constraints} constraints active, {contact.slip} slip; "
            f"pressures {low:.4g} to {high:.4g} per area at rest, penetration {contact.penetration:.2g}"
        )
    for support in found.supports:
        turned = f", turned by {support.rotation:.5g} degrees" if support.rotation else ""
        way = f"gone ({_row(support.displacement)}){turned}"
        yield f"support {support.name}: force ({_row(support.force)}), moment ({_row(support.moment)}), {way}"
    for load in found.loads:
        yield f"load {load.name}: force ({_row(load.force)}), moment ({_row(load.moment)})"
    for warning in found.warnings:
        yield f"warning: {warning}"
    if found.recorded < found.load_steps:
        yield f"not at its end: isomortar run SCENE --resume --output {quote(str(path))} goes on"


def _row(numbers: tuple[float, ...]) -> str:
    return ", ".join(f"{number:.5g}" for number in numbers)
