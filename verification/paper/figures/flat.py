"""The part of a slave face that is in contact laid flat, with a contact field over it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from paper.figures.picture import Panel

from isomortar.errors import InputError
from isomortar.geometry.patch import Direction, FloatArray
from isomortar.results.bezier import functions_at
from isomortar.results.fields import ContactSurface, contact_surfaces
from isomortar.results.gaps import gaps

Quantity = Literal["pressure", "traction", "traction_2", "gap"]
#: Where the gap is shown: pressure over its largest value. Beside the contact it grows at once to many times what it is inside.
CONTACT_ZONE = 0.2
#: Round-off over the largest pressure, which is no negative pressure.
_NOTHING = 1e-6
#: Samples along the region, and at least along one of its elements.
_SAMPLES, _SAMPLES_OF_ELEMENT = 150, 6


@dataclass(frozen=True)
class FlatPatch:
    """Lengths along both surface coordinates from the middle of the face; the second coordinate is the first axis of a field.

    `samples`: of the fields, by coordinate; `lines`: numbers of those on element boundaries. `points`, shape (n, 2), and
    `control_values`, shape (n,): active control points. `values`, `zone`: fields, shape (m2, m1); the zone is where its field is
    positive: the pressure is not negative; of a gap, the contact zone. `whole`: whether the field is shown outside the zone as well.
    `letters`: names of the coordinates.
    """

    samples: tuple[FloatArray, FloatArray]
    lines: tuple[NDArray[np.int64], NDArray[np.int64]]
    points: FloatArray
    control_values: FloatArray
    values: FloatArray
    zone: FloatArray
    whole: bool
    letters: tuple[str, str]

    @property
    def shown(self) -> FloatArray:
        """The values that are shown, one after the other."""
        return self.values.ravel() if self.whole else self.values[self.zone >= 0]


@dataclass(frozen=True)
class _Axis:
    """A surface coordinate as length from the middle of the face."""

    direction: Direction
    length: float

    def lengths(self, parameters: FloatArray) -> FloatArray:
        low, high = self.direction.boundaries[[0, -1]]
        return self.length * ((parameters - low) / (high - low) - 0.5)

    def parameters(self, lengths: FloatArray) -> FloatArray:
        low, high = self.direction.boundaries[[0, -1]]
        return np.clip(low + (lengths / self.length + 0.5) * (high - low), low, high)

    def samples(self, begin: float, end: float) -> tuple[FloatArray, NDArray[np.int64]]:
        """Samples between two lengths, element by element, and the numbers of those on element boundaries."""
        boundaries = self.lengths(self.direction.boundaries)
        near = 1e-9 * self.length
        inner = boundaries[(boundaries > begin + near) & (boundaries < end - near)]
        ends = np.array([begin, *inner, end])
        counts = np.maximum(np.ceil(_SAMPLES * np.diff(ends) / (end - begin)), _SAMPLES_OF_ELEMENT).astype(int)
        pieces = [np.linspace(a, b, n, endpoint=False) for a, b, n in zip(ends[:-1], ends[1:], counts, strict=True)]
        at_ends = np.abs(boundaries[:, None] - ends).min(axis=0) <= near
        return np.concatenate([*pieces, [end]]), np.cumsum([0, *counts])[at_ends]


def lay_flat(panels: Sequence[Panel], quantity: Quantity) -> tuple[list[FlatPatch], FloatArray]:
    """The slave face of each panel's first contact pair, within the region that is in contact in any of them.

    Control points lie at their Greville abscissae (Lagrange: at their nodes). The gap is that of each place.

    Returns
    -------
    patches : list of FlatPatch
    region : ndarray, shape (2, 2)
        Its lower and its upper corner.

    Raises
    ------
    InputError
        A traction over the friction coefficient is asked for where there is no friction.
    """
    surfaces = [contact_surfaces(panel.results.problem, panel.results.step(panel.step))[0] for panel in panels]
    corners = np.array([_contact_corners(surface) for surface in surfaces])
    region = np.array([corners[:, 0].min(axis=0), corners[:, 1].max(axis=0)])
    return [_patch(panel, surface, quantity, region) for panel, surface in zip(panels, surfaces, strict=True)], region


def _axes(surface: ContactSurface) -> tuple[_Axis, _Axis]:
    first, second = (_Axis(d, length) for d, length in zip(surface.directions, surface.lengths, strict=True))
    return first, second


def _places(surface: ContactSurface) -> FloatArray:
    """The control points laid flat, shape (n, 2)."""
    return np.stack(np.meshgrid(*(axis.lengths(axis.direction.greville) for axis in _axes(surface))), axis=-1).reshape(-1, 2)


def _contact_corners(surface: ContactSurface) -> FloatArray:
    """Lower and upper corner of the elements that hold the active control points; of the whole face where none is active."""
    active = surface.status > 0
    points = _places(surface)[active if active.any() else slice(None)]
    corners = []
    for axis, low, high in zip(_axes(surface), points.min(axis=0), points.max(axis=0), strict=True):
        ends = axis.lengths(axis.direction.boundaries)
        corners.append([ends[max(np.searchsorted(ends, low) - 1, 0)], ends[min(np.searchsorted(ends, high, side="right"), len(ends) - 1)]])
    return np.array(corners).T


def _patch(panel: Panel, surface: ContactSurface, quantity: Quantity, region: FloatArray) -> FlatPatch:
    axes = _axes(surface)
    (first, columns), (second, rows) = (axis.samples(*ends) for axis, ends in zip(axes, region.T, strict=True))
    matrices = functions_at(axes[0].direction, axes[0].parameters(first))[0], functions_at(axes[1].direction, axes[1].parameters(second))[0]
    points, pressure, _ = surface.fields(matrices)
    control_values = _control_values(surface, quantity)
    if quantity == "gap":
        values = gaps(panel.results.problem, surface.contact, panel.results.step(panel.step).state.positions, points)
    else:
        values = surface.field(matrices, control_values[:, None])
    border = (CONTACT_ZONE if quantity == "gap" else -_NOTHING) * float(np.abs(pressure).max())
    active = surface.status > 0
    return FlatPatch(
        samples=(first, second),
        lines=(columns, rows),
        points=_places(surface)[active],
        control_values=control_values[active],
        values=values.reshape(len(second), len(first)),
        zone=pressure.reshape(len(second), len(first)) - border,
        whole=quantity != "gap",
        letters=surface.letters,
    )


def _control_values(surface: ContactSurface, quantity: Quantity) -> FloatArray:
    if quantity == "pressure":
        return surface.pressure
    if quantity == "gap":
        return surface.gap
    if surface.contact.friction <= 0:
        raise InputError(f"has no friction: {quantity} over the friction coefficient means nothing", f"contact {surface.contact.name}")
    return surface.covariant[:, 0 if quantity == "traction" else 1] / surface.contact.friction
