"""``isomortar report``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from isomortar.cli.options import RunsOption, SceneArgument
from isomortar.cli.verification import CASES, CORES, RESULTS, CasesOption, JobsOption, TierOption, conduct, tier_of

report = typer.Typer(no_args_is_help=True, rich_markup_mode="markdown", help="Reports that take many runs of a scene.")


@report.callback()
def report_command() -> None:
    """Reports that take many runs of a scene."""


@report.command()
def orders(
    scene: SceneArgument,
    quick: Annotated[bool, typer.Option("--quick", help="Half the elements, and N1, N2, N3, L1, L2 only.")] = False,
    kinds: Annotated[
        str, typer.Option("--orders", metavar="N1,N2,..", help="Kinds of discretisation.", show_default="N1 to N5 and L1 to L4")
    ] = "",
    body: Annotated[str | None, typer.Option(help="The body to vary.", show_default="slave of the first contact")] = None,
    jobs: RunsOption = 1,
    out: Annotated[
        Path | None, typer.Option(file_okay=False, help="Folder of the report and its runs.", show_default="results/orders-NAME")
    ] = None,
    cases: CasesOption = CASES,
) -> None:
    """What orders and meshes make of a scene: error of curves and fields, smoothness, against unknowns and cost.

    Runs the scene with NURBS and Lagrange elements of several orders on several meshes, and a finer one as the reference, whose own
    error is estimated too. What was run already is not run again. Exit code 1 if a run failed; the others are in the report all the same.
    Run it in a checkout, from its folder: the study stands in verification/orders.

    For example:

    - `isomortar report orders press --quick`
    - `isomortar report orders twist --orders N2,N3,N4 -j 2`
    - `isomortar report orders my_scene.toml --body lower`
    """
    from isomortar.harness.study import study_module
    from isomortar.scene import Scene

    loaded, names = Scene.load(scene), [kind.strip() for kind in kinds.split(",") if kind.strip()]
    study = study_module(cases, "orders").study(loaded, names, body, quick)
    conduct(study, out or Path("results") / f"orders-{loaded.name}", jobs)


@report.command()
def extremes(
    tier: TierOption = "gate",
    jobs: JobsOption = CORES,
    out: Annotated[Path, typer.Option(file_okay=False, help="Folder of the page; what verify measured there counts.")] = RESULTS,
    cases: CasesOption = CASES,
) -> None:
    """Where the program can be trusted: scenes over decades of their numbers, each right, warned of, refused, stopped or wrong.

    Every sweep states in which interval the program is right, judged now and as an earlier program was; the page is extremes.html.
    The points are the cells of `isomortar verify --family extremes`. Exit code 1 if one did not end as stated. Run it in a checkout, from
    its folder: the study stands in verification/extremes.

    For example:

    - `isomortar report extremes`
    - `isomortar report extremes --tier nightly -j 2`
    """
    from isomortar.harness.study import study_module

    conduct(study_module(cases, "extremes").study(cases / "extremes", tier_of(tier)), out, jobs)


@report.command()
def programs(
    jobs: RunsOption = 1,
    out: Annotated[Path, typer.Option(file_okay=False, help="Folder of the report and its runs.")] = Path("results/programs"),
    cases: CasesOption = CASES,
) -> None:
    """The same contact problems by isomortar, GetFEM and CalculiX: curves side by side, endings, cost, and what is stated of them.

    A program that is not installed is not measured, and the exit code is 1; the others are in the report all the same. What was run
    already is not run again. Run it in a checkout, from its folder: the study stands in verification/programs.

    For example: `isomortar report programs`
    """
    from isomortar.harness.study import study_module

    conduct(study_module(cases, "programs").study(), out, jobs)


@report.command()
def enforcement(
    scenes: Annotated[str, typer.Option(metavar="hertz,twist,..", help="Scenes of the study.", show_default="all")] = "",
    jobs: RunsOption = 1,
    out: Annotated[Path, typer.Option(file_okay=False, help="Folder of the report and its runs.")] = Path("results/enforcement"),
    cases: CasesOption = CASES,
) -> None:
    """Every way of enforcing contact, the four that the paper names and all others, beside each other: error, roughness and cost.

    What was run already is not run again; all of it takes about half an hour. A run that stops is shown with the load step and the reason:
    some ways do. Exit code 1 if a statement could not be measured. Run it in a checkout, from its folder: the study stands in
    verification/enforcement.

    For example: `isomortar report enforcement --scenes twist`
    """
    from isomortar.harness.study import study_module

    conduct(study_module(cases, "enforcement").study([name.strip() for name in scenes.split(",") if name.strip()]), out, jobs)


@report.command()
def masters(
    quick: Annotated[bool, typer.Option("--quick", help="Coarse meshes, few load steps: it tries the machinery.")] = False,
    jobs: Annotated[int, typer.Option("-j", "--jobs", min=1, help="Runs at the same time.")] = 1,
    out: Annotated[
        Path | None,
        typer.Option(file_okay=False, help="Folder of the report and its runs.", show_default="results/masters or results/masters-quick"),
    ] = None,
    cases: CasesOption = CASES,
) -> None:
    """Masters with kinks: closest points and averaged normals on Lagrange elements, beside splines, and GetFEM on the block.

    What was run already is not run again, and a run that was killed goes on from its last load step. A run that stops is shown with the
    load step and the reason: closest points do on such masters. Exit code 1 if a statement could not be measured. Run it in a checkout,
    from its folder: the study stands in verification/masters.

    For example: `isomortar report masters --quick`
    """
    from isomortar.harness.study import study_module

    folder = out or Path("results") / ("masters-quick" if quick else "masters")
    conduct(study_module(cases, "masters").study(quick), folder, jobs)


@report.command()
def published(
    jobs: JobsOption = CORES,
    out: Annotated[Path, typer.Option(file_okay=False, help="Folder of the page; what verify measured there counts.")] = RESULTS,
    cases: CasesOption = CASES,
) -> None:
    """Benchmarks that others have published: values with their uncertainty beside theirs, and curves.

    The runs are the cells of `isomortar verify --tier nightly --family published`; the page is published.html. Exit code 1 if one did not
    come to its end or to what is claimed of it. Run it in a checkout, from its folder: the study stands in verification/published.

    For example: `isomortar report published -j 2`
    """
    from isomortar.harness.study import study_module

    conduct(study_module(cases, "published").study(cases / "published"), out, jobs)
