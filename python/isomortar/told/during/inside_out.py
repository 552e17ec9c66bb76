"""Bodies that fall into themselves within one load increment: to another equilibrium than the one they came along, maybe.

Equilibrium is asked of Gauss points alone. Between them a body may be turned inside out, and nothing there resists it.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy import sparse

from isomortar._frozen import frozen
from isomortar.errors import ConvergenceError
from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.model import constants
from isomortar.model.lines import along, functions_along, quotient
from isomortar.solve.equilibrium import Equilibrium


@frozen
class Least:
    """The smallest J of a body, and the element that it is in, by direction."""

    value: float
    element: tuple[int, int, int]

    @property
    def words(self) -> str:
        """The element, as people read it."""
        return f"element {', '.join(map(str, self.element))} along u, v, w"


class InsideOut:
    """What is asked of the volume of bodies in a load increment; of each body both are told once."""

    def __init__(self, equilibrium: Equilibrium) -> None:
        self._equilibrium = equilibrium
        self._places: dict[str, Places] = {}
        self._known: dict[str, tuple[FloatArray, Least]] = {}
        self._found: dict[tuple[str, bool], tuple[Least, Least]] = {}
        self._told = set[tuple[str, bool]]()

    def look(self, before: FloatArray, after: FloatArray, share: float) -> None:
        """Look at J of an increment, a share of the longest one, from positions to others (theory 5.25).

        Raises
        ------
        ConvergenceError
            A body has fallen into itself, and a shorter increment may show which way it goes.
        """
        equilibrium = self._equilibrium
        may_cut = share > constants.SHORT_OF_SNAPPING and 0.5 * share >= 0.5**equilibrium.problem.settings.max_cuts
        found: dict[tuple[str, bool], tuple[Least, Least]] = {}  # by body, and whether it is inside out
        for body, smallest in zip(equilibrium.problem.deformable, equilibrium.solid.smallest_jacobians(after), strict=True):
            if smallest > constants.LOOKED_BETWEEN or body.material.law == "linear-elastic":
                continue
            was, least = self._least(body.name, before), self._least(body.name, after)
            falls = was.value > constants.FALLEN and least.value < constants.FALLEN * was.value
            if falls and may_cut:
                raise ConvergenceError(
                    f"body {body.name!r}: its least J falls from {was.value:.2g} to {least.value:.2g} in one increment ({least.words}), "
                    "maybe past an equilibrium"
                )
            if falls or least.value <= 0.0:
                found[body.name, least.value <= 0.0] = was, least
        for kind, pair in found.items():
            self._found.setdefault(kind, pair)

    def after_step(self, step: int) -> Iterator[str]:
        """Warnings that the end of a load step gives rise to."""
        for (name, inside_out), (was, least) in self._found.items():
            if (name, inside_out) in self._told:
                continue
            self._told.add((name, inside_out))
            if inside_out:
                yield (
                    f"body {name!r}, load step {step}: it is turned inside out between its Gauss points (J = {least.value:.2g}, "
                    f"{least.words}): nothing there resists it, and what it exerts is none of its law's. Take more load steps, finer "
                    f"elements, or more Gauss points (bodies.{name}.mesh.quadrature)"
                )
            else:
                yield (
                    f"body {name!r}, load step {step}: its least J falls from {was.value:.2g} to {least.value:.2g} at once "
                    f"({least.words}), however short the load increment: it may have come to another equilibrium than the one beside "
                    "it. Take more load steps, or finer elements"
                )

    def _least(self, name: str, positions: FloatArray) -> Least:
        """The smallest J of a body at its places; that of the last positions is kept."""
        if name not in self._known or self._known[name][0] is not positions:
            if name not in self._places:
                self._places[name] = Places(self._equilibrium.problem.body(name).patch)
            found = self._places[name].least(self._equilibrium.numbering.of_patch(name, positions))
            self._known[name] = positions, found
        return self._known[name][1]


class Places:
    """The places of a patch at which J is looked at between its Gauss points: a grid in each element, its corners and edges among that.

    Parameters
    ----------
    patch : Patch
        In the reference configuration.
    """

    def __init__(self, patch: Patch) -> None:
        self._weights = patch.weights if np.any(patch.weights != patch.weights[0]) else None
        self._shape = patch.shape[::-1]
        self._lines = [_functions(direction) for direction in patch.directions]
        self._elements = patch.directions[0].elements, patch.directions[1].elements, patch.directions[2].elements
        layer = len(constants.PLACES_BETWEEN) ** 3 * self._elements[0] * self._elements[1]
        layers = max(1, constants.MOST_AT_ONCE // layer)
        self._slabs = [(first, min(first + layers, self._elements[2])) for first in range(0, self._elements[2], layers)]
        self._reference = [self._usable(volumes) for volumes in self._volumes(patch.control_points)]

    def least(self, positions: FloatArray) -> Least:
        """The smallest J = det F with the control points elsewhere, shape (control points of the patch, 3) (theory 5.25)."""
        best, where, count = np.inf, 0, 0
        for volumes, reference in zip(self._volumes(positions), self._reference, strict=True):
            jacobians = np.where(np.isfinite(reference), volumes / reference, np.inf).min(axis=(1, 3, 5))
            if jacobians.min() < best:
                best, where = float(jacobians.min()), count + int(jacobians.argmin())
            count += jacobians.size
        w, v, u = (int(k) for k in np.unravel_index(where, self._elements[::-1]))
        return Least(best, (u, v, w))

    @staticmethod
    def _usable(volumes: FloatArray) -> FloatArray:
        """The volumes of the reference; infinite at poles and corners where there is as good as none, which have no J."""
        largest = volumes.max(axis=(1, 3, 5), keepdims=True)
        return np.where(volumes > constants.NO_VOLUME * largest, volumes, np.inf)

    def _volumes(self, points: FloatArray) -> Iterator[FloatArray]:
        """Volumes dx/du x dx/dv . dx/dw at the places, slab by slab of elements along w: by element and place along w, v and u in turn."""
        net = points - points.mean(axis=0)
        if self._weights is not None:
            net = np.column_stack([net * self._weights[:, None], self._weights])
        net = net.reshape((*self._shape, -1))
        (here_u, slope_u), (here_v, slope_v), (here_w, slope_w) = self._lines
        low = along(here_u, net, 2)
        by_u, by_v, flat = along(here_v, along(slope_u, net, 2), 1), along(slope_v, low, 1), along(here_v, low, 1)
        each = len(constants.PLACES_BETWEEN)
        for first, last in self._slabs:
            rows = slice(first * each, last * each)
            slopes = [along(here_w[rows], by_u, 0), along(here_w[rows], by_v, 0), along(slope_w[rows], flat, 0)]
            if self._weights is not None:
                slopes = [quotient(slope, along(here_w[rows], flat, 0)) for slope in slopes]
            volumes = np.einsum("...c,...c->...", np.cross(slopes[0], slopes[1]), slopes[2])
            yield volumes.reshape(last - first, each, self._elements[1], each, self._elements[0], each)


def _functions(direction: Direction) -> tuple[sparse.csr_array, sparse.csr_array]:
    """Functions of a direction and their derivatives at the places of its elements; those on a line are beside it (theory 5.25)."""
    inside = np.clip(constants.PLACES_BETWEEN, constants.BESIDE_A_LINE, 1.0 - constants.BESIDE_A_LINE)
    return functions_along(direction, (direction.boundaries[:-1, None] + np.diff(direction.boundaries)[:, None] * inside).ravel())
