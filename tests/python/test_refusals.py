"""What the program says, word by word, where `test_sentences.py` does not hear it: refusals, causes, words on figures."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

import h5py
import numpy as np
import pytest
import splinepy
from matplotlib.figure import Figure
from matplotlib.text import Text
from told import corners, loose, tipping, too_tight
from told.too_steep import LOADS, of_block, said
from told.wrong.contacts import LAGRANGE, PAIR, PRESS
from told.wrong.halves import PLANE
from told.wrong.sides import ALL
from told.wrong.sides import GOOD as SIDES
from told.wrong.sides import PAIR as ROW
from told.wrong.singular import BLOCK, error

from isomortar import Results, Scene, _distributed, film, plot, view
from isomortar._codes import Status
from isomortar._condensed import CondensedFactors
from isomortar.errors import FoldedElementError
from isomortar.geometry import primitives
from isomortar.geometry.halves import upper_half
from isomortar.geometry.patch import Direction, Patch
from isomortar.geometry.refinement import mesh
from isomortar.march.simulation import Simulation
from isomortar.model import checks
from isomortar.model.contact_checks import check_contacts
from isomortar.model.enforcement.face import SlaveFace
from isomortar.model.enforcement.side import pointwise
from isomortar.model.entities import Body
from isomortar.model.numbering import Numbering
from isomortar.model.raised import lowered
from isomortar.results import files, layout
from isomortar.results.pictures import FIELDS
from isomortar.results.writer import ResultsWriter
from isomortar.scene.source import apply_overrides
from isomortar.solve import feet, singular, system
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.singular import PairConditions
from isomortar.solve.timing import Ledger
from isomortar.told.before import doubts
from isomortar.told.before.pairing import by_default
from isomortar.trade.search import Search
from isomortar.trade.want import wanted
from results_samples import problem, step_result, without_contact
from test_advice import warnings
from test_causes import pushed
from test_feet import cone, loaded, on_the_axis, ridge
from test_poles import drawn_together
from test_sentences import HEARD, Told, refusal, without_digits
from test_singular import FROM_BESIDE
from trade_formulas import Formula, synthetic


def of_geometry(_: pytest.MonkeyPatch) -> Told:
    """Directions, primitives, meshes and halves that there are not."""
    line = np.array([0.0, 0.0, 1.0, 1.0])
    yield "family", refusal(lambda: Direction("B", 1, line))  # type: ignore[arg-type]
    yield "order", refusal(lambda: Direction("L", 5, line))
    yield "knots: few", refusal(lambda: Direction("N", 2, line))
    yield "knots: not a list", refusal(lambda: Direction("N", 1, np.array([line])))
    yield "knots: fall", refusal(lambda: Direction("N", 1, np.array([0.0, 0.0, 0.7, 0.4, 1.0, 1.0])))
    yield "knots: not open", refusal(lambda: Direction("N", 1, np.array([0.0, 0.1, 0.9, 1.0])))
    yield "knots: too near", refusal(lambda: Direction("N", 1, np.array([0.0, 0.0, 1e-80, 1.0, 1.0])))
    yield "knots: torn", refusal(lambda: Direction("N", 1, np.array([0.0, 0.0, 0.5, 0.5, 1.0, 1.0])))
    yield "boundaries", refusal(lambda: Direction("L", 1, line))
    yield "box", refusal(lambda: primitives.box((0, 0, 0), (1, 1, 0)))
    yield "box upside down", refusal(lambda: primitives.box((0, 0, 0), (-0.5, -0.5, -0.5)))
    yield "box far away", refusal(lambda: primitives.box((1e16, 0, 0), (1e16, 1, 1)))
    yield "bowl: width", refusal(lambda: primitives.bowl((0, 0), 0.0, 0, 0, 1))
    yield "bowl: top", refusal(lambda: primitives.bowl((0, 0), 1.0, 0, 0.25, 0.5))
    yield "cap: radius", refusal(lambda: primitives.cap((0, 0), 0.0, 0.5, 0, 1))
    yield "cap: width", refusal(lambda: primitives.cap((0, 0), 2.0, 1.9, 0, 4))
    yield "cap: top", refusal(lambda: primitives.cap((0, 0), 2.0, 1.0, 0, 0.5))
    yield "wedge: order", refusal(lambda: primitives.wedge((0, 0), (1, -1), (0, 1), (0, 1)))
    yield "wedge: flat", refusal(lambda: primitives.wedge((0, 0), (-1, 1), (0, 1), (1, 1)))
    yield "wedge: two edges", refusal(lambda: primitives.wedge((0, 0), (1, 1), (0, 1), (0, 1)))
    yield "ring: inner", refusal(lambda: primitives.ring((0, 0, 0), -0.1, 1, 1))
    yield "ring: angles", refusal(lambda: primitives.ring((0, 0, 0), 0, 1, 1, (90, 90)))
    yield "sphere: latitudes", refusal(lambda: primitives.sphere((0, 0, 0), 0, 1, (0, 100)))
    yield "torus: latitudes", refusal(lambda: primitives.torus((0, 0, 0), 2, 0, 1, (90, 0)))
    yield "torus: radius", refusal(lambda: primitives.torus((0, 0, 0), 1, 0, 1))
    yield "ring: outer", refusal(lambda: primitives.ring((0, 0, 0), 1.0, 1, 1))
    yield "ring: width", refusal(lambda: primitives.ring((0, 0, 0), 1.0, 2, -1))
    box = primitives.box((0, 0, 0), (1, 1, 1))
    meshed = mesh(box, ("L", "N", "N"), (1, 1, 1), (2, 2, 2))
    yield "mesh of a mesh", refusal(lambda: mesh(meshed, ("L", "N", "N"), (2, 1, 1), (2, 2, 2)))
    ring = primitives.ring((0, 0, 0), 1, 2, 1)
    yield "elements", refusal(lambda: mesh(ring, ("N", "N", "N"), (2, 1, 1), (6, 1, 1)))
    yield "half", refusal(lambda: upper_half(meshed, 0, 0.4))
    row = mesh(box, ("L", "L", "L"), (1, 1, 1), (4, 1, 1))
    points = row.control_points.copy()
    points[:, 0] = np.resize([-2.0, 0.5, 0.0, -0.5, 2.0], len(points))
    yield "half that is folded", refusal(lambda: upper_half(replace(row, control_points=points), 0, 0.0))
    points = np.where(np.arange(24).reshape(8, 3) == 5, np.nan, box.control_points)
    yield "points", refusal(lambda: Patch(box.directions, points, box.weights))
    yield "few points", refusal(lambda: Patch(box.directions, points[:7], box.weights))
    yield "few weights", refusal(lambda: Patch(box.directions, box.control_points, box.weights[:7]))
    yield "no weight", refusal(lambda: Patch(box.directions, box.control_points, 0.0 * box.weights))
    yield "light weight", refusal(lambda: Patch(box.directions, box.control_points, np.array([1.0] * 7 + [1e-160])))
    raised = Direction("N", 2, np.array([0.0, 0, 0, 0.5, 1, 1, 1]))
    yield "raised", refusal(lambda: lowered(raised, 1))
    Path("bad.json").write_text("{")
    flat = splinepy.BSpline([1, 1], [line, line], np.zeros((4, 2)))
    splinepy.io.json.export("flat.json", [flat, flat])
    yield "no volume", _of(_FILE.replace("bad", "flat"))
    yield "file", re.sub(r"format\): .*", "format): #", _of(_FILE))
    yield "folder", _of(_FILE.replace("bad.json", "."))


_FILE = """
format = 1
bodies.a.file = "bad.json"
supports.top.face = "a.w1"
stages = [{ name = "pull", steps = 1, motions.top.translate = [0, 0, 0.1] }]
"""


def of_problems(patch: pytest.MonkeyPatch) -> Told:
    """Bodies, contacts and engines that cannot be meant, or that no number holds."""
    with pytest.MonkeyPatch.context() as within:
        within.setattr(_distributed, "is_built", lambda: False)
        within.setenv(_distributed.PROGRAMS, "2")
        yield "engine that is not built in", _stopped(PRESS, "solver.engine=mumps")
        yield "ranks that would wait", refusal(lambda: _distributed.refuse_idle("own"))
    yield "digits", _of(PRESS, "bodies.block.geometry.centre=[1e15,0]", "contacts.floor.plane.point=[1e15,0,0]")
    pair = Scene.from_toml(PAIR).problem()
    for name, body, face, change in (
        ("averaged normals at a pole", "lower", "w1", {"projection": "averaged"}),
        ("points at a pole", "upper", "w0", {"enforcement": "knots"}),
    ):
        asked = replace(pair, contacts=(replace(pair.contacts[0], **change),))  # type: ignore[arg-type]
        yield name, refusal(partial(check_contacts, drawn_together(asked, body, face, np.s_[0, :])))
    face = SlaveFace(replace(pair.contacts[0], enforcement="greville"), pair, Numbering(pair))
    yield "areas", refusal(lambda: pointwise(face, np.array([[0.25, 0.5]]), np.array([-1e-3])))
    joints = '["a.v1", "c.v0"], ["b.v1", "d.v0"]]'
    yield "torn side", _of(SIDES.replace(ROW, ALL).replace('["a.v1", "c.v0"]]', joints))
    block = Scene.from_toml(PAIR, overrides=["bodies.lower.mesh={ order = 2, contact_order = 3, elements = 2 }"]).problem()
    lower = block.body("lower")
    bent = replace(lower.patch, control_points=lower.patch.control_points + 0.01 * np.sin(7.0 * lower.patch.control_points[:, ::-1]))
    changed = replace(block, bodies=tuple(replace(b, patch=bent) if b.name == "lower" else b for b in block.bodies))
    yield "raised", refusal(lambda: Simulation(changed))
    upper = pair.body("upper").patch
    points = upper.control_points.copy()
    points[4] += [0.5, 0.5, 0.5]
    torn, mirrored = (
        replace(pair, bodies=tuple(replace(b, patch=replace(upper, control_points=moved)) if b.name == "upper" else b for b in pair.bodies))
        for moved in (points, upper.control_points * [-1, 1, 1])
    )
    yield "folded", refusal(lambda: Simulation(torn))
    flat = replace(upper, control_points=upper.control_points * [1, 1, 0])
    pressed = replace(pair, bodies=tuple(replace(b, patch=flat) if b.name == "upper" else b for b in pair.bodies))
    yield "flat", refusal(lambda: Numbering(pressed) and Simulation(pressed))
    yield "left-handed", refusal(lambda: Simulation(mirrored))
    last = next(Simulation(Scene.from_toml(PRESS).problem()).run())
    yield "record of another problem", refusal(lambda: Simulation(pair, resume_from=last))
    yield "a scene for its problem", refusal(lambda: Simulation(Scene.from_toml(PRESS)))  # type: ignore[arg-type]
    search = Search(Formula(pair, synthetic()), synthetic(), [wanted("force.top.x", pair)], 5.0)
    yield "budget of a trade", refusal(search.screen)
    raised = "bodies.block.mesh={ order = 2, contact_order = 3, elements = [4, 4, 2] }"
    yield "symmetry: raised", _of(PLANE, raised, "symmetry={ x = 0.0 }")
    yield "symmetry: closed", _of(_TYRE, "symmetry={ x = 0.0 }")
    patch.setattr(checks, "memory_of_machine", lambda: 1e3)
    yield "memory", re.sub(r"[\d.e-]+ GB", "# GB", _of(PRESS))


_TYRE = """
format = 1
bodies.tyre.geometry = { kind = "ring", inner = 1.0, outer = 2.0, width = 1.0 }
bodies.tyre.mesh.elements = [8, 1, 2]
contacts.floor = { slave = "tyre.v1", plane = { point = [0, 0, -2] } }
supports.rim.face = "tyre.v0"
stages = [{ name = "press", steps = 1, motions.rim.translate = [0, 0, -0.1] }]
"""


def _of(text: str, *overrides: str) -> str:
    return refusal(lambda: Scene.from_toml(text, overrides=overrides).problem())


def of_files(patch: pytest.MonkeyPatch) -> Told:
    """Files that are no scene, or no results, and places where nothing can be written."""
    for name, content in {"UTF-16": "# a".encode("utf-16"), "Latin-1": "# ä".encode("latin-1")}.items():
        Path("scene.toml").write_bytes(content)
        yield name, refusal(lambda: Scene.load("scene.toml"))
    ResultsWriter("results.toml", problem(), "", "0")
    yield "results", refusal(lambda: Scene.load("results.toml"))
    Path("scene.toml").write_text("format = = 1")
    yield "no TOML", _but_the_end(refusal(lambda: Scene.load("scene.toml")))
    Path("twice.toml").write_text("format = 1\nformat = 1")
    yield "no TOML, twice", refusal(lambda: Scene.load("twice.toml")).partition(")")[2]
    Path("comma.toml").write_text("format = 0,1")
    yield "no TOML, where", refusal(lambda: Scene.load("comma.toml")).partition(")")[2]
    Path("letters.toml").write_text("bodies.klötzchen = {}", encoding="utf-8")
    yield "no TOML, letters", refusal(lambda: Scene.load("letters.toml")).partition(")")[2]
    Path("quote.toml").write_text('name = "a\nformat = 1')
    yield "no TOML, quote", refusal(lambda: Scene.load("quote.toml")).partition(")")[2]
    Path("braces.toml").write_text("a = { b = 1,\nc = 2 }")
    yield "no TOML, braces", refusal(lambda: Scene.load("braces.toml")).partition(")")[2]
    Path("point.toml").write_text("a = { b = 5., c = 2 }\n")
    yield "no TOML, point", refusal(lambda: Scene.load("point.toml")).partition(")")[2]
    yield "a scene for results", refusal(lambda: Results("point.toml"))
    Path("list.toml").write_text(f"a = [{40 * '1, '}5., 2, 3]\n")
    yield "no TOML, list", refusal(lambda: Scene.load("list.toml")).partition(")")[2]
    yield "values of no kind", refusal(lambda: Scene.load("press", 5))  # type: ignore[arg-type]
    ring: list[object] = []
    ring.append(ring)
    yield "values without end", refusal(lambda: Scene.load("press", {"solver.max_cuts": ring}))
    yield "value", _but_the_end(refusal(lambda: apply_overrides({"solver": {}}, ["solver.max_cuts=[1"])))
    writer = ResultsWriter("run.h5", problem(), "", "0", states="last")
    yield "plotted: no step", refusal(lambda: plot("run.h5", "figures"))
    yield "viewed: no step", refusal(lambda: view("run.h5", "run.html"))
    yield "contact: no step", refusal(lambda: Results("run.h5").contact("tread"))
    writer.recorded(step_result(1))
    writer.recorded(step_result(2))
    yield "not kept", refusal(lambda: Results("run.h5").step(1))
    yield "drawn: slip", refusal(lambda: plot("run.h5", "figures", fields=["slip"]))
    yield "drawn over: words", refusal(lambda: plot("run.h5", "figures", x="strain"))
    yield "drawn over: still", refusal(lambda: plot("run.h5", "figures", x="rotation of bed"))
    with patch.context() as within:
        within.setitem(sys.modules, "pandas", None)
        yield "no pandas", refusal(lambda: Results("run.h5").to_dataframe())
        within.setitem(sys.modules, "xarray", None)
        yield "no xarray", refusal(lambda: Results("run.h5").to_xarray())
    yield "of two", refusal(lambda: Results("run.h5").curve("force", support="rim", contact="tread"))
    yield "component", refusal(lambda: Results("run.h5").curve("force", support="rim", component="xy"))  # type: ignore[arg-type]
    Path("run.html").write_bytes(Path("run.h5").read_bytes())
    yield "viewed: over results", refusal(lambda: view("run.h5", "run.html"))
    yield "viewed: type", refusal(lambda: view("run.h5", "run.toml"))
    yield "filmed: one state", refusal(lambda: film("run.h5", "run.gif"))
    yield "filmed: type", refusal(lambda: film("run.h5", "run.avi"))
    with patch.context() as within:
        within.setitem(sys.modules, "imageio_ffmpeg", None)
        yield "filmed: no encoder", refusal(lambda: film("run.h5", "run.mp4"))
    yield "filmed: nothing", refusal(lambda: film("run.h5", "run.gif", every=0))
    yield "filmed: without end", refusal(lambda: film("run.h5", "run.gif", rate=0.001))
    alone, step = without_contact(problem(), step_result(1))
    ResultsWriter("alone.h5", alone, "", "0").recorded(step)
    yield "filmed: no contact", refusal(lambda: film("alone.h5", "run.gif"))
    yield "plotted: no contact", refusal(lambda: plot("alone.h5", "figures", only=["maps"]))
    versions = ("of an earlier version", "format_version", 1), ("of a later version", "format_version", 9)
    for name, key, value in (("another format", "format", "waves"), *versions):
        Path("other.h5").write_bytes(Path("run.h5").read_bytes())
        with h5py.File("other.h5", "r+") as file:
            file.attrs[key] = value
        Path("other.h5").write_bytes(files.sealed(Path("other.h5").read_bytes()))
        yield name, refusal(lambda: Results("other.h5"))
    Path("cut.h5").write_bytes(Path("run.h5").read_bytes()[:-1])
    yield "damaged", refusal(lambda: files.read(Path("cut.h5")))
    yield "gone", _but_the_end(refusal(lambda: files.read(Path("gone.h5"))))
    with h5py.File("other.h5", "r+") as file:
        file.attrs["format_version"] = layout.FORMAT_VERSION
        del file["curves/time"]
    Path("other.h5").write_bytes(files.sealed(Path("other.h5").read_bytes()))
    with Results("run.h5") as ended:
        pass
    yield "closed", refusal(lambda: ended.curve("time"))
    yield "without a curve", re.sub(r"\(.*?\),", "(#),", refusal(lambda: Results("other.h5").curve("time")))
    Path("there").mkdir()
    yield "not replaced", _but_the_end(refusal(lambda: files.replace(Path("there"), b"")))
    half = ResultsWriter("half.h5", problem(), "", "0")
    half.recorded(step_result(1))
    with patch.context() as within:
        within.setattr(files.os, "fsync", _full)
        yield "kept", re.sub(r"written: [^;]*", "written: #", refusal(lambda: half.recorded(step_result(2))))
    Path("file").touch()
    yield "no folder", refusal(lambda: files.make_folder(Path("file/folder")))
    yield "not written", _but_the_end(refusal(lambda: _written(Path("none/new.svg"))))
    with files.claimed(Path("run.h5")):
        yield "claimed", refusal(lambda: files.claimed(Path("run.h5")).__enter__())


def _written(path: Path) -> None:
    with files.writing(path) as fresh:
        fresh.touch()


def _full(_: int) -> None:
    raise OSError(28, "No space left on device")


def _but_the_end(text: str) -> str:
    """Without the words of the system, or of Python, after the last colon."""
    return f"{text.rpartition(': ')[0]}: #"


def on_the_way(patch: pytest.MonkeyPatch) -> Told:
    """What stops a run."""
    with pytest.MonkeyPatch.context() as within:
        solve = CondensedFactors.solve
        within.setattr(CondensedFactors, "compression", 1e-3)
        within.setattr(CondensedFactors, "solve", lambda self, b: 0.3 * solve(self, b))
        by_parts = Scene.load("press", ["bodies.block.mesh.elements=[6,6,4]"])
        yield "compression", without_digits(refusal(lambda: list(Simulation(by_parts.problem()).run())))
    yield "foot on an axis", refusal(lambda: loaded(on_the_axis()))
    yield "foot on a line", refusal(lambda: loaded(ridge(0.3, 0.41)))
    yield "foot beside a pole", refusal(lambda: loaded(cone(0.3)))
    with pytest.MonkeyPatch.context() as within:
        within.setitem(feet._DOUBTS, int(Status.DEGENERATE_SURFACE), feet._DOUBTS[Status.LOST_PROJECTION])
        yield "foot that does not settle", refusal(lambda: loaded(on_the_axis()))
    drag = "stages.press.motions.top.translate=[0.2,0,-0.1]"
    few = ["solver.path_tolerance=1e-9", "solver.max_cuts=0", "contacts.pair.friction=0.3", drag]
    yield "path", without_digits(_stopped(PAIR, *few))
    few = ["solver.max_iterations=1", "solver.max_cuts=0"]
    yield "Newton", without_digits(_stopped(PRESS, *few))
    yield "Newton, too tight", without_digits(too_tight.ending(too_tight.TIGHT["both"])).partition("iterations")[2]
    short = too_tight.ending(too_tight.TIGHT["of increments so short that more is left"])
    yield "Newton, too tight before", without_digits(short).partition("iterations. ")[2]
    patch.setattr(system.constants, "REFUSED_ABOVE", -1.0)
    patch.setattr(system.constants, "REFINED_ABOVE", -1.0)
    yield "digits", without_digits(_stopped(PRESS, "solver.max_cuts=0"))


def _stopped(text: str, *overrides: str) -> str:
    return refusal(lambda: list(Simulation(Scene.from_toml(text, overrides=overrides).problem()).run()))


def of_causes(patch: pytest.MonkeyPatch) -> Told:
    """What may be behind it, and warnings that no other test hears."""
    yield "over an edge", error(FROM_BESIDE).partition("to iteration. ")[2]
    yield "slides", refusal(lambda: list(pushed("along", "plane", 0.24).run())).partition("Friction")[2].replace(" of", "friction of", 1)
    yield "too steep", of_block(LOADS["weight"], "plane", "monolithic", 2.0).partition("Loads")[2].replace(" push", "loads push", 1)
    yield "tips", tipping.of_block("weight", "plane", "monolithic", 0.46).partition("Loads")[2].replace(" turn", "loads turn", 1)
    yield "onto", tipping.before(1.2).partition("Loads")[2].replace(" turn", "loads turn", 1)
    yield "lifts", said(tipping.HEAD + tipping.LOWER + tipping.LIFTED).partition("Loads")[2].replace(" move", "loads move", 1)
    yield "gives way", corners.in_corner(0.5, (-0.4, 0.0, -1.0), "monolithic", "planes").partition("No p")[2].replace("res", "no pres", 1)
    coarse = said(loose.ROLLER.replace("COUNT", "4"))
    yield "averages apart", "contact " + coarse.partition("Contact ")[2].partition(". Contact")[0]
    yield "gives way, without friction", said(tipping.HEAD + tipping.SMOOTH).partition("No p")[2].replace("res", "no pres", 1)
    equilibrium = Equilibrium(Scene.from_toml(BLOCK + 'supports.top.face = "block.w1"').problem(), Ledger())
    reference = equilibrium.numbering.reference
    pair, start = equilibrium.pairs[0], equilibrium.initial_state().contacts[0]
    conditions = PairConditions(pair, np.full(3 * pair.pair.slave.test.count, -1), pair.kinematics(reference, start))
    held = np.zeros(reference.size, dtype=np.bool_)
    held[3 * pair.pair.slave.point[0]] = True
    yield "prescribed", str(singular._repeated("singular", conditions, np.arange(9), [conditions], held))
    (yield "kinks", *by_default(Scene.from_toml(LAGRANGE).problem().contacts[0]))
    die = "bodies.lower.rigid=true"
    yield "nothing moves", warnings(PAIR, [die, "supports.top.face=upper.w0"])[0]

    def fold(_: Body) -> float:
        raise FoldedElementError("element 0, 1, 0 along u, v, w is folded", 2)

    patch.setattr(doubts, "quadrature_error", fold)
    (yield "between Gauss points", *warnings(PRESS))


def on_figures(patch: pytest.MonkeyPatch) -> Told:
    """All words on figures."""
    found: dict[str, set[str]] = {}

    def read(figure: Figure, path: Path, **_: object) -> None:
        found.setdefault(Path(path).name.split(".")[1], set()).update(text.get_text() for text in figure.findobj(Text))
        Path(path).touch()

    writer = ResultsWriter("drawn.h5", problem(), "", "0")
    writer.recorded(step_result(1))
    patch.setattr(Figure, "savefig", read)
    plot("drawn.h5", "figures", fields=FIELDS)
    alone, step = without_contact(problem(), step_result(1))
    ResultsWriter("alone.h5", alone, "", "0").recorded(step)
    plot("alone.h5", "figures", only=["bodies"])
    for name, texts in found.items():
        yield name, " | ".join(sorted(text for text in texts if re.search("[a-z]", text)))


KINDS = (of_geometry, of_problems, of_files, on_the_way, of_causes, on_figures)


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_every_word(kind: Callable[[pytest.MonkeyPatch], Told], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert dict(kind(monkeypatch)) == HEARD[kind.__name__]
