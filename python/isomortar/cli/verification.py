"""``isomortar verify`` and ``isomortar bless``."""

from __future__ import annotations

import os
import time
from collections import Counter
from collections.abc import Sequence
from contextlib import AbstractContextManager
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from isomortar.cli import completion
from isomortar.cli.endings import FAILED
from isomortar.cli.tables import print_whole

if TYPE_CHECKING:
    from rich.table import Table

    from isomortar.harness import blessing
    from isomortar.harness.cases import Cell, Tier
    from isomortar.harness.compare import Lookup
    from isomortar.harness.runner import Result, Submit
    from isomortar.harness.study import Study

CasesOption = Annotated[Path, typer.Option("--cases", file_okay=False, help="Folder of families of cases.")]
ReferencesOption = Annotated[Path, typer.Option("--references", file_okay=False, help="Folder of references.")]
ResultsOption = Annotated[Path, typer.Option("--results", file_okay=False, help="Folder of measurements, history and report.")]
JobsOption = Annotated[int, typer.Option("-j", "--jobs", min=1, help="Cells measured at the same time.", show_default="one a core")]
TierOption = Annotated[str, typer.Option(help="gate (seconds a cell), nightly (minutes) or weekly; each holds those before it.")]
DaskOption = Annotated[str | None, typer.Option("--dask", metavar="ADDRESS", help="Measure on a Dask cluster: tcp://HOST:PORT.")]

KernelOption = Annotated[
    Path | None, typer.Option("--kernel", dir_okay=False, help="Another kernel with our interface, a .so or .py (docs/programs.md).")
]

CORES = os.cpu_count() or 1
CASES, REFERENCES, RESULTS = Path("verification"), Path("reference_data"), Path("results/verification")


def verify(
    tier: TierOption = "gate",
    family: Annotated[list[str] | None, typer.Option(help="Only this family; may be repeated.", autocompletion=completion.families)] = None,
    case: Annotated[
        list[str] | None, typer.Option(help="Only this case, FAMILY/NAME, or one cell of it, FAMILY/NAME[SETTINGS]; may be repeated.")
    ] = None,
    jobs: JobsOption = CORES,
    fresh: Annotated[bool, typer.Option("--fresh", help="Measure again what did not change since it was measured.")] = False,
    report: Annotated[
        Path | None,
        typer.Option(dir_okay=False, help="The HTML page; .xml (JUnit) and .json go beside it.", show_default="RESULTS/report.html"),
    ] = None,
    dask: DaskOption = None,
    kernel: KernelOption = None,
    cases: CasesOption = CASES,
    references: ReferencesOption = REFERENCES,
    results: ResultsOption = RESULTS,
) -> None:
    """Run verification cases, judge their numbers, and write the report.

    What was measured with the same program, case and settings is not measured again; a run that was killed goes on where it was.
    Exit code 0 only if every cell passes: a number that is missing, not finite, skipped or without its reference does not pass.

    For example:

    - `isomortar verify`
    - `isomortar verify --tier nightly -j 2`
    - `isomortar verify --family solid --fresh`
    - `isomortar verify --case "basis/non_negative[kind=N2]"`
    """
    from isomortar.errors import InputError
    from isomortar.harness import history
    from isomortar.harness import report as reports
    from isomortar.harness.collection import collect
    from isomortar.harness.references import finder
    from isomortar.harness.runner import not_measured, select

    if kernel:
        _take(kernel, dask)
    page = report or results / "report.html"
    if page.suffix != ".html":
        raise InputError(f"is {page}; the page is an .html file, with .xml and .json beside it", "report")
    found, families, names = collect(cases), family or (None,), case or (None,)
    asked = [cell for one in families for name in names for cell in select(found, tier_of(tier), one, name)]
    cells = list({cell.name: cell for cell in asked}.values())
    only = ", ".join(f"{what} {name}" for what, names in (("family", family), ("case", case)) for name in names or [])
    started, clock, lookup = datetime.now().astimezone(), time.perf_counter(), finder(references)
    # A run that is killed must not leave the green page of the one before.
    reports.write(page, not_measured(cells, lookup), reports.Context(tier, only, 0.0, started, []))
    measured = measure_all(cells, results, lookup, _submitter(jobs, dask), fresh)
    history.append(results / "history.jsonl", measured)
    context = reports.Context(tier, only, time.perf_counter() - clock, started, history.read(results / "history.jsonl"))
    reports.write(page, measured, context)
    counts = Counter(result.state for result in measured)
    print(", ".join(f"{count} {state}" for state, count in counts.items()))
    print(page)
    if set(counts) != {"passed"}:
        raise typer.Exit(FAILED)


