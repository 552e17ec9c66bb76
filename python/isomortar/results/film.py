"""A film of a run: bodies and contact pressure load step after load step, from one place and on one scale."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from io import BytesIO
from pathlib import Path
from typing import Any

from PIL import Image

from isomortar._arguments import place, real, whole
from isomortar.errors import InputError, ResultsError
from isomortar.results.bodies import common_scale, draw_bodies
from isomortar.results.files import place_for, writing
from isomortar.results.optional import optional
from isomortar.results.reader import Results
from isomortar.results.style import style
from isomortar.solve.record import StepResult

#: Types of films, and what Pillow calls them; films of type .mp4 are made by ffmpeg.
FORMATS = {".gif": "GIF", ".webp": "WEBP", ".mp4": "MP4"}
#: Fewest and most pictures a second: files hold how long each is shown, and not more than some minutes of it.
RATES = (0.01, 100.0)
#: One load step in so many is asked for at the most: runs are shorter.
FEWEST = 1_000_000
#: Pixels per inch: 8.6 inches are as wide as most windows.
DENSITY = 110


def film(
    results_path: str | os.PathLike[str],
    output: str | os.PathLike[str],
    *,
    contact: str | None = None,
    every: int = 1,
    rate: float = 8.0,
    tell: Callable[[int, int], None] | None = None,
) -> Path:
    """Film the bodies and the pressure of one contact.

    Parameters
    ----------
    results_path : path-like
    output : path-like
        A .gif, .webp or .mp4 file; the last of these needs imageio-ffmpeg (`isomortar[mp4]`). Its folder is made if it does not exist.
    contact : str, optional
        Whose pressure is in colour; default: the first one's.
    every : int
        Of the load steps one in so many is shown, the last one always.
    rate : float
        Pictures per second, 0.01 to 100.
    tell : callable, optional
        Told how many pictures of how many are drawn.

    Returns
    -------
    Path
        The film's.

    Raises
    ------
    InputError
        There is no such contact, or no such type of film; `every` is no whole number or too small, or `rate` too small or too large.
    ResultsError
        The results file is missing, damaged, or holds too few states; or there is a results file in the film's place, or it cannot be
        written.
    """
    path = place("output", output)
    if path.suffix not in FORMATS:
        raise InputError(f"is {path.name!r}; allowed: a name that ends in {' or '.join(FORMATS)}", "output")
    encoder = optional("imageio_ffmpeg", "output", "mp4") if path.suffix == ".mp4" else None
    whole("every", every, 1, FEWEST)
    real("rate", rate, lambda value: RATES[0] <= value <= RATES[1], f"a number from {RATES[0]:g} to {RATES[1]:g}")
    with Results(results_path) as results, style():
        number = _number(results, contact)
        shown = _shown(results, every)
        place_for(path)
        scale = common_scale(results.problem, _states(results, shown), number)
        pictures = []
        for step in _states(results, shown):
            drawn = BytesIO()
            draw_bodies(results.problem, step, number, scale).savefig(drawn, format="png", dpi=DENSITY)
            pictures.append(Image.open(drawn).convert("RGB"))
            if tell:
                tell(len(pictures), len(shown))
    with writing(path) as fresh:
        if encoder:
            _encode(encoder, pictures, fresh, rate)
        else:
            pictures[0].save(fresh, FORMATS[path.suffix], save_all=True, append_images=pictures[1:], duration=round(1000.0 / rate), loop=0)
    return path


def _encode(encoder: Any, pictures: Sequence[Image.Image], path: Path, rate: float) -> None:
    """As H.264, which wants even widths and heights: a line at the edge goes where they are odd.

    Raises
    ------
    OSError
        The film has not all pictures: the encoder, a program of its own, does not say where it failed.
    """
    width, height = (2 * (side // 2) for side in pictures[0].size)
    frames = encoder.write_frames(str(path), (width, height), fps=rate, macro_block_size=2, quality=8, ffmpeg_log_level="quiet")
    frames.send(None)
    for picture in pictures:
        frames.send(picture.crop((0, 0, width, height)).tobytes())
    frames.close()
    try:
        written, _ = encoder.count_frames_and_secs(str(path))
    except RuntimeError:  # there is no film
        written = 0
    if written != len(pictures):
        raise OSError("its encoder failed")


def _number(results: Results, contact: str | None) -> int:
    """Of a contact by its name, or of the first one."""
    names = [c.name for c in results.problem.contacts]
    if not names:
        raise ResultsError(f"{results.path} has no contact that could be filmed")
    if contact is not None and contact not in names:
        raise InputError(f"is {contact!r}; allowed: {', '.join(names)}", "contact")
    return names.index(contact) if contact is not None else 0


def _shown(results: Results, every: int) -> Sequence[int]:
    """Numbers of the load steps in the film: the last one, and one in so many before it."""
    kept = [int(number) for number in results.kept_states]
    if len(kept) < 2:
        raise ResultsError(
            f"{results.path} holds {len(kept)} state of a load step, and a film needs two: compute more steps, with record.states = 'every'"
        )
    return kept[::-1][::every][::-1]


def _states(results: Results, numbers: Sequence[int]) -> Iterator[StepResult]:
    """One after the other: a film takes no more memory than its pictures."""
    return (results.step(number) for number in numbers)
