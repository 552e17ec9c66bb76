"""Tables that the kernel's handles stand for slots of: every slot is given out, and none of them twice at a time."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from isomortar._codes import Status
from isomortar._compiled import kernel, kernel_at
from isomortar.harness import Bound, case

#: Of a table that is not filled, so many slots are taken; every so many of those taken are let go again.
SOME, EACH = 500, 7
#: How often one slot is let go and taken again: more often than eight bits count, so that its generations come round at none of theirs.
TURNS = 300


@dataclass(frozen=True)
class Table:
    """A table of handles: slot number s in generation g has the handle g * slots + s."""

    slots: int
    first_generation: int
    #: What takes a slot of a library's table: handle and status; and what lets it go: status.
    keep: Callable[[Any], tuple[int, int]]
    release: Callable[[Any, int], int]


def _keep(library: Any) -> tuple[int, int]:
    handle, status = library.keep_pattern(np.array([0, 1], dtype=np.int32), np.zeros(1, dtype=np.int32))
    return handle, status


def _analyse(library: Any) -> tuple[int, int]:
    handle, _, _, status = library.sparse_analyse(np.array([0, 1]), np.zeros(1, dtype=np.int64), False, 1e9)
    return handle, status


#: isomortar_api_descriptors, isomortar_sparse_factorisation.
TABLES = {
    "descriptors": Table(65536, 0, _keep, lambda library, handle: int(library.release_descriptor(handle))),
    "factorisations": Table(1024, 1, _analyse, lambda library, handle: int(library.sparse_release(handle))),
}


def without_handles(folder: Path) -> Any:
    """A kernel that has given out no handle: a copy of the file is loaded as another library."""
    return kernel_at(Path(shutil.copy2(str(kernel.__file__), folder)), kernel)


_BOUNDS = {
    "first": Bound(0.0, 0.0, "definition: handles other than those of slots 0, 1, 2, ... in the first generation"),
    "again": Bound(0.0, 0.0, "definition: handles other than those of the slots that were let go, the lowest first, one generation on"),
    "stale": Bound(0.0, 0.0, "definition: handles that were let go, or never given out, and are not refused"),
    "turns": Bound(0.0, 0.0, "definition: handles of one slot, let go and taken over and over, other than one generation on, or not stale"),
}
_FULL = {"beyond": Bound(0.0, 0.0, "definition: calls that a full table does not answer with the status of no memory")}


@case(
    claim="Slots are given out from the lowest that is free up to the last; a full table refuses; what was let go is stale for good, and "
    "its slot is given out again in another generation.",
    grid={"table": list(TABLES), "filled": [False, True]},
    bounds=lambda table, filled: _BOUNDS | (_FULL if filled else {}),  # noqa: ARG005
)
def slots(table: str, filled: bool) -> dict[str, float]:
    """How many handles are not what they should be, when a table is filled, or a part of it, and slots are let go and taken again."""
    one = TABLES[table]
    first = [one.first_generation * one.slots + slot for slot in range(one.slots if filled else SOME)]
    gone = first[::EACH]
    again = [handle + one.slots for handle in gone]
    never = [first[0] - one.slots, first[-1] + one.slots, *([] if filled else [first[-1] + 1])]
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        library = without_handles(Path(folder))
        found["first"] = sum(one.keep(library) != (handle, Status.OK) for handle in first)
        if filled:
            found["beyond"] = sum(one.keep(library)[1] != Status.OUT_OF_MEMORY for _ in range(3))
        refused = sum(one.release(library, handle) != Status.OK for handle in gone[::-1])
        found["again"] = refused + sum(one.keep(library) != (handle, Status.OK) for handle in again)
        found["stale"] = sum(one.release(library, handle) != Status.STALE_HANDLE for handle in (*gone, *never))
        found["turns"] = turned(one, library, again[0])
        for handle in {*first, *again} - {*gone}:
            one.release(library, handle)
    return {name: float(number) for name, number in found.items()}


def turned(one: Table, library: Any, handle: int) -> int:
    """How many handles of the lowest slot are not what they should be, when it is let go and taken again over and over."""
    handles = [handle + turn * one.slots for turn in range(TURNS + 1)]
    refused = sum(one.release(library, old) != Status.OK or one.keep(library) != (new, Status.OK) for old, new in pairwise(handles))
    stale = sum(one.release(library, old) != Status.STALE_HANDLE for old in handles[:-1])
    return refused + stale + (one.release(library, handles[-1]) != Status.OK)
