"""All figures of a results file."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path

from matplotlib.figure import Figure

from isomortar.errors import InputError, ResultsError
from isomortar.results.abscissa import Abscissa, abscissa
from isomortar.results.alone import draw_alone
from isomortar.results.bodies import draw_bodies
from isomortar.results.curves import WantedCurve, draw_curve, draw_reactions, moving_supports
from isomortar.results.files import make_folder, writing
from isomortar.results.maps import draw_map
from isomortar.results.reader import Results
from isomortar.results.style import style
from isomortar.solve.record import StepResult

#: What can be drawn, and the types of files that curves and maps are written as.
DRAWABLE, FORMATS = ("curves", "bodies", "pressure"), ("png", "pdf", "svg")


def plot(
    results_path: str | os.PathLike[str],
    outdir: str | os.PathLike[str],
    curves: Sequence[WantedCurve] = (),
    *,
    step: int | None = None,
    only: Sequence[str] = (),
    formats: Sequence[str] = (),
    x: str = "time",
) -> list[Path]:
    """Draw curves over all load steps, and bodies and contact pressure of one of them; without contact the bodies by their stress.

    Parameters
    ----------
    results_path : path-like
    outdir : path-like
        Folder of the figures; made if it does not exist.
    curves : sequence of WantedCurve
        Single curves to draw besides force and moment of every support that moves.
    step : int, optional
        Load step whose bodies and pressures are drawn; default: the last one.
    only : sequence of {"curves", "bodies", "pressure"}
        What is drawn; default: all of it.
    formats : sequence of {"png", "pdf", "svg"}
        Of curves and maps; default: png and pdf. Bodies, of which vectors would be many, are always PNG.
    x : str
        What curves are drawn over: ``time``, ``displacement of SUPPORT`` (its size), ``displacement z of SUPPORT`` or
        ``rotation of SUPPORT``.

    Returns
    -------
    list of Path

    Raises
    ------
    InputError
        Something else is to be drawn, or over something else, or another type of file.
    ResultsError
        The results file is missing, damaged, or holds no such load step; or a figure cannot be written.
    """
    _among("only", only, DRAWABLE)
    _among("format", formats, FORMATS)
    folder = Path(outdir)
    with Results(results_path) as results, style():
        shown = results.last_step() if step is None else results.step(step)
        if shown is None:
            raise ResultsError(f"{results.path} holds no load step yet: nothing to draw")
        over = abscissa(results, x)
        figures = dict(_figures(results, shown, curves, only or DRAWABLE, over))
        if not figures:
            raise ResultsError(f"{results.path} has no contact, or no support, of which {' or '.join(only)} could be drawn")
        make_folder(folder)
        paths = []
        for stem, draw in figures.items():
            paths += _save(draw(), folder / stem, ("png",) if stem.startswith("bodies") else formats or ("png", "pdf"))
    return paths


def _among(field: str, names: Sequence[str], allowed: tuple[str, ...]) -> None:
    """Refuse names that are not allowed."""
    for name in names:
        if name not in allowed:
            raise InputError(f"is {name!r}; allowed: {', '.join(allowed)}", field)


def _figures(
    results: Results, step: StepResult, curves: Sequence[WantedCurve], kinds: Sequence[str], over: Abscissa
) -> Iterator[tuple[str, Callable[[], Figure]]]:
    """Names of the figures, and what draws each."""
    if "curves" in kinds:
        yield from ((f"reactions-{s.name}", partial(draw_reactions, results, s.name, over)) for s in moving_supports(results))
        yield from ((f"curve-{curve.name}", partial(draw_curve, results, curve, over)) for curve in curves)
    if "bodies" in kinds and not results.problem.contacts:
        yield "bodies", partial(draw_alone, results.problem, step)
    for number, contact in enumerate(results.problem.contacts):
        if "bodies" in kinds:
            yield f"bodies-{contact.name}", partial(draw_bodies, results.problem, step, number)
        if "pressure" in kinds:
            yield f"pressure-{contact.name}", partial(draw_map, results.problem, step, number)


def _save(figure: Figure, stem: Path, formats: Sequence[str]) -> list[Path]:
    paths = [stem.with_name(f"{stem.name}.{kind}") for kind in formats]
    for path in paths:
        with writing(path):
            figure.savefig(path, bbox_inches="tight", pad_inches=0.08)
    return paths
