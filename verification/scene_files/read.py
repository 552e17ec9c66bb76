"""What a scene file is read as, against a table of what it says, and what comes of it when it is written again."""

from __future__ import annotations

import tempfile
import tomllib
from collections.abc import Callable, Iterator
from itertools import product
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np

from isomortar.errors import InputError
from isomortar.geometry.patch import Patch
from isomortar.geometry.primitives import ring
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case
from isomortar.model.entities import RigidPlane
from isomortar.model.settings import SolverSettings
from isomortar.scene import Scene, bundled_scenes
from isomortar.scene import build as building
from isomortar.scene.geometry_file import read_geometry, write_geometry
from isomortar.scene.keys import settable_keys
from isomortar.scene.source import parse as parsed
from isomortar.scene.source import read_source
from isomortar.scene.text import read_text

WRONG = Bound(0.0, 0.0, "definition: what a scene file says is what there is, and nothing else")
BOX = """
format = 1
bodies.block = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh = MESH }
supports.top.face = "block.w1"
MORE
"""
#: Stages and factors: of what is driven in all of them, and in the first and third alone.
DRIVEN = """
format = 1
bodies.block = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh = { order = 1, elements = 1 } }
[supports]
floor.face = "block.w0"
pulled = { face = "block.u1", force = { x = 1 } }
turned = { face = "block.v1", moment = 2 }
both = { face = "block.v0", force = { x = 1, y = 0 }, moment = 0, stages = ["a", "c"] }
moved = { face = "block.w1", stages = ["a", "c"] }
[loads]
weight = { body = "block", weight = [0, 0, -1] }
press = { face = "block.u0", pressure = 1 }
[[stages]]
name = "a"
steps = 1
loads = { both = 0.5, weight = 0.25 }
[[stages]]
name = "b"
steps = 2
loads = { pulled = 0.3, weight = -1 }
[[stages]]
name = "c"
steps = 1
[[stages]]
name = "d"
steps = 1
loads = { turned = 3, weight = 0 }
"""
FACTORS = {
    "floor": (), "moved": (), "pulled": (1.0, 0.3, 0.3, 0.3), "turned": (1.0, 1.0, 1.0, 3.0), "both": (0.5, 0.0, 0.5, 0.0),
    "weight": (0.25, -1.0, -1.0, 0.0), "press": (1.0, 1.0, 1.0, 1.0),
}  # fmt: skip


def box(mesh_table: str = "{ order = 1, elements = 1 }", more: str = 'stages = [{ name = "rest", steps = 1 }]') -> str:
    """A scene of one block."""
    return BOX.replace("MESH", mesh_table).replace("MORE", more)


def refusal(action: Callable[[], object]) -> str:
    """The sentence by which something is refused; empty: it is not."""
    try:
        action()
    except InputError as error:
        return str(error)
    return ""


@case(
    claim="Loads, and forces and moments of supports, have the factors that stages give them: that of the stage before where one says "
    "nothing, 1 in the first, and 0 where a support does not hold.",
    tier="gate",
    bounds={"wrong": WRONG},
)
def factors() -> dict[str, float]:
    """How many have others."""
    with mock.patch.object(building, "held_on_planes", lambda problem, _: problem):
        problem = Scene.from_toml(DRIVEN).whole()
    found = {support.name: support.factors for support in problem.supports} | {load.name: load.factors for load in problem.loads}
    held = {support.name: support.stages for support in problem.supports}
    wrong = sum(found[name] != expected for name, expected in FACTORS.items()) + (found.keys() != FACTORS.keys())
    wrong += held != {"floor": None, "pulled": None, "turned": None, "both": (0, 2), "moved": (0, 2)}
    return {"wrong": float(wrong)}


def plane_of(normal: np.ndarray, tangent: np.ndarray | None) -> RigidPlane:
    """As a scene file describes it."""
    also = "" if tangent is None else f", tangent = {tangent.tolist()}"
    text = (
        f'contacts.floor = {{ slave = "block.w0", plane = {{ normal = {normal.tolist()}{also} }} }}\nstages = [{{ name = "a", steps = 1 }}]'
    )
    master = Scene.from_toml(box(more=text)).whole().contacts[0].master
    assert isinstance(master, RigidPlane)
    return master


@case(
    claim="A scene without a name has that of its file, with _ for what names cannot have; supports prescribe components in the order x, "
    "y, z, however they are given.",
    tier="gate",
    bounds={"wrong": WRONG},
)
def names() -> dict[str, float]:
    """How many have others."""
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        for file, name in (
            ("my-scene.toml", "my-scene"),
            ("a_1.toml", "a_1"),
            ("my scene.v2.toml", "my_scene_v2"),
            ("größe.toml", "größe"),
            ("接触 1.toml", "接触_1"),
        ):
            (Path(folder) / file).write_text(box())
            wrong += Scene.load(Path(folder) / file).name != name
    for given, components in (("zyx", (0, 1, 2)), ("yx", (0, 1)), ("zx", (0, 2)), ("y", (1,))):
        support = Scene.from_toml(box(), overrides=[f"supports.top.components={list(given)}"]).whole().supports[0]
        wrong += support.components != components
    return {"wrong": float(wrong)}


