"""Statuses that the kernel returns, as exceptions."""

from __future__ import annotations

import math
from typing import NoReturn

from isomortar._codes import Status
from isomortar.errors import FoldedElementError, KernelError, LostProjectionError, PassedThroughError


def raise_status(status: int, place: int, jacobian: float = math.nan) -> NoReturn:
    """Raise the exception of a status; `place` counts from 0, `jacobian` is the J of a folded element."""
    folded = "J <= 0" if math.isnan(jacobian) else f"J = {jacobian:.3g}" if jacobian else "J = 0, flat but for round-off"
    sentences: dict[int, tuple[type[KernelError], str]] = {
        Status.FOLDED: (FoldedElementError, f"element {place} is folded ({folded})"),
        Status.FOLDED_INITIALLY: (FoldedElementError, f"element {place} is folded ({folded}) in the reference configuration"),
        Status.DEGENERATE_SURFACE: (
            LostProjectionError,
            f"the master has no normal at the closest point of slave quadrature point {place}",
        ),
        Status.PATTERN: (
            KernelError,
            f"a pattern does not fit what is added to it: block missing in row {place} (-1: it has other rows)",
        ),
        Status.NOT_FINITE: (LostProjectionError, f"the position of control point {place} is not finite"),
        Status.PASSED_THROUGH: (PassedThroughError, f"slave quadrature point {place} has passed through the master's body"),
    }
    kind, sentence = sentences.get(status, (KernelError, f"the kernel returned status {Status(status).name} at {place}"))
    raise kind(sentence, place)
