"""What the fuzz makes of how the program ends."""

from __future__ import annotations

from pathlib import Path

import pytest
from forked import program
from fuzz.child import Wrong, ending_of, tried

from isomortar import Scene


@pytest.mark.parametrize(("code", "kind"), [(0, "right"), (1, "stopped"), (2, "refused")])
def test_a_sentence_is_an_ending(code: int, kind: str) -> None:
    assert ending_of(code, "isomortar: that is so\n" if code else "").kind == kind


@pytest.mark.parametrize("code", [1, 2, 3, 130, -11])
def test_other_words_are_wrong(code: int) -> None:
    with pytest.raises(Wrong):
        ending_of(code, "isomortar: one\nisomortar: two\n")


def test_a_fault_of_the_program_is_wrong(monkeypatch: pytest.MonkeyPatch) -> None:
    """It never shows as a traceback: the command line makes a sentence of it."""
    monkeypatch.setattr(Scene, "load", lambda *_: {}["no such key"])
    ending = tried(lambda folder: ending_of(*program("run", "press", "--output", str(Path(folder) / "o.h5"), folder=folder)))
    assert ending.kind == "wrong"
    assert "a fault of the program" in ending.said
    assert "no such key" in ending.said
