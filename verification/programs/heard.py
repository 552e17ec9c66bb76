"""What is made of what GetFEM says, where it is, and what, where it is not: with a shell in place of its interpreter."""

from __future__ import annotations

import json
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from programs.declared import problem

from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case
from isomortar.model.numbering import Numbering
from isomortar.program.declaration import NotInstalledError, Outcome
from isomortar.program.getfem import ENERGIES, GetFEM, has_module
from isomortar.program.lagrange import LagrangeProblem

#: Largest Young's modulus of the scene: GetFEM's unit of stress.
STIFFEST = 70.0
#: After so many load steps what ends the job, how the run ends, and its last words.
ENDS = (
    (3, "exit 0", "measured", ""),
    (3, "exit 7", "measured", ""),
    (2, "echo why >&2; exit 7", "crashed", "why"),
    (1, "printf '{\"converged\": tr'; echo cut >&2; exit 7", "crashed", "cut"),
    (0, "exit 0", "crashed", "the process ended with status 0"),
    (1, 'echo \'{"converged": false, "solves": 60}\'', "not converged", "Newton's method did not converge in 60 iterations"),
)


def answered(lines: list[dict[str, Any]], end: str, has: str = "exit 0") -> Outcome:
    """What becomes of the scene with an interpreter that prints lines and ends so; `has`: whether it finds the module."""
    with TemporaryDirectory() as folder:
        (Path(folder) / "lines").write_text("".join(json.dumps(line) + "\n" for line in lines))
        python = Path(folder) / "python"
        python.write_text(f'#!/bin/sh\n[ "$1" = -c ] && {has}\n[ "$1" = -c ] && exit 1\ncat {folder}/lines\n{end}\n')
        python.chmod(0o755)
        return GetFEM(str(python)).run(problem())


@case(
    claim="Of GetFEM load steps are taken as it tells them, in the unit of force of a scene, and all of its solves; how it ended is told.",
    tier="gate",
    bounds={
        "error": Bound(at_most=1e-13, reason="round-off: positions, forces and works, over the largest"),
        "wrong": Bound(0.0, 0.0, "definition: endings, words, counts of load steps and of solves, and where it is found"),
    },
)
def heard() -> dict[str, float]:
    """Largest relative difference of what three load steps tell, and how many endings are others."""
    given, random = problem(), np.random.default_rng(3)
    of, rest = LagrangeProblem(given, "it", ENERGIES), Numbering(given).reference
    moves = 0.1 * random.normal(size=(3, *rest.shape))
    forces = random.normal(size=(3, len(of.prescribed)))
    lines: list[dict[str, Any]] = [
        {"converged": True, "solves": 4 + k, "forces": forces[k].tolist(), "displacements": moves[k].ravel().tolist()} for k in range(3)
    ]
    lines[1] |= {"friction": 0.5, "spurious": -0.25}
    wrong, errors = [], [0.0]
    for count, end, ending, words in ENDS:
        found = answered(lines[:count], end)
        solves = sum(4 + k for k in range(count)) + 60 * (ending == "not converged")
        wrong += [(found.ending, found.words, len(found.steps), found.solves) != (ending, words, count, solves)]
        errors += [float(np.abs(step.positions - rest - move).max()) for step, move in zip(found.steps, moves, strict=False)]
        totals = [np.sum([reaction.force for reaction in step.reactions], axis=0) for step in found.steps]
        errors += [_apart(total, of, force) for total, force in zip(totals, forces, strict=False)]
        wrong += [not np.isnan(found.steps[k].works).all() for k in (0, 2) if k < count]
        wrong += [found.steps[1].works != (0.5 * STIFFEST, -0.25 * STIFFEST)] if count > 1 else []
    try:
        answered(lines, "exit 0", has="exit 1")
        wrong += [True]
    except NotInstalledError:
        pass
    wrong += [not has_module("python3", "json"), has_module("python3", "no_such_module"), has_module("no-such-python", "json")]
    return {"error": float(np.max(errors)), "wrong": float(sum(wrong))}


def _apart(total: FloatArray, of: LagrangeProblem, force: FloatArray) -> float:
    """How far a sum of reactions is from that of forces at prescribed unknowns, over the largest force."""
    exact = np.array([STIFFEST * force[of.prescribed % 3 == component].sum() for component in range(3)])
    return float(np.abs(total - exact).max() / (STIFFEST * np.abs(force).max()))
