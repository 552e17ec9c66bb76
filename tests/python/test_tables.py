"""Tables on a terminal of any width: each number and each word is whole."""

import io
import re

import numpy as np
import pytest
from rich.console import Console

from isomortar import Scene, run
from isomortar.cli.cost import costs
from isomortar.cli.tables import print_whole
from isomortar.harness.tangents import check_tangent

SMALL = ["bodies.block.mesh.elements=[2,2,1]", "stages.press.steps=1"]


def printed(table, width):
    """The words of a table on a terminal, without its lines."""
    console = Console(file=io.StringIO(), width=width)
    print_whole(console, table)
    return re.sub("[\u2500-\u257f]", " ", console.file.getvalue())


@pytest.fixture(scope="module")
def tables(tmp_path_factory):
    """What check-tangent and run --cost print."""
    scene = Scene.load("press", SMALL)
    with run(scene, tmp_path_factory.mktemp("run") / "press.h5") as results:
        return {"tangent": check_tangent(scene.problem(), 1, directions=1), "cost": costs(results)}


@pytest.mark.parametrize("name", ["tangent", "cost"])
@pytest.mark.parametrize("width", [10, 40, 60])
def test_nothing_is_cut_on_a_narrow_terminal(tables, name, width):
    """Errors of a tangent were cut to their first two digits."""
    narrow, wide = (printed(tables[name], columns) for columns in (width, 300))
    assert "\N{HORIZONTAL ELLIPSIS}" not in narrow
    assert set(narrow.split()) == set(wide.split())


def test_a_wide_terminal_is_taken_as_it_is(tables):
    assert np.max([len(line) for line in printed(tables["tangent"], 80).splitlines()]) <= 80
