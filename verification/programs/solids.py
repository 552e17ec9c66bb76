"""Solids without contact, by isomortar and by other programs: reactions and positions, where elements are the same one for one."""

from __future__ import annotations

from typing import get_args

import numpy as np
from programs.run import FILES, outcome

from isomortar._arrays import MaterialLaw
from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, Shown, case
from isomortar.model.entities import Problem
from isomortar.program.calculix import LAWS, CalculiX
from isomortar.program.declaration import Outcome, Program
from isomortar.program.getfem import GetFEM
from isomortar.program.own import Isomortar
from isomortar.scene import Scene

#: What is compared.
NUMBERS = ("force", "moment", "position")
#: A block, held below; its top is pressed down by a fifth, pushed aside and turned about a tilted axis.
BLOCK = """
format = 1
name = "block"

[materials.rubber]
young = 10.0
poisson = 0.3
law = "{law}"

[bodies.block]
geometry = {{ kind = "box", lower = [0.0, 0.0, 0.0], upper = [1.0, 0.8, 0.6] }}
mesh = {{ family = "L", order = {order}, elements = {elements} }}

[supports.base]
face = "block.w0"

[supports.top]
face = "block.w1"
axis = [0.2, 0.3, 1.0]
centre = [0.3, 0.4, 0.6]

[[stages]]
name = "press"
steps = 2
motions.top = {{ translate = [0.1, 0.05, -0.12], rotate = 15 }}

[solver]
newton_tolerance = 1e-11
"""


def block(law: str, orders: str, elements: tuple[int, int, int]) -> Problem:
    """The block, of orders by direction as in "123"."""
    return Scene.from_toml(BLOCK.format(law=law, order=[int(order) for order in orders], elements=list(elements))).problem()


def run(program: Program, problem: Problem) -> Outcome:
    """All load steps; skipped where the program is not installed."""
    found = outcome(program, problem)
    if found.ending != "measured":
        raise RuntimeError(f"{program.name}: {found.ending}: {found.words}")
    return found


def reactions(found: Outcome) -> tuple[FloatArray, FloatArray]:
    """Forces and moments of all supports at all load steps, shapes (steps, supports, 3)."""
    forces = np.array([[reaction.force for reaction in step.reactions] for step in found.steps])
    return forces, np.array([[reaction.moment for reaction in step.reactions] for step in found.steps])


def apart(one: Outcome, other: Outcome) -> dict[str, float]:
    """Largest differences: of forces and moments over the largest, of positions where both programs have nodes over the block's length."""
    pairs = dict(zip(NUMBERS[:2], zip(reactions(one), reactions(other), strict=True), strict=True))
    found = {name: float(np.abs(a - b).max() / np.abs(a).max()) for name, (a, b) in pairs.items()}
    places = [np.array([step.positions for step in outcome.steps]) for outcome in (one, other)]
    return {**found, "position": float(np.nanmax(np.abs(places[0] - places[1])))}


@case(
    claim="A solid of each law deforms as in GetFEM, which derives forces and tangent from the stored energy by itself.",
    tier="nightly",
    grid={"law": get_args(MaterialLaw), "orders": ["111", "222", "123"]},
    bounds=dict.fromkeys(
        NUMBERS,
        Bound(at_most=1e-9, reason="round-off: the same elements and Gauss points, Newton's method to 1e-11 in either"),
    ),
    files=FILES,
)
def as_in_getfem(law: str, orders: str) -> dict[str, float]:
    """Lagrange elements of one order, of another by direction."""
    elements = (3, 2, 2) if orders == "111" else (2, 2, 1)
    problem = block(law, orders, elements)
    return apart(run(Isomortar(), problem), run(GetFEM(), problem))


_DIGITS = "reference: seven digits in CalculiX' output file, some units of the last in sums; C3D8 is L1 with 2 x 2 x 2 Gauss points"


@case(
    claim="A solid of CalculiX' laws deforms as in CalculiX, element for element.",
    tier="nightly",
    grid={"law": LAWS},
    bounds={
        **{name: Bound(at_most=1e-6, reason=_DIGITS) for name in NUMBERS},
        "force, the paper's law": Bound(at_least=1e-2, reason="definition: another law must be told apart by the comparison"),
    },
)
def as_in_calculix(law: str) -> dict[str, float]:
    """Linear elements, full integration; and how far off the paper's law would be."""
    chosen = ((Isomortar(), law), (CalculiX(), law), (Isomortar(), "neo-hookean"))
    own, other, paper = (run(program, block(name, "111", (8, 6, 5))) for program, name in chosen)
    return {**apart(own, other), "force, the paper's law": apart(paper, other)["force"]}


@case(
    claim="With elements of order 2, which are others in CalculiX, forces come to be the same under refinement.",
    tier="nightly",
    bounds={
        "force": Shown("definition: largest difference over the largest force, mesh by mesh"),
        "share of the coarser mesh's": Bound(at_most=0.5, reason="theory: both converge, at the singular edges too with an order above 1"),
    },
)
def with_other_elements() -> dict[str, FloatArray]:
    """L2 against C3D20, which has no nodes within faces and elements, on meshes of which each halves the elements of the one before."""
    meshes = [(2 * n, 2 * n, n) for n in (1, 2, 4)]
    pairs = [[run(program, block("neo-hookean-j", "222", mesh)) for program in (Isomortar(), CalculiX())] for mesh in meshes]
    force = np.array([apart(*pair)["force"] for pair in pairs])
    return {"force": force, "share of the coarser mesh's": force[1:] / force[:-1]}


#: The block under a pressure on its top, which is free: it follows the bulge.
PUSHED = (
    BLOCK[: BLOCK.index("[supports.top]")]
    + """
[loads.top]
face = "block.w1"
pressure = 0.5

[[stages]]
name = "press"
steps = 2

[solver]
newton_tolerance = 1e-9
"""
)


@case(
    claim="A pressure that follows its face deforms a solid as in GetFEM.",
    tier="nightly",
    bounds=dict.fromkeys(
        NUMBERS,
        Bound(at_most=1e-9, reason="round-off: the same elements and Gauss points, Newton's method to 1e-9 in either, which is quadratic"),
    ),
    files=FILES,
)
def under_pressure() -> dict[str, float]:
    """Linear elements, full integration. In CalculiX forces of the support are off by 2e-4 here."""
    problem = Scene.from_toml(PUSHED.format(law="neo-hookean-j", order=[1, 1, 1], elements=[4, 3, 3])).problem()
    return apart(run(Isomortar(), problem), run(GetFEM(), problem))
