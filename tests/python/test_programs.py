"""Other programs: what they are told, what they refuse, and what is read of them. What they compute is for verification/programs."""

from __future__ import annotations

import json
import re
import runpy
import sys
import time
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from typer.testing import CliRunner

from isomortar import _compiled
from isomortar.cli.commands import app
from isomortar.errors import InputError, IsomortarError
from isomortar.harness.worker import COMMAND
from isomortar.model.entities import Problem
from isomortar.model.numbering import Numbering
from isomortar.program import calculix, getfem
from isomortar.program.calculix import LAWS, CalculiX
from isomortar.program.declaration import NotInstalledError, Program, load_step
from isomortar.program.getfem import ENERGIES, GetFEM, has_module
from isomortar.program.lagrange import LagrangeProblem
from isomortar.program.own import Isomortar
from isomortar.program.process import End, Finished, Process, output_of, run
from isomortar.scene import Scene

COARSE = (
    "bodies.slave.mesh.elements=[2,2,1]",
    "bodies.master.mesh.elements=[3,3,2]",
    "stages.press.steps=2",
    "stages.press.motions.top.translate=[0,0,-0.1]",
    "stages.slide.steps=2",
    "stages.slide.motions.top.translate=[0.02,0,0]",
    "materials.rubber.law=neo-hookean-j",
)
SOLID = """
format = 1
name = "solid"

[materials.rubber]
law = "neo-hookean-j"

[bodies.block]
geometry = { kind = "box", lower = [0.0, 0.0, 0.0], upper = [1.0, 0.8, 0.6] }
mesh = { family = "L", order = [1, 1, 1], elements = [2, 1, 1] }

[supports.base]
face = "block.w0"

[supports.top]
face = "block.w1"
components = ["x", "z"]
centre = [0.5, 0.4, 0.6]

[[stages]]
name = "turn"
steps = 2
motions.top = { translate = [0.1, 0.0, -0.05], rotate = 10 }
"""


def block(*overrides: str) -> Problem:
    return Scene.load("block", [*COARSE, *overrides]).problem()


def solid(*overrides: str) -> Problem:
    return Scene.from_toml(SOLID, overrides=overrides).problem()


@pytest.mark.parametrize("program", [GetFEM(), CalculiX()], ids=lambda program: program.name)
@pytest.mark.parametrize(
    ("overrides", "field"),
    [
        (("bodies.slave.mesh.family=N", "bodies.slave.mesh.order=[2,2,2]"), "bodies.slave.mesh.family"),
        (("contacts.interface.cohesion=0.1",), "contacts.interface.cohesion"),
        (("contacts.interface.traction_max=0.1",), "contacts.interface.traction_max"),
        (("contacts.interface.elastic_slip=0.1",), "contacts.interface.elastic_slip"),
        (("contacts.interface.smoothing=1e-4",), "contacts.interface.smoothing"),
    ],
)
def test_what_a_program_cannot_express_is_named(program: Program, overrides: tuple[str, ...], field: str) -> None:
    with pytest.raises(InputError, match=program.name) as refused:
        program.run(block(*overrides))
    assert refused.value.field == field


@pytest.mark.parametrize(
    ("overrides", "field"),
    [
        (("materials.rubber.law=neo-hookean",), "bodies.block.material.law"),
        (("bodies.block.mesh.order=[3,3,3]",), "bodies.block.mesh.order"),
        (("bodies.block.mesh.order=[1,2,2]",), "bodies.block.mesh.order"),
        (("bodies.block.mesh.quadrature=[3,2,2]",), "bodies.block.mesh.quadrature"),
    ],
)
def test_calculix_names_what_it_lacks_in_a_solid(overrides: tuple[str, ...], field: str) -> None:
    with pytest.raises(InputError, match="CalculiX") as refused:
        CalculiX().run(solid(*overrides))
    assert refused.value.field == field
    LagrangeProblem(solid(*overrides), "GetFEM", ENERGIES)  # which GetFEM does not


def test_calculix_has_small_strain_in_all_bodies_or_in_none() -> None:
    problem = block()
    slave, master = problem.bodies
    small = replace(slave, material=replace(slave.material, law="linear-elastic"))
    with pytest.raises(InputError, match="small strain") as refused:
        CalculiX().run(replace(problem, bodies=(small, master)))
    assert refused.value.field == "bodies.master.material.law"


PRESSURE = ('loads.wind={face="block.u1", pressure=0.5}', "stages.turn.loads.wind=0.8")


