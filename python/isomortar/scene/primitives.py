"""Tables of the exact bodies that scene files name by their kind."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from isomortar.geometry.patch import Closed, Patch
from isomortar.geometry.primitives import bowl, box, cap, ring, sphere, torus, wedge
from isomortar.geometry.primitives.arcs import HALF, QUARTER, WHOLE, degrees
from isomortar.model.values import Point, Positive, Real
from isomortar.scene.types import Interval, PlanePoint, Table


class BoxTable(Table):
    """Axis-parallel box; u, v, w run along x, y, z."""

    closed: ClassVar[Closed | None] = None
    kind: Literal["box"]
    lower: Point
    """Corner with the smallest coordinates."""
    upper: Point
    """Corner with the largest coordinates."""

    def patch(self) -> Patch:
        """The coarse geometry."""
        return box(self.lower, self.upper)


class BowlTable(Table):
    """Block with a flat top and a paraboloid below; u, v, w run along x, y, z."""

    closed: ClassVar[Closed | None] = None
    kind: Literal["bowl"]
    centre: PlanePoint = (0.0, 0.0)
    """Middle of the square, [x, y]."""
    half_width: Positive
    """Half the side of the square."""
    bottom: Real
    """Height z of the lowest point."""
    rise: Real
    """By how much the mid-edges of the underside are higher; its corners by twice that."""
    top: Real
    """Height z of the flat top."""

    def patch(self) -> Patch:
        """The coarse geometry."""
        return bowl(self.centre, self.half_width, self.bottom, self.rise, self.top)


class CapTable(Table):
    """Block with a flat top and a part of a sphere below; u, v, w run along x, y, z."""

    closed: ClassVar[Closed | None] = None
    kind: Literal["cap"]
    centre: PlanePoint = (0.0, 0.0)
    """Where it is lowest, [x, y]."""
    radius: Positive
    """Of the sphere."""
    half_width: Positive
    """From the middle to the middle of a side, below 0.942 radius; sides are bent outwards."""
    bottom: Real
    """Height z of the lowest point."""
    top: Real
    """Height z of the flat top."""

    def patch(self) -> Patch:
        """The coarse geometry."""
        return cap(self.centre, self.radius, self.half_width, self.bottom, self.top)


class WedgeTable(Table):
    """Prism along y of a trapezium or a triangle; u, v, w run along x, y, z."""

    closed: ClassVar[Closed | None] = None
    kind: Literal["wedge"]
    bottom: Interval
    """From where to where along x its lower side is; both the same: an edge."""
    top: Interval
    """From where to where along x its upper side is; both the same: an edge."""
    y: Interval
    """From where to where along y."""
    z: Interval
    """From where to where along z."""

    def patch(self) -> Patch:
        """The coarse geometry."""
        return wedge(self.bottom, self.top, self.y, self.z)


class RingTable(Table):
    """Ring, pipe or cylinder; u runs round its axis, v outwards, w against the axis."""

    kind: Literal["ring"]
    centre: Point = (0.0, 0.0, 0.0)
    """Centre of the ring."""
    inner: Annotated[Real, Field(ge=0)]
    """Inner radius: face v0; 0: solid, v0 is the axis."""
    outer: Positive
    """Outer radius: face v1."""
    width: Positive
    """Extent along the axis."""
    angles: Interval = (0.0, WHOLE)
    """From where to where it goes round, degrees by the right-hand rule; 0: the coordinate that follows the axis in x, y, z, x."""
    axis: Literal["x", "y", "z"] = "y"
    """Coordinate that its axis goes along."""

    @property
    def closed(self) -> Closed | None:
        """Directions in which it meets itself."""
        return "u" if _whole(self.angles) else None

    def patch(self) -> Patch:
        """The coarse geometry."""
        return ring(self.centre, self.inner, self.outer, self.width, self.angles, self.axis)


class SphereTable(Table):
    """Ball or spherical shell, or a part of one; u runs round its axis, v outwards, w from the upper to the lower latitude."""

    kind: Literal["sphere"]
    centre: Point = (0.0, 0.0, 0.0)
    """Centre of the sphere."""
    inner: Annotated[Real, Field(ge=0)] = 0.0
    """Inner radius: face v0; 0: solid, v0 is the centre."""
    outer: Positive
    """Outer radius: face v1."""
    latitudes: Interval = (-QUARTER, QUARTER)
    """Of its rims, degrees from the plane across the axis; at -90 and 90 is a pole: in contact better on a rim than in the middle."""
    angles: Interval = (0.0, WHOLE)
    """From where to where it goes round, degrees by the right-hand rule; 0: the coordinate that follows the axis in x, y, z, x."""
    axis: Literal["x", "y", "z"] = "z"
    """Coordinate that its axis goes along, through the poles."""

    @property
    def closed(self) -> Closed | None:
        """Directions in which it meets itself."""
        return "u" if _whole(self.angles) else None

    def patch(self) -> Patch:
        """The coarse geometry."""
        return sphere(self.centre, self.inner, self.outer, self.latitudes, self.angles, self.axis)


class TorusTable(Table):
    """Torus or a part of one; u runs round its axis, v outwards in its section, w round that, from the upper to the lower latitude."""

    kind: Literal["torus"]
    centre: Point = (0.0, 0.0, 0.0)
    """Centre of the torus."""
    radius: Positive
    """Of the circle that the middle of its section goes along."""
    inner: Annotated[Real, Field(ge=0)] = 0.0
    """Inner radius of the section: face v0; 0: solid, v0 is that circle."""
    outer: Positive
    """Outer radius of the section: face v1."""
    latitudes: Interval = (-HALF, HALF)
    """From where to where its section goes, degrees: 0 farthest from the axis, 90 on top."""
    angles: Interval = (0.0, WHOLE)
    """From where to where it goes round, degrees by the right-hand rule; 0: the coordinate that follows the axis in x, y, z, x."""
    axis: Literal["x", "y", "z"] = "z"
    """Coordinate that its axis goes along."""

    @property
    def closed(self) -> Closed | None:
        """Directions in which it meets itself."""
        along: Closed | None = "u" if _whole(self.angles) else None
        return ("uw" if along else "w") if _whole(self.latitudes) else along

    def patch(self) -> Patch:
        """The coarse geometry."""
        return torus(self.centre, self.radius, self.inner, self.outer, self.latitudes, self.angles, self.axis)


def _whole(angles: tuple[float, float]) -> bool:
    """Whether an arc goes all round."""
    return degrees(*angles) == WHOLE


Primitive = BoxTable | BowlTable | CapTable | WedgeTable | RingTable | SphereTable | TorusTable
