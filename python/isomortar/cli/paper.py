"""``isomortar paper``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from isomortar.cli.verification import CASES, CORES, REFERENCES, CasesOption, ReferencesOption, conduct


def paper(
    quick: Annotated[bool, typer.Option("--quick", help="Coarse meshes, few load steps, N2, N3, L1, L2 only: about a minute.")] = False,
    study: Annotated[str, typer.Option(metavar="press,twist,..", help="Studies to run.", show_default="press,twist,iron,tire")] = "",
    jobs: Annotated[int, typer.Option("-j", "--jobs", min=1, help="Runs at the same time.", show_default="one a core")] = CORES,
    out: Annotated[
        Path | None,
        typer.Option(file_okay=False, help="Folder of page, figures and runs.", show_default="results/paper or results/paper-quick"),
    ] = None,
    cases: CasesOption = CASES,
    references: ReferencesOption = REFERENCES,
) -> None:
    """The paper's numerical section: every study, every figure, and every statement with the number that measures it.

    Runs the four scenes in all discretisations of Section 4, monolithic and by the paper's own method, and writes paper.html. A run that
    was killed goes on from its last load step when the command is repeated; what was run already is not run again. A run that
    fails is shown with its reason, the others go on. Run it in a checkout, from its folder: the studies stand in verification/paper.

    Exit code 0 if every run of NURBS came to its end and every statement could be measured, if partly, whether it holds or not. That
    Lagrange elements do not converge is a result; a crash, or a lack of time or memory, is none and ends with exit code 1.

    For example:

    - `isomortar paper --quick`
    - `isomortar paper`
    - `isomortar paper --study press,twist -j 2 --out study`
    """
    from isomortar.harness.study import study_module

    names = [name.strip() for name in study.split(",") if name.strip()]
    chosen = study_module(cases, "paper").study(names, quick, references, jobs)
    conduct(chosen, out or Path("results") / ("paper-quick" if quick else "paper"), jobs)
