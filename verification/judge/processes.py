"""How processes end, and what is made of it: by shells that end in every way."""

from __future__ import annotations

import json
import os
import sys
import time
from contextlib import suppress
from pathlib import Path

from judge.ways import BOUNDS, WAYS, told

from isomortar.errors import IsomortarError
from isomortar.harness import case
from isomortar.harness.measurement import used
from isomortar.harness.worker import Worker
from isomortar.program.process import Limits, Process, output_of, run

#: Seconds for what ends at once, on a machine that does much else.
PATIENCE = 60.0
#: What a shell does, the word for its end, and its exit status.
ENDS = {
    "exit 0": ("measured", 0),
    "exit 3": ("crashed", 3),
    "kill -ABRT $$": ("crashed", -6),
    "kill -SEGV $$": ("crashed", -11),
    "kill -KILL $$": ("trouble", -9),
    "kill -XCPU $$": ("timed out", None),
    "sleep 60": ("timed out", None),
}
ANSWER = json.dumps({"ending": "measured", "numbers": {"error": 0.5}})
#: What a measuring process does with its task, and how the measurement ends.
WORKERS = {
    f"read task; echo '{ANSWER}'; read more": "measured",
    "read task; exit 0": "crashed",
    "read task; exit 1": "crashed",
    "exit 1": "crashed",
    "read task; kill -ABRT $$": "crashed",
    "read task; kill -KILL $$": "trouble",
    "read task; sleep 60": "timed out",
}


def shell(text: str) -> tuple[str, str, str]:
    """The command that does it."""
    return "sh", "-c", f"ulimit -c 0; {text}"


def gone(pid: int) -> bool:
    """Whether a process is there no more, but for its entry, or is not within a second."""
    for _ in range(20):
        if ended(pid):
            return True
        time.sleep(0.05)
    return False


def ended(pid: int) -> bool:
    """Whether a process is there no more, but for its entry."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except OSError:
        return True


@case(
    claim="A process that ends is told by its exit status or its signal; what it started is gone with it, in whatever session; what it "
    "says is read whole; and its seconds are counted.",
    tier="gate",
    grid={"way": WAYS},
    bounds=BOUNDS,
)
def ends(way: str) -> dict[str, float]:
    """How many ends are told otherwise."""
    wrong = []
    for text, expected in ENDS.items():
        with Process(shell(text)) as process:
            end = process.wait(0.1 if text == "sleep 60" else PATIENCE)
            wrong += [f"{text}: {end}"] * ((end.ending, end.status) != expected)
    with Process(shell("sh -c 'sh -c \"setsid sleep 60 & echo \\$!; wait\"; true'; true")) as process:
        below = int(process.line(PATIENCE) or b"0")
        wrong += ["gone too early"] * ended(below)
        process.kill()
        wrong += ["goes on"] * (not gone(below))
    done = run(shell("read word; echo $word; echo more; echo why >&2; exit 2"), "said")
    wrong += [f"{done}"] * ((done.output, done.errors, done.last_words, done.end.status) != ("said\nmore\n", "why\n", "why", 2))
    late = run(shell("echo begun; sleep 60"), seconds=0.1)
    wrong += [f"{late}"] * ((late.end.ending, late.output) != ("timed out", ""))
    wrong += ["output"] * (output_of(shell("echo all; echo else >&2")) != "all\n")
    for text in ("exit 1", "kill -ABRT $$", "sleep 60"):
        with suppress(IsomortarError):
            output_of(shell(text), seconds=0.1 if text == "sleep 60" else PATIENCE)
            wrong.append(f"{text} has an output")
    with suppress(IsomortarError):
        output_of(["no-such-program"])
        wrong.append("no such program has an output")
    before = used()
    spent = run([sys.executable, "-S", "-c", "import time\nwhile time.process_time() < 0.1: pass"]).cpu_seconds
    wrong += [f"{spent} s, {used() - before} s"] * (not (0.1 <= spent < 1.0 and used() - before >= spent))
    with Process([sys.executable, "-S", "-c", "bytes(1 << 30)"], Limits(memory=1 << 29)) as process:
        wrong += ["memory without end"] * (process.wait(PATIENCE).status != 1)
    if way == WAYS[0]:  # it takes a second
        with Process([sys.executable, "-S", "-c", "while True: pass"], Limits(cpu_seconds=1)) as process:
            wrong += ["no limit"] * (process.wait(60.0).words != "no end within its seconds of the processor")
    return told(wrong, way)


@case(
    claim="A measuring process that gives no answer ends one cell, by the word for it, and the next cell has a process of its own.",
    tier="gate",
    grid={"way": WAYS},
    bounds=BOUNDS,
)
def workers(way: str) -> dict[str, float]:
    """How many measurements end otherwise."""
    wrong = []
    for text, ending in WORKERS.items():
        with Worker(shell(text)) as worker:
            task = {"seconds": 0.1 if "sleep" in text else PATIENCE}
            found = [worker.measure(task) for _ in range(1 if ending == "measured" else 2)]
            wrong += [f"{text}: {m.ending}" for m in found if m.ending != ending]
            wrong += ["numbers"] * (ending == "measured" and found[0].numbers != {"error": 0.5})
    with Worker(shell("read task; sleep 60")) as worker, suppress(IsomortarError):
        worker.measure({"seconds": PATIENCE}, lambda: False)
        wrong.append("measured though nobody wants it")
    wrong += ["this process is not the one"] * (os.getpid() != int(output_of(shell("echo $PPID"))))
    return told(wrong, way)
