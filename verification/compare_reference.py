"""Run explicit scenes and compare every load step with the results of another program.

    python verification/compare_reference.py ../shared/reference/tight/*.json --like tight

Each ``NAME.json`` has its ``NAME.result.json`` beside it. The scene is converted and run, and compared:

- at every load step: force and moment of each boundary condition, pressures (control, field; smallest and largest), largest
  traction, numbers of active and slipping control points and of excluded quadrature points;
- at the end: positions, control pressures and control tractions of all control points.

Relative errors. A force: norm of the difference over the larger of the reference's norm and 1e-6 of the largest force of the run, so
that steps without force do not blow up. A moment: likewise, with that force times the diagonal of the reference configuration.
Pressures: over the largest of that step and kind, or 1e-6 of that of the run; tractions over the step's largest, or 1e-6 of the run's
largest pressure. Positions: over the diagonal. Final control values: largest difference over the largest value. Counts: must be equal.

A missing key, a value that is not finite, another number of load steps, or a run that stops is a failure. A reference that says that
it did not complete is followed for the load steps that it has; its end lies somewhere after them and is not compared. One that does not
number its slave control points has them in ascending order. Exit code 1 if any scene fails.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any

import numpy as np
from convert_reference import convert

from isomortar.errors import IsomortarError
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.record import StepResult

#: Share of the largest value of a run below which a quantity counts as nothing.
FLOOR = 1e-6

#: Solver settings of the groups of references that an explicit scene does not state. The tight ones stopped by the paper's norm as well:
#: with it press_N3 agrees to round-off, with the separate test, which asks for more augmentations, only to 3e-6 in its tractions.
SETTINGS: dict[str, dict[str, str]] = {
    "local": {"method": "monolithic", "slip_sum": "local"},
    "tight": {"method": "uzawa", "slip_sum": "paper", "augmentation_norm": "paper"},
    "paper": {"method": "uzawa", "slip_sum": "paper", "augmentation_norm": "paper"},
}


@dataclass
class Comparison:
    """Largest relative error of each quantity with the load step where it occurs, and what is wrong beyond that."""

    worst: dict[str, tuple[float, int]] = field(default_factory=dict)
    faults: list[str] = field(default_factory=list)
    steps: int = 0

    def add(self, quantity: str, step: int, ours: Any, theirs: Any, scale: float) -> None:
        """Note the relative error of one quantity at one load step."""
        ours, theirs = np.asarray(ours, dtype=np.float64), np.asarray(theirs, dtype=np.float64)
        if ours.shape != theirs.shape or not (np.isfinite(ours).all() and np.isfinite(theirs).all()):
            self.faults.append(f"step {step}: {quantity} is {ours.tolist()}, the reference's {theirs.tolist()}")
            return
        difference = float(np.linalg.norm(ours - theirs))
        error = difference / scale if scale > 0.0 else (0.0 if difference == 0.0 else np.inf)
        if quantity not in self.worst or error > self.worst[quantity][0]:
            self.worst[quantity] = (error, step)

    def count(self, quantity: str, step: int, ours: int, theirs: int) -> None:
        """Note a number that must be equal; its error is the difference."""
        self.add(quantity, step, ours, theirs, 1.0)

    def holds(self, tolerance: float) -> bool:
        """Whether everything was there and within the tolerance."""
        return not self.faults and self.steps > 0 and all(error <= tolerance for error, _ in self.worst.values())


def compare(source: Path, settings: Iterable[str], folder: Path) -> Comparison:
    """Run one explicit scene and compare it with the result beside it.

    Parameters
    ----------
    source : Path
        ``NAME.json``.
    settings : iterable of str
        Overrides of the converted scene, ``solver.key=value``.
    folder : Path
        For the scene file and its geometry files.
    """
    reference = json.loads(source.with_suffix(".result.json").read_text(encoding="utf-8"))
    completed = reference.get("completed", True)
    comparison = Comparison()
    simulation = Simulation(Scene.load(convert(source, folder), settings).problem())
    records = reference["records"]
    if completed and len(records) != simulation.problem.total_steps:
        comparison.faults.append(f"the reference has {len(records)} load steps, the scene {simulation.problem.total_steps}")
    results: list[StepResult] = []
    try:
        results.extend(islice(simulation.run(), len(records)))
    except IsomortarError as error:
        comparison.faults.append(str(error))
    if len(results) != len(records):
        comparison.faults.append(f"the run has {len(results)} load steps, the reference {len(records)}")
        return comparison
    comparison.steps = len(results)
    diagonal = simulation.equilibrium.numbering.size
    compare_steps(comparison, results, records, diagonal)
    if completed:
        slave_points = np.concatenate([np.zeros(0, np.int32), *(pair.pair.slave.point for pair in simulation.equilibrium.pairs)])
        compare_end(comparison, results[-1], reference["final"], slave_points, diagonal)
    return comparison


def compare_steps(comparison: Comparison, results: Sequence[StepResult], records: Sequence[dict[str, Any]], diagonal: float) -> None:
    """Compare what was recorded at every load step."""
    force_floor = FLOOR * max(float(np.linalg.norm(bc["force"])) for record in records for bc in record["bcs"])
    pressure_floor = FLOOR * max(float(np.max(record["p_control"])) for record in records)
    for result, record in zip(results, records, strict=True):
        step = result.step
        comparison.count("load time", step, int(result.time), record["t"])
        for reaction, bc in zip(result.reactions, record["bcs"], strict=True):
            comparison.add("force", step, reaction.force, bc["force"], max(float(np.linalg.norm(bc["force"])), force_floor))
            scale = max(float(np.linalg.norm(bc["moment"])), force_floor * diagonal)
            comparison.add("moment", step, reaction.moment, bc["moment"], scale)
        for contact, state in zip(result.contacts, result.state.contacts, strict=True):
            comparison.count("active", step, contact.active, record["n_active"])
            comparison.count("slip", step, contact.slip, record["n_slip"])
            comparison.count("excluded", step, contact.excluded, record["n_excluded_points"])
            extremes = [state.pressure.min(), state.pressure.max()]
            for quantity, ours, theirs in (
                ("p control", extremes, record["p_control"]),
                ("p field", contact.pressure_field, record["p_field_qp"]),
            ):
                comparison.add(quantity, step, ours, theirs, max(float(np.max(np.abs(theirs))), pressure_floor))
            largest = record["tau_norm_max"]
            comparison.add("traction", step, contact.traction_norm.max(), largest, max(abs(largest), pressure_floor))


def compare_end(comparison: Comparison, result: StepResult, final: dict[str, Any], slave_points: np.ndarray, diagonal: float) -> None:
    """Compare positions and multipliers after the last load step."""
    step = result.step
    positions = np.asarray(final["x"], dtype=np.float64)
    if positions.shape != result.state.positions.shape:
        comparison.faults.append(f"the run has {len(result.state.positions)} control points, the reference {len(positions)}")
        return
    farthest = int(np.argmax(np.linalg.norm(result.state.positions - positions, axis=1)))
    comparison.add("end positions", step, result.state.positions[farthest], positions[farthest], diagonal)
    if not result.state.contacts:
        return
    (state,) = result.state.contacts
    nodes = np.asarray(final.get("slave_nodes", sorted(slave_points)))
    if sorted(nodes) != sorted(slave_points):
        comparison.faults.append("the slave control points differ")
        return
    order = np.argsort(slave_points)[np.searchsorted(np.sort(slave_points), nodes)]
    for quantity, ours, key in (("end pressures", state.pressure, "p_control"), ("end tractions", state.traction, "tau_control")):
        theirs = np.asarray(final[key], dtype=np.float64)
        where = np.unravel_index(np.argmax(np.abs(ours[order] - theirs)), theirs.shape)
        comparison.add(quantity, step, ours[order][where], theirs[where], float(np.abs(theirs).max()))


def table(comparison: Comparison) -> list[str]:
    """Errors by quantity, one a line."""
    return [f"    {quantity:<14} {error:9.2e}  step {step}" for quantity, (error, step) in comparison.worst.items()]


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sources", type=Path, nargs="+", help="explicit scenes (results among them are passed over)")
    parser.add_argument("--like", choices=SETTINGS, default="local", help="settings of the reference's group (default: %(default)s)")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="more settings, as for isomortar run")
    parser.add_argument("--tolerance", type=float, default=1e-6, help="largest relative error (default: %(default)g)")
    parser.add_argument("--folder", type=Path, help="keep the converted scenes here")
    options = parser.parse_args()
    settings = [f"solver.{key}={value}" for key, value in SETTINGS[options.like].items()] + options.set
    scenes = [source for source in options.sources if not source.name.endswith(".result.json")]
    if not scenes:
        parser.error("these are results: name the scenes that they are of, NAME.json")
    failures = 0
    for source in scenes:
        start = perf_counter()
        with TemporaryDirectory() as temporary:
            try:
                comparison = compare(source, settings, options.folder / source.stem if options.folder else Path(temporary))
            except (IsomortarError, OSError, KeyError, TypeError, ValueError) as error:
                comparison = Comparison(faults=[f"cannot be compared: {type(error).__name__}: {error}"])
        holds = comparison.holds(options.tolerance)
        failures += not holds
        print(f"{source.stem:<18} {'holds' if holds else 'FAILS'}  {comparison.steps:3d} steps {perf_counter() - start:7.1f} s")
        print("\n".join([*table(comparison), *(f"    {fault}" for fault in comparison.faults)]), flush=True)
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
