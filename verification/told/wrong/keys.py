"""Scenes with one wrong key, and what is said of it."""

from __future__ import annotations

# A scene with everything in it that can be wrong; each case below changes one place.
GOOD = """
format = 1
name = "good"
[materials.rubber]
young = 10.0
poisson = 0.3
[materials.cork]
poisson = 0.0
[bodies.upper]
material = "rubber"
geometry = { kind = "bowl", half_width = 0.5, bottom = 0.1, rise = 0.2, top = 1.0 }
mesh = { order = [2, 2, 1], elements = [2, 2, 1] }
[bodies.lower]
material = "cork"
[bodies.lower.patch]
order = [1, 1, 1]
knots = [[0, 0, 0.5, 1, 1], [0, 0, 1, 1], [0, 0, 1, 1]]
control_points = [[-1, -1, -1], [0, -1, -1], [1, -1, -1], [-1, 1, -1], [0, 1, -1], [1, 1, -1],
                  [-1, -1, 0], [0, -1, 0], [1, -1, 0], [-1, 1, 0], [0, 1, 0], [1, 1, 0]]
weights = [1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1]
[contacts.pair]
slave = "upper.w0"
master = "lower.w1"
[contacts.floor]
slave = "lower.w0"
plane = { point = [0, 0, -1], normal = [0, 0, 1], tangent = [1, 0, 0] }
[supports.top]
face = "upper.w1"
[supports.base]
face = "lower.w0"
[[stages]]
name = "press"
steps = 3
motions.top.translate = [0, 0, -0.2]
[[stages]]
name = "turn"
steps = 2
motions.top.rotate = 10
[solver]
max_cuts = 4
"""

_BOWL = 'geometry = { kind = "bowl", half_width = 0.5, bottom = 0.1, rise = 0.2, top = 1.0 }'

