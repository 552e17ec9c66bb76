"""Kill a parallel sweep of verification cells with SIGKILL at random moments, resume it each time, and compare the end.

    python verification/kill_sweep.py [--family basis] [--kills 20] [--seed 1] [--dask]

Every kill takes the whole process group: the run and its measuring processes. The report of the resumed run must be that of an
undisturbed run but for times. With --dask the cells are measured a third time, on two workers of a local Dask cluster: the same
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
    command = [sys.executable, "-m", "isomortar", "verify", "--family", family, "--results", str(results), *(options or ("-j", "2"))]
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)


def measured(results: Path) -> int:
    """Number of cells that are kept; each must be readable: a file is there whole or not at all."""
    kept = list(results.glob("cells/*/*.json"))
    for path in kept:
        json.loads(path.read_text())
    return len(kept)


def interrupted(family: str, results: Path, seconds: float) -> bool:
    """Run for some seconds and kill the process group; false where the run had ended."""
    process = start(family, results)
    try:
        process.wait(seconds)
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


def on_dask(family: str, results: Path) -> Any:
    """The report of a sweep on a local Dask cluster of two processes."""
    from distributed import LocalCluster

    with ExitStack() as stack:
        cluster = stack.enter_context(LocalCluster(**CLUSTER))  # type: ignore[no-untyped-call]
        return finish(family, results, "--dask", cluster.scheduler_address)[0]


def main() -> None:
    """Command line; exit code 1 where a report differs."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--family", default="basis")
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--dask", action="store_true", help="measure on a local Dask cluster too")
    options = parser.parse_args()
    chance, family = random.Random(options.seed), options.family

    with TemporaryDirectory() as folder:
        whole, seconds = finish(family, Path(folder) / "whole")
        print(f"undisturbed: {len(whole['cells'])} cells in {seconds:.1f} s, {whole['states']}", flush=True)
        if set(whole["states"]) != {"passed"}:
            sys.exit("only numbers can be compared: the family must pass")
        killed, number, rounds = Path(folder) / "killed-0", 0, 0
        found: list[list[str]] = []
        while number < options.kills:
            moment = chance.uniform(0.0, seconds)
            if interrupted(family, killed, moment):
                number += 1
                print(f"kill {number:2d} after {moment:5.2f} s: {measured(killed)} of {len(whole['cells'])} cells are kept", flush=True)
            else:
                found.append(list(differences(whole, report(killed))))
                rounds += 1
                killed = Path(folder) / f"killed-{rounds}"
                print("the run has come to its end before the next kill; another one begins", flush=True)
        found.append(list(differences(whole, finish(family, killed)[0])))
        print(f"resumed to their end: {len(found)} runs, {sum(map(bool, found))} reports differ in more than times", flush=True)
        if options.dask:
            found.append(list(differences(whole, on_dask(family, Path(folder) / "dask"))))
            print(f"Dask, two processes: the report {'differs' if found[-1] else 'is the same'}")
    for lines in filter(None, found):
        print("\n".join(lines[:10]))
    sys.exit(1 if any(found) else 0)


if __name__ == "__main__":
    main()