@case(
    claim="A rigid plane has a normal of length one along the given one, and a tangent across it: the part of the given one, of x, or of "
    "y where x is nearly normal, in the plane.",
    tier="gate",
    bounds={"error": Bound(at_most=1e-14, reason="round-off: of unit vectors")},
)
def planes() -> dict[str, float]:
    """Largest difference."""
    random, worst = np.random.default_rng(4), 0.0
    axes = [sign * axis for axis in np.eye(3) for sign in (1.0, -3.0)]
    near = [np.array([sign * 0.95, 0.2, 0.1]) for sign in (1.0, -1.0)]
    for normal in (*axes, *near, *random.normal(size=(6, 3))):
        n = normal / np.linalg.norm(normal)
        for tangent in (None, random.normal(size=3)):
            along = (np.eye(3)[0 if abs(n[0]) < 0.9 else 1]) if tangent is None else tangent
            exact = np.cross(np.cross(n, along), n)
            found = plane_of(normal, tangent)
            off = np.abs(found.normal - n).max(), np.abs(found.tangent - exact / np.linalg.norm(exact)).max()
            worst = np.max([worst, *off])
    return {"error": float(worst)}


@case(
    claim="A scene that is too large is refused before it is made, by the unknowns that it would have.",
    tier="gate",
    bounds={"wrong": WRONG},
)
def sizes() -> dict[str, float]:
    """Of how many meshes another number is told than they have."""
    wrong = 0
    for families, order, elements in product(("N", "L", "NLN", "LNL"), ((1, 1, 1), (3, 1, 2)), ((1, 1, 1), (2, 5, 3))):
        family = list(families * 3)[:3]
        scene = Scene.from_toml(box(f"{{ family = {family}, order = {list(order)}, elements = {list(elements)} }}"))
        unknowns = 3 * len(scene.whole().bodies[0].patch.control_points)
        for most, said in ((unknowns, ""), (unknowns - 1, f"{unknowns} unknowns")):
            with mock.patch.object(building, "MAX_UNKNOWNS", most):
                told = refusal(scene.whole)
            wrong += bool(told) != bool(said) or said not in told
    return {"wrong": float(wrong)}


@case(
    claim="An override sets the value that its path names, of stages by name or by number, and no other; what is not there is refused, "
    "by what is, but for a load that is whole.",
    tier="gate",
    bounds={"wrong": WRONG},
)
def overrides() -> dict[str, float]:
    """How many do otherwise."""
    names = [stage.name for stage in Scene.from_toml(DRIVEN).tables.stages]
    wrong = 0
    for number, name in enumerate(names):
        for place in (str(number), name):
            steps = [stage.steps for stage in Scene.from_toml(DRIVEN, overrides=[f"stages.{place}.steps=7"]).tables.stages]
            wrong += steps != [7 if k == number else (1, 2, 1, 1)[k] for k in range(4)]
    for path in ("stages.4.steps=7", "stages.-1.steps=7", "stages.e.steps=7", "supports.side.face=block.u0", "bodies.ball.rigid=true"):
        wrong += not refusal(lambda path=path: Scene.from_toml(DRIVEN, overrides=[path]))  # type: ignore[misc]
    for path in ("supports.side.face=block.u0", "bodies.ball.rigid=true", "loads.gust.pressure=1"):
        table = path.partition(".")[0]
        told = refusal(lambda path=path: Scene.from_toml(DRIVEN, overrides=[path]))  # type: ignore[misc]
        wrong += f"an override changes what the scene has; {table} there: {next(iter(tomllib.loads(DRIVEN)[table]))}" not in told
    added = Scene.from_toml(DRIVEN, overrides=['loads.gust={ face = "block.u0", pressure = 3 }']).tables.loads
    wrong += list(added) != ["weight", "press", "gust"] or added["gust"].pressure != 3.0
    for path in ("format.x=1", "title", "=1", "title=[1", "title=a b", "stages.0=1", "title=1\ntitle=2"):
        wrong += not refusal(lambda path=path: Scene.from_toml(DRIVEN, overrides=[path]))  # type: ignore[misc]
    by_path = Scene.from_toml(DRIVEN, overrides={"stages.c.steps": np.int64(4), "supports.moved.axis": np.array([1.0, 0.0, 0.0])}).tables
    wrong += by_path.stages[2].steps != 4 or by_path.supports["moved"].axis != (1.0, 0.0, 0.0)
    return {"wrong": float(wrong)}


