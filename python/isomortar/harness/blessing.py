"""Blessing: the numbers of a green run become the reference that later runs are compared with."""

from __future__ import annotations

import getpass
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Literal

import numpy as np

from isomortar._frozen import frozen
from isomortar.errors import InputError
from isomortar.geometry.patch import FloatArray
from isomortar.harness import svg
from isomortar.harness.cases import Case, Cell, Curve, Matches, Words
from isomortar.harness.compare import Lookup
from isomortar.harness.measurement import restored
from isomortar.harness.references import Reference, dataset_name, made_by, write_reference
from isomortar.harness.report import template
from isomortar.harness.runner import Result
from isomortar.harness.store import identity
from isomortar.harness.wording import reworded
from isomortar.results.files import write_whole

#: The number of a cell by which it states how far off its others are, relative to their largest values, measured by two refinements.
MEASURED = "uncertainty"


@frozen
class Change:
    """What blessing one number changes: new values, the old ones (None: there were none) and their uncertainty.

    `x`: what the values are shown over, shape (entries,): a curve's own, else the number of the entry. `measured`: relative uncertainty
    of the new values by the cell's own number of that name; NaN: it has none.
    """

    cell: Cell
    number: str
    reference: str
    new: FloatArray
    old: FloatArray | None
    old_uncertainty: float
    x: FloatArray
    x_label: str
    measured: float

    @property
    def difference(self) -> float:
        """Largest absolute difference; NaN where there is nothing to compare with, infinity where shapes differ."""
        if self.old is None:
            return np.nan
        return float(np.abs(self.new - self.old).max()) if self.new.shape == self.old.shape else np.inf


@frozen
class Rewording:
    """What blessing words changes: the new text, and the old one (None: there was none)."""

    cell: Cell
    number: str
    reference: str
    new: str
    old: str | None

    @property
    def lines(self) -> list[str]:
        """What is not as it was, to the last digit; all of it where there was nothing."""
        return reworded(self.old or "", self.new, 0.0)


def changes(results: Sequence[Result], lookup: Lookup) -> list[Change | Rewording]:
    """What blessing these results changes.

    Raises
    ------
    InputError
        The run is not green but for its references, a number could be no reference, or the case is compared with none.
    """
    found: list[Change | Rewording] = []
    for result in results:
        claims = result.cell.case.bounds_of(result.cell.settings)
        known = result.measurement.numbers.get(MEASURED)
        measured = known if isinstance(known, float) else np.nan
        for check in result.checks:
            claim = claims.get(check.name)
            if not isinstance(claim, Matches):
                if check.state != "passed":
                    raise InputError(f"{check.state} ({check.found}): only a green run can be blessed", f"{result.cell.name}.{check.name}")
                continue
            if result.measurement.ending != "measured" or check.state == "not measured":
                raise InputError("was not measured: only a green run can be blessed", f"{result.cell.name}.{check.name}")
            value = result.measurement.numbers[check.name]
            if (said := restored(value, Words)) is not None:
                if not said.text.strip():
                    raise InputError("says nothing: it can be no reference", f"{result.cell.name}.{check.name}")
                known_words = lookup(claim.reference, result.cell, check.name)
                found.append(Rewording(result.cell, check.name, claim.reference, said.text, known_words.text if known_words else None))
                continue
            curve = restored(value, Curve)
            new = np.asarray(value if curve is None else curve.y, float)
            if not (new.size and np.isfinite(new).all()):
                raise InputError("is empty or not finite: it can be no reference", f"{result.cell.name}.{check.name}")
            old = lookup(claim.reference, result.cell, check.name)
            worth = float(old.uncertainty.max()) if old else np.nan
            x, label = (np.asarray(curve.x, float), curve.x_label) if curve else (np.arange(float(new.size)), "entry")
            found.append(Change(result.cell, check.name, claim.reference, new, old.values if old else None, worth, x, label, measured))
    if not found:
        raise InputError("is compared with no reference: none of its bounds is Matches", results[0].cell.case.name)
    return found


