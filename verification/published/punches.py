"""Round punches with rounded edges, pressed into a cylinder: one whose solution is known, and the second contact benchmark of NAFEMS."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from published.benchmark import Benchmark, Beside, Drawing, Known, Quantity, reaction
from published.turned import disc, punch
from scipy.integrate import quad
from scipy.optimize import brentq

from isomortar.accuracy.discretisations import parse_kind
from isomortar.geometry.patch import FloatArray, Patch
from isomortar.harness import Bound, Shown, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.model.numbering import Numbering
from isomortar.results.bezier import sampling_matrix
from isomortar.results.fields import contact_surfaces
from isomortar.scene import Scene
from isomortar.scene.geometry_file import patch_table
from isomortar.scene.toml_text import dump

#: Both: radius and height of the punch, and of the cylinder below.
PUNCH, CYLINDER = (50.0, 100.0), (100.0, 200.0)
#: The one that is known: flat radius, radius of the edge, Young's modulus of both, Poisson's ratio, flat over contact radius, approach.
FLAT, EDGE, YOUNG, POISSON, RATIO, APPROACH = 10.0, 100.0, 1e5, 0.3, 0.7, 0.32115
#: Where elements end, in depth, and along the radius of either benchmark, closer to where contact ends.
_DEPTHS = (1.0, 2.5, 5.0, 10.0, 20.0, 45.0)
_ROUNDED = (2.5, 5.0, 7.5, 11.0, 12.0, 13.0, 13.7, 14.3, 15.0, 16.5, 19.0, 25.0, 35.0)
_NAFEMS = (10.0, 20.0, 27.0, 32.0, 35.0, 37.5, 39.0, 40.5, 41.0, 42.0, 43.0, 45.0)
#: With friction the cylinder has a hole of this radius, held as an axis is: at a pole slips have no coordinates. Load steps with friction.
_HOLE, _STEPS = 0.02, 4
#: Other programs take no edges that are points: for them both bodies have a hole, as wide as lets GetFEM tell multipliers apart.
_WIDER = 0.5
#: Lagrange elements round the axis, by order.
_ROUND = {1: 6, 2: 4}
#: Samples of the pressure an element.
_SAMPLES = 8
#: Kinds of elements, and into how many parts those of the coarse mesh are cut.
KINDS, _PARTS = ("N2", "N3"), {"coarse": 1, "fine": 2}
MESHES = tuple(f"{kind} {name}" for kind in KINDS for name in _PARTS)


@dataclass(frozen=True)
class Pressed:
    """What is found of a punch: forces of the whole, pressures by radius, settlement of the cylinder's middle, and what is unbalanced."""

    force: float
    radii: FloatArray
    pressure: FloatArray
    middle: float
    unbalanced: float


def problem(
    flat: float, edge: float, spans: tuple[float, ...], mesh: str, materials: dict[str, Any], push: dict[str, Any], friction: float = 0.0
) -> Problem:
    """A punch and the cylinder in small strain, without friction in one load step; `push` is how they are pressed, keys of a scene."""
    kind, size = mesh.split()
    radius, height = PUNCH
    wide, deep = CYLINDER
    beyond = [r for r in (*spans, flat, radius, 65.0) if r < wide]
    holes = (_WIDER, _WIDER) if kind[0] == "L" else (0.0, _HOLE if friction else 0.0)
    bodies = {
        "punch": punch(holes[0], flat, edge, radius, height, (spans, _DEPTHS)),
        "cylinder": disc(holes[1], wide, -deep, 0.0, (sorted(beyond), [-d for d in (*_DEPTHS, 100.0)[::-1]])),
    }
    held = {
        f"{body}-{face}": {"face": f"{body}.{face}", "components": components}
        for body in bodies
        for face, components in (("u0", ["x", "y"]), ("v0", ["y"]), ("v1", ["x"]))
    }
    scene = {
        "format": 1,
        "name": "punch",
        "materials": {name: {"law": "linear-elastic", "poisson": POISSON, **values} for name, values in materials.items()},
        "bodies": {
            name: {"material": material, "patch": patch_table(patch), "mesh": _mesh(patch, kind, _PARTS[size])}
            for (name, patch), material in zip(bodies.items(), materials, strict=True)
        },
        "contacts": {"face": {"slave": "punch.w0", "master": "cylinder.w1", "friction": friction}},
        "supports": {"below": {"face": "cylinder.w0"}, **held, **push.pop("supports", {})},
        "stages": [{"name": "press", "steps": _STEPS if friction else 1, "motions": push.pop("motions", {})}],
        **push,
    }
    return Scene.from_toml(dump(scene)).problem()


