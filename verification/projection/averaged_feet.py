"""Which foot along averaged normals, where there are several: the near side that faces the slave, and the one that was there before."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np

from isomortar import _bindings
from isomortar.errors import LostProjectionError
from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Body, Contact, Face, Material, Problem
from isomortar.scene import Scene
from isomortar.solve.contact import PairMechanics
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.record import ContactState
from isomortar.solve.timing import Ledger

#: A block in a ring, its lower face nearer to the ring above than to that below.
_IN_A_RING = """
format = 1
bodies.ring.geometry = { kind = "ring", inner = 0.3, outer = 0.5, width = 0.4 }
bodies.ring.mesh.elements = [12, 1, 1]
bodies.block.geometry = { kind = "box", lower = [-0.05, -0.1, 0.05], upper = [0.05, 0.1, 0.15] }
contacts.inside = { slave = "block.w0", master = "ring.v0", projection = "averaged", quadrature = 3 }
supports.outside.face = "ring.v1"
supports.top.face = "block.w1"
stages = [{ name = "down", steps = 1, motions.top.translate = [0, 0, -0.02] }]
"""
#: A block on top of a ring of flat elements or of others, over its seam.
_OVER_THE_SEAM = """
format = 1
bodies.ring.geometry = { kind = "ring", inner = 0.3, outer = 0.5, width = 0.4 }
bodies.ring.mesh = { family = "FAMILY", order = ORDER, elements = [12, 1, 1] }
bodies.block.geometry = { kind = "box", lower = [-0.1, -0.1, 0.45], upper = [0.1, 0.1, 0.6] }
bodies.block.mesh.elements = [2, 1, 1]
contacts.top = { slave = "block.w0", master = "ring.v1", projection = "averaged", quadrature = 4 }
supports.inside.face = "ring.v0"
supports.top.face = "block.w1"
stages = [{ name = "down", steps = 1, motions.top.translate = [0, 0, -0.02] }]
"""
#: A block on the flat side of a ring, which is closed in the first of its directions, as the others are in the second.
_ON_ITS_SIDE = """
format = 1
bodies.ring.geometry = {{ kind = "ring", inner = 0.3, outer = 0.5, width = 0.4 }}
bodies.ring.mesh.elements = [12, 1, 1]
bodies.block.geometry = {{ kind = "box", lower = [-0.1, 0.2, 0.3], upper = [0.1, 0.35, 0.5] }}
contacts.top = {{ slave = "block.v0", master = "ring.w0", projection = "{projection}", quadrature = 4 }}
supports.base.face = "ring.w1"
supports.top.face = "block.v1"
stages = [{{ name = "down", steps = 1, motions.top.translate = [0, -0.02, 0] }}]
"""
#: Half the width of a trough z = x^2, its elements along x, and how high above it the slave is: from there one foot is on either side.
HALF, ELEMENTS, HEIGHT = 1.0, 24, 0.9
#: How high a small block is above a flat element.
HOVER = 0.05
#: Largest gaps of feet as shares of the diagonal of a master's face, closed and open, and the least cosine between normals (theory 3.30).
DEEP, WIDE, FACING = 0.1, 0.5, 0.2
#: Gaps over the largest closed one, or, below zero, over the largest open one; and cosines.
GAPS, COSINES = (-1.3, -1.001, -0.999, -0.3, 0.0, 0.999, 1.001, 1.3, 3.0), (1.0, 0.201, 0.199, 0.0, -0.201, -1.0)


def trough() -> Problem:
    """A small block over a trough of quadratic elements."""
    curve, line = Direction("N", 2, np.repeat([0.0, 1.0], 3)), Direction("N", 1, np.repeat([0.0, 1.0], 2))
    x, y, z = (a.ravel(order="F") for a in np.meshgrid([-HALF, 0.0, HALF], [-0.3, 0.3], [-1.0, 0.0], indexing="ij"))
    points = np.column_stack([x, y, z + np.where(x == 0.0, -(HALF**2), HALF**2)])
    master = mesh(Patch((curve, line, line), points, np.ones(12)), ("L", "L", "L"), (2, 1, 1), (ELEMENTS, 2, 1))
    x, y, z = (a.ravel(order="F") for a in np.meshgrid([-0.02, 0.02], [-0.1, 0.1], [HEIGHT, HEIGHT + 0.2], indexing="ij"))
    slave = Patch((line, line, line), np.column_stack([x, y, z]), np.ones(8))
    bodies = tuple(Body(name, patch, Material(), (3, 2, 2)) for name, patch in (("slave", slave), ("master", master)))
    contact = Contact("interface", Face("slave", "w0"), Face("master", "w1"), 0.0, (3, 3), projection="averaged")
    return Problem("trough", bodies, (contact,), (), ())


def places(pair: PairMechanics, positions: FloatArray) -> FloatArray:
    """Slave points, shape (points, 3)."""
    slave = pair.pair.slave
    nodes = np.repeat(slave.shape.nodes, slave.per_element, axis=0)
    return np.einsum("qa,qak->qk", slave.shape.values, positions[slave.point][nodes])


@case(
    claim="Where the master is on both sides of the slave, its feet along averaged normals are where the faces look at each other, though "
    "the other side is nearer.",
    bounds={
        "missing": Bound(0.0, 0.0, "definition: the ring is all round"),
        "gap": Bound(at_most=1e-4, reason="discretisation: of a ring's normals by three elements an arc; the other side is nearer by 0.1"),
    },
)
def facing() -> dict[str, float]:
    """Slave points without a foot; largest difference of gaps from the distance to the ring below, along its radius."""
    equilibrium = Equilibrium(Scene.from_toml(_IN_A_RING).problem(), Ledger())
    pair, state = equilibrium.pairs[0], equilibrium.initial_state()
    kinematics = pair.kinematics(state.positions, state.contacts[0])
    control = kinematics.control
    radius = np.hypot(*places(pair, state.positions)[:, [0, 2]].T)
    area = pair.pair.slave.area
    gap = -(0.3 + float(area @ radius) / area.sum())
    return {
        "missing": float(np.count_nonzero(kinematics.projections.found == 0)),
        "gap": abs(float(control.gap.sum() / control.weight.sum()) - gap),
    }


@case(
    claim="Along averaged normals the seam of a closed master is a line as any other: gaps on both sides of it are the same.",
    grid={"kind": ("L1", "L2", "L3", "N2", "N3")},
    bounds={
        "missing": Bound(0.0, 0.0, "definition: the ring is all round"),
        "apart": Bound(at_most=1e-12, reason="round-off: the scene is its own mirror image"),
        "slant": Bound(at_least=1e-3, reason="definition: gaps differ along the slave, or their symmetry tells nothing"),
    },
)
def at_the_seam(kind: str) -> dict[str, float]:
    """Slave points without a foot; largest difference of control gaps from those mirrored at the seam, and of them all."""
    text = _OVER_THE_SEAM.replace("FAMILY", kind[0]).replace("ORDER", kind[1])
    equilibrium = Equilibrium(Scene.from_toml(text).problem(), Ledger())
    pair, state = equilibrium.pairs[0], equilibrium.initial_state()
    kinematics = pair.kinematics(state.positions, state.contacts[0])
    gap = kinematics.control.gap / kinematics.control.weight
    places = equilibrium.numbering.reference[pair.pair.slave.point]
    mirrored = np.linalg.norm(places[:, None] * [-1.0, 1.0, 1.0] - places, axis=2).argmin(axis=1)
    return {
        "missing": float(np.count_nonzero(kinematics.projections.found == 0)),
        "apart": float(np.abs(gap - gap[mirrored]).max()),
        "slant": float(np.ptp(gap)),
    }


@case(
    claim="A foot along averaged normals is followed from element to element, either way, though another one comes nearer; without one "
    "before, it is the nearest.",
    grid={"side": (-1, 1)},
    bounds={
        "left": Bound(0.0, 0.0, "definition: no foot changes to the other side"),
        "nearest": Bound(0.0, 0.0, "definition: the smallest gap counts, on the slave's own side of the middle"),
        "crossed": Bound(at_least=2.0, reason="definition: feet cross lines, or nothing is followed"),
    },
)
def followed(side: int) -> dict[str, float]:
    """Feet that have left their side, or are not on the nearer one when nothing is known; lines that the first point's foot has crossed."""
    equilibrium = Equilibrium(trough(), Ledger())
    pair, start = equilibrium.pairs[0], equilibrium.initial_state()
    moved, nothing = equilibrium.numbering.points["slave"], start.contacts[0]
    nothing = replace(nothing, projected=np.zeros_like(nothing.projected))
    state: ContactState | None = None
    left = nearest = 0
    elements = set()
    for shift in 0.15 * side * np.concatenate([np.linspace(1.0, -1.0, 14), np.linspace(-1.0, 1.0, 14)]):
        positions = start.positions.copy()
        positions[moved, 0] += shift
        alone = pair.kinematics(positions, nothing).projections
        nearest += int(np.count_nonzero((alone.xi[:, 0] - 0.5) * places(pair, positions)[:, 0] <= 0.0) + np.count_nonzero(alone.found == 0))
        kinematics = pair.kinematics(positions, state or nothing)
        left += int(np.count_nonzero((kinematics.projections.xi[:, 0] - 0.5) * side <= 0.0))
        elements.add(int(kinematics.projections.element[0, 0]))
        state = replace(nothing, projection=kinematics.projections.xi, projected=kinematics.projections.followed)
    return {"left": float(left), "nearest": float(nearest), "crossed": len(elements) - 1.0}


