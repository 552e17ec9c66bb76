"""GetFEM as a program: Lagrange elements of any order, contact by raytracing with an augmented Lagrangian, Newton's method.

What it is told and what it answers is JSON; `getfem_job` is read by the interpreter that Debian's python3-getfem belongs to.
"""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from isomortar.geometry.patch import FACES
from isomortar.model.entities import Contact, Face, Problem
from isomortar.program.declaration import LoadStep, NotInstalledError, Outcome, ended, load_step
from isomortar.program.lagrange import LagrangeProblem
from isomortar.program.process import Finished, run

#: The interpreter that Debian's Python packages belong to.
DEBIAN_PYTHON = "/usr/bin/python3"
#: Stored energy of each law per reference volume (theory 1.1), of a displacement gradient {g}, with data A1 and A2 of the body {b}.
_ISOCHORIC = "A2_{b}/2*(pow(Det(Id(3)+{g}),-2/3)*Norm_sqr(Id(3)+{g})-3)"
ENERGIES = {
    "neo-hookean": "A1_{b}/2*sqr(log(Det(Id(3)+{g}))) + " + _ISOCHORIC,
    "neo-hookean-j": "A1_{b}/2*sqr(Det(Id(3)+{g})-1) + " + _ISOCHORIC,
    "linear-elastic": "(A1_{b}/2-A2_{b}/3)*sqr(Trace({g})) + A2_{b}*Norm_sqr(Sym({g}))",
}
#: Newton iterations after which a load step has failed, if nothing else is said: those of increments that GetFEM cuts count, too.
MOST_ITERATIONS = 60


class GetFEM:
    """GetFEM's Python interface, in a process of its own with one thread.

    Multipliers of contact stand on the nodes of the slave face, with the contact's Gauss points. The augmentation parameter, half of the
    largest Young's modulus over the smallest extent of a body, steers the iterations and leaves the solution as it is. Nothing
    touches beyond 0.6 of that extent.

    Parameters
    ----------
    python : str
        An interpreter that finds the module getfem.
    works : bool
        Whether its load steps tell their works, which are integrated for us: not where it is timed.
    iterations : int
        Newton iterations after which a load step has failed.
    """

    name = "GetFEM"

    def __init__(self, python: str = DEBIAN_PYTHON, works: bool = True, iterations: int = MOST_ITERATIONS) -> None:
        self._python, self._works, self._iterations = python, works, iterations

    def run(self, problem: Problem) -> Outcome:
        """Compute all load steps, or as many as converge.

        Raises
        ------
        InputError
            What `LagrangeProblem` refuses.
        NotInstalledError
            The interpreter does not find GetFEM.
        """
        told = LagrangeProblem(problem, self.name, ENERGIES)
        if not has_module(self._python, "getfem"):
            raise NotInstalledError("GetFEM is not installed: apt-get install python3-getfem")
        with TemporaryDirectory() as folder:
            path = Path(folder) / "problem.json"
            path.write_text(json.dumps({**description(told), "works": self._works, "iterations": self._iterations}))
            finished = run([self._python, "-I", str(Path(__file__).with_name("getfem_job.py")), str(path)])
        return _outcome(told, finished)


def has_module(python: str, module: str) -> bool:
    """Whether an interpreter is there and finds a module."""
    try:
        return run([python, "-c", f"import importlib.util; raise SystemExit(importlib.util.find_spec({module!r}) is None)"]).end.status == 0
    except OSError:
        return False


def description(told: LagrangeProblem) -> dict[str, Any]:
    """What GetFEM has to know, in plain numbers that JSON holds: nodes count from 0, unknowns are 3 * node + component.

    The unit of force is such that the largest Young's modulus is 1: its tolerance knows none.
    """
    problem, unit = told.problem, told.stiffest
    bodies = [
        {
            "name": body.name,
            "orders": [direction.order for direction in body.patch.directions],
            "elements": told.elements(body).tolist(),
            "gauss": body.quadrature,
            "energy": ENERGIES[body.material.law].format(g=f"Grad_u_{number}", b=number),
            "bulk": body.material.bulk / unit,
            "shear": body.material.shear / unit,
        }
        for number, body in enumerate(problem.bodies)
    ]
    names = [body.name for body in problem.bodies]
    contacts = [
        {
            "friction": contact.friction,
            "sides": [
                {"body": names.index(place.body), "face": place.face, "elements": told.touching(place).tolist(), "gauss": points}
                for place, points in ((contact.slave, _by_direction(contact)), (contact.master, [max(contact.quadrature)] * 3))
                if isinstance(place, Face)
            ],
        }
        for contact in problem.contacts
    ]
    loads = [
        {"body": names.index(load.body), "face": load.place.face, "elements": told.touching(load.place).tolist()} for load in problem.loads
    ]
    return {
        "bodies": bodies,
        "contacts": contacts,
        "loads": loads,
        "nodes": told.nodes.tolist(),
        "prescribed": told.prescribed.tolist(),
        "displacements": told.displacements.tolist(),
        "pressures": (told.pressures / unit).tolist(),
        "augmentation": 0.5 / told.thinnest,
        "release": 0.6 * told.thinnest,
        "tolerance": problem.settings.newton_tolerance,
    }


def _by_direction(contact: Contact) -> list[int]:
    """Gauss points of a contact along the three directions of its slave: those of the face's own two; across it any number would do."""
    axis, points = FACES.index(contact.slave.face) // 2, [max(contact.quadrature)] * 3
    points[(axis + 1) % 3], points[(axis + 2) % 3] = contact.quadrature
    return points


def _outcome(told: LagrangeProblem, finished: Finished) -> Outcome:
    """From what the job printed: a line of JSON a load step; where it was killed the last one may be cut."""
    steps: list[LoadStep] = []
    solves = 0
    words = finished.last_words
    ending = finished.end.ending
    whole = finished.output[: finished.output.rfind("\n") + 1]
    for line in whole.splitlines():
        found = json.loads(line)
        solves += found["solves"]
        if not found["converged"]:
            ending, words = "not converged", f"Newton's method did not converge in {found['solves']} iterations"
            break
        forces = np.zeros(told.nodes.size)
        forces[told.prescribed] = told.stiffest * np.array(found["forces"])
        positions = told.nodes + np.reshape(found["displacements"], (-1, 3))
        step = load_step(told.problem, len(steps) + 1, positions, forces.reshape(-1, 3))
        works = (told.stiffest * found["friction"], told.stiffest * found["spurious"]) if "friction" in found else step.works
        steps.append(replace(step, works=works))
    return Outcome(*ended(steps, told.problem, ending, words), tuple(steps), solves, finished.cpu_seconds)
