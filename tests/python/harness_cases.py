"""A small folder of cases for tests of the harness, and what measures it."""

from pathlib import Path

from isomortar.harness.collection import collect
from isomortar.harness.references import finder
from isomortar.harness.runner import local_processes, run, select, start
from isomortar.harness.store import Store

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
MATCH = '''
from isomortar.harness import Bound, Matches, case

@case(claim="As before.", bounds={"value": Matches("kept", "reference: as it was"), "error": Bound(at_most=1.0, reason="theory: so")},
      grid={"kind": ["N1", "N2"]})
def same(kind):
    return {"value": [1.0, 2.0], "error": 0.0}
'''  # fmt: skip


def measured(root: Path, jobs: int = 2, fresh: bool = False):
    store = Store(root.parent / "store")
    with local_processes(jobs) as submit:
        results = run(start(select(collect(root), "gate"), store, submit, fresh), finder(root.parent / "references"), store)
    return {r.cell.name.partition("/")[2]: r for r in results}
