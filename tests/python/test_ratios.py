"""Ratios in sentences, and commands that sentences tell: both as people read and type them."""

import shlex

import numpy as np
import pytest

import isomortar
from isomortar.errors import IsomortarError
from isomortar.model.ratios import times


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_ratios_have_three_digits_and_no_powers_of_ten_where_people_read_them(sign):
    for ratio in 10.0 ** np.linspace(-3.0, 8.9, 200):
        value = ratio**sign if sign < 0 and ratio < 1e3 else ratio
        said = times(value)
        assert float(said.replace(" ", "")) == pytest.approx(value, rel=0.0051)
        assert "e" not in said
        assert max(map(len, said.split(" ")[1:]), default=3) == 3
    assert [times(x) for x in (1.333, 15, 999.6, 1e4, 2e6, 1e11)] == ["1.33", "15", "1 000", "10 000", "2 000 000", "1e+11"]
    assert [times(x) for x in (0.0004, float("inf"), float("nan"))] == ["0.0004", "inf", "nan"]


@pytest.mark.parametrize("name", ["plain", "a name with blanks", "it's"])
def test_a_command_that_a_sentence_tells_can_be_typed(name, tmp_path):
    """Of a scene for results, and of results for a scene."""
    scene, results = tmp_path / f"{name}.toml", tmp_path / f"{name} results.toml"
    scene.write_text(isomortar.Scene.load("press", ["bodies.block.mesh.elements=[1,1,1]", "stages.press.steps=1"]).to_toml())
    isomortar.run(scene, results, isomortar.Observer()).close()
    for call, path in ((isomortar.Results, scene), (isomortar.Scene.load, results)):
        with pytest.raises(IsomortarError) as raised:
            call(path)
        told = str(raised.value).partition("isomortar ")[2]
        for end in (" computes them", " says what it holds"):
            told = told.removesuffix(end)
        assert shlex.split(told)[1:] == [str(path)]
