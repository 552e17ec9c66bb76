"""Small scenes with contact and friction that several families run: seconds each."""

from __future__ import annotations

from dataclasses import replace

from isomortar.model.entities import Problem
from isomortar.scene import Scene

#: A bowl pressed off-centre onto a deformable block or a rigid plane, then moved and turned: open, stick and slip at once.
_BOWL = """
format = 1
name = "bowl-on-{master}"

[bodies.slave]
geometry = {{ kind = "bowl", centre = [0.05, 0.02], half_width = 0.375, bottom = 0, rise = 0.06, top = 0.5 }}
mesh = {{ order = [2, {order}, 1], elements = [5, 5, 1] }}

[contacts.interface]
slave = "slave.w0"
{interface}
friction = {friction}

[supports.top]
face = "slave.w1"
axis = [0, 0, 1]

[[stages]]
name = "press"
steps = 2
motions.top = {{ translate = [0, 0, -0.1] }}

[[stages]]
name = "turn"
steps = 2
motions.top = {{ translate = [0.04, 0.02, 0], rotate = 20 }}
"""

_BLOCK = """
[bodies.master]
geometry = { kind = "box", lower = [-0.6, -0.6, -0.5], upper = [0.7, 0.65, 0] }
mesh = { order = [3, 2, 1], elements = [3, 4, 1] }

[supports.floor]
face = "master.w0"
"""

#: Tolerances at which what is left is round-off.
TIGHT = {"newton_tolerance": 1e-12, "complementarity_tolerance": 1e-11}


def bowl(master: str, friction: float = 0.3, order: int = 2, slip_sum: str = "local") -> Problem:
    """The bowl on a ``block`` (deformable, cubic by quadratic) or a rigid ``plane``, at tight tolerances.

    Parameters
    ----------
    master : {"block", "plane"}
    friction : float
    order : int
        Of the bowl along y; along x it is quadratic.
    slip_sum : {"local", "paper"}
    """
    interface = 'master = "master.w1"\nsubcells = 0' if master == "block" else "plane = { point = [0, 0, 0], normal = [0, 0, 1] }"
    text = _BOWL.format(master=master, interface=interface, friction=friction, order=order) + (_BLOCK if master == "block" else "")
    problem = Scene.from_toml(text).problem()
    return replace(problem, settings=replace(problem.settings, slip_sum=slip_sum, **TIGHT))  # type: ignore[arg-type]


def at_few_points(problem: Problem) -> Problem:
    """The problem with as few Gauss points a direction as feel all functions: what is exact is so at any number, and costs go with them."""
    return replace(problem, contacts=tuple(replace(contact, quadrature=(2, 3), subcells=0) for contact in problem.contacts))
