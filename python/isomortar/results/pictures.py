"""All figures of a results file."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from matplotlib.figure import Figure

from isomortar.errors import ResultsError
from isomortar.results.bodies import draw_bodies
from isomortar.results.curves import WantedCurve, draw_curve, draw_reactions, moving_supports
from isomortar.results.files import make_folder, writing
from isomortar.results.maps import draw_map
from isomortar.results.reader import Results
from isomortar.results.style import style


def plot(results_path: str | os.PathLike[str], outdir: str | os.PathLike[str], curves: Sequence[WantedCurve] = ()) -> list[Path]:
    """Draw curves over all load steps, and bodies and contact pressure of the last one.

    Curves and maps are written as PNG and as PDF (vectors), bodies as PNG.

    Parameters
    ----------
    results_path : path-like
    outdir : path-like
        Folder of the figures; made if it does not exist.
    curves : sequence of WantedCurve
        Single curves to draw besides force and moment of every support that moves.

    Returns
    -------
    list of Path

    Raises
    ------
    ResultsError
        The results file is missing, damaged, or holds no load step yet; or a figure cannot be written.
    """
    folder = Path(outdir)
    with Results(results_path) as results, style():
        step = results.last_step()
        if step is None:
            raise ResultsError(f"{results.path} holds no load step yet: nothing to draw")
        make_folder(folder)
        paths = []
        for support in moving_supports(results):
            paths += _save(draw_reactions(results, support.name), folder / f"reactions-{support.name}", ("png", "pdf"))
        for curve in curves:
            paths += _save(draw_curve(results, curve), folder / f"curve-{curve.name}", ("png", "pdf"))
        for number, contact in enumerate(results.problem.contacts):
            paths += _save(draw_bodies(results.problem, step, number), folder / f"bodies-{contact.name}", ("png",))
            paths += _save(draw_map(results.problem, step, number), folder / f"pressure-{contact.name}", ("png", "pdf"))
    return paths


def _save(figure: Figure, stem: Path, formats: tuple[str, ...]) -> list[Path]:
    paths = [stem.with_name(f"{stem.name}.{kind}") for kind in formats]
    for path in paths:
        with writing(path):
            figure.savefig(path, bbox_inches="tight", pad_inches=0.08)
    return paths
