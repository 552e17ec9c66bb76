"""What is said of halves of bodies that would buckle across the plane which halves them: the half is stable, the whole is not."""

from __future__ import annotations

from told.runs import Heard
from told.unstable import column
from told.unstable import told as told_of_part

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

ENDS = ("free", "sticking", "sticking on a plane")
#: A plate that comes down is as good as a plane to which the column goes.
PLANE = {
    'bodies.p = { rigid = true, geometry = { kind = "box", lower = [-1, -1, 1], upper = [1, 1, 1.5] }, mesh.elements = [2, 2, 1] }\n': "",
    'master = "p.w0"': "plane = { point = [0, 0, 1], normal = [0, 0, -1] }",
    'supports.hand.face = "p.w1"\n': "",
    "motions.hand.translate = [0, 0, -": "motions.base.translate = [0, 0, ",
}
MOVED = {
    "lower = [0, 0, 0], upper = [0.04, 0.1, 1]": "lower = [-0.02, -0.05, 0], upper = [0.02, 0.05, 1]",
    "elements = [1, 2, 8]": "elements = [2, 2, 8]",
    'contacts.wall = { slave = "c.u1", plane = { point = [1, 0, 0], normal = [-1, 0, 0] } }': (
        'contacts.wall = { slave = "c.w1", plane = { point = [0, 0, 2], normal = [0, 0, -1] } }'
    ),
    "upper = [1, 1, 1.5] }": "upper = [1, 1, 1.5] }, mesh.elements = [2, 2, 1]",
}


#: How the scenes end, and how they go on for a stage.
END, LATER = "}]\n", '}, { name = "hold", steps = 1 }]\n'


def of_half(end: str, share: float, symmetry: str) -> str:
    """A column that bears a share of Euler's load halved by planes through its middle."""
    scene = column(end.removesuffix(" on a plane"), share, "monolithic")
    for old, new in (MOVED | (PLANE if end.endswith("plane") else {})).items():
        scene = scene.replace(old, new)
    return f"symmetry = {{ {symmetry} }}\n{scene.removesuffix(END)}{LATER}"


def told(text: str, plane: str) -> int:
    """How often it is said to buckle across a plane."""
    heard = Heard()
    list(Simulation(Scene.from_toml(text).problem(), heard).run())
    return sum(f"one side of the plane {plane} = 0 may be: body 'c' buckles across that plane" in said for said in heard.said)


@case(
    claim="A column that is halved across its weak direction, or quartered, is told to buckle across that plane where the whole does, "
    "once, and not below; halved along it, it is told to buckle as it is.",
    tier="gate",
    grid={"end": ENDS},
    bounds={
        "below": Bound(0.0, 0.0, "definition: sentences at 0.92 of Euler's load"),
        "above": Bound(2.0, 2.0, "definition: of a half and a quarter, sentences at 1.08 of it"),
        "along": Bound(0.0, 0.0, "definition: sentences on the other plane"),
        "of the part": Bound(1.0, 1.0, "definition: of the half along its weak direction, sentences that it buckles as it is"),
    },
)
def mirrored(end: str) -> dict[str, float]:
    """How many of each."""
    planes = ("x = 0", "x = 0, y = 0")
    return {
        "below": float(sum(told(of_half(end, 0.92, symmetry), "x") for symmetry in planes)),
        "above": float(sum(told(of_half(end, 1.08, symmetry), "x") for symmetry in planes)),
        "along": float(sum(told(of_half(end, 1.08, symmetry), "y") for symmetry in ("x = 0, y = 0", "y = 0"))),
        "of the part": float(len(told_of_part(of_half(end, 1.08, "y = 0")))),
    }
