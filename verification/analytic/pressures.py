"""Signs of pressures: what is asked of control pressures makes fields of NURBS, but not of Lagrange elements, press everywhere."""

from __future__ import annotations

import numpy as np

from isomortar.geometry.patch import Direction, Patch
from isomortar.geometry.primitives import bowl
from isomortar.geometry.quadrature import contact_points, volume_points
from isomortar.geometry.refinement import mesh
from isomortar.harness import LAGRANGE, NURBS, Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Body, Contact, Face, Material, Motion, Problem, RigidPlane, Stage, Support
from isomortar.model.settings import SolverSettings
from isomortar.results.bezier import sampling_matrix
from isomortar.results.fields import contact_surfaces

#: Elements a side, samples of the field per element.
ELEMENTS, SAMPLES = 5, 10
_SOLVER = "round-off: contact conditions are solved to 1e-11 of the largest pressure"


def body(kind: str) -> Patch:
    """A bowl; N1 can not hold it: its control points are on it like those of L1, whose functions it has."""
    family, order = ("L", 1) if kind == "N1" else (kind[0], int(kind[1:]))
    patch = mesh(
        bowl((0.0, 0.0), 0.375, 0.0, 0.06, 0.5),
        (family,) * 3,  # type: ignore[arg-type]
        (order, order, order),
        (ELEMENTS, ELEMENTS, 1),
    )
    if kind != "N1":
        return patch
    u, v, w = (Direction("N", 1, np.pad(d.knots, 1, mode="edge")) for d in patch.directions)
    return Patch((u, v, w), patch.control_points, patch.weights)


def pressed(kind: str) -> Problem:
    """The bowl pressed on a rigid plane: its middle in contact, its rim not."""
    patch = body(kind)
    along, across = patch.face_directions("w0")
    return Problem(
        name="bowl-on-plane",
        bodies=(Body("bowl", patch, Material(), tuple(volume_points(d) for d in patch.directions)),),  # type: ignore[arg-type]
        contacts=(
            Contact(
                "base",
                Face("bowl", "w0"),
                RigidPlane((0, 0, 0), (0, 0, 1), (1, 0, 0)),
                0.0,
                (contact_points(along), contact_points(across)),
            ),
        ),
        supports=(Support("top", Face("bowl", "w1"), (Motion((0.0, 0.0, -0.03)),)),),
        stages=(Stage("press", 1),),
        settings=SolverSettings(newton_tolerance=1e-11, complementarity_tolerance=1e-11),
    )


def signs(kind: str) -> dict[str, Bound]:
    """Theory: B-splines are not negative, so that what their coefficients keep their sums keep; Lagrange functions are above order 1."""
    bounds = {
        "control": Bound(at_least=-1e-11, at_most=1.0, reason=_SOLVER),
        "open": Bound(at_least=1.0, reason="definition: signs are tested only where some control points are open"),
    }
    if kind[0] == "N" or kind == "L1":
        return bounds | {"field": Bound(at_least=-1e-11, at_most=1.0, reason="theory: functions are not negative")}
    reason = "theory: beside the last element in contact Lagrange functions above order 1 are negative, a quarter of the peak at most"
    return bounds | {"field": Bound(at_least=-0.25, at_most=-1e-3, reason=reason)}


@case(
    claim="Control pressures never pull; pressure fields of NURBS do not either, those of Lagrange elements above order 1 do.",
    tier=lambda kind: "gate" if int(kind[1:]) <= 3 else "nightly",
    grid={"kind": NURBS + LAGRANGE},
    bounds=signs,
)
def sign(kind: str) -> dict[str, float]:
    """Smallest control pressure and smallest pressure of the field over the largest, and the number of open control points."""
    problem = pressed(kind)
    (result,) = Simulation(problem).run()
    (surface,) = contact_surfaces(problem, result)
    u, v = (sampling_matrix(line, SAMPLES) for line in surface.directions)
    _, field, _ = surface.fields((u, v))
    return {
        "control": float(surface.pressure.min() / surface.pressure.max()),
        "field": float(field.min() / field.max()),
        "open": float(np.sum(surface.status == 0)),
    }
