"""Laws that the kernel does not have: refused, and nothing is kept of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from isomortar._codes import Status
from isomortar._compiled import kernel
from isomortar.harness import Bound, case

#: What keeps a law of each kind, and how many parameters each takes, by number.
KEEP: dict[str, Callable[..., Any]] = {"material": kernel.keep_material, "friction": kernel.keep_friction}
TAKES = {"material": {1: 2, 2: 2, 3: 2}, "friction": {1: 1, 2: 3}}
#: Numbers of laws, and of parameters, that are tried.
NUMBERS, MOST = range(-2, 8), 5


@case(
    claim="A law is kept where there is one of that number with so many parameters; otherwise it is refused as no such law.",
    grid={"kind": list(KEEP)},
    bounds={
        "accepted": Bound(0.0, 0.0, "definition: laws that are not there and are not refused, or for another reason, or have a handle"),
        "refused": Bound(0.0, 0.0, "definition: laws that are there and are refused"),
    },
)
def laws(kind: str) -> dict[str, float]:
    """How many get the wrong answer."""
    accepted = refused = 0
    for number in NUMBERS:
        for count in range(1, MOST + 1):
            handle, status = KEEP[kind](number, np.full(count, 0.3))
            if TAKES[kind].get(number) == count:
                refused += status != Status.OK
            else:
                accepted += status != Status.NO_SUCH_LAW or handle != -1
            if handle != -1:
                kernel.release_descriptor(handle)
    return {"accepted": float(accepted), "refused": float(refused)}
