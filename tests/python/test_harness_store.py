"""Measurements are kept by all that their numbers depend on, with the history of runs, and taken again when any of it changes."""

import ast
import importlib.metadata
import json
import os
import re
import subprocess
import sys
from concurrent.futures import Future
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from harness_cases import GOOD, measured
from isomortar.harness import history, store
from isomortar.harness.cases import Cell
from isomortar.harness.collection import collect
from isomortar.harness.measurement import Measurement
from isomortar.harness.references import finder
from isomortar.harness.runner import run, select, start
from isomortar.harness.store import Store, cell_key


def test_measured_once_until_something_changes(root):
    first = measured(root)
    assert {r.state for r in first.values()} == {"passed"}
    assert all(r.fresh for r in first.values())
    again = measured(root)
    assert not any(r.fresh for r in again.values())
    assert {n: r.measurement.numbers for n, r in again.items()} == {n: r.measurement.numbers for n, r in first.items()}
    assert all(r.fresh for r in measured(root, fresh=True).values())


def test_all_of_the_package_that_a_run_loads_counts():
    """Numbers and sentences depend on it, whatever a case imports itself."""
    loads = "import sys, isomortar.driver, isomortar.march.outlook, isomortar.results"
    tell = "print(*(f for m in list(sys.modules.values()) if (f := getattr(m, '__file__', None))), sep='\\n')"
    told = subprocess.run([sys.executable, "-c", f"{loads}; {tell}"], capture_output=True, text=True, check=True).stdout
    package = [Path(line) for line in told.splitlines() if Path(line).is_relative_to(store._PACKAGE)]
    assert {"told", "solve", "march", "scene", "results"} <= {path.relative_to(store._PACKAGE).parts[0] for path in package}
    assert not [path for path in package for aside in store._ASIDE if path.is_relative_to(aside)]


def test_where_a_file_ends_counts():
    assert store._hash([b"a", b"bc"]) != store._hash([b"ab", b"c"])


def test_the_key_holds_what_the_numbers_depend_on(root):
    cells = select(collect(root), "gate")
    keys = {cell_key(cell) for cell in cells}
    assert len(keys) == len(cells)
    (root / "helper.py").write_text("SCALE = 2\n")
    store._case_hash.cache_clear()
    assert keys.isdisjoint({cell_key(cell) for cell in cells})


@pytest.mark.parametrize("name", ["numpy", "scipy", "splinepy", "h5py"])
def test_an_upgraded_library_is_measured_anew(root, monkeypatch, unhashed, name):
    cells = select(collect(root), "gate")
    keys = {cell_key(cell) for cell in cells}
    real = importlib.metadata.version
    monkeypatch.setattr("importlib.metadata.version", lambda of: real(of) + ".post1" * (of == name))
    unhashed()
    assert keys.isdisjoint({cell_key(cell) for cell in cells})


def test_what_is_stored_names_what_it_was_measured_with(root):
    measured(root)
    for path in (root.parent / "store").rglob("*.json"):
        libraries = json.loads(path.read_text())["libraries"]
        assert libraries["numpy"] == np.__version__
        assert libraries["libumfpack"].startswith("libumfpack.so.")


def test_what_the_kernel_is_linked_with_counts(root, monkeypatch, unhashed):
    names = " ".join(path.name for path in store.linked())
    assert all(f"lib{name}." in names for name in ("umfpack", "openblas", "metis", "gfortran"))
    library = root / "libumfpack.so"
    library.write_text("5.7.9")
    monkeypatch.setattr(store, "linked", lambda: [library])
    unhashed()
    cells = select(collect(root), "gate")
    keys = {cell_key(cell) for cell in cells}
    library.write_text("6.0.0")
    unhashed()
    assert keys.isdisjoint({cell_key(cell) for cell in cells})


@pytest.mark.parametrize(
    "damage",
    [lambda text: text[:40], lambda _: "", lambda _: "[]", lambda _: "null", lambda text: text.replace("1", "0"),
     lambda text: text.replace("measured", "skipped"), lambda text: text.replace("[order=", "[order=0")],
)  # fmt: skip
def test_a_damaged_file_is_measured_again(root, damage):
    measured(root)
    for path in (root.parent / "store").rglob("*.json"):
        path.write_text(damage(path.read_text()))
    assert all(r.fresh for r in measured(root).values())


def test_pages_are_utf_8_in_any_locale(tmp_path):
    """They say what ASCII cannot, which may be all that the system's text is."""
    words = f"pathlib.Path({str(tmp_path / 'page')!r}), chr(0x2264)"
    code = f"import pathlib; from isomortar.results.files import write_whole; write_whole({words})"
    ascii_alone = {"LC_ALL": "C", "PYTHONCOERCECLOCALE": "0", "PYTHONUTF8": "0"}
    subprocess.run([sys.executable, "-c", code], env=os.environ | ascii_alone, check=True)
    assert (tmp_path / "page").read_bytes() == "\u2264".encode()


def test_a_file_of_another_cell_is_not_taken(root):
    measured(root)
    one, other = sorted((root.parent / "store").rglob("sine*.json"))[:2]
    one.write_text(other.read_text())
    assert sum(r.fresh for r in measured(root).values()) == 1


