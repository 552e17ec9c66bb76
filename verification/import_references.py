"""Store results of another program as references of class "other code".

    python verification/import_references.py ../shared/reference

The folder has a folder of explicit scenes (``NAME.json``) and results (``NAME.result.json``) for every group of `reference_scenes`.
Each scene is compared with the bundled one that stands for it here, load step by load step: control points and weights to round-off,
the rest exactly; one that differs ends the import. Kept are the curves over the load steps and the positions at the end.
"""

from __future__ import annotations

import argparse
import json
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from bundled_scenes import differences
from convert_reference import convert
from other_code.agreement import GROUPS
from reference_scenes import FIRST, RUNS, Excerpt, find, has_end, load

from isomortar.geometry.patch import FloatArray
from isomortar.harness.references import write_reference
from isomortar.model.entities import Problem
from isomortar.scene import Scene

#: How far motions of one load step may be apart: a share of a path, cut to that many load steps.
MOTION = 1e-14

#: What the results of a group are worth: relative uncertainty of forces, moments and pressures, of tractions, of positions, and why.
WORTH: dict[str, tuple[float, float, float, str]] = {
    "local": (1e-9, 1e-9, 1e-9, "contact conditions solved to 1e-9 of the multipliers, by Newton's method to 1e-11"),
    "tight": (
        1e-8,
        1e-6,
        1e-8,
        "augmented until pressures and tractions in one norm change by 1e-8, of which tractions are the small part",
    ),
    # Paths are a tenth of the bodies' extent or more: positions are worth 1 % of them.
    "paper": (1e-2, 1e-2, 1e-3, "augmented until the multipliers change by 1e-2, of which each load step keeps its own share"),
}


def steps_of(problem: Problem) -> FloatArray:
    """What every load step moves and turns each support by, shape (steps, supports, 4)."""
    return np.array(
        [
            [np.array([*support.motions[i].translate, support.motions[i].rotate]) / stage.steps for support in problem.supports]
            for i, stage in enumerate(problem.stages)
            for _ in range(stage.steps)
        ]
    )


def not_the_same(run: Excerpt, source: Path) -> list[str]:
    """What differs between a run and the explicit scene, in words."""
    with TemporaryDirectory() as folder:
        theirs = Scene.load(convert(source, Path(folder))).problem()
    ours = load(run).problem()
    found = []
    if not np.abs(steps_of(ours)[: run.steps] - steps_of(theirs)[: run.steps]).max() <= MOTION * np.abs(steps_of(theirs)).max():
        found.append("motions by load step")
    moved = tuple(replace(own, motions=other.motions) for own, other in zip(ours.supports, theirs.supports, strict=True))
    return found + differences(replace(ours, supports=moved, stages=theirs.stages), theirs)


def numbers(result: dict[str, Any], run: Excerpt, end: bool) -> dict[str, FloatArray]:
    """The numbers of `reference_scenes.measure` in a result of the other program."""
    records = result["records"][: run.steps]
    if len(records) < run.steps:
        raise SystemExit(f"the result has {len(records)} load steps, {run.steps} are to be kept")
    found = {
        "force": np.array([[support["force"] for support in record["bcs"]] for record in records]),
        "moment": np.array([[support["moment"] for support in record["bcs"]] for record in records]),
        "pressure": np.array([[max(record["p_control"]), max(record["p_field_qp"])] for record in records]),
        "traction": np.array([record["tau_norm_max"] for record in records]),
        "points": np.array([[record[key] for key in ("n_active", "n_slip", "n_excluded_points")] for record in records], dtype=float),
    }
    return found | ({"position": np.array(result["final"]["x"], dtype=float)} if end else {})


def uncertainties(group: str, values: dict[str, FloatArray], size: float) -> dict[str, float]:
    """Absolute uncertainty of each number; a moment's is that of a force at the distance `size`, a count has none."""
    share, tractions, positions, _ = WORTH[group]
    force = share * float(np.abs(values["force"]).max())
    return {
        "force": force,
        "moment": force * size,
        "pressure": share * float(np.abs(values["pressure"]).max()),
        "traction": tractions * float(np.abs(values["traction"]).max()),
        "points": 0.0,
        "position": positions * size,
    }


def store(group: str, folder: Path, references: Path) -> Path:
    """Write the reference of one group: all numbers that its cells compare."""
    datasets: dict[str, tuple[FloatArray, float]] = {}
    for cell in GROUPS[group].cells:
        name = cell.settings["scene"]
        run, source = find(group, name), folder / f"{name if name in RUNS[group] else name.rpartition(FIRST)[0]}.json"
        different = not_the_same(run, source)
        if different:
            raise SystemExit(f"{source} is not the bundled scene {run.scene}: {'; '.join(different)}")
        values = numbers(json.loads(source.with_suffix(".result.json").read_text(encoding="utf-8")), run, has_end(name))
        points = np.concatenate([body.patch.control_points for body in load(run).problem().bodies])
        worth = uncertainties(group, values, float(np.linalg.norm(np.ptp(points, axis=0))))
        compared = cell.case.bounds_of(cell.settings)
        datasets |= {f"{cell.label}/{number}": (values[number], worth[number]) for number in compared}
    share, tractions, positions, reason = WORTH[group]
    of = f"{share:g} of the largest value of a run ({tractions:g} of tractions; moments: of forces at the bodies' extent; positions: "
    of += f"{positions:g} of that)"
    record = {
        "title": f"Benchmark scenes, {group}",
        "class": "other code",
        "origin": "An independent implementation of the same formulation, with its own projection, derivatives and assembly",
        "made": "python verification/import_references.py FOLDER",
        "uncertainty": f"{of}: {reason}",
    }
    write_reference(references / f"other_code_{group}", datasets, record)
    return references / f"other_code_{group}"


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--references", type=Path, default=Path("reference_data"), help="where to (default: %(default)s)")
    options = parser.parse_args()
    for group in GROUPS:
        print(store(group, options.folder / group, options.references))


if __name__ == "__main__":
    main()
