"""What the kernel keeps on the stack grows neither with the mesh nor much with the order: threads of programs that call it have little."""

from __future__ import annotations

import subprocess
import sys

import pytest

#: Three iterations of a scene in a thread whose stack has 192 kB, of which Python itself takes half.
CHILD = """
import sys, threading
from isomortar import Scene
from isomortar.solve.record import Observer
from isomortar.march.simulation import Simulation

class Enough(Exception):
    pass

class Few(Observer):
    def iteration(self, step, time, augmentation, record):
        if record.iteration == 3:
            raise Enough

def work():
    try:
        list(Simulation(Scene.load(sys.argv[1], sys.argv[2:]).problem(), Few()).run())
    except Enough:
        print("came through")

threading.stack_size(192 * 1024)
thread = threading.Thread(target=work)
thread.start()
thread.join()
"""
#: One real number a control point, or a point of the face, is more than the stack has.
LARGE = "{order=[2,2,1],elements=[110,110,1]}"
LAGRANGE = '{family="L",order=[4,4,2],elements=[2,2,1]}'
SCENES = {
    "many elements": ("press", f"bodies.block.mesh={LARGE}", "stages.press.motions.top.translate=[0,0,-0.02]"),
    "many elements of a master": (
        "twist", f"bodies.master.mesh={LARGE}", "bodies.master.rigid=true", "stages.press.steps=1",
        "stages.press.motions.top.translate=[0,0,-0.25]",
    ),
    "many elements of a master, averaged": (
        "block", 'bodies.master.mesh={family="L",order=[1,1,1],elements=[160,160,1]}', "bodies.master.rigid=true",
        "stages.press.steps=1",
    ),
    "summed slips": (
        "press", f"bodies.block.mesh={LARGE}", "stages.press.motions.top.translate=[0,0,-0.02]", "solver.method=uzawa",
        "solver.slip_sum=paper",
    ),
    "order 10": ("press", "bodies.block.mesh={order=[10,10,10],elements=[1,1,1]}"),
    "order 10 with weights": ("tire", "bodies.tire.mesh={order=[10,10,10],elements=[4,1,1]}"),
    "order 10 on both sides": (
        "twist", "bodies.slave.mesh={order=[10,10,2],elements=[1,1,1]}", "bodies.master.mesh={order=[10,10,2],elements=[2,2,1]}",
        "stages.press.steps=1", "stages.press.motions.top.translate=[0,0,-0.25]",
    ),
    "order 4 along averaged normals": (
        "block", f"bodies.slave.mesh={LAGRANGE}", f"bodies.master.mesh={LAGRANGE}", "contacts.interface.projection=averaged",
    ),
    "order 4 by closest points": (
        "block", f"bodies.slave.mesh={LAGRANGE}", f"bodies.master.mesh={LAGRANGE}", "contacts.interface.projection=closest",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", SCENES)
def test_a_small_stack_is_enough(name: str) -> None:
    done = subprocess.run([sys.executable, "-c", CHILD, *SCENES[name]], capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (0, "came through\n"), done.stderr