def _mesh(patch: Patch, kind: str, parts: int) -> dict[str, Any]:
    """Elements of a body of revolution: an exact one round the axis, or such as come near; and the patch's own, cut into parts."""
    family, order = parse_kind(kind)
    u, _, w = patch.directions
    across, elements = (order, _ROUND[order]) if family == "L" else (2, 1)
    return {"family": family, "order": [order, across, order], "elements": [parts * u.elements, elements, parts * w.elements]}


def pressed(problem: Problem) -> Pressed:
    """Press."""
    *_, step = Simulation(problem).run()
    surface = contact_surfaces(problem, step)[0]
    along, around = (sampling_matrix(line, _SAMPLES) for line in surface.directions)
    places, pressure, _ = surface.fields((along, around[:1]))
    below = next(r.force for s, r in zip(problem.supports, step.reactions, strict=True) if s.name == "below")
    force, loads = (-4.0 * float(step.contacts[0].force_master[2]), sum(float(load.force[2]) for load in step.loads))
    others = sum(float(r.force[2]) for s, r in zip(problem.supports, step.reactions, strict=True) if s.name != "below")
    middle = settled(problem, step.state.positions)
    return Pressed(force, places[:, 0], pressure, middle, abs(float(below[2]) + loads + others) / abs(float(below[2])))


def settled(problem: Problem, positions: FloatArray) -> float:
    """How far up the cylinder's middle goes."""
    numbering = Numbering(problem)
    top = numbering.face_points(problem.body("cylinder"), "w1")
    axis = top[np.argmin(np.linalg.norm(numbering.reference[top, :2], axis=1))]
    return float((positions - numbering.reference)[axis, 2])


@dataclass(frozen=True)
class Exact:
    """A rigid punch with a flat middle and a parabolic edge on a half-space in small strain, by contact radius (Sneddon; Ciavarella 1999).

    Two bodies act as one of the `modulus` of both together: of one material, what each gives way makes no shear between them.
    """

    radius: float
    flat: float
    edge: float
    modulus: float

    @classmethod
    def by_force(cls, force: float, flat: float, edge: float, modulus: float) -> Exact:
        """That whose punch bears a force; contact ends within the edge."""
        radius = brentq(lambda radius: cls(radius, flat, edge, modulus).force - force, flat, flat + edge)
        return cls(float(radius), flat, edge, modulus)

    @property
    def approach(self) -> float:
        """How far the punch goes in."""
        return self.radius / self.edge * (np.sqrt(self.radius**2 - self.flat**2) - self.flat * np.arccos(self.flat / self.radius))

    @property
    def force(self) -> float:
        """What it bears."""
        return 2.0 * self.modulus * quad(lambda x: x * self._slope(x), self.flat, self.radius)[0]

    @property
    def peak(self) -> float:
        """Largest pressure: bounded, as the punch has no corner."""
        places = np.linspace(self.flat, self.radius, 200)[1:-1]
        return float(np.max([self.pressure(place) for place in places]))

    def pressure(self, radius: float) -> float:
        """Pressure at a radius; the variable is the height over the radius, which has no singularity."""
        low, high = (np.sqrt(x**2 - radius**2) for x in (np.maximum(radius, self.flat), self.radius))

        def share(height: float) -> float:
            x = np.hypot(height, radius)
            return self._slope(x) / x if x > 0.0 else 0.0

        return self.modulus / np.pi * quad(share, low, high)[0]

    def normalised(self, radius: float) -> float:
        """Pressure at a radius over the mean one."""
        return self.pressure(radius) * np.pi * self.radius**2 / self.force

    def _slope(self, x: float) -> float:
        """How the approach grows with the contact radius."""
        rise = 2.0 * np.sqrt(np.maximum(x**2 - self.flat**2, 0.0)) - self.flat * np.arccos(np.minimum(self.flat / x, 1.0))
        return float(rise / self.edge)


