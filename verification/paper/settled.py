"""Over-refined curves of the sections, stored as a reference, and how far runs are from them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from paper.outcome import Outcome

from isomortar.accuracy.measures import curve_error
from isomortar.geometry.patch import FloatArray
from isomortar.harness.references import Reference

#: Folder below the references, and the dataset of a section there (``verification/paper_curves``).
NAME, DATASET = "paper_curves", "study={scene}/curve"


@dataclass(frozen=True)
class Settled:
    """The curve of a section after its load steps, shape (load steps,), and its relative uncertainty."""

    curve: FloatArray
    uncertainty: float

    def distance(self, outcome: Outcome) -> float | None:
        """L2 distance of a run over the section's window, relative; None where it did not come to its end.

        Standard load steps stand at equal distances in the last stage, whatever the number of those of the run.
        """
        if outcome.failure:
            return None
        section = outcome.section
        last = section.load(section.variants[0], "monolithic").tables.stages[-1].steps
        if last > len(self.curve):
            return None
        shares, window = np.arange(1, last + 1) / last, outcome.window
        return curve_error(outcome.array("share")[window], outcome.curve[window], shares, self.curve[-last:])


def settled_curves(references: Path) -> Mapping[str, Settled]:
    """By scene, of those that have settled; empty where the folder has no such reference.

    Raises
    ------
    InputError
        It is damaged.
    """
    if not (references / NAME / "record.toml").exists():
        return {}
    reference = Reference(references / NAME)
    found = {scene: reference.dataset(DATASET.format(scene=scene)) for scene in ("press", "twist", "tire")}
    return {
        scene: Settled(expected.values, float(expected.uncertainty.max() / np.abs(expected.values).max()))
        for scene, expected in found.items()
        if expected
    }