def test_pressures_are_told_by_load_step() -> None:
    told = LagrangeProblem(solid(*PRESSURE), "GetFEM", ENERGIES)
    np.testing.assert_allclose(told.pressures, [[0.2], [0.4]])
    lines = list(calculix.deck(told, 1e4, 1e3))
    first = lines.index("*SURFACE, NAME=LOAD0") + 1
    assert lines[first : first + 2] == ["2, S4", "*MATERIAL, NAME=MATERIAL0"], "the second element's end along x"
    assert [lines[k + 1] for k, line in enumerate(lines) if line == "*DSLOAD"] == [f"LOAD0, P, {size:.12e}" for size in (0.2, 0.4)]
    found = getfem.description(told)
    assert found["loads"] == [{"body": 0, "face": "u1", "elements": [1]}]
    np.testing.assert_allclose(found["pressures"], told.pressures / told.stiffest)


def test_loads_that_a_program_cannot_express_are_named() -> None:
    pull = solid('loads.pull={face="block.u1", traction=[1,0,0]}')
    with pytest.raises(InputError, match="no loads but pressures") as refused:
        GetFEM().run(pull)
    assert refused.value.field == "loads.pull.traction"
    with pytest.raises(InputError, match="forces of supports") as refused:  # the base holds an edge of that face
        CalculiX().run(solid(*PRESSURE))
    assert refused.value.field == "loads.wind.face"


def test_rigid_planes_are_refused() -> None:
    plane = Scene.load("tire", ["bodies.tire.mesh.family=L"]).problem()
    with pytest.raises(InputError, match="rigid planes"):
        LagrangeProblem(plane, "GetFEM", ENERGIES)


def test_what_is_not_installed_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shutil.which", lambda _: None)
    with pytest.raises(NotInstalledError, match="apt-get install calculix-ccx"):
        CalculiX().run(solid())
    with pytest.raises(NotInstalledError, match="apt-get install python3-getfem"):
        GetFEM("/no/such/python").run(solid())
    assert has_module(sys.executable, "json")
    assert not has_module(sys.executable, "no_such_module")


def test_calculix_deck_has_all_nodes_elements_faces_and_what_is_prescribed() -> None:
    told = LagrangeProblem(block("stages.slide.motions.top.translate=[-0.00001,0,0]"), "CalculiX", LAWS)
    lines = list(calculix.deck(told, 1e4, 1e3))
    first = lines.index("*NODE, NSET=ALL") + 1
    points = np.array([[float(x) for x in line.split(",")] for line in lines[first : first + len(told.nodes)]])
    np.testing.assert_array_equal(points, np.column_stack([np.arange(len(told.nodes)) + 1, told.nodes]))
    assert lines[first + len(told.nodes)] == "*ELEMENT, TYPE=C3D8, ELSET=BODY0"
    corners = np.array([int(n) for n in lines[first + len(told.nodes) + 1].split(",")])[1:] - 1
    a, b, c = (told.nodes[corners[k]] - told.nodes[corners[0]] for k in (1, 3, 4))
    np.testing.assert_allclose(np.linalg.det([a, b, c]), 0.35 * 0.35 * 0.5)
    # The slave touches with the faces below of its four elements, the master with those above of its upper layer.
    assert lines[lines.index("*SURFACE, NAME=SLAVE0") + 1] == "1, S1"
    assert lines[lines.index("*SURFACE, NAME=MASTER0") + 1] == "14, S2"
    fields = [field for line in lines[1:] if not line.startswith("*") for field in line.split(",")][1:]
    assert max(len(field.strip()) for field in fields) <= 20, "CalculiX reads no more of a number"
    assert lines.count("*BOUNDARY") == lines.count("*END STEP") == 4
    bulk, shear = (getattr(told.problem.bodies[0].material, name) for name in ("bulk", "shear"))
    c10, d1 = (float(x) for x in lines[lines.index("*HYPERELASTIC, NEO HOOKE") + 1].split(","))
    np.testing.assert_allclose([2 * c10, 2 / d1], [shear, bulk])


@pytest.mark.parametrize("order", [1, 2])
def test_elements_of_calculix_have_their_nodes_in_its_order(order: int) -> None:
    told = LagrangeProblem(solid(f"bodies.block.mesh.order=[{order},{order},{order}]"), "CalculiX", LAWS)
    for element in calculix._elements(told, told.problem.bodies[0]):
        corners = told.nodes[element[:8]]
        ends = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
        middles = [corners[list(pair)].mean(axis=0) for pair in ends]
        assert len(element) == (8, 20)[order - 1]
        np.testing.assert_allclose(told.nodes[element[8:]], middles[: len(element) - 8] or np.zeros((0, 3)), atol=1e-15)
        # The faces S1 to S6 look along -z, z, -y, x, y, -x.
        for corner, outward in zip(("0123", "4765", "0154", "1265", "2376", "3047"), ["w0", "w1", "v0", "u1", "v1", "u0"], strict=True):
            face = corners[[int(c) for c in corner]].mean(axis=0) - corners.mean(axis=0)
            assert np.argmax(np.abs(face)) == "uvw".index(outward[0])
            assert (face.sum() > 0) == (outward[1] == "1")


