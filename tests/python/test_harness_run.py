"""A small folder of cases, run as the command, the pytest plugin and Dask run them; killed, resumed, blessed, reported."""

import importlib.metadata
import json
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import Future
from contextlib import ExitStack
from pathlib import Path
from xml.etree import ElementTree

import h5py
import numpy as np
import pytest
from typer.testing import CliRunner

from isomortar.cli.commands import app
from isomortar.errors import InputError
from isomortar.harness import history, store
from isomortar.harness.collection import collect, find
from isomortar.harness.measurement import Measurement, measure
from isomortar.harness.references import Reference, finder, write_reference
from isomortar.harness.runner import dask_cluster, local_processes, run, select, start
from isomortar.harness.store import Store, cell_key

GOOD = """
import numpy as np
from isomortar.harness import Bound, Convergence, Matches, Order, Shown, case
from helper import SCALE

SMALL = Bound(at_most=1e-12, reason="round-off: some")

@case(claim="Sines are bounded.", bounds={"error": SMALL, "seen": Shown("to see")}, grid={"order": [1, 2, 3]})
def sine(order: int):
    return {"error": 1e-16 * order * SCALE, "seen": np.sin(np.arange(order) / 3)}

@case(claim="Errors fall.", bounds=lambda order: {"L2": Order(order + 1, "theory: interpolation")}, grid={"order": [1, 2]})
def rate(order: int):
    h = 0.5 ** np.arange(1, 6)
    return {"L2": Convergence(h, h ** (order + 1), {"quadrature": 1e-14})}
"""
BAD = """
import os, time
from isomortar.errors import ConvergenceError
from isomortar.harness import Bound, case, skip

B = {"error": Bound(at_most=1.0, reason="theory: so")}

@case(claim="Crashes.", bounds=B)
def crash():
    os.abort()

@case(claim="Leaves as if all were well.", bounds=B)
def leaving():
    raise SystemExit(0)

@case(claim="Raises.", bounds=B)
def raising():
    raise ValueError("no such thing")

@case(claim="Has no memory.", bounds=B)
def full():
    raise MemoryError

@case(claim="Does not converge.", bounds=B)
def unsolved():
    raise ConvergenceError("load step 1 does not converge")

@case(claim="Skips.", bounds=B)
def skipping():
    skip("no library")

@case(claim="Lies.", bounds=B)
def nan():
    return {"error": float("nan")}

@case(claim="Is late.", bounds=B)
def late():
    time.sleep(60)

@case(claim="Prints and is fine.", bounds=B)
def printing():
    print("hello")
    return {"error": 0.5}
"""
MATCH = '''
from isomortar.harness import Bound, Matches, case

@case(claim="As before.", bounds={"value": Matches("kept", "reference: as it was"), "error": Bound(at_most=1.0, reason="theory: so")},
      grid={"kind": ["N1", "N2"]})
def same(kind):
    return {"value": [1.0, 2.0], "error": 0.0}
'''  # fmt: skip


