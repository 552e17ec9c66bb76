"""What is stated of masters with kinks."""

from __future__ import annotations

from masters.found import Evidence

from isomortar.harness.statement import Statement

#: Where averaged normals were tried first; there as here every linear solve has a tangent of its own.
_TRIED = "reference: an independent program took"

STATEMENTS: tuple[Statement[Evidence], ...] = (
    Statement(
        "ending",
        "Along averaged normals every load step converges.",
        (),
        Evidence.missing,
        "load steps that are missing",
        at_most=0.0,
        reason="definition: a method that stops has not computed the scene",
        methods=("averaged",),
    ),
    Statement(
        "tangents",
        "Load steps take few tangents.",
        (),
        Evidence.tangents,
        "tangents that were factorised in a load step, median over all",
        at_most=6.0,
        reason=f"{_TRIED} 4 to 6",
        methods=("averaged",),
    ),
    Statement(
        "cuts",
        "Load increments are hardly ever cut.",
        (),
        Evidence.cuts,
        "cuts of load increments in all runs but those of the refinement",
        at_most=5.0,
        reason=f"{_TRIED} 5 cuts in the worst run",
        methods=("averaged",),
    ),
    Statement(
        "block, cuts",
        "The block of linear elements slides over kinks without a cut.",
        (),
        Evidence.cuts_of_block,
        "cuts of load increments",
        at_most=0.0,
        reason=f"{_TRIED} none",
        methods=("averaged",),
    ),
    Statement(
        "block, tangents",
        "It takes no more tangents than elsewhere.",
        (),
        Evidence.tangents_of_block,
        "tangents that were factorised in all load steps",
        at_most=75.0,
        reason=f"{_TRIED} 72",
        methods=("averaged",),
    ),
    Statement(
        "spurious work",
        "Its share of the friction work falls as the master is refined.",
        (),
        Evidence.spurious,
        "spurious over friction work, over the same on the next coarser master",
        at_most=1.0,
        reason="theory: averaged normals become those of the surface as facets become small",
        methods=("averaged",),
    ),
    Statement(
        "drag",
        "The mean drag comes nearer to that of a smooth master refined likewise.",
        (),
        Evidence.apart,
        "how far the mean is off that of N2 along averaged normals on the same elements, over the same on the next coarser ones",
        at_most=1.0,
        reason="theory: both converge to the same solution",
        methods=("averaged",),
    ),
    Statement(
        "GetFEM",
        "The work of pushing the linear block differs from GetFEM's by no more than what is spurious of both.",
        (),
        Evidence.beside_getfem,
        "difference of the works of the tangential force, over the sum of the sizes of the spurious works",
        at_most=1.0,
        reason="theory: without spurious work both would push against friction and the bodies' energy alone, on the same elements",
        methods=("averaged",),
    ),
)
