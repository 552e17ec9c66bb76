"""Runs that are killed, interrupted or run out of time, here and on a cluster: nothing is lost, and nothing goes on behind."""

import json
import os
import signal
import subprocess
import sys
import time
from contextlib import ExitStack, nullcontext
from pathlib import Path
from types import SimpleNamespace

import pytest
from typer.testing import CliRunner

from harness_cases import GOOD, measured
from isomortar.cli.commands import app
from isomortar.harness.collection import collect
from isomortar.harness.references import finder
from isomortar.harness.runner import dask_cluster, run, select, start
from isomortar.harness.store import Store
from isomortar.harness.worker import Worker, task_of


def test_a_run_that_is_killed_leaves_no_green_page(root, monkeypatch):
    options = ["verify", "--cases", str(root), "--results", "out", "-j", "1"]
    assert CliRunner().invoke(app, options).exit_code == 0
    monkeypatch.setattr("isomortar.cli.verification.measure_all", lambda *_: 1 / 0)
    assert CliRunner().invoke(app, options).exit_code == 1
    assert json.loads(Path("out/report.json").read_text())["states"] == {"not measured": 5}
    assert "5 of 5 cells do not pass" in Path("out/report.html").read_text()


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


def test_a_case_that_puts_something_in_the_place_of_its_input_ends_no_process(root):
    """As tests do that run inside of one; what is asked next is answered all the same, and a case reads no task."""
    reads = "    import os, sys\n    assert sys.stdin.read() == ''\n"
    change = reads + "    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)\n    return {"
    next(root.glob("family_*")).joinpath("good.py").write_text(GOOD.replace("    return {", change))
    first, second, *_ = (cell for case in collect(root) for cell in case.cells)
    with Worker() as worker:
        assert [worker.measure(task_of(cell)).ending for cell in (first, second, first)] == ["measured"] * 3


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


class Cluster:
    """Stands in for a client of Dask's: notes what is sent to it, and what of that is cancelled."""

    def __init__(self, *_, **__):
        self.sent, self.cancelled = [], []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def submit(self, *_, **__):
        self.sent.append(SimpleNamespace(add_done_callback=lambda _: None))
        return self.sent[-1]

    def cancel(self, futures, force=False):
        self.cancelled.append((list(futures), force))


@pytest.mark.parametrize("ending", [None, KeyboardInterrupt, SystemExit, ValueError])
def test_all_that_was_sent_to_a_cluster_is_cancelled_whatever_ends_a_run(ending, monkeypatch):
    client = Cluster()
    monkeypatch.setitem(sys.modules, "distributed", SimpleNamespace(Client=lambda *_, **__: client))
    with pytest.raises(ending) if ending else nullcontext(), dask_cluster("tcp://nowhere:1") as submit:
        for number in range(3):
            submit({"number": number})
        if ending:
            raise ending
    assert client.cancelled == ([(client.sent, True)] if ending else [])


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
