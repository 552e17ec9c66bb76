"""Something tried in a process of its own, and in what way it ended."""

from __future__ import annotations

import json
import signal
import tempfile
import traceback
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from forked import forked

#: Endings that are none of the program's mistakes.
FINE = ("right", "refused", "stopped")
#: What a child may take: seconds of the processor, seconds of the clock (a busy machine), bytes of memory.
CPU_SECONDS, WALL_SECONDS, MEMORY = 40, 300.0, 6 << 30


@dataclass(frozen=True)
class Ending:
    """How a try ended: `right`, `refused` before work, `stopped` with a sentence, or `wrong`; and what was said or seen."""

    kind: str
    said: str


class Wrong(Exception):  # noqa: N818 (what was seen, not a mistake of this program)
    """Something was seen that must never be."""


def tried(action: Callable[[Path], Ending]) -> Ending:
    """The ending of an action in a child process; the action is given a folder of its own."""
    with tempfile.TemporaryDirectory(prefix="fuzz-") as folder:
        gone = forked(lambda: _told(action, Path(folder)), CPU_SECONDS, WALL_SECONDS, MEMORY)
    if gone.status is None:
        return Ending("wrong", f"no end after {WALL_SECONDS:g} s")
    if gone.status < 0:
        return Ending("wrong", f"ended by {signal.Signals(-gone.status).name}{' (a hang)' if gone.status == -signal.SIGXCPU else ''}")
    return Ending(*json.loads(gone.said)) if gone.said else Ending("wrong", f"the process ended with status {gone.status}")


def _told(action: Callable[[Path], Ending], folder: Path) -> bytes:
    """In the child: the ending, whatever is raised."""
    try:
        ending = action(folder)
    except Wrong as error:
        ending = Ending("wrong", str(error))
    except BaseException:
        ending = Ending("wrong", f"a traceback: {traceback.format_exc()[-1500:]}")
    return json.dumps([ending.kind, ending.said[:3000]]).encode()


def ending_of(code: int, said: str) -> Ending:
    """What an exit code and its words amount to; a sentence of the program begins with its name. Code 3, a fault of its own, is wrong."""
    if code == 0:
        return Ending("right", "")
    sentences = [line for line in said.splitlines() if line.startswith("isomortar: ")]
    if code not in (1, 2) or len(sentences) != 1 or len(said) > 5000:
        raise Wrong(f"exit code {code} and the words {said[-1500:]!r}")
    return Ending("refused" if code == 2 else "stopped", sentences[0])


def tally(endings: Iterable[tuple[int, Ending]], again: str) -> dict[str, float]:
    """Shares of each kind of ending.

    Raises
    ------
    AssertionError
        One was wrong, with the number that repeats it by the command `again`.
    """
    kinds: Counter[str] = Counter()
    wrong: list[str] = []
    for number, ending in endings:
        kinds[ending.kind] += 1
        if ending.kind not in FINE:
            wrong.append(f"{again} --only {number}: {ending.said}")
    if wrong:
        raise AssertionError(f"{len(wrong)} of {sum(kinds.values())} went wrong\n" + "\n".join(wrong[:20]))
    return {kind: kinds[kind] / kinds.total() for kind in FINE}
