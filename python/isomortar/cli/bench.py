"""``isomortar bench``."""

from __future__ import annotations

from dataclasses import replace
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from isomortar.cli import completion
from isomortar.cli.endings import FAILED
from isomortar.cli.tables import print_whole
from isomortar.cli.verification import CASES

if TYPE_CHECKING:
    from isomortar.harness.bench import Row
    from isomortar.harness.bench.processes import Answer


def bench(
    names: Annotated[
        list[str] | None,
        typer.Argument(metavar="NAME", help="Benchmarks to run.", show_default="all", autocompletion=completion.benchmarks),
    ] = None,
    quick: Annotated[bool, typer.Option("--quick", help="Only try them, on the smallest input: says nothing about speed.")] = False,
    out: Annotated[Path, typer.Option(file_okay=False, help="Folder of page, numbers and history.")] = Path("results/bench"),
    cases: Annotated[Path, typer.Option("--cases", file_okay=False, help="Folder above that of the benchmarks, performance/.")] = CASES,
) -> None:
    """Measure what isomortar costs: by phase, order and mesh, against the limits of the machine, and beside other programs.

    The benchmarks stand in verification/performance/. Each runs in a process of its own with one thread, one after another, and is
    written to bench.html and bench.json in the folder when it has ended; history.jsonl keeps all runs for the trend. Times are CPU
    seconds. What the machine can do at most is measured before and after: where that changes, trust ratios only.

    Programs that isomortar is compared with are used where they are installed; else their row says how to install them.

    Exit code 1 if a benchmark did not come to its end. A limit that is missed is shown, and fails nothing.

    For example:

    - `isomortar bench`
    - `isomortar bench factorisation solid_assembly`
    - `isomortar bench --quick --out results/tried`
    """
    from rich.console import Console

    from isomortar.harness.bench import collection, machine, page, processes, record

    benchmarks = collection.select(collection.collect(cases), names or [])
    console = Console(stderr=True, highlight=False)
    kept = record.Record(datetime.now().astimezone(), quick, machine.machine(), (machine.limits(),))

    for benchmark in benchmarks:
        console.print(f"{benchmark.name}: {benchmark.question}", style="bold", soft_wrap=True)
        answer = processes.run(benchmark, quick, lambda row: console.print(f"  {_line(row)}", markup=False, soft_wrap=True))
        if answer.failed:
            console.print(answer.cost.message, markup=False, style="red", soft_wrap=True)
        kept = replace(kept, answers=(*kept.answers, answer))
        record.add(out, kept, answer)
        page.keep(out, kept)
    kept = replace(kept, limits=(*kept.limits, machine.limits()))
    page.keep(out, kept)
    for answer in kept.answers:
        _print(answer)
    print(" -> ".join(f"dgemm {limits.dgemm:.1f} GF/s, triad {limits.triad:.1f} GB/s, load {limits.load:.1f}" for limits in kept.limits))
    print(out / page.PAGE)
    if any(answer.failed for answer in kept.answers):
        raise typer.Exit(FAILED)


def _line(row: Row) -> str:
    """A row as it comes."""
    from isomortar.harness.bench.page import text

    return "  ".join(f"{name} {text(value)}" for name, value in row.items())


def _print(answer: Answer) -> None:
    """The table of a benchmark, and how its limits stand."""
    from rich.console import Console
    from rich.table import Table

    from isomortar.harness.bench.declaration import NOTE
    from isomortar.harness.bench.page import headings, text
    from isomortar.harness.bench.standings import standings

    benchmark, console = answer.benchmark, Console(highlight=False)
    table = Table(*headings(benchmark), title=benchmark.question, title_justify="left")
    for row in answer.rows:
        table.add_row(*(text(row.get(name, "")) for name in benchmark.columns))
    print_whole(console, table)
    for row in answer.rows:
        if NOTE in row:
            console.print(_line(row), markup=False, soft_wrap=True)
    for standing in standings(answer):
        style = {"met": "green", "missed": "red", "not compared": "yellow", "not measured": "yellow"}[standing.state]
        said = f"{standing.column} {standing.state}: {text(standing.worst)} ({standing.row}), at most {standing.at_most:g}: {standing.why}"
        console.print(said, markup=False, style=style, soft_wrap=True)
