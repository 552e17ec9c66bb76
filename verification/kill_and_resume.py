"""Kill a run with SIGKILL at random moments, resume it each time, and compare the end with an uninterrupted run.

    python verification/kill_and_resume.py [SCENE] [--kills 10] [--pairs 0] [--seed 1] [--set KEY=VALUE ...]

Half of the kills come at random times, half at a moment when the results file is being replaced. After each kill the results file
must be readable and hold complete load steps only, none fewer than before; at the end every curve and state of every step must equal the
uninterrupted run's to round-off, cuts and increments included. So many times as `--pairs` says, a second run is started on the file of one
that is under way: it must be refused.
"""

from __future__ import annotations

import argparse
import random
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from isomortar import Results
from isomortar.results import layout

#: A coarse ironing scene: sticking, slipping, a changing contact set, and load steps that are cut; a second a step or less.
COARSE = (
    "bodies.slave.mesh.elements=[2,2,1]",
    "bodies.master.mesh.elements=[4,2,1]",
    "stages.press.steps=2",
    "stages.drag.steps=6",
    "solver.max_iterations=9",
)
#: Kills that a run is to meet at the most: with more it would never come through its longest load step.
RUN_KILLS = 3
#: Largest relative difference that counts as round-off: what a Newton iteration stopped at its tolerance leaves.
ROUND_OFF = 1e-10


def command(scene: str, settings: Sequence[str], output: Path) -> list[str]:
    """The words that start or resume a run."""
    options = [word for setting in settings for word in ("--set", setting)]
    return [sys.executable, "-m", "isomortar", "run", scene, *options, "--output", str(output), "--resume"]


def start(scene: str, settings: Sequence[str], output: Path) -> subprocess.Popen[bytes]:
    """Start or resume a run in a process of its own; on return it computes."""
    process = subprocess.Popen(command(scene, settings, output), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    assert process.stderr is not None
    process.stderr.readline()
    return process


def refused(second: Sequence[str], first: subprocess.Popen[bytes]) -> bool:
    """Start a second run on the file of a first one, which pauses meanwhile: it must end with a sentence. False: the first had ended."""
    first.send_signal(signal.SIGSTOP)
    done = subprocess.run(second, capture_output=True, text=True)
    first.send_signal(signal.SIGCONT)
    if done.returncode == 1 and "another run" in done.stderr:
        return True
    if done.returncode or first.wait():
        sys.exit(f"a second run on one file ended with status {done.returncode}: {done.stderr}")
    return False


def wait_until(process: subprocess.Popen[bytes], moment: Callable[[], bool]) -> bool:
    """Wait for the moment; false where the process ended before."""
    while process.poll() is None:
        if moment():
            return True
        time.sleep(0.001)
    return False


def kill(process: subprocess.Popen[bytes], output: Path, seconds: float, while_writing: bool) -> bool:
    """Kill the computing process after some seconds, or at the first writing after that; false where it ended before."""
    began, copy = time.monotonic(), output.with_name(f".{output.name}.new")
    if not wait_until(process, lambda: time.monotonic() - began > seconds and (copy.exists() or not while_writing)):
        return False
    process.send_signal(signal.SIGKILL)
    return process.wait() == -signal.SIGKILL


def recorded_steps(output: Path) -> int:
    """Number of load steps in the file, each read whole; no file: none."""
    if not output.exists():
        return 0
    with Results(output) as results:
        for number in results.steps:
            results.step(int(number))
        return len(results.steps)


def largest_difference(one: Path, other: Path) -> tuple[float, str]:
    """Largest relative difference of all physical quantities over all steps, and where it is."""
    worst = (0.0, "nowhere")
    with Results(one) as a, Results(other) as b:
        if not np.array_equal(a.steps, b.steps):
            sys.exit(f"the runs have different load steps: {a.steps} and {b.steps}")
        quantities = {f"{s.name} {q}": [r.curve(q, support=s.name) for r in (a, b)] for s in a.problem.supports for q in layout.REACTION}
        quantities |= {f"{c.name} {q}": [r.curve(q, contact=c.name) for r in (a, b)] for c in a.problem.contacts for q in layout.CONTACT}
        for contact in a.problem.contacts:
            histories = a.contact(contact.name), b.contact(contact.name)
            for name in ("pressure", "traction", "gap", "status"):
                quantities[f"{contact.name} {name}"] = [getattr(history, name) for history in histories]
        quantities |= {name: [r.curve(name) for r in (a, b)] for name in ("time", "substeps", "cuts", "next_increment")}
        quantities["positions"] = [np.array([r.step(int(n)).state.positions for n in r.steps]) for r in (a, b)]
    for name, (ours, theirs) in quantities.items():
        size = float(np.abs(theirs).max()) or 1.0
        difference = float(np.abs(np.subtract(ours, theirs, dtype=np.float64)).max()) / size
        worst = max(worst, (difference if np.isfinite(difference) else np.inf, name))
    return worst


def finished(process: subprocess.Popen[bytes], killed: Path, whole: Path) -> tuple[float, str]:
    """The largest difference once the resumed run has come to its end."""
    if process.wait():
        sys.exit("the resumed run failed")
    return largest_difference(killed, whole)


def main() -> None:
    """Command line; exit code 1 where the resumed run differs."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", nargs="?", default="iron")
    parser.add_argument("--kills", type=int, default=10)
    parser.add_argument("--pairs", type=int, default=0, help="second runs to try on a file that is being written")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--set", action="append", metavar="KEY=VALUE", help="settings of the scene; default: a coarse ironing scene")
    options = parser.parse_args()
    settings = options.set or (COARSE if options.scene == "iron" else ())
    chance = random.Random(options.seed)

    with TemporaryDirectory() as folder:
        whole, killed = Path(folder) / "whole.h5", Path(folder) / "killed.h5"
        uninterrupted = start(options.scene, settings, whole)
        began = time.monotonic()
        if uninterrupted.wait():
            sys.exit("the uninterrupted run failed")
        duration = time.monotonic() - began
        with Results(whole) as results:
            cuts = int(results.curve("cuts").sum())
        print(f"uninterrupted: {recorded_steps(whole)} load steps with {cuts} cuts in {duration:.1f} s", flush=True)
        number = kept = pairs = 0
        differences = []
        while number < options.kills:
            writing = number % 2 == 1
            seconds = chance.uniform(0.0, 1.8) * duration / min(options.kills, RUN_KILLS)
            process = start(options.scene, settings, killed)
            if pairs < options.pairs:
                pairs += refused(command(options.scene, settings, killed), process)
            if kill(process, killed, seconds, writing):
                number += 1
                before, kept = kept, recorded_steps(killed)
                if kept < before:
                    sys.exit(f"{before} load steps were complete before the kill, {kept} are after it")
                moment = "while writing" if writing else "at random"
                print(f"kill {number:2d} after {seconds:4.1f} s, {moment:<13}: {kept} load steps are complete", flush=True)
            else:
                differences.append(finished(process, killed, whole))
                killed.unlink()
                kept = 0
                print("the run has come to its end before the next kill; another one begins")
        differences.append(finished(start(options.scene, settings, killed), killed, whole))
        difference, place = max(differences)
    print(f"{number} kills, {len(differences)} runs come to their end, {pairs} second runs refused")
    print(f"largest relative difference over all steps: {difference:.1e} ({place}); allowed {ROUND_OFF:.0e}")
    sys.exit(0 if difference <= ROUND_OFF else 1)


if __name__ == "__main__":
    main()
