"""What a reference is taken for, and what of it is refused; what blessing writes."""

from __future__ import annotations

import tempfile
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from judge.runs import refused
from judge.ways import BOUNDS, WAYS, told

from isomortar.harness import Bound, Matches, case
from isomortar.harness.blessing import MEASURED, Change, bless, changes
from isomortar.harness.cases import Case, Cell
from isomortar.harness.compare import judge
from isomortar.harness.measurement import Measurement
from isomortar.harness.references import FIELDS, KINDS, Reference, finder, made_by, write_reference
from isomortar.harness.runner import Result

_KEPT = Matches("kept", "reference: as it was")
_SMALL = Bound(at_most=1.0, reason="theory: so")


def value() -> dict[str, float]:
    """Nothing: results are made by hand."""
    return {}


ONE = Cell(Case(value, "It is as it was.", {"value": _KEPT, MEASURED: _SMALL}, "gate", {}, None, ()), {"kind": "a/b"})
TWO = Cell(ONE.case, {"kind": "c"})


def record(**changes: str) -> dict[str, str]:
    """Of a reference, complete but for the hash."""
    return dict.fromkeys(FIELDS[:-1], "as it was") | {"class": "exact"} | changes


def result(cell: Cell, values: Any, uncertainty: float, folder: Path) -> Result:
    """A cell as it would have been measured."""
    measurement = Measurement("measured", {"value": values, MEASURED: uncertainty})
    return Result(cell, measurement, tuple(judge(cell, measurement, finder(folder))), True)


@case(
    claim="A reference is what was written, of the class that its record says, of class self for the case that made it; without a whole "
    "record, its own data, or an uncertainty it is none.",
    tier="gate",
    grid={"way": WAYS},
    bounds=BOUNDS,
)
def read_back(way: str) -> dict[str, float]:
    """How much is read otherwise, or should be refused."""
    wrong = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        datasets = {"a|b": (np.array([1.0, -3.0]), 0.5), "kind=a|b/value": (np.array([1.0, 2.0]), 0.1), "value": (np.array(7.0), 0.2)}
        for kind in KINDS:
            write_reference(folder / kind, datasets, record(**{"class": kind}))
            for at, made in (("value", Cell(ONE.case, {})), ("kind=a|b/value", ONE)):
                found = finder(folder)(kind, made, "value")
                values, worth = datasets[at]
                if not (found and np.array_equal(found.values, values) and found.uncertainty == worth and found.kind == kind):
                    wrong.append(f"{kind}, {at}: {found}")
            wrong += [f"{kind}, {cell.label}" for cell in (TWO,) if finder(folder)(kind, cell, "value") is not None]
            write_reference(folder / "own", datasets, record(**{"class": kind, "made": made_by(ONE.case)}))
            own = finder(folder)("own", ONE, "value")
            wrong += [f"own, {kind}"] * (own is None or own.kind != "self")
        wrong += ["none"] * (finder(folder)("none", ONE, "value") is not None)
        for field in FIELDS[:-1]:
            lacking = record(**{field: " "})
            wrong += [f"without {field}"] * (not refused(partial(write_reference, folder / "bad", datasets, lacking)))
        wrong += ["class"] * (not refused(lambda: write_reference(folder / "bad", datasets, record(**{"class": "good"}))))
        for bad, unsure in ((np.nan, 0.1), ([], 0.1), ([1.0, np.inf], 0.1), (1.0, np.nan), (1.0, -0.1), (1.0, np.inf), (1.0, [0.1, 0.1])):
            given: Any = {"value": (np.asarray(bad, float), unsure)}
            wrong += [f"{bad} with {unsure}"] * (not refused(partial(write_reference, folder / "bad", given, record())))
        data = folder / "exact/data.h5"
        content = data.read_bytes()
        data.write_bytes(content[:-1] + bytes([content[-1] ^ 1]))
        wrong += ["another hash"] * (not refused(lambda: Reference(folder / "exact")))
        with h5py.File(data, "w") as file:
            file["value"] = 7.0
        (folder / "exact/record.toml").write_text(
            (folder / "exact/record.toml").read_text().replace(_hash(content), _hash(data.read_bytes()))
        )
        wrong += ["no uncertainty"] * (not refused(lambda: Reference(folder / "exact")))
    return told(wrong, way)


