"""What is stated of the ways of enforcement."""

from __future__ import annotations

from functools import partial

from enforcement import known
from enforcement.contact import IN_CELLS
from enforcement.found import Evidence
from enforcement.plan import WAYS

from isomortar.harness.statement import Statement

#: As many constraints as control points, or the mortar method with slave and master exchanged, or in cells.
_ENOUGH = (
    "mortar, averaged", "mortar, swapped", IN_CELLS, "dual", "dual, averaged",
    "greville", "greville, averaged", "demko", "demko, averaged",
)  # fmt: skip
#: Laws that are smooth where Coulomb's and that of contact have corners.
_SMOOTH = ("mortar, elastic slip", "mortar, smooth")
#: The scene whose bodies are splines and have sharp edges.
_EDGES = "block N2"
#: Order from which on dual functions are said to be large.
_LARGE = 3

STATEMENTS: tuple[Statement[Evidence], ...] = (
    Statement(
        "ending",
        "Every load step of every scene converges.",
        (),
        Evidence.missing,
        "load steps that are missing",
        at_most=0.0,
        reason="definition: a method that stops has not computed the scene",
        methods=tuple(WAYS),
    ),
    Statement(
        "as good",
        "With as many constraints as control points a curve is as near to that of finer meshes as the mortar method's.",
        (),
        Evidence.beside_mortar,
        "distance of the curve from the reference's, over that of the mortar method on the same meshes",
        at_most=2.0,
        reason="definition: twice the error is what another half an order of the mesh would cost",
        methods=_ENOUGH,
    ),
    Statement(
        "as theory",
        "Unless constraints are too many, tractions are as near the exact ones as elements can be whose edge is a root.",
        (),
        Evidence.beside_strip,
        "distance of the tractions from the exact ones, over that of a root missed by a third over two elements",
        at_most=1.0,
        reason="theory: 1.2 h / a at the edge of contact, and as much again at that of stick",
        methods=tuple(way for way in known.WAYS if way not in ("kts", *_SMOOTH)),
    ),
    Statement(
        "too many",
        "More constraints than control points spoil exact tractions: they are farther off than a root at the edge explains.",
        (),
        Evidence.beside_strip,
        "distance of the tractions from the exact ones, over that of a root missed by a third over two elements",
        at_least=1.0,
        reason="theory: 1.2 h / a at the edge of contact, and as much again at that of stick",
        methods=("kts",),
    ),
    Statement(
        "too few",
        "Fewer constraints than control points spoil the curve: it is farther from that of finer meshes than the mortar method's.",
        (),
        Evidence.with_fewer_beside_mortar,
        "distance of the curve from the reference's, over that of the mortar method on the same meshes",
        at_least=1.0,
        reason="definition: an error that is larger",
        methods=("knots", "knots, averaged"),
    ),
    Statement(
        "rank, too few",
        "Unique knots are too few constraints above order 1: some motions of the face are not constrained.",
        (),
        partial(Evidence.counted, key="too few", least=2),
        "control points beyond the rank of the constraints",
        at_least=1.0,
        reason="definition: one at least",
        methods=("knots",),
    ),
    Statement(
        "rank, too many",
        "Quadrature points are too many constraints, at every order: pressures depend on each other.",
        (),
        partial(Evidence.counted, key="too many"),
        "constraints beyond their rank",
        at_least=1.0,
        reason="definition: one at least",
        methods=("kts",),
    ),
    Statement(
        "patch test",
        "Cells along the master's knot lines make the mortar method pass the patch test on flat meshes that do not match.",
        (),
        partial(Evidence.counted, key="other"),
        "largest relative error of the pressures",
        at_most=1e-8,
        reason="definition: to round-off, with what sums and Newton's method leave",
        methods=(IN_CELLS,),
    ),
    Statement(
        "dual, smooth",
        "Tractions by dual functions oscillate less than the mortar method's.",
        (),
        Evidence.rougher_than_mortar,
        "second-difference energy of the tractions over the mortar method's",
        at_most=0.5,
        reason="definition: less than half",
        methods=("dual",),
    ),
    Statement(
        "dual, stable",
        "From order 3 on dual functions are large, and the pressure is hardly determined by the motion.",
        (),
        partial(Evidence.stable_beside_mortar, least=_LARGE),
        "inf-sup constant over the mortar method's",
        at_most=0.1,
        reason="definition: an order of magnitude",
        methods=("dual",),
    ),
    Statement(
        "dual, edges",
        "Over sharp edges dual functions take many more solves than the mortar method.",
        (),
        partial(Evidence.solves_beside_mortar, edges=_EDGES),
        "linear solves over the mortar method's",
        at_least=2.0,
        reason="definition: twice as many",
        methods=("dual",),
    ),
    Statement(
        "smooth laws",
        "Elastic slip, or distance under unit pressure, of a thousandth of a body costs a curve less than its mesh does.",
        (),
        Evidence.costs_beside_mesh,
        "distance from the mortar method's curve on the same mesh, over that of the latter from the reference",
        at_most=1.0,
        reason="definition: an error that is smaller",
        methods=_SMOOTH,
    ),
    Statement(
        "too many",
        "More constraints than control points spoil the pressures: the largest one is far above that of the mortar method.",
        (),
        Evidence.peak_beside_mortar,
        "largest pressure at the end, or where the run stopped, over that of the mortar method there",
        at_least=2.0,
        reason="definition: what is twice as large is not the pressure of the same mesh",
        methods=("kts", "kts, averaged"),
    ),
)