@pytest.fixture
def root(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / f"cases_{tmp_path.name}"
    family = folder / f"family_{tmp_path.name}"  # a name of its own: modules stay imported
    family.mkdir(parents=True)
    (folder / "helper.py").write_text("SCALE = 1\n")
    (family / "good.py").write_text(GOOD)
    yield folder
    for name in [n for n in sys.modules if n == "helper" or n.startswith("family_")]:
        del sys.modules[name]
    sys.path[:] = [p for p in sys.path if p != str(folder)]


def measured(root: Path, jobs: int = 2, fresh: bool = False):
    store = Store(root.parent / "store")
    with local_processes(jobs) as submit:
        results = run(start(select(collect(root), "gate"), store, submit, fresh), finder(root.parent / "references"), store)
    return {r.cell.name.partition("/")[2]: r for r in results}


def test_measured_once_until_something_changes(root):
    first = measured(root)
    assert {r.state for r in first.values()} == {"passed"}
    assert all(r.fresh for r in first.values())
    again = measured(root)
    assert not any(r.fresh for r in again.values())
    assert {n: r.measurement.numbers for n, r in again.items()} == {n: r.measurement.numbers for n, r in first.items()}
    assert all(r.fresh for r in measured(root, fresh=True).values())


def test_the_key_holds_what_the_numbers_depend_on(root):
    cells = select(collect(root), "gate")
    keys = {cell_key(cell) for cell in cells}
    assert len(keys) == len(cells)
    (root / "helper.py").write_text("SCALE = 2\n")
    store._case_hash.cache_clear()
    assert keys.isdisjoint({cell_key(cell) for cell in cells})


@pytest.fixture
def unhashed():
    """Hashes are taken anew, in the test and after it."""
    hashes = (store.package_hash, store.program_hash, store.identity, store._case_hash)
    for hashed in hashes:
        hashed.cache_clear()
    yield lambda: [hashed.cache_clear() for hashed in hashes]
    for hashed in hashes:
        hashed.cache_clear()


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


def test_packages_beside_an_installed_program_are_not_read(root, monkeypatch):
    packages = root.parent / "site-packages"
    for name in ("isomortar/ours.py", "isomortar/__init__.py", "beside/__init__.py"):
        (packages / name).parent.mkdir(parents=True, exist_ok=True)
        (packages / name).write_text("SCALE = 1\n")
    monkeypatch.setattr(store, "_PACKAGE", packages / "isomortar")
    path = root / "family" / "case.py"
    path.parent.mkdir()
    path.write_text("import beside\nimport isomortar.ours\n")
    assert store._with_imports(path, root, set()) == {path, packages / "isomortar/ours.py"}


def test_bad_cells_fail_and_the_run_goes_on(root, monkeypatch):
    monkeypatch.setitem(__import__("isomortar.harness.cases").harness.cases.TIMEOUTS, "gate", 8.0)
    next(root.glob("family_*")).joinpath("bad.py").write_text(BAD)
    results = measured(root)
    states = {name: result.state for name, result in results.items() if "[" not in name}
    assert states == {
        "crash": "crashed", "leaving": "crashed",
        "raising": "crashed", "full": "failed", "unsolved": "failed", "skipping": "skipped", "nan": "failed", "late": "timed out",
        "printing": "passed",
    }  # fmt: skip
    assert "SIGABRT" in results["crash"].measurement.message
    assert "no such thing" in results["raising"].measurement.message
    again = measured(root)
    kept = {name for name, result in again.items() if not result.fresh and "[" not in name}
    assert kept == {"nan", "printing", "unsolved"}  # the others may be the machine's fault, or be there the next time


def test_selection(root):
    cases = collect(root)
    family = cases[0].family
    assert len(select(cases, "gate")) == 5
    assert len(select(cases, "weekly", family, f"{family}/sine")) == 3
    assert len(select(cases, "gate", None, f"{family}/sine[order=2]")) == 1
    for tier, other, name in (("gate", "none", None), ("gate", None, "none")):
        with pytest.raises(InputError):
            select(cases, tier, other, name)
    with pytest.raises(InputError):
        find(root, "none")
    with pytest.raises(InputError):
        collect(root / "nowhere")


def test_no_case_is_lost_unseen(root):
    family = next(root.glob("family_*"))
    one = "from isomortar import harness\n\n@harness.case(claim='It holds.', bounds={'e': harness.Bound(1.0, reason='theory: so')})\n"
    (family / "other.py").write_text(one + "def other():\n    return {'e': 2.0}\n")
    assert f"{family.name}/other" in [case.name for case in collect(root)]
    (root / "helper.py").write_text("SCALE = 1\n" + one + "def made_elsewhere():\n    return {'e': 2.0}\n")
    (family / "more.py").write_text("from isomortar.harness import case\nfrom helper import made_elsewhere as made\n")
    sys.modules.pop("helper")
    with pytest.raises(InputError, match="made stand in no family"):
        collect(root)
    (family / "more.py").write_text(one + "def twin():\n    return {'e': 2.0}\n" + one + "def twin():\n    return {'e': 0.0}\n")
    with pytest.raises(InputError, match="defines twin twice"):
        collect(root)


def test_a_folder_without_cases_is_no_green_run(root):
    family = next(root.glob("family_*"))
    (family / "good.py").write_text("from isomortar.harness import case\n")
    with pytest.raises(InputError, match="no cases"):
        collect(root)
    (root / "empty").mkdir()
    with pytest.raises(InputError):
        CliRunner().invoke(app, ["verify", "--family", "empty", "--cases", str(root)], catch_exceptions=False)


def test_command_and_its_report(root):
    options = ["verify", "--cases", str(root), "--results", "out", "-j", "1"]
    assert CliRunner().invoke(app, options).exit_code == 0
    next(root.glob("family_*")).joinpath("match.py").write_text(MATCH)
    assert CliRunner().invoke(app, options).exit_code == 1  # no reference
    report = json.loads(Path("out/report.json").read_text())
    assert report["states"] == {"passed": 5, "missing reference": 2}
    suite = ElementTree.parse("out/report.xml").getroot()[0]
    assert (suite.get("tests"), suite.get("failures"), len(suite.findall("testcase/failure"))) == ("7", "2", 2)
    page = Path("out/report.html").read_text()
    assert "2 of 7 cells do not pass" in page
    assert "missing reference" in page
    assert "<svg" in page
    Path("out/open").touch()
    assert Path("out/report.html").stat().st_mode == Path("out/open").stat().st_mode  # whoever may read the folder may read the page
    for outside in ("http://", "https://", "src=", "<script", "@import", "url("):
        assert outside not in page
    assert len(history.read(Path("out/history.jsonl"))) == 2


def test_blessing(root):
    family = next(root.glob("family_*"))
    family.joinpath("match.py").write_text(MATCH)
    options = ["--cases", str(root), "--results", "out", "--references", "references", "-j", "1"]
    command = ["bless", f"{family.name}/same", "--reason", "first", *options]
    assert CliRunner().invoke(app, command, input="n\n").exit_code == 1
    assert not Path("references").exists()
    assert CliRunner().invoke(app, [*command, "--yes"]).exit_code == 0
    reference = Reference(Path("references/kept"))
    assert reference.record["class"] == "self"
    assert {"who", "when", "reason", "kernel", "compiler"} <= reference.record.keys()
    assert CliRunner().invoke(app, ["verify", *options]).exit_code == 0
    family.joinpath("match.py").write_text(MATCH.replace("[1.0, 2.0]", "[1.0, 2.5]"))
    store._case_hash.cache_clear()
    shown = CliRunner().invoke(app, command, input="n\n")
    page = Path(f"out/bless-{family.name}-same.html")
    assert shown.output.index(str(page)) < shown.output.index("Make these the reference?")
    assert "Largest difference 0.5" in page.read_text()
    assert page.read_text().count("<svg") == 4
    with h5py.File("references/kept/data.h5", "a") as file:
        file["kind=N1/value"][0] = 1.5
    with pytest.raises(InputError, match="hash"):
        Reference(Path("references/kept"))


def test_only_a_green_run_is_blessed(root):
    family = next(root.glob("family_*"))
    family.joinpath("match.py").write_text(MATCH.replace('"error": 0.0', '"error": 2.0'))
    with pytest.raises(InputError, match="green"):
        CliRunner().invoke(
            app, ["bless", f"{family.name}/same", "--reason", "x", "--yes", "--cases", str(root), "-j", "1"], catch_exceptions=False
        )


@pytest.mark.parametrize("value", ["[float('nan'), 1.0]", "[]"])
def test_what_can_be_no_reference_is_not_blessed(root, value):
    family = next(root.glob("family_*"))
    family.joinpath("match.py").write_text(MATCH.replace("[1.0, 2.0]", value))
    command = ["bless", f"{family.name}/same", "--reason", "x", "--yes", "--cases", str(root), "--references", "references", "-j", "1"]
    with pytest.raises(InputError, match="no reference"):
        CliRunner().invoke(app, command, catch_exceptions=False)
    assert not Path("references").exists()


def test_over_refined_is_what_has_measured_its_uncertainty(root):
    family = next(root.glob("family_*"))
    family.joinpath("match.py").write_text(MATCH)
    command = ["bless", f"{family.name}/same", "--reason", "x", "--yes", "--class", "over-refined", "--cases", str(root), "-j", "1"]
    command += ["--references", "references"]
    with pytest.raises(InputError, match="'uncertainty', measured by the case"):
        CliRunner().invoke(app, command, catch_exceptions=False)
    assert not Path("references").exists()
    also = MATCH.replace('{"value": M', '{"uncertainty": Bound(at_most=1.0, reason="theory: so"), "value": M')
    family.joinpath("match.py").write_text(also.replace('"error": 0.0', '"error": 0.0, "uncertainty": 1e-3 if kind == "N1" else 1e-12'))
    store._case_hash.cache_clear()
    for name in [name for name in sys.modules if name.startswith("family_")]:
        del sys.modules[name]
    assert CliRunner().invoke(app, command, catch_exceptions=False).exit_code == 0
    kept = Reference(Path("references/kept"))
    assert kept.record["class"] == "over-refined"
    for cell in find(root, f"{family.name}/same").cells:
        assert kept.get(cell, "value").kind == "self"  # compared with the run that made it, it shows change alone
    assert [float(kept._expected[f"kind={kind}/value"].uncertainty) for kind in ("N1", "N2")] == [2e-3, 2e-9]  # the stated 1e-9 at least


def test_what_is_worth_more_than_a_run_is_not_replaced(root):
    family = next(root.glob("family_*"))
    family.joinpath("match.py").write_text(MATCH)
    record = {"title": "t", "class": "exact", "origin": "o", "made": "m", "uncertainty": "u"}
    write_reference(Path("references/kept"), {"value": (np.array([1.0]), 0.1)}, record)
    command = ["bless", f"{family.name}/same", "--reason", "x", "--yes", "--cases", str(root), "--references", "references", "-j", "1"]
    with pytest.raises(InputError, match="does not replace"):
        CliRunner().invoke(app, command, catch_exceptions=False)


def test_a_run_that_is_killed_leaves_no_green_page(root, monkeypatch):
    options = ["verify", "--cases", str(root), "--results", "out", "-j", "1"]
    assert CliRunner().invoke(app, options).exit_code == 0
    monkeypatch.setattr("isomortar.cli.verification.measure_all", lambda *_: 1 / 0)
    assert CliRunner().invoke(app, options).exit_code == 1
    assert json.loads(Path("out/report.json").read_text())["states"] == {"not measured": 5}
    assert "5 of 5 cells do not pass" in Path("out/report.html").read_text()


@pytest.mark.parametrize(("values", "uncertainty"), [([np.nan], 1.0), ([], 1.0), ([1.0], np.nan), ([1.0], -1.0)])
def test_bad_references_are_refused(tmp_path, values, uncertainty):
    record = {"title": "t", "class": "exact", "origin": "o", "made": "m", "uncertainty": "u"}
    with pytest.raises(InputError):
        write_reference(tmp_path / "r", {"value": (np.array(values), uncertainty)}, record)
    write_reference(tmp_path / "good", {"value": (np.array([1.0]), 0.1)}, record)
    with pytest.raises(InputError, match="class"):
        write_reference(tmp_path / "r", {"value": (np.array([1.0]), 0.1)}, {**record, "class": "believed"})
    with pytest.raises(InputError, match="made"):
        write_reference(tmp_path / "r", {"value": (np.array([1.0]), 0.1)}, {**record, "made": " "})


def test_killed_and_resumed(root):
    slow = GOOD.replace("    return {", "    import time; time.sleep(0.3)\n    return {").replace("[1, 2, 3]", "list(range(1, 13))")
    next(root.glob("family_*")).joinpath("good.py").write_text(slow)
    command = [sys.executable, "-m", "isomortar", "verify", "--cases", str(root), "--results", "out", "-j", "2"]
    for _ in range(2):
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        kept = len(list(Path("out").rglob("*.json")))
        end = time.monotonic() + 60
        while len(list(Path("out").rglob("*.json"))) < kept + 3 and time.monotonic() < end:
            time.sleep(0.02)
        os.kill(process.pid, signal.SIGKILL)
        process.wait()
    resumed = subprocess.run(command, check=False, capture_output=True)
    assert resumed.returncode == 0, resumed.stderr.decode()
    report = json.loads(Path("out/report.json").read_text())
    subprocess.run([*command[:-4], "--results", "whole", "-j", "2"], check=True, capture_output=True)
    whole = json.loads(Path("whole/report.json").read_text())
    for cell in (*report["cells"], *whole["cells"]):
        for time_of in ("seconds", "cpu_seconds", "peak_memory"):
            del cell["measurement"][time_of]
    assert report["cells"] == whole["cells"]


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


def cluster(**options):
    """Two workers of Dask."""
    distributed = pytest.importorskip("distributed")
    return distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, **options)


