"""A slave face laid flat, with a contact field over it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from isomortar.errors import InputError
from isomortar.geometry.patch import Direction, FloatArray
from isomortar.harness.paper.figures.picture import Panel
from isomortar.results.bezier import greville, sampling_matrix, sampling_places
from isomortar.results.fields import ContactSurface, contact_surfaces
from isomortar.results.gaps import gaps

Quantity = Literal["pressure", "traction", "traction_2", "gap"]
#: Where the gap is shown: pressure over its largest value. Beside the contact it grows at once to many times what it is inside.
CONTACT_ZONE = 0.2
#: Round-off over the largest pressure, which is no negative pressure.
_NOTHING = 1e-6
#: Samples along a face.
_SAMPLES = 130


@dataclass(frozen=True)
class FlatPatch:
    """Lengths along both surface coordinates from the middle of the face; the second coordinate is the first axis of a field.

    `samples`, `boundaries`: of the field and of elements, by coordinate. `points`, shape (n, 2), `active`, `control_values`,
    shape (n,): the control points. `values`, `zone`: fields, shape (m2, m1); the zone is where its field is positive: where the pressure is
    not negative, for a gap the contact zone. `letters`: names of the coordinates.
    """

    samples: tuple[FloatArray, FloatArray]
    boundaries: tuple[FloatArray, FloatArray]
    points: FloatArray
    active: NDArray[np.bool_]
    control_values: FloatArray
    values: FloatArray
    zone: FloatArray
    letters: tuple[str, str]

    def within(self, region: FloatArray) -> FlatPatch:
        """The part of the fields between the lower and upper corner of `region`, shape (2, 2)."""
        samples, boundaries = (
            [(at >= low - 1e-9) & (at <= high + 1e-9) for at, low, high in zip(places, *region, strict=True)]
            for places in (self.samples, self.boundaries)
        )
        window = np.ix_(samples[1], samples[0])
        return replace(
            self,
            samples=(self.samples[0][samples[0]], self.samples[1][samples[1]]),
            boundaries=(self.boundaries[0][boundaries[0]], self.boundaries[1][boundaries[1]]),
            values=self.values[window],
            zone=self.zone[window],
        )


def lay_flat(panel: Panel, quantity: Quantity) -> FlatPatch:
    """The slave face of the panel's first contact pair. Control points lie at their Greville abscissae (Lagrange: at their nodes).

    The gap is that of each place, NaN where no cell of the contact zone is near.

    Raises
    ------
    InputError
        A traction over the friction coefficient is asked for where there is no friction.
    """
    step = panel.results.step(panel.step)
    surface = contact_surfaces(panel.results.problem, step)[0]
    parts = [max(8, _SAMPLES // d.elements) for d in surface.directions]
    first, second = (sampling_matrix(d, n) for d, n in zip(surface.directions, parts, strict=True))
    points, pressure, _ = surface.fields((first, second))
    control_values = _control_values(surface, quantity)
    shape = (len(second), len(first))
    border = (CONTACT_ZONE if quantity == "gap" else -_NOTHING) * float(np.abs(pressure).max())
    zone = pressure.reshape(shape) - border
    if quantity == "gap":
        values = gaps(panel.results.problem, surface.contact, step.state.positions, points).reshape(shape)
        values = np.where(_near(zone >= 0), values, np.nan)
    else:
        values = surface.field((first, second), control_values[:, None]).reshape(shape)
    samples, boundaries, at = (
        [_flat(d, length, places) for d, length, places in zip(surface.directions, surface.lengths, both, strict=True)]
        for both in (
            [sampling_places(d, n) for d, n in zip(surface.directions, parts, strict=True)],
            [d.boundaries for d in surface.directions],
            [greville(d) for d in surface.directions],
        )
    )
    return FlatPatch(
        samples=(samples[0], samples[1]),
        boundaries=(boundaries[0], boundaries[1]),
        points=np.stack(np.meshgrid(*at), axis=-1).reshape(-1, 2),
        active=surface.status > 0,
        control_values=control_values,
        values=values,
        zone=zone,
        letters=surface.letters,
    )


def region_of_contact(patches: Sequence[FlatPatch]) -> FloatArray:
    """Lower and upper corner of the elements that have active control points in any of the patches, shape (2, 2)."""
    corners = []
    for patch in patches:
        active = patch.points[patch.active] if patch.active.any() else patch.points
        low, high = active.min(axis=0), active.max(axis=0)
        first = [ends[max(np.searchsorted(ends, x) - 1, 0)] for ends, x in zip(patch.boundaries, low, strict=True)]
        last = [ends[min(np.searchsorted(ends, x, side="right"), len(ends) - 1)] for ends, x in zip(patch.boundaries, high, strict=True)]
        corners.append([first, last])
    return np.array([np.min(corners, axis=0)[0], np.max(corners, axis=0)[1]])


def _near(inside: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Places of a grid that share a cell with one that is inside."""
    padded = np.pad(inside, 1)
    rows = padded[2:] | padded[1:-1] | padded[:-2]
    return rows[:, 2:] | rows[:, 1:-1] | rows[:, :-2]


def _flat(direction: Direction, length: float, parameters: FloatArray) -> FloatArray:
    """Parameters as lengths from the middle."""
    low, high = direction.boundaries[[0, -1]]
    return length * ((parameters - low) / (high - low) - 0.5)


def _control_values(surface: ContactSurface, quantity: Quantity) -> FloatArray:
    if quantity == "pressure":
        return surface.pressure
    if quantity == "gap":
        return surface.gap
    if surface.contact.friction <= 0:
        raise InputError(f"has no friction: {quantity} over the friction coefficient means nothing", f"contact {surface.contact.name}")
    return surface.covariant[:, 0 if quantity == "traction" else 1] / surface.contact.friction
