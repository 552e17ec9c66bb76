"""What a contact of two blocks takes by itself, by what is changed of it; and what cannot be chosen together."""

from __future__ import annotations

from told.wrong.contacts import LAGRANGE, PAIR, PRESS

#: What is changed, the projection, and whether nobody asked for it.
PROJECTIONS: tuple[tuple[tuple[str, ...], str, bool], ...] = (
    ((), "closest", False),
    (("bodies.lower.mesh.family=L",), "averaged", True),
    (("bodies.lower.mesh.order=[2,1,2]", "bodies.lower.mesh.elements=[2,2,1]"), "averaged", True),
    (("bodies.lower.mesh.family=L", "bodies.lower.mesh.elements=[1,1,2]"), "closest", False),
    (("bodies.lower.mesh.family=L", "solver.method=uzawa", "solver.slip_sum=paper"), "closest", False),
    (("bodies.lower.mesh.family=L", "contacts.pair.projection=closest"), "closest", False),
    (("contacts.pair.projection=averaged",), "averaged", False),
    (
        (
            "bodies.lower.geometry={kind='ring',centre=[0,0,-1],inner=0.5,outer=1,width=2}",
            "bodies.lower.mesh.elements=[8,1,2]",
            "contacts.pair.master=lower.v1",
            "supports.base.face=lower.v0",
        ),
        "closest",
        False,
    ),
    (("bodies.upper.mesh.family=L",), "closest", False),
    (
        (
            "bodies.lower.geometry={kind='sphere',centre=[0,0,-1],inner=0.5,outer=1,latitudes=[0,90]}",
            "bodies.lower.mesh={family='L',elements=[8,1,4]}",
            "contacts.pair.master=lower.v1",
            "supports.base.face=lower.w1",
        ),
        "closest",
        False,
    ),
)
#: What is changed, how many times over elements are cut, and the points of each.
NEEDED: tuple[tuple[list[str], int, tuple[int, int]], ...] = (
    ([], 0, (6, 6)),
    (["bodies.lower.mesh.elements=[5,5,1]"], 1, (4, 4)),
    (["bodies.lower.mesh.elements=[20,3,1]"], 2, (4, 4)),
    (["bodies.lower.mesh.elements=[3,20,1]"], 2, (4, 4)),
    (["bodies.lower.mesh.elements=[12,3,1]"], 2, (4, 4)),
    (["bodies.lower.mesh.elements=[60,60,1]"], 4, (4, 4)),
    (
        ["bodies.lower.geometry.lower=[-1,-1,-1]", "bodies.lower.geometry.upper=[0.3,1,0]", "bodies.lower.mesh.elements=[1,1,1]"],
        1,
        (4, 4),
    ),
    (["bodies.lower.mesh.elements=[5,5,1]", "bodies.lower.mesh.order=[2,5,2]"], 1, (5, 5)),
    (["bodies.lower.mesh.elements=[5,5,1]", "bodies.upper.mesh.order=[1,3,2]"], 1, (3, 5)),
    (["bodies.lower.mesh.elements=[5,5,1]", "contacts.pair.quadrature=5"], 0, (5, 5)),
    (["bodies.lower.mesh.elements=[5,5,1]", "contacts.pair.subcells=0"], 0, (6, 6)),
    (["bodies.lower.mesh.elements=[5,5,1]", "contacts.pair.subcells=3"], 3, (6, 6)),
    (["bodies.lower.mesh.elements=[5,5,1]", "contacts.pair.enforcement=greville"], 0, (6, 6)),
    (["bodies.lower.mesh.elements=[5,5,1]", "contacts.pair.enforcement=dual"], 1, (4, 4)),
)
_AVERAGED = ("contacts.pair.projection=averaged", "contacts.pair.friction=0.1")
_DUAL = "contacts.pair.enforcement=dual"
#: A scene, and what is changed in it, by the name of its sentence.
REFUSED: dict[str, tuple[str, tuple[str, ...]]] = {
    "averaged normals and the paper's sum": (PAIR, (*_AVERAGED, "solver.slip_sum=paper")),
    "averaged normals of a plane": (PRESS, ("contacts.floor.projection=averaged",)),
    "abscissae": (LAGRANGE, ("contacts.pair.enforcement=demko",)),
    "conditions": (PAIR, ("contacts.pair.enforcement=kts",)),
    "dual: points": (PAIR, (_DUAL, "contacts.pair.quadrature=[3,2]")),
    "dual: sum": (PAIR, (_DUAL, "solver.slip_sum=paper", "contacts.pair.friction=0.1")),
    "cells on a plane": (PRESS, ("contacts.floor.subcells=1",)),
    "cells at points": (PAIR, ("contacts.pair.subcells=1", "contacts.pair.enforcement=greville")),
}
