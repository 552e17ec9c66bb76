"""What a program of one's own hands over by mistake is refused by name; what it does to what it was given changes no computation."""

import contextlib
import copy
import inspect
import multiprocessing
import pickle

import numpy as np
import pytest

import isomortar
from isomortar.errors import InputError
from isomortar.model.entities import Problem
from isomortar.scene.scene import Scene
from isomortar.solve.record import StepResult

CHANGES = {"bodies.block.mesh.elements": [2, 2, 1], "stages.press.steps": 3}
#: Parameters that take any number, text or choice of which other tests know the allowed ones.
OTHERS = {
    "curves",
    "step",
    "fields",
    "only",
    "formats",
    "x",
    "contact",
    "every",
    "rate",
    "tell",
    "quiet",
    "verbose",
    "resume",
    "overwrite",
    "name",
}


@pytest.fixture(scope="module")
def scene():
    return Scene.load("press", CHANGES)


@pytest.fixture(scope="module")
def results(scene, tmp_path_factory):
    path = tmp_path_factory.mktemp("results") / "press.h5"
    isomortar.run(scene, path, isomortar.Observer()).close()
    return path


def steps(scene, *given):
    return list(isomortar.Simulation(scene.problem(), *given).run())


CALLS = [getattr(isomortar, name) for name in isomortar.__all__ if not (inspect.isclass(getattr(isomortar, name)))]
CALLS += [isomortar.Simulation, isomortar.Results, Scene.load, Scene.from_toml]
PARAMETERS = [(call, name) for call in CALLS for name, parameter in inspect.signature(call).parameters.items() if name not in OTHERS]


def wrong(call, name):
    """Values of no type that it takes; None, where that is no default."""
    default = inspect.signature(call).parameters[name].default
    return [5.5, b"press", object(), *([None] if default is not None else [])]


def entered(call, **given):
    """Call something; a context that comes of it does nothing before it is entered."""
    with contextlib.ExitStack() as stack:
        stack.enter_context(call(**given))


@pytest.mark.parametrize(("call", "name"), PARAMETERS, ids=lambda given: getattr(given, "__qualname__", given))
def test_values_of_another_type_are_refused_by_the_name_of_the_parameter(call, name, scene, results, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    good = {
        "results_path": results,
        "path": results,
        "outdir": tmp_path / "out",
        "output": tmp_path / ("out.gif" if call is isomortar.film else "out.html"),
        "problem": scene.problem(),
    }
    good |= {"scene": scene, "text": scene.to_toml(), "source": "press", "name": "press", "folder": tmp_path}
    needed = {n: good[n] for n, p in inspect.signature(call).parameters.items() if n != name and p.default is inspect.Parameter.empty}
    for value in wrong(call, name):
        with pytest.raises(isomortar.IsomortarError) as raised:
            entered(call, **needed, **{name: value})
        field = "path" if name == "results_path" else name
        assert str(raised.value).startswith((f"{field}: is ", f"override {value!r:.5}")), raised.value
        assert not [*tmp_path.iterdir()]


@pytest.mark.parametrize(
    ("overrides", "said"),
    [
        ([5], "overrides: is 5; allowed: str of the form KEY=VALUE"),
        (None, "overrides: is None; allowed: Iterable of texts KEY=VALUE, or a mapping of values by path"),
        ({5: 3}, "override 5 is no path of keys"),
        ({"solver.max_cuts": (endless := [])}, "solver.max_cuts: has lists or tables within each other without end"),
    ],
)
def test_overrides_that_are_none_are_refused(overrides, said):
    endless.append(endless)
    with pytest.raises(InputError, match=said):
        Scene.load("press", overrides)


def test_a_record_of_another_problem_is_refused(scene):
    (first, *_) = steps(scene)
    others = {
        "control points": ["bodies.block.mesh.elements=[3,2,1]"],
        "quadrature points of contact 'floor'": ["bodies.block.mesh.elements=[2,2,1]", "contacts.floor.quadrature=[9,9]"],
        "contacts": ["bodies.block.mesh.elements=[2,2,1]"],
    }
    for what, overrides in others.items():
        problem = Scene.load("press", overrides).problem()
        if what == "contacts":
            problem = Problem(**{**{key: getattr(problem, key) for key in problem.__dataclass_fields__}, "contacts": ()})
        with pytest.raises(InputError, match=f"resume_from: is of another problem: it has .* {what}, and this one"):
            isomortar.Simulation(problem, resume_from=first)
    assert len(steps(scene, None, first)) == 2


def spoiled(part):
    """Write over all arrays of a record."""
    if isinstance(part, np.ndarray):
        part[...] = 1e9
    for field in getattr(part, "__dataclass_fields__", ()):
        spoiled(getattr(part, field))
    for entry in part if isinstance(part, tuple) else ():
        spoiled(entry)


#: The same scene so far from the origin that its coordinates count from elsewhere.
FAR = {"bodies.block.geometry.bottom": 1000.0, "bodies.block.geometry.top": 1000.8, "contacts.floor.plane.point": [0, 0, 1000]}


@pytest.mark.parametrize("overrides", [{}, {"solver.method": "uzawa"}, {"solver.measures": ["extrapolation"]}, FAR])
def test_who_writes_over_a_record_changes_no_later_load_step(overrides):
    scene = Scene.load("press", CHANGES | overrides)
    expected, found = steps(scene), []
    for step in isomortar.Simulation(scene.problem()).run():
        found.append(copy.deepcopy(step))
        spoiled(step)
    for one, other in zip(expected, found, strict=True):
        np.testing.assert_array_equal(one.state.positions, other.state.positions)
        np.testing.assert_array_equal([r.force for r in one.reactions], [r.force for r in other.reactions])
    begun = copy.deepcopy(expected[0])
    simulation = isomortar.Simulation(scene.problem(), resume_from=begun)
    spoiled(begun)
    assert isinstance(begun, StepResult)
    np.testing.assert_array_equal(list(simulation.run())[-1].state.positions, expected[-1].state.positions)


def test_results_go_to_other_processes(results):
    with isomortar.Results(results) as opened:
        force = opened.curve("force", support="top")
        with pickle.loads(pickle.dumps(opened)) as again:
            np.testing.assert_array_equal(again.curve("force", support="top"), force)
        with multiprocessing.get_context("fork").Pool(1) as pool:
            np.testing.assert_array_equal(pool.apply(opened.curve, ("force",), {"support": "top"}), force)
