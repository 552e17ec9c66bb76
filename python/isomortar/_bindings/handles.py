"""The kernel's handles of the arrays that it is handed once: each raises an error that names the argument (`_descriptors`)."""

from __future__ import annotations

from isomortar._arrays import (
    BodyArrays,
    FaceArrays,
    FrictionArrays,
    MasterArrays,
    MaterialArrays,
    PatchArrays,
    Pattern,
    PlaneArrays,
    SlaveArrays,
)
from isomortar._compiled import kernel
from isomortar._descriptors import Descriptors

_DESCRIPTORS = Descriptors(kernel)


def patch(arrays: PatchArrays) -> int:
    """That of a patch."""
    return _DESCRIPTORS.handle("patch", arrays, PatchArrays)


def body(arrays: BodyArrays) -> int:
    """That of a body."""
    return _DESCRIPTORS.handle("body", arrays, BodyArrays)


def material(arrays: MaterialArrays) -> int:
    """That of a material."""
    return _DESCRIPTORS.handle("material", arrays, MaterialArrays)


def friction(name: str, arrays: FrictionArrays) -> int:
    """That of a law of friction, the argument `name`."""
    return _DESCRIPTORS.handle(name, arrays, FrictionArrays)


def slave(arrays: SlaveArrays) -> int:
    """That of a slave side."""
    return _DESCRIPTORS.handle("slave", arrays, SlaveArrays)


def master(arrays: MasterArrays) -> int:
    """That of a master."""
    return _DESCRIPTORS.handle("master", arrays, PlaneArrays, FaceArrays)


def pattern(name: str, arrays: Pattern) -> int:
    """That of a pattern, the argument `name`."""
    return _DESCRIPTORS.handle(name, arrays, Pattern)
