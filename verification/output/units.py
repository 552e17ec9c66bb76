"""Units that a results file says its numbers have: a scene in other units gives the same numbers times those of the units."""

from __future__ import annotations

import re
import tempfile
from pathlib import Path

import h5py
import numpy as np

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.results.fields import contact_surfaces
from isomortar.results.writer import ResultsWriter
from isomortar.scene import Scene

#: A wheel that is pressed on a block by a force and dragged with friction, and its weight; all lengths and forces by a factor.
SCENE = """
format = 1
[materials]
rubber = {{ young = {stress}, poisson = 0.3 }}
[bodies.wheel]
geometry = {{ kind = "ring", centre = [0, 0, {up}], inner = {inner}, outer = {outer}, width = {inner} }}
mesh = {{ order = [2, 1, 1], elements = [8, 1, 1] }}
[bodies.base]
geometry = {{ kind = "box", lower = [-{outer}, -{outer}, -{inner}], upper = [{outer}, {outer}, 0] }}
mesh = {{ order = [2, 2, 1], elements = [3, 2, 1] }}
[contacts.tread]
slave = "wheel.v1"
master = "base.w1"
friction = 0.3
projection = "averaged"
[supports]
ground.face = "base.w0"
hub = {{ face = "wheel.v0", centre = [0, 0, {up}], axis = [0, 1, 0], force = {{ z = -{force} }} }}
[loads]
weight = {{ body = "wheel", weight = [0, 0, -{density}] }}
side = {{ face = "base.u0", pressure = {pressure} }}
[[stages]]
name = "roll"
steps = 2
motions.hub = {{ translate = [{way}, 0, 0], rotate = 2 }}
"""
#: Factors of lengths and of forces: powers of two, so that little else differs.
LENGTH, FORCE = 4.0, 32.0
FACTORS = {"force": FORCE, "length": LENGTH, "area": LENGTH**2, "degrees": 1.0, "parameter": 1.0, "load step": 1.0, "1": 1.0}


def run(folder: Path, length: float, force: float) -> tuple[dict[str, tuple[str, np.ndarray]], float]:
    """All numbers of a results file with their units, by their names; and what the slave's pressures differ by at its seam."""
    stress = force / length**2
    text = SCENE.format(
        stress=stress, up=0.499 * length, inner=0.25 * length, outer=0.5 * length, force=0.003 * force, density=1e-4 * force / length**3,
        pressure=1e-4 * stress, way=0.002 * length,
    )  # fmt: skip
    problem = Scene.from_toml(text).problem()
    path = folder / f"{length:g}.h5"
    writer = ResultsWriter(path, problem, text, "0")
    last = None
    for last in Simulation(problem).run():
        writer.recorded(last)
    assert last is not None
    found: dict[str, tuple[str, np.ndarray]] = {}

    def look(name: str, data: h5py.Dataset | h5py.Group) -> None:
        if isinstance(data, h5py.Dataset) and "unit" in data.attrs and data.dtype.kind in "fi" and data.size:
            found[name] = str(data.attrs["unit"]), data[()]

    with h5py.File(path) as file:
        file.visititems(look)
    (surface,) = contact_surfaces(problem, last)
    first, second = surface.directions
    rows = surface.pressure.reshape(second.count, first.count)
    assert rows.any()
    ends = (rows[:, [0, -1]] if surface.letters[0] == "u" else rows[[0, -1]].T).T
    return found, float(np.abs(ends[1] - ends[0]).max())


def factor(unit: str) -> float | None:
    """What numbers of a unit are multiplied by; None: they are no quantity of the scene."""
    names = re.split(r"[*/]", unit)
    if not set(names) <= set(FACTORS):
        return None
    whole = 1.0
    for sign, name in zip(("*", *re.findall(r"[*/]", unit)), names, strict=True):
        whole *= FACTORS[name] if sign == "*" else 1.0 / FACTORS[name]
    return whole


@case(
    claim="In other units of length and force all numbers of a results file are the same, times those of their units; pressures "
    "at the seam of a closed slave are one.",
    tier="gate",
    bounds={
        "error": Bound(
            at_most=1e-12, reason="round-off: of runs of the same numbers but for powers of two, by the largest of each quantity"
        ),
        "quantities": Bound(at_least=20.0, reason="definition: quantities with a unit of length or force"),
        "seam": Bound(at_most=0.0, reason="definition: both ends of the slave are the same control points"),
    },
)
def units() -> dict[str, float]:
    """Largest difference over the largest number of a quantity; how many there are."""
    with tempfile.TemporaryDirectory() as folder:
        one, seam = run(Path(folder), 1.0, 1.0)
        other, _ = run(Path(folder), LENGTH, FORCE)
    worst, count = 0.0, 0
    for name, (unit, values) in one.items():
        times = factor(unit)
        if times is None or unit == "1" or not np.abs(np.nan_to_num(values)).max():
            continue
        count += times != 1.0
        expected = np.nan_to_num(values) * times
        worst = float(np.maximum(worst, np.abs(np.nan_to_num(other[name][1]) - expected).max() / np.abs(expected).max()))
    return {"error": worst, "quantities": float(count), "seam": seam}
