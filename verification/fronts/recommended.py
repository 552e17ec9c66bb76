"""What a trade recommended, run again: as near to its truth as it was, and what that costs by now.

`verification/keep_front.py` keeps what `isomortar trade` found: the scenes in `recommended`, the truth in `reference_data/front-SCENE`.
"""

from __future__ import annotations

import re
from typing import Any

from keep_front import FOLDER, KEPT, REFERENCES

from isomortar.harness import Bound, Shown, case
from isomortar.harness.references import Reference
from isomortar.scene import Scene
from isomortar.trade import run as trades
from isomortar.trade.laboratory import Tried
from isomortar.trade.model import Yardstick
from isomortar.trade.want import wanted

#: ``press-within-1-percent``: the scene, and the target in per cent.
_NAME = re.compile(r"(?P<scene>.+)-within-(?P<percent>[\d.]+)-percent")
NAMES = tuple(sorted(path.stem for path in FOLDER.glob("*.toml")))


def target(name: str) -> float:
    """The largest error that what is called so may have."""
    found = _NAME.fullmatch(name)
    assert found, f"{name} says no target"
    return float(found["percent"]) / 100.0


def truth_of(name: str) -> Reference:
    """What is kept of the trade that recommended it."""
    found = _NAME.fullmatch(name)
    assert found, f"{name} says no scene"
    return Reference(REFERENCES / f"front-{found['scene']}")


@case(
    claim="Settings that were recommended for an accuracy have it: the curve that is wanted is as near as that to what an over-refined run "
    "gave. What they cost is shown, night after night.",
    tier="nightly",
    grid={"name": NAMES},
    bounds=lambda name: {
        "error": Bound(at_most=target(name), reason="definition: the target that they were recommended for"),
        "cpu_seconds": Shown("of the computation"),
        "unknowns": Shown("positions"),
        "solves": Shown("linear solves of all load steps"),
    },
    files=[*FOLDER.glob("*.toml"), *REFERENCES.glob("front-*/data.h5")],
)
def recommended(name: str) -> dict[str, float]:
    """Compute the scene; compare what is wanted with the truth as the trade did."""
    kept = truth_of(name)
    truth = _tried({key: expected.values for key in KEPT if (expected := kept.dataset(key))})
    path = FOLDER / f"{name}.toml"
    want = wanted(kept.record["wanted"], Scene.load(path).problem())
    run = trades.traded.function(str(path))
    return {
        "error": Yardstick(want, truth, truth).error(_tried(dict(run))),
        **{key: run[key] for key in ("cpu_seconds", "unknowns", "solves")},
    }


def _tried(numbers: dict[str, Any]) -> Tried:
    return Tried((), "", numbers, "", 0.0, 0.0)
