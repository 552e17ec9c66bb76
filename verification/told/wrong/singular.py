"""Scenes whose tangent has no inverse, and what is said of that."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from isomortar.errors import ConvergenceError
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.singular import PairConditions, explain
from isomortar.solve.timing import Ledger

BLOCK = """
format = 1
bodies.block = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 0.8, 0.4] }, mesh = { order = [2, 2, 1], elements = [2, 2, 1] } }
contacts.base = { slave = "block.w0", plane = { point = [0, 0, 0] }, friction = 0.0 }
solver.max_cuts = 1
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.02] }]
"""
CORNER = """
format = 1
bodies.block = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh.elements = [3, 3, 2] }
contacts.floor = { slave = "block.w0", plane = { point = [0, 0, 0] }, friction = 0.2 }
contacts.wall = { slave = "block.u0", plane = { point = [0, 0, 0], normal = [1, 0, 0] }, friction = 0.2 }
solver.max_cuts = 1
supports.top.face = "block.w1"
stages = [{ name = "press", steps = 1, motions.top.translate = [-0.05, 0, -0.05] }]
"""


def error(text: str, *overrides: str) -> str:
    """What a run that stops says; nothing, if it does not."""
    try:
        list(Simulation(Scene.from_toml(text, overrides=overrides).problem()).run())
    except ConvergenceError as stopped:
        return str(stopped)
    return ""


def explained(directions: list[int], multipliers: list[int], found: int = 1, beside: int = 0) -> str:
    """What is said of a direction that moves some unknowns of the held block, and of one that changes multipliers of its contact.

    `found` is 0 where all quadrature points have left the master, `beside` how many of them have.
    """
    equilibrium = Equilibrium(Scene.from_toml(BLOCK + 'supports.top.face = "block.w1"').problem(), Ledger())
    state, pair, free = equilibrium.initial_state(), equilibrium.pairs[0], equilibrium.supports.free
    kinematics = pair.kinematics(state.positions, state.contacts[0])
    projections = replace(kinematics.projections, found=np.full_like(kinematics.projections.found, found))
    projections.found[:beside] = 0
    equation = np.full(3 * len(pair.pair.slave.point), -1)
    equation[::3] = len(free) + np.arange(len(equation[::3]))
    null = np.zeros(len(free) + len(equation[::3]))
    null[directions] = 1.0
    null[len(free) + np.array(multipliers, dtype=int)] = 2.0
    contact = PairConditions(pair, equation, replace(kinematics, projections=projections))
    return str(explain(0.0, null, equilibrium.supports, state.positions, equilibrium.numbering, [contact]))
