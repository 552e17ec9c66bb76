"""Smooth contact: pressure times distance is what it should be, against a closed form, and how fast it comes to sharp contact."""

from __future__ import annotations

import itertools
from dataclasses import replace
from decimal import Decimal, localcontext
from typing import Final, Literal

import numpy as np
from friction.sliding import block
from scipy.optimize import brentq

from isomortar import _bindings
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Body, Contact, Face, Material, Motion, Problem, RigidPlane, Stage, Support
from isomortar.model.settings import SolverSettings
from isomortar.solve.record import StepResult

#: Height of the prism, its distance from the plane, and where its top is at the end of each stage: before, at, and beyond touch.
HEIGHT: Final = 0.5
APART: Final = 0.02
TOPS: Final = (-0.01, -0.02, -0.12)
PRODUCT: Final = 1e-3
#: Products of the rate.
PRODUCTS: Final = (1e-7, 5e-8)
SETTINGS: Final = {
    "newton_tolerance": 1e-12,
    "complementarity_tolerance": 1e-12,
    "augmentation_tolerance": 1e-12,
    "penalty_normal": 10.0,
    "penalty_growth": 1.0,
    "max_augmentations": 1000,
}
_SOLVED = "round-off: contact conditions are solved to 1e-12 of the largest pressure, and the least is a thousandth of it"


def prism(method: Literal["monolithic", "uzawa"]) -> Problem:
    """One element that is held at its sides, above a plane: it is stretched or shortened, and nothing else."""
    patch = mesh(box((0, 0, APART), (1.0, 0.8, APART + HEIGHT)), ("N", "N", "N"), (1, 1, 1), (1, 1, 1))
    heights = np.diff([0.0, *TOPS])
    still = (Motion(),) * len(TOPS)
    return Problem(
        name="prism",
        bodies=(Body("body", patch, Material(), (2, 2, 2)),),
        contacts=(Contact("floor", Face("body", "w0"), RigidPlane((0, 0, 0), (0, 0, 1), (1, 0, 0)), 0.0, (2, 2), smoothing=PRODUCT),),
        supports=(
            Support("top", Face("body", "w1"), tuple(Motion((0.0, 0.0, float(height))) for height in heights)),
            *(Support(side, Face("body", side), still, (0,)) for side in ("u0", "u1")),
            *(Support(side, Face("body", side), still, (1,)) for side in ("v0", "v1")),
        ),
        stages=tuple(Stage(f"to {top}", 1) for top in TOPS),
        settings=SolverSettings(method=method, **SETTINGS),  # type: ignore[arg-type]
    )


def exact(top: float) -> float:
    """Pressure on the prism: of W = A1/2 ln(J)^2 + A2/2 (J^(-2/3) tr C - 3) at F = diag(1, 1, J), where it is PRODUCT over the distance."""
    material = Material()

    def stress(ratio: float) -> float:
        bulk, shear = material.bulk, material.shear
        return bulk * np.log(ratio) / ratio + shear * (ratio ** (1 / 3) - (2 + ratio**2) / 3 * ratio ** (-5 / 3))

    def left(distance: float) -> float:
        return -stress((HEIGHT + APART + top - distance) / HEIGHT) - PRODUCT / distance

    return PRODUCT / float(brentq(left, 1e-9, 0.9 * (HEIGHT + APART + top), xtol=1e-16, rtol=1e-15))


@case(
    claim="A prism above a plane is pressed by a constant over its distance, before it would touch and after, by either method.",
    tier="gate",
    grid={"method": ("monolithic", "uzawa")},
    bounds={"pressure": Bound(at_most=1e-9, reason=_SOLVED), "spread": Bound(at_most=1e-9, reason=_SOLVED)},
)
def prism_of_smooth_contact(method: Literal["monolithic", "uzawa"]) -> dict[str, float]:
    """Largest relative error of the force, against the root of one equation, and spread of the control pressures."""
    results = list(Simulation(prism(method)).run())
    force = np.array([-result.reactions[0].force[2] / 0.8 for result in results])
    pressures = np.array([result.state.contacts[0].pressure for result in results])
    expected = np.array([exact(top) for top in TOPS])
    return {
        "pressure": float(np.abs(force / expected - 1.0).max()),
        "spread": float(np.abs(pressures / expected[:, None] - 1.0).max()),
    }


