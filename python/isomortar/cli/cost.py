"""What a run cost: CPU seconds by phase and what was done, of all load steps of a results file, as a table."""

from __future__ import annotations

import numpy as np
from rich.console import Group
from rich.table import Table

from isomortar.results.reader import Results
from isomortar.solve.timing import COUNTERS, SIZES


def costs(results: Results) -> Group:
    """Two tables: phases with their shares; what was done, where there was any of it."""
    phases = Table("phase", "CPU seconds", "share", box=None, pad_edge=False)
    for column in phases.columns[1:]:
        column.justify = "right"
    seconds = {name: float(np.nansum(values)) for name, values in results.timings().items()}
    total = seconds.pop("total", 0.0)
    for name, spent in sorted(seconds.items(), key=lambda entry: -entry[1]):
        phases.add_row(name, f"{spent:.3f}", f"{spent / total:.1%}" if total else "")
    phases.add_row("total", f"{total:.3f}", "")
    done = Table("done", "number", "", box=None, pad_edge=False)
    done.columns[1].justify = "right"
    found = totals(results)
    for name, words in COUNTERS.items():
        if found.get(name, 0):
            done.add_row(name, f"{found[name]:,}".replace(",", " "), words)
    return Group(phases, "", done)


def totals(results: Results) -> dict[str, int]:
    """What was done in all load steps, by name: sums, the largest of sizes, bytes of the states that are kept."""
    kept = np.isin(results.steps, results.kept_states)
    found = {}
    for name, values in results.counters().items():
        told = np.maximum(values[kept] if name == "history bytes" else values, 0)
        found[name] = int(told.max(initial=0) if name in SIZES else told.sum())
    return found
