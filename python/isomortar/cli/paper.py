"""``isomortar paper``."""

from __future__ import annotations

import time
from datetime import datetime
from pathlib import Path
from typing import Annotated

import typer

from isomortar.cli.verification import CORES, FAILED, REFERENCES, ReferencesOption, measure_all


def paper(
    quick: Annotated[bool, typer.Option("--quick", help="Coarse meshes, few load steps, N2, N3, L1, L2 only: about a minute.")] = False,
    study: Annotated[str, typer.Option(metavar="press,twist,..", help="Studies to run.", show_default="press,twist,iron,tire")] = "",
    jobs: Annotated[int, typer.Option("-j", "--jobs", min=1, help="Runs at the same time.", show_default="one a core")] = CORES,
    out: Annotated[
        Path | None,
        typer.Option(file_okay=False, help="Folder of page, figures and runs.", show_default="results/paper or results/paper-quick"),
    ] = None,
    references: ReferencesOption = REFERENCES,
) -> None:
    """The paper's numerical section: every study, every figure, and every statement with the number that measures it.

    Runs the four scenes in all discretisations of Section 4, monolithic and by the paper's own method, and writes paper.html. A run that
    was killed goes on from its last load step when the command is repeated; what was run already is not run again. A run that
    fails is shown with its reason, the others go on.

    Exit code 0 if every run of NURBS came to its end and every statement could be measured, if partly, whether it holds or not. That
    Lagrange elements do not converge is a result; a crash, or a lack of time or memory, is none and ends with exit code 1.

    For example:

    - `isomortar paper --quick`
    - `isomortar paper`
    - `isomortar paper --study press,twist -j 2 --out study`
    """
    from isomortar.harness.paper import page
    from isomortar.harness.paper.catalogue import chosen
    from isomortar.harness.paper.findings import STATEMENTS
    from isomortar.harness.paper.outcome import Outcomes, cells_of, outcome
    from isomortar.harness.paper.settled import settled_curves
    from isomortar.harness.runner import local_processes

    studies = chosen([name.strip() for name in study.split(",") if name.strip()], quick)
    folder = out or Path("results") / ("paper-quick" if quick else "paper")
    settled = {} if quick else settled_curves(references)
    started, clock = datetime.now().astimezone(), time.perf_counter()
    planned = cells_of(studies, folder)
    results = measure_all([cell for *_, cell in planned], folder, lambda *_: None, local_processes(jobs), False)
    outcomes = Outcomes(studies, tuple(outcome(*plan, result.measurement) for plan, result in zip(planned, results, strict=True)))
    statements = [statement for statement in STATEMENTS if statement.concerns(studies)]
    judgements = tuple(statement.judge(outcomes) for statement in statements)
    report = page.Report(outcomes, judgements, len(STATEMENTS) - len(statements), quick, started, settled)
    path = page.write(folder, report)
    print(f"{len(results)} runs, {len(report.failed)} failed, {time.perf_counter() - clock:.0f} s")
    print(", ".join(f"{count} {state}" for state, count in report.counts.items()))
    print(path)
    if not report.complete:
        raise typer.Exit(FAILED)
