"""How contact is enforced, and when a load step has converged."""

from __future__ import annotations

from typing import Annotated, Literal, get_args

from pydantic import Field

from isomortar._frozen import frozen
from isomortar.model import constants
from isomortar.model.values import TABLE, Count, Positive, Real

#: What helps Newton's method on the way to the solution (theory 6.5, 7.5); none changes the solution.
#: keeping: factors of an earlier tangent serve for as long as solves with them leave a small share of the residual. The others
#: help the monolithic loop. forgiving: slip rows with the current traction in place of the cone's. margin: what slips at the
#: start of an increment goes on slipping. reversal: predicted slip against its traction sticks instead. halving: updates that
#: fold an element, lose a projection, return to an earlier set of states, or double the merit are halved; in Uzawa's loop those that
#: leave a larger residual. extrapolation: an increment begins where it ends if all goes on as in the last one of its stage.
Measure = Literal["forgiving", "margin", "reversal", "halving", "keeping", "extrapolation"]
#: Residuals and distances that are left stand for an error of the result: above this share none is worth having.
Tolerance = Annotated[Positive, Field(le=1e-3)]
Penalty = Annotated[Real, Field(ge=1e-12, le=1e12)]


@frozen
class SolverSettings:
    """How contact is enforced and when a load step has converged."""

    __pydantic_config__ = TABLE

    method: Literal["monolithic", "uzawa"] = "monolithic"
    """Multipliers as unknowns of one Newton loop per load step (monolithic), or penalties corrected by augmentations (uzawa)."""
    slip_sum: Literal["local", "paper"] = "local"
    """Trial traction from the control point's own slip (local), or summed over active neighbours (paper)."""
    penalty_normal: Penalty = 100.0
    """Base penalty for the gap, times the largest diagonal entry of the tangents of the pair's bodies over the reference area."""
    penalty_tangential: Penalty = 10.0
    """Base penalty for slip, in the same unit; keep it near a tenth of the normal one."""
    penalty_growth: Annotated[Real, Field(ge=1, le=1e6)] = 2.0
    """Factor on the penalties per augmentation within a load step; 1: they stay."""
    penalty_growth_max: Annotated[Real, Field(ge=1, le=1e12)] = 200.0
    """Limit of that growth over the base."""
    augmentation_tolerance: Annotated[Positive, Field(le=0.1)] = 0.01
    """Relative change of the multipliers, and distance from the contact conditions, below which augmentations have converged."""
    augmentation_norm: Literal["separate", "paper"] = "separate"
    """Pressures and tractions tested each in their norm (separate), or in the paper's single norm, which mixes units."""
    newton_tolerance: Tolerance = 1e-9
    """Residual over the internal force of each body below which Newton's method has converged."""
    complementarity_tolerance: Tolerance = 1e-8
    """Monolithic: relative distance of pressures and tractions from the contact conditions."""
    max_augmentations: Count = 100
    """Augmentations after which a load step is cut."""
    max_iterations: Count = 30
    """Tangents of a Newton loop after which a load step is cut; up to four times as many while a front of contact or slip gets on."""
    max_cuts: Annotated[int, Field(strict=True, ge=0, le=constants.MOST_CUTS)] = 8
    """How often a load step may be halved before the run ends; 30 times is to a billionth."""
    measures: tuple[Measure, ...] = get_args(Measure)
    """What helps Newton's method on the way; leave one out to see what it does."""
    path_tolerance: Annotated[Positive, Field(le=1)] | None = None
    """Error of the multipliers that a load increment may make, estimated by halving it; absent: the load steps as given."""
    engine: Literal["own", "mumps"] = "own"
    """What factorises the bodies: this process (own), or MUMPS on several ranks, of several machines too (mumps, where it is built in)."""
    compression: Annotated[Real, Field(ge=0, le=0.01)] = 0.0
    """By mumps: what blocks of low rank may leave out of the bodies' factors, over their diagonal; solutions are refined. 0: nothing."""
