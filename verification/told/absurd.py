"""What is refused of loads and limits of contact that are absurdly large, by the field that says so, before any work."""

from __future__ import annotations

from isomortar.errors import InputError
from isomortar.harness import Bound, case
from isomortar.model.checks import check
from isomortar.scene import Scene

SCENE = """
format = 1
materials.soft.young = 100
bodies.block = { geometry = { kind = "box", lower = [0, 0, 0], upper = [2, 1, 0.3] }, rigid = RIGID }
bodies.base.geometry = { kind = "box", lower = [-1, -1, -1], upper = [3, 3, 0] }
contacts.c.slave = "base.w1"
contacts.c.master = "block.w0"
supports.base.face = "base.w0"
MORE
stages = [{ name = "one", steps = 1 }, { name = "two", steps = 1 }]
"""
HAND = 'supports.hand={face="block.w1",centre=[1,0.5,0.3],FORCE}'
#: What is set, with a size that is left open; the field that is to be named, and the largest size that is allowed.
FIELDS = (
    (('loads.own={body="base",weight=[1,-SIZE,0]}',), "loads.own.weight", 2.5e11),
    (('loads.own={face="base.u0",pressure=-SIZE}',), "loads.own.pressure", 1e12),
    (('loads.own={face="base.u0",traction=[1,0,SIZE]}',), "loads.own.traction", 1e12),
    (('loads.own={face="base.u0",pressure=1e3}', "stages.two.loads.own=-SIZE"), "stages.two.loads.own", 1e9),
    ((HAND.replace("FORCE", "force={x=0,y=1,z=-SIZE}"),), "supports.hand.force", 4e12),
    ((HAND.replace("FORCE", "force={x=0,y=0,z=0},moment=SIZE"),), "supports.hand.moment", 8e12),
    ((HAND.replace("FORCE", "force={x=0,y=0,z=-100}"), "stages.one.loads.hand=SIZE"), "stages.one.loads.hand", 4e10),
    (("contacts.c.cohesion=SIZE",), "contacts.c.cohesion", 1e100),
    (("contacts.c.traction_max=SIZE",), "contacts.c.traction_max", 1e100),
    (("contacts.c.reference_area=SIZE",), "contacts.c.reference_area", 1e100),
    (("contacts.c.friction=SIZE",), "contacts.c.friction", 1e100),
)


def refused(changes: tuple[str, ...], size: float, rigid: bool) -> str:
    """The field for which the scene is refused; nothing: it is not."""
    first, *others = (change.replace("SIZE", repr(size)) for change in changes)
    held = "" if first.startswith("supports") else 'supports.hand.face = "block.w1"\n'
    text = SCENE.replace("RIGID", str(rigid).lower()).replace("MORE", held + first)
    try:
        check(Scene.from_toml(text, overrides=others).problem())
    except InputError as error:
        return error.field or str(error)
    return ""


@case(
    claim="Loads, forces and moments of supports, with their factors, and limits of contact are refused by their fields from where on no "
    "body could bear them, or no number hold them, and not below.",
    tier="gate",
    grid={"rigid": (False, True)},
    bounds={
        "taken": Bound(0.0, 0.0, "definition: sizes beyond what is allowed that are not refused, or for another field"),
        "refused": Bound(0.0, 0.0, "definition: sizes within it that are"),
    },
)
def absurd(rigid: bool) -> dict[str, float]:
    """How many of eleven at three sizes; a rigid body's are those of what is to bear it, of twice the length."""
    taken = too_soon = 0
    for changes, field, most in FIELDS:
        longer = rigid and changes[0].startswith("supports")
        allowed = most * (2.0 ** (3 if "moment=" in changes[0] else 2) if longer else 1.0)
        taken += sum(refused(changes, size, rigid) != field for size in (1.01 * allowed, 1e160, 1e300))
        too_soon += sum(refused(changes, size, rigid) != "" for size in (0.99 * allowed, 1.0))
    return {"taken": float(taken), "refused": float(too_soon)}
