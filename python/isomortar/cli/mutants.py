"""``isomortar mutants``."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from isomortar.cli.endings import FAILED
from isomortar.cli.tables import print_whole
from isomortar.cli.verification import CASES, CORES, REFERENCES, CasesOption, ReferencesOption

if TYPE_CHECKING:
    from isomortar.harness.mutants.score import Score

MUTANTS = Path("results/mutants")


def mutants(
    layer: Annotated[
        Literal["kernel", "python"], typer.Option(help="The Fortran kernel, in both precisions, or the Python between a scene and it.")
    ] = "kernel",
    within: Annotated[
        list[str] | None,
        typer.Option(metavar="PATH", help="Only in these files and folders of the sources, as model/enforcement; may be given again."),
    ] = None,
    sample: Annotated[int, typer.Option(min=0, help="Random faults, beside all that are planted by hand.")] = 300,
    seed: Annotated[int, typer.Option(help="Of the random draw.")] = 1,
    patience: Annotated[
        float, typer.Option(min=0.0, help="A random fault survives when cells of so many CPU seconds are green; 0: when all are.")
    ] = 60.0,
    jobs: Annotated[
        int, typer.Option("-j", "--jobs", min=1, help="Faults built and attacked at the same time.", show_default="one a core")
    ] = CORES,
    cases: CasesOption = CASES,
    references: ReferencesOption = REFERENCES,
    results: Annotated[Path, typer.Option("--results", file_okay=False, help="Folder of what is known, and of the report.")] = MUTANTS,
) -> None:
    """Plant faults in the sources, one at a time, and see whether the gate catches them; those in Python may be caught by tests too.

    The faults are those of planted_faults.toml beside the cases, and random ones by the rules of universalmutator for the language
    (`pip install 'isomortar[mutants]'`). Run it in a checkout, from its folder. What is known is not done again: a run that was killed
    goes on where it was, and after a change of the cases the survivors meet those that are new.
    Exit code 0 only if all planted faults are caught, and of the random ones that are not classified as equivalent 95 % in the kernel,
    85 % in Python.

    For example:

    - `isomortar mutants --sample 0` attacks the planted faults alone
    - `isomortar mutants --sample 300 -j 2`
    - `isomortar mutants --layer python --sample 200`
    - `isomortar mutants --within contact/friction --sample 40`
    """
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    from isomortar.harness.collection import collect
    from isomortar.harness.mutants import report
    from isomortar.harness.mutants.campaign import Campaign
    from isomortar.harness.mutants.faults import read_planted
    from isomortar.harness.mutants.generate import draw
    from isomortar.harness.mutants.layers import LAYERS
    from isomortar.harness.mutants.score import Score, read_classified
    from isomortar.harness.mutants.tests.as_cells import cells_of_tests
    from isomortar.harness.references import finder
    from isomortar.harness.runner import select

    clock = time.perf_counter()
    where, folder = LAYERS[layer], results / layer
    sources = where.read(Path())
    attacked = where.within(sources, within or [])
    planted = [fault for fault in read_planted(cases / "planted_faults.toml", sources, where.suffix) if fault.file in attacked]
    classified = read_classified(cases / "surviving_mutants.toml")
    drawn = draw(where, attacked, seed) if sample else []
    cells = select(collect(cases), "gate") + (cells_of_tests(Path("tests/python")) if layer == "python" else [])
    console = Console(stderr=True, highlight=False)
    columns = (BarColumn(), MofNCompleteColumn(), TimeElapsedColumn(), TextColumn("{task.description}", markup=False))
    with Progress(*columns, console=console, transient=True) as progress:
        bar = progress.add_task("")

        def tell(what: str, done: int, total: int) -> None:
            progress.update(bar, description=what, completed=done, total=total or None)

        with Campaign(where, Path(), cases, cells, finder(references), folder, jobs, tell) as campaign:
            tally = campaign.run(planted, drawn, sample, patience or float("inf"))
    score = Score(tally, classified, where.least_share)
    minutes = round((time.perf_counter() - clock) / 60, 1)
    settings = {
        "layer": layer,
        "within": ", ".join(within or ["all"]),
        "sample": sample,
        "seed": seed,
        "patience": patience,
        "jobs": jobs,
        "minutes": minutes,
    }
    report.write(folder / "report.html", score, settings)
    _print(score)
    print(folder / "report.html")
    if not score.passes:
        raise typer.Exit(FAILED)


def _print(score: Score) -> None:
    """The tally on the terminal."""
    from rich.console import Console
    from rich.table import Table

    console = Console(highlight=False)
    table = Table("caught first by", *score.folders, "all")
    for family, counts in score.catches.items():
        table.add_row(family, *(str(counts[folder] or "") for folder in score.folders), str(counts.total()))
    print_whole(console, table)
    for attacked in score.survivors:
        fault = attacked.fault
        lines = [f"survived: {fault.place} {fault.name} ({score.kind(attacked)})", f"- {fault.old.strip()}", f"+ {fault.new.strip()}"]
        console.print("\n".join(lines), markup=False, style="red", soft_wrap=True)
    for cell in score.tally.unused:
        console.print(f"red without a fault, not used: {cell}", markup=False, soft_wrap=True)
    print(f"planted by hand: {score.caught_planted.part} of {score.caught_planted.whole} caught")
    if score.sample:
        for folder, (found, real) in score.caught_by_folder.items():
            print(f"random, in {folder}: {found.part} of {found.whole} caught; of those not equivalent {real.part} of {real.whole}")
        print(f"random: {score.caught} caught; without those classified as equivalent: {score.caught_of_real}")
    print(", ".join(f"{count} {reason}" for reason, count in score.tally.dropped.items()))
