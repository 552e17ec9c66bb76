"""Keep what a trade found: its truth and front as a reference, what it recommends as scenes that the nightly tier runs again.

    isomortar trade press --want force.top.z --within 5% --within 1% --within 0.1%
    python verification/keep_front.py results/trade-press

What was kept of a trade of the same scene before is replaced. The family `fronts` compares by the curve that was wanted, and
shows what the recommended scenes cost by then.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np

from isomortar.errors import InputError
from isomortar.geometry.patch import FloatArray
from isomortar.harness.references import write_reference
from isomortar.trade.model import NOISE

#: Where recommended scenes and truths are kept.
FOLDER = Path(__file__).parent / "fronts" / "recommended"
REFERENCES = Path(__file__).parents[1] / "reference_data"
#: Quantities whose curves are kept, and all numbers that these are compared by.
CURVES = ("force", "moment")
KEPT = ("time", *CURVES)


def keep(trade: Path, references: Path, scenes: Path) -> list[Path]:
    """Write the reference of a trade's folder below `references` and its recommended scenes to `scenes`; returns what was written.

    Raises
    ------
    InputError
        There is no report of a trade, or what it wanted is not one curve of a force or moment.
    """
    try:
        report = json.loads((trade / "report.json").read_text())
        (want,), scene = report["wanted"], report["scene"]
    except (OSError, KeyError, ValueError) as error:
        raise InputError(f"holds no report of a trade by one curve: {error}", str(trade)) from None
    if not want.startswith(CURVES):
        raise InputError(f"is a trade by {want}; kept are curves of {' and '.join(CURVES)}", str(trade))
    folder = references / f"front-{scene}"
    write_reference(folder, _datasets(report), _record(report, want))
    recommended = {f"{scene}-{path.stem}.toml": path.read_text() for path in sorted(trade.glob("within-*-percent.toml"))}
    for stale in scenes.glob(f"{scene}-within-*.toml"):
        stale.unlink()
    for name, text in recommended.items():
        (scenes / name).write_text(text)
    return [folder, *(scenes / name for name in recommended)]


def _datasets(report: dict[str, Any]) -> dict[str, tuple[FloatArray, float]]:
    """The truth's numbers, worth what over-refined runs differ by, and the front."""
    truth = {key: np.array(report["truth"][key], float) for key in KEPT}
    seconds = np.array([run["cpu_seconds"] for run in report["front"]])
    return {
        **{key: (values, report["uncertainty"] * float(np.abs(values).max()) if key in CURVES else 0.0) for key, values in truth.items()},
        "front/error": (np.array([run["error"] for run in report["front"]]), report["uncertainty"]),
        "front/cpu_seconds": (seconds, NOISE * float(seconds.max())),
    }


def _record(report: dict[str, Any], want: str) -> dict[str, str]:
    return {
        "title": f"What the trade of {report['scene']} found for {want}",
        "class": "over-refined",
        "origin": f"isomortar trade, program {report['program'][:12]}; {report['compiler']}",
        "made": f"{report['started']}; kept by verification/keep_front.py",
        "uncertainty": f"{report['uncertainty']:.2g} of the curve: what over-refined runs of other orders and meshes differ by",
        "wanted": want,
    }


def main() -> None:
    """Keep the trades of some folders."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("trade", type=Path, nargs="+", help="folder of a trade: results/trade-NAME")
    for trade in parser.parse_args().trade:
        print("\n".join(map(str, keep(trade, REFERENCES, FOLDER))))


if __name__ == "__main__":
    main()