_EXACT = Exact(FLAT / RATIO, FLAT, EDGE, 0.5 * YOUNG / (1.0 - POISSON**2))
#: The second benchmark of NAFEMS as half-spaces: steel on aluminium, 100 MPa on a radius of 50.
_STEEL, _ALUMINIUM, _LOAD = 210e3, 70e3, 100.0
_HALF_SPACES = Exact.by_force(_LOAD * np.pi * PUNCH[0] ** 2, 40.0, 10.0, 1.0 / ((1.0 - POISSON**2) * (1.0 / _STEEL + 1.0 / _ALUMINIUM)))
#: Radii, over the contact radius, at which pressures are told.
_AT = (0.0, 0.81)


@case(
    claim="A flat punch with a rounded edge goes as far in, bears as much, and has the pressures of theory, but for the bodies' size.",
    tier=lambda mesh: "gate" if mesh == "N2 coarse" else "nightly",
    grid={"mesh": tuple(MESHES)},
    bounds={
        "unbalanced": Bound(at_most=1e-8, reason="theory: equilibrium, to the tolerance of Newton's method times ten"),
        "force off": Bound(
            at_most=0.02, reason="theory: bodies of 7 and 3.5 contact radii in width for half-spaces: the square of a / width"
        ),
        "radius off": Bound(at_most=0.07, reason="discretisation: the edge of contact lies somewhere in an element of 0.7"),
        "pressure in the middle": Bound(at_least=0.62, at_most=0.66, reason="theory: 0.642; the mean is over a radius known to an element"),
        "force": Shown("N"),
        "contact radius": Shown("mm"),
        "pressure at 0.81": Shown("over the mean one, at 0.81 of the contact radius"),
        "radii": Shown("of the samples, mm"),
        "pressures": Shown("MPa"),
    },
)
def rounded_punch(mesh: str) -> dict[str, Any]:
    """The approach is given; both bodies are of one material, so that friction would not act."""
    found = pressed(_rounded(mesh))
    radius = float(found.radii[found.pressure > 0.0].max())
    mean = found.force / (np.pi * _EXACT.radius**2)
    told = [float(np.interp(share * _EXACT.radius, found.radii, found.pressure) / mean) for share in _AT]
    return {
        "unbalanced": found.unbalanced,
        "force off": abs(found.force / _EXACT.force - 1.0),
        "radius off": abs(radius / _EXACT.radius - 1.0),
        "pressure in the middle": told[0],
        "force": found.force,
        "contact radius": radius,
        "pressure at 0.81": told[1],
        "radii": found.radii,
        "pressures": found.pressure,
    }


def _rounded(mesh: str) -> Problem:
    return problem(
        *(FLAT, EDGE, _ROUNDED, mesh),
        {"steel": {"young": YOUNG}, "base": {"young": YOUNG}},
        {"supports": {"top": {"face": "punch.w1"}}, "motions": {"top": {"translate": [0, 0, -APPROACH]}}},
    )


#: How far the cylinder's middle settles, by friction.
_SETTLED = {
    0.0: Bound(at_least=-0.137, at_most=-0.129, reason="reference: -0.1310 (Marc) and -0.1329 (Code_Aster), coarser elements"),
    0.1: Bound(at_least=-0.137, at_most=-0.125, reason="reference: -0.131 and -0.133 without friction, which only holds back"),
}


