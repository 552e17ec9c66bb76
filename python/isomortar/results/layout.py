"""What a results file contains: every quantity with its unit and a sentence, and the groups it lives in.

The program knows no units; `unit` names the dimension in terms of the scene's own length and force. ::

    (first 512 bytes)            seal: digest of all bytes that follow
    /scene                       text of the scene file
    /problem/...                 definition of the computation, enough to rebuild every patch
    /curves/<quantity>           one row a recorded step
    /curves/supports/<name>/...  reactions
    /curves/contacts/<name>/...  resultants and counts of a contact pair
    /curves/loads/<name>/...     resultants of a load
    /timings/<phase>             CPU seconds, one row a recorded step
    /counters/<name>             what was done, one row a recorded step
    /orderings/<matrices>        orderings of the unknowns, one row a recorded step: part of what a restart needs
    /log/augmentations           one row an augmentation, in the order in which they happened
    /log/iterations              one row a Newton iteration, in the order in which they happened
    /log/notes                   one row a note of a Newton iteration
    /log/warnings                one row a warning, each once, in the order in which they were told
    /states/...                  one row a kept state: positions, control pressures, ...: enough to restart
    /rates/...                   one row a kept state, NaN where the next step does not go on like that: part of what a restart needs
"""

from __future__ import annotations

from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from isomortar._frozen import frozen

FORMAT = "isomortar results"
#: Of the files that are written. Format 3 had contact forces with the other sign, and is the earliest that is read.
FORMAT_VERSION, EARLIEST_VERSION = 4, 3


@frozen
class Quantity:
    """Type, unit and meaning of a dataset, shape of a row where the data do not tell it, what stands for a value nobody gave.

    `frictional`: of contacts with friction alone; without it all zeros, and not written. `turned`: files of formats before this one have
    it with the other sign.
    """

    dtype: np.dtype
    unit: str
    description: str
    row: tuple[int, ...] = ()
    missing: float | str | None = None
    frictional: bool = False
    turned: int = 0

    def signed(self, values: NDArray[Any], version: int) -> NDArray[Any]:
        """What a file of a format holds, with the sign of today."""
        return 0.0 - values if version < self.turned else values  # zero stays that: not -0


def _real(unit: str, description: str, row: tuple[int, ...] = ()) -> Quantity:
    return Quantity(np.dtype(np.float64), unit, description, row)


def _of_friction(unit: str, description: str, row: tuple[int, ...] = ()) -> Quantity:
    """What is zero without friction; `row` is that of a constraint."""
    return Quantity(np.dtype(np.float64), unit, description, row, frictional=True)


def _later(unit: str, description: str, row: tuple[int, ...] = ()) -> Quantity:
    """Numbers that files did not always hold; not a number where they do not."""
    return Quantity(np.dtype(np.float64), unit, description, row, missing=np.nan)


def _exerted(unit: str, description: str) -> Quantity:
    """A force or moment on a side of a contact; format 3 had what that side exerts."""
    return Quantity(np.dtype(np.float64), unit, description, (3,), turned=4)


def _count(description: str) -> Quantity:
    return Quantity(np.dtype(np.int64), "1", description)


def _flag(description: str) -> Quantity:
    return Quantity(np.dtype(np.int32), "1", description)


TEXT = h5py.string_dtype()


def version_of(file: h5py.File) -> int:
    """Number of a file's format; one that does not tell is as early as any."""
    return int(file.attrs.get("format_version", EARLIEST_VERSION))


#: One value a recorded step, named as in `StepResult`.
STEP = {
    "step": _count("number of the load step, from 1 over all stages"),
    "stage": Quantity(TEXT, "text", "stage that the load step belongs to"),
    "time": _real("load step", "load time"),
    "newton_order": _real("1", "observed order of Newton's method, median over the step's Newton loops; NaN: too few tangents"),
    "substeps": _count("load increments that the step was made of"),
    "cuts": _count("how often a load increment was cut"),
    "next_increment": _real("load step", "load increment that the step-size control tries next, over the longest one that turns allow"),
}

#: Named as in `Reaction`.
REACTION = {
    "force": _real("force", "force that the support exerts on its body", (3,)),
    "moment": _real("force*length", "moment that the support exerts on its body, about the moving centre", (3,)),
    "centre": _real("length", "moving centre of the support", (3,)),
    "displacement": _later("length", "how far the support has gone from where it was at first, by motions and by forces", (3,)),
    "rotation": _later("degrees", "angle by which the support has turned, by motions or by its moment (-180 to 180)"),
}

#: Named as in `LoadResult`.
LOAD = {
    "force": _real("force", "force of the load on its body", (3,)),
    "moment": _real("force*length", "moment of the load on its body, about the origin", (3,)),
}