def pressed(smoothing: float, *, keeping: bool = True) -> list[StepResult]:
    """The block with friction, pressed and pushed along."""
    problem = block(((0.1, 2),), direction=30.0)
    contact = replace(problem.contacts[0], smoothing=smoothing)
    measures = tuple(m for m in problem.settings.measures if keeping or m != "keeping")
    return list(Simulation(replace(problem, contacts=(contact,), settings=replace(problem.settings, measures=measures))).run())


@case(
    claim="Wherever a constraint has a place on the master pressure times distance is the same, with friction too, and all of them press.",
    tier="gate",
    grid={"product": (1e-3, 1e-5)},
    bounds={
        "product": Bound(at_most=1e-6, reason="round-off: contact conditions are solved to 1e-11 of all pressures, of which gaps are 1e-5"),
        "least": Bound(at_least=1e-12, reason="definition: no pressure is zero"),
    },
)
def constant_product(product: float) -> dict[str, float]:
    """Largest relative error of pressure times distance, and the least pressure, of all load steps."""
    results = pressed(product)
    pressures = np.array([result.state.contacts[0].pressure for result in results])
    gaps = np.array([result.contacts[0].gap for result in results])
    return {"product": float(np.abs(-pressures * gaps / product - 1.0).max()), "least": float(pressures.min())}


@case(
    claim="Forces and positions come to those of sharp contact in proportion to pressure times distance.",
    tier="gate",
    bounds=dict.fromkeys(
        ("force", "positions"), Bound(at_least=0.9, at_most=1.1, reason="theory: order 1, in the limit of small products (theory 4.18)")
    ),
)
def to_sharp() -> dict[str, float]:
    """Orders of the errors at the end of the press, between two products."""
    sharp, *smooth = [pressed(product)[1] for product in (0.0, *PRODUCTS)]
    force = [float(np.linalg.norm(result.reactions[0].force - sharp.reactions[0].force)) for result in smooth]
    positions = [float(np.abs(result.state.positions - sharp.state.positions).max()) for result in smooth]
    ratio = np.log(PRODUCTS[0] / PRODUCTS[1])
    return {"force": float(np.log(force[0] / force[1]) / ratio), "positions": float(np.log(positions[0] / positions[1]) / ratio)}


@case(
    claim="With a tangent in each iteration Newton's method has order 2 with smooth contact.",
    tier="gate",
    bounds={"order": Bound(at_least=1.8, reason="theory: 2, the tangent is exact and continuous; of three residuals, a tenth less")},
)
def smooth_order() -> dict[str, list[float]]:
    """Observed orders of the load steps of the press."""
    return {"order": [result.newton_order for result in pressed(1e-4, keeping=False)[:2]]}


def root(trial: float, product: float) -> float:
    """The larger root of p (p - trial) = product (theory 4.18), by 60 digits."""
    with localcontext(prec=60):
        half = Decimal(trial) / 2
        return float(half + (half * half + Decimal(product)).sqrt())


@case(
    claim="Pressures have all their digits from far apart to far inside, and so has their slope.",
    bounds={
        name: Bound(at_most=2e-15, reason="round-off: a product, a sum, a root and a quotient of positive numbers")
        for name in ("pressure", "slope")
    },
)
def digits_of_smooth_contact() -> dict[str, float]:
    """Largest relative errors over trial pressures from -1e12 to 1e12, with that product of the scene and one far below."""
    simulation = Simulation(prism("uzawa"))
    pair, state = simulation.equilibrium.pairs[0], simulation.state
    kinematics = pair.kinematics(state.positions, state.contacts[0])
    control = replace(kinematics.control, gap=np.zeros_like(kinematics.control.gap))
    penalty, n = 8.0, len(control.gap)
    errors = []
    for product, size in itertools.product((1e-12 * PRODUCT, PRODUCT), 10.0 ** np.arange(-12, 13)):
        for trial in (-size, size):
            law = replace(pair.law(np.array([penalty, 1.0]), np.full(n, trial), np.zeros((n, 2))), smoothing=product)
            response = _bindings.augmented_multipliers(pair.pair.slave, control, law)
            pressure = root(trial, penalty * product)
            share = pressure / (2.0 * pressure - trial)
            errors.append([response.pressure[0] / pressure - 1.0, response.pressure_slope[0] * control.weight[0] / penalty / share - 1.0])
    return dict(zip(("pressure", "slope"), np.abs(errors).max(axis=0).tolist(), strict=True))
