"""Fields of a slave face that pictures show: what they are called, and which control values they have."""

from __future__ import annotations

import numpy as np
from matplotlib.colors import Colormap

from isomortar._frozen import frozen
from isomortar.errors import ResultsError
from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Problem
from isomortar.results import style
from isomortar.results.fields import ContactSurface, contact_surfaces
from isomortar.results.vectors import contact_vectors
from isomortar.solve.record import StepResult

#: Fields of slave faces, and how a colour bar names them.
CONTACT_FIELDS = {
    "pressure": "contact pressure (force / area at rest)",
    "traction": "friction on the slave (force / area at rest)",
    "slip": "slip in the load step (length)",
    "gap": "gap (length; positive is penetration)",
}


@frozen
class FaceField:
    """A field of a slave face: its name among `CONTACT_FIELDS`, and values by control point, of shape (n, 1), or vectors, (n, 3)."""

    surface: ContactSurface
    name: str
    values: FloatArray

    @property
    def label(self) -> str:
        """What a colour bar says."""
        return CONTACT_FIELDS[self.name]

    @property
    def signed(self) -> bool:
        """Whether colours stand for both signs alike."""
        return self.name == "gap"

    @property
    def colours(self) -> Colormap:
        """Those of signed fields, or those of pressures."""
        return style.signed_colours() if self.signed else style.pressure_colours()


def face_field(problem: Problem, step: StepResult, number: int, name: str = "pressure", before: StepResult | None = None) -> FaceField:
    """A field of contact pair `number` at the end of a load step.

    Parameters
    ----------
    problem : Problem
    step : StepResult
    number : int
    name : {"pressure", "traction", "slip", "gap"}
    before : StepResult, optional
        The load step before it, from which slips are counted.

    Raises
    ------
    ResultsError
        A slip is to be shown, and there is no load step before it.
    """
    surface = contact_surfaces(problem, step)[number]
    if name in ("pressure", "gap"):
        values: FloatArray = (surface.pressure if name == "pressure" else surface.gap)[:, None]
    else:
        vectors = contact_vectors(problem, step, before)[number]
        values = vectors.traction if name == "traction" else vectors.slip
    if name == "slip" and np.isnan(values).any():
        raise ResultsError(
            f"slips of load step {step.step} begin at load step {step.step - 1}, of which no state was kept: nothing to draw"
        )
    return FaceField(surface, name, values)