def picture(folder: Path, case: Case, found: Sequence[Change | Rewording]) -> Path:
    """Write a page of pictures to a folder: of each number the new values over the old ones, and below what they differ by.

    Of words the lines that are others.
    """
    path = folder / f"bless-{case.family}-{case.function.__name__}.html"
    figures = [(change, _values(change), _differences(change)) for change in found if isinstance(change, Change)]
    words = [change for change in found if isinstance(change, Rewording)]
    write_whole(path, template("blessing.html").render(case=case, figures=figures, words=words))
    return path


def _values(change: Change) -> str:
    lines = [svg.Line("new", change.x, change.new.ravel())]
    if change.old is not None:
        x = change.x if change.old.size == change.x.size else np.arange(float(change.old.size))
        lines.append(svg.Line("old", x, change.old.ravel(), guide=True))
    return svg.plot(lines, change.x_label, change.number, False, False)


def _differences(change: Change) -> str:
    """New less old, between the old uncertainty; nothing where there is nothing to compare with."""
    if change.old is None or change.old.shape != change.new.shape:
        return ""
    apart = (change.new - change.old).ravel()
    limits = [svg.Line("", change.x, np.full(change.x.shape, side * change.old_uncertainty), guide=True) for side in (-1, 1)]
    return svg.plot([svg.Line("new - old", change.x, apart), *limits], change.x_label, "difference", False, False)


def bless(
    case: Case, found: Sequence[Change | Rewording], folder: Path, reason: str, kind: Literal["self", "over-refined"], uncertainty: float
) -> list[Path]:
    """Write the references that a case is compared with; `uncertainty` is relative to each number's largest value.

    One of class ``over-refined`` speaks of correctness: every cell must itself have measured how far off it is (a number `MEASURED`, from
    two refinements, say), and what it found counts where it is more than `uncertainty`.

    Returns
    -------
    list of Path
        The folders written.

    Raises
    ------
    InputError
        No reason, no uncertainty, one that was not measured, or a reference that is worth more than a run of this program.
    """
    if not reason.strip():
        raise InputError("say why the new numbers are right", "reason")
    if not (np.isfinite(uncertainty) and uncertainty > 0):
        raise InputError(f"is {uncertainty}; must be positive: no run is exact", "uncertainty")
    shares = {change.cell.name: uncertainty if kind == "self" else max(uncertainty, _measured(change)) for change in found}
    written, made = [], identity()
    for name in dict.fromkeys(change.reference for change in found):
        mine = [change for change in found if change.reference == name]
        if (folder / name / "record.toml").exists() and Reference(folder / name).record["class"] in ("exact", "other code"):
            raise InputError("is exact or of another program; a run of this program does not replace it", str(folder / name))
        datasets = {dataset_name(c.cell, c.number): (c.new, shares[c.cell.name] * _largest(c.new)) for c in mine}
        record = {
            "title": case.claim,
            "class": kind,
            "origin": f"This program: case {case.name}",
            "made": made_by(case),
            "uncertainty": f"{max(shares.values()):g} of the largest value of each number"
            + ("" if kind == "self" else " or less, as measured"),
            "reason": reason,
            "who": getpass.getuser(),
            "when": datetime.now(UTC).isoformat(timespec="seconds"),
            **{what: str(made[what]) for what in ("kernel", "program", "compiler")},
            "libraries": ", ".join(f"{what} {version}" for what, version in made["libraries"].items()),
        }
        write_reference(folder / name, datasets, record)
        written.append(folder / name)
    return written


def _largest(values: FloatArray | str) -> float:
    """What an uncertainty is relative to; that of words, in each line to its own numbers."""
    return 1.0 if isinstance(values, str) else float(np.abs(values).max())


def _measured(change: Change | Rewording) -> float:
    """The uncertainty that the cell itself measured, relative.

    Raises
    ------
    InputError
        It measured none.
    """
    if isinstance(change, Rewording) or not (np.isfinite(change.measured) and change.measured > 0):
        raise InputError(
            f"has no positive number {MEASURED!r}, measured by the case (as by two refinements): without it a run is of class self",
            change.cell.name,
        )
    return change.measured