def _hash(content: bytes) -> str:
    from hashlib import sha256

    return sha256(content).hexdigest()


@case(
    claim="Blessing writes the numbers of a green run with the larger of two uncertainties, tells what that changes, and replaces no "
    "reference that is worth more.",
    tier="gate",
    grid={"way": WAYS},
    bounds=BOUNDS,
)
def blessed(way: str) -> dict[str, float]:
    """How much is written or told otherwise."""
    wrong = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for kind, asked, worth in (
            ("self", 1e-3, (1e-3, 1e-3)),
            ("over-refined", 1e-3, (1e-2, 1e-3)),
            ("over-refined", 1e-1, (1e-1, 1e-1)),
        ):
            results = [result(ONE, [1.0, -3.0], 1e-2, folder), result(TWO, [2.0, 4.0], 1e-4, folder)]
            found = changes(results, finder(folder))
            bless(ONE.case, found, folder, "they are right", kind, asked)  # type: ignore[arg-type]
            for cell, values, share in ((ONE, [1.0, -3.0], worth[0]), (TWO, [2.0, 4.0], worth[1])):
                kept = Reference(folder / "kept").dataset(f"{cell.label.replace('/', '|')}/value")
                off = kept is None or not np.array_equal(kept.values, values) or kept.uncertainty != share * np.abs(values).max()
                wrong += [f"{kind} {asked}, {cell.label}: {kept}"] * bool(off or (kept and kept.kind != kind))
            wrong += ["made"] * (Reference(folder / "kept").record["made"] != made_by(ONE.case))
        change = next(of for of in changes([result(ONE, [1.5, -3.0], 1e-2, folder)], finder(folder)) if isinstance(of, Change))
        wrong += [f"{change}"] * (change.difference != 0.5 or change.old_uncertainty != 1e-1 * 3.0 or change.measured != 1e-2)
        for why, kind, asked in ((" ", "self", 1e-3), ("so", "self", 0.0), ("so", "self", np.nan), ("so", "self", -1.0)):
            wrong += [f"{why}, {asked}"] * (not refused(partial(bless, ONE.case, [change], folder, why, kind, asked)))  # type: ignore[arg-type]
        (unknown,) = changes([result(ONE, [1.5, -3.0], 0.0, folder)], finder(folder))
        wrong += ["not measured"] * (not refused(lambda: bless(ONE.case, [unknown], folder, "so", "over-refined", 1e-3)))
        for kind in ("exact", "other code"):
            write_reference(folder / "kept", {"value": (np.array(7.0), 0.2)}, record(**{"class": kind}))
            wrong += [kind] * (not refused(lambda: bless(ONE.case, [change], folder, "so", "self", 1e-3)))
        for ending in ("crashed", "not converged", "skipped"):
            lost = replace(result(ONE, [1.0], 1e-2, folder), measurement=Measurement(ending), checks=())
            lost = replace(lost, checks=tuple(judge(ONE, lost.measurement, finder(folder))))
            wrong += [ending] * (not refused(partial(changes, [lost], finder(folder))))
        half = Measurement("measured", {"value": [1.0]})
        part = Result(ONE, half, tuple(judge(ONE, half, finder(folder))), True)
        wrong += ["a number that is not there"] * (not refused(partial(changes, [part], finder(folder))))
        for values, uncertainty in (([], 1e-2), ([np.nan], 1e-2), ([1.0], 2.0), ([1.0], -1.0)):
            bad = result(ONE, values, uncertainty, folder)
            wrong += [f"{values}, {uncertainty}"] * (not refused(lambda bad=bad: changes([bad], finder(folder))))  # type: ignore[misc]
    return told(wrong, way)
