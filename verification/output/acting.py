"""Pressures beside the master: no picture, page, export or trade takes the coefficients that reach there for pressures that act."""

from __future__ import annotations

import base64
import json
import re
import tempfile
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

import isomortar
from isomortar.accuracy.sampling import face_grid
from isomortar.harness import Bound, case
from isomortar.results.bodies import common_scale
from isomortar.results.face_field import face_field
from isomortar.results.fields import contact_surfaces
from isomortar.results.maps import draw_map
from isomortar.scene import Scene
from isomortar.trade import run as trade_run

#: A rigid roller on a wider block, whose edges are an eighth of an element over knot lines: functions reach far beyond them.
SCENE = """
format = 1
materials.rubber = { young = 5.0, poisson = 0.3 }
[bodies.base]
geometry = { kind = "box", lower = [-2, -2, -1], upper = [2, 2, 0] }
mesh = { order = [2, 2, 1], elements = [8, 6, 1] }
[bodies.roller]
geometry = { kind = "ring", centre = [0, 0, 1], inner = 0.5, outer = 1, width = 1.5 }
mesh = { order = [2, 1, 1], elements = [8, 1, 1] }
rigid = true
[contacts.floor]
slave = "base.w1"
master = "roller.v1"
friction = 0
subcells = 0
[supports]
base.face = "base.w0"
hand = { face = "roller.v0", components = ["x", "y"], force.z = -1 }
[[stages]]
name = "press"
steps = 1
"""


@case(
    claim="A slave that goes beyond its master is shown, exported and measured with the pressures that act on it, however large the "
    "coefficients are of which little is over the master.",
    tier="gate",
    bounds={
        "hidden": Bound(
            at_least=10.0, reason="definition: the scene has such coefficients; their field over the largest pressure that acts"
        ),
        "shown": Bound(at_most=1.0 + 1e-6, reason="definition: largest pressures that are shown, as 32-bit floats"),
        "shares": Bound(at_most=0.07, reason="definition: as exact as quadrature points are near each other"),
        "beyond": Bound(at_most=0.0, reason="definition: area that presses a quadrature point and more beside the master"),
    },
)
def acting() -> dict[str, float]:
    """Largest field of all coefficients, and largest that is shown, over that at quadrature points; errors of shares; area beyond."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "run.h5"
        with isomortar.run(Scene.from_toml(SCENE), path) as results:
            problem, step = results.problem, results.step(1)
        page = isomortar.view(path, Path(folder) / "run.html").read_text()
        told = json.loads(re.search(r'id="page">(.*?)</script>', page, re.S)[1])  # type: ignore[index]
        isomortar.export(path, folder)
        root = ElementTree.parse(Path(folder) / "run" / "contacts-0001.vtu").getroot()
    (shares,) = (array.text for array in root.iter("DataArray") if array.get("Name") == "over master")
    over = np.frombuffer(base64.b64decode(str(shares))[8:]).reshape(6, 8)
    (surface,), largest = contact_surfaces(problem, step), float(step.contacts[0].pressure_field[1])
    body = problem.body("base")
    grid = face_grid(body.patch, "w1", 4096)
    pressures = trade_run._fields(problem, step, [grid])[0][0]
    everywhere, _ = surface.on_grid([d.subdivided(8) for d in surface.directions], surface.pressure[:, None])
    bar = draw_map(problem, step, face_field(problem, step, 0)).axes[0].collections
    colours = float(np.max([drawn.get_clim()[1] or 0.0 for drawn in bar if drawn.get_array() is not None]))
    shown = [colours, common_scale(problem, [step], 0).face.peak, float(told["fields"][0]["range"][1]), float(pressures.max())]
    presses = grid.weights @ ((pressures > 0) & (np.abs(_across(grid.places)) > 0.9))
    return {
        "hidden": float(everywhere.max()) / largest,
        "shown": float(np.max(shown)) / largest,
        "shares": float(np.abs(over - [[0.0], [0.125], [1.0], [1.0], [0.125], [0.0]]).max()),
        "beyond": float(presses) / float(grid.weights.sum()),
    }


def _across(places: tuple[np.ndarray, ...]) -> np.ndarray:
    """Places along y of a grid over the block's upper side."""
    along, across = places
    return np.repeat(4.0 * across - 2.0, len(along))
