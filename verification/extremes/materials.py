"""Materials at the edges of what they can be: near incompressibility, contrasts of stiffness, compression to nothing."""

from __future__ import annotations

from typing import Any

import numpy as np
from extreme_scenes import changed, column, column_pressure, loaded, press_of, ran, stack, stack_pressure
from extremes.endings import digits, endings, judge

from isomortar.harness import case

_TIGHT = {"solver.newton_tolerance": 1e-12, "solver.complementarity_tolerance": 1e-11}
_GATE_STIFFNESSES = ((1e-3, "1:1"), (1e3, "1:1"), (1e12, "2:1"))
_POISSONS = (-0.999999, -0.99, 0.0, 0.49, 0.4999, 0.49999, 0.499999, 0.4999999, 0.499999999, 0.4999999999999)


@case(
    claim="Poisson's ratio may come close to one half, and to minus one, where the state is homogeneous.",
    tier=lambda poisson, order: "gate" if (poisson, order) == (-0.99, 2) else "nightly",
    grid={"poisson": _POISSONS, "order": (1, 2, 4)},
    bounds=lambda poisson, **_: endings(-0.99 <= poisson <= 0.499999),
)
def poisson(poisson: float, order: int) -> dict[str, Any]:
    """Closed form: a column that is free to widen; every order holds its state."""
    data = changed(column(poisson=poisson), {"bodies.b.mesh.order": [order] * 3})
    right = [column_pressure(stretch, poisson=poisson) for stretch in (0.9, 0.8)]
    return judge(ran(data), lambda done: digits(press_of(done), right), needed=6.0, causes=["poisson", "lock", "round-off"])


@case(
    claim="Where near-incompressible elements lock, the program says so.",
    tier=lambda poisson, order: "gate" if (poisson, order) == (0.3, 3) else "nightly",
    grid={"poisson": (0.3, 0.49, 0.499, 0.4999, 0.499999), "order": (1, 2, 3)},
    bounds=lambda poisson, order: endings(order > 1 and poisson <= 0.49),
)
def locking(poisson: float, order: int) -> dict[str, Any]:
    """Finer run: order 4 on twice the elements (a minute near one half); a fifth of the force may be missing.

    The top of the block is clamped.
    """
    data = changed(column(poisson=poisson), {"supports": {"top": {"face": "b.w1"}}, "stages.0.steps": 1})
    data = changed(data, {"bodies.b.mesh.elements": [2, 2, 2]})
    fine = ran(changed(data, {"bodies.b.mesh": {"order": [4, 4, 4], "elements": [4, 4, 4]}}), seconds=300)
    coarse = ran(changed(data, {"bodies.b.mesh.order": [order] * 3}))
    return judge(coarse, lambda done: digits(press_of(done), press_of(fine)), needed=0.7, causes=["poisson", "lock"])


@case(
    claim="A slave may be stiffer or softer than its master, and finer or coarser.",
    tier=lambda ratio, meshes: "gate" if (ratio, meshes) in _GATE_STIFFNESSES else "nightly",
    grid={
        "ratio": (1e-12, 1e-8, 1e-6, 1e-3, 1.0, 1e3, 1e4, 1e6, 1e8, 1e12),
        "meshes": ("1:8", "1:1", "2:1", "8:1"),
    },
    bounds=lambda ratio, meshes: endings(1e-8 <= ratio <= 1e4 and meshes in ("1:1", "2:1")),
)
def stiffness(ratio: float, meshes: str) -> dict[str, Any]:
    """Closed form: two columns that can not widen carry the same force; elements of slave to master along x and y.

    Where the master is finer, a contact patch test holds as well as the quadrature, to two digits here. A column that is stiffer by many
    decades is shortened by as many less, and its coordinates hold these to 1e-16.
    """
    slave, master = (int(part) for part in meshes.split(":"))
    run = ran(stack(ratio, slave, master))
    right = [stack_pressure(ratio, press) for press in (0.2, 0.4)]
    needed = 2.0 if master > slave else float(min(15.0 - abs(np.log10(ratio)), 6.0))
    return judge(
        run, lambda done: digits(press_of(done), right), needed, causes=["times as stiff", "repeat each other", "quadrature points"]
    )


@case(
    claim="A body that touches nothing changes nothing, however stiff it is.",
    tier=lambda ratio: "gate" if ratio == 1e12 else "nightly",
    grid={"ratio": (1e-12, 1e-6, 1.0, 1e4, 1e8, 1e10, 1e12, 1e14, 1e16, 1e20)},
    bounds=endings(right=True),
)
def bystander(ratio: float) -> dict[str, Any]:
    """Symmetry: the same without the bystander; it is held at both ends and does not move."""
    data = changed(loaded("bystander"), {"materials.steel.young": 10.0 * ratio})
    alone = loaded("bystander")
    del alone["bodies"]["anvil"], alone["materials"]["steel"], alone["supports"]["anvilbase"], alone["supports"]["anviltop"]
    del alone["stages"][0]["motions"]["anviltop"]
    right = ran(alone).force("top")
    return judge(ran(data), lambda done: digits(done.force("top"), right), needed=8.0)


@case(
    claim="A body may be compressed to a small share of its height, or the program says that an element folds.",
    tier=lambda stretch: "gate" if stretch == 0.1 else "nightly",
    grid={"stretch": (0.9, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 1e-3, 1e-4, 0.0, -0.5)},
    bounds=lambda stretch: endings(stretch >= 0.1),
)
def compression(stretch: float) -> dict[str, Any]:
    """Closed form: a column at the end of a press in ten load steps."""
    data = changed(column(press=1.0 - stretch), {"stages.0.steps": 10, "bodies.b.mesh.elements": [1, 1, 2], **_TIGHT})
    right = column_pressure(stretch) if stretch > 0.0 else np.nan
    return judge(ran(data), lambda done: digits(press_of(done)[-1:], [right]), needed=6.0, causes=["folded", "pressed flat"])