def measured_on(there, root: Path, finished=lambda _: None):
    store = Store(root.parent / "other")
    with dask_cluster(there.scheduler_address) as submit:
        results = run(start(select(collect(root), "gate"), store, submit), finder(root.parent / "references"), store, finished)
    return {r.cell.name.partition("/")[2]: r for r in results}


def test_dask_gives_the_same_bits(root):
    local = measured(root)
    with cluster() as there:
        results = measured_on(there, root)
    assert {n: r.measurement.numbers for n, r in results.items()} == {n: r.measurement.numbers for n, r in local.items()}


KILLING = """
import os, signal
from isomortar.harness import Bound, case

@case(claim="Is alone.", grid={"kills": [0, 1]}, bounds={"error": Bound(at_most=1.0, reason="theory: so")})
def alone(kills):
    if kills:
        os.kill(os.getppid(), signal.SIGKILL)
    return {"error": 0.0}
"""


def test_a_dask_worker_that_is_killed_is_a_trouble_of_the_machine(root):
    next(root.glob("family_*/good.py")).write_text(KILLING)
    with cluster() as there:
        results = measured_on(there, root)
    assert results["alone[kills=0]"].state == "passed"
    lost = results["alone[kills=1]"]
    assert (lost.state, lost.measurement.ending) == ("failed", "trouble")
    assert "KilledWorker" in lost.measurement.message
    assert Store(root.parent / "other").get(lost.cell) is None