@case(
    claim="A ring is closed in either direction of a face without a pole at its edges: it has averaged normals on its flat sides too.",
    bounds={"force": Bound(at_most=2.5e-3, reason="theory: normals turn by 0.02 over the width of 0.4 at most, which counts squared")},
)
def on_the_side_of_a_ring() -> dict[str, float]:
    """Relative difference of the force from that along closest points."""
    forces = []
    for projection in ("closest", "averaged"):
        *_, last = Simulation(Scene.from_toml(_ON_ITS_SIDE.format(projection=projection)).problem()).run()
        forces.append(last.reactions[1].force)
    return {"force": float(np.linalg.norm(forces[1] - forces[0]) / np.linalg.norm(forces[0]))}


@case(
    claim="A foot along averaged normals is the same wherever its search began: in the foot before a motion, or nowhere.",
    grid={"kind": ("L2", "N2"), "shift": (0.003, 0.03)},
    bounds={
        "missing": Bound(0.0, 0.0, "definition: the ring is all round"),
        "foot": Bound(at_most=1e-11, reason="round-off: Newton's method ends below it on coordinates of size one"),
        "gap": Bound(at_most=1e-12, reason="round-off: as above, of lengths of a tenth"),
        "moved": Bound(at_least=1e-3, reason="definition: or both began at the foot"),
    },
)
def from_anywhere(kind: str, shift: float) -> dict[str, float]:
    """Points without a foot; largest differences of feet and mean gaps, and how far feet went, of a block that goes over a ring."""
    text = _OVER_THE_SEAM.replace("FAMILY", kind[0]).replace("ORDER", kind[1])
    equilibrium = Equilibrium(Scene.from_toml(text).problem(), Ledger())
    pair, begun = equilibrium.pairs[0], equilibrium.initial_state()
    nothing = replace(begun.contacts[0], projected=np.zeros_like(begun.contacts[0].projected))
    positions = begun.positions.copy()
    positions[equilibrium.numbering.points["block"]] += [shift, 0.3 * shift, 0.1 * shift]
    followed, found = (pair.kinematics(positions, start) for start in (begun.contacts[0], nothing))
    gaps = [kinematics.control.gap / kinematics.control.weight for kinematics in (followed, found)]
    return {
        "missing": float(np.count_nonzero(followed.projections.found == 0) + np.count_nonzero(found.projections.found == 0)),
        "foot": float(np.abs(followed.projections.xi - found.projections.xi).max()),
        "gap": float(np.abs(gaps[0] - gaps[1]).max()),
        "moved": float(np.abs(followed.projections.xi - begun.contacts[0].projection).max()),
    }


