"""Kill a parallel sweep of verification cells with SIGKILL again and again on its way, resume it each time, and compare the end.

    python verification/kill_sweep.py [--family basis] [--kills 20] [--seed 1] [--dask]

Kills come when even shares of the cells are kept, at a random moment of a cell's time after that: of one kill, when half of them are.
Every kill takes the whole process group: the run and its measuring processes. The report of the resumed run must be that of an
undisturbed run but for times. With --dask the same is done on two workers of a local Dask cluster, which outlives its clients: the same
numbers, bit for bit.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

#: What a run's report says of its time and place: all that may differ.
TIMES = ("started", "seconds", "cpu_seconds", "peak_memory", "host", "fresh")


#: Two processes on this machine, without a web page.
CLUSTER: dict[str, Any] = {"n_workers": 2, "threads_per_worker": 1, "processes": True, "dashboard_address": None}


def start(family: str, results: Path, *options: str) -> subprocess.Popen[bytes]:
    """Start or resume a sweep in a process group of its own."""
    command = [sys.executable, "-m", "isomortar", "verify", "--family", family, "--results", str(results), *options]
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)


def kept(results: Path) -> list[Path]:
    """The files of the cells that are measured."""
    return list(results.glob("cells/*/*.json"))


def killed(family: str, results: Path, many: int, later: float, *options: str) -> bool:
    """Run until so many cells are kept and some seconds more, and kill the process group; false where the run had ended."""
    process = start(family, results, *options)
    while process.poll() is None and len(kept(results)) < many:
        time.sleep(0.01)
    try:
        process.wait(later)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        return True
    return False


def report(results: Path) -> Any:
    """The report without times."""
    return _timeless(json.loads((results / "report.json").read_text()))


def _timeless(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _timeless(entry) for name, entry in value.items() if name not in TIMES}
    return [_timeless(entry) for entry in value] if isinstance(value, list) else value


def differences(one: Any, other: Any, place: str = "") -> Iterator[str]:
    """Where two reports differ."""
    if isinstance(one, dict) and isinstance(other, dict) and one.keys() == other.keys():
        for name in one:
            yield from differences(one[name], other[name], f"{place}/{name}")
    elif isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        for k, entries in enumerate(zip(one, other, strict=True)):
            yield from differences(*entries, f"{place}/{k}")
    elif one != other:
        yield f"{place}: {one!r:.60} and {other!r:.60}"


def finish(family: str, results: Path, *options: str) -> tuple[Any, float]:
    """Run to the end: the report without times, and the seconds that it took."""
    began = time.monotonic()
    process = start(family, results, *options)
    if process.wait() not in (0, 1):
        sys.exit(f"the run ended with status {process.returncode}")
    return report(results), time.monotonic() - began


def disturbed(family: str, results: Path, kills: int, cells: int, moments: Iterator[float], *options: str) -> Any:
    """The report of a sweep that is killed on its way and resumed each time."""
    for number in range(1, kills + 1):
        many = round(cells * number / (kills + 1))
        if killed(family, results, many, next(moments), *options):
            found = kept(results)
            for path in found:  # a file is there whole or not at all
                json.loads(path.read_text())
            print(f"kill {number:2d}: {len(found)} of {cells} cells are kept", flush=True)
        else:
            print(f"kill {number:2d} came too late", flush=True)
    return finish(family, results, *options)[0]


def main() -> None:
    """Command line; exit code 1 where a report differs."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--family", default="basis")
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", default="2")
    parser.add_argument("--dask", action="store_true", help="on a local Dask cluster too")
    asked = parser.parse_args()
    chance, local = random.Random(asked.seed), ("-j", asked.jobs)

    with TemporaryDirectory() as folder, ExitStack() as stack:
        whole, seconds = finish(asked.family, Path(folder) / "whole", *local)
        cells = len(whole["cells"])
        print(f"undisturbed: {cells} cells in {seconds:.1f} s, {whole['states']}", flush=True)
        if set(whole["states"]) != {"passed"}:
            sys.exit("only numbers can be compared: the family must pass")
        places = {"processes of this machine": local}
        if asked.dask:
            from distributed import LocalCluster

            cluster = stack.enter_context(LocalCluster(**CLUSTER))  # type: ignore[no-untyped-call]
            places["a Dask cluster"] = ("--dask", cluster.scheduler_address)
        moments = iter(lambda: chance.uniform(0.0, seconds / cells), None)
        same = True
        for place, options in places.items():
            found = list(differences(whole, disturbed(asked.family, Path(folder) / options[0], asked.kills, cells, moments, *options)))
            print(f"{place}: resumed to its end, the report {'differs in more than times' if found else 'is the same but for times'}")
            for difference in found[:10]:
                print(difference)
            same = same and not found
    sys.exit(0 if same else 1)


if __name__ == "__main__":
    main()