# What is replaced, by what, the field that the error names, and a part of its text.
CASES = {
    "version": ("format = 1", "format = 2", "format", "is 2; allowed: 1"),
    "unknown key": ("steps = 3", "step = 3", "stages.press.step", "unknown key; allowed here: steps, name, motions"),
    "unknown table": ("[solver]", "[solvers]", "solvers", "unknown key; allowed here: solver, "),
    "key of the file in a table": ("max_cuts = 4", "max_cuts = 4\nsymmetry.x = 0", "solver.symmetry", "put it above the first [table]"),
    "one stage": (
        '[[stages]]\nname = "press"\nsteps = 3\nmotions.top.translate = [0, 0, -0.2]\n[[stages]]',
        "[stages]",
        "stages",
        "begins with [[stages]]",
    ),
    "list of supports": ('[supports.top]\nface = "upper.w1"\n[supports.base]', "[[supports]]", "supports", "begins with [supports.NAME]"),
    "unknown key of a primitive": ("rise = 0.2", "raise = 0.2", "bodies.upper.geometry.raise", "rise, kind, centre, half_width"),
    "unknown primitive": ('kind = "bowl"', 'kind = "ball"', "bodies.upper.geometry.kind", "is 'ball'; allowed: 'box', 'bowl', 'cap'"),
    "half a turn too far": (
        _BOWL,
        'geometry = { kind = "sphere", outer = 1, angles = [0, 400] }',
        "bodies.upper.geometry.angles",
        "up to 360 degrees",
    ),
    "no interval": (
        _BOWL,
        'geometry = { kind = "sphere", outer = 1, latitudes = 90 }',
        "bodies.upper.geometry.latitudes",
        "a list of 2 numbers",
    ),
    "coarse grading": (
        "elements = [2, 2, 1]",
        "grading = 1e-4",
        "bodies.upper.mesh.grading",
        "is 0.0001; allowed: greater than or equal to 0.001",
    ),
    "no place": (
        '[supports.base]\nface = "lower.w0"',
        "[supports.base]",
        "supports.base",
        "has no place; allowed: exactly one of face, edge, corner",
    ),
    "two places": (
        'face = "lower.w0"',
        'face = "lower.w0"\nedge = "lower.u0.w0"',
        "supports.base",
        "has face and edge; allowed: exactly one of",
    ),
    "no edge": (
        'face = "lower.w0"',
        'edge = "lower.u0.u1"',
        "supports.base.edge",
        "allowed: BODY.FACE.FACE with faces that meet, such as lower.u0.w1",
    ),
    "half a corner": ('face = "lower.w0"', 'corner = "lower.u0.w1"', "supports.base.corner", "such as lower.u0.v0.w1"),
    "edge of a face that is not": (
        'face = "lower.w0"',
        'edge = "lower.u0.w2"',
        "supports.base.edge",
        "is 'lower.w2', but lower has no face 'w2'",
    ),
    "missing": ('name = "turn"\n', "", "stages.1.name", "is missing, but must be given"),
    "not a number": ("young = 10.0", 'young = "hard"', "materials.rubber.young", "is 'hard'; allowed: a number"),
    "Young": ("young = 10.0", "young = 0", "materials.rubber.young", "is 0; allowed: greater than 0"),
    "Poisson": ("poisson = 0.3", "poisson = 0.5", "materials.rubber.poisson", "is 0.5; allowed: less than 0.5"),
    "NaN": ("poisson = 0.3", "poisson = nan", "materials.rubber.poisson", "is nan; allowed: a finite number"),
    "name": ("[supports.top]", '[supports."the top"]', "supports.the top", "allowed: letters from a to z, digits, _ and -"),
    "no material": (
        'material = "cork"',
        'material = "corc"',
        "bodies.lower.material",
        "there is no material 'corc'; allowed: cork, rubber",
    ),
    "which material": ('material = "cork"\n', "", "bodies.lower.material", "must be given where there are several; allowed: rubber, cork"),
    "two geometries": (
        'material = "cork"',
        'file = "lower.json"',
        "bodies.lower",
        "has file and patch; allowed: exactly one of geometry, file, patch",
    ),
    "low top": ("top = 1.0", "top = 0.5", "bodies.upper.geometry.top", "is 0.5; must be above the highest point of the underside, 0.5"),
    "file": (
        'geometry = { kind = "bowl", half_width = 0.5, bottom = 0.1, rise = 0.2, top = 1.0 }',
        'file = "none.json"',
        "bodies.upper.file",
        "none.json",
    ),
    "file format": (
        'geometry = { kind = "bowl", half_width = 0.5, bottom = 0.1, rise = 0.2, top = 1.0 }',
        'file = "a.step"',
        "bodies.upper.file",
        ".json, .xml, .itd, .irit, .mesh",
    ),
    "order": ("order = [2, 2, 1]", "order = [2, 1, 1]", "bodies.upper.mesh.order", "is 1 in direction v; allowed for N there: 2 to 10"),
    "high order": ("order = [2, 2, 1]", "order = 11", "bodies.upper.mesh.order", "is 11 in direction u; allowed for N there: 2 to 10"),
    "high order of Lagrange": ("order = [2, 2, 1]", 'family = "L", order = 5', "bodies.upper.mesh.order", "allowed for L there: 1 to 4"),
    "family": ("order = [2, 2, 1]", 'family = "B"', "bodies.upper.mesh.family", "is 'B'; allowed: 'N' or 'L'"),
    "elements": (
        "elements = [2, 2, 1]",
        "elements = [2, 0, 1]",
        "bodies.upper.mesh.elements.1",
        "is 0; allowed: greater than or equal to 1",
    ),
    "two elements": ("elements = [2, 2, 1]", "elements = [2, 2]", "bodies.upper.mesh.elements", "allowed: one for all directions, or 3"),
    "half an element": ("elements = [2, 2, 1]", "elements = 2.5", "bodies.upper.mesh.elements", "is 2.5; allowed: a whole number"),
    "size": ("elements = [2, 2, 1]", "elements = [1000, 1000, 1000]", "bodies.upper.mesh.elements", "allowed: 5000000"),
    "closed": (
        'material = "cork"',
        'material = "cork"\nclosed = "u"',
        "bodies.lower.closed",
        "first and last control points along u differ",
    ),
    "knots unsorted": (
        "[0, 0, 0.5, 1, 1]",
        "[0, 0, 0.5, 0.4, 1, 1]",
        "bodies.lower.patch.knots",
        "value 3 (0.4) is below the one before it",
    ),
    "knots not open": ("[0, 0, 0.5, 1, 1]", "[0, 0, 0.5, 0.9, 1]", "bodies.lower.patch.knots", "must be open"),
    "knots repeated": ("[0, 0, 0.5, 1, 1]", "[0, 0, 0.5, 0.5, 1, 1]", "bodies.lower.patch.knots", "repeated more than order = 1 times"),
    "boundaries together": (
        "[0, 0, 0.5, 1, 1], [0, 0, 1, 1], [0, 0, 1, 1]]",
        '[0, 1, 1], [0, 1], [0, 1]]\nfamily = "L"',
        "bodies.lower.patch.knots",
        "must increase strictly",
    ),
    "boundaries back": (
        "[0, 0, 0.5, 1, 1], [0, 0, 1, 1], [0, 0, 1, 1]]",
        '[0, 1, 0.5], [0, 1], [0, 1]]\nfamily = "L"',
        "bodies.lower.patch.knots",
        "must increase strictly",
    ),
    "knot lists": ("[0, 0, 1, 1], [0, 0, 1, 1]]", "[0, 0, 1, 1]]", "bodies.lower.patch.knots", "has 2 entries; allowed: at least 3"),
    "NaN in knots": ("[0, 0, 0.5, 1, 1]", "[0, 0, nan, 1, 1]", "bodies.lower.patch.knots.0.2", "is nan; allowed: a finite number"),
    "points": (", [1, 1, 0]]", "]", "bodies.lower.patch.control_points", "knots and orders ask for 3 x 2 x 2 = 12 points"),
    "point": (", [1, 1, 0]]", ", [1, 1]]", "bodies.lower.patch.control_points.11", "is [1, 1]; allowed: a list of 3 numbers"),
    "NaN in points": (", [1, 1, 0]]", ", [1, 1, nan]]", "bodies.lower.patch.control_points.11.2", "is nan; allowed: a finite number"),
    "weights": ("weights = [1, 1,", "weights = [1, 0,", "bodies.lower.patch.weights", "weight 1 is 0; weights must be positive"),
    "number of weights": (
        "weights = [1, 1,",
        "weights = [1,",
        "bodies.lower.patch.weights",
        "has 11 values; knots and orders ask for 3 x 2 x 2 = 12",
    ),
    "quadrature": ("[contacts.pair]", "[contacts.pair]\nquadrature = [6, 0]", "contacts.pair.quadrature.1", "greater than or equal to 1"),
    "face": ('face = "upper.w1"', 'face = "upper.w2"', "supports.top.face", "upper has no face 'w2'; allowed: u0, u1, v0, v1, w0, w1"),
    "body": (
        'slave = "upper.w0"',
        'slave = "uper.w0"',
        "contacts.pair.slave",
        "there is no body 'uper'; allowed: BODY.FACE with BODY one of upper, lower",
    ),
    "no face of a slave": (
        'slave = "upper.w0"',
        'slave = "upper"',
        "contacts.pair.slave",
        "is 'upper', which names no face; allowed: BODY.FACE",
    ),
    "no component": (
        'face = "upper.w1"',
        'face = "upper.w1"\ncomponents = ["w"]',
        "supports.top.components.0",
        "is 'w'; allowed: 'x', 'y' or 'z'",
    ),
    "slave is master": ('master = "lower.w1"', 'master = "upper.w0"', "contacts.pair.master", "is the slave face 'upper.w0' itself"),
    "no master": ('master = "lower.w1"\n', "", "contacts.pair", "has neither master nor plane; allowed: exactly one of them"),
    "friction": (
        'master = "lower.w1"',
        'master = "lower.w1"\nfriction = -0.1',
        "contacts.pair.friction",
        "is -0.1; allowed: greater than or equal to 0",
    ),
    "normal": ("normal = [0, 0, 1]", "normal = [0, 0, 0]", "contacts.floor.plane.normal", "length zero"),
    "tangent": (
        "tangent = [1, 0, 0]",
        "tangent = [0, 0, -5]",
        "contacts.floor.plane.tangent",
        "parallel to the normal; allowed: any other direction",
    ),
    "axis": ('face = "upper.w1"', 'face = "upper.w1"\naxis = [0, 0, 0]', "supports.top.axis", "length zero"),
    "components": (
        'face = "upper.w1"',
        'face = "upper.w1"\ncomponents = ["x", "r"]',
        "supports.top.components.1",
        "is 'r'; allowed: 'x', 'y' or 'z'",
    ),
    "component twice": ('face = "upper.w1"', 'face = "upper.w1"\ncomponents = ["x", "x"]', "supports.top.components", "each once"),
    "steps": ("steps = 3", "steps = 0", "stages.press.steps", "is 0; allowed: greater than or equal to 1"),
    "motion of nobody": (
        "motions.top.rotate",
        "motions.tip.rotate",
        "stages.turn.motions.tip",
        "there is no such support; allowed: top, base",
    ),
    "turns without end": (
        "motions.top.rotate = 10",
        "motions.top.rotate = -1e20",
        "stages.turn.motions.top.rotate",
        "turns support 'top' 2.78e+17 times in 2 load steps; allowed: 10 times in each",
    ),
    "way without end": (
        "motions.top.translate = [0, 0, -0.2]",
        "motions.top.translate = [0, 1e20, -0.2]",
        "stages.press.motions.top.translate",
        "has gone 1e+20 by the end of the stage, where the coordinates of body 'upper' have no digits left",
    ),
    "way beyond numbers": (
        "motions.top.translate = [0, 0, -0.2]",
        "motions.top.translate = [0, 0, -1e308]\n[[stages]]\nname = 'more'\nsteps = 1\nmotions.top.translate = [0, 0, -1e308]",
        "stages.press.motions.top.translate",
        "has gone 1e+308 by the end of the stage",
    ),
    "centre without digits": (
        'face = "upper.w1"',
        'face = "upper.w1"\ncentre = [-1e15, 0, 0]',
        "supports.top.centre",
        "is 1e+15 from the origin, where the coordinates of body 'upper' have no digits left",
    ),
    "stage twice": ('name = "turn"', 'name = "press"', "stages.1.name", "is the name of two stages"),
    "free body": ('[supports.top]\nface = "upper.w1"', '[supports.top]\nface = "lower.u0"', "bodies.upper", "body 'upper' is free"),
    "free on a plane": ('[supports.base]\nface = "lower.w0"\n', "", "bodies.lower", "no load presses it on the plane that it touches"),
    "conflict": (
        '[supports.base]\nface = "lower.w0"',
        '[supports.base]\nface = "lower.w0"\n[supports.side]\nface = "upper.u0"',
        "supports.side",
        "prescribes x of 4 control points (the first at -0.5, -0.5, 1) that support 'top' moves differently",
    ),
    "solver": ("max_cuts = 4", "max_cuts = -1", "solver.max_cuts", "is -1; allowed: greater than or equal to 0"),
    "solver, cuts without end": ("max_cuts = 4", "max_cuts = 54", "solver.max_cuts", "is 54; allowed: less than or equal to 30"),
    "path by augmentations": (
        "max_cuts = 4",
        'method = "uzawa"\npath_tolerance = 0.001',
        "solver.path_tolerance",
        "is 0.001, below solver.augmentation_tolerance = 0.01",
    ),
    "compression of whole factors": (
        "max_cuts = 4",
        "compression = 1e-6",
        "solver.compression",
        'is 1e-06, and solver.engine is "own", whose factors are whole',
    ),
    "coarse compression": ("max_cuts = 4", "compression = 0.1", "solver.compression", "is 0.1; allowed: less than or equal to 0.01"),
    "engine": ("max_cuts = 4", 'engine = "petsc"', "solver.engine", "is 'petsc'; allowed: 'own' or 'mumps'"),
    "solver option": ("max_cuts = 4", 'slip_sum = "papers"', "solver.slip_sum", "is 'papers'; allowed: 'local' or 'paper'"),
    "curve": (
        "[solver]",
        '[[record.curves]]\nname = "drag"\nsupport = "tip"\n[solver]',
        "record.curves.drag.support",
        "allowed: top, base",
    ),
}
