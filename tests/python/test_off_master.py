"""Constraints of a slave that is beside its master in part: what has no foot at all has no weight, whatever the map counts else."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from fuzz import calls

#: A master of linear Lagrange elements, by its averaged normals.
AVERAGED = (calls.MASTERS["averaged"][0], 'master = "lower.w1", projection = "averaged"', "local")


@pytest.mark.parametrize("with_friction", [False, True])
@pytest.mark.parametrize("master", ["closest", "by averages"])
def test_constraints_without_any_foot_have_no_weight(monkeypatch: pytest.MonkeyPatch, master: str, with_friction: bool) -> None:
    monkeypatch.setitem(calls.MASTERS, "by averages", AVERAGED)
    routine, given = calls.sound(master)["control_quantities"]
    slave, feet = given["slave"], given["projections"]
    elements, functions = slave.test.nodes, np.arange(slave.test.count)
    points = len(feet.found) // len(elements)
    assert np.all(feet.found != 0)
    whole = routine(slave, given["master"], given["positions"], feet, with_friction)
    assert np.all(whole.weight > 0.0)
    for beside in range(len(elements) + 1):
        found = np.repeat(np.arange(len(elements)) >= beside, points).astype(np.int32)
        control = routine(slave, given["master"], given["positions"], replace(feet, found=found), with_friction)
        bears = np.isin(functions, elements[beside:])
        assert np.array_equal(control.weight > 0.0, bears), beside
        alone = bears & ~np.isin(functions, elements[:beside])  # all of whose points are over the master
        np.testing.assert_allclose(control.weight[alone], whole.weight[alone], rtol=1e-14)
        np.testing.assert_allclose(control.gap[alone], whole.gap[alone], rtol=1e-14)
        assert not np.any(control.gap[~bears])
