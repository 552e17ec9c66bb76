"""Scenes that were drawn by lot come out as they did: that is no proof of what they are, but what changes them anywhere is seen.

They stand in `scenes/`, each with all that it is: another one is put there, and blessed. None is there that round-off changes by more
than a thousandth of what is allowed; those that are given up are judged by the load steps before, and by what is said.
"""

from __future__ import annotations

import re
import tempfile
import zlib
from pathlib import Path

import numpy as np

import isomortar
from isomortar.cli.check import lines
from isomortar.errors import ConvergenceError
from isomortar.geometry.patch import FloatArray
from isomortar.harness import Matches, case
from isomortar.march.outlook import outlook
from isomortar.results.reader import Results
from isomortar.results.table import columns
from isomortar.solve.record import Observer

FOLDER = Path(__file__).parent / "scenes"
SCENES = tuple(sorted(path.stem for path in FOLDER.glob("*.toml")))
#: Where curves belong, by the first part of their name, and the power of a length that they are divided by.
_KINDS = {
    **dict.fromkeys(("force", "force_slave", "force_master"), ("forces", 0)),
    **dict.fromkeys(("moment", "moment_slave", "moment_master", "friction_work", "spurious_work"), ("forces", 1)),
    **dict.fromkeys(("displacement", "centre"), ("places", 1)),
    "rotation": ("places", 0),
    "pressure_field": ("pressures", 0),
    **dict.fromkeys(("active", "slip", "excluded", "cuts", "substeps"), ("counts", 0)),
}
_SAME = "round-off: the same scene by the same program; other ways to the same solution end within Newton's tolerance"
_ITSELF = "definition: the same points bear and slip, in the same load increments, and the same sentences are said"


@case(
    claim="Scenes drawn by lot have the forces, moments, work, motions, pressures and active sets that they had, and are told the same.",
    grid={"scene": SCENES},
    bounds={
        **{name: Matches("unchanged", _SAME, allowance=1e-6) for name in ("forces", "places", "pressures")},
        **{name: Matches("unchanged", _ITSELF) for name in ("counts", "said")},
    },
    files=tuple(FOLDER.rglob("*.toml")),
)
def runs(scene: str) -> dict[str, FloatArray]:
    """All curves of a run by kind, forces with moments and work over the size of the scene, and check sums of what is said."""
    given = isomortar.Scene.load(str(FOLDER / f"{scene}.toml"))
    said = list(lines(outlook(given.problem())))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "results.h5"
        try:
            isomortar.run(given, path, Observer()).close()
        except ConvergenceError as error:
            said.append(str(error))
        with Results(path) as results:
            said += results.warnings
            return {**_curves(results), "said": np.array([_sum(sentence) for sentence in said])}


def _curves(results: Results) -> dict[str, FloatArray]:
    """Numbers of one kind in one array each, so that round-off of what is nothing is beside what is not."""
    size = float(np.ptp(np.vstack([body.patch.control_points for body in results.problem.bodies]), axis=0).max())
    kinds: dict[str, list[FloatArray]] = {"forces": [], "places": [np.ones(1)], "pressures": [], "counts": [np.ones(1)]}
    for name, values in columns(results).items():
        kind, over = _KINDS.get(name.partition(".")[0], (None, 0))
        if kind is not None:
            kinds[kind].append(values / size**over)
    positions = results.step(int(results.steps[-1])).state.positions
    kinds["places"] += [np.mean(positions, axis=0) / size, np.std(positions, axis=0) / size]
    return {kind: np.concatenate(values) for kind, values in kinds.items()}


def _sum(sentence: str) -> float:
    """A check sum of a sentence but for its numbers, whose last digits round-off may change."""
    return float(zlib.crc32(re.sub(r"[-+0-9.]+(e[-+]?[0-9]+)?( [0-9]{3}(?![0-9]))*", "0", sentence).encode()))
