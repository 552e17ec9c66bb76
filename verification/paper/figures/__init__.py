"""Figures of the paper's kinds: fields over the contact patch, deformed bodies, curves."""

from paper.figures import bodies, closeups, curves, surfaces
from paper.figures.curves import Line
from paper.figures.picture import Panel, Picture

__all__ = ["Line", "Panel", "Picture", "bodies", "closeups", "curves", "surfaces"]
