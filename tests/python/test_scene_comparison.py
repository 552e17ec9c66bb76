"""Where the scene of a results file and that of a run differ: what one of both has alone, by its name, in the order of the scenes."""

from __future__ import annotations

import pytest

from isomortar.results.comparison import differences
from isomortar.scene import Scene

BLOCK = """
format = 1
bodies.a = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh = { order = 1 } }
supports.base.face = "a.w0"
stages = [{ name = "stay", steps = 1 }]
"""
#: What is said of entries that are there more.
MORE = {
    "a support": ('supports.top.face = "a.w1"', ["supports.top"]),
    "supports, the last of the alphabet first": (
        'supports.upper.face = "a.w1"\nsupports.aside.face = "a.u0"',
        ["supports.upper", "supports.aside"],
    ),
    "a contact": ('contacts.floor = { slave = "a.w1", plane = { point = [0, 0, 2], normal = [0, 0, -1] } }', ["contacts.floor"]),
    "a load": ('loads.wind = { face = "a.u0", pressure = 1 }', ["loads.wind"]),
}


@pytest.mark.parametrize(("more", "entries"), MORE.values(), ids=list(MORE))
def test_what_one_of_both_has_alone_is_told_of_it(more: str, entries: list[str]) -> None:
    fewer, whole = (Scene.from_toml(text).problem() for text in (BLOCK, BLOCK.replace("stages =", f"{more}\nstages =")))
    assert differences(whole, fewer) == [f"{entry}: in the file alone" for entry in entries]
    assert differences(fewer, whole) == [f"{entry}: in the scene alone" for entry in entries]
    assert differences(whole, whole) == []
