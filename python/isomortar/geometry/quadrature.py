"""Default numbers of Gauss points: Table 1 of Temizer (2012), and ours where it has none (theory 2)."""

from __future__ import annotations

from isomortar.geometry.patch import Direction, Family

_VOLUME: dict[Family, tuple[int, ...]] = {"N": (2, 4, 6, 6, 7), "L": (2, 4, 4, 6)}
_CONTACT: dict[Family, tuple[int, ...]] = {"N": (4, 6, 6, 6, 7), "L": (4, 4, 9, 12)}


def volume_points(direction: Direction) -> int:
    """Gauss points per volume element along a direction; orders above the table take order + 2."""
    return _by_order(_VOLUME, direction)


def contact_points(direction: Direction) -> int:
    """Gauss points per contact element along a surface direction; orders above the table take order + 2."""
    return _by_order(_CONTACT, direction)


def _by_order(table: dict[Family, tuple[int, ...]], direction: Direction) -> int:
    row = table[direction.family]
    return row[direction.order - 1] if direction.order <= len(row) else direction.order + 2


def load_points(direction: Direction) -> int:
    """Gauss points per element of a loaded face along a direction: what is polynomial is exact (theory 5.15), with one more for weights."""
    return (3 * direction.order + 1) // 2 + 1
