"""The quick sections: the same runs by name, N2, N3, L1 and L2 only, on coarse meshes in few load steps. They try the machinery."""

from __future__ import annotations

from paper.plans import CLOSEST, DRAG, FORCE, MOMENT, TOLERANCE, TORQUE, averaged, nurbs, own_method
from paper.sections import Section, Variant

PRESS = Section(
    scene="press",
    number="4.2",
    title="Local quality: contact tractions",
    quantity=FORCE,
    window=(0.0, 1.0),
    reference="N2-fine",
    series={"N": ("N2", "N3"), "L": ("L1", "L2"), "L>1": ("L2",)},
    instances=(2,),
    variants=(
        *nurbs((3, 3, 1), 2, 3),
        Variant("L1", "L1", (4, 4, 1), "Lagrange elements of order 1"),
        Variant("L2", "L2", (2, 2, 1), "Lagrange elements of order 2"),
        Variant("N2-fine", "N2", (6, 6, 1), "reference for NURBS"),
        Variant("L1-fine", "L1", (8, 8, 1), "reference for Lagrange elements", (), ("monolithic",)),
        own_method("tolerance", "N2", (3, 3, 1), "N2 with tolerance 0.001", TOLERANCE),
    ),
    changes=("stages.press.steps=2",),
)

TWIST = Section(
    scene="twist",
    number="4.3",
    title="Global quality I: twisting moment",
    quantity=MOMENT,
    window=(0.25, 1.0),
    reference="fine-N3",
    series={"N": ("N2", "N3"), "Lagrange": ("L1", "L2"), "averaged": ("L1-averaged",)},
    instances=(7,),
    variants=(
        *nurbs((3, 3, 1), 2, 3),
        Variant("fine-N3", "N3", (4, 4, 1), "reference: four elements laterally", (), ("monolithic",)),
        Variant("L1", "L1", (3, 3, 1), "master of Lagrange elements of order 1", CLOSEST, ("monolithic",)),
        Variant("L2", "L2", (2, 2, 1), "master of Lagrange elements of order 2", CLOSEST, ("monolithic",)),
        averaged(1, (3, 3, 1)),
    ),
    changes=(
        "bodies.slave.mesh.elements=[2,2,1]",
        "stages.press.steps=3",
        "stages.twist.steps=4",
        "stages.twist.motions.top.rotate=18",
    ),
)

IRON = Section(
    scene="iron",
    number="4.4",
    title="Global quality II: dragging force",
    quantity=DRAG,
    window=(0.2, 1.0),
    reference="N3",
    series={"N": ("N2", "N3"), "Lagrange": ("L1", "L2"), "averaged": ("L1-averaged",)},
    instances=(8,),
    variants=(
        *nurbs((5, 2, 2), 2, 3),
        Variant("A", "N2", (8, 2, 2), "N2 with 8 elements along the drag", (), ("monolithic",)),
        Variant("C", "N2", (5, 2, 2), "N2 pressed down by 0.4", ("stages.press.motions.top.translate=[0,0,-0.4]",), ("monolithic",)),
        Variant("L1", "L1", (5, 2, 2), "master of Lagrange elements of order 1", CLOSEST, ("monolithic",)),
        Variant("L2", "L2", (3, 2, 2), "master of Lagrange elements of order 2", CLOSEST, ("monolithic",)),
        averaged(1, (5, 2, 2)),
    ),
    changes=(
        "bodies.slave.mesh.elements=[2,2,2]",
        "stages.press.steps=3",
        "stages.drag.steps=5",
        "stages.drag.motions.top.translate=[0.225,0,0]",
    ),
)

TIRE = Section(
    scene="tire",
    number="4.5",
    title="Case study: tire traction",
    quantity=TORQUE,
    window=(0.0, 1.0),
    reference="N2",
    series={"N": ("N2", "N3"), "L": ("L1", "L2"), "matched": ("L1-matched", "L2-matched")},
    instances=(8,),
    variants=(
        *nurbs((8, 1, 1), 2, 3),
        Variant("L1", "L1", (8, 1, 1), "Lagrange elements of order 1"),
        Variant("L2", "L2", (4, 1, 1), "Lagrange elements of order 2"),
        Variant("L1-matched", "L1", (12, 1, 1), "Lagrange elements of order 1, the 12 control points of N2 round the ring"),
        Variant("L2-matched", "L2", (8, 1, 1), "Lagrange elements of order 2, the 16 control points of N3 round the ring"),
        own_method("L2-tolerance", "L2", (4, 1, 1), "L2 with tolerance 0.001", TOLERANCE),
    ),
    changes=("stages.press.steps=2", "stages.roll.steps=6", "stages.roll.motions.rim={translate=[0.14765485471872,0,0],rotate=18.0}"),
)

QUICK = (PRESS, TWIST, IRON, TIRE)
