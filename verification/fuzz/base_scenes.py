"""Tiny scenes that fuzz starts from: every kind of table, both methods, each a fraction of a second."""

from __future__ import annotations

#: A block on a rigid plane, pressed, then dragged and turned.
PRESS = """
format = 1
name = "press"
[materials.rubber]
young = 10.0
poisson = 0.3
[bodies.block]
geometry = { kind = "box", lower = [-0.5, -0.5, 0.0], upper = [0.5, 0.5, 0.5] }
mesh = { order = [2, 2, 1], elements = [2, 2, 1] }
[contacts.floor]
slave = "block.w0"
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0], tangent = [1.0, 0.0, 0.0] }
friction = 0.3
[supports.top]
face = "block.w1"
centre = [0.0, 0.0, 0.5]
axis = [0.0, 0.0, 1.0]
[[stages]]
name = "press"
steps = 1
motions.top.translate = [0.0, 0.0, -0.05]
[[stages]]
name = "drag"
steps = 1
motions.top = { translate = [0.03, 0.01, 0.0], rotate = 5.0 }
[solver]
method = "monolithic"
max_cuts = 4
"""

#: A bowl on a deformable block, with curves to draw.
BOWL = """
format = 1
name = "bowl"
title = "A bowl on a block"
[materials.soft]
young = 1.0
poisson = 0.3
[materials.stiff]
young = 10.0
poisson = 0.3
[bodies.bowl]
material = "soft"
geometry = { kind = "bowl", centre = [0.05, 0.02], half_width = 0.375, bottom = 0.0, rise = 0.06, top = 0.5 }
mesh = { order = [2, 2, 1], elements = [3, 3, 1] }
[bodies.block]
material = "stiff"
geometry = { kind = "box", lower = [-0.6, -0.6, -0.5], upper = [0.7, 0.65, 0.0] }
mesh = { order = [2, 2, 1], elements = [2, 2, 1] }
[contacts.interface]
slave = "bowl.w0"
master = "block.w1"
friction = 0.2
traction_max = 0.03
[supports.top]
face = "bowl.w1"
[supports.floor]
face = "block.w0"
[[stages]]
name = "press"
steps = 2
motions.top.translate = [0.0, 0.0, -0.06]
[solver]
max_cuts = 4
[record]
states = "last"
curves = [{ name = "down", support = "top", quantity = "force", component = "z" }]
"""

#: Augmentations of a bowl on a plane, of Lagrange elements.
UZAWA = """
format = 1
name = "uzawa"
[bodies.bowl]
geometry = { kind = "bowl", half_width = 0.5, bottom = 0.0, rise = 0.1, top = 0.5 }
mesh = { family = ["L", "N", "N"], order = [1, 2, 1], elements = [3, 2, 1], quadrature = [3, 4, 2] }
[contacts.floor]
slave = "bowl.w0"
plane = { point = [0.0, 0.0, 0.0] }
friction = 0.1
cohesion = 0.02
quadrature = [5, 5]
reference_area = 1.0
[supports.top]
face = "bowl.w1"
[[stages]]
name = "press"
steps = 1
motions.top.translate = [0.01, 0.0, -0.05]
[solver]
method = "uzawa"
slip_sum = "local"
penalty_normal = 100.0
penalty_tangential = 10.0
penalty_growth = 2.0
penalty_growth_max = 200.0
augmentation_tolerance = 1e-5
max_augmentations = 60
max_iterations = 20
max_cuts = 3
"""

#: A tyre on a plane.
TYRE = """
format = 1
name = "tyre"
[bodies.tyre]
geometry = { kind = "ring", centre = [0.0, 0.0, 0.5], inner = 0.25, outer = 0.5, width = 0.3 }
mesh = { order = [2, 2, 1], elements = [8, 1, 1] }
[contacts.tread]
slave = "tyre.v1"
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 2.0] }
friction = 0.3
[supports.rim]
face = "tyre.v0"
centre = [0.0, 0.0, 0.5]
axis = [0.0, 1.0, 0.0]
[[stages]]
name = "press"
steps = 1
motions.rim.translate = [0.0, 0.0, -0.03]
[[stages]]
name = "roll"
steps = 1
motions.rim = { translate = [0.02, 0.0, 0.0], rotate = 3.0 }
[solver]
max_cuts = 3
newton_tolerance = 1e-9
complementarity_tolerance = 1e-8
"""

#: A rational patch, point by point, held on planes of symmetry.
PATCH = """
format = 1
name = "patch"
[bodies.cube.patch]
family = ["N", "N", "N"]
order = [1, 1, 1]
knots = [[0.0, 0.0, 1.0, 1.0], [0.0, 0.0, 1.0, 1.0], [0.0, 0.0, 1.0, 1.0]]
control_points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0],
  [0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0], [1.0, 1.0, 1.0]]
weights = [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]
[bodies.cube.mesh]
order = 2
elements = [1, 2, 1]
[contacts.floor]
slave = "cube.w0"
plane = { point = [0.0, 0.0, -0.01], normal = [0.0, 0.0, 1.0] }
friction = 0.0
[supports.x]
face = "cube.u0"
components = ["x"]
[supports.y]
face = "cube.v0"
components = ["y"]
[supports.top]
face = "cube.w1"
components = ["z"]
[[stages]]
name = "press"
steps = 2
motions.top.translate = [0.0, 0.0, -0.1]
[solver]
max_cuts = 3
"""