def test_supports_turn_and_prescribe_what_they_hold_alone() -> None:
    told = LagrangeProblem(solid(), "GetFEM", ENERGIES)
    assert told.displacements.shape == (2, len(told.prescribed))
    components = {node: set(told.prescribed[told.prescribed // 3 == node] % 3) for node in told.prescribed // 3}
    assert set(map(frozenset, components.values())) == {frozenset({0, 1, 2}), frozenset({0, 2})}
    top = np.isclose(told.nodes[told.prescribed // 3, 2], 0.6)
    assert not np.any(told.displacements[:, ~top])
    corner, turn = np.flatnonzero((told.nodes == [0.0, 0.0, 0.6]).all(axis=1))[0], np.radians(10)
    x = told.displacements[-1, told.prescribed == 3 * corner][0]
    np.testing.assert_allclose(x, 0.1 + 0.5 - 0.5 * np.cos(turn) + 0.4 * np.sin(turn))


def test_load_steps_have_the_reactions_of_their_nodal_forces() -> None:
    problem = solid()
    nodes = Numbering(problem).reference
    forces = np.random.default_rng(1).normal(size=nodes.shape)
    base, top = load_step(problem, 2, nodes, forces).reactions
    below, above = np.isclose(nodes[:, 2], 0.0), np.isclose(nodes[:, 2], 0.6)
    np.testing.assert_allclose(base.force, forces[below].sum(axis=0))
    borne = forces[above] * [1, 0, 1]
    np.testing.assert_allclose(top.centre, [0.6, 0.4, 0.55])
    np.testing.assert_allclose(top.force, borne.sum(axis=0))
    np.testing.assert_allclose(top.moment, np.cross(nodes[above] - top.centre, borne).sum(axis=0), atol=1e-14)
    missing = np.where(above[:, None], nodes, np.nan)
    step = load_step(problem, 2, missing, np.where(above[:, None], forces, 0.0))
    np.testing.assert_array_equal(step.reactions[1].moment, top.moment)
    np.testing.assert_array_equal(step.reactions[0].moment, np.zeros(3))


def test_our_own_solver_keeps_what_converged() -> None:
    problem = solid()
    whole = Isomortar().run(problem)
    assert (whole.ending, len(whole.steps), [step.step for step in whole.steps]) == ("measured", 2, [1, 2])
    np.testing.assert_allclose(whole.steps[-1].reactions[0].force, -whole.steps[-1].reactions[1].force, atol=1e-9)
    assert whole.solves > 2
    stopped = Isomortar().run(solid("solver.max_iterations=1", "solver.max_cuts=0"))
    assert (stopped.ending, stopped.steps) == ("not converged", ())
    assert "load step 1" in stopped.words


DAT = """
 forces (fx,fy,fz) for set HELD and time  0.{0}000000E+01

{1}
 displacements (vx,vy,vz) for set ALL and time  0.{0}000000E+01

{2}"""


def _table(vectors: np.ndarray) -> str:
    return "".join(f"{node:10d} " + " ".join(f"{x:13.6E}" for x in vector) + "\n" for node, vector in enumerate(vectors, 1))


def test_what_calculix_writes_is_read() -> None:
    told = LagrangeProblem(solid(), "CalculiX", LAWS)
    vectors = np.random.default_rng(2).normal(size=(2, *told.nodes.shape)).round(6)
    dat = DAT.format(1, _table(vectors[0]), _table(vectors[1]))
    cvg = " SUMMARY\n STEP INC\n\n 1 1 1 1 0.5\n 1 1 1 2 0.1\n 2 1 1 1 0.3\n"
    stopped = Finished(
        End("crashed", "the process ended with status 201", 201), " *ERROR: increment size\n        smaller than minimum\n\n said", "", 0.5
    )
    found = calculix._outcome(told, stopped, dat, cvg)
    assert (found.ending, found.words, len(found.steps), found.solves) == (
        "not converged",
        "*ERROR: increment size smaller than minimum",
        1,
        3,
    )
    np.testing.assert_allclose(found.steps[0].positions, told.nodes + vectors[1])
    np.testing.assert_allclose(found.steps[0].reactions[0].force, vectors[0][np.isclose(told.nodes[:, 2], 0.0)].sum(axis=0))
    done = calculix._outcome(told, Finished(End("measured", "", 0), "", "", 0.5), dat + dat, cvg)
    assert (done.ending, done.words, len(done.steps)) == ("measured", "", 2)
    lost = calculix._outcome(told, Finished(End("measured", "all is well", 0), "", "", 0.5), dat, cvg)
    assert lost.ending == "crashed", "a program that ends well without its load steps has not measured them"


def test_what_getfem_answers_is_read() -> None:
    told = LagrangeProblem(solid(), "GetFEM", ENERGIES)
    assert getfem.description(told)["bodies"][0]["gauss"] == (2, 2, 2)
    answer = '{"solves": 3, "converged": true, "displacements": %s, "forces": %s, "friction": 0.5, "spurious": -0.25}\n'
    line = answer % (np.ones(told.nodes.size).tolist(), np.arange(len(told.prescribed)).tolist())
    stopped = line + '{"solves": 60, "converged": false}\n'
    found = getfem._outcome(told, Finished(End("measured", "", 0), stopped, "", 1.0))
    assert (found.ending, len(found.steps), found.solves) == ("not converged", 1, 63)
    np.testing.assert_allclose(found.steps[0].positions, told.nodes + 1.0)
    total = sum(reaction.force.sum() for reaction in found.steps[0].reactions)
    np.testing.assert_allclose(total, told.stiffest * len(told.prescribed) * (len(told.prescribed) - 1) / 2)
    np.testing.assert_allclose(found.steps[0].works, told.stiffest * np.array([0.5, -0.25]))
    untold = getfem._outcome(told, Finished(End("measured", "", 0), line.replace(', "friction": 0.5, "spurious": -0.25', ""), "", 1.0))
    np.testing.assert_array_equal(untold.steps[0].works, [np.nan, np.nan])
    killed = getfem._outcome(told, Finished(End("trouble", "killed", -9), line + line[:100], "", 1.0))
    assert (killed.ending, len(killed.steps)) == ("trouble", 1)


@pytest.mark.parametrize("works", [True, False])
def test_getfem_integrates_works_only_where_it_is_asked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], works: bool
) -> None:
    model = SimpleNamespace(nbdof=lambda: 0, solve=lambda *_: (1, 1))
    monkeypatch.setitem(sys.modules, "getfem", SimpleNamespace(Model=lambda _: model, util_trace_level=lambda _: None))
    nothing: dict[str, object] = {key: [] for key in ("bodies", "contacts", "loads", "nodes", "prescribed")}
    told = tmp_path / "problem.json"
    told.write_text(
        json.dumps({**nothing, "displacements": [[], []], "pressures": [[], []], "tolerance": 1e-9, "iterations": 5, "works": works})
    )
    runpy.run_path(str(Path(getfem.__file__).with_name("getfem_job.py")))["main"](str(told))
    steps = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert ["friction" in step and "spurious" in step for step in steps] == [works, works]


def test_a_program_is_run_to_its_end_with_what_it_says() -> None:
    code = "import sys; print('first'); print(sys.stdin.read(), end=''); print('aside', file=sys.stderr); sum(range(3_000_000))"
    found = run([sys.executable, "-c", code], '{"a": 1}')
    assert (found.output, found.errors, found.end.status) == ('first\n{"a": 1}\n', "aside\n", 0)
    assert found.cpu_seconds > 0.01
    assert run([sys.executable, "-c", "raise ValueError('the last words')"]).last_words == "ValueError: the last words"
    endless = run([sys.executable, "-c", "import time; print('said', flush=True); time.sleep(60)"], seconds=0.5)
    assert (endless.end.ending, endless.end.status) == ("timed out", None)


def test_a_kernel_that_lacks_routines_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "mine.py"
    path.write_text("from isomortar._kernel import add_values\n")
    result = CliRunner().invoke(app, ["verify", "--kernel", str(path), "--results", str(tmp_path / "results")])
    assert isinstance(result.exception, InputError)
    assert re.search(r"mine\.py has no add_body, .*: a kernel has all routines", str(result.exception))
    assert "add_values" not in str(result.exception)
    for text, said in (("import no_such_module", "no_such_module"), ("def (", "cannot be imported")):
        path.write_text(text)
        with pytest.raises(InputError, match=said):
            _compiled.kernel_at(path, _compiled.kernel)
    renamed = tmp_path / "mine.so"
    renamed.write_bytes(Path(str(_compiled.kernel.__file__)).read_bytes())
    with pytest.raises(InputError, match=r"mine.so cannot be imported: .*PyInit_mine"):
        _compiled.kernel_at(renamed, _compiled.kernel)
    with pytest.raises(InputError, match=r"is no file of a module"):
        _compiled.kernel_at(tmp_path / "not_there.so", _compiled.kernel)


KERNEL = """
from isomortar import _kernel
from isomortar._kernel import *

def material_stress(*arguments):
    stress, status, place = _kernel.material_stress(*arguments)
    return {factor} * stress, status, place
"""


CASE = """
import numpy as np
from isomortar import _bindings
from isomortar.harness import Bound, case
from isomortar.model.entities import Material

@case(claim="A small cube swells by its bulk modulus.", bounds={"error": Bound(at_most=1e-12, reason="theory: Hooke's law")})
def swelling():
    material = Material(law="linear-elastic")
    stress = _bindings.material_stress(material.arrays, 0.1 * np.eye(3)[None])
    return {"error": abs(stress[0, 0, 0] / (0.3 * material.bulk) - 1.0)}
"""


@pytest.mark.parametrize(("factor", "code"), [("1.0", 0), ("(1.0 + 1e-9)", 1)])
@pytest.mark.usefixtures("unhashed")
def test_another_kernel_is_verified_by_one_option(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, factor: str, code: int) -> None:
    monkeypatch.setenv(_compiled.KERNEL, "")  # taken back at the end, whatever the command writes there
    monkeypatch.delenv(_compiled.KERNEL)
    (tmp_path / "mine.py").write_text(KERNEL.format(factor=factor))
    (tmp_path / "cases/solid").mkdir(parents=True)
    (tmp_path / "cases/solid/cube.py").write_text(CASE)
    folders = ["--cases", str(tmp_path / "cases"), "--results", str(tmp_path / "results"), "--references", str(tmp_path)]
    words = ["verify", "-j", "1", *folders, "--kernel", str(tmp_path / "mine.py")]
    assert CliRunner().invoke(app, words).exit_code == code


def test_a_program_that_must_end_well_says_why_it_did_not() -> None:
    assert output_of([sys.executable, "-c", "print('all')"]) == "all\n"
    with pytest.raises(IsomortarError, match=r"/no/such/program is not there"):
        output_of(["/no/such/program"])
    with pytest.raises(IsomortarError, match=r"(?s)ended with status 1\n.*ValueError: the last words"):
        output_of([sys.executable, "-c", "raise ValueError('the last words')"])
    with pytest.raises(IsomortarError, match=r"no end after 0.2 s"):
        output_of([sys.executable, "-c", "import time; time.sleep(60)"], seconds=0.2)


def gone(child: int) -> bool:
    """Whether a process ends within some seconds."""
    for _ in range(100):
        state = Path(f"/proc/{child}/stat")
        if not state.exists() or state.read_text().rpartition(")")[2].split()[0] == "Z":
            return True
        time.sleep(0.05)
    return False


@pytest.mark.parametrize("session", [False, True])
def test_what_a_process_has_started_ends_with_it(session: bool) -> None:
    """In its session or, as programs that a case runs are, in one of their own."""
    started = f"subprocess.Popen(['sleep', '60'], start_new_session={session})"
    code = f"import subprocess, time; print({started}.pid, flush=True); time.sleep(60)"
    with Process([sys.executable, "-c", code]) as process:
        child = int(process.line(30) or 0)
    assert gone(child)


ENDLESS = """
import sys
from isomortar.harness import Bound, case
from isomortar.program.process import run

@case(claim="So.", bounds={"error": Bound(at_most=1.0, reason="theory: so")})
def endless():
    run([sys.executable, "-c", "import os, time; open('pid', 'w').write(f'{os.getpid()} '); time.sleep(60)"])
"""


def test_a_program_that_is_measured_ends_with_the_run_that_asked(tmp_path: Path) -> None:
    """The run is killed: the measuring process hears no more of it."""
    (tmp_path / "cases/family").mkdir(parents=True)
    path = tmp_path / "cases/family/endless.py"
    path.write_text(ENDLESS)
    with Process(COMMAND, folder=tmp_path) as worker:
        worker.send(json.dumps({"path": str(path), "case": "family/endless", "settings": {}, "seconds": 60}).encode())
        for _ in range(600):
            if (tmp_path / "pid").exists() and (tmp_path / "pid").read_text().endswith(" "):
                break
            time.sleep(0.1)
        worker.given_all()
        assert gone(int((tmp_path / "pid").read_text()))