def kite(corner: int) -> Problem:
    """A small block above a far corner of a flat element, by the number of that corner; all else of the element is near its middle."""
    line = Direction("L", 1, np.array([0.0, 1.0]))
    ends = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])
    way = 2.0 * ends[corner] - 1.0
    plan, (x, y) = ends + 2.0 * way * (np.arange(4) == corner)[:, None], ends[corner] + 1.4 * way
    points = np.vstack([np.column_stack([plan, np.full(4, z)]) for z in (-1.0, 0.0)])
    small = np.vstack([np.column_stack([[x, y] + 0.2 * (ends - 0.5), np.full(4, z)]) for z in (HOVER, HOVER + 0.2)])
    bodies = tuple(
        Body(name, Patch((line,) * 3, at, np.ones(8)), Material(), (2, 2, 2)) for name, at in (("small", small), ("kite", points))
    )
    contact = Contact("interface", Face("small", "w0"), Face("kite", "w1"), 0.0, (3, 3), projection="averaged")
    return Problem("kite", bodies, (contact,), (), ())


@case(
    claim="Feet are found in all of an element, though one of its corners is far from the others, whichever it is.",
    grid={"corner": (0, 1, 2, 3)},
    bounds={
        "missing": Bound(0.0, 0.0, "definition: the element is below all of the block"),
        "gap": Bound(at_most=1e-13, reason="round-off: the element is flat, its normals are parallel"),
        "foot": Bound(at_most=1e-13, reason="round-off: of the element's bilinear functions at the foot"),
    },
)
def far_corner(corner: int) -> dict[str, float]:
    """Points without a foot; largest errors of gaps, and of where feet are."""
    equilibrium = Equilibrium(kite(corner), Ledger())
    pair, start = equilibrium.pairs[0], equilibrium.initial_state()
    nothing = replace(start.contacts[0], projected=np.zeros_like(start.contacts[0].projected))
    kinematics = pair.kinematics(start.positions, nothing)
    u, v = kinematics.projections.xi.T
    functions = np.column_stack([(1.0 - u) * (1.0 - v), u * (1.0 - v), (1.0 - u) * v, u * v])
    feet = functions @ equilibrium.problem.body("kite").patch.control_points[4:]
    return {
        "missing": float(np.count_nonzero(kinematics.projections.found == 0)),
        "gap": float(np.abs(kinematics.control.gap / kinematics.control.weight + HOVER).max()),
        "foot": float(np.abs(feet[:, :2] - places(pair, start.positions)[:, :2]).max()),
    }


