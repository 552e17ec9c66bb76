"""``isomortar trade`` and ``isomortar advise``."""

from __future__ import annotations

import re
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from isomortar.cli.endings import FAILED
from isomortar.cli.options import Overrides, RunsOption, SceneArgument

if TYPE_CHECKING:
    from collections.abc import Sequence

    from isomortar.scene import Scene
    from isomortar.trade.knobs import Dial
    from isomortar.trade.laboratory import Tried
    from isomortar.trade.search import Search
    from isomortar.trade.want import Want


WantOption = Annotated[
    list[str],
    typer.Option(
        metavar="WHAT",
        help="What is wanted: force.SUPPORT.x, moment.SUPPORT.norm, displacement.SUPPORT.z, area.CONTACT (curves; @STAGE of one stage, "
        ":end, :peak, :roughness), pressure.CONTACT, traction.CONTACT, edge.CONTACT, gap.CONTACT (at the end); may be repeated.",
    ),
]
WithinOption = Annotated[list[str], typer.Option(metavar="ERROR", help="Largest error, 1% or 0.01; may be repeated.")]
BudgetOption = Annotated[float, typer.Option(min=0.1, metavar="MINUTES", help="Minutes of the processor for all runs.")]


def trade(
    scene: SceneArgument,
    want: WantOption,
    within: WithinOption,
    overrides: Overrides = None,
    budget: BudgetOption = 60.0,
    jobs: RunsOption = 1,
    out: Annotated[
        Path | None, typer.Option(file_okay=False, help="Folder of the page and its runs.", show_default="results/trade-NAME")
    ] = None,
) -> None:
    """The cheapest settings of a scene for an accuracy, and what every knob costs and spoils.

    Over-refined runs tell the truth and how well it is known; every knob (orders, elements, quadrature, load steps, tolerances, ways of
    enforcing contact, ...) is turned alone; from that the cheapest combination is forecast, run, and corrected until none is cheaper. What
    is recommended is run afresh. A target that the truth does not resolve is refused, with what would be needed.

    What was run already is not run again: a search that was killed goes on to the same answer. Exit code 1 if a target has no answer.

    For example:

    - `isomortar trade press --want force.top.z --within 1%`
    - `isomortar trade iron-round --want force.top.x@drag --within 5% --within 1% --budget 120 -j 2`
    - `isomortar trade my_scene.toml --want pressure.floor --want area.floor:end --within 2%`
    """
    from isomortar.scene import Scene
    from isomortar.trade.knobs import dials_of
    from isomortar.trade.search import Search

    loaded = Scene.load(scene, overrides or ())
    wants = _wants(loaded, want)
    _conduct(Search, loaded, dials_of(loaded, wants), wants, within, budget, jobs, out or Path("results") / f"trade-{loaded.name}")


def advise(
    scene: SceneArgument,
    want: WantOption,
    within: WithinOption,
    overrides: Overrides = None,
    budget: BudgetOption = 60.0,
    jobs: RunsOption = 1,
    out: Annotated[
        Path | None, typer.Option(file_okay=False, help="Folder of the page and its runs.", show_default="results/advice-NAME")
    ] = None,
) -> None:
    """What a scene could do without: the cheapest variant within a loss of what is wanted, each variant with what it loses.

    Masters that do not deform, no friction, lower orders in depth, fewer elements, quadrature points and load steps, looser tolerances are
    tried one at a time, and the cheapest combination is forecast, run, and corrected until none is cheaper. Losses are against the scene
    as it is, right or not: how right that is tells `isomortar trade`. Exit code 1 if nothing is cheaper.

    For example:

    - `isomortar advise iron-round --want force.top.x@drag --within 1%`
    """
    from isomortar.scene import Scene
    from isomortar.trade.advice import CheaperSearch, cheaper_dials

    loaded = Scene.load(scene, overrides or ())
    wants = _wants(loaded, want)
    _conduct(
        CheaperSearch, loaded, cheaper_dials(loaded, wants), wants, within, budget, jobs, out or Path("results") / f"advice-{loaded.name}"
    )


def _wants(scene: Scene, texts: list[str]) -> list[Want]:
    """What is wanted of the scene."""
    from isomortar.trade.want import wanted

    return [wanted(text, scene.problem()) for text in texts]


def _conduct(
    kind: type[Search],
    scene: Scene,
    dials: Sequence[Dial],
    wants: Sequence[Want],
    within: list[str],
    budget: float,
    jobs: int,
    folder: Path,
) -> None:
    """Search, write the page, say the answers."""
    from isomortar.harness.runner import local_processes
    from isomortar.trade import page
    from isomortar.trade.laboratory import Laboratory

    targets = sorted((_share(text) for text in within), reverse=True)
    started = datetime.now().astimezone()
    with local_processes(jobs) as submit:
        search = kind(Laboratory(scene, dials, folder, submit, _tell), dials, wants, 60.0 * budget)
        search.screen()
        answers = search.answers(targets)
    path = page.write(folder, scene, search, answers, started)
    print("\n".join([*(page.spoken(search, answer) for answer in answers), str(path)]))
    if not all(answer.best for answer in answers):
        raise typer.Exit(FAILED)


def _tell(outcome: Tried) -> None:
    """One line a run, on stderr."""
    from rich.console import Console

    line = f"{outcome.cost:8.2f} s  {outcome.name}" + (f": failed: {outcome.failure}" if outcome.failure else "")
    Console(stderr=True, highlight=False).print(line, markup=False, soft_wrap=True)


def _share(text: str) -> float:
    """A share as people write it.

    Raises
    ------
    InputError
        Not a number between 0 and 1, or 0 % and 100 %.
    """
    from isomortar.errors import InputError

    found = re.fullmatch(r"\s*([\d.]+(?:[eE]-?\d+)?)\s*(%?)\s*", text)
    try:
        value = float(found[1]) * (0.01 if found[2] else 1.0) if found else 0.0
    except ValueError:
        value = 0.0
    if not 0.0 < value < 1.0:
        raise InputError(f"is {text!r}; allowed: more than 0 and less than 1, or per cent, e.g. 0.01 or 1%", "within")
    return value