def test_what_a_dask_worker_had_no_time_for_is_measured_by_another(root):
    """A worker leaves like this at the end of its walltime."""
    slow = GOOD.replace("    return {", "    import time; time.sleep(1.0)\n    return {")
    next(root.glob("family_*/good.py")).write_text(slow)
    with cluster() as there, pytest.importorskip("distributed").Client(there) as client:
        workers, left = list(client.scheduler_info()["workers"]), []

        def leave(_):
            if not left:
                left.append(client.retire_workers(workers[:1], close_workers=True))

        results = measured_on(there, root, leave)
    assert left
    assert {result.state for result in results.values()} == {"passed"}


SWEEP = """
import time
from isomortar.harness import Bound, case

@case(claim="Takes its time.", grid={"number": list(range(200))}, bounds={"error": Bound(at_most=1.0, reason="theory: so")})
def sleeping(number):
    time.sleep(0.0 if number < 4 else 60.0)
    return {"error": 0.0}
"""


def measuring(folder: Path) -> list[int]:
    """Processes that measure cells, of runs that were started in a folder."""
    psutil = pytest.importorskip("psutil")
    found = []
    for process in psutil.process_iter(["cmdline", "cwd"]):
        if "isomortar.harness.worker" in (process.info["cmdline"] or ()) and process.info["cwd"] == str(folder):
            found.append(process.pid)
    return found


