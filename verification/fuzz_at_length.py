"""Fuzz at length, or one case again: what the cells of the family `fuzz` do in hundreds.

    python verification/fuzz_at_length.py scenes --count 10000 --first 1000 -j 2
    python verification/fuzz_at_length.py scenes --only 1234

Exit code 1 where one went wrong; each of those is printed with its number. How many ended how is told every minute, and at the end,
which Ctrl-C may bring before its time (exit code 130).
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context

from fuzz import calls, files, scenes
from fuzz.child import FINE, Ending

KINDS = {"calls": calls.endings, "files": files.endings, "scenes": scenes.endings}
#: Cases that one process takes at a time.
SHARE = 20
#: Seconds between two words of how it goes.
SILENCE = 60.0


def some(kind: str, count: int, first: int) -> list[tuple[int, Ending]]:
    """How some cases end."""
    return list(KINDS[kind](first, count))


def main() -> None:
    """Command line; exit code 1 where a case went wrong."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", choices=KINDS)
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0, help="number of the first case; each case is known by its number")
    parser.add_argument("--only", type=int, help="this case alone")
    parser.add_argument("-j", "--jobs", type=int, default=1)
    options = parser.parse_args()
    first, count = (options.first, options.count) if options.only is None else (options.only, 1)

    for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        os.environ.setdefault(variable, "1")  # the cores go to cases
    began = told = time.monotonic()
    kinds, starts, code = Counter[str](), range(first, first + count, SHARE), 0

    def tally() -> str:
        shares = ", ".join(f"{kinds[kind]} {kind}" for kind in (*FINE, "wrong"))
        return f"{kinds.total()} {options.kind} from {first}: {shares}; {time.monotonic() - began:.0f} s"

    pool = ProcessPoolExecutor(options.jobs, get_context("spawn"))
    try:
        for found in pool.map(partial(some, options.kind, SHARE if count > 1 else 1), starts):
            for number, ending in found:
                kinds[ending.kind] += 1
                if ending.kind not in FINE or options.only is not None:
                    print(f"{options.kind} {number}: {ending.kind}: {ending.said}", flush=True)
            if time.monotonic() - told > SILENCE:
                told = time.monotonic()
                print(tally(), file=sys.stderr, flush=True)
    except KeyboardInterrupt:
        code = 130
    pool.shutdown(wait=code == 0, cancel_futures=True)
    print(tally())
    sys.exit(code or int(kinds["wrong"] > 0))


if __name__ == "__main__":
    main()
