"""What other programs are not told of: a scene that has it is refused by its field, and one that has it not is taken."""

from __future__ import annotations

from isomortar.errors import InputError
from isomortar.harness import Bound, case
from isomortar.program.lagrange import LagrangeProblem
from isomortar.scene import Scene

#: Two blocks of Lagrange elements, one of which presses on the other.
SCENE = """
format = 1
materials = { soft = { young = 1 }, hard = { young = 2 } }
bodies.above.material = "soft"
bodies.above.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }
bodies.above.mesh = { family = "L", order = 1, elements = 2 }
bodies.below.material = "hard"
bodies.below.geometry = { kind = "box", lower = [-1, -1, -1], upper = [2, 2, 0] }
bodies.below.mesh = { family = "L", order = 1, elements = 2 }
contacts.c = { slave = "above.w0", MASTER, friction = 0.3 }
supports.top.face = "above.w1"
supports.base.face = "below.w0"
loads.wind = { face = "above.u0", pressure = 0.01 }
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.01] }]
"""
BELOW = 'master = "below.w1"'
_SIDE = '\nbodies.side.material = "soft"\nbodies.side.geometry = { kind = "box", lower = [2, -1, -1], upper = [3, 2, 0] }\n'
_SIDE += 'bodies.side.mesh = { family = "L", order = 1, elements = 2 }\n'
#: What is changed, what follows the scene, its master, and the field that is refused; none: it is taken.
REFUSED: tuple[tuple[tuple[str, ...], str, str, str], ...] = (
    ((), "", BELOW, ""),
    (("materials.soft.law=linear-elastic",), "", BELOW, ""),
    ((), _SIDE + 'supports.side.face = "side.w0"', BELOW, ""),
    ((), _SIDE + 'glue = [["below.u1", "side.u0"]]', BELOW, "glue"),
    (("loads.wind={face='above.u0',traction=[0.01,0,0]}",), "", BELOW, "loads.wind.traction"),
    (("loads.wind={body='above',weight=[0,0,-1]}",), "", BELOW, "loads.wind.weight"),
    (("supports.top.components=['x','y']", "supports.top.force.z=-0.01", "stages.press.motions={}"), "", BELOW, "supports.top.force"),
    (("supports.base.stages=['press']",), "", BELOW, "supports.base.stages"),
    (("bodies.below={rigid=true,geometry={kind='box',lower=[-1,-1,-1],upper=[2,2,0]}}",), "", BELOW, "bodies.below.rigid"),
    (("bodies.above.mesh.family=N",), "", BELOW, "bodies.above.mesh.family"),
    (("bodies.below.mesh.family=['L','L','N']",), "", BELOW, "bodies.below.mesh.family"),
    (("materials.hard.law=neo-hookean-j",), "", BELOW, "bodies.below.material.law"),
    ((), "", "plane = {}", "contacts.c.plane"),
    (("contacts.c.cohesion=0.1",), "", BELOW, "contacts.c.cohesion"),
    (("contacts.c.traction_max=0.1",), "", BELOW, "contacts.c.traction_max"),
    (("contacts.c.smoothing=0.001",), "", BELOW, "contacts.c.smoothing"),
    (("contacts.c.elastic_slip=0.001",), "", BELOW, "contacts.c.elastic_slip"),
)


def refused(changes: tuple[str, ...], more: str, master: str) -> str:
    """The field for which a scene is refused; nothing, where it is taken."""
    problem = Scene.from_toml(SCENE.replace("MASTER", master) + more, overrides=changes).problem()
    try:
        LagrangeProblem(problem, "It", {"linear-elastic", "neo-hookean"})
    except InputError as error:
        return str(error.field)
    return ""


@case(
    claim="Whatever another program is not told of is refused by its field, and nothing else is: it would compute another scene.",
    tier="gate",
    bounds={
        "wrong": Bound(0.0, 0.0, "definition: scenes that are taken and should not be, or are refused for something else, or for nothing")
    },
)
def not_told() -> dict[str, float]:
    """How many."""
    return {"wrong": float(sum(refused(*given) != field for *given, field in REFUSED))}  # type: ignore[arg-type]