def bless(
    case: Annotated[str, typer.Argument(metavar="CASE", help="The case, FAMILY/NAME.")],
    reason: Annotated[str, typer.Option(help="Why the new numbers are right; goes into the record.")],
    kind: Annotated[
        str,
        typer.Option(
            "--class", help="What the reference is worth: self (shows change only) or over-refined (the case measures its uncertainty)."
        ),
    ] = "self",
    uncertainty: Annotated[float, typer.Option(help="Of each number, relative to its largest value.")] = 1e-9,
    yes: Annotated[bool, typer.Option("--yes", help="Do not ask.")] = False,
    jobs: JobsOption = CORES,
    cases: CasesOption = CASES,
    references: ReferencesOption = REFERENCES,
    results: ResultsOption = RESULTS,
) -> None:
    """Make the numbers of a case the reference that it is compared with, after showing what that changes, as numbers and pictures.

    For example: `isomortar bless patch_tests/uniform_pressure --reason "More quadrature points by default"`
    """
    from rich.console import Console

    from isomortar.errors import InputError
    from isomortar.harness import blessing
    from isomortar.harness.collection import find
    from isomortar.harness.references import finder

    if kind not in ("self", "over-refined"):
        raise InputError(f"is {kind!r}; a run of this program is self or over-refined", "class")
    chosen, lookup = find(cases, case), finder(references)
    measured = measure_all(chosen.cells, results, lookup, _submitter(jobs, None), False)
    found = blessing.changes(measured, lookup)
    print_whole(Console(), _table(found))
    print(blessing.picture(results, chosen, found))
    if not yes:
        typer.confirm("Make these the reference?", abort=True)
    for path in blessing.bless(chosen, found, references, reason, "self" if kind == "self" else "over-refined", uncertainty):
        print(path)


def tier_of(name: str) -> Tier:
    """The tier of a name.

    Raises
    ------
    InputError
        There is none.
    """
    from isomortar.errors import InputError
    from isomortar.harness.cases import TIERS

    if name not in TIERS:
        raise InputError(f"is {name!r}; allowed: {', '.join(TIERS)}", "tier")
    return next(tier for tier in TIERS if tier == name)


def _take(kernel: Path, dask: str | None) -> None:
    """Let another kernel take the place of the own one, in this process and those that measure."""
    from isomortar import _compiled
    from isomortar.errors import InputError

    if dask:
        raise InputError(f"is of this machine: set {_compiled.KERNEL} in the environment of the cluster's workers", "kernel")
    _compiled.kernel_at(kernel.absolute(), _compiled.kernel)
    os.environ[_compiled.KERNEL] = str(kernel.absolute())


def _submitter(jobs: int, dask: str | None) -> AbstractContextManager[Submit]:
    from isomortar.harness.runner import dask_cluster, local_processes

    return dask_cluster(dask) if dask else local_processes(jobs)


def measure_all(
    cells: Sequence[Cell], folder: Path, lookup: Lookup, submitter: AbstractContextManager[Submit], fresh: bool
) -> list[Result]:
    """Measure with a progress bar on stderr, under which whatever does not pass is told of at once."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    from isomortar.harness.report import sentence
    from isomortar.harness.runner import run, start
    from isomortar.harness.store import Store

    console = Console(stderr=True, highlight=False)
    columns = (BarColumn(), MofNCompleteColumn(), TimeElapsedColumn(), TextColumn("{task.description}", markup=False))
    with Progress(*columns, console=console, transient=True) as progress, submitter as submit:
        bar = progress.add_task("", total=len(cells))

        def finished(result: Result) -> None:
            progress.update(bar, advance=1, description=result.cell.name)
            if result.state != "passed":
                bad = [check for check in result.checks if check.state != "passed"]
                said = [bad[0].found] if result.measurement.message else [sentence(check) for check in bad]
                lines = [result.cell.name, *(f"  {line}" for line in said)]
                console.print("\n".join(lines), markup=False, style="red", soft_wrap=True)

        store = Store(folder / "cells")
        return run(start(cells, store, submit, fresh), lookup, store, finished)


def conduct(study: Study, folder: Path, jobs: int) -> None:
    """Run a study, and tell what it came to; what was run already in the folder is not run again."""
    from isomortar.harness.runner import local_processes

    started, clock = datetime.now().astimezone(), time.perf_counter()
    results = measure_all(study.cells(folder), folder, lambda *_: None, local_processes(jobs), False)
    found = study.page(folder, results, started)
    print(f"{len(results)} runs, {found.failed} failed, {time.perf_counter() - clock:.0f} s")
    print("\n".join(filter(None, (found.summary, str(found.page)))))
    if not found.complete:
        raise typer.Exit(FAILED)


def _table(found: Sequence[blessing.Change | blessing.Rewording]) -> Table:
    """What a blessing changes, as numbers."""
    from rich.table import Table

    from isomortar.harness import blessing

    table = Table()
    for heading in ("cell", "number", "values", "largest, old", "largest, new", "difference", "old uncertainty"):
        table.add_column(heading, overflow="fold")
    for change in found:
        if isinstance(change, blessing.Rewording):
            lines, others = (f"{len(of)} lines" for of in (change.new.splitlines(), change.lines))
            table.add_row(change.cell.name, change.number, lines, "none" if change.old is None else "words", "words", others, "")
            continue
        old = "none" if change.old is None else f"{abs(change.old).max():.6g}"
        new, difference, worth = (f"{v:.6g}" for v in (abs(change.new).max(), change.difference, change.old_uncertainty))
        table.add_row(change.cell.name, change.number, str(change.new.size), old, new, difference, worth)
    return table
