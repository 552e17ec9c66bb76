"""What is stated of the ways of enforcement."""

from __future__ import annotations

from enforcement import known
from enforcement.found import Evidence
from enforcement.plan import WAYS

from isomortar.harness.statement import Statement

#: As many constraints as control points, or the mortar method with slave and master exchanged, or a smooth law of slip.
_ENOUGH = (
    "mortar, averaged", "mortar, swapped", "mortar, elastic slip", "dual", "dual, averaged", "greville", "greville, averaged", "demko",
)  # fmt: skip

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
        methods=tuple(way for way in known.WAYS if way != "kts"),
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
        methods=("knots",),
    ),
    Statement(
        "too many",
        "More constraints than control points spoil the pressures: the largest one is far above that of the mortar method.",
        (),
        Evidence.peak_beside_mortar,
        "largest pressure at the end, or where the run stopped, over that of the mortar method there",
        at_least=2.0,
        reason="definition: what is twice as large is not the pressure of the same mesh",
        methods=("kts",),
    ),
)
