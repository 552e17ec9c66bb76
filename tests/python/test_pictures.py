"""Pictures look as they did when somebody looked at them: `pictures/`, without words. Run as a program this draws them anew."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from unittest.mock import patch

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.image import imread, imsave
from matplotlib.text import Text

from isomortar.geometry.patch import FloatArray
from isomortar.results import ResultsWriter
from isomortar.results.pictures import plot
from results_samples import problem
from test_results_pictures import Curve, quiet

KEPT = Path(__file__).parent / "pictures"
NAMES = ("reactions-rim", "curve-drag", "bodies-tread", "bodies-ground", "pressure-tread", "pressure-ground")
#: Pixels by inch; colours are compared by squares of so many pixels, in which edges of lines average out; 1 is the whole range.
DPI, SQUARE, APART = 60, 6, 0.02


def drawn() -> Iterator[tuple[str, FloatArray]]:
    """Every picture of a results file, height x width x (red, green, blue)."""
    with TemporaryDirectory() as folder:
        path, found = Path(folder) / "run.h5", Path(folder) / "figures"
        writer = ResultsWriter(path, problem(), "", "0")
        for number in range(1, 6):
            writer.recorded(quiet(number))
        save = Figure.savefig

        def without_words(figure: Figure, path: Path, **_: object) -> None:
            for text in figure.findobj(Text):
                text.set_visible(False)  # and take no room: fonts are not the same everywhere
            save(figure, path, dpi=DPI)

        with patch.object(Figure, "savefig", without_words), mpl.rc_context(mpl.rcParamsDefault):
            plot(path, found, [Curve()], formats=["png"])
        for name in NAMES:
            yield name, np.asarray(imread(found / f"{name}.png")[..., :3], float)


def squares(picture: FloatArray) -> FloatArray:
    """Mean colours of the squares that a picture is made of, but for what is left at its ends."""
    rows, columns = (size // SQUARE for size in picture.shape[:2])
    whole = picture[: rows * SQUARE, : columns * SQUARE]
    return whole.reshape(rows, SQUARE, columns, SQUARE, 3).mean(axis=(1, 3))


@pytest.fixture(scope="module")
def pictures() -> dict[str, FloatArray]:
    return dict(drawn())


@pytest.mark.parametrize("name", NAMES)
def test_a_picture_looks_as_it_did(name: str, pictures: dict[str, FloatArray]) -> None:
    kept = np.asarray(imread(KEPT / f"{name}.png")[..., :3], float)
    assert pictures[name].shape == kept.shape
    assert np.abs(squares(pictures[name]) - squares(kept)).max() <= APART


if __name__ == "__main__":
    KEPT.mkdir(exist_ok=True)
    for name, picture in drawn():
        imsave(KEPT / f"{name}.png", picture)
