"""The bundled scenes that results of another program are there for, and what of a run is compared with them."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Any

import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: Settings of this program that its own error is below that of the references with.
SETTINGS: dict[str, dict[str, str | float]] = {
    "local": {"method": "monolithic", "slip_sum": "local", "newton_tolerance": 1e-11, "complementarity_tolerance": 1e-10},
    "tight": {
        "method": "uzawa",
        "slip_sum": "paper",
        "augmentation_norm": "paper",
        "newton_tolerance": 1e-11,
        "augmentation_tolerance": 1e-8,
        "penalty_growth": 2.0,
        "penalty_growth_max": 200.0,
        "max_augmentations": 600,
    },
    "paper": {"method": "uzawa", "slip_sum": "paper", "augmentation_norm": "paper", "penalty_growth": 1.0},
}

#: Between the name of a whole run and the number of load steps of its beginning.
FIRST = "_first"


@dataclass(frozen=True)
class Excerpt:
    """A bundled scene, the discretisation of one of its bodies if it is another than the scene's, and how many load steps are followed."""

    scene: str
    steps: int
    body: str = ""
    mesh: Mapping[str, Sequence[Any]] | None = None

    @property
    def overrides(self) -> list[str]:
        """Of the discretisation."""
        return [f"bodies.{self.body}.mesh.{key}={json.dumps(value)}" for key, value in (self.mesh or {}).items()]


_PRESS_L2: dict[str, Sequence[Any]] = {"family": ["L", "L", "L"], "order": [2, 2, 1]}
_PRESS_SIX = [6, 6, 3]

#: By group and name; steps that are fewer than the scene's are its first ones.
RUNS: dict[str, dict[str, Excerpt]] = {
    "local": {
        "press_L2_6": Excerpt("press", 5, "block", {**_PRESS_L2, "elements": [3, 3, 3]}),
        "press_N2_6": Excerpt("press", 5, "block", {"elements": _PRESS_SIX}),
        "press_N3_6": Excerpt("press", 5, "block", {"order": [3, 3, 2], "elements": _PRESS_SIX}),
        "press_N4_6": Excerpt("press", 5, "block", {"order": [4, 4, 2], "elements": _PRESS_SIX}),
        "press_N2_12": Excerpt("press", 5),
        "twist_N2": Excerpt("twist", 50),
        "twist_N3": Excerpt("twist", 50, "master", {"order": [3, 3, 2]}),
        "twist_N5": Excerpt("twist", 50, "master", {"order": [5, 5, 2]}),
        "iron_N2": Excerpt("iron", 50),
        "iron_N3": Excerpt("iron", 50, "master", {"order": [3, 2, 2]}),
        "iron_N5": Excerpt("iron", 50, "master", {"order": [5, 2, 2]}),
        "tire_N2_32_q": Excerpt("tire", 40),
    },
    "tight": {
        "press_L2": Excerpt("press", 5, "block", {**_PRESS_L2, "elements": [3, 3, 3]}),
        "press_N3": Excerpt("press", 5, "block", {"order": [3, 3, 2], "elements": _PRESS_SIX}),
        "twist_N2_first17": Excerpt("twist", 17),
        "twist_N3": Excerpt("twist", 20, "master", {"order": [3, 3, 2]}),
        "iron_N2": Excerpt("iron", 20),
        "tire_L2": Excerpt("tire", 20, "tire", {"family": ["L", "L", "L"], "elements": [16, 4, 4]}),
        "tire_N2": Excerpt("tire", 20),
    },
    "paper": {
        "press_L2_6": Excerpt("press", 5, "block", {**_PRESS_L2, "elements": [3, 3, 3]}),
        "press_L2_12": Excerpt("press", 5, "block", {**_PRESS_L2, "elements": [6, 6, 6]}),
        "press_N2_6": Excerpt("press", 5, "block", {"elements": _PRESS_SIX}),
        "press_N3_6": Excerpt("press", 5, "block", {"order": [3, 3, 2], "elements": _PRESS_SIX}),
        "press_N2_12": Excerpt("press", 5),
        "twist_N2": Excerpt("twist", 50),
        "twist_N3": Excerpt("twist", 50, "master", {"order": [3, 3, 2]}),
        "iron_N3": Excerpt("iron", 50, "master", {"order": [3, 2, 2]}),
        "iron_N4": Excerpt("iron", 50, "master", {"order": [4, 2, 2]}),
        "iron_N5": Excerpt("iron", 50, "master", {"order": [5, 2, 2]}),
        "tire_L1_32_q": Excerpt("tire", 40, "tire", {"family": ["L", "L", "L"], "order": [1, 1, 1]}),
        "tire_L4_8_q": Excerpt("tire", 40, "tire", {"family": ["L", "L", "L"], "order": [4, 1, 1], "elements": [8, 4, 4]}),
        "tire_N3_32_q": Excerpt("tire", 40, "tire", {"order": [3, 1, 1]}),
    },
}


def find(group: str, name: str) -> Excerpt:
    """A run by its name, or its beginning: ``twist_N2_first14`` is the first 14 load steps of ``twist_N2``."""
    if name in RUNS[group]:
        return RUNS[group][name]
    whole, _, steps = name.rpartition(FIRST)
    run = RUNS[group][whole]
    return Excerpt(run.scene, int(steps), run.body, run.mesh)


def has_end(name: str) -> bool:
    """Whether a run goes to the end of its reference, whose positions are known there only."""
    return FIRST not in name


def load(run: Excerpt, settings: Iterable[str] = ()) -> Scene:
    """The scene with its discretisation and solver settings."""
    return Scene.load(run.scene, [*run.overrides, *settings])


def measure(group: str, name: str) -> dict[str, FloatArray]:
    """Run the first load steps of a scene.

    Returns
    -------
    dict
        ``force`` and ``moment`` on the supports, shape (steps, supports, 3); ``pressure``, shape (steps, 2): the largest control
        pressure and the largest at quadrature points; ``traction``, shape (steps,): the largest control traction; ``points``, shape
        (steps, 3): numbers of active and slipping control points and of excluded quadrature points; at the end of a reference
        ``position`` of all control points, shape (n, 3).
    """
    run = find(group, name)
    simulation = Simulation(load(run, [f"solver.{key}={value}" for key, value in SETTINGS[group].items()]).problem())
    results = list(islice(simulation.run(), run.steps))
    contacts = [(result.contacts[0], result.state.contacts[0]) for result in results]
    found = {
        "force": np.array([[reaction.force for reaction in result.reactions] for result in results]),
        "moment": np.array([[reaction.moment for reaction in result.reactions] for result in results]),
        "pressure": np.array([[state.pressure.max(), np.max(contact.pressure_field)] for contact, state in contacts]),
        "traction": np.array([contact.traction_norm.max() for contact, _ in contacts]),
        "points": np.array([[contact.active, contact.slip, contact.excluded] for contact, _ in contacts], dtype=float),
    }
    return found | ({"position": results[-1].state.positions} if has_end(name) else {})