@pytest.mark.parametrize(
    "how", ["from .near import SCALE", "from . import near", "from package import SCALE", "from package.part import SCALE"]
)
def test_all_ways_to_import_count(root, how):
    family = next(root.glob("family_*"))
    (root / "package").mkdir()
    for path in (family / "near.py", root / "package" / "__init__.py", root / "package" / "part.py"):
        path.write_text("SCALE = 1\n")
    (family / "good.py").write_text(f"{how}\n{GOOD}")
    cell = select(collect(root), "gate")[0]
    key = cell_key(cell)
    for path in (family / "near.py", root / "package" / "__init__.py", root / "package" / "part.py"):
        path.write_text("SCALE = 2\n")
    store._case_hash.cache_clear()
    assert cell_key(cell) != key
    for name in [n for n in sys.modules if n == "package" or n.startswith("package.")]:
        del sys.modules[name]


@pytest.mark.usefixtures("unhashed")
@pytest.mark.parametrize(
    "text",
    [
        "def f():\n    import helper\n",
        "class A:\n    def f(self):\n        if True:\n            import helper\n",
        "try:\n    pass\nexcept OSError:\n    import helper\nelse:\n    pass\nfinally:\n    pass\n",
        "with open('x') as f:\n    for _ in f:\n        from helper import SCALE\n",
        "match 1:\n    case 1:\n        import helper as h\n",
        "async def f():\n    while True:\n        import helper\n",
    ],
)
def test_imports_are_found_wherever_they_stand(tmp_path, text):
    (tmp_path / "helper.py").write_text("SCALE = 1\n")
    file = tmp_path / "family" / "cases.py"
    file.parent.mkdir()
    file.write_text(text)
    assert store._imports_of(file, tmp_path) == {tmp_path / "helper.py"}


def test_a_file_is_read_for_its_imports_once_for_all_runs_and_cases(root, monkeypatch):
    """A study has a cell a scene file, and many cases import the same: reading anew for each took most of a minute."""
    read, parse = [], ast.parse
    monkeypatch.setattr(store.ast, "parse", lambda text, *how: read.append(text) or parse(text, *how))
    (root / "shared.py").write_text("import isomortar.geometry.patch\n")
    (family,) = root.glob("*/")
    for name in "ab":
        (family / f"{name}.py").write_text(re.sub(r"def (\w+)", rf"def \1_{name}", GOOD) + "\nimport shared\n")
    scenes = [root / f"{name}.toml" for name in "abc"]
    for scene in scenes:
        scene.write_text(scene.stem)
    made = [case for case in collect(root) if case.path.stem in "ab"]
    runs = [Cell(replace(case, files=(scene,)), {}) for case in made for scene in scenes]
    read.clear()
    assert len({cell_key(run) for run in runs}) == len(runs)
    assert len({case.path for case in made}) == 2
    assert "import isomortar.geometry.patch\n" in read
    assert len(read) == len(set(read))


def test_packages_beside_an_installed_program_are_not_read(root, monkeypatch):
    packages = root.parent / "site-packages"
    for name in ("isomortar/ours.py", "isomortar/__init__.py", "beside/__init__.py"):
        (packages / name).parent.mkdir(parents=True, exist_ok=True)
        (packages / name).write_text("SCALE = 1\n")
    monkeypatch.setattr(store, "_PACKAGE", packages / "isomortar")
    path = root / "family" / "case.py"
    path.parent.mkdir()
    path.write_text("import beside\nimport isomortar.ours\n")
    assert store._sources(path) == sorted([path, packages / "isomortar/ours.py"])


@pytest.mark.parametrize("sources", ["another", ""])
def test_numbers_from_other_sources_are_not_taken(root, sources):
    store, futures = Store(root.parent / "store"), []

    def submit(_):
        futures.append(Future())
        futures[-1].set_result(Measurement("measured", {"error": 0.0, "seen": [0.0]}, host="node7", sources=sources))
        return futures[-1]

    cells = select(collect(root), "gate")[-1:]
    (result,) = run(start(cells, store, submit), finder(root.parent / "references"), store)
    assert result.state == "failed"
    assert "node7 has other sources" in result.measurement.message
    assert store.get(cells[0]) is None


def test_a_line_that_was_cut_short_does_not_take_the_next_one_with_it(root, tmp_path):
    path = tmp_path / "history.jsonl"
    results = list(measured(root).values())
    history.append(path, results)
    whole = path.read_text()
    path.write_text(whole + whole[:70])
    history.append(path, results)
    runs = history.read(path)
    assert [sorted(run.cells) for run in runs] == [sorted(result.cell.name for result in results)] * 2


def test_the_last_runs_are_looked_back_on(tmp_path):
    path = tmp_path / "history.jsonl"
    cells = [{"values": {"error": float(number)}} for number in range(5)]
    lines = [json.dumps({"when": "", "program": "", "cells": {"one": cell} if number else {}}) for number, cell in enumerate(cells)]
    path.write_text("\n".join(lines) + "\n")
    assert history.values_of(history.read(path, 3), "one", "error") == [2.0, 3.0, 4.0]
    assert np.isnan(history.values_of(history.read(path), "one", "error")[0])
    assert np.isnan(history.values_of(history.read(path), "one", "other")).all()


def test_history_marks_changes_and_not_noise():
    rng = np.random.default_rng(1)
    noise = 1 + 0.01 * rng.standard_normal(30)
    assert history.change_points(list(noise)) == []
    stepped = noise * np.where(np.arange(30) < 12, 1.0, 1.5)
    assert history.change_points(list(stepped)) == [12]
    assert history.change_points([1.0] * 9 + [2.0]) == [9]
    assert history.change_points([1.0, 1.0, 9.0, 1.0, 1.0]) == []  # an outlier
    assert history.change_points([np.nan, 1.0, np.nan, 1.0]) == []
    assert history.change_points([1e-16, 5e-16], least=1e-14) == []
