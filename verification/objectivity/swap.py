"""Slave and master exchanged: nothing changes where meshes match and all sticks; else a difference that refinement takes away."""

from __future__ import annotations

import numpy as np
from slopes import fall

from isomortar.geometry.patch import FloatArray
from isomortar.geometry.primitives import bowl, box
from isomortar.geometry.quadrature import contact_points, volume_points
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, Curve, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Body, Contact, Enforcement, Face, Material, Motion, Problem, Stage, Support
from isomortar.scene import Scene

#: Elements of the bowl a side; the block has one less over a larger width. The edge of the contact lies anywhere in its element.
MESHES = (4, 5, 6, 7, 8, 10, 12)


def pressed(elements: int, slave: str, friction: float) -> Problem:
    """A bowl pressed on a block and moved along it, both cubic along the contact, with the ``bowl`` or the ``block`` as slave.

    The depth stays as it is: both exchanges have the same bodies.
    """
    orders = (3, 3, 1)
    patches = {
        "bowl": mesh(bowl((0.05, 0.02), 0.375, 0.0, 0.06, 0.5), ("N",) * 3, orders, (elements, elements, 2)),
        "block": mesh(box((-0.6, -0.6, -0.5), (0.7, 0.65, 0.0)), ("N",) * 3, orders, (elements - 1, elements - 1, 2)),
    }
    faces = {"bowl": Face("bowl", "w0"), "block": Face("block", "w1")}
    bodies = tuple(
        Body(name, patch, Material(), tuple(volume_points(d) for d in patch.directions))  # type: ignore[arg-type]
        for name, patch in patches.items()
    )
    master = "block" if slave == "bowl" else "bowl"
    along, across = patches[slave].face_directions(faces[slave].face)
    contact = Contact("contact", faces[slave], faces[master], friction, (contact_points(along), contact_points(across)))
    supports = (
        Support("top", Face("bowl", "w1"), (Motion((0.0, 0.0, -0.08)), Motion((0.03, 0.01, 0.0)))),
        Support("floor", Face("block", "w0"), (Motion(), Motion())),
    )
    return Problem("swap", bodies, (contact,), supports, (Stage("press", 1), Stage("move", 2)))


def forces(problem: Problem) -> FloatArray:
    """Forces on the bowl's top at the end of every load step, shape (steps, 3)."""
    return np.array([result.reactions[0].force for result in Simulation(problem).run()])


@case(
    claim="Exchanging slave and master changes the force by 0.5 % at most at twelve elements, and by less the finer the meshes.",
    tier="nightly",
    grid={"friction": (0.0, 0.3)},
    bounds={
        "curve": Bound(at_most=0.1, reason="discretisation: four elements over the bowl, two over the contact"),
        "last": Bound(at_most=5e-3, reason="theory: errors of h^(3/2) in energy norm enter forces squared: 12^-3 = 6e-4, times ten"),
        "order": Bound(
            at_least=1.0, reason="theory: both converge, with 3/2 in energy norm at the edge of the contact; the edge's place scatters it"
        ),
        "low": Bound(at_least=0.0, reason="definition: a change that falls has an order whose 95 % interval is above zero"),
        "high": Bound(at_least=1.5, reason="theory: the interval reaches the order of the energy norm; that of forces is up to twice it"),
    },
)
def slave_and_master(friction: float) -> dict[str, object]:
    """Largest change of the force over the largest force by elements a side, that on the finest mesh, order of its fall with interval."""
    changes = []
    for elements in MESHES:
        one, other = (forces(pressed(elements, slave, friction)) for slave in ("bowl", "block"))
        changes.append(float(np.linalg.norm(one - other, axis=1).max() / np.linalg.norm(one, axis=1).max()))
    return {
        "curve": Curve(MESHES, changes, "elements a side", "relative change of the force", log_x=True),
        "last": changes[-1],
        **fall(MESHES, changes),
    }


#: Two blocks of one footprint and one mesh along it, pressed, sheared and turned while they stick.
_MATCHING = """
format = 1
solver = { newton_tolerance = 1e-11, complementarity_tolerance = 1e-10 }
bodies.upper.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 0.8, 0.5] }
bodies.lower.geometry = { kind = "box", lower = [0, 0, -0.4], upper = [1, 0.8, 0] }
bodies.upper.mesh = { family = "FAMILY", order = ORDER, elements = [3, 2, 2], grading = [0.6, 1, 1] }
bodies.lower.mesh = { family = "FAMILY", order = ORDER, elements = [3, 2, 1], grading = [0.6, 1, 1] }
materials.m = { young = 10, poisson = 0.1 }
contacts.c = { friction = 5, slave = "SLAVE", master = "MASTER", enforcement = "HOW", projection = "PROJECTION" }
supports = { top.face = "upper.w1", base.face = "lower.w0" }
[[stages]]
name = "press"
steps = 1
motions.top.translate = [0, 0, -0.1]
[[stages]]
name = "shear"
steps = 2
motions.top = { translate = [0.02, 0.01, 0], rotate = 2 }
"""
_FACES = ("upper.w0", "lower.w1")
#: Families and orders along u, v, w, and how feet are found.
_KINDS = {
    "N2": ("N", "2", "closest"),
    "N3": ("N", "3", "closest"),
    "of two orders": ("N", "[2, 3, 1]", "closest"),
    "L1": ("L", "1", "averaged"),
    "L2": ("L", "2", "averaged"),
    "averaged": ("N", "2", "averaged"),
}


def _stuck(kind: str, enforcement: Enforcement, faces: tuple[str, ...]) -> tuple[FloatArray, FloatArray]:
    """Forces of the supports at the end of every load step, and positions at the last one; the first of the faces is the slave.

    All constraints bear and stick, or nothing could be said.
    """
    words = dict(zip(("FAMILY", "ORDER", "PROJECTION", "HOW", "SLAVE", "MASTER"), (*_KINDS[kind], enforcement, *faces), strict=True))
    text = _MATCHING
    for name, word in words.items():
        text = text.replace(name, word)
    steps = list(Simulation(Scene.from_toml(text).problem()).run())
    assert all(np.all(contact.status == 1) for step in steps for contact in step.contacts)
    return np.array([[support.force for support in step.reactions] for step in steps]), steps[-1].state.positions


@case(
    claim="Where meshes match and bodies stick slave and master may be exchanged: forces and positions are the same.",
    tier="gate",
    grid={"kind": tuple(_KINDS), "enforcement": ("mortar", "dual", "greville")},
    bounds={
        "forces": Bound(at_most=1e-11, reason="round-off: Newton's method leaves 1e-11 of the inner forces; over the largest one"),
        "positions": Bound(at_most=1e-11, reason="round-off: the same, over the length of the blocks"),
    },
)
def matching(kind: str, enforcement: Enforcement) -> dict[str, float]:
    """Largest change by the exchange."""
    (forces_, places), (others, elsewhere) = (_stuck(kind, enforcement, faces) for faces in (_FACES, _FACES[::-1]))
    return {"forces": float(np.abs(forces_ - others).max() / np.abs(forces_).max()), "positions": float(np.abs(places - elsewhere).max())}
