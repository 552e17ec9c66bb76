"""Handles of one kind in the place of another: refused as those are that were let go."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from isomortar._codes import Status
from isomortar._compiled import kernel
from isomortar.harness import Bound, case

_PRESSURE = np.ones(2)
_KNOTS = np.array([0.0, 0.0, 1.0, 1.0] * 3)


def _patch() -> int:
    numbers = np.arange(8, dtype=np.int32)
    return int(kernel.keep_patch(np.ones(3, np.int32), np.ones(3, np.int32), np.full(3, 2, np.int32), _KNOTS, numbers, np.ones(8))[0])


def _body() -> int:
    """Of a cube."""
    patch = _patch()
    corners = np.indices((2, 2, 2))[::-1].reshape(3, 8).astype(np.float64)
    handle = int(kernel.keep_body(patch, np.full(3, 2, np.int32), corners, 1)[0])
    kernel.release_descriptor(patch)
    return handle


#: What keeps a descriptor of each kind, and a call that asks for a body, a law of friction, a material: the status.
KEPT: dict[str, Callable[[], int]] = {
    "patch": _patch,
    "body": _body,
    "material": lambda: int(kernel.keep_material(1, np.array([2.0, 1.0]))[0]),
    "friction": lambda: int(kernel.keep_friction(1, np.array([0.3]))[0]),
    "pattern": lambda: int(kernel.keep_pattern(np.array([0, 1], dtype=np.int32), np.zeros(1, dtype=np.int32))[0]),
}
ASKED: dict[str, Callable[[int], int]] = {
    "body": lambda handle: int(kernel.control_volumes(handle, 8)[-2]),
    "friction": lambda handle: int(kernel.friction_radius(handle, _PRESSURE)[-1]),
    "material": lambda handle: int(kernel.material_stress(handle, np.zeros((3, 3, 1)))[-2]),
}


@case(
    claim="A handle of another kind is stale where a body, a law of friction or a material is asked for, and one of its own kind is not.",
    tier="gate",
    grid={"asked": list(ASKED)},
    bounds={
        "others": Bound(0.0, 0.0, "definition: handles of other kinds that are not refused"),
        "own": Bound(0.0, 0.0, "definition: handles of the kind that are refused"),
    },
)
def kinds(asked: str) -> dict[str, float]:
    """How many handles get the wrong answer."""
    handles: dict[str, Any] = {kind: keep() for kind, keep in KEPT.items()}
    status = {kind: ASKED[asked](handle) for kind, handle in handles.items()}
    for handle in handles.values():
        kernel.release_descriptor(handle)
    own = status.pop(asked)
    return {"others": float(sum(code != Status.STALE_HANDLE for code in status.values())), "own": float(own != Status.OK)}