def hears_ctrl_c():
    """A shell starts background jobs with SIGINT ignored, and children inherit that."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@pytest.mark.parametrize(("where", "code"), [("here", 130), ("on a cluster", 130), ("by pytest", 2)])
def test_ctrl_c_ends_a_sweep_at_once(root, where, code):
    """Cells sleep for a minute: what ends in half of it did not wait for one (it takes two seconds on an idle machine)."""
    folder = Path.cwd()
    next(root.glob("family_*/good.py")).write_text(SWEEP)
    with ExitStack() as stack:
        command = [sys.executable, "-m", "isomortar", "verify", "--cases", str(root), "--results", "results/verification", "-j", "2"]
        if where == "on a cluster":
            command[-2:] = ["--dask", stack.enter_context(cluster()).scheduler_address]
        if where == "by pytest":
            command = [sys.executable, "-m", "pytest", "--rootdir", str(folder), str(root)]
        process = subprocess.Popen(
            command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True, preexec_fn=hears_ctrl_c
        )
        end = time.monotonic() + 120
        while len(list(Path("results/verification/cells").rglob("*.json"))) < 4 and time.monotonic() < end:
            time.sleep(0.05)
        assert measuring(folder)
        begin = time.monotonic()
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=30) == code
        while measuring(folder) and time.monotonic() < begin + 10:
            time.sleep(0.1)
        assert not measuring(folder)


IN_A_CHILD = """
import subprocess
import sys

