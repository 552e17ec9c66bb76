"""What lets contacts bear more friction: a larger coefficient, or where the largest traction limits it, a larger one of these."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Contact

#: Share of all that friction can bear above which what limits it is named.
NAMED = 0.05


def more_friction(limits: Sequence[tuple[Contact, FloatArray, FloatArray]]) -> str:
    """Words for it.

    Parameters
    ----------
    limits : sequence of (Contact, ndarray, ndarray)
        For each contact the largest traction that each of its constraints can have, and what that adds to all that friction can bear.
    """
    capped = [float(parts[tractions >= (contact.traction_max or np.inf)].sum()) for contact, tractions, parts in limits]
    least = NAMED * (total := float(sum(parts.sum() for _, _, parts in limits)))
    ways = ["more friction"] if total - sum(capped) > least else []
    ways += [f"a larger contacts.{contact.name}.traction_max" for (contact, _, _), part in zip(limits, capped, strict=True) if part > least]
    return " or ".join(ways)