@case(
    claim="A cylinder below a punch settles as two other programs say, with friction or without, and peaks are those of half-spaces.",
    tier="nightly",
    grid={"mesh": tuple(MESHES), "friction": tuple(_SETTLED)},
    bounds=lambda friction, **_: {
        "unbalanced": Bound(at_most=1e-8, reason="theory: equilibrium, to the tolerance of Newton's method times ten"),
        "middle": _SETTLED[friction],
        "pressure in the middle": Shown("MPa; the mean one is 100 over the radius of the punch"),
        "peak": Bound(
            at_least=0.9 * _HALF_SPACES.peak,
            at_most=1.1 * _HALF_SPACES.peak,
            reason="theory: a rigid punch on a half-space, bounded as it has no corner; a tenth for bodies' size and elements at the edge",
        ),
        "contact radius": Shown("mm"),
        "radii": Shown("of the samples, mm"),
        "pressures": Shown("MPa"),
    },
)
def nafems_punch(mesh: str, friction: float) -> dict[str, Any]:
    """NAFEMS 2: steel on aluminium, 100 MPa on top."""
    found = pressed(_nafems(mesh, friction))
    return {
        "unbalanced": found.unbalanced,
        "middle": found.middle,
        "pressure in the middle": float(found.pressure[0]),
        "peak": float(found.pressure.max()),
        "contact radius": float(found.radii[found.pressure > 0.0].max()),
        "radii": found.radii,
        "pressures": found.pressure,
    }


def _nafems(mesh: str, friction: float) -> Problem:
    materials = {"steel": {"young": _STEEL}, "aluminium": {"young": _ALUMINIUM}}
    return problem(40.0, 10.0, _NAFEMS, mesh, materials, {"loads": {"top": {"face": "punch.w1", "pressure": _LOAD}}}, friction)