#: Resultants and counts of a contact pair, named as in `ContactResult`.
CONTACT = {
    "force_slave": _exerted("force", "resultant of the contact forces on the slave"),
    "force_master": _exerted("force", "resultant of the contact forces on the master; of a rigid plane 0"),
    "moment_slave": _exerted("force*length", "moment of the contact forces on the slave, about the origin"),
    "moment_master": _exerted("force*length", "moment of the contact forces on the master, about the origin; of a rigid plane 0"),
    "active": _count("active constraints"),
    "slip": _count("slipping constraints"),
    "pressure_field": _real(
        "force/area", "smallest and largest contact pressure p = sum R^J p^J at the contact quadrature points; per area at rest", (2,)
    ),
    "excluded": _count("contact quadrature points without a projection"),
    "friction_work": _later("force*length", "work that friction took up within the load step"),
    "spurious_work": _later("force*length", "work that pressures along averaged normals took up within the load step; else zero"),
}

#: Restart state of a contact pair, named as in `ContactState`.
CONTACT_STATE = {
    "pressure": _real(
        "force/area", "pressures p^J of the constraints, per area at rest: slave control points (mortar), or points of the slave"
    ),
    "traction": _of_friction("force/area*length/parameter", "covariant tractions tau_alpha^J of the constraints", (2,)),
    "projection": _real("parameter", "master coordinates of the slave quadrature points (on a rigid plane: lengths)"),
    "projected": _flag("1 where the slave quadrature point has a projection on the master, else 0"),
}

#: Measured values of the constraints, named as in `ContactResult`; kept with the states.
CONTACT_VALUES = {
    "traction_norm": _of_friction("force/area", "metric norm of the tractions"),
    "status": _flag("constraints: 0 open, 1 stick, 2 slip"),
    "gap": _real("length", "gap g^J of the constraints, positive is penetration; 0 where the slave has left its master"),
}

STATE_STEP = _count("number of the load step whose state this row is")
POSITIONS = _real(
    "length", "positions of all control points, bodies one after the other, those glued to one right after it, shared points once"
)
#: Named as in `Rates`.
RATES = {
    "time": _later("load step", "load time at which the increment ended that had these rates; NaN: there are none"),
    "positions": _later("length/load step", "rates of the positions of all control points"),
}
#: Named as in `ContactRates`.
CONTACT_RATES = {
    "pressure": _later("force/area/load step", "rates of the pressures of the constraints"),
    "traction": _of_friction("force/area*length/parameter/load step", "rates of the covariant tractions of the constraints", (2,)),
}
TIMING = Quantity(np.dtype(np.float64), "s", "CPU time of all threads in the phase within the load step", missing=np.nan)
ORDERING = Quantity(
    TEXT, "text", "ordering of the unknowns in use since it was chosen, by the number of matrices in the system", missing=""
)
COUNTER = Quantity(np.dtype(np.int64), "1", "what was done within the load step: counts, of sizes the largest", missing=-1)

_AUGMENTATIONS = Quantity(
    np.dtype(
        [
            ("step", np.int64),
            ("augmentation", np.int64),
            ("penalty_normal", np.float64),
            ("penalty_tangential", np.float64),
            ("change_pressure", np.float64),
            ("change_traction", np.float64),
            ("iterations", np.int64),
        ]
    ),
    "penalties: force/area/length; all else: 1",
    "augmentations with the change of multipliers that each made and its number of Newton iterations",
)
_ITERATIONS = Quantity(
    np.dtype(
        [
            ("step", np.int64),
            ("iteration", np.int64),
            ("residual", np.float64),
            ("active", np.int64),
            ("stick", np.int64),
            ("slip", np.int64),
            ("notes", np.int64),
        ]
    ),
    "1",
    "Newton iterations with what was left before the solve (the relative residual, or what the monolithic method is off the contact "
    "conditions where that is more), constraints by state, number of notes",
)

_NOTES = Quantity(TEXT, "text", "what acted in a Newton iteration, in the order of the iterations")

_WARNINGS = Quantity(TEXT, "text", "what was told of the scene and its run, each sentence once, in the order in which it was told")

#: Named as the datasets of the log; warnings were not always among them.
LOG = {"augmentations": _AUGMENTATIONS, "iterations": _ITERATIONS, "notes": _NOTES, "warnings": _WARNINGS}

CONTROL_POINTS = _real("length", "control points in the reference configuration, first direction fastest")
WEIGHTS = _real("1", "weights of the control points, not multiplied into them")
KNOTS = _real("parameter", "N: full open knot vector; L: element boundaries")