from isomortar.harness import Bound, case

@case(claim="Works in a process of its own.", bounds={"status": Bound(at_most=0.0, reason="definition: it ends well")})
def elsewhere():
    work = "import time\\nwhile time.process_time() < 0.5: pass"
    return {"status": float(subprocess.run([sys.executable, "-c", work]).returncode)}
"""


def test_what_child_processes_take_is_counted(root):
    """A limit by the seconds of a cell is none for what it leaves to others."""
    next(root.glob("family_*/good.py")).write_text(IN_A_CHILD)
    (cell,) = [cell for case in collect(root) for cell in case.cells]
    assert measure(cell).cpu_seconds >= 0.5


def test_a_line_that_was_cut_short_does_not_take_the_next_one_with_it(root, tmp_path):
    path = tmp_path / "history.jsonl"
    results = list(measured(root).values())
    history.append(path, results)
    whole = path.read_text()
    path.write_text(whole + whole[:70])
    history.append(path, results)
    runs = history.read(path)
    assert [sorted(run.cells) for run in runs] == [sorted(result.cell.name for result in results)] * 2


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


pytest_plugins = ["pytester"]


def test_pytest_collects_cells(pytester):
    family = pytester.mkdir("cases_of_ours").joinpath("family_of_ours")
    family.mkdir()
    family.joinpath("helper.py").write_text("")
    family.joinpath("good.py").write_text(GOOD.replace("from helper import SCALE", "SCALE = 1"))
    family.joinpath("more.py").write_text(
        "from isomortar.harness import Bound, case\n"
        "B = {'error': Bound(at_most=1.0, reason='theory: so')}\n"
        "@case(claim='Too large.', bounds=B)\ndef large():\n    return {'error': 2.0}\n"
        "@case(claim='Slow.', bounds=B, tier='nightly')\ndef slow():\n    return {'error': 0.0}\n"
    )
    result = pytester.runpytest_subprocess("cases_of_ours", "-m", "gate", "--strict-markers")
    result.assert_outcomes(passed=5, failed=1, deselected=1)
    result.stdout.fnmatch_lines(["*error: failed: 2, limit*"])
