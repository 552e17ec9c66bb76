"""The four sections in full: representative dimensions as in the paper, the last numbers as in the bundled scenes."""

from __future__ import annotations

from paper.sections import Quantity, Section, Variant

from isomortar.accuracy.discretisations import Elements

FORCE, MOMENT, DRAG, TORQUE = (
    Quantity("pressing force", "force", "z"),
    Quantity("twisting moment", "moment", "z"),
    Quantity("dragging force", "force", "x"),
    Quantity("rolling torque", "moment", "y"),
)
TOLERANCE, TIGHT = "solver.augmentation_tolerance=0.001", "solver.augmentation_tolerance=0.0001"
#: What the paper says of masters of Lagrange elements, it says of closest points.
CLOSEST = ('contacts.interface.projection="closest"',)
#: What such masters do along averaged normals, beside that; these know the paper's slip sum not.
AVERAGED = ('contacts.interface.projection="averaged"',)
SOFT = ("solver.penalty_normal=10.0", "solver.penalty_tangential=1.0")


def nurbs(elements: Elements, *orders: int) -> tuple[Variant, ...]:
    """NURBS of several orders on the same elements."""
    return tuple(Variant(f"N{p}", f"N{p}", elements, f"NURBS of order {p}") for p in orders)


def lagrange_slave(order: int, elements: Elements) -> tuple[str, ...]:
    """The slave in Lagrange elements along its contact face, linear in the other direction."""
    mesh = "bodies.slave.mesh"
    return (f'{mesh}.family=["L","L","L"]', f"{mesh}.order=[{order},{order},1]", f"{mesh}.elements={list(elements)}")


def averaged(order: int, elements: Elements) -> Variant:
    """A master of Lagrange elements along averaged normals."""
    return Variant(f"L{order}-averaged", f"L{order}", elements, f"L{order} along averaged normals", AVERAGED, ("monolithic",))


def own_method(name: str, kind: str, elements: Elements, title: str, *changes: str) -> Variant:
    """A run about a number of the paper's method."""
    return Variant(name, kind, elements, title, changes, ("paper",))