_PUNCH = (
    "A steel punch of radius 50 and height 100, whose edge is rounded with radius 10, on an aluminium cylinder of radius 100 and height "
    "200, under 100 MPa on top"
)
_PEAKS = (
    f"Pressures are largest just beyond where the edge begins, and bounded there: by theory, for half-spaces, {_HALF_SPACES.peak:.0f} MPa, "
    f"where contact ends at a radius of {_HALF_SPACES.radius:.2f}. Elements of millimetres tell a part of that."
)
_RESOLVED = "of eight samples an element"
_EDGE = Quantity("contact radius", "contact radius", "mm", (), "to an element: both meshes have the same ends of elements there")
_THEORY = "theory, half-spaces"
_LAGRANGE = f"On the coarse mesh, with facets round the axis, where both have a hole of radius {_WIDER:g}"
_FACETS = Bound(at_least=-0.137, at_most=-0.122, reason="reference: -0.1310 and -0.1329; facets and linear elements take a twentieth")
_CURVE = np.array([(share * _EXACT.radius, _EXACT.normalised(share * _EXACT.radius)) for share in np.linspace(0.0, 0.999, 60)])
BENCHMARKS = (
    Benchmark(
        "rounded_punch",
        "Flat punch with a rounded edge",
        "A punch, flat to a radius of 10 with an edge of radius 100, and a cylinder, both of 100 GPa and Poisson's ratio 0.3, approach "
        "each other by 0.32115, in small strain, without friction: contact to 10 / 0.7.",
        f"The force of 4657 N that goes round with this benchmark is not that of its own theory, {_EXACT.force:.0f} N for this approach.",
        ("N3 fine", "N2 fine"),
        (
            Quantity("force", "force", "N", (Known(_THEORY, _EXACT.force), Known("as told", 4657.0)), "the bodies are no half-spaces"),
            Quantity(
                "contact radius",
                "contact radius",
                "mm",
                (Known(_THEORY, _EXACT.radius),),
                "to an element: both meshes have the same ends of elements there",
            ),
            Quantity(
                "pressure in the middle",
                "pressure in the middle over the mean one",
                "",
                (Known(_THEORY, _EXACT.normalised(0.0)), Known("as told", 0.648)),
            ),
            Quantity(
                "pressure at 0.81",
                "pressure at 0.81 of the contact radius over the mean one",
                "",
                (Known(_THEORY, _EXACT.normalised(0.81 * _EXACT.radius)), Known("as told", 1.418)),
            ),
        ),
        (
            Drawing(
                "radii", "pressures", "radius, mm", "pressure, MPa", {_THEORY: _CURVE * [1.0, _EXACT.force / (np.pi * _EXACT.radius**2)]}
            ),
        ),
        Beside(
            f"{_LAGRANGE}.",
            lambda kind: _rounded(f"{kind} coarse"),
            lambda problem, steps: {"force": -4.0 * float(reaction(problem, steps[-1], "top")[2])},
            {"force": Bound(at_least=0.95 * _EXACT.force, at_most=1.05 * _EXACT.force, reason="theory: half-spaces; facets take a share")},
            ("L1",),
        ),
    ),
    Benchmark(
        "nafems_punch",
        "Punch on a foundation (NAFEMS 2)",
        f"{_PUNCH}, without friction.",
        _PEAKS,
        ("N3 fine", "N2 fine"),
        (
            Quantity(
                "middle",
                "displacement of the foundation's middle",
                "mm",
                (Known("NAFEMS, Marc", -0.1310), Known("Code_Aster V6.01.122", -0.132897)),
            ),
            Quantity(
                "pressure in the middle",
                "pressure in the middle",
                "MPa",
                (Known("Code_Aster V6.01.122, stress at point M", 93.626),),
                "stress of an element beside it",
            ),
            Quantity("peak", "largest pressure", "MPa", (Known(_THEORY, _HALF_SPACES.peak),), _RESOLVED),
            _EDGE,
        ),
        (Drawing("radii", "pressures", "radius, mm", "pressure, MPa", {}),),
        Beside(
            f"{_LAGRANGE}.",
            lambda kind: _nafems(f"{kind} coarse", 0.0),
            lambda problem, steps: {"middle": settled(problem, steps[-1].positions)},
            {"middle": _FACETS},
        ),
        {"friction": 0.0},
    ),
    Benchmark(
        "nafems_punch",
        "Punch on a foundation with friction (NAFEMS 2)",
        f"{_PUNCH}, friction 0.1.",
        f"{_PEAKS} The load comes in {_STEPS} steps. At the cylinder's axis is a hole of radius {_HOLE:g}, held as an axis is: at a pole "
        "slips have no coordinates.",
        ("N3 fine", "N2 fine"),
        (
            Quantity(
                "middle",
                "displacement of the foundation's middle",
                "mm",
                (Known("NAFEMS, Marc, told as without friction", -0.1310),),
                "Marc's value comes nearer to this one than to that without friction",
            ),
            Quantity("pressure in the middle", "pressure in the middle", "MPa", ()),
            Quantity(
                "peak",
                "largest pressure",
                "MPa",
                (
                    Known(f"{_THEORY}, no friction", _HALF_SPACES.peak),
                    Known("NAFEMS, the least", 353.0),
                    Known("NAFEMS, the largest", 386.0),
                ),
                f"{_RESOLVED}; those published, told as singular, presumably of elements longer than the 0.4 mm of contact beyond the edge",
            ),
            _EDGE,
        ),
        (Drawing("radii", "pressures", "radius, mm", "pressure, MPa", {}),),
        Beside(
            f"{_LAGRANGE}.",
            lambda kind: _nafems(f"{kind} coarse", 0.1),
            lambda problem, steps: {"middle": settled(problem, steps[-1].positions)},
            {"middle": _FACETS},
            ("L1",),
        ),
        {"friction": 0.1},
    ),
)
