"""Exact coarse bodies. `isomortar.geometry.refinement.mesh` makes their discretisations."""

from isomortar.geometry.primitives.blocks import bowl, box, cap, wedge
from isomortar.geometry.primitives.turned import ring, sphere, torus

__all__ = ["bowl", "box", "cap", "ring", "sphere", "torus", "wedge"]
