"""Handles of what the kernel is handed once: patches, bodies, laws, slave sides, masters, patterns (isomortar_api_descriptors)."""

from __future__ import annotations

import weakref
from collections.abc import Callable
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np

from isomortar import _arguments as check
from isomortar._arrays import (
    AveragedFaceArrays,
    BodyArrays,
    FaceArrays,
    FrictionArrays,
    MaterialArrays,
    PatchArrays,
    Pattern,
    PlaneArrays,
    SlaveArrays,
)
from isomortar._codes import Status
from isomortar.errors import KernelError


class Descriptors:
    """What a compiled library holds for arrays: handed over when first asked for, and let go with them.

    The library keeps a copy: the arrays must not change once they were used.

    Parameters
    ----------
    library : module
        The kernel, or its extended-precision twin.
    """

    def __init__(self, library: Any) -> None:
        self._library = library
        self._handles: WeakKeyDictionary[Any, int] = WeakKeyDictionary()
        self._keepers: dict[type, Callable[[Any], tuple[int, int]]] = {
            PatchArrays: self._patch,
            BodyArrays: self._body,
            MaterialArrays: self._law_by(library.keep_material),
            FrictionArrays: self._law_by(library.keep_friction),
            PlaneArrays: lambda plane: library.keep_plane(plane.origin, plane.normal, plane.tangent),
            FaceArrays: self._face,
            AveragedFaceArrays: self._face,
            SlaveArrays: self._slave,
            Pattern: lambda pattern: library.keep_pattern(pattern.start, pattern.column),
        }

    def handle(self, name: str, arrays: Any, *allowed: type) -> int:
        """The library's handle of some arrays, which are the argument `name` and must be of an allowed type.

        Raises
        ------
        InputError
            They are not.
        KernelError
            No law has that number and so many parameters; memory ran out; too many descriptors are alive.
        """
        check.kind(name, arrays, *allowed)
        handle = self._handles.get(arrays)
        if handle is None:
            handle, status = self._keepers[type(arrays)](arrays)
            if status:
                raise KernelError(_REFUSALS[Status(status)])
            self._handles[arrays] = handle
            weakref.finalize(arrays, self._library.release_descriptor, handle).atexit = False
        return handle

    def _patch(self, patch: PatchArrays) -> tuple[int, int]:
        found: tuple[int, int] = self._library.keep_patch(
            patch.families, patch.orders, patch.counts, patch.knots, patch.point, patch.weight
        )
        return found

    def _body(self, body: BodyArrays) -> tuple[int, int]:
        patch, gauss = self.handle("patch", body.patch, PatchArrays), np.asarray(body.gauss, np.int32)
        found: tuple[int, int] = self._library.keep_body(patch, gauss, body.reference.T, int(body.often))
        return found

    def _slave(self, slave: SlaveArrays) -> tuple[int, int]:
        shape, test = slave.shape, slave.test
        found: tuple[int, int] = self._library.keep_slave(
            shape.nodes.T, shape.values.T, slave.slopes.T, test.nodes.T, test.values.T, test.count, slave.area, slave.point, slave.outward
        )
        return found

    def _face(self, face: FaceArrays) -> tuple[int, int]:
        averaged = isinstance(face, AveragedFaceArrays)
        patch = self.handle("patch", face.patch, PatchArrays)
        found: tuple[int, int] = self._library.keep_face(patch, face.axis, face.side, averaged, face.brim, face.mirror.T)
        return found

    @staticmethod
    def _law_by(keeper: Callable[..., tuple[int, int]]) -> Callable[[Any], tuple[int, int]]:
        return lambda law: keeper(law.law, law.parameters)


_REFUSALS = {
    Status.NO_SUCH_LAW: "no law of material or friction has that number and so many parameters",
    Status.OUT_OF_MEMORY: "memory ran out, or too many patches, bodies, laws, contacts and patterns are alive: let some go",
    Status.STALE_HANDLE: "the patch of a face or a body was released before",
}