#: Three plates, two contacts, the middle one held by contact alone.
PLATES = """
format = 1
name = "plates"
[bodies.low]
geometry = { kind = "box", lower = [-0.6, -0.6, -0.3], upper = [0.6, 0.6, 0.0] }
mesh = { order = [2, 2, 1], elements = [2, 2, 1] }
[bodies.middle]
geometry = { kind = "box", lower = [-0.5, -0.5, 0.0], upper = [0.5, 0.5, 0.2] }
mesh = { order = [2, 2, 1], elements = [2, 2, 1] }
[bodies.high]
geometry = { kind = "box", lower = [-0.4, -0.4, 0.2], upper = [0.4, 0.4, 0.5] }
mesh = { order = [2, 2, 1], elements = [2, 2, 1] }
[contacts.lower]
slave = "middle.w0"
master = "low.w1"
friction = 0.3
[contacts.upper]
slave = "high.w0"
master = "middle.w1"
friction = 0.5
[supports.bed]
face = "low.w0"
[supports.head]
face = "high.w1"
[[stages]]
name = "press"
steps = 1
motions.head.translate = [0.0, 0.0, -0.03]
[solver]
max_cuts = 3
"""

#: A rigid die pressed onto the free end of a block, then turned; below is a rigid table that nothing moves.
DIE = """
format = 1
name = "die"
[bodies.block]
geometry = { kind = "box", lower = [-0.5, -0.5, 0.0], upper = [0.5, 0.5, 0.4] }
mesh = { order = [2, 2, 1], elements = [2, 2, 1] }
[bodies.die]
rigid = true
geometry = { kind = "bowl", centre = [0.05, 0.02], half_width = 0.6, bottom = 0.4, rise = 0.1, top = 0.8 }
[bodies.table]
rigid = true
geometry = { kind = "box", lower = [-1.0, -1.0, -0.5], upper = [1.0, 1.0, -0.01] }
mesh = { order = 1, elements = [2, 1, 1] }
[contacts.above]
slave = "block.w1"
master = "die.w0"
friction = 0.2
[contacts.below]
slave = "block.w0"
master = "table.w1"
friction = 0.5
[supports.wall]
face = "block.u0"
[supports.die]
face = "die.w1"
centre = [0.05, 0.02, 0.6]
[[stages]]
name = "press"
steps = 1
motions.die.translate = [0.0, 0.0, -0.06]
[[stages]]
name = "turn"
steps = 1
motions.die = { translate = [0.02, 0.0, 0.0], rotate = 5.0 }
[solver]
max_cuts = 3
"""

#: No contact: a beam bent by turning its end.
BEAM = """
format = 1
name = "beam"
[materials.rubber]
young = 10.0
poisson = 0.4
[bodies.beam]
geometry = { kind = "box", lower = [0.0, 0.0, 0.0], upper = [1.0, 0.3, 0.2] }
mesh = { order = [2, 1, 1], elements = [3, 1, 1] }
[supports.wall]
face = "beam.u0"
[supports.hand]
face = "beam.u1"
centre = [1.0, 0.15, 0.1]
axis = [1.0, 0.0, 0.0]
[[stages]]
name = "turn"
steps = 2
motions.hand = { translate = [0.1, 0.0, 0.0], rotate = 30.0 }
[solver]
max_cuts = 3
"""

#: A bowl that its weight, a force and a pressure press on a block, which a traction pulls at; they grow, stay and fall. The bowl's top
#: tilts once it is let go, and the block is held at its side later on.
LOADED = """
format = 1
name = "loaded"
[bodies.bowl]
geometry = { kind = "bowl", half_width = 0.4, bottom = 0.0, rise = 0.08, top = 0.4 }
mesh = { order = [2, 2, 1], elements = [2, 2, 1] }
[bodies.block]
geometry = { kind = "box", lower = [-0.6, -0.6, -0.4], upper = [0.6, 0.6, 0.0] }
mesh = { order = [2, 2, 1], elements = [2, 2, 1] }
[contacts.interface]
slave = "bowl.w0"
master = "block.w1"
friction = 0.3
[supports.top]
face = "bowl.w1"
force.z = -0.2
moment = 0.01
axis = [0.0, 1.0, 0.0]
centre = [0.0, 0.0, 0.4]
stages = ["blow"]
[supports.first]
face = "bowl.w1"
stages = ["press"]
[supports.bed]
face = "block.w0"
[supports.side]
face = "block.u0"
components = ["x"]
stages = ["blow"]
[loads.own]
body = "bowl"
weight = [0.0, 0.0, -0.3]
[loads.wind]
face = "bowl.u0"
pressure = 0.1
[loads.pull]
face = "block.u1"
traction = [0.05, 0.0, 0.02]
[[stages]]
name = "press"
steps = 1
loads = { wind = 0.0 }
motions.first.translate = [0.0, 0.0, -0.02]
[[stages]]
name = "blow"
steps = 2
loads = { wind = 1.0, own = 0.5 }
motions.top.translate = [0.01, 0.0, 0.0]
[solver]
max_cuts = 3
"""

TEXTS = (PRESS, BOWL, UZAWA, TYRE, PATCH, PLATES, DIE, BEAM, LOADED)
