"""Rotations, places, units, mirror images, parametrisations and names leave the results of a scene with friction."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from small_scenes import at_few_points, bowl
from transforms import mirrored, moved, relabelled, scaled, turned, with_knots, with_weights

from isomortar.geometry.patch import FloatArray
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Enforcement, Problem, RigidPlane
from isomortar.solve.record import StepResult

#: No axis, plane or round number is kept by this rotation.
TURN = np.linalg.qr(np.array([[0.3, -1.1, 0.7], [0.9, 0.4, -0.2], [-0.5, 0.8, 1.3]]))[0]
TURN = TURN * np.sign(np.linalg.det(TURN))
MIRROR = np.diag([-1.0, 1.0, 1.0])
MASTERS = ("block", "plane")

_REASON = "round-off: forces are in balance to Newton's 1e-12"
_SINGLE = f"{_REASON}; of the load of one control point, a tenth of the largest"
BOUNDS = {
    "forces": Bound(at_most=1e-12, reason=_REASON),
    "moments": Bound(at_most=1e-12, reason=_REASON),
    "pressures": Bound(at_most=1e-11, reason=_SINGLE),
    "tractions": Bound(at_most=1e-11 / 0.3, reason=f"{_SINGLE}, and 0.3, the friction, of the pressures"),
    "states": Bound(at_most=0.0, reason="theory: the same control points stick and slip"),
}

#: Forces and moments on the supports, sorted control pressures, traction norms, and states; by load step.
Measured = dict[str, FloatArray]


def measured(results: list[StepResult]) -> Measured:
    """What is compared of the results of a run; pressures, traction norms and states are sorted, so that numbering does not count."""
    return {
        "forces": np.array([[reaction.force for reaction in result.reactions] for result in results]),
        "moments": np.array([[reaction.moment for reaction in result.reactions] for result in results]),
        "pressures": np.array([np.sort(result.state.contacts[0].pressure) for result in results]),
        "tractions": np.array([np.sort(result.contacts[0].traction_norm) for result in results]),
        "states": np.array([np.sort(result.contacts[0].status) for result in results], dtype=float),
    }


def kinked() -> Problem:
    """The bowl on Lagrange elements, along averaged normals."""
    problem = at_few_points(bowl("block"))
    slave, master = problem.bodies
    patch = mesh(box((-0.6, -0.6, -0.5), (0.7, 0.65, 0.0)), ("L", "L", "N"), (1, 2, 1), (6, 4, 1))
    (contact,) = problem.contacts
    return replace(problem, bodies=(slave, replace(master, patch=patch)), contacts=(replace(contact, projection="averaged"),))


def capped() -> Problem:
    """The bowl on the block, with a cohesion and a largest traction."""
    problem = at_few_points(bowl("block"))
    return replace(problem, contacts=(replace(problem.contacts[0], cohesion=0.05, traction_max=0.3),))


def pointwise(enforcement: Enforcement) -> Problem:
    """A block of Lagrange elements with constraints at points, many of them between elements, along averaged normals."""
    problem = kinked()
    slave, master = problem.bodies
    patch = mesh(box((-0.31, -0.27, 0.02), (0.33, 0.29, 0.4)), ("L", "L", "N"), (2, 1, 1), (3, 2, 1))
    contact = replace(problem.contacts[0], enforcement=enforcement)
    return replace(problem, bodies=(replace(slave, patch=patch), master), contacts=(contact,))


#: Scenes by name: the bowl on its masters, and others.
SCENES: dict[str, Callable[[], Problem]] = {
    "block": lambda: at_few_points(bowl("block")),
    "plane": lambda: at_few_points(bowl("plane")),
    "kinked": kinked,
    "capped": capped,
    "greville": lambda: pointwise("greville"),
    "knots": lambda: pointwise("knots"),
}


@functools.cache
def as_it_is(scene: str) -> tuple[Problem, list[StepResult]]:
    """A scene and its results, computed once for all that is done to it."""
    problem = SCENES[scene]()
    return problem, list(Simulation(problem).run())


def change(
    scene: str, transform: Callable[[Problem], Problem], back: Callable[[Measured], Measured] = lambda found: found
) -> dict[str, float]:
    """Largest change of each measured quantity over its largest value, when `back` has taken the transformed results back."""
    problem, results = as_it_is(scene)
    return differences(measured(results), back(measured(list(Simulation(transform(problem)).run()))))


def differences(before: Measured, after: Measured) -> dict[str, float]:
    """Largest difference of each quantity over its largest value."""
    return {name: float(np.abs(after[name] - value).max() / np.abs(value).max()) for name, value in before.items()}


@case(claim="A rotation of the whole scene changes no result.", tier="gate", grid={"master": MASTERS}, bounds=BOUNDS)
def rotation(master: str) -> dict[str, float]:
    """Geometry, rigid plane and motions turned; forces and moments turned back."""
    return change(
        master,
        lambda problem: turned(problem, TURN),
        lambda found: found | {"forces": found["forces"] @ TURN, "moments": found["moments"] @ TURN},
    )


def _last_bits(distance: float) -> dict[str, Bound]:
    """Coordinates of the input are rounded to the last bits that they have at a distance."""
    bits = f"round-off: the input's last bits at {distance:g} lengths, over a compression of some hundredths"
    reach = 10.0 * float(np.spacing(distance))
    forces = Bound(at_most=reach, reason=bits)
    return BOUNDS | {
        "forces": forces,
        "moments": forces,
        "contact": Bound(at_most=1e-14, reason="round-off: of forces times the distance"),
        "pressures": Bound(at_most=10.0 * reach, reason=f"{bits}; of the load of one control point, a tenth of the largest"),
        "tractions": Bound(at_most=10.0 * reach / 0.3, reason=f"{bits}; the same, and 0.3, the friction, of the pressures"),
    }


@case(
    claim="Where a scene stands changes no result, and contact moments are about the origin wherever that is.",
    tier="gate",
    grid={"master": MASTERS, "distance": (1e3, 1e5, 1e6)},
    bounds=lambda distance, **_: _last_bits(distance),
)
def place(master: str, distance: float) -> dict[str, float]:
    """Everything moved, but what moves; moments of contact forces taken back to where they were. Distances are in lengths of the body."""
    (problem, here), by = as_it_is(master), distance * np.array([1.0, 0.7, -0.3])
    there = list(Simulation(moved(problem, by)).run())
    near, far = (np.array([_contact_wrench(result) for result in results]) for results in (here, there))
    back = far[:, 1] - np.cross(by, far[:, 0])
    return differences(measured(here), measured(there)) | {
        "contact": float(np.abs(back - near[:, 1]).max() / distance / np.abs(near[:, 0]).max())
    }


@case(
    claim="A plane is the same by whichever of its points it is given.",
    tier="gate",
    grid={"distance": (1.0, 1e4, 1e8, 1e12)},
    bounds=BOUNDS,
)
def point_of_plane(distance: float) -> dict[str, float]:
    """The plane z = 0 of the scene by a point that is so many units of length aside."""

    def elsewhere(problem: Problem) -> Problem:
        (contact,) = problem.contacts
        assert isinstance(contact.master, RigidPlane)
        plane = replace(contact.master, point=(distance, -0.3 * distance, 0.0))
        return replace(problem, contacts=(replace(contact, master=plane),))

    return change("plane", elsewhere)


#: A turn about the x-axis by an eighth: of a plane z = 0 it makes one that any point with the same y and z is on, exactly.
EIGHTH = np.array([[1.0, 0.0, 0.0], [0.0, np.sqrt(0.5), -np.sqrt(0.5)], [0.0, np.sqrt(0.5), np.sqrt(0.5)]])


@case(
    claim="So it is of a plane that is not along the axes, but for the last bits that its point has.",
    tier="gate",
    grid={"distance": (1e4, 1e6)},
    bounds=lambda distance: {name: bound for name, bound in _last_bits(distance).items() if name != "contact"},
)
def point_of_oblique_plane(distance: float) -> dict[str, float]:
    """The scene turned by an eighth, its plane given by a point that is so many units of length aside."""

    def elsewhere(problem: Problem) -> Problem:
        oblique = turned(problem, EIGHTH)
        (contact,) = oblique.contacts
        assert isinstance(contact.master, RigidPlane)
        plane = replace(contact.master, point=(-0.3 * distance, distance, distance))
        return replace(oblique, contacts=(replace(contact, master=plane),))

    return change("plane", elsewhere, lambda found: found | {"forces": found["forces"] @ EIGHTH, "moments": found["moments"] @ EIGHTH})


def _contact_wrench(result: StepResult) -> tuple[FloatArray, FloatArray]:
    """Force on the slave and its moment about the origin."""
    return result.contacts[0].force_slave, result.contacts[0].moment_slave


@case(
    claim="The units of length and of stress change no result.",
    tier="gate",
    grid={"length": (1e-6, 1.0, 1e6), "stress": (1e-6, 1e6)},
    bounds=BOUNDS,
)
def units(length: float, stress: float) -> dict[str, float]:
    """Lengths and stresses in other units, those of a cohesion and a largest traction too; results taken back to the first ones."""
    return change(
        "capped",
        lambda problem: scaled(problem, length, stress),
        lambda found: {
            "forces": found["forces"] / (stress * length**2),
            "moments": found["moments"] / (stress * length**3),
            "pressures": found["pressures"] / stress,
            "tractions": found["tractions"] / stress,
            "states": found["states"],
        },
    )


@case(
    claim="The mirror image of a scene has the mirror image of its results.",
    tier="gate",
    grid={"master": (*MASTERS, "greville", "knots")},
    bounds=BOUNDS,
)
def mirror_image(master: str) -> dict[str, float]:
    """Reflected in the plane x = 0; moments are axial vectors."""
    return change(master, mirrored, lambda found: found | {"forces": found["forces"] @ MIRROR, "moments": -found["moments"] @ MIRROR})


@case(
    claim="Other knots for the same functions change no result.",
    tier=lambda factor, shift: "gate" if (factor < 1.0) == (shift > 0.0) else "nightly",
    grid={"factor": (1e-3, 4096.0), "shift": (0.0, 0.7)},
    bounds=BOUNDS,
)
def knot_scaling(factor: float, shift: float) -> dict[str, float]:
    """Knots of all directions times a factor, and shifted by a share of their range."""
    return change("block", lambda problem: with_knots(problem, factor, shift * factor))


@case(
    claim="Where knots begin changes no result along averaged normals of a master with kinks, below zero either.",
    tier="gate",
    bounds=BOUNDS,
)
def knots_of_kinks() -> dict[str, float]:
    """Knots of all directions shifted to both sides of zero, of a bowl on Lagrange elements."""
    return change("kinked", lambda problem: with_knots(problem, 1.0, -0.7))


@case(
    claim="Knots of one direction that are far longer than those of another change no result, along closest points or averaged normals.",
    tier="gate",
    grid={"master": ("block", "kinked"), "longer": ("u", "v")},
    bounds=BOUNDS,
)
def uneven_knots(master: str, longer: str) -> dict[str, float]:
    """Knots of u and of v times powers of two, which cost no digits."""
    long, short = 2.0**22, 2.0**-22
    factors = (long, short, 1.0) if longer == "u" else (short, long, 1.0)
    return change(master, lambda problem: with_knots(problem, factors, 0.0))


@case(claim="A factor of all weights changes no result.", tier="gate", grid={"factor": (1e-3, 7.0)}, bounds=BOUNDS)
def weight_scaling(factor: float) -> dict[str, float]:
    """All weights times a factor."""
    return change("block", lambda problem: with_weights(problem, factor))


@case(
    claim="The order of the bodies, the sense and the names of their directions change no result.",
    tier="gate",
    grid={"master": MASTERS},
    bounds=BOUNDS,
)
def relabelling(master: str) -> dict[str, float]:
    """Bodies in reverse order, u and v reversed, u, v, w called w, u, v."""
    return change(master, relabelled)