def over_a_cube() -> Problem:
    """A tiny block on top of a cube, which is deeper than feet are looked for."""
    line = Direction("N", 1, np.repeat([0.0, 1.0], 2))

    def block(lower: tuple[float, float, float], upper: tuple[float, float, float]) -> Patch:
        x, y, z = (a.ravel(order="F") for a in np.meshgrid(*zip(lower, upper, strict=True), indexing="ij"))
        return Patch((line, line, line), np.column_stack([x, y, z]), np.ones(8))

    tiny, cube = block((-1e-6, -1e-6, 0.0), (1e-6, 1e-6, 2e-6)), block((-0.45, -0.55, -1.0), (0.6, 0.5, 0.0))
    cube = mesh(cube, ("L", "L", "L"), (1, 1, 1), (3, 2, 1))
    bodies = tuple(Body(name, patch, Material(), (2, 2, 2)) for name, patch in (("tiny", tiny), ("cube", cube)))
    contact = Contact("interface", Face("tiny", "w0"), Face("cube", "w1"), 0.0, (2, 2), projection="averaged")
    return Problem("cube", bodies, (contact,), (), ())


@case(
    claim="A foot along averaged normals is one only where it is neither too deep, nor too far, and the sides face each other: all three, "
    "whether it was followed or is found; what was there before and is too deep now has passed through.",
    bounds={
        "accepted": Bound(0.0, 0.0, "definition: one of the three does not hold"),
        "refused": Bound(0.0, 0.0, "definition: all three hold"),
        "passed": Bound(0.0, 0.0, "definition: what had a foot and is too deep is told, nothing else is"),
        "kinds": Bound(6.0, 6.0, "definition: too deep, too far or neither, each facing and not: all that there is"),
    },
)
def all_three() -> dict[str, float]:
    """Points with a foot that has no right to be one, and without one that has; wrong refusals; combinations of the three."""
    equilibrium = Equilibrium(over_a_cube(), Ledger())
    pair, start = equilibrium.pairs[0].pair, equilibrium.numbering.reference
    moved, size = equilibrium.numbering.points["tiny"], float(np.hypot(1.05, 1.05))
    n = len(pair.slave.area)
    none, had, xi = np.zeros(n, dtype=np.int32), np.ones(n, dtype=np.int32), np.full((n, 2), 0.5)
    near = _bindings.project_points(pair.slave, pair.master, start, xi, none)
    accepted = refused = passed = 0
    kinds = set()
    for gap, cosine in product(GAPS, COSINES):
        deep, wide, facing = gap > 1.0, gap < -1.0, cosine > FACING
        kinds.add((deep, wide, facing))
        sine, positions = np.sqrt(1.0 - cosine**2), start.copy()
        positions[moved] = start[moved] @ np.array([[1.0, 0.0, 0.0], [0.0, cosine, sine], [0.0, -sine, cosine]])
        positions[moved, 2] -= gap * size * (DEEP if gap > 0.0 else WIDE)
        for before, known in ((none, None), (none, near), (had, None)):
            lost = False
            try:
                feet = _bindings.project_points(pair.slave, pair.master, positions, near.xi, before, near=known)
            except LostProjectionError:
                lost = True
            passed += lost != (deep and before is had)
            if not lost:
                accepted += int(np.count_nonzero(feet.found)) if deep or wide or not facing else 0
                refused += int(np.count_nonzero(feet.found == 0)) if not deep and not wide and facing else 0
    return {"accepted": float(accepted), "refused": float(refused), "passed": float(passed), "kinds": float(len(kinds))}