@case(
    claim="A file that is no text in UTF-8 is refused by what it is most likely, and by the line of what is not; its byte-order mark is "
    "none of its text.",
    tier="gate",
    bounds={"wrong": WRONG},
)
def encodings() -> dict[str, float]:
    """How many files are told of otherwise."""
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scene.toml"
        text = 'title = "größer"\nname = "a"\n'
        for encoding, said in (
            ("utf-8", ""), ("utf-8-sig", ""), ("utf-16", "UTF-16"), ("utf-16-le", "UTF-16"), ("utf-16-be", "UTF-16"), ("utf-32", "UTF-32"),
        ):  # fmt: skip
            path.write_bytes(text.encode(encoding))
            told = refusal(lambda: read_text(path))
            wrong += bool(told) != bool(said) or said not in told or (not said and read_text(path) != text)
        for line in (1, 2, 5):
            path.write_bytes(b"# a\n" * (line - 1) + b'title = "gr\xf6\xdfer"\n')
            wrong += f"byte 0xf6 in line {line} is not UTF-8" not in refusal(lambda: read_text(path))
        path.write_bytes(b"isomortar results file; and so on")
        wrong += "is a results file" not in refusal(lambda: read_text(path))
    return {"wrong": float(wrong)}


def leaves(data: Any, path: str = "") -> Iterator[str]:
    """Paths of the single values of a file, of stages by their names."""
    if isinstance(data, dict) and data:
        for key, value in data.items():
            yield from leaves(value, f"{path}.{key}".lstrip("."))
    elif isinstance(data, list) and data and all(isinstance(entry, dict) for entry in data):
        for number, entry in enumerate(data):
            yield from leaves(entry, f"{path}.{entry.get('name', number)}")
    else:
        yield path


@case(
    claim="Keys that can be set are those of every value of the bundled scenes, all settings of the solver, and what is left out and has a "
    "default; each but the kind of a body has a meaning.",
    tier="gate",
    bounds={"wrong": WRONG},
)
def keys() -> dict[str, float]:
    """How many are not there, or mean nothing."""
    wrong = 0
    always = {f"solver.{name}" for name in SolverSettings.__dataclass_fields__} | {"record.states", "record.curves", "title", "name"}
    for name in bundled_scenes():
        found = dict(settable_keys(name))
        data = parsed(read_source(name)[0], name)
        bodies = {f"bodies.{body}.mesh.{key}" for body in data["bodies"] for key in ("order", "elements", "quadrature")}
        there = {path for path in leaves(data) if not path.startswith("record.curves.")}
        wrong += len((always | bodies | there) - found.keys())
        wrong += sum(not meaning for path, meaning in found.items() if not path.endswith("geometry.kind"))
    return {"wrong": float(wrong + len({"title", "format", "record.states"} - dict(settable_keys(None)).keys()))}


def unlike(one: Patch, other: Patch) -> bool:
    """Whether a bit of two patches differs."""
    arrays = [(one.control_points, other.control_points), (one.weights, other.weights)]
    arrays += [(a.knots, b.knots) for a, b in zip(one.directions, other.directions, strict=True)]
    kinds = [[(d.family, d.order) for d in patch.directions] for patch in (one, other)]
    return kinds[0] != kinds[1] or any(a.tobytes() != b.tobytes() for a, b in arrays)


@case(
    claim="A geometry file gives back the patch that was written, to the bit, and a scene that names it needs it no more when it is "
    "written.",
    tier="gate",
    bounds={"wrong": WRONG},
)
def written() -> dict[str, float]:
    """How many patches are others."""
    wrong = 0
    text = box(more="stages = [{ name = 'rest', steps = 1 }]").replace(
        'geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }', "FROM"
    )
    body = mesh(ring((0.1, 0.2, 0.3), 0.5, 1.1, 0.7, (10.0, 100.0)), ("N", "N", "N"), (3, 2, 2), (3, 2, 1))
    lagrange = mesh(body, ("L", "N", "L"), (2, 2, 1), (3, 2, 1))
    for patch in (body, lagrange):
        with tempfile.TemporaryDirectory() as folder:
            write_geometry(Path(folder) / "body.toml", patch)
            wrong += unlike(read_geometry(Path(folder) / "body.toml"), patch)
            scene = Scene.from_toml(text.replace("FROM", 'file = "body.toml"').replace(", mesh = { order = 1, elements = 1 }", ""), folder)
            wrong += unlike(scene.whole().bodies[0].patch, patch)
            again = scene.to_toml()
        wrong += unlike(Scene.from_toml(again).whole().bodies[0].patch, patch)
    return {"wrong": float(wrong)}
