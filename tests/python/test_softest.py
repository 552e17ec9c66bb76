"""Parameters of contact come from the stiffest element of bodies that are as soft as the softest of a pair (theory 5.7)."""

from __future__ import annotations

import numpy as np
import pytest

from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: Two blocks whose elements and materials differ.
SCENE = """
format = 1
contacts.pair = { slave = "upper.w0", master = "lower.w1" }
supports = { top.face = "upper.w1", base.face = "lower.w0" }
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.01] }]
materials = { one = { young = UPPER, poisson = 0.3 }, other = { young = LOWER, poisson = 0.3 } }
[bodies.upper]
geometry = { kind = "box", lower = [-0.4, -0.4, 0.0], upper = [0.4, 0.4, 0.6] }
material = "one"
mesh = { elements = [A, 1, 2] }
[bodies.lower]
geometry = { kind = "box", lower = [-1, -1, -1], upper = [1, 1, 0] }
material = "other"
mesh = { elements = [B, 2, 1] }
"""


def stiffness(upper: float, lower: float, elements: tuple[int, int]) -> tuple[float, float]:
    """That of the pair, and the largest diagonal entry of all tangents by themselves."""
    text = SCENE.replace("UPPER", str(upper)).replace("LOWER", str(lower))
    equilibrium = Simulation(Scene.from_toml(text.replace("A,", f"{elements[0]},").replace("B,", f"{elements[1]},")).problem()).equilibrium
    at = equilibrium.numbering.reference
    _, tangent = equilibrium.solid.forces_and_tangent(at)
    largest = float(np.einsum("kii->ki", tangent[equilibrium.solid.diagonal]).max())
    return equilibrium.pairs[0].stiffness(equilibrium.measures.scales(at)), largest


@pytest.mark.parametrize("elements", [(1, 1), (6, 1), (1, 6)])
@pytest.mark.parametrize("moduli", [(1.0, 1.0), (1.0, 1e5), (1e5, 1.0)])
def test_the_stiffest_element_of_bodies_as_soft_as_the_softest(moduli: tuple[float, float], elements: tuple[int, int]) -> None:
    """On whichever side of the contact it is: the same as that of a pair of equal moduli, where it is the tangents' largest entry."""
    soft, largest = stiffness(1.0, 1.0, elements)
    assert soft == pytest.approx(largest, rel=1e-12)
    assert stiffness(*moduli, elements)[0] == pytest.approx(soft, rel=1e-9)