PRESS = Section(
    scene="press",
    number="4.2",
    title="Local quality: contact tractions",
    quantity=FORCE,
    window=(0.0, 1.0),
    reference="N2-fine",
    series={"N": ("N2", "N3", "N4"), "L": ("L1", "L2", "L3", "L4"), "L>1": ("L2", "L3", "L4")},
    instances=(1, 3, 5),
    variants=(
        *nurbs((12, 12, 6), 2, 3, 4),
        *(Variant(f"L{p}", f"L{p}", (12 // p, 12 // p, 6), f"Lagrange elements of order {p}, as many nodes as L1") for p in (1, 2, 3, 4)),
        Variant("N2-fine", "N2", (24, 24, 6), "reference for NURBS"),
        Variant("L1-fine", "L1", (24, 24, 6), "reference for Lagrange elements"),
        own_method("tolerance", "N2", (12, 12, 6), "N2 with tolerance 0.001", TOLERANCE),
    ),
)

TWIST = Section(
    scene="twist",
    number="4.3",
    title="Global quality I: twisting moment",
    quantity=MOMENT,
    window=(0.25, 1.0),
    reference="N4-fine",
    series={"N": ("N2", "N3", "N4", "N5"), "Lagrange": ("L1", "L2", "slave-L1", "slave-L2"), "averaged": ("L1-averaged", "L2-averaged")},
    instances=(10, 20, 30, 40, 50),
    variants=(
        *nurbs((5, 5, 3), 2, 3, 4, 5),
        Variant("N4-fine", "N4", (8, 8, 3), "reference: eight elements laterally"),
        Variant("coarse", "N4", (3, 3, 3), "N4 with three elements laterally: the 7 x 7 control points of N2 with five"),
        Variant(
            "fine",
            "N2",
            (7, 7, 5),
            "N2 with seven elements laterally and five vertically in both bodies (Fig. 4): 9 control points a side, N5 has 10",
            ("bodies.slave.mesh.elements=[7,7,5]",),
        ),
        own_method("ten-points", "N2", (5, 5, 3), "N2 with ten contact points", "contacts.interface.quadrature=[10,10]"),
        own_method("more-steps", "N2", (5, 5, 3), "N2 in 15 and 60 load steps", "stages.press.steps=15", "stages.twist.steps=60"),
        own_method("fewer-steps", "N2", (5, 5, 3), "N2 in 5 and 20 load steps", "stages.press.steps=5", "stages.twist.steps=20"),
        own_method("tolerance", "N2", (5, 5, 3), "N2 with tolerance 0.001", TOLERANCE),
        own_method("tight", "N2", (5, 5, 3), "N2 with tolerance 0.0001", TIGHT),
        own_method("soft", "N2", (5, 5, 3), "N2 with penalties 10 and 1", *SOFT),
        own_method("soft-tolerance", "N2", (5, 5, 3), "N2 with penalties 10 and 1, tolerance 0.001", *SOFT, TOLERANCE),
        Variant("L1", "L1", (5, 5, 3), "master of Lagrange elements of order 1", CLOSEST),
        Variant("L2", "L2", (3, 3, 3), "master of Lagrange elements of order 2, 7 x 7 nodes as N2", CLOSEST),
        averaged(1, (5, 5, 3)),
        averaged(2, (3, 3, 3)),
        Variant("slave-L1", "N2", (5, 5, 3), "slave of Lagrange elements of order 1, 5 x 5 nodes as N2", lagrange_slave(1, (4, 4, 3))),
        Variant("slave-L2", "N2", (5, 5, 3), "slave of Lagrange elements of order 2, 5 x 5 nodes as N2", lagrange_slave(2, (2, 2, 3))),
    ),
)

IRON = Section(
    scene="iron",
    number="4.4",
    title="Global quality II: dragging force",
    quantity=DRAG,
    window=(0.25, 1.0),
    reference="N5",
    series={
        "N": ("N2", "N3", "N4", "N5"),
        "refined": ("N2", "A", "B"),
        "Lagrange": ("L1", "L2", "slave-L1", "slave-L2"),
        "averaged": ("L1-averaged", "L2-averaged"),
    },
    instances=(10, 20, 30, 40, 50),
    variants=(
        *nurbs((10, 5, 3), 2, 3, 4, 5),
        Variant("A", "N2", (15, 5, 3), "N2 with 15 elements along the drag"),
        Variant("B", "N2", (20, 5, 3), "N2 with 20 elements along the drag"),
        Variant("C", "N2", (10, 5, 3), "N2 pressed down by 0.4 in place of 0.5", ("stages.press.motions.top.translate=[0,0,-0.4]",)),
        Variant("D", "N2", (10, 5, 3), "N2 pressed down by 0.3", ("stages.press.motions.top.translate=[0,0,-0.3]",)),
        own_method("fewer-steps", "N2", (10, 5, 3), "N2 in 5 and 20 load steps", "stages.press.steps=5", "stages.drag.steps=20"),
        Variant("L1", "L1", (10, 5, 3), "master of Lagrange elements of order 1", CLOSEST),
        Variant("L2", "L2", (5, 5, 3), "master of Lagrange elements of order 2 along the drag, as many nodes as L1", CLOSEST),
        averaged(1, (10, 5, 3)),
        averaged(2, (5, 5, 3)),
        Variant("slave-L1", "N2", (10, 5, 3), "slave of Lagrange elements of order 1, 7 x 7 nodes as N2", lagrange_slave(1, (6, 6, 3))),
        Variant("slave-L2", "N2", (10, 5, 3), "slave of Lagrange elements of order 2, 7 x 7 nodes as N2", lagrange_slave(2, (3, 3, 3))),
    ),
)

# Round the ring N^p on 32 elements has 4 (7 + p) control points: four arcs of 8 + p, joined C0. L^p on n elements has p n.
# Matched with N^(p+1): L1 36 (36 elements), L2 40 (20), L4 48 (12); L3 would need 44 / 3 elements.
TIRE = Section(
    scene="tire",
    number="4.5",
    title="Case study: tire traction",
    quantity=TORQUE,
    window=(1 / 6, 1 / 3),
    reference="N2",
    series={"N": ("N2", "N3", "N4"), "L": ("L1", "L2", "L4"), "matched": ("L1-matched", "L2-matched", "L4-matched")},
    instances=(10, 40, 70, 100),
    variants=(
        *nurbs((32, 4, 4), 2, 3, 4),
        *(Variant(f"L{p}", f"L{p}", (32 // p, 4, 4), f"Lagrange elements of order {p}, 32 nodes round the ring") for p in (1, 2, 4)),
        Variant("L1-matched", "L1", (36, 4, 4), "Lagrange elements of order 1, the 36 control points of N2 round the ring"),
        Variant("L2-matched", "L2", (20, 4, 4), "Lagrange elements of order 2, the 40 control points of N3 round the ring"),
        Variant("L4-matched", "L4", (12, 4, 4), "Lagrange elements of order 4, the 48 control points of N5 round the ring"),
        own_method("L2-tolerance", "L2", (16, 4, 4), "L2 with tolerance 0.001", TOLERANCE),
        own_method("L2-points", "L2", (16, 4, 4), "L2 with twice the contact points a direction", "contacts.road.quadrature=[8,8]"),
    ),
)

FULL = (PRESS, TWIST, IRON, TIRE)
