"""All figures of a results file."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path

from matplotlib.figure import Figure

from isomortar._arguments import place
from isomortar.errors import InputError, ResultsError
from isomortar.model.entities import Problem
from isomortar.results.abscissa import Abscissa, abscissa
from isomortar.results.bodies import draw_bodies
from isomortar.results.coloured import BODY_FIELDS, draw_coloured
from isomortar.results.curves import WantedCurve, draw_curve, draw_reactions, moving_supports
from isomortar.results.face_field import CONTACT_FIELDS, face_field
from isomortar.results.files import make_folder, writing
from isomortar.results.maps import draw_map
from isomortar.results.reader import Results
from isomortar.results.style import style
from isomortar.solve.record import StepResult

#: What can be drawn, and the types of files that curves and maps are written as.
DRAWABLE, FORMATS = ("curves", "bodies", "maps"), ("png", "pdf", "svg")
#: Name of a figure's file, and what draws it.
Named = tuple[str, Callable[[], Figure]]
#: Fields that maps show, of slave faces, and then those that bodies show.
FIELDS = (*CONTACT_FIELDS, *BODY_FIELDS)


def plot(
    results_path: str | os.PathLike[str],
    outdir: str | os.PathLike[str],
    curves: Sequence[WantedCurve] = (),
    *,
    step: int | None = None,
    fields: Sequence[str] = (),
    only: Sequence[str] = (),
    formats: Sequence[str] = (),
    x: str = "time",
) -> list[Path]:
    """Draw curves over all load steps, and of one of them the bodies, and slave faces laid flat, in colours by fields.

    Parameters
    ----------
    results_path : path-like
    outdir : path-like
        Folder of the figures; made if it does not exist.
    curves : sequence of WantedCurve
        Single curves to draw besides force and moment of every support that moves.
    step : int, optional
        Load step whose bodies and maps are drawn; default: the last one.
    fields : sequence of {"pressure", "traction", "slip", "gap", "stress", "J", "displacement"}
        What is drawn in colours: pressure, friction, slip and gap on maps of slave faces, pressure on slave bodies too; stress, J and
        displacement on all bodies. Default: pressure, without contact stress.
    only : sequence of {"curves", "bodies", "maps"}
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
        The results file is missing, damaged, or holds no such load step, or not the one before it, of a slip; or a figure cannot be
        written.
    """
    fields, only, formats = ([given] if isinstance(given, str) else given for given in (fields, only, formats))
    _among("field", fields, FIELDS)
    _among("only", only, DRAWABLE)
    _among("format", formats, FORMATS)
    folder = place("outdir", outdir)
    with Results(results_path) as results, style():
        if not len(results.steps):
            raise ResultsError(f"{results.path} holds no load step yet: nothing to draw")
        over = abscissa(results, x)
        kinds = [kind for kind in DRAWABLE if kind in (only or DRAWABLE)]
        figures = dict(_of_curves(results, curves, over)) if "curves" in kinds else {}
        if kinds != ["curves"]:
            figures |= dict(_of_step(results, int(results.steps[-1]) if step is None else step, fields, kinds))
        if not figures:
            wanted = " or ".join([*fields, *only])
            raise ResultsError(f"{results.path} has no contact, or no support, of which {wanted} could be drawn")
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


def _of_curves(results: Results, curves: Sequence[WantedCurve], over: Abscissa) -> Iterator[Named]:
    yield from ((f"reactions-{s.name}", partial(draw_reactions, results, s.name, over)) for s in moving_supports(results))
    yield from ((_stem(f"curve-{curve.name}"), partial(draw_curve, results, curve, over)) for curve in curves)


def _stem(label: str) -> str:
    """What a file may be called after a label that says anything: letters, digits and signs of no meaning to the system, not too many."""
    return re.sub(r"[^\w .,+=()-]", "_", label)[:100].rstrip()


def _of_step(results: Results, number: int, fields: Sequence[str], kinds: Sequence[str]) -> Iterator[Named]:
    step, chosen = results.step(number), fields or (("pressure",) if results.problem.contacts else ("stress",))
    if "bodies" in kinds:
        yield from _of_bodies(results, step, chosen)
    if "maps" in kinds:
        yield from _of_contacts(results, step, chosen)


def _of_bodies(results: Results, step: StepResult, fields: Sequence[str]) -> Iterator[Named]:
    problem = results.problem
    for number, contact in enumerate(problem.contacts) if "pressure" in fields else ():
        yield f"bodies-{contact.name}", partial(draw_bodies, problem, step, number)
    of_bodies = [field for field in fields if field in BODY_FIELDS and problem.deformable]
    yield from ((f"bodies-{field}", partial(draw_coloured, problem, step, field)) for field in of_bodies)


def _of_contacts(results: Results, step: StepResult, fields: Sequence[str]) -> Iterator[Named]:
    problem = results.problem
    before = results.step(step.step - 1) if step.step - 1 in results.kept_states else None
    for number, contact in enumerate(problem.contacts):
        for field in fields:
            if field in CONTACT_FIELDS:
                yield f"{field}-{contact.name}", partial(_map, problem, step, number, field, before)


def _map(problem: Problem, step: StepResult, number: int, field: str, before: StepResult | None) -> Figure:
    return draw_map(problem, step, face_field(problem, step, number, field, before))


def _save(figure: Figure, stem: Path, formats: Sequence[str]) -> list[Path]:
    paths = [stem.with_name(f"{stem.name}.{kind}") for kind in formats]
    for path in paths:
        with writing(path) as fresh:
            figure.savefig(fresh, bbox_inches="tight", pad_inches=0.08)
    return paths
